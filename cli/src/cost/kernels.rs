//! The options of one kernel beside each other, from the settings that differ from the first in one knob.

use super::records::{Point, Times};
use serde_json::{Value, json};
use twinlight::methods::cost::knobs::swept;
use twinlight::methods::cost::{Knob, METHODS, METRICS, Setting};

/// What is no call at all takes no time.
const NO_TIME: Times = Times { median: 0.0, least: 0.0, most: 0.0 };

/// A table per knob that sets a kernel's cost and of which two values were measured.
pub fn json(points: &[&Point]) -> Vec<Value> {
    let knobs = METHODS.iter().flat_map(|(method, _)| swept(method).map(move |(knob, _)| (*method, knob)));
    knobs
        .filter(|(_, knob)| !knob.kernel.is_empty())
        .filter_map(|(method, knob)| table(method, knob, points))
        .collect()
}

fn table(method: &'static str, knob: &Knob, points: &[&Point]) -> Option<Value> {
    let begin = Setting::begin(method);
    let values = knob.sweep?.values;
    let variant = |value: &&str| {
        let is_it = |point: &&&Point| {
            let setting = point.setting.setting();
            setting
                .is_some_and(|s| s.differs_only_in(&begin, knob.flag) && s.value(knob.flag) == Some(*value))
        };
        points.iter().find(is_it).map(|point| of_point(value, knob.kernel, point))
    };
    let variants: Vec<Value> = values.iter().filter_map(variant).collect();
    (variants.len() > 1).then(|| {
        json!({
            "kernel": knob.kernel, "what": format!("{} trades {}", knob.flag, knob.trades), "metric": METRICS[0].key(),
            "variants": variants,
        })
    })
}

fn of_point(value: &str, kernel: &str, point: &Point) -> Value {
    let seconds = point.steps.iter().find(|step| step.name == kernel).map_or(NO_TIME, |step| step.spread);
    json!({ "name": value, "seconds": seconds, "error": point.errors[0], "bytes": point.bytes })
}
