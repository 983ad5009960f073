//! Which nodes of a binary hierarchy become the nodes and packs of a wide one, so that the surface area heuristic's cost
//! is least: the dynamic programme of Ylitie, Karras, Laine, "Efficient incoherent ray traversal on GPUs through
//! compressed wide BVHs", HPG 2017, §3.1.

use super::node::CHILDREN;
use super::pack::PACK;
use twinlight_core::bvh::{Bvh, BvhNode};

/// Cost of testing a pack, where testing a node costs 1.
const PACK_COST: f32 = 1.0;

/// What a subtree costs as a forest of at most 1 to 7 trees, and how each is cut.
#[derive(Debug, Clone, Copy, Default)]
struct Cut {
    cost: [f32; CHILDREN - 1],
    /// For forests of at most 2 to 8 trees (entries 1 to 7): trees that the first child gets, or 0 if one tree less
    /// costs no more.
    first_share: [u8; CHILDREN],
    /// The subtree, as one tree, is a pack.
    pack: bool,
}

/// The cheapest way to cut every subtree.
pub(super) struct Collapse {
    cuts: Vec<Cut>,
}

impl Collapse {
    /// Children come after their parents, so one pass from the back sees both before it sees the parent.
    pub(super) fn new(bvh: &Bvh) -> Self {
        let mut cuts = vec![Cut::default(); bvh.nodes.len()];
        let mut counts = vec![0_u32; bvh.nodes.len()];
        for (index, node) in bvh.nodes.iter().enumerate().rev() {
            let first = node.first as usize;
            counts[index] = if node.count > 0 { node.count } else { counts[first] + counts[first + 1] };
            let as_pack = pack_cost(node, counts[index]);
            cuts[index] = if node.count > 0 {
                leaf_cut(node, as_pack)
            } else {
                inner_cut(&cuts[first], &cuts[first + 1], half_area(node), as_pack)
            };
        }
        Collapse { cuts }
    }

    /// Whether the subtree at `index` is a pack.
    pub(super) fn is_pack(&self, index: u32) -> bool {
        self.cuts[index as usize].pack
    }

    /// Calls `child` with the roots of the subtrees that become the children of the wide node made of `index`, which is
    /// not a leaf.
    pub(super) fn children(&self, bvh: &Bvh, index: u32, child: &mut impl FnMut(u32)) {
        self.forest(bvh, index, CHILDREN, child);
    }

    fn forest(&self, bvh: &Bvh, index: u32, mut trees: usize, child: &mut impl FnMut(u32)) {
        let node = &bvh.nodes[index as usize];
        let cut = &self.cuts[index as usize];
        while trees > 1 && cut.first_share[trees - 1] == 0 {
            trees -= 1;
        }
        if trees == 1 || node.count > 0 {
            child(index);
            return;
        }
        let share = cut.first_share[trees - 1] as usize;
        self.forest(bvh, node.first, share, child);
        self.forest(bvh, node.first + 1, trees - share, child);
    }
}

fn half_area(node: &BvhNode) -> f32 {
    let [x, y, z] = [0, 1, 2].map(|axis| node.max[axis] - node.min[axis]);
    (x * y + y * z) + z * x
}

fn pack_cost(node: &BvhNode, count: u32) -> f32 {
    if count as usize <= PACK { half_area(node) * PACK_COST } else { f32::INFINITY }
}

/// A leaf is one tree. One that no pack holds will be a node of packs.
fn leaf_cut(node: &BvhNode, as_pack: f32) -> Cut {
    let pack = as_pack < f32::INFINITY;
    let packs = node.count.div_ceil(PACK as u32) as f32;
    let cost = if pack { as_pack } else { half_area(node) * (1.0 + packs * PACK_COST) };
    Cut { cost: [cost; CHILDREN - 1], first_share: [0; CHILDREN], pack }
}

fn inner_cut(first: &Cut, second: &Cut, area: f32, as_pack: f32) -> Cut {
    // Cheapest shares for forests of exactly two children's trees, at most `trees` in sum.
    let split = |trees: usize| {
        (1..trees).fold((f32::INFINITY, 0), |best, share| {
            let cost = first.cost[share - 1] + second.cost[trees - share - 1];
            if cost < best.0 { (cost, share as u8) } else { best }
        })
    };
    let (distributed, share) = split(CHILDREN);
    let as_node = area + distributed;
    let mut cut = Cut { pack: as_pack <= as_node, ..Cut::default() };
    cut.first_share[CHILDREN - 1] = share;
    cut.cost[0] = if cut.pack { as_pack } else { as_node };
    for trees in 2..CHILDREN {
        let (cost, share) = split(trees);
        let fewer = cut.cost[trees - 2];
        (cut.cost[trees - 1], cut.first_share[trees - 1]) =
            if cost < fewer { (cost, share) } else { (fewer, 0) };
    }
    cut
}
