//! Real lenses by name, by file and by scene file.

use serde_json::Value;

use super::Workplace;

impl Workplace {
    /// The bytes of the glare that these options give of the photo, and the report.
    fn through(&self, options: &[&str]) -> (Vec<u8>, Value) {
        let mut args =
            vec!["apply", "in.exr", "--glare", "glare.exr", "--report", "report.json", "--force", "--no-calibration"];
        args.extend(options);
        self.vglare(&args).succeeded();
        (std::fs::read(self.path("glare.exr")).expect("the glare"), self.read_json("report.json"))
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
