//! Photos in cd/m²: what reports and summaries tell of them.

use std::fmt;
use std::io::{self, Write};

use serde::Serialize;

use crate::photo::{LuminanceScale, Photo};
use crate::terminal::digits;

/// How bright a colour of a photo is: in cd/m² where that is known, else in the photo's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brightness {
    /// Of one of each colour.
    weights: [f64; 3],
    /// In words.
    pub unit: &'static str,
}

impl Brightness {
    /// By a photo's scale and its primaries.
    pub fn of(photo: &Photo) -> Self {
        match photo.luminance_scale() {
            Some(scale) => Self { weights: scale.weights, unit: "cd/m²" },
            None => Self { weights: photo.luminance_weights(), unit: "units of the photo" },
        }
    }

    /// Of a colour.
    pub fn at(&self, rgb: [f64; 3]) -> f64 {
        self.weights.iter().zip(rgb).map(|(weight, part)| weight * part).sum()
    }
}

/// The luminance of a picture in cd/m², of its pixels that are finite numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Extent {
    /// The mean.
    mean: f64,
    /// The largest.
    max: f64,
}

impl Extent {
    /// That of what a photo shows, and not of what is stored beyond it; none where no pixel is finite.
    pub fn of(photo: &Photo, scale: &LuminanceScale) -> Option<Self> {
        let (mut sum, mut count, mut max) = (0.0, 0_usize, f64::NEG_INFINITY);
        for row in 0..photo.height() {
            let row = photo.picture_row(row);
            for luminance in row.iter().map(|pixel| scale.of(pixel)).filter(|luminance| luminance.is_finite()) {
                (sum, count, max) = (sum + luminance, count + 1, max.max(luminance));
            }
        }
        (count > 0).then(|| Self { mean: sum / count as f64, max })
    }
}

impl fmt::Display for Extent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} on average, {} at most", digits(self.mean), digits(self.max))
    }
}

/// A line of a summary: what the numbers are, and some pictures by it.
///
/// # Errors
/// Where it cannot be written.
pub fn line(out: &mut dyn Write, scale: &LuminanceScale, pictures: [(&str, &Option<Extent>); 2]) -> io::Result<()> {
    write!(out, "cd/m²    {} of white, {}", digits(scale.cd_m2_per_unit), scale.from)?;
    for (name, extent) in pictures {
        extent.iter().try_for_each(|extent| write!(out, "; {name} {extent}"))?;
    }
    writeln!(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_extent_is_of_the_picture_and_of_finite_pixels() {
        let scale = LuminanceScale { cd_m2_per_unit: 100.0, from: "as given".into(), weights: [20.0, 70.0, 10.0] };
        let pixel = |value: f32| [value, value, value, 1.0];
        let photo = Photo::new(4, 1, vec![pixel(1.0), pixel(f32::NAN), pixel(4.0), [0.0, 1.0, f32::INFINITY, 1.0]]);
        let extent = Extent::of(&photo, &scale).unwrap();
        assert!((extent.mean - 250.0).abs() < 1e-12 && (extent.max - 400.0).abs() < 1e-12, "{extent:?}");
        assert_eq!(extent.to_string(), "250.0 on average, 400.0 at most");
        assert_eq!(Extent::of(&Photo::new(1, 1, vec![pixel(f32::NAN)]), &scale), None);
    }
}
