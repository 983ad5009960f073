// kernel family: scan
// contract core/src/kernels/scan.rs
// cpu backend-cpu/src/kernels/scan.rs
// gpu backend-gpu/src/kernels/scan.wgsl
// oracle conformance/src/oracle/scan.rs
//! Host side of `scan`.

use crate::buffer::{BufferRef, CHUNK_GRAIN, GpuBuffer, chunks};
use crate::device::GpuDevice;
use crate::dispatch::Recorder;
use crate::pipeline::Pipeline;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use std::sync::Arc;
use twinlight_core::kernels::scan::MAX_LEN;
use twinlight_core::{Error, Result};

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "scan",
    files: &[WgslFile { path: "backend-gpu/src/kernels/scan.wgsl", text: include_str!("scan.wgsl") }],
};

/// Elements per workgroup; twin of the WGSL constant.
pub const TILE_SIZE: u32 = 4096;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct ScanParams {
    /// Elements of input and output.
    pub count: u32,
    /// Tiles that hold them.
    pub tile_count: u32,
}

/// The three pipelines.
#[derive(Debug)]
pub struct Scan {
    reduce_tiles: Arc<Pipeline>,
    scan_tile_sums: Arc<Pipeline>,
    scan_tiles: Arc<Pipeline>,
}

impl Scan {
    /// Compiles what isn't compiled yet.
    ///
    /// # Errors
    /// As [`GpuDevice::pipeline`].
    pub fn new(device: &GpuDevice) -> Result<Self> {
        Ok(Self {
            reduce_tiles: device.pipeline(&SOURCE, "reduce_tiles")?,
            scan_tile_sums: device.pipeline(&SOURCE, "scan_tile_sums")?,
            scan_tiles: device.pipeline(&SOURCE, "scan_tiles")?,
        })
    }

    /// Records the scan of the first `count` elements, in parts of `most` or fewer, as [`chunk`] gives it. `tile_sums` has
    /// a tile's sum per element and one element more, which receives the total.
    ///
    /// # Errors
    /// As [`Recorder::dispatch`].
    pub fn record<'a>(
        &self,
        recorder: &mut Recorder<'a>,
        input: &'a GpuBuffer<u32>,
        tile_sums: &'a GpuBuffer<u32>,
        output: &'a GpuBuffer<u32>,
        (count, most): (usize, usize),
    ) -> Result<()> {
        let part = |elements: Range<usize>| {
            let tiles = elements.start / TILE_SIZE as usize..elements.end.div_ceil(TILE_SIZE as usize);
            let params = ScanParams { count: elements.len() as u32, tile_count: tiles.len() as u32 };
            let read =
                [("input", input.binding_of(elements.clone())), ("tile_sums", tile_sums.binding_of(tiles))];
            (params, read, ("output", output.binding_of(elements)))
        };
        for elements in chunks(count, most) {
            let (params, read, _) = part(elements);
            recorder.dispatch("sum every tile", &self.reduce_tiles, &params, &read, params.tile_count)?;
        }
        self.record_in_place(recorder, count.div_ceil(TILE_SIZE as usize) as u32, tile_sums.binding())?;
        for elements in chunks(count, most) {
            let (params, [input, tile_sums], output) = part(elements);
            let buffers = [input, tile_sums, output];
            recorder.dispatch("scan every tile", &self.scan_tiles, &params, &buffers, params.tile_count)?;
        }
        Ok(())
    }

    /// Records the scan of a short buffer by one workgroup, in place; element `count` receives the total.
    ///
    /// # Errors
    /// As [`Recorder::dispatch`].
    pub fn record_in_place<'a>(
        &self,
        recorder: &mut Recorder<'a>,
        count: u32,
        values: BufferRef<'a>,
    ) -> Result<()> {
        let params = ScanParams { count: 0, tile_count: count };
        recorder.dispatch("scan the sums", &self.scan_tile_sums, &params, &[("tile_sums", values)], 1)
    }
}

/// Elements that one part of a scan may have: whole tiles, whose sums begin at a grain too. 0 where a binding holds less
/// than a mebibyte: such a scan has one part or is refused.
pub fn chunk(device: &GpuDevice) -> usize {
    let step = TILE_SIZE as usize * CHUNK_GRAIN;
    device.elements_per_binding(size_of::<u32>()) / step * step
}

/// Runs the kernel; see the contract.
///
/// # Errors
/// [`Error::InvalidInput`] when the lengths differ, [`Error::LimitExceeded`] beyond [`MAX_LEN`] or where a binding holds
/// too little for one part.
pub fn run(device: &GpuDevice, input: &GpuBuffer<u32>, output: &mut GpuBuffer<u32>) -> Result<u32> {
    if input.len() != output.len() {
        return Err(Error::invalid("scan", format!("{} inputs, {} outputs", input.len(), output.len())));
    }
    if input.len() > MAX_LEN {
        return Err(Error::limit("elements of scan", input.len() as u64, MAX_LEN as u64));
    }
    if input.is_empty() {
        return Ok(0);
    }
    let scan = Scan::new(device)?;
    let tile_count = input.len().div_ceil(TILE_SIZE as usize);
    let tile_sums = device.zeroed::<u32>(tile_count + 1)?;
    let mut recorder = device.record("scan counts into offsets");
    scan.record(&mut recorder, input, &tile_sums, output, (input.len(), chunk(device)))?;
    recorder.run()?;
    Ok(device.download_range(&tile_sums, tile_count, 1)?[0])
}
