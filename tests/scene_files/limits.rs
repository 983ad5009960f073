//! Small files can't ask for much.

use crate::{read, read_bytes};
use twinlight::io::LoadOptions;
use twinlight::io::resolve::MemoryFiles;

const VERTICES: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";

#[test]
fn a_library_named_again_and_again_is_read_once() {
    let text = format!("{}{VERTICES}usemtl m\nf 1 2 3\n", "mtllib a.mtl\n".repeat(1000));
    let scene = read("a.obj", &text, &[("a.mtl", "newmtl m\n")], &LoadOptions::default()).unwrap();
    assert_eq!(scene.materials.len(), 1);
}

#[test]
fn long_names_are_not_copied_to_every_group() {
    let faces = "f 1 2 3\nf 1/1 2/1 3/1\n".repeat(1000);
    let text = format!("{VERTICES}g {}\n{faces}", "x".repeat(1 << 20));
    let scene = read("a.obj", &text, &[], &LoadOptions::default()).unwrap();
    assert_eq!(scene.meshes.len(), 2000);
    assert!(scene.meshes.iter().all(|m| m.name.len() < 100));
}

#[test]
fn notices_are_bounded() {
    let text = format!("{}{VERTICES}", "usemtl a\nusemtl b\nbad\nmtllib c.mtl\nmtllib d.mtl\n".repeat(1000));
    let names: String = (0..1000).map(|i| format!("usemtl {i}\nmtllib {i}.mtl\n")).collect();
    let scene = read("a.obj", &(text + &names), &[], &LoadOptions::default()).unwrap();
    assert!(scene.notices.len() < 50, "{}", scene.notices.len());
    assert!(scene.notices.iter().any(|n| n.contains("980 more unknown statements")), "{:?}", scene.notices);
}

#[test]
fn faces_are_counted_against_the_bytes() {
    let mut options = LoadOptions::default();
    options.limits.max_bytes = 10_000;
    let text = format!("{VERTICES}{}", "f 1 2 3\n".repeat(100));
    let message = read("a.obj", &text, &[], &options).unwrap_err().to_string();
    assert!(
        message.starts_with("a.obj: bytes to read the faces: needs ") && message.ends_with("is 10000"),
        "{message}"
    );
}

#[test]
fn textures_share_one_limit() {
    let picture = include_bytes!("../../fixtures/files/textured-quad/checker.png");
    let library = "newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd b.png\n";
    let files = MemoryFiles::new([
        ("a.mtl".to_owned(), library.as_bytes().to_vec()),
        ("a.png".to_owned(), picture.to_vec()),
        ("b.png".to_owned(), picture.to_vec()),
        ("a.obj".to_owned(), b"mtllib a.mtl\n".to_vec()),
    ]);
    let mut options = LoadOptions::default();
    let scene = read_bytes("a.obj", b"mtllib a.mtl\n", &files, &options).unwrap();
    let held = 4 * scene.textures[0].texels.len() as u64;
    assert_eq!(scene.textures.len(), 2);
    // Decoding needs at most 16 bytes per texel for a while; the limit leaves room for one picture, not for a second.
    options.limits.max_bytes = 4 * held + held / 2;
    let message = read_bytes("a.obj", b"mtllib a.mtl\n", &files, &options).unwrap_err().to_string();
    assert!(message.starts_with("b.png: decoded bytes"), "{message}");
}

#[test]
fn the_meshes_of_a_scene_file_share_one_limit() {
    let mut options = LoadOptions::default();
    options.limits.max_triangles = 1;
    let mesh = format!("{VERTICES}f 1 2 3\n");
    let others =
        [("a.obj", mesh.as_str()), ("b.obj", mesh.as_str()), ("c.toml", "[[mesh]]\npath = 'b.obj'\n")];
    assert!(read("s.toml", "[[mesh]]\npath = 'a.obj'\n", &others, &options).is_ok());
    for second in ["b.obj", "c.toml", "builtin:cornell"] {
        let text = format!("[[mesh]]\npath = 'a.obj'\n[[mesh]]\npath = '{second}'\n");
        let message = read("s.toml", &text, &others, &options).unwrap_err().to_string();
        assert!(message.contains("triangles"), "{message}");
    }
}

#[test]
fn long_headers_and_lines_end_soon() {
    let header = format!(
        "ply\nformat ascii 1.0\n{}",
        (0..100_000).map(|i| format!("element e{i} 0\n")).collect::<String>()
    );
    let message = read("a.ply", &header, &[], &LoadOptions::default()).unwrap_err().to_string();
    assert!(message.ends_with("the header has no 'end_header'"), "{message}");
    let line = "f ".to_owned() + &"1 ".repeat(1 << 20);
    let scene = read("a.obj", &(VERTICES.to_owned() + &line), &[], &LoadOptions::default()).unwrap();
    assert_eq!(scene.triangle_count(), (1 << 20) - 2);
}
