//! Fragments into sorted lists.

use super::setup::element;
use super::{Ends, Fragment, ViewLists};
use twinlight_core::kernels::rasterize_lhb::{CAP_NEAR, RasterizeLhbParams};

/// Lists up to this long are sorted by insertion.
const SHORT: usize = 24;

/// Pixels for each fragment from which on there are few.
const SPARSE: usize = 32;

/// Working memory.
#[derive(Debug, Default)]
pub(super) struct Lists {
    /// Per pixel: first a count, then where the next fragment goes, which ends as where the list ends.
    cursors: Vec<u32>,
    keys: Vec<u64>,
}

impl Lists {
    /// Sorts fragments into lists.
    #[inline(always)]
    pub(super) fn sort(&mut self, fragments: &mut [Fragment], params: &RasterizeLhbParams) -> ViewLists {
        let pixels = params.size as usize * params.size as usize;
        // With a cap, every pixel is visited anyway: it has a number of elements left out.
        if params.layer_cap == 0 && fragments.len() < pixels / SPARSE {
            return few_lists(fragments);
        }
        self.sort_by_pixel(fragments, pixels);
        self.finish(params)
    }

    /// Counts, scans, scatters and sorts.
    #[inline(always)]
    fn sort_by_pixel(&mut self, fragments: &[Fragment], pixels: usize) {
        self.cursors.clear();
        self.cursors.resize(pixels, 0);
        for fragment in fragments {
            self.cursors[fragment.pixel as usize] += 1;
        }
        let mut sum = 0;
        for cursor in &mut self.cursors {
            sum += std::mem::replace(cursor, sum);
        }
        self.keys.resize(fragments.len(), 0);
        for fragment in fragments {
            let cursor = &mut self.cursors[fragment.pixel as usize];
            self.keys[*cursor as usize] = fragment.key;
            *cursor += 1;
        }
        let mut begin = 0;
        for &end in &self.cursors {
            sort_list(&mut self.keys[begin..end as usize]);
            begin = end as usize;
        }
    }

    /// Applies the cap.
    fn finish(&self, params: &RasterizeLhbParams) -> ViewLists {
        if params.layer_cap == 0 {
            let elements = self.keys.iter().map(|&key| element(key)).collect();
            return ViewLists { ends: Ends::All(self.cursors.clone()), elements, left_out: Vec::new() };
        }
        let (mut elements, mut left_out) = (Vec::new(), Vec::new());
        let mut ends = Vec::with_capacity(self.cursors.len());
        let mut begin = 0;
        for &end in &self.cursors {
            let list = &self.keys[begin..end as usize];
            let kept = list.len().min(params.layer_cap as usize);
            let kept = if params.cap_side == CAP_NEAR { &list[..kept] } else { &list[list.len() - kept..] };
            elements.extend(kept.iter().map(|&key| element(key)));
            ends.push(elements.len() as u32);
            left_out.push((list.len() - kept.len()) as u32);
            begin = end as usize;
        }
        ViewLists { ends: Ends::All(ends), elements, left_out }
    }
}

/// Lists made by comparing: what an object covers in a view should not cost a visit of every pixel.
fn few_lists(fragments: &mut [Fragment]) -> ViewLists {
    fragments.sort_unstable_by_key(|fragment| (fragment.pixel, fragment.key));
    let elements = fragments.iter().map(|fragment| element(fragment.key)).collect();
    let mut ends: Vec<[u32; 2]> = Vec::new();
    for (i, fragment) in fragments.iter().enumerate() {
        let end = i as u32 + 1;
        match ends.last_mut() {
            Some(last) if last[0] == fragment.pixel => last[1] = end,
            _ => ends.push([fragment.pixel, end]),
        }
    }
    ViewLists { ends: Ends::Few(ends), elements, left_out: Vec::new() }
}

#[inline(always)]
fn sort_list(keys: &mut [u64]) {
    if keys.len() > SHORT {
        keys.sort_unstable();
        return;
    }
    for i in 1..keys.len() {
        let key = keys[i];
        let mut place = i;
        while place > 0 && keys[place - 1] > key {
            keys[place] = keys[place - 1];
            place -= 1;
        }
        keys[place] = key;
    }
}
