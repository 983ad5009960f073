//! Meshes on the lattice.

use super::{Lattice, LatticePlane, REACH, corners};
use crate::error::{Error, Result};
use crate::kernels::rasterize_lhb::MAX_TRIANGLES;
use crate::scene::{CompiledScene, Triangle};
use glam::DVec3;
use std::collections::HashMap;

/// A validated triangle mesh on a [`Lattice`]: every index names a vertex, and every vertex is in reach.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LatticeMesh {
    vertices: Vec<[i16; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl LatticeMesh {
    /// A mesh of snapped vertices.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for an index out of range or a vertex out of [`REACH`], [`Error::LimitExceeded`] beyond
    /// [`MAX_TRIANGLES`].
    pub fn new(vertices: Vec<[i16; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self> {
        check_count(triangles.len())?;
        let far =
            |v: &[i16; 3]| v.iter().map(|&c| i64::from(c).pow(2)).sum::<i64>() > i64::from(REACH).pow(2);
        if let Some(i) = vertices.iter().position(far) {
            let what = format!("{:?} is farther than {REACH} from the centre", vertices[i]);
            return Err(Error::invalid(format!("vertices[{i}]"), what));
        }
        let wild = |t: &[u32; 3]| t.iter().any(|&v| v as usize >= vertices.len());
        if let Some(i) = triangles.iter().position(wild) {
            let what = format!("{:?} names a vertex beyond the {} there are", triangles[i], vertices.len());
            return Err(Error::invalid(format!("triangles[{i}]"), what));
        }
        Ok(Self { vertices, triangles })
    }

    /// Snaps triangles given by their corners. Corners at one lattice point become one vertex; vertices are numbered in the
    /// order in which they are first met.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a corner out of the lattice's reach, [`Error::LimitExceeded`] beyond
    /// [`MAX_TRIANGLES`].
    pub fn snap(lattice: &Lattice, triangles: impl ExactSizeIterator<Item = [DVec3; 3]>) -> Result<Self> {
        check_count(triangles.len())?;
        let mut vertices = Vec::new();
        let mut numbers: HashMap<[i16; 3], u32> = HashMap::new();
        let mut snapped = Vec::with_capacity(triangles.len());
        for (i, corners) in triangles.enumerate() {
            let mut triangle = [0; 3];
            for (corner, number) in corners.into_iter().zip(&mut triangle) {
                let Some(point) = lattice.snap(corner) else {
                    return Err(Error::invalid(
                        format!("triangles[{i}]"),
                        format!("{corner} is off the lattice"),
                    ));
                };
                *number = *numbers.entry(point).or_insert_with(|| {
                    vertices.push(point);
                    vertices.len() as u32 - 1
                });
            }
            snapped.push(triangle);
        }
        Ok(Self { vertices, triangles: snapped })
    }

    /// Snaps a scene. Triangle i is [`CompiledScene::triangles`]`[i]`.
    ///
    /// # Errors
    /// As [`LatticeMesh::snap`].
    pub fn of_scene(lattice: &Lattice, scene: &CompiledScene) -> Result<Self> {
        Self::of_triangles(lattice, &scene.triangles)
    }

    /// Snaps triangles of a scene, in their order.
    ///
    /// # Errors
    /// As [`LatticeMesh::snap`].
    pub fn of_triangles(lattice: &Lattice, triangles: &[Triangle]) -> Result<Self> {
        Self::snap(lattice, triangles.iter().map(corners))
    }

    /// Positions, lattice units from the centre.
    pub fn vertices(&self) -> &[[i16; 3]] {
        &self.vertices
    }

    /// The least and the greatest coordinates; 0 without vertices.
    pub fn bounds(&self) -> ([i16; 3], [i16; 3]) {
        let Some(&first) = self.vertices.first() else { return ([0; 3], [0; 3]) };
        self.vertices.iter().fold((first, first), |(low, high), v| {
            ([0, 1, 2].map(|i| low[i].min(v[i])), [0, 1, 2].map(|i| high[i].max(v[i])))
        })
    }

    /// Vertex numbers.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The plane of every triangle.
    pub fn planes(&self) -> impl ExactSizeIterator<Item = LatticePlane> + '_ {
        self.triangles.iter().map(|t| LatticePlane::of(t.map(|v| self.vertices[v as usize])))
    }

    /// The triangles of `self`, then those of `other`.
    ///
    /// # Errors
    /// [`Error::LimitExceeded`] beyond [`MAX_TRIANGLES`] or 2³² vertices.
    pub fn followed_by(&self, other: &Self) -> Result<Self> {
        let (count, limit) = (self.vertices.len() + other.vertices.len(), u64::from(u32::MAX));
        if count as u64 > limit {
            return Err(Error::limit("vertices of a mesh", count as u64, limit));
        }
        check_count(self.triangles.len() + other.triangles.len())?;
        let moved = |t: &[u32; 3]| t.map(|v| v + self.vertices.len() as u32);
        Ok(Self {
            vertices: self.vertices.iter().chain(&other.vertices).copied().collect(),
            triangles: self.triangles.iter().copied().chain(other.triangles.iter().map(moved)).collect(),
        })
    }
}

fn check_count(triangles: usize) -> Result<()> {
    if triangles > MAX_TRIANGLES {
        return Err(Error::limit("triangles of a mesh", triangles as u64, MAX_TRIANGLES as u64));
    }
    Ok(())
}
