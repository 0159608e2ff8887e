//! A look in a file is the same look in options, and options win.

use serde_json::json;
use vglare::gpu::{Backend, Device};
use vglare::job::{Computer, Found, Known, Stages, Unwatched, Wanted};
use vglare::look::Look;
use vglare::photo::{self, WriteOptions};
use vglare::scene::read_scene;

use super::Workplace;
use crate::support::turn;

/// Two lights and a lens whose numbers survive halving and doubling.
const SCENE: &str = "\
[[light]]
position = [0.5, 0.25]
flux = [8.0, 4.0, 2.0]
[[light]]
position = [-0.75, -0.5]
flux = [1.0, 2.0, 4.0]
";

fn lens(size: f64, tint: [f64; 3]) -> String {
    format!("[[lens_ghost]]\nalong = -0.5\nsize = {size}\ntint = {tint:?}\nshare = 0.125\n")
}

impl Workplace {
    /// The bytes of the picture that these options give of the photo.
    fn applied(&self, options: &[&str]) -> Vec<u8> {
        let mut args = vec!["apply", "in.exr", "-o", "out.pfm", "--force", "--no-calibration"];
        args.extend(options);
        self.vglare(&args).succeeded();
        std::fs::read(self.path("out.pfm")).expect("the picture")
    }
}

#[test]
fn a_look_file_needs_no_options() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text(
        "look.toml",
        "version = 2\npreset = \"v1/zoom\"\naxis = [-0.2, 0.1]\nperiod = [6, 5]\ndegree = [24, 20]\n[look]\nstrength = 1.5\n\
         size = 0.8\ntint = [1, 0.9, 0.7]\nnormalize = \"minmax\"\n[find]\nthreshold = 50\nmerge = 0\nmax_lights = 1\n\
         [accuracy]\ntolerance = 0.01\nevaluator = \"series\"\n",
    );
    let all = "--preset v1/zoom --axis -0.2,0.1 --period 6,5 --degree 24,20 --strength 1.5 --size 0.8 --tint 1,0.9,0.7 \
               --normalize minmax --threshold 50 --merge 0 --max-lights 1 --tolerance 0.01 --evaluator series";
    let options: Vec<&str> = all.split_whitespace().collect();
    let from_file = place.applied(&["--scene", "look.toml", "--report", "report.json"]);
    assert!(from_file == place.applied(&options));
    // Each of the others matters here by itself.
    for pair in options.chunks(2).filter(|pair| !["--merge", "--threshold", "--tolerance"].contains(&pair[0])) {
        let rest: Vec<&str> = options.chunks(2).filter(|other| *other != pair).flatten().copied().collect();
        // The lens by default has a veil, of which no minmax is to be had.
        assert!(from_file != place.applied(&[&rest[..], &["--veil", "none"]].concat()), "{pair:?} changes nothing");
    }
    let report = place.read_json("report.json");
    assert_eq!(
        (&report["strength"], &report["size"], &report["tint"]),
        (&json!(1.5), &json!(0.8), &json!([1.0, 0.9, 0.7]))
    );
    assert_eq!((&report["normalize"], &report["mix"]), (&json!("minmax"), &json!("add")));
    assert_eq!((&report["scene"]["axis"], &report["scene"]["lens"]), (&json!([-0.2, 0.1]), &json!("v1/zoom")));
    assert_eq!((&report["scene"]["threshold"], &report["error"]["asked"]), (&json!(50.0), &json!(0.01)));
}

#[test]
fn a_look_gives_the_same_bytes_without_a_command_line() {
    let place = Workplace::new();
    let photo = place.photo("in.exr");
    let _turn = turn();
    let device = Device::open(&Backend::ALL).unwrap_or_else(|error| panic!("this test needs GL: {error}"));
    let mut computer = Computer::new(device, Known::default());
    for text in [
        "preset = \"zoom\"\n[look]\nsize = 0.7\nmix = \"energy\"\n",
        &format!("{SCENE}muted = true\n[look]\nnormalize = \"minmax\"\n[accuracy]\nevaluator = \"direct\"\n"),
        "[look]\nstrength = 0\n",
    ] {
        let look = Look::from_scene(read_scene(&place.text("look.toml", text)).unwrap()).unwrap();
        let found = Found::new(&look, photo::read(&photo).unwrap(), Stages::default()).unwrap();
        let done = found.compute(Some(&mut computer), Wanted::default(), &Unwatched).unwrap();
        let path = place.path("job.pfm");
        photo::write(&path, &done.picture.unwrap(), &WriteOptions { overwrite: true, ..WriteOptions::default() })
            .unwrap();
        assert!(std::fs::read(path).unwrap() == place.applied(&["--scene", "look.toml"]), "{text}");
        assert_eq!(done.computed.is_some(), look.strength != 0.0);
    }
}

#[test]
fn options_win_over_the_file() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text(
        "look.toml",
        "axis = [0.5, 0]\nlight = []\n[look]\nstrength = 0\nsize = 3\ntint = [0, 0, 1]\nmix = \"energy\"\n\
         [find]\nthreshold = 1e9\n[accuracy]\nbudget = 1000\n[[lens_ghost]]\nalong = 1\nsize = 1\nshare = 1\n",
    );
    place.text("lights.toml", SCENE);
    let back = "--axis 0,0 --lights lights.toml --strength 1 --size 1 --tint 1,1,1 --mix add --tolerance 1e-3 --preset zoom --veil none";
    let mut options: Vec<&str> = back.split_whitespace().collect();
    // A veil is another where somebody asks to add it.
    let plain = place.applied(&["--lights", "lights.toml", "--preset", "zoom", "--veil", "none"]);
    options.extend(["--scene", "look.toml"]);
    assert!(plain == place.applied(&options));
    let bare = place.applied(&["--strength", "0"]);
    assert!(bare != plain && bare == place.applied(&["--scene", "look.toml"]));
    // No lights at all are not the same as none listed.
    assert!(bare == place.applied(&["--scene", "look.toml", "--strength", "1", "--mix", "add", "--tolerance", "0.1"]));
}

#[test]
fn muted_lights_make_no_ghosts() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text("both.toml", &format!("{SCENE}muted = true\n"));
    place.text("one.toml", SCENE.rsplit_once("[[light]]").unwrap().0);
    let muted = place.applied(&["--scene", "both.toml", "--report", "report.json"]);
    // A file without a version has the lens of then.
    assert!(muted == place.applied(&["--lights", "one.toml", "--preset", "v1/classic-prime"]));
    assert!(muted == place.applied(&["--lights", "both.toml", "--preset", "v1/classic-prime"]));
    let report = place.read_json("report.json");
    assert_eq!(
        (&report["scene"]["lights"][0]["muted"], &report["scene"]["lights"][1]["muted"]),
        (&json!(false), &json!(true))
    );
}

#[test]
fn size_and_tint_are_those_of_every_lens_ghost() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text("lights.toml", SCENE);
    place.text("plain.toml", &lens(0.25, [1.0; 3]));
    place.text("large.toml", &lens(0.5, [1.0; 3]));
    place.text("red.toml", &lens(0.25, [1.0, 0.5, 0.0]));
    let through =
        |lens: &str, more: &[&str]| place.applied(&[&["--lights", "lights.toml", "--lens", lens], more].concat());
    let plain = through("plain.toml", &[]);
    let (large, red) = (through("large.toml", &[]), through("red.toml", &[]));
    assert!(plain != large && plain != red);
    assert!(large == through("plain.toml", &["--size", "2"]));
    assert!(red == through("plain.toml", &["--tint", "1,0.5,0"]));
    assert!(plain == through("large.toml", &["--size", "0.5"]));
}

#[test]
fn plans_follow_the_look_too() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text(
        "look.toml",
        "preset = \"zoom\"\n[look]\nsize = 0.1\n[find]\nmax_lights = 1\n[accuracy]\ntolerance = 0.1\nevaluator = \"grid\"\n",
    );
    let plan = place.json(&["plan", "in.exr", "--scene", "look.toml", "--json"]);
    assert_eq!((&plan["lights"], &plan["plan"]["tolerance"]), (&json!(1), &json!(0.1)));
    let full = "plan in.exr --preset v1/zoom --tolerance 0.1 --max-lights 1 --evaluator grid --json";
    let again = place.json(&full.split(' ').collect::<Vec<_>>());
    assert_eq!(plan["ghosts"], again["ghosts"]);
    assert_ne!(plan["plan"]["period"], again["plan"]["period"], "a tenth of the size has a smaller reach");
}

#[test]
fn a_look_that_is_not_right_is_shown_in_its_line() {
    let place = Workplace::new();
    place.photo("in.exr");
    for (text, words) in [
        ("\n[look]\nsize = 0\n", ["line 3, column 8", "a positive finite number, found 0"]),
        ("preset = \"fish-eye\"\n", ["line 1, column 10", "fish-eye"]),
        ("[accuracy]\ntolerance = 0.1\nbudget = 3\n", ["line 3, column 10", "either `tolerance` or `budget`"]),
        ("[find]\nlimit = 3\n", ["line 2, column 1", "unknown field `limit`"]),
    ] {
        place.text("look.toml", text);
        let ran = place.vglare(&["apply", "in.exr", "-o", "out.exr", "--scene", "look.toml"]);
        ran.failed(1, &["look.toml", words[0], words[1]]);
    }
    for bad in [["--size", "0"], ["--tint", "1,1"], ["--tint", "1,-1,1"], ["--axis", "1"], ["--axis", "nan,0"]] {
        place.vglare(&["apply", "in.exr", "-o", "out.exr", bad[0], bad[1]]).failed(2, &[bad[0]]);
    }
    assert_eq!(place.files(), ["in.exr", "look.toml"]);
}
