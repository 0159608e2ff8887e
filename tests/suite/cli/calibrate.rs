//! What is measured of a machine, kept, used, forgotten, and never trusted blindly.

use serde_json::{Value, json};
use vglare::plan::CostModel;

use super::Workplace;

const FILE: &str = "cache/calibration.json";

/// A calibration for the renderer that is there, with some constants.
fn keep(place: &Workplace, version: &str, nanoseconds: &Value) {
    let info = &place.json(&["info", "--json"])["backends"][0]["info"];
    let entry =
        json!({"vglare": version, "renderer": info["renderer"], "driver": info["version"], "nanoseconds": nanoseconds});
    std::fs::create_dir_all(place.path("cache")).expect("a folder");
    place.text(FILE, &json!({"calibrations": [entry]}).to_string());
}

fn constants(change: impl FnOnce(&mut CostModel)) -> Value {
    let mut model = CostModel::default();
    change(&mut model);
    serde_json::to_value(model).expect("JSON")
}

#[test]
fn what_is_measured_is_kept_used_and_forgotten() {
    let place = Workplace::new();
    place.photo("in.exr");
    let dry = place.vglare(&["calibrate", "--rounds", "2", "--dry-run"]).succeeded().stdout();
    assert!(dry.contains("dry run") && !place.path("cache").exists(), "{dry}");

    let said = place.vglare(&["calibrate", "--rounds", "2"]).succeeded().stdout();
    for name in CostModel::NAMES {
        assert!(said.contains(name) && dry.contains(name), "{name}: {said}");
    }
    let kept = place.read_json(FILE);
    let measured = &kept["calibrations"][0]["nanoseconds"];
    let model: CostModel = serde_json::from_value(measured.clone()).expect("a cost model");
    assert!(model.is_sound() && model != CostModel::default(), "{model:?}");

    let plan = place.json(&["plan", "in.exr", "--json"]);
    assert_eq!((&plan["model"]["source"], &plan["model"]["nanoseconds"]), (&json!("calibrated"), measured));
    let apply = ["apply", "in.exr", "-o", "out.exr", "-v", "--report", "report.json", "--force"];
    let summary = place.vglare(&apply).succeeded().stdout();
    assert!(summary.contains("vglare calibrate measured here") && summary.contains(FILE), "{summary}");
    assert_eq!(place.read_json("report.json")["cost"]["model"]["source"], "calibrated");
    let plain = place.json(&["plan", "in.exr", "--json", "--no-calibration"]);
    assert_eq!(plain["model"]["source"], "built-in");

    place.vglare(&["calibrate", "--forget"]).succeeded();
    assert!(!place.path(FILE).exists());
    assert_eq!(place.json(&["plan", "in.exr", "--json"])["model"]["source"], "built-in");
    let again = place.vglare(&["calibrate", "--forget"]).succeeded().stdout();
    assert!(again.contains("nothing"), "{again}");
}

#[test]
fn what_was_kept_decides_for_its_renderer_and_version_only() {
    let place = Workplace::new();
    place.photo("in.exr");
    // Gaussians of few lights, which `grid` sums sooner unless bells cost nothing.
    let line = "plan in.exr --preset v1/classic-prime --sources lights --json --size 1920x1280";
    let line: Vec<&str> = line.split(' ').collect();
    let plan = |more: &[&str]| place.json(&[&line[..], more].concat());
    assert_eq!(plan(&[])["plan"]["evaluator"], "grid", "or the rest shows nothing");
    let cheap_bells = constants(|model| model.bell = 1e-6);
    keep(&place, env!("CARGO_PKG_VERSION"), &cheap_bells);
    assert_eq!(plan(&[])["plan"]["evaluator"], "direct");
    assert_eq!(plan(&["--no-calibration"])["plan"]["evaluator"], "grid");
    // One from before spectra were gathered knows nothing of moments.
    let mut older = cheap_bells.clone();
    older.as_object_mut().expect("an object").remove("moment");
    keep(&place, env!("CARGO_PKG_VERSION"), &older);
    let by_older = plan(&[]);
    assert_eq!(
        (&by_older["plan"]["evaluator"], &by_older["model"]["source"]),
        (&json!("direct"), &json!("calibrated"))
    );
    // And one from before there was `local` says so; what it lacks is to the others as it is in the built-in model.
    let mut before = constants(|model| *model = CostModel::from_values(model.values().map(|value| 0.5 * value)));
    for name in ["splat", "quad", "canvas"] {
        before.as_object_mut().expect("an object").remove(name);
    }
    keep(&place, env!("CARGO_PKG_VERSION"), &before);
    let by_old = place.vglare(&["plan", "in.exr", "--json"]).succeeded();
    assert!(by_old.stderr().contains("before there was `local`"), "{}", by_old.stderr());
    let by_old: Value = serde_json::from_str(&by_old.stdout()).expect("JSON");
    let of_local =
        ["splat", "quad", "canvas"].map(|name| by_old["model"]["nanoseconds"][name].as_f64().expect("a number"));
    let built_in = CostModel::default();
    assert_eq!(of_local, [built_in.splat, built_in.quad, built_in.canvas].map(|value| 0.5 * value));
    // So does one from before devices summed veils, which has nothing to say of the CPU.
    let mut before = constants(|model| *model = CostModel::from_values(model.values().map(|value| 0.5 * value)));
    for name in ["veil_add", "veil_tap", "veil_pixel"] {
        before.as_object_mut().expect("an object").remove(name);
    }
    keep(&place, env!("CARGO_PKG_VERSION"), &before);
    let by_old = place.vglare(&["plan", "in.exr", "--json"]).succeeded();
    assert!(by_old.stderr().contains("before devices summed veils"), "{}", by_old.stderr());
    let by_old: Value = serde_json::from_str(&by_old.stdout()).expect("JSON");
    let of_veils = ["veil_add", "veil_tap", "veil_pixel"]
        .map(|name| by_old["model"]["nanoseconds"][name].as_f64().expect("a number"));
    assert_eq!(of_veils, [built_in.veil_add, 0.5 * built_in.veil_tap, 0.5 * built_in.veil_pixel]);
    keep(&place, "0.0.0", &cheap_bells);
    let other = plan(&[]);
    assert_eq!((&other["plan"]["evaluator"], &other["model"]["source"]), (&json!("grid"), &json!("built-in")));
}

#[test]
fn a_damaged_file_is_a_warning_and_changes_nothing() {
    let place = Workplace::new();
    place.photo("in.exr");
    let expected = place.json(&["plan", "in.exr", "--json"]);
    let check = |what: &str| {
        let ran = place.vglare(&["plan", "in.exr", "--json"]).succeeded();
        assert!(
            ran.stderr().contains("warning") && ran.stderr().contains("calibration.json"),
            "{what}: {}",
            ran.stderr()
        );
        let got: Value = serde_json::from_str(&ran.stdout()).expect("JSON");
        assert_eq!(got, expected, "{what}");
    };
    std::fs::create_dir(place.path("cache")).expect("a folder");
    // Whoever reads it says so, whatever is wrong with it.
    place.text(FILE, "{");
    let apply = place.vglare(&["apply", "in.exr", "-o", "out.exr", "--quiet"]).succeeded();
    assert!(apply.stderr().contains("calibration.json"), "{}", apply.stderr());
    let silent = place.vglare(&["plan", "in.exr", "--no-calibration"]).succeeded();
    assert_eq!(silent.stderr(), "");
    for text in ["", "{", "[]", "null", "{\"calibrations\": 3}", "{\"lights\": []}", "\u{0}\u{1}"] {
        place.text(FILE, text);
        check(text);
    }
    for wrong in [0.0, -3.0] {
        keep(&place, env!("CARGO_PKG_VERSION"), &constants(|model| model.strip = wrong));
        check(&format!("a time of {wrong}"));
    }
    let mut foreign = constants(|_| ());
    foreign["teapots"] = json!(1.0);
    keep(&place, env!("CARGO_PKG_VERSION"), &foreign);
    check("a constant that there is not");
    // What is measured anew replaces it.
    let ran = place.vglare(&["calibrate", "--rounds", "2"]).succeeded();
    assert!(ran.stderr().contains("replaced"), "{}", ran.stderr());
    assert_eq!(place.json(&["plan", "in.exr", "--json"])["model"]["source"], "calibrated");
    std::fs::remove_file(place.path(FILE)).expect("a file");
    std::fs::create_dir(place.path(FILE)).expect("a folder");
    check("a folder");
}

#[test]
fn a_cache_that_cannot_be_written_is_an_error_before_anything_is_measured() {
    let place = Workplace::new();
    place.text("cache", "a file where the folder should be");
    place.vglare(&["calibrate"]).failed(1, &["cannot write", "cache: "]);
    place.vglare(&["calibrate", "--forget", "--dry-run"]).failed(2, &["--forget"]);
    place.vglare(&["calibrate", "--rounds", "0"]).failed(2, &["rounds"]);
}
