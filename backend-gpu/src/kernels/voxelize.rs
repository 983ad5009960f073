// kernel family: voxelize
// contract core/src/kernels/voxelize.rs
// cpu backend-cpu/src/kernels/voxelize.rs
// gpu backend-gpu/src/kernels/voxelize.wgsl
// oracle conformance/src/oracle/voxelize.rs
//! Host side of `voxelize`: triangles are classed, `items` cuts both lists into work for marking, and lists are made of the mask.

pub mod items;

use crate::backend::GpuBackend;
use crate::buffer::{BufferRef, GpuBuffer, chunks};
use crate::device::GpuDevice;
use crate::kernels::scan;
use crate::mesh::GpuMesh;
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use items::{Class, VoxelItems, for_each_run};
use twinlight_core::Result;
use twinlight_core::kernels::voxelize::{VoxelBuffers, VoxelizeParams, Voxels};
use twinlight_core::lattice::VoxelGrid;

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "voxelize",
    files: &[
        shared::DISPATCH,
        shared::WIDE,
        shared::MORTON,
        shared::VOXEL,
        shared::VOXEL_ITEMS,
        WgslFile { path: "backend-gpu/src/kernels/voxelize.wgsl", text: include_str!("voxelize.wgsl") },
    ],
};

/// Triangles, items or words per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 256;

/// Words per rank of the next level's list. Its ranks are no output, and a scan of one per word would take as long as all else
/// in a grid of 512³.
const WORDS_PER_PARENT_RANK: u32 = 16;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct VoxelizeBlock {
    /// The grid, the mesh, and items of a list.
    pub items: VoxelItems,
    /// Most cells of a small triangle.
    pub cutoff: u32,
    /// Small triangles.
    pub small_count: u32,
    /// Words of the mask.
    pub word_count: u32,
    /// 0 lists voxels, 1 lists those of the next level.
    pub level: u32,
    /// Words of the mask per rank.
    pub words_per_rank: u32,
    /// First code of the dispatch.
    pub code_begin: u32,
    /// The code after the last.
    pub code_end: u32,
    /// Unused, 0.
    pub padding: u32,
}

/// Runs the kernel; see the contract.
///
/// # Errors
/// As [`twinlight_core::Backend::voxelize`]: [`twinlight_core::Error::LimitExceeded`] where a binding has no room for the mask.
pub fn run(
    device: &GpuDevice,
    mesh: &GpuMesh,
    grid: &VoxelGrid,
    params: &VoxelizeParams,
) -> Result<Voxels<GpuBackend>> {
    params.check(grid, mesh.triangle_count() as usize)?;
    let words = grid.mask_words();
    device.expect_bindable::<u32>("voxels", words + 1)?;
    let call = Call { device, mesh, block: block(grid, mesh, params) };
    let [small, large] = call.classify()?;
    let mask = device.zeroed::<u32>(words)?;
    call.mark(Class::small(grid, &small, params.cutoff), &mask)?;
    call.mark(Class::large(grid, &large), &mask)?;
    let (ranks, active) = call.list_codes(&mask, 0, 1)?;
    let (_, parents) = call.list_codes(&mask, 1, WORDS_PER_PARENT_RANK)?;
    Ok(VoxelBuffers { grid: *grid, small, large, mask, ranks, active, parents })
}

/// What all dispatches of a call have in common.
fn block(grid: &VoxelGrid, mesh: &GpuMesh, params: &VoxelizeParams) -> VoxelizeBlock {
    let VoxelizeParams { separation, cutoff } = *params;
    let triangle_count = mesh.triangle_count();
    let items = VoxelItems { grid: *grid, separation, triangle_count, ..VoxelItems::zeroed() };
    VoxelizeBlock { items, cutoff, word_count: grid.mask_words() as u32, ..VoxelizeBlock::zeroed() }
}

/// A call.
struct Call<'a> {
    device: &'a GpuDevice,
    mesh: &'a GpuMesh,
    block: VoxelizeBlock,
}

impl Call<'_> {
    /// The numbers of small and of large triangles.
    fn classify(&self) -> Result<[GpuBuffer<u32>; 2]> {
        let device = self.device;
        let count = self.block.items.triangle_count;
        if count == 0 {
            return Ok([device.zeroed(0)?, device.zeroed(0)?]);
        }
        let flags = device.zeroed::<u32>(2 * count as usize)?;
        let mut places = device.zeroed::<u32>(flags.len())?;
        let buffers = [
            ("vertices", self.mesh.vertices()),
            ("triangles", self.mesh.triangles()),
            ("flags", flags.binding()),
        ];
        self.dispatch("classify", &self.block, &buffers, count)?;
        let total = scan::run(device, &flags, &mut places)?;
        let small_count = device.download_range(&places, count as usize, 1)?[0];
        let small = device.zeroed::<u32>(small_count as usize)?;
        let large = device.zeroed::<u32>((total - small_count) as usize)?;
        let buffers = [
            ("flags", flags.binding()),
            ("places", places.binding()),
            ("small", small.binding()),
            ("large", large.binding()),
        ];
        let block = VoxelizeBlock { small_count, ..self.block };
        self.dispatch("list_classes", &block, &buffers, count)?;
        Ok([small, large])
    }

    /// Marks the voxels that the triangles of a class meet.
    fn mark(&self, class: Class<'_>, mask: &GpuBuffer<u32>) -> Result<()> {
        for_each_run(self.device, self.mesh, self.block.items, class, |items, [listed, offsets]| {
            let block = VoxelizeBlock { items, ..self.block };
            let buffers = [listed, offsets, ("marks", mask.binding())];
            self.dispatch("mark_items", &block, &buffers, items.item_end - items.item_begin)
        })
    }

    /// The ranks of every `words_per_rank` words of the mask at `level`, and the codes there.
    fn list_codes(
        &self,
        mask: &GpuBuffer<u32>,
        level: u32,
        words_per_rank: u32,
    ) -> Result<(GpuBuffer<u32>, GpuBuffer<u32>)> {
        let device = self.device;
        let block = VoxelizeBlock { level, words_per_rank, ..self.block };
        let count = block.word_count.div_ceil(words_per_rank);
        let counts = device.zeroed::<u32>(count as usize + 1)?;
        let mut ranks = device.zeroed::<u32>(counts.len())?;
        let buffers = [("mask", mask.binding()), ("counts", counts.binding())];
        self.dispatch("count_codes", &block, &buffers, count)?;
        let total = scan::run(device, &counts, &mut ranks)? as usize;
        let codes = device.zeroed::<u32>(total)?;
        for part in chunks(total, device.elements_per_binding(size_of::<u32>())) {
            let (code_begin, code_end) = (part.start as u32, part.end as u32);
            let block = VoxelizeBlock { code_begin, code_end, ..block };
            let buffers =
                [("mask", mask.binding()), ("ranks", ranks.binding()), ("codes", codes.binding_of(part))];
            self.dispatch("list_codes", &block, &buffers, count)?;
        }
        Ok((ranks, codes))
    }

    /// Runs an entry point for `count` invocations.
    fn dispatch(
        &self,
        entry: &'static str,
        block: &VoxelizeBlock,
        buffers: &[(&'static str, BufferRef<'_>)],
        count: u32,
    ) -> Result<()> {
        let pipeline = self.device.pipeline(&SOURCE, entry)?;
        let mut recorder = self.device.record(entry);
        recorder.dispatch(entry, &pipeline, block, buffers, count.div_ceil(WORKGROUP_SIZE))?;
        recorder.run()
    }
}
