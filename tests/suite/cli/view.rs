//! `vglare view` where there is no window: scripts, and what it says where it cannot open one.

use super::*;

/// Plays a script on a photo.
fn play(workplace: &Workplace, script: &str) -> Ran {
    workplace.photo("night.exr");
    workplace.text("script.json", script);
    workplace.text("lights.toml", "version = 2\n[look]\nsources = \"lights\"\n");
    let view = ["view", "night.exr", "--scene", "lights.toml"];
    workplace.vglare(&[&view[..], &["--script", "script.json", "--script-output", "out"]].concat())
}

#[test]
fn a_script_is_played_and_each_step_told_of() {
    let workplace = Workplace::new();
    let script = r#"["load", {"drag": {"from": {"light": 0}, "to": {"picture": [0.0, 0.0]}, "frames": 3}},
        {"key": {"key": "G"}}, "lose", {"scale": 1.5}, "rest", {"screenshot": "glare"}]"#;
    play(&workplace, script).succeeded();
    let steps: Value = serde_json::from_slice(&std::fs::read(workplace.path("out/steps.json")).unwrap()).unwrap();
    let [first, .., last] = steps.as_array().unwrap().as_slice() else { panic!("{steps}") };
    assert_eq!((&first["photo"], &last["devices"]), (&"night.exr".into(), &2.into()));
    let [x, y] = [0, 1].map(|axis| last["lights"][0][axis].as_f64().unwrap());
    assert!(x.hypot(y) < 0.05 && first["lights"] != last["lights"], "{last:#}");
    assert!(workplace.path("out/glare.png").exists());
}

#[test]
fn a_script_that_cannot_be_played_is_told_of() {
    let workplace = Workplace::new();
    workplace.photo("night.exr");
    let missing = ["view", "night.exr", "--script", "none.json", "--script-output", "out"];
    workplace.vglare(&missing).failed(1, &["none.json", "No such file"]);
    assert!(!workplace.path("out").exists(), "nothing is made before the script is read");
    play(&workplace, "[\n\"load\",\n]").failed(1, &["script.json", "line 3"]);
    play(&workplace, r#"["dance"]"#).failed(1, &["script.json", "unknown variant `dance`"]);
    play(&workplace, r#"["load", {"move": {"light": 70}}]"#).failed(1, &["step 2", "no such light"]);
    play(&workplace, r#"["load", {"move": {"control": ["Sparkle", 0.5]}}]"#).failed(1, &["step 2", "\"Sparkle\""]);
    play(&workplace, r#"[{"key": {"key": "Anykey"}}]"#).failed(1, &["step 1", "no key is called \"Anykey\""]);
    play(&workplace, r#"[{"resize": [0, 100]}]"#).failed(1, &["step 1", "0x100"]);
    workplace.vglare(&["view", "night.exr", "--script", "script.json"]).failed(2, &["--script-output"]);
}

#[test]
fn a_file_that_a_script_opens_in_vain_is_told_of_in_the_window() {
    let workplace = Workplace::new();
    play(&workplace, r#"["load", {"open": "missing.exr"}, {"drop": "script.json"}, "load", "rest"]"#).succeeded();
    let steps: Value = serde_json::from_slice(&std::fs::read(workplace.path("out/steps.json")).unwrap()).unwrap();
    let last = &steps[4];
    assert!(last["notices"][0].as_str().unwrap().contains("missing.exr"), "{last:#}");
    assert!(last["notices"][1].as_str().unwrap().contains("script.json"), "{last:#}");
    assert_eq!(last["photo"], "night.exr");
}

#[test]
fn without_a_display_there_is_an_error_and_no_window() {
    let workplace = Workplace::new();
    workplace.photo("night.exr");
    let mut command = workplace.command(&["view", "night.exr"]);
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    let ran = Ran(command.output().unwrap());
    ran.failed(4, &["no window can be opened", "neither WAYLAND_DISPLAY nor DISPLAY"]);
    let ran = Ran(command.env("DISPLAY", ":54321").output().unwrap());
    ran.failed(4, &["no window can be opened", ":54321 does not answer"]);
}
