//! The buffers of a scene, and what lookups need beside them.

use std::time::{Duration, Instant};
use twinlight_core::directions::{DirectionSet, NearestMap};
use twinlight_core::kernels::rasterize_lhb::{CAP_NEAR, Lhb, PATH_AUTO, RasterizeLhbParams};
use twinlight_core::kernels::walk_lhb::{CONE, TRACE_MISSES, WalkLhbBlock};
use twinlight_core::lattice::{Lattice, LatticeMesh, View, subpixel_bits};
use twinlight_core::scene::CompiledScene;
use twinlight_core::{Backend, Result};

/// What the accuracy of lookups depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct LookupSettings {
    /// Directions that rays are rounded to.
    pub directions: DirectionSet,
    /// Pixels per row and column of a view, 1 to 1024.
    pub size: u32,
    /// Most layers per pixel, the nearest to the viewer; `None` keeps all.
    pub layers: Option<u32>,
    /// The cone approximation: without it, light bands.
    pub cone: bool,
    /// Whether rays that lookups find nothing for are traced, because lines beside a silhouette lose light.
    pub trace_misses: bool,
    /// Pixels per row and column of an interleaved pattern: pixels that far apart draw the same random numbers, so that [`super::filter()`] finds
    /// every pattern in its window. 1 gives every pixel numbers of its own.
    pub interleave: u32,
}

impl Default for LookupSettings {
    fn default() -> Self {
        let directions =
            DirectionSet::icosahedron(2).unwrap_or_else(|_| unreachable!("a size that the set has"));
        Self { directions, size: 128, layers: None, cone: true, trace_misses: true, interleave: 1 }
    }
}

/// Layered hit buffers of a scene, on a device.
pub struct Buffers<B: Backend> {
    /// The snapped scene.
    pub mesh: B::Mesh,
    /// A view per line of the set.
    pub lhb: Lhb<B>,
    /// The views.
    pub views: Vec<View>,
    /// Words of the directional map.
    pub map: B::Buffer<u32>,
    /// For the kernel.
    pub lookup: WalkLhbBlock,
    /// Time to rasterize.
    pub build_time: Duration,
}

impl<B: Backend> Buffers<B> {
    /// Elements of all lists.
    pub fn elements(&self, backend: &B) -> usize {
        backend.len(&self.lhb.elements)
    }

    /// Bytes on the device.
    pub fn bytes(&self, backend: &B) -> u64 {
        let words = backend.len(&self.lhb.offsets) + backend.len(&self.lhb.left_out) + backend.len(&self.map);
        8 * self.elements(backend) as u64 + 4 * words as u64
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
    let lattice = Lattice::of_scene(scene)?;
    let mesh = backend.upload_mesh(&LatticeMesh::of_scene(&lattice, scene)?)?;
    let size = settings.size;
    let lines = settings.directions.lines().iter();
    let views = lines.map(|&line| View::along(line, size)).collect::<Result<Vec<_>>>()?;
    let params = RasterizeLhbParams {
        size,
        path: PATH_AUTO,
        layer_cap: settings.layers.unwrap_or(0),
        cap_side: CAP_NEAR,
    };
    let start = Instant::now();
    let lhb = backend.rasterize_lhb(&mesh, &views, &params)?;
    let build_time = start.elapsed();
    let map = NearestMap::new(&settings.directions);
    let lookup = WalkLhbBlock {
        centre: lattice.centre().as_vec3().to_array(),
        steps_per_unit: (1.0 / lattice.step()) as f32,
        unit_per_step: lattice.step() as f32,
        row_scale: size.next_power_of_two() as f32 / size as f32,
        lift: 2.0 * sine(settings.directions.covering_radius()) as f32,
        size,
        subpixel_bits: subpixel_bits(size),
        map_resolution: map.resolution(),
        flags: flag(settings.cone, CONE) | flag(settings.trace_misses, TRACE_MISSES),
        interleave: settings.interleave,
    };
    let map = backend.upload(&map.ray_words(&settings.directions))?;
    Ok(Buffers { mesh, lhb, views, map, lookup, build_time })
}

fn flag(set: bool, bit: u32) -> u32 {
    if set { bit } else { 0 }
}

/// sin x for 0 ≤ x ≤ π/2 by its series, to 10⁻⁷: the platform's may differ from machine to machine.
fn sine(x: f64) -> f64 {
    let square = x * x;
    x * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0))))
}
