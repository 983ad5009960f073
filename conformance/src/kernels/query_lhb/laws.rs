//! Laws of `query_lhb`: relations between answers that hold without knowing any.

use super::inputs::{FREE, anywhere, from, made_up, some_queries};
use super::{Seen, both_ways};
use crate::compare::{Shape, exact};
use crate::kernels::rasterize_lhb::inputs::{front, separate, snapped, some_directions, views};
use crate::oracle::query_lhb::{Looking, NOTHING};
use crate::oracle::rasterize_lhb::Lists;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_core::lattice::{DEPTH_ORIGIN, View};
use twinlight_fixtures::meshes;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "query_lhb":
        query_order_is_free, free_space_meets_the_next, from_gap_to_gap, turned_round_twice, meshes_add_up, repeated,
    );
}

fn soup(seed: u64) -> Seen {
    Seen::new(snapped(&meshes::soup(300, 0.3, seed)), views(&some_directions(3, 8), 30), 30)
}

/// A permutation of the queries permutes the hits, and queries asked in parts are queries asked at once.
fn query_order_is_free<B: Backend>(cx: &Context<'_, B>) -> Check {
    let seen = soup(cx.options.seed ^ 21);
    let mut random = Random::new(cx.options.seed ^ 22);
    let queries = some_queries(&seen, &mut random, 1_500);
    let hits = seen.answers(cx, &queries)?;
    both_ways(&hits)?;
    let mut order: Vec<usize> = (0..queries.len()).collect();
    for i in (1..order.len()).rev() {
        order.swap(i, random.index(i + 1));
    }
    let permuted: Vec<LhbQuery> = order.iter().map(|&i| queries[i]).collect();
    let want: Vec<LhbElement> = order.iter().map(|&i| hits[i]).collect();
    exact(cx, "permuted", &seen.answers(cx, &permuted)?, &want, Shape::Line)?;
    let mut parts = Vec::new();
    for part in [&queries[..1], &queries[1..700], &queries[700..]] {
        parts.extend(seen.answers(cx, part)?);
    }
    exact(cx, "in parts", &parts, &hits, Shape::Line)
}

/// Without a window: the first element of the list that is farther, or nearer when reversed, by the depths alone.
fn free_space_meets_the_next<B: Backend>(cx: &Context<'_, B>) -> Check {
    let seen = soup(cx.options.seed ^ 23);
    let mut random = Random::new(cx.options.seed ^ 24);
    let queries: Vec<LhbQuery> = (0..2_000)
        .map(|i| LhbQuery { leaves: FREE - i / 2 % 2, ..from(anywhere(&mut random), i % 6) })
        .collect();
    let hits = seen.answers(cx, &queries)?;
    both_ways(&hits)?;
    let lists: Vec<&[LhbElement]> = seen.lists.each().collect();
    for (query, hit) in queries.iter().zip(&hits) {
        let Some(looking) = Looking::of(query, &seen.views, seen.size) else { continue };
        let list = lists[looking.list(seen.size)];
        let depth = |e: &&LhbElement| i128::from(e.depth);
        let next = if looking.reversed {
            list.iter().rev().find(|e| depth(e) < looking.depth)
        } else {
            list.iter().find(|e| depth(e) > looking.depth)
        };
        let surface = |e: &LhbElement| e.surface ^ u32::from(looking.reversed);
        let want = next.map_or(NOTHING, |e| LhbElement { surface: surface(e), ..*e });
        ensure(*hit == want, || format!("{query:?} meets {hit:?}, the next is {want:?}"))?;
    }
    Ok(())
}

/// From the gaps between layers, walked through from the nearest to the farthest and back: what is left of a gap ahead is what
/// is left of the next one behind, from its other side.
fn from_gap_to_gap<B: Backend>(cx: &Context<'_, B>) -> Check {
    let layers = 200;
    let mut random = Random::new(cx.options.seed ^ 25);
    let heights: Vec<i32> = (0..layers).map(|i| (i - 100) * 150 + random.index(100) as i32).collect();
    let wall = |z: i32, over: bool| {
        let (z, corners) = (z as i16, [[-9_000, -18_000], [-9_000, 18_000], [18_000, 0]]);
        let [a, b, c] = corners.map(|[x, y]| [x, y, z]);
        if over { [a, c, b] } else { [a, b, c] }
    };
    let corners: Vec<_> = heights.iter().map(|&z| wall(z, random.index(2) == 0)).collect();
    let mesh = separate(&corners);
    let seen = Seen::new(mesh, vec![front()], 6);
    let gaps: Vec<i32> = heights.windows(2).map(|w| (w[0] + w[1]).div_euclid(2)).collect();
    let ask = |ray: u32| -> Vec<LhbQuery> { gaps.iter().map(|&z| from([0, 0, z], ray)).collect() };
    let (away, back) = (seen.answers(cx, &ask(0))?, seen.answers(cx, &ask(1))?);
    for gap in 1..gaps.len() {
        let (ahead, behind) = (away[gap - 1], back[gap]);
        let same = ahead.surface == behind.surface ^ 1 && ahead.depth == behind.depth;
        ensure(same && ahead.triangle() == gap as u32, || {
            format!("layer {gap}: {ahead:?}, back {behind:?}")
        })?;
    }
    Ok(())
}

/// Lists turned round, seen from the other end and asked the other way: the same surfaces, depths counted from the other end.
fn turned_round_twice<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 26);
    for seen in [soup(cx.options.seed ^ 27), made_up(&mut random, 3, 12, 20)] {
        let over =
            |e: &LhbElement| LhbElement { surface: e.surface ^ 1, depth: 2 * DEPTH_ORIGIN as u32 - e.depth };
        let lists: Vec<Vec<LhbElement>> =
            seen.lists.each().map(|list| list.iter().rev().map(over).collect()).collect();
        let behind = |view: &View| View { forward: view.forward.map(|c| -c), ..*view };
        let turned = Seen {
            lists: Lists::of(lists.iter().map(Vec::as_slice)),
            views: seen.views.iter().map(behind).collect(),
            ..seen.clone()
        };
        let queries = some_queries(&seen, &mut random, 2_000);
        let asked: Vec<LhbQuery> = queries.iter().map(|q| LhbQuery { ray: q.ray ^ 1, ..*q }).collect();
        let hits = seen.answers(cx, &queries)?;
        both_ways(&hits)?;
        let counted = |e: &LhbElement| match *e {
            NOTHING => NOTHING,
            e => LhbElement { depth: 2 * DEPTH_ORIGIN as u32 - e.depth, ..e },
        };
        let want: Vec<LhbElement> = hits.iter().map(counted).collect();
        exact(cx, "hits", &turned.answers(cx, &asked)?, &want, Shape::Line)?;
    }
    Ok(())
}

/// What is met among two meshes together is the first of what is met among each alone, that of the first of equals.
fn meshes_add_up<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (still, moving) =
        (snapped(&meshes::icosphere(4)), snapped(&meshes::soup(200, 0.3, cx.options.seed ^ 28)));
    let count = still.triangles().len() as u32;
    let views = views(&some_directions(3, 29), 32);
    let both = Seen::new(still.followed_by(&moving)?, views.clone(), 32);
    let mut random = Random::new(cx.options.seed ^ 30);
    let queries = some_queries(&both, &mut random, 2_000);
    let hits = both.answers(cx, &queries)?;
    both_ways(&hits)?;
    // The side that a query is on counts in both, its triangle in one.
    let left = |of_still: bool| {
        let leaves = |q: &LhbQuery| match (q.leaves / 2 < count, of_still) {
            (true, true) => q.leaves,
            (false, false) if q.leaves < FREE - 1 => q.leaves - 2 * count,
            _ => FREE - 1 + q.leaves % 2,
        };
        queries.iter().map(|q| LhbQuery { leaves: leaves(q), ..*q }).collect::<Vec<_>>()
    };
    let of_still = Seen::new(still, views.clone(), 32).answers(cx, &left(true))?;
    let of_moving = Seen::new(moving, views, 32).answers(cx, &left(false))?;
    let first = |((query, a), b): ((&LhbQuery, &LhbElement), &LhbElement)| {
        let later = LhbElement { surface: b.surface.wrapping_add(2 * count), ..*b };
        match (*a == NOTHING, *b == NOTHING, query.ray % 2 == 0) {
            (_, true, _) => *a,
            (true, ..) => later,
            (_, _, true) => {
                if a.depth <= b.depth {
                    *a
                } else {
                    later
                }
            }
            (_, _, false) => {
                if a.depth > b.depth {
                    *a
                } else {
                    later
                }
            }
        }
    };
    let want: Vec<LhbElement> = queries.iter().zip(&of_still).zip(&of_moving).map(first).collect();
    exact(cx, "hits", &hits, &want, Shape::Line)
}

fn repeated<B: Backend>(cx: &Context<'_, B>) -> Check {
    let seen = soup(cx.options.seed ^ 31);
    let queries = some_queries(&seen, &mut Random::new(32), 3_000);
    let first = seen.answers(cx, &queries)?;
    exact(cx, "hits of a second call", &seen.answers(cx, &queries)?, &first, Shape::Line)
}
