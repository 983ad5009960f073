//! What PLY elements mean, in every encoding.

use crate::{files, read, read_bytes};
use twinlight::io::LoadOptions;
use twinlight_core::scene::Scene;

/// A quad and a triangle with normals, texture coordinates, colours, a skipped list and a skipped element.
const ASCII: &str = "ply\nformat ascii 1.0\ncomment made by hand\nobj_info none\n\
    element extra 1\nproperty list uchar short junk\nproperty double more\n\
    element vertex 5\nproperty double x\nproperty float y\nproperty short z\n\
    property float nx\nproperty float ny\nproperty float nz\n\
    property uchar red\nproperty float s\nproperty float t\n\
    element face 3\nproperty uchar flags\nproperty list uint ushort vertex_index\n\
    end_header\n\
    3 7 8 -9 0.5\n\
    0 0 0 0 0 1 255 0 0\n1 0 0 0 0 1 255 1 0\n1 1 0 0 0 1 0 1 1\n0 1 0 0 0 1 0 0 1\n0.5 2 -3 0 0 1 1 0.5 0.25\n\
    1 4 0 1 2 3\n2 3 2 3 4\n3 2 0 1\n";

fn check(scene: &Scene) {
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [2, 3, 4]]);
    assert_eq!(mesh.positions[4], [0.5, 2.0, -3.0]);
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 5]);
    assert_eq!(mesh.texcoords[4], [0.5, 0.25]);
    assert_eq!(mesh.material_ids, [0; 3]);
    let notices = scene.notices.join("\n");
    for expected in
        ["1 'extra' elements ignored", "ignored: red", "ignored: flags", "1 faces with fewer than 3"]
    {
        assert!(notices.contains(expected), "{expected} in {notices}");
    }
}

/// The body of [`ASCII`] in a binary encoding.
fn binary(big: bool) -> Vec<u8> {
    let (head, body) = ASCII.split_at(ASCII.find("end_header\n").unwrap() + 11);
    let order = if big { "binary_big_endian" } else { "binary_little_endian" };
    let mut bytes = head.replace("ascii", order).into_bytes();
    // One letter per value: b u8, h i16, H u16, I u32, f f32, d f64.
    let formats =
        ["bhhhd", "dfhfffbff", "dfhfffbff", "dfhfffbff", "dfhfffbff", "dfhfffbff", "bIHHHH", "bIHHH", "bIHH"];
    for (line, format) in body.lines().zip(formats) {
        for (word, letter) in line.split(' ').zip(format.chars()) {
            let value: f64 = word.parse().unwrap();
            let mut chunk = match letter {
                'b' => vec![value as u8],
                'h' => (value as i16).to_le_bytes().to_vec(),
                'H' => (value as u16).to_le_bytes().to_vec(),
                'I' => (value as u32).to_le_bytes().to_vec(),
                'f' => (value as f32).to_le_bytes().to_vec(),
                _ => value.to_le_bytes().to_vec(),
            };
            if big {
                chunk.reverse();
            }
            bytes.extend(chunk);
        }
    }
    bytes
}

#[test]
fn every_encoding_gives_the_same_mesh() {
    let options = LoadOptions::default();
    check(&read("a.ply", ASCII, &[], &options).unwrap());
    check(&read("a.ply", &ASCII.replace('\n', "\r\n"), &[], &options).unwrap());
    for big in [false, true] {
        check(&read_bytes("a.ply", &binary(big), &files(&[]), &options).unwrap());
    }
}

#[test]
fn a_binary_file_cut_anywhere_is_an_error() {
    let whole = binary(false);
    for length in 0..whole.len() {
        let result = read_bytes("a.ply", &whole[..length], &files(&[]), &LoadOptions::default());
        assert!(result.is_err(), "cut to {length} of {} bytes", whole.len());
    }
}

#[test]
fn limits_are_checked_while_reading() {
    let mut options = LoadOptions::default();
    options.limits.max_triangles = 2;
    let message = read("a.ply", ASCII, &[], &options).unwrap_err().to_string();
    assert_eq!(message, "a.ply: triangles: needs 3, the limit is 2");
    let quad = "v 0 0 0\nf 1 1 1 1 1\n";
    let message = read("a.obj", quad, &[], &options).unwrap_err().to_string();
    assert_eq!(message, "a.obj: triangles: needs 3, the limit is 2");
}
