// kernel family: query_lhb
// contract core/src/kernels/query_lhb.rs
// cpu backend-cpu/src/kernels/query_lhb.rs
// gpu backend-gpu/src/kernels/query_lhb.wgsl
// oracle conformance/src/oracle/query_lhb.rs
//! `query_lhb`: in the order in which the queries are given. Callers who sort them by view keep that view's lists in the
//! core's cache.

use crate::parallel::fill_chunks;
use crate::simd::{Isa, Kernel, Width, prefetch, prefetch_item};
use bytemuck::Zeroable;
use twinlight_core::kernels::query_lhb::{CLEARANCE, LhbQuery, NO_ELEMENT};
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_core::lattice::{LatticePlane, View};

mod front;
mod project;
#[cfg(test)]
mod tests;

use front::judge;
use project::{LANES, Places, project};

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

/// Queries per task: as many bytes as the first cache holds four times over.
const TASK: usize = 1 << 12;

/// Batches between the one that is looked up and the one that is fetched: a few memory latencies. The processor's own prefetching ends
/// at every page, which is every fourth batch.
const BATCHES_AHEAD: usize = 4;

/// Queries of a cache line of 64 bytes.
const QUERIES_PER_LINE: usize = 64 / size_of::<LhbQuery>();

const NOTHING: LhbElement = LhbElement { surface: NO_ELEMENT, depth: 0 };

pub(crate) fn query_lhb(isa: Isa, lhb: LhbData<'_>, queries: &[LhbQuery], hits: &mut [LhbElement]) {
    fill_chunks(isa, TASK, hits, |first, hits| Chunk { lhb, queries: &queries[first..][..hits.len()], hits });
}

struct Chunk<'a> {
    lhb: LhbData<'a>,
    queries: &'a [LhbQuery],
    hits: &'a mut [LhbElement],
}

impl Kernel for Chunk<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Width>(self, width: W) {
        let mut later = self.queries.chunks(BATCH).skip(BATCHES_AHEAD);
        for (queries, hits) in self.queries.chunks(BATCH).zip(self.hits.chunks_mut(BATCH)) {
            for line in later.next().unwrap_or_default().chunks(QUERIES_PER_LINE) {
                prefetch(&line[0]);
            }
            look_up(width, &self.lhb, queries, hits);
        }
    }
}

/// Where a list begins and ends.
#[derive(Debug, Clone, Copy, Default)]
struct Span {
    begin: u32,
    end: u32,
}

/// The elements that at most [`BATCH`] queries meet.
#[inline(always)]
pub(crate) fn look_up<W: Width>(width: W, lhb: &LhbData<'_>, queries: &[LhbQuery], hits: &mut [LhbElement]) {
    if let (Ok(queries), Ok(hits)) = (queries.try_into(), (&mut *hits).try_into()) {
        return look_up_batch(width, lhb, queries, hits);
    }
    let mut padded = [LhbQuery::zeroed(); BATCH];
    padded[..queries.len()].copy_from_slice(queries);
    let mut found = [NOTHING; BATCH];
    look_up_batch(width, lhb, &padded, &mut found);
    hits.copy_from_slice(&found[..hits.len()]);
}

/// In steps for all of them: each waits for memory, and waits of independent reads overlap. Few queries need more than the first
/// elements of their list: they are left for the end, so that the others take the same way and no processor has to guess it.
#[inline(always)]
fn look_up_batch<W: Width>(
    width: W,
    lhb: &LhbData<'_>,
    queries: &[LhbQuery; BATCH],
    hits: &mut [LhbElement; BATCH],
) {
    // [1] project
    let mut places = Places::default();
    project(width, lhb, queries, &mut places);
    let mut spans = [Span::default(); BATCH];
    for (span, &list) in spans.iter_mut().zip(&places.lists) {
        let list = list as usize;
        // Offsets of other buffers may point beyond these elements.
        if let Some(&[begin, end]) = lhb.offsets.get(list..list.wrapping_add(2))
            && end as usize <= lhb.elements.len()
        {
            *span = Span { begin, end };
            prefetch_item(lhb.elements, begin as usize);
        }
    }
    // [2] walk the list
    let mut pending = [0_u8; BATCH];
    let mut count = 0;
    for (group, reversed) in places.reversed.into_iter().enumerate() {
        for i in group * LANES..(group + 1) * LANES {
            let reversed = reversed.unwrap_or(queries[i].ray & 1);
            let (element, is_pending) = if reversed == 0 {
                judge::<W, 0>(width, lhb, &queries[i], places.depths[i], spans[i])
            } else {
                judge::<W, 1>(width, lhb, &queries[i], places.depths[i], spans[i])
            };
            hits[i] = element;
            pending[count] = i as u8;
            count += usize::from(is_pending);
        }
    }
    let pending = &pending[..count];
    for &i in pending {
        prefetch_item(lhb.planes, (hits[usize::from(i)].surface >> 1) as usize);
    }
    for &i in pending {
        let i = usize::from(i);
        let (query, span, depth) = (&queries[i], spans[i], places.depths[i] as i32);
        hits[i] = if query.ray & 1 == 0 {
            ahead::<0>(lhb, query, depth, span)
        } else {
            ahead::<1>(lhb, query, depth, span)
        };
    }
}

/// The first element of a list that lies ahead; the last, for `REVERSED` 1.
#[inline(always)]
fn ahead<const REVERSED: u32>(lhb: &LhbData<'_>, query: &LhbQuery, depth: i32, list: Span) -> LhbElement {
    // Offsets of other buffers may point beyond these.
    let Some(elements) = lhb.elements.get(list.begin as usize..list.end as usize) else { return NOTHING };
    let window = query.window as i32;
    for i in 0..elements.len() {
        let element = elements[if REVERSED == 0 { i } else { elements.len() - 1 - i }];
        let away = (element.depth as i32).wrapping_sub(depth);
        let ahead = if REVERSED == 0 { away } else { away.wrapping_neg() };
        let seen = LhbElement { surface: element.surface ^ REVERSED, ..element };
        let changed = seen.surface ^ query.leaves;
        let is_candidate = ahead >= -window && changed & 1 == 0 && changed != 0;
        if ahead > window || (is_candidate && is_before(lhb, query, seen.surface)) {
            return seen;
        }
    }
    NOTHING
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
