//! What reaches a terminal: no command that a file hides in its texts, and no panic where nothing can be printed.

use std::fs::OpenOptions;
use std::process::Stdio;

use super::{Ran, Workplace};

/// Text that would turn a terminal red, ring its bell and turn the direction of writing.
const EVIL: &str = "\u{1b}[31m\u{7}\u{9b}2J\u{202e}";

#[track_caller]
fn harmless(ran: &Ran) {
    for text in [ran.stdout(), ran.stderr()] {
        let acts = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
        assert!(!text.contains(acts), "{text:?}");
    }
}

#[test]
fn names_of_files_command_no_terminal() {
    let place = Workplace::new();
    let name = format!("{EVIL}.exr");
    place.photo(&name);
    let ran = place.vglare(&["apply", &name, "-o", "out.exr"]).succeeded();
    assert!(ran.stdout().contains("\\u{1b}[31m\\u{7}\\u{9b}2J\\u{202e}.exr"), "{}", ran.stdout());
    harmless(&ran);
    for args in
        [&["lights", &name][..], &["plan", &name], &["apply", &name, "-o", &name], &[&name], &["lights", "-x", EVIL]]
    {
        harmless(&place.vglare(args));
    }
    place.text("a.exr", "no photo");
    harmless(&place.vglare(&["apply", &name, "a.exr", "-o", &format!("{EVIL}/"), "--keep-going", "--verbose"]));
}

#[test]
fn texts_of_scene_files_command_no_terminal() {
    let place = Workplace::new();
    place.photo("a.exr");
    let text = "preset = \"\\u001b[31m\\u0007\\u009b2J\\u202e\"\n\"\\u001b[31m\" = 1\n";
    place.text("scene.toml", text);
    let ran = place.vglare(&["apply", "a.exr", "-o", "out.exr", "--scene", "scene.toml"]);
    harmless(&ran);
    ran.failed(1, &["\\u{1b}[31m"]);
}

#[test]
fn json_says_what_there_is() {
    let place = Workplace::new();
    let name = format!("{EVIL}.exr");
    place.photo(&name);
    let ran = place.vglare(&["plan", &name, "--json"]).succeeded();
    harmless(&ran);
    assert!(serde_json::from_str::<serde_json::Value>(&ran.stdout()).is_ok(), "{}", ran.stdout());
}

#[test]
fn nothing_that_cannot_be_printed_is_a_panic() {
    let place = Workplace::new();
    place.photo("a.exr");
    place.text("b.exr", "no photo");
    let full = || Stdio::from(OpenOptions::new().write(true).open("/dev/full").expect("a device"));
    let code =
        |args: &[&str], out: Stdio| place.command(args).stdout(out).stderr(full()).status().expect("it runs").code();
    assert_eq!(code(&["apply", "b.exr", "-o", "c.exr"], Stdio::null()), Some(1));
    assert_eq!(code(&["apply", "a.exr", "b.exr", "-o", "out/", "--keep-going"], Stdio::null()), Some(1));
    assert_eq!(code(&["apply", "a.exr"], Stdio::null()), Some(2));
    assert_eq!(code(&["lights", "a.exr"], full()), Some(1));
    assert_eq!(code(&["--help"], full()), Some(0));
    let out = || Stdio::from(OpenOptions::new().write(true).open("/dev/full").expect("a device"));
    let ran = place.command(&["lights", "a.exr"]).stdout(out()).stderr(Stdio::piped()).output().expect("it runs");
    Ran(ran).failed(1, &["cannot write standard output: No space left on device"]);
}
