use crate::Folder;

#[test]
fn help_shows_the_first_steps_and_the_exit_codes() {
    let folder = Folder::new();
    let short = folder.run(&["-h"]).ok().stdout;
    assert!(short.contains("twinlight render builtin:cornell"), "{short}");
    let long = folder.run(&["--help"]).ok().stdout;
    assert_eq!(
        long,
        include_str!("help.txt"),
        "cli/tests/cli/help.txt is what --help printed when it was last read"
    );
}

#[test]
fn every_command_has_examples() {
    let folder = Folder::new();
    for command in [
        &["render"][..],
        &["plan"],
        &["compare"],
        &["cost"],
        &["conform"],
        &["completions"],
        &["scene", "inspect"],
        &["scene", "convert"],
        &["scene", "schema"],
    ] {
        let help = folder.run(&[command, &["--help"]].concat()).ok().stdout;
        assert!(help.contains("Example"), "{command:?}: {help}");
        assert!(help.contains("  twinlight "), "{command:?}: {help}");
    }
}

#[test]
fn flags_have_twins_in_the_environment() {
    let folder = Folder::new();
    let mut command = folder.command(&["render", "builtin:furnace", "--backend", "cpu", "--spp", "1"]);
    let output = command.env("TWINLIGHT_SIZE", "7x5").env("TWINLIGHT_SPP", "2").output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let sidecar: serde_json::Value = serde_json::from_slice(&folder.read("furnace.json")).unwrap();
    assert_eq!(sidecar["settings"]["size"], serde_json::json!([7, 5]));
    assert_eq!(sidecar["settings"]["spp"], 1, "flags come first");
}

#[test]
fn devices_and_completions() {
    let folder = Folder::new();
    let devices: serde_json::Value =
        serde_json::from_str(&folder.run(&["devices", "--json"]).ok().stdout).unwrap();
    assert!(devices["cpu"]["threads"].as_u64().unwrap() >= 1);
    assert_eq!(devices["gpu_support"], cfg!(feature = "gpu"));
    assert!(devices["adapters"].is_array());
    assert!(folder.run(&["devices"]).ok().stdout.starts_with("cpu    "));
    for shell in ["bash", "zsh", "fish"] {
        assert!(folder.run(&["completions", shell]).ok().stdout.contains("twinlight"), "{shell}");
    }
}
