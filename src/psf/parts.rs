//! What the functions of the eye are sums of, whoever's eye it is.
//!
//! The published functions are linear in a few numbers that follow from age, pigment and adaptation; what those numbers
//! are taken by depends on the angle alone. Here is the latter, by its formula, without a factor.
//!
//! None of them vanishes within the angles that a picture has, so that the veil of each can be had relative to itself.

use super::eye::{self, Luminance, Moffat, SPENCER_SHIFT};
use super::hankel;
use super::tail::{ORDERS, shifted};

/// A function of the angle in degrees that is nowhere negative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Part {
    /// θ^−`exponent`, whose value at `from` degrees is kept nearer to 0.
    Power { exponent: i32, from: f64 },
    /// 1.
    Constant,
    /// CIE 135's two Moffats of the core, whose weight falls with age.
    Core,
    /// CIE 135's Moffat that age raises, and its term in θ², which goes with it.
    Wide,
    /// CIE 135's two Moffats that age and pigment raise.
    Pigment,
    /// Spencer's (θ + 0.02)⁻³ and (θ + 0.02)⁻² as by day.
    Tail,
    /// Spencer's (θ + 0.02)⁻².
    Square,
}

impl Part {
    /// Its value at an angle ≥ 0.
    pub fn value(self, angle: f64) -> f64 {
        match self {
            Self::Power { exponent, from } => angle.max(from).powi(-exponent),
            Self::Constant => 1.0,
            Self::Tail | Self::Square => {
                let [cube, square] = self.shifted_powers();
                let inverse = 1.0 / (angle + SPENCER_SHIFT);
                inverse * inverse * (square + inverse * cube)
            }
            Self::Core | Self::Wide | Self::Pigment => {
                let [_, quadratic] = self.moments();
                self.moffats().iter().map(|moffat| moffat.value(angle)).sum::<f64>() + quadratic * angle * angle
            }
        }
    }

    /// What of it no Gaussian has to stand for: a constant, and what the squared angle is taken by.
    pub fn moments(self) -> [f64; 2] {
        match self {
            Self::Constant => [1.0, 0.0],
            Self::Wide => [0.0, eye::CIE135_QUADRATIC],
            _ => [0.0; 2],
        }
    }

    /// Within what it is constant by definition; 0 where it is not, or everywhere.
    pub fn flat_within(self) -> f64 {
        if let Self::Power { from, .. } = self { from } else { 0.0 }
    }

    /// Within what it changes little.
    pub fn scale(self) -> f64 {
        match self {
            Self::Power { from, .. } => from,
            Self::Constant => 1.0,
            Self::Core => 0.002,
            Self::Wide | Self::Pigment => 0.05,
            Self::Tail | Self::Square => 0.2 * SPENCER_SHIFT,
        }
    }

    /// The transform in the plane at q > 0 radians per degree; a constant and θ² have none.
    pub fn transform(self, q: f64) -> f64 {
        match self {
            Self::Constant => 0.0,
            Self::Core | Self::Wide | Self::Pigment => {
                self.moffats().iter().map(|moffat| moffat.transform(q)).sum::<f64>()
            }
            Self::Power { .. } | Self::Tail | Self::Square => {
                hankel::transform(&|angle| self.value(angle), self.scale(), 3.0 * self.scale(), q)
            }
        }
    }

    /// What θ^−1, θ^−2, … are taken by far from the centre: exactly of powers, else cut after so many.
    pub fn powers(self) -> [f64; ORDERS] {
        let mut powers = [0.0; ORDERS];
        match self {
            Self::Power { exponent, .. } => powers[exponent as usize - 1] = 1.0,
            Self::Tail | Self::Square => {
                let [cube, square] = self.shifted_powers();
                let both = shifted(cube, 3).into_iter().zip(shifted(square, 2)).map(|(a, b)| a + b);
                powers.iter_mut().zip(both).for_each(|(power, both)| *power = both);
            }
            _ => self.moffats().iter().for_each(|moffat| moffat.add_powers(&mut powers)),
        }
        powers
    }

    /// What (θ + 0.02)⁻³ and (θ + 0.02)⁻² are taken by; nothing in others.
    fn shifted_powers(self) -> [f64; 2] {
        match self {
            Self::Tail => {
                let [_, cube, square] = eye::spencer_weights(Luminance::Photopic);
                [cube, square]
            }
            Self::Square => [0.0, 1.0],
            _ => [0.0; 2],
        }
    }

    /// The Moffats of a part of CIE 135; none of others.
    fn moffats(self) -> &'static [Moffat] {
        match self {
            Self::Core => &eye::CIE135_MOFFATS[..2],
            Self::Wide => &eye::CIE135_MOFFATS[2..3],
            Self::Pigment => &eye::CIE135_MOFFATS[3..],
            _ => &[],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The closed forms of Moffats, against the lobes of the transform's definition.
    #[test]
    fn transforms_of_parts_are_those_of_their_values() {
        for part in [Part::Core, Part::Wide, Part::Pigment] {
            let [constant, quadratic] = part.moments();
            let value = |angle: f64| part.value(angle) - constant - quadratic * angle * angle;
            for q in [0.5, 30.0] {
                let lobes = hankel::transform(&value, 0.2 * part.scale(), 3.0 * part.scale().max(0.1), q);
                let closed = part.transform(q);
                assert!((lobes / closed - 1.0).abs() < 1e-6, "{part:?} at {q}: {lobes} for {closed}");
            }
        }
    }
}
