//! Pixels at which plans are held against the direct sum in f64: the field, and the picture as it is shown.
//!
//! \[CIE\] CIE 142:2001, "Improvement to industrial colour-difference evaluation": ΔE2000. Colours that are 1 apart are
//! about what a trained eye tells apart side by side.

use palette::color_difference::Ciede2000 as _;
use palette::{IntoColor as _, Lab, LinSrgb};
use rayon::prelude::*;

use crate::compare::compare;
use crate::frame::Frame;
use crate::photo::{Photo, Shown, srgb_encode};
use crate::problem::Problem;

/// Bells that the direct sum may evaluate for a sample.
const EFFORT: usize = 20_000_000;
/// Pixels that are spread evenly, at least and at most.
const FEWEST: usize = 64;
const MOST: usize = 4096;
/// And of a photo's images.
const FEW: usize = 9;

/// Pixels of a picture with their light and the exact field.
pub(super) struct Sample {
    pub pixels: Vec<[i32; 2]>,
    light: Vec<[f32; 3]>,
    exact: Vec<[f64; 3]>,
    shown: Shown,
    pictured: Vec<Pictured>,
}

/// A pixel of a picture as a display shows it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pictured {
    /// sRGB, 0 to 1, not rounded to codes.
    pub code: [f32; 3],
    pub lab: Lab,
}

/// How far a field and its picture are from the exact ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Quality {
    /// Of the field, relative to its largest value, the worst colour: the largest error, and the root mean square.
    pub measured: f64,
    pub rms: f64,
    /// Of the tone-mapped composite: peak signal to noise ratio of its sRGB values in dB, infinite where nothing differs.
    pub psnr: f64,
    /// \[CIE\], the largest and the mean.
    pub delta_e: f64,
    pub delta_e_mean: f64,
}

/// What a display shows of light.
pub(super) fn pictured(shown: Shown, light: [f32; 3]) -> Pictured {
    let [red, green, blue] = shown.light(light);
    Pictured { code: [red, green, blue].map(srgb_encode), lab: LinSrgb::new(red, green, blue).into_color() }
}

/// A pixel with glare.
pub(super) fn composite(light: [f32; 3], field: [f64; 3]) -> [f32; 3] {
    [0, 1, 2].map(|colour| (f64::from(light[colour]) + field[colour]) as f32)
}

impl Sample {
    /// Pixels evenly over the picture, and those in `also`; of a photo's images these alone, or few, since each meets all of its pixels.
    pub fn new(photo: &Photo, problem: &Problem, also: Vec<[i32; 2]>) -> Self {
        let frame = photo.frame;
        let mut pixels = match problem.images() {
            Some(_) if !also.is_empty() => Vec::new(),
            Some(_) => even(frame, FEW),
            None => even(frame, (EFFORT / problem.ghosts().len().max(1)).clamp(FEWEST, MOST)),
        };
        pixels.extend(also);
        pixels.sort_unstable();
        pixels.dedup();
        let at = |&[i, j]: &[i32; 2]| {
            let [r, g, b, _] = photo.pixels[j as usize * frame.width as usize + i as usize];
            [r, g, b]
        };
        let light: Vec<_> = pixels.iter().map(at).collect();
        let exact = problem.truth(&pixels);
        let shown = Shown::of(photo);
        let pictured = light.iter().zip(&exact).map(|(&light, &field)| pictured(shown, composite(light, field)));
        Self { pictured: pictured.collect(), pixels, light, exact, shown }
    }

    /// Holds a field, at the sample's pixels, against the exact one.
    pub fn judge(&self, field: &[[f64; 3]]) -> Quality {
        let difference = compare(&self.exact, field);
        let (squares, delta_e, sum) = self
            .light
            .par_iter()
            .zip(field)
            .zip(&self.pictured)
            .map(|((&light, &field), exact)| {
                let seen = pictured(self.shown, composite(light, field));
                let squares: f64 = exact.code.iter().zip(seen.code).map(|(a, b)| f64::from(a - b).powi(2)).sum();
                let delta_e = f64::from(exact.lab.difference(seen.lab));
                (squares, delta_e, delta_e)
            })
            .reduce(|| (0.0, 0.0, 0.0), |a, b| (a.0 + b.0, a.1.max(b.1), a.2 + b.2));
        let count = self.light.len().max(1) as f64;
        Quality {
            measured: difference.relative,
            rms: difference.rms,
            psnr: -10.0 * (squares / (3.0 * count)).log10(),
            delta_e,
            delta_e_mean: sum / count,
        }
    }
}

/// About `most` pixels in rows and columns evenly over a picture; all of them where it has no more.
fn even(frame: Frame, most: usize) -> Vec<[i32; 2]> {
    let step = (f64::from(frame.width) * f64::from(frame.height) / most as f64).sqrt().max(1.0);
    let along = |length: u32| {
        let count = ((f64::from(length) / step) as u32).max(1);
        (0..count).map(move |k| ((f64::from(k) + 0.5) * f64::from(length) / f64::from(count)) as i32)
    };
    along(frame.height).flat_map(|j| along(frame.width).map(move |i| [i, j])).collect()
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::scene::Ghost;
    use crate::series::Bell;

    fn sample() -> (Sample, Vec<[f64; 3]>) {
        let ghosts =
            [Ghost { bell: Bell::Gaussian, center: DVec2::ZERO, size: DVec2::splat(0.4), radiance: [0.5, 0.4, 0.3] }];
        let photo = Photo::new(30, 20, vec![[0.2, 0.2, 0.2, 1.0]; 600]);
        let sample = Sample::new(&photo, &Problem::new(ghosts, photo.frame), vec![[29, 19]]);
        let exact = sample.exact.clone();
        (sample, exact)
    }

    #[test]
    fn the_exact_field_is_perfect_and_a_wrong_one_is_seen() {
        let (sample, exact) = sample();
        let quality = sample.judge(&exact);
        assert_eq!((quality.measured, quality.rms, quality.delta_e), (0.0, 0.0, 0.0));
        assert!(quality.psnr.is_infinite());
        let tinted: Vec<_> = exact.iter().map(|&[r, g, b]| [1.5 * r, g, b]).collect();
        let quality = sample.judge(&tinted);
        assert!((quality.measured - 0.5).abs() < 1e-9 && quality.rms < 0.5, "{quality:?}");
        assert!(quality.delta_e > 2.0 && quality.delta_e_mean < quality.delta_e, "{quality:?}");
        assert!((10.0..50.0).contains(&quality.psnr), "{quality:?}");
    }

    #[test]
    fn even_pixels_lie_in_the_picture_and_are_all_of_a_small_one() {
        assert_eq!(even(Frame::full(7, 3), 100).len(), 21);
        let pixels = even(Frame::full(1920, 1080), 4096);
        assert!((3600..=4096).contains(&pixels.len()), "{}", pixels.len());
        assert!(pixels.iter().all(|&[i, j]| (0..1920).contains(&i) && (0..1080).contains(&j)));
    }

    #[test]
    fn lab_of_white_is_white() {
        let white = pictured(Shown::of(&Photo::new(1, 1, vec![[0.0; 4]])), [1e6; 3]);
        assert!((white.lab.l - 100.0).abs() < 0.5 && white.code.iter().all(|&c| c > 0.99), "{white:?}");
    }
}
