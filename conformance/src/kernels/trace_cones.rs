// kernel family: trace_cones
// contract core/src/kernels/trace_cones.rs
// cpu backend-cpu/src/kernels/trace_cones.rs
// gpu backend-gpu/src/kernels/trace_cones.wgsl
// oracle conformance/src/oracle/trace_cones.rs
//! Cases and laws of `trace_cones`. Levels and values are the oracle's of `reduce_mips`, or made up, so that wrong light is this kernel's own.

mod cases;
mod foreign;
mod hard;
pub(crate) mod inputs;
mod laws;
mod limits;

use crate::compare::{Evidence, Shape};
use crate::oracle::trace_cones::{Possible, possible};
use crate::trial::{Check, Context, Failure, Listing, ensure};
use inputs::Lit;
use twinlight_core::Backend;
use twinlight_core::kernels::reduce_mips::{
    ANISOTROPIC, HARMONICS, HARMONICS_8, ISOTROPIC, VoxelLevelBuffers, VoxelLevels,
};
use twinlight_core::kernels::trace_cones::{Cone, ConeLight, TraceConesBlock};

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    cases::list(list);
    hard::list(list);
    limits::list(list);
    laws::list(list);
    foreign::list(list);
}

type Checked<T> = Result<T, Failure>;

/// The storages that hold light.
pub(crate) const STORAGES: [u32; 4] = [ISOTROPIC, ANISOTROPIC, HARMONICS, HARMONICS_8];

/// What an output holds before the kernel runs: whoever reads it, or leaves some of it, shows it.
const GARBAGE: ConeLight = ConeLight { rgb: [f32::NAN, -7.0, f32::INFINITY], transmittance: 9.0 };

/// What comes through nothing.
const OPEN: ConeLight = ConeLight { rgb: [0.0; 3], transmittance: 1.0 };

fn uploaded<B: Backend>(backend: &B, lit: &Lit) -> twinlight_core::Result<VoxelLevels<B>> {
    Ok(VoxelLevelBuffers {
        grid: lit.grid,
        starts: lit.levels.starts.clone(),
        mask: backend.upload(&lit.levels.mask)?,
        ranks: backend.upload(&lit.levels.ranks)?,
        active: backend.upload(&lit.levels.active)?,
    })
}

/// The backend's light.
pub(crate) fn traced<B: Backend>(
    backend: &B,
    lit: &Lit,
    block: &TraceConesBlock,
    cones: &[Cone],
) -> twinlight_core::Result<Vec<ConeLight>> {
    let levels = uploaded(backend, lit)?;
    let values = backend.upload(&lit.values)?;
    let mut light = backend.upload(&vec![GARBAGE; cones.len()])?;
    backend.trace_cones(&levels, &values, &backend.upload(cones)?, block, &mut light)?;
    backend.download(&light)
}

/// The backend's light, which is one of those that the oracle allows.
fn agreed<B: Backend>(
    cx: &Context<'_, B>,
    lit: &Lit,
    block: &TraceConesBlock,
    cones: &[Cone],
) -> Checked<Vec<ConeLight>> {
    let light = traced(cx.backend, lit, block, cones)?;
    possible_light(lit, block, cones, &light).map_err(|f| f.within(&format!("{lit:?}, {block:?}")))?;
    Ok(light)
}

fn agrees<B: Backend>(cx: &Context<'_, B>, lit: &Lit, block: &TraceConesBlock, cones: &[Cone]) -> Check {
    agreed(cx, lit, block, cones).map(|_| ())
}

/// Whether each of `light` is one of those that the oracle allows. Where one end is possible, it is compared number by number.
pub(crate) fn possible_light(
    lit: &Lit,
    block: &TraceConesBlock,
    cones: &[Cone],
    light: &[ConeLight],
) -> Check {
    let mut evidence = Evidence::new("light", Shape::Line);
    for (at, (cone, found)) in cones.iter().zip(light).enumerate() {
        let ends = possible(&lit.pyramid, block, cone);
        if let [Possible { rgb, transmittance }] = ends[..] {
            let because = "WGSL's accuracy of each operation";
            for (c, within) in rgb.iter().enumerate() {
                evidence.interval(
                    at,
                    &format!("rgb.{c} of {cone:?}"),
                    found.rgb[c],
                    within.low,
                    within.high,
                    because,
                );
            }
            let within = transmittance;
            evidence.interval(at, "transmittance", found.transmittance, within.low, within.high, because);
        } else {
            let is_one = ends.iter().any(|end| end.holds(found));
            evidence.holds(at, is_one, || format!("{found:?} is none of {ends:?} of {cone:?}"));
        }
    }
    evidence.finish()
}

/// Cones whose end a rounding decides.
fn undecided(lit: &Lit, block: &TraceConesBlock, cones: &[Cone]) -> usize {
    cones.iter().filter(|cone| possible(&lit.pyramid, block, cone).len() > 1).count()
}

/// Fails unless `found` has the bits of `want`.
pub(crate) fn same(what: &str, found: &[ConeLight], want: &[ConeLight]) -> Check {
    let bits = |light: &ConeLight| (light.rgb.map(f32::to_bits), light.transmittance.to_bits());
    let differs = found.iter().zip(want).position(|(found, want)| bits(found) != bits(want));
    ensure(found.len() == want.len() && differs.is_none(), || {
        let at = differs.unwrap_or(0);
        format!("{what}: cone {at} has {:?}, want {:?}", found.get(at), want.get(at))
    })
}
