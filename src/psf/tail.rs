//! A function far from its centre, as powers of the angle.

use super::Psf;
use super::eye::{self, SPENCER_SHIFT};
use super::function::Function;

/// Powers of the angle that stand for a function of the eye from an angle on, as the sphere takes them
/// ([`super::ChordSeries`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Tail {
    /// What θ^−1, θ^−2, … are taken by, θ in degrees, per steradian.
    pub powers: Vec<f64>,
    /// What is added everywhere.
    pub constant: f64,
    /// What θ² is taken by and added.
    pub quadratic: f64,
    /// From which angle on the error holds, in degrees, to [`Psf::end`].
    pub from: f64,
    /// The largest relative error there; 0 for `cie` and `stiles-holladay`, which are powers.
    pub error: f64,
}

/// The powers that a series is cut to.
pub(super) const ORDERS: usize = 8;

impl Tail {
    /// Its value at an angle in degrees.
    pub fn value(&self, angle: f64) -> f64 {
        let inverse = 1.0 / angle;
        inverse * self.powers.iter().rev().fold(0.0, |sum, power| sum * inverse + power)
            + self.constant
            + self.quadratic * angle * angle
    }
}

impl Psf {
    /// The tail of a function in degrees from `from` degrees on; None for the others. `cie` and `stiles-holladay` are
    /// powers from where they are not flat; of `cie135` and `spencer` the series in core/θ is cut after eight powers,
    /// and tells its error.
    pub fn tail(&self, from: f64) -> Option<Tail> {
        let powers = match &self.function {
            Function::Cie(observer) => eye::cie_powers(*observer).to_vec(),
            Function::StilesHolladay { age } => vec![0.0, eye::stiles_holladay_power(*age)],
            Function::Cie135(observer) => eye::cie135(*observer).iter().fold(vec![0.0; ORDERS], |mut powers, part| {
                part.add_powers(&mut powers);
                powers
            }),
            Function::Spencer(luminance) => {
                let [_, cube, square] = eye::spencer_weights(*luminance);
                shifted(square, 2).iter().zip(shifted(cube, 3)).map(|(a, b)| a + b).collect()
            }
            Function::Part(part, _) => part.powers().to_vec(),
            _ => return None,
        };
        let [constant, quadratic] = self.function.moments();
        let from = if from.is_finite() { from.clamp(1e-9, self.end()).max(self.flat_within()) } else { self.end() };
        let mut tail = Tail {
            powers: powers.iter().map(|power| power * self.scale).collect(),
            constant: constant * self.scale,
            quadratic: quadratic * self.scale,
            from,
            error: 0.0,
        };
        if !matches!(self.function, Function::Cie(_) | Function::StilesHolladay { .. }) {
            // What is left out falls faster than the function, so that it is largest at the begin; 64 angles more see
            // to it.
            let angle = |i: i32| from * (self.end() / from).powf(f64::from(i) / 64.0);
            tail.error =
                (0..=64).map(|i| (tail.value(angle(i)) / self.value(angle(i)) - 1.0).abs()).fold(0.0, f64::max);
        }
        Some(tail)
    }
}

impl eye::Moffat {
    /// (1 + (θ/c)²)^−β = Σ binomial(−β, j) (c/θ)^(2β + 2j), added to the powers θ^−1, θ^−2, ….
    pub(super) fn add_powers(self, powers: &mut [f64]) {
        let first = (2.0 * self.exponent) as usize;
        let mut factor = self.factor * self.core.powi(first as i32);
        for (j, order) in (first..=powers.len()).step_by(2).enumerate() {
            powers[order - 1] += factor;
            factor *= -(self.exponent + j as f64) / (j as f64 + 1.0) * self.core * self.core;
        }
    }
}

/// (θ + h)^−s = Σ binomial(−s, j) h^j θ^−(s + j), h = 0.02°, times `factor`, as the powers θ^−1, θ^−2, ….
pub(super) fn shifted(factor: f64, s: usize) -> [f64; ORDERS] {
    let mut powers = [0.0; ORDERS];
    let mut next = factor;
    for (j, power) in powers[s - 1..].iter_mut().enumerate() {
        *power = next;
        next *= -((s + j) as f64) / (j as f64 + 1.0) * SPENCER_SHIFT;
    }
    powers
}
