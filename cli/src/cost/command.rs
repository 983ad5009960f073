//! The render that a setting stands for, as a command: what is measured is what that command does.

use crate::args::{
    BackendChoice, Cli, Command, CostArgs, DeviceArgs, LoadArgs, MAX_MEMORY, ModeName, PictureArgs,
};
use crate::exit::Failure;
use clap::Parser;
use std::fmt::Display;
use twinlight::methods::post::tonemap::Operator;

/// Flags with their values.
pub type Flags = Vec<(&'static str, String)>;

/// What a render is asked for.
pub struct Render<'a> {
    /// Of the study.
    pub args: &'a CostArgs,
    /// As often light scatters at most.
    pub bounces: Option<u32>,
    /// Of the random numbers.
    pub seed: u32,
    /// As on the command line.
    pub method: &'static str,
    /// Samples and the method's knobs.
    pub flags: Flags,
}

impl Render<'_> {
    /// As the command line's parser reads it.
    ///
    /// # Errors
    /// [`Failure::Usage`] for what the parser refuses: what the environment says may not fit.
    pub fn picture(&self) -> Result<PictureArgs, Failure> {
        match Cli::try_parse_from(self.words()).map(|cli| cli.command) {
            Ok(Command::Render(render)) => Ok(render.picture),
            Ok(_) => unreachable!("the words begin with render"),
            Err(error) => Err(Failure::Usage(error.to_string())),
        }
    }

    /// For a shell.
    pub fn line(&self, output: &str) -> String {
        let words = self.words().into_iter().chain(["-o".into(), output.into()]);
        words.map(|word| quoted(&word)).collect::<Vec<_>>().join(" ")
    }

    fn words(&self) -> Vec<String> {
        let args = self.args;
        let bounces = self.bounces.map_or("unlimited".into(), |bounces| bounces.to_string());
        let mut words = Words(vec!["twinlight".into(), "render".into()]);
        words.0.push(args.scene.clone());
        words.flag("--size", format_args!("{}x{}", args.size.0, args.size.1));
        words.flag("--bounces", bounces);
        words.flag("--seed", self.seed);
        words.flag("--method", self.method);
        self.flags.iter().for_each(|(flag, value)| words.flag(flag, value));
        words.view(args);
        words.device(&args.device);
        words.load(&args.load);
        words.0
    }
}

struct Words(Vec<String>);

impl Words {
    fn flag(&mut self, flag: &str, value: impl Display) {
        self.0.extend([flag.to_owned(), value.to_string()]);
    }

    fn view(&mut self, args: &CostArgs) {
        if let Some(camera) = &args.camera {
            self.flag("--camera", camera);
        }
        if args.tone.exposure != 0.0 {
            self.flag("--exposure", args.tone.exposure);
        }
        if args.tone.tonemap != Operator::None {
            self.flag("--tonemap", args.tone.tonemap.key());
        }
    }

    fn device(&mut self, device: &DeviceArgs) {
        match &device.backend {
            BackendChoice::Auto => {}
            BackendChoice::Cpu => self.flag("--backend", "cpu"),
            BackendChoice::Gpu(selector) if selector.is_empty() => self.flag("--backend", "gpu"),
            BackendChoice::Gpu(selector) => self.flag("--backend", format_args!("gpu:{selector}")),
        }
        match device.mode {
            None => {}
            Some(ModeName::Strict) => self.flag("--mode", "strict"),
            Some(ModeName::Portable) => self.flag("--mode", "portable"),
        }
        if let Some(threads) = device.threads {
            self.flag("--threads", threads);
        }
    }

    fn load(&mut self, load: &LoadArgs) {
        load.allow_path.iter().for_each(|path| self.flag("--allow-path", path.display()));
        if MAX_MEMORY.parse() != Ok(load.max_memory) {
            self.flag("--max-memory", load.max_memory.0);
        }
        self.0.extend(load.lenient.then(|| "--lenient".into()));
        self.0.extend(load.strict.then(|| "--strict".into()));
        load.animation.iter().for_each(|animation| self.flag("--animation", animation));
    }
}

/// The command of this process, for a shell.
pub fn asked() -> String {
    let words = std::env::args().skip(1).map(|word| quoted(&word));
    std::iter::once("twinlight".into()).chain(words).collect::<Vec<_>>().join(" ")
}

/// A word that a POSIX shell takes as it is.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./:,=+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::MethodName;
    use twinlight::methods::cost::{METHODS, Setting};

    fn args(words: &[&str]) -> CostArgs {
        let words = ["twinlight", "cost", "builtin:cornell"].iter().chain(words);
        match Cli::try_parse_from(words).unwrap().command {
            Command::Cost(args) => *args,
            other => panic!("{other:?}"),
        }
    }

    /// Every value of the sweep is one that the command line takes.
    #[test]
    fn every_setting_is_a_render() {
        let args = args(&[
            "--size",
            "20x10",
            "--camera",
            "0,0.5,3 0,1,0 1,1,0 40",
            "--exposure",
            "1.5",
            "--threads",
            "2",
        ]);
        for (method, _) in METHODS {
            let begin = Setting::begin(method);
            for setting in
                begin.star().into_iter().chain([begin, Setting::coarsest(method), Setting::finest(method)])
            {
                let (flags, bounces) = (setting.flags(), Some(3));
                let render = Render { args: &args, bounces, seed: 7, method, flags: flags.clone() };
                let picture = render.picture().unwrap();
                assert_eq!(picture.method.map(MethodName::key), Some(method));
                assert_eq!((picture.size, picture.camera), (Some(args.size), args.camera));
                assert_eq!((picture.seed, picture.tone.exposure), (Some(7), 1.5));
                let of = |flag| flags.iter().find(|(name, _)| *name == flag).map(|(_, value)| value.clone());
                assert_eq!(of("--spp"), picture.spp.map(|spp| spp.to_string()));
                assert!(of("--grid").is_none_or(|grid| grid == picture.voxel.grid.to_string()));
                assert!(of("--lhb-size").is_none_or(|size| size == picture.slhb.lhb_size.to_string()));
            }
        }
    }

    #[test]
    fn lines_survive_a_shell() {
        let args = args(&["--allow-path", "it's here", "--backend", "gpu:Model 7"]);
        let flags = Setting::begin("reference").flags();
        let line = Render { args: &args, bounces: None, seed: 0, method: "reference", flags }.line("a b.exr");
        assert!(
            line.starts_with("twinlight render builtin:cornell --size 128x128 --bounces unlimited"),
            "{line}"
        );
        for part in [r"'it'\''s here'", "'gpu:Model 7'", "-o 'a b.exr'"] {
            assert!(line.contains(part), "{line}");
        }
    }
}
