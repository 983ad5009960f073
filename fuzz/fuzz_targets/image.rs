//! PNG and JPEG: whatever the bytes, the reader returns.
#![no_main]

use libfuzzer_sys::fuzz_target;
use twinlight::io::image;
use twinlight_core::scene::Limits;

fuzz_target!(|bytes: &[u8]| {
    let limits = Limits { max_bytes: 64 << 20, ..Limits::default() };
    let _ = image::decode_texture(bytes, "fuzz.png", &limits);
    let _ = image::read_rgb(bytes, "fuzz.png", &limits);
});
