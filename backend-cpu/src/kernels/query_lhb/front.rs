//! The elements that a list is read from first, judged side by side.

use super::{LhbData, NOTHING, Span};
use crate::simd::{Width, Words};
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::kernels::rasterize_lhb::LhbElement;

/// Elements that are judged side by side: with surface and depth they fill one vector.
pub(super) const GROUP: usize = 4;

/// The lanes of surfaces.
const SURFACES: u32 = 0b0101_0101;

/// What the first elements of a list say; the last, for `REVERSED` 1: what is met, as the query sees it, and whether that is still to be
/// decided, by the plane of this element's triangle or by what follows. `depth` is the query's.
#[inline(always)]
pub(super) fn judge<W: Width, const REVERSED: u32>(
    width: W,
    lhb: &LhbData<'_>,
    query: &LhbQuery,
    depth: u32,
    list: Span,
) -> (LhbElement, bool) {
    let (begin, end) = (list.begin as usize, list.end as usize);
    let count = end.saturating_sub(begin).min(GROUP);
    let from = if REVERSED == 0 { begin } else { end - count };
    // What follows the list is masked. Only the last lists of all have nothing behind them.
    let Some(group) = lhb.elements.get(from..from + GROUP) else { return (NOTHING, true) };
    let lanes: &[u32] = bytemuck::cast_slice(group);
    let Some(lanes) = lanes.first_chunk() else { return (NOTHING, true) };
    let lanes = W::U8::load(width, lanes);
    // Sums stay within 32 bits: depths are below 2³⁰, and windows at most that.
    let farther = lanes.greater_signed(W::U8::splat(width, depth.wrapping_add(query.window)));
    let nearer = W::U8::splat(width, depth.wrapping_sub(query.window)).greater_signed(lanes);
    let (beyond, behind) = if REVERSED == 0 { (farther, nearer) } else { (nearer, farther) };
    // Surfaces that differ from what is left in their triangle, and not in their side.
    let changed = lanes ^ W::U8::splat(width, query.leaves ^ REVERSED);
    let zero = W::U8::splat(width, 0);
    let others = (changed & W::U8::splat(width, 1)).equal(zero) & !changed.equal(zero);
    // Depths are in the lanes behind their surfaces.
    let beyond = beyond >> 1;
    let there = SURFACES & ((1 << (2 * count)) - 1);
    let matters = (beyond | (others & !(behind >> 1))) & there;
    if matters == 0 {
        return (NOTHING, end.saturating_sub(begin) > GROUP);
    }
    let lane = if REVERSED == 0 { matters.trailing_zeros() } else { 31 - matters.leading_zeros() };
    let LhbElement { surface, depth } = group[(lane / 2) as usize % GROUP];
    (LhbElement { surface: surface ^ REVERSED, depth }, beyond >> lane & 1 == 0)
}
