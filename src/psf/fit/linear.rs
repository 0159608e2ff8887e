//! The least largest error in the weights alone: Lawson's iteration.
//!
//! Least squares whose importances are multiplied by the errors again and again converge to the smallest largest error
//! (Lawson 1961). It needs no count of extrema, and takes any basis.

use super::dense;
use super::samples::largest;

/// A round that gains less than this part is idle, and so many of them in a row are the last.
const LEAST_GAIN: f64 = 2e-3;
const MOST_IDLE: usize = 3;

/// Factors of the columns of `basis` (a row of `columns` for each number that is wanted) such that their sums are off
/// from `wanted` by as little as can be, and by how much; the best of `rounds`. None where the columns are not
/// independent.
pub(in super::super) fn least_largest(
    basis: &[f64],
    columns: usize,
    wanted: &[f64],
    rounds: usize,
) -> Option<(Vec<f64>, f64)> {
    let mut importance = vec![1.0; wanted.len()];
    let mut best: Option<(Vec<f64>, f64)> = None;
    let mut idle = 0;
    for _ in 0..rounds {
        let Some(factors) = weighted_squares(basis, columns, wanted, &importance) else { break };
        let errors: Vec<f64> = basis
            .chunks_exact(columns)
            .zip(wanted)
            .map(|(row, wanted)| row.iter().zip(&factors).map(|(a, b)| a * b).sum::<f64>() - wanted)
            .collect();
        let off = largest(&errors);
        let least = best.as_ref().map_or(f64::INFINITY, |(_, least)| *least);
        idle = if off < least * (1.0 - LEAST_GAIN) { 0 } else { idle + 1 };
        if off < least {
            best = Some((factors, off));
        }
        let mean = importance.iter().zip(&errors).map(|(weight, error)| weight * error.abs()).sum::<f64>()
            / wanted.len() as f64;
        if !(mean.is_normal() && off.is_finite()) || idle > MOST_IDLE {
            break;
        }
        // Not quite 0, from where none would come back.
        importance
            .iter_mut()
            .zip(&errors)
            .for_each(|(weight, error)| *weight = (*weight * error.abs() / mean).max(1e-9));
    }
    best
}

/// The factors of least Σ importance · error².
fn weighted_squares(basis: &[f64], columns: usize, wanted: &[f64], importance: &[f64]) -> Option<Vec<f64>> {
    let width = columns + 1;
    let mut rows = vec![0.0; columns * width];
    for ((row, wanted), importance) in basis.chunks_exact(columns).zip(wanted).zip(importance) {
        for (j, &a) in row.iter().enumerate() {
            if a.abs() < 1e-14 {
                continue;
            }
            let a = a * importance;
            let to = &mut rows[j * width..(j + 1) * width];
            to[j..columns].iter_mut().zip(&row[j..]).for_each(|(to, b)| *to += a * b);
            to[columns] += a * wanted;
        }
    }
    for j in 0..columns {
        for k in 0..j {
            rows[j * width + k] = rows[k * width + j];
        }
    }
    dense::solve(rows, columns)
}
