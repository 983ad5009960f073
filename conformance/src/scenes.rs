//! Small compiled scenes and rays made to hurt.

mod rays;

pub use rays::{Rays, between};

use twinlight_core::scene::{CompiledScene, Limits, Material, Mesh, Scene, compile};
use twinlight_fixtures::meshes::{self, joined};

/// A scene of one grey mesh.
pub fn scene_of(mesh: Mesh) -> Scene {
    let mut scene = Scene::default();
    scene.add_material(Material::diffuse("grey", [0.5; 3]));
    scene.add_mesh(meshes::with_material(mesh, 0));
    scene
}

/// Compiles a scene of this crate or of the fixtures.
///
/// # Panics
/// When core refuses it, which is a defect of one of the two; [`crate::Trial::run`] reports it.
pub fn compiled(scene: &Scene) -> CompiledScene {
    compile(scene, &Limits::default()).expect("the suite's own scenes are valid")
}

/// Triangles with corners of their own.
pub fn separate(name: &str, corners: &[[[f32; 3]; 3]]) -> Mesh {
    let positions = corners.iter().flatten().copied().collect();
    let triangles = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Mesh::new(name, positions, triangles, 0)
}

/// Triangles of three sizes in a cube.
pub fn soup(count: u32, seed: u64) -> CompiledScene {
    let part = |size: f64| meshes::soup(count.div_ceil(3), size, seed ^ size.to_bits());
    compiled(&scene_of(joined("soup", &[part(0.02), part(0.1), part(0.5)])))
}

/// An axis-parallel room with a block in it: flat boxes, rays in face planes.
pub fn room() -> CompiledScene {
    let block = meshes::placed(meshes::cube(), 0.25, glam::DVec3::new(0.125, -0.75, 0.25));
    compiled(&scene_of(joined("room", &[meshes::inverted(meshes::cube()), block])))
}

/// The same two triangles five times, and a third in their plane.
pub fn coplanar_copies() -> Mesh {
    let (a, b, c, d) = ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]);
    let mut triangles = [[a, b, c], [a, c, d]].repeat(5);
    triangles.push([[-1.0, -1.0, 0.0], [3.0, -1.0, 0.0], [-1.0, 3.0, 0.0]]);
    separate("coplanar copies", &triangles)
}

/// One long edge against two short ones.
pub fn junction() -> Mesh {
    let (left, right, middle) = ([-1.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.0, 0.05, 0.0]);
    let below = [0.0, -1.0, 0.0];
    separate("junction", &[[left, right, [0.0, 1.0, 0.0]], [left, below, middle], [middle, below, right]])
}

/// Triangles whose bounds are flat in one, two or three axes; the last two have no area.
pub fn flat(axes: u32) -> Mesh {
    separate(
        "flat",
        &[match axes {
            1 => [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]],
            2 => [[0.0, 2.0, 1.0], [1.0, 2.0, 1.0], [0.5, 2.0, 1.0]],
            _ => [[3.0, 2.0, 1.0]; 3],
        }],
    )
}
