//! `cost`: what accuracy costs in a scene.

mod base64;
mod command;
mod conditions;
mod data;
mod kernels;
mod page;
mod pictures;
mod progress;
mod records;
mod study;
mod table;

use crate::args::{Bounces, CostArgs, MethodName};
use crate::device::{self, Device};
use crate::exit::{Failure, Stage};
use crate::interrupt::Interrupt;
use crate::render::Job;
use crate::report;
use crate::source::{self, Prepared};
use command::Render;
use pictures::Pictures;
use records::Records;
use std::path::PathBuf;
use study::{End, Study};
use twinlight::io::write_file;
use twinlight::methods::cost::{METHODS, Reference, Sweep};
use twinlight::methods::post::tonemap;
use twinlight::{Backend, BackendInfo, Error};

/// As often light scatters at most, unless the scene or a flag says otherwise: all methods must simulate the same light to be compared.
const BOUNCES: u32 = 4;

/// Runs the command.
///
/// # Errors
/// Those of reading scenes and pictures, of the backend and of writing files; [`Failure::Signal`] after a signal.
pub fn run(args: &CostArgs) -> Result<(), Failure> {
    let tone = tonemap::Display::new(args.tone.exposure, args.tone.tonemap).map_err(Failure::Pictures)?;
    let loaded = source::load(&args.scene, &args.load, args.camera.map(|camera| camera.0))?;
    let prepared = loaded.at(0.0)?;
    prepared.notices.iter().for_each(|text| report::notice(text));
    let folder = args.out.clone().unwrap_or_else(|| format!("{}-cost", source::stem(&args.scene)).into());
    let interrupt = Interrupt::watch()
        .map_err(|e| Failure::Library(Stage::Device, Error::Internal(format!("signal handlers: {e}"))))?;
    let (device, unavailable) = device::open(&args.device)?;
    unavailable.iter().for_each(|text| report::notice(text));
    let session = Session { args, prepared: &prepared, tone, folder, interrupt };
    match &device {
        Device::Cpu(backend) => session.run(backend),
        #[cfg(feature = "gpu")]
        Device::Gpu(backend) => session.run(&**backend),
    }
}

struct Session<'a> {
    args: &'a CostArgs,
    prepared: &'a Prepared<'a>,
    tone: tonemap::Display,
    folder: PathBuf,
    interrupt: Interrupt,
}

impl Session<'_> {
    fn run<B: Backend>(&self, backend: &B) -> Result<(), Failure> {
        let args = self.args;
        let methods = methods(&args.methods);
        let bounces = bounces(args, self.prepared);
        let key = self.key(bounces, &backend.info())?;
        std::fs::create_dir_all(&self.folder).map_err(|source| {
            Failure::Library(Stage::Output, Error::Io { path: self.folder.clone(), source })
        })?;
        let mut records = Records::open(self.folder.join("points.jsonl"), &key)?;
        let pictures = Pictures::new(&self.folder, &key, self.tone);
        let progress = progress::Display::new(args.progress);
        let sweep = if args.quick { Sweep::quick(&methods) } else { Sweep::new(&methods) };
        let before = records.points().count();
        let (records_now, pictures_now) = (&mut records, &pictures);
        let ended = Study {
            args,
            prepared: self.prepared,
            bounces,
            tone: self.tone,
            sweep,
            methods: &methods,
            records: records_now,
            pictures: pictures_now,
            progress: &progress,
            interrupt: &self.interrupt,
        }
        .run(backend);
        progress.clear();
        let (end, reference) = ended?;
        if let Some(reference) = &reference {
            let info = backend.info();
            let is_complete = end == End::Complete;
            self.write(&methods, bounces, info, &records, &pictures, reference, is_complete)?;
            let count = records.points().count();
            report::status(&format!(
                "{count} settings, {} of them new, in {:.0} s",
                count - before,
                records.spent()
            ));
        }
        match end {
            End::Signal(signal) => Err(Failure::Signal(signal)),
            End::Complete | End::Time => Ok(()),
        }
    }

    /// Of the conditions. What a render takes from the environment is read as a render reads it.
    fn key(&self, bounces: Option<u32>, info: &BackendInfo) -> Result<String, Failure> {
        let flags = vec![("--spp", "1".into())];
        let render = Render { args: self.args, bounces, seed: self.args.seed, method: "reference", flags };
        let usual = render.picture()?;
        let job = Job::new(&usual, None, self.prepared)?;
        Ok(conditions::key(self.args, self.prepared, bounces, &job.camera, &usual, info))
    }

    fn write(
        &self,
        methods: &[&'static str],
        bounces: Option<u32>,
        info: BackendInfo,
        records: &Records,
        pictures: &Pictures,
        reference: &Reference,
        is_complete: bool,
    ) -> Result<(), Failure> {
        let (args, prepared, tone) = (self.args, self.prepared, self.tone);
        let study = data::Study {
            args,
            prepared,
            bounces,
            info,
            tone,
            methods,
            records,
            pictures,
            reference,
            is_complete,
        }
        .json()?;
        let page = page::html(&args.scene, &study);
        let numbers = format!("{:#}\n", data::without_pictures(study));
        let table = table::csv(&records.points().collect::<Vec<_>>());
        let files = [("cost.html", page), ("cost.json", numbers), ("cost.csv", table)];
        for (name, text) in files {
            let path = self.folder.join(name);
            write_file(&path, text.as_bytes()).map_err(Failure::at(Stage::Output))?;
            report::print(&format!("{}\n", path.display()))?;
        }
        Ok(())
    }
}

/// In the order of the table, each once.
fn methods(wanted: &[MethodName]) -> Vec<&'static str> {
    let is_wanted = |key: &str| wanted.iter().any(|method| method.key() == key);
    METHODS.iter().map(|(key, _)| *key).filter(|key| is_wanted(key)).collect()
}

/// The flag's, else the scene's, else the usual: the same for all methods.
fn bounces(args: &CostArgs, prepared: &Prepared) -> Option<u32> {
    match args.bounces {
        Some(Bounces(bounces)) => bounces,
        None => prepared.settings.bounces.or(Some(BOUNCES)),
    }
}
