//! Functions of the plane, in the look's unit r, per square of it.
//!
//! | tag | source |
//! | --- | --- |
//! | \[HARVEY\] | Harvey & Shack: light scattered by a polished surface, as A/(B + δ^g), δ in cosines of direction |
//! | \[KING\] | I. R. King, *The profile of a star image*, PASP 83 (1971) 199: a Gaussian core, an aureole as r⁻² |

use std::f64::consts::{PI, TAU};

use super::Fault;
use super::fault::{positive, within};
use super::integral::integral_from_zero;

/// How many widths a mixture may be given.
pub const MOST_WIDTHS: usize = 64;
/// The exponents g that are taken of an ABg tail.
pub const EXPONENTS: [f64; 2] = [0.5, 10.0];

/// A round Gaussian.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    /// Standard deviation, in the function's unit.
    pub sigma: f64,
    /// Value at the centre, per squared unit (per steradian of functions in degrees). Its energy on the plane is 2πσ²
    /// times this.
    pub weight: f64,
    /// What each channel takes of it; 1 each but for a `mixture` with tints.
    pub tint: [f64; 3],
}

impl Term {
    /// Without a tint.
    pub fn new(sigma: f64, weight: f64) -> Self {
        Self { sigma, weight, tint: [1.0; 3] }
    }

    /// With unit energy on the plane times `share`.
    pub(super) fn of_energy(sigma: f64, share: f64, tint: [f64; 3]) -> Self {
        Self { sigma, weight: share / (TAU * sigma * sigma), tint }
    }

    /// Its value at a distance whose square is `square`, without the tint.
    pub fn value(&self, square: f64) -> f64 {
        self.weight * (-0.5 * square / (self.sigma * self.sigma)).exp()
    }

    /// Its energy on the plane, in squared units times what the weight is in.
    pub fn energy(&self) -> f64 {
        TAU * self.sigma * self.sigma * self.weight
    }
}

/// A Gaussian of standard deviation `width` and unit energy.
pub(super) fn gaussian(width: f64) -> Result<Vec<Term>, Fault> {
    Ok(vec![Term::of_energy(positive("width", width)?, 1.0, [1.0; 3])])
}

/// Gaussians of standard deviations `widths`, whose energies are as `weights` to each other (equal without any) and
/// together 1, each tinted by its three of `tints` (white without any).
pub(super) fn mixture(widths: &[f64], weights: Option<&[f64]>, tints: Option<&[[f64; 3]]>) -> Result<Vec<Term>, Fault> {
    let count = widths.len();
    if !(1..=MOST_WIDTHS).contains(&count) {
        return Err(Fault::new("widths", format!("a mixture has from 1 to {MOST_WIDTHS} widths, and not {count}")));
    }
    for (key, given) in [("weights", weights.map(<[_]>::len)), ("tints", tints.map(<[_]>::len))] {
        if given.is_some_and(|given| given != count) {
            return Err(Fault::new(
                key,
                format!("there must be one for each of the {count} widths, and not {}", given.unwrap_or(0)),
            ));
        }
    }
    let shares = match weights {
        None => vec![1.0; count],
        Some(weights) => weights
            .iter()
            .map(|&weight| within("weights", weight, [0.0, 1e18], "a weight is a number from 0 to 1e18"))
            .collect::<Result<_, _>>()?,
    };
    let total: f64 = shares.iter().sum();
    if total < 1e-18 {
        return Err(Fault::new("weights", "one at least must be above 0"));
    }
    let term = |i: usize| {
        let tint = tints.map_or([1.0; 3], |tints| tints[i]);
        for channel in tint {
            within("tints", channel, [0.0, 1e6], "a tint has three numbers from 0 to 1e6")?;
        }
        Ok(Term::of_energy(positive("widths", widths[i])?, shares[i] / total, tint))
    };
    let terms: Vec<Term> = (0..count).map(term).collect::<Result<_, Fault>>()?;
    // A tint of nothing but zeros is a veil that is not there, and nothing can be relative to it.
    if (0..3).all(|channel| terms.iter().all(|term| term.tint[channel] * term.weight == 0.0)) {
        return Err(Fault::new("tints", "one of a weighted width at least must be above 0"));
    }
    Ok(terms)
}

/// A/(B + r^g) \[HARVEY\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Abg {
    a: f64,
    b: f64,
    g: f64,
    /// Where it ends: beyond, it is 0.
    pub end: f64,
}

impl Abg {
    /// The tail of these three to the radius `end`: without one to infinity, which takes g above 2.
    pub fn new([a, b, g]: [f64; 3], end: Option<f64>) -> Result<Self, Fault> {
        let (a, b) = (positive("a", a)?, positive("b", b)?);
        let g = within("g", g, EXPONENTS, "the exponent of an ABg tail is from 0.5 to 10")?;
        let end = match end {
            Some(end) => positive("end", end)?,
            // Closer to 2 the energy is a matter of what is light years away.
            None if g >= 2.05 => f64::INFINITY,
            None => {
                let rule = "a tail whose `g` is below 2.05 has no finite energy: say at which radius it ends";
                return Err(Fault::new("end", rule));
            }
        };
        Ok(Self { a, b, g, end })
    }

    /// The same with the factor 1, and what it has for that.
    pub fn over_its_factor(self) -> (Self, f64) {
        (Self { a: 1.0, ..self }, self.a)
    }

    /// Its value at the radius r; 0 beyond its end.
    pub fn value(self, r: f64) -> f64 {
        if r > self.end { 0.0 } else { self.a / (self.b + r.powf(self.g)) }
    }

    /// The radius at which it has half its height.
    pub fn core(self) -> f64 {
        self.b.powf(1.0 / self.g)
    }

    /// The radius at which it has fallen to 1e-100 of its height, or where it ends.
    pub fn reach(self) -> f64 {
        (self.core() * 1e100_f64.powf(1.0 / self.g)).min(self.end)
    }

    /// 2π ∫ r k dr to its end.
    pub fn energy(self) -> f64 {
        if self.end.is_finite() {
            return integral_from_zero(&|r| TAU * r * self.value(r), self.core(), self.end);
        }
        // ∫₀^∞ r/(B + r^g) dr = B^(2/g − 1) (π/g)/sin(2π/g).
        TAU * self.a * self.b.powf(2.0 / self.g - 1.0) * (PI / self.g) / (TAU / self.g).sin()
    }
}

/// A camera's lens: the light that it scatters, a core and a tail in heights of the picture.
///
/// The tail is r⁻² between two radii, and smooth: a mixture of Gaussians of all widths σ between them, with the same
/// energy for each factor of width. Its integral is closed, S/(2πLr²) (e^(−r²/2σ₁²) − e^(−r²/2σ₀²)) with L = ln(σ₁/σ₀),
/// S its share of the light.
///
/// The form is \[KING\]'s; the numbers are chosen, since lenses differ and no table of measured ones is open. Of the
/// light, 1 % glows around a lamp and 2 % is spread over the picture; a black patch of a tenth of the height amid white
/// has then about 1 %, what a clean lens may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Camera;

impl Camera {
    /// The core's share of the light.
    const CORE: f64 = 0.01;
    /// The tail's.
    const TAIL: f64 = 0.02;
    /// σ of the core and of the narrowest and the widest Gaussian of the tail.
    pub const WIDTHS: [f64; 3] = [0.003, 0.004, 0.5];

    /// The light that is scattered.
    pub fn energy(self) -> f64 {
        Self::CORE + Self::TAIL
    }

    /// The core.
    fn core(self) -> Term {
        Term::of_energy(Self::WIDTHS[0], Self::CORE, [1.0; 3])
    }

    /// Its value at the radius r.
    pub fn value(self, r: f64) -> f64 {
        let square = r * r;
        let [narrow, wide] = [Self::WIDTHS[1], Self::WIDTHS[2]].map(|sigma| 0.5 / (sigma * sigma));
        // (e^−wx − e^−nx)/x, without cancelling near 0.
        let difference = if square > 0.0 {
            (-wide * square).exp() * -((wide - narrow) * square).exp_m1() / square
        } else {
            narrow - wide
        };
        self.core().value(square) + Self::TAIL / (TAU * (Self::WIDTHS[2] / Self::WIDTHS[1]).ln()) * difference
    }
}
