//! 1 − (x² + y²) of 000: half of the disc, and the diagonal of the modes.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec2;

use super::even_table;
use crate::series::kappa;

/// a_n of 000: ∫_{−1}^{1} ∫_0^{√(1−x²)} (1 − x² − y²) cos qx cos qy dy dx, q = nω.
///
/// The inner integral has to begin at −√(1−x²): this is half of the bell's. And the cosines of x and y have to have an
/// index each, a_nm: this is the diagonal. Valid for q up to about 1000.
pub fn half_disc(q: f64) -> f64 {
    // With x = sin t the integrand is smooth and of period π, so that the trapezium rule converges faster than any power
    // once it resolves the waves.
    let samples = 64 + (2.0 * q).ceil() as u32;
    let sum: f64 = (0..samples)
        .map(|i| {
            let (x, h) = (PI * f64::from(i) / f64::from(samples) - FRAC_PI_2).sin_cos();
            (q * x).cos() * chord(q, h) * h
        })
        .sum();
    sum * PI / f64::from(samples)
}

/// ∫_0^h (h² − y²) cos qy dy.
fn chord(q: f64, h: f64) -> f64 {
    let z = q * h;
    if z.abs() < 0.05 {
        // 2 (sin z − z cos z)/z³ cancels here; these are the first terms of its power series.
        let z2 = z * z;
        return h.powi(3) * (2.0 / 3.0) * (1.0 - z2 / 10.0 * (1.0 - z2 / 28.0 * (1.0 - z2 / 54.0 * (1.0 - z2 / 88.0))));
    }
    2.0 * (z.sin() - z * z.cos()) / q.powi(3)
}

/// The table (a, b, p, r) with a_n on the diagonal and nothing beside it. The note gives no prefactor: κ/(T1 T2) is the
/// one that belongs to such an integral. ω is that of x, as the note has one.
pub(super) fn table(period: DVec2, degree: [u32; 2]) -> Vec<[f64; 4]> {
    let coefficient = |n| kappa(n, n) / period.element_product() * half_disc(TAU / period.x * f64::from(n));
    even_table(degree, |n, m| if n == m { coefficient(n) } else { 0.0 })
}
