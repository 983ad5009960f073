//! Nodes that move and meshes that bend, collected while the scene is walked through.

use super::Document;
use super::animation::Animation;
use super::mesh::primitive_path;
use super::node;
use ::gltf::json;
use ::gltf::json::Index;
use glam::DMat3;
use twinlight_core::Result;
use twinlight_core::scene::motion::{Binding, Local, Motion, Node, Skin};
use twinlight_core::scene::{Scene, Transform};

/// Where a node stands.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// To the world, at rest.
    pub transform: Transform,
    /// Its index in the motion; `None` for the world itself.
    pub node: Option<u32>,
    /// Whether the node or one that it hangs on has keyframes.
    pub keyed: bool,
}

impl Place {
    pub const WORLD: Self = Self { transform: Transform::IDENTITY, node: None, keyed: false };
}

/// A mesh of the scene that has a skin.
pub(super) struct Skinned {
    pub mesh: u32,
    pub skin: Index<json::Skin>,
    /// Mesh of the file and primitive in it.
    pub source: (Index<json::Mesh>, usize),
}

/// The motion of a scene being read.
pub(super) struct Skeleton {
    animation: Animation,
    motion: Motion,
    /// Where the file's nodes are in the motion.
    placed: Vec<Option<u32>>,
    skinned: Vec<Skinned>,
}

impl Skeleton {
    pub fn new(document: &Document) -> Result<Self> {
        let placed = vec![None; document.root.nodes.len()];
        Ok(Self { animation: document.animation()?, motion: Motion::default(), placed, skinned: Vec::new() })
    }

    /// Adds a node under its parent.
    pub fn place(
        &mut self,
        document: &Document,
        index: Index<json::Node>,
        node: &json::Node,
        parent: &Place,
        path: &str,
    ) -> Result<Place> {
        let (local, keyed) = match node::by_matrix(document, node, path)? {
            Some(matrix) => (matrix, None),
            None => {
                let rest = node::rest(document, node, path)?;
                let linear = DMat3::from_quat(rest.rotation) * DMat3::from_diagonal(rest.scale);
                let local = Transform { linear, translation: rest.translation };
                (local, self.animation.take(index, &rest))
            }
        };
        let transform = parent.transform.then_inner(&local);
        document.budget.spend(|| format!("{}: {path}", document.name), 1, size_of::<Node>() as u64)?;
        let number = self.motion.nodes.len() as u32;
        let is_keyed = parent.keyed || keyed.is_some();
        let local = keyed.unwrap_or(Local::Fixed(local));
        self.motion.nodes.push(Node { parent: parent.node, local });
        self.placed[index.value()] = Some(number);
        Ok(Place { transform, node: Some(number), keyed: is_keyed })
    }

    /// Lets an instance follow a node.
    pub fn bind(&mut self, instance: u32, node: u32) {
        self.motion.bindings.push(Binding { instance, nodes: vec![node], inner: Transform::IDENTITY });
    }

    /// Notes a mesh to be bent.
    pub fn skin(&mut self, skinned: Skinned) {
        self.skinned.push(skinned);
    }

    /// Gives the scene its motion. Where nothing moves, the scene is put as its nodes and joints stand.
    pub fn finish(mut self, document: &Document, scene: &mut Scene) -> Result<()> {
        for node in self.animation.left() {
            document.note("animated nodes outside the scene ignored", format!("nodes[{node}]"));
        }
        for skinned in &self.skinned {
            if let Some(skin) = self.read_skin(document, skinned, scene)? {
                self.motion.skins.push(skin);
            }
        }
        if self.motion.is_empty() {
            return Ok(());
        }
        self.motion.duration = self.animation.duration;
        scene.motion = self.motion;
        if !scene.moving().contains(&true) {
            *scene = scene.at(0.0)?;
        }
        Ok(())
    }

    fn read_skin(&self, document: &Document, skinned: &Skinned, scene: &Scene) -> Result<Option<Skin>> {
        let (mesh, primitive) = skinned.source;
        let path = primitive_path(mesh, primitive);
        let Some(joints) = document.joints(skinned.skin, &path, &self.placed)? else {
            document.note("skinned meshes shown in their bind pose: their joints are not in the scene", path);
            return Ok(None);
        };
        let vertices = scene.meshes[skinned.mesh as usize].positions.len();
        let json = &document.root.meshes[mesh.value()].primitives[primitive];
        let Some(influences) = document.influences(json, &path, vertices, joints.len())? else {
            document.note("skinned meshes shown in their bind pose: they have no weights", path);
            return Ok(None);
        };
        let (per_vertex, influences) = (influences.per_vertex, influences.list);
        Ok(Some(Skin { mesh: skinned.mesh, joints, per_vertex, influences }))
    }
}
