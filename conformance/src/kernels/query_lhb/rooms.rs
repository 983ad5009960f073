//! The foot of a wall: lookups from the floor next to it, and from it next to the floor.

use super::Seen;
use super::solids::{Leaving, facet, leaving};
use crate::kernels::rasterize_lhb::inputs::views;
use crate::oracle::query_lhb::Looking;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use glam::{DMat3, DVec3};
use twinlight_core::Backend;
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::lattice::LatticeMesh;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "query_lhb": the_foot_of_a_wall);
}

/// Where the wall stands.
const WALL: f64 = 9_000.0;

/// A floor across y = 0, a wall that ends `below` it, facing −x, a second wall 1500 steps behind, and that one's other side: what
/// is met by those who miss the first. Triangles 0 and 1 are the floor, 2 and 3 the wall.
fn corner(below: f64, turn: DMat3) -> LatticeMesh {
    let quad = |a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]| [[a, b, c], [a, c, d]];
    let wall = |x: f64, low: f64| {
        quad([x, low, -12_000.0], [x, low, 12_000.0], [x, 14_000.0, 12_000.0], [x, 14_000.0, -12_000.0])
    };
    let side = 12_000.0;
    let floor = quad([-side, 0.0, side], [side, 0.0, side], [side, 0.0, -side], [-side, 0.0, -side]);
    let behind = wall(WALL + 1_500.0, -12_000.0);
    let turned_over = behind.map(|[a, b, c]| [a, c, b]);
    let triangles = [floor, wall(WALL, -below), behind, turned_over].concat();
    let placed = |p: [f64; 3]| (turn * DVec3::from(p)).to_array().map(|c| c.round_ties_even() as i16);
    let vertices = triangles.iter().flatten().map(|&p| placed(p)).collect();
    let numbers = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    LatticeMesh::new(vertices, numbers).expect("the suite's own corners are within reach")
}

/// From the floor, `r` steps from the wall, for every r from the clearance on: the wall is met wherever it is on the pixel's line,
/// in depths that the window explains or beyond. So is the floor from the wall, `r` steps above it.
fn the_foot_of_a_wall<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 51);
    let mut turns = vec![DMat3::IDENTITY];
    for _ in 0..2 {
        let x = random.direction();
        let y = x.cross(random.direction()).normalize();
        turns.push(DMat3::from_cols(x, y, x.cross(y)));
    }
    for turn in turns {
        // A wall that goes on below is on every line; one that ends at the floor, or a lattice step below, is not.
        for below in [12_000.0, 0.0, 1.0] {
            for size in [16, 64, 200] {
                let directions = towards_the_foot(&mut random, turn, if cx.full() { 24 } else { 5 });
                let seen = Seen::drawn(cx, corner(below, turn), views(&directions, size), size)?;
                let place = format!("wall {below} below the floor, size {size}");
                foot(cx, &seen, turn, &mut random).map_err(|f| f.within(&place))?;
            }
        }
    }
    Ok(())
}

/// Away from the floor and towards the wall, or the other way, so that both senses of a ray are asked.
fn towards_the_foot(random: &mut Random, turn: DMat3, count: usize) -> Vec<DVec3> {
    let direction = |random: &mut Random| {
        let d = random.direction();
        let sign = if random.index(2) == 0 { 1.0 } else { -1.0 };
        turn * DVec3::new(d.x.abs(), d.y.abs(), d.z) * sign
    };
    (0..count).map(|_| direction(random)).collect()
}

fn foot<B: Backend>(cx: &Context<'_, B>, seen: &Seen, turn: DMat3, random: &mut Random) -> Check {
    let mut rays: Vec<(Leaving, [u32; 2])> = Vec::new();
    for power in 0..if cx.full() { 400 } else { 100 } {
        // 12 to 8000 steps, evenly in their logarithms.
        let r = 12.0 * 670.0_f64.powf(f64::from(power) / if cx.full() { 400.0 } else { 100.0 });
        let along = random.between(-9_000.0, 9_000.0);
        let on_floor = turn * DVec3::new(WALL - r, 0.0, along);
        let on_wall = turn * DVec3::new(WALL, r, along);
        for ray in 0..2 * seen.views.len() as u32 {
            let of_floor = [0, 1].into_iter().find(|&t| contains(&seen.mesh, t, on_floor));
            let of_wall = [2, 3].into_iter().find(|&t| contains(&seen.mesh, t, on_wall));
            rays.extend(of_floor.and_then(|t| leaving(seen, t, on_floor, ray)).map(|l| (l, [2, 3])));
            rays.extend(of_wall.and_then(|t| leaving(seen, t, on_wall, ray)).map(|l| (l, [0, 1])));
        }
    }
    let queries: Vec<LhbQuery> = rays.iter().map(|(leaving, _)| leaving.query).collect();
    let lists: Vec<_> = seen.lists.each().collect();
    let mut met = 0;
    for ((leaving, opposite), hit) in rays.iter().zip(seen.answers(cx, &queries)?) {
        let Some(looking) = Looking::of(&leaving.query, &seen.views, seen.size) else { continue };
        let (_, normal) = facet(&seen.mesh, opposite[0] as usize);
        let cosine = -normal.dot(leaving.direction);
        let on_line = lists[looking.list(seen.size)].iter().any(|e| opposite.contains(&e.triangle()));
        // What the window allows other surfaces: the slope of what is left, at least 4. A little less, for roundings.
        let steepest = 0.95 * leaving.slope.clamp(4.0, 64.0);
        if cosine <= 0.0 || (1.0 - cosine * cosine).sqrt() > steepest * cosine || !on_line {
            continue;
        }
        met += 1;
        ensure(opposite.contains(&hit.triangle()), || {
            format!("{leaving:?} has triangle {} before it and meets {hit:?}", opposite[0])
        })?;
    }
    ensure(met * 8 > rays.len(), || format!("only {met} of {} rays go to the other side", rays.len()))
}

/// Whether a triangle holds a point of its plane, to a few steps.
fn contains(mesh: &LatticeMesh, triangle: usize, point: DVec3) -> bool {
    let ([a, b, c], normal) = facet(mesh, triangle);
    [(a, b), (b, c), (c, a)]
        .iter()
        .all(|&(p, q)| (q - p).cross(point - p).dot(normal) >= -3.0 * (q - p).length())
}
