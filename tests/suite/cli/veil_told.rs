//! What is told of a veil: by what it is summed, what becomes of the light, what changes nothing, and what no number can be.

use serde_json::{Value, json};
use vglare::photo::Photo;

use super::Workplace;

const WIDTH: usize = 96;

/// Dim, with a lamp.
fn lamp() -> Photo {
    let mut pixels = vec![[0.02, 0.02, 0.02, 1.0]; WIDTH * 64];
    pixels[20 * WIDTH + 30] = [50.0, 40.0, 30.0, 1.0];
    Photo::new(WIDTH as u32, 64, pixels)
}

impl Workplace {
    /// What is said and reported of a veil alone.
    fn told(&self, veil: &str) -> (String, Value) {
        let mut line = vec![
            "apply",
            "in.exr",
            "--glare",
            "out.exr",
            "--force",
            "--lens",
            "none",
            "--report",
            "report.json",
            "--veil",
        ];
        line.extend(veil.split(' '));
        let said = self.vglare(&line).succeeded().stdout();
        (said, self.read_json("report.json")["veil"].clone())
    }

    /// What is said and reported of the plan of a veil alone.
    fn planned(&self, veil: &str) -> (String, Value) {
        let mut line = vec!["plan", "in.exr", "--lens", "none", "--veil"];
        line.extend(veil.split(' '));
        let said = self.vglare(&line).succeeded().stdout();
        line.push("--json");
        (said, self.json(&line)["veil"].clone())
    }
}

#[test]
fn it_says_by_what_it_is_summed() {
    let place = Workplace::new();
    place.write("in.exr", &lamp());
    place.write("star.exr", &Photo::new(5, 5, (0..25).map(|k| [1.0 + k as f32, 1.0, 2.0, 1.0]).collect()));
    place.text("ring.csv", "0,1e-3\n0.2,1\n0.3,1\n0.31,1e-3\n");
    for (veil, ways) in [
        ("gaussian --width 0.2 --scatter 0.1 --tolerance 1e-2", &["pyramid", "transform", "sum"][..]),
        ("cie --fov 40", &["sphere", "sum"]),
        ("kernel --kernel star.exr --scatter 0.1", &["transform", "sum"]),
        ("table --table ring.csv --scatter 0.1", &["transform", "sum"]),
        ("starburst --fstop 16", &["transform", "sum"]),
    ] {
        for (said, veil) in [place.told(veil), place.planned(veil)] {
            let by = veil["summed_by"].as_str().unwrap();
            assert!(ways.contains(&by) && said.contains(by), "{veil}: {said}");
            // Gaussians are told where there are some, and are what is summed.
            let has_gaussians = ["pyramid", "sphere"].contains(&by);
            assert_eq!(said.contains("Gaussian"), has_gaussians, "{said}");
            assert!(has_gaussians || !said.contains("left out"), "{said}");
        }
    }
    // Of ghosts that there are none of nothing is told.
    let (said, _) = place.planned("cie --fov 40");
    assert!(!said.contains("(total)") && !said.contains("chosen "), "{said}");
    let with_ghosts =
        place.vglare(&["plan", "in.exr", "--veil", "cie", "--fov", "40", "--firefly-limit", "0"]).succeeded().stdout();
    assert!(with_ghosts.contains("(total)") && with_ghosts.contains("chosen "), "{with_ghosts}");
}

#[test]
fn light_that_the_definition_adds_is_no_negative_share() {
    let place = Workplace::new();
    place.write("in.exr", &lamp());
    for (veil, words) in [
        // A pixel is many times as wide as the core of an eye's function.
        ("cie --fov 170", "more than there was: pixels are coarser than the function's core"),
        ("gaussian --width 0.1 --scatter 0.2 --mix add", "more than there was: the veil is added"),
        ("gaussian --width 0.5 --scatter 0.2", "leaves it"),
        ("gaussian --width 0.05 --scatter 0.2", "leaves it"),
    ] {
        let (said, told) = place.told(veil);
        let light = said.lines().find(|line| line.starts_with("light")).unwrap();
        assert!(light.contains(words) && !light.contains("-"), "{veil}: {light}");
        for channel in 0..3 {
            let part = |name: &str| told["ledger"][name][channel].as_f64().unwrap();
            assert_eq!(part("gained"), (-part("lost")).max(0.0));
            let sum = part("kept") + part("inside") + part("lost");
            assert!((sum - part("light")).abs() < 1e-9 * part("light"));
        }
    }
}

#[test]
fn a_size_that_changes_nothing_is_told() {
    let place = Workplace::new();
    place.write("in.exr", &lamp());
    place.write("star.exr", &Photo::new(5, 5, vec![[1.0; 4]; 25]));
    for (veil, words) in [
        ("kernel --kernel star.exr --scatter 0.1", Some("kernel, is a picture")),
        ("cie --fov 40", Some("cie, is in degrees")),
        ("starburst --fstop 16", Some("starburst, is as large as the f-number")),
        ("gaussian --width 0.1 --scatter 0.1", None),
    ] {
        let (plain, sized) = (place.told(veil), place.told(&format!("{veil} --size 2")));
        let is_told = |(said, veil): &(String, Value)| {
            let notes = veil["notes"].to_string();
            (said.contains("note     a size of 2"), words.is_some_and(|words| notes.contains(words)))
        };
        assert_eq!(is_told(&plain), (false, false), "{veil}");
        assert_eq!(is_told(&sized), (words.is_some(), words.is_some()), "{}", sized.0);
    }
}

#[test]
fn a_sum_that_no_float_holds_is_of_the_picture() {
    let place = Workplace::new();
    let mut photo = lamp();
    photo.pixels[30 * WIDTH + 50] = [3.0e38, 1.0, 1.0, 1.0];
    place.write("in.exr", &photo);
    // The veil is finite, and the pixel keeps more than it had.
    let line = ["apply", "in.exr", "-o", "out.exr", "--lens", "none", "--veil", "cie", "--fov", "170"];
    place.vglare(&line).failed(1, &["the picture is infinite", "at 1 pixel where", "nothing is written"]);
    assert!(!place.files().contains(&"out.exr".to_owned()));
}

#[test]
fn a_panorama_is_warned_of_its_seam() {
    let place = Workplace::new();
    let turn = std::f64::consts::TAU / 128.0;
    let world = |part: f64| {
        let value = move |at: usize| {
            let (x, y) = ((at % 128) as f64 * turn * part, (at / 128) as f64 / 64.0);
            (2.0 * (x + 0.4).sin() + (3.0 * x - 5.0 * y).cos() - 3.0 * y).exp() as f32
        };
        Photo::new(128, 64, (0..128 * 64).map(value).map(|value| [value, value, value, 1.0]).collect())
    };
    place.write("all.exr", &world(1.0));
    place.write("half.exr", &world(0.5));
    let warned = |photo: &str, options: &str| {
        let mut line = vec!["apply", photo, "-o", "out.exr", "--force"];
        line.extend(options.split(' '));
        place.vglare(&line).succeeded().stderr().contains("the seam will show")
    };
    let veil = "--veil camera --lens none";
    assert_eq!([warned("all.exr", veil), warned("half.exr", veil)], [true, false]);
    assert!(!warned("all.exr", "--lens none --veil none") && !warned("all.exr", "--veil camera --strength 0"));
}

#[test]
fn a_veil_is_traded_with_and_without_ghosts() {
    let place = Workplace::new();
    place.write("in.exr", &lamp());
    let line = ["tradeoff", "in.exr", "--quick", "-o", "trade", "--veil", "cie", "--fov", "40", "--lens", "none"];
    let said = place.vglare(&line).succeeded().stdout();
    assert!(said.contains("The veil at 96 × 64") && said.contains("1e-3") && !said.contains("planner"), "{said}");
    let results = place.read_json("trade/results.json");
    assert_eq!((&results["ghosts"], &results["recommendation"]), (&json!(0), &Value::Null));
    let points = results["points"].as_array().unwrap();
    assert_eq!((points.len(), results["veil_front"].as_array().map(Vec::is_empty)), (3, Some(false)));
    for point in points {
        let number = |key: &str| point[key].as_f64().unwrap();
        assert!(
            point["sweep"] == "veil"
                && number("measured") <= number("predicted")
                && number("predicted") <= number("asked")
        );
        assert!(said.contains(point["summed_by"].as_str().unwrap()), "{said}");
    }
    let page = std::fs::read_to_string(place.path("trade/index.html")).unwrap();
    assert!(
        page.contains("<h2>The veil</h2>") && page.contains("veil-error-against-time") && !page.contains("No plan")
    );
    // Nothing glares without either.
    let nothing = ["tradeoff", "in.exr", "--quick", "-o", "new", "--lens", "none"];
    place.vglare(&nothing).failed(2, &["nothing glares in in.exr"]);
}
