//! Triangles of a list cut into items, for the kernels that go over the voxels of triangles.

use super::{SOURCE, VoxelizeBlock, WORKGROUP_SIZE};
use crate::buffer::{BufferRef, GpuBuffer, chunks};
use crate::device::GpuDevice;
use crate::kernels::scan;
use crate::mesh::GpuMesh;
use bytemuck::{Pod, Zeroable};
use twinlight_core::Result;
use twinlight_core::lattice::VoxelGrid;

/// Cells of a small triangle's item. With columns of at most 512 voxels an invocation's loops stay below the 65535 rounds that
/// llvmpipe gives them.
const SMALL_CELLS: u32 = 64;

/// Cells of a large triangle's item: to find a triangle and set it up takes as long as a few cells.
const LARGE_CELLS: u32 = 8;

/// Triangles that are set up at once: 32 MiB.
const MAX_LISTED: usize = 1 << 20;

/// Cells per submission: one that takes seconds looks like a device that hangs.
const MAX_CELLS: u32 = 1 << 22;

/// What the parameters of the kernels over items begin with; twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct VoxelItems {
    /// The grid.
    pub grid: VoxelGrid,
    /// Thin or conservative.
    pub separation: u32,
    /// Triangles of the mesh.
    pub triangle_count: u32,
    /// Triangles of the dispatch's part of the list.
    pub list_count: u32,
    /// Cells per item.
    pub cells_per_item: u32,
    /// Most items of a triangle.
    pub most_items: u32,
    /// First item of the dispatch.
    pub item_begin: u32,
    /// The item after the last.
    pub item_end: u32,
    /// Unused, 0.
    pub padding: u32,
}

/// A triangle of a list in grid coordinates; twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct ListedTriangle {
    /// Per corner x and y in the halves of a word, x in the low one, and z.
    pub corners: [[u32; 2]; 3],
    /// Its number.
    pub triangle: u32,
    /// Unused, 0.
    pub padding: u32,
}

/// A list of triangles, and how they are cut.
#[derive(Clone, Copy)]
pub(crate) struct Class<'a> {
    list: &'a GpuBuffer<u32>,
    cells_per_item: u32,
    /// Most cells of a triangle; of lists of other origin those beyond are left out.
    most_cells: u32,
}

impl<'a> Class<'a> {
    /// Triangles of at most `cutoff` cells.
    pub(crate) fn small(grid: &VoxelGrid, list: &'a GpuBuffer<u32>, cutoff: u32) -> Self {
        Self { list, cells_per_item: SMALL_CELLS, most_cells: cutoff.min(face(grid)) }
    }

    /// Those of more.
    pub(crate) fn large(grid: &VoxelGrid, list: &'a GpuBuffer<u32>) -> Self {
        Self { list, cells_per_item: LARGE_CELLS, most_cells: face(grid) }
    }

    /// Most items of a triangle.
    fn most_items(&self) -> u32 {
        self.most_cells.div_ceil(self.cells_per_item)
    }
}

/// How many triangles of at most `most_items` each have items that are counted in one word; in multiples of 64, from which on lists
/// can be bound.
fn countable(most_items: u32) -> usize {
    (u32::MAX / most_items.max(1)) as usize / 64 * 64
}

/// Cells of the grid's greatest face.
fn face(grid: &VoxelGrid) -> u32 {
    let [x, y, z] = grid.dims;
    (x * y).max(y * z).max(z * x)
}

/// The items of a list in runs of one submission each: calls `work` with the parameters of each run and the buffers that
/// `shared/voxel_items.wgsl` wants. `call` has the grid and the mesh.
///
/// # Errors
/// Those of `work`; [`twinlight_core::Error::LimitExceeded`] where a binding has no room for 64 triangles.
pub(crate) fn for_each_run(
    device: &GpuDevice,
    mesh: &GpuMesh,
    call: VoxelItems,
    class: Class<'_>,
    mut work: impl FnMut(VoxelItems, [(&'static str, BufferRef<'_>); 2]) -> Result<()>,
) -> Result<()> {
    let (Class { list, cells_per_item, .. }, most_items) = (class, class.most_items());
    let bindable = device.elements_per_binding(size_of::<ListedTriangle>());
    for part in chunks(list.len(), countable(most_items).min(bindable).min(MAX_LISTED)) {
        let list_count = part.len() as u32;
        let call = VoxelItems { list_count, cells_per_item, most_items, ..call };
        let (listed, offsets, total) = sized(device, mesh, call, list.binding_of(part))?;
        let buffers = [("listed", listed.binding()), ("item_offsets", offsets.binding())];
        let step = MAX_CELLS / cells_per_item;
        for item_begin in (0..total).step_by(step as usize) {
            let item_end = total.min(item_begin.saturating_add(step));
            work(VoxelItems { item_begin, item_end, ..call }, buffers)?;
        }
    }
    Ok(())
}

/// The triangles of a part of a list, the scan of their numbers of items, and its total.
fn sized(
    device: &GpuDevice,
    mesh: &GpuMesh,
    call: VoxelItems,
    list: BufferRef<'_>,
) -> Result<(GpuBuffer<ListedTriangle>, GpuBuffer<u32>, u32)> {
    let count = call.list_count as usize;
    let (listed, sizes) = (device.zeroed(count)?, device.zeroed::<u32>(count)?);
    let mut offsets = device.zeroed::<u32>(count)?;
    let buffers = [
        ("vertices", mesh.vertices()),
        ("triangles", mesh.triangles()),
        ("list", list),
        ("set_up", listed.binding()),
        ("sizes", sizes.binding()),
    ];
    let params = VoxelizeBlock { items: call, ..VoxelizeBlock::zeroed() };
    let pipeline = device.pipeline(&SOURCE, "size_items")?;
    let mut recorder = device.record("cut triangles into items");
    let workgroups = call.list_count.div_ceil(WORKGROUP_SIZE);
    recorder.dispatch("size items", &pipeline, &params, &buffers, workgroups)?;
    recorder.run()?;
    let total = scan::run(device, &sizes, &mut offsets)?;
    Ok((listed, offsets, total))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_of_a_part_are_counted_in_one_word() {
        let face = 1_u32 << 18;
        for most_items in [0, 1, 2, 63, 4096, face / LARGE_CELLS, face] {
            let count = countable(most_items) as u64;
            assert!(count > 0 && count.is_multiple_of(64), "{most_items}: {count}");
            assert!(count * u64::from(most_items) <= u64::from(u32::MAX), "{most_items}: {count}");
        }
    }
}
