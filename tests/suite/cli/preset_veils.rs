//! Presets that name a veil beside their ghosts, or in their place.

use serde_json::json;
use vglare::frame::{Frame, Window};
use vglare::photo::{self, Photo};

use super::Workplace;

/// As high as is needed for pixels that are finer than the eye's core.
const SIDE: usize = 512;

/// Black but for one pixel.
fn point() -> Photo {
    let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; SIDE * SIDE];
    pixels[256 * SIDE + 128] = [1e4, 1e4, 1e4, 1.0];
    Photo::new(SIDE as u32, SIDE as u32, pixels)
}

#[test]
fn the_eye_sees_a_glow_around_every_pixel() {
    let place = Workplace::new();
    place.write("in.exr", &point());
    let line = ["apply", "in.exr", "--glare", "veil.exr", "--preset", "eye", "--report", "report.json", "--force"];
    let said = place.vglare(&line).succeeded().stdout();
    assert!(said.contains("eye: a veil in place of its ghosts"), "{said}");
    let report = place.read_json("report.json");
    assert_eq!((&report["veil"]["psf"], &report["plan"]), (&json!("mixture"), &json!(null)));
    let veil = photo::read(&place.path("veil.exr")).unwrap();
    // 40 degrees in 512 pixels; Spencer's photopic function (1995, eq. 5) beyond its core.
    let pitch = 40.0 / SIDE as f64;
    for pixels in [2, 3, 5, 10, 30, 100, 300] {
        let degrees = pitch * pixels as f64;
        let spencer = 0.478 * 20.91 / (degrees + 0.02f64).powi(3) + 0.138 * 72.37 / (degrees + 0.02).powi(2);
        let value = f64::from(veil.pixels[256 * SIDE + 128 + pixels][1]);
        let ratio = value / (1e4 * pitch.to_radians().powi(2) * spencer);
        assert!((ratio - 1.0).abs() < 0.02, "{degrees}: {ratio}");
    }
}

#[test]
fn a_lens_has_its_veil_unless_somebody_says_otherwise() {
    let place = Workplace::new();
    place.photo("in.exr");
    let run = |options: &str| {
        let line = ["apply", "in.exr", "-o", "out.exr", "--report", "report.json", "--force", "--no-calibration"];
        place.vglare(&line.into_iter().chain(options.split_whitespace()).collect::<Vec<_>>()).succeeded();
        let report = place.read_json("report.json");
        let ghosts = report["scene"]["ghosts"].as_u64().unwrap();
        (report["veil"]["psf"].as_str().map(str::to_owned), ghosts > 0, std::fs::read(place.path("out.exr")).unwrap())
    };
    place.text("eye.toml", "version = 2\npreset = \"eye\"\n");
    place.text("ghosts.toml", "version = 2\npreset = \"eye\"\n[veil]\npsf = \"none\"\n");
    place.text("own.toml", "version = 2\npreset = \"eye\"\n[veil]\npsf = \"gaussian\"\nwidth = 0.1\nscatter = 0.1\n");
    let told = |options: &str| {
        let (veil, ghosts, _) = run(options);
        (veil.unwrap_or_default(), ghosts)
    };
    for (options, veil, ghosts) in [
        ("--preset eye", "mixture", false),
        ("--preset eye --veil none", "", true),
        ("--preset eye --veil stiles-holladay --fov 40 --projection planar", "stiles-holladay", false),
        ("--preset classic-veil", "camera", true),
        ("--preset haze-filter", "mixture", false),
        ("--preset v1/classic-prime", "", true),
        ("--preset v1/eye", "", true),
        ("--preset v1/classic-veil", "camera", true),
        ("--scene eye.toml", "mixture", false),
        ("--scene ghosts.toml", "", true),
        ("--scene own.toml", "gaussian", false),
        ("--scene own.toml --preset classic-veil", "gaussian", true),
        ("--scene eye.toml --preset v1/zoom", "", true),
        ("--scene eye.toml --lens none --veil none", "", false),
    ] {
        assert_eq!(told(options), (veil.to_owned(), ghosts), "{options}");
    }
    // A preset's own file does what the preset does.
    place.text("mine.toml", &place.vglare(&["presets", "eye"]).succeeded().stdout());
    assert!(run("--preset eye").2 == run("--lens mine.toml").2);
    for (file, text, words) in [
        ("both.toml", "[veil]\npsf = \"none\"\nage = 30\n", "veil.age"),
        ("scene.toml", "[veil]\npsf = \"cie\"\nfov = 50\nreplaces_ghosts = true\n", "replaces_ghosts"),
    ] {
        place.text(file, text);
        place.vglare(&["apply", "in.exr", "-o", "o.exr", "--scene", file]).failed(1, &[file, words]);
    }
    let lens = "[veil]\npsf = \"camera\"\nreplaces_ghosts = 1\n[[lens_ghost]]\nalong = 1\nsize = 1\nshare = 0.1\n";
    place.text("lens.toml", lens);
    place.vglare(&["apply", "in.exr", "-o", "o.exr", "--lens", "lens.toml"]).failed(1, &["lens.toml", "true or false"]);
    let list = place.json(&["presets", "--json"]);
    let eye = list.as_array().unwrap().iter().find(|entry| entry["name"] == "eye").unwrap();
    assert!((eye["scatter"].as_f64().unwrap() - 0.3965).abs() < 1e-9 && eye["replaces_ghosts"] == json!(true));
}

#[test]
fn a_window_of_the_picture_has_the_veil_of_what_is_stored() {
    let place = Workplace::new();
    let (width, height, window) = (96, 64, Window { x: 10, y: -4, width: 60, height: 40 });
    let light = |at: usize| if at.is_multiple_of(37) { 5.0 } else { 0.1 };
    let stored = Photo {
        frame: Frame::full(width, height).with_window(window),
        pixels: (0..window.pixels()).map(|at| [light(at), light(at), 0.2, 1.0]).collect(),
        ..Photo::new(1, 1, vec![[0.0; 4]])
    };
    // The same alone, whose unit is another.
    let alone = Photo::new(window.width, window.height, stored.pixels.clone());
    place.write("window.exr", &stored);
    place.write("alone.exr", &alone);
    let veil = |name: &str, width: f64| {
        let width = width.to_string();
        let line = [
            "apply",
            name,
            "--glare",
            "veil.exr",
            "--lens",
            "none",
            "--veil",
            "gaussian",
            "--scatter",
            "0.1",
            "--force",
        ];
        place.vglare(&[&line[..], &["--width", &width, "--tolerance", "1e-3"]].concat()).succeeded();
        photo::read(&place.path("veil.exr")).unwrap().pixels
    };
    let (part, whole) =
        (veil("window.exr", 0.1), veil("alone.exr", 0.1 * f64::from(height) / f64::from(window.height)));
    assert!(part.iter().zip(&whole).all(|(a, b)| (0..3).all(|k| (a[k] / b[k] - 1.0).abs() < 2e-3)));
}

#[test]
fn a_look_that_is_larger_has_a_larger_veil() {
    let place = Workplace::new();
    place.photo("in.exr");
    let veil = |options: &str| {
        let line = "apply in.exr --glare veil.exr --lens none --force --veil gaussian --scatter 0.1 --tolerance 1e-3";
        place.vglare(&line.split(' ').chain(options.split(' ')).collect::<Vec<_>>()).succeeded();
        photo::read(&place.path("veil.exr")).unwrap().pixels
    };
    let (sized, wide) = (veil("--width 0.1 --size 2"), veil("--width 0.2"));
    assert!(sized.iter().zip(&wide).all(|(a, b)| (0..3).all(|k| (a[k] / b[k] - 1.0).abs() < 2e-3)));
}
