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

/// Leaves out every triangle that has the corners of an emissive one, and returns how many. A ray meets only one of them,
/// but each would be sampled as a light of its own: a lamp instanced twice would shine twice. Of several emissive ones the
/// first stays. Two that back each other are how files without two-sided emitters model one, so that becomes one.
pub(super) fn leave_out(flat: &mut Flat, materials: &mut Vec<MaterialRecord>) -> usize {
    let mut first = HashMap::new();
    for (i, corners) in flat.corners.iter().enumerate() {
        if emits(&materials[flat.materials[i] as usize]) {
            first.entry(key(corners)).or_insert(i);
        }
    }
    if first.is_empty() {
        return 0;
    }
    let mut keep = vec![true; flat.corners.len()];
    let mut backed = Vec::new();
    for (i, corners) in flat.corners.iter().enumerate() {
        let Some(&stays) = first.get(&key(corners)) else { continue };
        if stays == i {
            continue;
        }
        keep[i] = false;
        let same_light = flat.materials[i] == flat.materials[stays];
        if same_light && !same_winding(flat.corners[stays], *corners) {
            backed.push(stays);
        }
    }
    emit_from_both_sides(flat, materials, &backed);
    let left_out = keep.iter().filter(|&&keep| !keep).count();
    if left_out > 0 {
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
