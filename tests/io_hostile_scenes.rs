//! Hostile OBJ, MTL, PLY and TOML files: the fuzz targets' seeds and seeded mutations of them go through every reader.
//! None panics, and none takes more memory than the limits allow.
#![cfg(feature = "io")]

#[path = "../fuzz/src/drive.rs"]
mod drive;

use std::alloc::{GlobalAlloc, Layout, System};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use twinlight_core::Result;
use twinlight_core::scene::Scene;
use twinlight_fixtures::random::Random;

/// Mutations of each corpus file.
const MUTATIONS: usize = 200;
/// What a reader may hold beyond the limit of its options: the corpus, and buffers that grow by doubling.
const SLACK_BYTES: usize = 32 << 20;

/// Counts what is allocated, to hold the readers to their limits.
struct Counting;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call is passed on to the system's allocator unchanged; the counters allocate nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let live = LIVE.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        PEAK.fetch_max(live, Ordering::Relaxed);
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller keeps the contract of `dealloc`, and `alloc` passed on what the system gave.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

type Target = (&'static str, fn(&[u8]) -> Result<Scene>);

const TARGETS: [Target; 4] =
    [("obj", drive::obj), ("mtl", drive::mtl), ("ply", drive::ply), ("toml", drive::toml)];

/// Spellings that have broken readers.
const SPELLINGS: [&[u8]; 16] = [
    b"nan",
    b"-inf",
    b"1e39",
    b"1e-50",
    b"0",
    b"-1",
    b"2147483648",
    b"4294967296",
    b"18446744073709551616",
    b"9999999999999999999999",
    b"",
    b"\xff\xfe",
    b"../../etc/passwd",
    b"%ff",
    b"\n",
    b"//",
];

fn mutated(seed: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    let below = |random: &mut Random, n: usize| (random.next_u64() % (n as u64 + 1)) as usize;
    for _ in 0..=below(random, 3) {
        let (i, j) = (below(random, bytes.len()), below(random, bytes.len()));
        let range = i.min(j)..i.max(j).min(i.min(j) + 64);
        match random.next_u64() % 7 {
            0 => bytes[range].iter_mut().for_each(|b| *b ^= random.next_u64() as u8),
            1 => drop(bytes.drain(range)),
            2 => bytes.truncate(i),
            3 => {
                let copy = bytes[range].to_vec();
                bytes.splice(j..j, copy);
            }
            4 => {
                let (a, b) = (below(random, other.len()), below(random, other.len()));
                let part = &other[a.min(b)..a.max(b)];
                bytes.splice(i..i, part.iter().copied());
            }
            _ => {
                // Replaces a word.
                let start = bytes[..i].iter().rposition(u8::is_ascii_whitespace).map_or(0, |p| p + 1);
                let end = bytes[i..].iter().position(u8::is_ascii_whitespace).map_or(bytes.len(), |p| p + i);
                let spelling = SPELLINGS[below(random, SPELLINGS.len() - 1)];
                bytes.splice(start..end, spelling.iter().copied());
            }
        }
    }
    bytes
}

fn corpus(target: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds").join(target);
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut files: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    files.sort();
    files.into_iter().map(|path| (path.clone(), std::fs::read(path).unwrap())).collect()
}

/// Runs a reader, and holds its memory against the limit.
fn run(label: &dyn Fn() -> String, read: fn(&[u8]) -> Result<Scene>, bytes: &[u8]) -> bool {
    let before = LIVE.load(Ordering::Relaxed);
    PEAK.store(before, Ordering::Relaxed);
    let result = std::panic::catch_unwind(|| read(bytes).is_ok());
    let used = PEAK.load(Ordering::Relaxed).saturating_sub(before);
    let allowed = drive::options().limits.max_bytes as usize + SLACK_BYTES;
    let Ok(accepted) = result else {
        let dump = std::env::temp_dir().join("twinlight-hostile.bin");
        std::fs::write(&dump, bytes).unwrap();
        panic!("{} panicked; its bytes are in {}", label(), dump.display());
    };
    assert!(used <= allowed, "{}: {used} bytes allocated, {allowed} allowed", label());
    accepted
}

// One test, not one per target: others in the same process would count into its memory.
#[test]
fn no_file_makes_a_reader_panic_or_take_too_much_memory() {
    for (target, read) in TARGETS {
        let files = corpus(target);
        assert!(files.len() >= 8, "{target}: {} corpus files", files.len());
        let (mut accepted, mut runs) = (0, 0);
        for (i, (path, bytes)) in files.iter().enumerate() {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let ok = run(&|| format!("{target}/{name}"), read, bytes);
            // The name says what to expect.
            assert_eq!(ok, name.starts_with("good"), "{target}/{name}: {:?}", read(bytes).map(|s| s.notices));
            let mut random = Random::new(i as u64);
            for m in 0..MUTATIONS {
                let other = &files[(random.next_u64() % files.len() as u64) as usize].1;
                let mutant = mutated(bytes, other, &mut random);
                accepted += usize::from(run(&|| format!("{target}/{name}, mutation {m}"), read, &mutant));
                runs += 1;
            }
        }
        println!("{target}: {} files, {accepted} of {runs} mutations accepted", files.len());
        assert!(accepted > 0 && accepted < runs, "{target}: the mutations are all alike");
    }
}
