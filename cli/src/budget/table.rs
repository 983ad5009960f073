//! What was measured before: `cost.json` of a scene, or what twinlight comes with.

use serde_json::Value;
use twinlight::methods::budget::Curve;

/// A scene and what its pictures cost.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// As on the command line.
    pub scene: String,
    /// Of the scene.
    pub triangles: f64,
    /// relMSE of one independent sample per pixel, and the share of light that was scattered more than once, where they were looked at.
    pub look: Option<Look>,
    /// Methods and settings, without the number of samples.
    pub rows: Vec<Row>,
}

/// What tells scenes apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// relMSE of one independent sample per pixel.
    pub noise: f64,
    /// Share of the light that was scattered more than once.
    pub indirect: f64,
}

/// Knobs with their values, as on the command line.
pub type Flags = Vec<(String, String)>;

/// A method with all knobs set but the number of samples. Times are seconds of the machine it was measured on.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// As on the command line.
    pub method: String,
    /// Its knobs, as on the command line.
    pub flags: Flags,
    /// What is built, however large the picture is.
    pub build: f64,
    /// What is done once per pixel.
    pub per_pixel: f64,
    /// Per sample of a pixel.
    pub per_sample: f64,
    /// Of relMSE.
    pub relmse: Curve,
    /// Of ꟻLIP.
    pub flip: Curve,
    /// Fewest and most samples that were measured.
    pub samples: (u32, u32),
}

/// Measured with one number of samples.
struct Point {
    samples: u32,
    build: f64,
    once: f64,
    sampling: f64,
    relmse: f64,
    flip: f64,
}

/// Kernels whose work depends on the scene and on knobs, and not on pixels. What is no kernel counts with the pixels: transfers and the host's work on pictures.
const BUILDING: [&str; 13] = [
    "upload_scene",
    "upload_mesh",
    "rasterize_lhb",
    "merge_lhb",
    "pack_lhb",
    "unpack_lhb",
    "voxelize",
    "sum_voxels",
    "voxel_levels",
    "light_voxels",
    "reduce_mips",
    "scan",
    "sort",
];

/// Kernels whose work is in proportion to samples.
const SAMPLING: [&str; 2] = ["trace_paths", "walk_lhb"];

impl Table {
    /// Of `cost.json`; `None` where it doesn't say what a table needs.
    pub fn of_json(json: &Value) -> Option<Self> {
        let pixels = json["size"][0].as_f64()? * json["size"][1].as_f64()?;
        let mut groups: Vec<(String, Flags, Vec<Point>)> = Vec::new();
        for point in json["points"].as_array()? {
            let Some((method, flags, point)) = read_point(point) else { continue };
            match groups.iter_mut().find(|(m, f, _)| *m == method && *f == flags) {
                Some((_, _, points)) => points.push(point),
                None => groups.push((method, flags, vec![point])),
            }
        }
        let rows =
            groups.into_iter().filter_map(|(method, flags, points)| row(method, flags, &points, pixels));
        let rows: Vec<Row> = rows.collect();
        let scene = json["scene"]["source"].as_str()?.to_owned();
        let triangles = json["scene"]["triangles"].as_f64()?;
        let noise = json["look"]["noise"].as_f64();
        let look = noise.zip(json["look"]["indirect"].as_f64());
        let look = look.map(|(noise, indirect)| Look { noise, indirect });
        (!rows.is_empty()).then_some(Self { scene, triangles, look, rows })
    }

    /// The reference tracer's row.
    pub fn reference(&self) -> Option<&Row> {
        self.rows.iter().find(|row| row.method == "reference")
    }
}

fn read_point(json: &Value) -> Option<(String, Flags, Point)> {
    let mut flags = Flags::new();
    let mut samples = None;
    for pair in json["settings"].as_array()? {
        let (flag, value) = (pair[0].as_str()?, pair[1].as_str()?);
        if flag == "--spp" { samples = value.parse().ok() } else { flags.push((flag.into(), value.into())) }
    }
    let step = |step: &Value| Some((step["name"].as_str()?.to_owned(), step["seconds"].as_f64()?));
    let steps: Vec<(String, f64)> = json["steps"].as_array()?.iter().filter_map(step).collect();
    let of = |names: &[&str]| {
        steps
            .iter()
            .filter(|(name, _)| names.contains(&name.as_str()))
            .map(|(_, seconds)| seconds)
            .sum::<f64>()
    };
    // A gather's samples are the directions of its set, and no other number is possible.
    if flags.contains(&("--gather".into(), "all".into())) {
        return None;
    }
    let (build, sampling) = (of(&BUILDING), of(&SAMPLING));
    let once = (json["seconds"]["median"].as_f64()? - build - sampling).max(0.0);
    let error = |key: &str| json["errors"][key].as_f64().unwrap_or(f64::NAN);
    let point =
        Point { samples: samples?, build, once, sampling, relmse: error("relmse"), flip: error("flip") };
    Some((json["method"].as_str()?.to_owned(), flags, point))
}

fn row(method: String, flags: Flags, points: &[Point], pixels: f64) -> Option<Row> {
    let mean = |of: fn(&Point) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let samples: f64 = points.iter().map(|point| f64::from(point.samples)).sum();
    let sampling: f64 = points.iter().map(|point| point.sampling).sum();
    let counts = || points.iter().map(|point| point.samples);
    let curve = |of: fn(&Point) -> f64, of_roots| {
        let measured: Vec<(u32, f64)> = points.iter().map(|point| (point.samples, of(point))).collect();
        Curve::through(&measured, of_roots)
    };
    Some(Row {
        method,
        flags,
        build: mean(|point| point.build),
        per_pixel: mean(|point| point.once) / pixels,
        per_sample: sampling / (samples * pixels),
        relmse: curve(|point| point.relmse, false)?,
        flip: curve(|point| point.flip, true)?,
        samples: (counts().min()?, counts().max()?),
    })
}

/// What was measured in builtin scenes, in the order of their triangles.
pub fn shipped() -> Vec<Table> {
    let json: Value = serde_json::from_str(include_str!("shipped.json")).unwrap_or_default();
    let mut tables: Vec<Table> = json.as_array().into_iter().flatten().filter_map(Table::of_json).collect();
    tables.sort_by(|a, b| a.triangles.total_cmp(&b.triangles));
    tables
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn samples_are_no_knob_of_a_row() {
        let point = |spp: &str, trace: f64, relmse: f64| {
            json!({
                "method": "slhb", "settings": [["--spp", spp], ["--directions", "80"]],
                "seconds": { "median": 0.5 + trace + 0.25 },
                "steps": [{ "name": "rasterize_lhb", "seconds": 0.5 }, { "name": "walk_lhb", "seconds": trace }],
                "errors": { "relmse": relmse, "flip": 0.1 },
            })
        };
        let json = json!({
            "scene": { "source": "a", "triangles": 7 }, "size": [10, 20],
            "points": [point("4", 0.4, 0.3), point("16", 1.6, 0.15)],
        });
        let table = Table::of_json(&json).unwrap();
        let [row] = &table.rows[..] else { panic!("one row: {table:?}") };
        assert_eq!((row.method.as_str(), row.flags.len()), ("slhb", 1));
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
        assert!(
            near(row.build, 0.5) && near(row.per_pixel, 0.25 / 200.0) && near(row.per_sample, 0.1 / 200.0)
        );
        assert!(near(row.relmse.bias, 0.1) && near(row.relmse.noise, 0.8), "{:?}", row.relmse);
        assert_eq!(Table::of_json(&json!({ "size": [1, 1], "points": [] })), None);
    }

    /// What twinlight comes with has every method in every scene, and rows that can be chosen.
    #[test]
    fn shipped_tables_are_complete() {
        let tables = shipped();
        assert!(tables.len() >= 2, "scenes of few and of many triangles");
        for table in &tables {
            assert!(table.reference().is_some(), "{}", table.scene);
            for method in ["reference", "slhb", "voxel"] {
                let rows = table.rows.iter().filter(|row| row.method == method);
                assert!(rows.clone().count() > 0, "{}: {method}", table.scene);
                for row in rows {
                    assert!(row.per_sample > 0.0 && row.build >= 0.0 && row.per_pixel >= 0.0, "{row:?}");
                }
            }
        }
    }
}
