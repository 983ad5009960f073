//! Collapses a binary hierarchy into an eight-wide one.

use super::node::{CHILDREN, LEAF, Node};
use super::pack::{PACK, Pack};
use super::{NO_SLOT, WideBvh};
use glam::Vec3;
use twinlight_core::bvh::MAX_DEPTH;
use twinlight_core::scene::CompiledScene;
use twinlight_core::transport::intersect::padded_bounds;

/// What a child will hold.
enum Content {
    /// A node of the binary hierarchy.
    Binary(u32),
    /// Slots whose hierarchy ends here: a leaf too big for a pack, or a subtree too deep.
    Slots(Vec<u32>),
}

struct Item {
    min: Vec3,
    max: Vec3,
    content: Content,
}

impl Item {
    fn area(&self) -> f32 {
        let d = self.max - self.min;
        (d.x * d.y + d.y * d.z) + d.z * d.x
    }
}

struct Builder<'a> {
    scene: &'a CompiledScene,
    /// Triangles below each binary node.
    counts: Vec<u32>,
    wide: WideBvh,
}

impl WideBvh {
    /// The hierarchy of a scene.
    #[must_use]
    pub fn new(scene: &CompiledScene) -> Self {
        let wide = WideBvh {
            nodes: vec![Node::EMPTY],
            packs: vec![Pack::EMPTY],
            slots: vec![NO_SLOT; PACK],
            ids: vec![u32::MAX; PACK],
        };
        let mut builder = Builder { scene, counts: subtree_counts(scene), wide };
        if !scene.bvh.nodes.is_empty() {
            builder.run();
        }
        builder.wide
    }
}

/// Children come after their parents, so one pass from the back sees both before it sees the parent.
fn subtree_counts(scene: &CompiledScene) -> Vec<u32> {
    let nodes = &scene.bvh.nodes;
    let mut counts = vec![0_u32; nodes.len()];
    for (index, node) in nodes.iter().enumerate().rev() {
        let first = node.first as usize;
        counts[index] = if node.count > 0 { node.count } else { counts[first] + counts[first + 1] };
    }
    counts
}

impl Builder<'_> {
    fn run(&mut self) {
        let mut pending = vec![(self.binary(0), 0_usize, 0_u32)];
        while let Some((item, to, depth)) = pending.pop() {
            let children = self.open(item, depth);
            let mut node = Node::EMPTY;
            for (lane, child) in children.into_iter().enumerate() {
                let (min, max) = (child.min, child.max);
                let reference = if self.count(&child) as usize <= PACK {
                    self.add_pack(&child)
                } else {
                    let index = self.wide.nodes.len();
                    self.wide.nodes.push(Node::EMPTY);
                    pending.push((child, index, depth + 1));
                    index as u32
                };
                node.set(lane, min, max, reference);
            }
            self.wide.nodes[to] = node;
        }
    }

    fn binary(&self, index: u32) -> Item {
        let node = &self.scene.bvh.nodes[index as usize];
        Item { min: node.min.into(), max: node.max.into(), content: Content::Binary(index) }
    }

    fn count(&self, item: &Item) -> u32 {
        match &item.content {
            Content::Binary(index) => self.counts[*index as usize],
            Content::Slots(slots) => slots.len() as u32,
        }
    }

    /// Slots below an item, in leaf order.
    fn slots(&self, item: &Item) -> Vec<u32> {
        let root = match &item.content {
            Content::Slots(slots) => return slots.clone(),
            Content::Binary(index) => *index,
        };
        let (mut slots, mut stack) = (Vec::new(), vec![root]);
        while let Some(index) = stack.pop() {
            let node = &self.scene.bvh.nodes[index as usize];
            if node.count > 0 {
                slots.extend(node.first..node.first + node.count);
            } else {
                stack.extend([node.first + 1, node.first]);
            }
        }
        slots
    }

    /// Up to eight items that together hold what `item` holds: the one with the largest surface is replaced by its two
    /// children until eight are there. An item that fits a pack stays whole.
    fn open(&self, item: Item, depth: u32) -> Vec<Item> {
        let mut items = Vec::with_capacity(CHILDREN);
        match &item.content {
            Content::Slots(slots) => return self.eighths(slots),
            Content::Binary(_) if depth >= MAX_DEPTH => return self.eighths(&self.slots(&item)),
            Content::Binary(index) if self.scene.bvh.nodes[*index as usize].count as usize > PACK => {
                return self.eighths(&self.slots(&item));
            }
            Content::Binary(_) => items.push(item),
        }
        while items.len() < CHILDREN {
            let widest = (0..items.len())
                .filter_map(|i| self.inner(&items[i]).map(|children| (i, children)))
                .max_by(|a, b| items[a.0].area().total_cmp(&items[b.0].area()));
            let Some((i, first)) = widest else { break };
            items[i] = self.binary(first);
            items.push(self.binary(first + 1));
        }
        items
    }

    /// First child of an item that can be opened.
    fn inner(&self, item: &Item) -> Option<u32> {
        let Content::Binary(index) = item.content else { return None };
        let node = &self.scene.bvh.nodes[index as usize];
        (node.count == 0 && self.counts[index as usize] as usize > PACK).then_some(node.first)
    }

    /// Eight equal shares of `slots`.
    fn eighths(&self, slots: &[u32]) -> Vec<Item> {
        let share = slots.len().div_ceil(CHILDREN).max(PACK);
        slots.chunks(share).map(|chunk| self.slot_item(chunk.to_vec())).collect()
    }

    fn slot_item(&self, slots: Vec<u32>) -> Item {
        let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for &slot in &slots {
            let t = &self.scene.triangles[slot as usize];
            let (lo, hi) = padded_bounds(t.p0.into(), t.p1.into(), t.p2.into());
            (min, max) = (min.min(lo), max.max(hi));
        }
        Item { min, max, content: Content::Slots(slots) }
    }

    fn add_pack(&mut self, item: &Item) -> u32 {
        let slots = self.slots(item);
        let mut pack = Pack::EMPTY;
        for lane in 0..PACK {
            let Some(&slot) = slots.get(lane) else {
                self.wide.slots.push(NO_SLOT);
                self.wide.ids.push(u32::MAX);
                continue;
            };
            let triangle = &self.scene.triangles[slot as usize];
            for (vertex, corner) in [triangle.p0, triangle.p1, triangle.p2].into_iter().enumerate() {
                for (axis, coordinate) in corner.into_iter().enumerate() {
                    pack.corners[vertex][axis][lane] = coordinate;
                }
            }
            self.wide.slots.push(slot);
            self.wide.ids.push(triangle.id);
        }
        self.wide.packs.push(pack);
        (self.wide.packs.len() - 1) as u32 | LEAF
    }
}
