//! Queries made to hurt: on triangles and off them, at the limits of windows and of the image, and lists that no mesh has.

use super::Seen;
use crate::kernels::rasterize_lhb::inputs::{SIDE, separate, some_directions, views};
use crate::oracle::query_lhb::Looking;
use crate::oracle::rasterize_lhb::Lists;
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_core::lattice::LatticeMesh;
use twinlight_fixtures::random::Random;

/// [`LhbQuery::leaves`] of a position on no triangle: one beyond those that a mesh can have.
pub(super) const FREE: u32 = u32::MAX;

/// A query from free space, with no window.
pub(super) fn from(position: [i32; 3], ray: u32) -> LhbQuery {
    LhbQuery { position, ray, offset: [0; 2], leaves: FREE, window: 0 }
}

/// A point within the cube that is within reach.
pub(super) fn anywhere(random: &mut Random) -> [i32; 3] {
    let side = f64::from(SIDE);
    [(); 3].map(|()| random.between(-side, side).round_ties_even() as i32)
}

/// The lattice point next to a random point of a triangle.
pub(super) fn on_triangle(random: &mut Random, mesh: &LatticeMesh, triangle: usize) -> [i32; 3] {
    let [a, b, c] = mesh.triangles()[triangle].map(|v| mesh.vertices()[v as usize].map(f64::from));
    let (mut u, mut v) = (random.unit(), random.unit());
    if u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    [0, 1, 2].map(|i| (a[i] + u * (b[i] - a[i]) + v * (c[i] - a[i])).round_ties_even() as i32)
}

/// Queries of every kind. Windows are nothing, a few slopes of a pixel, everything, or end at the element, one unit before it or
/// one behind; offsets stay, move by pixels or leave the image; some positions are a few steps beside their triangles, about as
/// many as the clearance.
pub(super) fn some_queries(seen: &Seen, random: &mut Random, count: usize) -> Vec<LhbQuery> {
    (0..count).map(|_| some_query(seen, random)).collect()
}

fn some_query(seen: &Seen, random: &mut Random) -> LhbQuery {
    let triangles = seen.mesh.triangles().len();
    // Now and then a view too many.
    let rays = 2 * seen.views.len() + usize::from(random.index(40) == 0);
    let mut query = from(anywhere(random), random.index(rays) as u32);
    if triangles > 0 && random.index(4) > 0 {
        let triangle = random.index(triangles);
        query.position = on_triangle(random, &seen.mesh, triangle);
        query.leaves = 2 * triangle as u32 + random.index(2) as u32;
        if random.index(3) == 0 {
            query.leaves = 2 * random.index(triangles) as u32 + random.index(2) as u32;
        }
        if random.index(2) == 0 {
            let beside = query.position.map(|c| c + random.index(33) as i32 - 16);
            let squared: i32 = beside.iter().map(|c| c * c).sum();
            query.position = if squared <= 32_760 * 32_760 { beside } else { query.position };
        }
    }
    let pixel = 32_768 / seen.size as i32;
    query.offset = match random.index(4) {
        0 | 1 => [0; 2],
        2 => [0, 1].map(|_| random.index(4 * pixel as usize) as i32 - 2 * pixel),
        _ => [0, 1].map(|_| random.index(100_000) as i32 - 50_000),
    };
    query.window = match random.index(5) {
        0 => 0,
        1 => 1 << 30,
        2 => random.index(64 * pixel.min(1_024) as usize) as u32 * (1 << 14),
        _ => window_to_an_element(seen, random, &query),
    };
    query
}

/// A window that ends at an element of the query's list, or a unit beside.
fn window_to_an_element(seen: &Seen, random: &mut Random, query: &LhbQuery) -> u32 {
    let Some(looking) = Looking::of(query, &seen.views, seen.size) else { return 5 };
    let list = seen.lists.each().nth(looking.list(seen.size)).unwrap_or(&[]);
    if list.is_empty() {
        return 7;
    }
    let ahead = looking.ahead(list[random.index(list.len())]).unsigned_abs() as u32;
    (ahead + random.index(3) as u32).saturating_sub(1)
}

/// Lists of up to `longest` elements that no mesh has: any triangle, any side, equal depths, sorted as the contract says.
pub(super) fn made_up(random: &mut Random, count: usize, size: u32, longest: usize) -> Seen {
    let corner = |random: &mut Random| anywhere(random).map(|c| c as i16);
    let corners: Vec<_> = (0..40).map(|_| [(); 3].map(|()| corner(random))).collect();
    let mesh = separate(&corners);
    let lists: Vec<Vec<LhbElement>> = (0..count * (size * size) as usize)
        .map(|_| {
            // Few depths, so that many are equal.
            let depths = [(); 6].map(|()| (1 << 29) - (1 << 28) + random.index(1 << 29) as u32);
            let element = |random: &mut Random| LhbElement {
                surface: random.index(80) as u32,
                depth: if random.index(2) == 0 {
                    depths[random.index(6)]
                } else {
                    random.index(1 << 30) as u32
                },
            };
            let mut list: Vec<_> = (0..random.index(longest + 1)).map(|_| element(random)).collect();
            list.sort_by_key(|e| (e.depth, e.triangle()));
            list
        })
        .collect();
    let views = views(&some_directions(count, random.next_u64()), size);
    Seen { mesh, views, size, lists: Lists::of(lists.iter().map(Vec::as_slice)) }
}
