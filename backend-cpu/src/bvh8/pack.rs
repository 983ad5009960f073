//! Triangles in packs, and the test of a ray against one pack: `twinlight_core::transport::intersect::triangle`, lane
//! by lane, operation by operation.

use crate::simd::{LaneMask, Lanes, Width};
use glam::Vec3;
use twinlight_core::transport::intersect::RayFrame;

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

    /// The corners of triangle `lane`.
    #[inline(always)]
    pub(super) fn triangle(&self, lane: usize) -> [Vec3; 3] {
        [0, 1, 2].map(|vertex| {
            let [x, y, z] = &self.corners[vertex];
            Vec3::new(x[lane], y[lane], z[lane])
        })
    }
}

/// What a ray brings to every pack. Axes are permuted.
#[derive(Clone, Copy)]
pub(super) struct PackRay<W: Width> {
    axes: [usize; 3],
    origin: [PackLanes<W>; 3],
    shear: [PackLanes<W>; 3],
    t_min: f32,
}

/// Lanes of a pack that a ray may meet: about one or two, behind the ray among them. What remains of the contract is
/// tested one by one, by `twinlight_core::transport::intersect::triangle_t`.
pub(super) struct PackHits<W: Width> {
    /// Bit i: the edges of triangle i let the ray through, and its corners' depths lie about `t_min ..= t_best`.
    pub mask: u32,
    /// Edge functions U, V and W.
    pub edges: [PackLanes<W>; 3],
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
        // One sign only, and not all zero. A NaN that slips through here fails the test of the determinant later.
        let one_sided = u.minimum(v).minimum(w).lt(zero) ^ zero.lt(u.maximum(v).maximum(w));
        if one_sided.bits() == 0 {
            return None;
        }
        let (az, bz, cz) = (sz * a[2], sz * b[2], sz * c[2]);
        let high = az.maximum(bz).maximum(cz);
        let low = az.minimum(bz).minimum(cz);
        let in_range =
            PackLanes::<W>::splat(width, self.t_min).lt(high) & low.le(PackLanes::<W>::splat(width, t_best));
        Some(PackHits { mask: (one_sided & in_range).bits(), edges: [u, v, w] })
    }
}

#[inline(always)]
fn permuted(v: Vec3, axes: [usize; 3]) -> [f32; 3] {
    // glam's own indexing branches on axes that can't be predicted.
    let components = [v.x, v.y, v.z, 0.0];
    [components[axes[0] & 3], components[axes[1] & 3], components[axes[2] & 3]]
}
