//! The eye: glare functions in degrees, per steradian.
//!
//! | tag | source |
//! | --- | --- |
//! | \[CIE146\] | CIE 146:2002, *CIE equations for disability glare*: general, and age-adjusted Stiles-Holladay |
//! | \[CIE135\] | CIE 135/1-1999, *Disability glare*, and Vos & van den Berg, eq. 8: the total glare function |
//! | \[SPENCER\] | Spencer et al., *Physically-based glare effects for digital images*, SIGGRAPH 1995 |

use serde::{Deserialize, Serialize};

use super::Fault;
use super::fault::within;

/// From where on \[CIE146\]'s equation holds, in degrees; nearer, the value here is kept.
pub(super) const CIE_FROM: f64 = 0.1;
/// How far \[CIE146\]'s equation, \[CIE135\]'s and, here, Stiles and Holladay's go, in degrees.
pub(super) const CIE_END: f64 = 100.0;
/// From where on Stiles and Holladay's equation holds, in degrees; nearer, the value here is kept.
pub(super) const STILES_FROM: f64 = 1.0;
/// How far \[SPENCER\]'s functions go: each has unit energy over the hemisphere.
pub(super) const SPENCER_END: f64 = 90.0;

/// The ages that are taken, in years: beyond what anybody measured, the equations are only continued.
pub const AGES: [f64; 2] = [0.0, 120.0];
/// The pigment factors that are taken: 0 black eyes, 0.5 brown, 1.0 light, 1.2 very light.
pub const PIGMENTS: [f64; 2] = [0.0, 1.2];

/// Whose eye it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observer {
    age: f64,
    pigment: f64,
}

impl Observer {
    /// An observer of `age` years, whose eyes have the pigment factor `pigment`.
    ///
    /// # Errors
    /// On `age` or `pigment` outside [`AGES`] or [`PIGMENTS`], or no number.
    pub fn new(age: f64, pigment: f64) -> Result<Self, Fault> {
        Ok(Self {
            age: within("age", age, AGES, "an age is from 0 to 120 years")?,
            pigment: within(
                "pigment",
                pigment,
                PIGMENTS,
                "a pigment factor is from 0 (black eyes) to 1.2 (very light)",
            )?,
        })
    }

    /// Age, in years.
    pub fn age(self) -> f64 {
        self.age
    }

    /// Pigment factor.
    pub fn pigment(self) -> f64 {
        self.pigment
    }

    /// The same eyes at another age, which must be one of [`AGES`].
    pub(super) fn aged(self, age: f64) -> Self {
        Self { age, ..self }
    }
}

/// To what light the eye is adapted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Luminance {
    /// By day.
    #[default]
    Photopic,
    /// At dusk.
    Mesopic,
    /// At night.
    Scotopic,
}

/// 1 + (A/62.5)⁴, by which age raises \[CIE146\]'s wide part.
fn age_factor(age: f64) -> f64 {
    1.0 + (age / 62.5).powi(4)
}

/// \[CIE146\]'s general equation without its constant, at θ > 0 degrees: 10/θ³ + (5/θ² + 0.1p/θ)(1 + (A/62.5)⁴).
pub(super) fn cie(observer: Observer, angle: f64) -> f64 {
    let inverse = 1.0 / angle.max(CIE_FROM);
    let [first, second, third] = cie_powers(observer);
    inverse * (first + inverse * (second + inverse * third))
}

/// What θ⁻¹, θ⁻² and θ⁻³ are taken by in [`cie`], θ in degrees.
pub(super) fn cie_powers(observer: Observer) -> [f64; 3] {
    let aged = age_factor(observer.age);
    [0.1 * observer.pigment * aged, 5.0 * aged, 10.0]
}

/// \[CIE146\]'s constant: light through the wall of the eye.
pub(super) fn cie_constant(observer: Observer) -> f64 {
    0.0025 * observer.pigment
}

/// The parts of \[CIE135\], each (1 + (θ/c)²)^−β times a factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Moffat {
    pub factor: f64,
    pub core: f64,
    pub exponent: f64,
}

impl Moffat {
    pub fn value(self, angle: f64) -> f64 {
        let square = 1.0 + (angle / self.core) * (angle / self.core);
        // The three exponents are multiples of a half, and `powf` is many times as slow.
        self.factor
            * match self.exponent {
                0.5 => 1.0 / square.sqrt(),
                1.0 => 1.0 / square,
                1.5 => 1.0 / (square * square.sqrt()),
                exponent => square.powf(-exponent),
            }
    }
}

/// \[CIE135\]'s total function without its constant and its term in θ², by its five parts. With a₄ = (A/70)⁴,
///
/// (1 − 0.08a₄) [9.2e6 (1+(θ/0.0046)²)^−1.5 + 1.5e5 (1+(θ/0.045)²)^−1.5]
/// + (1 + 1.6a₄) {400 (1+(θ/0.1)²)^−1 + p [1300 (1+(θ/0.1)²)^−1.5 + 0.8 (1+(θ/0.1)²)^−0.5]},
///
/// over 1 + p (0.0417 + 0.055a₄). A public copy prints 0.008 for 0.08: with that the function's energy would be 1.08 to
/// 1.14 of the light at ages 70 and 80, and with 0.08 it is at most 1.04.
pub(super) fn cie135(observer: Observer) -> [Moffat; 5] {
    let [core, wide] = cie135_factors(observer);
    let pigment = observer.pigment;
    let factors = [core, core, wide, wide * pigment, wide * pigment];
    let scaled = |i: usize| Moffat { factor: factors[i] * CIE135_MOFFATS[i].factor, ..CIE135_MOFFATS[i] };
    [0, 1, 2, 3, 4].map(scaled)
}

/// The five parts of \[CIE135\] by themselves: the core's two, the one that age raises, and the two of pigment.
pub(super) const CIE135_MOFFATS: [Moffat; 5] = [
    Moffat { factor: 9.2e6, core: 0.0046, exponent: 1.5 },
    Moffat { factor: 1.5e5, core: 0.045, exponent: 1.5 },
    Moffat { factor: 400.0, core: 0.1, exponent: 1.0 },
    Moffat { factor: 1300.0, core: 0.1, exponent: 1.5 },
    Moffat { factor: 0.8, core: 0.1, exponent: 0.5 },
];

/// What θ² (degrees) is taken by in \[CIE135\], beside the factor of age.
pub(super) const CIE135_QUADRATIC: f64 = 3e-8;

/// 1 − 0.08a₄ and 1 + 1.6a₄, over the normaliser.
pub(super) fn cie135_factors(observer: Observer) -> [f64; 2] {
    let a4 = (observer.age / 70.0).powi(4);
    [1.0 - 0.08 * a4, 1.0 + 1.6 * a4].map(|factor| factor / cie135_normaliser(observer))
}

/// 1 + p (0.0417 + 0.055a₄).
pub(super) fn cie135_normaliser(observer: Observer) -> f64 {
    1.0 + observer.pigment * (0.0417 + 0.055 * (observer.age / 70.0).powi(4))
}

/// \[CIE135\]'s constant, and the factor of its term in θ² (degrees).
pub(super) fn cie135_moments(observer: Observer) -> [f64; 2] {
    let [_, wide] = cie135_factors(observer);
    [0.0025 * observer.pigment / cie135_normaliser(observer), CIE135_QUADRATIC * wide]
}

/// \[SPENCER\]'s functions of θ in degrees without the ring f₃ (the ciliary corona's lenticular halo, which depends on
/// the wavelength and lies at 3°): f₀ = 2.61e6 e^−(θ/0.02)², f₁ = 20.91/(θ+0.02)³, f₂ = 72.37/(θ+0.02)², by the weights
/// of [`spencer_weights`]. The ring's share of the light, 0.016 (mesopic) or 0.033 (scotopic), is left out and not
/// given to the others.
pub(super) fn spencer(luminance: Luminance, angle: f64) -> f64 {
    let [core, cube, square] = spencer_weights(luminance);
    let inverse = 1.0 / (angle + SPENCER_SHIFT);
    core * (-(angle / SPENCER_SHIFT) * (angle / SPENCER_SHIFT)).exp() + inverse * inverse * (square + inverse * cube)
}

/// The 0.02 degrees in all of \[SPENCER\]'s functions.
pub(super) const SPENCER_SHIFT: f64 = 0.02;

/// What e^−(θ/0.02)², (θ+0.02)⁻³ and (θ+0.02)⁻² are taken by.
pub(super) fn spencer_weights(luminance: Luminance) -> [f64; 3] {
    let [core, cube, square] = match luminance {
        Luminance::Photopic => [0.384, 0.478, 0.138],
        Luminance::Mesopic => [0.368, 0.478, 0.138],
        Luminance::Scotopic => [0.282, 0.478, 0.207],
    };
    [core * 2.61e6, cube * 20.91, square * 72.37]
}

/// The age-adjusted equation of Stiles and Holladay \[CIE146\], 10 (1 + (A/70)⁴)/θ², is made for 1 to 30 degrees. Nearer,
/// the value at 1° is kept; beyond, the same power goes on to 100°, which the standard does not say.
pub(super) fn stiles_holladay(age: f64, angle: f64) -> f64 {
    let angle = angle.max(STILES_FROM);
    stiles_holladay_power(age) / (angle * angle)
}

/// What θ⁻² is taken by in [`stiles_holladay`].
pub(super) fn stiles_holladay_power(age: f64) -> f64 {
    10.0 * (1.0 + (age / 70.0).powi(4))
}
