//! Real spherical harmonics, in f64: light as a function of direction.
//!
//! Directions are unit vectors, z up; θ is the angle from +z, φ runs from +x to +y. The basis is orthonormal over the
//! sphere, and Y_lm stands at index l(l+1)+m of every list:
//!
//! ```text
//! Y_l0 = P̄_l0(cos θ)      Y_lm = √2 P̄_lm(cos θ) cos mφ      Y_l,−m = √2 P̄_lm(cos θ) sin mφ      (m > 0)
//! ```
//!
//! without the Condon–Shortley sign, so that Y_1,−1, Y_10, Y_11 are positive multiples of y, z, x; [`Phase`] changes
//! between the conventions. docs/math.md has the derivations.
//!
//! | module | what |
//! | --- | --- |
//! | `basis` | P̄_lm and Y_lm by recurrence |
//! | `as_printed` | P_lm as textbooks print it, which overflows |
//! | `quadrature` | nodes and weights |
//! | `projection` | functions of direction ↔ coefficients |
//! | `panorama` | equirectangular pictures ↔ coefficients |
//! | `rotation` | turned coefficients, by matrices of whole bands |
//! | `wigner` | turned coefficients of any degree |
//! | `turned` | coefficients of turned pictures, the long way round |
//! | `convolution` | zonal kernels, and the irradiance of a matt surface |

mod as_printed;
mod basis;
mod convolution;
mod panorama;
mod projection;
mod quadrature;
mod rotation;
mod turned;
mod wigner;

use glam::DVec3;

pub use as_printed::{Real, legendre_as_printed, norm_squared_as_printed};
pub use basis::Basis;
pub use convolution::{irradiance_of_nine, lambert, zonal};
pub use panorama::{Grid, Reading, project_panorama};
pub use projection::project;
pub use quadrature::{fejer, gauss_legendre};
pub use rotation::{Band, RECURSION_LIMIT, each_band, turn};
pub use turned::{project_samples, project_turned};

/// The highest degree that the recurrences are tested for.
pub const HIGHEST_DEGREE: usize = 1500;

/// Where Y_lm stands in a list of coefficients: l(l+1)+m, for |m| ≤ l.
pub fn index(l: usize, m: isize) -> usize {
    debug_assert!(m.unsigned_abs() <= l, "|m| ≤ l");
    ((l * (l + 1)) as isize + m) as usize
}

/// Whether the basis has the sign (−1)^m of Condon and Shortley; only conversion depends on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Phase {
    /// Without; all of this module.
    #[default]
    Plain,
    /// With (−1)^m in every Y_lm: Green, "Spherical Harmonic Lighting: The Gritty Details", 2003; Direct3D's library.
    CondonShortley,
}

impl Phase {
    /// The factor between Y_lm, or its coefficient, in this convention and without the sign: 1 or −1.
    pub fn sign(self, m: isize) -> f64 {
        if self == Self::CondonShortley && m % 2 != 0 { -1.0 } else { 1.0 }
    }
}

/// A function of direction of three colours: Σ c_lm Y_lm up to a degree.
#[derive(Debug, Clone, PartialEq)]
pub struct Coefficients {
    degree: usize,
    values: Vec<[f64; 3]>,
}

impl Coefficients {
    /// The function 0; (degree + 1)² coefficients.
    pub fn zero(degree: usize) -> Self {
        Self { degree, values: vec![[0.0; 3]; (degree + 1).pow(2)] }
    }

    /// From (degree + 1)² coefficients, RGB, c_lm at [`index`]`(l, m)`.
    ///
    /// # Panics
    /// If there are not as many.
    pub fn new(degree: usize, values: Vec<[f64; 3]>) -> Self {
        assert_eq!(values.len(), (degree + 1).pow(2), "a coefficient for each harmonic up to degree {degree}");
        Self { degree, values }
    }

    /// The highest l.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// All coefficients, c_lm at [`index`]`(l, m)`.
    pub fn values(&self) -> &[[f64; 3]] {
        &self.values
    }

    /// All coefficients, to be changed in place.
    pub fn values_mut(&mut self) -> &mut [[f64; 3]] {
        &mut self.values
    }

    /// The coefficients of one l, m from −l to l.
    pub fn band(&self, l: usize) -> &[[f64; 3]] {
        &self.values[l * l..(l + 1) * (l + 1)]
    }

    /// ∫ of the square of one band over the sphere, the sum of the three colours.
    pub fn band_energy(&self, l: usize) -> f64 {
        self.band(l).as_flattened().iter().map(|c| c * c).sum()
    }

    /// The bands up to `degree`, which must not be above this one's.
    pub fn truncated(&self, degree: usize) -> Self {
        Self::new(degree, self.values[..(degree + 1).pow(2)].to_vec())
    }

    /// The function at a direction, RGB. For many directions, [`Coefficients::sum`] with one basis is faster.
    pub fn at(&self, direction: DVec3) -> [f64; 3] {
        self.sum(&Basis::new(self.degree).at(direction))
    }

    /// Σ c_lm Y_lm for harmonics that [`Basis::fill`] has given.
    pub fn sum(&self, harmonics: &[f64]) -> [f64; 3] {
        self.values.iter().zip(harmonics).fold([0.0; 3], |sum, (c, y)| [0, 1, 2].map(|i| sum[i] + c[i] * y))
    }

    /// The same function's coefficients for a basis of the other convention; its own inverse.
    pub fn in_phase(mut self, phase: Phase) -> Self {
        for l in 0..=self.degree {
            for (m, value) in (-(l as isize)..).zip(&mut self.values[l * l..(l + 1) * (l + 1)]) {
                *value = value.map(|c| c * phase.sign(m));
            }
        }
        self
    }

    /// How far these are from `exact`: √(Σ |difference|² / Σ |exact|²) over all l and m, the worst of the three colours.
    /// 0 where both are nothing, infinite where something stands against nothing.
    ///
    /// # Panics
    /// If the degrees differ.
    pub fn difference(&self, exact: &Self) -> f64 {
        assert_eq!(self.degree, exact.degree, "the same degree");
        let of_colour = |i: usize| {
            let (mut error, mut norm) = (0.0, 0.0);
            for (ours, theirs) in self.values.iter().zip(&exact.values) {
                error += (ours[i] - theirs[i]).powi(2);
                norm += theirs[i].powi(2);
            }
            if error == 0.0 { 0.0 } else { (error / norm).sqrt() }
        };
        // NaN counts as infinitely far; folding with max would lose it.
        [0, 1, 2].map(of_colour).into_iter().fold(0.0, |worst, e| if e.is_nan() { f64::INFINITY } else { e.max(worst) })
    }
}
