//! Presets that name a veil beside their ghosts or alone, and lens files that name one in their place.

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
    assert!(said.contains("lens     none, so no ghosts") && said.contains("veil     mixture"), "{said}");
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
        let line = ["apply", "in.exr", "-o", "out.pfm", "--report", "report.json", "--force", "--no-calibration"];
        place.vglare(&line.into_iter().chain(options.split_whitespace()).collect::<Vec<_>>()).succeeded();
        let report = place.read_json("report.json");
        let ghosts = report["scene"]["ghosts"].as_u64().unwrap();
        (report["veil"]["psf"].as_str().map(str::to_owned), ghosts > 0, std::fs::read(place.path("out.pfm")).unwrap())
    };
    place.text("eye.toml", "version = 2\npreset = \"eye\"\n");
    place.text("first.toml", "preset = \"eye\"\n");
    place.text("ghosts.toml", "version = 2\npreset = \"zoom\"\n[veil]\npsf = \"none\"\n");
    place.text("own.toml", "version = 2\npreset = \"eye\"\n[veil]\npsf = \"gaussian\"\nwidth = 0.1\nscatter = 0.1\n");
    let told = |options: &str| {
        let (veil, ghosts, _) = run(options);
        (veil.unwrap_or_default(), ghosts)
    };
    for (options, veil, ghosts) in [
        // A lens of today has ghosts and a veil, and each can be had alone.
        ("", "camera", true),
        ("--veil none", "", true),
        ("--lens none", "", false),
        ("--veil camera --lens none", "camera", false),
        ("--veil stiles-holladay --fov 40 --projection planar", "stiles-holladay", true),
        ("--preset classic-prime", "camera", true),
        ("--preset modern-prime", "camera", true),
        ("--preset anamorphic", "camera", true),
        ("--preset zoom", "camera", true),
        ("--preset vintage-uncoated", "camera", true),
        // These are a veil alone, and nothing without it.
        ("--preset classic-veil", "camera", false),
        ("--preset haze-filter", "mixture", false),
        ("--preset eye", "mixture", false),
        ("--preset eye --veil none", "", false),
        ("--preset eye --veil stiles-holladay --fov 40 --projection planar", "stiles-holladay", false),
        // Those of version 1 had ghosts, and but for one no veil.
        ("--preset v1/classic-prime", "", true),
        ("--preset v1/eye", "", true),
        ("--preset v1/classic-veil", "camera", true),
        ("--scene first.toml", "", true),
        ("--scene first.toml --preset eye", "mixture", false),
        ("--scene eye.toml", "mixture", false),
        ("--scene ghosts.toml", "", true),
        ("--scene own.toml", "gaussian", false),
        ("--scene own.toml --preset classic-prime", "gaussian", true),
        ("--scene eye.toml --preset v1/zoom", "", true),
        ("--scene eye.toml --lens none --veil none", "", false),
    ] {
        assert_eq!(told(options), (veil.to_owned(), ghosts), "{options}");
    }
    // A preset's own file does what the preset does.
    for preset in ["eye", "classic-prime"] {
        place.text("mine.toml", &place.vglare(&["presets", preset]).succeeded().stdout());
        assert!(run(&format!("--preset {preset}")).2 == run("--lens mine.toml").2, "{preset}");
    }
    let list = place.json(&["presets", "--all", "--json"]);
    let told = |name: &str| list.as_array().unwrap().iter().find(|entry| entry["name"] == name).unwrap().clone();
    for (name, scatter, ghosts) in
        [("classic-prime", 0.02, 5), ("classic-veil", 0.02, 0), ("haze-filter", 0.12, 0), ("eye", 0.3965, 0)]
    {
        let entry = told(name);
        assert!((entry["scatter"].as_f64().unwrap() - scatter).abs() < 1e-9, "{entry}");
        assert_eq!((&entry["ghosts"], &entry["replaces_ghosts"]), (&json!(ghosts), &json!(false)), "{entry}");
        assert_eq!(told(&format!("v1/{name}"))["scatter"].is_null(), name != "classic-veil");
    }
}

#[test]
fn a_veil_that_replaces_ghosts_does_so_wherever_there_is_one() {
    let place = Workplace::new();
    place.photo("in.exr");
    let ghost = "[[lens_ghost]]\nalong = -0.5\nsize = 0.3\nshare = 0.05\n";
    let veil = "[veil]\npsf = \"camera\"\nscatter = 0.1\n";
    place.text("both.toml", &format!("{ghost}{veil}"));
    place.text("either.toml", &format!("{ghost}{veil}replaces_ghosts = true\n"));
    place.text("neither.toml", &format!("{ghost}{veil}replaces_ghosts = false\n"));
    place.text("bare.toml", ghost);
    place.text("alone.toml", veil);
    place.text("own.toml", "version = 2\n[veil]\npsf = \"gaussian\"\nwidth = 0.1\nscatter = 0.1\n");
    place.text("none.toml", "version = 2\n[veil]\npsf = \"none\"\n");
    let run = |options: &str| {
        let line = ["apply", "in.exr", "-o", "out.pfm", "--report", "report.json", "--force", "--no-calibration"];
        let line: Vec<_> = line.into_iter().chain(options.split_whitespace()).collect();
        let said = place.vglare(&line).succeeded().stdout();
        let report = place.read_json("report.json");
        let ghosts = report["scene"]["ghosts"].as_u64().unwrap();
        let veil = report["veil"]["psf"].as_str().unwrap_or_default().to_owned();
        (veil, ghosts > 0, std::fs::read(place.path("out.pfm")).unwrap(), said)
    };
    for (options, veil, ghosts) in [
        ("--lens either.toml", "camera", false),
        ("--lens either.toml --sources lights", "camera", false),
        ("--lens either.toml --veil none", "", true),
        ("--lens either.toml --veil gaussian --width 0.1 --scatter 0.1", "gaussian", false),
        ("--lens either.toml --scene own.toml", "gaussian", false),
        ("--lens either.toml --scene none.toml", "", true),
        ("--lens both.toml", "camera", true),
        ("--lens neither.toml", "camera", true),
    ] {
        let (got, has, _, said) = run(options);
        assert_eq!((&*got, has), (veil, ghosts), "{options}");
        let replaced = options.contains("--lens either") && !veil.is_empty();
        assert_eq!(said.contains("lens     either: a veil in place of its ghosts"), replaced, "{options}: {said}");
    }
    let same = |one: &str, other: &str| assert!(run(one).2 == run(other).2, "{one}, {other}");
    same("--lens either.toml", "--lens alone.toml");
    same("--lens either.toml --veil none", "--lens bare.toml");
    same("--lens both.toml", "--lens neither.toml");
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
