//! Triangles in packs, and the test of a ray against one pack: `twinlight_core::transport::intersect::triangle`, lane
//! by lane, operation by operation.

use crate::simd::{LaneMask, Lanes, Width};
use glam::Vec3;
use twinlight_core::transport::intersect::{PAD_COORDINATE, PAD_EXTENT, RayFrame, SLAB_FAR_FACTOR};

/// Triangles per pack.
pub(super) const PACK: usize = 8;

/// The vector that holds one number of every triangle of a pack.
pub(super) type PackLanes<W> = <W as Width>::F8;

/// Corners by vertex, axis and lane, so that a ray's permuted axes are plain indices. Empty lanes are all zeros: a
/// triangle without area is never met.
#[repr(C, align(32))]
#[derive(Debug, Clone, Copy)]
pub(super) struct Pack {
    pub corners: [[[f32; PACK]; 3]; 3],
}

impl Pack {
    pub(super) const EMPTY: Pack = Pack { corners: [[[0.0; PACK]; 3]; 3] };
}

/// What a ray brings to every pack. Axes are permuted.
#[derive(Clone, Copy)]
pub(super) struct PackRay<W: Width> {
    axes: [usize; 3],
    origin: [PackLanes<W>; 3],
    shear: [PackLanes<W>; 3],
    inverse: [f32; 3],
    t_min: f32,
}

/// Lanes of a pack that a ray meets within `t_min < t ≤ t_best`.
pub(super) struct PackHits<W: Width> {
    /// Bit i: triangle i is met.
    pub mask: u32,
    pub t: PackLanes<W>,
    /// Edge functions V and W, and the determinant that makes weights of them.
    pub edges: [PackLanes<W>; 2],
    pub determinant: PackLanes<W>,
}

impl<W: Width> PackRay<W> {
    #[inline(always)]
    pub(super) fn new(width: W, frame: &RayFrame, t_min: f32) -> Self {
        let axes = frame.axes.map(|k| k as usize);
        let permuted = |v: Vec3| axes.map(|k| v[k]);
        let splat = |v: [f32; 3]| v.map(|x| PackLanes::<W>::splat(width, x));
        PackRay {
            axes,
            origin: splat(permuted(frame.origin)),
            shear: splat(frame.shear.to_array()),
            inverse: permuted(frame.inverse),
            t_min,
        }
    }

    /// Tests every lane. `None` when no line of a triangle's edges lets the ray through, which is the common case.
    #[inline(always)]
    pub(super) fn meet(&self, width: W, pack: &Pack, t_best: f32) -> Option<PackHits<W>> {
        let zero = PackLanes::<W>::splat(width, 0.0);
        let corner = |vertex: usize, k: usize| {
            // SAFETY: vertices are 0 to 2, axes come from a ray frame and are 0 to 2.
            let lanes = unsafe { pack.corners.get_unchecked(vertex).get_unchecked(self.axes[k]) };
            PackLanes::<W>::load(width, lanes) - self.origin[k]
        };
        let relative = |vertex: usize| [corner(vertex, 0), corner(vertex, 1), corner(vertex, 2)];
        let [a, b, c] = [relative(0), relative(1), relative(2)];
        let [sx, sy, sz] = self.shear;
        let (ax, ay) = (a[0] - sx * a[2], a[1] - sy * a[2]);
        let (bx, by) = (b[0] - sx * b[2], b[1] - sy * b[2]);
        let (cx, cy) = (c[0] - sx * c[2], c[1] - sy * c[2]);
        let u = cx * by - cy * bx;
        let v = ax * cy - ay * cx;
        let w = bx * ay - by * ax;
        // One sign only, and not all zero. A NaN that slips through here fails the test of the determinant below.
        let one_sided = u.minimum(v).minimum(w).lt(zero) ^ zero.lt(u.maximum(v).maximum(w));
        if one_sided.bits() == 0 {
            return None;
        }
        let determinant = (u + v) + w;
        let t_edge = ((u * (sz * a[2]) + v * (sz * b[2])) + w * (sz * c[2])) / determinant;
        let (near, far) = self.padded_slab(width, pack);
        let t = t_edge.maximum(near);
        let mask = one_sided
            & (determinant.lt(zero) | zero.lt(determinant))
            & near.maximum(zero).le(far)
            & PackLanes::<W>::splat(width, self.t_min).lt(t)
            & t.le(PackLanes::<W>::splat(width, t_best));
        Some(PackHits { mask: mask.bits(), t, edges: [v, w], determinant })
    }

    /// Entry and exit of every triangle's padded bounds: `padded_bounds` and `slab` of the contract. The exit's factor
    /// is applied to negative exits too, which makes them no less negative.
    #[inline(always)]
    fn padded_slab(&self, width: W, pack: &Pack) -> (PackLanes<W>, PackLanes<W>) {
        let zero = PackLanes::<W>::splat(width, 0.0);
        let bounds = |k: usize| {
            let corner = |vertex: usize| {
                // SAFETY: vertices are 0 to 2, axes come from a ray frame and are 0 to 2.
                PackLanes::<W>::load(width, unsafe { pack.corners[vertex].get_unchecked(self.axes[k]) })
            };
            let [p0, p1, p2] = [corner(0), corner(1), corner(2)];
            (p0.minimum(p1).minimum(p2), p0.maximum(p1).maximum(p2))
        };
        let boxes = [bounds(0), bounds(1), bounds(2)];
        let size = boxes.map(|(min, max)| max - min);
        let extent = size[0].maximum(size[1]).maximum(size[2]);
        // max(|min|, |max|), as min ≤ max.
        let reach = boxes.map(|(min, max)| (zero - min).maximum(max));
        let coordinate = reach[0].maximum(reach[1]).maximum(reach[2]);
        let pad = extent * PackLanes::<W>::splat(width, PAD_EXTENT)
            + coordinate * PackLanes::<W>::splat(width, PAD_COORDINATE);
        let side = |k: usize| {
            let inverse = PackLanes::<W>::splat(width, self.inverse[k]);
            let a = (boxes[k].0 - pad - self.origin[k]) * inverse;
            let b = (boxes[k].1 + pad - self.origin[k]) * inverse;
            (a.minimum(b), a.maximum(b))
        };
        let [x, y, z] = [side(0), side(1), side(2)];
        let near = x.0.maximum(y.0).maximum(z.0);
        let far = x.1.minimum(y.1).minimum(z.1) * PackLanes::<W>::splat(width, SLAB_FAR_FACTOR);
        (near, far)
    }
}
