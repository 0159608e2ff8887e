//! The Gaussian of 000 and 003: half-range integrals, a real error function, and prefactors that do not belong together.

use std::f64::consts::{SQRT_2, TAU};

use glam::DVec2;

use super::{even_table, kappa_by_or};
use crate::series::kappa;

/// p and a1 … a5 of \[AS\] 7.1.26.
///
/// \[AS\] Abramowitz and Stegun, Handbook of Mathematical Functions, page 299.
const P: f64 = 0.327_591_1;
const A: [f64; 5] = [0.254_829_592, -0.284_496_736, 1.421_413_741, -1.453_152_027, 1.061_405_429];

/// erf by \[AS\] 7.1.26, for any x: odd, as the book's x ≥ 0 leaves to the reader.
///
/// The notes print |ε| ≤ 5·10⁻⁷ for it; the book says 1.5·10⁻⁷, and f64 reaches 1.394·10⁻⁷ (at x = 0.045).
pub fn erf(x: f64) -> f64 {
    erf_not_extended(x.abs()).copysign(x)
}

/// The same expression for x < 0, too, as 000 and 001 print it, without saying where it holds: erf(−½) becomes −0.52090
/// instead of −0.52050, and there is a pole at x = −3.05.
pub fn erf_not_extended(x: f64) -> f64 {
    let t = 1.0 / (1.0 + P * x);
    let sum = A.iter().rev().fold(0.0, |sum, a| (sum + a) * t);
    1.0 - sum * (-x * x).exp()
}

/// [`erf`] in f32, as a shader would: off by up to 6·10⁻⁷, more than the notes allow it.
pub fn erf_f32(x: f32) -> f32 {
    let t = 1.0 / (1.0 + P as f32 * x.abs());
    let sum = A.iter().rev().fold(0.0, |sum, &a| (sum + a as f32) * t);
    (1.0 - sum * (-x * x).exp()).copysign(x)
}

/// 1/(σ√2π), the peak that 000 and 001 give the Gaussian of two variables: it is that of one. The volume below the bell
/// is then σ√2π instead of 1, which needs 1/(2πσ²).
pub fn peak(sigma: f64) -> f64 {
    1.0 / (sigma * TAU.sqrt())
}

/// The coefficient a_n of 000: √(2π)σ/2 · exp(−(nωσ)²/2) · erf(T/(2√2σ)), for ∫_0^{T/2} exp(−x²/2σ²) cos(nωx) dx.
///
/// The integral needs Re erf(T/(2√2σ) + i nωσ/√2); with the real argument this is right at n = 0 only. It is the
/// coefficient of the *periodised* bell instead, T/2 times it, dimmed by the same `erf` at every n. From T = 10 σ on the
/// dimming is below 10⁻⁶.
///
/// `erf` is the error function to use: [`erf`] for the notes' own.
pub fn half_range(sigma: f64, period: f64, n: u32, erf: impl Fn(f64) -> f64) -> f64 {
    let turn = TAU / period * f64::from(n) * sigma;
    0.5 * TAU.sqrt() * sigma * (-0.5 * turn * turn).exp() * erf(period / (2.0 * SQRT_2 * sigma))
}

/// The ways in which 000 and 003 make two coefficients into a series of two variables. With I_n = [`half_range`], all
/// that a mode (n, m) is multiplied by is here.
///
/// The ratios are those of the series to a bell of peak 1, where T is many σ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GaussianForm {
    /// 000 and 003: κ/(T1 T2) · I_n I_m; the κ of full-range integrals with half-range ones. 1/4.
    HalfRange,
    /// 003's program: κ/T² · I_n I_m with one T, which is taken for T1. T2/(4 T1).
    OnePeriod,
    /// The same with full-range integrals 2 I_n 2 I_m, which leaves the slip of the one T. T2/T1.
    OnePeriodFullRange,
    /// 000 and 003: κ/(T1 T2) · (2/T1) I_n (2/T2) I_m; the integrals already carry their prefactor. 1/(T1 T2). (The
    /// notes' slices g(x, y_k) g(x_k, y) carry the bell's peak twice, besides; here it is 1.)
    Slices,
    /// 000 and 003: (2/T1) I_n (2/T2) I_m without any κ, as their A, B, C and D are printed. (1 + α_0)(1 + β_0)/4, the mean
    /// alone at its full strength.
    NoKappa,
    /// 000: [a_0/2 + Σ a_n c_n] [b_0/2 + Σ b_m c_m] with a_n = I_n, which lacks its 4/T. T1 T2/16.
    Halves,
    /// 000 and 003: a_00/4 + Σ a_nm c_n c_m with the right a_nm, the modes with one index 0 taken as they are printed,
    /// whole; they need 1/2.
    EdgesWhole,
    /// The same, the sum read as one over n, m ≥ 1: the modes with one index 0 are missing.
    EdgesDropped,
    /// The right series but for κ: "2 if n = 0 or m = 0" taken at its word, see [`kappa_by_or`].
    KappaByOr,
}

impl GaussianForm {
    /// Every form.
    pub const ALL: [Self; 9] = [
        Self::HalfRange,
        Self::OnePeriod,
        Self::OnePeriodFullRange,
        Self::Slices,
        Self::NoKappa,
        Self::Halves,
        Self::EdgesWhole,
        Self::EdgesDropped,
        Self::KappaByOr,
    ];

    /// As the tables name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::HalfRange => "κ/(T1 T2) I J",
            Self::OnePeriod => "κ/T² I J",
            Self::OnePeriodFullRange => "κ/T² 2I 2J",
            Self::Slices => "κ/(T1 T2) (2/T1) I (2/T2) J",
            Self::NoKappa => "(2/T1) I (2/T2) J, no κ",
            Self::Halves => "[a0/2 + Σ][b0/2 + Σ] without 4/T",
            Self::EdgesWhole => "a00/4 + Σ, edges whole",
            Self::EdgesDropped => "a00/4 + Σ, edges dropped",
            Self::KappaByOr => "κ = 2 if n = 0 or m = 0",
        }
    }

    /// What I_n I_m is multiplied by.
    fn prefactor(self, period: DVec2, n: u32, m: u32) -> f64 {
        let area = period.element_product();
        let edges = [n, m].iter().filter(|&&index| index == 0).count();
        match self {
            Self::HalfRange => kappa(n, m) / area,
            Self::OnePeriod => kappa(n, m) / (period.x * period.x),
            Self::OnePeriodFullRange => 4.0 * kappa(n, m) / (period.x * period.x),
            Self::Slices => kappa(n, m) / area * 4.0 / area,
            Self::NoKappa => 4.0 / area,
            Self::Halves => 0.5_f64.powi(edges as i32),
            // a_nm = 4/(T1 T2) · the integral over the whole plane, which is 4 I_n I_m.
            Self::EdgesWhole => 16.0 / area * [1.0, 1.0, 0.25][edges],
            Self::EdgesDropped => 16.0 / area * [1.0, 0.0, 0.25][edges],
            Self::KappaByOr => 4.0 * kappa_by_or(n, m) / area,
        }
    }
}

/// The table (a, b, p, r) of a Gaussian of peak 1 and size `sigma` by one of the notes' forms and with their [`erf`].
pub fn gaussian_table(sigma: f64, form: GaussianForm, period: DVec2, degree: [u32; 2]) -> Vec<[f64; 4]> {
    let integral = |period, n| half_range(sigma, period, n, erf);
    even_table(degree, |n, m| form.prefactor(period, n, m) * integral(period.x, n) * integral(period.y, m))
}
