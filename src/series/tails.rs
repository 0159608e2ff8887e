//! Tails of coefficients: what harmonics beyond N hold together.

/// At index N, for N = 0 ..= `highest`, the sum of `coefficient(n)` over N < n ≤ `last`, and `remainder` beyond.
///
/// `last` must not be below `highest`.
pub(super) fn summed(highest: u32, last: u32, remainder: f64, coefficient: impl Fn(u32) -> f64) -> Vec<f64> {
    let mut tails = vec![0.0; highest as usize + 1];
    let mut sum = remainder;
    for n in (0..=last).rev() {
        if let Some(tail) = tails.get_mut(n as usize) {
            // A few roundings upward, so that the sum stays a bound.
            *tail = sum * (1.0 + 1e-13);
        }
        sum += coefficient(n);
    }
    tails
}

/// A bell that ends and is narrower than this, in periods, needs more harmonics than any series has: there the bound of its
/// tails may be loose, and need not be a sum of millions of terms.
pub(super) const NARROWEST: f64 = 1e-4;

/// The tails of a narrow bell, at index N for N = 0 ..= `highest`: no harmonic holds more than `most`, and those beyond n
/// hold at most `integral(n)` from n = `close` on.
pub(super) fn narrow(highest: u32, close: f64, most: f64, integral: impl Fn(f64) -> f64) -> Vec<f64> {
    let tail = |n: f64| most * (close - n).max(0.0) + integral(n.max(close));
    (0..=highest).map(|n| tail(f64::from(n))).collect()
}

/// Copies that are added one by one. More of them are bounded by so many ranges: a file may well say that a bell is 1e12
/// periods wide.
const MOST_COPIES: f64 = 4096.0;
const RANGES: u32 = 256;

/// What the copies of an even bound that never grows add, `period` apart, within `distance` of the centre; nothing of the
/// bell is further out than `support`. Where there are very many copies, a bound of that.
pub(super) fn copies(period: f64, distance: f64, support: f64, along: impl Fn(f64) -> f64) -> f64 {
    let beyond = support - (period - distance);
    if beyond > MOST_COPIES * period {
        // A range holds at most its width over the period, and one, on either side; none is larger than where it begins,
        // and the far ones are not larger than the near ones.
        let width = beyond / f64::from(RANGES);
        let ranges = (0..RANGES).map(|range| along(period - distance + f64::from(range) * width));
        return 2.0 * (width / period + 1.0) * ranges.sum::<f64>();
    }
    let mut sum = 0.0;
    let mut near = period - distance;
    let mut far = period;
    while near < support {
        sum += along(near) + along(far);
        near += period;
        far += period;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sum of a triangle's copies, in closed form for whole numbers of them.
    #[test]
    fn very_many_copies_are_bounded_from_above_and_closely() {
        let triangle = |support: f64| move |x: f64| (1.0 - x / support).max(0.0);
        for support in [1e4, 1e5] {
            // Σ_{k=1}^{n} (1 − k/n) = (n − 1)/2, on either side, where the distance is 0.
            let exact = support - 1.0;
            let bound = copies(1.0, 0.0, support, triangle(support));
            assert!(bound >= exact && bound <= 1.03 * exact, "{support}: {bound} for {exact}");
        }
        let bound = copies(4.0, 1.0, 1e12, triangle(1e12));
        assert!((2.5e11..2.6e11).contains(&bound), "{bound:e}");
        assert!(copies(1e-38, 0.0, 3e38, triangle(3e38)).is_finite());
    }
}
