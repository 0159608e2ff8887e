//! Numbers of fifty digits hold the series and the reference, which hold everything else.

use glam::DVec2;
use serde_json::Value;
use vglare::reference;
use vglare::scene::Ghost;
use vglare::series::Bell;

use crate::support::check::Worst;
use crate::support::scenes;

const COEFFICIENTS: &str = include_str!("../golden/gaussian_coeff.json");
const PERIODISED: &str = include_str!("../golden/gaussian_periodised.json");
const FIELD: &str = include_str!("../golden/field_gaussian.json");

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
    let shape = Bell::Gaussian.shape();
    let (mut worst, mut underflows) = (Worst::default(), 0);
    for case in cases(COEFFICIENTS) {
        let (sigma, period, n) = (number(&case["sigma"]), number(&case["T"]), count(&case["n"]));
        let (expected, got) = (number(&case["alpha_wrapped"]), shape.coefficient(n, sigma / period));
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

/// The periodised bell from its coefficients.
fn reconstructed(sigma: f64, period: f64, x: f64) -> f64 {
    let shape = Bell::Gaussian.shape();
    let last = (1.5 * period / sigma).ceil() as u32 + 1; // exp(-44) is left
    let cosine = |n: u32| (std::f64::consts::TAU * (f64::from(n) * x / period).fract()).cos();
    let term = |n: u32| 2.0 * shape.coefficient(n, sigma / period) * cosine(n);
    shape.coefficient(0, sigma / period) + (1..=last).rev().map(term).sum::<f64>()
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
        let single = Bell::Gaussian.shape().factor(x / sigma);
        assert!((single - number(&case["g"])).abs() <= 1e-15, "the bell itself at {x}");
    }
    println!("worst error {worst}");
}

#[test]
fn whole_fields_are_the_golden_ones() {
    let shape = Bell::Gaussian.shape();
    let mut worst = [Worst::default(), Worst::default()];
    let mut shares = [Worst::default(), Worst::default()];
    for case in cases(FIELD) {
        let period = DVec2::new(number(&case["T1"]), number(&case["T2"]));
        let (degree_x, degree_y) = (count(&case["N"]), count(&case["M"]));
        let counts = vec![degree_y + 1; degree_x as usize + 1];
        let ghosts: Vec<Ghost> = (case["ghosts"].as_array().unwrap().iter())
            .map(|ghost| {
                let center = [number(&ghost["x"]), number(&ghost["y"])];
                scenes::one(center, number(&ghost["s"]), [number(&ghost["w"]), 0.0, 2.0 * number(&ghost["w"])])
            })
            .collect();
        let weights: f64 = ghosts.iter().map(|ghost| ghost.radiance[0]).sum();
        let name = format!("K = {}", ghosts.len());
        for point in case["points"].as_array().unwrap() {
            let at = DVec2::new(number(&point["x"]), number(&point["y"]));
            let [direct, periodised, series] = ["direct", "periodised", "series"].map(|key| number(&point[key]));
            let ours = [reference::direct(&ghosts, at), reference::series(&ghosts, period, &counts, at)];
            for (which, (got, expected)) in ours.into_iter().zip([direct, series]).enumerate() {
                let error = (got[0] - expected).abs();
                // Some hundred terms of some roundings each.
                assert!(error <= 1e-13 * weights, "{name} at {at}: {} for {expected}", got[0]);
                assert_eq!([got[1], got[2]], [0.0, 2.0 * got[0]], "each colour on its own");
                worst[which].take(error / weights.max(1.0), || name.clone());
            }
            let bounds = ghosts.iter().fold([0.0, 0.0], |[cut, wrapped], ghost| {
                let (size, distance) = (ghost.size / period, (at - ghost.center).abs());
                let tail = [shape.tails(degree_x, size.x), shape.tails(degree_y, size.y)];
                let (cut_x, cut_y) = (tail[0][degree_x as usize], tail[1][degree_y as usize]);
                let (peak_x, peak_y) =
                    (shape.coefficient(0, size.x) + tail[0][0], shape.coefficient(0, size.y) + tail[1][0]);
                let wrap_x = shape.wrap(period.x, distance.x, ghost.size.x);
                let wrap_y = shape.wrap(period.y, distance.y, ghost.size.y);
                let offset = distance / ghost.size;
                let (own_x, own_y) = (shape.factor(offset.x), shape.factor(offset.y));
                let weight = ghost.radiance[0];
                [
                    cut + weight * (cut_x * peak_y + cut_y * peak_x),
                    wrapped + weight * (wrap_x * own_y + wrap_y * own_x + wrap_x * wrap_y),
                ]
            });
            let errors = [(series - periodised).abs(), (periodised - direct).abs()];
            for ((error, bound), share) in errors.into_iter().zip(bounds).zip(&mut shares) {
                assert!(error <= bound + 1e-15 * weights, "{name} at {at}: {error:e} beyond {bound:e}");
                if bound > 1e-14 {
                    share.take(error / bound, || name.clone());
                }
            }
        }
    }
    println!("direct, series: worst error for each unit of weight {} , {}", worst[0], worst[1]);
    println!("truncation, periodisation: worst share of the bound {} , {}", shares[0], shares[1]);
}
