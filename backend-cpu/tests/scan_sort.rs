//! `scan` and `sort` beside the obvious serial code: every length around a boundary, any thread count, inside a
//! caller's pool, two at once.

use proptest::prelude::*;
use twinlight_backend_cpu::CpuBackend;
use twinlight_core::Backend;

/// Lengths at which something changes: SIMD heads and tails, the small sort, chunks of both kernels.
const LADDER: [usize; 17] =
    [0, 1, 2, 3, 5, 15, 16, 17, 255, 256, 257, 4_095, 4_097, 32_767, 32_768, 32_769, 140_001];

/// Long enough for streaming stores.
const LONG: usize = 4_200_003;

const THREADS: [usize; 4] = [1, 2, 3, 8];

/// A bijection of u32 that looks random (Wellons' lowbias32).
fn hash(x: u32) -> u32 {
    let x = (x ^ (x >> 16)).wrapping_mul(0x7FEB_352D);
    let x = (x ^ (x >> 15)).wrapping_mul(0x846C_A68B);
    x ^ (x >> 16)
}

fn hashes(len: usize) -> Vec<u32> {
    (0..len as u32).map(hash).collect()
}

fn wide(len: usize) -> Vec<u64> {
    (0..len as u32).map(|i| u64::from(hash(i)) << 32 | u64::from(hash(!i))).collect()
}

fn scan(backend: &CpuBackend, host: &[u32]) -> (Vec<u32>, u32) {
    let input = backend.upload(host).unwrap();
    let mut output = backend.upload(&vec![0xDEAD_BEEF; host.len()]).unwrap();
    let total = backend.scan(&input, &mut output).unwrap();
    assert_eq!(backend.download(&input).unwrap(), host, "the input stays as it was");
    (backend.download(&output).unwrap(), total)
}

fn serial_scan(host: &[u32]) -> (Vec<u32>, u32) {
    let mut total = 0_u32;
    let step = |&x: &u32| {
        let before = total;
        total = total.wrapping_add(x);
        before
    };
    let sums = host.iter().map(step).collect();
    (sums, total)
}

fn sort_u32(backend: &CpuBackend, keys: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let mut payload = backend.upload(&(0..keys.len() as u32).map(hash).collect::<Vec<_>>()).unwrap();
    let mut keys = backend.upload(keys).unwrap();
    backend.sort_u32(&mut keys, &mut payload).unwrap();
    (backend.download(&keys).unwrap(), backend.download(&payload).unwrap())
}

fn sort_u64(backend: &CpuBackend, keys: &[u64]) -> (Vec<u64>, Vec<u32>) {
    let mut payload = backend.upload(&(0..keys.len() as u32).map(hash).collect::<Vec<_>>()).unwrap();
    let mut keys = backend.upload(keys).unwrap();
    backend.sort_u64(&mut keys, &mut payload).unwrap();
    (backend.download(&keys).unwrap(), backend.download(&payload).unwrap())
}

fn serial_sort<K: Copy + Ord>(keys: &[K]) -> (Vec<K>, Vec<u32>) {
    let mut pairs: Vec<(K, u32)> = keys.iter().zip(0..).map(|(&key, i)| (key, hash(i))).collect();
    pairs.sort_by_key(|pair| pair.0);
    pairs.into_iter().unzip()
}

/// Keys that stress one thing each: ties, few digits, gaps between varying bits, order, extremes, one outlier.
fn key_patterns(len: usize) -> Vec<(&'static str, Vec<u32>)> {
    let random = hashes(len);
    let map = |f: fn(u32) -> u32| random.iter().map(|&k| f(k)).collect::<Vec<u32>>();
    let mut outlier = vec![5; len];
    if let Some(last) = outlier.last_mut() {
        *last = 4;
    }
    vec![
        ("equal", vec![7; len]),
        ("two values", map(|k| if k & 1 == 0 { u32::MAX } else { 0 })),
        ("twelve bits", map(|k| k >> 20)),
        ("bits apart", map(|k| k & 0x8001_0101)),
        ("crowded in one digit", map(|k| if k.is_multiple_of(1000) { k } else { k & 3 })),
        ("ascending", (0..len as u32).collect()),
        ("descending", (0..len as u32).rev().collect()),
        ("outlier last", outlier),
        ("random", random),
    ]
}

#[test]
fn scan_is_the_serial_scan_at_every_length() {
    for threads in THREADS {
        let backend = CpuBackend::with_threads(threads).unwrap();
        for len in LADDER.into_iter().chain([LONG]) {
            let host = hashes(len);
            assert!(scan(&backend, &host) == serial_scan(&host), "{threads} threads, {len} elements");
        }
    }
}

#[test]
fn scan_wraps_at_32_bits() {
    let host = vec![u32::MAX; 100_000];
    assert!(scan(&CpuBackend::new(), &host) == serial_scan(&host));
    assert_eq!(scan(&CpuBackend::new(), &[u32::MAX, 2, 3]), (vec![0, u32::MAX, 1], 4));
}

#[test]
fn sort_is_the_stable_serial_sort_at_every_length() {
    for threads in THREADS {
        let backend = CpuBackend::with_threads(threads).unwrap();
        for len in LADDER {
            for (name, keys) in key_patterns(len) {
                assert!(
                    sort_u32(&backend, &keys) == serial_sort(&keys),
                    "{threads} threads, {len} keys, {name}"
                );
                let keys: Vec<u64> = keys.iter().map(|&k| u64::from(k) << 29 | 1 << 62).collect();
                assert!(
                    sort_u64(&backend, &keys) == serial_sort(&keys),
                    "{threads} threads, {len} 64-bit keys, {name}"
                );
            }
        }
    }
}

#[test]
fn long_sorts_are_the_serial_ones() {
    let keys = hashes(LONG);
    let expected = serial_sort(&keys);
    for threads in [1, 2] {
        assert!(sort_u32(&CpuBackend::with_threads(threads).unwrap(), &keys) == expected);
    }
}

#[test]
fn sort_orders_all_64_bits() {
    let keys = wide(70_000);
    for threads in THREADS {
        assert!(sort_u64(&CpuBackend::with_threads(threads).unwrap(), &keys) == serial_sort(&keys));
    }
    let extremes = [u64::MAX, 0, 1 << 63, u64::MAX, 1, 0];
    assert_eq!(sort_u64(&CpuBackend::new(), &extremes), serial_sort(&extremes));
}

/// D8: inside pools of the caller, and two calls at once on one pool.
#[test]
fn callers_pools_and_concurrent_calls_change_nothing() {
    let host = hashes(200_000);
    let (scanned, sorted) = (serial_scan(&host), serial_sort(&host));
    for threads in THREADS {
        let outer = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        for backend in [CpuBackend::new(), CpuBackend::with_threads(2).unwrap()] {
            let scans = || scan(&backend, &host) == scanned;
            let sorts = || sort_u32(&backend, &host) == sorted;
            let ((a, b), (c, d)) =
                outer.install(|| rayon::join(|| rayon::join(scans, sorts), || rayon::join(sorts, scans)));
            assert!(a && b && c && d, "inside a pool of {threads}");
            std::thread::scope(|scope| {
                let running: Vec<_> = (0..2).map(|_| scope.spawn(|| scans() && sorts())).collect();
                assert!(running.into_iter().all(|thread| thread.join().unwrap()), "two threads at once");
            });
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_scan(host in prop::collection::vec(any::<u32>(), 0..40_000)) {
        prop_assert_eq!(scan(&CpuBackend::new(), &host), serial_scan(&host));
    }

    #[test]
    fn any_sort(
        keys in prop::collection::vec(any::<u64>(), 0..3_000),
        mask in any::<u64>(),
        low in 0_u32..64,
    ) {
        // Masks and shifts make ties, and digits that begin at any bit.
        let keys: Vec<u64> = keys.iter().map(|k| (k & mask) >> low).collect();
        prop_assert_eq!(sort_u64(&CpuBackend::new(), &keys), serial_sort(&keys));
        let keys: Vec<u32> = keys.iter().map(|&k| k as u32).collect();
        prop_assert_eq!(sort_u32(&CpuBackend::new(), &keys), serial_sort(&keys));
    }
}
