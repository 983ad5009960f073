//! Digits of keys: which bits matter, how often each value occurs, where its pairs go.

use super::Key;
use rayon::prelude::*;

/// Values of a digit.
pub(super) const DIGITS: usize = 256;

/// Places of one chunk's next pair, by digit.
pub(super) type Places = [u32; DIGITS];

/// The bits that aren't the same in all keys.
pub(super) fn varying_bits<K: Key>(keys: &[K], chunk: usize) -> u64 {
    let Some(&first) = keys.first() else { return 0 };
    let of_chunk = |keys: &[K]| keys.iter().fold(K::zeroed(), |bits, &key| bits | (key ^ first)).into();
    keys.par_chunks(chunk).map(of_chunk).reduce(|| 0, |a, b| a | b)
}

/// Where digits begin, from the lowest: each covers the lowest varying bit that no earlier one does, so bits that all
/// keys share cost no pass.
pub(super) fn digit_shifts(mut varying: u64) -> Vec<u32> {
    let mut shifts = Vec::new();
    while varying != 0 {
        let shift = varying.trailing_zeros();
        shifts.push(shift);
        varying &= !(0xFF << shift);
    }
    shifts
}

/// How often each digit occurs. Four tables, so that neighbouring equal digits don't wait for each other's increments.
pub(super) fn count<K: Key>(keys: impl ExactSizeIterator<Item = K>, shift: u32) -> Places {
    let mut tables = [[0_u32; DIGITS]; 4];
    for (i, key) in keys.enumerate() {
        tables[i % 4][usize::from(key.digit(shift))] += 1;
    }
    let [a, b, c, d] = &tables;
    std::array::from_fn(|i| a[i] + b[i] + c[i] + d[i])
}

/// Exclusive prefix sums over (digit, chunk), digit major: of equal digits those of earlier chunks come first.
pub(super) fn counts_to_places(counts: &mut [Places]) {
    let mut place = 0;
    for digit in 0..DIGITS {
        for chunk in counts.iter_mut() {
            place += std::mem::replace(&mut chunk[digit], place);
        }
    }
}

/// Calls `write` with a place for every pair: those of its digit, in order.
pub(super) fn deal<K: Key>(
    pairs: impl Iterator<Item = (K, u32)>,
    shift: u32,
    places: &Places,
    write: impl Fn(usize, (K, u32)),
) {
    let mut next = *places;
    for pair in pairs {
        let place = &mut next[usize::from(pair.0.digit(shift))];
        write(*place as usize, pair);
        *place += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_begin_at_varying_bits() {
        assert_eq!(digit_shifts(0), []);
        assert_eq!(digit_shifts(1), [0]);
        assert_eq!(digit_shifts(0xFFF0), [4, 12]);
        assert_eq!(digit_shifts(1 << 63 | 1 << 3), [3, 63]);
        assert_eq!(digit_shifts(u64::MAX), [0, 8, 16, 24, 32, 40, 48, 56]);
        assert_eq!(varying_bits(&[5_u32, 5, 4, 5], 2), 1);
        assert_eq!(varying_bits(&[1_u64 << 40, 3 << 40], 4096), 2 << 40);
        assert_eq!(varying_bits::<u64>(&[], 4096), 0);
    }

    #[test]
    fn places_are_dealt_by_digit_and_then_by_chunk() {
        let chunks = [[2_u32, 0, 2, 1], [0, 2, 0, 0]];
        let mut places: Vec<Places> = chunks.iter().map(|keys| count(keys.iter().copied(), 0)).collect();
        counts_to_places(&mut places);
        assert_eq!(places.iter().map(|p| p[..3].to_vec()).collect::<Vec<_>>(), [[0, 4, 5], [1, 5, 7]]);
        let dealt = std::cell::RefCell::new(Vec::new());
        let pairs = chunks[1].iter().copied().zip(0..);
        deal(pairs, 0, &places[1], |place, pair| dealt.borrow_mut().push((place, pair)));
        assert_eq!(dealt.into_inner(), [(1, (0, 0)), (7, (2, 1)), (2, (0, 2)), (3, (0, 3))]);
    }
}
