//! `render --budget` and `--target-flip`: a method and its knobs, chosen by what was measured before.

mod choose;
mod probe;
mod table;

pub use choose::{Chosen, Wish};
pub use probe::{Effort, Probe, probe};

use crate::args::{Cli, Command, RenderArgs};
use crate::device::Device;
use crate::exit::{Failure, Stage};
use crate::report;
use crate::source::{self, Prepared};
use choose::{Subject, of_own, of_shipped};
use clap::Parser;
use std::path::{Path, PathBuf};
use std::time::Duration;
use table::{Table, shipped};
use twinlight::io::resolve::read_limited;
use twinlight::scene::{Camera, Limits, compile};
use twinlight::{Error, fixtures};

/// A look at a scene takes a tenth of the time that there is, a second at most.
const MOST_LOOKING: Duration = Duration::from_secs(1);

/// A look at the scene that tells machines apart.
const MACHINE: (&str, Duration) = ("cornell", Duration::from_millis(60));

/// Never the first to end.
const MOST_SAMPLES: u32 = 1 << 24;

/// Larger files are no tables.
const MAX_TABLE_BYTES: u64 = 256 << 20;

/// What to render, with the method and the knobs that were chosen.
pub struct Settled {
    /// The flags, as if they had been given.
    pub args: RenderArgs,
    /// Why.
    pub chosen: Chosen,
}

/// Chooses what to render, and says so.
///
/// # Errors
/// [`Failure::Usage`] for knobs that would be chosen; tables that can't be read; what the backend refuses.
pub fn settle(
    args: &RenderArgs,
    wish: Wish,
    prepared: &Prepared,
    device: &Device,
) -> Result<Settled, Failure> {
    refuse_knobs(args)?;
    let size =
        args.picture.size.map_or(prepared.settings.size.unwrap_or([512, 512]), |size| [size.0, size.1]);
    let camera = Camera::of_scene(&prepared.scene).ok_or_else(|| {
        Failure::Library(Stage::Input, Error::invalid("camera", "the scene has none and no bounds to frame"))
    })?;
    let time = match wish {
        Wish::Within(budget) => (budget / 10).min(MOST_LOOKING),
        Wish::Flip(_) => MOST_LOOKING / 4,
    };
    let bounces = args.picture.bounces.map_or(prepared.settings.bounces, |bounces| bounces.0);
    let look =
        look(device, prepared, &camera, bounces, Effort::Time(time)).map_err(Failure::at(Stage::Device))?;
    let mut subject = Subject {
        triangles: prepared.scene.triangle_count() as f64,
        pixels: f64::from(size[0]) * f64::from(size[1]),
        probe: look,
        machine: 1.0,
    };
    let method = args.picture.method.map(|method| method.key());
    let (chosen, source) = match own_table(args)? {
        Some((path, table)) => (of_own(&table, &subject, wish, method), path.display().to_string()),
        None => {
            let tables = shipped();
            subject.machine = machine(device, &tables).map_err(Failure::at(Stage::Device))?;
            (of_shipped(&tables, &subject, wish, method), "builtin scenes".into())
        }
    };
    let chosen = chosen
        .ok_or_else(|| Failure::Usage(format!("{source}: no setting of such a method was measured")))?;
    let args = with(args, &chosen, wish)?;
    say(&chosen, wish, &source);
    Ok(Settled { args, chosen })
}

/// What is chosen can't be asked for.
fn refuse_knobs(args: &RenderArgs) -> Result<(), Failure> {
    match args.picture.slhb.asked_for().or(args.picture.voxel.asked_for()) {
        Some(flag) => {
            Err(Failure::Usage(format!("{flag} would be chosen by --budget or --target-flip: leave it out")))
        }
        None => Ok(()),
    }
}

fn look(
    device: &Device,
    prepared: &Prepared,
    camera: &Camera,
    bounces: Option<u32>,
    effort: Effort,
) -> twinlight::Result<Probe> {
    match device {
        Device::Cpu(backend) => probe(backend, &prepared.compiled, camera, bounces, effort),
        #[cfg(feature = "gpu")]
        Device::Gpu(backend) => probe(&**backend, &prepared.compiled, camera, bounces, effort),
    }
}

/// How much longer a sample takes here than where shipped tables were measured.
fn machine(device: &Device, tables: &[Table]) -> twinlight::Result<f64> {
    let name = format!("builtin:{}", MACHINE.0);
    let known = tables.iter().find(|table| table.scene == name).and_then(Table::reference);
    let (Some(known), Some(scene)) = (known, fixtures::scenes::builtin(MACHINE.0)) else { return Ok(1.0) };
    let Some(camera) = Camera::of_scene(&scene) else { return Ok(1.0) };
    let compiled = compile(&scene, &Limits::default())?;
    let (bounces, effort) = (Some(MEASURED_BOUNCES), Effort::Time(MACHINE.1));
    let found = match device {
        Device::Cpu(backend) => probe(backend, &compiled, &camera, bounces, effort)?,
        #[cfg(feature = "gpu")]
        Device::Gpu(backend) => probe(&**backend, &compiled, &camera, bounces, effort)?,
    };
    Ok(found.per_sample / known.per_sample)
}

/// Bounces of shipped tables.
const MEASURED_BOUNCES: u32 = 4;

/// The table that is named, or that `twinlight cost` wrote into this folder for this scene.
fn own_table(args: &RenderArgs) -> Result<Option<(PathBuf, Table)>, Failure> {
    let path = match &args.costs {
        Some(path) if path.is_dir() => path.join("cost.json"),
        Some(path) => path.clone(),
        None => {
            let usual = Path::new(&format!("{}-cost", source::stem(&args.picture.scene))).join("cost.json");
            if !usual.is_file() {
                return Ok(None);
            }
            usual
        }
    };
    let bytes = read_limited(&path, MAX_TABLE_BYTES).map_err(Failure::at(Stage::Input))?;
    let table = serde_json::from_slice(&bytes).ok().as_ref().and_then(Table::of_json);
    match table {
        Some(table) if table.scene == args.picture.scene => Ok(Some((path, table))),
        // Of another scene with the same file name: nothing that was asked for.
        Some(_) if args.costs.is_none() => Ok(None),
        Some(table) => Err(Failure::Usage(format!("{} is about '{}'", path.display(), table.scene))),
        None => Err(Failure::Library(
            Stage::Input,
            Error::invalid(path.display().to_string(), "no table of costs: `twinlight cost` writes one"),
        )),
    }
}

/// With method, knobs and samples.
fn with(args: &RenderArgs, chosen: &Chosen, wish: Wish) -> Result<RenderArgs, Failure> {
    let mut args = args.clone();
    let scene = &args.picture.scene;
    let words = ["twinlight", "render", scene, "--method", &chosen.method].map(String::from);
    let flags = chosen.flags.iter().flat_map(|(flag, value)| [flag.clone(), value.clone()]);
    let parsed = Cli::try_parse_from(words.into_iter().chain(flags));
    let Ok(Command::Render(parsed)) = parsed.map(|cli| cli.command) else {
        return Err(Failure::Usage(format!(
            "the table's setting {:?} is none of this version",
            chosen.flags
        )));
    };
    args.picture.method = parsed.picture.method;
    args.picture.slhb = parsed.picture.slhb;
    args.picture.voxel = parsed.picture.voxel;
    // Within a time, as many as there is time for.
    args.picture.spp = match wish {
        Wish::Within(_) => Some(MOST_SAMPLES),
        Wish::Flip(_) => Some(chosen.samples),
    };
    Ok(args)
}

fn say(chosen: &Chosen, wish: Wish, source: &str) {
    let flags: Vec<String> = chosen.flags.iter().map(|(flag, value)| format!("{flag} {value}")).collect();
    let knobs = if flags.is_empty() { String::new() } else { format!(" {}", flags.join(" ")) };
    report::status(&format!(
        "chosen: --method {}{knobs} with about {} samples: {:.2} s, relMSE {:.4}, ꟻLIP {:.3} expected by what was measured in {source}",
        chosen.method, chosen.samples, chosen.seconds, chosen.relmse, chosen.flip
    ));
    if !chosen.is_enough {
        let what = match wish {
            Wish::Within(budget) => format!("nothing takes less than {:.2} s", budget.as_secs_f64()),
            Wish::Flip(flip) => format!("no setting that was measured comes down to a ꟻLIP of {flip}"),
        };
        report::notice(&format!("{what}: this is the nearest"));
    }
}
