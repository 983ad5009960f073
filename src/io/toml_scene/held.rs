//! How much a scene holds, for the limits that its files share.

use twinlight_core::scene::Scene;

/// What a scene holds.
#[derive(Default)]
pub(super) struct Held {
    pub triangles: u64,
    pub bytes: u64,
}

impl Held {
    /// Counts what a mesh file brought.
    pub fn add(&mut self, scene: &Scene) {
        for mesh in &scene.meshes {
            self.triangles += mesh.triangles.len() as u64;
            // Three indices and a material; a position, a normal and texture coordinates.
            self.bytes += 16 * mesh.triangles.len() as u64 + 32 * mesh.positions.len() as u64;
        }
        self.bytes += scene.textures.iter().map(|t| 4 * t.texels.len() as u64).sum::<u64>();
        self.bytes += scene.motion.bytes();
    }
}
