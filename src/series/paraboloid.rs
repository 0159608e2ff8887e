//! The paraboloid 1 − r² within r ≤ 1, round on its floor. It is no product, but its shift separates all the same: its
//! coefficients are its Hankel transform at |(nω1ρx, mω2ρy)|.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use glam::DVec2;

use super::bell::{Modes, Radial, Shape};
use super::tails::copies;

pub(super) struct Paraboloid;

/// 8 J2(z)/z², with its limit 1 at 0.
pub(super) fn psi(z: f64) -> f64 {
    let square = z * z;
    if z.abs() < 0.5 {
        // Divisors 4k(k + 2): the series of J2.
        let divisors = [252.0, 192.0, 140.0, 96.0, 60.0, 32.0, 12.0];
        return divisors.into_iter().fold(1.0, |tail, divisor| 1.0 - square / divisor * tail);
    }
    8.0 * libm::jn(2, z) / square
}

/// How far the series of a paraboloid of height and radius 1 is off at most if it has all modes below z.
///
/// Across the rim the bell is a kink with a slope of 2 on one side, and leaving out all that varies faster than z there
/// changes it by 2/(πz). What the whole rim sends to the centre is of the order z^(−3/2).
pub(super) fn cut_off(z: f64) -> f64 {
    (FRAC_2_PI / z * (1.0 + 2.6 / z.sqrt())).min(1.0)
}

impl Shape for Paraboloid {
    fn name(&self) -> &'static str {
        "paraboloid"
    }

    fn shader(&self) -> &'static str {
        "bells/paraboloid.glsl"
    }

    fn value(&self, offset: DVec2, size: DVec2) -> f64 {
        (1.0 - (offset / size).length_squared()).max(0.0)
    }

    /// (1 − x²)(1 − y²) is 1 − x² − y² and more.
    fn along(&self, distance: f64, size: f64) -> f64 {
        (1.0 - (distance / size).powi(2)).max(0.0)
    }

    fn wrap(&self, period: f64, distance: f64, size: f64) -> f64 {
        copies(period, distance, size, |x| self.along(x, size))
    }

    fn steepest(&self, distance: f64) -> f64 {
        if distance < 1.0 { 2.0 } else { 0.0 }
    }

    fn integral(&self, size: DVec2) -> f64 {
        FRAC_PI_2 * size.element_product()
    }

    fn variance(&self) -> f64 {
        1.0 / 6.0
    }

    fn modes(&self) -> Modes<'_> {
        Modes::Radial(self)
    }
}

impl Radial for Paraboloid {
    /// ĝ(z) = 4π J2(z)/z².
    fn transform(&self, z: f64) -> f64 {
        FRAC_PI_2 * psi(z)
    }

    fn beyond(&self, z: f64, _cell: f64) -> f64 {
        cut_off(z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn psi_joins_its_series() {
        for z in [0.499_999, 0.5, 0.500_001] {
            assert!((psi(z) - 8.0 * libm::jn(2, z) / (z * z)).abs() < 3e-15, "{z}");
        }
        assert_eq!(psi(0.0), 1.0);
    }
}
