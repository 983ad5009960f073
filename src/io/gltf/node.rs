//! The default scene: nodes to instances, lights and a camera.

use super::Document;
use super::material::{self, ReadMaterial};
use super::mesh::primitive_path;
use super::skeleton::{Place, Skeleton, Skinned};
use super::texture::Textures;
use ::gltf::json;
use ::gltf::json::Index;
use glam::{DMat3, DQuat, DVec3};
use std::collections::BTreeMap;
use twinlight_core::Result;
use twinlight_core::scene::{Instance, Scene, Transform};

/// How far the last row of a matrix may be from 0 0 0 1.
const ROUNDED: f64 = 1e-5;

/// A node's transform at rest, in parts.
pub(super) struct Rest {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
}

/// Reads the default scene, else the first, else the nodes that are no one's children.
pub(super) fn read(document: &Document) -> Result<Scene> {
    let mut reader = SceneReader {
        document,
        scene: Scene::default(),
        meshes: BTreeMap::new(),
        materials: Vec::new(),
        skeleton: Skeleton::new(document)?,
    };
    reader.read_materials()?;
    let mut visited = vec![false; document.root.nodes.len()];
    // A list instead of recursion: depth is the file's to choose. Pushed in reverse, so that nodes are met in file order.
    let mut open: Vec<(Index<json::Node>, Place)> =
        roots(document)?.into_iter().rev().map(|n| (n, Place::WORLD)).collect();
    while let Some((index, parent)) = open.pop() {
        let path = format!("nodes[{}]", index.value());
        let node = document.get(&document.root.nodes, index, "node", "scene")?;
        // Nodes form a tree. A second visit is a cycle or a node with two parents, which could repeat exponentially.
        if std::mem::replace(&mut visited[index.value()], true) {
            return Err(document.invalid(&path, "is reached twice: nodes don't form a tree"));
        }
        let place = reader.skeleton.place(document, index, node, &parent, &path)?;
        reader.add(node, index, &place, &path)?;
        let children = node.children.as_deref().unwrap_or_default();
        open.extend(children.iter().rev().map(|&child| (child, place)));
    }
    let mut scene = reader.scene;
    reader.skeleton.finish(document, &mut scene)?;
    Ok(scene)
}

fn roots(document: &Document) -> Result<Vec<Index<json::Node>>> {
    let root = document.root;
    let scene = match root.scene {
        Some(index) => Some(document.get(&root.scenes, index, "scene", "scene")?),
        None => root.scenes.first(),
    };
    if let Some(scene) = scene {
        return Ok(scene.nodes.clone());
    }
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(|n| n.children.as_deref().unwrap_or_default()) {
        if let Some(flag) = is_child.get_mut(child.value()) {
            *flag = true;
        }
    }
    let tops = is_child.iter().enumerate().filter(|&(_, &child)| !child);
    Ok(tops.map(|(i, _)| Index::new(i as u32)).collect())
}

/// The transform of a column-major matrix whose last row is 0 0 0 1, but for roundings.
pub(super) fn affine(m: &[f32; 16]) -> Option<Transform> {
    let m = m.map(f64::from);
    let off = [m[3], m[7], m[11], m[15] - 1.0];
    let column = |c: usize| DVec3::new(m[4 * c], m[4 * c + 1], m[4 * c + 2]);
    off.iter().all(|x| x.abs() <= ROUNDED).then(|| Transform {
        linear: DMat3::from_cols(column(0), column(1), column(2)),
        translation: column(3),
    })
}

/// How a node is placed in its parent by a matrix.
pub(super) fn by_matrix(document: &Document, node: &json::Node, path: &str) -> Result<Option<Transform>> {
    let Some(matrix) = &node.matrix else { return Ok(None) };
    match affine(matrix) {
        Some(transform) => Ok(Some(transform)),
        None => Err(document.invalid(path, "matrix is not affine: its last row is not 0 0 0 1")),
    }
}

/// How a node is placed in its parent by translation, rotation and scale.
pub(super) fn rest(document: &Document, node: &json::Node, path: &str) -> Result<Rest> {
    let vector = |v: Option<[f32; 3]>, default: f64| {
        v.map_or(DVec3::splat(default), |v| DVec3::from(v.map(f64::from)))
    };
    let rotation = DQuat::from_array(node.rotation.unwrap_or_default().0.map(f64::from));
    let length = rotation.length();
    if !(length > 1e-6 && length.is_finite()) {
        return Err(document.invalid(path, format!("rotation {:?} has no direction", rotation.to_array())));
    }
    let (translation, scale) = (vector(node.translation, 0.0), vector(node.scale, 1.0));
    Ok(Rest { translation, rotation: rotation.normalize(), scale })
}

struct SceneReader<'d, 'a> {
    document: &'d Document<'a>,
    scene: Scene,
    /// The scene's meshes for each mesh of the file that was met, and each skin it was met with: one for each primitive
    /// with triangles.
    meshes: BTreeMap<(usize, Option<usize>), Vec<u32>>,
    /// The file's materials, then the default one.
    materials: Vec<ReadMaterial>,
    skeleton: Skeleton,
}

impl SceneReader<'_, '_> {
    fn read_materials(&mut self) -> Result<()> {
        let document = self.document;
        let mut textures = Textures::default();
        for (i, material) in document.root.materials.iter().enumerate() {
            self.materials.push(material::read(document, &mut textures, material, Some(i))?);
        }
        let primitives = document.root.meshes.iter().flat_map(|m| &m.primitives);
        if primitives.into_iter().any(|p| p.material.is_none()) {
            let default = json::Material::default();
            self.materials.push(material::read(document, &mut textures, &default, None)?);
        }
        self.scene.materials = self.materials.iter().map(|m| m.material.clone()).collect();
        self.scene.textures = textures.into_list();
        Ok(())
    }

    fn add(&mut self, node: &json::Node, index: Index<json::Node>, place: &Place, path: &str) -> Result<()> {
        let document = self.document;
        let transform = &place.transform;
        let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        if place.keyed && (node.camera.is_some() || light.is_some()) {
            document.note("cameras and lights on animated nodes stay where they rest", path);
        }
        if let Some(camera) = node.camera
            && self.scene.camera.is_none()
        {
            self.scene.camera = document.camera(camera, transform, path)?;
        }
        if let Some(light) = light {
            self.scene.lights.push(document.light(light.light, transform, path)?);
        }
        let Some(mesh) = node.mesh else { return Ok(()) };
        let name = node.name.clone().unwrap_or_else(|| format!("nodes[{}]", index.value()));
        // The joints alone place a skinned mesh: its node's transform plays no part.
        let place = if node.skin.is_some() { &Place::WORLD } else { place };
        if place.transform.determinant() == 0.0 && !place.keyed {
            // Exporters hide objects by a scale of 0; there is nothing to see.
            document.note("objects flattened to nothing by their transforms left out", name);
            return Ok(());
        }
        for part in self.mesh_parts(mesh, node.skin, path)? {
            self.add_instance(part, &name, place, path)?;
        }
        Ok(())
    }

    fn add_instance(&mut self, mesh: u32, name: &str, place: &Place, path: &str) -> Result<()> {
        let document = self.document;
        let message_place = || format!("{}: {path}", document.name);
        document.budget.spend(message_place, 1, (size_of::<Instance>() + name.len()) as u64)?;
        let triangles = self.scene.meshes[mesh as usize].triangles.len();
        document.budget.add_triangles(message_place, triangles as u64)?;
        if let Some(node) = place.node.filter(|_| place.keyed) {
            self.skeleton.bind(self.scene.instances.len() as u32, node);
        }
        let transform = if place.keyed { place.transform.or_point() } else { place.transform };
        self.scene.instances.push(Instance { transform, ..Instance::new(name, mesh) });
        Ok(())
    }

    /// The scene's meshes for a mesh of the file, read when first met: with each skin it is another one.
    fn mesh_parts(
        &mut self,
        index: Index<json::Mesh>,
        skin: Option<Index<json::Skin>>,
        path: &str,
    ) -> Result<Vec<u32>> {
        let key = (index.value(), skin.map(|skin| skin.value()));
        if let Some(parts) = self.meshes.get(&key) {
            return Ok(parts.clone());
        }
        let document = self.document;
        let mesh = document.get(&document.root.meshes, index, "mesh", path)?;
        let mut parts = Vec::new();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let path = primitive_path(index, i);
            let material = match primitive.material {
                Some(material) => {
                    document.get(&document.root.materials, material, "material", &path)?;
                    material.value()
                }
                None => document.root.materials.len(),
            };
            let texture = self.materials.get(material).and_then(|m| m.texture.as_ref());
            if let Some(read) = document.primitive(primitive, &path, material as u32, texture)? {
                let part = self.scene.meshes.len() as u32;
                if let Some(skin) = skin {
                    self.skeleton.skin(Skinned { mesh: part, skin, source: (index, i) });
                }
                parts.push(part);
                self.scene.meshes.push(read);
            }
        }
        self.meshes.insert(key, parts.clone());
        Ok(parts)
    }
}
