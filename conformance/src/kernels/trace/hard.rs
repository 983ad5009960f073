//! The hard cases that concern `trace`; `HARD-CASES.md` lists them.

use super::{Checked, any, as_written, closest, within};
use crate::compare::{Shape, exact};
use crate::kernels::strict_only;
use crate::scenes::{Rays, between, compiled, coplanar_copies, flat, junction, room, scene_of, soup};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use glam::{DVec3, Vec3};
use twinlight_core::Backend;
use twinlight_core::kernels::trace::{Hit, NO_HIT, Ray};
use twinlight_core::scene::{CompiledScene, Mesh, Scene, Transform};
use twinlight_core::transport::SceneView;
use twinlight_core::transport::offset::offset_origin;
use twinlight_core::transport::surface::surface_at;
use twinlight_fixtures::meshes;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "trace":
        g3_subnormal_coordinates, g5_no_area_is_never_met, g6_slivers, g7_coplanar_copies, g8_junction,
        g9_nothing_to_meet, g10_flat_bounds, g11_shifted_exactly, g12_scaled_by_powers_of_two, g13_mirrored,
        t6_no_self_hit, t10_axis_parallel,
    );
}

fn of(mesh: Mesh) -> CompiledScene {
    compiled(&scene_of(mesh))
}

/// Both roads, where the mode allows the first.
fn agrees<B: Backend>(cx: &Context<'_, B>, scene: &CompiledScene, rays: &[Ray]) -> Check {
    within(cx, scene, rays)?;
    if cx.backend.info().strict { as_written(cx, scene, rays) } else { Ok(()) }
}

/// Subnormal coordinates are zeros: adapters that flush and adapters that don't see the same scene.
fn g3_subnormal_coordinates<B: Backend>(cx: &Context<'_, B>) -> Check {
    let tiny = f32::from_bits(7);
    let with = |x: f32| of(crate::scenes::separate("corner", &[[[x, x, -x], [1.0, x, 0.0], [-x, 1.0, x]]]));
    let (scene, zero) = (with(tiny), with(0.0));
    let rays = Rays::new(&zero, 3).mixed(400);
    exact(cx, "hits", &closest(cx, &scene, &rays)?, &closest(cx, &zero, &rays)?, Shape::Line)?;
    agrees(cx, &zero, &rays)
}

/// Collinear corners, two equal corners, one point: nothing there, whatever comes.
fn g5_no_area_is_never_met<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    let repeated_corners = |axes| of(flat(axes));
    for scene in [repeated_corners(3), of(degenerate_edges())] {
        let rays = Rays::new(&scene, cx.options.seed ^ 83).mixed(2_000);
        let met = closest(cx, &scene, &rays)?.iter().filter(|h| h.triangle != NO_HIT).count();
        let blocked: u32 = any(cx, &scene, &rays)?.iter().sum();
        ensure(met == 0 && blocked == 0, || format!("{met} closest and {blocked} any hits on nothing"))?;
    }
    let collinear = of(meshes::needles(60, 5));
    let rays = Rays::new(&collinear, cx.options.seed ^ 89).mixed(2_000);
    as_written(cx, &collinear, &rays)
}

/// Triangles with two equal corners, in each of the three positions.
fn degenerate_edges() -> Mesh {
    let (a, b) = ([0.25, -0.5, 0.125], [-0.75, 0.5, 1.0]);
    crate::scenes::separate("two corners", &[[a, a, b], [a, b, b], [b, a, b]])
}

fn g6_slivers<B: Backend>(cx: &Context<'_, B>) -> Check {
    for aspect in [1e-3, 1e-6] {
        let scene = of(meshes::slivers(100, aspect, 17));
        let rays = Rays::new(&scene, cx.options.seed ^ 97).mixed(3_000);
        agrees(cx, &scene, &rays)?;
        let finite =
            |h: &Hit| h.triangle == NO_HIT || (h.t.is_finite() && h.u.is_finite() && h.v.is_finite());
        let broken = closest(cx, &scene, &rays)?.iter().filter(|h| !finite(h)).count();
        ensure(broken == 0, || format!("{broken} hits without finite numbers"))?;
    }
    Ok(())
}

/// Copies stay in the scene; the lowest id among the nearest is named.
fn g7_coplanar_copies<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    let scene = of(coplanar_copies());
    let rays: Vec<Ray> = (0..400)
        .map(|i| {
            let p = Vec3::new((i % 20) as f32 / 19.0, (i / 20) as f32 / 19.0, 0.0);
            between(p + Vec3::Z, p)
        })
        .collect();
    as_written(cx, &scene, &rays)?;
    let high = closest(cx, &scene, &rays)?.iter().filter(|h| h.triangle > 1).count();
    ensure(high == 0, || format!("{high} of 400 rays name a copy instead of the first"))
}

/// No watertightness is promised at a T-junction, but the same answer every time, and few leaks.
fn g8_junction<B: Backend>(cx: &Context<'_, B>) -> Check {
    let scene = of(junction());
    let rays: Vec<Ray> = (1..2_000)
        .map(|i| {
            let x = i as f32 / 1_000.0 - 1.0;
            let p = Vec3::new(x, 0.05 * x + 0.05, 0.0);
            between(p + Vec3::new(0.1, 0.2, 1.0), p)
        })
        .collect();
    let first = closest(cx, &scene, &rays)?;
    exact(cx, "hits of a second run", &closest(cx, &scene, &rays)?, &first, Shape::Line)?;
    agrees(cx, &scene, &rays)
}

fn g9_nothing_to_meet<B: Backend>(cx: &Context<'_, B>) -> Check {
    let nothing = compiled(&Scene::default());
    let rays = Rays::new(&room(), 1).mixed(70);
    let want: Vec<Hit> = rays.iter().map(|r| Hit { t: r.t_max, triangle: NO_HIT, u: 0.0, v: 0.0 }).collect();
    exact(cx, "hits", &closest(cx, &nothing, &rays)?, &want, Shape::Line)?;
    exact(cx, "occlusion", &any(cx, &nothing, &rays)?, &[0; 70], Shape::Line)
}

fn g10_flat_bounds<B: Backend>(cx: &Context<'_, B>) -> Check {
    for axes in 1..=3 {
        let scene = of(flat(axes));
        let rays = Rays::new(&scene, cx.options.seed ^ 101).mixed(500);
        agrees(cx, &scene, &rays)?;
    }
    let scene = of(flat(1));
    let down = between(
        Vec3::from(scene.bounds.0) + Vec3::new(0.25, 0.25, 1.0),
        Vec3::from(scene.bounds.0) + Vec3::new(0.25, 0.25, 0.0),
    );
    ensure(closest(cx, &scene, &[down])?[0].triangle == 0, || "a flat box is missed from above".into())
}

fn moved(mesh: &Mesh, transform: Transform) -> CompiledScene {
    let mut scene = scene_of(mesh.clone());
    for instance in &mut scene.instances {
        instance.transform = transform;
    }
    compiled(&scene)
}

fn same_bits<B: Backend>(cx: &Context<'_, B>, a: &CompiledScene, b: &CompiledScene) -> Checked<Vec<Ray>> {
    let rays = Rays::new(a, cx.options.seed ^ 103).mixed(2_000);
    exact(cx, "hits", &closest(cx, b, &rays)?, &closest(cx, a, &rays)?, Shape::Line)?;
    Ok(rays)
}

/// 2²⁰ from the origin, by an exact shift: recentring gives the same records, so the same hits.
fn g11_shifted_exactly<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mesh = meshes::snapped(meshes::soup(200, 0.3, 19), 1.0 / 1_048_576.0);
    let far = Transform::scale_translate(1.0, DVec3::new(1_048_576.0, -2_097_152.0, 4_194_304.0));
    let (here, there) = (moved(&mesh, Transform::IDENTITY), moved(&mesh, far));
    let rays = same_bits(cx, &here, &there)?;
    agrees(cx, &there, &rays)
}

/// Scaled by 2ᵏ, ids and weights stay and t, counted in scaled directions, too.
fn g12_scaled_by_powers_of_two<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    let mesh = meshes::soup(200, 0.3, 23);
    let scene = moved(&mesh, Transform::IDENTITY);
    let rays = Rays::new(&scene, cx.options.seed ^ 107).mixed(2_000);
    let want = closest(cx, &scene, &rays)?;
    for factor in [1_048_576.0_f32, 1.0 / 1_024.0] {
        let scaled = moved(&mesh, Transform::scale_translate(f64::from(factor), DVec3::ZERO));
        let grown = |r: &Ray| Ray {
            origin: r.origin.map(|x| x * factor),
            direction: r.direction.map(|x| x * factor),
            ..*r
        };
        let rays: Vec<Ray> = rays.iter().map(grown).collect();
        exact(cx, "hits", &closest(cx, &scaled, &rays)?, &want, Shape::Line)
            .map_err(|f| f.within(&format!("scale {factor}")))?;
    }
    Ok(())
}

/// A mirroring transform keeps fronts in front: the mirrored mesh is met where the mirrored ray meets the mesh.
fn g13_mirrored<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    let mesh = meshes::soup(200, 0.3, 29);
    let scene = moved(&mesh, Transform::IDENTITY);
    let mirror =
        Transform { linear: glam::DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)), ..Transform::IDENTITY };
    let mirrored = moved(&mesh, mirror);
    let mut rays = Rays::new(&scene, cx.options.seed ^ 109);
    let rays: Vec<Ray> = (0..2_000).map(|_| rays.incoherent()).collect();
    let flip = |p: [f32; 3]| [-p[0], p[1], p[2]];
    let turned: Vec<Ray> =
        rays.iter().map(|r| Ray { origin: flip(r.origin), direction: flip(r.direction), ..*r }).collect();
    let (here, there) = (closest(cx, &scene, &rays)?, closest(cx, &mirrored, &turned)?);
    let same = |a: &Hit, b: &Hit| a.triangle == b.triangle;
    let different = here.iter().zip(&there).filter(|(a, b)| !same(a, b)).count();
    ensure(different == 0, || format!("{different} of 2000 mirrored rays meet another triangle"))?;
    as_written(cx, &mirrored, &turned)
}

/// Rays that leave a surface from its offset origin do not meet it again, at any scale and without a scene epsilon; on
/// planes through the origin the position has no error along the normal, but the distance to it does.
fn t6_no_self_hit<B: Backend>(cx: &Context<'_, B>) -> Check {
    let floor = meshes::quad([-9.0, 0.0, 9.0], [9.0, 0.0, 9.0], [9.0, 0.0, -9.0], [-9.0, 0.0, -9.0]);
    let tilt = glam::DMat3::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.4);
    let turned = Transform { linear: tilt, translation: DVec3::new(5.0, -3.0, 0.5) };
    let scaled = |scale| {
        moved(&meshes::soup(600, 0.2, 31), Transform::scale_translate(scale, DVec3::splat(3.0 * scale)))
    };
    for (name, scene) in [
        ("soup of size 0.001", scaled(1e-3)),
        ("soup of size 1", scaled(1.0)),
        ("soup of size 1000000", scaled(1e6)),
        ("floor through the origin", moved(&floor, Transform::IDENTITY)),
        ("tilted floor", moved(&floor, turned)),
        ("room", room()),
    ] {
        no_self_hit(cx, &scene).map_err(|f| f.within(name))?;
    }
    Ok(())
}

fn no_self_hit<B: Backend>(cx: &Context<'_, B>, scene: &CompiledScene) -> Check {
    let mut makers = Rays::new(scene, cx.options.seed ^ 113);
    let (mut rays, mut left) = (Vec::new(), Vec::new());
    for _ in 0..if cx.full() { 20_000 } else { 3_000 } {
        let (pick, towards) = (makers.from_surface(), makers.incoherent());
        let Some((slot, u, v)) = source_of(scene, &pick) else { continue };
        let direction = Vec3::from(towards.direction);
        let surface = surface_at(&SceneView::from(scene), slot, u, v, -direction);
        let normal = surface.geometric_normal;
        let origin = offset_origin(surface.position, surface.offset, normal, direction);
        let (origin, direction) = (origin.to_array(), direction.to_array());
        rays.push(Ray { origin, t_min: 0.0, direction, t_max: f32::INFINITY });
        left.push(scene.triangles[slot as usize].id);
    }
    let hits = closest(cx, scene, &rays)?;
    let again = hits.iter().zip(&left).filter(|(h, id)| h.triangle == **id).count();
    ensure(again == 0, || format!("{again} of {} rays meet what they left", rays.len()))
}

/// A slot and weights drawn from the ray's bits: any point of any triangle, needles of 10⁶ : 1 included.
fn source_of(scene: &CompiledScene, pick: &Ray) -> Option<(u32, f32, f32)> {
    let bits = pick.origin.iter().chain(&pick.direction).fold(17_u32, |h, x| h.rotate_left(5) ^ x.to_bits());
    let slot = bits % scene.triangles.len() as u32;
    let t = &scene.triangles[slot as usize];
    let (e1, e2) = (Vec3::from(t.p1) - Vec3::from(t.p0), Vec3::from(t.p2) - Vec3::from(t.p0));
    let share = e1.cross(e2).length() / (e1.length() * e2.length());
    let (u, v) = ((bits >> 8 & 1023) as f32 / 1024.0, (bits >> 18 & 1023) as f32 / 1024.0);
    let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
    if share > 1e-6 { Some((slot, u, v)) } else { None }
}

/// Directions with one component, zeros of both signs, in and beside face planes: no 0·∞.
fn t10_axis_parallel<B: Backend>(cx: &Context<'_, B>) -> Check {
    for scene in [room(), soup(300, 37), of(flat(1)), of(meshes::grid(8, 8))] {
        let mut rays = Rays::new(&scene, cx.options.seed ^ 127);
        let rays: Vec<Ray> = (0..2_000).map(|_| rays.along_axis()).collect();
        agrees(cx, &scene, &rays)?;
        let nan = closest(cx, &scene, &rays)?
            .iter()
            .filter(|h| h.t.is_nan() || h.u.is_nan() || h.v.is_nan())
            .count();
        ensure(nan == 0, || format!("{nan} hits that are not numbers"))?;
    }
    Ok(())
}
