//! `scan` beside memcpy and `sort` beside rdst, alternately in one run, on as many threads as `RAYON_NUM_THREADS` says
//! (all processors without it):
//!
//! ```text
//! cargo bench -p twinlight-backend-cpu --bench scan_sort [-- scan | sort]
//! ```
//!
//! Bytes moved, for n elements: memcpy reads 4n and writes 4n. `scan` reads 4n from memory and writes 4n, and reads 4n
//! once more from cache. A sort's working memory is there already, as in every call of a backend but the first.

mod support;

use rayon::prelude::*;
use rdst::{RadixKey, RadixSort};
use support::{Contender, compare, timed};
use twinlight_backend_cpu::CpuBackend;
use twinlight_core::Backend;

const ROUNDS: usize = 9;

/// A bijection of u32 that looks random (Wellons' lowbias32).
fn hash(x: u32) -> u32 {
    let x = (x ^ (x >> 16)).wrapping_mul(0x7FEB_352D);
    let x = (x ^ (x >> 15)).wrapping_mul(0x846C_A68B);
    x ^ (x >> 16)
}

fn scan_beside_memcpy(backend: &CpuBackend, len: u32) {
    let host: Vec<u32> = (0..len).map(|i| hash(i) & 7).collect();
    let input = backend.upload(&host).expect("memory for the input");
    let mut output = backend.zeroed(host.len()).expect("memory for the output");
    let mut copy = vec![1_u32; host.len()];
    let half = host.len().div_ceil(rayon::current_num_threads()).max(1);
    compare(
        &format!("scan, {len} elements"),
        ROUNDS,
        &mut [
            Contender {
                name: "scan",
                run: &mut || timed(|| assert!(backend.scan(&input, &mut output).is_ok())),
            },
            Contender {
                name: "memcpy per thread",
                run: &mut || {
                    timed(|| {
                        copy.par_chunks_mut(half)
                            .zip(host.par_chunks(half))
                            .for_each(|(to, from)| to.copy_from_slice(from));
                    })
                },
            },
        ],
    );
}

#[derive(Clone, Copy)]
struct Pair<K> {
    key: K,
    payload: u32,
}

impl RadixKey for Pair<u32> {
    const LEVELS: usize = 4;

    fn get_level(&self, level: usize) -> u8 {
        self.key.get_level(level)
    }
}

impl RadixKey for Pair<u64> {
    const LEVELS: usize = 8;

    fn get_level(&self, level: usize) -> u8 {
        self.key.get_level(level)
    }
}

fn rdst_pairs<K: Copy>(keys: &[K]) -> Vec<Pair<K>> {
    keys.iter().zip(0..).map(|(&key, payload)| Pair { key, payload }).collect()
}

fn sort_beside_rdst(backend: &CpuBackend, name: &str, host: &[u32]) {
    let payload: Vec<u32> = (0..host.len() as u32).collect();
    let pairs = rdst_pairs(host);
    compare(
        &format!("sort_u32, {} pairs, {name}", host.len()),
        ROUNDS,
        &mut [
            Contender {
                name: "sort_u32",
                run: &mut || {
                    let mut keys = host.to_vec().into();
                    let mut values = payload.clone().into();
                    timed(|| assert!(backend.sort_u32(&mut keys, &mut values).is_ok()))
                },
            },
            Contender {
                name: "rdst",
                run: &mut || {
                    let mut pairs = pairs.clone();
                    let time = timed(|| pairs.radix_sort_unstable());
                    std::hint::black_box(pairs.first().map(|pair| pair.payload));
                    time
                },
            },
        ],
    );
}

fn sort_u64_beside_rdst(backend: &CpuBackend, name: &str, host: &[u64]) {
    let payload: Vec<u32> = (0..host.len() as u32).collect();
    let pairs = rdst_pairs(host);
    compare(
        &format!("sort_u64, {} pairs, {name}", host.len()),
        ROUNDS,
        &mut [
            Contender {
                name: "sort_u64",
                run: &mut || {
                    let mut keys = host.to_vec().into();
                    let mut values = payload.clone().into();
                    timed(|| assert!(backend.sort_u64(&mut keys, &mut values).is_ok()))
                },
            },
            Contender {
                name: "rdst",
                run: &mut || {
                    let mut pairs = pairs.clone();
                    timed(|| pairs.radix_sort_unstable())
                },
            },
        ],
    );
}

fn main() {
    let wanted = |what: &str| {
        let named: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
        named.is_empty() || named.iter().any(|a| a == what)
    };
    let backend = CpuBackend::new();
    println!("{:?}", backend.info());
    if wanted("scan") {
        scan_beside_memcpy(&backend, 100_000_000);
        scan_beside_memcpy(&backend, 1_000_000);
    }
    if wanted("sort") {
        let random: Vec<u32> = (0..10_000_000).map(hash).collect();
        sort_beside_rdst(&backend, "random", &random);
        let tiles: Vec<u32> = random.iter().map(|k| k >> 20).collect();
        sort_beside_rdst(&backend, "12 random bits", &tiles);
        sort_beside_rdst(&backend, "random", &random[..100_000]);
        let wide: Vec<u64> = random.iter().map(|&k| u64::from(k) << 32 | u64::from(hash(!k))).collect();
        sort_u64_beside_rdst(&backend, "random", &wide);
    }
}
