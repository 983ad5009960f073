// kernel family: sort
// contract core/src/kernels/sort.rs
// cpu backend-cpu/src/kernels/sort.rs
// gpu backend-gpu/src/kernels/sort.wgsl
// oracle conformance/src/oracle/sort.rs
//! `sort`: LSD radix sort, 8 bits per pass. Each pass counts the digits of every chunk, turns the counts into every
//! chunk's own places for every digit, and moves the pairs there: from the caller's arrays to an array of pairs, in
//! the next pass back.
//!
//! *Bytes.* Of a 32-bit key: 4 read for the bits that vary; 4 + 8 read and 8 written in a pass to pairs, 8 + 8 read and
//! 8 written in a pass back.
//! *Choices.* Pairs beside each other make one store of two. Collecting a digit's pairs in cache and writing whole lines
//! (Satish et al., "Fast sort on CPUs and GPUs", 2010, §4) was slower by half for 256 digits: so many open lines fit
//! into today's caches and address tables without help.

use crate::buffer::try_zeroed;
use crate::parallel::Scattered;
use crate::scratch::Scratch;
use bytemuck::Pod;
use rayon::prelude::*;
use std::ops::{BitOr, BitXor};
use twinlight_core::Result;

mod digits;

use digits::{Places, count, counts_to_places, deal, digit_shifts, varying_bits};

/// Up to this length a comparison sort is quicker than counting digits.
const SMALL_LEN: usize = 256;

/// Chunk lengths: enough pairs per digit that its counts cost little, and few enough that chunks are more than threads.
const CHUNK_MIN: usize = 1 << 14;
const CHUNK_MAX: usize = 1 << 17;

/// An unsigned key.
pub(crate) trait Key:
    Pod + Ord + Send + Sync + Into<u64> + BitOr<Output = Self> + BitXor<Output = Self>
{
    /// Key and payload in 32-bit words, without padding.
    type Pair: Pod + Send + Sync;

    /// Puts a pair together.
    fn pair(self, payload: u32) -> Self::Pair;

    /// Takes a pair apart.
    fn parts(pair: Self::Pair) -> (Self, u32);

    /// The 8 bits from bit `shift` on.
    fn digit(self, shift: u32) -> u8;
}

impl Key for u32 {
    type Pair = [u32; 2];

    fn pair(self, payload: u32) -> [u32; 2] {
        [self, payload]
    }

    fn parts([key, payload]: [u32; 2]) -> (Self, u32) {
        (key, payload)
    }

    fn digit(self, shift: u32) -> u8 {
        (self >> shift) as u8
    }
}

impl Key for u64 {
    type Pair = [u32; 3];

    fn pair(self, payload: u32) -> [u32; 3] {
        [self as u32, (self >> 32) as u32, payload]
    }

    fn parts([low, high, payload]: [u32; 3]) -> (Self, u32) {
        (Self::from(low) | Self::from(high) << 32, payload)
    }

    fn digit(self, shift: u32) -> u8 {
        (self >> shift) as u8
    }
}

/// Sorts `keys` with `payload` (of the same length), stably and ascending.
pub(crate) fn sort<K: Key>(keys: &mut [K], payload: &mut [u32], scratch: &Scratch) -> Result<()> {
    if keys.len() <= SMALL_LEN {
        sort_small(keys, payload);
        return Ok(());
    }
    // From outside the pool, one change of threads instead of one per loop.
    rayon::scope(|_| sort_by_digits(keys, payload, scratch))
}

fn sort_by_digits<K: Key>(keys: &mut [K], payload: &mut [u32], scratch: &Scratch) -> Result<()> {
    let chunk = (keys.len() / 64).next_power_of_two().clamp(CHUNK_MIN, CHUNK_MAX);
    let shifts = digit_shifts(varying_bits(keys, chunk));
    if shifts.is_empty() {
        return Ok(());
    }
    let mut places: Vec<Places> = try_zeroed(keys.len().div_ceil(chunk))?;
    let words = keys.len() * (size_of::<K::Pair>() / size_of::<u32>());
    scratch.lend(words, |words| {
        let pairs: &mut [K::Pair] = bytemuck::cast_slice_mut(words);
        for shifts in shifts.chunks(2) {
            to_pairs(keys, payload, pairs, shifts[0], chunk, &mut places);
            match shifts.get(1) {
                Some(&shift) => from_pairs(pairs, keys, payload, shift, chunk, &mut places),
                None => unzip(pairs, keys, payload, chunk),
            }
        }
    })
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

/// One pass by the digit at `shift`, from the caller's arrays to pairs.
fn to_pairs<K: Key>(
    keys: &[K],
    payload: &[u32],
    pairs: &mut [K::Pair],
    shift: u32,
    chunk: usize,
    places: &mut [Places],
) {
    // [1] count
    places
        .par_iter_mut()
        .zip(keys.par_chunks(chunk))
        .for_each(|(places, keys)| *places = count(keys.iter().copied(), shift));
    // [2] places
    counts_to_places(places);
    // [3] scatter
    let to = Scattered::new(pairs);
    keys.par_chunks(chunk).zip(payload.par_chunks(chunk)).zip(places).for_each(
        |((keys, payload), places)| {
            let from = keys.iter().copied().zip(payload.iter().copied());
            // SAFETY: places are exclusive prefix sums of the counts of these same keys, in number as many as the
            // destination has elements: each is inside it and dealt to one pair.
            deal(from, shift, places, |place, (key, value)| unsafe { to.write(place, key.pair(value)) });
        },
    );
}

/// One pass by the digit at `shift`, from pairs to the caller's arrays.
fn from_pairs<K: Key>(
    pairs: &[K::Pair],
    keys: &mut [K],
    payload: &mut [u32],
    shift: u32,
    chunk: usize,
    places: &mut [Places],
) {
    // [1] count
    places
        .par_iter_mut()
        .zip(pairs.par_chunks(chunk))
        .for_each(|(places, pairs)| *places = count(pairs.iter().map(|&pair| K::parts(pair).0), shift));
    // [2] places
    counts_to_places(places);
    // [3] scatter
    let (to_keys, to_payload) = (Scattered::new(keys), Scattered::new(payload));
    pairs.par_chunks(chunk).zip(places).for_each(|(pairs, places)| {
        deal(pairs.iter().map(|&pair| K::parts(pair)), shift, places, |place, (key, value)| {
            // SAFETY: as in `to_pairs`; both destinations are as long as `pairs`.
            unsafe {
                to_keys.write(place, key);
                to_payload.write(place, value);
            }
        });
    });
}

/// Copies pairs to the caller's arrays.
fn unzip<K: Key>(pairs: &[K::Pair], keys: &mut [K], payload: &mut [u32], chunk: usize) {
    let to = keys.par_chunks_mut(chunk).zip(payload.par_chunks_mut(chunk));
    to.zip(pairs.par_chunks(chunk)).for_each(|((keys, payload), pairs)| {
        for ((key, value), pair) in keys.iter_mut().zip(payload).zip(pairs) {
            (*key, *value) = K::parts(*pair);
        }
    });
}
