//! What a picture shows, and how well: what `render`, `plan` and `cost` share.

use super::VoxelArgs;
use super::render::{LoadArgs, MethodName, SamplerName, SlhbArgs, ToneArgs};
use super::values::{Bounces, CameraArg, Size};
use clap::Args;
use twinlight::methods::cost::knobs::{help, long_help};
use twinlight::methods::plan::Effects;

/// What a picture shows, and how well.
#[derive(Debug, Clone, Args)]
pub struct PictureArgs {
    /// A scene file (.toml .obj .ply .gltf .glb) or builtin:NAME
    #[arg(value_name = "SCENE")]
    pub scene: String,

    /// Rendering method
    #[arg(long, value_name = "NAME", env = "TWINLIGHT_METHOD", help_heading = "Quality")]
    pub method: Option<MethodName>,
    /// Width and height, pixels [default: the scene's, else 512x512]
    #[arg(long, value_name = "WxH", env = "TWINLIGHT_SIZE", help_heading = "Quality")]
    pub size: Option<Size>,
    #[arg(long, help = help("--spp"), long_help = long_help("--spp"), value_name = "N", env = "TWINLIGHT_SPP", help_heading = "Quality", allow_negative_numbers = true,
          value_parser = clap::value_parser!(u32).range(1..=16_777_216))]
    pub spp: Option<u32>,
    #[arg(
        long,
        help = help("--bounces"),
        long_help = long_help("--bounces"),
        value_name = "N",
        env = "TWINLIGHT_BOUNCES",
        help_heading = "Quality",
        allow_negative_numbers = true
    )]
    pub bounces: Option<Bounces>,
    /// Seed of the random numbers: same seed, same picture
    #[arg(
        long,
        value_name = "N",
        env = "TWINLIGHT_SEED",
        help_heading = "Quality",
        allow_negative_numbers = true
    )]
    pub seed: Option<u32>,
    #[arg(
        long,
        help = help("--sampler"),
        long_help = long_help("--sampler"),
        value_name = "NAME",
        env = "TWINLIGHT_SAMPLER",
        default_value = "sobol",
        help_heading = "Quality"
    )]
    pub sampler: SamplerName,

    /// What light does in the picture: auto (what the scene calls for), all, none, or a list such as shadows,interreflection
    ///
    /// A list names what may be simulated of shadows, environment, interreflection, glossy, mirror, refraction and textures; the rest is left out.
    /// `twinlight plan` says what that means for a scene.
    #[arg(long, value_name = "LIST", env = "TWINLIGHT_EFFECTS", default_value = "auto", value_parser = effects, help_heading = "Quality")]
    pub effects: Effects,
    #[arg(long, help = help("--tolerance"), long_help = long_help("--tolerance"), value_name = "SHARE", env = "TWINLIGHT_TOLERANCE", value_parser = tolerance, help_heading = "Quality",
          allow_negative_numbers = true)]
    pub tolerance: Option<f64>,

    // The brackets are clap's help text, no link.
    #[allow(rustdoc::broken_intra_doc_links)]
    /// Camera as "px,py,pz tx,ty,tz [ux,uy,uz] vfov": position, target, up (+Y), vertical field of view in degrees
    #[arg(long, value_name = "CAMERA", allow_hyphen_values = true, help_heading = "Picture")]
    pub camera: Option<CameraArg>,
    #[command(flatten, next_help_heading = "Picture")]
    pub tone: ToneArgs,

    #[command(flatten)]
    pub slhb: SlhbArgs,
    #[command(flatten)]
    pub voxel: VoxelArgs,

    #[command(flatten)]
    pub load: LoadArgs,
}

fn effects(text: &str) -> Result<Effects, String> {
    text.parse().map_err(|e: twinlight::Error| e.to_string())
}

/// A share such as 0.004 or 1/255.
fn tolerance(text: &str) -> Result<f64, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let share = match text.split_once('/') {
        Some((part, whole)) => number(part).zip(number(whole)).map(|(part, whole)| part / whole),
        None => number(text),
    };
    share
        .filter(|share| share.is_finite() && *share >= 0.0)
        .ok_or_else(|| "write a share from 0 on, such as 0.004 or 1/255".into())
}
