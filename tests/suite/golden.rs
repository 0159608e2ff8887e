//! Numbers of fifty digits hold the series and the reference, which hold everything else.

use glam::DVec2;
use serde_json::Value;
use vglare::series::{Bell, Modes};

use crate::support::check::Worst;

const COEFFICIENTS: &str = include_str!("../golden/gaussian_coeff.json");
const PERIODISED: &str = include_str!("../golden/gaussian_periodised.json");

pub fn cases(text: &str) -> Vec<Value> {
    let file: Value = serde_json::from_str(text).unwrap();
    file["cases"].as_array().unwrap().clone()
}

/// The nearest f64 to a number printed in a string.
pub fn number(value: &Value) -> f64 {
    value.as_str().unwrap().parse().unwrap()
}

pub fn count(value: &Value) -> u32 {
    value.as_u64().unwrap().try_into().unwrap()
}

#[test]
fn gaussian_coefficients_are_the_golden_ones_and_underflow_to_nothing() {
    let (mut worst, mut underflows) = (Worst::default(), 0);
    for case in cases(COEFFICIENTS) {
        let (sigma, period, n) = (number(&case["sigma"]), number(&case["T"]), count(&case["n"]));
        let (expected, got) = (number(&case["alpha_wrapped"]), coefficient(&Bell::Gaussian, n, sigma / period));
        let name = format!("sigma {sigma}, T {period}, n {n}");
        if expected < f64::MIN_POSITIVE {
            underflows += 1;
            assert!((0.0..=f64::MIN_POSITIVE).contains(&got), "{name}: {got:e} for {expected:e}");
            continue;
        }
        // exp(-a) is relatively off by the roundings of a: a few times a * 2^-53.
        let exponent = 0.5 * (std::f64::consts::TAU * f64::from(n) * sigma / period).powi(2);
        let limit = 1e-15 * (4.0 + exponent);
        let error = ((got - expected) / expected).abs();
        assert!(error <= limit, "{name}: {got:e} for {expected:e}");
        worst.take(error / limit, || name);
    }
    assert!(underflows > 0, "the file has values beyond f64");
    println!("worst share of the limit {worst}; {underflows} underflows");
}

/// a_n of a product bell's factor, of a size in periods.
pub fn coefficient(bell: &Bell, n: u32, size: f64) -> f64 {
    let Modes::Product(factor) = bell.shape().modes() else { panic!("{bell} is no product") };
    factor.coefficients(n, size)[n as usize][0]
}

/// The periodised bell from its coefficients.
fn reconstructed(sigma: f64, period: f64, x: f64) -> f64 {
    let last = (1.5 * period / sigma).ceil() as u32 + 1; // exp(-44) is left
    let cosine = |n: u32| (std::f64::consts::TAU * (f64::from(n) * x / period).fract()).cos();
    let term = |n: u32| 2.0 * coefficient(&Bell::Gaussian, n, sigma / period) * cosine(n);
    coefficient(&Bell::Gaussian, 0, sigma / period) + (1..=last).rev().map(term).sum::<f64>()
}

#[test]
fn the_series_gives_the_periodised_bell() {
    let mut worst = Worst::default();
    for case in cases(PERIODISED) {
        let (sigma, period, x) = (number(&case["sigma"]), number(&case["T"]), number(&case["x"]));
        let expected = number(&case["g_periodised"]);
        // n x / T is off by n half roundings of x / T in turns; the tail of a bell is as far off as its peak.
        let limit = 1e-13 * expected.max(1.0) * (1.0 + (x / sigma).abs() * 1e-2);
        let error = (reconstructed(sigma, period, x) - expected).abs();
        assert!(error <= limit, "sigma {sigma}, T {period}, x {x}: {error:e}");
        worst.take(error, || format!("sigma {sigma}, T {period}, x {x}"));
        let single = Bell::Gaussian.shape().value(DVec2::new(x, 0.0), DVec2::splat(sigma));
        assert!((single - number(&case["g"])).abs() <= 1e-15, "the bell itself at {x}");
    }
    println!("worst error {worst}");
}
