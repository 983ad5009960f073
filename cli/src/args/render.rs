//! `render`.

use super::values::{Bytes, FrameRange, flip, frame_rate, moment, seconds};
use super::{DeviceArgs, PictureArgs};
use crate::budget::Wish;
use clap::builder::RangedI64ValueParser;
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::time::Duration;
use twinlight::directions::DirectionSet;
use twinlight::io::LoadOptions;
use twinlight::kernels::filter_indirect::MAX_WINDOW;
use twinlight::methods::cost::knobs::{help, long_help};
use twinlight::methods::post::tonemap::Operator;
use twinlight::methods::reference::Sampler;
use twinlight::methods::slhb::{Elements, Shadows};
use twinlight::scene::Limits;

const EXAMPLES: &str = "\
Examples:
  twinlight render builtin:cornell
      64 samples per pixel; writes cornell.png, cornell.exr and cornell.json to the current folder
  twinlight render room.toml -o out/room.exr --spp 1024 --bounces 8
      a scene file's own settings count until a flag says otherwise
  twinlight render bunny.ply --time 10 --size 800x600 --camera \"0,0.1,0.4 0,0.1,0 35\"
      as many samples as fit into ten seconds
  twinlight render fox.glb --animation Run --frames 0.. -o run/fox.png
      every frame of an animation: run/fox-0000.png, run/fox-0001.png and so on
  twinlight render builtin:cornell --backend gpu:llvmpipe --mode strict
      on a GPU adapter, bit for bit what the CPU renders

Ctrl-C ends the render and saves what is finished (exit code 130), of a sequence the frames that are complete; twice: at
once, nothing is saved.";

/// What a scene may need, unless a flag says otherwise.
pub const MAX_MEMORY: &str = "16GiB";

/// Where a scene comes from and what it may need.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Reading the scene")]
pub struct LoadArgs {
    /// Let the scene's files lie in this folder too, beside the scene's own
    #[arg(long, value_name = "DIR", env = "TWINLIGHT_ALLOW_PATH")]
    pub allow_path: Vec<PathBuf>,
    /// Refuse what would need more memory than this, such as 4GiB
    #[arg(long, value_name = "BYTES", env = "TWINLIGHT_MAX_MEMORY", default_value = MAX_MEMORY)]
    pub max_memory: Bytes,
    /// Drop triangles with vertices that are no numbers, instead of refusing the scene
    #[arg(long)]
    pub lenient: bool,
    /// Refuse what else is a notice: unknown keys, missing textures
    #[arg(long)]
    pub strict: bool,
    /// Play this animation of glTF files, by its name or its number from 0 [default: the first]
    #[arg(long, value_name = "NAME|N", env = "TWINLIGHT_ANIMATION")]
    pub animation: Option<String>,
}

impl LoadArgs {
    /// As the readers take them.
    pub fn options(&self) -> LoadOptions {
        LoadOptions {
            limits: self.limits(),
            allow_paths: self.allow_path.clone(),
            strict: self.strict,
            animation: self.animation.clone(),
            ..LoadOptions::default()
        }
    }

    /// As [`twinlight::scene::compile`] takes them.
    pub fn limits(&self) -> Limits {
        Limits { max_bytes: self.max_memory.0, lenient: self.lenient, ..Limits::default() }
    }
}

/// How radiance becomes a PNG.
#[derive(Debug, Clone, Args)]
pub struct ToneArgs {
    /// Stops of exposure of PNGs and display metrics; EXR files hold radiance as it is
    #[arg(
        long,
        value_name = "STOPS",
        env = "TWINLIGHT_EXPOSURE",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    pub exposure: f64,
    /// Tone curve of PNGs and display metrics: none clamps
    #[arg(long, value_name = "CURVE", env = "TWINLIGHT_TONEMAP", default_value = "none", value_parser = tone_operator)]
    pub tonemap: Operator,
}

fn tone_operator(text: &str) -> Result<Operator, String> {
    text.parse().map_err(|e: twinlight::methods::post::PostError| e.to_string())
}

/// How float arithmetic is compiled on a GPU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ModeName {
    /// Every operation rounds as written: the CPU's bits
    Strict,
    /// Plain WGSL: the driver may fuse and reorder
    Portable,
}

/// Where random numbers come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SamplerName {
    /// Owen-scrambled Sobol points: less noise
    Sobol,
    /// Independent numbers: a variance that can be tested
    Independent,
}

impl From<SamplerName> for Sampler {
    fn from(name: SamplerName) -> Self {
        match name {
            SamplerName::Sobol => Self::Sobol,
            SamplerName::Independent => Self::Independent,
        }
    }
}

/// The rendering methods.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// Unbiased path tracer, what the others are judged by
    Reference,
    /// Spherical layered hit buffers: indirect light is looked up, not traced
    Slhb,
    /// Voxel cone tracing: indirect light is gathered from lit voxels through a few wide cones, without noise between pixels
    Voxel,
}

impl MethodName {
    /// As scene files and sidecars spell it.
    pub fn key(self) -> &'static str {
        match self {
            Self::Reference => "reference",
            Self::Slhb => "slhb",
            Self::Voxel => "voxel",
        }
    }
}

/// Whether hit buffers keep everything.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layers(pub Option<u32>);

impl std::str::FromStr for Layers {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "all" {
            return Ok(Self(None));
        }
        match text.parse() {
            Ok(layers) if layers > 0 => Ok(Self(Some(layers))),
            _ => Err("neither `all` nor a number above 0".into()),
        }
    }
}

/// What `--show` draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Show {
    /// A view of the layered hit buffers.
    Lhb(u32),
}

impl std::str::FromStr for Show {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let view = text.strip_prefix("lhb:").and_then(|view| view.parse().ok());
        view.map(Self::Lhb).ok_or_else(|| "not of the form lhb:VIEW, such as lhb:0".into())
    }
}

/// Cone approximation of lookups.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ConeName {
    /// Lines are chosen through what the ray meets
    Auto,
    /// Lines go through the ray's start: shows the banding of few directions
    Off,
}

/// Rays that lookups find nothing for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MissesName {
    /// They are traced: lines beside a silhouette lose light
    Trace,
    /// They leave the scene
    Leave,
}

/// How light finds out what shadows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ShadowsName {
    /// Shadow rays are traced
    Rays,
    /// They are traced from what the camera sees, and looked up from there on
    Indirect,
    /// They are looked up everywhere: shadows have the resolution of the hit buffers
    All,
}

impl ShadowsName {
    /// As it is written on the command line.
    pub fn key(self) -> &'static str {
        match self {
            Self::Rays => "rays",
            Self::Indirect => "indirect",
            Self::All => "all",
        }
    }
}

impl From<ShadowsName> for Shadows {
    fn from(name: ShadowsName) -> Self {
        match name {
            ShadowsName::Rays => Self::Rays,
            ShadowsName::Indirect => Self::IndirectLookups,
            ShadowsName::All => Self::Lookups,
        }
    }
}

/// How the first vertex of a path looks around.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum GatherName {
    /// Along directions that are drawn
    Off,
    /// Along all directions of the set in turn: nothing is left to chance; samples come in multiples of their number
    All,
}

/// Knobs of the method slhb.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Method slhb")]
pub struct SlhbArgs {
    #[arg(long, help = help("--directions"), long_help = long_help("--directions"), value_name = "SET", env = "TWINLIGHT_DIRECTIONS", default_value = "320", value_parser = direction_set)]
    pub directions: DirectionSet,
    #[arg(long, help = help("--lhb-size"), long_help = long_help("--lhb-size"), value_name = "N", env = "TWINLIGHT_LHB_SIZE", default_value_t = 128, value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub lhb_size: u32,
    #[arg(long, help = help("--layers"), long_help = long_help("--layers"), value_name = "N", env = "TWINLIGHT_LAYERS", default_value = "all")]
    pub layers: Layers,
    #[arg(long, help = help("--elements"), long_help = long_help("--elements"), value_name = "FORMAT", env = "TWINLIGHT_ELEMENTS", default_value = "full", value_parser = elements)]
    pub elements: Elements,
    #[arg(long, help = help("--cone"), long_help = long_help("--cone"), value_name = "HOW", env = "TWINLIGHT_CONE", default_value = "auto")]
    pub cone: ConeName,
    #[arg(long, help = help("--misses"), long_help = long_help("--misses"), value_name = "HOW", env = "TWINLIGHT_MISSES", default_value = "trace")]
    pub misses: MissesName,
    #[arg(long, help = help("--shadows"), long_help = long_help("--shadows"), value_name = "WHICH", env = "TWINLIGHT_SHADOWS", default_value = "rays")]
    pub shadows: ShadowsName,
    #[arg(long, help = help("--gather"), long_help = long_help("--gather"), value_name = "WHAT", env = "TWINLIGHT_GATHER", default_value = "off")]
    pub gather: GatherName,
    #[arg(long, help = help("--interleave"), long_help = long_help("--interleave"), value_name = "N", env = "TWINLIGHT_INTERLEAVE", default_value_t = 1, value_parser = window())]
    pub interleave: u32,
    #[arg(long, help = help("--filter"), long_help = long_help("--filter"), value_name = "N", env = "TWINLIGHT_FILTER", default_value_t = 1, value_parser = window())]
    pub filter: u32,
}

impl SlhbArgs {
    /// The flag that asks for what only this method does.
    pub fn asked_for(&self) -> Option<&'static str> {
        let flags = [
            ("--shadows", self.shadows != ShadowsName::Rays),
            ("--elements", self.elements != Elements::Full),
            ("--gather", self.gather == GatherName::All),
            ("--interleave", self.interleave > 1),
            ("--filter", self.filter > 1),
        ];
        flags.into_iter().find(|(_, is_asked_for)| *is_asked_for).map(|(flag, _)| flag)
    }
}

fn window() -> RangedI64ValueParser<u32> {
    clap::value_parser!(u32).range(1..=i64::from(MAX_WINDOW))
}

fn elements(text: &str) -> Result<Elements, String> {
    text.parse().map_err(|e: twinlight::Error| e.to_string())
}

fn direction_set(text: &str) -> Result<DirectionSet, String> {
    text.parse().map_err(|e: twinlight::Error| e.to_string())
}

/// How progress is shown on stderr.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ProgressMode {
    /// A bar on a terminal, else nothing
    Auto,
    /// A line every second
    Plain,
    /// A line of JSON for every pass
    Json,
    /// Nothing
    Never,
}

/// Renders a scene and writes pictures: PNG to look at, EXR with layers to measure, and a JSON file
/// that says how they were made.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = EXAMPLES, after_help = "`--help` shows examples and explains more.")]
pub struct RenderArgs {
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Write here; .png or .exr, as often as you like [default: SCENE.png and SCENE.exr in the current folder]
    ///
    /// Folders are created. PNG is exposed and tone-mapped. EXR holds radiance and the layers direct, indirect, albedo,
    /// N (normals), Z (depth), id and variance. A JSON file with settings, timings and memory lies beside the first.
    #[arg(short, long = "output", value_name = "FILE")]
    pub outputs: Vec<PathBuf>,

    /// Stop after this many seconds, but not before every pixel has a sample
    ///
    /// With --spp, whichever comes first. The number of samples then depends on the machine, and the picture with it.
    #[arg(long, value_name = "SECONDS", env = "TWINLIGHT_TIME", help_heading = "Quality", value_parser = seconds,
          allow_negative_numbers = true)]
    pub time: Option<f64>,
    /// Choose the method and its knobs for the least error within this many seconds, from the scene as it is read to the picture
    ///
    /// By the table that `twinlight cost` wrote of the scene (SCENE-cost/cost.json here, or --costs), else by what was measured in builtin scenes and a short look at
    /// this one. With --method, knobs of that method. Says what was chosen, and which error is expected.
    #[arg(long, value_name = "SECONDS", env = "TWINLIGHT_BUDGET", help_heading = "Quality", value_parser = seconds,
          allow_negative_numbers = true, conflicts_with_all = ["spp", "time", "frames", "show"])]
    pub budget: Option<f64>,
    /// Choose the method and its knobs for the least time in which the error is down to this, such as 0.05, as --budget does
    #[arg(long, value_name = "FLIP", env = "TWINLIGHT_TARGET_FLIP", help_heading = "Quality", value_parser = flip,
          allow_negative_numbers = true, conflicts_with_all = ["budget", "spp", "time", "frames", "show"])]
    pub target_flip: Option<f64>,
    /// The table to choose by: cost.json, or the folder it is in
    #[arg(long, value_name = "PATH", env = "TWINLIGHT_COSTS", help_heading = "Quality")]
    pub costs: Option<PathBuf>,
    /// Render these frames of a scene that moves, each to files of its own
    ///
    /// FIRST up to but without END; without END, to the end of the motion. Frame N shows the scene at N/fps seconds.
    /// Outputs are numbered: a.png becomes a-0000.png, a-0001.png and so on; {frame} in a name says where the number goes.
    /// Frames that are there already are rendered again. --time counts for each frame.
    #[arg(long, value_name = "FIRST..END", env = "TWINLIGHT_FRAMES", help_heading = "Motion")]
    pub frames: Option<FrameRange>,
    /// Frames per second of --frames
    #[arg(long, value_name = "N", env = "TWINLIGHT_FPS", default_value = "24", help_heading = "Motion",
          value_parser = frame_rate, allow_negative_numbers = true)]
    pub fps: f64,
    /// Render one picture of a scene that moves, at this many seconds [default: 0]
    #[arg(long, value_name = "SECONDS", env = "TWINLIGHT_AT", help_heading = "Motion", value_parser = moment,
          conflicts_with = "frames", allow_negative_numbers = true)]
    pub at: Option<f64>,
    /// Begin the motion anew when it is over, instead of staying as it ends
    #[arg(long = "loop", help_heading = "Motion")]
    pub looped: bool,

    #[command(flatten)]
    pub device: DeviceArgs,
    /// How progress is shown, on stderr
    #[arg(
        long,
        value_name = "HOW",
        env = "TWINLIGHT_PROGRESS",
        default_value = "auto",
        help_heading = "Device"
    )]
    pub progress: ProgressMode,

    /// Instead of rendering, draw what the method works with: lhb:VIEW, a hit buffer's layer counts and layers
    #[arg(long, value_name = "WHAT", help_heading = "Method slhb")]
    pub show: Option<Show>,
}

impl RenderArgs {
    /// What is to be chosen by, if anything is.
    pub fn wish(&self) -> Option<Wish> {
        let within = self.budget.map(|seconds| Wish::Within(Duration::from_secs_f64(seconds)));
        within.or(self.target_flip.map(Wish::Flip))
    }
}
