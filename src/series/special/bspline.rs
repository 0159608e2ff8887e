//! Cardinal B-splines.

/// What the B-splines of an order, one at each knot, are at 0 ≤ t < 1 after a knot: that of the knot `ORDER` / 2 − 1 before it first. By the
/// recursion of Cox and de Boor.
pub fn bspline<const ORDER: usize>(t: f64) -> [f64; ORDER] {
    let mut weights = [0.0; ORDER];
    weights[0] = 1.0;
    for order in 1..ORDER {
        let scale = (order as f64).recip();
        let mut carried = 0.0;
        for (k, weight) in weights.iter_mut().enumerate().take(order) {
            // Of a knot that is `k` before the place's own.
            let right = (k + 1) as f64 - t;
            let left = t + (order - 1 - k) as f64;
            let part = *weight * scale;
            *weight = carried + right * part;
            carried = left * part;
        }
        weights[order] = carried;
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_what_its_polynomials_are_and_all_orders_add_up_to_one() {
        for t in [0.0, 0.1, 0.5, 0.77f64] {
            let cubic = [
                (1.0 - t).powi(3),
                4.0 - 6.0 * t * t + 3.0 * t * t * t,
                1.0 + 3.0 * t + 3.0 * t * t - 3.0 * t * t * t,
                t.powi(3),
            ];
            for (found, wanted) in bspline::<4>(t).into_iter().zip(cubic) {
                assert!((found - wanted / 6.0).abs() < 1e-15, "{t}: {found} {wanted}");
            }
            let sum: f64 = bspline::<12>(t).iter().sum();
            assert!((sum - 1.0).abs() < 1e-14, "{t}: {sum}");
        }
    }
}
