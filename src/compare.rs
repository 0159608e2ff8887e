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
    compare_in(exact, actual, [0.0; 3])
}

/// Compares value by value, in units of the largest exact value or of `unit`, whichever is larger: where the exact values
/// are nothing beside what they are made of, the unit says what nothing is.
///
/// # Panics
/// Where there are not as many of one as of the other.
pub fn compare_in(exact: &[[f64; 3]], actual: &[[f64; 3]], unit: [f64; 3]) -> Difference {
    let mut comparison = Comparison::in_units(unit);
    comparison.add(exact, actual);
    comparison.difference()
}

/// A comparison of more values than memory should hold at once.
#[derive(Debug, Clone, Default)]
pub struct Comparison {
    count: usize,
    not_finite: usize,
    /// The largest exact value of each colour.
    largest: [f64; 3],
    /// The largest error of each colour, and at which value.
    worst: [(usize, f64); 3],
    /// The squared errors of each colour, added up.
    squares: [f64; 3],
}

impl Comparison {
    /// A comparison in units of the largest exact value or of `unit`, whichever is larger.
    pub fn in_units(unit: [f64; 3]) -> Self {
        Self { largest: unit, ..Self::default() }
    }

    /// Takes in the next values.
    ///
    /// # Panics
    /// Where there are not as many of one as of the other.
    pub fn add(&mut self, exact: &[[f64; 3]], actual: &[[f64; 3]]) {
        assert_eq!(exact.len(), actual.len(), "as many actual values as exact ones");
        self.not_finite += actual.as_flattened().iter().filter(|value| !value.is_finite()).count();
        for colour in 0..3 {
            let worst = &mut self.worst[colour];
            for (index, (exact, actual)) in exact.iter().zip(actual).enumerate() {
                // NaN is told first: folding with max would lose it.
                let finite = actual[colour].is_finite();
                let error = if finite { (actual[colour] - exact[colour]).abs() } else { f64::INFINITY };
                if error > worst.1 {
                    *worst = (self.count + index, error);
                }
                self.squares[colour] += error * error;
                self.largest[colour] = self.largest[colour].max(exact[colour].abs());
            }
        }
        self.count += exact.len();
    }

    /// How many values were taken in.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The difference of all values so far.
    pub fn difference(&self) -> Difference {
        let mut result =
            Difference { relative: 0.0, rms: 0.0, absolute: 0.0, worst: (0, 0), not_finite: self.not_finite };
        for colour in 0..3 {
            let (index, error) = self.worst[colour];
            let relative = if error == 0.0 { 0.0 } else { error / self.largest[colour] };
            if relative > result.relative {
                result.relative = relative;
                result.worst = (index, colour);
            }
            if error > 0.0 {
                let mean = self.squares[colour] / self.count as f64;
                result.rms = result.rms.max(mean.sqrt() / self.largest[colour]);
            }
            result.absolute = result.absolute.max(error);
        }
        result
    }
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
    fn piece_by_piece_is_the_same_as_at_once() {
        let exact: Vec<[f64; 3]> = (0..90).map(|k| [k as f64, 1.0, f64::from(k).sin()]).collect();
        let mut actual = exact.clone();
        actual[70][2] += 1e-3;
        actual[20][0] -= 0.05;
        for size in [1, 7, 64, 90] {
            let mut comparison = Comparison::default();
            exact.chunks(size).zip(actual.chunks(size)).for_each(|(exact, actual)| comparison.add(exact, actual));
            assert_eq!((comparison.difference(), comparison.count()), (compare(&exact, &actual), 90), "{size}");
        }
        assert_eq!(compare(&exact, &actual).worst, (70, 2));
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

    #[test]
    fn a_unit_counts_where_the_exact_values_are_smaller() {
        let actual = [[0.5, 0.0, 0.0]];
        assert_eq!(compare_in(&[[0.0; 3]], &actual, [2.0; 3]).relative, 0.25);
        assert_eq!(compare_in(&[[5.0, 0.0, 0.0]], &actual, [2.0; 3]).relative, 0.9);
    }
}
