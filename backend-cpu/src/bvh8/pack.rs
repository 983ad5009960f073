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

/// Three numbers of every triangle of a pack: of a corner, by permuted axis.
type Lanes3<W> = [PackLanes<W>; 3];

#[inline(always)]
fn splat3<W: Width>(width: W, [x, y, z]: [f32; 3]) -> Lanes3<W> {
    [PackLanes::<W>::splat(width, x), PackLanes::<W>::splat(width, y), PackLanes::<W>::splat(width, z)]
}

impl<W: Width> PackRay<W> {
    #[inline(always)]
    pub(super) fn new(width: W, frame: &RayFrame, t_min: f32) -> Self {
        let axes = [frame.axes[0] as usize, frame.axes[1] as usize, frame.axes[2] as usize];
        PackRay {
            axes,
            origin: splat3(width, permuted(frame.origin, axes)),
            shear: splat3(width, frame.shear.to_array()),
            inverse: permuted(frame.inverse, axes),
            t_min,
        }
    }

    #[inline(always)]
    fn corner(&self, width: W, pack: &Pack, vertex: usize) -> Lanes3<W> {
        let corner = &pack.corners[vertex];
        // SAFETY: axes come from a ray frame and are 0 to 2.
        unsafe {
            [
                PackLanes::<W>::load(width, corner.get_unchecked(self.axes[0])),
                PackLanes::<W>::load(width, corner.get_unchecked(self.axes[1])),
                PackLanes::<W>::load(width, corner.get_unchecked(self.axes[2])),
            ]
        }
    }

    #[inline(always)]
    fn relative(&self, corner: Lanes3<W>) -> Lanes3<W> {
        [corner[0] - self.origin[0], corner[1] - self.origin[1], corner[2] - self.origin[2]]
    }

    /// Tests every lane. `None` when no triangle's edges let the ray through, which is the common case.
    #[inline(always)]
    pub(super) fn meet(&self, width: W, pack: &Pack, t_best: f32) -> Option<PackHits<W>> {
        let zero = PackLanes::<W>::splat(width, 0.0);
        let a = self.relative(self.corner(width, pack, 0));
        let b = self.relative(self.corner(width, pack, 1));
        let c = self.relative(self.corner(width, pack, 2));
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
        let p0 = self.corner(width, pack, 0);
        let p1 = self.corner(width, pack, 1);
        let p2 = self.corner(width, pack, 2);
        let min = minimum3::<W>(minimum3::<W>(p0, p1), p2);
        let max = maximum3::<W>(maximum3::<W>(p0, p1), p2);
        let extent = (max[0] - min[0]).maximum(max[1] - min[1]).maximum(max[2] - min[2]);
        // max(|min|, |max|) per axis, as min ≤ max.
        let reach = maximum3::<W>([zero - min[0], zero - min[1], zero - min[2]], max);
        let coordinate = reach[0].maximum(reach[1]).maximum(reach[2]);
        let pad = extent * PackLanes::<W>::splat(width, PAD_EXTENT)
            + coordinate * PackLanes::<W>::splat(width, PAD_COORDINATE);
        let [ix, iy, iz] = splat3(width, self.inverse);
        let low = self.relative([min[0] - pad, min[1] - pad, min[2] - pad]);
        let high = self.relative([max[0] + pad, max[1] + pad, max[2] + pad]);
        let a = [low[0] * ix, low[1] * iy, low[2] * iz];
        let b = [high[0] * ix, high[1] * iy, high[2] * iz];
        let (enter, leave) = (minimum3::<W>(a, b), maximum3::<W>(a, b));
        let near = enter[0].maximum(enter[1]).maximum(enter[2]);
        let far = leave[0].minimum(leave[1]).minimum(leave[2]);
        (near, far * PackLanes::<W>::splat(width, SLAB_FAR_FACTOR))
    }
}

#[inline(always)]
fn permuted(v: Vec3, axes: [usize; 3]) -> [f32; 3] {
    [v[axes[0]], v[axes[1]], v[axes[2]]]
}

#[inline(always)]
fn minimum3<W: Width>(a: Lanes3<W>, b: Lanes3<W>) -> Lanes3<W> {
    [a[0].minimum(b[0]), a[1].minimum(b[1]), a[2].minimum(b[2])]
}

#[inline(always)]
fn maximum3<W: Width>(a: Lanes3<W>, b: Lanes3<W>) -> Lanes3<W> {
    [a[0].maximum(b[0]), a[1].maximum(b[1]), a[2].maximum(b[2])]
}
