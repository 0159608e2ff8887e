//! The parabola 1 − x²/h² within |x| ≤ h, and the product of two. The floor of the product is a square.

use std::f64::consts::{PI, SQRT_2, TAU};

use glam::DVec2;

use super::bell::{Factor, Modes, Shape};
use super::special::parabola_kernel;
use super::tails::{NARROWEST, copies, narrow, summed};

pub(super) struct Parabola;

impl Parabola {
    /// A bound of |a_n| for sizes from `size` to √2 times it, from |sin z − z cos z| ≤ 1 + z: it falls with n.
    fn envelope(n: u32, size: f64) -> f64 {
        let z = TAU * f64::from(n) * size;
        let falling = 4.0 * size * (1.0 + 1.0 / z) / (z * z);
        falling.min(4.0 / 3.0 * SQRT_2 * size)
    }
}

impl Shape for Parabola {
    fn name(&self) -> &'static str {
        "parabola"
    }

    fn shader(&self) -> &'static str {
        "bells/parabola.glsl"
    }

    fn value(&self, offset: DVec2, size: DVec2) -> f64 {
        self.along(offset.x, size.x) * self.along(offset.y, size.y)
    }

    fn along(&self, distance: f64, size: f64) -> f64 {
        (1.0 - (distance / size).powi(2)).max(0.0)
    }

    fn wrap(&self, period: f64, distance: f64, size: f64) -> f64 {
        copies(period, distance, size, |x| self.along(x, size))
    }

    fn steepest(&self, distance: f64) -> f64 {
        if distance < 1.0 { 2.0 } else { 0.0 }
    }

    fn ends(&self) -> f64 {
        1.0
    }

    fn reach(&self, share: f64) -> f64 {
        (1.0 - share).max(0.0).sqrt()
    }

    fn edges(&self) -> Vec<f64> {
        vec![0.97, 1.0]
    }

    fn integral(&self, size: DVec2) -> f64 {
        16.0 / 9.0 * size.element_product()
    }

    fn variance(&self) -> f64 {
        0.2
    }

    fn modes(&self) -> Modes<'_> {
        Modes::Product(self)
    }

    fn tabulated(&self) -> bool {
        false
    }
}

impl Factor for Parabola {
    /// a_n = (4h/3T) Φ(nωh).
    fn coefficients(&self, highest: u32, size: f64) -> Vec<[f64; 2]> {
        (0..=highest).map(|n| [4.0 / 3.0 * size * parabola_kernel(TAU * f64::from(n) * size), 0.0]).collect()
    }

    /// The envelope summed, and beyond some harmonic its integral (2T/π²hN)(1 + T/4πhN).
    fn tails(&self, highest: u32, size: f64) -> Vec<f64> {
        let close = 1.0 / size;
        let integral = |n: f64| 2.0 / (PI * PI * size * n) * (1.0 + 0.25 / (PI * size * n));
        if size < NARROWEST {
            return narrow(highest, close, 8.0 / 3.0 * SQRT_2 * size, integral);
        }
        let last = highest.max(close.ceil() as u32);
        summed(highest, last, integral(f64::from(last)), |n| 2.0 * Self::envelope(n, size))
    }

    fn mean(&self, size: f64) -> f64 {
        4.0 / 3.0 * SQRT_2 * size
    }

    fn degree(&self, error: f64, size: f64) -> f64 {
        2.2 / (PI * PI * size * error) + 1.0
    }
}
