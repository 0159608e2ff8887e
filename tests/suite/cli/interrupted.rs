//! What ends a run leaves nothing behind: signals, limits, and what no program hears of.
#![cfg(target_os = "linux")]

use std::os::unix::process::ExitStatusExt as _;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use vglare::photo::Photo;

use super::{Workplace, night};

/// A photo that takes a while to be written.
fn large(place: &Workplace) {
    let photo = night();
    let pixels = (0..1600 * 900).map(|k| photo.pixels[k % photo.pixels.len()]).collect();
    place.write("in.exr", &Photo::new(1600, 900, pixels));
    std::fs::create_dir(place.path("out")).unwrap();
}

/// Runs the program by way of a shell, or of another program that sets something for it. The cache is the place's own.
fn run(place: &Workplace, by: &[&str], args: &[&str]) -> Command {
    let program = env!("CARGO_BIN_EXE_vglare");
    let mut command = Command::new(by[0]);
    command.args(&by[1..]).arg(program).args(args).current_dir(place.path("."));
    command.env("VGLARE_CACHE", place.path("cache")).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Waits until a picture is being written, and then sends a signal.
fn signal_while_writing(place: &Workplace, child: &mut Child, name: &str) {
    let until = Instant::now() + Duration::from_secs(60);
    let parts = || left(place).iter().any(|name| name.ends_with(".part"));
    while !parts() {
        assert!(child.try_wait().unwrap().is_none(), "it takes long enough to be seen");
        assert!(Instant::now() < until, "it comes to writing");
        std::thread::sleep(Duration::from_millis(1));
    }
    // By now it writes, or looks whether it can.
    let sent = Command::new("kill").args(["-s", name, &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

fn left(place: &Workplace) -> Vec<String> {
    std::fs::read_dir(place.path("out"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect()
}

const WRITE: [&str; 7] = ["apply", "in.exr", "-o", "out/out.png", "--strength", "0", "-q"];

#[test]
fn signals_end_the_program_and_leave_nothing() {
    let place = Workplace::new();
    large(&place);
    for (name, number) in [("INT", 2), ("TERM", 15), ("HUP", 1), ("QUIT", 3), ("XCPU", 24)] {
        // Whoever runs the tests may ignore some.
        let mut child =
            run(&place, &["sh", "-c", "ulimit -c 0; exec env --default-signal \"$@\"", "sh"], &WRITE).spawn().unwrap();
        signal_while_writing(&place, &mut child, name);
        let ended = child.wait().unwrap();
        assert_eq!(ended.signal(), Some(number), "it ends by {name}, as who sent it expects: {ended}");
        assert_eq!(left(&place), [""; 0], "{name}");
    }
}

#[test]
fn a_signal_that_is_to_be_ignored_is() {
    let place = Workplace::new();
    large(&place);
    let mut child = run(&place, &["env", "--ignore-signal=HUP"], &WRITE).spawn().unwrap();
    signal_while_writing(&place, &mut child, "HUP");
    let ended = child.wait_with_output().unwrap();
    assert!(ended.status.success(), "as under nohup: {}", String::from_utf8_lossy(&ended.stderr));
    assert_eq!(left(&place), ["out.png"]);
}

#[test]
fn what_a_killed_run_leaves_is_removed_by_the_next() {
    let place = Workplace::new();
    large(&place);
    let mut child = run(&place, &["env"], &WRITE).spawn().unwrap();
    signal_while_writing(&place, &mut child, "KILL");
    child.wait().unwrap();
    place.photo("small.exr");
    place.vglare(&["apply", "small.exr", "-o", "out/small.exr", "--strength", "0"]).succeeded();
    assert_eq!(left(&place), ["small.exr"]);
}

#[test]
fn a_file_that_may_not_be_so_large_is_an_error() {
    let place = Workplace::new();
    large(&place);
    for name in ["out/out.exr", "out/out.tif", "out/out.png", "out/out.pfm"] {
        let args = ["apply", "in.exr", "-o", name, "--strength", "0"];
        // In units of 512 bytes.
        let ran = run(&place, &["sh", "-c", "ulimit -f 8; exec \"$@\"", "sh"], &args).output().unwrap();
        super::Ran(ran).failed(1, &[name, "larger than a file may be here"]);
        assert_eq!(left(&place), [""; 0], "{name}");
    }
}
