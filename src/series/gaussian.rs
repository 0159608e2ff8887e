//! The Gaussian exp(−x²/2σ²), by its wrapped coefficients: exact for the periodised bell, without any erf.

use std::f64::consts::{PI, SQRT_2, TAU};

use super::Shape;

/// √(2π).
const SQRT_TAU: f64 = 2.506_628_274_631_000_5;

pub(super) struct Gaussian;

impl Shape for Gaussian {
    fn name(&self) -> &'static str {
        "gaussian"
    }

    fn shader(&self) -> &'static str {
        "bells/gaussian.glsl"
    }

    fn factor(&self, distance: f64) -> f64 {
        (-0.5 * distance * distance).exp()
    }

    fn integral(&self) -> f64 {
        SQRT_TAU
    }

    fn coefficient(&self, n: u32, size: f64) -> f64 {
        let turn = TAU * f64::from(n) * size;
        SQRT_TAU * size * (-0.5 * turn * turn).exp()
    }

    /// The sum itself from the last coefficient that f64 can tell from nothing; for bells so narrow that this would
    /// be millions of terms, the integral bound erfc(√2 π N σ/T).
    fn tails(&self, highest: u32, size: f64) -> Vec<f64> {
        const NEGLIGIBLE: f64 = 1.5; // exp(−(2π·1.5)²/2) = 5e-20
        const NARROWEST: f64 = 1e-4;
        if size < NARROWEST {
            return (0..=highest).map(|n| libm::erfc(SQRT_2 * PI * f64::from(n) * size)).collect();
        }
        let last = highest + (NEGLIGIBLE / size).ceil() as u32;
        let mut tails = vec![0.0; highest as usize + 1];
        let mut sum = 0.0;
        for n in (1..=last).rev() {
            sum += 2.0 * self.coefficient(n, size);
            if let Some(tail) = tails.get_mut(n as usize - 1) {
                // A few roundings upward, so that the sum stays a bound.
                *tail = sum * (1.0 + 1e-13);
            }
        }
        tails
    }

    /// 2 exp(−(T−D)²/2σ²) / (1 − exp(−(3T²−2TD)/2σ²)).
    fn wrap(&self, period: f64, distance: f64, size: f64) -> f64 {
        let gap = (period - distance) / size;
        let ratio = period * (3.0 * period - 2.0 * distance) / (size * size);
        2.0 * (-0.5 * gap * gap).exp() / -(-0.5 * ratio).exp_m1()
    }
}
