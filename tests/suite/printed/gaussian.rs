//! The Gaussian of 000 and 003.

use std::f64::consts::{SQRT_2, TAU};

use glam::DVec2;
use vglare::series::printed::{
    GaussianForm, Printed2d, erf, erf_f32, erf_not_extended, gaussian_table, half_range, peak, table_value,
};

use super::{cases, count, figure, number, worst};
use crate::support::check::Worst;

const COEFFICIENTS: &str = include_str!("../../golden/gaussian_coeff.json");
const ERF: &str = include_str!("../../golden/erf.json");

#[test]
fn the_error_function_is_the_golden_one_and_as_exact_as_the_book_says() {
    for case in cases(ERF) {
        let x = number(&case, "x");
        let error = (erf(x) - number(&case, "as_7_1_26")).abs();
        assert!(error <= 1e-15, "erf({x}) is off by {error:e}");
    }
    let (mut double, mut single) = (Worst::default(), Worst::default());
    for i in 0..=600_000 {
        let x = f64::from(i) * 1e-5;
        double.take((erf(x) - libm::erf(x)).abs(), || format!("{x:.3}"));
        let x = x as f32;
        single.take((f64::from(erf_f32(x)) - libm::erf(f64::from(x))).abs(), || format!("{x:.3}"));
        assert_eq!((erf(-f64::from(x)), erf_f32(-x)), (-erf(f64::from(x)), -erf_f32(x)), "odd at {x}");
    }
    println!("7.1.26 in f64 {double}, in f32 {single}");
    figure("7.1.26 in f64", double.value, 1.394e-7, 1e-3);
    assert_eq!(double.at, "0.045");
    // The book's bound holds, the notes' 5e-7 is another, and f32 keeps neither; how far it is off is a matter of single
    // roundings.
    figure("7.1.26 in f32", single.value, 6e-7, 0.15);
}

#[test]
fn the_error_function_is_wrong_left_of_zero_unless_it_is_made_odd() {
    assert_eq!(format!("{:.5} {:.5}", erf_not_extended(-0.5), libm::erf(-0.5)), "-0.52090 -0.52050");
    assert!((erf(-0.5) - libm::erf(-0.5)).abs() < 1.5e-7);
    assert!(erf_not_extended(-3.05).abs() > 1e3, "near its pole");
}

#[test]
fn the_coefficient_is_the_golden_one_with_a_real_argument() {
    let mut seen = 0;
    for case in cases(COEFFICIENTS) {
        let (sigma, period, n) = (number(&case, "sigma"), number(&case, "T"), count(&case));
        if case["half_range_printed_real_erf"].is_null() {
            continue; // The file has none for what underflows and for bells beyond any picture.
        }
        let expected = number(&case, "half_range_printed_real_erf");
        let exact = half_range(sigma, period, n, libm::erf);
        let approximate = half_range(sigma, period, n, erf);
        let name = format!("sigma {sigma}, T {period}, n {n}");
        if expected < f64::MIN_POSITIVE {
            assert!(exact <= f64::MIN_POSITIVE && approximate <= f64::MIN_POSITIVE, "{name}");
            continue;
        }
        seen += 1;
        let exponent = 0.5 * (TAU * f64::from(n) * sigma / period).powi(2);
        assert!((exact / expected - 1.0).abs() <= 1e-15 * (4.0 + exponent), "{name}: {exact:e} {expected:e}");
        let most = exact / libm::erf(period / (2.0 * SQRT_2 * sigma)) * 1.5e-7;
        assert!((approximate - exact).abs() <= most, "{name}: {approximate:e} {exact:e}");
    }
    assert!(seen > 40, "{seen} golden values");
}

/// ∫_0^{T/2} exp(−x²/2) cos nωx dx for σ = 1, by Simpson's rule.
fn windowed(period: f64, n: u32) -> f64 {
    const PANELS: u32 = 20_000;
    let step = 0.5 * period / f64::from(PANELS);
    let value = |i: u32| {
        let x = f64::from(i) * step;
        (-0.5 * x * x).exp() * (TAU / period * f64::from(n) * x).cos()
    };
    let weight = |i: u32| if i == 0 || i == PANELS { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
    (0..=PANELS).map(|i| weight(i) * value(i)).sum::<f64>() * step / 3.0
}

#[test]
fn the_integral_of_the_window_is_the_golden_one() {
    let mine = |case: &&serde_json::Value| {
        number(case, "sigma") == 1.0 && count(case) <= 20 && !case["half_range_exact"].is_null()
    };
    for case in cases(COEFFICIENTS).iter().filter(mine) {
        let (period, n) = (number(case, "T"), count(case));
        let error = (windowed(period, n) - number(case, "half_range_exact")).abs();
        assert!(error < 1e-13, "T {period}, n {n}: {error:e}");
    }
}

/// T/σ; how much the printed form dims; its coefficients' errors for n = 1, 2, 4, 8 in units of √(2π)σ/2; the largest
/// difference of its field from the periodised bell's, and of that from the bell's within half a period.
const DIMMING: [(f64, f64, [f64; 4], f64, f64); 5] = [
    (2.0, 0.317, [6.2e-2, 1.29e-2, 3.1e-3, 7.7e-4], 0.403, 0.629),
    (4.0, 0.0455, [4.73e-2, 1.73e-2, 5.3e-3, 1.36e-3], 0.0455, 0.135),
    (6.0, 2.7e-3, [4.05e-3, 1.7e-3, 1.06e-3, 3.5e-4], 2.7e-3, 1.11e-2),
    (8.0, 6.3e-5, [1.08e-4, 3.8e-5, 4.16e-5, 2e-5], 6.3e-5, 3.35e-4),
    (10.0, 5.7e-7, [1.04e-6, 2.84e-7, 4.47e-7, 3.01e-7], 5.7e-7, 3.73e-6),
];

#[test]
fn the_real_error_function_dims_the_bell() {
    for (period, dimming, coefficients, field, copies) in DIMMING {
        let unit = 0.5 * TAU.sqrt();
        let dims = |n| 1.0 - half_range(1.0, period, n, libm::erf) / half_range(1.0, period, n, |_| 1.0);
        figure(&format!("T/σ = {period}: dimming"), dims(0), dimming, 0.01);
        assert!((dims(3) / dims(0) - 1.0).abs() < 1e-8, "the same at every n");
        assert!((half_range(1.0, period, 0, libm::erf) - windowed(period, 0)).abs() < 1e-13, "right at n = 0");
        for (n, error) in [1, 2, 4, 8].into_iter().zip(coefficients) {
            let measured = (half_range(1.0, period, n, libm::erf) - windowed(period, n)).abs() / unit;
            figure(&format!("T/σ = {period}: n = {n}"), measured, error, 0.01);
        }
        let bell = |x: f64| (-0.5 * x * x).exp();
        let periodised = |x: f64| (-9..=9).map(|j| bell(x - f64::from(j) * period)).sum::<f64>();
        figure(&format!("T/σ = {period}: field"), dims(0) * periodised(0.0), field, 0.02);
        let within = (0..=50).map(|i| 0.01 * f64::from(i) * period);
        let apart = within.map(|x| periodised(x) - bell(x)).fold(0.0, f64::max);
        figure(&format!("T/σ = {period}: copies"), apart, copies, 0.02);
    }
}

// Centre (5, -10), T = (16, 32), σ = 1, as in 000, but N = M = 30: the truth is 1 at the centre.
#[test]
fn the_forms_of_the_series_are_off_by_their_prefactors() {
    let (period, degree) = (DVec2::new(16.0, 32.0), [30, 30]);
    let ratios: [(GaussianForm, f64); 9] = [
        (GaussianForm::HalfRange, 1.0 / 4.0),
        (GaussianForm::OnePeriod, 0.5),
        (GaussianForm::OnePeriodFullRange, 2.0),
        (GaussianForm::Slices, 1.0 / 512.0),
        (GaussianForm::NoKappa, 0.3118),
        (GaussianForm::Halves, 32.0),
        (GaussianForm::EdgesWhole, 1.21),
        (GaussianForm::EdgesDropped, 0.79),
        (GaussianForm::KappaByOr, 1.0 + 0.012_27),
    ];
    for (form, ratio) in ratios {
        let table = Printed2d::Gaussian { sigma: 1.0, form }.table(period, degree);
        let centre = table_value(&table, period, degree, DVec2::ZERO);
        // The edges are given to two digits; the others are off by what the truncation leaves.
        let edges = matches!(form, GaussianForm::EdgesWhole | GaussianForm::EdgesDropped);
        figure(&format!("{form:?}"), centre, ratio, if edges { 3e-3 } else { 1e-4 });
    }
    for form in [GaussianForm::EdgesWhole, GaussianForm::EdgesDropped] {
        let table = gaussian_table(1.0, form, period, degree);
        let error = worst(&table, period, degree, 64, |x, y| (-0.5 * (x * x + y * y)).exp());
        figure(&format!("{form:?}, worst error"), error, 0.21, 0.01);
    }
    assert_eq!(GaussianForm::ALL.len(), ratios.len());
}

#[test]
fn the_constant_in_front_is_that_of_one_variable() {
    for sigma in [0.3, 1.0, 7.0] {
        let plane = TAU * sigma * sigma;
        assert!((peak(sigma) * plane - sigma * TAU.sqrt()).abs() < 1e-14 * plane, "the volume for {sigma}");
        let line = TAU.sqrt() * sigma;
        assert!((peak(sigma) * line - 1.0).abs() < 1e-15, "the area for {sigma}");
    }
}
