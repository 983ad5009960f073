//! Laws of `trace`: relations between answers that hold without knowing any.

use super::{any, as_written, closest, on_every_scene};
use crate::compare::{Shape, exact};
use crate::kernels::strict_only;
use crate::scenes::{Rays, compiled, room, scene_of, soup};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::trace::{Hit, NO_HIT, Ray};
use twinlight_core::scene::Mesh;
use twinlight_fixtures::meshes;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "trace":
        any_is_whether_closest, rays_are_independent, triangle_order_is_free, limits_cut_at_the_hit,
        lengths_of_directions, repeated, closed_meshes_have_no_gaps, both_faces,
    );
}

/// A ray is occluded when and only when it has a closest hit.
fn any_is_whether_closest<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    on_every_scene(cx, |scene, rays| {
        let hits = closest(cx, scene, rays)?;
        let want: Vec<u32> = hits.iter().map(|h| u32::from(h.triangle != NO_HIT)).collect();
        exact(cx, "occlusion", &any(cx, scene, rays)?, &want, Shape::Line)
    })
}

/// Reversed and cut, a list of rays gives the reversed and cut list of hits.
fn rays_are_independent<B: Backend>(cx: &Context<'_, B>) -> Check {
    let scene = soup(300, 7);
    let rays = Rays::new(&scene, cx.options.seed ^ 53).mixed(3_001);
    let hits = closest(cx, &scene, &rays)?;
    let mut reversed: Vec<Ray> = rays.clone();
    reversed.reverse();
    let mut back = closest(cx, &scene, &reversed)?;
    back.reverse();
    exact(cx, "hits of reversed rays", &back, &hits, Shape::Line)?;
    let mut parts = closest(cx, &scene, &rays[..1_111])?;
    parts.extend(closest(cx, &scene, &rays[1_111..])?);
    exact(cx, "hits of parts", &parts, &hits, Shape::Line)
}

/// Reversing the triangles renumbers the hits and nothing else, except which of several equally near ones is named.
fn triangle_order_is_free<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    let mesh = meshes::soup(300, 0.3, 8);
    let mut turned: Mesh = mesh.clone();
    turned.triangles.reverse();
    let last = mesh.triangles.len() as u32 - 1;
    let (scene, turned) = (compiled(&scene_of(mesh)), compiled(&scene_of(turned)));
    let mut rays = Rays::new(&scene, cx.options.seed ^ 59);
    let rays: Vec<Ray> = (0..3_000).map(|_| rays.incoherent()).collect();
    let renumber =
        |h: &Hit| Hit { triangle: if h.triangle == NO_HIT { NO_HIT } else { last - h.triangle }, ..*h };
    let want: Vec<Hit> = closest(cx, &scene, &rays)?.iter().map(renumber).collect();
    exact(cx, "hits", &closest(cx, &turned, &rays)?, &want, Shape::Line)
}

/// `t_max` is inclusive and `t_min` exclusive: cut at its own distance, a hit stays; started there, it is gone.
fn limits_cut_at_the_hit<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    let scene = soup(300, 11);
    let mut rays = Rays::new(&scene, cx.options.seed ^ 61);
    let rays: Vec<Ray> = (0..2_000).map(|_| rays.incoherent()).collect();
    let hits = closest(cx, &scene, &rays)?;
    let met: Vec<(Ray, Hit)> = rays.into_iter().zip(hits).filter(|(_, h)| h.triangle != NO_HIT).collect();
    ensure(met.len() > 300, || format!("only {} of 2000 rays meet the soup", met.len()))?;
    let want: Vec<Hit> = met.iter().map(|(_, h)| *h).collect();
    let ending: Vec<Ray> = met.iter().map(|(r, h)| Ray { t_max: h.t, ..*r }).collect();
    exact(cx, "hits at t_max", &closest(cx, &scene, &ending)?, &want, Shape::Line)?;
    let before = |t: f32| f32::from_bits(t.to_bits() - 1);
    let short: Vec<Ray> =
        met.iter().filter(|(_, h)| h.t > 0.0).map(|(r, h)| Ray { t_max: before(h.t), ..*r }).collect();
    let nothing: Vec<Hit> =
        short.iter().map(|r| Hit { t: r.t_max, triangle: NO_HIT, u: 0.0, v: 0.0 }).collect();
    exact(cx, "hits one ulp beyond t_max", &closest(cx, &scene, &short)?, &nothing, Shape::Line)?;
    let beyond: Vec<Ray> = met.iter().map(|(r, h)| Ray { t_min: h.t, ..*r }).collect();
    as_written(cx, &scene, &beyond)?;
    let again = closest(cx, &scene, &beyond)?;
    let kept = again.iter().zip(&met).filter(|(a, (_, h))| a.t <= h.t).count();
    ensure(kept == 0, || format!("{kept} hits at or before t_min"))
}

/// `t` counts lengths of the direction: doubling the direction halves t, exactly.
fn lengths_of_directions<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    let scene = room();
    let mut rays = Rays::new(&scene, cx.options.seed ^ 67);
    let rays: Vec<Ray> = (0..1_000).map(|_| rays.incoherent()).collect();
    let hits = closest(cx, &scene, &rays)?;
    for factor in [2.0_f32, 0.125, 1_024.0] {
        let scaled: Vec<Ray> =
            rays.iter().map(|r| Ray { direction: r.direction.map(|d| d * factor), ..*r }).collect();
        let want: Vec<Hit> = hits.iter().map(|h| Hit { t: h.t / factor, ..*h }).collect();
        exact(cx, "hits", &closest(cx, &scene, &scaled)?, &want, Shape::Line)?;
    }
    Ok(())
}

fn repeated<B: Backend>(cx: &Context<'_, B>) -> Check {
    let scene = soup(300, 13);
    let rays = Rays::new(&scene, cx.options.seed ^ 71).mixed(5_003);
    let first = closest(cx, &scene, &rays)?;
    for _ in 0..2 {
        exact(cx, "hits of a second run", &closest(cx, &scene, &rays)?, &first, Shape::Line)?;
    }
    Ok(())
}

/// From inside a closed mesh every ray meets it, at corners and edges too (Woop et al. 2013).
fn closed_meshes_have_no_gaps<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    for (name, mesh) in [("ball", meshes::icosphere(6)), ("cube", meshes::cube())] {
        let scene = compiled(&scene_of(mesh));
        let mut rays = Rays::new(&scene, cx.options.seed ^ 73);
        let inside = |ray: Ray| Ray { origin: ray.origin.map(|x| x * 0.25), ..ray };
        let aimed: Vec<Ray> = (0..4_000)
            .map(|_| {
                let (ray, from) = (rays.at_edge(), inside(rays.incoherent()).origin);
                let target: [f32; 3] = std::array::from_fn(|i| ray.origin[i] + ray.direction[i]);
                Ray { origin: from, direction: std::array::from_fn(|i| target[i] - from[i]), ..ray }
            })
            .collect();
        let missed = closest(cx, &scene, &aimed)?.iter().filter(|h| h.triangle == NO_HIT).count();
        ensure(missed == 0, || format!("{name}: {missed} of {} rays escape through edges", aimed.len()))?;
    }
    Ok(())
}

/// Turning every triangle over changes no distance.
fn both_faces<B: Backend>(cx: &Context<'_, B>) -> Check {
    let ball = meshes::icosphere(4);
    let turned = compiled(&scene_of(meshes::inverted(ball.clone())));
    let scene = compiled(&scene_of(ball));
    let mut rays = Rays::new(&scene, cx.options.seed ^ 79);
    let rays: Vec<Ray> = (0..2_000).map(|_| rays.incoherent()).collect();
    for (name, scene) in [("outwards", &scene), ("inwards", &turned)] {
        super::within(cx, scene, &rays).map_err(|f| f.within(name))?;
    }
    Ok(())
}
