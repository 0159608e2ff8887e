//! The least largest error: Remez's exchange, in widths and weights together.
//!
//! The best of all sums of n Gaussians has 2n + 1 errors of one size and alternating signs, if the profile is
//! completely monotone in θ² (Braess, *Nonlinear approximation theory*, 1986, ch. VI: exponential sums). Newton's
//! method on these equations at the extrema of the present error converges from the sum of least squares within a few
//! steps.

use super::dense;
use super::samples::{Samples, Sum, largest};

/// How far a step may change a logarithm, at first.
const LONGEST: f64 = 0.5;
/// How often a step is shortened before there is none.
const TRIES: usize = 5;
/// A step that lowers the largest error by less than this part is the last.
const LEAST_GAIN: f64 = 3e-3;

/// `start`, levelled in at most `steps` steps: its largest error is never above the start's.
pub(super) fn levelled(samples: &Samples, start: Sum, steps: usize) -> Sum {
    let mut sum = start;
    for _ in 0..steps {
        let before = sum.largest();
        let Some(step) = newton_step(samples, &sum) else { break };
        let mut most = LONGEST.min(largest(&step));
        let lower = (0..TRIES).find_map(|_| {
            let next = Some(sum.moved(samples, &step, most)).filter(|next| next.largest() < before);
            most *= 0.3;
            next
        });
        let Some(lower) = lower else { break };
        sum = lower;
        if sum.largest() > before * (1.0 - LEAST_GAIN) {
            break;
        }
    }
    sum
}

/// Whether the errors at the extrema alternate in one size, as those of the best sum do, within a few parts in a
/// hundred.
pub(super) fn is_level(sum: &Sum) -> bool {
    let points = extrema(&sum.errors);
    let least = points.iter().map(|&i| sum.errors[i].abs()).fold(f64::INFINITY, f64::min);
    points.len() > 2 * sum.widths.len() && least > 0.95 * sum.largest()
}

/// The step towards errors of one size at the extrema. None where there are too few of these.
fn newton_step(samples: &Samples, sum: &Sum) -> Option<Vec<f64>> {
    let n = 2 * sum.widths.len();
    let mut points = extrema(&sum.errors);
    if points.len() <= n {
        return None;
    }
    while points.len() > n + 1 {
        let size = |i: usize| sum.errors[points[i]].abs();
        let end = if size(0) < size(points.len() - 1) { 0 } else { points.len() - 1 };
        points.remove(end);
    }
    // Unknown are the n changes, and the size that all errors shall have.
    let mut rows = vec![0.0; (n + 1) * (n + 2)];
    for (row, &i) in rows.chunks_exact_mut(n + 2).zip(&points) {
        sum.gradient(samples, i, &mut row[..n]);
        row[n] = -sum.errors[i].signum();
        row[n + 1] = -sum.errors[i];
    }
    let mut step = dense::solve(rows, n + 1)?;
    step.truncate(n);
    Some(step)
}

/// Where each run of errors of one sign has its largest.
pub(super) fn extrema(errors: &[f64]) -> Vec<usize> {
    let runs = errors.chunk_by(|a, b| (*a > 0.0) == (*b > 0.0));
    let mut begin = 0;
    runs.filter_map(|run| {
        let from = begin;
        begin += run.len();
        (from..begin).max_by(|&i, &j| errors[i].abs().total_cmp(&errors[j].abs()))
    })
    .collect()
}
