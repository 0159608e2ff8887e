//! A mixture of Gaussians of the chord: what a mixture of Gaussians of the angle is on the sphere.
//!
//! The widths stay, the weights are fitted anew: none negative, by least squares relative to the kernel, with weights of the
//! samples that follow their errors (Lawson 1961), which tends to the least largest error.

/// Samples of the kernel, each further by the same factor.
const SAMPLES: usize = 240;

/// No exponent is above this: a steeper kernel is none that a lattice sees for long.
const MOST_EXPONENT: f64 = 6.0;

/// A sum of Gaussians that is off by more is not the kernel.
const MISSING: f64 = 0.03;

/// Rounds of mending exponents.
const MENDED: usize = 16;

/// Rounds of weighting.
const ROUNDS: usize = 60;

/// Weights for Gaussians exp(−c² / 2 width²), so that they come close to `wanted` from chord `from` to `to`.
pub(super) fn fit(widths: &[f64], wanted: impl Fn(f64) -> f64, from: f64, to: f64) -> Vec<f64> {
    let value = |chord: f64, index: usize| (-0.5 * (chord / widths[index]).powi(2)).exp();
    fit_columns(widths.len(), value, wanted, [from, to], ROUNDS)
}

/// The same for any functions of the chord.
pub(super) fn fit_columns(
    count: usize,
    value: impl Fn(f64, usize) -> f64,
    wanted: impl Fn(f64) -> f64,
    [from, to]: [f64; 2],
    rounds: usize,
) -> Vec<f64> {
    let step = (to / from).max(1.0 + 1e-9).powf(1.0 / (SAMPLES - 1) as f64);
    let chords: Vec<f64> = (0..SAMPLES).map(|index| from * step.powi(index as i32)).collect();
    // Each row is relative to the wanted value there.
    let rows: Vec<Vec<f64>> = chords
        .iter()
        .map(|chord| {
            let wanted = wanted(*chord).max(f64::MIN_POSITIVE);
            (0..count).map(|index| value(*chord, index) / wanted).collect()
        })
        .collect();
    let mut importance = vec![1.0 / SAMPLES as f64; SAMPLES];
    let (mut best, mut least) = (vec![0.0; count], f64::INFINITY);
    for _ in 0..rounds {
        let weights = least_squares(&rows, &importance);
        let error =
            |row: &Vec<f64>| (row.iter().zip(&weights).map(|(value, weight)| value * weight).sum::<f64>() - 1.0).abs();
        let errors: Vec<f64> = rows.iter().map(error).collect();
        let worst = errors.iter().copied().fold(0.0, f64::max);
        importance
            .iter_mut()
            .zip(&errors)
            .for_each(|(importance, error)| *importance *= error / worst.max(1e-300) + 1e-3);
        let all: f64 = importance.iter().sum();
        importance.iter_mut().for_each(|importance| *importance /= all);
        if worst < least {
            (best, least) = (weights, worst);
        }
    }
    best
}

/// By groups of Gaussians, as their values at a chord: the exponent s of the power of the chord that they are part of, so that Σ s · Gaussians is
/// −c dk/dc of the kernel k, or nearly so: the mean exponent where a group is most of the kernel, mended a few times by what the sum
/// lacks (van Cittert), which stays smooth where least squares would not. A group that is not used has its neighbour's.
pub(super) fn exponents(
    groups: impl Fn(f64) -> Vec<f64>,
    used: &[bool],
    wanted: impl Fn(f64) -> f64,
    [from, to]: [f64; 2],
) -> Vec<f64> {
    const APART: f64 = 1.01;
    let step = (to / from).max(1.0 + 1e-9).powf(1.0 / (SAMPLES - 1) as f64);
    let sample = |index: usize| {
        let chord = from * step.powi(index as i32);
        let values = groups(chord);
        let (all, wanted_here) = (values.iter().sum::<f64>(), wanted(chord));
        // What narrower Gaussians would add, which no lattice takes, says nothing of these.
        let whole = wanted_here > 0.0 && (all / wanted_here - 1.0).abs() < MISSING;
        let slope = (wanted(chord / APART) / wanted(chord * APART)).ln() / (2.0 * APART.ln());
        whole.then(|| (values.iter().map(|value| value / all).collect::<Vec<f64>>(), slope.clamp(0.0, MOST_EXPONENT)))
    };
    let samples: Vec<(Vec<f64>, f64)> = (0..SAMPLES).filter_map(sample).collect();
    let mut exponents = vec![0.0; used.len()];
    for _ in 0..MENDED {
        let lacks: Vec<f64> = samples
            .iter()
            .map(|(shares, slope)| slope - shares.iter().zip(&exponents).map(|(share, of)| share * of).sum::<f64>())
            .collect();
        for (group, exponent) in exponents.iter_mut().enumerate() {
            let each = || samples.iter().map(|(shares, _)| shares[group].powi(2));
            let all: f64 = each().sum();
            if all > 0.0 {
                *exponent += each().zip(&lacks).map(|(share, lack)| share * lack).sum::<f64>() / all;
            }
        }
    }
    let known: Vec<usize> = (0..used.len()).filter(|group| used[*group]).collect();
    let own = |group: usize| {
        known.iter().find(|known| **known >= group).or(known.last()).map_or(0.0, |known| exponents[*known])
    };
    (0..used.len()).map(own).collect()
}

/// The largest error of a sum of Gaussians, as widths and weights, relative to `wanted`, between two chords.
pub(super) fn error(terms: &[(f64, f64)], wanted: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let step = (to / from).max(1.0).powf(1.0 / (2 * SAMPLES) as f64);
    let at = |index: usize| {
        let chord = from * step.powi(index as i32);
        let sum: f64 = terms.iter().map(|(width, weight)| weight * (-0.5 * (chord / width).powi(2)).exp()).sum();
        (sum / wanted(chord) - 1.0).abs()
    };
    (0..=2 * SAMPLES).map(at).fold(0.0, f64::max)
}

/// The w ≥ 0 of the least Σ importance (row · w − 1)²: by active sets (Lawson and Hanson 1974).
fn least_squares(rows: &[Vec<f64>], importance: &[f64]) -> Vec<f64> {
    let count = rows.first().map_or(0, Vec::len);
    // Columns of unit length, as widths differ by orders of magnitude.
    let weighted = || rows.iter().zip(importance);
    let length =
        |column: usize| weighted().map(|(row, importance)| importance * row[column] * row[column]).sum::<f64>().sqrt();
    let lengths: Vec<f64> = (0..count).map(|column| length(column).max(1e-300)).collect();
    let product = |one: usize, other: usize| {
        weighted().map(|(row, importance)| importance * row[one] * row[other]).sum::<f64>()
            / (lengths[one] * lengths[other])
    };
    let gram: Vec<Vec<f64>> = (0..count).map(|one| (0..count).map(|other| product(one, other)).collect()).collect();
    let right: Vec<f64> = (0..count)
        .map(|column| weighted().map(|(row, importance)| importance * row[column]).sum::<f64>() / lengths[column])
        .collect();
    let (mut active, mut solution) = (Vec::<usize>::new(), vec![0.0; count]);
    for _ in 0..3 * count {
        let slope =
            |column: usize| right[column] - (0..count).map(|other| gram[column][other] * solution[other]).sum::<f64>();
        let next = (0..count)
            .filter(|column| !active.contains(column))
            .max_by(|one, other| slope(*one).total_cmp(&slope(*other)));
        let Some(next) = next.filter(|next| slope(*next) > 1e-13) else { break };
        active.push(next);
        // Each round but the last takes one out; where rounding would let it go on, it ends.
        for _ in 0..=count {
            let Some(trial) = solve(&gram, &right, &active) else { break };
            let share = active
                .iter()
                .zip(&trial)
                .filter(|(_, trial)| **trial <= 0.0)
                .map(|(column, trial)| solution[*column] / (solution[*column] - trial));
            let share = share.fold(1.0, f64::min);
            for (column, trial) in active.iter().zip(&trial) {
                solution[*column] += share * (trial - solution[*column]);
            }
            if share >= 1.0 {
                break;
            }
            active.retain(|column| solution[*column] > 1e-15);
            (0..count).filter(|column| !active.contains(column)).for_each(|column| solution[column] = 0.0);
        }
    }
    solution.iter().zip(lengths).map(|(value, length)| value / length).collect()
}

/// The solution of the equations of some columns, by Cholesky's factors with a hair on the diagonal.
fn solve(gram: &[Vec<f64>], right: &[f64], active: &[usize]) -> Option<Vec<f64>> {
    let count = active.len();
    let mut factor = vec![vec![0.0; count]; count];
    for row in 0..count {
        for column in 0..=row {
            let known: f64 = (0..column).map(|index| factor[row][index] * factor[column][index]).sum();
            let rest = gram[active[row]][active[column]] - known;
            factor[row][column] =
                if row == column { (rest + 1e-14).max(1e-16).sqrt() } else { rest / factor[column][column] };
        }
    }
    let mut solution: Vec<f64> = Vec::with_capacity(count);
    for row in 0..count {
        let known: f64 = (0..row).map(|index| factor[row][index] * solution[index]).sum();
        solution.push((right[active[row]] - known) / factor[row][row]);
    }
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|index| factor[index][row] * solution[index]).sum();
        solution[row] = (solution[row] - known) / factor[row][row];
    }
    (count > 0).then_some(solution)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An inverse square from 1 to 30 degrees by eight Gaussians of the chord.
    #[test]
    fn a_power_is_fitted_to_a_thousandth() {
        let widths: Vec<f64> =
            [0.435668f64, 0.723819, 1.19194, 1.95935, 3.22229, 5.35936, 9.51913, 23.172].map(f64::to_radians).into();
        let wanted = |chord: f64| (2.0 * (0.5 * chord).asin()).powi(-2);
        let weights = fit(&widths, wanted, 1f64.to_radians(), 30f64.to_radians());
        for index in 0..1000 {
            let chord = 1f64.to_radians() * 30f64.powf(index as f64 / 1000.0) * 0.999;
            let sum: f64 = widths
                .iter()
                .zip(&weights)
                .map(|(width, weight)| weight * (-0.5 * (chord / width).powi(2)).exp())
                .sum();
            assert!((sum / wanted(chord) - 1.0).abs() < 2e-3, "{chord}: {:e}", sum / wanted(chord) - 1.0);
        }
    }
}
