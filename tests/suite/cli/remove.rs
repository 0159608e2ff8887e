//! `remove`: a veil taken away again.

use vglare::photo::{self, Photo};

use super::Workplace;

const VEIL: [&str; 6] = ["--veil", "gaussian", "--width", "0.1", "--scatter", "0.2"];

/// The largest difference between two pictures, over the brightest sample.
fn apart(one: &Photo, other: &Photo) -> f64 {
    let samples = |photo: &Photo| photo.pixels.iter().flat_map(|pixel| pixel[..3].to_vec()).collect::<Vec<f32>>();
    let (one, other) = (samples(one), samples(other));
    let peak = other.iter().copied().fold(0.0, f32::max);
    let differences = one.iter().zip(&other).map(|(a, b)| f64::from((a - b).abs() / peak));
    differences.fold(0.0, f64::max)
}

#[test]
fn what_apply_has_done_is_undone_and_done_again() {
    let place = Workplace::new();
    place.photo("in.exr");
    let read = |name: &str| photo::read(&place.path(name)).unwrap();
    let apply = |from: &'static str, to: &'static str| {
        let line = ["apply", from, "-o", to, "--lens", "none", "--tolerance", "1e-5", "--depth", "float"];
        place.vglare(&[&line[..], &VEIL].concat()).succeeded();
    };
    apply("in.exr", "seen.exr");
    let line = ["remove", "seen.exr", "-o", "clean.exr", "--report", "report.json", "--tolerance", "1e-5"];
    let said = place.vglare(&[&line[..], &VEIL].concat()).succeeded().stdout();
    assert!(said.contains("removed  by") && said.contains("noise    grows at most 1.6"), "{said}");
    assert!(apart(&read("clean.exr"), &read("in.exr")) < 2e-5, "{}", apart(&read("clean.exr"), &read("in.exr")));
    let report = place.read_json("report.json");
    let number = |path: [&str; 2]| report["removal"][path[0]][path[1]].as_f64().unwrap();
    let (asked, predicted, measured) =
        (number(["error", "asked"]), number(["error", "predicted"]), number(["error", "measured"]));
    assert!(asked == 1e-5 && predicted <= asked && measured <= predicted, "{report}");
    assert!(report["removal"]["veils"].as_u64().unwrap() > 1 && report["output"] == "clean.exr");
    apply("clean.exr", "again.exr");
    assert!(apart(&read("again.exr"), &read("seen.exr")) < 2e-5);
    // What has no veil stays as it is.
    place.vglare(&[&["remove", "seen.exr", "-o", "same.exr", "--strength", "0"][..], &VEIL].concat()).succeeded();
    assert_eq!(read("same.exr").pixels, read("seen.exr").pixels);
}

#[test]
fn what_is_clipped_is_shown_and_what_is_darker_than_black_told() {
    let place = Workplace::new();
    place.photo("in.exr");
    let line = ["remove", "in.exr", "-o", "clean.exr", "--clip", "5", "--mask", "mask.png", "--negative", "clamp"];
    let ran = place.vglare(&[&line[..], &VEIL].concat()).succeeded();
    let said = ran.stderr();
    assert!(said.contains("clipped, from 5 on") && said.contains("more than the photo holds"), "{said}");
    let (photo, mask) = (photo::read(&place.path("in.exr")).unwrap(), photo::read(&place.path("mask.png")).unwrap());
    for (pixel, mask) in photo.pixels.iter().zip(&mask.pixels) {
        let clipped = pixel[..3].iter().any(|value| *value >= 5.0);
        assert_eq!(mask[0], if clipped { 1.0 } else { 0.0 });
    }
    let clean = photo::read(&place.path("clean.exr")).unwrap();
    assert!(clean.pixels.iter().all(|pixel| pixel[..3].iter().all(|value| *value >= 0.0)));
}

#[test]
fn what_cannot_be_is_refused_and_nothing_is_written() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text("k.csv", "0,1\n0.1,0.5\n0.3,0\n");
    let before = place.files();
    for (line, code, words) in [
        ("remove in.exr -o o.exr", 2, &["--veil"][..]),
        ("remove in.exr -o o.exr --veil none", 2, &["no veil"]),
        ("remove in.exr", 2, &["--output"]),
        ("remove in.exr -o o.exr --veil camera --tolerance 0", 2, &["between 0 and 1"]),
        ("remove in.exr -o o.exr --veil gaussian --width 0.1 --scatter 0.5 --strength 2", 2, &["no more than all"]),
        ("remove in.exr -o o.exr --veil camera --mask m.png", 2, &["--mask", "--clip"]),
        ("remove in.exr -o o.exr --veil camera --mask o.exr", 2, &["o.exr would be both"]),
        ("remove in.exr -o k.csv --veil table --table k.csv", 2, &["would replace k.csv"]),
        ("remove in.exr -o o.exr --veil camera --report in.exr", 2, &["would replace in.exr"]),
        ("remove in.exr -o o.xyz --veil camera", 1, &["o.xyz"]),
        ("remove none.exr -o o.exr --veil camera", 1, &["none.exr"]),
        ("remove in.exr -o o.exr --veil stiles-holladay --scatter 0.95 --fov 20", 3, &["proved"]),
    ] {
        place.vglare(&line.split(' ').collect::<Vec<_>>()).failed(code, words);
        assert_eq!(place.files(), before, "{line}");
    }
}
