//! From which luminance on a pixel counts as light; or from which value of its brightest channel on, where light is told by
//! that, which is meant here by luminance, too.
//!
//! Glare is made of flux, so the rule looks at where the flux is, not at where the pixels are. A histogram of
//! log-luminance, each bin weighted by the flux that its pixels carry, is split in two by Otsu's method \[O79\]: of all
//! splits it is the one that leaves the least variance, in stops, on its two sides. A lamp of 1000 in a room of 0.5 so
//! gets a threshold between the two, although it covers a thousandth of the picture. Box-filtering a photo moves
//! little flux between bins, hence the same photo gives nearly the same threshold at any resolution.
//!
//! Otsu's method always splits, also where there is nothing to split, like a sky above a field. So only thresholds of at
//! least [`FLOOR`] times the mean luminance are looked at, and lights can cover at most 1 / [`FLOOR`] of the pixels
//! (Markov's inequality). Below that nothing stands out enough to be called a light.
//!
//! A photo of short range, whose brightest luminance is less than [`SHORT_RANGE`] times its mean, and which reaches that
//! luminance with a patch and not a pixel, has been clipped there: what is clipped is its light.
//!
//! Fireflies take no part: one that is a hundred times as bright as a lamp has the flux of all of it.
//!
//! \[O79\] N. Otsu, "A Threshold Selection Method from Gray-Level Histograms", IEEE Trans. SMC 9(1), 1979.

use std::ops::Range;

use rayon::prelude::*;
use serde::Serialize;

use super::lit::Lit;

/// The automatic threshold is at least this many times the mean luminance.
pub const FLOOR: f64 = 4.0;

/// A photo whose peak is less than this many times its mean (six stops) may be one whose highlights are clipped.
pub const SHORT_RANGE: f64 = 64.0;

/// Luminances above this share of the peak are "at the peak"; one step of an 8 bit sRGB code near white is 0.9 %.
const AT_PEAK: f64 = 0.995;

/// A photo is clipped if this share of its pixels is at the peak: more than a few pixels, less than a white wall, and no
/// more than lights may cover by the other rules.
const CLIPPED: std::ops::RangeInclusive<f64> = 2e-4..=1.0 / FLOOR;

/// How a threshold was chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rule {
    /// The caller gave it.
    Given,
    /// It splits the photo's flux into light and scene (Otsu's method).
    Split,
    /// It is [`FLOOR`] times the mean luminance, because no split above that is better.
    Mean,
    /// Highlights are clipped, and it lies just below that level.
    Clipped,
}

/// The threshold for these pixels and the rule that chose it. Above the peak, and so without effect, where no pixel
/// stands out; 0 where all of them are black.
pub(super) fn automatic(lit: &Lit<'_>) -> (f64, Rule) {
    let histogram = Histogram::new(lit);
    let mean = histogram.mean();
    let peak = f64::from(f32::from_bits(histogram.peak));
    if peak < SHORT_RANGE * mean {
        let level = AT_PEAK * peak;
        if CLIPPED.contains(&(reaching(lit, level) as f64 / lit.pixels().len() as f64)) {
            return (level, Rule::Clipped);
        }
    }
    let floor = FLOOR * mean;
    histogram.split(floor).map_or((floor, Rule::Mean), |split| (split, Rule::Split))
}

/// How many pixels have at least a luminance, fireflies left out.
fn reaching(lit: &Lit<'_>, level: f64) -> usize {
    let of_row = |row| {
        let mut count = 0;
        lit.each(row, |_, luminance| count += usize::from(f64::from(luminance) >= level));
        count
    };
    lit.bands().map(|rows| rows.map(of_row).sum::<usize>()).sum()
}

/// How many pixels have which luminance, 16 bins to the octave. Counts are integers and do not depend on the order in
/// which threads add them.
struct Histogram {
    counts: Vec<u64>,
    /// The largest luminance, as bits; those of positive floats are ordered like their values.
    peak: u32,
}

/// A bin is the sign, the exponent and 4 bits of the mantissa of an f32.
const SHIFT: u32 = 19;
const BINS: usize = (f32::INFINITY.to_bits() >> SHIFT) as usize;

/// The least luminance in bin `k`.
fn edge(k: usize) -> f64 {
    f64::from(f32::from_bits((k as u32) << SHIFT))
}

/// The luminance in the middle of bin `k`.
fn middle(k: usize) -> f64 {
    f64::from(f32::from_bits((k as u32) << SHIFT | 1 << (SHIFT - 1)))
}

impl Histogram {
    fn new(lit: &Lit<'_>) -> Self {
        let empty = || Self { counts: vec![0; BINS], peak: 0 };
        lit.bands().fold(empty, |histogram, rows| histogram.with(lit, rows)).reduce(empty, Self::plus)
    }

    fn with(mut self, lit: &Lit<'_>, rows: Range<usize>) -> Self {
        for row in rows {
            lit.each(row, |_, luminance| {
                let bits = luminance.to_bits();
                self.counts[(bits >> SHIFT) as usize] += 1;
                self.peak = self.peak.max(bits);
            });
        }
        self
    }

    fn plus(mut self, other: Self) -> Self {
        self.counts.iter_mut().zip(&other.counts).for_each(|(a, b)| *a += b);
        Self { peak: self.peak.max(other.peak), ..self }
    }

    /// Flux in each bin, in units of a pixel's area. Black pixels are in the first bin and carry none.
    fn flux(&self) -> impl Iterator<Item = (usize, f64)> {
        self.counts.iter().enumerate().skip(1).map(|(k, &count)| (k, count as f64 * middle(k)))
    }

    /// Mean luminance, to the 3 % that a bin is wide.
    fn mean(&self) -> f64 {
        let pixels: u64 = self.counts.iter().sum();
        self.flux().map(|(_, flux)| flux).sum::<f64>() / pixels.max(1) as f64
    }

    /// Of the luminances above `floor`, the one that splits the flux so that the variance of log-luminance within the two
    /// sides is least, which is where the variance between them is greatest \[O79, eq. 18\]. Across a gap of empty bins
    /// every split is as good, and the middle is taken. `None` where no split is better than that at the floor itself.
    fn split(&self, floor: f64) -> Option<f64> {
        let total: f64 = self.flux().map(|(_, flux)| flux).sum();
        let moment: f64 = self.flux().map(|(k, flux)| flux * middle(k).log2()).sum();
        let (mut below, mut below_moment) = (0.0, 0.0);
        let (mut first, mut best, mut range) = (None, 0.0, (0, 0));
        for (k, flux) in self.flux() {
            below += flux;
            below_moment += flux * middle(k).log2();
            let above = total - below;
            if below <= 0.0 || above <= 1e-12 * total || edge(k + 1) < floor {
                continue;
            }
            first.get_or_insert(k + 1);
            let between = below * above * (below_moment / below - (moment - below_moment) / above).powi(2);
            if between > best {
                (best, range) = (between, (k + 1, k + 1));
            } else if between == best && flux == 0.0 && range.1 == k {
                range.1 = k + 1;
            }
        }
        (range.1 > first?).then(|| (edge(range.0) * edge(range.1)).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The threshold of pixels in any order, by all of them.
    fn automatic(pixels: &[[f32; 4]]) -> (f64, Rule) {
        super::automatic(&Lit::new(pixels, 1, [0.2126, 0.7152, 0.0722].into(), 0.0))
    }

    fn grey(l: f32) -> [f32; 4] {
        [l, l, l, 1.0]
    }

    /// `pixels` grey ones, of which the shares given have the luminances given and the rest is `rest`.
    fn mixture(pixels: usize, rest: f32, parts: &[(f64, f32)]) -> Vec<[f32; 4]> {
        let mut out = Vec::with_capacity(pixels);
        for &(share, l) in parts {
            out.resize(out.len() + (share * pixels as f64) as usize, grey(l));
        }
        out.resize(pixels, grey(rest));
        out
    }

    #[test]
    fn a_small_lamp_in_a_dim_room_is_split_from_it() {
        let (threshold, rule) = automatic(&mixture(100_000, 0.3, &[(0.001, 1000.0), (0.1, 0.9)]));
        assert_eq!(rule, Rule::Split);
        assert!((10.0..100.0).contains(&threshold), "{threshold}");
    }

    #[test]
    fn a_bright_sky_is_no_light() {
        for share in [0.3, 0.5, 0.75] {
            let (threshold, rule) = automatic(&mixture(100_000, 0.2, &[(share, 3.0)]));
            assert_eq!(rule, Rule::Mean);
            assert!(threshold > 3.0, "a sky over {share} of the picture, {threshold}");
        }
    }

    #[test]
    fn a_sun_in_a_bright_sky_is_one() {
        let (threshold, _) = automatic(&mixture(100_000, 0.2, &[(0.5, 3.0), (0.0003, 2000.0)]));
        assert!((6.0..1000.0).contains(&threshold), "{threshold}");
    }

    #[test]
    fn clipped_highlights_of_a_display_referred_photo_are_lights() {
        let (threshold, rule) = automatic(&mixture(100_000, 0.3, &[(0.2, 0.8), (0.02, 1.0)]));
        assert_eq!((threshold, rule), (0.995, Rule::Clipped));
        // Also in a low key; a few hot pixels are no highlight, and a clipped half of the picture is none either.
        assert_eq!(automatic(&mixture(100_000, 0.02, &[(0.01, 0.3), (0.002, 1.0)])).1, Rule::Clipped);
        assert_ne!(automatic(&mixture(100_000, 0.2, &[(0.2, 0.5), (0.0001, 1.0)])).1, Rule::Clipped);
        assert_eq!(automatic(&mixture(100_000, 0.3, &[(0.5, 1.0)])).1, Rule::Mean);
    }

    #[test]
    fn nothing_stands_out_in_a_flat_picture() {
        for level in [0.01, 0.5, 1.0, 1e30] {
            let (threshold, rule) = automatic(&vec![grey(level); 1000]);
            assert_eq!(rule, Rule::Mean);
            assert!(threshold > 3.0 * f64::from(level));
        }
        assert_eq!(automatic(&[grey(0.0); 10]).0, 0.0);
        assert!(automatic(&[grey(7.0)]).0 > 7.0);
        assert_eq!(automatic(&[]).0, 0.0);
    }

    #[test]
    fn a_hot_pixel_does_not_hide_a_lamp() {
        let mut pixels = mixture(2_000_000, 0.3, &[(0.001, 1000.0)]);
        pixels[1_000_000] = grey(60_000.0);
        assert!(automatic(&pixels).0 < 500.0);
    }
}
