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
        assert!(run.stderr.contains("id layers: the render ended early (interrupted)"), "{}", run.stderr);
        assert_eq!(run.stdout, "cornell.png\ncornell.exr\ncornell.json\n");
        for name in ["cornell.png", "cornell.exr"] {
            let image = read_rgb(&folder.read(name), name, &Limits::default()).unwrap();
            assert!(image.pixels.iter().flatten().any(|&x| x > 0.0), "{name}");
        }
        let sidecar: serde_json::Value = serde_json::from_slice(&folder.read("cornell.json")).unwrap();
        assert_eq!(sidecar["result"]["stop"], "interrupted");
    }
}

/// The first signal asks for a stop, which waits for a pass; who can't wait sends another.
#[test]
fn two_signals_end_at_once_and_leave_no_half_file() {
    let folder = Folder::new();
    let flags = ["--size", "4096x4096", "--spp", "16000000", "--backend", "cpu", "--progress", "json"];
    let mut command = folder.command(&[&["render", "builtin:room-70k"], &flags[..]].concat());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut stderr = BufReader::new(child.stderr.take().unwrap());
    assert_ne!(stderr.read_line(&mut String::new()).unwrap(), 0, "the render ended by itself");
    // Repeated, because two signals on the way at the same time count as one.
    while child.try_wait().unwrap().is_none() {
        Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let status = child.wait().unwrap();
    assert_eq!(status.code(), Some(130));
    assert_eq!(std::fs::read_dir(folder.path(".")).unwrap().count(), 0);
}
