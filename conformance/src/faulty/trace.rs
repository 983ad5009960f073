//! Bugs in `trace`. Those that need other hits than the sound backend's find them by brute force on the host.

use super::FaultyScene;
use crate::faults::Fault;
use crate::oracle::trace::{closest_as_written, occluded_as_written};
use glam::Vec3;
use twinlight_core::kernels::trace::{Hit, NO_HIT, Ray};
use twinlight_core::scene::Triangle;
use twinlight_core::transport::intersect::{ray_frame, triangle};
use twinlight_core::{Backend, Result};

pub(super) fn closest<B: Backend>(
    inner: &B,
    fault: Fault,
    scene: &FaultyScene<B::Scene>,
    rays: &B::Buffer<Ray>,
    hits: &mut B::Buffer<Hit>,
) -> Result<()> {
    let before = inner.download(hits)?;
    inner.trace_closest(&scene.inner, rays, hits)?;
    let mut answers = inner.download(hits)?;
    let asked = inner.download(rays)?;
    let triangles = &scene.host.triangles;
    for (hit, ray) in answers.iter_mut().zip(&asked) {
        *hit = broken(fault, triangles, ray, *hit);
    }
    if fault == Fault::TraceLastRay && answers.len() > 64 {
        let last = answers.len() - 1;
        answers[last] = before[last];
    }
    *hits = inner.upload(&answers)?;
    Ok(())
}

fn broken(fault: Fault, triangles: &[Triangle], ray: &Ray, hit: Hit) -> Hit {
    let miss = Hit { t: ray.t_max, triangle: NO_HIT, u: 0.0, v: 0.0 };
    let met = hit.triangle != NO_HIT;
    match fault {
        Fault::TraceTieToHigherId if met => highest_tie(triangles, ray, hit),
        Fault::TraceCullsBackFaces if met && is_back(triangles, ray, hit.triangle) => miss,
        Fault::TraceIgnoresMin => closest_as_written(triangles, &Ray { t_min: 0.0, ..*ray }),
        Fault::TraceIgnoresMax => closest_as_written(triangles, &Ray { t_max: f32::INFINITY, ..*ray }),
        Fault::TraceMaxExclusive if met && hit.t == ray.t_max => miss,
        Fault::TraceMissesTriangles if met && hit.triangle % 61 == 60 => {
            let seen: Vec<Triangle> = triangles.iter().copied().filter(|t| t.id % 61 != 60).collect();
            closest_as_written(&seen, ray)
        }
        Fault::TraceEdgesExclusive if met && (hit.u == 0.0 || hit.v == 0.0 || hit.u + hit.v >= 1.0) => miss,
        Fault::TraceSwapsWeights => Hit { u: hit.v, v: hit.u, ..hit },
        Fault::TraceNormalizesDirections if met => {
            let direction = Vec3::from(ray.direction);
            Hit { t: hit.t * direction.dot(direction).sqrt(), ..hit }
        }
        Fault::TraceWrongMissDistance if !met => Hit { t: 0.0, ..hit },
        Fault::TraceSlotForId if met => {
            let slot = triangles.iter().position(|t| t.id == hit.triangle).unwrap_or(0);
            Hit { triangle: slot as u32, ..hit }
        }
        _ => hit,
    }
}

fn is_back(triangles: &[Triangle], ray: &Ray, id: u32) -> bool {
    triangles.iter().filter(|t| t.id == id).any(|t| {
        let [p0, p1, p2] = [t.p0, t.p1, t.p2].map(Vec3::from);
        (p1 - p0).cross(p2 - p0).dot(Vec3::from(ray.direction)) > 0.0
    })
}

fn highest_tie(triangles: &[Triangle], ray: &Ray, hit: Hit) -> Hit {
    let frame = ray_frame(Vec3::from(ray.origin), Vec3::from(ray.direction));
    let as_near = |t: &Triangle| {
        let met = triangle(&frame, t, ray.t_min, ray.t_max)?;
        (met.t == hit.t).then_some(Hit { t: met.t, triangle: t.id, u: met.u, v: met.v })
    };
    triangles.iter().filter_map(as_near).max_by_key(|h| h.triangle).unwrap_or(hit)
}

pub(super) fn any<B: Backend>(
    inner: &B,
    fault: Fault,
    scene: &FaultyScene<B::Scene>,
    rays: &B::Buffer<Ray>,
    occluded: &mut B::Buffer<u32>,
) -> Result<()> {
    inner.trace_any(&scene.inner, rays, occluded)?;
    let mut answers = inner.download(occluded)?;
    for (answer, ray) in answers.iter_mut().zip(inner.download(rays)?) {
        match fault {
            Fault::TraceAnyInverted => *answer = 1 - *answer,
            Fault::TraceAnyIgnoresMax => {
                *answer = occluded_as_written(&scene.host.triangles, &Ray { t_max: f32::INFINITY, ..ray });
            }
            _ => {}
        }
    }
    *occluded = inner.upload(&answers)?;
    Ok(())
}
