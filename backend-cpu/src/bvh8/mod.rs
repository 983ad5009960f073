//! The hierarchy the CPU traverses: up to eight children per node, triangles in packs that are tested in one go.
//!
//! Collapsed from the binary hierarchy of `twinlight_core::bvh`. Nodes keep full `f32` bounds, as Embree's BVH8 does
//! (Wald et al., "Embree: a kernel framework for efficient CPU ray tracing", 2014): quantised ones would be smaller but
//! would have to be decoded at every visit. Which triangle a ray meets, and the bits of t, u and v, are those of
//! `twinlight_core::kernels::trace` at every width, because a box that holds a triangle's padded bounds is never missed
//! by a ray that meets them.

mod build;
mod collapse;
mod node;
mod pack;
mod traverse;

use node::{MAX_STACK, Node};
use pack::Pack;

/// [`SlotHit::slot`] of a ray that meets nothing.
pub const NO_SLOT: u32 = u32::MAX;

/// The closest triangle on a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlotHit {
    /// Ray parameter; the ray's `t_max` when nothing is met.
    pub t: f32,
    /// Barycentric weight of the second vertex.
    pub u: f32,
    /// Barycentric weight of the third vertex.
    pub v: f32,
    /// Index into `CompiledScene::triangles`, or [`NO_SLOT`].
    pub slot: u32,
}

/// What a traversal did, for benchmarks and tests.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Visits {
    /// Nodes whose eight boxes were tested.
    pub nodes: u64,
    /// Packs whose triangles were tested.
    pub packs: u64,
}

/// Eight-wide hierarchy of a scene. Node 0 is the root, pack 0 is empty.
#[derive(Debug, Clone)]
pub struct WideBvh {
    nodes: Vec<Node>,
    packs: Vec<Pack>,
    /// Slot of each lane of each pack.
    slots: Vec<u32>,
    /// Triangle id of each lane of each pack.
    ids: Vec<u32>,
}

impl WideBvh {
    /// Number of nodes, number of packs, and bytes of all of it.
    #[must_use]
    pub fn size(&self) -> (usize, usize, usize) {
        let bytes = size_of_val(self.nodes.as_slice())
            + size_of_val(self.packs.as_slice())
            + size_of_val(self.slots.as_slice())
            + size_of_val(self.ids.as_slice());
        (self.nodes.len(), self.packs.len(), bytes)
    }

    /// Triangles per pack and children per node, on average.
    #[must_use]
    pub fn fill(&self) -> (f64, f64) {
        let triangles = self.slots.iter().filter(|&&slot| slot != NO_SLOT).count();
        let children: usize = self.nodes.iter().map(Node::occupied).sum();
        (triangles as f64 / (self.packs.len() - 1).max(1) as f64, children as f64 / self.nodes.len() as f64)
    }
}
