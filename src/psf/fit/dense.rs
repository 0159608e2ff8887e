//! Small dense systems of linear equations.

/// Solves the `n` × `n` system whose rows, of `n` coefficients and the right-hand side each, are `rows`, by elimination
/// with partial pivoting. None where it is singular to working precision, or not finite.
pub(super) fn solve(mut rows: Vec<f64>, n: usize) -> Option<Vec<f64>> {
    let width = n + 1;
    debug_assert_eq!(rows.len(), n * width);
    for column in 0..n {
        let size = |i: usize| rows[i * width + column].abs();
        let pivot = (column..n).max_by(|&i, &j| size(i).total_cmp(&size(j)))?;
        for k in column..width {
            rows.swap(pivot * width + k, column * width + k);
        }
        let (above, below) = rows.split_at_mut((column + 1) * width);
        let lead = &above[column * width..];
        if !lead[column].is_finite() || lead[column] == 0.0 {
            return None;
        }
        for row in below.chunks_exact_mut(width) {
            let factor = row[column] / lead[column];
            for k in column..width {
                row[k] -= factor * lead[k];
            }
        }
    }
    let mut x = vec![0.0; n];
    for i in (0..n).rev() {
        let row = &rows[i * width..(i + 1) * width];
        let known: f64 = (i + 1..n).map(|k| row[k] * x[k]).sum();
        x[i] = (row[n] - known) / row[i];
    }
    x.iter().all(|x| x.is_finite()).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_is_solved_and_a_singular_one_is_not() {
        // Its first pivot is 0.
        let rows = vec![0.0, 2.0, 1.0, 7.0, 1.0, 1.0, 1.0, 6.0, 4.0, -1.0, 2.0, 8.0];
        let x = solve(rows, 3).unwrap();
        for (x, known) in x.iter().zip([1.0, 2.0, 3.0]) {
            assert!((x - known).abs() < 1e-14, "{x} for {known}");
        }
        assert!(solve(vec![1.0, 2.0, 3.0, 2.0, 4.0, 6.0], 2).is_none());
        assert!(solve(vec![f64::NAN, 1.0], 1).is_none());
    }
}
