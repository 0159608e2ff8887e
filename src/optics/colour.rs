//! Wavelengths → linear Rec. 709, for light that is white where it comes straight through.

use super::glass::VISIBLE;

/// Wavelengths in nm by this step: some thirty, which resolve the ripple of a multilayer.
const STEP: f64 = 10.0;

/// The weight of each wavelength in red, green and blue.
///
/// Colour matching functions of the CIE 1931 standard observer, in the fit by lobes of Wyman, Sloan and Shirley, "Simple
/// analytic approximations to the CIE XYZ color matching functions" (JCGT 2(2), 2013), through the matrix of Rec. 709's
/// primaries. Each colour's weights are divided by their sum, so that a constant spectrum is (1, 1, 1).
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// In nm.
    pub wavelengths: Vec<f64>,
    /// Red, green and blue of each; a few are negative, where a hue is outside of Rec. 709.
    pub weights: Vec<[f64; 3]>,
    /// The mean wavelength of the positive weights of each colour, in nm, at which its rays are taken.
    pub centres: [f64; 3],
}

impl Sensitivity {
    /// That of the standard observer from 380 to 780 nm.
    pub fn standard_observer() -> Self {
        let [least, most] = VISIBLE;
        let count = ((most - least) / STEP).round() as u32 + 1;
        let wavelengths: Vec<f64> = (0..count).map(|k| least + STEP * f64::from(k)).collect();
        let raw: Vec<_> = wavelengths.iter().map(|&wavelength| rec_709(matching(wavelength))).collect();
        let sum = |c: usize| raw.iter().map(|rgb| rgb[c]).sum::<f64>();
        let sums: [f64; 3] = std::array::from_fn(sum);
        let weights: Vec<[f64; 3]> = raw.iter().map(|rgb| std::array::from_fn(|c| rgb[c] / sums[c])).collect();
        let centres = std::array::from_fn(|c| {
            let positive = || wavelengths.iter().zip(&weights).map(|(wavelength, rgb)| (wavelength, rgb[c].max(0.0)));
            positive().map(|(wavelength, weight)| wavelength * weight).sum::<f64>()
                / positive().map(|(_, w)| w).sum::<f64>()
        });
        Self { wavelengths, weights, centres }
    }

    /// The colour of a spectrum that is given at [`Sensitivity::wavelengths`], relative to that of `white`.
    ///
    /// A hue outside of Rec. 709 has its negative parts set to 0.
    pub fn relative(&self, spectrum: &[f64], white: &[f64]) -> [f64; 3] {
        let colour = |of: &[f64], c: usize| self.weights.iter().zip(of).map(|(rgb, power)| rgb[c] * power).sum::<f64>();
        std::array::from_fn(|c| {
            let (part, whole) = (colour(spectrum, c), colour(white, c));
            if whole > 0.0 { (part / whole).max(0.0) } else { 0.0 }
        })
    }

    /// The largest part that a spectrum of at most 1 can have in any colour.
    pub(super) fn most(&self) -> f64 {
        let positive = |c: usize| self.weights.iter().map(|rgb| rgb[c].max(0.0)).sum::<f64>();
        (0..3).map(positive).fold(0.0, f64::max)
    }
}

/// x̄, ȳ and z̄ of the 1931 observer at a wavelength in nm.
fn matching(wavelength: f64) -> [f64; 3] {
    let lobe = |height: f64, centre: f64, below: f64, above: f64| {
        let width = if wavelength < centre { below } else { above };
        height * (-0.5 * ((wavelength - centre) / width).powi(2)).exp()
    };
    [
        lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) + lobe(-0.065, 501.1, 20.4, 26.2),
        lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
        lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8),
    ]
}

/// Linear Rec. 709 of a colour in CIE XYZ (IEC 61966-2-1).
fn rec_709([x, y, z]: [f64; 3]) -> [f64; 3] {
    [3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z, 0.0557 * x - 0.2040 * y + 1.0570 * z]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fit_is_near_the_published_observer() {
        // CIE 1931, 2°: x̄, ȳ, z̄.
        for (wavelength, published) in
            [(450.0, [0.3362, 0.0380, 1.7721]), (550.0, [0.4334, 0.9950, 0.0087]), (600.0, [1.0622, 0.6310, 0.0008])]
        {
            let found = matching(wavelength);
            let near = found.iter().zip(published).all(|(found, published)| (found - published).abs() < 0.03);
            assert!(near, "{wavelength}: {found:?}");
        }
    }

    #[test]
    fn equal_light_is_white_and_each_colour_is_where_it_is_seen() {
        let observer = Sensitivity::standard_observer();
        let white = vec![0.7; observer.wavelengths.len()];
        let grey: Vec<f64> = white.iter().map(|power| 0.1 * power).collect();
        for part in observer.relative(&grey, &white) {
            assert!((part - 0.1).abs() < 1e-15);
        }
        let [red, green, blue] = observer.centres;
        assert!((590.0..620.0).contains(&red) && (530.0..560.0).contains(&green), "{:?}", observer.centres);
        assert!((440.0..470.0).contains(&blue), "{:?}", observer.centres);
        let long: Vec<f64> = observer.wavelengths.iter().map(|&w| if w > 600.0 { 1.0 } else { 0.0 }).collect();
        let [red, green, blue] = observer.relative(&long, &white);
        assert!(red > 0.5 && green < 0.1 && blue < 0.01, "{red} {green} {blue}");
        let most = observer.most();
        assert!(most > 1.0 && most < 2.0, "{most}");
    }

    #[test]
    fn a_finer_step_gives_the_same_colour() {
        // A coating's reflectance, whose ripple is about as fast as this.
        let observer = Sensitivity::standard_observer();
        let ripple = |wavelength: f64| 1.0 + (wavelength / 12.0).sin();
        let spectrum: Vec<f64> = observer.wavelengths.iter().map(|&wavelength| ripple(wavelength)).collect();
        let white = vec![1.0; spectrum.len()];
        let found = observer.relative(&spectrum, &white);
        for (c, found) in found.into_iter().enumerate() {
            let fine = (3800..=7800).map(|k| f64::from(k) * 0.1).map(|wavelength| {
                let weight = rec_709(matching(wavelength))[c];
                (weight * ripple(wavelength), weight)
            });
            let (part, whole) = fine.fold((0.0, 0.0), |sum, next| (sum.0 + next.0, sum.1 + next.1));
            assert!((found - part / whole).abs() < 2e-3, "{c}: {found} {}", part / whole);
        }
    }
}
