//! Linear blend skinning.

use super::super::{Mesh, Transform};
use glam::{DMat3, DVec3, Vec3};

/// A mesh that bends with joints (glTF 2.0, §3.7.3): a vertex goes where the weighted mean of its joints' transforms takes
/// it. The mesh's own positions are those of the bind pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Skin {
    /// Index into [`super::super::Scene::meshes`].
    pub mesh: u32,
    /// The joints.
    pub joints: Vec<Joint>,
    /// Influences on each vertex.
    pub per_vertex: u32,
    /// `per_vertex` for each position of the mesh. Weights count relative to their sum over a vertex, which is positive.
    pub influences: Vec<Influence>,
}

/// A node that a mesh bends with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joint {
    /// Index into [`super::Motion::nodes`].
    pub node: u32,
    /// From the mesh's space to the joint's, in the bind pose.
    pub inverse_bind: Transform,
}

/// How much a vertex follows a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Influence {
    /// Index into [`Skin::joints`].
    pub joint: u32,
    /// At least 0.
    pub weight: f32,
}

impl Skin {
    /// Bends `mesh`, which is in its bind pose, to where the nodes stand in the world.
    pub(super) fn bend(&self, world: &[Transform], mesh: &mut Mesh) {
        let joint = |j: &Joint| world[j.node as usize].then_inner(&j.inverse_bind);
        let joints: Vec<Transform> = self.joints.iter().map(joint).collect();
        for (v, influences) in self.influences.chunks_exact(self.per_vertex as usize).enumerate() {
            let map = blend(&joints, influences);
            mesh.positions[v] = map.point(mesh.positions[v]).as_vec3().to_array();
            if let Some(normal) = mesh.normals.get_mut(v) {
                let n = to_normal(&map.linear) * Vec3::from(*normal).as_dvec3();
                *normal = n.normalize_or_zero().as_vec3().to_array();
            }
        }
    }
}

/// The weighted mean of the joints' transforms.
fn blend(joints: &[Transform], influences: &[Influence]) -> Transform {
    let (mut linear, mut translation, mut sum) = (DMat3::ZERO, DVec3::ZERO, 0.0);
    for influence in influences {
        let (joint, weight) = (&joints[influence.joint as usize], f64::from(influence.weight));
        // Most vertices have fewer joints than there is room for; and 0 times a joint at infinity is no number.
        if weight != 0.0 {
            linear += joint.linear * weight;
            translation += joint.translation * weight;
            sum += weight;
        }
    }
    Transform { linear: linear * (1.0 / sum), translation: translation / sum }
}

/// The inverse transpose up to a positive factor: cofactors, which exist for maps that flatten too.
fn to_normal(m: &DMat3) -> DMat3 {
    let cofactors =
        DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
    if m.determinant() < 0.0 { cofactors * -1.0 } else { cofactors }
}
