//! The transform in the plane of a radial function, F(q) = 2π ∫₀^∞ r k(r) J₀(qr) dr.

use std::f64::consts::{PI, TAU};

use super::eye::Moffat;
use super::integral::{integral, integral_from_zero};

/// Lobes of J₀ that are summed beyond the last place where the function bends sharply, before they are extrapolated.
const LOBES: usize = 36;
/// Lobes that are summed at most.
const MOST_LOBES: f64 = 20_000.0;

/// The transform of `value` at q > 0 radians per unit. It changes little within `scale`, and is smooth beyond `smooth`.
///
/// One integral for each lobe of J₀, whose sums alternate and are averaged again and again (Euler's summation): so
/// powers of r that fall too slowly for an integral, a constant and r² have the transforms that are meant: 0 of the
/// last two.
pub(super) fn transform(value: &impl Fn(f64) -> f64, scale: f64, smooth: f64, q: f64) -> f64 {
    let integrand = |r: f64| TAU * r * value(r) * libm::j0(q * r);
    let zero = |n: usize| zero(n) / q;
    let lobes = LOBES + (q * smooth / PI).min(MOST_LOBES) as usize;
    let mut sum = integral_from_zero(&integrand, scale.min(zero(1)), zero(1));
    let mut sums = Vec::with_capacity(LOBES);
    for n in 1..lobes {
        if n + LOBES >= lobes {
            sums.push(sum);
        }
        sum += integral(&integrand, zero(n), zero(n + 1));
    }
    sums.push(sum);
    while sums.len() > 1 {
        sums = sums.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    }
    sums[0]
}

/// The n-th zero of J₀ by McMahon's expansion, n from 1: near enough for ends of lobes.
fn zero(n: usize) -> f64 {
    let beta = (n as f64 - 0.25) * PI;
    beta + 0.125 / beta
}

/// The transform at q > 0 radians per unit of a `value` that is nothing beyond `end`, where it may fall all at once; it changes
/// little within `scale`.
///
/// Lobe by lobe to the end. Where there are too many lobes, as [`transform`] has it, less what would go on beyond the end:
/// 2π ∫_R^∞ r k J₀(qr) dr = −2π R k(R) J₁(qR)/q (1 + O(1/qR)), by parts.
pub(super) fn transform_within(value: &impl Fn(f64) -> f64, scale: f64, end: f64, q: f64) -> f64 {
    if q * end / PI > MOST_LOBES {
        return transform(value, scale, end, q) + TAU * end * value(end) * libm::j1(q * end) / q;
    }
    let integrand = |r: f64| TAU * r * value(r) * libm::j0(q * r);
    let first = (zero(1) / q).min(end);
    let mut sum = integral_from_zero(&integrand, scale.min(first), first);
    let mut from = first;
    for n in 2.. {
        if from >= end {
            break;
        }
        let to = (zero(n) / q).min(end);
        sum += integral(&integrand, from, to);
        from = to;
    }
    sum
}

impl Moffat {
    /// The transform at q > 0 radians per unit of one of the three exponents of \[CIE135\]: with z = cq, c the core, 2πc²
    /// times e^−z/z (β = 1/2), K₀(z) (β = 1), e^−z (β = 3/2).
    pub(super) fn transform(self, q: f64) -> f64 {
        let z = self.core * q;
        let shape = match self.exponent {
            0.5 => (-z).exp() / z,
            1.0 => bessel_k0(z),
            _ => (-z).exp(),
        };
        self.factor * TAU * self.core * self.core * shape
    }
}

/// K₀(z) = ∫₀^∞ e^(−z cosh t) dt for z > 0 (DLMF 10.32.9), by the trapezoidal rule, whose error falls with e^(−π²/h):
/// at h = 1/8 below rounding.
pub(super) fn bessel_k0(z: f64) -> f64 {
    const STEP: f64 = 0.125;
    let term = |i: u32| (-z * (STEP * f64::from(i)).cosh()).exp();
    let tail: f64 = (1..).map(term).take_while(|term| *term > 1e-320).sum();
    STEP * (0.5 * term(0) + tail)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a disc of radius R and value 1, 2πR J₁(qR)/q, with few lobes and with more than are summed.
    #[test]
    fn a_disc_has_the_transform_of_a_disc() {
        for (end, q) in [(1.0, 1e-3), (1.0, 0.5), (3.0, 40.0), (1e-9, 7.0), (2.0, 3e3), (1.0, 7e4)] {
            let disc = |r: f64| f64::from(u8::from(r <= end));
            let known = TAU * end * libm::j1(q * end) / q;
            let off = transform_within(&disc, 0.1 * end, end, q) - known;
            assert!(off.abs() <= 1e-9 * TAU * end * end / (1.0 + q * end), "{end}, {q}: {off:e} of {known:e}");
        }
    }

    /// DLMF 10.31.2 and 10.40.2, summed by hand at both ends, and the value at 1 of tables (Abramowitz & Stegun 9.8).
    #[test]
    fn k0_is_the_one_of_tables() {
        assert!((bessel_k0(1.0) - 0.421_024_438_240_708_34).abs() < 1e-15);
        let small: f64 = 1e-3;
        let square = 0.25 * small * small;
        let known = -((0.5 * small).ln() + 0.577_215_664_901_532_9) * (1.0 + square) + square;
        assert!((bessel_k0(small) / known - 1.0).abs() < 1e-11, "{}", bessel_k0(small) / known - 1.0);
        let z: f64 = 40.0;
        let known = (0.5 * PI / z).sqrt()
            * (-z).exp()
            * (1.0 - 1.0 / (8.0 * z) + 9.0 / (128.0 * z * z) - 225.0 / (3072.0 * z * z * z));
        assert!((bessel_k0(z) / known - 1.0).abs() < 1e-6);
    }
}
