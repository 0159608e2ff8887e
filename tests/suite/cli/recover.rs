//! Clipped highlights shine brighter than they are shown.

use serde_json::json;
use vglare::photo::{self, Photo};

use super::Workplace;

const LENS: &str = "[[lens_ghost]]\nalong = -0.5\nsize = 0.4\ntint = [1.0, 1.0, 1.0]\nshare = 0.125\n";

/// A disc of this light in a grey room.
fn lamp(light: f32) -> Photo {
    let (width, height) = (160usize, 120usize);
    let inside = |at: usize| ((at % width) as f64 - 40.0).hypot((at / width) as f64 - 40.0) < 8.0;
    let pixels = (0..width * height).map(|at| if inside(at) { [light; 3] } else { [0.1; 3] });
    Photo::new(width as u32, height as u32, pixels.map(|[r, g, b]| [r, g, b, 1.0]).collect())
}

impl Workplace {
    /// What `vglare apply` says, and its report, of a photo by the lens of this test; the glare is in glare.pfm.
    fn glare(&self, photo: &str, options: &[&str]) -> (String, serde_json::Value) {
        let mut args =
            vec!["apply", photo, "-o", "out.exr", "--glare", "glare.pfm", "--report", "report.json", "--force"];
        args.push("--no-calibration");
        if !options.contains(&"--lens") {
            args.extend(["--lens", "lens.toml"]);
        }
        args.extend(options);
        let said = self.vglare(&args).succeeded().stdout();
        (said, self.read_json("report.json"))
    }

    /// The sum of the glare, and of the picture less that.
    fn sums(&self) -> [f64; 2] {
        let sum =
            |name| photo::read(&self.path(name)).unwrap().pixels.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>();
        let glare = sum("glare.pfm");
        [glare, sum("out.exr") - glare]
    }
}

#[test]
fn clipped_lamps_make_more_glare_and_the_picture_keeps_what_it_shows() {
    let place = Workplace::new();
    place.text("lens.toml", LENS);
    place.write("in.png", &lamp(40.0));
    for more in [&["--sources", "lights"][..], &["--sources", "photo"], &["--sources", "photo", "--threshold", "0.9"]] {
        let with = |recover: &str| {
            let options = [more, &["--recover", recover]].concat();
            let (said, report) = place.glare("in.png", &options);
            (said, report, place.sums())
        };
        let (said, report, [plain, shown]) = with("none");
        assert!(!said.contains("recovered"), "{said}");
        let nothing = json!({"asked": "none", "stops": 0.0, "pixels": 0, "clipped": 0, "share": 0.0, "note": null});
        assert_eq!(report["recover"], nothing);
        let (said, report, [glare, kept]) = with("4");
        let told = &report["recover"];
        assert!(said.contains("recovered: 193 clipped pixels shine up to 16 times as bright, which is "), "{said}");
        assert_eq!((&told["asked"], &told["pixels"], &told["stops"]), (&json!(4.0), &json!(193), &json!(4.0)));
        assert!(told["share"].as_f64().unwrap() > 0.3, "{told}");
        assert!((kept / shown - 1.0).abs() < 1e-5, "{kept} {shown}");
        // All of a rim is not as bright; a lamp that is brighter in its middle is smaller, and its ghosts fall into the picture.
        // Above a threshold, what is below it does not count.
        let most = if more.contains(&"--threshold") { 160.0 } else { 20.0 };
        assert!(glare > 1.5 * plain && glare < most * plain, "{more:?}: {glare} {plain}");
        let (said, _, [auto, _]) = with("auto");
        assert!(said.contains("up to 256 times as bright") && auto > 5.0 * glare, "{said}");
        let options = [more, &[]].concat();
        place.glare("in.png", &options);
        assert_eq!(place.sums()[0], auto, "auto is the default");
    }
}

#[test]
fn a_veil_is_of_what_shines() {
    let place = Workplace::new();
    place.text("lens.toml", LENS);
    place.write("in.png", &lamp(40.0));
    let veil = |recover: &str| {
        let (_, report) = place.glare(
            "in.png",
            &["--lens", "none", "--veil", "gaussian", "--width", "0.2", "--scatter", "0.1", "--recover", recover],
        );
        (place.sums()[0], report)
    };
    let ((plain, _), (glare, report)) = (veil("none"), veil("6"));
    // The room scatters, too.
    assert!(glare > 4.0 * plain, "{glare} {plain}");
    let ledger = &report["veil"]["ledger"];
    let part = |name: &str| ledger[name][1].as_f64().unwrap();
    assert!(part("light") > 10.0 * part("inside") / 1.2 && part("lost") >= 0.0, "{ledger}");
}

#[test]
fn scene_linear_light_is_left_alone_unless_asked() {
    let place = Workplace::new();
    place.text("lens.toml", LENS);
    place.write("in.exr", &lamp(40.0));
    let (said, report) = place.glare("in.exr", &[]);
    assert!(!said.contains("recovered") && report["recover"]["pixels"] == json!(0), "{said}");
    let [plain, _] = place.sums();
    let (said, _) = place.glare("in.exr", &["--recover", "3"]);
    assert!(said.contains("recovered: 193 clipped pixels shine up to 8 times as bright"), "{said}");
    assert!(place.sums()[0] > 5.0 * plain);
}

#[test]
fn a_look_file_says_it_and_bad_values_are_refused() {
    let place = Workplace::new();
    place.text("lens.toml", LENS);
    place.write("in.png", &lamp(40.0));
    let (_, by_option) = place.glare("in.png", &["--recover", "2.5"]);
    let [glare, _] = place.sums();
    place.text("look.toml", "version = 2\n[look]\nunit = \"short-side\"\nrecover = 2.5\n");
    let (_, by_file) = place.glare("in.png", &["--scene", "look.toml"]);
    assert_eq!((&by_file["recover"], place.sums()[0]), (&by_option["recover"], glare));
    // Options win.
    let (_, none) = place.glare("in.png", &["--scene", "look.toml", "--recover", "none"]);
    assert_eq!(none["recover"]["pixels"], json!(0));
    for word in ["\"auto\"", "\"none\"", "0", "20"] {
        place.text("look.toml", &format!("[look]\nrecover = {word}\n"));
        place.glare("in.png", &["--scene", "look.toml"]);
    }
    for bad in ["-1", "21", "nan", "\"some\"", "true"] {
        place.text("look.toml", &format!("[look]\nrecover = {bad}\n"));
        let ran = place.vglare(&["apply", "in.png", "-o", "bad.exr", "--scene", "look.toml"]);
        ran.failed(1, &["look.toml", "line 2", "a number of stops from 0 to 20"]);
    }
    for bad in ["-1", "20.1", "nan", "some", ""] {
        let ran = place.vglare(&["apply", "in.png", "-o", "bad.exr", "--recover", bad]);
        ran.failed(2, &["--recover", "a number of stops from 0 to 20"]);
    }
    assert!(!place.path("bad.exr").exists());
}

#[test]
fn what_is_clipped_everywhere_stays_and_is_told() {
    let place = Workplace::new();
    place.text("lens.toml", LENS);
    for (name, size) in [("dot.png", 1), ("white.png", 20)] {
        place.write(name, &Photo::new(size, size, vec![[40.0, 40.0, 40.0, 1.0]; (size * size) as usize]));
        let (said, report) = place.glare(name, &["--sources", "photo"]);
        assert!(said.contains("recovered: nothing of ") && said.contains("all of the picture is clipped"), "{said}");
        assert_eq!(report["recover"]["pixels"], json!(0));
    }
}
