//! Powers of an angle by powers of its chord, c = 2 sin(θ/2).
//!
//! In stereographic coordinates a = tan(ψ/2) (cos φ, sin φ) of two directions, c² = 4 |a − b|² / ((1 + |a|²)(1 +
//! |b|²)), so that a power of the chord is a factor of the one, a convolution in the plane and a factor of the other,
//! exactly; a power of the angle is none of that kind, but a short series in such powers.

use super::Fault;
use super::fault::within;

/// Most powers of a series.
pub const MOST_POWERS: usize = 16;

/// θ^−s by Σ coefficients\[k\] c^(2k − s), θ in radians.
#[derive(Debug, Clone, PartialEq)]
pub struct ChordSeries {
    exponent: f64,
    coefficients: Vec<f64>,
}

impl ChordSeries {
    /// Taylor's series of θ^−`exponent` at 0, cut to `powers` powers: exact to rounding near 0, and worst at the
    /// largest angle.
    ///
    /// θ/c = asin(x)/x with x = c/2, a series in x² whose coefficients are (2k)!/(4^k (k!)² (2k + 1)); its power −s by
    /// J. C. P. Miller's recurrence (Knuth, *The art of computer programming* 2, 4.7).
    ///
    /// # Errors
    /// On an exponent outside −6..6, or a number of powers outside 1..=[`MOST_POWERS`].
    pub fn taylor(exponent: f64, powers: usize) -> Result<Self, Fault> {
        let exponent = checked(exponent, powers)?;
        let mut ratio = vec![1.0];
        let mut middle = 1.0;
        for k in 1..powers {
            let k = k as f64;
            // (2k)!/(4^k (k!)²), and 4^−k for x² = c²/4.
            middle *= (2.0 * k - 1.0) / (2.0 * k) / 4.0;
            ratio.push(middle / (2.0 * k + 1.0));
        }
        let mut coefficients = vec![1.0];
        for k in 1..powers {
            let next =
                (1..=k).map(|j| (-exponent * j as f64 - (k - j) as f64) * ratio[j] * coefficients[k - j]).sum::<f64>();
            coefficients.push(next / k as f64);
        }
        Ok(Self { exponent, coefficients })
    }

    /// The same powers with coefficients that spread the error over 0..`widest` radians (interpolation at Chebyshev's
    /// points of c²): by a power of 4 for each power less at the largest angle than [`ChordSeries::taylor`].
    ///
    /// # Errors
    /// As of [`ChordSeries::taylor`], and on a largest angle that is not above 0 and at most 3.1.
    pub fn even(exponent: f64, powers: usize, widest: f64) -> Result<Self, Fault> {
        let exponent = checked(exponent, powers)?;
        let widest =
            within("angle", widest, [1e-9, 3.1], "the largest angle of a chord series is from 1e-9 to 3.1 radians")?;
        let chord = 2.0 * (0.5 * widest).sin();
        let square = chord * chord;
        // Newton's divided differences, of (θ/c)^−s over z = c², then multiplied out.
        let nodes: Vec<f64> = (0..powers)
            .map(|i| 0.5 * square * (1.0 - ((i as f64 + 0.5) * std::f64::consts::PI / powers as f64).cos()))
            .collect();
        let mut differences: Vec<f64> = nodes.iter().map(|z| angle_over_chord(z.sqrt()).powf(-exponent)).collect();
        for k in 1..powers {
            for i in (k..powers).rev() {
                differences[i] = (differences[i] - differences[i - 1]) / (nodes[i] - nodes[i - k]);
            }
        }
        let mut coefficients = vec![0.0; powers];
        for i in (0..powers).rev() {
            // p ← p (z − zᵢ) + dᵢ.
            for k in (1..powers).rev() {
                coefficients[k] = coefficients[k - 1] - nodes[i] * coefficients[k];
            }
            coefficients[0] = differences[i] - nodes[i] * coefficients[0];
        }
        Ok(Self { exponent, coefficients })
    }

    /// s.
    pub fn exponent(&self) -> f64 {
        self.exponent
    }

    /// What c^(2k − s) is taken by, for k = 0, 1, ….
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// The series at an angle of up to π radians.
    pub fn value(&self, angle: f64) -> f64 {
        let chord = 2.0 * (0.5 * angle).sin();
        let square = chord * chord;
        chord.powf(-self.exponent)
            * self.coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * square + coefficient)
    }

    /// Its relative error at an angle: series / θ^−s − 1.
    pub fn error_at(&self, angle: f64) -> f64 {
        self.value(angle) * angle.powf(self.exponent) - 1.0
    }

    /// The largest relative error over 0..`widest` radians, at 256 angles.
    pub fn error(&self, widest: f64) -> f64 {
        (1..=256).map(|i| self.error_at(widest * f64::from(i) / 256.0).abs()).fold(0.0, f64::max)
    }
}

/// θ/c of a chord.
fn angle_over_chord(chord: f64) -> f64 {
    if chord < 1e-4 { 1.0 + chord * chord / 24.0 } else { 2.0 * (0.5 * chord).min(1.0).asin() / chord }
}

fn checked(exponent: f64, powers: usize) -> Result<f64, Fault> {
    if !(1..=MOST_POWERS).contains(&powers) {
        return Err(Fault::new(
            "powers",
            format!("a chord series has from 1 to {MOST_POWERS} powers, and not {powers}"),
        ));
    }
    within("exponent", exponent, [-6.0, 6.0], "an exponent is from -6 to 6")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (θ/c)^−s = (1 + c²/24 + 3c⁴/640 + 5c⁶/7168 + …)^−s: its powers by hand.
    #[test]
    fn taylors_coefficients_are_those_of_the_inverse_sine() {
        let [a, b, d] = [1.0 / 24.0, 3.0 / 640.0, 5.0 / 7168.0];
        for s in [1.0, 2.0, 3.0, -1.0] {
            let known = [
                1.0,
                -s * a,
                -s * b + s * (s + 1.0) / 2.0 * a * a,
                -s * d + s * (s + 1.0) * a * b - s * (s + 1.0) * (s + 2.0) / 6.0 * a * a * a,
            ];
            let series = ChordSeries::taylor(s, 4).unwrap();
            for (x, known) in series.coefficients().iter().zip(known) {
                assert!((x - known).abs() < 1e-16, "{s}: {x} for {known}");
            }
        }
    }

    /// With all its powers the series is the power to rounding; fewer err as far as the first left out, and less when
    /// spread.
    #[test]
    fn a_series_is_the_power_as_far_as_it_says() {
        for s in [1.0, 2.0, 3.0] {
            let all = ChordSeries::taylor(s, MOST_POWERS).unwrap();
            assert!(all.error(60_f64.to_radians()) < 1e-11, "{s}: {}", all.error(60_f64.to_radians()));
            let three = ChordSeries::taylor(s, 3).unwrap();
            let [near, far] = [10_f64, 90.0].map(|angle| three.error_at(angle.to_radians()).abs());
            assert!(near < 3e-8 && (1e-3..1e-2).contains(&far), "{s}: {near} and {far}");
            for powers in 2..6 {
                let widest = 100_f64.to_radians();
                let [taylor, even] = [ChordSeries::taylor(s, powers), ChordSeries::even(s, powers, widest)]
                    .map(|series| series.unwrap().error(widest));
                assert!(even < 0.3 * taylor, "{s} by {powers}: {even} and {taylor}");
            }
        }
    }

    #[test]
    fn what_is_no_series_is_refused() {
        assert!(ChordSeries::taylor(f64::NAN, 3).is_err() && ChordSeries::taylor(1.0, 0).is_err());
        assert!(ChordSeries::even(1.0, 3, 3.2).is_err() && ChordSeries::even(1.0, 17, 1.0).is_err());
    }
}
