//! Typed arrays in host memory, and allocations that fail instead of aborting.

use crate::huge;
use bytemuck::Zeroable;
use twinlight_core::{Error, Result};

/// A typed array in host memory.
#[derive(Debug, Clone)]
pub struct CpuBuffer<T>(Vec<T>);

impl<T> CpuBuffer<T> {
    /// The elements.
    pub fn as_slice(&self) -> &[T] {
        &self.0
    }

    /// The elements, to change in place.
    pub fn as_mut_slice(&mut self) -> &mut [T] {
        &mut self.0
    }
}

impl<T> From<Vec<T>> for CpuBuffer<T> {
    fn from(elements: Vec<T>) -> Self {
        Self(elements)
    }
}

pub(crate) fn out_of_memory<T>(len: usize) -> Error {
    let bytes = (len as u64).saturating_mul(size_of::<T>() as u64);
    Error::OutOfMemory { device: "host".into(), bytes }
}

/// A copy of `data`.
pub(crate) fn try_copy<T: Clone>(data: &[T]) -> Result<Vec<T>> {
    let mut copy = Vec::new();
    copy.try_reserve_exact(data.len()).map_err(|_| out_of_memory::<T>(data.len()))?;
    copy.extend_from_slice(data);
    Ok(copy)
}

/// `len` zeroed elements, from pages that the system zeroes when they are first touched.
pub(crate) fn try_zeroed<T: Zeroable>(len: usize) -> Result<Vec<T>> {
    match bytemuck::allocation::try_zeroed_slice_box(len) {
        Ok(mut zeroes) => {
            huge::advise(&mut zeroes);
            Ok(Vec::from(zeroes))
        }
        Err(()) => Err(out_of_memory::<T>(len)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_beyond_memory_is_an_error() {
        let len = usize::MAX / 16;
        match try_zeroed::<u64>(len) {
            Err(Error::OutOfMemory { bytes, .. }) => assert_eq!(bytes, len as u64 * 8),
            other => panic!("{:?}", other.map(|v| v.len())),
        }
        assert!(matches!(try_zeroed::<u64>(usize::MAX), Err(Error::OutOfMemory { bytes: u64::MAX, .. })));
    }

    #[test]
    fn copies_and_zeroes_hold_what_they_should() {
        assert_eq!(try_copy(&[1_u32, 2]).unwrap(), [1, 2]);
        assert_eq!(try_copy::<u32>(&[]).unwrap(), []);
        assert_eq!(try_zeroed::<u64>(3).unwrap(), [0; 3]);
        assert!(try_zeroed::<u64>(3 << 20).unwrap().iter().all(|&word| word == 0));
        assert_eq!(try_zeroed::<u64>(0).unwrap(), []);
    }
}
