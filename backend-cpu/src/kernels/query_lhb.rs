// kernel family: query_lhb
// contract core/src/kernels/query_lhb.rs
// cpu backend-cpu/src/kernels/query_lhb.rs
// gpu backend-gpu/src/kernels/query_lhb.wgsl
// oracle conformance/src/oracle/query_lhb.rs
//! `query_lhb`: in the order in which the queries are given. Callers who sort them by view keep that view's lists in the
//! core's cache.

use crate::parallel::fill_chunks;
use crate::simd::{Isa, Kernel, Width, prefetch};
use twinlight_core::kernels::query_lhb::{CLEARANCE, LhbQuery, NO_ELEMENT};
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_core::lattice::{DEPTH_ORIGIN, LatticePlane, View};

/// Layered hit buffers and what queries need beside them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LhbData<'a> {
    pub(crate) size: u32,
    /// Sub-pixel bits.
    pub(crate) bits: u32,
    pub(crate) views: &'a [View],
    pub(crate) offsets: &'a [u32],
    pub(crate) elements: &'a [LhbElement],
    pub(crate) planes: &'a [LatticePlane],
}

/// Queries that are looked up side by side: more than memory serves at once.
pub(crate) const BATCH: usize = 32;

/// Elements of a list that are judged side by side.
const GROUP: usize = 4;

const NOTHING: LhbElement = LhbElement { surface: NO_ELEMENT, depth: 0 };

pub(crate) fn query_lhb(isa: Isa, lhb: LhbData<'_>, queries: &[LhbQuery], hits: &mut [LhbElement]) {
    fill_chunks(isa, hits, |first, hits| Chunk { lhb, queries: &queries[first..][..hits.len()], hits });
}

struct Chunk<'a> {
    lhb: LhbData<'a>,
    queries: &'a [LhbQuery],
    hits: &'a mut [LhbElement],
}

impl Kernel for Chunk<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Width>(self, _: W) {
        for (queries, hits) in self.queries.chunks(BATCH).zip(self.hits.chunks_mut(BATCH)) {
            look_up(&self.lhb, queries, hits);
        }
    }
}

/// Where a query's list is.
#[derive(Debug, Clone, Copy, Default)]
struct Place {
    /// Number of the list, and then where it begins and ends.
    list: u32,
    begin: u32,
    end: u32,
    /// The position's depth.
    z: i32,
}

/// The elements that at most [`BATCH`] queries meet, in steps for all of them: each waits for memory, and waits of independent
/// reads overlap.
#[inline(always)]
pub(crate) fn look_up(lhb: &LhbData<'_>, queries: &[LhbQuery], hits: &mut [LhbElement]) {
    let mut places = [Place::default(); BATCH];
    // [1] project
    for (query, place) in queries.iter().zip(&mut places) {
        *place = project(lhb, query);
        if let Some(offset) = lhb.offsets.get(place.list as usize) {
            prefetch(offset);
        }
    }
    for place in places.iter_mut().take(queries.len()) {
        let list = place.list as usize;
        if let Some(&[begin, end]) = lhb.offsets.get(list..).and_then(|rest| rest.first_chunk()) {
            (place.begin, place.end) = (begin, end);
            if let Some(element) = lhb.elements.get(begin as usize) {
                prefetch(element);
            }
        }
    }
    // [2] walk the list
    for ((query, place), hit) in queries.iter().zip(&places).zip(hits) {
        *hit = if query.ray & 1 == 0 { ahead::<0>(lhb, query, place) } else { ahead::<1>(lhb, query, place) };
    }
}

/// The number of a query's list, beyond all for a view that there isn't.
#[inline(always)]
fn project(lhb: &LhbData<'_>, query: &LhbQuery) -> Place {
    let number = query.ray >> 1;
    let Some(view) = lhb.views.get(number as usize) else {
        return Place { list: u32::MAX, ..Place::default() };
    };
    let bits = lhb.bits;
    let middle = ((lhb.size << (bits + 14)) + (1 << 14)) as i32;
    let edge = (lhb.size << bits) as i32 - 1;
    let x = ((dot(view.right, query.position).wrapping_add(middle)) >> 15).wrapping_add(query.offset[0]);
    let y = ((dot(view.down, query.position).wrapping_add(middle)) >> 15).wrapping_add(query.offset[1]);
    let z = dot(view.forward, query.position).wrapping_add(DEPTH_ORIGIN);
    let (column, row) = (x.clamp(0, edge) as u32 >> bits, y.clamp(0, edge) as u32 >> bits);
    Place { list: (number * lhb.size + row) * lhb.size + column, begin: 0, end: 0, z }
}

/// The first element of a list that lies ahead; the last, for `REVERSED` 1. Lists are read a group at a time: most end in the
/// first, and no processor foresees at which of its elements.
#[inline(always)]
fn ahead<const REVERSED: u32>(lhb: &LhbData<'_>, query: &LhbQuery, place: &Place) -> LhbElement {
    let (mut begin, mut end) = (place.begin as usize, place.end as usize);
    while begin < end {
        let count = (end - begin).min(GROUP);
        let from = if REVERSED == 0 { begin } else { end - count };
        let mut group = [NOTHING; GROUP];
        // The copy of a whole group is one load. What follows the list is masked.
        match lhb.elements.get(from..from + GROUP) {
            Some(elements) => group.copy_from_slice(elements),
            None => {
                // Offsets of other buffers may point beyond these.
                let Some(elements) = lhb.elements.get(from..from + count) else { return NOTHING };
                group[..count].copy_from_slice(elements);
            }
        }
        let (beyond, candidates) = sorted_out::<REVERSED>(query, place.z, &group);
        let mut left = (beyond | candidates) & ((1 << count) - 1);
        while left != 0 {
            let i = if REVERSED == 0 { left.trailing_zeros() } else { 31 - left.leading_zeros() };
            let LhbElement { surface, depth } = group[i as usize];
            let seen = LhbElement { surface: surface ^ REVERSED, depth };
            if beyond >> i & 1 == 1 || is_before(lhb, query, seen.surface) {
                return seen;
            }
            left &= !(1 << i);
        }
        if REVERSED == 0 {
            begin += count;
        } else {
            end -= count;
        }
    }
    NOTHING
}

/// Which elements lie beyond the window, and which lie in it, are not of the triangle that is left, and show the side that was
/// left.
#[inline(always)]
fn sorted_out<const REVERSED: u32>(query: &LhbQuery, z: i32, group: &[LhbElement; GROUP]) -> (u32, u32) {
    let window = query.window as i32;
    let (mut beyond, mut candidates) = (0, 0);
    for (i, element) in group.iter().enumerate() {
        let ahead = if REVERSED == 0 { element.depth as i32 - z } else { z - element.depth as i32 };
        let changed = element.surface ^ REVERSED ^ query.leaves;
        let is_candidate = (ahead >= -window) & (changed & 1 == 0) & (changed >> 1 != 0);
        beyond |= u32::from(ahead > window) << i;
        candidates |= u32::from(is_candidate) << i;
    }
    (beyond, candidates)
}

/// Whether the query's position is before the plane of a surface, on the side that it shows.
#[inline(always)]
fn is_before(lhb: &LhbData<'_>, query: &LhbQuery, surface: u32) -> bool {
    let Some(plane) = lhb.planes.get((surface >> 1) as usize) else { return false };
    let [x, y, z] = plane.normal.map(i32::from);
    let side = dot([x, y, z, 0], query.position).wrapping_sub(plane.offset);
    if surface & 1 == 1 { side > CLEARANCE } else { side < -CLEARANCE }
}

#[inline(always)]
fn dot(row: [i32; 4], p: [i32; 3]) -> i32 {
    let sum = row[0].wrapping_mul(p[0]).wrapping_add(row[1].wrapping_mul(p[1]));
    sum.wrapping_add(row[2].wrapping_mul(p[2]))
}
