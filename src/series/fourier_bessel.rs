//! The paraboloid as a Fourier-Bessel series on a disc, and Graf's theorem, which takes the ghosts out of it.
//!
//! This is the notes' way to a bell with a round floor. The disc r ≤ L is *about each ghost*: the series is neither
//! periodic nor zero outside, so a point should be within L of every ghost. In all of this, lengths have one unit,
//! whichever, and α_k is the k-th positive zero of J_0.

use glam::DVec2;

use super::special::{bessel_j, bessel_j_all, j0_zeros};

/// The bell A − B r², cut off at its edge ρ = √(A/B).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paraboloid {
    /// A > 0.
    pub peak: f64,
    /// B > 0.
    pub curvature: f64,
}

impl Paraboloid {
    /// ρ = √(A/B).
    pub fn edge(&self) -> f64 {
        (self.peak / self.curvature).sqrt()
    }

    /// The bell at a distance from its centre, 0 to A.
    pub fn value(&self, distance: f64) -> f64 {
        (self.peak - self.curvature * distance * distance).max(0.0)
    }
}

/// A bell's place, and what it is multiplied by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Its centre, in the disc's unit.
    pub center: DVec2,
    /// What it is multiplied by.
    pub weight: f64,
}

/// Where the coefficients come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Chain {
    /// The integral up to the edge or up to L, whichever is nearer.
    #[default]
    Whole,
    /// The notes' last line, which integrates up to the edge even where that lies beyond the disc. There the series folds
    /// the rest back into the disc, and is wrong from r = 2L − ρ on.
    Printed,
}

/// The weights κ_m of Graf's sum over m = 0, 1, 2, ….
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Kappa {
    /// 1 for m = 0, else 2.
    #[default]
    Right,
    /// 1 for m = 1, 2 for m > 1, as the notes print it. They name none for m = 0: here it is `zeroth`.
    Printed {
        /// κ_0.
        zeroth: f64,
    },
}

impl Kappa {
    /// κ_m.
    pub fn weight(self, m: u32) -> f64 {
        match (self, m) {
            (Self::Right, 0) | (Self::Printed { .. }, 1) => 1.0,
            (Self::Printed { zeroth }, 0) => zeroth,
            _ => 2.0,
        }
    }
}

/// Term k: a_k J_0(α_k r/L).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    /// α_k.
    pub alpha: f64,
    /// a_k.
    pub coefficient: f64,
}

/// Σ_k a_k J_0(α_k r/L), k = 1 ..= N.
#[derive(Debug, Clone, PartialEq)]
pub struct FourierBessel {
    /// L > 0.
    pub radius: f64,
    /// The terms, from k = 1 on.
    pub terms: Vec<Term>,
}

impl FourierBessel {
    /// The first `count` terms of a bell on the disc r ≤ `radius`.
    ///
    /// With s = α_k/L, for an edge within the disc, ρ ≤ L,
    ///
    /// ```text
    /// a_k = 4A J_2(sρ) / (α_k² J_1(α_k)²)
    /// a_k = 2/(L² J_1(α_k)²) [(A − BL²) L J_1(α_k)/s + 2BL² J_2(α_k)/s²]      for ρ > L
    /// ```
    ///
    /// from a_k = 2/(L² J_1(α_k)²) ∫₀^L r f(r) J_0(sr) dr by parts (docs/math.md, "Fourier-Bessel and Graf").
    pub fn new(bell: Paraboloid, radius: f64, count: u32, chain: Chain) -> Self {
        let (edge, Paraboloid { peak, curvature }) = (bell.edge(), bell);
        let inside = edge <= radius || chain == Chain::Printed;
        let term = |zero: super::special::J0Zero| {
            let (alpha, j1) = (zero.alpha, zero.j1);
            let s = alpha / radius;
            let coefficient = if inside {
                4.0 * peak * bessel_j(2, s * edge) / (alpha * alpha * j1 * j1)
            } else {
                let rim = (peak - curvature * radius * radius) * radius * j1 / s;
                let bowl = 2.0 * curvature * radius * radius * bessel_j(2, alpha) / (s * s);
                2.0 / (radius * radius * j1 * j1) * (rim + bowl)
            };
            Term { alpha, coefficient }
        };
        Self { radius, terms: j0_zeros(count).into_iter().map(term).collect() }
    }

    /// The series at a distance from the bell's centre, up to `radius`.
    pub fn value(&self, distance: f64) -> f64 {
        let turn = distance / self.radius;
        self.terms.iter().map(|term| term.coefficient * bessel_j(0, term.alpha * turn)).sum()
    }

    /// The field of many bells at a point, the series of each one about its own centre.
    pub fn unseparated(&self, spots: &[Spot], at: DVec2) -> f64 {
        spots.iter().map(|spot| spot.weight * self.value(at.distance(spot.center))).sum()
    }
}

/// The field of many bells at a point by definition.
pub fn exact(bell: Paraboloid, spots: &[Spot], at: DVec2) -> f64 {
    spots.iter().map(|spot| spot.weight * bell.value(at.distance(spot.center))).sum()
}

/// The largest error of N = `terms` terms of a bell whose edge is within the disc: 2AL/(π²ρN), at r = ρ.
///
/// An estimate, not a bound: it was within 0.4 % of what was measured for N = 20 to 400.
pub fn truncation(bell: Paraboloid, radius: f64, terms: u32) -> f64 {
    use std::f64::consts::PI;
    2.0 * bell.peak * radius / (PI * PI * bell.edge() * f64::from(terms))
}

/// How many angular orders M Graf's sum needs: z + c max(z, 1)^{1/3} with z = α_N min(|r|, |dr|)/L, for an error of J_0
/// from 1e-2 down to 1e-12.
///
/// c was measured at 1e-2, 1e-3, 1e-6 and 1e-12 for z up to 314; between those it is taken as linear in the logarithm.
pub fn angular_terms(z: f64, error: f64) -> u32 {
    const MEASURED: [(f64, f64); 4] = [(2.0, 1.8), (3.0, 3.0), (6.0, 6.0), (12.0, 10.0)];
    let digits = -error.log10();
    let piece = MEASURED.windows(2).find(|pair| digits <= pair[1].0).unwrap_or(&MEASURED[2..]);
    let slope = (piece[1].1 - piece[0].1) / (piece[1].0 - piece[0].0);
    let c = piece[0].1 + slope * (digits.clamp(2.0, 12.0) - piece[0].0);
    (z + c * z.max(1.0).cbrt()).ceil() as u32
}

/// J_0(|r − dr|) by Graf's theorem (DLMF 10.23.7), Σ_{m=0}^M κ_m J_m(r) J_m(dr) cos mθ, with the lengths of two vectors
/// and the angle between them.
pub fn graf_j0(r: f64, dr: f64, theta: f64, highest: u32, kappa: Kappa) -> f64 {
    let (far, near) = (bessel_j_all(r, highest), bessel_j_all(dr, highest));
    let term = |m: u32| {
        let index = m as usize;
        kappa.weight(m) * far[index] * near[index] * (f64::from(m) * theta).cos()
    };
    (0..=highest).map(term).sum()
}

/// The field of all ghosts with the ghosts taken out:
///
/// ```text
/// G(r, θ) = Σ_k Σ_m J_m(α_k r/L) [U_km cos mθ + V_km sin mθ]      k = 1 ..= N, m = 0 ..= M
/// U_km + iV_km = κ_m a_k Σ_g w_g J_m(α_k d_g/L) exp(imθ_g)
/// ```
///
/// with the ghosts' polar coordinates (d_g, θ_g). A point costs the same for one ghost and for a million.
#[derive(Debug, Clone, PartialEq)]
pub struct Graf {
    radius: f64,
    alphas: Vec<f64>,
    orders: usize,
    /// (U, V) of k and m, m running fastest.
    spectrum: Vec<[f64; 2]>,
}

impl Graf {
    /// The tables of `spots`, for m = 0 ..= `highest`.
    pub fn new(series: &FourierBessel, spots: &[Spot], highest: u32, kappa: Kappa) -> Self {
        let orders = highest as usize + 1;
        let mut spectrum = vec![[0.0; 2]; series.terms.len() * orders];
        for spot in spots {
            let (distance, angle) = polar(spot.center);
            for (term, row) in series.terms.iter().zip(spectrum.chunks_exact_mut(orders)) {
                let bessel = bessel_j_all(term.alpha * distance / series.radius, highest);
                for ((entry, bessel), m) in row.iter_mut().zip(bessel).zip(0..) {
                    let amplitude = kappa.weight(m) * term.coefficient * spot.weight * bessel;
                    let (sin, cos) = (f64::from(m) * angle).sin_cos();
                    entry[0] += amplitude * cos;
                    entry[1] += amplitude * sin;
                }
            }
        }
        let alphas = series.terms.iter().map(|term| term.alpha).collect();
        Self { radius: series.radius, alphas, orders, spectrum }
    }

    /// The field at a point.
    pub fn value(&self, at: DVec2) -> f64 {
        let (distance, angle) = polar(at);
        let turns: Vec<_> = (0..self.orders).map(|m| (m as f64 * angle).sin_cos()).collect();
        let mut sum = 0.0;
        for (alpha, row) in self.alphas.iter().zip(self.spectrum.chunks_exact(self.orders)) {
            let bessel = bessel_j_all(alpha * distance / self.radius, self.orders as u32 - 1);
            let term = |((j, [u, v]), (sin, cos)): ((&f64, &[f64; 2]), &(f64, f64))| j * (u * cos + v * sin);
            sum += bessel.iter().zip(row).zip(&turns).map(term).sum::<f64>();
        }
        sum
    }

    /// (U, V) of every k and m, m running fastest.
    pub fn spectrum(&self) -> &[[f64; 2]] {
        &self.spectrum
    }
}

fn polar(at: DVec2) -> (f64, f64) {
    (at.length(), at.y.atan2(at.x))
}
