//! Zonal kernels: what blurs alike in all directions multiplies each band by a number.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::{Basis, Coefficients, gauss_legendre, index};

impl Coefficients {
    /// The function convolved with a kernel that depends on the angle alone: band l times `eigenvalues[l]`.
    ///
    /// The eigenvalue is λ_l = 2π ∫ h(t) P_l(t) dt over |t| ≤ 1 = √(4π/(2l+1)) h_l0 (Funk and Hecke), which [`zonal`]
    /// computes.
    ///
    /// # Panics
    /// If there are fewer eigenvalues than bands.
    pub fn convolved(&self, eigenvalues: &[f64]) -> Self {
        let mut result = self.clone();
        for (l, eigenvalue) in eigenvalues[..=self.degree].iter().enumerate() {
            for value in &mut result.values[l * l..(l + 1) * (l + 1)] {
                *value = value.map(|c| c * eigenvalue);
            }
        }
        result
    }

    /// The irradiance that a surface facing each direction gets from this radiance: band l times [`lambert`]`(l)`.
    /// In the photo's unit times steradian; a radiance of 1 all round gives π.
    pub fn irradiance(&self) -> Self {
        self.convolved(&(0..=self.degree).map(lambert).collect::<Vec<_>>())
    }
}

/// λ_l for l = 0 ..= degree of a kernel h(cos angle), by `nodes` Gauss–Legendre nodes: exact for a polynomial h of degree
/// 2 `nodes` − 1 − `degree` and below.
pub fn zonal(degree: usize, nodes: usize, kernel: impl Fn(f64) -> f64) -> Vec<f64> {
    let basis = Basis::new(degree);
    // h_l0 first: the zonal harmonics do not need the azimuth.
    let mut values = vec![0.0; degree + 1];
    let (seed, steps) = basis.column(0);
    for (t, weight) in gauss_legendre(nodes) {
        let (mut before, mut value) = (0.0, seed);
        let share = TAU * weight * kernel(t);
        values[0] += share * value;
        for (sum, &[a, b]) in values[1..].iter_mut().zip(steps) {
            (before, value) = (value, a * t * value - b * before);
            *sum += share * value;
        }
    }
    values.iter().enumerate().map(|(l, h)| h * (2.0 * TAU / (2 * l + 1) as f64).sqrt()).collect()
}

/// A_l of the cosine lobe max(0, cos θ): π, 2π/3, π/4, 0, −π/24, 0, … (Ramamoorthi and Hanrahan, "An efficient
/// representation for irradiance environment maps", SIGGRAPH 2001, eq. 7 to 9.)
pub fn lambert(l: usize) -> f64 {
    match l {
        1 => TAU / 3.0,
        l if l % 2 == 1 => 0.0,
        // l! / (2^l (l/2)!²), as a product that stays below 1.
        l => {
            let ratio: f64 = (1..=l / 2).map(|k| (2 * k - 1) as f64 / (2 * k) as f64).product();
            let sign = if l % 4 == 0 { -1.0 } else { 1.0 };
            sign * TAU * ratio / ((l + 2) as f64 * (l as f64 - 1.0))
        }
    }
}

/// The irradiance at a unit normal from the nine coefficients of l ≤ 2 as a quadratic polynomial, as a shader would
/// have it (Ramamoorthi and Hanrahan 2001, eq. 13). Higher bands add at most 3/32 of the strongest irradiance, and that
/// much only sideways of a single point of light.
///
/// # Panics
/// If the degree is below 2.
pub fn irradiance_of_nine(coefficients: &Coefficients, normal: DVec3) -> [f64; 3] {
    assert!(coefficients.degree() >= 2, "nine coefficients");
    let DVec3 { x, y, z } = normal;
    // A_l times the factor in Y_lm; the paper's c1 to c5 are rounded ones.
    let c1 = PI / 16.0 * (15.0 / PI).sqrt();
    let c2 = PI / 3.0 * (0.75 / PI).sqrt();
    let c3 = 3.0 * PI / 16.0 * (5.0 / PI).sqrt();
    let c4 = PI * (0.25 / PI).sqrt();
    let c5 = PI / 16.0 * (5.0 / PI).sqrt();
    [0, 1, 2].map(|colour| {
        let c = |l, m| coefficients.values()[index(l, m)][colour];
        c1 * c(2, 2) * (x * x - y * y) + c3 * c(2, 0) * z * z + c4 * c(0, 0) - c5 * c(2, 0)
            + 2.0 * c1 * (c(2, -2) * x * y + c(2, 1) * x * z + c(2, -1) * y * z)
            + 2.0 * c2 * (c(1, 1) * x + c(1, -1) * y + c(1, 0) * z)
    })
}
