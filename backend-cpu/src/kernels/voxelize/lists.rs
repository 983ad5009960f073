//! From a mask to ranks and lists of codes.

use crate::buffer::try_zeroed;
use rayon::prelude::*;
use twinlight_core::Result;

/// Words of a mask per task.
const WORDS: usize = 1 << 12;

/// Bits set before each word, and in all.
pub(crate) fn ranks(mask: &[u32]) -> Result<Vec<u32>> {
    let mut ranks = try_zeroed::<u32>(mask.len() + 1)?;
    let counts: Vec<u32> =
        mask.par_chunks(WORDS).map(|words| words.iter().map(|w| w.count_ones()).sum()).collect();
    let mut before = 0;
    let starts: Vec<u32> = counts
        .iter()
        .map(|count| {
            let start = before;
            before += count;
            start
        })
        .collect();
    let chunks = ranks[1..].par_chunks_mut(WORDS).zip(mask.par_chunks(WORDS)).zip(&starts);
    chunks.for_each(|((ranks, words), &start)| {
        let mut sum = start;
        for (rank, word) in ranks.iter_mut().zip(words) {
            sum += word.count_ones();
            *rank = sum;
        }
    });
    Ok(ranks)
}

/// The codes of set bits, ascending.
pub(crate) fn codes(mask: &[u32], ranks: &[u32]) -> Result<Vec<u32>> {
    let mut codes = try_zeroed::<u32>(ranks[mask.len()] as usize)?;
    fill_codes(mask, ranks, &mut codes);
    Ok(codes)
}

/// The codes of set bits, ascending, in a slice of their number; `ranks` may begin with what comes before the mask.
pub(crate) fn fill_codes(mask: &[u32], ranks: &[u32], codes: &mut [u32]) {
    let mut rest = codes;
    let mut parts = Vec::new();
    for begin in (0..mask.len()).step_by(WORDS) {
        let end = mask.len().min(begin + WORDS);
        let part = rest.split_off_mut(..(ranks[end] - ranks[begin]) as usize).unwrap_or_default();
        parts.push((begin, &mask[begin..end], part));
    }
    parts.into_par_iter().for_each(|(begin, words, part)| {
        let mut places = part.iter_mut();
        for (i, &word) in words.iter().enumerate() {
            let mut bits = word;
            while bits != 0 {
                if let Some(place) = places.next() {
                    *place = ((begin + i) << 5) as u32 | bits.trailing_zeros();
                }
                bits &= bits - 1;
            }
        }
    });
}

/// The codes of the next level.
pub(crate) fn parents(active: &[u32]) -> Vec<u32> {
    let mut parents: Vec<u32> = active.iter().map(|code| code >> 3).collect();
    parents.dedup();
    parents
}
