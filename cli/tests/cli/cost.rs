use crate::{Folder, Run};
use serde_json::Value;

const SMALL: [&str; 10] =
    ["--size", "16x16", "--backend", "cpu", "--quick", "--time-limit", "600", "--out", "study", "--seed"];

fn cost(folder: &Folder, seed: &str, more: &[&str]) -> Run {
    folder.run(&[&["cost", "builtin:cornell"], &SMALL[..], &[seed], more].concat())
}

fn study(folder: &Folder) -> Value {
    serde_json::from_slice(&folder.read("study/cost.json")).unwrap()
}

/// Time and error of a point, 0 of which is a perfect picture.
fn place(point: &Value, metric: &Value) -> (f64, f64) {
    let error = point["errors"][metric["key"].as_str().unwrap()].as_f64().unwrap();
    let error = match metric["better"].as_str().unwrap() {
        "higher" => 1.0 - error,
        "one" => (error - 1.0).abs(),
        _ => error,
    };
    (point["seconds"]["median"].as_f64().unwrap(), error)
}

fn holds(list: &Value, key: &Value) -> bool {
    list.as_array().unwrap().contains(key)
}

#[test]
fn a_study_measures_every_method_and_knows_its_front() {
    let folder = Folder::new();
    let run = cost(&folder, "0", &["--reference-spp", "64"]).ok();
    assert_eq!(run.stdout, "study/cost.html\nstudy/cost.json\nstudy/cost.csv\n");
    let study = study(&folder);
    assert_eq!((&study["finished"], &study["bounces"]), (&true.into(), &4.into()));
    let command = study["command"].as_str().unwrap();
    assert!(command.starts_with("twinlight cost builtin:cornell --size 16x16"), "{command}");
    let splits = study["split"].as_array().unwrap();
    assert_eq!(splits.len(), 3 * 2);
    for split in splits {
        assert!(split["noise"].as_f64().unwrap() > 0.0 && split["bias"].as_f64().unwrap().is_finite());
        let point = &study["points"][split["point"].as_u64().unwrap() as usize];
        assert_eq!(point["method"], split["method"]);
    }
    assert_eq!((&study["reference"]["spp"], &study["reference"]["image"]), (&64.into(), &Value::Null));
    let (points, metrics) = (study["points"].as_array().unwrap(), study["metrics"].as_array().unwrap());
    for method in ["reference", "slhb", "voxel"] {
        assert_eq!(points.iter().filter(|point| point["method"] == method).count(), 2, "{method}");
    }
    for metric in metrics {
        let key = &metric["key"];
        assert!(study["reference"]["noise"][key.as_str().unwrap()].as_f64().unwrap() > 0.0, "{key}");
        let places: Vec<(f64, f64)> = points.iter().map(|point| place(point, metric)).collect();
        for (point, (time, error)) in points.iter().zip(&places) {
            assert!(error.is_finite() && *time > 0.0);
            let beaten = places.iter().any(|(t, e)| t <= time && e <= error && (t < time || e < error));
            assert_eq!(holds(&point["front"], key), !beaten, "{key}: {point}");
            assert!(!holds(&point["front"], key) || holds(&point["method_front"], key));
        }
    }
    let steps = |point: &Value| {
        point["steps"].as_array().unwrap().iter().map(|s| s["seconds"].as_f64().unwrap()).sum::<f64>()
    };
    assert!(
        points
            .iter()
            .all(|point| steps(point) > 0.0 && steps(point) <= point["seconds"]["median"].as_f64().unwrap())
    );
}

/// The page holds the same study, with pictures; the table has a line per setting.
#[test]
fn page_and_table_say_the_same() {
    let folder = Folder::new();
    cost(&folder, "0", &["--reference-spp", "16", "--methods", "voxel"]).ok();
    let mut page = String::from_utf8(folder.read("study/cost.html")).unwrap();
    let (_, data) = page.split_once("id=\"data\">").unwrap();
    let mut study_of_page: Value = serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap();
    let is_picture =
        |value: &Value| value.as_str().is_some_and(|text| text.starts_with("data:image/png;base64,iVBOR"));
    assert!(is_picture(&study_of_page["reference"]["image"]));
    study_of_page["reference"]["image"] = Value::Null;
    for point in study_of_page["points"].as_array_mut().unwrap() {
        assert!(is_picture(&point["image"]) || point["method_front"].as_array().unwrap().is_empty());
        point["image"] = Value::Null;
    }
    assert_eq!(study_of_page, study(&folder));
    for namespace in ["http://www.w3.org/1999/xhtml", "http://www.w3.org/2000/svg"] {
        page = page.replace(namespace, "");
    }
    assert!(!page.contains("http://") && !page.contains("https://") && !page.contains("{{"));
    let table = String::from_utf8(folder.read("study/cost.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + 2);
    assert!(table.contains(",voxel,voxel --spp 16 --grid 128"), "{table}");
}

/// The command of a point renders the picture that was judged.
#[test]
fn a_command_renders_what_was_measured() {
    let folder = Folder::new();
    cost(&folder, "3", &["--reference-spp", "16", "--methods", "slhb"]).ok();
    let study = study(&folder);
    for point in study["points"].as_array().unwrap() {
        let command = point["command"].as_str().unwrap();
        let words: Vec<&str> = command.split_whitespace().skip(1).collect();
        let picture = *words.last().unwrap();
        folder.run(&words).ok();
        let compared = folder.run(&["compare", picture, "study/reference.exr", "--json"]).ok().stdout;
        let compared: Value = serde_json::from_str(&compared).unwrap();
        for metric in study["metrics"].as_array().unwrap() {
            let key = metric["key"].as_str().unwrap();
            assert_eq!(compared["metrics"][key]["value"], point["errors"][key], "{key} of {command}");
        }
    }
}

#[test]
fn a_second_run_measures_nothing_anew() {
    let folder = Folder::new();
    let flags = ["--reference-spp", "16", "--methods", "reference,voxel"];
    let first = cost(&folder, "0", &flags).ok();
    assert!(first.stderr.contains("4 settings, 4 of them new"), "{}", first.stderr);
    let before = ["study/cost.json", "study/cost.html", "study/points.jsonl"].map(|name| folder.read(name));
    // Half a line, as a crash leaves it.
    let mut records = before[2].clone();
    records.extend(b"\n{\"key\":\"");
    std::fs::write(folder.path("study/points.jsonl"), &records).unwrap();
    let second = cost(&folder, "0", &flags).ok();
    assert!(second.stderr.contains("4 settings, 0 of them new"), "{}", second.stderr);
    assert!(before[0] == folder.read("study/cost.json") && before[1] == folder.read("study/cost.html"));
    // Other conditions, in the same folder.
    let other = cost(&folder, "1", &flags).ok();
    assert!(other.stderr.contains("4 settings, 4 of them new"), "{}", other.stderr);
    // The first conditions again: the reference is rendered anew, to the same bits, and what was judged by it counts.
    let third = cost(&folder, "0", &flags).ok();
    assert!(third.stderr.contains("4 settings, 0 of them new"), "{}", third.stderr);
}

#[test]
fn a_reference_may_come_from_a_file() {
    let folder = Folder::new();
    let render = ["render", "builtin:cornell", "--backend", "cpu", "--size", "16x16", "--bounces", "4"];
    folder.run(&[&render[..], &["--spp", "16", "-o", "same.exr"]].concat()).ok();
    cost(&folder, "0", &["--reference", "same.exr", "--methods", "reference"]).ok();
    let study = study(&folder);
    assert!(study["reference"]["noise"]["mse"].is_null() && study["reference"]["spp"].is_null());
    // The first setting is the same render.
    let same = &study["points"][0];
    assert_eq!((&same["errors"]["mse"], &same["errors"]["ratio"]), (&0.0.into(), &1.0.into()));
    assert!(study["split"][0]["how"].as_str().unwrap().contains("noise of the reference counts as bias"));
    folder
        .run(&["cost", "builtin:cornell", "--reference", "same.exr", "--backend", "cpu"])
        .fails(2, "add --size 16x16");
}

/// Without time for a single setting, there is a valid study without points.
#[test]
fn no_time_is_no_error() {
    let folder = Folder::new();
    let flags = ["--size", "8x8", "--backend", "cpu", "--time-limit", "0.001", "--out", "study"];
    folder.run(&[&["cost", "builtin:cornell"], &flags[..]].concat()).ok();
    let study = study(&folder);
    assert_eq!((&study["finished"], &study["points"]), (&false.into(), &Value::Array(Vec::new())));
}

#[cfg(unix)]
#[test]
fn a_signal_saves_what_is_there_and_the_next_run_goes_on() {
    use std::io::{BufRead, BufReader, Read};
    use std::process::{Command, Stdio};
    let folder = Folder::new();
    let flags = [
        "--size",
        "16x16",
        "--backend",
        "cpu",
        "--reference-spp",
        "16",
        "--out",
        "study",
        "--methods",
        "voxel",
    ];
    let endless = ["--time-limit", "31536000", "--progress", "json"];
    let mut command = folder.command(&[&["cost", "builtin:cornell"], &flags[..], &endless].concat());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut stderr = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("\"points\":1") {
        line.clear();
        assert_ne!(stderr.read_line(&mut line).unwrap(), 0, "the study ended by itself");
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let mut rest = String::new();
    stderr.read_to_string(&mut rest).unwrap();
    let run = Run { stderr: rest, ..Run::of(child.wait_with_output().unwrap()) };
    run.fails(130, "interrupted; what was finished is saved");
    let interrupted = study(&folder);
    let count = interrupted["points"].as_array().unwrap().len();
    assert!((1..=2).contains(&count) && interrupted["finished"] == false, "{interrupted}");
    let next = folder.run(&[&["cost", "builtin:cornell"], &flags[..], &["--quick"]].concat()).ok();
    assert!(next.stderr.contains(&format!("2 settings, {} of them new", 2 - count)), "{}", next.stderr);
    let points = &study(&folder)["points"];
    for (id, point) in interrupted["points"].as_array().unwrap().iter().enumerate() {
        assert_eq!((&point["seconds"], &point["errors"]), (&points[id]["seconds"], &points[id]["errors"]));
    }
}
