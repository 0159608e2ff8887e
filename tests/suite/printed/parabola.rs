//! The parabola of 001.

use std::f64::consts::{PI, TAU};

use vglare::series::printed::{
    parabola_cosine, parabola_kernel, parabola_kernel_f32, parabola_mean, parabola_sine, parabola_titled,
};

use super::{cases, count, figure, number};

const PARABOLA: &str = include_str!("../../golden/parabola1d.json");
const PHI: &str = include_str!("../../golden/phi.json");

#[test]
fn the_coefficients_are_the_golden_ones_as_far_as_their_digits_last() {
    let mut seen = 0;
    for case in cases(PARABOLA) {
        let [a, b, t, period] = ["A", "B", "t", "T"].map(|key| number(&case, key));
        let (n, name) = (count(&case), &case["id"]);
        if n == 0 {
            let mean = parabola_mean(a, b, period);
            assert!((mean / number(&case, "a_n") - 1.0).abs() < 1e-15, "{name}: {mean:e}");
            assert!(parabola_cosine(a, b, t, period, 0).is_nan() && parabola_sine(a, b, t, period, 0).is_nan());
            assert_eq!(number(&case, "b_n"), 0.0, "{name}");
            continue;
        }
        seen += 1;
        // sin z/z³ and cos z/z² cancel below z = 1, each with its roundings; and the phases n t/T are off by n.
        let z = TAU * f64::from(n) / period * (a / b);
        let scale = 8.0 * a.powi(3) / (b * period) * (1.0 / (z * z) + 1.0 / z.powi(3));
        let limit = 4e-16 * scale * (1.0 + z + f64::from(n) * t.abs() / period);
        for (got, key) in [(parabola_cosine(a, b, t, period, n), "a_n"), (parabola_sine(a, b, t, period, n), "b_n")] {
            let expected = number(&case, key);
            assert!((got - expected).abs() <= limit, "{name}, {key}: {got:e} for {expected:e}, limit {limit:e}");
        }
    }
    assert!(seen >= 40, "{seen} values");
}

#[test]
fn the_kernel_loses_its_digits_for_narrow_bells() {
    // Φ/3 without cancellation, from its power series.
    let exact = |z: f64| (1.0 - z * z / 10.0 * (1.0 - z * z / 28.0 * (1.0 - z * z / 54.0))) / 3.0;
    // The worst from z to 1.1 z: at any one z the roundings may happen to agree.
    let nearby = |z: f64, kernel: &dyn Fn(f64) -> f64| {
        let each = (0..10_000).map(|i| f64::from((z * (1.0 + 1e-5 * f64::from(i))) as f32));
        each.map(|z| (kernel(z) / exact(z) - 1.0).abs()).fold(0.0, f64::max)
    };
    let single = |z: f64| f64::from(parabola_kernel_f32(z as f32));
    for (z, error) in [(1e-4, 25.0), (1e-3, 0.5), (1e-2, 4.9e-3), (0.1, 5.1e-5), (0.5, 1.8e-6)] {
        figure(&format!("f32 from {z:e}"), nearby(z, &single), error, 0.3);
    }
    figure("f64 from 1e-4", nearby(1e-4, &parabola_kernel), 7.6e-8, 0.3);
    for case in cases(PHI) {
        let (z, expected) = (number(&case, "z"), number(&case, "Phi"));
        if z >= 1.0 {
            assert!((3.0 * parabola_kernel(z) - expected).abs() < 1e-15, "z {z}");
        }
    }
    assert!(parabola_kernel(0.0).is_nan());
}

// 002's ∫ (1 − x²) cos nπx dx over |x| ≤ 1, with T = 2, is the same formula.
#[test]
fn it_is_002s_integral_for_a_period_of_two() {
    for n in 1..=30_u32 {
        let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
        let expected = -4.0 * sign / (f64::from(n) * PI).powi(2);
        assert!((parabola_cosine(1.0, 1.0, 0.0, 2.0, n) - expected).abs() < 1e-15, "n = {n}");
    }
}

#[test]
fn the_title_names_another_bell() {
    let (a, b) = (2.0, 0.5);
    let integrated = |x: f64| (a * a - b * b * x * x).max(0.0);
    assert_eq!([parabola_titled(a, b, 3.0, 3.0), integrated(0.0)], [2.0, 4.0], "peaks A and A²");
    // Half-widths √(A/B) = 2 and A/B = 4.
    assert_eq!([parabola_titled(a, b, 0.0, 2.0), integrated(4.0)], [0.0, 0.0]);
    assert!(parabola_titled(a, b, 0.0, 1.99) > 0.0 && integrated(3.99) > 0.0);
    // They are one where A and B are.
    assert_eq!(parabola_titled(1.0, 1.0, 0.0, 0.3), 1.0 - 0.3 * 0.3);
}
