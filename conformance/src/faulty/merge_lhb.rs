//! Bugs in `merge_lhb`: a merge on the host, wrong in one step.

use crate::faults::Fault;
use crate::oracle::rasterize_lhb::Lists;
use std::sync::{Mutex, PoisonError};
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::rasterize_lhb::{CAP_NEAR, Lhb, LhbBuffers, LhbElement};
use twinlight_core::{Backend, Result};

/// What the call before added: what a merge that reads a stale buffer would add again.
pub(super) type Previous = Mutex<Option<Lists>>;

pub(super) fn merge_lhb<B: Backend>(
    inner: &B,
    fault: Fault,
    previous: &Previous,
    kept: &Lhb<B>,
    added: &Lhb<B>,
    params: &MergeLhbParams,
) -> Result<Lhb<B>> {
    let sound = inner.merge_lhb(kept, added, params);
    let fit = params.check(kept, added, |buffer| inner.len(buffer)).is_ok();
    let lists = if fault == Fault::MergeAcceptsAnything && !fit {
        Lists::of([])
    } else if fault.sits_in("merge_lhb") && fit {
        let [on_host, of_added] = [host(inner, kept)?, host(inner, added)?];
        // Bugs must show in sound lists: those of other origin are left to the sound backend.
        if fault != Fault::MergeTrustsOffsets && !(are_lists(&on_host) && are_lists(&of_added)) {
            return sound;
        }
        let of_added = if fault == Fault::MergeStale { stale(previous, of_added) } else { of_added };
        Broken { fault, size: kept.size as usize, params, kept: &on_host, added: &of_added }.merged()
    } else {
        return sound;
    };
    Ok(LhbBuffers {
        size: kept.size,
        view_count: kept.view_count,
        offsets: inner.upload(&lists.offsets)?,
        elements: inner.upload(&lists.elements)?,
        left_out: inner.upload(&lists.left_out)?,
    })
}

/// The lists of a device.
pub(super) fn host<B: Backend>(inner: &B, lhb: &Lhb<B>) -> Result<Lists> {
    Ok(Lists {
        offsets: inner.download(&lhb.offsets)?,
        elements: inner.download(&lhb.elements)?,
        left_out: inner.download(&lhb.left_out)?,
    })
}

/// Whether offsets rise from 0 to the number of elements.
pub(super) fn are_lists(lists: &Lists) -> bool {
    let ends = (lists.offsets.first(), lists.offsets.last());
    ends == (Some(&0), Some(&(lists.elements.len() as u32))) && lists.offsets.is_sorted()
}

/// What was added before, where it has the shape of what is added now.
fn stale(previous: &Previous, added: Lists) -> Lists {
    let mut previous = previous.lock().unwrap_or_else(PoisonError::into_inner);
    let shape = |lists: &Lists| (lists.offsets.len(), lists.left_out.len());
    let before = previous.replace(added.clone());
    before.filter(|before| shape(before) == shape(&added)).unwrap_or(added)
}

struct Broken<'a> {
    fault: Fault,
    size: usize,
    params: &'a MergeLhbParams,
    kept: &'a Lists,
    added: &'a Lists,
}

impl Broken<'_> {
    fn merged(&self) -> Lists {
        let [kept, added]: [Vec<&[LhbElement]>; 2] =
            [self.kept, self.added].map(|lists| lists.each().collect());
        let (mut lists, mut left_out) = (Vec::new(), Vec::new());
        for i in 0..kept.len() {
            let whole = self.union(kept[i], added[self.other(i, added.len())]);
            let cut = self.within_cap(&whole);
            if self.params.layer_cap > 0 {
                left_out.push(self.left_out(i, (whole.len() - cut.len()) as u32));
            }
            lists.push(cut.to_vec());
        }
        Lists { left_out, ..Lists::of(lists.iter().map(Vec::as_slice)) }
    }

    /// Whose list is added to the i-th.
    fn other(&self, i: usize, count: usize) -> usize {
        let pixels = self.size * self.size;
        match self.fault {
            Fault::MergeNeighbour => (i + 1) % count,
            Fault::MergeTransposed => {
                i / pixels * pixels + i % self.size * self.size + i % pixels / self.size
            }
            Fault::MergeFirstViewOnly => i % pixels,
            _ => i,
        }
    }

    fn union(&self, kept: &[LhbElement], added: &[LhbElement]) -> Vec<LhbElement> {
        let added: Vec<LhbElement> =
            added.iter().map(|e| LhbElement { surface: self.renumbered(e.surface), ..*e }).collect();
        let mut list = kept.to_vec();
        if self.fault == Fault::MergeRenumbersAll {
            list.iter_mut().for_each(|e| e.surface = self.renumbered(e.surface));
        }
        match self.fault {
            Fault::MergeLosesCommonLast if !kept.is_empty() => {
                list.extend(&added[..added.len().saturating_sub(1)])
            }
            Fault::MergeEndsWithKept => {
                let last = kept.last().map_or(u32::MAX, |e| e.depth);
                list.extend(added.iter().take_while(|e| e.depth <= last));
            }
            Fault::MergeLosesLoneAdded if kept.is_empty() => {}
            Fault::MergeCopiesLoneAdded if self.kept.elements.is_empty() => {
                list.extend(added.iter().map(|e| {
                    let back = self.params.first_triangle.wrapping_mul(2);
                    LhbElement { surface: e.surface.wrapping_sub(back), ..*e }
                }))
            }
            _ => list.extend(&added),
        }
        match self.fault {
            Fault::MergeAppends => {}
            Fault::MergeTiesToAdded => {
                list.rotate_left(kept.len());
                list.sort_by_key(|e| e.depth);
            }
            Fault::MergeTiesByNumber => list.sort_by_key(|e| (e.depth, e.triangle())),
            Fault::MergeSigned => list.sort_by_key(|e| e.depth as i32),
            Fault::MergeDropsCopies => {
                list.sort_by_key(|e| e.depth);
                list.dedup_by_key(|e| e.depth);
            }
            Fault::MergeLongUnsorted if list.len() > 65_536 => list[..65_536].sort_by_key(|e| e.depth),
            _ => list.sort_by_key(|e| e.depth),
        }
        list
    }

    fn renumbered(&self, surface: u32) -> u32 {
        let first = self.params.first_triangle;
        match self.fault {
            Fault::MergeNotRenumbered => surface,
            Fault::MergeRenumbersOffByOne => surface.wrapping_add(2 * first).wrapping_sub(2),
            Fault::MergeRenumbersSurfaces => surface.wrapping_add(first),
            Fault::MergeLosesFacing => (surface & !1).wrapping_add(2 * first),
            Fault::MergeSaturates => surface.saturating_add(2 * first),
            _ => surface.wrapping_add(2 * first),
        }
    }

    fn within_cap<'a>(&self, list: &'a [LhbElement]) -> &'a [LhbElement] {
        let cap = self.params.layer_cap as usize;
        let most = match self.fault {
            Fault::MergeIgnoresCap => list.len(),
            Fault::MergeCapOff if cap > 1 => cap - 1,
            Fault::MergeCapPerPart => 2 * cap,
            _ => cap,
        };
        let most = if cap == 0 { list.len() } else { most.min(list.len()) };
        let near = match self.fault {
            Fault::MergeCapKeepsNear => true,
            Fault::MergeCapKeepsFar => false,
            _ => self.params.cap_side == CAP_NEAR,
        };
        if near { &list[..most] } else { &list[list.len() - most..] }
    }

    fn left_out(&self, i: usize, cut: u32) -> u32 {
        let (kept, added) = (self.kept.left_out[i], self.added.left_out[i]);
        match self.fault {
            Fault::MergeForgetsLeftOutOfAdded => kept.wrapping_add(cut),
            Fault::MergeForgetsLeftOutOfKept => added.wrapping_add(cut),
            Fault::MergeForgetsWhatItCuts => kept.wrapping_add(added),
            Fault::MergeLeftOutSaturates => kept.saturating_add(added).saturating_add(cut),
            _ => kept.wrapping_add(added).wrapping_add(cut),
        }
    }
}
