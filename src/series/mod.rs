//! Bells and their Fourier series, in f64.
//!
//! One normalisation throughout: the *mean* coefficients of the *periodised* bell. For a factor u of period T,
//!
//! ```text
//! a_n = 1/T ∫ u(x) cos(nωx) dx     b_n = 1/T ∫ u(x) sin(nωx) dx
//! Σ_j u(x + jT) = a_0 + 2 Σ_{n≥1} a_n cos(nωx) + b_n sin(nωx)
//! ```
//!
//! with the integrals over the whole line, so that a shift stays exact and no window cuts the bell. A bell need not be a
//! product of factors: only its shift has to separate, so a round bell uses its two-dimensional transform in the same
//! tables. docs/math.md has the derivations.
//!
//! A new bell is a file beside this one, its file in `shaders/bells/`, and a line in [`Bell`] and in
//! `shaders/bells/any.glsl`.

mod bell;
mod cosine_squared;
mod disc;
mod distinct;
pub mod fourier_bessel;
pub(crate) mod frequencies;
mod gaussian;
mod iris;
pub mod moments;
mod nodes;
pub mod numeric;
mod parabola;
mod paraboloid;
mod periodic;
pub mod printed;
mod profile;
pub mod special;
pub mod sphere;
mod spline;
mod tails;
mod waves;

pub use bell::{Bell, Bounded, Factor, Modes, Plane, Radial, Shape};
pub use disc::{Disc, MOST_BLADES};
pub(crate) use distinct::Distinct;
pub use gaussian::{windowed_gaussian, wrapped_gaussian};
pub use iris::{Cut, Iris};
pub use periodic::{SineGaussian, VonMises};
pub use profile::Profile;
pub use spline::{CUBIC, spline_error, spline_error_of, spline_gains};
pub use waves::waves;

/// The weight of mode (n, m) in the series of a bell: 1, 2 where exactly one index is 0, else 4.
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
mod tests;
