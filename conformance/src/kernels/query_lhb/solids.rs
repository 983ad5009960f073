//! Closed meshes, asked as a walk asks: from their surface, with the window that the slope across a pixel explains. From
//! outside, a convex one never hides itself; from inside, every wall is met that the pixel's line leaves through.

use super::Seen;
use crate::kernels::rasterize_lhb::inputs::{snapped, some_directions, turned, views};
use crate::oracle::query_lhb::{Looking, NOTHING};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use glam::DVec3;
use twinlight_core::Backend;
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::kernels::walk_lhb::WalkLhbBlock;
use twinlight_core::lattice::{LatticeMesh, subpixel_bits};
use twinlight_core::scene::Mesh;
use twinlight_core::transport::lhb::{lhb_query, ray_direction};
use twinlight_fixtures::meshes;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "query_lhb": convex_from_outside, convex_from_inside);
}

/// Slope up to which the window explains what a pixel's corner sees of the surface that is left. [`lhb_query`] allows for 64;
/// the rest is for the rounding of positions and vertices, which counts the more the flatter the ray.
const STEEPEST: f64 = 60.0;

/// What lookups on the lattice itself need.
fn block(size: u32) -> WalkLhbBlock {
    WalkLhbBlock {
        centre: [0.0; 3],
        steps_per_unit: 1.0,
        unit_per_step: 1.0,
        row_scale: size.next_power_of_two() as f32 / size as f32,
        lift: 0.0,
        size,
        subpixel_bits: subpixel_bits(size),
        map_resolution: 2,
        flags: 0,
        interleave: 0,
        gather_begin: 0,
        gather_count: 0,
        padding: [0; 2],
    }
}

/// A ray that leaves the front of a triangle.
#[derive(Debug)]
pub(super) struct Leaving {
    pub query: LhbQuery,
    pub position: DVec3,
    pub direction: DVec3,
    /// Of the triangle, against the ray: how far a pixel's line moves in depth on it, per step aside.
    pub slope: f64,
}

/// Corners of a triangle, its front's unit normal.
pub(super) fn facet(mesh: &LatticeMesh, triangle: usize) -> ([DVec3; 3], DVec3) {
    let corners = mesh.triangles()[triangle].map(|v| DVec3::from(mesh.vertices()[v as usize].map(f64::from)));
    let [a, b, c] = corners;
    (corners, (b - a).cross(c - a).normalize_or_zero())
}

/// The lookup from a point of a triangle along a ray; `None` where the ray does not leave its front.
pub(super) fn leaving(seen: &Seen, triangle: usize, position: DVec3, ray: u32) -> Option<Leaving> {
    let (_, normal) = facet(&seen.mesh, triangle);
    let view = &seen.views[ray as usize / 2];
    let direction = ray_direction(view, ray);
    let cosine = normal.dot(direction.as_dvec3());
    let slope = (1.0 - cosine * cosine).max(0.0).sqrt() / cosine;
    let leaves = 2 * triangle as u32 + 1;
    let query = || lhb_query(&block(seen.size), view, ray, position.as_vec3(), normal.as_vec3(), leaves);
    (cosine > 0.0).then(|| Leaving { query: query(), position, direction: direction.as_dvec3(), slope })
}

/// Rays from random points of random triangles.
fn rays(seen: &Seen, random: &mut Random, count: usize) -> Vec<Leaving> {
    let mut rays = Vec::new();
    while rays.len() < count {
        let triangle = random.index(seen.mesh.triangles().len());
        let ([a, b, c], _) = facet(&seen.mesh, triangle);
        let (mut u, mut v) = (random.unit(), random.unit());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let position = a + (b - a) * u + (c - a) * v;
        let ray = random.index(2 * seen.views.len()) as u32;
        rays.extend(leaving(seen, triangle, position, ray).filter(|leaving| leaving.slope < STEEPEST));
    }
    rays
}

/// Flat sides and round ones, coarse and fine, as they are and inside out.
fn each_convex<B: Backend>(
    cx: &Context<'_, B>,
    finish: impl Fn(Mesh) -> Mesh,
    check: impl Fn(&Seen, &[Leaving]) -> Check,
) -> Check {
    let shapes = [
        ("cube", meshes::cube()),
        ("turned cube", turned(meshes::cube(), 3)),
        ("icosahedron", meshes::icosphere(1)),
        ("sphere of facets", turned(meshes::icosphere(4), 8)),
        ("sphere", meshes::icosphere(if cx.full() { 48 } else { 16 })),
    ];
    let mut random = Random::new(cx.options.seed ^ 41);
    for (name, mesh) in shapes {
        let mesh = snapped(&finish(mesh));
        for (size, count) in [(16, 12), (100, 8), (512, 1), (1_024, 1)] {
            if size > 100 && !cx.full() {
                continue;
            }
            let mut directions = some_directions(if cx.full() { 4 * count } else { count }, 17);
            directions.push(DVec3::new(0.02, -0.03, 1.0));
            let seen = Seen::drawn(cx, mesh.clone(), views(&directions, size), size)?;
            let rays = rays(&seen, &mut random, if cx.full() { 20_000 } else { 3_000 });
            check(&seen, &rays).map_err(|f| f.within(&format!("{name}, size {size}")))?;
        }
    }
    Ok(())
}

fn queries(rays: &[Leaving]) -> Vec<LhbQuery> {
    rays.iter().map(|leaving| leaving.query).collect()
}

/// A convex body's own facets never stop a ray that leaves it, though the pixel's line crosses them: those beside the one that
/// is left are within the window and show the other side, or the position is not before them.
fn convex_from_outside<B: Backend>(cx: &Context<'_, B>) -> Check {
    let holds = |seen: &Seen, rays: &[Leaving]| {
        let lists: Vec<_> = seen.lists.each().collect();
        let mut crossed = 0;
        for (leaving, hit) in rays.iter().zip(seen.answers(cx, &queries(rays))?) {
            let Some(looking) = Looking::of(&leaving.query, &seen.views, seen.size) else { continue };
            crossed += usize::from(lists[looking.list(seen.size)].iter().any(|e| looking.ahead(*e) > 0));
            // Where a pixel's corner sees the surface at the very end of the window, roundings decide: a step aside of the
            // position, half a sub-pixel of it and of the corners, which are up to 4 steps wide, all as deep as the slope makes
            // them.
            let beyond = looking.ahead(hit) - i128::from(leaving.query.window);
            let rounded = hit.triangle() == leaving.query.leaves / 2
                && beyond as f64 / 16_384.0 < (1.0 + 2.0 * 4.0 * 0.71) * leaving.slope + 1.0;
            ensure(hit == NOTHING || rounded, || format!("{leaving:?} meets its own body: {hit:?}"))?;
        }
        ensure(crossed * 20 > rays.len(), || format!("only {crossed} rays have their body ahead of them"))
    };
    each_convex(cx, |mesh| mesh, holds)
}

/// From inside, the wall that the pixel's line leaves through is met. Three kinds of rays are left aside. Where the position is
/// about as near to that wall's plane as the clearance: at an edge of the room, and where facets are all but in one
/// plane. Where the line misses the room, less than a pixel from its silhouette. And where, as near to it, the line enters the
/// room farther ahead than the window, which then is what is met.
fn convex_from_inside<B: Backend>(cx: &Context<'_, B>) -> Check {
    let holds = |seen: &Seen, rays: &[Leaving]| {
        let lists: Vec<_> = seen.lists.each().collect();
        let (mut missed, mut unsure) = (0, 0);
        for (leaving, hit) in rays.iter().zip(seen.answers(cx, &queries(rays))?) {
            let Some(looking) = Looking::of(&leaving.query, &seen.views, seen.size) else { continue };
            let list = lists[looking.list(seen.size)];
            let Some(last) = (if looking.reversed { list.first() } else { list.last() }) else {
                missed += 1;
                continue;
            };
            let ([corner, ..], normal) = facet(&seen.mesh, last.triangle() as usize);
            // Eight steps, what positions are rounded by, and what planes are: 2⁻¹⁴ times √3/2 of 2¹⁶ steps.
            if normal.dot(leaving.position - corner) < 8.0 + 0.9 + 3.5 {
                unsure += 1;
                continue;
            }
            let enters = hit != NOTHING && hit.surface % 2 == 0;
            missed += usize::from(enters);
            ensure(enters || hit.triangle() == last.triangle(), || {
                format!("{leaving:?} leaves by {last:?}, meets {hit:?}")
            })?;
        }
        // A silhouette's pixels are about 4/size of the picture, and grazing rays start where it is seen.
        let silhouette = rays.len() / 20 + 2 * rays.len() / seen.size as usize;
        ensure(missed < silhouette && unsure * 5 < rays.len(), || {
            format!("{missed} of {} rays miss the room, {unsure} start on what they would meet", rays.len())
        })
    };
    each_convex(cx, meshes::inverted, holds)
}
