//! Triangles that lie exactly on emissive ones.

use super::super::compiled::{EMITS_BOTH_SIDES, MaterialRecord};
use super::Flat;
use std::collections::{BTreeMap, HashMap};

/// The bits of three corners, whatever their order.
type Key = [[u32; 3]; 3];

fn key(corners: &[[f32; 3]; 3]) -> Key {
    let mut key = corners.map(|corner| corner.map(f32::to_bits));
    key.sort_unstable();
    key
}

/// Whether two triangles with the same corners wind the same way.
fn same_winding([a, b, c]: [[f32; 3]; 3], other: [[f32; 3]; 3]) -> bool {
    [[a, b, c], [b, c, a], [c, a, b]].contains(&other)
}

fn emits(material: &MaterialRecord) -> bool {
    material.emission.iter().any(|&e| e > 0.0)
}

/// What was left out.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct LeftOut {
    /// Triangles in all.
    pub(super) triangles: usize,
    /// Those that emit otherwise than the one that stays, so that their light is lost.
    pub(super) other_lights: usize,
}

/// Leaves out every triangle that has the corners of an emissive one. A ray meets only one of them, but each would be
/// sampled as a light of its own: a lamp instanced twice would shine twice. The first emissive one stays, and hides a wall
/// that has its corners. Two that back each other with the same emission become one that emits from both sides, which is
/// what they model. Quads cut along different diagonals share no triangle, and are left as they are.
pub(super) fn leave_out(flat: &mut Flat, materials: &mut Vec<MaterialRecord>) -> LeftOut {
    let mut left_out = LeftOut::default();
    let mut first = HashMap::new();
    for (i, corners) in flat.corners.iter().enumerate() {
        if emits(&materials[flat.materials[i] as usize]) {
            first.entry(key(corners)).or_insert(i);
        }
    }
    if first.is_empty() {
        return left_out;
    }
    let mut keep = vec![true; flat.corners.len()];
    let mut backed = Vec::new();
    for (i, corners) in flat.corners.iter().enumerate() {
        let Some(&stays) = first.get(&key(corners)) else { continue };
        if stays == i {
            continue;
        }
        keep[i] = false;
        left_out.triangles += 1;
        let (own, other) =
            (&materials[flat.materials[stays] as usize], &materials[flat.materials[i] as usize]);
        if own.emission != other.emission {
            left_out.other_lights += usize::from(emits(other));
        } else if !same_winding(flat.corners[stays], *corners) {
            backed.push(stays);
        }
    }
    emit_from_both_sides(flat, materials, &backed);
    if left_out.triangles > 0 {
        flat.retain(&keep);
    }
    left_out
}

fn emit_from_both_sides(flat: &mut Flat, materials: &mut Vec<MaterialRecord>, triangles: &[usize]) {
    let mut two_sided = BTreeMap::new();
    for &triangle in triangles {
        let material = flat.materials[triangle];
        let record = materials[material as usize];
        if record.flags & EMITS_BOTH_SIDES != 0 {
            continue;
        }
        flat.materials[triangle] = *two_sided.entry(material).or_insert_with(|| {
            materials.push(MaterialRecord { flags: record.flags | EMITS_BOTH_SIDES, ..record });
            materials.len() as u32 - 1
        });
    }
}
