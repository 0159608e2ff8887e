//! Comparisons that say what was worst, and canaries that show that they can fail.

use vglare::compare::{Difference, compare};

/// The difference, asserted to be within `limit` of the largest exact value.
///
/// # Panics
/// With the worst pixel, its colour, what was expected and what came.
#[track_caller]
pub fn within(limit: f64, what: &str, pixels: &[[i32; 2]], exact: &[[f64; 3]], actual: &[[f64; 3]]) -> Difference {
    let difference = compare(exact, actual);
    assert!(
        // NaN fails this, too.
        difference.relative <= limit && difference.not_finite == 0,
        "{what}: {:.3e} of the largest value, {limit:.3e} allowed; {}",
        difference.relative,
        describe(&difference, pixels, exact, actual),
    );
    difference
}

fn describe(difference: &Difference, pixels: &[[i32; 2]], exact: &[[f64; 3]], actual: &[[f64; 3]]) -> String {
    let (index, colour) = difference.worst;
    let (Some(exact), Some(actual)) = (exact.get(index), actual.get(index)) else { return "nothing to see".into() };
    format!(
        "worst at pixel {:?}, {}: expected {:e}, got {:e}; {} values are not finite",
        pixels.get(index),
        ["red", "green", "blue"][colour],
        exact[colour],
        actual[colour],
        difference.not_finite
    )
}

/// The worst of many, for the line that a passing test prints.
#[derive(Debug, Clone, Default)]
pub struct Worst {
    pub value: f64,
    pub at: String,
}

impl Worst {
    pub fn take(&mut self, value: f64, at: impl FnOnce() -> String) {
        if value.is_nan() || value > self.value {
            *self = Self { value, at: at() };
        }
    }
}

impl std::fmt::Display for Worst {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.2e} ({})", self.value, self.at)
    }
}

mod canaries {
    use super::*;

    const EXACT: [[f64; 3]; 2] = [[4.0, 1.0, 2.0], [1.0, 0.5, 1.0]];

    #[test]
    fn an_error_at_the_limit_passes() {
        let actual = [[4.0, 1.0, 2.0], [1.0, 0.5 + 1.0 / 64.0, 1.0]];
        assert_eq!(within(1.0 / 64.0, "canary", &[], &EXACT, &actual).worst, (1, 1));
    }

    #[test]
    #[should_panic(expected = "worst at pixel Some([5, 6]), green: expected 5e-1, got 5.15")]
    fn an_error_just_beyond_the_limit_fails_and_is_named() {
        let actual = [[4.0, 1.0, 2.0], [1.0, 0.5 + 1.0001 / 64.0, 1.0]];
        within(1.0 / 64.0, "canary", &[[3, 4], [5, 6]], &EXACT, &actual);
    }

    #[test]
    #[should_panic(expected = "1 values are not finite")]
    fn a_nan_fails() {
        within(1.0, "canary", &[], &EXACT, &[[4.0, 1.0, 2.0], [1.0, f64::NAN, 1.0]]);
    }

    #[test]
    fn the_worst_of_many_never_loses_a_nan() {
        let mut worst = Worst::default();
        for value in [1.0, f64::NAN] {
            worst.take(value, String::new);
        }
        assert!(worst.value.is_nan());
    }
}
