//! The `status` buffer: how a kernel tells the host that the adapter didn't run it as written.

use crate::buffer::GpuBuffer;
use crate::device::GpuDevice;
use twinlight_core::{Error, Result};

/// Rounds of the loop that a kernel runs last to see whether loops still run. More than one, because a spent loop still
/// runs once.
pub(crate) const LOOP_ROUNDS: u32 = 16;

/// Word 0: a loop ended early. The others belong to the kernel.
pub(crate) const STATUS_WORDS: usize = 8;

/// A fresh status.
pub(crate) fn new(device: &GpuDevice) -> Result<GpuBuffer<u32>> {
    device.zeroed(STATUS_WORDS)
}

/// Makes a status fresh again.
pub(crate) fn clear(device: &GpuDevice, status: &GpuBuffer<u32>) -> Result<()> {
    device.write(status, &[0; STATUS_WORDS])
}

/// The status after a run.
///
/// # Errors
/// [`Error::Unsupported`] when loops ended early, so that the results are wrong.
pub(crate) fn read(device: &GpuDevice, status: &GpuBuffer<u32>, kernel: &str) -> Result<Vec<u32>> {
    let words = device.download(status)?;
    if words[0] != 0 {
        return Err(Error::Unsupported(format!(
            "{kernel} on {}: the driver ended a loop before its condition did (llvmpipe allows 65535 rounds per \
             invocation), the result is void; use the CPU backend or another adapter",
            device.report().name
        )));
    }
    Ok(words)
}
