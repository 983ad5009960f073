//! Binary PLY.

use std::io::Write as _;
use twinlight::scene::Mesh;

/// The triangles of `mesh` that `keep` accepts, with normals and texture coordinates where the mesh has them, as a
/// binary little-endian PLY. Vertices that no kept triangle uses are left out.
pub fn encode(mesh: &Mesh, keep: impl Fn(usize) -> bool) -> Vec<u8> {
    let kept: Vec<[u32; 3]> =
        mesh.triangles.iter().enumerate().filter(|(i, _)| keep(*i)).map(|(_, t)| *t).collect();
    let mut new_index = vec![None; mesh.positions.len()];
    let mut vertices = Vec::new();
    for &v in kept.iter().flatten() {
        let entry = &mut new_index[v as usize];
        if entry.is_none() {
            *entry = Some(vertices.len() as u32);
            vertices.push(v as usize);
        }
    }
    let (has_normals, has_texcoords) = (!mesh.normals.is_empty(), !mesh.texcoords.is_empty());
    let mut names = vec!["x", "y", "z"];
    names.extend(has_normals.then_some(["nx", "ny", "nz"]).into_iter().flatten());
    names.extend(has_texcoords.then_some(["s", "t"]).into_iter().flatten());
    let properties: String = names.iter().map(|name| format!("property float {name}\n")).collect();
    let mut bytes = Vec::with_capacity(vertices.len() * names.len() * 4 + kept.len() * 13 + 256);
    // Writing to a vector can't fail.
    let _ = write!(
        bytes,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n{properties}element face {}\nproperty list uchar uint \
         vertex_indices\nend_header\n",
        vertices.len(),
        kept.len()
    );
    for &v in &vertices {
        let normal = if has_normals { &mesh.normals[v][..] } else { &[] };
        let texcoord = if has_texcoords { &mesh.texcoords[v][..] } else { &[] };
        for number in mesh.positions[v].iter().chain(normal).chain(texcoord) {
            bytes.extend(number.to_le_bytes());
        }
    }
    for triangle in &kept {
        bytes.push(3);
        for &v in triangle {
            bytes.extend(new_index[v as usize].unwrap_or(0).to_le_bytes());
        }
    }
    bytes
}
