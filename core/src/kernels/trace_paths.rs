// kernel family: trace_paths
// contract core/src/kernels/trace_paths.rs
// cpu backend-cpu/src/kernels/trace_paths.rs
// gpu backend-gpu/src/kernels/trace_paths.wgsl
// oracle conformance/src/oracle/trace_paths.rs
//! `trace_paths`: the reference path tracer's samples, added to a film in fixed point.
//!
//! *Meaning.* For every pixel p of `pixel_begin .. pixel_begin + pixel_count` and every sample s of
//! `sample_begin .. sample_begin + sample_count`: one path from a random point of the pixel (box filter), next-event
//! estimation at every vertex, and its radiance added to `film[p]`.
//!
//! 1. *Sample.* Pairs of numbers come from [`crate::math::sobol`] (or hashed, `sampler`), a pure function of (seed,
//!    pixel, sample, dimension).
//! 2. *Vertex.* Emission met by a scattered ray is weighted by the balance heuristic against the light sampler's pdf;
//!    at the first vertex and after mirrors and glass its weight is 1.
//! 3. *Direct light.* One light, chosen by power with an alias table, one point on it, one shadow ray, weighted by the
//!    balance heuristic against the BSDF's pdf (delta lights: weight 1). Where the scene says so
//!    ([`crate::scene::NOTHING_HIDES`]), no ray is sent and no triangle shadows anything; sphere lights still do.
//! 4. *Scatter.* BSDF sample, [`crate::transport::bsdf`].
//! 5. *Roulette* from vertex `roulette_begin` on, survival min(max component of throughput, 0.95).
//!
//! `max_bounces` counts scattering vertices: 0 emission only, 1 direct light only, [`UNLIMITED_BOUNCES`] to roulette.
//! *Units.* Radiance, W·sr⁻¹·m⁻², linear RGB. *Fixed point.* A component x ≥ 0 is added as ⌊x·2^`film_exponent` + ½⌋ to
//! a u64, second moments of luminance as ⌊y²·2^`moment_exponent` + ½⌋; the exponents come from the scene's brightest
//! emitter ([`crate::scene::CompiledScene`]). A sample that is not finite, is negative or exceeds 2⁶² quanta is left
//! out and counted in [`FilmTexel::rejected`]; callers treat a count above 0 as an error.
//! *Order.* Sums of integers: any split over pixels, samples, threads, tiles and shards gives the same film.
//! *Sources.* Kajiya 1986; Veach 1997 §9.2 (balance heuristic) and §10.

use crate::accuracy::Accuracy;
use crate::error::{Error, Result};
use bytemuck::{Pod, Zeroable};

/// Paths branch on float comparisons.
pub const ACCURACY: Accuracy = Accuracy::Statistical {
    because: "exact in strict mode on adapters that round correctly; elsewhere a path may branch otherwise",
};

/// `max_bounces` without a cap but roulette's.
pub const UNLIMITED_BOUNCES: u32 = u32::MAX;

/// [`TracePathsParams::sampler`]: Owen-scrambled Sobol pairs.
pub const SAMPLER_SOBOL: u32 = 0;
/// [`TracePathsParams::sampler`]: independent hashed numbers.
pub const SAMPLER_INDEPENDENT: u32 = 1;

/// A pinhole camera for one image size. The ray through image point (x, y) in pixels has the direction
/// `corner + x·step_x + y·step_y`, normalised.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct CameraRecord {
    /// Eye, world units.
    pub position: [f32; 3],
    /// Unused, 0.
    pub padding_a: f32,
    /// Direction to the top-left corner of the image, at view-axis distance 1.
    pub corner: [f32; 3],
    /// Unused, 0.
    pub padding_b: f32,
    /// Change of direction per pixel to the right.
    pub step_x: [f32; 3],
    /// Unused, 0.
    pub padding_c: f32,
    /// Change of direction per pixel downwards.
    pub step_y: [f32; 3],
    /// Unused, 0.
    pub padding_d: f32,
    /// Unit view axis.
    pub forward: [f32; 3],
    /// Unused, 0.
    pub padding_e: f32,
}

/// Parameters of one call.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct TracePathsParams {
    /// The camera, for `width` by `height` pixels.
    pub camera: CameraRecord,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// First pixel, row-major.
    pub pixel_begin: u32,
    /// Number of pixels.
    pub pixel_count: u32,
    /// First sample index.
    pub sample_begin: u32,
    /// Number of samples per pixel.
    pub sample_count: u32,
    /// Seed of the image.
    pub seed: u32,
    /// Scattering vertices at most.
    pub max_bounces: u32,
    /// First vertex (1 = the first surface met) after which roulette may end the path.
    pub roulette_begin: u32,
    /// [`SAMPLER_SOBOL`] or [`SAMPLER_INDEPENDENT`].
    pub sampler: u32,
    /// Quanta per unit of radiance, as a power of two.
    pub film_exponent: i32,
    /// Quanta per unit of squared luminance, as a power of two.
    pub moment_exponent: i32,
}

/// Pairs of sample dimensions per vertex: direction, light point, (light, lobe), environment texel, roulette.
pub const PAIRS_PER_VERTEX: u32 = 5;

/// Vertices after which roulette must be running, so that every path ends.
pub const LATEST_ROULETTE: u32 = 1024;

/// Roulette never lets a path survive with more than this probability, so that paths between perfect mirrors end.
pub const MAX_SURVIVAL: f32 = 0.95;

impl TracePathsParams {
    /// Checks what a kernel relies on.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] naming the parameter, when pixels leave the image, the film has another size, sample
    /// indices overflow, the sampler is unknown or paths might never end.
    pub fn check(&self, film_len: usize) -> Result<()> {
        let invalid = |what: String| Err(Error::invalid("trace_paths", what));
        let pixels = u64::from(self.width) * u64::from(self.height);
        if pixels != film_len as u64 {
            return invalid(format!(
                "film of {film_len} pixels for an image of {}x{}",
                self.width, self.height
            ));
        }
        let end = u64::from(self.pixel_begin) + u64::from(self.pixel_count);
        if end > pixels {
            return invalid(format!("pixels {}..{end} of {pixels}", self.pixel_begin));
        }
        if self.sample_begin.checked_add(self.sample_count).is_none() {
            return invalid(format!("{} samples from {} overflow", self.sample_count, self.sample_begin));
        }
        if self.sampler > SAMPLER_INDEPENDENT {
            return invalid(format!("sampler {}", self.sampler));
        }
        if self.max_bounces > LATEST_ROULETTE && self.roulette_begin > LATEST_ROULETTE {
            return invalid(format!(
                "roulette from vertex {} on with {} bounces; needs roulette at {LATEST_ROULETTE} or before",
                self.roulette_begin, self.max_bounces
            ));
        }
        Ok(())
    }
}

/// One pixel's sums. All 64-bit sums are (low, high) words.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct FilmTexel {
    /// Σ of emission seen directly and light scattered once, RGB.
    pub direct: [[u32; 2]; 3],
    /// Σ of light scattered more than once, RGB.
    pub indirect: [[u32; 2]; 3],
    /// Σ of squared luminance of whole samples.
    pub luminance_squared: [u32; 2],
    /// Samples added.
    pub samples: u32,
    /// Samples left out: not finite, negative or too bright for the film.
    pub rejected: u32,
}
