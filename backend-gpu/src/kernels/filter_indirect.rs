// kernel family: filter_indirect
// contract core/src/kernels/filter_indirect.rs
// cpu backend-cpu/src/kernels/filter_indirect.rs
// gpu backend-gpu/src/kernels/filter_indirect.wgsl
// oracle conformance/src/oracle/filter_indirect.rs
//! Host side of `filter_indirect`: pictures whose G-buffer is beyond one binding are filtered part by part, each bound with the rows
//! that its windows reach.

use crate::buffer::{CHUNK_GRAIN, GpuBuffer, chunks};
use crate::device::GpuDevice;
use crate::kernels::status;
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, RadianceTexel};
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::{Error, Result};

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "filter_indirect",
    files: &[
        shared::DISPATCH,
        shared::TRIG,
        shared::VECTOR,
        WgslFile {
            path: "backend-gpu/src/kernels/filter_indirect.wgsl",
            text: include_str!("filter_indirect.wgsl"),
        },
    ],
};

/// Pixels per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 64;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct FilterIndirectBlock {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Pixels per row and column of the window.
    pub window: u32,
    /// Least cosine between normals.
    pub least_cosine: f32,
    /// Width of a pixel at depth 1.
    pub footprint: f32,
    /// Elements of `diffuse`.
    pub diffuse_count: u32,
    /// The pixels of the dispatch; `output` begins with the first of them.
    pub pixel_begin: u32,
    /// How many.
    pub pixel_count: u32,
    /// The pixel that `gbuffer` and `input` begin with.
    pub neighbour_begin: u32,
    /// For `loops_run`.
    pub loop_rounds: u32,
    /// Unused, 0.
    pub padding: [u32; 2],
}

/// Filters a picture; see the contract.
///
/// # Errors
/// As [`FilterIndirectParams::check`]; [`Error::LimitExceeded`] beyond 2³² pixels or materials, for materials beyond a binding and for
/// rows of which a window's are beyond one; [`Error::Unsupported`] when the driver ends loops early.
pub fn run(
    device: &GpuDevice,
    gbuffer: &GpuBuffer<GBufferTexel>,
    diffuse: &GpuBuffer<u32>,
    input: &GpuBuffer<RadianceTexel>,
    params: &FilterIndirectParams,
    output: &mut GpuBuffer<RadianceTexel>,
) -> Result<()> {
    let pixels = params.check([gbuffer.len(), input.len(), output.len()])?;
    check_count("pixels of one call", pixels)?;
    let pipeline = device.pipeline(&SOURCE, "filter_indirect")?;
    let status = status::new(device)?;
    let mut recorder = device.record("filter indirect light");
    let most = device.elements_per_binding(size_of::<GBufferTexel>());
    for part in chunks(pixels, part_len(params, pixels, most)) {
        let neighbours = neighbours(params, pixels, &part);
        let block = FilterIndirectBlock {
            width: params.width,
            height: params.height,
            window: params.window,
            least_cosine: params.least_cosine,
            footprint: params.footprint,
            diffuse_count: check_count("materials", diffuse.len())?,
            pixel_begin: part.start as u32,
            pixel_count: part.len() as u32,
            neighbour_begin: neighbours.start as u32,
            loop_rounds: status::LOOP_ROUNDS,
            padding: [0; 2],
        };
        let buffers = [
            ("gbuffer", gbuffer.binding_of(neighbours.clone())),
            ("diffuse", diffuse.binding()),
            ("input", input.binding_of(neighbours)),
            ("output", output.binding_of(part)),
            ("status", status.binding()),
        ];
        let workgroups = block.pixel_count.div_ceil(WORKGROUP_SIZE);
        recorder.dispatch("filter", &pipeline, &block, &buffers, workgroups)?;
    }
    recorder.run()?;
    status::read(device, &status, "filter_indirect")?;
    Ok(())
}

fn check_count(what: &str, count: usize) -> Result<u32> {
    u32::try_from(count).map_err(|_| Error::limit(what, count as u64, u32::MAX.into()))
}

/// Pixels of a part, in whole grains, so that a binding of `most` elements holds their neighbours too. 0 where there is no such number.
fn part_len(params: &FilterIndirectParams, pixels: usize, most: usize) -> usize {
    if pixels <= most {
        return pixels;
    }
    // Rows above and below, what a part leaves of its first and last row, and what lies before the first whole grain.
    let rows = params.window as usize / 2 * 2 + 2;
    let beside = rows.saturating_mul(params.width as usize).saturating_add(CHUNK_GRAIN);
    most.saturating_sub(beside) / CHUNK_GRAIN * CHUNK_GRAIN
}

/// The rows that the windows of some pixels reach, from a whole grain on.
fn neighbours(params: &FilterIndirectParams, pixels: usize, part: &Range<usize>) -> Range<usize> {
    let (width, reach) = (params.width as usize, params.window as usize / 2);
    let first_row = (part.start / width).saturating_sub(reach);
    let last_row = (part.end - 1) / width + reach;
    first_row * width / CHUNK_GRAIN * CHUNK_GRAIN..pixels.min((last_row + 1) * width)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parts cover a picture, and a binding holds what each needs.
    #[test]
    fn bindings_hold_parts_and_their_neighbours() {
        for (width, height, window) in [(100, 100, 8), (64, 999, 32), (7, 3000, 1), (333, 65, 5)] {
            let params = FilterIndirectParams { width, height, window, ..FilterIndirectParams::zeroed() };
            let (pixels, most) = ((width * height) as usize, 5120);
            let mut end = 0;
            for part in chunks(pixels, part_len(&params, pixels, most)) {
                assert_eq!(part.start, end);
                end = part.end;
                let bound = neighbours(&params, pixels, &part);
                assert!(bound.len() <= most && bound.start.is_multiple_of(CHUNK_GRAIN));
                let (first, last) = (part.start / width as usize, (part.end - 1) / width as usize);
                let reach = window as usize / 2;
                assert!(bound.start <= first.saturating_sub(reach) * width as usize);
                assert!(bound.end >= (last + reach + 1).min(height as usize) * width as usize);
            }
            assert_eq!(end, pixels);
        }
        let wide =
            FilterIndirectParams { width: 4000, height: 9, window: 8, ..FilterIndirectParams::zeroed() };
        assert_eq!(part_len(&wide, 36_000, 5120), 0);
        assert_eq!(part_len(&wide, 36_000, 36_000), 36_000);
    }
}
