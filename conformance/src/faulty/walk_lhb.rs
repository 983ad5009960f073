//! Bugs in `walk_lhb`: in the parameters, in what is looked up, in the film, and in the scene's records, where a wrong formula and
//! a wrong record show alike.

use super::{FaultyMesh, FaultyScene};
use crate::faults::Fault;
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbBuffers, LhbElement};
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams, UNLIMITED_BOUNCES};
use twinlight_core::kernels::walk_lhb::{
    CONE, GATHER, SHADOW_LOOKUPS, SHADOW_LOOKUPS_FIRST, TRACE_MISSES, WalkLhbBlock, WalkLhbParams,
};
use twinlight_core::lattice::View;
use twinlight_core::scene::{CompiledScene, LIGHT_TRIANGLE, NONE};
use twinlight_core::{Backend, Result};

/// The scene that a kernel with the bug would effectively render.
pub(super) fn broken_scene(fault: Fault, mut scene: CompiledScene) -> CompiledScene {
    match fault {
        Fault::WalkAlbedoBias => {
            scene.materials.iter_mut().for_each(|m| m.albedo = m.albedo.map(|a| a * 0.97));
        }
        Fault::WalkShadowsAnyway => scene.environment.flags = 0,
        Fault::WalkSpheresUnseen => scene.environment.sphere_count = 0,
        Fault::WalkEnvironmentLost if scene.environment.offset != NONE => {
            scene.words[scene.environment.offset as usize..].fill(0);
        }
        _ => {}
    }
    for light in scene.lights.iter_mut().filter(|light| light.kind == LIGHT_TRIANGLE) {
        match fault {
            // The density falls by what the light is counted more.
            Fault::WalkEmittersTwice => light.area *= 1.5,
            Fault::WalkEmittersWeighted => light.area *= 0.8,
            _ => {}
        }
    }
    scene
}

pub(super) fn walk_lhb<B: Backend>(
    inner: &B,
    fault: Fault,
    scene: &FaultyScene<B::Scene>,
    mesh: &FaultyMesh<B::Mesh>,
    lhb: &Lhb<B>,
    views: &[View],
    map: &B::Buffer<u32>,
    params: &WalkLhbParams,
    film: &mut B::Buffer<FilmTexel>,
) -> Result<()> {
    let mut broken =
        WalkLhbParams { call: asked(fault, &params.call), lookup: lookup(fault, &params.lookup) };
    let looks_shadows_up = params.lookup.flags & SHADOW_LOOKUPS != 0;
    if looks_shadows_up {
        broken = shadowed(fault, broken);
    }
    match fault {
        Fault::WalkAcceptAnything if params.check(inner.len(film), views, inner.len(map)).is_err() => {
            return Ok(());
        }
        _ => params.check(inner.len(film), views, inner.len(map))?,
    }
    let before = inner.download(film)?;
    if fault == Fault::WalkTraces {
        inner.trace_paths(&scene.inner, &broken.call, film)?;
    } else {
        let (broken_lhb, broken_map, broken_scene);
        let (mut lhb, mut map, mut resident) = (lhb, map, &scene.inner);
        if matches!(fault, Fault::WalkWrongTriangle | Fault::WalkFirstLayer | Fault::WalkFacing)
            || (looks_shadows_up && fault == Fault::WalkShadowsNever)
        {
            broken_lhb = listed(inner, fault, mesh, lhb)?;
            lhb = &broken_lhb;
        }
        if matches!(fault, Fault::WalkAgainst | Fault::WalkViewOffByOne) {
            broken_map = rays(inner, fault, map, views.len() as u32, params.lookup.map_resolution)?;
            map = &broken_map;
        }
        if looks_shadows_up && fault == Fault::WalkShadowsAlways {
            broken_scene = inner.upload_scene(&unlit(scene.host.clone()))?;
            resident = &broken_scene;
        }
        inner.walk_lhb(resident, &mesh.inner, lhb, views, map, &broken, film)?;
    }
    let mut after = inner.download(film)?;
    for (texel, old) in after.iter_mut().zip(&before) {
        *texel = summed(fault, *texel, old);
    }
    *film = inner.upload(&after)?;
    Ok(())
}

fn asked(fault: Fault, call: &TracePathsParams) -> TracePathsParams {
    let mut asked = *call;
    match fault {
        Fault::WalkLoseBounce if call.max_bounces != UNLIMITED_BOUNCES => {
            asked.max_bounces = call.max_bounces.saturating_sub(1);
        }
        Fault::WalkStopEarly => asked.max_bounces = call.max_bounces.min(2),
        Fault::WalkIgnoreFirstSample => asked.sample_begin = 0,
        Fault::WalkOneSample => asked.sample_count = call.sample_count.min(1),
        Fault::WalkIgnoreSeed => asked.seed = 0,
        Fault::WalkIgnoreSampler => asked.sampler = 1,
        Fault::WalkWholeImage => (asked.pixel_begin, asked.pixel_count) = (0, call.width * call.height),
        Fault::WalkFixedExponent => asked.film_exponent = 20,
        _ => {}
    }
    asked
}

fn lookup(fault: Fault, block: &WalkLhbBlock) -> WalkLhbBlock {
    match fault {
        Fault::WalkNoCone => WalkLhbBlock { flags: block.flags & !CONE, ..*block },
        Fault::WalkLosesMisses => WalkLhbBlock { flags: block.flags & !TRACE_MISSES, ..*block },
        Fault::WalkNoGather => WalkLhbBlock { flags: block.flags & !GATHER, ..*block },
        Fault::WalkNoPatterns => WalkLhbBlock { interleave: 0, ..*block },
        Fault::WalkNoLift => WalkLhbBlock { lift: 0.0, ..*block },
        Fault::WalkScale => WalkLhbBlock { steps_per_unit: block.steps_per_unit / 1.05, ..*block },
        Fault::WalkOffCentre => WalkLhbBlock { centre: [0.0; 3], ..*block },
        _ => *block,
    }
}

/// What a kernel with a bug in its shadow lookups would effectively be asked for.
fn shadowed(fault: Fault, mut asked: WalkLhbParams) -> WalkLhbParams {
    let (call, lookup) = (&mut asked.call, &mut asked.lookup);
    match fault {
        Fault::WalkShadowsMargin => lookup.unit_per_step = -lookup.unit_per_step,
        Fault::WalkShadowsFirst => lookup.flags |= SHADOW_LOOKUPS_FIRST,
        Fault::WalkShadowsTraced => lookup.flags &= !(SHADOW_LOOKUPS | SHADOW_LOOKUPS_FIRST),
        Fault::WalkShadowsLast if call.max_bounces != UNLIMITED_BOUNCES => {
            call.max_bounces = call.max_bounces.saturating_sub(1);
        }
        _ => {}
    }
    asked
}

/// A scene whose lights are black wherever they are sampled.
fn unlit(mut scene: CompiledScene) -> CompiledScene {
    scene.lights.iter_mut().for_each(|light| light.emission = [0.0; 3]);
    scene
}

/// The lists that a kernel with the bug would effectively read.
fn listed<B: Backend>(inner: &B, fault: Fault, mesh: &FaultyMesh<B::Mesh>, lhb: &Lhb<B>) -> Result<Lhb<B>> {
    let mut offsets = inner.download(&lhb.offsets)?;
    let mut elements = inner.download(&lhb.elements)?;
    let triangles = mesh.host.triangles().len() as u32;
    match fault {
        Fault::WalkWrongTriangle => {
            let next = |e: &LhbElement| (e.surface + 2) % (2 * triangles);
            elements.iter_mut().for_each(|e| e.surface = next(e));
        }
        // With misses traced, scattered rays don't notice.
        Fault::WalkShadowsNever => offsets.fill(0),
        Fault::WalkFacing => elements.iter_mut().for_each(|e| e.surface ^= 1),
        Fault::WalkFirstLayer => {
            let first =
                |w: &[u32]| elements.get(w[0] as usize..w[1] as usize).and_then(<[_]>::first).copied();
            let lists: Vec<Option<LhbElement>> = offsets.windows(2).map(first).collect();
            elements = lists.iter().flatten().copied().collect();
            let mut count = 0;
            for (offset, list) in offsets.iter_mut().skip(1).zip(&lists) {
                count += u32::from(list.is_some());
                *offset = count;
            }
        }
        _ => {}
    }
    Ok(LhbBuffers {
        size: lhb.size,
        view_count: lhb.view_count,
        offsets: inner.upload(&offsets)?,
        elements: inner.upload(&elements)?,
        left_out: inner.upload(&[])?,
    })
}

/// The map that a kernel with the bug would effectively read: of a candidate's second word the low 15 bits are the ray.
fn rays<B: Backend>(
    inner: &B,
    fault: Fault,
    map: &B::Buffer<u32>,
    views: u32,
    resolution: u32,
) -> Result<B::Buffer<u32>> {
    const RAY: u32 = (1 << 15) - 1;
    let mut words = inner.download(map)?;
    for word in words.iter_mut().skip((resolution * resolution) as usize).skip(1).step_by(2) {
        let ray = match fault {
            Fault::WalkAgainst => (*word & RAY) ^ 1,
            _ => ((*word & RAY) + 2) % (2 * views),
        };
        *word = *word & !RAY | ray;
    }
    inner.upload(&words)
}

fn summed(fault: Fault, texel: FilmTexel, old: &FilmTexel) -> FilmTexel {
    let wide = |w: [u32; 2]| u64::from(w[1]) << 32 | u64::from(w[0]);
    let words = |x: u64| [x as u32, (x >> 32) as u32];
    let added = |new: [u32; 2], old: [u32; 2]| wide(new).wrapping_sub(wide(old));
    let each = |new: [[u32; 2]; 3], old: [[u32; 2]; 3], f: &dyn Fn([u32; 2], [u32; 2]) -> [u32; 2]| {
        [0, 1, 2].map(|c| f(new[c], old[c]))
    };
    let doubled = |new, old| words(wide(new).wrapping_add(added(new, old)));
    let fresh = |new, old| words(added(new, old));
    match fault {
        Fault::WalkDoubleDirect => FilmTexel { direct: each(texel.direct, old.direct, &doubled), ..texel },
        Fault::WalkDropIndirect => FilmTexel { indirect: old.indirect, ..texel },
        Fault::WalkOverwriteFilm => FilmTexel {
            direct: each(texel.direct, old.direct, &fresh),
            indirect: each(texel.indirect, old.indirect, &fresh),
            ..texel
        },
        _ => texel,
    }
}
