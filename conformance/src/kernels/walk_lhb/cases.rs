//! Scenes and pictures at the edges of what there is, and what is refused.

use super::laws::{LINE, SIZE, mixed};
use super::{Prepared, walked};
use crate::compare::{Shape, exact};
use crate::kernels::trace_paths::film::wide;
use crate::kernels::trace_paths::params;
use crate::scenes::compiled;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use bytemuck::Zeroable;
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams};
use twinlight_core::kernels::walk_lhb::{WalkLhbBlock, WalkLhbParams};
use twinlight_core::lattice::View;
use twinlight_core::{Backend, Error};
use twinlight_fixtures::scenes;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "walk_lhb":
        image_sizes, no_rejected_sample, nothing_and_darkness, parameters_are_checked, shapes_are_checked,
    );
}

fn image_sizes<B: Backend>(cx: &Context<'_, B>) -> Check {
    let scene = scenes::cornell();
    let compiled = compiled(&scene);
    let prepared = Prepared::new(cx.backend, &compiled, "halton:7", 9)?;
    for size in [(1, 1), (1, 67), (67, 1), (64, 2), (65, 5)] {
        let film = walked(cx.backend, &prepared, &params(&scene, &compiled, size, 2, Some(3))?)?;
        let wrong = film.iter().filter(|t| t.samples != 2 || t.rejected != 0).count();
        ensure(wrong == 0, || format!("{size:?}: {wrong} pixels without their two samples"))?;
    }
    Ok(())
}

/// No sample of any fixture is infinite, negative or NaN, and every film has light.
fn no_rejected_sample<B: Backend>(cx: &Context<'_, B>) -> Check {
    for name in ["cornell", "materials", "lights", "veach", "axis", "textured", "environment", "furnace"] {
        let Some(scene) = scenes::builtin(name) else { continue };
        let compiled = compiled(&scene);
        let samples = if cx.full() { 32 } else { 4 };
        let prepared = Prepared::new(cx.backend, &compiled, "icosahedron:20", 16)?;
        let film = walked(cx.backend, &prepared, &params(&scene, &compiled, SIZE, samples, None)?)?;
        let rejected: u32 = film.iter().map(|t| t.rejected).sum();
        let lit = film.iter().filter(|t| wide(t.direct[1]) + wide(t.indirect[1]) > 0).count();
        ensure(rejected == 0 && lit > 0, || {
            format!("{name}: {rejected} samples rejected, {lit} pixels lit")
        })?;
    }
    Ok(())
}

/// No triangle, or no light: black, with every sample counted.
fn nothing_and_darkness<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut dark = scenes::cornell();
    dark.lights.clear();
    dark.materials.iter_mut().for_each(|m| m.emission = [0.0; 3]);
    for (name, scene) in [("empty", scenes::empty()), ("dark", dark)] {
        let compiled = compiled(&scene);
        let call = params(&scene, &compiled, SIZE, 3, None)?;
        let prepared = Prepared::new(cx.backend, &compiled, "octahedron:8", 8)?;
        let black = FilmTexel { samples: 3, ..FilmTexel::zeroed() };
        exact(cx, name, &walked(cx.backend, &prepared, &call)?, &[black; 117], LINE)?;
    }
    Ok(())
}

/// Refused as invalid, with the film as it was.
fn refused<B: Backend>(
    cx: &Context<'_, B>,
    name: &str,
    len: usize,
    walk: impl FnOnce(&mut B::Buffer<FilmTexel>) -> twinlight_core::Result<()>,
) -> Check {
    let mut film = cx.backend.zeroed::<FilmTexel>(len)?;
    match walk(&mut film) {
        Err(Error::InvalidInput { .. }) => {}
        Err(Error::Unsupported(what)) => return Err(Failure::Skip(what)),
        other => return Err(Failure::Mismatch(format!("{name}: {other:?}, want InvalidInput"))),
    }
    exact(cx, name, &cx.backend.download(&film)?, &vec![FilmTexel::zeroed(); len], Shape::Line)
}

fn parameters_are_checked<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (_, good, prepared) = mixed(cx)?;
    let block = prepared.buffers.lookup;
    let call = |call: TracePathsParams| WalkLhbParams { call, lookup: block };
    let lookup = |lookup: WalkLhbBlock| WalkLhbParams { call: good, lookup };
    for (name, bad, len) in [
        ("film too short", call(good), 116),
        ("film too long", call(good), 118),
        ("pixels beyond the image", call(TracePathsParams { pixel_begin: 1, ..good }), 117),
        ("samples overflow", call(TracePathsParams { sample_begin: u32::MAX, ..good }), 117),
        ("unknown sampler", call(TracePathsParams { sampler: 2, ..good }), 117),
        ("endless paths", call(TracePathsParams { roulette_begin: u32::MAX, ..good }), 117),
        ("size 0", lookup(WalkLhbBlock { size: 0, ..block }), 117),
        ("another size", lookup(WalkLhbBlock { size: 25, ..block }), 117),
        ("sub-pixel bits", lookup(WalkLhbBlock { subpixel_bits: block.subpixel_bits + 1, ..block }), 117),
        ("odd map", lookup(WalkLhbBlock { map_resolution: 63, ..block }), 117),
        ("no map", lookup(WalkLhbBlock { map_resolution: 0, ..block }), 117),
        ("large map", lookup(WalkLhbBlock { map_resolution: 8_192, ..block }), 117),
    ] {
        refused(cx, name, len, |film| prepared.walk_as(cx.backend, &bad, film))?;
    }
    Ok(())
}

/// Views that are not those of the lists, or out of their budget.
fn shapes_are_checked<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (_, call, prepared) = mixed(cx)?;
    let buffers = &prepared.buffers;
    let views = &buffers.views;
    let mut long = views.clone();
    long[3] = View { forward: views[3].forward.map(|c| 2 * c), ..views[3] };
    let more = [views.clone(), views[..1].to_vec()].concat();
    let params = WalkLhbParams { call, lookup: buffers.lookup };
    for (name, views) in
        [("a view too few", views[1..].to_vec()), ("a view too many", more), ("a long row", long)]
    {
        refused(cx, name, 117, |film| {
            let (mesh, lhb, map) = (&buffers.mesh, &buffers.lhb, &buffers.map);
            cx.backend.walk_lhb(&prepared.resident, mesh, lhb, &views, map, &params, film)
        })?;
    }
    let short = cx.backend.upload(&[0_u32; 5])?;
    refused(cx, "a short map", 117, |film| {
        let (mesh, lhb) = (&buffers.mesh, &buffers.lhb);
        cx.backend.walk_lhb(&prepared.resident, mesh, lhb, views, &short, &params, film)
    })
}
