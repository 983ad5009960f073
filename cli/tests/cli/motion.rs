use crate::Folder;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read};
use std::process::Stdio;
use twinlight::io::image::exr;
use twinlight::scene::Limits;

const SMALL: [&str; 8] = ["--size", "16x16", "--spp", "2", "--backend", "cpu", "--threads", "2"];

/// A folder with a scene that moves for two seconds.
fn folder() -> Folder {
    let folder = Folder::new();
    let all = twinlight::fixtures::files::all();
    let bytes = &all.iter().find(|(path, _)| *path == "bending/bending.glb").expect("the fixture").1;
    std::fs::write(folder.path("b.glb"), bytes).expect("a file of the test");
    folder
}

fn render<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["render", "b.glb"], &SMALL[..], more].concat()
}

fn sidecar(folder: &Folder, name: &str) -> Value {
    serde_json::from_slice(&folder.read(name)).unwrap()
}

#[test]
fn frames_have_numbers_and_moments() {
    let folder = folder();
    let run = folder.run(&render(&["--frames", "1..4", "--fps", "2", "-o", "a.png", "-o", "x/a.exr"])).ok();
    let files: Vec<String> = (1..4)
        .flat_map(|n| [format!("a-000{n}.png"), format!("x/a-000{n}.exr"), format!("a-000{n}.json")])
        .collect();
    assert_eq!(run.stdout.lines().collect::<Vec<_>>(), files);
    assert!(run.stderr.contains("3 frames in "), "{}", run.stderr);
    assert_eq!(run.stderr.matches("notice: 1 animations not played: Wave").count(), 1, "{}", run.stderr);
    assert_eq!(sidecar(&folder, "a-0003.json")["moment"], json!({ "seconds": 1.5, "frame": 3 }));
    let bytes = folder.read("x/a-0003.exr");
    let attributes = exr::read_attributes(&bytes, "exr", &Limits::default()).unwrap();
    assert!(attributes.contains(&("seconds".into(), "1.5".into())), "{attributes:?}");
    assert_ne!(folder.read("a-0001.png"), folder.read("a-0002.png"));
    // The same moment by itself is the same picture.
    folder.run(&render(&["--at", "1.5", "-o", "single.exr"])).ok();
    assert!(folder.read("single.exr") == bytes);
}

#[test]
fn without_an_end_frames_go_to_the_end_of_the_motion() {
    let folder = folder();
    let run = folder.run(&render(&["--frames", "0..", "--fps", "2", "-o", "f{frame}.png"])).ok();
    let pictures: Vec<&str> = run.stdout.lines().filter(|line| line.ends_with(".png")).collect();
    assert_eq!(pictures, ["f0000.png", "f0001.png", "f0002.png", "f0003.png"]);
    folder.run(&render(&["--frames", "4..", "--fps", "2"])).fails(2, "4 frames, 0 to 3: there is no frame 4");
}

#[test]
fn a_motion_ends_or_begins_anew() {
    let folder = folder();
    folder.run(&render(&["--at", "2", "-o", "end.png"])).ok();
    folder.run(&render(&["--at", "3", "-o", "after.png"])).ok();
    folder.run(&render(&["--at", "3", "--loop", "-o", "again.png"])).ok();
    folder.run(&render(&["--at", "1", "-o", "one.png"])).ok();
    let picture = |name: &str| folder.read(name);
    assert!(picture("after.png") == picture("end.png") && picture("again.png") == picture("one.png"));
    assert!(picture("again.png") != picture("end.png"));
    assert_eq!(sidecar(&folder, "again.json")["moment"], json!({ "seconds": 1.0, "frame": null }));
}

#[test]
fn without_a_moment_it_is_the_beginning_and_said() {
    let folder = folder();
    let run = folder.run(&render(&["-o", "a.png"])).ok();
    assert!(
        run.stderr.contains("notice: the scene moves for 2.000 s, and this is how it begins"),
        "{}",
        run.stderr
    );
    let wave = folder.run(&render(&["--at", "1", "--animation", "Wave", "-o", "w.png"])).ok();
    assert!(wave.stderr.contains("notice: 1 animations not played: Bend"), "{}", wave.stderr);
    folder.run(&render(&["--animation", "Walk"])).fails(3, "no animation is called 'Walk'");
}

#[test]
fn flags_about_motion_are_for_scenes_that_move() {
    let folder = folder();
    let still = |more: &[&str]| folder.run(&[&["render", "builtin:furnace"], more].concat());
    still(&["--frames", "0..2"]).fails(2, "nothing moves in 'builtin:furnace': leave out --frames");
    still(&["--at", "1"]).fails(2, "leave out --at");
    still(&["--loop"]).fails(2, "leave out --loop");
    still(&["--animation", "1"]).fails(2, "leave out --animation");
    folder.run(&render(&["--frames", "2..2"])).fails(2, "such as 0..48");
    folder.run(&render(&["--frames", "0..2", "--at", "1"])).fails(2, "--at");
    folder.run(&render(&["--frames", "0..2", "--fps", "0"])).fails(2, "frames per second above 0");
    let twice = render(&["--frames", "0..2", "-o", "a.png", "-o", "a-{frame}.png"]);
    folder.run(&twice).fails(2, "'a-0000.png' is asked for twice");
    folder.write("c-0001.json", "{\"mine\": 1}");
    let run = folder.run(&render(&["--frames", "0..2", "-o", "c.png"]));
    run.fails(2, "'c-0001.json' exists and is not a report of twinlight");
    assert!(!folder.path("c-0000.png").exists(), "seen before anything is rendered");
}

#[test]
fn an_error_in_a_frame_names_it_and_keeps_those_before() {
    let folder = folder();
    folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write(
        "far.toml",
        "[[mesh]]\npath = 'm.obj'\n[[instance]]\nmesh = 'm.obj'\n[camera]\nposition = [0, 0, 3]\ntarget = [0, 0, 0]\n\
         [environment]\nradiance = 1\n",
    );
    let text = String::from_utf8(folder.read("far.toml")).unwrap().replace(
        "[camera]",
        "[[instance.motion]]\ntime = 0\ntranslate = [0, 0, 0]\n[[instance.motion]]\ntime = 1\ntranslate = [1e13, 0, 0]\n[camera]",
    );
    folder.write("far.toml", &text);
    let run =
        folder.run(&[&["render", "far.toml"], &SMALL[..], &["--frames", "0..3", "--fps", "1"]].concat());
    let run = run.fails(3, "error: frame 1: far.toml: mesh ");
    assert_eq!(run.stdout, "far-0000.png\nfar-0000.exr\nfar-0000.json\n");
}

#[test]
fn progress_is_of_the_whole_and_names_frames() {
    let folder = folder();
    let run = folder.run(&render(&["--frames", "3..6", "--progress", "json"])).ok();
    let lines: Vec<Value> =
        run.stderr.lines().filter(|l| l.starts_with('{')).map(|l| serde_json::from_str(l).unwrap()).collect();
    let fractions: Vec<f64> = lines.iter().map(|l| l["fraction"].as_f64().unwrap()).collect();
    assert!(fractions.is_sorted() && fractions.last() == Some(&1.0), "{fractions:?}");
    assert_eq!((&lines[0]["frame"], &lines[lines.len() - 1]["frame"]), (&json!(3), &json!(5)));
    let run = folder.run(&render(&["--frames", "3..6", "--progress", "plain"])).ok();
    assert!(run.stderr.contains("100.0 %  frame 5  2 spp"), "{}", run.stderr);
}

/// What is there is complete: the frame that a signal ends is not.
#[cfg(unix)]
#[test]
fn a_signal_keeps_the_frames_that_are_complete() {
    let folder = folder();
    let flags =
        ["--size", "16x16", "--spp", "64", "--frames", "0..1000", "--progress", "json", "-o", "a.png"];
    let mut command = folder.command(&[&["render", "b.glb", "--backend", "cpu"], &flags[..]].concat());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut stderr = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("\"frame\":2") {
        line.clear();
        assert_ne!(stderr.read_line(&mut line).unwrap(), 0, "the render ended by itself");
    }
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let mut rest = String::new();
    stderr.read_to_string(&mut rest).unwrap();
    let run = crate::Run { stderr: rest, ..crate::Run::of(child.wait_with_output().unwrap()) };
    let run = run.fails(130, "interrupted; what was finished is saved");
    assert!(run.stderr.contains("error: frame "), "{}", run.stderr);
    assert!(run.stdout.starts_with("a-0000.png\na-0000.json\na-0001.png\na-0001.json\n"), "{}", run.stdout);
    for name in run.stdout.lines().filter(|name| name.ends_with(".json")) {
        assert_eq!(sidecar(&folder, name)["result"]["stop"], "samples", "{name}");
    }
    let there = std::fs::read_dir(folder.path(".")).unwrap().count();
    assert_eq!(there, 1 + run.stdout.lines().count(), "nothing but the scene and what was listed");
}

#[test]
fn inspection_tells_what_moves_and_conversion_what_is_lost() {
    let folder = folder();
    let run = folder.run(&["scene", "inspect", "b.glb"]).ok();
    assert!(run.stdout.contains("motion      2.000 s, 2 of 3 instances: bar, cube\n"), "{}", run.stdout);
    let run = folder.run(&["scene", "inspect", "b.glb", "--animation", "Wave", "--json"]).ok();
    let value: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(value["motion"], json!({ "seconds": 1.0, "moving": ["bar"] }));
    let run = folder.run(&["scene", "convert", "b.glb", "out.toml"]).ok();
    assert!(run.stderr.contains("the motion is left out"), "{}", run.stderr);
    folder.run(&["scene", "inspect", "out.toml"]).ok();
}
