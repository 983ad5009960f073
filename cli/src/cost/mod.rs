//! `cost`: what accuracy costs in a scene.

mod base64;
mod command;
mod conditions;
mod data;
mod judge;
mod kernels;
mod page;
mod pictures;
mod progress;
mod records;
mod setup;
mod split;
mod study;
mod table;

use crate::args::{CostArgs, MethodName};
use crate::budget::{Effort, Probe, probe};
use crate::device::{self, Device};
use crate::exit::{Failure, Stage};
use crate::interrupt::Interrupt;
use crate::render::Job;
use crate::report;
use crate::source;
use data::Told;
use judge::Judge;
use pictures::Pictures;
use records::Records;
use setup::Setup;
use std::path::{Path, PathBuf};
use study::{End, Study};
use twinlight::io::write_file;
use twinlight::methods::cost::{METHODS, Sweep};
use twinlight::methods::post::tonemap;
use twinlight::{Backend, BackendInfo, Error};

/// Runs the command.
///
/// # Errors
/// Those of reading scenes and pictures, of the backend and of writing files; [`Failure::Signal`] after a signal.
pub fn run(args: &CostArgs) -> Result<(), Failure> {
    let tone = tonemap::Display::new(args.tone.exposure, args.tone.tonemap).map_err(Failure::Pictures)?;
    let loaded = source::load(&args.scene, &args.load, args.camera.map(|camera| camera.0))?;
    let prepared = loaded.at(0.0)?;
    prepared.notices.iter().for_each(|text| report::notice(text));
    let (device, unavailable) = device::open(&args.device)?;
    unavailable.iter().for_each(|text| report::notice(text));
    let interrupt = Interrupt::watch()
        .map_err(|e| Failure::Library(Stage::Device, Error::Internal(format!("signal handlers: {e}"))))?;
    let setup = Setup::new(args, &prepared, tone, interrupt);
    match &device {
        Device::Cpu(backend) => on_backend(&setup, backend),
        #[cfg(feature = "gpu")]
        Device::Gpu(backend) => on_backend(&setup, &**backend),
    }
}

fn on_backend<B: Backend>(setup: &Setup, backend: &B) -> Result<(), Failure> {
    let (args, info) = (setup.args, backend.info());
    let key = key(setup, &info)?;
    let folder = folder(args)?;
    let pictures = Pictures::new(&folder, &key, setup.tone);
    let judge = Judge::find(setup, &pictures, backend);
    setup.progress.clear();
    // Without a reference, nothing can be judged and nothing is worth writing.
    let Some(judge) = judge? else {
        return Err(Failure::Signal(setup.interrupt.caught().unwrap_or_default()));
    };
    let key = conditions::key_with(&key, judge.reference.image());
    let records = Records::open(folder.join("points.jsonl"), &key)?;
    let methods = methods(&args.methods);
    let sweep = if args.quick { Sweep::quick(&methods) } else { Sweep::new(&methods) };
    let before = records.points().count();
    let (judge, methods, pictures) = (&judge, &methods, &pictures);
    let mut study = Study { setup, judge, methods, sweep, records, pictures, finest: Vec::new() };
    let end = study.run(backend);
    setup.progress.clear();
    let end = end?;
    let look = look(setup, backend)?;
    write(&Told { study: &study, info, is_complete: end == End::Complete, look }, &folder)?;
    let count = study.records.points().count();
    report::status(&format!("{count} settings, {} of them new, in {:.0} s", count - before, study.spent()));
    match end {
        End::Signal(signal) => Err(Failure::Signal(signal)),
        End::Complete | End::Time => Ok(()),
    }
}

/// Samples per pixel by which scenes are told apart.
const LOOK: u32 = 16;

/// What `render --budget` knows this scene by.
fn look<B: Backend>(setup: &Setup, backend: &B) -> Result<Probe, Failure> {
    let job = setup.job("reference", vec![("--spp", "1".into())], setup.args.seed)?;
    let scene = &setup.prepared.compiled;
    probe(backend, scene, &job.camera, setup.bounces, Effort::Samples(LOOK))
        .map_err(Failure::at(Stage::Device))
}

/// Of the conditions. What a render takes from the environment is read as a render reads it.
fn key(setup: &Setup, info: &BackendInfo) -> Result<String, Failure> {
    let usual = setup.render("reference", vec![("--spp", "1".into())], setup.args.seed).picture()?;
    let job = Job::new(&usual, None, setup.prepared)?;
    Ok(conditions::key(setup, &job.camera, &usual, info))
}

/// Of the study, which is there afterwards.
fn folder(args: &CostArgs) -> Result<PathBuf, Failure> {
    let usual = || format!("{}-cost", source::stem(&args.scene)).into();
    let folder = args.out.clone().unwrap_or_else(usual);
    let made = std::fs::create_dir_all(&folder);
    made.map_err(|source| Failure::Library(Stage::Output, Error::Io { path: folder.clone(), source }))?;
    Ok(folder)
}

fn write(told: &Told, folder: &Path) -> Result<(), Failure> {
    let study = told.json()?;
    let page = page::html(&told.study.setup.args.scene, &study);
    let numbers = format!("{:#}\n", data::without_pictures(study));
    let table = table::csv(&told.study.records.points().collect::<Vec<_>>());
    for (name, text) in [("cost.html", page), ("cost.json", numbers), ("cost.csv", table)] {
        let path = folder.join(name);
        write_file(&path, text.as_bytes()).map_err(Failure::at(Stage::Output))?;
        report::print(&format!("{}\n", path.display()))?;
    }
    Ok(())
}

/// In the order of the table, each once.
fn methods(wanted: &[MethodName]) -> Vec<&'static str> {
    let is_wanted = |key: &str| wanted.iter().any(|method| method.key() == key);
    METHODS.iter().map(|(key, _)| *key).filter(|key| is_wanted(key)).collect()
}
