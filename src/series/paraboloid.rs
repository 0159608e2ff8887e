//! The paraboloid 1 − r² within r ≤ 1, round on its floor. It is no product, but its shift separates all the same: its
//! coefficients are its Hankel transform at |(nω1ρx, mω2ρy)|.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use glam::DVec2;
use rayon::prelude::*;

use super::bell::{Bounded, Modes, Radial, Shape};
use super::special::{paraboloid_kernel, paraboloid_kernel_looked_up};
use super::tails::copies;

pub(super) struct Paraboloid;

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
        FRAC_PI_2 * paraboloid_kernel(z)
    }

    fn transforms(&self, at: &[f64]) -> Vec<f64> {
        at.par_iter().map(|&z| FRAC_PI_2 * paraboloid_kernel_looked_up(z)).collect()
    }
}

impl Bounded for Paraboloid {
    fn beyond(&self, z: f64, _cell: f64) -> f64 {
        cut_off(z)
    }

    /// √z |J2(z)| is below 0.86.
    fn envelope(&self, z: f64) -> f64 {
        FRAC_PI_2 * (8.0 * 0.86 / (z * z * z.sqrt())).min(1.0)
    }
}
