//! Scenes: what a reader produces ([`Scene`]) and what a backend consumes ([`CompiledScene`]).

mod camera;
mod compile;
mod compiled;
mod environment;
mod light;
mod material;
mod mesh;
pub mod motion;
mod triangle;
mod validate;

pub use camera::Camera;
pub use compile::compile;
pub use compiled::{
    CompiledScene, EMITS_BOTH_SIDES, EnvironmentHeader, HAS_NORMALS, HAS_TEXCOORDS, LIGHT_DIRECTIONAL,
    LIGHT_ENVIRONMENT, LIGHT_POINT, LIGHT_SPHERE, LIGHT_SPOT, LIGHT_TRIANGLE, LightRecord,
    MATERIAL_DIELECTRIC, MATERIAL_MIRROR, MATERIAL_OPAQUE, MaterialRecord, NONE, NOTHING_HIDES,
    SRGB_TABLE_LEN, TriangleAttributes,
};
pub use environment::Environment;
pub use light::Light;
pub use material::{Material, MaterialKind, Texture, Wrap};
pub use mesh::{Instance, Mesh, Transform};
pub use motion::Motion;
pub use triangle::Triangle;
pub use validate::{COORDINATE_LIMIT, Limits};

/// A scene as a reader or a program describes it. [`Scene::validate`] and [`compile`] check it once; kernels trust
/// the result.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scene {
    /// Triangle meshes, in object space.
    pub meshes: Vec<Mesh>,
    /// Placements of meshes. A mesh without an instance is not in the picture.
    pub instances: Vec<Instance>,
    /// Materials, referred to by index.
    pub materials: Vec<Material>,
    /// Textures, referred to by index.
    pub textures: Vec<Texture>,
    /// Lights beside emissive materials.
    pub lights: Vec<Light>,
    /// Light from infinitely far away.
    pub environment: Option<Environment>,
    /// Where the picture is taken from. Readers leave `None` when the file says nothing.
    pub camera: Option<Camera>,
    /// What moves, and how. The rest of the scene is as the file places it, which need not be how it stands at any time:
    /// [`Scene::at`] gives that.
    pub motion: Motion,
    /// What a person should know about how the scene was read: ignored keys, dropped triangles, made-up defaults.
    pub notices: Vec<String>,
}

impl Scene {
    /// Triangles over all instances.
    pub fn triangle_count(&self) -> usize {
        let meshes = &self.meshes;
        self.instances.iter().filter_map(|i| meshes.get(i.mesh as usize)).map(|m| m.triangles.len()).sum()
    }

    /// World bounds (min, max) over all instances, or `None` without a vertex.
    pub fn bounds(&self) -> Option<(glam::DVec3, glam::DVec3)> {
        self.bounds_of(|_| true)
    }

    /// [`Scene::bounds`] over the instances whose numbers `counts` says.
    fn bounds_of(&self, counts: impl Fn(usize) -> bool) -> Option<(glam::DVec3, glam::DVec3)> {
        let mut bounds: Option<(glam::DVec3, glam::DVec3)> = None;
        for (_, instance) in self.instances.iter().enumerate().filter(|(i, _)| counts(*i)) {
            let Some(mesh) = self.meshes.get(instance.mesh as usize) else { continue };
            for &p in &mesh.positions {
                let p = instance.transform.point(p);
                let (lo, hi) = bounds.unwrap_or((p, p));
                bounds = Some((lo.min(p), hi.max(p)));
            }
        }
        bounds
    }

    /// Adds an untransformed mesh and its instance; returns the mesh's index.
    pub fn add_mesh(&mut self, mesh: Mesh) -> u32 {
        let index = self.meshes.len() as u32;
        self.instances.push(Instance::new(mesh.name.clone(), index));
        self.meshes.push(mesh);
        index
    }

    /// Adds a material; returns its index.
    pub fn add_material(&mut self, material: Material) -> u32 {
        self.materials.push(material);
        self.materials.len() as u32 - 1
    }

    /// Whether anything in the scene gives light.
    pub fn has_light(&self) -> bool {
        let emits = |m: &Material| m.emission.iter().any(|&e| e > 0.0);
        let glows = |id: u32| self.materials.get(id as usize).is_some_and(emits);
        let placed = |i: &Instance| match i.material {
            Some(id) => glows(id),
            None => {
                let mesh = self.meshes.get(i.mesh as usize);
                mesh.is_some_and(|mesh| mesh.material_ids.iter().any(|&id| glows(id)))
            }
        };
        !self.lights.is_empty()
            || self.environment.as_ref().is_some_and(Environment::is_bright)
            || self.instances.iter().any(placed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A placement's material decides, not the one that it replaces.
    #[test]
    fn light_is_what_placements_give() {
        let mut scene = Scene::default();
        let dark = scene.add_material(Material::default());
        let bright = scene.add_material(Material::emitter("lamp", [1.0; 3]));
        scene.add_mesh(Mesh::new("triangle", vec![[0.0; 3]; 3], vec![[0, 1, 2]], dark));
        assert!(!scene.has_light());
        scene.instances[0].material = Some(bright);
        assert!(scene.has_light());
        scene.meshes[0].material_ids = vec![bright];
        scene.instances[0].material = Some(dark);
        assert!(!scene.has_light());
        scene.instances[0].material = None;
        assert!(scene.has_light());
        scene.instances.clear();
        assert!(!scene.has_light(), "a mesh without a placement is not in the picture");
    }
}
