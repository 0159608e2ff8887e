//! The two ways to the clean photo: a series, and conjugate gradients.

use rayon::prelude::*;

use super::super::HALF_A_UNIT;
use super::bound::Bound;
use super::operator::{Field, Norms, Operator, Signed, Within};
use crate::Result;

/// Sums of a veil after which an answer is not looked for any longer.
const MOST_VEILS: usize = 400;

/// Where what remains to be done is less than this share of what the sums of the veil are off by, more of them are of no use.
const OF_NO_USE: f64 = 0.02;

/// An answer, and how far it is from the clean photo at most.
pub struct Solution {
    pub clean: Field,
    /// By channels, in the unit of the samples.
    pub bounds: [f64; 3],
    /// The brightest sample of each channel.
    pub peaks: [f64; 3],
    /// Steps that were taken.
    pub steps: usize,
}

impl Solution {
    /// Of an answer that is so far off at most, each step rounded.
    fn of(clean: Field, errors: [f64; 3], steps: usize) -> Self {
        let norms = clean.each_ref().map(|plane| Norms::of(plane).largest);
        let rounding = (steps + 1) as f64 * HALF_A_UNIT;
        let bounds = [0, 1, 2].map(|c| errors[c] + rounding * norms[c]);
        let peaks = clean.each_ref().map(|plane| f64::from(plane.par_iter().copied().reduce(|| 0.0, f32::max)));
        Self { clean, bounds, peaks, steps }
    }

    /// The largest of the bounds, each relative to the brightest that its channel surely is.
    pub fn relative(&self) -> f64 {
        let of = |(&bound, &peak): (&f64, &f64)| match bound {
            0.0 => 0.0,
            bound if peak > bound => bound / (peak - bound),
            _ => f64::INFINITY,
        };
        self.bounds.iter().zip(&self.peaks).map(of).fold(0.0, f64::max)
    }
}

/// By the series x = Σ (−D⁻¹ K)ⁿ D⁻¹ y (Neumann), which falls by the contraction with each term: what K makes of the last one is all that
/// is left. Of light that is nowhere negative each term has one sign, and takes one sum of a veil.
///
/// # Errors
/// Those of the veil's sums.
pub fn series(operator: &mut Operator, veiled: &Field, bounds: &[Bound; 3], asked: f64) -> Result<Solution> {
    let mut term = operator.map(|c, pixel, kept| f64::from(veiled[c][pixel]) / kept);
    let mut clean = term.clone();
    // What the residual is off by: at first as the first term is rounded.
    let mut off = veiled.each_ref().map(|plane| Norms::of(plane).times(HALF_A_UNIT));
    for steps in 1.. {
        let within = if steps == 1 { Within::Tight } else { Within::Loose };
        let Signed { veil, error } = operator.signed_veil(&term, within)?;
        term = operator.map(|c, pixel, kept| -f64::from(veil[c][pixel]) / kept);
        let left = term.each_ref().map(|plane| Norms::of(plane));
        for channel in 0..3 {
            off[channel] = off[channel].plus(error[channel]).plus(Norms::of(&veil[channel]).times(HALF_A_UNIT));
            clean[channel].par_iter_mut().zip(&term[channel]).for_each(|(sum, term)| *sum += term);
        }
        // What K makes of the last term.
        let left = [0, 1, 2]
            .map(|c| Norms { largest: bounds[c].veil(&term[c], left[c].largest), root: bounds[c].row * left[c].root });
        let terms = [0, 1, 2].map(|c| bounds[c].terms(left[c].largest, has_one_sign(&term[c])));
        let errors = [0, 1, 2].map(|c| {
            let by_terms = terms[c] + bounds[c].error(off[c]);
            by_terms.min(bounds[c].error(left[c].plus(off[c])))
        });
        let solution = Solution::of(clean, errors, steps);
        if ends(&solution, asked, &left, &off, operator.veils) {
            return Ok(solution);
        }
        clean = solution.clean;
    }
    unreachable!("it ends by its number of steps")
}

/// By conjugate gradients, where K is its own transpose by the areas of pixels (Hestenes and Stiefel 1952): the residual is carried along, and
/// what its parts are off by with it.
///
/// # Errors
/// Those of the veil's sums.
pub fn gradients(operator: &mut Operator, veiled: &Field, bounds: &[Bound; 3], asked: f64) -> Result<Solution> {
    let mut clean = operator.map(|c, pixel, kept| f64::from(veiled[c][pixel]) / kept);
    let Signed { veil, error: mut off } = operator.signed_veil(&clean, Within::Tight)?;
    let mut residual = operator.map(|c, pixel, kept| {
        f64::from(veiled[c][pixel]) - kept * f64::from(clean[c][pixel]) - f64::from(veil[c][pixel])
    });
    let mut way = residual.clone();
    let mut squares = products(operator, &residual, &residual);
    for steps in 0.. {
        let left = residual.each_ref().map(|plane| Norms::of(plane));
        (0..3).for_each(|c| off[c] = off[c].plus(left[c].times(HALF_A_UNIT)));
        let solution = Solution::of(clean, [0, 1, 2].map(|c| bounds[c].error(left[c].plus(off[c]))), steps);
        if ends(&solution, asked, &left, &off, operator.veils) {
            return Ok(solution);
        }
        clean = solution.clean;
        let Signed { veil, error } = operator.signed_veil(&way, Within::Tight)?;
        let image = operator.map(|c, pixel, kept| kept * f64::from(way[c][pixel]) + f64::from(veil[c][pixel]));
        let along = products(operator, &way, &image);
        let far = [0, 1, 2].map(|c| if along[c] > 0.0 { squares[c] / along[c] } else { 0.0 });
        for c in 0..3 {
            let rounded = Norms::of(&image[c]).times(HALF_A_UNIT);
            off[c] = off[c].plus(error[c].plus(rounded).times(far[c].abs()));
            add(&mut clean[c], far[c], &way[c]);
            add(&mut residual[c], -far[c], &image[c]);
        }
        let after = products(operator, &residual, &residual);
        for c in 0..3 {
            let turn = if squares[c] > 0.0 { after[c] / squares[c] } else { 0.0 };
            let both = way[c].par_iter_mut().zip(&residual[c]);
            both.for_each(|(way, residual)| *way = (f64::from(*residual) + turn * f64::from(*way)) as f32);
        }
        squares = after;
    }
    unreachable!("it ends by its number of steps")
}

/// Whether an answer is as exact as was asked, or will not be.
fn ends(solution: &Solution, asked: f64, left: &[Norms; 3], off: &[Norms; 3], veils: usize) -> bool {
    let useless = left.iter().zip(off).all(|(left, off)| left.largest <= OF_NO_USE * off.largest);
    solution.relative() <= asked || useless || veils >= MOST_VEILS
}

/// Whether nothing of a field is of the other sign than the rest.
fn has_one_sign(field: &[f32]) -> bool {
    let any = |sign: f32| field.par_iter().any(|value| sign * value > 0.0);
    !(any(1.0) && any(-1.0))
}

/// Adds so many times a field.
fn add(sum: &mut [f32], times: f64, field: &[f32]) {
    sum.par_iter_mut().zip(field).for_each(|(sum, value)| *sum = (f64::from(*sum) + times * f64::from(*value)) as f32);
}

/// Σ a b Ω, by channels.
fn products(operator: &Operator, a: &Field, b: &Field) -> [f64; 3] {
    const ROW: usize = 1 << 14;
    let of = |start: usize| {
        let mut sums = [0.0; 3];
        for pixel in start..(start + ROW).min(operator.len()) {
            let (area, _) = operator.kept(pixel);
            (0..3).for_each(|c| sums[c] += area * f64::from(a[c][pixel]) * f64::from(b[c][pixel]));
        }
        sums
    };
    // Part by part in their order, so that a sum is the same every time.
    let parts: Vec<[f64; 3]> = (0..operator.len().div_ceil(ROW)).into_par_iter().map(|part| of(part * ROW)).collect();
    parts.into_iter().fold([0.0; 3], |all, part| [0, 1, 2].map(|c| all[c] + part[c]))
}
