// kernel family: scan
// contract core/src/kernels/scan.rs
// cpu backend-cpu/src/kernels/scan.rs
// gpu backend-gpu/src/kernels/scan.wgsl
// oracle conformance/src/oracle/scan.rs
//! Oracle of `scan`: one running sum in u64.

/// Exclusive sums and the total, modulo 2³².
pub fn scan(input: &[u32]) -> (Vec<u32>, u32) {
    let mut sum = 0_u64;
    let mut offsets = Vec::with_capacity(input.len());
    for &count in input {
        offsets.push((sum % (1 << 32)) as u32);
        sum += u64::from(count);
    }
    (offsets, (sum % (1 << 32)) as u32)
}

#[cfg(test)]
mod tests {
    #[test]
    fn known_sums() {
        assert_eq!(super::scan(&[]), (vec![], 0));
        assert_eq!(super::scan(&[3, 0, 5]), (vec![0, 3, 3], 8));
        assert_eq!(super::scan(&[u32::MAX, 2, 7]), (vec![0, u32::MAX, 1], 8));
    }
}
