//! Face centres of subdivided polyhedra: one of each pair of opposite faces.

use glam::DVec3;

type Face = [DVec3; 3];

/// One half of the icosahedron's face centres.
pub(super) fn icosahedron(subdivisions: u32) -> Vec<DVec3> {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut vertices = Vec::new();
    for (a, b) in [(1.0, golden), (1.0, -golden), (-1.0, golden), (-1.0, -golden)] {
        vertices.extend([DVec3::new(0.0, a, b), DVec3::new(a, b, 0.0), DVec3::new(b, 0.0, a)]);
    }
    // Neighbours' product is the golden ratio, the next larger one is that of a vertex with itself, golden + 2.
    let adjacent = |a: DVec3, b: DVec3| a.dot(b) > 1.0;
    let mut faces = Vec::new();
    for (i, &a) in vertices.iter().enumerate() {
        for (j, &b) in vertices.iter().enumerate().skip(i + 1) {
            let third = vertices.iter().skip(j + 1).filter(|&&c| adjacent(a, c) && adjacent(b, c));
            faces.extend(third.filter(|_| adjacent(a, b)).map(|&c| [a, b, c]));
        }
    }
    // Coordinates of the sums are 0 exactly or far from it.
    let first = |sum: DVec3| sum.to_array().into_iter().find(|&c| c != 0.0);
    faces.retain(|&[a, b, c]| first(a + b + c) > Some(0.0));
    let on_sphere: Vec<Face> = faces.into_iter().map(|face| face.map(DVec3::normalize)).collect();
    centres(on_sphere, subdivisions)
}

/// The upper half of the octahedron's face centres.
pub(super) fn octahedron(subdivisions: u32) -> Vec<DVec3> {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    centres(vec![[x, y, z], [y, -x, z], [-x, -y, z], [-y, x, z]], subdivisions)
}

/// Cuts each face into four through the middles of its edges, again and again. Children follow each other.
fn centres(mut faces: Vec<Face>, subdivisions: u32) -> Vec<DVec3> {
    for _ in 0..subdivisions {
        faces = faces.into_iter().flat_map(quarters).collect();
    }
    faces.into_iter().map(|[a, b, c]| (a + b + c).normalize()).collect()
}

fn quarters([a, b, c]: Face) -> [Face; 4] {
    let [ab, bc, ca] = [a + b, b + c, c + a].map(DVec3::normalize);
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}
