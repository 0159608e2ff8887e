//! Least squares in widths and weights: Levenberg's and Marquardt's method.

use super::dense;
use super::exchange::extrema;
use super::samples::{Samples, Sum};

/// How far a step may change a logarithm.
const LONGEST: f64 = 0.5;
/// A step that gains less than this part is the last.
const LEAST_GAIN: f64 = 1e-3;
/// How often a step is damped more before there is none.
const TRIES: usize = 8;

/// `start`, moved until Σ errors² hardly falls, or until the errors alternate often enough for the exchange; in at most
/// `steps` steps.
pub(super) fn least_squares(samples: &Samples, start: Sum, steps: usize, until_alternating: bool) -> Sum {
    let mut sum = start;
    let mut damping = 1e-3;
    let n = 2 * sum.widths.len();
    for _ in 0..steps {
        let rows = normal_equations(samples, &sum);
        let cost = sum.cost();
        let next = (0..TRIES).find_map(|_| {
            let next = damped_step(&rows, 2 * sum.widths.len(), damping)
                .map(|step| sum.moved(samples, &step, LONGEST))
                .filter(|next| next.cost() < cost);
            damping = if next.is_some() { (damping / 5.0_f64).max(1e-12) } else { damping * 4.0 };
            next
        });
        let Some(next) = next else { break };
        sum = next;
        if sum.cost() > cost * (1.0 - LEAST_GAIN) || (until_alternating && extrema(&sum.errors).len() > n) {
            break;
        }
    }
    sum
}

/// Jᵀ J and −Jᵀ e, a row of 2n + 1 for each of the 2n unknowns.
fn normal_equations(samples: &Samples, sum: &Sum) -> Vec<f64> {
    let n = 2 * sum.widths.len();
    let width = n + 1;
    let mut rows = vec![0.0; n * width];
    let mut gradient = vec![0.0; n];
    for (i, error) in sum.errors.iter().enumerate() {
        sum.gradient(samples, i, &mut gradient);
        for (j, &a) in gradient.iter().enumerate() {
            // Far beyond its width a Gaussian says nothing.
            if a < 1e-12 {
                continue;
            }
            let row = &mut rows[j * width..(j + 1) * width];
            // The upper half; the lower is its mirror.
            row[j..n].iter_mut().zip(&gradient[j..]).for_each(|(to, b)| *to += a * b);
            row[n] -= a * error;
        }
    }
    for j in 0..n {
        for k in 0..j {
            rows[j * width + k] = rows[k * width + j];
        }
    }
    rows
}

/// The step that solves the normal equations with their diagonal raised by the part `damping`.
fn damped_step(rows: &[f64], n: usize, damping: f64) -> Option<Vec<f64>> {
    let mut damped = rows.to_vec();
    for j in 0..n {
        // The last bit holds a Gaussian that no sample sees.
        damped[j * (n + 2)] = damped[j * (n + 2)] * (1.0 + damping) + 1e-14;
    }
    dense::solve(damped, n)
}
