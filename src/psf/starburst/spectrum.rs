//! By how much each channel sees a wavelength.
//!
//! Colour matching functions of the CIE 1931 2° observer by the analytic fit of Wyman, Sloan & Shirley, *Simple Analytic
//! Approximations to the CIE XYZ Color Matching Functions*, JCGT 2 (2013) 1, eq. 4, taken to linear Rec. 709. That gives
//! spectral colours outside the gamut negative channels, which no kernel can have: they are 0 here, as for a camera whose
//! channels see what is left, and what is saturated comes out a little paler. Each channel's sensitivities then add up to 1,
//! so that a source of equal energy at all wavelengths, and what is diffracted of it in sum, is white.

/// The wavelengths that count, in micrometres.
pub(super) const VISIBLE: [f64; 2] = [0.38, 0.73];
/// Of the unit in which patterns are computed, in micrometres; near the middle of what is seen.
pub(super) const UNIT: f64 = 0.55;
/// Parts of the visible range in a sum over wavelengths: 5 nm each.
pub(super) const PARTS: usize = 70;

/// XYZ to linear Rec. 709, white D65 (IEC 61966-2-1).
const TO_REC709: [[f64; 3]; 3] =
    [[3.240_6, -1.537_2, -0.498_6], [-0.968_9, 1.875_8, 0.041_5], [0.055_7, -0.204_0, 1.057_0]];

/// What the channels see of a wavelength in micrometres, as ratios.
fn seen(wavelength: f64) -> [f64; 3] {
    let nm = 1e3 * wavelength;
    let lobe = |height: f64, middle: f64, below: f64, above: f64| {
        let off = (nm - middle) / if nm < middle { below } else { above };
        height * (-0.5 * off * off).exp()
    };
    let xyz = [
        lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) + lobe(-0.065, 501.1, 20.4, 26.2),
        lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
        lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8),
    ];
    TO_REC709.map(|row| row.iter().zip(xyz).map(|(factor, x)| factor * x).sum::<f64>().max(0.0))
}

/// Sensitivities of the channels, each of the integral 1 over wavelengths in micrometres.
pub(super) struct Sensitivities {
    by: [f64; 3],
}

impl Sensitivities {
    pub fn new() -> Self {
        let mut sums = [0.0; 3];
        for wavelength in wavelengths() {
            seen(wavelength).iter().zip(&mut sums).for_each(|(value, sum)| *sum += value);
        }
        Self { by: sums.map(|sum| 1.0 / (sum * step())) }
    }

    /// At a wavelength in micrometres, per micrometre; 0 of what is not visible.
    pub fn at(&self, wavelength: f64) -> [f64; 3] {
        if !(VISIBLE[0]..=VISIBLE[1]).contains(&wavelength) {
            return [0.0; 3];
        }
        let seen = seen(wavelength);
        [0, 1, 2].map(|channel| seen[channel] * self.by[channel])
    }

    /// The middles of equal parts of the visible range, and what each channel has of the part.
    pub fn parts(&self) -> impl Iterator<Item = (f64, [f64; 3])> {
        wavelengths().map(|wavelength| (wavelength, self.at(wavelength).map(|value| value * step())))
    }
}

/// The width of a part, in micrometres.
fn step() -> f64 {
    (VISIBLE[1] - VISIBLE[0]) / PARTS as f64
}

fn wavelengths() -> impl Iterator<Item = f64> {
    (0..PARTS).map(|part| VISIBLE[0] + (part as f64 + 0.5) * step())
}
