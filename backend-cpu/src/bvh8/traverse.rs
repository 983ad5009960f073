//! Closest hit and any hit.

use super::node::{LEAF, NodeRay};
use super::pack::{PACK, PackHits, PackRay};
use super::{MAX_STACK, NO_SLOT, Node, Pack, SlotHit, Visits, WideBvh};
use crate::simd::{Lanes, Portable, Width};
use glam::Vec3;
use std::mem::MaybeUninit;
use twinlight_core::transport::intersect::ray_frame;

/// Children still to visit: the entry parameter's bits above, the reference below. Entries are not negative, so the
/// order of the integers is the order of the entries.
struct Stack<'a> {
    entries: &'a mut Entries,
    len: usize,
}

/// Memory of a stack. Apart from [`Stack`], because a struct that is partly initialised is set to 0 as a whole, 4 KiB
/// per ray.
type Entries = [MaybeUninit<u64>; MAX_STACK];

impl<'a> Stack<'a> {
    #[inline(always)]
    fn new(entries: &'a mut Entries) -> Self {
        Stack { entries, len: 0 }
    }

    #[inline(always)]
    fn push(&mut self, entry: u64) {
        debug_assert!(self.len < MAX_STACK);
        // SAFETY: a node's children are pushed after the node left the stack, so per level seven remain at most, and
        // construction bounds the levels (`MAX_LEVELS`).
        unsafe { self.entries.get_unchecked_mut(self.len) }.write(entry);
        self.len += 1;
    }

    #[inline(always)]
    fn get(&self, index: usize) -> u64 {
        debug_assert!(index < self.len);
        // SAFETY: entries below `len` were written by `push`.
        unsafe { self.entries.get_unchecked(index).assume_init() }
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<u64> {
        if self.len == 0 {
            return None;
        }
        let entry = self.get(self.len - 1);
        self.len -= 1;
        Some(entry)
    }

    /// Moves the last entry down to where it belongs in the descending run that starts at `base`.
    #[inline(always)]
    fn sink_last(&mut self, base: usize) {
        let mut at = self.len - 1;
        let entry = self.get(at);
        while at > base && self.get(at - 1) < entry {
            let smaller = self.get(at - 1);
            // SAFETY: `at` is below `len`, which is at most the array's length.
            unsafe { self.entries.get_unchecked_mut(at) }.write(smaller);
            at -= 1;
        }
        // SAFETY: as above.
        unsafe { self.entries.get_unchecked_mut(at) }.write(entry);
    }
}

/// The best hit so far.
struct Best {
    t: f32,
    /// Edge functions over `determinant` are the weights: divided once per ray, not once per improvement.
    v: f32,
    w: f32,
    determinant: f32,
    /// pack · PACK + lane.
    lane: u32,
}

impl WideBvh {
    #[inline(always)]
    fn node(&self, reference: u32) -> &Node {
        debug_assert!((reference as usize) < self.nodes.len());
        // SAFETY: construction writes only references to nodes that exist, and 0 always does.
        unsafe { self.nodes.get_unchecked(reference as usize) }
    }

    #[inline(always)]
    fn pack(&self, reference: u32) -> (u32, &Pack) {
        let index = reference & !LEAF;
        debug_assert!((index as usize) < self.packs.len());
        // SAFETY: construction writes only references to packs that exist.
        (index, unsafe { self.packs.get_unchecked(index as usize) })
    }

    /// The closest triangle with `t_min < t ≤ t_max`; of several at the same t, the one with the lowest id.
    #[inline(always)]
    pub fn closest<W: Width>(
        &self,
        width: W,
        origin: Vec3,
        direction: Vec3,
        t_min: f32,
        t_max: f32,
    ) -> SlotHit {
        self.closest_counting(width, origin, direction, t_min, t_max, |_| {})
    }

    /// [`WideBvh::closest`], telling `count` of every node (true) and pack (false) it visits.
    #[inline(always)]
    fn closest_counting<W: Width>(
        &self,
        width: W,
        origin: Vec3,
        direction: Vec3,
        t_min: f32,
        t_max: f32,
        mut count: impl FnMut(bool),
    ) -> SlotHit {
        let frame = ray_frame(origin, direction);
        let node_ray = NodeRay::new(width, origin, frame.inverse);
        let pack_ray = PackRay::new(width, &frame, t_min);
        let mut best = Best { t: t_max, v: 0.0, w: 0.0, determinant: 1.0, lane: NO_SLOT };
        let mut entries: Entries = [MaybeUninit::uninit(); MAX_STACK];
        let mut stack = Stack::new(&mut entries);
        let mut current = 0_u32;
        loop {
            if current & LEAF == 0 {
                count(true);
                let node = self.node(current);
                let (mask, enter) = node_ray.meet(width, node, best.t);
                if let Some(child) = nearest_child(&mut stack, node, mask, enter) {
                    current = child;
                    continue;
                }
            } else {
                count(false);
                let (index, pack) = self.pack(current);
                if let Some(hits) = pack_ray.meet(width, pack, best.t) {
                    self.improve(&mut best, index, &hits);
                }
            }
            current = loop {
                let Some(entry) = stack.pop() else {
                    return self.slot_hit(&best);
                };
                if f32::from_bits((entry >> 32) as u32) <= best.t {
                    break entry as u32;
                }
            };
        }
    }

    /// Whether any triangle has `t_min < t ≤ t_max`.
    #[inline(always)]
    pub fn occluded<W: Width>(
        &self,
        width: W,
        origin: Vec3,
        direction: Vec3,
        t_min: f32,
        t_max: f32,
    ) -> bool {
        let frame = ray_frame(origin, direction);
        let node_ray = NodeRay::new(width, origin, frame.inverse);
        let pack_ray = PackRay::new(width, &frame, t_min);
        let mut entries: Entries = [MaybeUninit::uninit(); MAX_STACK];
        let mut stack = Stack::new(&mut entries);
        stack.push(0);
        // No order: what is met first ends the search, and packs, which may end it, are tested before nodes.
        while let Some(reference) = stack.pop() {
            let node = self.node(reference as u32);
            let (mask, _) = node_ray.meet(width, node, t_max);
            let mut packs = mask & node.packs;
            while packs != 0 {
                let (_, pack) = self.pack(take_child(node, &mut packs));
                if let Some(hits) = pack_ray.meet(width, pack, t_max)
                    && hits.mask != 0
                {
                    return true;
                }
            }
            let mut nodes = mask & !node.packs;
            while nodes != 0 {
                stack.push(u64::from(take_child(node, &mut nodes)));
            }
        }
        false
    }

    /// Takes over what is nearer, or as near with a lower id.
    #[inline(always)]
    fn improve<W: Width>(&self, best: &mut Best, index: u32, hits: &PackHits<W>) {
        let mut mask = hits.mask;
        if mask == 0 {
            return;
        }
        let t = hits.t.to_array();
        let edges = hits.edges.map(|lanes| lanes.to_array());
        while mask != 0 {
            let i = mask.trailing_zeros() as usize & (PACK - 1);
            mask &= mask - 1;
            let lane = index * PACK as u32 + i as u32;
            let (t, [u, v, w]) = (t[i], [edges[0][i], edges[1][i], edges[2][i]]);
            let tie = t == best.t && (best.lane == NO_SLOT || self.id(lane) < self.id(best.lane));
            if t < best.t || tie {
                *best = Best { t, v, w, determinant: (u + v) + w, lane };
            }
        }
    }

    #[inline(always)]
    fn id(&self, lane: u32) -> u32 {
        self.ids[lane as usize]
    }

    #[inline(always)]
    fn slot_hit(&self, best: &Best) -> SlotHit {
        let slot = self.slots.get(best.lane as usize).copied().unwrap_or(NO_SLOT);
        SlotHit { t: best.t, u: best.v / best.determinant, v: best.w / best.determinant, slot }
    }

    /// What finding the closest hit of one ray takes.
    #[must_use]
    pub fn count_visits(&self, origin: Vec3, direction: Vec3, t_min: f32, t_max: f32) -> Visits {
        let mut visits = Visits::default();
        self.closest_counting(Portable, origin, direction, t_min, t_max, |node| {
            if node {
                visits.nodes += 1;
            } else {
                visits.packs += 1;
            }
        });
        visits
    }
}

/// The met child that the ray enters first; the others go on the stack, the farthest lowest.
#[inline(always)]
fn nearest_child<L: Lanes<Array = [f32; 8]>>(
    stack: &mut Stack<'_>,
    node: &Node,
    mut mask: u32,
    enter: L,
) -> Option<u32> {
    if mask == 0 {
        return None;
    }
    let enters = enter.to_array();
    let first = take_entry(node, &enters, &mut mask);
    if mask == 0 {
        return Some(first as u32);
    }
    let second = take_entry(node, &enters, &mut mask);
    let (nearer, farther) = if first < second { (first, second) } else { (second, first) };
    if mask == 0 {
        stack.push(farther);
        return Some(nearer as u32);
    }
    let base = stack.len;
    stack.push(farther);
    stack.push(nearer);
    while mask != 0 {
        stack.push(take_entry(node, &enters, &mut mask));
        stack.sink_last(base);
    }
    stack.pop().map(|entry| entry as u32)
}

/// The stack entry of the lowest child in `mask`, which is cleared there.
#[inline(always)]
fn take_entry(node: &Node, enters: &[f32; 8], mask: &mut u32) -> u64 {
    let i = mask.trailing_zeros() as usize & 7;
    u64::from(enters[i].to_bits()) << 32 | u64::from(take_child(node, mask))
}

/// The lowest child in `mask`, which is cleared there.
#[inline(always)]
fn take_child(node: &Node, mask: &mut u32) -> u32 {
    let i = mask.trailing_zeros() as usize & 7;
    *mask &= *mask - 1;
    node.children[i]
}
