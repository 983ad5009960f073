// kernel family: walk_lhb
// contract core/src/kernels/walk_lhb.rs
// cpu backend-cpu/src/kernels/walk_lhb.rs
// gpu backend-gpu/src/kernels/walk_lhb.wgsl
// oracle conformance/src/oracle/walk_lhb.rs
//! `walk_lhb`: the paths of [`crate::kernels::trace_paths`], whose scattered rays are looked up in layered hit buffers instead
//! of traced.
//!
//! *Meaning.* As `trace_paths`, with the same numbers for the same pixel and sample, but for these:
//! 1. *Lookup.* A ray scattered by an opaque material along ω goes along d, the direction of the set that is nearest to ω; where d does
//!    not leave the surface, the one nearest to ω + 2·sin ρ·n, ρ the set's covering radius. What it meets is
//!    [`crate::kernels::query_lhb`]'s answer. With [`CONE`], the answer of the line that crosses the ray at that distance
//!    ([`crate::transport::lhb`]), and the ray is intersected with the triangle so found; without, the hit is where the pixel's line
//!    meets it, so that light bands.
//! 2. Rays from the camera, mirrors and glass are traced: their hits are seen sharply. Shadow rays are traced. With [`TRACE_MISSES`] so
//!    are rays whose lookup finds nothing, or something that emits: a line that passes beside a silhouette loses light, 3 % of it in a
//!    closed room of 70 k triangles, though one ray in fifty is concerned; and a lamp of a few pixels is met by too many lines.
//! 3. *Direct light* (area formulation). An emissive triangle's light is counted by whichever technique is denser there (Veach's
//!    maximum heuristic): sampling such a triangle has the weight 1 where its density is not below that of scattering, else 0, and a
//!    scattered ray that meets one adds its emission where scattering is denser. Small lamps cast sharp shadows however coarse the
//!    buffers; lamps close by, and lobes narrower than a lamp, would be noise without bound if they were sampled alone. Sphere
//!    lights, which a ray meets analytically, and the environment, which rays that leave the scene read along ω, keep the
//!    balance heuristic.
//!
//! 4. *Interleaved sampling.* With [`WalkLhbBlock::interleave`] n > 1, a path whose first vertex is diffuse (opaque, without a lobe) draws, for the
//!    direction that it scatters along there and for all later vertices, the numbers of the pixel (x mod n, y mod n): each n × n tile
//!    holds the same patterns, whose noise [`crate::kernels::filter_indirect`] averages. What that kernel leaves alone, sampled
//!    lights and what other materials reflect, has numbers of its own: it would show the patterns. (Light that a path's first scattered
//!    ray meets itself still does.)
//! 5. *Gathering.* With [`GATHER`], light at the first vertex of a path, if that is opaque, is a sum over all D directions of the set instead
//!    of an integral over drawn ones: sample s goes along direction s mod D, with the weight D·Ω·f·cos θ, Ω the solid angle that is nearer to
//!    it than to others, and ends where that does not leave the surface. With a multiple of D samples each direction has the same
//!    share. Its density in 3 is that of scattering, as if it had been drawn: the weights still add up to 1.
//! 6. *Shadows.* Where the scene says so ([`crate::scene::NOTHING_HIDES`]) triangles cast none. Else with [`SHADOW_LOOKUPS`], the shadow rays of every vertex but the first are looked up as rays of 1 are, whatever
//!    [`TRACE_MISSES`] says, but for a second line that crosses the ray at its end where the first line finds nothing nearer; with
//!    [`SHADOW_LOOKUPS_FIRST`] too, those of the first as well: the hit buffers are the shadow maps of all lights at once. With L the
//!    distance to the sampled point of the light, the light is shadowed where the lookup finds a triangle which the ray meets before
//!    [`crate::transport::light::SHADOW_REACH`]·L, or which the ray passes beside and whose nearest point to the lookup's line is, along
//!    the ray, ahead of its start and more than [`crate::transport::lhb::shadow_margin`] before L: neither what is behind the start nor
//!    what a pixel sees of the surface that carries the light is a shadow. Light from infinitely far, L = ∞, is shadowed by all that is
//!    ahead. Sphere lights shadow as they do otherwise. Without [`CONE`] rays are not
//!    intersected: all that is found counts as passed beside. Within its window a lookup from a front finds fronts only, from a back backs
//!    ([`crate::kernels::query_lhb`]), so that a sheet which faces away shadows nothing next to it.
//!
//! *Shapes.* The [`crate::kernels::rasterize_lhb::LhbBuffers`] of the set's lines, all layers, and the views they were made with;
//! the mesh is the scene's ([`crate::lattice::LatticeMesh::of_scene`]), so that its triangles are the scene's slots; `film` as `trace_paths`.
//! *Units, fixed point, order.* As `trace_paths`: a sum of integers, the same for any split and any order of lookups.
//! *Error.* Biased: visibility is that of d through a pixel's centre. It falls with more directions and pixels.
//! *Source.* Yu, spherical layered hit buffers, whose shadow maps are buffers of their own, filtered over neighbouring texels: here (6)
//! a pixel's samples look up from as many points, which filters alike; Veach and Guibas, "Optimally combining sampling techniques",
//! 1995 (3).

use crate::accuracy::Accuracy;
use crate::directions::MAX_RESOLUTION;
use crate::error::{Error, Result};
use crate::kernels::trace_paths::TracePathsParams;
use crate::lattice::{View, check_size, subpixel_bits};
use bytemuck::{Pod, Zeroable};

/// Lookups are exact, but what is looked up, and where, comes from floats.
pub const ACCURACY: Accuracy = Accuracy::Statistical {
    because: "exact in strict mode on adapters that round correctly; elsewhere a path may branch otherwise",
};

/// [`WalkLhbBlock::flags`]: lines through the ray's hit instead of its start.
pub const CONE: u32 = 1;
/// [`WalkLhbBlock::flags`]: rays whose lookup finds nothing, or an emissive triangle, are traced.
pub const TRACE_MISSES: u32 = 2;

/// [`WalkLhbBlock::flags`]: the first vertex gathers along all directions.
pub const GATHER: u32 = 4;

/// [`WalkLhbBlock::flags`]: shadow rays of every vertex but the first are looked up.
pub const SHADOW_LOOKUPS: u32 = 8;
/// [`WalkLhbBlock::flags`]: with [`SHADOW_LOOKUPS`], those of the first vertex too.
pub const SHADOW_LOOKUPS_FIRST: u32 = 16;

/// What lookups need to know of a scene and its buffers.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct WalkLhbBlock {
    /// The lattice's centre, relative to [`crate::scene::CompiledScene::origin`].
    pub centre: [f32; 3],
    /// Lattice steps per world unit.
    pub steps_per_unit: f32,
    /// World units per lattice step.
    pub unit_per_step: f32,
    /// P/N, P the power of two not below the size N.
    pub row_scale: f32,
    /// Twice the sine of the set's covering radius.
    pub lift: f32,
    /// Pixels per row and column of a view.
    pub size: u32,
    /// [`crate::lattice::subpixel_bits`] of the size.
    pub subpixel_bits: u32,
    /// Cells per row of the directional map.
    pub map_resolution: u32,
    /// Sum of [`CONE`], [`TRACE_MISSES`], [`GATHER`], [`SHADOW_LOOKUPS`] and [`SHADOW_LOOKUPS_FIRST`], or 0.
    pub flags: u32,
    /// Pixels per row and column of an interleaved pattern; 0 and 1 give every pixel numbers of its own.
    pub interleave: u32,
    /// Where in the map's buffer the D directions to gather along begin, two words each: the ray, and the bits of its solid angle.
    pub gather_begin: u32,
    /// D; at least 1 with [`GATHER`].
    pub gather_count: u32,
    /// Unused, 0.
    pub padding: [u32; 2],
}

/// Parameters of one call.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct WalkLhbParams {
    /// Camera, pixels, samples, bounces, film.
    pub call: TracePathsParams,
    /// Lookups.
    pub lookup: WalkLhbBlock,
}

impl WalkLhbParams {
    /// Checks what a kernel relies on.
    ///
    /// # Errors
    /// As [`TracePathsParams::check`]; [`Error::InvalidInput`] for views out of their budget, a map of `map_len` words that has fewer words than
    /// cells, or lookup parameters that contradict
    /// each other.
    pub fn check(&self, film_len: usize, views: &[View], map_len: usize) -> Result<()> {
        self.call.check(film_len)?;
        let lookup = &self.lookup;
        check_size(lookup.size)?;
        for (i, view) in views.iter().enumerate() {
            view.check(lookup.size)
                .map_err(|error| Error::invalid(format!("views[{i}]"), error.to_string()))?;
        }
        if lookup.subpixel_bits != subpixel_bits(lookup.size) {
            let what = format!("{} sub-pixel bits for views of {}", lookup.subpixel_bits, lookup.size);
            return Err(Error::invalid("walk_lhb", what));
        }
        if !lookup.map_resolution.is_multiple_of(2) || !(2..=MAX_RESOLUTION).contains(&lookup.map_resolution)
        {
            return Err(Error::invalid(
                "walk_lhb",
                format!("map of {} cells per row", lookup.map_resolution),
            ));
        }
        let cells = lookup.map_resolution as usize * lookup.map_resolution as usize;
        if map_len < cells {
            return Err(Error::invalid("walk_lhb map", format!("{map_len} words of a map of {cells} cells")));
        }
        let (begin, count) = (u64::from(lookup.gather_begin), u64::from(lookup.gather_count));
        if lookup.flags & GATHER != 0 && (count == 0 || begin + 2 * count > map_len as u64) {
            let what = format!("{count} directions from word {begin} on, of {map_len}");
            return Err(Error::invalid("walk_lhb gather", what));
        }
        Ok(())
    }
}
