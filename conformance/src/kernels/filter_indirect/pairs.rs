//! Two pixels, and which of them has the other for a neighbour. Floats are exact here, so no mode rounds them and nothing is in doubt.

use super::inputs::{radiance, wall};
use super::{Checked, filtered, shape};
use crate::compare::exact;
use crate::oracle::filter_indirect::{Picture, as_written};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::filter_indirect::FilterIndirectParams;
use twinlight_core::kernels::shade_primary::GBufferTexel;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "filter_indirect":
        normals_at_the_limit, planes_at_the_limit, the_plane_is_the_pixels_own, shading_and_geometry,
        limits_grow_with_depth,
    );
}

/// Which pixels of each pair have the other for a neighbour. Every pair is a row of its own material, and its second
/// pixel's light is worth 1 in the first, and the other way round.
fn joined<B: Backend>(
    cx: &Context<'_, B>,
    params: &FilterIndirectParams,
    pairs: &[[GBufferTexel; 2]],
) -> Checked<Vec<[bool; 2]>> {
    let params = FilterIndirectParams { width: 2, height: pairs.len() as u32, window: 2, ..*params };
    let rows = pairs.iter().enumerate();
    let gbuffer = rows
        .flat_map(|(row, pair)| pair.map(|texel| GBufferTexel { material: row as u32, ..texel }))
        .collect();
    let input = [radiance([0.0, 3.0, 0.0]), radiance([3.0, 0.0, 0.0])].repeat(pairs.len());
    let picture = Picture { params, gbuffer, diffuse: vec![1; pairs.len()], input };
    let got = filtered(cx, &picture)?;
    if cx.backend.info().strict {
        exact(cx, "pairs", &got, &as_written(&picture), shape(&picture))?;
    }
    Ok(got.chunks_exact(2).map(|pair| [pair[0].rgb[0] != 0.0, pair[1].rgb[1] != 0.0]).collect())
}

/// What a pair shows, the change to two pixels of a wall that makes it, and who is joined then.
type Pair = (&'static str, fn(&mut GBufferTexel, &mut GBufferTexel), [bool; 2]);

fn check_pairs<B: Backend>(cx: &Context<'_, B>, params: &FilterIndirectParams, pairs: &[Pair]) -> Check {
    let made: Vec<[GBufferTexel; 2]> = pairs
        .iter()
        .map(|(_, differ, _)| {
            let wall = wall(2, 1, 2);
            let [mut p, mut q] = [wall.gbuffer[0], wall.gbuffer[1]];
            differ(&mut p, &mut q);
            [p, q]
        })
        .collect();
    for ((name, _, want), got) in pairs.iter().zip(joined(cx, params, &made)?) {
        ensure(got == *want, || format!("{name}: joined {got:?}, want {want:?}"))?;
    }
    Ok(())
}

/// A cosine of exactly the limit is enough; an ulp less is not.
fn normals_at_the_limit<B: Backend>(cx: &Context<'_, B>) -> Check {
    let params = FilterIndirectParams { least_cosine: 0.5, ..wall(2, 1, 2).params };
    check_pairs(
        cx,
        &params,
        &[
            (
                "at the limit",
                |p, q| (p.shading_normal, q.shading_normal) = ([1.0, 0.0, 0.0], [0.5, 0.75, 0.0]),
                [true; 2],
            ),
            (
                "an ulp below",
                |p, q| {
                    (p.shading_normal, q.shading_normal) = ([1.0, 0.0, 0.0], [0.5_f32.next_down(), 0.75, 0.0])
                },
                [false; 2],
            ),
            (
                "all axes",
                |p, q| (p.shading_normal, q.shading_normal) = ([0.5, 0.5, 1.0], [0.5, -0.5, 0.5]),
                [true; 2],
            ),
            (
                "too little of all",
                |p, q| (p.shading_normal, q.shading_normal) = ([0.5, 0.5, 1.0], [0.5, -0.75, 0.5]),
                [false; 2],
            ),
            (
                "contrary",
                |p, q| (p.shading_normal, q.shading_normal) = ([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]),
                [false; 2],
            ),
            ("no number", |_, q| q.shading_normal[1] = f32::NAN, [false; 2]),
        ],
    )
}

/// A height of exactly the limit, (⅛·2)·8 = 2, is joined, above or below; an ulp more is not.
fn planes_at_the_limit<B: Backend>(cx: &Context<'_, B>) -> Check {
    check_pairs(
        cx,
        &wall(2, 1, 2).params,
        &[
            ("in the plane", |_, q| q.position[0] += 1e6, [true; 2]),
            ("above", |_, q| q.position[2] += 2.0, [true; 2]),
            ("below", |_, q| q.position[2] -= 2.0, [true; 2]),
            ("too far above", |p, q| (p.position[2], q.position[2]) = (0.0, 2.0_f32.next_up()), [false; 2]),
            ("too far below", |p, q| (p.position[2], q.position[2]) = (0.0, -2.0_f32.next_up()), [false; 2]),
            (
                "in a plane askew",
                |p, q| {
                    (p.geometric_normal, q.geometric_normal) = ([0.5, -0.5, 0.5], [0.5, -0.5, 0.5]);
                    (p.position, q.position) = ([1.0, 2.0, 3.0], [65.0, 64.0, 1.0]);
                },
                [true; 2],
            ),
            ("no number", |_, q| q.position[0] = f32::NAN, [false; 2]),
            ("infinitely far", |_, q| q.position[2] = f32::INFINITY, [false; 2]),
        ],
    )
}

/// Normal and depth are those of the pixel that is filtered: of two pixels one may be the other's neighbour and not the other way.
fn the_plane_is_the_pixels_own<B: Backend>(cx: &Context<'_, B>) -> Check {
    check_pairs(
        cx,
        &wall(2, 1, 2).params,
        &[
            (
                "along the first's plane",
                |p, q| {
                    (p.geometric_normal, q.geometric_normal) = ([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]);
                    q.position = [p.position[0], p.position[1] + 9.0, p.position[2]];
                },
                [true, false],
            ),
            (
                "along the second's",
                |p, q| {
                    (p.geometric_normal, q.geometric_normal) = ([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]);
                    q.position = [p.position[0], p.position[1], p.position[2] + 9.0];
                },
                [false, true],
            ),
            (
                "the first is near",
                |p, q| {
                    (p.depth, q.depth) = (1.0, 64.0);
                    q.position[2] -= 10.0;
                },
                [false, true],
            ),
        ],
    )
}

/// Cosines are of shading normals, planes of geometric ones.
fn shading_and_geometry<B: Backend>(cx: &Context<'_, B>) -> Check {
    check_pairs(
        cx,
        &wall(2, 1, 2).params,
        &[
            ("geometric normals turned", |_, q| q.geometric_normal = [0.0, 1.0, 0.0], [true; 2]),
            ("shading normals turned", |_, q| q.shading_normal = [0.0, 1.0, 0.0], [false; 2]),
            (
                "both shading normals turned, in one plane",
                |p, q| {
                    (p.shading_normal, q.shading_normal) = ([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
                    q.position[0] += 100.0;
                },
                [true; 2],
            ),
            (
                "both shading normals turned, in two planes",
                |p, q| {
                    (p.shading_normal, q.shading_normal) = ([0.0, 1.0, 0.0], [0.0, 1.0, 0.0]);
                    q.position[2] += 100.0;
                },
                [false; 2],
            ),
        ],
    )
}

/// At depth 0 what is in the plane is joined, and nothing else.
fn limits_grow_with_depth<B: Backend>(cx: &Context<'_, B>) -> Check {
    fn pair(p: &mut GBufferTexel, q: &mut GBufferTexel, depths: [f32; 2], height: f32) {
        [p.depth, q.depth] = depths;
        q.position[2] += height;
    }
    check_pairs(
        cx,
        &wall(2, 1, 2).params,
        &[
            ("depth 0 in the plane", |p, q| pair(p, q, [0.0, 0.0], 0.0), [true; 2]),
            ("depth 0 off the plane", |p, q| pair(p, q, [0.0, 0.0], 1.0 / 1_048_576.0), [false; 2]),
            ("depth 0 beside depth 8", |p, q| pair(p, q, [0.0, 8.0], 2.0), [false, true]),
            ("depth −0", |p, q| pair(p, q, [-0.0, -0.0], 0.0), [true; 2]),
            ("negative depth", |p, q| pair(p, q, [-8.0, 8.0], 0.0), [false, true]),
            ("depth 1", |p, q| pair(p, q, [1.0, 1.0], 0.25), [true; 2]),
            ("less than depth 1", |p, q| pair(p, q, [1.0_f32.next_down(), 1.0], 0.25), [false, true]),
        ],
    )
}
