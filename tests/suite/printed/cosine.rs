//! cos²x cos²y of 000.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

use glam::DVec2;
use vglare::series::printed::{Printed2d, Slips, Zeroth, cosine_factor, cosine_integral, cosine_kappas, table_value};

use super::{cases, count, figure, number, worst};

const HANN: &str = include_str!("../../golden/hann.json");

/// cos²x cos²y within π/2.
fn bell(x: f64, y: f64) -> f64 {
    let one = |x: f64| if x.abs() <= FRAC_PI_2 { x.cos().powi(2) } else { 0.0 };
    one(x) * one(y)
}

fn table(slips: Slips, zeroth: Zeroth, period: f64, degree: u32) -> Vec<[f64; 4]> {
    Printed2d::Cosine { slips, zeroth }.table(DVec2::splat(period), [degree, degree])
}

#[test]
fn the_integral_is_the_golden_one_but_for_its_limits() {
    let (mut seen, mut limits) = (0, 0);
    let mine = |case: &&serde_json::Value| (number(case, "h") - FRAC_PI_2).abs() < 1e-12;
    for case in cases(HANN).iter().filter(mine) {
        let (period, n, expected) = (number(case, "T"), count(case), number(case, "I"));
        let q = TAU / period * f64::from(n);
        let got = cosine_integral(q);
        if q == 0.0 || q == 2.0 {
            limits += 1;
            assert!(!got.is_finite(), "T {period}, n {n}: {got:e}");
            continue;
        }
        seen += 1;
        // q is off by a rounding, which q - 2 in the denominator magnifies where it is small.
        let limit = 1e-15 * (1.0 + q) + 2e-15 / (q - 2.0).abs();
        assert!((got - expected).abs() <= limit, "T {period}, n {n}: {got:e} for {expected:e}");
    }
    assert!(seen > 30 && limits == 7, "{seen} values, {limits} limits");
    // q = 2 exactly, where T = nπ: sin π is a rounding of π, and that divided by 0. Next to it the limit is seen.
    assert!(cosine_integral(2.0).is_infinite() && (cosine_integral(2.0 + 1e-6) - FRAC_PI_4).abs() < 1e-6);
}

#[test]
fn the_fourth_power_shifts_the_coefficients() {
    let omega = 2.0 * std::f32::consts::PI / 6.0;
    let right = |n| cosine_integral(f64::from(omega) * f64::from(n));
    for (n, percent) in [(1, 1.8), (2, -35.0), (3, -7.4), (4, -5.8)] {
        assert!((cosine_factor(omega, n, false) / right(n) - 1.0).abs() < 1e-6, "the same without it, n = {n}");
        let off = 100.0 * (cosine_factor(omega, n, true) / right(n) - 1.0);
        figure(&format!("n = {n}, in percent"), off, percent, 0.015);
    }
    let at_zero = cosine_factor(omega, 0, true);
    assert_eq!(at_zero, FRAC_PI_2);
}

#[test]
fn the_fourth_power_spoils_the_field() {
    let only = Slips { fourth_power: true, ..Slips::NONE };
    for (period, degree, expected) in [(6.0, 30, 0.16), (16.0, 30, 3.1), (20.0, 30, 1.0)] {
        let (square, degrees) = (DVec2::splat(period), [degree; 2]);
        let error = worst(&table(only, Zeroth::Kept, period, degree), square, degrees, 100, bell);
        figure(&format!("T = {period}, N = {degree}: the fourth power"), error, expected, 0.05);
        let right = worst(&table(Slips::NONE, Zeroth::Kept, period, degree), square, degrees, 100, bell);
        println!("without it {right:.1e}");
        assert!(right < 4e-3, "the right code at T = {period}: {right:e}");
    }
}

#[test]
fn kappa_is_always_four() {
    assert!(cosine_kappas(5, 4).iter().flatten().all(|&kappa| kappa == 4.0));
    assert_eq!((cosine_kappas(5, 4).len(), cosine_kappas(5, 4)[0].len()), (4, 5));
}

// The veil that 000 sees and deletes the 0-th terms for.
#[test]
fn the_wrong_kappa_lays_a_veil_over_everything() {
    let only = Slips { kappa: true, ..Slips::NONE };
    let (period, degree) = (DVec2::splat(6.0), [30; 2]);
    let veiled = table(only, Zeroth::Kept, 6.0, 30);
    figure("κ = 4, T = 6: worst error", worst(&veiled, period, degree, 100, bell), 0.59, 0.01);
    // The corner of the period, where the bell is 0 along both axes, and the middle of an edge, where along one.
    let haze = table_value(&veiled, period, degree, DVec2::splat(3.0));
    figure("κ = 4, T = 6: haze", haze, 0.0685, 2e-3);
    let mean = FRAC_PI_2 / 6.0;
    assert!((haze - mean * mean).abs() < 1e-4);
    let streak = table_value(&veiled, period, degree, DVec2::new(0.0, 3.0)) - haze;
    figure("κ = 4, T = 6: cross", streak, mean, 1e-3);

    // With the right κ there is none, and the mean belongs to the bell.
    let right = table(Slips::NONE, Zeroth::Kept, 6.0, 30);
    assert!(table_value(&right, period, degree, DVec2::splat(3.0)).abs() < 1e-5);
    // Leaving out what the note leaves out hides the haze below 0 …
    let no_mean = table(only, Zeroth::MeanDropped, 6.0, 30);
    let corner = table_value(&no_mean, period, degree, DVec2::splat(3.0));
    figure("κ = 4 without the mean: corner", corner, -3.0 * mean * mean, 1e-3);
    // … or, without all modes of an index 0, makes the cross a dark one: (u - α_0)(v - α_0).
    let no_edges = table(only, Zeroth::EdgesDropped, 6.0, 30);
    let arm = table_value(&no_edges, period, degree, DVec2::new(0.0, 3.0));
    figure("κ = 4 without edges: cross", arm, -(1.0 - mean) * mean, 2e-3);
}

#[test]
fn the_loops_end_one_harmonic_early() {
    let only = Slips { short_loops: true, ..Slips::NONE };
    let short = table(only, Zeroth::Kept, 6.0, 7);
    let whole = table(Slips::NONE, Zeroth::Kept, 6.0, 7);
    for (index, (short, whole)) in short.iter().zip(&whole).enumerate() {
        let last = index / 8 == 7 || index % 8 == 7;
        assert_eq!(short[0], if last { 0.0 } else { whole[0] }, "mode {}, {}", index / 8, index % 8);
    }
}

#[test]
fn the_integer_cube_overflows_from_1291() {
    let omega = 0.4;
    let magnitude = |n: u32| {
        let (n, w) = (f64::from(n), f64::from(omega));
        let sine = (FRAC_PI_2 * n * w).sin();
        cosine_factor(omega, n as u32, false) / (4.0 * sine / (4.0 * n * w - (n * w).powi(3)))
    };
    assert!((magnitude(1290) - 1.0).abs() < 1e-3 && magnitude(1291) < 0.0, "{} {}", magnitude(1290), magnitude(1291));
}

// T = π: ω is 2 in float, and the first harmonic divided by 0.
#[test]
fn nothing_guards_the_removable_singularity() {
    let table = table(Slips::NONE, Zeroth::Kept, std::f64::consts::PI, 3);
    for (index, mode) in table.iter().enumerate() {
        let first = index / 4 == 1 || index % 4 == 1;
        assert_eq!(mode[0].is_finite(), !first, "mode {}, {}: {}", index / 4, index % 4, mode[0]);
    }
}
