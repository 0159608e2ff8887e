//! What the program will not do, and what it exits with then.

use std::process::Command;

use super::{Workplace, night};

#[test]
fn an_existing_file_is_only_replaced_by_force() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text("out.exr", "precious");
    place.text("report.json", "precious");
    place.vglare(&["apply", "in.exr", "-o", "out.exr"]).failed(1, &["out.exr", "--force"]);
    place.vglare(&["apply", "in.exr", "-o", "in.exr"]).failed(1, &["in.exr", "--force"]);
    let report = ["apply", "in.exr", "-o", "new.exr", "--report", "report.json"];
    place.vglare(&report).failed(1, &["report.json", "--force"]);
    assert!(!place.path("new.exr").exists(), "nothing is written where not all can be");
    assert_eq!(std::fs::read_to_string(place.path("out.exr")).unwrap(), "precious");
    place.vglare(&["apply", "in.exr", "-o", "out.exr", "--force"]).succeeded();
    place.vglare(&["apply", "in.exr", "-o", "in.exr", "--force"]).succeeded();
}

#[test]
fn a_window_is_not_opened_for_a_look_that_cannot_be_read() {
    let place = Workplace::new();
    place.text("look.toml", "[look]\nstrength = -1\n");
    place.vglare(&["view", "--scene", "look.toml"]).failed(1, &["look.toml: line 2", "strength"]);
    place.vglare(&["view", "--scene", "look.toml", "--preset", "zoom"]).failed(2, &["--preset"]);
    place.vglare(&["view", "--preset", "no-such-lens"]).failed(2, &["no-such-lens", "classic-prime"]);
}

#[test]
fn usage_errors_exit_with_2() {
    let place = Workplace::new();
    place.photo("in.exr");
    let apply = |more: &[&str]| {
        let mut args = vec!["apply", "in.exr", "-o", "out.exr"];
        args.extend(more);
        place.vglare(&args)
    };
    apply(&["--tolerance", "0"]).failed(2, &["tolerance"]);
    apply(&["--strength", "-1"]).failed(2, &[]);
    apply(&["--degree", "3"]).failed(2, &["degree"]);
    apply(&["--preset", "no-such-lens"]).failed(2, &["no-such-lens", "classic-prime"]);
    apply(&["--mix", "energy", "--normalize", "minmax"]).failed(2, &["energy"]);
    apply(&["--glare", "out.exr"]).failed(2, &["each"]);
    place.vglare(&["apply"]).failed(2, &[]);
    place.vglare(&["frobnicate"]).failed(2, &[]);
    assert_eq!(place.files(), ["in.exr"]);
}

#[test]
fn outputs_that_cannot_be_are_refused_before_the_work() {
    let place = Workplace::new();
    place.photo("in.exr");
    for (options, words) in [
        (&["-o", "out.gif"][..], &["out.gif", ".exr"][..]),
        (&["-o", "out"], &["out"]),
        (&["-o", "nowhere/out.exr"], &["nowhere"]),
        (&["-o", "out.png", "--depth", "half"], &["PNG"]),
        (&["-o", "out.exr", "--tonemap", "aces"], &["out.exr"]),
        (&["-o", "out.png", "--report", "nowhere/report.json"], &["nowhere"]),
    ] {
        let mut args = vec!["apply", "in.exr"];
        args.extend(options);
        place.vglare(&args).failed(1, words);
        assert_eq!(place.files(), ["in.exr"], "{options:?}");
    }
}

#[test]
fn a_tolerance_beyond_f32_names_the_floor() {
    let place = Workplace::new();
    place.photo("in.exr");
    place
        .vglare(&["apply", "in.exr", "-o", "out.exr", "--tolerance", "1e-12"])
        .failed(3, &["1.0e-12", "below what can be had here"]);
    assert_eq!(place.files(), ["in.exr"]);
}

#[test]
fn a_missed_tolerance_is_told_and_under_strict_an_error() {
    let place = Workplace::new();
    place.photo("in.exr");
    let rough = ["apply", "in.exr", "-o", "out.exr", "--degree", "2,2", "--force"];
    let ran = place.vglare(&rough).succeeded();
    assert!(ran.stderr().contains("warning") && ran.stderr().contains("1.0e-3"), "{}", ran.stderr());
    let mut strict = rough.to_vec();
    strict.push("--strict");
    place.vglare(&strict).failed(3, &["1.0e-3"]);
}

/// A disk that fills up while a file is written: the system then refuses, and so must the program, without remains.
#[test]
#[cfg(unix)]
fn a_full_disk_leaves_nothing_behind() {
    let place = Workplace::new();
    let mut photo = night();
    // Noise does not compress.
    for (k, pixel) in (1u32..).zip(&mut photo.pixels) {
        let noise = |salt: u32| f32::from_bits((k.wrapping_mul(2_654_435_761) ^ salt) >> 9 | 0x3f00_0000);
        *pixel = [noise(1), noise(77_777), noise(3_333_333), 1.0];
    }
    place.write("in.exr", &photo);
    for output in ["out.exr", "out.pfm", "out.tif", "out.hdr"] {
        // The shell's limit on a file's size stands in for the disk's; ignoring the signal makes writes fail instead.
        let script = r#"trap "" XFSZ; ulimit -f 8; exec "$0" apply in.exr -o "$1""#;
        let ran = Command::new("sh")
            .args(["-c", script, env!("CARGO_BIN_EXE_vglare"), output])
            .env("MESA_SHADER_CACHE_DISABLE", "1")
            .env("VGLARE_CACHE", place.path("cache"))
            .current_dir(place.folder.path())
            .output()
            .expect("a shell");
        super::Ran(ran).failed(1, &[output]);
        assert_eq!(place.files(), ["in.exr"], "{output}");
    }
}

#[test]
#[cfg(unix)]
fn devices_that_refuse_are_an_error() {
    let place = Workplace::new();
    place.photo("in.exr");
    std::os::unix::fs::symlink("/dev/full", place.path("full.png")).unwrap();
    std::os::unix::fs::symlink("/dev/full", place.path("full.json")).unwrap();
    place.vglare(&["apply", "in.exr", "-o", "full.png", "--force"]).failed(1, &["full.png"]);
    let report = ["apply", "in.exr", "-o", "out.png", "--report", "full.json", "--force"];
    place.vglare(&report).failed(1, &["full.json"]);
}
