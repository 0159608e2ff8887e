//! The one error metric: the largest error, relative to the largest exact value, the worst of the three colours.

/// How far values are from the exact ones.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Difference {
    /// max |actual − exact| / max |exact|, the worst colour. 0 where both are nothing; infinite where something stands
    /// against an exact nothing, or where a value is not finite.
    pub relative: f64,
    /// The root of the mean of (actual − exact)², over max |exact|, the worst colour.
    pub rms: f64,
    /// max |actual − exact| over all colours.
    pub absolute: f64,
    /// Where the worst colour's largest error is: which value, and which colour.
    pub worst: (usize, usize),
    /// How many actual values are NaN or infinite.
    pub not_finite: usize,
}

/// Compares value by value.
///
/// # Panics
/// Where there are not as many of one as of the other.
pub fn compare(exact: &[[f64; 3]], actual: &[[f64; 3]]) -> Difference {
    assert_eq!(exact.len(), actual.len(), "as many actual values as exact ones");
    let not_finite = actual.as_flattened().iter().filter(|value| !value.is_finite()).count();
    let mut result = Difference { relative: 0.0, rms: 0.0, absolute: 0.0, worst: (0, 0), not_finite };
    for colour in 0..3 {
        // NaN is told first: folding with max would lose it.
        let errors = exact.iter().zip(actual).map(|(exact, actual)| {
            if actual[colour].is_finite() { (actual[colour] - exact[colour]).abs() } else { f64::INFINITY }
        });
        let squares: f64 = errors.clone().map(|error| error * error).sum();
        let (index, error) =
            errors.enumerate().fold((0, 0.0), |worst, next| if next.1 > worst.1 { next } else { worst });
        let largest = exact.iter().map(|value| value[colour].abs()).fold(0.0, f64::max);
        let relative = if error == 0.0 { 0.0 } else { error / largest };
        if relative > result.relative {
            result.relative = relative;
            result.worst = (index, colour);
        }
        if error > 0.0 {
            result.rms = result.rms.max((squares / exact.len() as f64).sqrt() / largest);
        }
        result.absolute = result.absolute.max(error);
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_colour_counts_relative_to_its_own_largest_value() {
        let exact = [[10.0, 1.0, 0.0], [20.0, 0.5, 0.0]];
        let actual = [[10.1, 1.0, 0.0], [20.0, 0.48, 0.0]];
        let difference = compare(&exact, &actual);
        assert!((difference.relative - 0.02).abs() < 1e-12, "{difference:?}");
        assert!((difference.absolute - 0.1).abs() < 1e-12, "{difference:?}");
        assert_eq!(difference.worst, (1, 1));
        assert!((difference.rms - 0.02 / 2f64.sqrt()).abs() < 1e-12, "{difference:?}");
    }

    #[test]
    fn nan_and_infinity_are_never_lost() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for at in 0..3 {
                let mut actual = [[1.0; 3]; 3];
                actual[at][1] = bad;
                let difference = compare(&[[1.0; 3]; 3], &actual);
                assert_eq!((difference.relative, difference.not_finite), (f64::INFINITY, 1));
            }
        }
    }

    #[test]
    fn nothing_against_nothing_is_exact_and_something_is_not() {
        assert_eq!(compare(&[[0.0; 3]], &[[0.0; 3]]).relative, 0.0);
        assert_eq!(compare(&[[0.0; 3]], &[[0.0, 1e-30, 0.0]]).relative, f64::INFINITY);
        assert_eq!(compare(&[], &[]).relative, 0.0);
    }
}
