//! The buffers of a scene, and what lookups need beside them.

use super::elements::Elements;
use super::plan::Plan;
use std::time::{Duration, Instant};
use twinlight_core::directions::DirectionSet;
use twinlight_core::kernels::rasterize_lhb::Lhb;
use twinlight_core::kernels::walk_lhb::WalkLhbBlock;
use twinlight_core::lattice::{Lattice, LatticeMesh, View};
use twinlight_core::scene::CompiledScene;
use twinlight_core::{Backend, Result};

/// Which shadow rays are looked up: a lookup costs a fraction of a ray, and has the buffers' resolution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shadows {
    /// None: all are traced.
    #[default]
    Rays,
    /// Those of indirect light, of every vertex but the first.
    IndirectLookups,
    /// All.
    Lookups,
}

/// What the accuracy of lookups depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct LookupSettings {
    /// Directions that rays are rounded to.
    pub directions: DirectionSet,
    /// Pixels per row and column of a view, 1 to 1024.
    pub size: u32,
    /// Most layers per pixel, the nearest to the viewer; `None` keeps all.
    pub layers: Option<u32>,
    /// How elements are stored.
    pub elements: Elements,
    /// The cone approximation: without it, light bands.
    pub cone: bool,
    /// Whether rays that lookups find nothing for are traced, because lines beside a silhouette lose light.
    pub trace_misses: bool,
    /// Which shadow rays are looked up.
    pub shadows: Shadows,
    /// Whether light at first vertices is a sum over all directions: the deterministic gather. Samples are best a multiple of their
    /// number.
    pub gather: bool,
    /// Pixels per row and column of an interleaved pattern: from diffuse surfaces on, paths of pixels that far apart draw the same random
    /// numbers, so that [`super::filter()`] finds every pattern in its window. 1 gives every pixel numbers of its own.
    pub interleave: u32,
}

impl Default for LookupSettings {
    fn default() -> Self {
        let directions =
            DirectionSet::icosahedron(2).unwrap_or_else(|_| unreachable!("a size that the set has"));
        Self {
            directions,
            size: 128,
            layers: None,
            elements: Elements::Full,
            cone: true,
            trace_misses: true,
            shadows: Shadows::Rays,
            gather: false,
            interleave: 1,
        }
    }
}

/// Layered hit buffers of a scene, on a device.
pub struct Buffers<B: Backend> {
    /// The snapped scene.
    pub mesh: B::Mesh,
    /// A view per line of the set; of packed elements, what was read back.
    pub lhb: Lhb<B>,
    /// The views.
    pub views: Vec<View>,
    /// Words of the directional map.
    pub map: B::Buffer<u32>,
    /// For the kernel.
    pub lookup: WalkLhbBlock,
    /// Time to rasterize, and to merge what was kept with what moves.
    pub build_time: Duration,
    /// Time to pack elements and to read them back.
    pub pack_time: Duration,
    /// Bytes of the lists as they are stored.
    pub stored_bytes: u64,
    /// Bytes of what lookups read instead; 0 where they read the lists as they are stored.
    pub read_back_bytes: u64,
    /// Elements of what was kept from a frame before; 0 where everything was rasterized.
    pub kept_elements: usize,
}

impl<B: Backend> Buffers<B> {
    /// Elements of all lists.
    pub fn elements(&self, backend: &B) -> usize {
        backend.len(&self.lhb.elements)
    }

    /// Bytes of the lists as they are stored and of the directional map. Beside them, lookups take [`Buffers::read_back_bytes`].
    pub fn bytes(&self, backend: &B) -> u64 {
        self.stored_bytes + 4 * backend.len(&self.map) as u64
    }
}

/// Rasterizes a scene along the lines of the set.
///
/// # Errors
/// [`twinlight_core::Error::LimitExceeded`] or [`twinlight_core::Error::OutOfMemory`] when the buffers are too large for the backend,
/// [`twinlight_core::Error::InvalidInput`] for a size out of range.
pub fn build<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    settings: &LookupSettings,
) -> Result<Buffers<B>> {
    build_by(&Plan::new(settings)?, backend, scene)
}

/// [`build`], with what follows from the settings.
pub(super) fn build_by<B: Backend>(plan: &Plan, backend: &B, scene: &CompiledScene) -> Result<Buffers<B>> {
    plan.settings.elements.check(scene.triangles.len())?;
    let lattice = Lattice::of_scene(scene)?;
    let mesh = LatticeMesh::of_scene(&lattice, scene)?;
    let resident = backend.upload_mesh(&mesh)?;
    let start = Instant::now();
    let lhb = plan.rasterize(backend, &resident)?;
    plan.buffers(backend, &lattice, resident, lhb, start.elapsed(), 0)
}
