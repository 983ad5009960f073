// kernel family: reduce_mips
// contract core/src/kernels/reduce_mips.rs
// cpu backend-cpu/src/kernels/reduce_mips.rs
// gpu backend-gpu/src/kernels/reduce_mips.wgsl
// oracle conformance/src/oracle/reduce_mips.rs
//! Host side of `reduce_mips`.

use crate::backend::GpuBackend;
use crate::buffer::{BufferRef, GpuBuffer};
use crate::device::GpuDevice;
use crate::dispatch::Recorder;
use crate::kernels::scan;
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use twinlight_core::Result;
use twinlight_core::kernels::reduce_mips::{
    ANISOTROPIC, HARMONICS, HARMONICS_8, RANGES, ReduceMipsParams, SUMS, VoxelLevelBuffers, VoxelLevels,
    VoxelLight, check_voxels, word_starts,
};
use twinlight_core::kernels::voxelize::Voxels;
use twinlight_core::lattice::VoxelGrid;

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "reduce_mips",
    files: &[
        shared::DISPATCH,
        shared::WIDE,
        WgslFile {
            path: "backend-gpu/src/kernels/reduce_mips/harmonics.wgsl",
            text: include_str!("reduce_mips/harmonics.wgsl"),
        },
        WgslFile { path: "backend-gpu/src/kernels/reduce_mips.wgsl", text: include_str!("reduce_mips.wgsl") },
    ],
};

/// Invocations per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 256;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct ReduceMipsBlock {
    /// One of the storages, for the entry points that ask; bytes are packed from harmonics.
    pub storage: u32,
    /// Voxels on the longest axis of level 0.
    pub padded: u32,
    /// Number of levels.
    pub level_count: u32,
    /// Words of all levels.
    pub word_count: u32,
    /// The level in work.
    pub level: u32,
    /// First word of its mask.
    pub word_begin: u32,
    /// End of its mask.
    pub word_end: u32,
    /// First word of the mask of the level below.
    pub below_word: u32,
    /// Its first value.
    pub value_begin: u32,
    /// End of its values.
    pub value_end: u32,
    /// First value of the level below.
    pub below_value: u32,
    /// Unused, 0.
    pub padding: u32,
}

/// Names of WGSL variables and what is bound to them.
type Bindings<'a> = Vec<(&'static str, BufferRef<'a>)>;

/// A grid's levels, for blocks.
struct Shape {
    padded: u32,
    /// First word of each level, and their number.
    words: Vec<usize>,
}

impl Shape {
    fn new(grid: &VoxelGrid) -> Self {
        Self { padded: grid.padded(), words: word_starts(grid.padded()) }
    }

    fn level_count(&self) -> usize {
        self.words.len() - 1
    }

    fn word_count(&self) -> usize {
        self.words[self.level_count()]
    }

    /// The block of a level, without values.
    fn block(&self, level: usize) -> ReduceMipsBlock {
        ReduceMipsBlock {
            padded: self.padded,
            level_count: self.level_count() as u32,
            word_count: self.word_count() as u32,
            level: level as u32,
            word_begin: self.words[level] as u32,
            word_end: self.words[level + 1] as u32,
            below_word: self.words[level.saturating_sub(1)] as u32,
            ..ReduceMipsBlock::zeroed()
        }
    }
}

/// Runs the first of the kernels; see the contract.
///
/// # Errors
/// As [`twinlight_core::Backend::voxel_levels`]; [`twinlight_core::Error::LimitExceeded`] for masks and lists beyond one binding.
pub fn levels(device: &GpuDevice, voxels: &Voxels<GpuBackend>) -> Result<VoxelLevels<GpuBackend>> {
    check_voxels(voxels, GpuBuffer::len)?;
    let shape = Shape::new(&voxels.grid);
    device.expect_bindable::<u32>("ranks of voxels", shape.word_count() + 1)?;
    let (mask, counts) = masks(device, voxels, &shape)?;
    let mut ranks = device.zeroed::<u32>(counts.len())?;
    let total = scan::run(device, &counts, &mut ranks)?;
    device.expect_bindable::<u32>("codes of voxels", total as usize)?;
    let active = device.zeroed::<u32>(total as usize)?;
    let firsts = device.zeroed::<u32>(shape.level_count())?;
    let mut recorder = device.record("list the codes of voxels");
    let pipeline = device.pipeline(&SOURCE, "list_codes")?;
    let buffers = [
        ("level_mask", mask.binding()),
        ("level_ranks", ranks.binding()),
        ("active_codes", active.binding()),
        ("starts", firsts.binding()),
    ];
    let block = shape.block(0);
    recorder.dispatch(
        "list codes",
        &pipeline,
        &block,
        &buffers,
        block.word_count.div_ceil(WORKGROUP_SIZE),
    )?;
    recorder.run()?;
    let mut starts = device.download(&firsts)?;
    starts.push(total);
    Ok(VoxelLevelBuffers { grid: voxels.grid, starts, mask, ranks, active })
}

/// The masks of all levels and how many bits each word has, and a 0, so that a scan ends with the total.
fn masks(
    device: &GpuDevice,
    voxels: &Voxels<GpuBackend>,
    shape: &Shape,
) -> Result<(GpuBuffer<u32>, GpuBuffer<u32>)> {
    let mask = device.zeroed::<u32>(shape.word_count())?;
    let counts = device.zeroed::<u32>(shape.word_count() + 1)?;
    let pipeline = device.pipeline(&SOURCE, "fill_mask")?;
    let buffers =
        [("voxel_mask", voxels.mask.binding()), ("mask", mask.binding()), ("counts", counts.binding())];
    let mut recorder = device.record("masks of the levels of voxels");
    for level in 0..shape.level_count() {
        let block = shape.block(level);
        let workgroups = (block.word_end - block.word_begin).div_ceil(WORKGROUP_SIZE);
        recorder.dispatch("fill mask", &pipeline, &block, &buffers, workgroups)?;
    }
    recorder.run()?;
    Ok((mask, counts))
}

/// Runs the second of the kernels; see the contract.
///
/// # Errors
/// As [`twinlight_core::Backend::reduce_mips`]; [`twinlight_core::Error::LimitExceeded`] also for leaves and values beyond one binding.
pub fn reduce(
    device: &GpuDevice,
    levels: &VoxelLevels<GpuBackend>,
    leaves: &GpuBuffer<VoxelLight>,
    params: &ReduceMipsParams,
) -> Result<GpuBuffer<u32>> {
    let words = params.check(levels, GpuBuffer::len, leaves.len())?;
    let reduction = Reduction { device, levels, leaves, shape: Shape::new(&levels.grid) };
    if params.storage == HARMONICS_8 {
        return reduction.packed();
    }
    reduction.values(params.storage, words)
}

/// A call.
struct Reduction<'a> {
    device: &'a GpuDevice,
    levels: &'a VoxelLevels<GpuBackend>,
    leaves: &'a GpuBuffer<VoxelLight>,
    shape: Shape,
}

impl Reduction<'_> {
    /// Room for the values of all voxels.
    fn room(&self, words: usize) -> Result<GpuBuffer<u32>> {
        let len = words * self.levels.active.len();
        self.device.expect_bindable::<u32>("values of voxels", len)?;
        self.device.zeroed(len)
    }

    fn values(&self, storage: u32, words: usize) -> Result<GpuBuffer<u32>> {
        let values = self.room(words)?;
        let buffers = vec![
            ("level_mask", self.levels.mask.binding()),
            ("level_ranks", self.levels.ranks.binding()),
            ("level_codes", self.levels.active.binding()),
            ("leaves", self.leaves.binding()),
            ("values", values.binding()),
        ];
        let mut recorder = self.device.record("reduce voxels level by level");
        self.record(&mut recorder, storage, &buffers)?;
        recorder.run()?;
        Ok(values)
    }

    /// Records the dispatches of all levels.
    fn record<'b>(&self, recorder: &mut Recorder<'b>, storage: u32, buffers: &Bindings<'b>) -> Result<()> {
        let leaves = self.device.pipeline(&SOURCE, "store_leaves")?;
        let (entry, lanes) = match storage {
            ANISOTROPIC => ("reduce_anisotropic", 6),
            HARMONICS => ("reduce_harmonics", 3),
            SUMS => ("reduce_sums", 1),
            RANGES => ("reduce_ranges", 1),
            _ => ("reduce_isotropic", 1),
        };
        let parents = self.device.pipeline(&SOURCE, entry)?;
        for level in 0..self.shape.level_count() {
            let block = self.block(level, storage);
            let values = block.value_end - block.value_begin;
            let (pipeline, lanes) = if level == 0 { (&leaves, 1) } else { (&parents, lanes) };
            let workgroups = (values * lanes).div_ceil(WORKGROUP_SIZE);
            recorder.dispatch(entry, pipeline, &block, buffers, workgroups)?;
        }
        Ok(())
    }

    fn block(&self, level: usize, storage: u32) -> ReduceMipsBlock {
        let starts = &self.levels.starts;
        ReduceMipsBlock {
            storage,
            value_begin: starts[level],
            value_end: starts[level + 1],
            below_value: starts[level.saturating_sub(1)],
            ..self.shape.block(level)
        }
    }

    /// Harmonics of all voxels, and then their bytes.
    fn packed(&self) -> Result<GpuBuffer<u32>> {
        let harmonics = self.values(HARMONICS, 13)?;
        let packed = self.room(4)?;
        let pipeline = self.device.pipeline(&SOURCE, "pack_harmonics")?;
        let count = self.levels.active.len() as u32;
        let block = ReduceMipsBlock { value_end: count, ..self.shape.block(0) };
        let buffers = [("harmonics", harmonics.binding()), ("packed", packed.binding())];
        let mut recorder = self.device.record("pack harmonics");
        recorder.dispatch("pack harmonics", &pipeline, &block, &buffers, count.div_ceil(WORKGROUP_SIZE))?;
        recorder.run()?;
        Ok(packed)
    }
}
