//! Shadow rays that are looked up: the film of traced ones wherever no edge of a shadow is nearer than the lines of lookups are aside.

use super::laws::{LINE, SIZE, mixed};
use super::{Prepared, walked};
use crate::compare::{Shape, exact};
use crate::kernels::trace_paths::film::wide;
use crate::kernels::trace_paths::laws::{any_split, floor_and_roof};
use crate::kernels::trace_paths::params;
use crate::oracle::trace_paths::{self as known, Known};
use crate::scenes::compiled;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::trace_paths::{FilmTexel, SAMPLER_SOBOL, TracePathsParams};
use twinlight_core::kernels::walk_lhb::{
    CONE, SHADOW_LOOKUPS, SHADOW_LOOKUPS_FIRST, TRACE_MISSES, WalkLhbBlock, WalkLhbParams,
};
use twinlight_core::scene::{Camera, Light, Material, Mesh, NOTHING_HIDES, Scene};
use twinlight_fixtures::meshes::{quad, with_material};

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "walk_lhb":
        lights_that_nothing_shadows, squares_shadow, lines_cross_no_farther_than_the_light, walls_keep_light_out,
        direct_light_keeps_its_shadows, shadows_are_looked_up, any_split_with_shadow_lookups,
        nothing_hides_a_light_where_the_scene_says_so,
    );
}

const ALL: u32 = SHADOW_LOOKUPS | SHADOW_LOOKUPS_FIRST;

/// A film of the same buffers with other flags.
fn flagged<B: Backend>(
    cx: &Context<'_, B>,
    prepared: &Prepared<B>,
    call: &TracePathsParams,
    flags: u32,
) -> Result<Vec<FilmTexel>, Failure> {
    let lookup = WalkLhbBlock { flags, ..prepared.buffers.lookup };
    let mut film = cx.backend.zeroed::<FilmTexel>((call.width * call.height) as usize)?;
    prepared.walk_as(cx.backend, &WalkLhbParams { call: *call, lookup }, &mut film)?;
    Ok(cx.backend.download(&film)?)
}

/// All light of a film, in quanta.
fn light(film: &[FilmTexel]) -> u64 {
    film.iter().map(|texel| wide(texel.direct[1]) + wide(texel.indirect[1])).sum()
}

/// Every kind of light over the oracle's floor, cut to what squares over its middle need to be some pixels wide.
fn small_floors() -> Vec<Known> {
    let mut all = known::punctual_lights();
    all.truncate(3);
    all.extend(known::area_lights());
    all.extend(known::environments().into_iter().filter(|case| case.name.contains("cap")));
    for case in &mut all {
        case.scene.meshes[0] = quad([-2.0, 0.0, 2.0], [2.0, 0.0, 2.0], [2.0, 0.0, -2.0], [-2.0, 0.0, -2.0]);
        // From below the squares.
        let camera =
            Camera { position: [0.0, 0.3, 1.5], target: [0.0; 3], up: [0.0, 1.0, 0.0], vfov_degrees: 0.4 };
        case.scene.camera = Some(camera);
    }
    all
}

/// A black square of half-width 0.6 above the floor, around x = 0 and a z. It faces the floor: close by, lookups go from fronts to
/// fronts.
fn with_square(mut scene: Scene, z: f32) -> Scene {
    let black = scene.add_material(Material::diffuse("black", [0.0; 3]));
    let (y, s, near, far) = (0.4, 0.6, z + 0.6, z - 0.6);
    let square = quad([-s, y, far], [s, y, far], [s, y, near], [-s, y, near]);
    scene.add_mesh(with_material(square, black));
    scene
}

/// Looked up or traced, along rays or directions alone: the same light, where no shadow's edge is near. The light of paths that
/// roulette ends at once is added too.
fn same_light<B: Backend>(cx: &Context<'_, B>, case: &Known, scene: &Scene, is_dark: bool) -> Check {
    let compiled = compiled(scene);
    let call = params(scene, &compiled, SIZE, 4, case.bounces)?;
    let call = TracePathsParams { sampler: SAMPLER_SOBOL, roulette_begin: 0, ..call };
    let prepared = Prepared::new(cx.backend, &compiled, "icosahedron:80", 64)?;
    let want = flagged(cx, &prepared, &call, CONE | TRACE_MISSES)?;
    ensure((light(&want) == 0) == is_dark, || format!("{} quanta of light when traced", light(&want)))?;
    for cone in [CONE, 0] {
        let got = flagged(cx, &prepared, &call, cone | TRACE_MISSES | ALL)?;
        exact(cx, "film", &got, &want, LINE)
            .map_err(|f| f.within(&format!("{}, cone {}", case.name, cone == CONE)))?;
    }
    Ok(())
}

/// Lamps that are triangles are found by the shadow rays to them, and don't shadow themselves.
fn lights_that_nothing_shadows<B: Backend>(cx: &Context<'_, B>) -> Check {
    small_floors().iter().try_for_each(|case| same_light(cx, case, &case.scene, false))
}

/// A square between the lights and the picture is a shadow, and beside them it is none. Where a first lookup finds nothing, the second one's
/// line to a sky is aside by the lattice's radius times the set's, and passes 1.4 from the middle at the height of the squares.
fn squares_shadow<B: Backend>(cx: &Context<'_, B>) -> Check {
    for case in small_floors() {
        same_light(cx, &case, &with_square(case.scene.clone(), 0.0), true)?;
        same_light(cx, &case, &with_square(case.scene.clone(), -2.2), false)?;
    }
    Ok(())
}

/// A light 0.3 above the middle of a floor of 4 × 4, below it a black ceiling with a hole, at half the way, which faces the floor. Rays
/// from what the camera sees pass the hole, and so do lines that cross them no farther than the light. At the lattice's radius, nine
/// times as far, lines are aside by more than the hole is wide.
fn light_in_a_hole() -> Scene {
    let mut scene = Scene { materials: vec![Material::diffuse("white", [0.8; 3])], ..Scene::default() };
    scene.add_mesh(quad([-2.0, 0.0, 2.0], [2.0, 0.0, 2.0], [2.0, 0.0, -2.0], [-2.0, 0.0, -2.0]));
    let black = scene.add_material(Material::diffuse("black", [0.0; 3]));
    let (y, hole, end) = (0.15, 0.3, 2.0);
    for [left, right, far, near] in [
        [-end, end, hole, end],
        [-end, end, -end, -hole],
        [-end, -hole, -hole, hole],
        [hole, end, -hole, hole],
    ] {
        let part = quad([left, y, far], [right, y, far], [right, y, near], [left, y, near]);
        scene.add_mesh(with_material(part, black));
    }
    scene.lights.push(Light::Point { position: [0.0, 0.3, 0.0], intensity: [1.0; 3] });
    scene.camera = Some(Camera {
        position: [0.0, 0.25, 0.05],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        vfov_degrees: 30.0,
    });
    scene
}

/// What is aside of a ray and beyond its light shadows nothing: the film of traced shadow rays.
fn lines_cross_no_farther_than_the_light<B: Backend>(cx: &Context<'_, B>) -> Check {
    let scene = light_in_a_hole();
    let compiled = compiled(&scene);
    let call = TracePathsParams { sampler: SAMPLER_SOBOL, ..params(&scene, &compiled, SIZE, 4, Some(1))? };
    let prepared = Prepared::new(cx.backend, &compiled, "icosahedron:80", 256)?;
    let want = flagged(cx, &prepared, &call, CONE | TRACE_MISSES)?;
    ensure(want.iter().all(|texel| wide(texel.direct[1]) > 0), || "a pixel is dark when traced".into())?;
    exact(cx, "film", &flagged(cx, &prepared, &call, CONE | TRACE_MISSES | ALL)?, &want, LINE)
}

/// Across a box of height and depth 1.
fn across(x: f32, faces_right: bool) -> Mesh {
    let (near, far) = if faces_right { (1.0, 0.0) } else { (0.0, 1.0) };
    quad([x, 0.0, near], [x, 0.0, far], [x, 1.0, far], [x, 1.0, near])
}

/// A box of 2 × 1 × 1 with a lamp in its left half and the camera in its right one; a thin wall may part the halves.
fn halves(has_wall: bool) -> Scene {
    let mut scene = Scene { materials: vec![Material::diffuse("white", [0.8; 3])], ..Scene::default() };
    let (l, r) = (-1.0, 1.0);
    scene.add_mesh(quad([l, 0.0, 1.0], [r, 0.0, 1.0], [r, 0.0, 0.0], [l, 0.0, 0.0]));
    scene.add_mesh(quad([l, 1.0, 0.0], [r, 1.0, 0.0], [r, 1.0, 1.0], [l, 1.0, 1.0]));
    scene.add_mesh(quad([l, 0.0, 0.0], [r, 0.0, 0.0], [r, 1.0, 0.0], [l, 1.0, 0.0]));
    scene.add_mesh(quad([r, 0.0, 1.0], [l, 0.0, 1.0], [l, 1.0, 1.0], [r, 1.0, 1.0]));
    scene.add_mesh(across(l, true));
    scene.add_mesh(across(r, false));
    if has_wall {
        scene.add_mesh(across(0.01, true));
        scene.add_mesh(across(-0.01, false));
    }
    scene.lights.push(Light::Point { position: [-0.5, 0.6, 0.5], intensity: [1.0; 3] });
    scene.camera = Some(Camera {
        position: [0.1, 0.9, 0.5],
        target: [0.7, 0.2, 0.5],
        up: [0.0, 1.0, 0.0],
        vfov_degrees: 60.0,
    });
    scene
}

/// What comes through a wall that parts two rooms, at first vertices and behind them: where lines of the coarse set pass beside its edges.
fn walls_keep_light_out<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut lit = Vec::new();
    for has_wall in [false, true] {
        let scene = halves(has_wall);
        let compiled = compiled(&scene);
        let call = params(&scene, &compiled, SIZE, 16, Some(3))?;
        let call = TracePathsParams { sampler: SAMPLER_SOBOL, ..call };
        let prepared = Prepared::new(cx.backend, &compiled, "icosahedron:320", 64)?;
        lit.push(light(&flagged(cx, &prepared, &call, CONE | TRACE_MISSES | ALL)?) as f64);
    }
    let share = lit[1] / lit[0];
    ensure(share < 0.01, || format!("{share:.4} of the light comes through"))
}

/// Unless first vertices look up too, what is scattered at most once is as it was, and what is scattered more often is not.
fn direct_light_keeps_its_shadows<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (_, call, prepared) = mixed(cx)?;
    let part = |film: &[FilmTexel], of: fn(&FilmTexel) -> [[u32; 2]; 3]| {
        film.iter().flat_map(|texel| of(texel).map(wide)).collect::<Vec<u64>>()
    };
    let traced = walked(cx.backend, &prepared, &call)?;
    let looked_up = flagged(cx, &prepared, &call, CONE | SHADOW_LOOKUPS)?;
    exact(cx, "direct sums", &part(&looked_up, |t| t.direct), &part(&traced, |t| t.direct), Shape::Line)?;
    ensure(part(&looked_up, |t| t.indirect) != part(&traced, |t| t.indirect), || {
        "indirect light has the shadows of rays, of every one".into()
    })
}

/// With few pixels shadows have other edges than traced ones, at first vertices too, and about as much light is left.
fn shadows_are_looked_up<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (_, call, prepared) = mixed(cx)?;
    let call = TracePathsParams { max_bounces: 1, ..call };
    let traced = walked(cx.backend, &prepared, &call)?;
    let looked_up = flagged(cx, &prepared, &call, CONE | ALL)?;
    let differ = traced.iter().zip(&looked_up).filter(|(a, b)| a.direct != b.direct).count();
    let ratio = light(&looked_up) as f64 / light(&traced) as f64;
    ensure(differ > 0 && (ratio - 1.0).abs() < 0.1, || {
        format!("{differ} pixels with other light, {ratio:.4} of it in all")
    })
}

fn any_split_with_shadow_lookups<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (_, whole, prepared) = mixed(cx)?;
    let lookup = WalkLhbBlock { flags: CONE | ALL, ..prepared.buffers.lookup };
    let want = flagged(cx, &prepared, &whole, CONE | ALL)?;
    any_split(cx, &whole, &want, |part, film| {
        prepared.walk_as(cx.backend, &WalkLhbParams { call: *part, lookup }, film)
    })
}

/// Whether shadow rays would be traced or looked up: without them a floor under a roof is lit, and with them it is not.
fn nothing_hides_a_light_where_the_scene_says_so<B: Backend>(cx: &Context<'_, B>) -> Check {
    let scene = floor_and_roof(true);
    let films = |scene_flags: u32, lookups: u32| -> Result<Vec<FilmTexel>, Failure> {
        let mut compiled = compiled(&scene);
        compiled.environment.flags = scene_flags;
        let call = params(&scene, &compiled, SIZE, 4, Some(1))?;
        let prepared = Prepared::new(cx.backend, &compiled, "icosahedron:20", 32)?;
        flagged(cx, &prepared, &call, CONE | lookups)
    };
    ensure(light(&films(0, 0)?) == 0, || "the roof hides nothing: the trial has no power".into())?;
    let lit = films(NOTHING_HIDES, 0)?;
    ensure(light(&lit) > 0, || "no light comes through".into())?;
    exact(cx, "with lookups", &films(NOTHING_HIDES, ALL)?, &lit, LINE)
}
