//! `--each-pixel`: the tolerance holds of photo and glare wherever the picture is darkest.

use super::*;

/// A ghost in focus, ten thousand times as bright as five wide ones.
const SCENE: &str = "
    version = 2
    preset = 'classic-veil'
    light = []
    [[ghost]]
    center = [0.3, 0.2]
    size = 0.05
    radiance = [1000.0, 900.0, 800.0]
    [[ghost]]
    center = [-0.9, -0.4]
    size = [0.31, 0.22]
    radiance = [0.1, 0.2, 0.1]
    [[ghost]]
    center = [0.8, -0.5]
    size = [0.27, 0.35]
    radiance = [0.2, 0.1, 0.1]
";

fn apply(place: &Workplace, out: &str, more: &[&str]) -> (Photo, Value) {
    let report = format!("{out}.json");
    let mut args = vec!["apply", "dim.exr", "--scene", "look.toml", "-o", out, "--force", "--report", &report];
    args.extend(more);
    place.vglare(&args).succeeded();
    let read = photo::read(&place.path(out)).expect("what was written");
    (read, place.read_json(&report))
}

/// The largest difference over what there is, the worst colour and pixel.
fn off(picture: &Photo, truth: &Photo) -> f64 {
    let pixels = picture.pixels.iter().zip(&truth.pixels);
    let each =
        |(a, b): (&[f32; 4], &[f32; 4])| (0..3).map(|c| f64::from((a[c] - b[c]).abs() / b[c])).fold(0.0, f64::max);
    pixels.map(each).fold(0.0, f64::max)
}

#[test]
fn one_ghost_in_focus_excuses_no_other() {
    let place = Workplace::new();
    let pixels = (0..96 * 54).map(|k| [0.01 + 1e-4 * (k % 96) as f32, 0.012, 0.011, 1.0]).collect();
    place.write("dim.exr", &Photo::new(96, 54, pixels));
    place.text("look.toml", SCENE);
    let (truth, _) = apply(&place, "truth.exr", &["--tolerance", "2e-7", "--evaluator", "direct"]);
    let (of_largest, report) = apply(&place, "largest.exr", &["--tolerance", "1e-2", "--evaluator", "rows"]);
    assert!(report["each_pixel"].is_null());
    assert!(off(&of_largest, &truth) > 1e-2, "{:e}", off(&of_largest, &truth));
    let (of_each, report) = apply(&place, "each.exr", &["--tolerance", "1e-2", "--evaluator", "rows", "--each-pixel"]);
    let told = |key: &str| report["each_pixel"][key].as_f64().unwrap();
    assert!(off(&of_each, &truth) <= told("predicted"), "{:e} {}", off(&of_each, &truth), report["each_pixel"]);
    assert!(told("measured") <= told("predicted") && told("predicted") <= told("asked"), "{}", report["each_pixel"]);
    assert!(report["error"]["asked"].as_f64().unwrap() < 1e-4, "{}", report["error"]);
}

#[test]
fn what_has_no_measure_at_each_pixel_is_refused() {
    let place = Workplace::new();
    place.photo("night.exr");
    let ran =
        place.vglare(&["apply", "night.exr", "--each-pixel", "--normalize", "minmax", "--veil", "none", "-o", "o.exr"]);
    ran.failed(2, &["--normalize none"]);
    place.text("budget.toml", "preset = 'zoom'\n[accuracy]\nbudget = 20\neach_pixel = true\n");
    place.vglare(&["apply", "night.exr", "--scene", "budget.toml", "-o", "o.exr"]).failed(1, &["each_pixel"]);
}
