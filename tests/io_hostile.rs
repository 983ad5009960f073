//! Hostile files: whatever the bytes, readers return, and allocate no more than the limits allow.
//!
//! The corpus is that of the fuzz targets (`fuzz/seeds`), each file as it is, cut off, and with seeded mutations. The
//! number of mutations is bounded so that the ordinary test run stays short; the fuzz targets go on from there.
#![cfg(feature = "io")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;
use twinlight::io::resolve::MemoryFiles;
use twinlight::io::{LoadOptions, gltf, image};
use twinlight_core::scene::{Limits, compile};

/// Counts what the current thread holds and has held at most.
struct Counting;

thread_local! {
    static HELD: Cell<usize> = const { Cell::new(0) };
    static PEAK: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call is handed to the system's allocator unchanged; the counters are thread-local cells without
// destructors, so that touching them allocates nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        HELD.set(HELD.get().wrapping_add(layout.size()));
        // Memory freed here may come from another thread: a wrapped count is not a peak.
        if (HELD.get() as isize) > PEAK.get() as isize {
            PEAK.set(HELD.get());
        }
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.set(HELD.get().wrapping_sub(layout.size()));
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Limit given to the readers.
const MAX_BYTES: u64 = 8 << 20;
/// What they may hold at once: the limit counts what is kept; decoders need working memory beside it (a block of lines,
/// zlib windows, colour tables), the compiled scene is a second copy, and vectors that grow double.
const MAX_HELD: usize = 6 * MAX_BYTES as usize;

/// Tables that decoders make once and keep. Thousands of files that each leaked a little would exceed it.
const MAX_KEPT: isize = 16 << 10;

fn limits() -> Limits {
    Limits { max_bytes: MAX_BYTES, max_triangles: 100_000, lenient: false }
}

/// Xorshift: the mutations are the same in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % n.max(1)
    }
}

/// Bytes that stand for limits: zeros, ones, signs, and numbers near the ends of their ranges.
const HARD: [&[u8]; 10] = [
    &[0],
    &[0xff],
    &[0x7f],
    &[0x80],
    &[0, 0, 0, 0],
    &[0xff, 0xff, 0xff, 0xff],
    &[0xff, 0xff, 0xff, 0x7f],
    b"18446744073709551615",
    b"-1",
    b"1e39",
];

fn mutated(seed: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..1 + random.below(4) {
        let at = random.below(bytes.len());
        match random.below(6) {
            0 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
            1 if !bytes.is_empty() => bytes[at] = random.below(256) as u8,
            2 => bytes.truncate(at),
            3 => {
                let end = (at + 1 + random.below(8)).min(bytes.len());
                bytes.drain(at..end);
            }
            4 => {
                let hard = HARD[random.below(HARD.len())];
                let end = (at + hard.len()).min(bytes.len());
                bytes.splice(at..end, hard.iter().copied());
            }
            _ => {
                let end = (at + random.below(32)).min(bytes.len());
                let copy = bytes[at..end].to_vec();
                let to = random.below(bytes.len());
                bytes.splice(to..to, copy);
            }
        }
    }
    bytes
}

/// Runs `read` over the seeds in a folder and their mutations. A panic names the file and the mutation.
fn torment(folder: &str, mutations: usize, read: impl Fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds").join(folder);
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    assert!(files.len() >= 5, "the corpus is missing");
    let before_all = HELD.get();
    for file in files {
        let seed = std::fs::read(&file).unwrap();
        let mut random = Random(0x9e37_79b9_7f4a_7c15);
        for i in 0..=mutations {
            let bytes = if i == 0 { seed.clone() } else { mutated(&seed, &mut random) };
            let before = HELD.get();
            PEAK.set(before);
            read(&bytes);
            let held = PEAK.get().wrapping_sub(before);
            assert!(held <= MAX_HELD, "{} mutation {i}: {held} bytes held", file.display());
        }
    }
    // Negative when something older was given back meanwhile.
    let kept = HELD.get().wrapping_sub(before_all) as isize;
    assert!(kept <= MAX_KEPT, "{kept} bytes were not given back");
}

#[test]
fn gltf_files() {
    let options = LoadOptions { limits: limits(), ..LoadOptions::default() };
    torment("gltf", 3000, |bytes| {
        if let Ok(scene) = gltf::parse(bytes, "hostile.gltf", &MemoryFiles::default(), &options) {
            let _ = compile(&scene, &options.limits);
            for seconds in [0.0, 0.5 * scene.motion.duration] {
                let posed = scene.at(seconds).expect("a motion that was read fits its scene");
                let _ = compile(&posed, &options.limits);
            }
        }
    });
}

#[test]
fn exr_files() {
    torment("exr", 2000, |bytes| {
        let _ = image::read_exr_environment(bytes, "hostile.exr", &limits());
        let _ = image::exr::read_attributes(bytes, "hostile.exr", &limits());
    });
}

#[test]
fn pictures() {
    torment("image", 2000, |bytes| {
        let _ = image::decode_texture(bytes, "hostile.png", &limits());
        let _ = image::read_rgb(bytes, "hostile.png", &limits());
    });
}

#[test]
fn headers_that_promise_gigabytes_are_refused_by_their_numbers() {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds");
    let message = |result: Result<(), twinlight_core::Error>| result.unwrap_err().to_string();
    let exr = std::fs::read(seeds.join("exr/promises-17-gigabytes.exr")).unwrap();
    assert!(exr.len() < 600);
    let before = HELD.get();
    PEAK.set(before);
    // Limits as large as a default scene's: what the file can hold decides.
    let text = message(image::read_layers(&exr, "sky.exr", &Limits::default()).map(drop));
    assert_eq!(text, "sky.exr: pixels of the longest side: needs 38000, the limit is 16384");
    let exr = std::fs::read(seeds.join("exr/promises-3-gigabytes.exr")).unwrap();
    let text = message(image::read_layers(&exr, "sky.exr", &Limits::default()).map(drop));
    assert!(text.starts_with("sky.exr: decoded bytes of a file of 416 bytes: needs 6442450944"), "{text}");
    let png = std::fs::read(seeds.join("image/promises-one-gigabyte.png")).unwrap();
    let text = message(image::decode_texture(&png, "wall.png", &Limits::default()).map(drop));
    assert!(text.starts_with("wall.png: decoded bytes of a file of 69 bytes: needs 4294967296"), "{text}");
    let held = PEAK.get() - before;
    assert!(held < 1 << 20, "{held} bytes held to refuse two small files");
}
