//! Knobs of the method voxel.

use clap::Args;
use twinlight::kernels::light_voxels::MAX_SAMPLES;
use twinlight::lattice::MAX_VOXELS;
use twinlight::methods::cost::knobs::{help, long_help};
use twinlight::methods::voxel::{Cones, Storage, VoxelSettings};

/// Knobs of the method voxel.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Method voxel")]
pub struct VoxelArgs {
    #[arg(long, help = help("--grid"), long_help = long_help("--grid"), value_name = "N", env = "TWINLIGHT_GRID", default_value_t = VoxelSettings::default().grid,
          value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_VOXELS)))]
    pub grid: u32,
    #[arg(long, help = help("--storage"), long_help = long_help("--storage"), value_name = "NAME", env = "TWINLIGHT_STORAGE", default_value_t = VoxelSettings::default().storage, value_parser = storage)]
    pub storage: Storage,
    #[arg(long, help = help("--cones"), long_help = long_help("--cones"), value_name = "HOW", env = "TWINLIGHT_CONES", default_value_t = VoxelSettings::default().cones, value_parser = cones)]
    pub cones: Cones,
    #[arg(long, help = help("--light-samples"), long_help = long_help("--light-samples"), value_name = "N", env = "TWINLIGHT_LIGHT_SAMPLES", default_value_t = VoxelSettings::default().light_samples,
          value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    pub light_samples: u32,
}

impl VoxelArgs {
    /// The flag that asks for what only this method does.
    pub fn asked_for(&self) -> Option<&'static str> {
        let usual = VoxelSettings::default();
        let flags = [
            ("--grid", self.grid != usual.grid),
            ("--storage", self.storage != usual.storage),
            ("--cones", self.cones != usual.cones),
            ("--light-samples", self.light_samples != usual.light_samples),
        ];
        flags.into_iter().find(|(_, is_asked_for)| *is_asked_for).map(|(flag, _)| flag)
    }

    /// As the method takes them. Light that is scattered without a limit is gathered as often as [`VoxelSettings::default`] says.
    pub fn settings(&self, bounces: Option<u32>, seed: u32) -> VoxelSettings {
        VoxelSettings {
            grid: self.grid,
            storage: self.storage,
            cones: self.cones,
            light_samples: self.light_samples,
            bounces: bounces.unwrap_or(VoxelSettings::default().bounces),
            seed,
            ..VoxelSettings::default()
        }
    }
}

fn storage(text: &str) -> Result<Storage, String> {
    text.parse().map_err(|e: twinlight::Error| e.to_string())
}

fn cones(text: &str) -> Result<Cones, String> {
    text.parse().map_err(|e: twinlight::Error| e.to_string())
}
