//! A snapped mesh in host memory, laid out for the rasterizer.

use crate::buffer::try_zeroed;
use rayon::prelude::*;
use twinlight_core::Result;
use twinlight_core::lattice::{LatticeMesh, LatticePlane};

mod runs;

pub(crate) use runs::{Boxes, RUN, Run, halves};

/// A resident mesh.
#[derive(Debug, Clone)]
pub struct CpuMesh {
    /// The boxes of each cluster's runs.
    pub(crate) boxes: Vec<Boxes>,
    /// The triangles, a cluster each. The last cluster is filled up with triangles that are points: they cover nothing.
    pub(crate) clusters: Vec<[Run; RUN]>,
    /// The triangles' planes.
    pub(crate) planes: Vec<LatticePlane>,
}

impl CpuMesh {
    pub(crate) fn new(mesh: &LatticeMesh) -> Result<Self> {
        let triangles = mesh.triangles();
        let count = triangles.len().div_ceil(RUN * RUN);
        let (mut boxes, mut clusters) = (try_zeroed::<Boxes>(count)?, try_zeroed::<[Run; RUN]>(count)?);
        let mut planes = try_zeroed::<LatticePlane>(triangles.len())?;
        let places = boxes.par_iter_mut().zip(&mut clusters).zip(planes.par_chunks_mut(RUN * RUN));
        places.zip(triangles.par_chunks(RUN * RUN)).for_each(|(((boxes, cluster), planes), triangles)| {
            for (i, triangles) in triangles.chunks(RUN).enumerate() {
                cluster[i] = Run::of(mesh.vertices(), triangles);
                boxes.set(i, mesh.vertices(), triangles);
            }
            for (plane, triangle) in planes.iter_mut().zip(triangles) {
                *plane = LatticePlane::of(triangle.map(|v| mesh.vertices()[v as usize]));
            }
        });
        Ok(Self { boxes, clusters, planes })
    }

    /// The corners of a triangle.
    #[inline(always)]
    pub(crate) fn corners(&self, triangle: usize) -> [[i16; 3]; 3] {
        let run = &self.clusters[triangle / (RUN * RUN)][triangle / RUN % RUN];
        run.corners(triangle % RUN).map(|p| p.map(|c| c as i16))
    }

    /// Number of triangles.
    pub(crate) fn len(&self) -> usize {
        self.planes.len()
    }
}
