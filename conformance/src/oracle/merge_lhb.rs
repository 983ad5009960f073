// kernel family: merge_lhb
// contract core/src/kernels/merge_lhb.rs
// cpu backend-cpu/src/kernels/merge_lhb.rs
// gpu backend-gpu/src/kernels/merge_lhb.wgsl
// oracle conformance/src/oracle/merge_lhb.rs
//! Oracle of `merge_lhb`: both lists in one, kept elements first, sorted by depth by a sort that leaves equals in their order. It
//! compares no two heads, knows no ranks, and counts in 64 bits.

use super::rasterize_lhb::Lists;
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::rasterize_lhb::{CAP_NEAR, LhbElement};

/// What the contract promises for sound parameters and lists in order of depth.
pub fn merge(kept: &Lists, added: &Lists, params: &MergeLhbParams) -> Lists {
    let whole: Vec<Vec<LhbElement>> =
        kept.each().zip(added.each()).map(|(kept, added)| union(kept, added, params)).collect();
    let cut: Vec<&[LhbElement]> = whole.iter().map(|list| within_cap(list, params)).collect();
    let left_out = |i: usize| {
        let before = [kept, added].map(|lists| u64::from(lists.left_out[i]));
        let beyond = (whole[i].len() - cut[i].len()) as u64;
        (before[0] + before[1] + beyond) as u32
    };
    let capped = if params.layer_cap > 0 { whole.len() } else { 0 };
    Lists { left_out: (0..capped).map(left_out).collect(), ..Lists::of(cut.iter().copied()) }
}

/// All of two lists.
fn union(kept: &[LhbElement], added: &[LhbElement], params: &MergeLhbParams) -> Vec<LhbElement> {
    let mut list = kept.to_vec();
    list.extend(added.iter().map(|e| LhbElement { surface: renumbered(e.surface, params), ..*e }));
    list.sort_by_key(|e| e.depth);
    list
}

/// Modulo 2³², by cutting off what is above.
fn renumbered(surface: u32, params: &MergeLhbParams) -> u32 {
    (u64::from(surface) + 2 * u64::from(params.first_triangle)) as u32
}

/// The end of a list that the cap keeps.
fn within_cap<'a>(list: &'a [LhbElement], params: &MergeLhbParams) -> &'a [LhbElement] {
    let most = if params.layer_cap == 0 { list.len() } else { list.len().min(params.layer_cap as usize) };
    if params.cap_side == CAP_NEAR { &list[..most] } else { &list[list.len() - most..] }
}

#[cfg(test)]
mod tests;
