//! Edge ladders, random lists and meshes, and what is refused.

use super::inputs::{from, made_up, some_queries};
use super::{Seen, both_ways};
use crate::kernels::property::hold;
use crate::kernels::rasterize_lhb::inputs::{
    Case, any_mesh, case, front, separate, snapped, some_directions, views,
};
use crate::oracle::query_lhb::NOTHING;
use crate::oracle::rasterize_lhb::Lists;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use proptest::prelude::*;
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::kernels::rasterize_lhb::{LhbBuffers, LhbElement};
use twinlight_core::lattice::LatticeMesh;
use twinlight_core::{Backend, Error};
use twinlight_fixtures::meshes;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "query_lhb":
        query_ladder, nothing_to_meet, views_beyond_the_last, random_lists, random_meshes, bad_lengths_are_refused,
        impossible_sizes_are_refused,
    );
}

/// Numbers of queries around every chunk or workgroup size a backend is likely to use.
fn query_ladder<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 1);
    let seen = Seen::new(snapped(&meshes::soup(200, 0.4, 5)), views(&some_directions(3, 2), 24), 24);
    for power in 0..=if cx.full() { 17 } else { 10 } {
        for count in [(1_usize << power) - 1, 1 << power, (1 << power) + 1] {
            seen.agrees(cx, &some_queries(&seen, &mut random, count))?;
        }
    }
    both_ways(&seen.answers(cx, &some_queries(&seen, &mut random, 1_000))?)
}

/// No triangle; no view; lines that miss what there is.
fn nothing_to_meet<B: Backend>(cx: &Context<'_, B>) -> Check {
    let aside = separate(&[[[9_000, 9_000, 9_000], [9_100, 9_000, 9_000], [9_000, 9_100, 9_050]]]);
    for mesh in [LatticeMesh::default(), aside] {
        for (count, size) in [(0, 1), (0, 64), (1, 1), (3, 7)] {
            let mut views = views(&some_directions(count, 3), size);
            views.truncate(count);
            let seen = Seen::new(mesh.clone(), views, size);
            let queries: Vec<LhbQuery> =
                (0..9).map(|ray| LhbQuery { leaves: 0, window: 1 << 30, ..from([-9_000; 3], ray) }).collect();
            let hits = seen.agreed(cx, &queries)?;
            let misses = hits.iter().filter(|hit| **hit == NOTHING).count();
            ensure(misses == hits.len(), || format!("{} hits", hits.len() - misses))?;
        }
    }
    Ok(())
}

/// A ray of a view that there is not meets nothing, whatever the number.
fn views_beyond_the_last<B: Backend>(cx: &Context<'_, B>) -> Check {
    let views = views(&some_directions(5, 6), 16);
    let seen = Seen::new(snapped(&meshes::icosphere(3)), views, 16);
    let rays = [8, 9, 10, 11, 12, 1 << 16, (1 << 31) - 1, 1 << 31, u32::MAX - 1, u32::MAX];
    let queries = rays.map(|ray| LhbQuery { window: 3, ..from([0; 3], ray) });
    let hits = seen.agreed(cx, &queries)?;
    let met: Vec<bool> = hits.iter().map(|hit| *hit != NOTHING).collect();
    let want: Vec<bool> = rays.iter().map(|ray| *ray < 10).collect();
    ensure(met == want, || format!("{met:?} of rays {rays:?}"))
}

fn random_lists<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, (any::<u64>(), 1..40_u32, 1..4_usize, 0..30_usize), |(seed, size, count, longest)| {
        let mut random = Random::new(seed);
        let seen = made_up(&mut random, count, size, longest);
        seen.agrees(cx, &some_queries(&seen, &mut random, 400))
    })
}

fn random_meshes<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, (case(any_mesh()), any::<u64>()), |(Case { mesh, views, params }, seed)| {
        let seen = Seen::new(mesh, views, params.size);
        seen.agrees(cx, &some_queries(&seen, &mut Random::new(seed), 400))
    })
}

/// Hits that are fewer or more than queries, and views that are not those of the lists.
fn bad_lengths_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let seen = Seen::new(snapped(&meshes::icosphere(2)), views(&some_directions(2, 4), 8), 8);
    let (mesh, lhb) = seen.uploaded(cx)?;
    let queries = cx.backend.upload(&[from([0; 3], 0); 5])?;
    let one_more = [seen.views.clone(), vec![front()]].concat();
    for (what, views, hits) in [
        ("fewer hits", seen.views.clone(), 4),
        ("more hits", seen.views.clone(), 6),
        ("no hits", seen.views.clone(), 0),
        ("a view too few", seen.views[..1].to_vec(), 5),
        ("no views", vec![], 5),
        ("a view too many", one_more, 5),
    ] {
        let stale = vec![LhbElement { surface: 9, depth: 9 }; hits];
        let mut hits = cx.backend.upload(&stale)?;
        match cx.backend.query_lhb(&mesh, &lhb, &views, &queries, &mut hits) {
            Err(Error::InvalidInput { .. }) => {}
            Err(Error::Unsupported(what)) => return Err(Failure::Skip(what)),
            other => return Err(Failure::Mismatch(format!("{what}: {other:?}, want InvalidInput"))),
        }
        let after = cx.backend.download(&hits)?;
        ensure(after == stale, || format!("{what}: refused, but {after:?}"))?;
    }
    // Nothing asked is nothing wrong.
    let empty = Seen { lists: Lists::of([]), views: vec![], ..seen };
    empty.agrees(cx, &[])
}

/// Buffers put together by hand, of no pixels, or of as many as fall on few modulo 2³² or 2⁶⁴, or on none.
fn impossible_sizes_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let seen = Seen::new(snapped(&meshes::icosphere(2)), views(&some_directions(4, 4), 8), 8);
    let mesh = cx.backend.upload_mesh(&seen.mesh)?;
    let queries = cx.backend.upload(&[from([0; 3], 0), from([0; 3], 1)])?;
    for size in [0, 1 << 16, 1 << 31, u32::MAX] {
        let lhb = LhbBuffers {
            size,
            view_count: 4,
            offsets: cx.backend.upload(&[0])?,
            elements: cx.backend.zeroed(0)?,
            left_out: cx.backend.zeroed(0)?,
        };
        let mut hits = cx.backend.zeroed(2)?;
        match cx.backend.query_lhb(&mesh, &lhb, &seen.views, &queries, &mut hits) {
            Err(Error::InvalidInput { .. } | Error::LimitExceeded { .. }) => {}
            Err(Error::Unsupported(what)) => return Err(Failure::Skip(what)),
            other => return Err(Failure::Mismatch(format!("size {size}: {other:?}"))),
        }
    }
    Ok(())
}
