//! What follows from the settings alone.

use super::elements::Stored;
use super::{Buffers, LookupSettings, Shadows};
use std::time::{Duration, Instant};
use twinlight_core::directions::NearestMap;
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::rasterize_lhb::{CAP_NEAR, Lhb, PATH_AUTO, RasterizeLhbParams};
use twinlight_core::kernels::walk_lhb::{
    CONE, GATHER, SHADOW_LOOKUPS, SHADOW_LOOKUPS_FIRST, TRACE_MISSES, WalkLhbBlock,
};
use twinlight_core::lattice::{Lattice, View, subpixel_bits};
use twinlight_core::{Backend, Result};

/// Views, parameters and the directional map of some settings.
pub(super) struct Plan {
    pub(super) settings: LookupSettings,
    views: Vec<View>,
    params: RasterizeLhbParams,
    map_resolution: u32,
    /// The map, and what is gathered along behind it.
    map: Vec<u32>,
    gather_begin: u32,
}

impl Plan {
    pub(super) fn new(settings: &LookupSettings) -> Result<Self> {
        let size = settings.size;
        let lines = settings.directions.lines().iter();
        let views = lines.map(|&line| View::along(line, size)).collect::<Result<Vec<_>>>()?;
        let params = RasterizeLhbParams {
            size,
            path: PATH_AUTO,
            layer_cap: settings.layers.unwrap_or(0),
            cap_side: CAP_NEAR,
        };
        let map = NearestMap::new(&settings.directions);
        let mut words = map.ray_words(&settings.directions);
        let gather_begin = words.len() as u32;
        words.extend(NearestMap::gather_words(&settings.directions));
        let (settings, map_resolution) = (settings.clone(), map.resolution());
        Ok(Self { settings, views, params, map_resolution, map: words, gather_begin })
    }

    pub(super) fn rasterize<B: Backend>(&self, backend: &B, mesh: &B::Mesh) -> Result<Lhb<B>> {
        backend.rasterize_lhb(mesh, &self.views, &self.params)
    }

    /// `kept`, of a mesh of `first_triangle` triangles, with `added` behind it.
    pub(super) fn merge<B: Backend>(
        &self,
        backend: &B,
        kept: &Lhb<B>,
        added: &Lhb<B>,
        first_triangle: u32,
    ) -> Result<Lhb<B>> {
        let RasterizeLhbParams { layer_cap, cap_side, .. } = self.params;
        backend.merge_lhb(kept, added, &MergeLhbParams { first_triangle, layer_cap, cap_side, padding: 0 })
    }

    /// The buffers of a snapped scene.
    pub(super) fn buffers<B: Backend>(
        &self,
        backend: &B,
        lattice: &Lattice,
        mesh: B::Mesh,
        lhb: Lhb<B>,
        build_time: Duration,
        kept_elements: usize,
    ) -> Result<Buffers<B>> {
        let start = Instant::now();
        let Stored { lhb, bytes, read_back_bytes } = self.settings.elements.stored(backend, lhb)?;
        Ok(Buffers {
            mesh,
            lhb,
            views: self.views.clone(),
            map: backend.upload(&self.map)?,
            lookup: self.lookup(lattice),
            build_time,
            pack_time: start.elapsed(),
            stored_bytes: bytes,
            read_back_bytes,
            kept_elements,
        })
    }

    fn lookup(&self, lattice: &Lattice) -> WalkLhbBlock {
        let (settings, size) = (&self.settings, self.settings.size);
        WalkLhbBlock {
            centre: lattice.centre().as_vec3().to_array(),
            steps_per_unit: (1.0 / lattice.step()) as f32,
            unit_per_step: lattice.step() as f32,
            row_scale: size.next_power_of_two() as f32 / size as f32,
            lift: 2.0 * sine(settings.directions.covering_radius()) as f32,
            size,
            subpixel_bits: subpixel_bits(size),
            map_resolution: self.map_resolution,
            flags: flag(settings.cone, CONE)
                | flag(settings.trace_misses, TRACE_MISSES)
                | flag(settings.gather, GATHER)
                | flag(settings.shadows != Shadows::Rays, SHADOW_LOOKUPS)
                | flag(settings.shadows == Shadows::Lookups, SHADOW_LOOKUPS_FIRST),
            interleave: settings.interleave,
            gather_begin: self.gather_begin,
            gather_count: settings.directions.len() as u32,
            padding: [0; 2],
        }
    }
}

fn flag(set: bool, bit: u32) -> u32 {
    if set { bit } else { 0 }
}

/// sin x for 0 ≤ x ≤ π/2 by its series, to 10⁻⁷: the platform's may differ from machine to machine.
fn sine(x: f64) -> f64 {
    let square = x * x;
    x * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0))))
}
