//! Bugs in `sort`.

use crate::faults::Fault;
use bytemuck::Pod;
use twinlight_core::{Backend, Result};

/// A key type of the contract.
pub(super) trait Key: Pod + Send + Sync + Ord {
    fn run<B: Backend>(inner: &B, keys: &mut B::Buffer<Self>, payload: &mut B::Buffer<u32>) -> Result<()>;
    /// What the bug sorts by instead.
    fn broken(self, fault: Fault) -> u64;
}

impl Key for u32 {
    fn run<B: Backend>(inner: &B, keys: &mut B::Buffer<u32>, payload: &mut B::Buffer<u32>) -> Result<()> {
        inner.sort_u32(keys, payload)
    }

    fn broken(self, fault: Fault) -> u64 {
        u64::from(match fault {
            Fault::SortSkipsPass => self & 0x00ff_ffff,
            Fault::SortSigned => self ^ 0x8000_0000,
            _ => self,
        })
    }
}

impl Key for u64 {
    fn run<B: Backend>(inner: &B, keys: &mut B::Buffer<u64>, payload: &mut B::Buffer<u32>) -> Result<()> {
        inner.sort_u64(keys, payload)
    }

    fn broken(self, fault: Fault) -> u64 {
        if fault == Fault::SortSkipsMiddlePass { self & !(0xff << 32) } else { self }
    }
}

pub(super) fn sort<K: Key, B: Backend>(
    inner: &B,
    fault: Fault,
    keys: &mut B::Buffer<K>,
    payload: &mut B::Buffer<u32>,
) -> Result<()> {
    if fault == Fault::SortAcceptsLengths && inner.len(keys) != inner.len(payload) {
        return Ok(());
    }
    let before: Vec<(K, u32)> = pairs(inner, keys, payload)?;
    K::run(inner, keys, payload)?;
    let mut after = pairs(inner, keys, payload)?;
    match fault {
        Fault::SortUnstable => {
            if let Some(i) = after.windows(2).position(|w| w[0].0 == w[1].0) {
                after.swap(i, i + 1);
            }
        }
        Fault::SortSkipsPass | Fault::SortSkipsMiddlePass | Fault::SortSigned => {
            after = before;
            after.sort_by_key(|(key, _)| key.broken(fault));
        }
        Fault::SortKeepsPayload => after.iter_mut().zip(&before).for_each(|(a, b)| a.1 = b.1),
        Fault::SortDescending => after.reverse(),
        Fault::SortDropsLast => {
            if let Some((last, rest)) = before.split_last() {
                after = rest.to_vec();
                after.sort_by_key(|(key, _)| *key);
                after.push(*last);
            }
        }
        _ => return Ok(()),
    }
    let (sorted_keys, sorted_payload): (Vec<K>, Vec<u32>) = after.into_iter().unzip();
    *keys = inner.upload(&sorted_keys)?;
    *payload = inner.upload(&sorted_payload)?;
    Ok(())
}

fn pairs<K: Key, B: Backend>(
    inner: &B,
    keys: &B::Buffer<K>,
    payload: &B::Buffer<u32>,
) -> Result<Vec<(K, u32)>> {
    Ok(inner.download(keys)?.into_iter().zip(inner.download(payload)?).collect())
}
