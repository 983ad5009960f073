//! Layout of a node, and the test of a ray against its eight boxes.

use crate::simd::{LaneMask, Lanes, Width};
use glam::Vec3;

/// Children per node.
pub(super) const CHILDREN: usize = 8;

/// Longest path from the root to a leaf, in edges. The binary hierarchy is opened to depth 64; what lies deeper is cut
/// into balanced eighths, 11 levels for 2³² triangles.
pub(super) const MAX_LEVELS: usize = 64 + 11;

/// Entries a traversal's stack can hold at once: each level leaves at most seven siblings behind, and the last pushes
/// eight.
pub(super) const MAX_STACK: usize = MAX_LEVELS * (CHILDREN - 1) + CHILDREN;

/// A child's reference with this bit is a pack, otherwise a node.
pub(super) const LEAF: u32 = 1 << 31;

/// Eight boxes and what they hold; four cache lines.
#[repr(C, align(64))]
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    /// Least and greatest x, least and greatest y, least and greatest z of every child. An absent child is an empty
    /// box, +∞ to −∞, which no ray of numbers meets.
    pub bounds: [[f32; CHILDREN]; 6],
    /// Node or pack ([`LEAF`]). An absent child is pack 0, which is empty: rays with a NaN may get there.
    pub children: [u32; CHILDREN],
    /// Bit i: child i is a pack.
    pub packs: u32,
}

impl Node {
    pub(super) const EMPTY: Node = {
        let (lo, hi) = ([f32::INFINITY; CHILDREN], [f32::NEG_INFINITY; CHILDREN]);
        Node { bounds: [lo, hi, lo, hi, lo, hi], children: [LEAF; CHILDREN], packs: 0xff }
    };

    /// Number of children.
    pub(super) fn occupied(&self) -> usize {
        self.bounds[0].iter().filter(|min| min.is_finite()).count()
    }

    pub(super) fn set(&mut self, lane: usize, min: Vec3, max: Vec3, child: u32) {
        for axis in 0..3 {
            self.bounds[2 * axis][lane] = min[axis];
            self.bounds[2 * axis + 1][lane] = max[axis];
        }
        self.children[lane] = child;
        if child & LEAF == 0 {
            self.packs &= !(1 << lane);
        }
    }
}

/// The contract moves the far side of a slab out by 1 + 2⁻²¹ after two roundings. Here the factor 1 + 2⁻²⁰ is put into
/// the reciprocal, once per ray: (1 + 2⁻²⁰)(1 − 2⁻²⁴)² > (1 + 2⁻²¹)(1 + 2⁻²⁴)³, so a box is entered whenever the
/// contract's arithmetic would enter it, and one multiplication per node is saved.
const FAR_FACTOR: f32 = 1.000_000_953_674_316_4;

/// What a ray brings to every node.
#[derive(Clone, Copy)]
pub(super) struct NodeRay<W: Width> {
    origin: [W::F8; 3],
    near_inverse: [W::F8; 3],
    far_inverse: [W::F8; 3],
    zero: W::F8,
    /// Row of [`Node::bounds`] the ray enters through, per axis; it leaves through the row's neighbour (xor 1).
    near_row: [usize; 3],
}

impl<W: Width> NodeRay<W> {
    #[inline(always)]
    pub(super) fn new(width: W, origin: Vec3, inverse: Vec3) -> Self {
        NodeRay {
            origin: splat3(width, origin),
            near_inverse: splat3(width, inverse),
            far_inverse: splat3(width, inverse * FAR_FACTOR),
            zero: W::F8::splat(width, 0.0),
            near_row: [
                usize::from(inverse.x < 0.0),
                2 + usize::from(inverse.y < 0.0),
                4 + usize::from(inverse.z < 0.0),
            ],
        }
    }

    /// Which children the ray meets at parameters in 0 ..= `t_best`, and where it enters each.
    #[inline(always)]
    pub(super) fn meet(&self, width: W, node: &Node, t_best: f32) -> (u32, W::F8) {
        let near_x = (self.near_plane(width, node, 0) - self.origin[0]) * self.near_inverse[0];
        let near_y = (self.near_plane(width, node, 1) - self.origin[1]) * self.near_inverse[1];
        let near_z = (self.near_plane(width, node, 2) - self.origin[2]) * self.near_inverse[2];
        let far_x = (self.far_plane(width, node, 0) - self.origin[0]) * self.far_inverse[0];
        let far_y = (self.far_plane(width, node, 1) - self.origin[1]) * self.far_inverse[1];
        let far_z = (self.far_plane(width, node, 2) - self.origin[2]) * self.far_inverse[2];
        let enter = near_x.maximum(near_y).maximum(near_z.maximum(self.zero));
        let leave = far_x.minimum(far_y).minimum(far_z.minimum(W::F8::splat(width, t_best)));
        (enter.le(leave).bits(), enter)
    }

    #[inline(always)]
    fn near_plane(&self, width: W, node: &Node, axis: usize) -> W::F8 {
        // SAFETY: rows are 2·axis or 2·axis + 1, at most 5.
        W::F8::load(width, unsafe { node.bounds.get_unchecked(self.near_row[axis]) })
    }

    #[inline(always)]
    fn far_plane(&self, width: W, node: &Node, axis: usize) -> W::F8 {
        // SAFETY: rows are 2·axis or 2·axis + 1, at most 5.
        W::F8::load(width, unsafe { node.bounds.get_unchecked(self.near_row[axis] ^ 1) })
    }
}

#[inline(always)]
fn splat3<W: Width>(width: W, v: Vec3) -> [W::F8; 3] {
    [W::F8::splat(width, v.x), W::F8::splat(width, v.y), W::F8::splat(width, v.z)]
}
