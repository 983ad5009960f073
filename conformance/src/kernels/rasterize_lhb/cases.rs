//! Edge ladders, random meshes, and what is refused.

use super::inputs::{self, Case, case, front, separate, snapped, some_directions, views};
use super::{agrees, agrees_on_every_path, drawn};
use crate::kernels::property::hold;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use glam::DVec3;
use twinlight_core::kernels::rasterize_lhb::RasterizeLhbParams;
use twinlight_core::lattice::{LatticeMesh, View};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::meshes;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "rasterize_lhb":
        one_triangle_one_pixel, triangle_ladder, view_ladder, random_soup, random_sizes, random_aligned,
        random_fans_and_strips, random_thin, random_duplicates, bad_parameters_are_refused,
    );
}

fn one_triangle_one_pixel<B: Backend>(cx: &Context<'_, B>) -> Check {
    let whole = separate(&[[[-16_000, -16_000, 5], [-16_000, 16_000, -5], [28_000, 1_000, 0]]]);
    let aside = separate(&[[[-16_000, -16_000, 5], [-16_000, 16_000, -5], [-3, 0, 0]]]);
    for mesh in [whole, aside, LatticeMesh::default()] {
        for path in super::PATHS {
            agrees(cx, &mesh, &[front()], &RasterizeLhbParams { path, ..RasterizeLhbParams::new(1) })?;
        }
    }
    Ok(())
}

/// Numbers of triangles around every chunk or workgroup size a backend is likely to use.
fn triangle_ladder<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut counts = vec![0_u32, 1, 2, 3, 31, 33];
    for power in [6, 7, 8, 9, 10, 12, 14, 16, 17] {
        if power <= if cx.full() { 17 } else { 10 } {
            counts.extend([(1 << power) - 1, 1 << power, (1 << power) + 1]);
        }
    }
    let size = 20;
    for count in counts {
        let mut mesh =
            snapped(&meshes::soup(count.saturating_sub(1), 0.04, u64::from(count) ^ cx.options.seed));
        if count > 0 {
            // The last one is seen from everywhere.
            mesh = mesh.followed_by(&separate(&[[
                [9_000, -900, 400],
                [-2_000, 9_000, -900],
                [700, -400, 9_000],
            ]]))?;
        }
        let views = views(&some_directions(1, u64::from(count)), size);
        agrees(cx, &mesh, &views, &RasterizeLhbParams::new(size))?;
    }
    Ok(())
}

/// Numbers of views, and none.
fn view_ladder<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mesh = snapped(&meshes::icosphere(2));
    for (count, size) in [(0, 1), (0, 1024), (1, 5), (2, 16), (3, 16), (17, 9), (65, 7), (300, 2), (1025, 1)]
    {
        let directions = some_directions(count, count as u64 ^ cx.options.seed);
        agrees(cx, &mesh, &views(&directions, size), &RasterizeLhbParams::new(size))?;
    }
    Ok(())
}

fn holds_for<B: Backend>(cx: &Context<'_, B>, case: &Case) -> Check {
    agrees(cx, &case.mesh, &case.views, &case.params)
}

fn random_soup<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, case(inputs::soup()), |case| holds_for(cx, &case))
}

/// Sub-pixel triangles, giants and everything between, in one mesh.
fn random_sizes<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, case(inputs::mixed_sizes()), |case| holds_for(cx, &case))
}

/// Vertices on pixel centres, edges through them: every case of the fill rule.
fn random_aligned<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, case(inputs::aligned()), |case| holds_for(cx, &case))?;
    let on_centres = case(inputs::aligned());
    hold(cx, on_centres, |Case { mesh, params, .. }| {
        let size = 1 << (params.size % 6);
        agrees_on_every_path(cx, &mesh, &[front()], size)
    })
}

fn random_fans_and_strips<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, case(inputs::fans_and_strips()), |case| holds_for(cx, &case))
}

fn random_thin<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, case(inputs::thin()), |case| holds_for(cx, &case))
}

fn random_duplicates<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, case(inputs::duplicates()), |case| holds_for(cx, &case))
}

/// The kind of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Invalid,
    Limit,
}

/// Nothing that is out of range is drawn, and the error says which kind of wrong it is.
fn bad_parameters_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let sound = RasterizeLhbParams::new(8);
    let along = |size| View::along(DVec3::new(0.3, -0.5, 0.8), size);
    let view = along(8)?;
    let long = View { down: view.down.map(|c| c * 2), ..view };
    let fourth = View { forward: [16_384, 0, 0, 1], ..view };
    let extreme = View { right: [i32::MIN; 4], ..view };
    // The rows of a size that is no power of two are shorter.
    let of_another_size = RasterizeLhbParams::new(5);
    for (what, views, params, want) in [
        ("size 0", vec![view], RasterizeLhbParams::new(0), Kind::Invalid),
        ("size 0 without views", vec![], RasterizeLhbParams::new(0), Kind::Invalid),
        ("size 1025", vec![view], RasterizeLhbParams::new(1025), Kind::Limit),
        ("size 2^32 - 1", vec![view], RasterizeLhbParams::new(u32::MAX), Kind::Limit),
        ("path 5", vec![view], RasterizeLhbParams { path: 5, ..sound }, Kind::Invalid),
        ("path 2^32 - 1", vec![view], RasterizeLhbParams { path: u32::MAX, ..sound }, Kind::Invalid),
        ("cap side 2", vec![view], RasterizeLhbParams { cap_side: 2, layer_cap: 3, ..sound }, Kind::Invalid),
        ("cap side 2 of no cap", vec![view], RasterizeLhbParams { cap_side: 2, ..sound }, Kind::Invalid),
        ("a long row", vec![view, long], sound, Kind::Invalid),
        ("a fourth component", vec![fourth, view], sound, Kind::Invalid),
        ("the least integer", vec![view, view, extreme], sound, Kind::Invalid),
        ("a view of another size", vec![view], of_another_size, Kind::Invalid),
        ("2^27 lists", vec![along(1024)?; 128], RasterizeLhbParams::new(1024), Kind::Limit),
    ] {
        for mesh in [LatticeMesh::default(), separate(&[[[0, 0, 0], [9_999, 0, 0], [0, 9_999, 0]]])] {
            let resident = cx.backend.upload_mesh(&mesh)?;
            let got = match cx.backend.rasterize_lhb(&resident, &views, &params) {
                Err(Error::InvalidInput { .. }) => Ok(Kind::Invalid),
                Err(Error::LimitExceeded { .. }) => Ok(Kind::Limit),
                Err(Error::Unsupported(what)) => return Err(Failure::Skip(what)),
                other => Err(format!("{other:?}")),
            };
            ensure(got == Ok(want), || format!("{what}: {got:?}, want {want:?}"))?;
        }
    }
    // A refused call leaves the backend as it was.
    drawn(cx, &LatticeMesh::default(), &[view], &sound).map(|_| ())
}
