//! Triangles in packs, and the test of a ray against one pack: `twinlight_core::transport::intersect::triangle`, lane
//! by lane, operation by operation. Axes are the ray's, permuted: only sums over axes depend on their order, and those of
//! the plane are formed in the scene's.

use crate::simd::{LaneMask, Lanes, Width};
use glam::Vec3;
use twinlight_core::transport::intersect::{
    PAD_COORDINATE, PAD_EXTENT, RayFrame, SIDE_ERROR, SLAB_FAR_FACTOR,
};

/// Triangles per pack.
pub(super) const PACK: usize = 8;

/// The vector that holds one number of every triangle of a pack.
pub(super) type PackLanes<W> = <W as Width>::F8;

/// One truth value per triangle of a pack.
type PackMask<W> = <PackLanes<W> as Lanes>::Mask;

/// Corners by vertex, axis and lane, so that a ray's permuted axes are plain indices; normals by axis and lane. Empty
/// lanes are all zeros: a triangle without area is never met.
#[repr(C, align(32))]
#[derive(Debug, Clone, Copy)]
pub(super) struct Pack {
    pub corners: [[[f32; PACK]; 3]; 3],
    pub normals: [[f32; PACK]; 3],
}

impl Pack {
    pub(super) const EMPTY: Pack = Pack { corners: [[[0.0; PACK]; 3]; 3], normals: [[0.0; PACK]; 3] };
}

/// One number of every triangle of a pack, per axis.
type Lanes3<W> = [PackLanes<W>; 3];

/// What a ray brings to every pack. Axes are permuted, but for `plane_origin` and `plane_direction`.
#[derive(Clone, Copy)]
pub(super) struct PackRay<W: Width> {
    axes: [usize; 3],
    origin: Lanes3<W>,
    shear: Lanes3<W>,
    inverse: [f32; 3],
    plane_origin: Vec3,
    plane_direction: Vec3,
    t_min: f32,
}

/// The triangles of a pack that a ray meets, rarely more than one.
pub(super) struct PackHits<W: Width> {
    /// Bit i: triangle i is met.
    pub mask: u32,
    /// Where, for the bits of `mask`.
    pub t: PackLanes<W>,
    /// Edge functions U, V and W.
    pub edges: Lanes3<W>,
}

#[inline(always)]
fn splat3<W: Width>(width: W, [x, y, z]: [f32; 3]) -> Lanes3<W> {
    [PackLanes::<W>::splat(width, x), PackLanes::<W>::splat(width, y), PackLanes::<W>::splat(width, z)]
}

#[inline(always)]
fn least<L: Lanes>([a, b, c]: [L; 3]) -> L {
    a.minimum(b).minimum(c)
}

#[inline(always)]
fn greatest<L: Lanes>([a, b, c]: [L; 3]) -> L {
    a.maximum(b).maximum(c)
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
            plane_origin: frame.origin,
            plane_direction: frame.direction,
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

    /// Tests every lane. `None` when it is soon clear that none is met, most often by the edges.
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
        // One sign only, and not all zero. A NaN that slips through here fails the test of the determinant.
        let one_sided = least([u, v, w]).lt(zero) ^ zero.lt(greatest([u, v, w]));
        if one_sided.bits() == 0 {
            return None;
        }
        let depths = [sz * a[2], sz * b[2], sz * c[2]];
        let (low, high) = (least(depths), greatest(depths));
        let (t_min, t_best) =
            (PackLanes::<W>::splat(width, self.t_min), PackLanes::<W>::splat(width, t_best));
        let determinant = (u + v) + w;
        let in_range = t_min.lt(high) & low.le(t_best) & zero.lt(determinant.abs());
        let t_edge = ((u * depths[0] + v * depths[1]) + w * depths[2]) / determinant;
        let (ahead, t) = self.plane_t(width, pack, [a, b, c], t_edge);
        let candidates = one_sided & in_range & ahead;
        if candidates.bits() == 0 {
            return None;
        }
        let t = t.maximum(low).minimum(high);
        let (near, far) = self.padded_slab(width, pack);
        let entry = t.maximum(near);
        let met = candidates & near.maximum(zero).le(far) & t_min.lt(t) & entry.le(t_best);
        Some(PackHits { mask: met.bits(), t: entry, edges: [u, v, w] })
    }

    /// Lanes whose plane the ray doesn't go away from, and where it meets the plane, or `t_edge` where it is in doubt on
    /// which side the ray starts.
    #[inline(always)]
    fn plane_t(
        &self,
        width: W,
        pack: &Pack,
        [a, b, c]: [Lanes3<W>; 3],
        t_edge: PackLanes<W>,
    ) -> (PackMask<W>, PackLanes<W>) {
        let zero = PackLanes::<W>::splat(width, 0.0);
        let normal = [
            PackLanes::<W>::load(width, &pack.normals[0]),
            PackLanes::<W>::load(width, &pack.normals[1]),
            PackLanes::<W>::load(width, &pack.normals[2]),
        ];
        let origin = splat3(width, self.plane_origin.to_array());
        let [x, y, z] = &pack.corners[0];
        let x = PackLanes::<W>::load(width, x) - origin[0];
        let y = PackLanes::<W>::load(width, y) - origin[1];
        let z = PackLanes::<W>::load(width, z) - origin[2];
        // How far along the normal the plane lies: the contract's height with the other sign.
        let depth = normal[0] * x + normal[1] * y + normal[2] * z;
        let direction = splat3(width, self.plane_direction.to_array());
        let slope = normal[0] * direction[0] + normal[1] * direction[1] + normal[2] * direction[2];
        let a = greatest([a[0].abs(), a[1].abs(), a[2].abs()]);
        let b = greatest([b[0].abs(), b[1].abs(), b[2].abs()]);
        let c = greatest([c[0].abs(), c[1].abs(), c[2].abs()]);
        let doubt = greatest([a, b, c]) * PackLanes::<W>::splat(width, SIDE_ERROR);
        let certain = doubt.lt(depth.abs());
        let t_plane = depth / slope;
        // The quotient's sign alone could be that of a slope of 0.
        let towards = (depth.lt(zero) & slope.lt(zero)) | (zero.lt(depth) & zero.lt(slope));
        (towards | depth.abs().le(doubt), t_plane.select(certain, t_edge))
    }

    /// Where the ray enters and leaves every triangle's padded bounds.
    #[inline(always)]
    fn padded_slab(&self, width: W, pack: &Pack) -> (PackLanes<W>, PackLanes<W>) {
        let a = self.corner(width, pack, 0);
        let b = self.corner(width, pack, 1);
        let c = self.corner(width, pack, 2);
        let min = [least([a[0], b[0], c[0]]), least([a[1], b[1], c[1]]), least([a[2], b[2], c[2]])];
        let max = [greatest([a[0], b[0], c[0]]), greatest([a[1], b[1], c[1]]), greatest([a[2], b[2], c[2]])];
        let extent = greatest([max[0] - min[0], max[1] - min[1], max[2] - min[2]]);
        let reach = greatest([
            min[0].abs().maximum(max[0].abs()),
            min[1].abs().maximum(max[1].abs()),
            min[2].abs().maximum(max[2].abs()),
        ]);
        let pad = extent * PackLanes::<W>::splat(width, PAD_EXTENT)
            + reach * PackLanes::<W>::splat(width, PAD_COORDINATE);
        let x = self.slab(width, 0, min[0] - pad, max[0] + pad);
        let y = self.slab(width, 1, min[1] - pad, max[1] + pad);
        let z = self.slab(width, 2, min[2] - pad, max[2] + pad);
        let far = least([x.1, y.1, z.1]);
        let moved_out = far * PackLanes::<W>::splat(width, SLAB_FAR_FACTOR);
        // Moved out only where it lies ahead; what lies behind is no hit either way.
        (greatest([x.0, y.0, z.0]), far.maximum(moved_out))
    }

    #[inline(always)]
    fn slab(
        &self,
        width: W,
        axis: usize,
        min: PackLanes<W>,
        max: PackLanes<W>,
    ) -> (PackLanes<W>, PackLanes<W>) {
        let inverse = PackLanes::<W>::splat(width, self.inverse[axis]);
        let (a, b) = ((min - self.origin[axis]) * inverse, (max - self.origin[axis]) * inverse);
        (a.minimum(b), a.maximum(b))
    }
}

#[inline(always)]
fn permuted(v: Vec3, axes: [usize; 3]) -> [f32; 3] {
    // glam's own indexing branches on axes that can't be predicted.
    let components = [v.x, v.y, v.z, 0.0];
    [components[axes[0] & 3], components[axes[1] & 3], components[axes[2] & 3]]
}
