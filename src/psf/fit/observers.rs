//! One set of widths for all ages.
//!
//! At one pigment every age's function is the youngest's and the oldest's, mixed: \[CIE146\] is linear in (A/62.5)⁴,
//! \[CIE135\] times its normaliser and Stiles and Holladay's in (A/70)⁴. So two sets of weights, of the same widths, give
//! all others, and no error is above the larger one of the two. The widths are the best ones of an age between. Pigment
//! has widths of its own: it decides how the far end falls, and one set for all pigments would take two Gaussians more.

use super::super::eye::AGES;
use super::samples::Profile;
use super::{Fitted, linear, search};

/// The ages whose best widths are tried, in years. With those of the first the youngest's and the oldest's errors are
/// the same, within a tenth, where the core does not matter, which fades with age; where it does, with those of the
/// second.
const REFERENCES: [f64; 2] = [50.0, 90.0];
/// The reference's error over that of the ends.
const ENDS: f64 = 0.85;
/// How many Gaussians more the ends may need.
const MORE: usize = 12;
/// Rounds of Lawson's iteration: more gain less than 1 % of the error.
const ROUNDS: usize = 50;

/// The Gaussians of all ages at one pigment.
#[derive(Debug, Clone, PartialEq)]
pub(in super::super) struct AllAges {
    /// Standard deviations, and the heights at the first and the last of [`AGES`].
    gaussians: Vec<[f64; 3]>,
    /// The largest relative error of any age.
    pub error: f64,
}

impl AllAges {
    /// The fewest widths that meet `tolerance` over `range` at every age; `profile` is a function of an age and an
    /// angle.
    pub fn new<P: Profile>(profile: impl Fn(f64) -> P, range: [f64; 2], tolerance: f64) -> Self {
        let [reference, older] = REFERENCES.map(&profile);
        let ends = AGES.map(&profile);
        let shape = search::Shape::new(&reference, range, tolerance);
        // The reference alone leads to about the right count; what the ends do not meet gets some more.
        let mut fit =
            search::fewest(&shape, ENDS * tolerance, |count, last| super::free(&reference, &shape, count, last));
        let mut best = Self { gaussians: Vec::new(), error: f64::INFINITY };
        let mut keep = |fit: &Fitted| {
            let ages = Self::reweighted(&ends, &shape, fit);
            if ages.error < best.error {
                best = ages;
            }
            best.error <= tolerance
        };
        for count in fit.gaussians.len()..=super::MOST_TERMS.min(fit.gaussians.len() + MORE) {
            if keep(&fit) || keep(&super::free(&older, &shape, count, Some(&fit))) {
                break;
            }
            fit = super::free(&reference, &shape, count + 1, Some(&fit));
        }
        best
    }

    /// The widths of `fit`, with weights for both ends.
    fn reweighted<P: Profile>(ends: &[P; 2], shape: &search::Shape, fit: &Fitted) -> Self {
        let count = fit.gaussians.len();
        let widths: Vec<f64> = fit.gaussians.iter().map(|[sigma, _]| sigma.ln()).collect();
        let start: Vec<f64> = fit.gaussians.iter().map(|[_, height]| height.ln()).collect();
        let [young, old] = [0, 1].map(|end| {
            let samples = shape.samples(&ends[end], count);
            let basis = samples.shares(&widths, &start);
            let factors = linear::least_largest(&basis, count, &samples.wanted, ROUNDS).map(|(factors, _)| factors);
            let heights = start
                .iter()
                .zip(factors.unwrap_or_else(|| vec![1.0; count]))
                .map(|(start, factor)| start.exp() * factor);
            let gaussians: Vec<[f64; 2]> =
                widths.iter().map(|width| width.exp()).zip(heights).map(|(sigma, height)| [sigma, height]).collect();
            let error = super::measured(&ends[end], shape.range, &gaussians);
            Fitted { gaussians, error }
        });
        let error = young.error.max(old.error);
        let both = young.gaussians.iter().zip(&old.gaussians);
        Self { gaussians: both.map(|([sigma, young], [_, old])| [*sigma, *young, *old]).collect(), error }
    }

    /// Widths and heights at the part `part` of the way from the youngest's function to the oldest's.
    pub fn mixed(&self, part: f64) -> Vec<[f64; 2]> {
        self.gaussians.iter().map(|[sigma, young, old]| [*sigma, young * (1.0 - part) + old * part]).collect()
    }
}
