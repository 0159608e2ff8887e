//! The prototype's printed formulas: each is what the notes print, and off by what docs/math.md says.

mod cosine;
mod gaussian;
mod parabola;
mod rest;

use glam::DVec2;
use serde_json::Value;
use vglare::series::printed::table_value;

fn cases(text: &str) -> Vec<Value> {
    let file: Value = serde_json::from_str(text).unwrap();
    file["cases"].as_array().unwrap().clone()
}

/// The nearest f64 to a number printed in a string.
fn number(case: &Value, key: &str) -> f64 {
    case[key].as_str().unwrap().parse().unwrap()
}

fn count(case: &Value) -> u32 {
    case["n"].as_u64().unwrap().try_into().unwrap()
}

/// Fails unless `measured` is `expected`, a figure of the documentation, rounded to some digits.
#[track_caller]
fn figure(what: &str, measured: f64, expected: f64, relative: f64) {
    println!("{what}: {measured:.4e}");
    assert!((measured / expected - 1.0).abs() <= relative, "{what}: {measured:e} for {expected:e}");
}

/// The largest |table − bell| over one period, on `steps` × `steps` points.
fn worst(table: &[[f64; 4]], period: DVec2, degree: [u32; 2], steps: u32, bell: impl Fn(f64, f64) -> f64) -> f64 {
    let at = |i: u32, period: f64| period * (f64::from(i) / f64::from(steps) - 0.5);
    let points = (0..steps * steps).map(|k| DVec2::new(at(k % steps, period.x), at(k / steps, period.y)));
    points.map(|x| (table_value(table, period, degree, x) - bell(x.x, x.y)).abs()).fold(0.0, f64::max)
}
