//! The small kernel, which makes near offsets exact.

/// What is added at offsets within a disc: eight offsets that are each other's mirror images share a value.
#[derive(Debug, Clone, Default)]
pub(crate) struct Near {
    /// For each distance of rows, from 0 on: the values at distances of columns from 0 on.
    pub rows: Vec<Vec<f64>>,
}

impl Near {
    /// The disc of the offsets whose squares sum to at most `square`, within `most` columns and rows; none if that is 0.
    pub fn new(square: usize, most: [usize; 2], value: impl Fn(usize, usize) -> f64) -> Self {
        if square == 0 {
            return Self::default();
        }
        let rows = (0..=square.isqrt().min(most[1])).map(|y| {
            let reach = (square - y * y).isqrt().min(most[0]);
            (0..=reach).map(|x| value(x, y)).collect()
        });
        Self { rows: rows.collect() }
    }

    /// Multiply-adds and additions for each pixel.
    pub fn operations(square: usize) -> f64 {
        if square == 0 {
            return 0.0;
        }
        let rows = (0..=square.isqrt()).map(|y| 2 * (square - y * y).isqrt() + 2);
        rows.sum::<usize>() as f64
    }
}
