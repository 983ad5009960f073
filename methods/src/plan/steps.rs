//! The calls of kernels that a plan makes.

use super::{Plan, Sampling};
use crate::voxel::{Cones, VoxelSettings};
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::kernels::trace_cones::{Cone, ConeLight};
use twinlight_core::kernels::trace_paths::FilmTexel;

/// How often a kernel is called.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dispatches {
    /// So often.
    Exactly(u64),
    /// At most so often: fewer where fewer pixels show what it is for.
    AtMost(u64),
    /// In passes of about a quarter of a second.
    Passes,
}

/// Calls of one kernel.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The method of [`twinlight_core::Backend`].
    pub kernel: &'static str,
    /// What for.
    pub purpose: &'static str,
    /// How often.
    pub dispatches: Dispatches,
    /// What there is to do, in the kernel's unit of work.
    pub work: f64,
    /// That unit.
    pub unit: &'static str,
    /// Bytes of what it writes, about.
    pub bytes: u64,
}

/// The steps of a plan, in order.
pub(super) fn of(plan: &Plan) -> Vec<Step> {
    let mut steps = Vec::new();
    lookups(plan, &mut steps);
    voxels(plan, &mut steps);
    sampling(plan, &mut steps);
    let pixels = pixels(plan);
    steps.push(Step {
        kernel: "shade_primary",
        purpose: "what the camera sees",
        dispatches: Dispatches::Exactly(1),
        work: pixels as f64,
        unit: "pixels",
        bytes: pixels * size_of::<GBufferTexel>() as u64,
    });
    if plan.filter > 1 {
        steps.push(Step {
            kernel: "filter_indirect",
            purpose: "indirect light, averaged over neighbours",
            dispatches: Dispatches::Exactly(1),
            work: pixels as f64 * f64::from(plan.filter) * f64::from(plan.filter),
            unit: "pixels averaged",
            bytes: pixels * 32,
        });
    }
    gathering(plan, &mut steps);
    steps
}

fn pixels(plan: &Plan) -> u64 {
    u64::from(plan.request.picture.width) * u64::from(plan.request.picture.height)
}

fn lookups(plan: &Plan, steps: &mut Vec<Step>) {
    let Some(settings) = &plan.buffers else { return };
    let views = settings.directions.lines().len() as f64;
    let lists = views * f64::from(settings.size) * f64::from(settings.size);
    // Seen from all sides, a surface covers half its area; a view is as wide as the ball around the scene, at most √3 of the longest side.
    let pixel = 3.0_f64.sqrt() * plan.facts.longest_side / f64::from(settings.size);
    let elements = if pixel > 0.0 { views * plan.facts.area * 0.5 / (pixel * pixel) } else { 0.0 };
    steps.push(Step {
        kernel: "rasterize_lhb",
        purpose: "every surface along every direction",
        dispatches: Dispatches::Exactly(1),
        work: views * plan.facts.triangles as f64,
        unit: "triangle views",
        bytes: (4.0 * lists + 8.0 * elements) as u64,
    });
}

fn voxels(plan: &Plan, steps: &mut Vec<Step>) {
    let Some(settings) = &plan.voxels else { return };
    let active = active_voxels(plan, settings);
    let grid = f64::from(settings.grid);
    let gathers = u64::from(settings.bounces.saturating_sub(2));
    let mut step = |kernel, purpose, count, work, unit, bytes: f64| {
        if count > 0 {
            let dispatches = Dispatches::Exactly(count);
            steps.push(Step { kernel, purpose, dispatches, work, unit, bytes: bytes as u64 });
        }
    };
    let triangles = plan.facts.triangles as f64;
    step("voxelize", "which voxels have surfaces", 1, triangles, "triangles", grid * grid * grid / 4.0);
    step("sum_voxels", "what surfaces are in them", 1, triangles, "triangles", 32.0 * active);
    step("voxel_levels", "coarser levels", 1, active, "voxels", 8.0 * active);
    let samples = active * f64::from(settings.light_samples);
    step("light_voxels", "light on voxels", 1 + gathers, samples, "shadow rays", 16.0 * active);
    let cones = 6.0 * active * gathers as f64;
    step("trace_cones", "light from voxel to voxel", gathers, cones, "cones", 6.0 * active * CONE_BYTES);
    let reductions = active * (1 + gathers) as f64;
    step("reduce_mips", "light of coarser levels", 1 + gathers, reductions, "voxels", 32.0 * active);
}

const CONE_BYTES: f64 = (size_of::<Cone>() + size_of::<ConeLight>()) as f64;

/// Surfaces without thickness meet about 1½ voxels per voxel's area, until the grid is full.
fn active_voxels(plan: &Plan, settings: &VoxelSettings) -> f64 {
    let grid = f64::from(settings.grid);
    let voxel = plan.facts.longest_side / grid;
    if voxel > 0.0 { (1.5 * plan.facts.area / (voxel * voxel)).min(grid * grid * grid) } else { 0.0 }
}

fn sampling(plan: &Plan, steps: &mut Vec<Step>) {
    let kernel = match plan.sampling {
        Sampling::Nothing => return,
        Sampling::Paths => "trace_paths",
        Sampling::Lookups => "walk_lhb",
    };
    let pixels = pixels(plan);
    steps.push(Step {
        kernel,
        purpose: if plan.voxels.is_some() { "direct light" } else { "light of paths" },
        dispatches: Dispatches::Passes,
        work: pixels as f64 * f64::from(plan.request.picture.samples) * vertices(plan),
        unit: "vertices",
        bytes: pixels * size_of::<FilmTexel>() as u64,
    });
}

/// Vertices of a path where none leaves the scene: after the first few, roulette keeps as many as surfaces reflect.
fn vertices(plan: &Plan) -> f64 {
    let certain = plan.request.picture.roulette_begin.min(plan.sampled_bounces.unwrap_or(u32::MAX));
    let kept = plan.facts.mean_albedo.min(0.95);
    let rest = plan.sampled_bounces.map_or(u32::MAX, |bounces| bounces - certain).min(1024);
    let mut sum = f64::from(certain);
    let mut alive = 1.0;
    for _ in 0..rest {
        alive *= kept;
        sum += alive;
    }
    1.0 + sum
}

fn gathering(plan: &Plan, steps: &mut Vec<Step>) {
    let Some(settings) = &plan.voxels else { return };
    let pixels = pixels(plan);
    let lobes = match settings.cones {
        Cones::Six => 6,
        Cones::Generic(count) => u64::from(count),
    };
    let mut step = |purpose, cones: u64, at_once: u64| {
        steps.push(Step {
            kernel: "trace_cones",
            purpose,
            dispatches: Dispatches::AtMost(cones.div_ceil(at_once)),
            work: cones as f64,
            unit: "cones",
            bytes: (cones.min(at_once) as f64 * CONE_BYTES) as u64,
        });
    };
    let at_once = (crate::voxel::CONES_AT_ONCE as u64 / lobes).max(1) * lobes;
    step("diffuse light of pixels", pixels * lobes, at_once);
    if settings.shining {
        step("what shining pixels reflect", pixels, crate::voxel::CONES_AT_ONCE as u64);
    }
}
