//! Nodes and weights.

use std::f64::consts::PI;

/// The n-point rule of Gauss and Legendre on \[−1, 1\]: pairs of node and weight, nodes rising, exact for polynomials
/// of degree 2n − 1. n ≥ 1.
///
/// Newton's iteration on P_n from cos(π (k − 1/4) / (n + 1/2)) (Davis and Rabinowitz, "Methods of Numerical
/// Integration", 2nd ed., 1984, section 2.7); nodes are good to some 1e-16, weights to 1e-13 of their size at n = 2000.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let mut rule = vec![(0.0, 0.0); n];
    for k in 0..n.div_ceil(2) {
        let mut x = (PI * (k as f64 + 0.75) / (n as f64 + 0.5)).cos();
        // Quadratic convergence from an error of O(n⁻⁴): four steps are more than enough.
        for _ in 0..4 {
            let (value, slope) = legendre(n, x);
            x -= value / slope;
        }
        if 2 * k + 1 == n {
            x = 0.0;
        }
        let weight = 2.0 / ((1.0 - x) * (1.0 + x) * legendre(n, x).1.powi(2));
        rule[k] = (-x, weight);
        rule[n - 1 - k] = (x, weight);
    }
    rule
}

/// P_n(x) and its slope, |x| < 1.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (0.0, 1.0);
    for k in 1..=n {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
    }
    (value, n as f64 * (before - x * value) / ((1.0 - x) * (1.0 + x)))
}

/// The weights of Fejér's first rule, for ∫ f(cos θ) sin θ dθ from values at θ = (j + 1/2) π / n: exact for polynomials
/// of degree n − 1 in cos θ. They add up to 2. (Fejér, Mathematische Zeitschrift 37, 1933.)
pub fn fejer(n: usize) -> Vec<f64> {
    let weight = |j: usize| {
        // The angle 2kθ in units of π / n, wrapped in integers.
        let cosine = |k: usize| (PI * ((k * (2 * j + 1)) % (2 * n)) as f64 / n as f64).cos();
        let sum: f64 = (1..=n / 2).rev().map(|k| cosine(k) / ((4 * k * k - 1) as f64)).sum();
        2.0 / n as f64 * (1.0 - 2.0 * sum)
    };
    (0..n).map(weight).collect()
}

/// The least number of Gauss–Legendre nodes whose mean of cos(κt) over |t| ≤ `half` is off by less than `limit`, from
/// the rule's error term; `phase` is κ · half.
pub(super) fn nodes_for(phase: f64, limit: f64) -> usize {
    let (mut n, mut error) = (1, phase * phase / 6.0);
    while error > limit {
        let k = n as f64;
        // 2^2n n!⁴ / ((2n+1) (2n)!³) phase^2n, from one n to the next.
        error *= 4.0 * (k + 1.0).powi(4) * (2.0 * k + 1.0) / (2.0 * k + 3.0) * phase * phase;
        error /= ((2.0 * k + 2.0) * (2.0 * k + 1.0)).powi(3);
        n += 1;
    }
    n
}
