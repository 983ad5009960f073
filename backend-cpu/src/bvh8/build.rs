//! Makes an eight-wide hierarchy of a binary one.

use super::collapse::Collapse;
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
    /// Slots whose hierarchy ends here: of a leaf too big for a pack, or of a subtree too deep.
    Slots(Vec<u32>),
}

struct Item {
    min: Vec3,
    max: Vec3,
    content: Content,
}

struct Builder<'a> {
    scene: &'a CompiledScene,
    collapse: Collapse,
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
        let mut builder = Builder { scene, collapse: Collapse::new(&scene.bvh), wide };
        if !scene.bvh.nodes.is_empty() {
            builder.run();
        }
        builder.wide
    }
}

impl Builder<'_> {
    fn run(&mut self) {
        let mut pending = vec![(self.binary(0), 0_usize, 0_u32)];
        let mut children = Vec::with_capacity(CHILDREN);
        let mut slots = Vec::new();
        while let Some((item, to, depth)) = pending.pop() {
            self.open(item, depth, &mut children);
            let mut node = Node::EMPTY;
            for (lane, child) in children.drain(..).enumerate() {
                let (min, max) = (child.min, child.max);
                let reference = if self.is_pack(&child) {
                    self.slots(&child.content, &mut slots);
                    self.add_pack(&slots)
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

    fn is_pack(&self, item: &Item) -> bool {
        match &item.content {
            Content::Binary(index) => self.collapse.is_pack(*index),
            Content::Slots(slots) => slots.len() <= PACK,
        }
    }

    /// Slots below an item, in leaf order.
    fn slots(&self, content: &Content, slots: &mut Vec<u32>) {
        slots.clear();
        let root = match content {
            Content::Slots(own) => return slots.extend(own),
            Content::Binary(index) => *index,
        };
        let mut stack = vec![root];
        while let Some(index) = stack.pop() {
            let node = &self.scene.bvh.nodes[index as usize];
            if node.count > 0 {
                slots.extend(node.first..node.first + node.count);
            } else {
                stack.extend([node.first + 1, node.first]);
            }
        }
    }

    /// Up to eight items that together hold what `item` holds.
    fn open(&self, item: Item, depth: u32, children: &mut Vec<Item>) {
        let Content::Binary(index) = item.content else {
            return self.eighths(&item.content, children);
        };
        let leaf = self.scene.bvh.nodes[index as usize].count > 0;
        if leaf && self.collapse.is_pack(index) {
            children.push(item);
        } else if leaf || depth >= MAX_DEPTH {
            self.eighths(&item.content, children);
        } else {
            let mut add = |child| children.push(self.binary(child));
            self.collapse.children(&self.scene.bvh, index, &mut add);
        }
    }

    /// Eight equal shares of an item's slots.
    fn eighths(&self, content: &Content, children: &mut Vec<Item>) {
        let mut slots = Vec::new();
        self.slots(content, &mut slots);
        let share = slots.len().div_ceil(CHILDREN).max(PACK);
        children.extend(slots.chunks(share).map(|chunk| self.slot_item(chunk.to_vec())));
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

    fn add_pack(&mut self, slots: &[u32]) -> u32 {
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
            for (axis, component) in triangle.normal.into_iter().enumerate() {
                pack.normals[axis][lane] = component;
            }
            self.wide.ids.push(triangle.id);
        }
        self.wide.packs.push(pack);
        (self.wide.packs.len() - 1) as u32 | LEAF
    }
}
