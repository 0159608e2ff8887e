//! The prototype's experiments, end to end: files, numbers, refusals.

use std::path::Path;

use vglare::photo;

use super::Workplace;
use super::tables::tidy;

/// Columns of a CSV by name; empty cells are NaN.
struct Csv {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Csv {
    fn read(path: &Path) -> Self {
        let mut reader = csv::Reader::from_path(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let strings = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect();
        let header = strings(reader.headers().unwrap());
        Self { header, rows: reader.records().map(|record| strings(&record.unwrap())).collect() }
    }

    #[track_caller]
    fn column(&self, name: &str) -> Vec<f64> {
        let index = self.header.iter().position(|column| column == name);
        let index = index.unwrap_or_else(|| panic!("{name:?} is not among {:?}", self.header));
        self.rows.iter().map(|row| row[index].parse().unwrap_or(f64::NAN)).collect()
    }
}

/// A picture that is more than a frame around nothing: letters, axes and curves in several colours.
#[track_caller]
fn not_blank(path: &Path) {
    let picture = image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_rgb8();
    let white = picture.pixels().filter(|pixel| pixel.0 == [255; 3]).count();
    let spread = |[r, g, b]: [u8; 3]| r.max(g).max(b) - r.min(g).min(b);
    let coloured = picture.pixels().filter(|pixel| spread(pixel.0) > 60);
    let all = (picture.width() * picture.height()) as usize;
    assert!(white < all - all / 100, "{} is blank", path.display());
    assert!(coloured.count() > 500, "{} has no curve", path.display());
}

/// All files under a folder, by extension.
fn files(folder: &Path, extension: &str) -> Vec<std::path::PathBuf> {
    let mut found: Vec<_> = std::fs::read_dir(folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == extension))
        .collect();
    found.sort();
    found
}

#[test]
fn the_parabola_is_written_with_its_numbers_and_keeps_its_bound() {
    let place = Workplace::new();
    let ran = place.vglare(&["rex", "parabola-1d", "--degree", "3,8", "-o", "out"]).succeeded();
    assert!(ran.stdout().contains("index.html"), "{}", ran.stdout());
    let folder = place.path("out/parabola-1d");
    let pictures = files(&folder, "png");
    assert_eq!(pictures.len(), 3);
    pictures.iter().for_each(|path| not_blank(path));
    assert_eq!(files(&folder, "svg").len(), 3);

    let csv = Csv::read(&folder.join("error.csv"));
    let (degree, measured, bound) = (csv.column("degree N"), csv.column("measured"), csv.column("bound e"));
    assert_eq!(degree.len(), 200);
    for ((n, measured), bound) in degree.iter().zip(&measured).zip(&bound) {
        // h = 1, T = 4, peak 1.
        let e = 8.0 / (std::f64::consts::PI.powi(2) * n) * (1.0 + 1.0 / (std::f64::consts::PI * n));
        assert!((bound - e).abs() < 1e-12, "{n}: {bound} {e}");
        assert!((0.25 * bound..=*bound).contains(measured), "{n}: {measured} {bound}");
    }
    tidy(&place.path("out"), 4);
    let page = std::fs::read_to_string(place.path("out/index.html")).unwrap();
    for part in
        ["parabola-1d/series.png", "parabola-1d/error.csv", "parabola-1d/stability.svg", "largest error at N = 8"]
    {
        assert!(page.contains(part), "{part} is not on the page");
    }
}

#[test]
fn the_periodic_gaussians_come_from_cpu_and_gpu_alike() {
    let place = Workplace::new();
    let mut fields = Vec::new();
    // Of the first, the numbers come from the CPU.
    for (name, tables, backends) in [("fourier-1d", 5, &["egl"][..]), ("fourier-1d-gpu", 4, &["egl", "osmesa"])] {
        for backend in backends {
            let out = format!("{name}-{backend}");
            let args = ["rex", name, "--as-printed", "--converged", "40", "--backend", backend, "-o", &out];
            place.vglare(&args).succeeded();
            let folder = place.path(&out).join(name);
            files(&folder, "png").iter().for_each(|path| not_blank(path));
            tidy(&folder, tables);
            let slips = Csv::read(&folder.join("slips.csv"));
            let (degrees, errors) = (slips.column("N"), slips.column("largest error"));
            assert_eq!(degrees, [10.0, 40.0].repeat(5));
            assert!((0.2..0.3).contains(&errors[0]), "{name}: the right series at N = 10 is off by {}", errors[0]);
            assert!(errors[2..].iter().all(|error| *error > 0.5), "{name}: every slip is worse: {errors:?}");
            fields.push(photo::read(&folder.join("before.exr")).unwrap());
        }
    }
    let exact = Csv::read(&place.path("fourier-1d-egl/fourier-1d/before.csv")).column("exact sum");
    assert!(
        exact.iter().filter(|value| value.is_finite()).any(|value| (value - 1.0).abs() < 1e-3),
        "the lobe is there"
    );
    // The pictures that GL has drawn: the same curve but for pixels at its rim.
    let first = &fields[0].pixels;
    assert!(first.iter().filter(|pixel| pixel[0] < 0.9).count() > 5000, "there are curves");
    for other in &fields[1..] {
        let differ = first.iter().zip(&other.pixels).filter(|(a, b)| a != b).count();
        assert!(differ < 200, "{differ} pixels differ");
    }
}

#[test]
fn the_look_up_table_has_the_errors_of_its_size() {
    let place = Workplace::new();
    let args = ["rex", "lookup", "--lights", "40", "--entries", "64,256,1024", "--rounds", "2", "-o", "out"];
    place.vglare(&args).succeeded();
    let folder = place.path("out/lookup");
    files(&folder, "png").iter().for_each(|path| not_blank(path));
    let csv = Csv::read(&folder.join("error.csv"));
    let (nearest, linear) = (csv.column("nearest, f64"), csv.column("linear, f64"));
    assert_eq!(csv.column("entries P in a period"), [64.0, 256.0, 1024.0]);
    assert!(nearest[0] > 2.0 * nearest[2] && linear[0] > 100.0 * linear[2], "{nearest:?} {linear:?}");
    let updates = Csv::read(&folder.join("updates.csv"));
    assert_eq!(updates.rows.len(), 3 * 2 * 6);
    tidy(&place.path("out"), 3);
    assert!(updates.column("least ms").iter().all(|ms| *ms > 0.0));
}

#[test]
fn folders_that_hold_other_things_are_refused_and_former_ones_are_not() {
    let place = Workplace::new();
    std::fs::create_dir(place.path("mine")).unwrap();
    place.text("mine/letter.txt", "precious");
    let parabola = ["rex", "parabola-1d", "-o", "mine"];
    place.vglare(&parabola).failed(1, &["mine", "--force"]);
    assert_eq!(std::fs::read_dir(place.path("mine")).unwrap().count(), 1, "nothing was written");
    place.vglare(&[&parabola[..], &["--force"]].concat()).succeeded();
    assert_eq!(std::fs::read_to_string(place.path("mine/letter.txt")).unwrap(), "precious");
    // Now it is a former output.
    place.vglare(&parabola).succeeded();
    place.text("file", "precious");
    place.vglare(&["rex", "parabola-1d", "-o", "file", "--force"]).failed(1, &["file"]);
    // A page of someone else's is no former output.
    std::fs::create_dir(place.path("site")).unwrap();
    place.text("site/index.html", "<!doctype html><title>precious</title>");
    place.vglare(&["rex", "parabola-1d", "-o", "site"]).failed(1, &["site", "--force"]);
}

#[test]
fn unknown_names_and_parameters_are_usage_errors() {
    let place = Workplace::new();
    place.vglare(&["rex"]).failed(2, &[]);
    place.vglare(&["rex", "no-such-experiment"]).failed(2, &["no-such-experiment"]);
    place.vglare(&["rex", "parabola-1d", "--period", "0"]).failed(2, &["--period"]);
    place.vglare(&["rex", "parabola-1d", "--degree", "0"]).failed(2, &["--degree"]);
    place.vglare(&["rex", "fourier-1d", "--mean", "0.5"]).failed(2, &["--mean"]);
    place.vglare(&["rex", "fourier-1d", "--samples", "100"]).failed(2, &["100 samples"]);
    place.vglare(&["rex", "fourier-1d-gpu", "--samples", "5000"]).failed(2, &["4096"]);
    place.vglare(&["rex", "lookup", "--sigma", "nan"]).failed(2, &["--sigma"]);
    let list = place.vglare(&["rex", "list"]).succeeded().stdout();
    assert!(["parabola-1d", "fourier-1d", "fourier-1d-gpu", "lookup"].iter().all(|name| list.contains(name)), "{list}");
}

/// Without a driver, EGL's vendor library has nothing to give: what draws fails with 4, what does not need GL runs.
#[test]
#[cfg(unix)]
fn without_opengl_the_experiments_that_draw_with_it_say_so() {
    let place = Workplace::new();
    let run = |name: &str| {
        let ran = std::process::Command::new(env!("CARGO_BIN_EXE_vglare"))
            .args(["rex", name, "--backend", "egl", "-o", name])
            .env("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent")
            .env("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent")
            .current_dir(place.path("."))
            .output()
            .expect("the program runs");
        super::Ran(ran)
    };
    run("fourier-1d").failed(4, &["OpenGL"]);
    run("parabola-1d").succeeded();
}
