//! Every pixel as a source, from the command line.

use serde_json::json;

use super::Workplace;

const LENS: &str = "[[lens_ghost]]\nalong = -0.5\nsize = 0.4\ntint = [1.0, 0.5, 0.25]\nshare = 0.125\n";

/// Of the photo of [`Workplace::photo`].
const PIXELS: usize = 96 * 64;

#[test]
fn a_file_and_an_option_take_the_whole_photo_and_the_report_says_so() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text("lens.toml", LENS);
    place.text("look.toml", &format!("{LENS}[look]\nunit = \"short-side\"\nsources = \"photo\"\n"));
    let apply = |options: &[&str]| {
        let mut args =
            vec!["apply", "in.exr", "-o", "out.pfm", "--force", "--no-calibration", "--report", "report.json"];
        args.extend(options);
        let said = place.vglare(&args).succeeded().stdout();
        (std::fs::read(place.path("out.pfm")).expect("the picture"), place.read_json("report.json"), said)
    };
    let (by_option, report, said) = apply(&["--lens", "lens.toml", "--sources", "photo"]);
    let (by_file, ..) = apply(&["--scene", "look.toml"]);
    assert!(by_option == by_file);
    // Unless somebody says otherwise, it is so.
    let (by_default, ..) = apply(&["--lens", "lens.toml"]);
    place.text("new.toml", &format!("version = 2\n{LENS}"));
    let (by_new_file, ..) = apply(&["--scene", "new.toml"]);
    assert!(by_option == by_default && by_option == by_new_file);
    assert_eq!(report["scene"]["sources"], json!("photo"));
    assert_eq!(report["scene"]["ghosts"], json!(PIXELS));
    let (predicted, measured) = (report["error"]["predicted"].as_f64(), report["error"]["measured"].as_f64());
    assert!(measured <= predicted && predicted <= Some(1e-3), "{measured:?} {predicted:?}");
    assert!(said.contains(&format!("{PIXELS} pixels")), "{said}");
    let (by_lights, report, _) = apply(&["--lens", "lens.toml", "--sources", "lights"]);
    assert!(by_lights != by_option && report["scene"]["sources"] == json!("lights"));
    let warned = place.vglare(&[
        "apply",
        "in.exr",
        "-o",
        "out.exr",
        "--force",
        "--sources",
        "photo",
        "--lens",
        "lens.toml",
        "--merge",
        "0.1",
    ]);
    assert!(warned.succeeded().stderr().contains("change nothing where every pixel is a source"));
}

#[test]
fn what_contradicts_the_whole_photo_is_refused() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text("lens.toml", LENS);
    place.text("lights.toml", "[[light]]\nposition = [0, 0]\nflux = [1, 1, 1]\n");
    let refused = |code: i32, options: &[&str], expected: &str| {
        let mut args = vec!["apply", "in.exr", "-o", "out.exr", "--sources", "photo", "--lens", "lens.toml"];
        args.extend(options);
        place.vglare(&args).failed(code, &[expected]);
        assert!(!place.path("out.exr").exists());
    };
    refused(2, &["--lights", "lights.toml"], "--sources photo cannot be used with --lights");
    refused(2, &["--max-lights", "7"], "--sources photo cannot be used with --max-lights");
    refused(1, &["--evaluator", "direct"], "give --sources lights, or another evaluator");
}

/// A lamp of four columns that moves to the left, and out of the picture.
#[test]
fn with_overscan_a_lamp_that_leaves_the_picture_keeps_its_glare() {
    let place = Workplace::new();
    place.text("lens.toml", "[[lens_ghost]]\nalong = 1\nsize = 0.5\nshare = 0.1\n");
    let mean = |lamp: i32, options: &[&str], size: [u32; 2]| {
        let light =
            |k: i32| if (lamp..lamp + 4).contains(&(k % 100)) && (30..50).contains(&(k / 100)) { 50.0 } else { 0.0 };
        let pixels = (0..100 * 80).map(|k| [light(k), light(k), light(k), 1.0]).collect();
        place.write("in.exr", &vglare::photo::Photo::new(100, 80, pixels));
        let mut args =
            vec!["apply", "in.exr", "-o", "out.pfm", "--glare", "glare.pfm", "--force", "--lens", "lens.toml"];
        args.extend(options);
        place.vglare(&args).succeeded();
        let glare = vglare::photo::read(&place.path("glare.pfm")).expect("the glare");
        assert_eq!([glare.width(), glare.height()], size);
        glare.pixels.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>() / glare.pixels.len() as f64
    };
    let over = ["--overscan", "0.1"];
    let steps = [14, 12, 10, 8, 6].map(|lamp| mean(lamp, &over, [80, 64]));
    for pair in steps.windows(2) {
        assert!(pair[1] < pair[0] && pair[1] > 0.8 * pair[0], "{steps:?}");
    }
    // The same pixels without what lies beyond.
    assert!(mean(-4, &[], [100, 80]) == 0.0);
    // What is beyond stays in OpenEXR, beyond its display window, and is what it was.
    let args = ["apply", "in.exr", "-o", "out.exr", "--overscan", "0.1", "--strength", "0"];
    place.vglare(&args).succeeded();
    let kept = vglare::photo::read(&place.path("out.exr")).expect("the picture");
    assert_eq!((kept.width(), kept.height(), kept.pixels.len()), (80, 64, 100 * 80));
    assert_eq!((kept.frame.window.x, kept.frame.window.y), (-10, -8));
    for wrong in ["0.5", "-0.1", "nan", "much"] {
        place.vglare(&["apply", "in.exr", "-o", "no.exr", "--overscan", wrong]).failed(2, &["--overscan"]);
    }
}
