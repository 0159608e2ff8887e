//! Functions of direction to coefficients.

use std::f64::consts::TAU;

use glam::DVec3;
use rayon::prelude::*;

use super::{Basis, Coefficients, gauss_legendre};

/// c_lm = ∫ f Y_lm for l ≤ degree, from `nodes` Gauss–Legendre nodes in cos θ times 2 `nodes` even steps in φ.
///
/// Exact but for rounding where f itself is a sum of harmonics up to `nodes` − 1 and `degree` < `nodes`; for other
/// functions, as exact as the rule.
///
/// # Panics
/// If `degree` ≥ `nodes`, where the rule could not tell the harmonics apart.
pub fn project(degree: usize, nodes: usize, f: impl Fn(DVec3) -> [f64; 3] + Sync) -> Coefficients {
    assert!(degree < nodes, "more nodes than the degree");
    let basis = Basis::new(degree);
    let rule = gauss_legendre(nodes);
    let step = TAU / (2 * nodes) as f64;
    let rings: Vec<Coefficients> = rule
        .par_iter()
        .map(|&(z, weight)| {
            let sin = ((1.0 - z) * (1.0 + z)).sqrt();
            let mut harmonics = vec![0.0; (degree + 1).pow(2)];
            let mut ring = Coefficients::zero(degree);
            for k in 0..2 * nodes {
                let (s, c) = (k as f64 * step).sin_cos();
                let direction = DVec3::new(sin * c, sin * s, z);
                basis.fill(direction, &mut harmonics);
                ring.add(&harmonics, f(direction).map(|value| value * weight * step));
            }
            ring
        })
        .collect();
    Coefficients::total(degree, rings)
}

impl Coefficients {
    /// Adds `value` times each harmonic.
    pub(super) fn add(&mut self, harmonics: &[f64], value: [f64; 3]) {
        for (c, y) in self.values.iter_mut().zip(harmonics) {
            for (c, value) in c.iter_mut().zip(value) {
                *c += value * y;
            }
        }
    }

    /// The sum of parts, in their order, so that every run gives the same bits.
    pub(super) fn total(degree: usize, parts: Vec<Self>) -> Self {
        let mut total = Self::zero(degree);
        for part in parts {
            for (sum, value) in total.values.as_flattened_mut().iter_mut().zip(part.values.as_flattened()) {
                *sum += value;
            }
        }
        total
    }
}
