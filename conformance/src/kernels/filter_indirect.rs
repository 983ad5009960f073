// kernel family: filter_indirect
// contract core/src/kernels/filter_indirect.rs
// cpu backend-cpu/src/kernels/filter_indirect.rs
// gpu backend-gpu/src/kernels/filter_indirect.wgsl
// oracle conformance/src/oracle/filter_indirect.rs
//! Cases and laws of `filter_indirect`. Most pictures are made up, so that it is known which neighbours are joined: no pair is within
//! the oracle's band of doubt unless its floats are exact. Patchworks and rendered scenes have what comes.

mod cases;
mod foreign;
pub(crate) mod inputs;
mod joins;
mod laws;
mod pairs;
mod spread;
mod values;

use crate::compare::{Evidence, Shape, exact};
use crate::oracle::filter_indirect::{Allowed, Picture, as_written, possible};
use crate::trial::{Check, Context, Failure, Listing, ensure};
use twinlight_core::Backend;
use twinlight_core::kernels::filter_indirect::RadianceTexel;

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    cases::list(list);
    pairs::list(list);
    joins::list(list);
    spread::list(list);
    values::list(list);
    laws::list(list);
    foreign::list(list);
}

type Checked<T> = Result<T, Failure>;

/// What an output holds before the kernel runs: whoever reads it, or leaves some of it, shows it.
fn garbage(count: usize) -> Vec<RadianceTexel> {
    vec![RadianceTexel { rgb: [f32::NAN, -7.0, f32::INFINITY], padding: 0xdead_beef }; count]
}

/// The backend's output over `before`.
pub(crate) fn filtered_over<B: Backend>(
    backend: &B,
    picture: &Picture,
    before: &[RadianceTexel],
) -> Checked<Vec<RadianceTexel>> {
    let gbuffer = backend.upload(&picture.gbuffer)?;
    let diffuse = backend.upload(&picture.diffuse)?;
    let input = backend.upload(&picture.input)?;
    let mut output = backend.upload(before)?;
    backend.filter_indirect(&gbuffer, &diffuse, &input, &picture.params, &mut output)?;
    Ok(backend.download(&output)?)
}

fn filtered<B: Backend>(cx: &Context<'_, B>, picture: &Picture) -> Checked<Vec<RadianceTexel>> {
    filtered_over(cx.backend, picture, &garbage(picture.input.len()))
}

fn shape(picture: &Picture) -> Shape {
    Shape::Image { width: picture.params.width as usize }
}

/// The backend's output, which is within the oracle's intervals, and in strict mode has its bits.
fn agreed<B: Backend>(cx: &Context<'_, B>, picture: &Picture) -> Checked<Vec<RadianceTexel>> {
    let got = filtered(cx, picture)?;
    let place = |f: Failure| f.within(&format!("{:?}", picture.params));
    within_intervals(picture, &got).map_err(place)?;
    if cx.backend.info().strict {
        let want = as_written(picture);
        exact(cx, "output", &settled(&got, &want), &want, shape(picture)).map_err(place)?;
    }
    Ok(got)
}

fn agrees<B: Backend>(cx: &Context<'_, B>, picture: &Picture) -> Check {
    agreed(cx, picture).map(|_| ())
}

/// `got` with the NaN that `want` has, where both have one.
fn settled(got: &[RadianceTexel], want: &[RadianceTexel]) -> Vec<RadianceTexel> {
    let mut settled = got.to_vec();
    for (texel, want) in settled.iter_mut().zip(want) {
        for (value, want) in texel.rgb.iter_mut().zip(want.rgb) {
            if value.is_nan() && want.to_bits() == f32::NAN.to_bits() {
                *value = want;
            }
        }
    }
    settled
}

/// Every pixel against the oracle. More than one undecided pixel in a hundred would make the check a formality.
pub(crate) fn within_intervals(picture: &Picture, got: &[RadianceTexel]) -> Check {
    let mut evidence = Evidence::new("output", shape(picture));
    let mut undecided = 0;
    for (at, texel) in got.iter().enumerate() {
        let pixel = possible(picture, at);
        undecided += usize::from(pixel.undecided > 0);
        for (c, allowed) in pixel.rgb.into_iter().enumerate() {
            check_channel(&mut evidence, at, c, texel.rgb[c], picture.input[at].rgb[c], allowed);
        }
        evidence.one_of(at, "padding", texel.padding, &[0]);
    }
    evidence.finish()?;
    let count = got.len();
    ensure(undecided * 100 <= count, || {
        format!("the oracle is undecided about {undecided} of {count} pixels")
    })
}

fn check_channel(evidence: &mut Evidence, at: usize, c: usize, got: f32, input: f32, allowed: Allowed) {
    let field = format!("rgb.{c}");
    match allowed {
        Allowed::Copied => {
            let same = got.to_bits() == input.to_bits();
            evidence.holds(at, same, || format!("{field}: got {got:e}, want a copy of {input:e}"));
        }
        Allowed::Within { low, high } => {
            evidence.interval(at, &field, got, low, high, "WGSL's accuracy of each operation");
        }
        Allowed::NotFinite => {
            evidence.holds(at, !got.is_finite(), || format!("{field}: got {got:e}, finite"))
        }
        Allowed::Any => {}
    }
}

/// Relative error of a mean of `terms` terms, none of them negative, as the oracle counts it.
fn rounding(terms: usize) -> f64 {
    (terms as f64 + 5.0) * 1.001 / 8_388_608.0
}
