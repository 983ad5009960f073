// kernel family: sum_voxels
// contract core/src/kernels/sum_voxels.rs
// cpu backend-cpu/src/kernels/sum_voxels.rs
// gpu backend-gpu/src/kernels/sum_voxels.wgsl
// oracle conformance/src/oracle/sum_voxels.rs
//! Host side of `sum_voxels`.

use crate::backend::GpuBackend;
use crate::buffer::{BufferRef, GpuBuffer, chunks};
use crate::device::GpuDevice;
use crate::kernels::voxelize::items::{Class, VoxelItems, for_each_run};
use crate::mesh::GpuMesh;
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use twinlight_core::Result;
use twinlight_core::kernels::sum_voxels::{VoxelSums, VoxelSurface, check, check_fragments};
use twinlight_core::kernels::voxelize::{VoxelBuffers, VoxelizeParams, Voxels};

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "sum_voxels",
    files: &[
        shared::DISPATCH,
        shared::WIDE,
        shared::MORTON,
        shared::VOXEL,
        shared::VOXEL_ITEMS,
        shared::FRAGMENT,
        WgslFile { path: "backend-gpu/src/kernels/sum_voxels.wgsl", text: include_str!("sum_voxels.wgsl") },
    ],
};

/// Items or voxels per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 256;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct SumVoxelsBlock {
    /// The grid, the mesh, and items of a list.
    pub items: VoxelItems,
    /// Number of texels.
    pub texel_count: u32,
    /// First voxel of the dispatch.
    pub active_begin: u32,
    /// The voxel after the last.
    pub active_end: u32,
    /// Unused, 0.
    pub padding: u32,
}

/// Runs the kernel; see the contract. Where a binding has no room for all sums, triangles are gone over once per part of them.
///
/// # Errors
/// As [`twinlight_core::Backend::sum_voxels`]; [`twinlight_core::Error::LimitExceeded`] also for surfaces or texels beyond one
/// binding.
pub fn run(
    device: &GpuDevice,
    mesh: &GpuMesh,
    voxels: &Voxels<GpuBackend>,
    surfaces: &GpuBuffer<VoxelSurface>,
    texels: &GpuBuffer<u32>,
    params: &VoxelizeParams,
) -> Result<GpuBuffer<VoxelSums>> {
    let active = check(params, voxels, GpuBuffer::len, mesh.triangle_count() as usize, surfaces.len())?;
    let sums = device.zeroed::<VoxelSums>(active)?;
    let most = device.zeroed::<u32>(1)?;
    let call = Call { device, mesh, voxels, surfaces, texels, cutoff: params.cutoff };
    let (grid, triangle_count) = (voxels.grid, mesh.triangle_count());
    let items = VoxelItems { grid, separation: params.separation, triangle_count, ..VoxelItems::zeroed() };
    for part in chunks(active, device.elements_per_binding(size_of::<VoxelSums>())) {
        let block = SumVoxelsBlock {
            items,
            texel_count: texels.len() as u32,
            active_begin: part.start as u32,
            active_end: part.end as u32,
            padding: 0,
        };
        let sums = sums.binding_of(part);
        call.add(&block, sums)?;
        let buffers = [("sums", sums), ("most", most.binding())];
        call.dispatch("find_most", &block, &buffers, block.active_end - block.active_begin)?;
    }
    check_fragments(device.download(&most)?[0])?;
    Ok(sums)
}

/// A call.
struct Call<'a> {
    device: &'a GpuDevice,
    mesh: &'a GpuMesh,
    voxels: &'a Voxels<GpuBackend>,
    surfaces: &'a GpuBuffer<VoxelSurface>,
    texels: &'a GpuBuffer<u32>,
    cutoff: u32,
}

impl Call<'_> {
    /// Adds what all triangles have to some voxels' sums.
    fn add(&self, block: &SumVoxelsBlock, sums: BufferRef<'_>) -> Result<()> {
        let VoxelBuffers { grid, small, large, .. } = self.voxels;
        for class in [Class::small(grid, small, self.cutoff), Class::large(grid, large)] {
            for_each_run(self.device, self.mesh, block.items, class, |items, [listed, offsets]| {
                let block = SumVoxelsBlock { items, ..*block };
                let buffers = [
                    listed,
                    offsets,
                    ("mask", self.voxels.mask.binding()),
                    ("ranks", self.voxels.ranks.binding()),
                    ("surfaces", self.surfaces.binding()),
                    ("texels", self.texels.binding()),
                    ("sums", sums),
                ];
                self.dispatch("add_items", &block, &buffers, items.item_end - items.item_begin)
            })?;
        }
        Ok(())
    }

    /// Runs an entry point for `count` invocations.
    fn dispatch(
        &self,
        entry: &'static str,
        block: &SumVoxelsBlock,
        buffers: &[(&'static str, BufferRef<'_>)],
        count: u32,
    ) -> Result<()> {
        let pipeline = self.device.pipeline(&SOURCE, entry)?;
        let mut recorder = self.device.record(entry);
        recorder.dispatch(entry, &pipeline, block, buffers, count.div_ceil(WORKGROUP_SIZE))?;
        recorder.run()
    }
}
