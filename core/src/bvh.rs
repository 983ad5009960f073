//! The bounding volume hierarchy: built on the host by obvhs, laid out depth first, the same for every backend.

use crate::transport::intersect::padded_bounds;
use bytemuck::{Pod, Zeroable};
use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::{Boundable, BvhBuildParams};
use std::time::Duration;

mod parts;

pub use parts::build_parts;

/// Triangles per leaf at most.
pub const MAX_LEAF_TRIANGLES: u32 = 4;

/// Deepest hierarchy handed to a kernel: fixed stacks of this many entries never overflow.
pub const MAX_DEPTH: u32 = 64;

/// A node. Inner nodes have `count` 0 and children at `first` and `first + 1`; leaves hold `count` triangles from
/// `first` in leaf order.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct BvhNode {
    /// Least corner, world units; holds the padded bounds of every triangle below.
    pub min: [f32; 3],
    /// First child or first triangle.
    pub first: u32,
    /// Greatest corner.
    pub max: [f32; 3],
    /// Triangles, 0 for an inner node.
    pub count: u32,
}

/// A binary hierarchy. Node 0 is the root; without triangles there are no nodes.
#[derive(Debug, Clone, Default)]
pub struct Bvh {
    /// Nodes, depth first, siblings adjacent.
    pub nodes: Vec<BvhNode>,
    /// Longest path from the root, in edges.
    pub depth: u32,
}

struct PaddedTriangle<'a>(&'a [[f32; 3]; 3]);

impl Boundable for PaddedTriangle<'_> {
    fn aabb(&self) -> Aabb {
        let (min, max) = padded_bounds(self.0[0].into(), self.0[1].into(), self.0[2].into());
        Aabb::new(Vec3A::from(min), Vec3A::from(max))
    }
}

/// Builds the hierarchy over `triangles` (three finite corners each) and returns it with the leaf order: element s
/// is the index of the triangle in slot s.
pub fn build(triangles: &[[[f32; 3]; 3]]) -> (Bvh, Vec<u32>) {
    build_within(triangles, MAX_DEPTH)
}

/// [`build`], at most `max_depth` deep, which is more than a balanced hierarchy of as many triangles has.
fn build_within(triangles: &[[[f32; 3]; 3]], max_depth: u32) -> (Bvh, Vec<u32>) {
    if triangles.is_empty() {
        return (Bvh::default(), Vec::new());
    }
    if crowded(triangles) {
        return median_split(triangles);
    }
    let boundables: Vec<PaddedTriangle<'_>> = triangles.iter().map(PaddedTriangle).collect();
    let params = BvhBuildParams { max_prims_per_leaf: MAX_LEAF_TRIANGLES, ..BvhBuildParams::fast_build() };
    let source = build_bvh2(&boundables, params, &mut Duration::default());
    let built = depth_first(&source);
    if built.0.depth <= max_depth { built } else { median_split(triangles) }
}

/// Triangles that may share one cell of the builder's Morton grid.
const MAX_CELL_TRIANGLES: usize = 256;

/// Whether so many triangles have the same middle, to 2⁻²¹ of the bounds, that obvhs's clustering would chain them one
/// by one: quadratic time, and recursion as deep as their number.
fn crowded(triangles: &[[[f32; 3]; 3]]) -> bool {
    let middle = |t: &[[f32; 3]; 3]| {
        Vec3A::from(t[0]).min(t[1].into()).min(t[2].into()) * 0.5
            + Vec3A::from(t[0]).max(t[1].into()).max(t[2].into()) * 0.5
    };
    let (lo, hi) = triangles
        .iter()
        .map(middle)
        .fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
    let scale = 2_097_151.0 / (hi - lo).max(Vec3A::splat(f32::MIN_POSITIVE));
    let cell = |t| ((middle(t) - lo) * scale).to_array().map(|x| x as u64);
    let mut cells: Vec<u64> = triangles.iter().map(cell).map(|[x, y, z]| x << 42 | y << 21 | z).collect();
    cells.sort_unstable();
    cells.windows(MAX_CELL_TRIANGLES + 1).any(|w| w[0] == w[MAX_CELL_TRIANGLES])
}

fn record(aabb: &Aabb, first: u32, count: u32) -> BvhNode {
    BvhNode { min: aabb.min.to_array(), first, max: aabb.max.to_array(), count }
}

/// Renumbers obvhs's nodes so that siblings are adjacent and subtrees contiguous, which is what a traversal reads.
fn depth_first(source: &Bvh2) -> (Bvh, Vec<u32>) {
    let mut bvh = Bvh { nodes: Vec::with_capacity(source.nodes.len()), depth: 0 };
    let mut order = Vec::with_capacity(source.primitive_indices.len());
    bvh.nodes.push(BvhNode::zeroed());
    let mut stack = vec![(0_usize, 0_usize, 0_u32)];
    while let Some((from, to, depth)) = stack.pop() {
        bvh.depth = bvh.depth.max(depth);
        let node = &source.nodes[from];
        let first = node.first_index as usize;
        if node.prim_count > 0 {
            let slot = order.len() as u32;
            order.extend_from_slice(&source.primitive_indices[first..first + node.prim_count as usize]);
            bvh.nodes[to] = record(node.aabb(), slot, node.prim_count);
            continue;
        }
        let child = bvh.nodes.len();
        bvh.nodes.extend([BvhNode::zeroed(); 2]);
        bvh.nodes[to] = record(node.aabb(), child as u32, 0);
        stack.push((first + 1, child + 1, depth + 1));
        stack.push((first, child, depth + 1));
    }
    (bvh, order)
}

/// A balanced hierarchy for inputs on which obvhs builds one that is too deep (many coinciding boxes).
fn median_split(triangles: &[[[f32; 3]; 3]]) -> (Bvh, Vec<u32>) {
    let boxes: Vec<Aabb> = triangles.iter().map(|t| PaddedTriangle(t).aabb()).collect();
    let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
    let mut bvh = Bvh { nodes: vec![BvhNode::zeroed()], depth: 0 };
    let mut stack = vec![(0_usize, 0..order.len(), 0_u32)];
    while let Some((to, range, depth)) = stack.pop() {
        bvh.depth = bvh.depth.max(depth);
        let members = &mut order[range.clone()];
        let bounds = members.iter().fold(Aabb::empty(), |b, &i| b.union(&boxes[i as usize]));
        if members.len() <= MAX_LEAF_TRIANGLES as usize {
            bvh.nodes[to] = record(&bounds, range.start as u32, members.len() as u32);
            continue;
        }
        let extent = bounds.diagonal().to_array();
        let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
        let middle = members.len() / 2;
        let center = |i: u32| boxes[i as usize].center()[axis];
        members.select_nth_unstable_by(middle, |&a, &b| center(a).total_cmp(&center(b)).then(a.cmp(&b)));
        let child = bvh.nodes.len();
        bvh.nodes.extend([BvhNode::zeroed(); 2]);
        bvh.nodes[to] = record(&bounds, child as u32, 0);
        let split = range.start + middle;
        stack.push((child + 1, split..range.end, depth + 1));
        stack.push((child, range.start..split, depth + 1));
    }
    (bvh, order)
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn check(bvh: &Bvh, order: &[u32], triangles: &[[[f32; 3]; 3]]) {
        let mut seen = order.to_vec();
        seen.sort_unstable();
        assert!(seen.iter().copied().eq(0..triangles.len() as u32), "every triangle in one slot");
        for (index, node) in bvh.nodes.iter().enumerate() {
            let inside =
                |lo: [f32; 3], hi: [f32; 3]| (0..3).all(|a| node.min[a] <= lo[a] && node.max[a] >= hi[a]);
            if node.count == 0 {
                for child in [node.first, node.first + 1] {
                    let child = &bvh.nodes[child as usize];
                    assert!(inside(child.min, child.max), "node {index} holds its children");
                }
                continue;
            }
            for slot in node.first..node.first + node.count {
                let t = &triangles[order[slot as usize] as usize];
                let (lo, hi) = padded_bounds(t[0].into(), t[1].into(), t[2].into());
                assert!(inside(lo.to_array(), hi.to_array()), "leaf {index} holds triangle {slot}");
            }
        }
    }

    pub(super) fn soup(n: usize) -> Vec<[[f32; 3]; 3]> {
        let at = |i: usize, k: usize| ((i * 7919 + k * 104_729) % 1000) as f32 * 0.01;
        (0..n)
            .map(|i| {
                let p = [at(i, 1), at(i, 2), at(i, 3)];
                [p, [p[0] + at(i, 4) * 0.1, p[1], p[2]], [p[0], p[1] + at(i, 5) * 0.1, p[2] + at(i, 6) * 0.1]]
            })
            .collect()
    }

    #[test]
    fn hierarchies_hold_their_triangles() {
        for n in [1, 2, 3, 4, 5, 17, 1000] {
            let triangles = soup(n);
            let (bvh, order) = build(&triangles);
            check(&bvh, &order, &triangles);
            let (bvh, order) = median_split(&triangles);
            check(&bvh, &order, &triangles);
        }
    }

    #[test]
    fn nothing_builds_nothing() {
        let (bvh, order) = build(&[]);
        assert!(bvh.nodes.is_empty() && order.is_empty());
    }

    #[test]
    fn coinciding_triangles_stay_within_the_depth_limit() {
        let nested = |i: usize| [[i as f32, 0.0, 0.0], [-(i as f32), i as f32, 0.0], [0.0, -(i as f32), 1.0]];
        for triangles in [vec![soup(1)[0]; 20_000], (0..20_000).map(nested).collect()] {
            let (bvh, order) = build(&triangles);
            check(&bvh, &order, &triangles);
            assert!(bvh.depth <= MAX_DEPTH, "depth {}", bvh.depth);
        }
    }
}
