//! The prototype's formulas as its notes print them, where they are wrong, incomplete, inconsistent or unstable.
//!
//! Nothing that vglare renders by default comes from here. The formulas are kept so that a reader of the notes can see
//! how large each difference is: tests measure them, docs/math.md lists them, and `vglare rex --as-printed` draws them.
//! The notes are those of the prototype *rex*: 000 (2025-03-07), 001 (2025-03-18) and 003.
//!
//! A whole two-dimensional bell is a *table*: (a, b, p, r) for each mode, the coefficients of c_n c_m, s_n s_m, c_n s_m
//! and s_n c_m about the ghost's own centre, with every prefactor multiplied in. It holds the whole rectangle
//! n = 0 ..= N, m = 0 ..= M, one n after the other.

mod cosine;
mod disc;
mod gaussian;
mod mip;
mod parabola;

use std::f64::consts::TAU;

use glam::DVec2;

pub use cosine::{Slips, Zeroth, cosine_factor, cosine_integral, cosine_kappas, cosine_table};
pub use disc::half_disc;
pub use gaussian::{GaussianForm, erf, erf_f32, erf_not_extended, gaussian_table, half_range, peak};
pub use mip::last_mip;
pub use parabola::{
    parabola_cosine, parabola_kernel, parabola_kernel_f32, parabola_mean, parabola_sine, parabola_titled,
};

/// The two-dimensional bells that the notes' formulas give.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Printed2d {
    /// The Gaussian, by one of the ways in which 000 and 003 put its series together.
    Gaussian {
        /// σ of the bell, in the unit of the period.
        sigma: f64,
        /// Which way.
        form: GaussianForm,
    },
    /// cos²x cos²y by the C++ of 000; the period along x serves both axes, as it does there.
    Cosine {
        /// Which of the program's slips are made.
        slips: Slips,
        /// What becomes of the 0-th terms.
        zeroth: Zeroth,
    },
    /// 1 − (x² + y²) by the integral of 000, which knows the diagonal n = m only.
    HalfDisc,
}

impl Printed2d {
    /// The bell's table for the periods along x and y (in the unit of the bell's size) and the highest harmonics.
    pub fn table(self, period: DVec2, degree: [u32; 2]) -> Vec<[f64; 4]> {
        match self {
            Self::Gaussian { sigma, form } => gaussian_table(sigma, form, period, degree),
            Self::Cosine { slips, zeroth } => cosine_table(slips, zeroth, period.x, degree),
            Self::HalfDisc => disc::table(period, degree),
        }
    }
}

/// The table of an even bell: `coefficient(n, m)` for each mode, and nothing with a sine.
pub fn even_table(degree: [u32; 2], coefficient: impl Fn(u32, u32) -> f64) -> Vec<[f64; 4]> {
    let modes = (0..=degree[0]).flat_map(|n| (0..=degree[1]).map(move |m| (n, m)));
    modes.map(|(n, m)| [coefficient(n, m), 0.0, 0.0, 0.0]).collect()
}

/// What a table is worth at an offset from the bell's centre, every term by its own sine and cosine.
///
/// # Panics
/// Where the table does not hold the rectangle of modes up to `degree`.
pub fn table_value(table: &[[f64; 4]], period: DVec2, degree: [u32; 2], offset: DVec2) -> f64 {
    let rows = degree[1] as usize + 1;
    assert_eq!(table.len(), (degree[0] as usize + 1) * rows, "the whole rectangle of modes");
    let waves = |highest: u32, turns: f64| -> Vec<(f64, f64)> {
        (0..=highest).map(|n| (TAU * f64::from(n) * turns).sin_cos()).collect()
    };
    let (along_x, along_y) = (waves(degree[0], offset.x / period.x), waves(degree[1], offset.y / period.y));
    let term = |(index, &[a, b, p, r]): (usize, &[f64; 4])| {
        let ((sn, cn), (sm, cm)) = (along_x[index / rows], along_y[index % rows]);
        a * cn * cm + b * sn * sm + p * cn * sm + r * sn * cm
    };
    table.iter().enumerate().map(term).sum()
}

/// κ as 000 and 003 word it: "2 if n = 0 or m = 0". Read after "1 if n = 0 and m = 0" it is right; read by itself, as
/// here, it doubles the mean. The pseudo-code of 003 asks in the right order.
pub fn kappa_by_or(n: u32, m: u32) -> f64 {
    if n == 0 || m == 0 { 2.0 } else { 4.0 }
}

/// How many ghosts 000 sums over for K of them: its sums for cos² run k = 0 ..= K, one more than there are.
pub fn ghosts_summed(count: u32) -> u32 {
    (0..=count).count() as u32
}
