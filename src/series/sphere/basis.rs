//! The basis itself.

use std::f64::consts::{PI, SQRT_2};

use glam::DVec3;

use super::index;

/// The numbers in the recurrences of P̄_lm, which do not depend on the direction.
///
/// P̄_lm is normalised over the sphere with its azimuth's factor left out: 2π ∫ P̄_lm² sin θ dθ = 1, and carries no
/// Condon–Shortley sign. With x = cos θ,
///
/// ```text
/// P̄_00 = √(1/4π)      P̄_mm = √((2m+1)/2m) sin θ P̄_m−1,m−1      P̄_lm = a x P̄_l−1,m − b P̄_l−2,m
/// a = √((4l²−1)/(l²−m²))      b = a √(((l−1)²−m²)/(4(l−1)²−1))
/// ```
///
/// Nothing in it grows, unlike factorials. (Holmes and Featherstone, "A unified approach to the Clenshaw summation",
/// Journal of Geodesy 76, 2002, eq. 11 to 13, where the norm is 4π.)
pub struct Basis {
    degree: usize,
    /// P̄_mm / sin^m θ.
    seeds: Vec<f64>,
    /// \[a, b\] for l = m+1 ..= degree, one m after the other.
    steps: Vec<[f64; 2]>,
}

impl Basis {
    /// The basis up to a degree; tested to [`super::HIGHEST_DEGREE`]. Beyond it P̄_mm underflows near the poles and may
    /// be missed where P̄_lm has grown again.
    pub fn new(degree: usize) -> Self {
        let mut seeds = vec![(0.25 / PI).sqrt()];
        for m in 1..=degree {
            seeds.push(seeds[m - 1] * ((2 * m + 1) as f64 / (2 * m) as f64).sqrt());
        }
        let steps = (0..=degree).flat_map(|m| (m + 1..=degree).map(move |l| step(l, m))).collect();
        Self { degree, seeds, steps }
    }

    /// The highest l.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// P̄_mm / sin^m θ, and \[a, b\] for l = m+1 ..= degree.
    pub(super) fn column(&self, m: usize) -> (f64, &[[f64; 2]]) {
        let start = m * self.degree - m * m.saturating_sub(1) / 2;
        (self.seeds[m], &self.steps[start..][..self.degree - m])
    }

    /// Hands P̄_lm at cos θ and sin θ to `take(l, m, value)`, for 0 ≤ m ≤ l ≤ degree: by m, then by l.
    ///
    /// Relative to the largest value of its degree off by some 1e-15 at l = 10 and 2e-11 at l = 1500.
    pub fn legendre(&self, cos: f64, sin: f64, mut take: impl FnMut(usize, usize, f64)) {
        let mut power = 1.0;
        for m in 0..=self.degree {
            let (seed, steps) = self.column(m);
            let (mut before, mut value) = (0.0, seed * power);
            take(m, m, value);
            for (l, &[a, b]) in (m + 1..).zip(steps) {
                (before, value) = (value, a * cos * value - b * before);
                take(l, m, value);
            }
            power *= sin;
        }
    }

    /// All Y_lm at a direction of any length but 0, without the Condon–Shortley sign, at [`index`]`(l, m)`.
    ///
    /// # Panics
    /// If `values` has not (degree + 1)² elements.
    pub fn fill(&self, direction: DVec3, values: &mut [f64]) {
        assert_eq!(values.len(), (self.degree + 1).pow(2), "a value for each harmonic");
        let (sin, length) = (direction.truncate().length(), direction.length());
        // The azimuth means nothing at a pole.
        let (cos_phi, sin_phi) = if sin > 0.0 { (direction.x / sin, direction.y / sin) } else { (1.0, 0.0) };
        let (mut order, mut c, mut s) = (0, 1.0, 0.0);
        self.legendre(direction.z / length, sin / length, |l, m, value| {
            if m != order {
                let weight = if m == 1 { SQRT_2 } else { 1.0 };
                (c, s) = (weight * (c * cos_phi - s * sin_phi), weight * (s * cos_phi + c * sin_phi));
                order = m;
            }
            values[index(l, m as isize)] = value * c;
            if m > 0 {
                values[index(l, -(m as isize))] = value * s;
            }
        });
    }

    /// [`Basis::fill`] into a new list of (degree + 1)² values.
    pub fn at(&self, direction: DVec3) -> Vec<f64> {
        let mut values = vec![0.0; (self.degree + 1).pow(2)];
        self.fill(direction, &mut values);
        values
    }
}

fn step(l: usize, m: usize) -> [f64; 2] {
    let [l, m] = [l as f64, m as f64];
    let a = ((4.0 * l * l - 1.0) / ((l - m) * (l + m))).sqrt();
    let below = l - 1.0;
    // Zero for l = m + 1, where there is nothing two below.
    [a, a * (((below - m) * (below + m)) / (4.0 * below * below - 1.0)).sqrt()]
}
