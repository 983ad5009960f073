//! Skins: joints, inverse bind matrices, weights (glTF 2.0, §3.7.3).

use super::Document;
use super::node::affine;
use ::gltf::json::mesh::{Primitive, Semantic};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, Skin as JsonSkin};
use twinlight_core::Result;
use twinlight_core::scene::Transform;
use twinlight_core::scene::motion::{Influence, Joint};

/// How far the weights of a vertex may add up to something else than 1 without a notice: more than 8-bit weights round.
const ROUNDED: f32 = 0.02;

/// The influences of a mesh's vertices.
pub(super) struct Influences {
    pub per_vertex: u32,
    pub list: Vec<Influence>,
}

impl Document<'_> {
    /// The joints of a skin, given where each node of the file stands in the scene; `None` when one stands outside.
    pub fn joints(
        &self,
        index: Index<JsonSkin>,
        path: &str,
        placed: &[Option<u32>],
    ) -> Result<Option<Vec<Joint>>> {
        let skin = self.get(&self.root.skins, index, "skin", path)?;
        let path = format!("skins[{}]", index.value());
        let place = || format!("{}: {path}", self.name);
        self.budget.spend(place, skin.joints.len() as u64, size_of::<Joint>() as u64)?;
        let binds = match skin.inverse_bind_matrices {
            Some(accessor) => self.inverse_binds(accessor, &path)?,
            None => vec![Transform::IDENTITY; skin.joints.len()],
        };
        if binds.len() < skin.joints.len() {
            let what = format!("{} inverse bind matrices for {} joints", binds.len(), skin.joints.len());
            return Err(self.invalid(&path, what));
        }
        let mut joints = Vec::with_capacity(skin.joints.len());
        for (i, (&node, inverse_bind)) in skin.joints.iter().zip(binds).enumerate() {
            self.get(&self.root.nodes, node, "node", &format!("{path}.joints[{i}]"))?;
            let Some(node) = placed[node.value()] else { return Ok(None) };
            joints.push(Joint { node, inverse_bind });
        }
        Ok(Some(joints))
    }

    fn inverse_binds(&self, accessor: Index<::gltf::json::Accessor>, path: &str) -> Result<Vec<Transform>> {
        let path = format!("{path}.inverseBindMatrices");
        let matrices = self.floats::<16>(accessor, &path)?;
        let read = |(i, m): (usize, &[f32; 16])| {
            let transform = affine(m).filter(|t| t.linear.is_finite() && t.translation.is_finite());
            transform
                .ok_or_else(|| self.invalid(&format!("{path}[{i}]"), "matrix is not affine or not finite"))
        };
        matrices.iter().enumerate().map(read).collect()
    }

    /// Which joints, of so many, each vertex of a primitive follows; `None` when it says nothing.
    pub fn influences(
        &self,
        primitive: &Primitive,
        path: &str,
        vertices: usize,
        joints: usize,
    ) -> Result<Option<Influences>> {
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let mut sets = Vec::new();
        for set in 0.. {
            let found = (attribute(Semantic::Joints(set)), attribute(Semantic::Weights(set)));
            let (Some(indices), Some(weights)) = found else { break };
            let [joints_path, weights_path] =
                ["JOINTS", "WEIGHTS"].map(|name| format!("{path}.attributes.{name}_{set}"));
            let indices = self.joint_indices(indices, &joints_path)?;
            let weights = self.floats::<4>(weights, &weights_path)?;
            for (what, len) in [(&joints_path, indices.len()), (&weights_path, weights.len())] {
                if len != vertices {
                    return Err(self.invalid(what, format!("{len} elements for {vertices} positions")));
                }
            }
            sets.push((indices, weights));
        }
        if sets.is_empty() {
            return Ok(None);
        }
        let place = || format!("{}: {path}", self.name);
        let influences = (vertices as u64).saturating_mul(4 * sets.len() as u64);
        self.budget.spend(place, influences, size_of::<Influence>() as u64)?;
        let mut list = Vec::with_capacity(influences as usize);
        for vertex in 0..vertices {
            let start = list.len();
            for (indices, weights) in &sets {
                for (joint, weight) in indices[vertex].into_iter().zip(weights[vertex]) {
                    list.push(self.influence(joint, weight, joints, vertex, path)?);
                }
            }
            self.settle(&mut list[start..], path);
        }
        Ok(Some(Influences { per_vertex: 4 * sets.len() as u32, list }))
    }

    fn influence(
        &self,
        joint: u32,
        weight: f32,
        joints: usize,
        vertex: usize,
        path: &str,
    ) -> Result<Influence> {
        if !(weight >= 0.0 && weight.is_finite()) {
            let what = format!("weight {weight} of vertex {vertex} is negative or not a number");
            return Err(self.invalid(path, what));
        }
        // Exporters leave anything in the joints that they don't use.
        let used = weight > 0.0;
        if used && joint as usize >= joints {
            return Err(self.invalid(path, format!("joint {joint} of {joints} at vertex {vertex}")));
        }
        Ok(Influence { joint: if used { joint } else { 0 }, weight })
    }

    /// Weights count relative to their sum; a vertex without any follows the first joint.
    fn settle(&self, influences: &mut [Influence], path: &str) {
        let sum: f32 = influences.iter().map(|i| i.weight).sum();
        if sum == 0.0 {
            self.note("vertices without weights follow the first joint", path);
            influences[0].weight = 1.0;
        } else if !((sum - 1.0).abs() <= ROUNDED) {
            self.note("vertices with weights that don't add up to 1 scaled", path);
        }
    }
}
