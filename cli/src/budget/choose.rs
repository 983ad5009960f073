//! From tables, a look at the scene and a wish to a setting.

use super::probe::Probe;
use super::table::{Row, Table};
use std::time::Duration;
use twinlight::methods::budget::{Candidate, Choice, Curve, best_within, quickest, quickest_for};

/// What a person wants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wish {
    /// The least error within a time.
    Within(Duration),
    /// The least time for a ꟻLIP.
    Flip(f64),
}

/// What follows from it.
#[derive(Debug, Clone, PartialEq)]
pub struct Chosen {
    /// As on the command line.
    pub method: String,
    /// Its knobs.
    pub flags: Vec<(String, String)>,
    /// Samples per pixel.
    pub samples: u32,
    /// Seconds that it is expected to take.
    pub seconds: f64,
    /// Expected relMSE.
    pub relmse: f64,
    /// Expected ꟻLIP.
    pub flip: f64,
    /// Seconds after sampling that are expected.
    pub after: f64,
    /// Whether the wish can be granted.
    pub is_enough: bool,
}

/// What is about the picture, not the method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Subject {
    /// Of the scene.
    pub triangles: f64,
    /// Of the picture.
    pub pixels: f64,
    /// What a look at the scene found.
    pub probe: Probe,
    /// How much longer everything takes here than where shipped tables were measured.
    pub machine: f64,
}

/// Rows as they are expected to be for the subject.
struct Expected<'a> {
    row: &'a Row,
    build: f64,
    once: f64,
    per_sample: f64,
    relmse: Curve,
    flip: Curve,
}

/// The best setting of the scene's own table.
pub fn of_own(table: &Table, subject: &Subject, wish: Wish, method: Option<&str>) -> Option<Chosen> {
    // Same scene: what a sample takes here and there tells machines apart.
    let machine = table.reference().map_or(1.0, |row| subject.probe.per_sample / row.per_sample);
    let expected = table.rows.iter().map(|row| Expected {
        row,
        build: row.build * machine,
        once: row.per_pixel * subject.pixels * machine,
        per_sample: row.per_sample * subject.pixels * machine,
        relmse: row.relmse,
        flip: row.flip,
    });
    chosen(expected.collect(), wish, method)
}

/// The best setting of another scene's table: of the one that is most alike in how much of its light is indirect. Times are scaled by a look at the scene.
pub fn of_shipped(tables: &[Table], subject: &Subject, wish: Wish, method: Option<&str>) -> Option<Chosen> {
    let unlike = |table: &Table| {
        table.look.map_or(f64::INFINITY, |look| (look.indirect - subject.probe.indirect).abs())
    };
    let table = tables.iter().min_by(|a, b| unlike(a).total_cmp(&unlike(b)))?;
    let sampling = subject.probe.per_sample / table.reference()?.per_sample;
    let noise = table.look.map_or(1.0, |look| subject.probe.noise / look.noise);
    let expected = table.rows.iter().map(|row| {
        let growth = building(tables, row, subject.triangles) / building(tables, row, table.triangles);
        Expected {
            row,
            build: row.build * growth * subject.machine,
            once: row.per_pixel * subject.pixels * subject.machine,
            per_sample: row.per_sample * subject.pixels * sampling,
            relmse: Curve { noise: row.relmse.noise * noise, ..row.relmse },
            flip: Curve { noise: row.flip.noise * noise.sqrt(), ..row.flip },
        }
    });
    chosen(expected.collect(), wish, method)
}

/// Time to build what a row's method builds for so many triangles: on the line through the two scenes next to that number, by the mean over settings that were measured in
/// both; the same for all settings of a method.
fn building(tables: &[Table], row: &Row, triangles: f64) -> f64 {
    let mean = |table: &Table| {
        let builds =
            table.rows.iter().filter(|other| other.method == row.method && is_everywhere(tables, other));
        let (sum, count) = builds.fold((0.0, 0.0), |(sum, count), other| (sum + other.build, count + 1.0));
        (table.triangles, if count > 0.0 { sum / count } else { row.build })
    };
    let points: Vec<(f64, f64)> = tables.iter().map(mean).collect();
    let next = points.iter().position(|point| point.0 > triangles).unwrap_or(points.len());
    let last = points.len().saturating_sub(1);
    let (low, high) = (
        points[next.saturating_sub(1).min(last.saturating_sub(1))],
        points[next.clamp(1, last.max(1)).min(last)],
    );
    let slope = if high.0 > low.0 { (high.1 - low.1) / (high.0 - low.0) } else { 0.0 };
    // Times are no less than those of the smallest scene, whatever its neighbours' noise says.
    (low.1 + slope * (triangles - low.0)).max(points[0].1).max(1e-6)
}

fn is_everywhere(tables: &[Table], row: &Row) -> bool {
    let is_same = |other: &Row| other.method == row.method && other.flags == row.flags;
    tables.iter().all(|table| table.rows.iter().any(is_same))
}

fn chosen(expected: Vec<Expected>, wish: Wish, method: Option<&str>) -> Option<Chosen> {
    let expected: Vec<Expected> =
        expected.into_iter().filter(|e| method.is_none_or(|method| e.row.method == method)).collect();
    let candidates = |of: fn(&Expected) -> Curve| -> Vec<Candidate> {
        let candidate = |e: &Expected| Candidate {
            fixed: e.build + e.once,
            per_sample: e.per_sample,
            least_samples: e.row.samples.0,
            error: of(e),
        };
        expected.iter().map(candidate).collect()
    };
    let all = candidates(|e| e.relmse);
    let found = match wish {
        Wish::Within(time) => best_within(&all, time.as_secs_f64()),
        Wish::Flip(flip) => quickest_for(&candidates(|e| e.flip), flip),
    };
    let is_enough = found.is_some();
    let Choice { candidate, samples, seconds, .. } = found.or_else(|| match wish {
        Wish::Within(_) => quickest(&all),
        Wish::Flip(_) => least_measured(&expected),
    })?;
    let e = &expected[candidate];
    Some(Chosen {
        method: e.row.method.clone(),
        flags: e.row.flags.clone(),
        samples,
        seconds,
        relmse: e.relmse.at(samples),
        flip: e.flip.at(samples),
        after: e.once,
        is_enough,
    })
}

/// What comes nearest to no ꟻLIP at all with as many samples as were measured: more might take hours.
fn least_measured(expected: &[Expected]) -> Option<Choice> {
    let all = expected.iter().enumerate().map(|(candidate, e)| {
        let samples = e.row.samples.1;
        let seconds = e.build + e.once + e.per_sample * f64::from(samples);
        Choice { candidate, samples, seconds, error: e.flip.at(samples) }
    });
    all.min_by(|a, b| a.error.total_cmp(&b.error))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(method: &str, build: f64, per_sample: f64, bias: f64, noise: f64) -> Row {
        let curve = Curve { bias, noise, of_roots: false };
        let flip = Curve { of_roots: true, ..curve };
        Row {
            method: method.into(),
            flags: vec![("--x".into(), "1".into())],
            build,
            per_pixel: 0.0,
            per_sample,
            relmse: curve,
            flip,
            samples: (1, 16),
        }
    }

    fn table(triangles: f64, build: f64) -> Table {
        let rows = vec![row("reference", 0.0, 1e-6, 0.0, 1.0), row("voxel", build, 1e-7, 0.01, 0.01)];
        let look = Some(super::super::table::Look { noise: 2.0, indirect: triangles / 100.0 });
        Table { scene: "a".into(), triangles, look, rows }
    }

    fn subject(triangles: f64) -> Subject {
        let probe = Probe { per_sample: 2e-6, noise: 4.0, indirect: 0.1 };
        Subject { triangles, pixels: 1e4, probe, machine: 2.0 }
    }

    #[test]
    fn own_tables_are_scaled_by_the_machine() {
        let table = table(10.0, 0.1);
        let within = |seconds| {
            let wish = Wish::Within(Duration::from_secs_f64(seconds));
            of_own(&table, &subject(10.0), wish, None).unwrap()
        };
        // Twice as slow: voxels are built in 0.2 s, and a sample takes the reference 0.02 s.
        let little = within(0.1);
        assert_eq!((little.method.as_str(), little.samples), ("reference", 5));
        let some = within(0.3);
        assert_eq!((some.method.as_str(), some.is_enough), ("voxel", true));
        assert!(some.seconds <= 0.3 && some.relmse < 0.011);
        assert_eq!(within(10.0).method, "reference");
        let none = within(0.001);
        assert!(!none.is_enough && none.samples == 1);
    }

    #[test]
    fn shipped_tables_are_scaled_by_the_scene() {
        let tables = [table(10.0, 0.1), table(1000.0, 1.09)];
        let voxel = |triangles| {
            let wish = Wish::Within(Duration::from_secs(100));
            of_shipped(&tables, &subject(triangles), wish, Some("voxel")).unwrap()
        };
        // A millisecond per triangle more, twice as slow; samples are the same.
        let (few, many) = (voxel(10.0), voxel(100.0));
        let sampling = |chosen: &Chosen| f64::from(chosen.samples) * 1e-7 * 2.0 * 1e4;
        assert!((few.seconds - sampling(&few) - 0.2).abs() < 1e-6, "{few:?}");
        assert!((many.seconds - sampling(&many) - 0.38).abs() < 1e-6, "{many:?}");
        // Twice as noisy.
        let reference =
            of_shipped(&tables, &subject(10.0), Wish::Within(Duration::from_secs(2)), Some("reference"));
        let reference = reference.unwrap();
        assert!((reference.relmse - 2.0 / f64::from(reference.samples)).abs() < 1e-9);
    }

    #[test]
    fn targets_that_cannot_be_reached_are_said_so() {
        let table = table(10.0, 0.1);
        let target = |flip, method| of_own(&table, &subject(10.0), Wish::Flip(flip), method).unwrap();
        assert!(target(0.5, None).is_enough);
        assert!(!target(0.005, Some("voxel")).is_enough, "its bias is more");
        assert!(target(0.005, Some("reference")).is_enough);
    }
}
