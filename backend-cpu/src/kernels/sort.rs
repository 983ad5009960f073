// kernel family: sort
// contract core/src/kernels/sort.rs
// cpu backend-cpu/src/kernels/sort.rs
// gpu backend-gpu/src/kernels/sort.wgsl
// oracle conformance/src/oracle/sort.rs
//! `sort`: LSD radix sort, 8 bits per pass. Each pass counts the digits of every chunk, turns the counts into every
//! chunk's own places for every digit, and moves the pairs there.
//!
//! *Bytes.* A pass reads the keys, then reads and writes keys and payload: 20 bytes per 32-bit pair.
//! *Deviations.* Bits that all keys share are left out of the digits, and chunks stage pairs in cache so that memory is
//! written in whole lines (Satish et al., "Fast sort on CPUs and GPUs", 2010, §4).

use crate::buffer::try_zeroed;
use crate::parallel::Scattered;
use bytemuck::Pod;
use rayon::prelude::*;
use twinlight_core::Result;

mod scatter;

use scatter::{Destination, scatter};

/// Values of a digit.
const DIGITS: usize = 256;

/// Up to this length a comparison sort is quicker than counting digits.
const SMALL_LEN: usize = 256;

/// Chunk lengths: enough pairs per digit that staging pays, and few enough that chunks are more than threads.
const CHUNK_MIN: usize = 1 << 12;
const CHUNK_MAX: usize = 1 << 17;

/// Places of one chunk, by digit.
type Places = [u32; DIGITS];

/// An unsigned key.
pub(crate) trait Key: Pod + Ord + Send + Sync {
    /// The 8 bits from bit `shift` on.
    fn digit(self, shift: u32) -> u8;
    /// The bits in which the keys differ.
    fn differing(self, other: Self) -> u64;
}

impl Key for u32 {
    fn digit(self, shift: u32) -> u8 {
        (self >> shift) as u8
    }

    fn differing(self, other: Self) -> u64 {
        u64::from(self ^ other)
    }
}

impl Key for u64 {
    fn digit(self, shift: u32) -> u8 {
        (self >> shift) as u8
    }

    fn differing(self, other: Self) -> u64 {
        self ^ other
    }
}

/// Sorts `keys` with `payload` (of the same length), stably and ascending. The vectors' memory may be exchanged for
/// other memory of the same size.
pub(crate) fn sort<K: Key>(keys: &mut Vec<K>, payload: &mut Vec<u32>) -> Result<()> {
    if keys.len() <= SMALL_LEN {
        sort_small(keys, payload);
        return Ok(());
    }
    let chunk = chunk_len(keys.len());
    let shifts = digit_shifts(varying_bits(keys, chunk));
    if shifts.is_empty() {
        return Ok(());
    }
    let (mut keys_back, mut payload_back) = (try_zeroed(keys.len())?, try_zeroed(payload.len())?);
    let mut places = try_zeroed::<Places>(keys.len().div_ceil(chunk))?;
    for shift in shifts {
        // [1] count
        places.par_iter_mut().zip(keys.par_chunks(chunk)).for_each(|(p, keys)| *p = count(keys, shift));
        // [2] places
        counts_to_places(&mut places);
        // [3] scatter
        let to =
            Destination { keys: Scattered::new(&mut keys_back), payload: Scattered::new(&mut payload_back) };
        let from = keys.par_chunks(chunk).zip(payload.par_chunks(chunk));
        // SAFETY: the places of all chunks and digits are exclusive prefix sums of the counts of these same keys, so
        // every pair has a place of its own inside the destination.
        from.zip(&places).for_each(|((keys, payload), places)| unsafe {
            scatter(keys, payload, shift, places, &to);
        });
        std::mem::swap(keys, &mut keys_back);
        std::mem::swap(payload, &mut payload_back);
    }
    Ok(())
}

fn sort_small<K: Key>(keys: &mut [K], payload: &mut [u32]) {
    let mut pairs = [(K::zeroed(), 0_u32); SMALL_LEN];
    let pairs = &mut pairs[..keys.len()];
    for (pair, (&key, &value)) in pairs.iter_mut().zip(keys.iter().zip(payload.iter())) {
        *pair = (key, value);
    }
    pairs.sort_by_key(|pair| pair.0);
    for ((key, value), pair) in keys.iter_mut().zip(payload).zip(pairs) {
        (*key, *value) = *pair;
    }
}

fn chunk_len(len: usize) -> usize {
    (len / 64).next_power_of_two().clamp(CHUNK_MIN, CHUNK_MAX)
}

/// The bits that aren't the same in all keys.
fn varying_bits<K: Key>(keys: &[K], chunk: usize) -> u64 {
    let first = keys[0];
    let of_chunk = |keys: &[K]| keys.iter().fold(0, |bits, &key| bits | key.differing(first));
    keys.par_chunks(chunk).map(of_chunk).reduce(|| 0, |a, b| a | b)
}

/// Where digits begin, from the lowest: each covers the lowest varying bit that no earlier one does.
fn digit_shifts(mut varying: u64) -> Vec<u32> {
    let mut shifts = Vec::new();
    while varying != 0 {
        let shift = varying.trailing_zeros();
        shifts.push(shift);
        varying &= !(0xFF << shift);
    }
    shifts
}

/// Counts digits in four tables: neighbouring equal digits don't wait for each other's increments.
fn count<K: Key>(keys: &[K], shift: u32) -> Places {
    let mut tables = [[0_u32; DIGITS]; 4];
    let (quads, rest) = keys.as_chunks::<4>();
    for quad in quads {
        for (table, key) in tables.iter_mut().zip(quad) {
            table[usize::from(key.digit(shift))] += 1;
        }
    }
    for key in rest {
        tables[0][usize::from(key.digit(shift))] += 1;
    }
    let [a, b, c, d] = &tables;
    std::array::from_fn(|i| a[i] + b[i] + c[i] + d[i])
}

/// Exclusive prefix sums over (digit, chunk), digit major: of equal digits those of earlier chunks come first.
fn counts_to_places(counts: &mut [Places]) {
    let mut place = 0;
    for digit in 0..DIGITS {
        for chunk in counts.iter_mut() {
            place += std::mem::replace(&mut chunk[digit], place);
        }
    }
}
