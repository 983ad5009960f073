//! What of a scene moves, and how.
//!
//! Three kinds of data, as in glTF 2.0: a forest of [`Node`]s whose translations, rotations and scales follow keyframes
//! (§3.11), [`Binding`]s of instances to nodes (§3.5), and [`Skin`]s, which bend meshes with the nodes that are their
//! joints (§3.7.3). [`super::Scene::at`] gives the scene at a time. Only `+ - * /` and square roots of f64 go into it, so
//! that a frame has the same bits on every machine.

mod check;
mod curve;
mod pose;
mod rotation;
mod skin;

pub use curve::{Curve, Interpolation, Keyed};
pub use skin::{Influence, Joint, Skin};

use super::Transform;
use glam::{DMat3, DQuat, DVec3};

/// The motion of a scene; empty for one that stands still.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Motion {
    /// What moves instances and joints; parents come before their children.
    pub nodes: Vec<Node>,
    /// Instances that follow nodes, by ascending instance, each at most once.
    pub bindings: Vec<Binding>,
    /// Meshes that bend, by ascending mesh, each at most once.
    pub skins: Vec<Skin>,
    /// Seconds from 0 to the last keyframe.
    pub duration: f64,
}

/// A frame of reference within another.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The node whose space this one is in: a lower index into [`Motion::nodes`], or `None` for the world.
    pub parent: Option<u32>,
    /// From this node's space to its parent's.
    pub local: Local,
}

/// A node's transform within its parent.
#[derive(Debug, Clone, PartialEq)]
pub enum Local {
    /// The same at all times.
    Fixed(Transform),
    /// By keyframes.
    Keyed(Box<Track>),
}

/// Keyframes of a transform that scales, then rotates, then moves.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// Translation, units of the parent.
    pub translation: Curve<DVec3>,
    /// Rotation; values need not have length 1.
    pub rotation: Curve<DQuat>,
    /// Scale, one factor per axis.
    pub scale: Curve<DVec3>,
}

impl Track {
    /// The transform at a time in seconds.
    pub fn at(&self, seconds: f64) -> Transform {
        let linear =
            DMat3::from_quat(self.rotation.at(seconds)) * DMat3::from_diagonal(self.scale.at(seconds));
        Transform { linear, translation: self.translation.at(seconds) }
    }

    /// Whether it is the same at all times.
    pub fn is_constant(&self) -> bool {
        self.translation.is_constant() && self.rotation.is_constant() && self.scale.is_constant()
    }
}

/// An instance that follows nodes: its transform becomes W(`nodes[0]`) · W(`nodes[1]`) · … · `inner`, where W leads from
/// a node's space to that of its root's surroundings.
///
/// More than one node occurs where a scene that moves is itself placed in another scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Binding {
    /// Index into [`super::Scene::instances`].
    pub instance: u32,
    /// Indices into [`Motion::nodes`], outermost first.
    pub nodes: Vec<u32>,
    /// From the mesh's space to that of the last node.
    pub inner: Transform,
}

impl Motion {
    /// Whether nothing is posed.
    pub fn is_empty(&self) -> bool {
        self.bindings.is_empty() && self.skins.is_empty()
    }

    /// Bytes held.
    pub fn bytes(&self) -> u64 {
        let keys = |node: &Node| match &node.local {
            Local::Fixed(_) => 0,
            Local::Keyed(track) => {
                size_of::<Track>() + track.translation.bytes() + track.rotation.bytes() + track.scale.bytes()
            }
        };
        let nodes: usize = self.nodes.iter().map(|node| size_of::<Node>() + keys(node)).sum();
        let bindings: usize =
            self.bindings.iter().map(|b| size_of::<Binding>() + size_of_val(&*b.nodes)).sum();
        let skins: usize = self
            .skins
            .iter()
            .map(|s| size_of::<Skin>() + size_of_val(&*s.joints) + size_of_val(&*s.influences))
            .sum();
        (nodes + bindings + skins) as u64
    }
}
