//! Plans that are only told, budgets instead of tolerances, the floor, and how precise the driver is.

use serde_json::Value;
use vglare::plan::{CostModel, LOOSEST};

use super::Workplace;

fn number(value: &Value, path: &str) -> f64 {
    value.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {path} in {value}"))
}

#[test]
fn a_plan_is_told_line_by_line_and_nothing_is_written() {
    let place = Workplace::new();
    place.photo("in.exr");
    // Of Gaussians, which every evaluator can sum.
    let line = "plan in.exr --size 1920x1280 --preset v1/classic-prime --sources lights";
    let text = place.vglare(&line.split(' ').collect::<Vec<_>>()).succeeded().stdout();
    for word in [
        "1920 x 1280",
        "2 lights through v1/classic-prime",
        "period",
        "degree",
        "groups",
        "lattice",
        "dropped",
        "periodisation",
        "truncation",
        "interpolation",
        "rounding",
        "total",
        "chosen",
        "rejected",
        "built-in",
        "65535 rounds",
    ] {
        assert!(text.contains(word), "{word:?} is not in: {text}");
    }
    for evaluator in ["direct", "series", "rows", "grid"] {
        assert!(text.contains(&format!(" {evaluator} ")), "{evaluator}: {text}");
    }
    assert_eq!(place.files(), ["in.exr"]);
}

#[test]
fn what_plan_tells_is_what_apply_does() {
    let place = Workplace::new();
    place.photo("in.exr");
    for options in [
        &["--tolerance", "1e-4"][..],
        &["--budget", "4"],
        &["--evaluator", "rows", "--preset", "anamorphic"],
        &["--max-lights", "9"],
    ] {
        let told = place.json(&[&["plan", "in.exr", "--json"], options].concat());
        let apply = ["apply", "in.exr", "-o", "out.exr", "--report", "report.json", "--force"];
        place.vglare(&[&apply, options].concat()).succeeded();
        let report = place.read_json("report.json");
        assert_eq!(told["plan"], report["plan"], "{options:?}");
        let bounds =
            ["dropped", "cut", "periodisation", "truncation", "interpolation", "gathering", "rounding", "storage"];
        let sum: f64 = bounds.iter().map(|source| number(&told, &format!("/plan/predicted/{source}"))).sum();
        assert!((sum - number(&told, "/predicted_total")).abs() <= 1e-12, "{told}");
        assert_eq!(report["cost"]["model"]["source"], "built-in");
        let built_in = serde_json::to_value(CostModel::default()).unwrap();
        assert_eq!(report["cost"]["model"]["nanoseconds"], built_in);
    }
    // In words, too.
    let by_grid = ["--evaluator", "grid"];
    let by_grid = [&by_grid[..], &["--sources", "lights"]].concat();
    let verbose = place
        .vglare(&[&["apply", "in.exr", "-o", "out.exr", "--force", "-v"][..], &by_grid].concat())
        .succeeded()
        .stdout();
    let told = place.vglare(&[&["plan", "in.exr"][..], &by_grid].concat()).succeeded().stdout();
    let lines = |text: &str| -> Vec<String> {
        let mine = ["plan", "groups", "lattice", "bounds", "chosen", "rejected", "costs"];
        text.lines().filter(|line| mine.iter().any(|word| line.starts_with(word))).map(str::to_owned).collect()
    };
    assert_eq!(lines(&told).len(), 6, "{told}");
    assert_eq!(lines(&told), lines(&verbose));
}

#[test]
fn what_cannot_be_had_is_refused_in_the_plan_with_the_reason() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text("scene.toml", "[[ghost]]\ncenter = [0.0, 0.0]\nsize = 0.000001\nradiance = [1.0, 1.0, 1.0]\n");
    let plan = place.json(&["plan", "in.exr", "--scene", "scene.toml", "--size", "1921x1081", "--json"]);
    assert_eq!(plan["plan"]["evaluator"], "local", "{plan}");
    let refused = plan["plan"]["refused"].as_array().expect("a list");
    let reasons: Vec<&str> = refused.iter().filter_map(|one| one["reason"].as_str()).collect();
    // To draw a single bell takes less than rows or a lattice, whatever they have to carry; and no series has its degree.
    let [series, rows, grid] = reasons[..] else { panic!("{plan}") };
    assert!(series.contains("degree"), "{plan}");
    assert!(rows.contains("the passes of rows alone") && grid.contains("the passes of grid alone"), "{plan}");
    let text = place.vglare(&["plan", "in.exr", "--scene", "scene.toml", "--size", "1921x1081"]).succeeded().stdout();
    assert!(text.lines().filter(|line| line.starts_with("refused")).count() == 3, "{text}");
}

#[test]
fn a_plan_for_another_size_costs_what_that_size_costs() {
    let place = Workplace::new();
    place.photo("in.exr");
    // Of few lights: the spectrum of all pixels takes as long whatever size it is shown at.
    let line =
        ["plan", "in.exr", "--json", "--evaluator", "grid", "--sources", "lights", "--preset", "v1/classic-prime"];
    let plan = |size: &str| place.json(&[&line[..], &["--size", size]].concat());
    let (small, large) = (plan("96x64"), plan("1920x1280"));
    assert_eq!(large["size"], serde_json::json!([1920, 1280]));
    assert!(number(&large, "/predicted_ms") > 5.0 * number(&small, "/predicted_ms"), "{large}");
    place.vglare(&["plan", "in.exr", "--size", "0x5"]).failed(2, &["WxH"]);
}

#[test]
fn a_plan_needs_no_opengl() {
    let place = Workplace::new();
    place.photo("in.exr");
    let without = |args: &[&str]| {
        let mut command = place.command(args);
        // A loader that finds no driver.
        command.env("__EGL_VENDOR_LIBRARY_DIRS", place.path("nowhere"));
        super::Ran(command.output().expect("the program runs"))
    };
    without(&["apply", "in.exr", "-o", "out.exr", "--backend", "egl"]).failed(4, &["egl"]);
    let text = without(&["plan", "in.exr", "--backend", "egl"]).succeeded().stdout();
    assert!(text.contains("no OpenGL 4.3 here: assuming") && text.contains("chosen"), "{text}");
}

#[test]
fn a_budget_buys_accuracy_and_one_that_is_too_small_names_the_least() {
    let place = Workplace::new();
    place.photo("in.exr");
    let cost = |tolerance: f64| {
        let plan = ["plan", "in.exr", "--sources", "lights", "--json", "--tolerance", &tolerance.to_string()];
        number(&place.json(&plan), "/predicted_ms")
    };
    let (least, most) = (cost(LOOSEST), cost(1e-4));
    assert!(least < most);
    let budget = 0.5 * (least + most);
    let apply = ["apply", "in.exr", "-o", "out.exr", "--sources", "lights", "--report", "report.json", "--budget"];
    let ran = place.vglare(&[&apply[..], &[&budget.to_string()]].concat()).succeeded();
    assert!(ran.stdout().contains("bought a tolerance of"), "{}", ran.stdout());
    let report = place.read_json("report.json");
    assert_eq!(number(&report, "/cost/budget_ms"), budget);
    assert!(number(&report, "/cost/predicted_ms") <= budget && number(&report, "/cost/measured_ms") > 0.0, "{report}");
    let reached = number(&report, "/plan/tolerance");
    assert!(reached > 1e-4 && reached < LOOSEST, "{report}");
    assert_eq!(number(&report, "/error/asked"), reached);
    assert!(number(&report, "/error/measured") <= number(&report, "/error/predicted"), "{report}");

    let small = (0.9 * least).to_string();
    let lights = ["--sources", "lights"];
    for command in [&["plan", "in.exr"][..], &["apply", "in.exr", "-o", "none.exr"]] {
        let command = &[command, &lights].concat()[..];
        place.vglare(&[command, &["--budget", &small]].concat()).failed(3, &["budget", &format!("{least:.3} ms")]);
        place.vglare(&[command, &["--budget", "5", "--tolerance", "1e-3"]].concat()).failed(2, &["--tolerance"]);
        place.vglare(&[command, &["--budget", "0"]].concat()).failed(2, &["milliseconds"]);
    }
    assert!(!place.path("none.exr").exists());
}

#[test]
fn the_floor_is_settled_for_where_that_is_allowed() {
    let place = Workplace::new();
    place.photo("in.exr");
    place
        .vglare(&["plan", "in.exr", "--sources", "lights", "--tolerance", "1e-12"])
        .failed(3, &["1.0e-12", "below what can be had"]);
    let apply = [
        "apply",
        "in.exr",
        "-o",
        "out.exr",
        "--report",
        "report.json",
        "--sources",
        "lights",
        "--allow-floor",
        "--tolerance",
    ];
    let ran = place.vglare(&[&apply[..], &["1e-12"]].concat()).succeeded();
    assert!(ran.stdout().contains("note ") && ran.stdout().contains("instead of 1.0e-12"), "{}", ran.stdout());
    let report = place.read_json("report.json");
    let reached = number(&report, "/plan/tolerance");
    assert!(reached > 1e-8 && number(&report, "/error/measured") <= reached, "{report}");
    assert_eq!(report["notes"].as_array().map(Vec::len), Some(1), "{report}");
    // What can be had is left alone.
    let plan = place.json(&["plan", "in.exr", "--json", "--allow-floor", "--tolerance", "1e-3"]);
    assert_eq!((number(&plan, "/plan/tolerance"), plan["notes"].as_array().map(Vec::len)), (1e-3, Some(0)));
}

#[test]
fn every_pixel_can_be_verified() {
    let place = Workplace::new();
    place.photo("in.exr");
    let error = |verify: &str| {
        // Of Gaussians, whose direct sum over all pixels is a product, and soon had.
        let line = "apply in.exr -o out.exr --force --report report.json --preset v1/classic-prime --verify";
        let apply = line.split(' ').chain([verify]).collect::<Vec<_>>();
        let said = place.vglare(&apply).succeeded().stdout();
        (place.read_json("report.json")["error"].clone(), said)
    };
    let ((sample, _), (full, said)) = (error("sample"), error("full"));
    assert_eq!((&sample["verify"], &full["verify"]), (&"sample".into(), &"full".into()));
    assert_eq!(full["pixels"], 96 * 64);
    assert!(sample["pixels"].as_u64() < full["pixels"].as_u64());
    assert!(said.contains("at all 6144 pixels"), "{said}");
    assert!(number(&sample, "/measured") <= number(&full, "/measured"), "{sample} {full}");
    assert!(number(&full, "/measured") <= number(&full, "/predicted"), "{full}");
    // A poor choice is found out at every pixel too.
    let rough = "apply in.exr -o out.exr --force --preset v1/classic-prime --degree 2,2 --strict --verify full";
    place.vglare(&rough.split(' ').collect::<Vec<_>>()).failed(3, &["1.0e-3"]);
    place.vglare(&["apply", "in.exr", "-o", "out.exr", "--verify", "half"]).failed(2, &["sample", "full"]);
}

#[test]
fn the_drivers_precision_is_measured() {
    let place = Workplace::new();
    let info = place.json(&["info", "--precision", "--json"]);
    for backend in info["backends"].as_array().expect("a list") {
        let ranges = backend["precision"].as_array().unwrap_or_else(|| panic!("no precision in {backend}"));
        let up_to: Vec<f64> = ranges.iter().map(|range| number(range, "/up_to")).collect();
        assert_eq!(up_to, [1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6]);
        for range in ranges {
            assert!(number(range, "/cis") <= 1e-6 && number(range, "/cis") > 0.0, "{range}");
            assert_eq!(range["not_finite"], 0, "{range}");
            assert!(["/sin", "/cos", "/exp"].iter().all(|name| number(range, name) > 0.0), "{range}");
        }
    }
    let text = place.vglare(&["info", "--precision"]).succeeded().stdout();
    assert!(text.contains("1000000") && text.contains("vglare's phases"), "{text}");
    assert!(!place.vglare(&["info"]).succeeded().stdout().contains("phases"), "only where it was asked for");
}

#[test]
fn a_veil_is_planned_as_it_is_computed() {
    let place = Workplace::new();
    place.photo("in.exr");
    for options in [
        &["--veil", "cie", "--fov", "50", "--projection", "planar", "--tolerance", "5e-3"][..],
        &[],
        &["--preset", "classic-veil"],
        &["--preset", "haze-filter", "--unit", "diagonal"],
    ] {
        let veil = place.json(&[&["plan", "in.exr", "--json"], options].concat())["veil"].clone();
        let line = ["apply", "in.exr", "-o", "out.exr", "--report", "report.json", "--force"];
        place.vglare(&[&line[..], options].concat()).succeeded();
        let done = place.read_json("report.json")["veil"].clone();
        let [planned, certified] = [number(&veil, "/predicted"), number(&done, "/error/predicted")];
        assert_eq!(number(&veil, "/asked"), number(&done, "/error/asked"));
        for key in ["psf", "projection", "fov", "fov_from", "border", "terms"] {
            assert_eq!(veil[key], done[key], "{key}");
        }
        let summed = veil["lattices"].as_array().unwrap().iter().map(|count| count.as_u64().unwrap()).sum::<u64>();
        let [direct, dropped, terms] = ["direct", "dropped", "terms"].map(|key| veil[key].as_u64().unwrap());
        assert_eq!(direct + summed + dropped, terms, "{veil}");
        // Of a transform the plan knows only what it will be held to.
        assert!(certified <= planned && (certified == planned || direct + summed == 0), "{veil} {done}");
    }
    let text = |options: &[&str]| place.vglare(&[&["plan", "in.exr"], options].concat()).succeeded().stdout();
    let said = text(&["--veil", "cie", "--fov", "50", "--projection", "planar"]);
    assert!(
        said.contains("veil     cie, as given: 50° across, planar") && said.contains("of the local veil"),
        "{said}"
    );
    // A picture of twice the size spans the same angles.
    let twice = place.json(&["plan", "in.exr", "--json", "--size", "192x128", "--veil", "cie", "--fov", "50"]);
    assert_eq!((number(&twice, "/veil/fov"), &twice["size"]), (50.0, &serde_json::json!([192, 128])));
    // That of the lens, too, unless somebody says otherwise.
    assert!(text(&[]).contains("veil     camera, planar: scatters 2.0 % of the light"));
    assert!(!text(&["--veil", "none"]).contains("veil     "));
    place.vglare(&["plan", "in.exr", "--veil", "cie"]).failed(2, &["--fov"]);
}
