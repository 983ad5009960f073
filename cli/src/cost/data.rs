//! What a study found, as JSON: what the page shows and what `cost.json` holds.

use super::base64;
use super::command;
use super::kernels;
use super::records::{Parts, Point};
use super::study::Study;
use crate::budget::Probe;
use crate::exit::Failure;
use serde_json::{Map, Value, json};
use twinlight::BackendInfo;
use twinlight::methods::cost::{Errors, KNOBS, METHODS, METRICS, front};
use twinlight::methods::post::metrics::Metric;

/// A study, and how it is told.
pub struct Told<'a> {
    pub study: &'a Study<'a>,
    pub info: BackendInfo,
    pub is_complete: bool,
    /// What tells the scene from others.
    pub look: Probe,
}

impl Told<'_> {
    /// The whole, with pictures.
    ///
    /// # Errors
    /// Those of the reference's noise and of the PNG encoder.
    pub fn json(&self) -> Result<Value, Failure> {
        let (study, setup) = (self.study, self.study.setup);
        let args = setup.args;
        let points: Vec<&Point> = study.records.points().collect();
        let fronts = Fronts::of(&points);
        let of_point = |(id, point): (usize, &&Point)| self.point(id, point, &fronts);
        let mode = if self.info.strict { "strict" } else { "portable" };
        Ok(json!({
            "twinlight": env!("CARGO_PKG_VERSION"),
            "command": command::asked(),
            "finished": self.is_complete,
            "scene": { "source": args.scene, "triangles": setup.prepared.scene.triangle_count() },
            "size": [args.size.0, args.size.1],
            "bounces": setup.bounces,
            "seed": args.seed,
            "backend": { "kind": self.info.kind, "device": self.info.device, "driver": self.info.driver, "mode": mode },
            "display": format!("exposure {} stops, curve {}", args.tone.exposure, args.tone.tonemap.key()),
            "reference": self.reference()?,
            "look": { "noise": self.look.noise, "indirect": self.look.indirect },
            "metrics": METRICS.map(metric),
            "methods": METHODS.iter().filter(|(key, _)| self.is_told(key))
                .map(|(key, title)| json!({ "key": key, "title": title })).collect::<Vec<_>>(),
            "knobs": self.knobs(),
            "points": points.iter().enumerate().map(of_point).collect::<Vec<_>>(),
            "split": study.splits_known().flat_map(|parts| self.split(parts, &points)).collect::<Vec<_>>(),
            "kernels": kernels::json(&points),
        }))
    }

    fn reference(&self) -> Result<Value, Failure> {
        let (judge, setup) = (self.study.judge, self.study.setup);
        let noise = judge.reference.noise(&setup.tone).map_err(Failure::Pictures)?;
        Ok(json!({
            "spp": judge.taken.map(|taken| taken.samples),
            "seconds": judge.taken.map(|taken| taken.seconds),
            "image": inlined(&self.study.pictures.png(judge.reference.image())?),
            "noise": by_metric(noise.map_or([None; METRICS.len()], |noise| noise.map(Some))),
        }))
    }

    /// Whether a method was asked for, or measured by an earlier run.
    fn is_told(&self, method: &str) -> bool {
        let mut points = self.study.records.points();
        self.study.methods.contains(&method) || points.any(|point| point.setting.method == method)
    }

    fn knobs(&self) -> Vec<Value> {
        let knobs = KNOBS.iter().filter(|knob| knob.method == "all" || self.is_told(knob.method));
        knobs
            .map(|knob| {
                json!({
                    "method": knob.method, "flag": knob.flag, "unit": knob.unit, "default": knob.default,
                    "range": knob.range, "trades": knob.trades,
                })
            })
            .collect()
    }

    fn point(&self, id: usize, point: &Point, fronts: &Fronts) -> Value {
        let (all, own) = (fronts.all(id), fronts.own(id));
        let is_shown = !all.is_empty() || !own.is_empty();
        let image = is_shown.then(|| self.study.pictures.kept(&point.setting)).flatten();
        json!({
            "id": id,
            "method": point.setting.method,
            "settings": point.setting.flags,
            "command": self.command(id, point),
            "seconds": {
                "median": point.seconds.median, "least": point.seconds.least, "most": point.seconds.most, "runs": point.runs,
            },
            "steps": point.steps.iter()
                .map(|step| json!({ "name": step.name, "calls": step.calls, "seconds": step.seconds })).collect::<Vec<_>>(),
            "bytes": point.bytes,
            "errors": by_metric(point.errors),
            "front": all,
            "method_front": own,
            "image": image.map(|png| inlined(&png)),
        })
    }

    fn command(&self, id: usize, point: &Point) -> Option<String> {
        let setting = point.setting.setting()?;
        let (method, flags) = (setting.method(), setting.flags());
        let setup = self.study.setup;
        Some(setup.render(method, flags, setup.args.seed).line(&format!("{method}-{id}.exr")))
    }

    fn split(&self, parts: &Parts, points: &[&Point]) -> Vec<Value> {
        let point = points.iter().position(|point| point.setting == parts.setting);
        let which = if parts.setting.is_finest() {
            "finest setting"
        } else {
            "most accurate setting that was measured"
        };
        let of_metric = |(metric, [bias, error, noise]): &(String, [f64; 3])| {
            let is_known = self.study.judge.taken.is_some();
            let floor = if is_known { "" } else { "; noise of the reference counts as bias" };
            json!({
                "method": parts.setting.method, "point": point, "metric": metric,
                "total": bias + noise, "bias": bias, "noise": noise,
                "how": format!("two seeds of the {which}; bias to within {error:.1e}{floor}"),
            })
        };
        parts.parts.iter().map(of_metric).collect()
    }
}

/// Takes the pictures out, which only the page needs.
pub fn without_pictures(mut study: Value) -> Value {
    study["reference"]["image"] = Value::Null;
    for point in study["points"].as_array_mut().into_iter().flatten() {
        point["image"] = Value::Null;
    }
    study
}

fn metric(metric: Metric) -> Value {
    let better = match metric {
        Metric::Mssim | Metric::Psnr => "higher",
        Metric::RadianceRatio => "one",
        Metric::Mae | Metric::Mse | Metric::Nrmse | Metric::RelMse | Metric::Flip => "lower",
    };
    json!({ "key": metric.key(), "name": metric.name(), "formula": metric.formula(), "better": better })
}

fn by_metric(values: [Option<f64>; METRICS.len()]) -> Value {
    let pairs = METRICS.iter().zip(values).map(|(metric, value)| (metric.key().to_owned(), json!(value)));
    Value::Object(pairs.collect::<Map<_, _>>())
}

fn inlined(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", base64::encode(png))
}

/// Which points are on which fronts.
pub struct Fronts {
    all: Vec<[bool; METRICS.len()]>,
    own: Vec<[bool; METRICS.len()]>,
}

impl Fronts {
    /// Of all points, and of those of each method.
    pub fn of(points: &[&Point]) -> Self {
        let none = vec![[false; METRICS.len()]; points.len()];
        let mut fronts = Self { all: none.clone(), own: none };
        let everything: Vec<usize> = (0..points.len()).collect();
        mark(&mut fronts.all, points, &everything);
        for (method, _) in METHODS {
            let of_method = everything.iter().copied().filter(|&id| points[id].setting.method == method);
            mark(&mut fronts.own, points, &of_method.collect::<Vec<_>>());
        }
        fronts
    }

    /// Metrics for which a point is on the front of all.
    pub fn all(&self, id: usize) -> Vec<&'static str> {
        keys(&self.all[id])
    }

    /// Metrics for which it is on that of its method.
    pub fn own(&self, id: usize) -> Vec<&'static str> {
        keys(&self.own[id])
    }
}

fn keys(flags: &[bool; METRICS.len()]) -> Vec<&'static str> {
    METRICS.iter().zip(flags).filter(|(_, flag)| **flag).map(|(metric, _)| metric.key()).collect()
}

fn mark(fronts: &mut [[bool; METRICS.len()]], points: &[&Point], chosen: &[usize]) {
    let distances: Vec<Errors> = chosen.iter().map(|&id| points[id].distances()).collect();
    for metric in 0..METRICS.len() {
        let places = chosen
            .iter()
            .zip(&distances)
            .map(|(&id, distances)| (points[id].seconds.median, distances[metric]));
        let on_front = front(&places.collect::<Vec<_>>());
        chosen.iter().zip(on_front).for_each(|(&id, on_front)| fronts[id][metric] = on_front);
    }
}
