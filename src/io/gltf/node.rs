//! The default scene: nodes to instances, lights and a camera.

use super::Document;
use super::material::{self, ReadMaterial};
use super::mesh::primitive_path;
use super::texture::Textures;
use ::gltf::json;
use ::gltf::json::Index;
use glam::{DMat3, DQuat, DVec3};
use std::collections::BTreeMap;
use twinlight_core::Result;
use twinlight_core::scene::{Instance, Scene, Transform};

/// Reads the default scene, else the first, else the nodes that are no one's children.
pub(super) fn read(document: &Document) -> Result<Scene> {
    let mut reader =
        SceneReader { document, scene: Scene::default(), meshes: BTreeMap::new(), materials: Vec::new() };
    reader.read_materials()?;
    let mut visited = vec![false; document.root.nodes.len()];
    // A list instead of recursion: depth is the file's to choose. Pushed in reverse, so that nodes are met in file order.
    let mut open: Vec<(Index<json::Node>, Transform)> =
        roots(document)?.into_iter().rev().map(|n| (n, Transform::IDENTITY)).collect();
    while let Some((index, parent)) = open.pop() {
        let path = format!("nodes[{}]", index.value());
        let node = document.get(&document.root.nodes, index, "node", "scene")?;
        // Nodes form a tree. A second visit is a cycle or a node with two parents, which could repeat exponentially.
        if std::mem::replace(&mut visited[index.value()], true) {
            return Err(document.invalid(&path, "is reached twice: nodes don't form a tree"));
        }
        let transform = parent.then_inner(&local_transform(document, node, &path)?);
        reader.add(node, index, &transform, &path)?;
        let children = node.children.as_deref().unwrap_or_default();
        open.extend(children.iter().rev().map(|&child| (child, transform)));
    }
    Ok(reader.scene)
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

fn local_transform(document: &Document, node: &json::Node, path: &str) -> Result<Transform> {
    if let Some(m) = node.matrix {
        let m = m.map(f64::from);
        if [m[3], m[7], m[11], m[15]] != [0.0, 0.0, 0.0, 1.0] {
            return Err(document.invalid(path, "matrix is not affine: its last row is not 0 0 0 1"));
        }
        let column = |c: usize| DVec3::new(m[4 * c], m[4 * c + 1], m[4 * c + 2]);
        return Ok(Transform {
            linear: DMat3::from_cols(column(0), column(1), column(2)),
            translation: column(3),
        });
    }
    let vector = |v: Option<[f32; 3]>, default: f64| {
        v.map_or(DVec3::splat(default), |v| DVec3::from(v.map(f64::from)))
    };
    let rotation = node.rotation.unwrap_or_default().0.map(f64::from);
    let rotation = DQuat::from_array(rotation);
    let length = rotation.length();
    if !(length > 1e-6 && length.is_finite()) {
        return Err(document.invalid(path, format!("rotation {:?} has no direction", rotation.to_array())));
    }
    let linear = DMat3::from_quat(rotation.normalize()) * DMat3::from_diagonal(vector(node.scale, 1.0));
    Ok(Transform { linear, translation: vector(node.translation, 0.0) })
}

struct SceneReader<'d, 'a> {
    document: &'d Document<'a>,
    scene: Scene,
    /// The scene's meshes for each mesh of the file that was met: one for each primitive with triangles.
    meshes: BTreeMap<usize, Vec<u32>>,
    /// The file's materials, then the default one.
    materials: Vec<ReadMaterial>,
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

    fn add(
        &mut self,
        node: &json::Node,
        index: Index<json::Node>,
        transform: &Transform,
        path: &str,
    ) -> Result<()> {
        let document = self.document;
        if let Some(camera) = node.camera
            && self.scene.camera.is_none()
        {
            self.scene.camera = document.camera(camera, transform, path)?;
        }
        let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        if let Some(light) = light {
            self.scene.lights.push(document.light(light.light, transform, path)?);
        }
        let Some(mesh) = node.mesh else { return Ok(()) };
        let name = node.name.clone().unwrap_or_else(|| format!("nodes[{}]", index.value()));
        let transform = if node.skin.is_some() {
            document.note("skinned meshes shown in their bind pose", &name);
            &Transform::IDENTITY
        } else {
            transform
        };
        if transform.determinant() == 0.0 {
            // Animations hide objects by a scale of 0; there is nothing to see.
            document.note("objects flattened to nothing by their transforms left out", name);
            return Ok(());
        }
        self.add_instances(mesh, &name, transform, path)
    }

    fn add_instances(
        &mut self,
        mesh: Index<json::Mesh>,
        name: &str,
        transform: &Transform,
        path: &str,
    ) -> Result<()> {
        let document = self.document;
        let place = || format!("{}: {path}", document.name);
        for part in self.mesh_parts(mesh, path)? {
            let bytes = size_of::<Instance>() + name.len();
            document.budget.spend(place, 1, bytes as u64)?;
            let triangles = self.scene.meshes[part as usize].triangles.len();
            document.budget.add_triangles(place, triangles as u64)?;
            self.scene.instances.push(Instance { transform: *transform, ..Instance::new(name, part) });
        }
        Ok(())
    }

    /// The scene's meshes for a mesh of the file, read when first met.
    fn mesh_parts(&mut self, index: Index<json::Mesh>, path: &str) -> Result<Vec<u32>> {
        if let Some(parts) = self.meshes.get(&index.value()) {
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
                parts.push(self.scene.meshes.len() as u32);
                self.scene.meshes.push(read);
            }
        }
        self.meshes.insert(index.value(), parts.clone());
        Ok(parts)
    }
}
