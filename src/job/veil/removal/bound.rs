//! How far an answer may be from the clean photo, by what is left of the veiled one.
//!
//! A = D + K with K ≥ 0, the sums of its rows R, r = y − A x and e = A⁻¹ r:
//!
//! - Where D > R at every sample, ‖e‖∞ ≤ max |r| / (D − R) (Varah 1975, Linear Algebra Appl. 11: 3–5).
//! - Where A is symmetric and its least eigenvalue λ is above 0, ‖e‖₂ ≤ ‖r‖₂ / λ, and row by row D |e| ≤ |r| + ‖K's row‖₂ ‖e‖₂.
//!
//! On a plane without a border, a veil of positive Gaussians is symmetric, and with its own light at each pixel positive: the transform of
//! a Gaussian is, and a picture's edges leave a part of such a matrix. So λ ≥ D − m(0) Ω − Σ |k − m| Ω, m the mixture and the sum over all
//! offsets in the picture: by how much the function is no mixture.

use std::sync::Arc;

use rayon::prelude::*;

use super::offsets::Offsets;
use super::operator::{Norms, Operator};
use super::ranked::Ranked;
use crate::Result;

/// What is known of the operator in one channel.
pub struct Bound {
    /// max R.
    pub row: f64,
    /// min D.
    pub kept: f64,
    /// max R / D: by how much each step of the series is less than the one before, at most.
    pub contraction: f64,
    /// max 1 / (D − R); none where D > R does not hold everywhere.
    pub dominance: Option<f64>,
    /// Where there is one.
    pub spectrum: Option<Spectrum>,
    /// The values of K by their size, where they are known.
    ranked: Option<Arc<Ranked>>,
}

/// What is known of a symmetric operator.
#[derive(Debug, Clone, Copy)]
pub struct Spectrum {
    /// λ, above 0.
    pub least: f64,
    /// The root of the squares of a row of K.
    pub row: f64,
}

impl Bound {
    /// Of each channel: by the offsets between pixels where these say all, else by the veil of a white photo.
    ///
    /// # Errors
    /// Those of the veil's sum.
    pub fn all(operator: &mut Operator) -> Result<[Self; 3]> {
        let offsets = Offsets::all(operator);
        if let [Some(_), ..] = offsets.as_slice() {
            let of =
                |c: usize| offsets[if offsets.len() == 1 { 0 } else { c }].as_ref().expect("all have them or none");
            return Ok([0, 1, 2].map(|channel| {
                let (offsets, symmetric) = (of(channel), operator.is_symmetric());
                let bound = Self::of(operator, channel, &offsets.sums);
                Self { spectrum: spectrum(offsets, &bound, symmetric), ranked: Some(offsets.ranked.clone()), ..bound }
            }));
        }
        let sums = operator.row_sums()?;
        Ok([0, 1, 2].map(|channel| Self::of(operator, channel, &sums[channel])))
    }

    /// Of one channel, by the sums of its rows.
    fn of(operator: &Operator, channel: usize, sums: &[f32]) -> Self {
        let at = |pixel: usize| {
            let (_, kept) = operator.kept(pixel);
            let (kept, row) = (kept[channel], f64::from(sums[pixel]));
            [row, -kept, row / kept, row - kept]
        };
        let most = |a: [f64; 4], b: [f64; 4]| [0, 1, 2, 3].map(|k| f64::max(a[k], b[k]));
        let light = (0..operator.len()).into_par_iter().filter(|&pixel| operator.has(channel, pixel));
        let [row, kept, contraction, rest] = light.map(at).reduce(|| [f64::NEG_INFINITY; 4], most);
        if row == f64::NEG_INFINITY {
            // There is no light at all.
            return Self { row: 0.0, kept: 1.0, contraction: 0.0, dominance: Some(1.0), spectrum: None, ranked: None };
        }
        Self {
            row,
            kept: -kept,
            contraction,
            dominance: (rest < 0.0).then(|| -1.0 / rest),
            spectrum: None,
            ranked: None,
        }
    }

    /// The largest sample that K can make of a field.
    pub fn veil(&self, field: &[f32], largest: f64) -> f64 {
        let by_rows = self.row * largest;
        self.ranked.as_ref().map_or(by_rows, |ranked| ranked.gathers(field, self.row).min(by_rows))
    }

    /// How much all terms of the series are together that follow on one, the veil of which is `next` at most: 1/(1 − q) of the first of them, and
    /// 1/(1 − q²) where the one before has one sign, since theirs alternate then.
    pub fn terms(&self, next: f64, one_sign: bool) -> f64 {
        let q = self.contraction;
        if q < 1.0 { next / self.kept / (1.0 - if one_sign { q * q } else { q }) } else { f64::INFINITY }
    }

    /// How far an answer is off at most, of which `residual` is what is left; infinite where nothing is known.
    pub fn error(&self, residual: Norms) -> f64 {
        let by_rows = self.dominance.map(|times| times * residual.largest);
        let by_spectrum =
            self.spectrum.map(|Spectrum { least, row }| (residual.largest + row * residual.root / least) / self.kept);
        by_rows.into_iter().chain(by_spectrum).fold(f64::INFINITY, f64::min)
    }
}

/// What is known of a channel's eigenvalues where `K` is symmetric: by the mixture, and by the sums of rows (Gershgorin).
fn spectrum(offsets: &Offsets, bound: &Bound, symmetric: bool) -> Option<Spectrum> {
    let by_mixture = offsets.of_mixture.map(|of_mixture| bound.kept - of_mixture);
    let by_rows = bound.dominance.map(|times| 1.0 / times);
    let least = by_mixture.into_iter().chain(by_rows).fold(0.0, f64::max);
    (symmetric && least > 0.0).then(|| Spectrum { least, row: (offsets.largest * bound.row).sqrt() })
}
