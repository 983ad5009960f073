//! glTF and GLB: whatever the bytes, the reader returns, and what it returns compiles or is refused.
#![no_main]

use libfuzzer_sys::fuzz_target;
use twinlight::io::resolve::MemoryFiles;
use twinlight::io::{LoadOptions, gltf};
use twinlight_core::scene::{Limits, compile};

fuzz_target!(|bytes: &[u8]| {
    let limits = Limits { max_bytes: 64 << 20, max_triangles: 1 << 18, lenient: false };
    let options = LoadOptions { limits, ..LoadOptions::default() };
    if let Ok(scene) = gltf::parse(bytes, "fuzz.gltf", &MemoryFiles::default(), &options) {
        let _ = compile(&scene, &limits);
        for seconds in [0.0, 0.5 * scene.motion.duration] {
            let posed = scene.at(seconds).expect("a motion that was read fits its scene");
            let _ = compile(&posed, &limits);
        }
    }
});
