//! Real lenses by name, by file and by scene file.

use serde_json::Value;

use super::Workplace;

impl Workplace {
    /// The bytes of the glare that these options give of the photo, and the report.
    fn through(&self, options: &[&str]) -> (Vec<u8>, Value) {
        let mut args =
            vec!["apply", "in.exr", "--glare", "glare.pfm", "--report", "report.json", "--force", "--no-calibration"];
        args.extend(options);
        self.vglare(&args).succeeded();
        (std::fs::read(self.path("glare.pfm")).expect("the glare"), self.read_json("report.json"))
    }
}

/// The error that was measured is no more than what was predicted, and that no more than what was asked.
fn holds(report: &Value) {
    let [measured, predicted] = ["measured", "predicted"].map(|key| {
        let error = &report["error"][key];
        error.as_f64().or_else(|| error["total"].as_f64()).unwrap_or_else(|| panic!("{key}: {}", report["error"]))
    });
    assert!(measured <= predicted && predicted <= 1e-3, "{measured} {predicted}");
}

#[test]
fn a_real_lens_makes_its_ghosts_of_every_pixel() {
    let place = Workplace::new();
    place.photo("in.exr");
    let bare = ["--lens", "tessar", "--coating", "none", "--veil", "none"];
    let (wide, report) = place.through(&bare);
    holds(&report);
    let (coated, report) = place.through(&["--lens", "tessar", "--veil", "none"]);
    holds(&report);
    let (stopped, report) = place.through(&[&bare[..], &["--fstop", "8", "--blades", "5"]].concat());
    holds(&report);
    let (lights, _) = place.through(&[&bare[..], &["--sources", "lights"]].concat());
    assert!(wide != coated && wide != stopped && wide != lights);
    // By name there is a veil, by file there is none.
    assert!(place.through(&["--lens", "tessar"]).1["veil"]["psf"] == "camera");
    let zemax = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden-optics/double-gauss.zmx");
    let (_, report) = place.through(&["--lens", zemax, "--tolerance", "1e-3"]);
    holds(&report);
    assert!(report["veil"].is_null());
}

#[test]
fn a_scene_file_sets_a_lens_as_options_do() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text(
        "look.toml",
        "version = 2\n[optics]\nlens = \"tessar\"\nfstop = 5.6\nsensor = [24, 16]\ncoating = \"none\"\n",
    );
    let options = "--lens tessar --fstop 5.6 --sensor 24x16 --coating none";
    let options: Vec<&str> = options.split_whitespace().collect();
    let (from_file, _) = place.through(&["--scene", "look.toml"]);
    assert!(from_file == place.through(&options).0);
    // Options win over what the file says.
    let (other, _) = place.through(&["--scene", "look.toml", "--fstop", "11"]);
    assert!(other != from_file);
    let eleven: Vec<&str> = options.iter().map(|word| if *word == "5.6" { "11" } else { word }).collect();
    assert!(other == place.through(&eleven).0);
}

/// A preset by that name is the lens itself; one that is called like a preset is found as a lens alone.
#[test]
fn a_real_lens_is_a_preset_too() {
    let place = Workplace::new();
    place.photo("in.exr");
    let lens = place.through(&["--lens", "tessar", "--fstop", "8"]).0;
    assert!(lens == place.through(&["--preset", "tessar", "--fstop", "8"]).0);
    place.text("look.toml", "version = 2\npreset = \"tessar\"\n");
    assert!(lens == place.through(&["--scene", "look.toml", "--fstop", "8"]).0);
    assert!(place.through(&["--preset", "zoom"]).0 != place.through(&["--lens", "zoom"]).0);
    let list = place.json(&["presets", "--json"]);
    let named = |name: &str| list.as_array().unwrap().iter().filter(|entry| entry["name"] == name).count();
    assert_eq!([named("tessar"), named("zoom"), named("classic-prime")], [1, 1, 1]);
    let toml = place.vglare(&["presets", "tessar"]).succeeded().stdout();
    place.text("mine.toml", &toml);
    assert!(
        place.through(&["--lens", "mine.toml", "--fstop", "8", "--veil", "none"]).0
            == place.through(&["--lens", "tessar", "--fstop", "8", "--veil", "none"]).0
    );
    place.text("old.toml", "preset = \"tessar\"\n");
    place.vglare(&["apply", "in.exr", "-o", "out.exr", "--scene", "old.toml"]).failed(1, &["tessar", "classic-prime"]);
}

/// In a corner rims leave less of a lamp's ghosts than in the middle, whether it is a light or pixels.
#[test]
fn rims_cut_what_is_in_a_corner() {
    let place = Workplace::new();
    let (width, height) = (96, 54);
    let black = |lamp: Option<usize>| -> Vec<u8> {
        let mut bytes = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
        // Rows from the bottom.
        let pixel = |k: usize| if lamp == Some(k) { 50.0f32 } else { 0.0 };
        bytes.extend((0..width * height).flat_map(|k| [pixel(k); 3]).flat_map(f32::to_le_bytes));
        bytes
    };
    let glare = |name: &str, options: &[&str]| -> f64 {
        let base = [
            "apply",
            name,
            "--glare",
            "glare.pfm",
            "--force",
            "--veil",
            "none",
            "--lens",
            "double-gauss",
            "--no-calibration",
        ];
        place.vglare(&[&base[..], options].concat()).succeeded();
        let bytes = std::fs::read(place.path("glare.pfm")).unwrap();
        let values = bytes[bytes.len() - 12 * width * height..].as_chunks::<4>().0;
        values.iter().map(|value| f64::from(f32::from_le_bytes(*value))).sum()
    };
    let at = |column: usize, row: usize| row * width + column;
    for (name, lamp) in [("middle.pfm", at(48, 27)), ("corner.pfm", at(92, 3)), ("edge.pfm", at(92, 27))] {
        std::fs::write(place.path(name), black(Some(lamp))).unwrap();
    }
    let [middle, edge, corner] = ["middle.pfm", "edge.pfm", "corner.pfm"].map(|name| glare(name, &[]));
    assert!(edge < 0.8 * middle && corner < 0.8 * edge, "{middle} {edge} {corner}");
    // The same lamp as a light.
    std::fs::write(place.path("black.pfm"), black(None)).unwrap();
    let y = |row: f64| (2.0 * row + 1.0 - 54.0) / 54.0;
    let pixel = 2.0 / 54.0;
    for (x, row, wanted) in [(92.0, 27.0, edge), (92.0, 3.0, corner)] {
        let (x, y) = ((2.0 * x + 1.0 - 96.0) / 54.0, y(row));
        let flux = 50.0 * pixel * pixel;
        place.text(
            "lamp.toml",
            &format!(
                "[[light]]\nposition = [{x}, {y}]\nflux = [{flux}, {flux}, {flux}]\nsize = {}\n",
                pixel / 12f64.sqrt()
            ),
        );
        let found = glare("black.pfm", &["--lights", "lamp.toml"]);
        assert!((found / wanted - 1.0).abs() < 2e-3, "{found} {wanted}");
    }
}

#[test]
fn an_opening_is_the_lenss_and_the_starbursts() {
    let place = Workplace::new();
    place.photo("in.exr");
    let report = place.through(&["--lens", "tessar", "--fstop", "11", "--veil", "starburst"]).1;
    assert_eq!((&report["veil"]["psf"], &report["veil"]["fstop"]), (&"starburst".into(), &11.0.into()));
    for (options, word) in [
        (&["--fstop", "8"][..], "--veil starburst"),
        (&["--preset", "zoom", "--blades", "5"], "--veil starburst"),
        (&["--coating", "none"], "--lens"),
        (&["--preset", "zoom", "--focus", "2"], "surfaces"),
        (&["--lens", "anamorphic", "--focus", "2"], "surfaces"),
        (&["--lens", "tesar"], "did you mean tessar?"),
        (&["--lens", "tessar", "--fstop", "1.2"], "f/"),
        (&["--lens", "tessar", "--coating", "gold"], "mgf2"),
    ] {
        let args = [&["apply", "in.exr", "-o", "out.exr"][..], options].concat();
        let done = place.vglare(&args);
        assert!(done.code() != Some(0) && done.stderr().contains(word), "{options:?}: {}", done.stderr());
        assert!(!place.path("out.exr").exists());
    }
}
