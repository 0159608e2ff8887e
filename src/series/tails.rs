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

/// What the copies of an even bound that never grows add, `period` apart, within `distance` of the centre; nothing of the
/// bell is further out than `support`.
pub(super) fn copies(period: f64, distance: f64, support: f64, along: impl Fn(f64) -> f64) -> f64 {
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
