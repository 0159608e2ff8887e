//! Photos by standard input and output, sizes that are too large, and files of formats that are not read.

use std::io::Write;
use std::process::{Output, Stdio};

use super::{Ran, Workplace};

/// Runs the program with a file led into it.
fn led(place: &Workplace, args: &[&str], input: &str) -> Ran {
    let input = std::fs::File::open(place.path(input)).unwrap();
    Ran(place.command(args).stdin(input).output().unwrap())
}

/// The same through a pipe, so that it cannot be sought in.
fn piped(place: &Workplace, args: &[&str], input: &[u8]) -> Output {
    let mut command = place.command(args);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut pipe = child.stdin.take().unwrap();
    std::thread::scope(|scope| {
        // It may be turned away after the first bytes.
        scope.spawn(move || drop(pipe.write_all(input)));
        child.wait_with_output().unwrap()
    })
}

#[test]
fn a_photo_goes_through_a_pipe() {
    let place = Workplace::new();
    place.photo("in.exr");
    let bytes = std::fs::read(place.path("in.exr")).unwrap();
    place.vglare(&["apply", "in.exr", "-o", "out.png", "--glare", "glare.exr"]).succeeded();
    let out = piped(&place, &["apply", "-", "-o", "-", "--format", "png"], &bytes);
    let said = String::from_utf8_lossy(&out.stderr);
    assert!(out.status.success() && said.contains("photo    -") && said.contains("wrote"), "{said}");
    assert!(out.stdout == std::fs::read(place.path("out.png")).unwrap(), "nothing but the picture");
    // The glare, and a report, in its place; the picture beside it.
    let args = ["apply", "-", "-o", "beside.png", "--glare", "-", "--format", "exr", "--quiet"];
    let glare = led(&place, &args, "in.exr").succeeded();
    assert!(glare.0.stdout == std::fs::read(place.path("glare.exr")).unwrap());
    let report = led(&place, &["apply", "-", "-o", "reported.png", "--report", "-"], "in.exr").succeeded();
    let report: serde_json::Value = serde_json::from_slice(&report.0.stdout).expect("JSON alone");
    assert_eq!(report["output"], "reported.png");
    let clean = led(&place, &["remove", "-", "-o", "-", "--format", "exr", "--veil", "camera"], "in.exr").succeeded();
    assert!(clean.0.stdout.starts_with(&[0x76, 0x2f, 0x31, 0x01]), "{}", clean.stderr());
    for args in [&["info", "-"][..], &["lights", "-"], &["plan", "-"]] {
        let told = led(&place, args, "in.exr").succeeded();
        assert!(!told.stdout().is_empty(), "{args:?}");
    }
    let named = ["apply", "in.exr", "-o", "named", "--format", "hdr"];
    place.vglare(&named).succeeded();
    assert!(std::fs::read(place.path("named")).unwrap().starts_with(b"#?RADIANCE"));
}

#[test]
fn what_cannot_be_led_there_is_refused() {
    let place = Workplace::new();
    place.photo("in.exr");
    let files = place.files();
    for (args, words) in [
        (&["apply", "in.exr", "-o", "-"][..], &["standard output", "--format"][..]),
        (&["apply", "in.exr", "-o", "out.exr", "--format", "png"], &["out.exr", "OpenEXR", "PNG"]),
        (&["apply", "-", "-o", "out.png"], &["standard input", "empty"]),
    ] {
        place.vglare(args).failed(1, words);
    }
    for args in [
        &["apply", "in.exr", "-o", "-", "--glare", "-", "--format", "exr"][..],
        &["apply", "in.exr", "-o", "-", "--report", "-", "--format", "exr"],
        &["apply", "in.exr", "in.exr", "-o", "-", "--format", "exr"],
        &["apply", "in.exr", "-", "-o", "out/"],
    ] {
        place.vglare(args).failed(2, &["-"]);
    }
    assert_eq!(place.files(), files, "nothing is left");
}

#[test]
#[cfg(target_os = "linux")]
fn a_pipe_that_closes_and_a_full_device_are_errors() {
    let place = Workplace::new();
    place.photo("in.exr");
    let args = ["apply", "in.exr", "-o", "-", "--format", "exr"];
    let mut child = place.command(&args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    Ran(child.wait_with_output().unwrap()).failed(1, &["standard output", "pipe"]);
    let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
    let ran = place.command(&args).stdout(full).stderr(Stdio::piped()).spawn().unwrap().wait_with_output().unwrap();
    Ran(ran).failed(1, &["standard output", "full"]);
    place.vglare(&["apply", "in.exr", "-o", "/dev/full", "--format", "exr"]).failed(1, &["/dev/full", "full"]);
}

#[test]
fn a_photo_is_as_large_as_it_may_be() {
    let place = Workplace::new();
    place.photo("in.exr");
    let photo = vglare::photo::read(&place.path("in.exr")).unwrap();
    let pixels = u64::from(photo.width()) * u64::from(photo.height());
    for name in ["in.exr", "in.png", "in.jpg", "in.tif", "in.hdr", "in.pfm"] {
        place.write(name, &photo);
        let (below, at) = ((pixels - 1).to_string(), pixels.to_string());
        let words = [name, "--max-pixels", &below];
        place.vglare(&["info", name, "--max-pixels", &below]).failed(1, &words);
        place.vglare(&["info", name, "--max-pixels", &at]).succeeded();
    }
    place.vglare(&["apply", "in.exr", "-o", "out.exr", "--max-pixels", "9"]).failed(1, &["--max-pixels"]);
    place.vglare(&["info", "in.exr", "--max-pixels", "0"]).failed(2, &["--max-pixels"]);
}

#[test]
fn other_formats_are_called_by_name() {
    let place = Workplace::new();
    for (name, head, words) in [
        ("a.png", &b"\0\0\0\x18ftypheic\0\0\0\0mif1heic"[..], ["HEIC", "heif-convert"]),
        ("a.cr3", b"\0\0\0\x18ftypcrx \0\0\0\x01crx isom", ["Canon CR3", "darktable-cli"]),
        ("a.jxl", b"\xff\x0a\xfa\x1f\x01", ["cannot read", "cut short"]),
        ("a.webp", b"RIFF\x24\0\0\0WEBPVP8 ", ["WebP", "dwebp"]),
        ("a.txt", b"Plain text", ["not a picture of a known kind", "OpenEXR"]),
    ] {
        std::fs::write(place.path(name), head).unwrap();
        place.vglare(&["info", name]).failed(1, &[name, words[0], words[1]]);
        // And by content alone.
        Ran(piped(&place, &["info", "-"], head)).failed(1, &["standard input", words[0], words[1]]);
    }
}
