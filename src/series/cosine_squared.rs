//! The cosine-squared bell cos²(πx/2h) within |x| ≤ h: the Hann window. The prototype had h = π/2.

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};

use glam::DVec2;

use super::bell::{Factor, Modes, Shape};
use super::tails::{NARROWEST, copies, narrow, summed};

pub(super) struct CosineSquared;

/// sin(πt)/(πt).
fn sinc(t: f64) -> f64 {
    if t == 0.0 { 1.0 } else { (PI * t).sin() / (PI * t) }
}

impl CosineSquared {
    /// û/h at s = 2nh/T, and its limit 1/2 at the removable singularity s = 1: with δ = s − 1, sin πs = −sin πδ takes
    /// the zero of the denominator out by hand.
    fn transform(s: f64) -> f64 {
        if s < 0.5 {
            return sinc(s) / ((1.0 - s) * (1.0 + s));
        }
        let delta = s - 1.0;
        sinc(delta) / ((1.0 + delta) * (2.0 + delta))
    }

    /// A bound of |a_n| for sizes from `size` to √2 times it: it falls with n.
    fn envelope(n: u32, size: f64) -> f64 {
        let s = 2.0 * f64::from(n) * size;
        let falling = if s > 1.0 { size / (PI * s * (s * s - 1.0)) } else { f64::INFINITY };
        falling.min(SQRT_2 * size)
    }
}

impl Shape for CosineSquared {
    fn name(&self) -> &'static str {
        "cosine-squared"
    }

    fn shader(&self) -> &'static str {
        "bells/cosine_squared.glsl"
    }

    fn value(&self, offset: DVec2, size: DVec2) -> f64 {
        self.along(offset.x, size.x) * self.along(offset.y, size.y)
    }

    fn along(&self, distance: f64, size: f64) -> f64 {
        let t = distance / size;
        if t.abs() < 1.0 { (FRAC_PI_2 * t).cos().powi(2) } else { 0.0 }
    }

    fn wrap(&self, period: f64, distance: f64, size: f64) -> f64 {
        copies(period, distance, size, |x| self.along(x, size))
    }

    fn steepest(&self, distance: f64) -> f64 {
        if distance < 1.0 { FRAC_PI_2 } else { 0.0 }
    }

    fn ends(&self) -> f64 {
        1.0
    }

    fn reach(&self, share: f64) -> f64 {
        share.min(1.0).sqrt().acos() / FRAC_PI_2
    }

    fn edges(&self) -> Vec<f64> {
        vec![0.5, 0.97]
    }

    fn integral(&self, size: DVec2) -> f64 {
        size.element_product()
    }

    fn variance(&self) -> f64 {
        1.0 / 3.0 - 2.0 / (PI * PI)
    }

    fn modes(&self) -> Modes<'_> {
        Modes::Product(self)
    }

    fn tabulated(&self) -> bool {
        false
    }
}

impl Factor for CosineSquared {
    /// a_n = (h/T) sinc(s) / (1 − s²), s = 2nh/T.
    fn coefficients(&self, highest: u32, size: f64) -> Vec<[f64; 2]> {
        (0..=highest).map(|n| [size * Self::transform(2.0 * f64::from(n) * size), 0.0]).collect()
    }

    /// The envelope summed, and beyond some harmonic its integral ln(s²/(s² − 1)) / 2π.
    fn tails(&self, highest: u32, size: f64) -> Vec<f64> {
        // Where s is 2 at least, and the integral close to the sum.
        let close = 1.0 / size + 1.0;
        let integral = |n: f64| -(-(2.0 * n * size).powi(-2)).ln_1p() / TAU;
        if size < NARROWEST {
            return narrow(highest, close, 2.0 * SQRT_2 * size, integral);
        }
        let last = highest.max(close.ceil() as u32);
        summed(highest, last, integral(f64::from(last)), |n| 2.0 * Self::envelope(n, size))
    }

    fn mean(&self, size: f64) -> f64 {
        SQRT_2 * size
    }

    /// Where the integral is ε.
    fn degree(&self, error: f64, size: f64) -> f64 {
        0.5 / (size * (-(-TAU * error).exp_m1()).sqrt()) + 1.0
    }
}
