//! How hostile bytes reach each reader: used by the fuzz targets and, with the committed corpus, by an ordinary test.
//!
//! Whatever the bytes, a reader returns; a scene it accepts passes validation or is refused by it, and can be completed,
//! posed and compiled.

use twinlight::io::resolve::MemoryFiles;
use twinlight::io::{LoadOptions, complete, obj, ply, toml_scene};
use twinlight_core::Result;
use twinlight_core::scene::{Limits, Scene, compile};

/// Triangles up to which an accepted scene is compiled too.
const COMPILED_TRIANGLES: usize = 256;

const TRIANGLE: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";

/// Small limits: a file of some kilobytes has no business needing more.
pub fn options() -> LoadOptions {
    let limits = Limits { max_triangles: 1 << 16, max_bytes: 32 << 20, lenient: false };
    LoadOptions { limits, max_file_bytes: 16 << 20, ..LoadOptions::default() }
}

fn files(own: (&str, &[u8])) -> MemoryFiles {
    let mut texts = vec![
        ("a.obj".to_owned(), TRIANGLE.as_bytes().to_vec()),
        ("a.mtl".to_owned(), b"newmtl m\nKd 1 1 1\nmap_Kd a.png\n".to_vec()),
        ("sub/b.obj".to_owned(), TRIANGLE.as_bytes().to_vec()),
    ];
    texts.push((own.0.to_owned(), own.1.to_vec()));
    MemoryFiles::new(texts)
}

/// What a caller does with a scene that was read.
fn used(scene: Result<Scene>) -> Result<Scene> {
    let mut scene = scene?;
    let limits = options().limits;
    scene.validate(&limits)?;
    complete(&mut scene);
    let middle = scene.at(scene.motion.duration * 0.5)?;
    if scene.triangle_count() <= COMPILED_TRIANGLES {
        compile(&scene, &limits)?;
        // Numbers that are fine at every keyframe may overflow between them.
        let _ = compile(&middle, &limits);
    }
    Ok(scene)
}

/// Both ways of reading.
fn strictly_and_leniently(read: impl Fn(&LoadOptions) -> Result<Scene>) -> Result<Scene> {
    let mut strict = options();
    strict.strict = true;
    let _ = used(read(&strict));
    let mut lenient = options();
    lenient.limits.lenient = true;
    let _ = used(read(&lenient));
    used(read(&options()))
}

/// `bytes` as an OBJ file.
///
/// # Errors
/// Those of the reader.
pub fn obj(bytes: &[u8]) -> Result<Scene> {
    let files = files(("x.obj", bytes));
    strictly_and_leniently(|options| obj::parse(bytes, "x.obj", &files, options))
}

/// `bytes` as the material library of a triangle.
///
/// # Errors
/// Those of the reader.
pub fn mtl(bytes: &[u8]) -> Result<Scene> {
    let files = files(("a.mtl", bytes));
    strictly_and_leniently(|options| obj::parse(TRIANGLE.as_bytes(), "a.obj", &files, options))
}

/// `bytes` as a PLY file.
///
/// # Errors
/// Those of the reader.
pub fn ply(bytes: &[u8]) -> Result<Scene> {
    let files = files(("x.ply", bytes));
    strictly_and_leniently(|options| ply::parse(bytes, "x.ply", &files, options))
}

/// `bytes` as a TOML scene file beside a mesh and itself.
///
/// # Errors
/// Those of the reader.
pub fn toml(bytes: &[u8]) -> Result<Scene> {
    let files = files(("x.toml", bytes));
    strictly_and_leniently(|options| toml_scene::parse(bytes, "x.toml", &files, options))
}
