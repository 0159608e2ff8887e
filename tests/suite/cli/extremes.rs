//! Numbers in scene files that no one means: a clear answer within seconds, never a picture that is not finite.

use super::{Workplace, night};

/// Runs `plan` and `apply` on a scene. An exit code and words of the error, or 0 for a picture that is finite.
#[track_caller]
fn ends(scene: &str, code: i32, words: &[&str]) {
    let place = Workplace::new();
    place.photo("in.pfm");
    place.text("scene.toml", scene);
    let apply = ["apply", "in.pfm", "-o", "out.pfm", "--scene", "scene.toml"];
    for args in [&["plan", "in.pfm", "--scene", "scene.toml"][..], &apply] {
        match code {
            0 => drop(place.vglare(args).succeeded()),
            code => drop(place.vglare(args).failed(code, words)),
        }
    }
    let out = place.path("out.pfm");
    match code {
        0 => {
            let picture = vglare::photo::read(&out).unwrap();
            assert!(picture.pixels.as_flattened().iter().all(|value| value.is_finite()));
        }
        _ => assert!(!out.exists(), "a picture is left behind"),
    }
}

const GHOST: &str = "center = [0, 0]\nradiance = [1, 1, 1]";

#[test]
fn bells_very_much_wider_than_a_period_are_refused_with_their_copies() {
    for bell in ["cosine-squared", "parabola", "paraboloid", "gaussian"] {
        let scene = format!("period = [4, 4]\n[[ghost]]\nbell = \"{bell}\"\nsize = 1e12\n{GHOST}");
        ends(&scene, 1, &["a period of 4e0 x 4e0 is too short", "copies"]);
    }
}

#[test]
fn bells_1e12_wide_are_planned_in_a_period_of_their_own() {
    for bell in ["cosine-squared", "gaussian"] {
        ends(&format!("[[ghost]]\nbell = \"{bell}\"\nsize = 1e12\n{GHOST}"), 0, &[]);
    }
    let profile =
        "[[profile]]\nname = \"a\"\nrows = [[0, 1], [1e12, 0]]\n[[ghost]]\nbell = \"profile\"\nprofile = \"a\"";
    ends(&format!("{profile}\nsize = 1\n{GHOST}"), 0, &[]);
}

#[test]
fn periodic_bells_of_a_period_of_1e12_are_planned_at_once() {
    let von_mises = format!("[[ghost]]\nbell = \"von-mises\"\nsize = 0.2\n{GHOST}");
    ends(&format!("period = [1e12, 3]\ndegree = [32, 24]\n{von_mises}"), 0, &[]);
    let narrow = format!("period = [1e12, 3]\n[[ghost]]\nbell = \"sine-gaussian\"\nsize = 0.2\n{GHOST}");
    ends(&narrow, 1, &["a sine-gaussian bell is at least 2.0e7 x 6.0e-5 in its period"]);
}

#[test]
fn periods_beyond_their_range_are_refused_with_it() {
    for period in ["1.2e-38, 1.2e-38", "4, 1e-7", "1e16, 3"] {
        ends(
            &format!("period = [{period}]"),
            1,
            &["a period of", "each has to be from 1e-6 to 1e15 half picture heights"],
        );
    }
}

#[test]
fn a_picture_that_the_glare_makes_infinite_is_an_error_and_not_written() {
    let place = Workplace::new();
    let mut photo = night();
    photo.pixels[100] = [f32::MAX, 0.0, 0.0, 1.0];
    place.write("in.pfm", &photo);
    place.text("scene.toml", "[[ghost]]\ncenter = [0, 0]\nsize = 2\nradiance = [1e37, 1, 1]");
    let before = place.files();
    let args =
        ["apply", "in.pfm", "-o", "out.pfm", "--scene", "scene.toml", "--glare", "glare.pfm", "--report", "a.json"];
    place.vglare(&args).failed(1, &["the picture is infinite or undefined at 1 pixel where", "nothing is written"]);
    assert_eq!(place.files(), before);
    // What was infinite in the photo already stays so.
    photo.pixels[100] = [f32::INFINITY, f32::NAN, 0.0, 1.0];
    place.write("in.pfm", &photo);
    place.vglare(&args).succeeded();
}

/// The file says pixelAspectRatio 2: 160 × 100 pixels that are shown as 320 × 100.
#[test]
fn pixels_that_are_not_square_are_told_in_summary_report_and_plan() {
    let place = Workplace::new();
    std::fs::copy("tests/inputs/exr-pixel-aspect-2.exr", place.path("in.exr")).unwrap();
    place.text("scene.toml", &format!("light = []\n[[ghost]]\nsize = 0.2\n{GHOST}"));
    let args =
        ["apply", "in.exr", "-o", "out.exr", "--scene", "scene.toml", "--glare", "glare.exr", "--report", "a.json"];
    let ran = place.vglare(&args).succeeded();
    assert!(ran.stdout().contains("pixels 2.0000 times as wide as high"), "{}", ran.stdout());
    let report: serde_json::Value = serde_json::from_slice(&std::fs::read(place.path("a.json")).unwrap()).unwrap();
    assert_eq!(report["input"]["pixel_aspect"], 2.0);
    let planned = place.vglare(&["plan", "in.exr", "--scene", "scene.toml", "--size", "80x50"]).succeeded();
    assert!(planned.stdout().contains("80 x 50 pixels, 2.0000 times as wide as high"), "{}", planned.stdout());
    for name in ["out.exr", "glare.exr"] {
        let photo = vglare::photo::read(&place.path(name)).unwrap();
        assert_eq!((photo.source.pixel_aspect, photo.frame.pixel_aspect), (2.0, 2.0), "{name}");
    }
    // An aspect that no pixel has.
    let mut bytes = std::fs::read(place.path("in.exr")).unwrap();
    let at = bytes.windows(16).position(|word| word == b"pixelAspectRatio").unwrap() + 16 + 1 + 6 + 4;
    bytes[at..at + 4].copy_from_slice(&0.0f32.to_le_bytes());
    std::fs::write(place.path("in.exr"), bytes).unwrap();
    let ran = place.vglare(&["apply", "in.exr", "-o", "square.exr", "--scene", "scene.toml"]).succeeded();
    assert!(
        ran.stderr().contains("its pixelAspectRatio, 0, makes no sense: its pixels are taken for square"),
        "{}",
        ran.stderr()
    );
}
