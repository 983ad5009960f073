//! Where queries' lists are.

use super::{BATCH, LhbData, dot};
use crate::simd::{Width, Words};
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::lattice::{DEPTH_ORIGIN, View};

/// Queries that are projected side by side.
pub(super) const LANES: usize = 8;

/// Where the lists of a batch of queries are.
#[derive(Debug, Default)]
pub(super) struct Places {
    /// Number of the list, beyond all for a view that there isn't.
    pub(super) lists: [u32; BATCH],
    /// The position's depth.
    pub(super) depths: [u32; BATCH],
    /// 1 for [`LANES`] queries that all look towards the viewer, 0 for as many that look away.
    pub(super) reversed: [Option<u32>; BATCH / LANES],
}

/// Projects a batch, eight at a time where they look along one view, as neighbours in a sorted order do. `places` is a new one: one that
/// is returned is copied.
#[inline(always)]
pub(super) fn project<W: Width>(
    width: W,
    lhb: &LhbData<'_>,
    queries: &[LhbQuery; BATCH],
    places: &mut Places,
) {
    let (eights, _) = queries.as_chunks::<LANES>();
    for (group, queries) in eights.iter().enumerate() {
        let first = group * LANES;
        let lists = &mut places.lists[first..first + LANES];
        let depths = &mut places.depths[first..first + LANES];
        if project_eight(width, lhb, queries, lists, depths) {
            places.reversed[group] = Some(queries[0].ray & 1);
        } else {
            for (i, query) in queries.iter().enumerate() {
                (lists[i], depths[i]) = project_one(lhb, query);
            }
        }
    }
}

/// Projects eight queries of one ray; false, and nothing done, for others.
#[inline(always)]
fn project_eight<W: Width>(
    width: W,
    lhb: &LhbData<'_>,
    queries: &[LhbQuery; LANES],
    lists: &mut [u32],
    depths: &mut [u32],
) -> bool {
    let &[a, b, c, d, e, f, g, h]: &[[u32; LANES]; LANES] = bytemuck::cast_ref(queries);
    let number = queries[0].ray >> 1;
    let Some(view) = lhb.views.get(number as usize) else { return false };
    let [px, py, pz, ray, right, down, ..] = W::U8::transpose([
        W::U8::load(width, &a),
        W::U8::load(width, &b),
        W::U8::load(width, &c),
        W::U8::load(width, &d),
        W::U8::load(width, &e),
        W::U8::load(width, &f),
        W::U8::load(width, &g),
        W::U8::load(width, &h),
    ]);
    if ray.equal(W::U8::splat(width, queries[0].ray)) != 0xff {
        return false;
    }
    let position = [px, py, pz];
    let middle = W::U8::splat(width, middle(lhb));
    let edge = W::U8::splat(width, edge(lhb));
    let x = (dots(width, view.right, position) + middle).shift_right_signed::<15>() + right;
    let y = (dots(width, view.down, position) + middle).shift_right_signed::<15>() + down;
    let z = dots(width, view.forward, position) + W::U8::splat(width, DEPTH_ORIGIN as u32);
    let column = x.clamp_signed(edge).shift_right_by(lhb.bits);
    let row = y.clamp_signed(edge).shift_right_by(lhb.bits);
    let size = W::U8::splat(width, lhb.size);
    let list = (W::U8::splat(width, number * lhb.size) + row) * size + column;
    lists.copy_from_slice(&list.to_array());
    depths.copy_from_slice(&z.to_array());
    true
}

#[inline(always)]
fn dots<W: Width>(width: W, row: [i32; 4], [x, y, z]: [W::U8; 3]) -> W::U8 {
    let a = W::U8::splat(width, row[0] as u32) * x;
    let b = W::U8::splat(width, row[1] as u32) * y;
    let c = W::U8::splat(width, row[2] as u32) * z;
    (a + b) + c
}

/// A query's list and depth.
#[inline(always)]
fn project_one(lhb: &LhbData<'_>, query: &LhbQuery) -> (u32, u32) {
    let number = query.ray >> 1;
    let Some(view) = lhb.views.get(number as usize) else { return (u32::MAX, 0) };
    let x = on_screen(lhb, view.right, query.position).wrapping_add(query.offset[0]);
    let y = on_screen(lhb, view.down, query.position).wrapping_add(query.offset[1]);
    let edge = edge(lhb) as i32;
    let (column, row) = (x.clamp(0, edge) as u32 >> lhb.bits, y.clamp(0, edge) as u32 >> lhb.bits);
    ((number * lhb.size + row) * lhb.size + column, depth(view, query))
}

/// Depth of a query's position in its view.
#[inline(always)]
fn depth(view: &View, query: &LhbQuery) -> u32 {
    dot(view.forward, query.position).wrapping_add(DEPTH_ORIGIN) as u32
}

#[inline(always)]
fn on_screen(lhb: &LhbData<'_>, row: [i32; 4], position: [i32; 3]) -> i32 {
    dot(row, position).wrapping_add(middle(lhb) as i32) >> 15
}

/// What brings the middle of the screen to that of the image, and rounds, before the shift by 15.
#[inline(always)]
fn middle(lhb: &LhbData<'_>) -> u32 {
    (lhb.size << (lhb.bits + 14)) + (1 << 14)
}

/// The last screen coordinate of the image.
#[inline(always)]
fn edge(lhb: &LhbData<'_>) -> u32 {
    (lhb.size << lhb.bits) - 1
}
