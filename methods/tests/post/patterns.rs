//! Pictures made of integers, so that any language reproduces them bit for bit: byte / 255 in `f32`, linear.

use twinlight_methods::post::image::Image;

/// An image from a function of column and row to three bytes.
pub fn picture(width: u32, height: u32, bytes: impl Fn(u32, u32) -> [u32; 3]) -> Image {
    Image::from_fn(width, height, |x, y| bytes(x, y).map(|byte| byte as f32 / 255.0)).unwrap()
}

/// A byte of noise.
pub fn noise(x: u32, y: u32, seed: u32) -> u32 {
    let mut v =
        x.wrapping_mul(1973).wrapping_add(y.wrapping_mul(9277)).wrapping_add(seed.wrapping_mul(26699));
    v ^= v >> 15;
    v = v.wrapping_mul(2246822519);
    v ^= v >> 13;
    v & 255
}

/// Three bytes of noise, a seed per channel.
pub fn noise_colour(seed: u32) -> impl Fn(u32, u32) -> [u32; 3] {
    move |x, y| [0, 1, 2].map(|channel| noise(x, y, 3 * seed + channel))
}

/// Red along x, green along y, for 48×40 pixels.
pub fn gradient(x: u32, y: u32) -> [u32; 3] {
    [x * 255 / 47, y * 255 / 39, 128]
}

/// [`gradient`] with noise of ±20.
pub fn noisy_gradient(x: u32, y: u32) -> [u32; 3] {
    let clean = gradient(x, y);
    [0, 1, 2].map(|c| (clean[c] + noise(x, y, c as u32) % 41).saturating_sub(20).min(255))
}

/// Fields of 8 pixels, sand and night.
pub fn checker(x: u32, y: u32) -> [u32; 3] {
    if (x / 8 + y / 8).is_multiple_of(2) { [230, 200, 40] } else { [10, 30, 90] }
}

/// A white line of one pixel at column 16 on black.
pub fn line(x: u32, _y: u32) -> [u32; 3] {
    if x == 16 { [255; 3] } else { [0; 3] }
}
