//! The Gaussian exp(−x²/2σ²), by its wrapped coefficients: exact for the periodised bell, without any erf.

use std::f64::consts::{E, PI, SQRT_2, TAU};

use glam::DVec2;

use super::bell::{Factor, Modes, Shape};
use super::special::re_erf_scaled;
use super::tails::summed;

/// √(2π).
const SQRT_TAU: f64 = 2.506_628_274_631_000_5;

pub(super) struct Gaussian;

/// a_n of a Gaussian that is cut off half a period from its centre, of a size in periods: what the prototype's notes mean
/// to integrate. Its series has a kink there, and falls like n⁻² instead of like a Gaussian.
///
/// √(2π) (σ/T) exp(−b²) Re erf(a + ib), a = T/(2√2σ), b = nωσ/√2.
pub fn windowed_gaussian(n: u32, size: f64) -> f64 {
    let (a, b) = (0.5 / (SQRT_2 * size), TAU * f64::from(n) * size / SQRT_2);
    SQRT_TAU * size * re_erf_scaled(a, b)
}

/// a_n of the periodised Gaussian, of a size in periods: √(2π) (σ/T) exp(−(nωσ)²/2).
pub fn wrapped_gaussian(n: u32, size: f64) -> f64 {
    let turn = TAU * f64::from(n) * size;
    SQRT_TAU * size * (-0.5 * turn * turn).exp()
}

impl Shape for Gaussian {
    fn name(&self) -> &'static str {
        "gaussian"
    }

    fn shader(&self) -> &'static str {
        "bells/gaussian.glsl"
    }

    fn value(&self, offset: DVec2, size: DVec2) -> f64 {
        (-0.5 * (offset / size).length_squared()).exp()
    }

    fn along(&self, distance: f64, size: f64) -> f64 {
        (-0.5 * (distance / size).powi(2)).exp()
    }

    /// 2 exp(−(T−D)²/2σ²) / (1 − exp(−(3T²−2TD)/2σ²)).
    fn wrap(&self, period: f64, distance: f64, size: f64) -> f64 {
        let gap = (period - distance) / size;
        let ratio = period * (3.0 * period - 2.0 * distance) / (size * size);
        let nearest = 2.0 * (-0.5 * gap * gap).exp();
        // Of very wide bells the quotient is 0/0; no sum of samples a period apart is beyond the first and the integral.
        (nearest / -(-0.5 * ratio).exp_m1()).min(nearest + SQRT_TAU * size / period)
    }

    /// d exp(−d²/2), which is steepest at a distance of 1, or where it begins.
    fn steepest(&self, distance: f64) -> f64 {
        // The steepest place of all needs no exponential: most ghosts shine on a pixel near their centres.
        if distance <= 1.0 { E.sqrt().recip() } else { distance * (-0.5 * distance * distance).exp() }
    }

    fn reach(&self, share: f64) -> f64 {
        (-2.0 * share.ln()).max(0.0).sqrt()
    }

    fn integral(&self, size: DVec2) -> f64 {
        TAU * size.element_product()
    }

    fn variance(&self) -> f64 {
        1.0
    }

    fn modes(&self) -> Modes<'_> {
        Modes::Product(self)
    }

    fn tabulated(&self) -> bool {
        false
    }
}

impl Factor for Gaussian {
    fn coefficients(&self, highest: u32, size: f64) -> Vec<[f64; 2]> {
        (0..=highest).map(|n| [wrapped_gaussian(n, size), 0.0]).collect()
    }

    /// The sum itself from the last coefficient that f64 can tell from nothing; for bells so narrow that this would
    /// be millions of terms, the integral bound erfc(√2 π N σ/T). Either falls as the size grows.
    fn tails(&self, highest: u32, size: f64) -> Vec<f64> {
        const NEGLIGIBLE: f64 = 1.5; // exp(−(2π·1.5)²/2) = 5e-20
        const NARROWEST: f64 = 1e-4;
        if size < NARROWEST {
            return (0..=highest).map(|n| libm::erfc(SQRT_2 * PI * f64::from(n) * size)).collect();
        }
        let last = highest + (NEGLIGIBLE / size).ceil() as u32;
        summed(highest, last, 0.0, |n| 2.0 * wrapped_gaussian(n, size))
    }

    /// As much as leaves the sum of all coefficients, which is the periodised peak, a bound for the largest size too.
    fn mean(&self, size: f64) -> f64 {
        // From here on the copies add up to √(2π) σ/T, but for 1e-8 of that (Poisson's sum).
        if size > 1.0 {
            return SQRT_2 * wrapped_gaussian(0, size);
        }
        let copies = |size: f64| -> f64 {
            let reach = (9.0 * size) as i32;
            (1..=reach).map(|j| 2.0 * self.along(f64::from(j), size)).sum()
        };
        wrapped_gaussian(0, size) + (copies(SQRT_2 * size) - copies(size)).max(0.0)
    }

    /// erfc(z) < exp(−z²), so z = √ln(1/ε) is enough.
    fn degree(&self, error: f64, size: f64) -> f64 {
        (1.0 / error).max(E).ln().sqrt() / (SQRT_2 * PI * size) + 1.0
    }
}
