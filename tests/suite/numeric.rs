//! Coefficients by sampling: the golden ones, and what each slip of the notes does to them.

use std::f64::consts::{PI, TAU};

use serde_json::Value;
use vglare::series::numeric::{Rule, Slips, sine_gaussian};

use crate::support::check::Worst;

const SINE_GAUSSIAN: &str = include_str!("../golden/sin_gaussian.json");
const PARABOLA: &str = include_str!("../golden/parabola1d.json");

fn cases(text: &str) -> Vec<Value> {
    let file: Value = serde_json::from_str(text).unwrap();
    file["cases"].as_array().unwrap().clone()
}

fn number(value: &Value) -> f64 {
    value.as_str().unwrap().parse().unwrap()
}

fn count(value: &Value) -> u32 {
    value.as_u64().unwrap().try_into().unwrap()
}

fn rule(period: f64, samples: u32, slips: Slips) -> Rule {
    Rule { period, samples, slips }
}

#[test]
fn the_periodic_gaussian_has_the_golden_coefficients() {
    let mut worst = Worst::default();
    for case in cases(SINE_GAUSSIAN) {
        let (mean, sigma, n) = (number(&case["mu"]), number(&case["sigma"]), count(&case["n"]));
        let series = rule(TAU, 1000, Slips::default()).of(sine_gaussian(mean, sigma), n);
        for (got, key) in series.terms[n as usize].into_iter().zip(["a_n", "b_n"]) {
            let error = (got - number(&case[key])).abs();
            // The samples' places are off by half a rounding of x, and the function is as steep as 0.6 / sigma.
            assert!(error <= 1e-15, "mu {mean}, sigma {sigma}, {key} at {n}: {got:e} for {}", case[key]);
            worst.take(error, || format!("mu {mean}, sigma {sigma}, n {n}"));
        }
    }
    println!("worst error {worst}");
}

/// Sampling folds harmonics n + jM onto n, and the parabola's fall like 1/n²: that is all that the rule gets wrong.
#[test]
fn the_parabola_is_off_by_its_folded_harmonics_and_no_more() {
    const SAMPLES: u32 = 20_000;
    let mut shares = Worst::default();
    let (mut checked, mut tight) = (0, false);
    for case in cases(PARABOLA) {
        let [a, b, shift, period] = ["A", "B", "t", "T"].map(|key| number(&case[key]));
        let (n, half, peak) = (count(&case["n"]), a / b, a * a);
        // Bells beyond the period or narrower than the samples' distance are not what this rule is for.
        if 2.0 * half > period || half < 50.0 * period / f64::from(SAMPLES) || n > SAMPLES / 4 {
            continue;
        }
        let f = |x: f64| {
            let offset = x - shift - period * ((x - shift) / period).round();
            peak * (1.0 - (offset / half).powi(2)).max(0.0)
        };
        let series = rule(period, SAMPLES, Slips::default()).of(f, n);
        // 2|alpha_k| is at most 2T/(pi^2 h k^2) (1 + T/(2 pi h k)) of the peak; k = M - n, M + n, 2M - n, ...
        let folds = f64::from(SAMPLES) - f64::from(n);
        let bound = peak * 2.0 * period / (PI * PI * half * folds * folds) * 1.1 * (PI * PI / 3.0);
        for (got, key) in series.terms[n as usize].into_iter().zip(["a_n", "b_n"]) {
            let error = (got - number(&case[key])).abs();
            let limit = bound + 2e-15 * peak;
            assert!(error <= limit, "{}: {key} {got:e} for {}, {error:e} of {limit:e}", case["id"], case[key]);
            shares.take(error / limit, || case["id"].to_string());
            tight |= error > 0.05 * limit;
            checked += 1;
        }
    }
    assert!(checked >= 30 && tight, "{checked} checked; the bound is met closely at least once");
    println!("worst share of the limit {shares}");
}

#[test]
fn degree_sixty_is_converged_and_ten_is_not() {
    let f = sine_gaussian(0.5, 0.1);
    let series = rule(TAU, 1000, Slips::default()).of(&f, 60);
    let error = |degree: u32| {
        let cut = series.cut(degree);
        (0..4000).map(|i| TAU * f64::from(i) / 4000.0).map(|x| (cut.value(x) - f(x)).abs()).fold(0.0, f64::max)
    };
    let [ten, twenty, sixty] = [10, 20, 60].map(error);
    println!("{ten:.2e} {twenty:.2e} {sixty:.2e}");
    assert!((0.2..0.3).contains(&ten) && (0.02..0.04).contains(&twenty), "{ten} {twenty}");
    assert!((5e-10..1e-9).contains(&sixty), "{sixty:e}");
}

#[test]
fn twice_the_mean_is_twice_the_truth() {
    let slips = Slips { twice: true, ..Slips::default() };
    let [right, twice] = [Slips::default(), slips].map(|slips| rule(TAU, 500, slips).of(|x| 1.0 + x.cos(), 3));
    assert_eq!(twice.terms[0][0], 2.0);
    for (right, twice) in right.terms.iter().zip(&twice.terms) {
        assert_eq!([2.0 * right[0], 2.0 * right[1]], *twice);
    }
}

/// The samples of (−1, 1), taken for those of (−T, T), give the same numbers whatever T is, and the mean of the two
/// halves of that interval: (f(x/T) + f(x/T − 1)) / 2 for x in (0, T).
#[test]
fn the_wrong_interval_forgets_the_period_and_folds() {
    let f = |x: f64| (-4.0 * x * x).exp() * (1.0 - x * x).powi(4);
    let slips = Slips { interval: true, ..Slips::default() };
    let [one, other] = [1.0, TAU].map(|period| rule(period, 4096, slips).of(f, 40));
    assert_eq!(one.terms, other.terms);
    for i in 1..20 {
        let x = f64::from(i) / 20.0;
        let folded = 0.5 * (f(x) + f(x - 1.0));
        let error = (other.value(TAU * x) - folded).abs();
        assert!(error < 1e-4, "{x}: {error:e}");
    }
    assert!((other.value(0.0) - f(0.0)).abs() > 0.4, "and that is far from the function");
}

#[test]
fn half_the_period_is_another_function() {
    let f = sine_gaussian(0.5, 0.1);
    let slips = Slips { half_period: true, ..Slips::default() };
    let series = rule(TAU, 1000, slips).of(&f, 200);
    assert_eq!(series.period, PI);
    let x = PI / 6.0; // a peak of f, and of what was sampled
    assert!((series.value(x) - 1.0).abs() < 1e-9);
    assert!((series.value(x + PI) - 1.0).abs() < 1e-9 && f(x + PI) < 1e-15, "it comes back too soon");
}

#[test]
fn sums_of_series_are_the_series_of_sums() {
    let [f, g] = [sine_gaussian(0.5, 0.1), sine_gaussian(0.0, 0.1)];
    let rule = rule(TAU, 1000, Slips::default());
    let sum = rule.of(&f, 20).plus(&rule.of(&g, 20));
    let whole = rule.of(|x| f(x) + g(x), 20);
    for (a, b) in sum.terms.iter().zip(&whole.terms) {
        assert!((a[0] - b[0]).abs() < 1e-15 && (a[1] - b[1]).abs() < 1e-15);
    }
}
