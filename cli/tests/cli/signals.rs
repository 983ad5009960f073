#![cfg(unix)]

use crate::{Folder, Run};
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use twinlight::io::image::read_rgb;
use twinlight::scene::Limits;

/// Starts an endless render, sends `signal` once a whole sample is done and waits for the end.
fn interrupted(folder: &Folder, signal: &str) -> Run {
    let flags = ["--size", "32x32", "--spp", "16000000", "--backend", "cpu", "--progress", "json"];
    let mut command = folder.command(&[&["render", "builtin:cornell"], &flags[..]].concat());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut stderr = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("\"samples\":1") {
        line.clear();
        assert_ne!(stderr.read_line(&mut line).unwrap(), 0, "the render ended by itself");
    }
    let kill = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let mut rest = String::new();
    stderr.read_to_string(&mut rest).unwrap();
    let output = child.wait_with_output().unwrap();
    Run { stderr: rest, ..Run::of(output) }
}

#[test]
fn one_signal_saves_valid_files() {
    for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
        let folder = Folder::new();
        let run = interrupted(&folder, signal).fails(code, "interrupted; what was finished is saved");
        assert_eq!(run.stdout, "cornell.png\ncornell.exr\ncornell.json\n");
        for name in ["cornell.png", "cornell.exr"] {
            let image = read_rgb(&folder.read(name), name, &Limits::default()).unwrap();
            assert!(image.pixels.iter().flatten().any(|&x| x > 0.0), "{name}");
        }
        let sidecar: serde_json::Value = serde_json::from_slice(&folder.read("cornell.json")).unwrap();
        assert_eq!(sidecar["result"]["stop"], "interrupted");
    }
}
