//! Bugs in `scan`.

use crate::faults::Fault;
use twinlight_core::{Backend, Result};

pub(super) fn scan<B: Backend>(
    inner: &B,
    fault: Fault,
    input: &B::Buffer<u32>,
    output: &mut B::Buffer<u32>,
) -> Result<u32> {
    if fault == Fault::ScanAcceptsLengths && inner.len(input) != inner.len(output) {
        return Ok(0);
    }
    let before = inner.download(output)?;
    let mut total = inner.scan(input, output)?;
    let counts = inner.download(input)?;
    let mut offsets = inner.download(output)?;
    let last = counts.last().copied().unwrap_or(0);
    match fault {
        Fault::ScanInclusive => {
            for (offset, count) in offsets.iter_mut().zip(&counts) {
                *offset = offset.wrapping_add(*count);
            }
        }
        Fault::ScanLostCarry => lose_carry(&mut offsets, 256),
        Fault::ScanLostLateCarry => lose_carry(&mut offsets, 65_536),
        Fault::ScanLastElement => {
            if let (Some(offset), Some(old)) = (offsets.last_mut(), before.last()) {
                *offset = *old;
            }
        }
        Fault::ScanTotalWithoutLast => total = total.wrapping_sub(last),
        Fault::ScanSaturates => {
            let mut sum = 0_u32;
            for (offset, count) in offsets.iter_mut().zip(&counts) {
                *offset = sum;
                sum = sum.saturating_add(*count);
            }
            total = sum;
        }
        _ => return Ok(total),
    }
    *output = inner.upload(&offsets)?;
    Ok(total)
}

fn lose_carry(offsets: &mut [u32], chunk: usize) {
    if let Some(&carry) = offsets.get(chunk) {
        offsets[chunk..].iter_mut().for_each(|offset| *offset = offset.wrapping_sub(carry));
    }
}
