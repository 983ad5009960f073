//! Which setting to measure next.

use super::{Setting, front};
use std::collections::HashSet;

/// Most settings of a method that are all measured.
const SMALL: usize = 32;

/// A setting that was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// What.
    pub setting: Setting,
    /// Time of a render; not a number where it failed.
    pub seconds: f64,
    /// Distances from a perfect picture, by the metrics whose fronts are looked for.
    pub errors: Vec<f64>,
    /// Time that measuring it took, all renders together.
    pub spent: f64,
}

/// A search for the settings that are worth their time.
///
/// Of every method first the setting where its sweep begins, the coarsest and the finest, and then all that differ from the first in one knob: they show what
/// each knob does. Methods with few settings are measured in full. Of others, coordinate descent: neighbours of what is on the method's front
/// so far, until all of them are measured. Methods get the same time. What comes next follows from what is there alone, so that a sweep that was
/// stopped goes on as if it had not been.
#[derive(Debug, Clone)]
pub struct Sweep {
    methods: Vec<Opening>,
    explores: bool,
}

/// What is measured of a method whatever comes out.
#[derive(Debug, Clone)]
struct Opening {
    method: &'static str,
    settings: Vec<Setting>,
}

impl Sweep {
    /// Of these methods, as [`super::METHODS`] calls them.
    pub fn new(methods: &[&'static str]) -> Self {
        let methods = methods.iter().map(|&method| {
            let mut settings =
                vec![Setting::begin(method), Setting::coarsest(method), Setting::finest(method)];
            settings.extend(Setting::all(method, SMALL).unwrap_or_else(|| Setting::begin(method).star()));
            Opening { method, settings: once(settings) }
        });
        Self { methods: methods.collect(), explores: true }
    }

    /// Two settings of each method, for a first look: where its sweep begins, and the coarsest.
    pub fn quick(methods: &[&'static str]) -> Self {
        let methods = methods.iter().map(|&method| Opening {
            method,
            settings: once(vec![Setting::begin(method), Setting::coarsest(method)]),
        });
        Self { methods: methods.collect(), explores: false }
    }

    /// The setting to measure next; `None` when nothing is left to try.
    pub fn next(&self, tried: &[Tried]) -> Option<Setting> {
        let known: HashSet<&Setting> = tried.iter().map(|tried| &tried.setting).collect();
        let spent = |method| of(tried, method).map(|tried| tried.spent).sum::<f64>();
        let mut candidates: Vec<(bool, f64, Setting)> = Vec::new();
        for opening in &self.methods {
            let planned = opening.settings.iter().find(|setting| !known.contains(setting));
            let found = match planned {
                Some(setting) => Some((false, setting.clone())),
                None if self.explores => {
                    explore(opening.method, tried, &known).map(|setting| (true, setting))
                }
                None => None,
            };
            candidates.extend(found.map(|(late, setting)| (late, spent(opening.method), setting)));
        }
        // Openings before exploring, and the method that had least time so far; the first of equal ones.
        candidates.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        candidates.into_iter().next().map(|(_, _, setting)| setting)
    }

    /// How many settings are to come whatever comes out; exploring may add to them.
    pub fn planned(&self, tried: &[Tried]) -> usize {
        let known: HashSet<&Setting> = tried.iter().map(|tried| &tried.setting).collect();
        let settings = self.methods.iter().flat_map(|opening| &opening.settings);
        settings.filter(|setting| !known.contains(setting)).count()
    }
}

/// In order, without repetitions.
fn once(settings: Vec<Setting>) -> Vec<Setting> {
    let mut seen = HashSet::new();
    settings.into_iter().filter(|setting| seen.insert(setting.clone())).collect()
}

fn of<'a>(tried: &'a [Tried], method: &'a str) -> impl Iterator<Item = &'a Tried> {
    tried.iter().filter(move |tried| tried.setting.method() == method)
}

/// A neighbour of the point on a front of which most are known already is not as telling as one of a point whose surroundings are unknown.
fn explore(method: &'static str, tried: &[Tried], known: &HashSet<&Setting>) -> Option<Setting> {
    let mut best: Option<(usize, f64, Setting)> = None;
    for point in on_fronts(&of(tried, method).collect::<Vec<_>>()) {
        let neighbours = point.setting.neighbours();
        let explored = neighbours.iter().filter(|setting| known.contains(setting)).count();
        let Some(unknown) = neighbours.into_iter().find(|setting| !known.contains(setting)) else { continue };
        if best.as_ref().is_none_or(|(least, seconds, _)| (explored, point.seconds) < (*least, *seconds)) {
            best = Some((explored, point.seconds, unknown));
        }
    }
    best.map(|(_, _, setting)| setting)
}

/// Those on the front of any metric.
fn on_fronts<'a>(tried: &[&'a Tried]) -> Vec<&'a Tried> {
    let metrics = tried.iter().map(|tried| tried.errors.len()).max().unwrap_or(0);
    let mut chosen = vec![false; tried.len()];
    for metric in 0..metrics {
        let place = |tried: &&Tried| (tried.seconds, tried.errors.get(metric).copied().unwrap_or(f64::NAN));
        let on_front = front(&tried.iter().map(place).collect::<Vec<_>>());
        chosen.iter_mut().zip(on_front).for_each(|(chosen, on_front)| *chosen |= on_front);
    }
    tried.iter().zip(chosen).filter(|(_, chosen)| *chosen).map(|(tried, _)| *tried).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::knobs::swept;

    /// A made-up cost: finer is slower and better, and cones are worth nothing.
    fn measured(setting: Setting) -> Tried {
        let (mut seconds, mut error) = (1.0, 1.0);
        for (knob, range) in swept(setting.method()) {
            let place = range.values.iter().position(|value| Some(*value) == setting.value(knob.flag));
            let steps = place.unwrap() as f64;
            seconds += steps;
            error /= if knob.flag == "--cones" { 1.0 } else { 1.0 + steps };
        }
        Tried { setting, seconds, errors: vec![error], spent: seconds }
    }

    fn run(sweep: &Sweep, most: usize) -> Vec<Tried> {
        let mut tried = Vec::new();
        while tried.len() < most {
            let Some(setting) = sweep.next(&tried) else { break };
            assert!(tried.iter().all(|known: &Tried| known.setting != setting), "{setting:?} twice");
            tried.push(measured(setting));
        }
        tried
    }

    #[test]
    fn methods_of_few_settings_are_measured_in_full() {
        let sweep = Sweep::new(&["reference"]);
        let tried = run(&sweep, 100);
        assert_eq!(tried.len(), 5);
        assert_eq!((sweep.planned(&[]), sweep.planned(&tried)), (5, 0));
    }

    #[test]
    fn a_quick_look_is_two_settings_of_each() {
        assert_eq!(run(&Sweep::quick(&["reference", "slhb", "voxel"]), 100).len(), 6);
    }

    /// At the end no neighbour of a point on the front is unknown, and the front is that of the whole grid.
    #[test]
    fn descent_finds_the_front_of_the_grid() {
        let sweep = Sweep::new(&["voxel"]);
        let tried = run(&sweep, 1000);
        let all: Vec<Tried> = Setting::all("voxel", 1000).unwrap().into_iter().map(measured).collect();
        assert!(tried.len() < all.len() / 2, "{} of {}", tried.len(), all.len());
        let places = |points: &[Tried]| {
            let mut places: Vec<(f64, f64)> = on_fronts(&points.iter().collect::<Vec<_>>())
                .iter()
                .map(|point| (point.seconds, point.errors[0]))
                .collect();
            places.sort_by(|a, b| a.0.total_cmp(&b.0));
            places.dedup();
            places
        };
        assert!(places(&all).len() > 5);
        assert_eq!(places(&tried), places(&all));
    }

    #[test]
    fn what_comes_next_does_not_depend_on_the_order() {
        let sweep = Sweep::new(&["voxel", "slhb"]);
        let mut tried = run(&sweep, 70);
        let next = sweep.next(&tried);
        tried.reverse();
        assert_eq!(sweep.next(&tried), next);
        assert!(next.is_some());
    }

    #[test]
    fn methods_get_the_same_time() {
        let tried = run(&Sweep::new(&["slhb", "voxel"]), 120);
        let spent = |method| of(&tried, method).map(|tried| tried.spent).sum::<f64>();
        let (slhb, voxel) = (spent("slhb"), spent("voxel"));
        // Up to one setting, the slowest of which takes 31 of these seconds.
        assert!((slhb - voxel).abs() < 32.0, "{slhb} {voxel}");
    }

    /// What failed is not tried again, and has no neighbours worth looking at.
    #[test]
    fn failures_end_where_they_are() {
        let sweep = Sweep::new(&["voxel"]);
        let mut tried = Vec::new();
        while let Some(setting) = sweep.next(&tried) {
            tried.push(Tried { setting, seconds: f64::NAN, errors: vec![f64::NAN], spent: 0.1 });
        }
        assert_eq!(tried.len(), 2 + Setting::begin("voxel").star().len() + 1);
    }
}
