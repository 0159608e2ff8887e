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
    /// The luminance of each; their sum is 1 as well.
    pub luminance: Vec<f64>,
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
        let luminance: Vec<f64> = wavelengths.iter().map(|&wavelength| matching(wavelength)[1]).collect();
        let whole = luminance.iter().sum::<f64>();
        let luminance = luminance.iter().map(|part| part / whole).collect();
        let sum = |c: usize| raw.iter().map(|rgb| rgb[c]).sum::<f64>();
        let sums: [f64; 3] = std::array::from_fn(sum);
        let weights: Vec<[f64; 3]> = raw.iter().map(|rgb| std::array::from_fn(|c| rgb[c] / sums[c])).collect();
        let centres = std::array::from_fn(|c| {
            let positive = || wavelengths.iter().zip(&weights).map(|(wavelength, rgb)| (wavelength, rgb[c].max(0.0)));
            positive().map(|(wavelength, weight)| wavelength * weight).sum::<f64>()
                / positive().map(|(_, w)| w).sum::<f64>()
        });
        Self { wavelengths, weights, luminance, centres }
    }

    /// The colour of a spectrum that is given at [`Sensitivity::wavelengths`], relative to that of `white`. Neither is negative.
    ///
    /// A hue outside of Rec. 709, as of a coating that reflects violet and red alone, is paled at the same luminance until
    /// it is just within.
    pub fn relative(&self, spectrum: &[f64], white: &[f64]) -> [f64; 3] {
        let ratio = |weight: &dyn Fn(usize) -> f64| {
            let sum = |of: &[f64]| of.iter().enumerate().map(|(k, power)| weight(k) * power).sum::<f64>();
            let whole = sum(white);
            if whole > 0.0 { sum(spectrum) / whole } else { 0.0 }
        };
        let colour: [f64; 3] = std::array::from_fn(|c| ratio(&|k| self.weights[k][c]));
        let grey = ratio(&|k| self.luminance[k]);
        let least = colour.into_iter().fold(grey, f64::min);
        if least >= 0.0 {
            return colour;
        }
        let kept = grey / (grey - least);
        colour.map(|part| (grey + kept * (part - grey)).max(0.0))
    }

    /// No colour of a spectrum that is the product of two, or less, has a larger part than this of that of `white`.
    pub(super) fn most(&self, one: &[f64], other: &[f64], white: &[f64]) -> f64 {
        let ratio = |weight: &dyn Fn(usize) -> f64| {
            let most = one.iter().zip(other).enumerate().map(|(k, (one, other))| weight(k).max(0.0) * one * other);
            most.sum::<f64>() / white.iter().enumerate().map(|(k, power)| weight(k) * power).sum::<f64>()
        };
        let colours = (0..3).map(|c| ratio(&|k| self.weights[k][c]));
        // Paling raises a colour to the luminance at most.
        colours.chain([ratio(&|k| self.luminance[k])]).fold(0.0, f64::max)
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
        for sum in (0..3).map(|c| observer.weights.iter().map(|rgb| rgb[c]).sum::<f64>()) {
            assert!((sum - 1.0).abs() < 1e-12);
        }
        let [red, green, blue] = observer.centres;
        assert!((590.0..620.0).contains(&red) && (530.0..560.0).contains(&green), "{:?}", observer.centres);
        assert!((440.0..470.0).contains(&blue), "{:?}", observer.centres);
        let long: Vec<f64> = observer.wavelengths.iter().map(|&w| if w > 600.0 { 1.0 } else { 0.0 }).collect();
        let [red, green, blue] = observer.relative(&long, &white);
        assert!(red > 0.5 && green < 0.1 && blue < 0.1, "{red} {green} {blue}");
    }

    #[test]
    fn a_hue_outside_of_the_primaries_is_paled_at_its_luminance() {
        let observer = Sensitivity::standard_observer();
        let white = vec![1.0; observer.wavelengths.len()];
        for line in [400.0, 450.0, 500.0, 520.0, 700.0] {
            let spectrum: Vec<f64> = observer.wavelengths.iter().map(|&w| f64::from(u8::from(w == line))).collect();
            let colour = observer.relative(&spectrum, &white);
            let most = observer.most(&spectrum, &white, &white);
            assert!(colour.iter().all(|&part| (0.0..=most).contains(&part)), "{line}: {colour:?}");
            assert!(colour.iter().any(|&part| part < 1e-15), "{line}: {colour:?} is paler than it has to be");
            // Rec. 709's luminance, but for white being that of equal energy.
            let [red, green, blue] = colour;
            let luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
            let grey: f64 = observer.luminance.iter().zip(&spectrum).map(|(part, power)| part * power).sum();
            assert!((luminance - grey).abs() < 0.2 * grey + 1e-3, "{line}: {luminance} {grey}");
        }
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
