//! Bells and their Fourier series, in f64.
//!
//! One normalisation throughout: the *mean* coefficients of the *periodised* bell. For an even factor u of period T,
//!
//! ```text
//! α_n = 1/T ∫ u(x) cos(nωx) dx        Σ_j u(x + jT) = α_0 + 2 Σ_{n≥1} α_n cos(nωx)
//! ```
//!
//! with the integral over the whole line, so that a shift stays exact and no window cuts the bell. docs/math.md has
//! the derivations.

mod gaussian;
pub mod printed;
mod spline;

use std::fmt;

use glam::DVec2;

pub use spline::spline_error;

/// The kinds of bell, by the name that scene files use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bell {
    /// exp(−x²/2σx² − y²/2σy²).
    Gaussian,
}

impl Bell {
    /// Every bell. With [`Bell::shape`], the registry: a new bell is a file beside this one and a line in each.
    pub const ALL: [Self; 1] = [Self::Gaussian];

    /// What the bell is, mathematically.
    pub fn shape(self) -> &'static dyn Shape {
        match self {
            Self::Gaussian => &gaussian::Gaussian,
        }
    }
}

impl fmt::Display for Bell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.shape().name())
    }
}

/// A bell that is a product u(x/σx) u(y/σy) of even, non-negative factors whose coefficients are not negative.
///
/// Sizes σ and distances are in one unit, whichever; a `size` alone is in periods.
pub trait Shape: Sync {
    /// The name that files and reports use.
    fn name(&self) -> &'static str;

    /// The bell's file in `shaders/`, which defines `bell_coefficient` and `bell_value`.
    fn shader(&self) -> &'static str;

    /// The factor u at a distance measured in sizes; u(0) = 1, and it never grows with the distance.
    fn factor(&self, distance: f64) -> f64;

    /// ∫ u over the line, for size 1.
    fn integral(&self) -> f64;

    /// α_n of the factor of a size in periods.
    fn coefficient(&self, n: u32, size: f64) -> f64;

    /// At index N an upper bound of Σ_{n>N} 2α_n, for N = 0 ..= `highest`, of the factor of a size in periods. It is
    /// also the largest error of the factor's series cut after N, because every coefficient counts towards the centre.
    fn tails(&self, highest: u32, size: f64) -> Vec<f64>;

    /// A bound of what all other copies of the factor add, `period` apart, within `distance` < `period` of its centre.
    fn wrap(&self, period: f64, distance: f64, size: f64) -> f64;

    /// The bell at an offset from its centre that is measured in sizes.
    fn value(&self, offset: DVec2) -> f64 {
        self.factor(offset.x) * self.factor(offset.y)
    }
}

/// The weight of mode (n, m) in the series of an even bell: 1, 2 where exactly one index is 0, else 4.
pub fn kappa(n: u32, m: u32) -> f64 {
    f64::from((1 + u32::from(n > 0)) * (1 + u32::from(m > 0)))
}

/// The place of `x` in its period, as a fraction of a turn in units of 2⁻³²; `n *` it wraps as n x / T does.
pub fn phase(x: f64, period: f64) -> u32 {
    let turns = x / period;
    // The cast wraps the rounding of .999… up to a whole turn back to 0.
    ((turns - turns.floor()) * 2f64.powi(32)).round() as u64 as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// α_n by the trapezium rule on the periodised factor, which converges faster than any power for smooth ones.
    fn coefficient_by_quadrature(shape: &dyn Shape, n: u32, size: f64) -> f64 {
        let samples = 4096;
        let copies = (12.0 * size).ceil() as i32 + 1;
        let sum: f64 = (0..samples)
            .map(|i| {
                let x = f64::from(i) / f64::from(samples);
                let value: f64 = (-copies..=copies).map(|j| shape.factor((x + f64::from(j)) / size)).sum();
                value * (std::f64::consts::TAU * f64::from(n) * x).cos()
            })
            .sum();
        sum / f64::from(samples)
    }

    #[test]
    fn every_bell_keeps_the_promises_of_the_registry() {
        for bell in Bell::ALL {
            let shape = bell.shape();
            assert_eq!(shape.factor(0.0), 1.0, "{bell}");
            for distance in [0.1, 0.9, 1.7, 3.0] {
                assert_eq!(shape.factor(distance), shape.factor(-distance), "{bell} is even");
                assert!(shape.factor(distance) <= shape.factor(0.9 * distance), "{bell} never grows");
            }
            for size in [0.02, 0.1, 0.4] {
                assert!((shape.coefficient(0, size) - shape.integral() * size).abs() < 1e-12, "{bell}: the mean");
                for n in [0, 1, 2, 5, 9, 20] {
                    let (closed, quadrature) = (shape.coefficient(n, size), coefficient_by_quadrature(shape, n, size));
                    assert!((closed - quadrature).abs() < 1e-14, "{bell} α_{n} at {size}: {closed} {quadrature}");
                }
            }
        }
    }

    #[test]
    fn tails_and_wraps_are_never_below_the_truth() {
        for bell in Bell::ALL {
            let shape = bell.shape();
            for size in [0.01, 0.05, 0.2, 1.0] {
                let tails = shape.tails(60, size);
                for highest in 0..=60 {
                    let truth: f64 = (highest + 1..4000).map(|n| 2.0 * shape.coefficient(n, size)).sum();
                    let bound = tails[highest as usize];
                    assert!(bound >= truth * (1.0 - 1e-12), "{bell} tail at {highest}, {size}: {bound} {truth}");
                    assert!(bound <= truth * 1.01 + 1e-15, "{bell} tail {highest} at {size} is loose: {bound} {truth}");
                }
                for distance in [0.3, 0.5, 0.8, 0.99] {
                    let others = (-40..=40).filter(|&j| j != 0).map(|j| shape.factor((distance - f64::from(j)) / size));
                    let truth: f64 = others.sum();
                    let bound = shape.wrap(1.0, distance, size);
                    assert!(bound >= truth * (1.0 - 1e-12), "{bell} wrap at {distance}, {size}: {bound} {truth}");
                }
            }
        }
    }

    #[test]
    fn phases_wrap() {
        assert_eq!(phase(0.0, 3.0), 0);
        assert_eq!(phase(0.75, 3.0), 1 << 30);
        assert_eq!(phase(-0.75, 3.0), 3 << 30);
        assert_eq!(phase(3.0 * 1e6, 3.0), 0);
        assert_eq!(phase(-1e-30, 3.0), 0);
    }

    #[test]
    fn kappa_is_two_where_exactly_one_index_is_zero() {
        assert_eq!([kappa(0, 0), kappa(0, 3), kappa(7, 0), kappa(2, 2)], [1.0, 2.0, 2.0, 4.0]);
    }
}
