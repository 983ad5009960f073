//! What is between voxels and lights.

use super::Checked;
use super::inputs::{point, sun, voxel, voxels, within};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use glam::DVec3;
use twinlight_core::Backend;
use twinlight_core::scene::{Light, Mesh, NOTHING_HIDES};
use twinlight_fixtures::meshes::{cube, placed, quad};

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "light_voxels":
        a_triangle_shadows, what_is_beyond_the_light_does_not, a_sphere_shadows, a_closed_box_is_dark, rays_begin_on_the_lights_side,
        rays_without_normal_begin_in_the_middle, some_of_many_are_dark,
        nothing_hides_a_light_where_the_scene_says_so,
    );
}

/// A square of half-width `half` at height `y`.
fn plate(y: f32, half: f32) -> Mesh {
    quad([-half, y, -half], [half, y, -half], [half, y, half], [-half, y, half])
}

/// Whether voxels are lit, which the oracle says too.
fn are_lit<B: Backend>(
    cx: &Context<'_, B>,
    meshes: Vec<Mesh>,
    lights: Vec<Light>,
    normals: &[[i32; 3]],
) -> Checked<Vec<bool>> {
    let voxels = normals.iter().map(|normal| voxel([4; 3], *normal)).collect();
    let leaves = within(meshes, lights, voxels).agreed(cx)?;
    Ok(leaves.iter().map(|leaf| leaf.rgb[0] > 0).collect())
}

fn expect(got: &[bool], want: &[bool], what: &str) -> Check {
    ensure(got == want, || format!("{what}: lit {got:?}, want {want:?}"))
}

fn a_triangle_shadows<B: Backend>(cx: &Context<'_, B>) -> Check {
    for light in [point([0.3, 3.0, 0.2]), sun([0.1, -1.0, 0.05])] {
        let above = are_lit(cx, vec![plate(1.5, 1.0)], vec![light], &[[0, 9, 0], [0; 3]])?;
        expect(&above, &[false, false], "a plate above")?;
        let below = are_lit(cx, vec![plate(-1.5, 1.0)], vec![light], &[[0, 9, 0], [0; 3]])?;
        expect(&below, &[true, true], "a plate below")?;
    }
    Ok(())
}

/// Rays end at a point, and go on to the sun.
fn what_is_beyond_the_light_does_not<B: Backend>(cx: &Context<'_, B>) -> Check {
    let lamp = are_lit(cx, vec![plate(3.5, 2.0)], vec![point([0.3, 3.0, 0.2])], &[[0, 9, 0]])?;
    expect(&lamp, &[true], "a lamp under a roof")?;
    let sun = are_lit(cx, vec![plate(900.0, 500.0)], vec![sun([0.1, -1.0, 0.05])], &[[0, 9, 0]])?;
    expect(&sun, &[false], "a roof in the sky")
}

/// Its own light is next to none.
fn a_sphere_shadows<B: Backend>(cx: &Context<'_, B>) -> Check {
    let ball = |y| Light::Sphere { center: [0.12, y, 0.12], radius: 0.4, radiance: [1e-9; 3] };
    for light in [point([0.2, 3.0, 0.15]), sun([0.05, -1.0, 0.05])] {
        for (y, want) in [(1.5, false), (-1.5, true)] {
            let voxels = vec![voxel([4; 3], [0, 9, 0]), voxel([4; 3], [0; 3])];
            // Lights are chosen by their power, and the sun's is that on a scene's meshes.
            let case = within(vec![plate(-4.0, 2.0)], vec![light, ball(y)], voxels);
            // Enough samples that the other light is among the chosen.
            let leaves = case.with(|block| block.samples = 64).lit(cx)?;
            let lit: Vec<bool> = leaves.iter().map(|leaf| leaf.rgb[0] > 0).collect();
            expect(&lit, &[want; 2], &format!("a sphere at {y}"))?;
        }
    }
    Ok(())
}

fn a_closed_box_is_dark<B: Backend>(cx: &Context<'_, B>) -> Check {
    let normals = [[0, 9, 0], [5, 5, 5], [-1, 0, 0], [0; 3]];
    for light in [point([0.3, 3.0, 0.2]), point([-4.0, 0.3, 0.2]), sun([0.3, -1.0, 0.5])] {
        let lit = are_lit(cx, vec![placed(cube(), 0.9, DVec3::ZERO)], vec![light], &normals)?;
        expect(&lit, &[false; 4], "in a box")?;
    }
    let inside = are_lit(cx, vec![placed(cube(), 0.9, DVec3::ZERO)], vec![point([0.3, 0.6, 0.2])], &normals)?;
    expect(&inside, &[true; 4], "beside a lamp in a box")
}

/// A wall through the voxel, which its centre is behind, or in front of: it is lit from wherever the light is, by either normal.
fn rays_begin_on_the_lights_side<B: Backend>(cx: &Context<'_, B>) -> Check {
    // The voxel's middle is at 0.125, and it is a quarter wide.
    for wall in [0.01, 0.09, 0.16, 0.24] {
        for light in [point([0.3, 3.0, 0.2]), point([0.3, -3.0, 0.2]), sun([0.1, -1.0, 0.2])] {
            let lit = are_lit(cx, vec![plate(wall, 1.0)], vec![light], &[[0, 9, 0], [0, -9, 0]])?;
            expect(&lit, &[true, true], &format!("a wall at {wall}"))?;
        }
    }
    // Farther off than rays begin, it shadows.
    let lit = are_lit(cx, vec![plate(0.30, 1.0)], vec![point([0.3, 3.0, 0.2])], &[[0, 9, 0], [0, -9, 0]])?;
    expect(&lit, &[false, false], "a wall above the voxel")
}

fn rays_without_normal_begin_in_the_middle<B: Backend>(cx: &Context<'_, B>) -> Check {
    for (wall, want) in [(0.09, true), (0.16, false)] {
        let lit = are_lit(cx, vec![plate(wall, 1.0)], vec![point([0.3, 3.0, 0.2])], &[[0; 3]])?;
        expect(&lit, &[want], &format!("a wall at {wall}"))?;
    }
    Ok(())
}

/// Boxes among voxels.
fn some_of_many_are_dark<B: Backend>(cx: &Context<'_, B>) -> Check {
    let boxes = [[0.31, 0.47, -0.23], [-0.52, 0.11, 0.37], [0.07, -0.61, 0.55]];
    let meshes: Vec<Mesh> = boxes.map(|at| placed(cube(), 0.21, DVec3::from(at))).into();
    for light in [point([0.3, 3.0, 0.2]), sun([0.3, -1.0, 0.5])] {
        let mut voxels = voxels(50, 400);
        for voxel in &mut voxels {
            (voxel.gathered, voxel.sums.emission) = ([0.0; 3], [0; 3]);
        }
        let lit = within(meshes.clone(), vec![light], voxels).agreed(cx)?;
        let dark = lit.iter().filter(|leaf| leaf.opacity > 0 && leaf.rgb == [0; 3]).count();
        ensure((20..200).contains(&dark), || format!("{dark} of 400 are dark: the case shows nothing"))?;
    }
    Ok(())
}

fn nothing_hides_a_light_where_the_scene_says_so<B: Backend>(cx: &Context<'_, B>) -> Check {
    for light in [point([0.3, 3.0, 0.2]), sun([0.1, -1.0, 0.05])] {
        let case = |meshes| within(meshes, vec![light], vec![voxel([4; 3], [0, 9, 0])]);
        let open = case(Vec::new()).lit(cx)?;
        let mut covered = case(vec![plate(1.5, 1.0)]);
        expect(&[covered.lit(cx)?[0].rgb[0] > 0], &[false], "a plate above")?;
        covered.scene.environment.flags = NOTHING_HIDES;
        let leaves = covered.lit(cx)?;
        ensure(leaves == open, || {
            format!("{leaves:?} under a plate that hides nothing, {open:?} without one")
        })?;
    }
    Ok(())
}
