//! The experiments in two dimensions show what their pages say: small runs of each, by their own numbers and fields.

use std::collections::HashSet;

use clap::Parser;
use vglare::gpu::Backend;
use vglare::laboratory::rex::{Experiment, Field, Figure, Lab, Report};

use crate::support::table::faults;
use crate::support::turn;

#[derive(Parser)]
struct Cli {
    #[command(subcommand)]
    experiment: Experiment,
}

/// Runs an experiment as the command line would, in a thread and a context of its own.
fn run(arguments: &str) -> Report {
    let words = std::iter::once("rex").chain(arguments.split_whitespace());
    let experiment = Cli::try_parse_from(words).unwrap_or_else(|error| panic!("{error}")).experiment;
    let run = || {
        let _turn = turn();
        experiment.run(&mut Lab::new(&[Backend::Egl])).unwrap()
    };
    let report = std::thread::scope(|scope| scope.spawn(run).join().unwrap());
    tidy(&report);
    report
}

/// All tables and numbers of a report are such as a notebook reads.
#[track_caller]
fn tidy(report: &Report) {
    for table in &report.tables {
        let faults = faults(&table.header, &table.rows);
        assert!(faults.is_empty(), "{}: {faults:?}", table.stem);
    }
    for figure in &report.figures {
        let Some(numbers) = &figure.numbers else { continue };
        let text = |row: &Vec<f64>| row.iter().map(f64::to_string).collect();
        let faults = faults(&numbers.columns, &numbers.rows.iter().map(text).collect::<Vec<_>>());
        assert!(faults.is_empty(), "{}: {faults:?}", figure.stem);
        assert!(numbers.series.is_empty() || numbers.series.len() == numbers.rows.len(), "{}", figure.stem);
    }
}

fn figure<'a>(report: &'a Report, stem: &str) -> &'a Figure {
    report.figures.iter().find(|figure| figure.stem == stem).unwrap_or_else(|| panic!("no figure {stem}"))
}

fn field<'a>(report: &'a Report, stem: &str) -> &'a Field {
    figure(report, stem).field.as_ref().unwrap_or_else(|| panic!("{stem} has no field"))
}

/// The value of a measure, up to the first word.
#[track_caller]
fn measure(report: &Report, what: &str) -> f64 {
    let found = report.measures.iter().find(|(name, _)| name.contains(what));
    let (_, value) = found.unwrap_or_else(|| panic!("no measure {what} in {:?}", report.measures));
    value.split([' ', ',']).next().unwrap().parse().unwrap_or_else(|_| panic!("{what}: {value}"))
}

/// A column of a table by its header.
fn column(report: &Report, stem: &str, header: &str) -> Vec<String> {
    let table = report.tables.iter().find(|table| table.stem == stem).unwrap_or_else(|| panic!("no table {stem}"));
    let index = table.header.iter().position(|name| name == header).unwrap_or_else(|| panic!("no column {header}"));
    table.rows.iter().map(|row| row[index].clone()).collect()
}

/// Pixels of the field's brightest value: column and row from the top.
fn brightest(field: &Field) -> [u32; 2] {
    let values = field.pixels.iter().map(|pixel| pixel[0]);
    let (index, _) = values.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    [index as u32 % field.width, index as u32 / field.width]
}

/// How many separate patches are brighter than `level`.
fn patches(field: &Field, level: f32) -> usize {
    let [width, height] = [field.width, field.height].map(i64::from);
    let bright = |&(x, y): &(i64, i64)| {
        (0..width).contains(&x) && (0..height).contains(&y) && field.pixels[(y * width + x) as usize][0] > level
    };
    let mut seen = HashSet::new();
    let mut count = 0;
    for start in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(bright) {
        let mut open = vec![start];
        count += usize::from(!seen.contains(&start));
        while let Some((x, y)) = open.pop() {
            if seen.insert((x, y)) {
                open.extend([(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)].iter().filter(|at| bright(at)));
            }
        }
    }
    count
}

#[test]
fn gaussian_2d_puts_the_bell_where_it_belongs_and_measures_the_printed_forms() {
    let report = run("gaussian-2d --size 64 --as-printed");
    // f32 and, in the long period, what N = 20 leaves out.
    assert!(measure(&report, "(0, 0), T = 16: largest error against the bell and its copies") < 1e-6);
    assert!(measure(&report, "T = 16 × 32: largest error against the bell and its copies") < 1e-4);
    // The copy at x = -11 at the left border, 3 σ from it, is worth 0.0111; half a pixel inside, 0.0049.
    let copy = measure(&report, "T = 16 × 32: largest error against the bell");
    assert!((0.004..0.0112).contains(&copy), "{copy}");

    // (5, -10) in 32 × 64 pixels over 16 × 32: right of the middle, and below it.
    let [column_, row] = brightest(field(&report, "off-centre-series"));
    assert!([25, 26].contains(&column_) && [51, 52].contains(&row), "{column_}, {row}");
    let [column_, row] = brightest(field(&report, "centred-series"));
    assert!([31, 32].contains(&column_) && [31, 32].contains(&row), "{column_}, {row}");

    // In the table by f64, and in the cut that the GPU drew.
    let expected = [0.25, 0.5, 2.0, 1.0 / 512.0, 0.3118, 32.0, 1.2104, 0.7895, 1.0122];
    let peaks = column(&report, "off-centre-forms", "peak");
    let cut = figure(&report, "off-centre-cut-y-printed").numbers.as_ref().unwrap();
    assert_eq!((peaks.len(), cut.columns.len()), (9, 12), "x, the bell, its series and nine forms");
    for (index, expected) in expected.into_iter().enumerate() {
        let peak: f64 = peaks[index].parse().unwrap();
        assert!((peak - expected).abs() < 1e-3 * expected + 5e-5, "{}: {peak}", cut.columns[index + 3]);
        let drawn = cut.rows.iter().map(|row| row[index + 3]).fold(0.0, f64::max);
        assert!((drawn / expected - 1.0).abs() < 1e-3, "{}: {drawn}", cut.columns[index + 3]);
    }
}

#[test]
fn cosine_2d_shows_two_ellipses_and_the_veil_of_the_printed_kappa() {
    let report = run("cosine-2d --size 96 --as-printed");
    let outside = |name: &str| measure(&report, &format!("{name}: mean where there is no bell"));
    assert!(outside("right").abs() < 1e-3, "no veil");
    // Two means, (π/2/6)² each.
    assert!((outside("right, without the mean") + 0.1371).abs() < 1e-3);
    assert!(outside("as printed") > 0.3, "{}", outside("as printed"));
    assert!(outside("as printed, without the mean") < -0.15);
    assert!(measure(&report, "right: largest error") < 5e-3);
    assert!(measure(&report, "as printed: largest error") > 0.6);

    // The notes' two ellipses, at half of their red; as printed they drown.
    for (stem, count) in [("with-mean", 2), ("printed-without-mean", 2), ("printed", 1)] {
        assert_eq!(patches(field(&report, stem), 0.25), count, "{stem}");
    }
    // (1.2, 1) is the upper right one, (-1.2, -0.8) the lower left one.
    let right = field(&report, "with-mean");
    let at = |x: f64, y: f64| {
        let column = ((x + 3.0) / 6.0 * f64::from(right.width)) as u32;
        let row = ((3.0 - y) / 6.0 * f64::from(right.height)) as u32;
        right.pixels[(row * right.width + column) as usize][0]
    };
    assert!(at(1.2, 1.0) > 0.98 && at(-1.2, -0.8) > 0.98 && at(1.2, -0.8) < 0.05, "y points up");
    let red = figure(&report, "with-mean").picture.pixels().map(|pixel| pixel.0).max().unwrap();
    assert_eq!(red, [255, 0, 0]);
}

#[test]
fn parabola_2d_has_a_square_floor_and_a_round_one() {
    let report = run("parabola-2d --size 129 --as-printed");
    let ratios: Vec<f64> = column(&report, "outlines", "ratio").iter().map(|ratio| ratio.parse().unwrap()).collect();
    assert_eq!(ratios.len(), 8);
    // (1 − t²)² = 0.05 along the diagonal, 1 − t² along the axis: 1.278.
    assert!((ratios[3] - 1.278).abs() < 0.02, "square: {ratios:?}");
    assert!(ratios[4..].iter().all(|ratio| (ratio - 1.0).abs() < 0.01), "round: {ratios:?}");
    for bell in ["(1 − x²)(1 − y²)", "1 − x² − y²"] {
        let error = measure(&report, &format!("{bell}: largest error"));
        assert!((0.005..0.03).contains(&error), "{bell}, N = 20, T = 4: {error}");
    }
    assert!(measure(&report, "as printed: largest error") > 0.7);
}

#[test]
fn normalize_stretches_what_clamping_cuts_off() {
    let report = run("normalize --size 64");
    let value = |what: &str| report.measures.iter().find(|(name, _)| name == what).unwrap().1.clone();
    assert_eq!(value("normalised: least and largest"), "0.0000, 1.0000");
    assert_eq!(
        value("least and largest value, by the reduction"),
        value("least and largest value, pixel by pixel"),
        "the reduction finds what is there"
    );
    let [mean, last] = ["mean", "last level of a plain mip chain"].map(|what| value(what).parse::<f64>().unwrap());
    assert!((last / mean - 1.0).abs() < 0.2, "a mean: {last}, {mean}");
    assert!(measure(&report, "clamped: pixels cut off") > 10.0);
    assert!(measure(&report, "largest error of the series") < 2e-3, "N = 15, σ = 0.7, T = 20");

    let pixels = |arguments| field(&run(arguments), "normalised").pixels.clone();
    assert_eq!(pixels("normalize --size 64"), field(&report, "normalised").pixels, "the same seed, the same ghosts");
    assert_ne!(pixels("normalize --size 64 --seed 4"), field(&report, "normalised").pixels);
}

#[test]
fn benchmark_has_the_layout_of_the_notes() {
    let report = run("benchmark --size 16 --rounds 2 --most 8");
    assert_eq!(column(&report, "benchmark", "K"), ["5", "5", "1000", "1000"]);
    let cases = ["parametric", "non-parametric"];
    assert_eq!(column(&report, "benchmark", "case"), [cases, cases].concat());
    assert_eq!(column(&report, "benchmark", "notes: draw_glare, ms"), ["0.080", "0.014", "0.082", "0.311"]);
    assert_eq!(column(&report, "benchmark", "notes: mean GL time, ms"), ["0.207", "0.161", "0.207", "0.442"]);
    let noted = ["least", "most"].map(|end| column(&report, "benchmark", &format!("notes: FPS, {end}")));
    assert_eq!(noted, [["4000", "5000", "4000", "2000"], ["5000", "6000", "5000", "2000"]]);
    for header in ["FPS", "draw_glare, ms", "mean GL time, ms"] {
        let times = column(&report, "benchmark", header);
        assert!(times.iter().all(|time| time.parse::<f64>().unwrap() > 0.0), "{header}: {times:?}");
    }
    assert!(measure(&report, "parametric, K = 1000 over K = 5") > 0.0);
    let sweep = figure(&report, "sweep").numbers.as_ref().unwrap();
    assert_eq!(sweep.rows.iter().map(|row| row[0]).collect::<Vec<_>>(), [1.0, 2.0, 4.0, 8.0]);
    assert!(sweep.rows.iter().flatten().all(|&number| number > 0.0), "{:?}", sweep.rows);
    assert!(report.parameters.iter().any(|(name, value)| name == "device" && !value.is_empty()));
}
