//! Checks that let a pose be computed without looking.

use super::super::Scene;
use super::{Motion, Skin};
use crate::error::{Error, Result};

impl Motion {
    /// Checks every index and length against `scene`, whose motion this is.
    pub(in super::super) fn check(&self, scene: &Scene) -> Result<()> {
        let nodes = self.nodes.len();
        let invalid = |place: String, what: String| Err(Error::invalid(place, what));
        for (i, node) in self.nodes.iter().enumerate() {
            if let Some(parent) = node.parent.filter(|&parent| parent as usize >= i) {
                return invalid(
                    format!("motion node {i}"),
                    format!("parent {parent} does not come before it"),
                );
            }
        }
        for (i, binding) in self.bindings.iter().enumerate() {
            let place = || format!("motion binding {i}");
            if binding.instance as usize >= scene.instances.len() {
                let what = format!("instance {} of {}", binding.instance, scene.instances.len());
                return invalid(place(), what);
            }
            if let Some(node) = binding.nodes.iter().find(|&&node| node as usize >= nodes) {
                return invalid(place(), format!("node {node} of {nodes}"));
            }
        }
        if !self.bindings.is_sorted_by(|a, b| a.instance < b.instance) {
            return invalid("motion bindings".into(), "instances don't ascend".into());
        }
        for (i, skin) in self.skins.iter().enumerate() {
            check_skin(&format!("skin {i}"), skin, nodes, scene)?;
        }
        if !self.skins.is_sorted_by(|a, b| a.mesh < b.mesh) {
            return invalid("skins".into(), "meshes don't ascend".into());
        }
        if !(self.duration >= 0.0 && self.duration.is_finite()) {
            return invalid(
                "motion".into(),
                format!("duration {} is negative or not a number", self.duration),
            );
        }
        Ok(())
    }
}

fn check_skin(place: &str, skin: &Skin, nodes: usize, scene: &Scene) -> Result<()> {
    let invalid = |what: String| Err(Error::invalid(place, what));
    let Some(mesh) = scene.meshes.get(skin.mesh as usize) else {
        return invalid(format!("mesh {} of {}", skin.mesh, scene.meshes.len()));
    };
    if let Some(joint) = skin.joints.iter().find(|joint| joint.node as usize >= nodes) {
        return invalid(format!("node {} of {nodes}", joint.node));
    }
    let (per_vertex, positions) = (skin.per_vertex as usize, mesh.positions.len());
    if per_vertex == 0 || positions.checked_mul(per_vertex) != Some(skin.influences.len()) {
        let what =
            format!("{} influences, {per_vertex} for each of {positions} positions", skin.influences.len());
        return invalid(what);
    }
    for (v, influences) in skin.influences.chunks_exact(per_vertex).enumerate() {
        if let Some(bad) = influences.iter().find(|i| i.joint as usize >= skin.joints.len()) {
            return invalid(format!("vertex {v}: joint {} of {}", bad.joint, skin.joints.len()));
        }
        if let Some(bad) = influences.iter().find(|i| !(i.weight >= 0.0 && i.weight.is_finite())) {
            return invalid(format!("vertex {v}: weight {} is negative or not a number", bad.weight));
        }
        if influences.iter().all(|i| i.weight == 0.0) {
            return invalid(format!("vertex {v}: no joint has a weight"));
        }
    }
    Ok(())
}
