//! Photos that go all the way round.

use rayon::prelude::*;

use crate::photo::Photo;

/// What of the difference to columns half the width away there may be between the first column and the last.
const ALIKE: f64 = 0.5;
/// How many times the difference to the column next to it that may be, where it is not tiny anyway.
const NEXT: f64 = 2.5;
const TINY: f64 = 0.01;
/// Light that is as good as black, in means of the photo: a logarithm makes too much of it.
const BLACK: f64 = 1e-4;

/// A warning where a photo seems to be an equirectangular panorama: twice as wide as high, and its last column goes on in the
/// first. Glare is not carried from one to the other.
pub(super) fn seam(photo: &Photo) -> Option<String> {
    is_panorama(photo).then(|| {
        "the photo looks like a panorama of the whole sphere, whose left edge goes on at its right one: its glare ends at both, and \
         the seam will show; a veil in degrees goes all the way round by --projection equirectangular"
            .to_owned()
    })
}

fn is_panorama(photo: &Photo) -> bool {
    let frame = photo.frame;
    let width = frame.width as usize;
    if frame.width != 2 * frame.height || frame.width < 8 || frame.pixel_aspect != 1.0 || !frame.is_whole() {
        return false;
    }
    let light = |pixel: &[f32; 4]| {
        let sum: f64 = pixel[..3].iter().map(|&value| f64::from(value)).filter(|value| value.is_finite()).sum();
        sum.max(0.0)
    };
    let mean = photo.pixels.par_iter().map(light).sum::<f64>() / photo.pixels.len() as f64;
    let apart = |one: usize, other: usize| {
        let at = |row: &[[f32; 4]], column: usize| (light(&row[column]) + BLACK * mean).ln();
        let rows = photo.pixels.chunks_exact(width);
        rows.map(|row| (at(row, one) - at(row, other)).abs()).sum::<f64>() / f64::from(frame.height)
    };
    let seam = apart(width - 1, 0);
    let far = 0.5 * (apart(0, width / 2) + apart(width - 1, width / 2 - 1));
    let next = 0.5 * (apart(0, 1) + apart(width - 2, width - 1));
    // A photo that is the same everywhere says nothing; nor do edges of one sky, unless they fit as neighbours do.
    seam < ALIKE * far && seam <= (NEXT * next).max(TINY)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Light by the turn and the height, each from 0 to 1.
    fn photo([width, height]: [usize; 2], light: impl Fn(f64, f64) -> f64) -> Photo {
        let turn =
            |at: usize| (((at % width) as f64 + 0.5) / width as f64, ((at / width) as f64 + 0.5) / height as f64);
        let pixels = (0..width * height).map(turn).map(|(x, y)| light(x, y) as f32);
        Photo::new(width as u32, height as u32, pixels.map(|value| [value, 0.8 * value, 0.5 * value, 1.0]).collect())
    }

    /// Something in every direction, which goes on where the turn begins again.
    fn world(x: f64, y: f64) -> f64 {
        (2.0 * (TAU * x + 0.4).sin() + (3.0 * TAU * x - 5.0 * y).cos() - 3.0 * y).exp()
    }

    #[test]
    fn a_world_all_round_is_told_from_a_part_of_it() {
        let all_round = photo([128, 64], world);
        assert!(seam(&all_round).is_some_and(|text| text.contains("seam")));
        // Half of the turn, a slope of light, one that is not twice as wide as high, the same everywhere, and black.
        for other in [
            photo([128, 64], |x, y| world(0.5 * x, y)),
            photo([128, 64], |x, y| (4.0 * x + y).exp()),
            photo([128, 63], world),
            photo([96, 64], world),
            photo([128, 64], |_, y| y),
            photo([128, 64], |_, _| 0.0),
        ] {
            assert_eq!(seam(&other), None);
        }
    }

    #[test]
    fn pixels_that_are_no_number_do_not_matter() {
        let mut photo = photo([64, 32], world);
        photo.pixels[64 * 5] = [f32::NAN, -1.0, f32::INFINITY, 1.0];
        assert!(is_panorama(&photo));
    }
}
