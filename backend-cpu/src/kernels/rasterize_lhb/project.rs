//! Vertices on the screen.

use crate::mesh::CpuMesh;
use twinlight_core::lattice::{View, subpixel_bits};

/// A view's projected vertices.
#[derive(Debug, Default)]
pub(super) struct Screen {
    /// x in the low half, y in the high one: both are at most 2¹⁵.
    pub(super) points: Vec<u32>,
    /// Sub-pixel bits.
    pub(super) bits: u32,
}

impl Screen {
    #[inline(always)]
    pub(super) fn project(&mut self, mesh: &CpuMesh, view: &View, size: u32) {
        self.bits = subpixel_bits(size);
        let [xs, ys, zs] = &mesh.axes;
        self.points.resize(xs.len(), 0);
        let middle = ((size << (self.bits + 14)) + (1 << 14)) as i32;
        let (right, down) = (view.right, view.down);
        for (((point, &x), &y), &z) in self.points.iter_mut().zip(xs).zip(ys).zip(zs) {
            let p = [i32::from(x), i32::from(y), i32::from(z)];
            let x = (right[0] * p[0] + right[1] * p[1] + right[2] * p[2] + middle) >> 15;
            let y = (down[0] * p[0] + down[1] * p[1] + down[2] * p[2] + middle) >> 15;
            *point = x as u32 | (y as u32) << 16;
        }
    }

    /// Screen coordinates of a vertex.
    #[inline(always)]
    pub(super) fn at(&self, vertex: u32) -> [i32; 2] {
        let point = self.points[vertex as usize];
        [(point & 0xffff) as i32, (point >> 16) as i32]
    }
}

/// Distance of a vertex from the plane through the lattice's centre, 2⁻¹⁴ steps.
#[inline(always)]
pub(super) fn distance(mesh: &CpuMesh, view: &View, vertex: u32) -> i32 {
    let v = vertex as usize;
    let [x, y, z] = &mesh.axes;
    let f = view.forward;
    f[0] * i32::from(x[v]) + f[1] * i32::from(y[v]) + f[2] * i32::from(z[v])
}
