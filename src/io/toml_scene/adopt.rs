//! Motions of mesh files where the files are placed.

use twinlight_core::scene::motion::{Binding, Local, Motion, Node, Track};
use twinlight_core::scene::{Instance, Transform};

/// The nodes that an instance of a mesh file follows, by their numbers in the whole scene, and where it is in the last.
#[derive(Clone)]
pub(super) struct Follows {
    nodes: Vec<u32>,
    inner: Transform,
}

/// Takes over a mesh file's motion, whose meshes are numbered from `first_mesh` on in the whole scene; returns what each of
/// its instances follows.
pub(super) fn adopt(
    all: &mut Motion,
    own: Motion,
    first_mesh: u32,
    instances: usize,
) -> Vec<Option<Follows>> {
    let first = all.nodes.len() as u32;
    let shifted = |node: Node| Node { parent: node.parent.map(|parent| parent + first), ..node };
    all.nodes.extend(own.nodes.into_iter().map(shifted));
    for mut skin in own.skins {
        skin.mesh += first_mesh;
        skin.joints.iter_mut().for_each(|joint| joint.node += first);
        all.skins.push(skin);
    }
    all.duration = all.duration.max(own.duration);
    let mut follows = vec![None; instances];
    for Binding { instance, nodes, inner } in own.bindings {
        let nodes = nodes.into_iter().map(|node| node + first).collect();
        follows[instance as usize] = Some(Follows { nodes, inner });
    }
    follows
}

/// How a mesh file is placed.
pub(super) struct Placement<'a> {
    /// Where it stands, or begins.
    pub transform: Transform,
    /// How it moves.
    pub track: Option<&'a Track>,
}

impl Placement<'_> {
    /// As a node of the motion, where there is something to follow: `None` for a placement that leaves all as it is.
    pub fn node(&self, all: &mut Motion, part_moves: bool) -> Option<u32> {
        let local = match self.track {
            Some(track) => Local::Keyed(Box::new(track.clone())),
            None if part_moves && self.transform != Transform::IDENTITY => Local::Fixed(self.transform),
            None => return None,
        };
        all.nodes.push(Node { parent: None, local });
        Some(all.nodes.len() as u32 - 1)
    }

    /// The binding of an instance of the file, the scene's number `instance`, below the node of the placement.
    pub fn bind(
        &self,
        instance: usize,
        placed: &Instance,
        follows: Option<&Follows>,
        node: Option<u32>,
    ) -> Option<Binding> {
        let own = match follows {
            Some(follows) => follows.clone(),
            None if self.track.is_some() => Follows { nodes: Vec::new(), inner: placed.transform },
            None => return None,
        };
        let nodes = node.into_iter().chain(own.nodes).collect();
        Some(Binding { instance: instance as u32, nodes, inner: own.inner })
    }
}
