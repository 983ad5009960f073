//! Pictures read and written: round trips, known values, refusals.
#![cfg(feature = "io")]

use std::path::PathBuf;
use twinlight::io::image::{LayeredImage, Samples, decode_texture, exr, png, read_rgb};
use twinlight_core::Error;
use twinlight_core::scene::Limits;

/// A folder of its own for each test, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Self {
        let path = std::env::temp_dir().join(format!("twinlight-{test}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).unwrap();
        let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).unwrap();
    }
}

/// Values that a careless path would lose: zero's sign, subnormals, the largest, infinities, NaN.
fn hard_floats(count: usize, salt: u32) -> Vec<f32> {
    let hard = [0.0, -0.0, 1e-45, f32::MAX, f32::INFINITY, f32::NAN, -1.5, 0.1];
    (0..count).map(|i| hard[i % 8] * if i < 8 { 1.0 } else { (i as u32 ^ salt) as f32 }).collect()
}

fn full_image(width: u32, height: u32) -> LayeredImage {
    let count = (width * height) as usize;
    let rgb = |salt: u32| -> Vec<[f32; 3]> {
        let planes = [0, 1, 2].map(|c| hard_floats(count, salt + c));
        (0..count).map(|i| [planes[0][i], planes[1][i], planes[2][i]]).collect()
    };
    let mut image = LayeredImage::new(width, height);
    image.add_rgb("", &rgb(1));
    for (i, layer) in ["direct", "indirect", "albedo", "variance"].into_iter().enumerate() {
        image.add_rgb(layer, &rgb(10 * i as u32));
    }
    image.add_xyz("N", &rgb(77));
    image.add_f32("Z", hard_floats(count, 5));
    image.add_u32("id", (0..count as u32).map(|i| u32::MAX - i).collect());
    image
}

fn bits(samples: &Samples) -> Vec<u32> {
    match samples {
        Samples::F32(v) => v.iter().map(|x| x.to_bits()).collect(),
        Samples::U32(v) => v.clone(),
    }
}

#[test]
fn exr_round_trip_keeps_every_bit_and_every_name() {
    // 17 lines: one more than a block, so that the last block is short.
    for (width, height) in [(1, 1), (5, 17), (64, 33)] {
        let image = full_image(width, height);
        let bytes = exr::encode(&image, &[("version", "0.1.0"), ("adapter", "Käfer 日")]).unwrap();
        let back = exr::read_layers(&bytes, "round.exr", &Limits::default()).unwrap();
        assert_eq!((back.width, back.height, back.channels.len()), (width, height, image.channels.len()));
        for channel in &image.channels {
            let read = back.channel(&channel.name).unwrap_or_else(|| panic!("no {}", channel.name));
            assert_eq!(bits(read), bits(&channel.samples), "{} at {width}x{height}", channel.name);
        }
        let pairs = exr::read_attributes(&bytes, "round.exr", &Limits::default()).unwrap();
        assert_eq!(pairs, [("adapter".into(), "Käfer 日".into()), ("version".into(), "0.1.0".into())]);
    }
}

#[test]
fn exr_bytes_do_not_depend_on_the_run() {
    let names = ["version", "method", "seed", "backend", "adapter", "spp", "stop reason"];
    let pairs: Vec<(&str, &str)> = names.iter().map(|n| (*n, "value")).collect();
    // Five blocks of lines, compressed by several threads.
    let image = full_image(40, 70);
    let first = exr::encode(&image, &pairs).unwrap();
    // Every hash map has its own order: 20 unsorted headers of 7 attributes would be equal once in 10^70 runs.
    for _ in 0..20 {
        assert!(exr::encode(&image, &pairs).unwrap() == first);
    }
    let reversed: Vec<(&str, &str)> = pairs.iter().rev().copied().collect();
    assert!(exr::encode(&image, &reversed).unwrap() == first);
}

#[test]
fn exr_refuses_what_would_make_a_broken_file() {
    let image = full_image(2, 2);
    let message = |m: &[(&str, &str)]| exr::encode(&image, m).unwrap_err().to_string();
    assert_eq!(message(&[("a", "x"), ("a", "y")]), "attribute 'a': occurs twice");
    assert!(message(&[("", "x")]).contains("1 to 200"));

    let mut short = full_image(2, 2);
    short.add_f32("short", vec![0.0; 3]);
    let error = exr::encode(&short, &[]).unwrap_err().to_string();
    assert_eq!(error, "channel 'short': 3 samples for 2x2 pixels");
    let mut twice = full_image(2, 2);
    twice.add_f32("R", vec![0.0; 4]);
    assert_eq!(exr::encode(&twice, &[]).unwrap_err().to_string(), "channel 'R': occurs twice");
    assert!(exr::encode(&LayeredImage::new(2, 2), &[]).is_err());
    assert!(exr::encode(&LayeredImage::new(0, 2), &[]).is_err());
}

#[test]
fn a_failed_write_leaves_the_old_file_and_no_other() {
    let folder = Folder::new("atomic");
    let path = folder.0.join("a.exr");
    exr::write(&path, &full_image(3, 3), &[]).unwrap();
    let old = std::fs::read(&path).unwrap();
    exr::write(&path, &full_image(4, 4), &[]).unwrap();
    assert_ne!(std::fs::read(&path).unwrap(), old);
    assert_eq!(folder.files(), ["a.exr"]);

    // A folder of that name can't be replaced by a file: the rename fails after the data was written.
    let taken = folder.0.join("taken.png");
    std::fs::create_dir(&taken).unwrap();
    let error = png::write(&taken, 1, 1, &[[1, 2, 3]]).unwrap_err();
    assert!(matches!(&error, Error::Io { path, .. } if *path == taken), "{error}");
    assert_eq!(folder.files(), ["a.exr", "taken.png"]);
    let nowhere = folder.0.join("missing/b.png");
    assert!(matches!(png::write(&nowhere, 1, 1, &[[1, 2, 3]]), Err(Error::Io { .. })));
    assert!(matches!(png::write("..".as_ref(), 1, 1, &[[1, 2, 3]]), Err(Error::InvalidInput { .. })));
}

#[test]
fn png_round_trip_and_texture_layout() {
    let pixels = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [10, 20, 30], [40, 50, 60], [188, 188, 188]];
    let bytes = png::encode(3, 2, &pixels).unwrap();
    let texture = decode_texture(&bytes, "t.png", &Limits::default()).unwrap();
    assert_eq!((texture.width, texture.height, texture.name.as_str()), (3, 2, "t.png"));
    assert_eq!(texture.texels, pixels.map(|[r, g, b]| [r, g, b, 255]));
    let linear = read_rgb(&bytes, "t.png", &Limits::default()).unwrap();
    assert_eq!(linear.pixels[0], [1.0, 0.0, 0.0]);
    assert!((linear.pixels[5][1] - 0.502_886_5).abs() < 1e-6, "{:?}", linear.pixels[5]);
    assert!(png::encode(3, 2, &pixels[..5]).is_err());
    assert!(png::encode(0, 0, &[]).is_err());
}

#[test]
fn rgb_is_found_at_the_top_level_in_a_layer_or_as_grey() {
    let limits = Limits::default();
    let mut layered = LayeredImage::new(1, 1);
    layered.add_rgb("beauty", &[[1.0, 2.0, 3.0]]);
    let read = |image: &LayeredImage| read_rgb(&exr::encode(image, &[]).unwrap(), "x.exr", &limits);
    assert_eq!(read(&layered).unwrap().pixels, [[1.0, 2.0, 3.0]]);
    layered.add_f32("Y", vec![7.0]);
    assert_eq!(read(&layered).unwrap().pixels, [[7.0; 3]]);
    layered.add_rgb("", &[[4.0, 5.0, 6.0]]);
    assert_eq!(read(&layered).unwrap().pixels, [[4.0, 5.0, 6.0]]);
    let mut depth = LayeredImage::new(1, 1);
    depth.add_f32("Z", vec![1.0]);
    depth.add_u32("R", vec![1]);
    let error = read(&depth).unwrap_err().to_string();
    assert_eq!(error, "x.exr: no float channels R, G, B or Y among R, Z");
}

#[test]
fn environment_texels_are_refused_or_mended() {
    let mut image = LayeredImage::new(2, 1);
    image.add_rgb("", &[[1.0, 2.0, 3.0], [-1.0, f32::NAN, f32::INFINITY]]);
    let bytes = exr::encode(&image, &[]).unwrap();
    let error = exr::read_environment(&bytes, "sky.exr", &Limits::default()).unwrap_err().to_string();
    assert_eq!(error, "sky.exr: texel (1, 0): radiance -1 is negative or not a number");
    let lenient = Limits { lenient: true, ..Limits::default() };
    let sky = exr::read_environment(&bytes, "sky.exr", &lenient).unwrap();
    assert_eq!(sky.texels, [[1.0, 2.0, 3.0], [0.0, 0.0, 65504.0]]);
    assert_eq!((sky.width, sky.height, sky.scale), (2, 1, 1.0));
}

#[test]
fn other_formats_are_named_as_unsupported() {
    for bytes in [&b"GIF89a\x01\x00\x01\x00"[..], b"not a picture", b""] {
        let error = decode_texture(bytes, "dir/t.gif", &Limits::default()).unwrap_err();
        assert!(matches!(error, Error::Unsupported(_)), "{error}");
        assert!(error.to_string().contains("dir/t.gif"), "{error}");
    }
}
