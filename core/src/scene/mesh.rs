//! Triangle meshes and their placements.

use glam::{DMat3, DVec3};

/// Scale at which nothing is seen any more, 2⁻¹⁰⁰.
const SPECK: f64 = 7.888_609_052_210_118e-31;

/// An indexed triangle mesh in object space. Counter-clockwise triangles face the viewer.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// For messages.
    pub name: String,
    /// Vertex positions, object units.
    pub positions: Vec<[f32; 3]>,
    /// Vertex normals, any length; empty, or one per position.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, (0, 0) the bottom-left texel corner as in OBJ; empty, or one per position.
    pub texcoords: Vec<[f32; 2]>,
    /// Vertex indices.
    pub triangles: Vec<[u32; 3]>,
    /// Material of each triangle.
    pub material_ids: Vec<u32>,
}

impl Mesh {
    /// A mesh of one material, without normals or texture coordinates.
    pub fn new(
        name: impl Into<String>,
        positions: Vec<[f32; 3]>,
        triangles: Vec<[u32; 3]>,
        material: u32,
    ) -> Self {
        let material_ids = vec![material; triangles.len()];
        Self { name: name.into(), positions, triangles, material_ids, ..Self::default() }
    }
}

/// An affine map, column vectors: `p ↦ linear·p + translation`, in f64 so that chains of nodes don't lose bits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    /// Rotation, scale, shear.
    pub linear: DMat3,
    /// Translation, world units.
    pub translation: DVec3,
}

impl Default for Transform {
    fn default() -> Self {
        Self { linear: DMat3::IDENTITY, translation: DVec3::ZERO }
    }
}

impl Transform {
    /// The identity.
    pub const IDENTITY: Self = Self { linear: DMat3::IDENTITY, translation: DVec3::ZERO };

    /// Uniform scale, then translation.
    pub fn scale_translate(scale: f64, translation: DVec3) -> Self {
        Self { linear: DMat3::from_diagonal(DVec3::splat(scale)), translation }
    }

    /// `self ∘ inner`: first `inner`, then `self`.
    pub fn then_inner(&self, inner: &Self) -> Self {
        Self {
            linear: self.linear * inner.linear,
            translation: self.linear * inner.translation + self.translation,
        }
    }

    /// The image of a point.
    pub fn point(&self, p: [f32; 3]) -> DVec3 {
        self.linear * glam::Vec3::from(p).as_dvec3() + self.translation
    }

    /// This map, or where it takes all volume away (to less than 2⁻³⁰⁰ of it), one that makes an all but invisible point of
    /// things: compiled scenes need maps with an inverse, and triangles keep their numbers.
    pub fn or_point(self) -> Self {
        if self.determinant().abs() < SPECK * SPECK * SPECK {
            return Self::scale_translate(SPECK, self.translation);
        }
        self
    }

    /// Volume factor; negative when the map mirrors, 0 when it is singular.
    pub fn determinant(&self) -> f64 {
        self.linear.determinant()
    }
}

/// A placement of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Instance {
    /// For messages.
    pub name: String,
    /// Index into [`super::Scene::meshes`].
    pub mesh: u32,
    /// Object to world.
    pub transform: Transform,
    /// Replaces the mesh's materials when set.
    pub material: Option<u32>,
    /// Whether another frame may have it elsewhere, or of another shape: it is compiled behind what stays. [`super::Scene::at`]
    /// sets it for what follows a motion.
    pub moves: bool,
}

impl Instance {
    /// An untransformed placement.
    pub fn new(name: impl Into<String>, mesh: u32) -> Self {
        Self { name: name.into(), mesh, transform: Transform::IDENTITY, material: None, moves: false }
    }
}
