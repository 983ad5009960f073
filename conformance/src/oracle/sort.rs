// kernel family: sort
// contract core/src/kernels/sort.rs
// cpu backend-cpu/src/kernels/sort.rs
// gpu backend-gpu/src/kernels/sort.wgsl
// oracle conformance/src/oracle/sort.rs
//! Oracle of `sort`: the standard library's stable comparison sort, no digits.

/// Keys in order, each with its payload; equal keys keep their order.
pub fn sort<K: Ord + Copy>(keys: &[K], payload: &[u32]) -> (Vec<K>, Vec<u32>) {
    let mut pairs: Vec<(K, u32)> = keys.iter().copied().zip(payload.iter().copied()).collect();
    pairs.sort_by_key(|&(key, _)| key);
    pairs.into_iter().unzip()
}

#[cfg(test)]
mod tests {
    #[test]
    fn equal_keys_keep_their_order() {
        let (keys, payload) = super::sort(&[2_u64, 1, 2, 1 << 40, 1], &[0, 1, 2, 3, 4]);
        assert_eq!((keys, payload), (vec![1, 1, 2, 2, 1 << 40], vec![1, 4, 0, 2, 3]));
    }
}
