// kernel family: walk_lhb
// contract core/src/kernels/walk_lhb.rs
// cpu backend-cpu/src/kernels/walk_lhb.rs
// gpu backend-gpu/src/kernels/walk_lhb.wgsl
// oracle conformance/src/oracle/walk_lhb.rs
//! Cases and laws of `walk_lhb`: pictures whose radiance is known, the reference within a stated bias, and the film's integers,
//! which are exact.

mod cases;
mod laws;
mod moved;
mod reference;
mod shadows;
mod walked;

use super::trace_paths::film::Mean;
use super::trace_paths::params;
use crate::kernels::pictures_wanted;
use crate::oracle::walk_lhb::{self as oracle, Looked};
use crate::scenes::compiled;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_methods::slhb::LookupSettings;
pub(crate) use walked::{Prepared, walked};

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "walk_lhb":
        closed_furnaces, sphere_room, lights_over_a_floor, environments, white_furnaces, mirrors_and_glass,
    );
    shadows::list(list);
    cases::list(list);
    laws::list(list);
    moved::list(list);
    reference::list(list);
}

/// Standard errors by which a mean may miss: with fixed seeds this is decided once, and 4.5 leaves 7·10⁻⁶ to chance.
const SIGMAS: f64 = 4.5;

/// Largest relative standard error of a picture's mean: lamps that are sampled by area are noisy in corners, and a lobe lost or
/// counted twice shows nevertheless. Floors, which are a tenth as noisy, show 3 %.
const POWER: f64 = 0.015;

fn known<B: Backend>(cx: &Context<'_, B>, cases: &[Looked]) -> Check {
    pictures_wanted(cx)?;
    for case in cases {
        check(cx, case).map_err(|f| f.within(&case.known.name))?;
    }
    Ok(())
}

/// The mean over the picture against the known radiance.
fn check<B: Backend>(cx: &Context<'_, B>, case: &Looked) -> Check {
    let known = &case.known;
    let compiled = compiled(&known.scene);
    let (size, samples) = if cx.full() { ((32, 32), 256) } else { ((16, 16), 256) };
    let mut params = params(&known.scene, &compiled, size, samples, known.bounces)?;
    params.seed = params.seed.wrapping_add(cx.options.seed as u32);
    let settings = LookupSettings {
        directions: case.directions.parse()?,
        size: case.size,
        trace_misses: case.trace_misses,
        ..LookupSettings::default()
    };
    let prepared = Prepared::with(cx.backend, &compiled, &settings)?;
    let mean = Mean::of(&walked(cx.backend, &prepared, &params)?, &params)?;
    let error = mean.standard_error();
    ensure(error <= POWER, || {
        format!("relative standard error {error} hides biases; the check has no power")
    })?;
    for channel in 0..3 {
        let (got, want) = (mean.radiance[channel], known.radiance[channel]);
        let (low, high) =
            (want * (SIGMAS * error + known.slack + case.lost), want * (SIGMAS * error + known.slack));
        ensure(got >= want - low && got <= want + high, || {
            format!(
                "channel {channel}: got {got:.6}, want {want:.6} − {low:.6} + {high:.6} ({:+.2} %)",
                (got / want - 1.0) * 100.0
            )
        })?;
    }
    Ok(())
}

/// Closed furnaces: every looked-up surface has the same radiance, so that only rays that miss the room lose light.
fn closed_furnaces<B: Backend>(cx: &Context<'_, B>) -> Check {
    known(cx, &oracle::furnaces())
}

/// A lamp in a diffuse sphere: met analytically by rays that were looked up.
fn sphere_room<B: Backend>(cx: &Context<'_, B>) -> Check {
    known(cx, &[oracle::sphere_room()])
}

/// Every kind of light over a floor that sees nothing else.
fn lights_over_a_floor<B: Backend>(cx: &Context<'_, B>) -> Check {
    known(cx, &oracle::lights())
}

/// Floors under skies, glossy ones too, over a black cellar, which a ray below the horizon would meet.
fn environments<B: Backend>(cx: &Context<'_, B>) -> Check {
    known(cx, &oracle::environments())
}

/// White bodies under an even sky, where light comes back from wherever a ray goes.
fn white_furnaces<B: Backend>(cx: &Context<'_, B>) -> Check {
    known(cx, &oracle::white_furnaces())
}

fn mirrors_and_glass<B: Backend>(cx: &Context<'_, B>) -> Check {
    known(cx, &oracle::specular())
}
