//! Values at times, and what lies between: monotone cubics.
//!
//! \[FC\] F. N. Fritsch, R. E. Carlson: Monotone piecewise cubic interpolation, 1980.
//! \[FB\] F. N. Fritsch, J. Butland: A method for constructing local monotone piecewise cubic interpolants, 1984.

/// Values at times that rise, N of them at each.
///
/// Between two times each value is a cubic that stays between theirs, by slopes that keep \[FC\]'s condition, so that nothing
/// overshoots and what stands still stands still to the bit. Two rows are joined by a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Track<const N: usize> {
    times: Vec<f64>,
    values: Vec<[f64; N]>,
    slopes: Vec<[f64; N]>,
}

impl<const N: usize> Track<N> {
    /// Of rows whose times rise.
    ///
    /// # Panics
    /// Without rows.
    pub fn new(rows: &[(f64, [f64; N])]) -> Self {
        assert!(!rows.is_empty(), "a track has a row");
        let times: Vec<f64> = rows.iter().map(|row| row.0).collect();
        let values: Vec<[f64; N]> = rows.iter().map(|row| row.1).collect();
        let mut slopes = vec![[0.0; N]; rows.len()];
        for k in 0..N {
            let column: Vec<f64> = values.iter().map(|row| row[k]).collect();
            slopes.iter_mut().zip(slopes_of(&times, &column)).for_each(|(row, slope)| row[k] = slope);
        }
        Self { times, values, slopes }
    }

    /// When it begins.
    pub fn first(&self) -> f64 {
        self.times[0]
    }

    /// When it ends.
    pub fn last(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// The values at a time; none before its first row and after its last, with what rounding makes of these forgiven.
    pub fn at(&self, time: f64) -> Option<[f64; N]> {
        let (first, last) = (self.first(), self.last());
        let slack = 1e-9 * (last - first).max(f64::EPSILON * first.abs().max(last.abs()));
        if !(first - slack..=last + slack).contains(&time) {
            return None;
        }
        let next = self.times.partition_point(|&row| row <= time);
        if next == 0 {
            return Some(self.values[0]);
        }
        if next == self.times.len() {
            return Some(self.values[next - 1]);
        }
        let row = |k: usize| (self.times[k], &self.values[k], &self.slopes[k]);
        let ((t0, v0, m0), (t1, v1, m1)) = (row(next - 1), row(next));
        Some(std::array::from_fn(|k| hermite([t0, v0[k], m0[k]], [t1, v1[k], m1[k]], time)))
    }
}

/// The cubic between two rows of time, value and slope. Written as a change from the first, so that where neither value
/// nor slope changes it is that value to the bit.
fn hermite([t0, v0, m0]: [f64; 3], [t1, v1, m1]: [f64; 3], time: f64) -> f64 {
    let h = t1 - t0;
    let u = (time - t0) / h;
    let w = 1.0 - u;
    v0 + (v1 - v0) * (u * u * (3.0 - 2.0 * u)) + h * (u * w * (w * m0 - u * m1))
}

/// Slopes at all times: within, the harmonic mean of the secants on both sides, weighted by how long these are \[FB\], or 0 at
/// a turn; at the ends that of the parabola through three, held to \[FC\]'s condition.
fn slopes_of(times: &[f64], values: &[f64]) -> Vec<f64> {
    let secants: Vec<[f64; 2]> = (1..times.len())
        .map(|k| {
            let h = times[k] - times[k - 1];
            [h, (values[k] - values[k - 1]) / h]
        })
        .collect();
    match secants[..] {
        [] => vec![0.0],
        [[_, secant]] => vec![secant; 2],
        _ => {
            let n = secants.len();
            let mut slopes = vec![end(secants[0], secants[1])];
            slopes.extend(secants.windows(2).map(|pair| within(pair[0], pair[1])));
            slopes.push(end(secants[n - 1], secants[n - 2]));
            slopes
        }
    }
}

fn within([h0, before]: [f64; 2], [h1, after]: [f64; 2]) -> f64 {
    // By signs: a product of small numbers may be 0.
    if before == 0.0 || after == 0.0 || (before > 0.0) != (after > 0.0) {
        return 0.0;
    }
    let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
    (w0 + w1) / (w0 / before + w1 / after)
}

fn end([h0, secant]: [f64; 2], [h1, next]: [f64; 2]) -> f64 {
    let slope = ((2.0 * h0 + h1) * secant - h0 * next) / (h0 + h1);
    if secant == 0.0 || (slope > 0.0) != (secant > 0.0) {
        return 0.0;
    }
    let turns = (secant > 0.0) != (next > 0.0);
    if turns && slope.abs() > 3.0 * secant.abs() { 3.0 * secant } else { slope }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(rows: &[(f64, f64)]) -> Track<1> {
        Track::new(&rows.iter().map(|&(time, value)| (time, [value])).collect::<Vec<_>>())
    }

    fn at(track: &Track<1>, time: f64) -> f64 {
        track.at(time).expect("within its time")[0]
    }

    #[test]
    fn it_goes_through_its_rows_and_never_beyond_them() {
        let rows = [(0.0, 0.0), (1.0, 0.1), (1.5, 4.0), (4.0, 4.1), (5.0, -3.0), (9.0, -3.0), (10.0, 8.0)];
        let track = track(&rows);
        for &(time, value) in &rows {
            assert!((at(&track, time) - value).abs() < 1e-12);
        }
        for pair in rows.windows(2) {
            let [(t0, v0), (t1, v1)] = [pair[0], pair[1]];
            let (low, high) = (v0.min(v1), v0.max(v1));
            let mut before = v0;
            for step in 0..=200 {
                let value = at(&track, t0 + (t1 - t0) * f64::from(step) / 200.0);
                assert!((low - 1e-12..=high + 1e-12).contains(&value), "{value} between {v0} and {v1}");
                assert!((value - before) * (v1 - v0) >= -1e-12, "it turns between {t0} and {t1}");
                before = value;
            }
        }
    }

    #[test]
    fn its_slope_does_not_jump() {
        let track = track(&[(0.0, 0.0), (1.0, 1.0), (3.0, 2.0), (4.0, 7.0)]);
        let slope = |time: f64| (at(&track, time + 1e-6) - at(&track, time - 1e-6)) / 2e-6;
        for time in [1.0, 3.0] {
            assert!((slope(time - 1e-5) - slope(time + 1e-5)).abs() < 1e-3, "at {time}");
        }
    }

    #[test]
    fn two_rows_are_a_line_and_one_is_a_moment() {
        let line = track(&[(2.0, 1.0), (4.0, 5.0)]);
        for (time, value) in [(2.0, 1.0), (2.5, 2.0), (3.0, 3.0), (3.75, 4.5), (4.0, 5.0)] {
            assert!((at(&line, time) - value).abs() < 1e-14);
        }
        assert_eq!((line.at(1.99), line.at(4.01)), (None, None));
        let moment = track(&[(2.0, 7.0)]);
        assert_eq!((moment.at(2.0), moment.at(2.1), moment.at(1.9)), (Some([7.0]), None, None));
    }

    #[test]
    fn what_stands_still_stands_still_to_the_bit() {
        let track = track(&[(0.0, 0.1), (0.7, 0.1), (3.1, 0.1), (9.0, 0.3)]);
        for step in 0..=310 {
            assert_eq!(at(&track, f64::from(step) / 100.0), 0.1);
        }
        assert!(at(&track, 6.0) > 0.1);
    }
}
