//! What is refused.

use super::inputs::{noisy_wall, radiance};
use super::{agrees, garbage};
use crate::compare::{Shape, exact};
use crate::oracle::filter_indirect::Picture;
use crate::trial::{Check, Context, Failure, Listing, list_trials};
use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, MAX_WINDOW};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "filter_indirect": bad_parameters_are_refused, lengths_must_agree);
}

fn some_wall() -> Picture {
    noisy_wall(&mut Random::new(61), 5, 4, 3)
}

/// Refused as invalid, with an output of `length` pixels that stays as it was.
fn refused<B: Backend>(cx: &Context<'_, B>, picture: &Picture, length: usize) -> Check {
    let backend = cx.backend;
    let gbuffer = backend.upload(&picture.gbuffer)?;
    let diffuse = backend.upload(&picture.diffuse)?;
    let input = backend.upload(&picture.input)?;
    let before = garbage(length);
    let mut output = backend.upload(&before)?;
    match backend.filter_indirect(&gbuffer, &diffuse, &input, &picture.params, &mut output) {
        Err(Error::InvalidInput { .. }) => {}
        Err(other) => return Err(other.into()),
        Ok(()) => return Err(Failure::Mismatch("not refused".into())),
    }
    exact(cx, "a refused output", &backend.download(&output)?, &before, Shape::Line)
}

fn bad_parameters_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let sound = some_wall();
    let with = |change: fn(&mut FilterIndirectParams)| {
        let mut params = sound.params;
        change(&mut params);
        params
    };
    for params in [
        with(|p| p.window = 0),
        with(|p| p.window = MAX_WINDOW + 1),
        with(|p| p.window = u32::MAX),
        with(|p| p.least_cosine = f32::NAN),
        with(|p| p.least_cosine = f32::NEG_INFINITY),
        with(|p| p.footprint = f32::NAN),
        with(|p| p.footprint = f32::INFINITY),
    ] {
        let picture = Picture { params, ..sound.clone() };
        refused(cx, &picture, 20).map_err(|f| f.within(&format!("{params:?}")))?;
    }
    // Without pixels too.
    let params = FilterIndirectParams { width: 0, window: 0, ..sound.params };
    refused(cx, &Picture { params, gbuffer: Vec::new(), diffuse: Vec::new(), input: Vec::new() }, 0)?;
    // A refused call leaves the backend as it was.
    agrees(cx, &sound)
}

/// Of any of the three buffers; and sizes whose product is small modulo 2³².
fn lengths_must_agree<B: Backend>(cx: &Context<'_, B>) -> Check {
    let sound = some_wall();
    let of = |texels: usize, lights: usize| Picture {
        gbuffer: vec![sound.gbuffer[0]; texels],
        input: vec![radiance([1.0; 3]); lights],
        ..sound.clone()
    };
    for other in [0, 19, 21, 40] {
        for (name, picture, length) in
            [("gbuffer", of(other, 20), 20), ("input", of(20, other), 20), ("output", of(20, 20), other)]
        {
            refused(cx, &picture, length).map_err(|f| f.within(&format!("{name} of {other}")))?;
        }
    }
    for (width, height, length) in [(65_536, 65_536, 0), (u32::MAX, u32::MAX, 1), (1 << 31, 2, 0), (4, 5, 19)]
    {
        let picture = of(length, length);
        let params = FilterIndirectParams { width, height, ..sound.params };
        let picture = Picture { params, ..picture };
        refused(cx, &picture, length).map_err(|f| f.within(&format!("{width} x {height}")))?;
    }
    Ok(())
}
