//! How a picture was made, for machines: the JSON beside it and the attributes in the EXR header.

use super::job::Job;
use super::moment::Moment;
use super::output::Outputs;
use super::run::Done;
use crate::args::RenderArgs;
use crate::budget::Wish;
use crate::source::{self, Prepared};
use serde_json::{Value, json};
use std::time::Duration;
use twinlight::kernels::trace_paths::FilmTexel;
use twinlight::methods::reference::Sampler;
use twinlight::methods::slhb::Elements;

/// Times that only the command knows.
pub struct Times {
    /// From the compiled scene to the picture, the choice of a method included.
    pub rendered: Duration,
    /// Writing pictures.
    pub write: Duration,
    /// Everything so far.
    pub total: Duration,
}

fn sampler_name(sampler: Sampler) -> &'static str {
    match sampler {
        Sampler::Sobol => "sobol",
        Sampler::Independent => "independent",
    }
}

/// What goes into EXR headers: only what the pixels depend on, so that the same picture is the same file whatever the
/// number of threads and the hour.
pub fn attributes(
    args: &RenderArgs,
    job: &Job,
    done: &Done,
    moment: Option<Moment>,
) -> Vec<(&'static str, String)> {
    let settings = job.settings();
    let mode = if done.info.strict { "strict" } else { "portable" };
    let mut attributes = vec![
        ("version", env!("CARGO_PKG_VERSION").into()),
        ("scene", source::stem(&args.picture.scene)),
        ("method", job.plan.request.method.name().into()),
        ("backend", done.info.kind.into()),
        ("adapter", done.info.device.clone()),
        ("mode", mode.into()),
        ("seed", settings.seed.to_string()),
        ("sampler", sampler_name(settings.sampler).into()),
        ("samples", done.taken.samples().0.to_string()),
        ("bounces", job.plan.bounces.map_or("unlimited".into(), |n| n.to_string())),
        ("stop", done.taken.stop.name().into()),
    ];
    attributes.extend(job.plan.voxels.as_ref().map(|knobs| {
        let what = format!(
            "grid {}, storage {}, cones {}, light samples {}",
            knobs.grid, knobs.storage, knobs.cones, knobs.light_samples
        );
        ("voxel", what)
    }));
    attributes.extend(moment.map(|moment| ("seconds", moment.seconds.to_string())));
    attributes
}

/// The sidecar.
pub fn json(
    args: &RenderArgs,
    prepared: &Prepared,
    job: &Job,
    done: &Done,
    moment: Option<Moment>,
    outputs: &Outputs,
    notices: &[String],
    times: &Times,
) -> String {
    let (settings, camera, plan) = (job.settings(), &job.camera, &job.plan);
    let (least, most) = done.taken.samples();
    let seconds = |d: Duration| (d.as_secs_f64() * 1e6).round_ties_even() / 1e6;
    let pixels = u64::from(settings.width) * u64::from(settings.height);
    let kernel = if done.lookups.is_some() { "walk_lhb" } else { "trace_paths" };
    let packed = done
        .lookups
        .as_ref()
        .filter(|_| plan.buffers.as_ref().is_some_and(|lookups| lookups.elements != Elements::Full));
    let made = done.surfaces.as_ref().filter(|surfaces| surfaces.made.is_some());
    let voxels = done.voxels.as_ref();
    let (filtered, gathered) = if voxels.is_some() { (None, made) } else { (made, None) };
    let value = json!({
        "twinlight": env!("CARGO_PKG_VERSION"),
        "scene": { "source": args.picture.scene, "triangles": prepared.scene.triangle_count() },
        "moment": moment.map(|m| json!({ "seconds": m.seconds, "frame": m.frame })),
        "files": outputs.pictures().map(|p| p.display().to_string()).collect::<Vec<_>>(),
        "settings": {
            "method": job.plan.request.method.name(),
            "slhb": plan.buffers.as_ref().map(|lookups| json!({
                "directions": lookups.directions.to_string(),
                "size": lookups.size,
                "layers": lookups.layers,
                "elements": lookups.elements.to_string(),
                "cone": lookups.cone,
                "gather": lookups.gather,
                "trace_misses": lookups.trace_misses,
                "shadows": args.picture.slhb.shadows.key(),
                "interleave": lookups.interleave,
                "filter": plan.filter,
            })),
            "voxel": plan.voxels.as_ref().map(|knobs| json!({
                "grid": knobs.grid,
                "storage": knobs.storage.to_string(),
                "cones": knobs.cones.to_string(),
                "light_samples": knobs.light_samples,
                "bounces": knobs.bounces,
            })),
            "effects": plan.request.effects.to_string(),
            "tolerance": plan.request.tolerance,
            "size": [settings.width, settings.height],
            "spp": args.picture.spp.or(job.time.is_none().then_some(settings.samples)),
            "time_s": job.time.map(seconds),
            "bounces": job.plan.bounces,
            "seed": settings.seed,
            "sampler": sampler_name(settings.sampler),
            "camera": {
                "position": camera.position, "target": camera.target, "up": camera.up,
                "vfov": camera.vfov_degrees
            },
            "exposure": args.picture.tone.exposure,
            "tonemap": args.picture.tone.tonemap.key(),
        },
        "backend": {
            "kind": done.info.kind,
            "device": done.info.device,
            "driver": done.info.driver,
            "mode": if done.info.strict { "strict" } else { "portable" },
        },
        "budget": job.chosen.as_ref().map(|(wish, chosen)| json!({
            "seconds": match wish { Wish::Within(time) => Some(seconds(*time)), Wish::Flip(_) => None },
            "flip": match wish { Wish::Within(_) => None, Wish::Flip(flip) => Some(*flip) },
            "expected": { "seconds": chosen.seconds, "samples": chosen.samples, "relmse": chosen.relmse, "flip": chosen.flip },
            "taken": seconds(times.rendered),
        })),
        "plan": crate::plan::effects_json(plan),
        "result": {
            "stop": done.taken.stop.name(),
            "lhb_views": done.lookups.as_ref().map(|built| built.views),
            "lhb_elements": done.lookups.as_ref().map(|built| built.elements),
            "lhb_elements_kept": done.lookups.as_ref().map(|built| built.kept),
            "voxels": voxels.map(|built| built.count),
            "samples": { "least": least, "most": most },
            "paths_per_second": done.taken.paths_per_second(),
        },
        "seconds": {
            "load": seconds(prepared.load_time),
            "compile": seconds(prepared.compile_time),
            "plan": seconds(job.plan_time),
            "upload": seconds(done.upload_time),
            "rasterize_lhb": done.lookups.as_ref().map(|built| seconds(built.time)),
            "pack_lhb": packed.map(|built| seconds(built.pack_time)),
            (kernel): seconds(done.taken.elapsed),
            "shade_primary": done.surfaces.as_ref().map(|surfaces| seconds(surfaces.gbuffer_time)),
            "filter_indirect": filtered.map(|surfaces| seconds(surfaces.made_time)),
            "voxelize": voxels.map(|built| seconds(built.voxelize_time)),
            "light_voxels": voxels.map(|built| seconds(built.light_time)),
            "reduce_mips": voxels.map(|built| seconds(built.reduce_time)),
            "trace_cones": gathered.map(|surfaces| seconds(surfaces.made_time)),
            "write": seconds(times.write),
            "total": seconds(times.total),
        },
        "bytes": {
            "scene": source::compiled_bytes(&prepared.compiled),
            "lhb": done.lookups.as_ref().map(|built| built.bytes),
            "lhb_read_back": packed.map(|built| built.read_back_bytes),
            "voxels": voxels.map(|built| built.bytes),
            "film": pixels * size_of::<FilmTexel>() as u64,
            "peak_resident": peak_resident(),
        },
        "notices": notices,
    });
    text(&value)
}

fn text(value: &Value) -> String {
    format!("{value:#}\n")
}

/// The most memory this process had at once, where the system says.
fn peak_resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}
