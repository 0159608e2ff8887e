//! A function of the eye by few powers of the chord, fitted to all of it at once.

use super::fit::{checked, even_in_logarithm, least_largest};
use super::function::Unit;
use super::{Fault, Psf};

/// Σ coefficient · c^exponent for a function of the eye, c = 2 sin(θ/2) the chord.
///
/// With a negative exponent a term is a weighted convolution in stereographic coordinates, with 0 the constant, and
/// with 2 a moment of the picture: c² = 2 − 2 cos θ, of rank 4. A fit of the whole function takes fewer powers than a
/// series for each power of θ: the exponents −3, −2, −1, 0 and 2 are all of `cie`, within 1e-4 up to 58 degrees and
/// 4e-4 up to 100.
#[derive(Debug, Clone, PartialEq)]
pub struct ChordPowers {
    /// Exponents, each with its coefficient, per steradian.
    pub terms: Vec<(i32, f64)>,
    /// The largest relative error over `range`, measured at 2401 angles.
    pub error: f64,
    /// The angles between which it holds, in degrees.
    pub range: [f64; 2],
}

/// Angles that a fit looks at.
const ANGLES: usize = 601;
/// Rounds of Lawson's iteration.
const ROUNDS: usize = 80;
/// The farthest angle, in degrees: beyond it a picture has no pixels.
const FARTHEST: f64 = 180.0;
/// The exponents that are taken.
const EXPONENTS: std::ops::RangeInclusive<i32> = -6..=6;

impl ChordPowers {
    /// The exponents that do for `cie` and `stiles-holladay`, and for `cie135` and `spencer` from some degrees on.
    pub const USUAL: [i32; 5] = [-3, -2, -1, 0, 2];

    /// The sum at an angle in degrees.
    pub fn value(&self, angle: f64) -> f64 {
        let chord = chord(angle);
        self.terms.iter().map(|(exponent, coefficient)| coefficient * chord.powi(*exponent)).sum()
    }
}

impl Psf {
    /// The powers `exponents` of the chord that come closest to this function, relatively, over `range`, or to as much
    /// of it as lies outside [`Psf::flat_within`].
    ///
    /// # Errors
    /// On a range that is none, lies within the flat part or goes beyond 180 degrees; on exponents that are none,
    /// repeat, or are not from −6 to 6; on a function that is not in degrees.
    pub fn chord_powers(&self, range: [f64; 2], exponents: &[i32]) -> Result<ChordPowers, Fault> {
        let ([from, to], _) = checked(range, 0.1)?;
        if self.unit() != Unit::Degrees {
            return Err(Fault::new(
                "psf",
                format!("{} is a function of the plane, and not of the sphere", self.name()),
            ));
        }
        let from = from.max(self.flat_within());
        if !(from..=FARTHEST).contains(&to) {
            return Err(Fault::new("range", format!("it ends above {from} degrees and at 180, and not at {to}")));
        }
        let new = |i: usize| EXPONENTS.contains(&exponents[i]) && !exponents[..i].contains(&exponents[i]);
        if exponents.is_empty() || !(0..exponents.len()).all(new) {
            return Err(Fault::new(
                "exponents",
                "there is at least one, each is from -6 to 6, and none is there twice",
            ));
        }
        let range = [from, to];
        // In nearest chords, so that no power is far from the others.
        let unit = chord(from);
        let row = |angle: f64| {
            let (ratio, value) = (chord(angle) / unit, self.value(angle));
            exponents.iter().map(move |exponent| ratio.powi(*exponent) / value)
        };
        let basis: Vec<f64> = even_in_logarithm(range, ANGLES).flat_map(row).collect();
        let factors = factors(&basis, exponents.len());
        let terms = exponents.iter().zip(factors).map(|(exponent, factor)| (*exponent, factor * unit.powi(-exponent)));
        let mut powers = ChordPowers { terms: terms.collect(), error: 0.0, range };
        let off = |angle: f64| (powers.value(angle) / self.value(angle) - 1.0).abs();
        powers.error = even_in_logarithm(range, 4 * ANGLES - 3).map(off).fold(0.0, f64::max);
        Ok(powers)
    }
}

/// The factors of least largest error of rows of `count` columns that shall sum to 1. Where the range is too short to
/// tell the columns apart, the last ones are left out, as 0.
fn factors(basis: &[f64], count: usize) -> Vec<f64> {
    for columns in (2..=count).rev() {
        let rows: Vec<f64> = basis.chunks_exact(count).flat_map(|row| row[..columns].to_vec()).collect();
        if let Some((mut factors, _)) = least_largest(&rows, columns, &[1.0; ANGLES], ROUNDS) {
            factors.resize(count, 0.0);
            return factors;
        }
    }
    let mut factors = vec![0.0; count];
    factors[0] = 1.0 / basis[0];
    factors
}

/// The chord of an angle in degrees.
fn chord(angle: f64) -> f64 {
    2.0 * (0.5 * angle.to_radians()).sin()
}

#[cfg(test)]
mod tests {
    use super::super::{Luminance, Observer};
    use super::*;

    /// What the type's text says, for observers of all kinds, at angles of its own.
    #[test]
    fn five_powers_are_all_of_cie() {
        for (age, pigment) in [(0.0, 0.0), (25.0, 0.5), (75.0, 0.5), (0.0, 1.2), (120.0, 1.2)] {
            let psf = Psf::cie(Observer::new(age, pigment).unwrap());
            for (widest, most) in [(58.0, 1e-4), (100.0, 4e-4), (140.0, 6e-3)] {
                let powers = psf.chord_powers([0.01, widest], &ChordPowers::USUAL).unwrap();
                assert!(
                    powers.error < most && powers.range == [0.1, widest],
                    "{age}, {pigment} to {widest}: {:.1e}",
                    powers.error
                );
                for i in 0..=997 {
                    let angle = 0.1 * (widest / 0.1_f64).powf(f64::from(i) / 997.0);
                    let off = (powers.value(angle) / psf.value(angle) - 1.0).abs();
                    assert!(off <= powers.error * 1.01, "{off} at {angle}");
                }
            }
        }
        let spencer = Psf::spencer(Luminance::Photopic).chord_powers([2.0, 90.0], &ChordPowers::USUAL).unwrap();
        assert!(spencer.error < 1e-3, "{:.1e}", spencer.error);
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let psf = Psf::cie(Observer::new(25.0, 0.5).unwrap());
        for (range, exponents) in [
            ([0.1, 181.0], &[-3][..]),
            ([0.01, 0.05], &[-3]),
            ([0.1, 50.0], &[]),
            ([0.1, 50.0], &[-3, -3]),
            ([0.1, 50.0], &[7]),
        ] {
            assert!(psf.chord_powers(range, exponents).is_err(), "{range:?}, {exponents:?}");
        }
        assert_eq!(Psf::camera().chord_powers([0.1, 1.0], &[-2]).unwrap_err().key, "psf");
        // One angle alone has no five powers.
        assert!(psf.chord_powers([5.0, 5.0], &ChordPowers::USUAL).unwrap().error < 1e-12);
    }
}
