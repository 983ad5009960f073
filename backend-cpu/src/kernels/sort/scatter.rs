//! Moves the pairs of one chunk to their places, a memory line at a time.

use super::{DIGITS, Key, Places};
use crate::parallel::Scattered;

/// Pairs staged per digit: one 64-byte line of payloads, one or two of keys.
const GROUP: usize = 16;

/// Where pairs go.
pub(super) struct Destination<'a, K> {
    pub(super) keys: Scattered<'a, K>,
    pub(super) payload: Scattered<'a, u32>,
}

/// Pairs on their way, by digit. Staged per chunk: 32 KiB for 32-bit keys.
#[repr(C, align(64))]
struct Staging<K> {
    keys: [[K; GROUP]; DIGITS],
    payload: [[u32; GROUP]; DIGITS],
}

/// Moves each pair to `places[digit]`, counting on from there.
///
/// # Safety
/// For every digit, the places from `places[digit]` on, as many as `keys` has pairs with that digit, lie inside `to`,
/// and nobody else reads or writes them meanwhile.
pub(super) unsafe fn scatter<K: Key>(
    keys: &[K],
    payload: &[u32],
    shift: u32,
    places: &Places,
    to: &Destination<'_, K>,
) {
    // Groups are counted so that they begin at line boundaries of the payload.
    let phase = to.payload.as_ptr().align_offset(64).wrapping_neg() % GROUP;
    let begin = places.map(|place| place as usize + phase);
    let mut next = begin;
    let mut staging = Staging { keys: [[K::zeroed(); GROUP]; DIGITS], payload: [[0; GROUP]; DIGITS] };
    for (&key, &value) in keys.iter().zip(payload) {
        let digit = usize::from(key.digit(shift));
        let place = next[digit];
        let slot = place % GROUP;
        staging.keys[digit][slot] = key;
        staging.payload[digit][slot] = value;
        next[digit] = place + 1;
        if slot == GROUP - 1 {
            // The first group of a digit may begin before its first place.
            let skip = begin[digit].saturating_sub(place + 1 - GROUP);
            // SAFETY: places `begin..=place` of the digit, which the caller gave to this call.
            unsafe { flush(&staging, digit, skip..GROUP, place + 1 - GROUP + skip - phase, to) };
        }
    }
    for digit in 0..DIGITS {
        let end = next[digit];
        let group = end / GROUP * GROUP;
        let from = if begin[digit] > group { begin[digit] } else { group };
        if from < end {
            // SAFETY: as above; the last places of the digit.
            unsafe { flush(&staging, digit, from - group..end - group, from - phase, to) };
        }
    }
}

/// Copies some of a digit's staged pairs to `place`.
///
/// # Safety
/// `slots` is inside the group, and the places it goes to belong to the caller.
#[inline(always)]
unsafe fn flush<K: Key>(
    staging: &Staging<K>,
    digit: usize,
    slots: std::ops::Range<usize>,
    place: usize,
    to: &Destination<'_, K>,
) {
    let count = slots.len();
    debug_assert!(place + count <= to.keys.len() && place + count <= to.payload.len());
    let (keys, payload) = (staging.keys[digit].as_ptr(), staging.payload[digit].as_ptr());
    // SAFETY: the caller's promise; source and destination are different allocations.
    unsafe {
        let (to_keys, to_payload) = (to.keys.as_ptr().add(place), to.payload.as_ptr().add(place));
        if count == GROUP {
            // A length known when compiling: a few vector moves instead of calls.
            std::ptr::copy_nonoverlapping(keys, to_keys, GROUP);
            std::ptr::copy_nonoverlapping(payload, to_payload, GROUP);
        } else {
            std::ptr::copy_nonoverlapping(keys.add(slots.start), to_keys, count);
            std::ptr::copy_nonoverlapping(payload.add(slots.start), to_payload, count);
        }
    }
}
