//! The Bessel function J_n of integer order n ≥ 0.

use serde::{Deserialize, Serialize};

/// J_n(x) for any real x, by libm: within 3e-16 of the truth for n ≤ 2000 and x ≤ 1e5, and relatively within 2e-14 where
/// n > |x| makes it small. The time grows with the larger of n and |x|.
pub fn bessel_j(n: u32, x: f64) -> f64 {
    libm::jn(i32::try_from(n).unwrap_or(i32::MAX), x)
}

/// J_0(x) to J_`highest`(x) in one go, for finite x; as exact as [`bessel_j`] up to the rounding that the recurrence
/// gathers, below 1e-15 for orders up to 2000 and |x| up to 1e5. What is below f64 becomes 0.
///
/// J_{n−1}(x) + J_{n+1}(x) = 2n/x J_n(x) (DLMF 10.6.1) upwards from libm's J_0 and J_1 while n ≤ |x|. Beyond, J_n
/// decays, and upwards the recurrence would drown it in Y_n; so there it runs downwards (Miller), in ratios
/// J_n/J_{n−1} (Gautschi 1967), which neither overflow nor have to be normalised.
///
/// libm has no such function, and asking it for each order would cost as many recurrences; of the crates,
/// `complex-bessel` has one that is off by 1e-13 at x = 1e5.
pub fn bessel_j_all(x: f64, highest: u32) -> Vec<f64> {
    let size = x.abs();
    let last = highest as usize;
    let mut values = vec![0.0; last + 1];
    values[0] = libm::j0(size);
    // The last order that is reached upwards.
    let turn = if size >= 1.0 { (size as usize).min(last) } else { 0 };
    if turn > 0 {
        values[1] = libm::j1(size);
    }
    for n in 1..turn {
        values[n + 1] = 2.0 * n as f64 / size * values[n] - values[n - 1];
    }
    if last > turn {
        continue_beyond(size, turn, &mut values);
    }
    if x < 0.0 {
        values.iter_mut().skip(1).step_by(2).for_each(|value| *value = -*value);
    }
    values
}

/// Fills `values` after `turn` ≥ ⌊x⌋ by the ratios of neighbours.
fn continue_beyond(x: f64, turn: usize, values: &mut [f64]) {
    let last = values.len() - 1;
    // A ratio forgets where the recurrence began by the square of all ratios between. From n = x on, J_n falls by
    // 3e-9 within 7.5 x^(1/3) orders, as the Airy function does.
    let begin = last + 16 + (10.0 * (last as f64).max(x).cbrt()) as usize;
    let mut ratio = 0.0;
    for n in (turn + 1..=begin).rev() {
        ratio = x / (2.0 * n as f64 - x * ratio);
        if n <= last {
            values[n] = ratio;
        }
    }
    for n in turn + 1..=last {
        values[n] *= values[n - 1];
    }
}

/// Which factorial stands in the power series of J_n.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Factorial {
    /// (k + n)!, as it must be.
    #[default]
    Right,
    /// (k + n + 1)!, as the notes print it; the sum is then 2/x J_{n+1}(x).
    Printed,
}

/// Σ_k (−1)^k (x/2)^{2k+n} / (k! (k+n)!) (DLMF 10.2.2), or the same with the notes' factorial.
///
/// Meant for the comparison with the notes, |x| ≤ 20 or so: the terms cancel, and the error grows as e^|x| 1e-17.
pub fn bessel_j_series(n: u32, x: f64, factorial: Factorial) -> f64 {
    let half = 0.5 * x;
    let shift = n + u32::from(factorial == Factorial::Printed);
    let mut term = (1..=n).fold(1.0, |term, j| term * half / f64::from(j));
    if factorial == Factorial::Printed {
        term /= f64::from(shift);
    }
    let mut sum = term;
    let mut k = 0.0;
    while term.abs() > 1e-18 * sum.abs() || k < half.abs() {
        k += 1.0;
        term *= -half * half / (k * (k + f64::from(shift)));
        sum += term;
        if term == 0.0 {
            break;
        }
    }
    sum
}
