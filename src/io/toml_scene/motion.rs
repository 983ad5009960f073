//! Keyframes of placements.

use super::document::{InstanceTable, KeyframeTable};
use super::place;
use super::source::Source;
use glam::{DQuat, DVec3};
use toml::Spanned;
use twinlight_core::scene::motion::{Curve, Interpolation, Keyed, Track};
use twinlight_core::{Error, Result};

/// Angle between keyframes that a rotation takes as it is written, degrees; more is cut into such parts, because between two
/// rotations alone the shortest turn is meant.
const QUARTER: f64 = 90.0;
/// Quarter turns between two keyframes, at most.
const MAX_QUARTERS: f64 = 4096.0;
/// A time and a rotation, twice: in the list and in the curve.
const KEY_BYTES: u64 = 2 * 48;

/// A placement that moves.
pub(super) struct Moving {
    pub track: Track,
    /// Seconds to the last keyframe.
    pub duration: f64,
    /// What it holds.
    pub bytes: u64,
}

/// The motion of an instance table, if it has one, in at most `max_bytes`. What no keyframe gives stays as the table has it.
pub(super) fn moving(table: &InstanceTable, source: &Source<'_>, max_bytes: u64) -> Result<Option<Moving>> {
    let (Some(first), Some(last)) = (table.motion.first(), table.motion.last()) else { return Ok(None) };
    if table.matrix.is_some() {
        let what = "a placement by a matrix can't have keyframes: use translate, rotate and scale";
        return Err(source.error(&first.span(), what));
    }
    for pair in table.motion.windows(2) {
        let (before, after) = (pair[0].get_ref().time, pair[1].get_ref().time);
        if !(before < after) {
            let what = format!("times of keyframes must increase: {before}, then {after}");
            return Err(source.error(&pair[1].span(), what));
        }
    }
    for key in &table.motion {
        let KeyframeTable { translate, rotate, scale, .. } = key.get_ref();
        if translate.is_none() && rotate.is_none() && scale.is_none() {
            return Err(source.error(&key.span(), "a keyframe needs translate, rotate or scale"));
        }
    }
    let keys = |pick: fn(&KeyframeTable) -> Option<DVec3>| -> Vec<(f64, DVec3)> {
        let key = |key: &Spanned<KeyframeTable>| Some((key.get_ref().time, pick(key.get_ref())?));
        table.motion.iter().filter_map(key).collect()
    };
    let translations = keys(|key| key.translate.map(DVec3::from));
    let scales = keys(|key| key.scale.map(|scale| DVec3::from(scale.0)));
    let turns = rotations(table, source, max_bytes)?;
    let bytes = (turns.len() + translations.len() + scales.len()) as u64 * KEY_BYTES;
    let curves = || -> Result<Track> {
        Ok(Track {
            translation: curve(translations, table.translate.map_or(DVec3::ZERO, DVec3::from))?,
            rotation: curve(turns, DQuat::from_mat3(&place::rotation(table, source)?))?,
            scale: curve(scales, table.scale.map_or(DVec3::ONE, |scale| DVec3::from(scale.0)))?,
        })
    };
    let track = curves().map_err(|error| match error {
        Error::InvalidInput { place, what } if place == "keyframes" => source.error(&first.span(), what),
        other => other,
    })?;
    Ok(Some(Moving { track, duration: last.get_ref().time, bytes }))
}

/// A curve through keyframes, or `rest` without any.
fn curve<T: Keyed>(keys: Vec<(f64, T)>, rest: T) -> Result<Curve<T>> {
    if keys.is_empty() {
        return Ok(Curve::constant(rest));
    }
    let (times, values) = keys.into_iter().unzip();
    Curve::new(Interpolation::Linear, times, values)
}

/// The rotations of the keyframes. Two in a row about one axis turn through the angles between theirs, however many; about
/// different axes, by the shortest turn.
fn rotations(table: &InstanceTable, source: &Source<'_>, max_bytes: u64) -> Result<Vec<(f64, DQuat)>> {
    let mut keys: Vec<(f64, DQuat)> = Vec::new();
    let mut last: Option<(f64, DVec3, f64)> = None;
    for key in &table.motion {
        let Some(rotate) = &key.get_ref().rotate else { continue };
        let (time, angle) = (key.get_ref().time, rotate.angle);
        let Some(axis) = DVec3::from(rotate.axis).try_normalize() else {
            return Err(source.error(&key.span(), format!("axis {:?} has no direction", rotate.axis)));
        };
        if let Some((before, _, from)) = last.filter(|(_, previous, _)| *previous == axis) {
            let quarters = ((angle - from).abs() / QUARTER).ceil();
            if !(quarters <= MAX_QUARTERS) {
                let what = format!("turns by {} degrees, more than {}", angle - from, MAX_QUARTERS * QUARTER);
                return Err(source.error(&key.span(), what));
            }
            let needed = (keys.len() as u64 + quarters as u64) * KEY_BYTES;
            if needed > max_bytes {
                return Err(Error::limit("bytes of the scene's keyframes", needed, max_bytes));
            }
            for i in 1..quarters as u32 {
                let share = f64::from(i) / quarters;
                let between = |a: f64, b: f64| a + (b - a) * share;
                keys.push((between(before, time), turn(axis, between(from, angle))));
            }
        }
        keys.push((time, turn(axis, angle)));
        last = Some((time, axis, angle));
    }
    Ok(keys)
}

fn turn(axis: DVec3, degrees: f64) -> DQuat {
    DQuat::from_axis_angle(axis, degrees.to_radians())
}
