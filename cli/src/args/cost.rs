//! `cost`.

use super::values::{Bounces, CameraArg, Size, seconds};
use super::{DeviceArgs, LoadArgs, MethodName, ProgressMode, ToneArgs};
use clap::Args;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  twinlight cost builtin:cornell
      in less than three minutes; writes cornell-cost/cost.html, cost.json and cost.csv
  twinlight cost room.toml --methods slhb,voxel --bounces 8 --time-limit 3600 --out room
      an hour for two methods; the same command again with more time goes on where this ended
  twinlight cost builtin:cornell --backend gpu --reference converged.exr
      on a GPU, against a picture that is there already (of the same size and the same number of bounces)

Ctrl-C ends the measuring and writes what is there (exit code 130); the same command again goes on.";

/// Measures what accuracy costs in a scene: renders it with many settings of each method, takes their time and their memory, compares
/// them with a reference, and writes which settings are worth their time: a page to look at, and the numbers as JSON and CSV.
#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES, after_help = "`--help` shows examples and explains more.")]
pub struct CostArgs {
    /// A scene file (.toml .obj .ply .gltf .glb) or builtin:NAME
    #[arg(value_name = "SCENE")]
    pub scene: String,

    /// Measure these methods
    #[arg(
        long,
        value_name = "NAMES",
        env = "TWINLIGHT_METHODS",
        value_delimiter = ',',
        default_value = "reference,slhb,voxel"
    )]
    pub methods: Vec<MethodName>,
    /// Write cost.html, cost.json, cost.csv and what later runs go on from to this folder [default: SCENE-cost]
    #[arg(long, value_name = "DIR", env = "TWINLIGHT_OUT")]
    pub out: Option<PathBuf>,
    /// Begin no new setting after this many seconds, the reference and earlier runs into the same folder included
    #[arg(long, value_name = "SECONDS", env = "TWINLIGHT_TIME_LIMIT", default_value = "150", value_parser = seconds,
          allow_negative_numbers = true)]
    pub time_limit: f64,
    /// Measure two settings of each method alone, for a first look
    #[arg(long)]
    pub quick: bool,

    /// Judge by this picture (EXR, PNG or JPEG), whose noise is taken for none, instead of rendering one
    #[arg(
        long,
        value_name = "FILE",
        env = "TWINLIGHT_REFERENCE",
        conflicts_with = "reference_spp",
        help_heading = "Reference"
    )]
    pub reference: Option<PathBuf>,
    /// Samples per pixel of the reference, in two halves by which its own noise is measured [default: what fits into a quarter of --time-limit, up to 8192]
    #[arg(long, value_name = "N", env = "TWINLIGHT_REFERENCE_SPP", help_heading = "Reference", allow_negative_numbers = true,
          value_parser = clap::value_parser!(u32).range(2..=16_777_216))]
    pub reference_spp: Option<u32>,

    /// Width and height, pixels
    #[arg(
        long,
        value_name = "WxH",
        env = "TWINLIGHT_SIZE",
        default_value = "128x128",
        help_heading = "Picture"
    )]
    pub size: Size,
    /// Times light may scatter, of the reference and of every method alike [default: the scene's, else 4]; for `unlimited`, --method voxel
    /// gathers 3 times, and what it lacks is part of its error
    #[arg(
        long,
        value_name = "N",
        env = "TWINLIGHT_BOUNCES",
        allow_negative_numbers = true,
        help_heading = "Picture"
    )]
    pub bounces: Option<Bounces>,
    /// Seed of the random numbers of what is measured; the reference has others
    #[arg(
        long,
        value_name = "N",
        env = "TWINLIGHT_SEED",
        default_value_t = 0,
        allow_negative_numbers = true,
        help_heading = "Picture"
    )]
    pub seed: u32,
    // The brackets are clap's help text, no link.
    #[allow(rustdoc::broken_intra_doc_links)]
    /// Camera as "px,py,pz tx,ty,tz [ux,uy,uz] vfov": position, target, up (+Y), vertical field of view in degrees
    #[arg(long, value_name = "CAMERA", allow_hyphen_values = true, help_heading = "Picture")]
    pub camera: Option<CameraArg>,
    #[command(flatten, next_help_heading = "Picture")]
    pub tone: ToneArgs,

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

    #[command(flatten)]
    pub load: LoadArgs,
}
