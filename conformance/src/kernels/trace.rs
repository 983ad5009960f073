// kernel family: trace
// contract core/src/kernels/trace.rs
// cpu backend-cpu/src/kernels/trace.rs
// gpu backend-gpu/src/kernels/trace.wgsl
// oracle conformance/src/oracle/trace.rs
//! Cases and laws of `trace`.
//!
//! Two roads to the right answer: the contract's formula without a hierarchy, bit for bit (`as_written`, strict mode
//! only), and f64 with derived intervals (`within`, every mode).

mod hard;
mod laws;

use super::strict_only;
use crate::compare::{Evidence, Shape, exact};
use crate::oracle::trace as oracle;
use crate::scenes::{Rays, compiled, coplanar_copies, junction, room, scene_of, soup};
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use twinlight_core::kernels::trace::{Hit, NO_HIT, Ray};
use twinlight_core::scene::CompiledScene;
use twinlight_core::{Backend, Error};
use twinlight_fixtures::meshes;

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "trace":
        edge_ladder, closest_within_intervals, closest_as_written, any_within_intervals, any_as_written,
        lengths_must_agree,
    );
    laws::list(list);
    hard::list(list);
}

/// What a buffer holds before the kernel runs; none of it may be left.
const GARBAGE: Hit = Hit { t: -7.0, triangle: 0xdead_beef, u: -7.0, v: -7.0 };

type Checked<T> = Result<T, Failure>;

fn closest<B: Backend>(cx: &Context<'_, B>, scene: &CompiledScene, rays: &[Ray]) -> Checked<Vec<Hit>> {
    let device_scene = cx.backend.upload_scene(scene)?;
    let device_rays = cx.backend.upload(rays)?;
    let mut hits = cx.backend.upload(&vec![GARBAGE; rays.len()])?;
    cx.backend.trace_closest(&device_scene, &device_rays, &mut hits)?;
    Ok(cx.backend.download(&hits)?)
}

fn any<B: Backend>(cx: &Context<'_, B>, scene: &CompiledScene, rays: &[Ray]) -> Checked<Vec<u32>> {
    let device_scene = cx.backend.upload_scene(scene)?;
    let device_rays = cx.backend.upload(rays)?;
    let mut occluded = cx.backend.upload(&vec![0xdead_beef_u32; rays.len()])?;
    cx.backend.trace_any(&device_scene, &device_rays, &mut occluded)?;
    Ok(cx.backend.download(&occluded)?)
}

/// Closest hits against the contract's formula without a hierarchy.
fn as_written<B: Backend>(cx: &Context<'_, B>, scene: &CompiledScene, rays: &[Ray]) -> Check {
    let want: Vec<Hit> = rays.iter().map(|r| oracle::closest_as_written(&scene.triangles, r)).collect();
    exact(cx, "hits", &closest(cx, scene, rays)?, &want, Shape::Line)
}

/// Closest hits against f64; returns the share of rays with only one right answer.
fn within<B: Backend>(cx: &Context<'_, B>, scene: &CompiledScene, rays: &[Ray]) -> Checked<f64> {
    let hits = closest(cx, scene, rays)?;
    let mut evidence = Evidence::new("hits", Shape::Line);
    let mut decided = 0_usize;
    for (index, (ray, hit)) in rays.iter().zip(&hits).enumerate() {
        let allowed = oracle::closest(&scene.triangles, ray);
        decided += usize::from(allowed.is_decided());
        let mut ids: Vec<u32> = allowed.hits.iter().map(|(id, _)| *id).collect();
        if allowed.miss {
            ids.push(NO_HIT);
        }
        if !evidence.one_of(index, "triangle", hit.triangle, &ids) {
            continue;
        }
        if hit.triangle == NO_HIT {
            let t_max = f64::from(ray.t_max);
            evidence.interval(index, "t of a miss", hit.t, t_max, t_max, "the contract: t_max");
            continue;
        }
        for (_, range) in allowed.hits.iter().filter(|(id, _)| *id == hit.triangle) {
            let because = "WGSL's accuracy of each operation of the formula";
            evidence.interval(index, "t", hit.t, range.t.low, range.t.high, because);
            evidence.interval(index, "u", hit.u, range.u.low, range.u.high, because);
            evidence.interval(index, "v", hit.v, range.v.low, range.v.high, because);
        }
    }
    evidence.finish()?;
    Ok(decided as f64 / rays.len().max(1) as f64)
}

/// Scenes that between them hold every kind of trouble, by name.
fn scenes(full: bool) -> Vec<(&'static str, CompiledScene)> {
    let of = |mesh| compiled(&scene_of(mesh));
    vec![
        ("soup", soup(if full { 900 } else { 240 }, 3)),
        ("room", room()),
        ("ball", of(meshes::icosphere(5))),
        ("slivers", of(meshes::slivers(60, 1e-6, 4))),
        ("fan", of(meshes::fan(37))),
        ("no area", of(meshes::needles(40, 5))),
        ("coplanar copies", of(coplanar_copies())),
        ("junction", of(junction())),
    ]
}

fn on_every_scene<B: Backend>(cx: &Context<'_, B>, check: impl Fn(&CompiledScene, &[Ray]) -> Check) -> Check {
    let count = if cx.full() { 4_000 } else { 1_000 };
    for (at, (name, scene)) in scenes(cx.full()).iter().enumerate() {
        let rays = Rays::new(scene, cx.options.seed ^ at as u64).mixed(count);
        check(scene, &rays).map_err(|f| f.within(name))?;
    }
    Ok(())
}

/// Numbers of rays around workgroup and chunk sizes.
fn edge_ladder<B: Backend>(cx: &Context<'_, B>) -> Check {
    let scene = soup(60, 1);
    for len in [0, 1, 2, 31, 33, 63, 64, 65, 255, 256, 257, 1023, 1025, 4097] {
        let rays = Rays::new(&scene, len as u64).mixed(len);
        let place = format!("{len} rays");
        within(cx, &scene, &rays).map_err(|f| f.within(&place))?;
        let got = any(cx, &scene, &rays).map_err(|f| f.within(&place))?;
        ensure(got.iter().all(|&o| o <= 1), || format!("{place}: occlusion is neither 0 nor 1"))?;
    }
    Ok(())
}

/// Besides the intervals: on scenes without coincidences the oracle must be sure of nearly every incoherent ray, or
/// the check would check nothing.
fn closest_within_intervals<B: Backend>(cx: &Context<'_, B>) -> Check {
    on_every_scene(cx, |scene, rays| within(cx, scene, rays).map(|_| ()))?;
    let count = if cx.full() { 4_000 } else { 1_000 };
    for (name, scene) in [("soup", soup(240, 3)), ("room", room())] {
        let mut rays = Rays::new(&scene, cx.options.seed ^ 99);
        let rays: Vec<Ray> = (0..count).map(|_| rays.incoherent()).collect();
        let decided = within(cx, &scene, &rays)?;
        ensure(decided > 0.97, || format!("{name}: the oracle decides only {decided} of the rays"))?;
    }
    Ok(())
}

fn closest_as_written<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    on_every_scene(cx, |scene, rays| as_written(cx, scene, rays))
}

fn any_within_intervals<B: Backend>(cx: &Context<'_, B>) -> Check {
    on_every_scene(cx, |scene, rays| {
        let mut evidence = Evidence::new("occlusion", Shape::Line);
        for (index, (ray, got)) in rays.iter().zip(any(cx, scene, rays)?).enumerate() {
            let want = oracle::occluded(&scene.triangles, ray);
            let allowed: &[u32] = want.map_or(&[0, 1], |o| if o { &[1] } else { &[0] });
            evidence.one_of(index, "occluded", got, allowed);
        }
        evidence.finish()
    })
}

fn any_as_written<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    on_every_scene(cx, |scene, rays| {
        let want: Vec<u32> = rays.iter().map(|r| oracle::occluded_as_written(&scene.triangles, r)).collect();
        exact(cx, "occlusion", &any(cx, scene, rays)?, &want, Shape::Line)
    })
}

fn lengths_must_agree<B: Backend>(cx: &Context<'_, B>) -> Check {
    let scene = cx.backend.upload_scene(&room())?;
    let rays = cx.backend.upload(&Rays::new(&room(), 1).mixed(3))?;
    let mut hits = cx.backend.upload(&[GARBAGE; 2])?;
    let mut occluded = cx.backend.upload(&[9_u32; 4])?;
    for refused in [
        cx.backend.trace_closest(&scene, &rays, &mut hits),
        cx.backend.trace_any(&scene, &rays, &mut occluded),
    ] {
        match refused {
            Err(Error::InvalidInput { .. }) => {}
            Err(Error::Unsupported(what)) => return Err(Failure::Skip(what)),
            other => return Err(Failure::Mismatch(format!("unequal lengths: {other:?}, want InvalidInput"))),
        }
    }
    exact(cx, "hits of a refused call", &cx.backend.download(&hits)?, &[GARBAGE; 2], Shape::Line)
}
