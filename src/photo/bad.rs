//! Counts the pixels that are no light: NaN, infinite, negative. What becomes of them: see [`super`].

use rayon::prelude::*;

use super::Photo;

/// How many pixels have a colour channel that is NaN, infinite or negative; a pixel may count in all three.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BadPixels {
    /// Pixels with a NaN.
    pub nan: usize,
    /// Pixels with +∞ or −∞.
    pub infinite: usize,
    /// Pixels with a finite value below zero.
    pub negative: usize,
    /// Column and row in the picture of the first pixel with any of these, and its worst kind.
    pub first: Option<(i32, i32, BadKind)>,
}

/// What is wrong with a pixel, the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BadKind {
    /// A channel is NaN.
    Nan,
    /// A channel is infinite.
    Infinite,
    /// A channel is finite and negative.
    Negative,
}

impl BadPixels {
    /// Whether no pixel is NaN, infinite or negative.
    pub fn is_clean(&self) -> bool {
        self.first.is_none()
    }

    fn add(mut self, later: Self) -> Self {
        self.nan += later.nan;
        self.infinite += later.infinite;
        self.negative += later.negative;
        self.first = self.first.or(later.first);
        self
    }
}

/// How many of the pixels have a colour channel that is NaN or infinite; alpha does not count.
pub(crate) fn not_finite(pixels: &[[f32; 4]]) -> usize {
    let count = |row: &[[f32; 4]]| {
        row.iter().filter(|[r, g, b, _]| !(r + g + b).is_finite() && ![r, g, b].iter().all(|c| c.is_finite())).count()
    };
    pixels.par_chunks(1 << 14).map(count).sum()
}

/// Counts the bad pixels of a photo; alpha does not count.
pub fn survey(photo: &Photo) -> BadPixels {
    let window = photo.frame.window;
    let rows = photo.pixels.par_chunks_exact((window.width as usize).max(1)).enumerate();
    // rayon keeps the order, so that the first pixel is the first by row and column.
    rows.map(|(row, pixels)| survey_row(pixels, window.x, window.y + row as i32))
        .reduce(BadPixels::default, BadPixels::add)
}

fn survey_row(pixels: &[[f32; 4]], x: i32, y: i32) -> BadPixels {
    let mut bad = BadPixels::default();
    for (column, &[r, g, b, _]) in pixels.iter().enumerate() {
        if [r, g, b].iter().all(|c| c.is_finite() && *c >= 0.0) {
            continue;
        }
        let nan = [r, g, b].iter().any(|c| c.is_nan());
        let infinite = [r, g, b].iter().any(|c| c.is_infinite());
        bad.nan += usize::from(nan);
        bad.infinite += usize::from(infinite);
        bad.negative += usize::from([r, g, b].iter().any(|c| c.is_finite() && *c < 0.0));
        let kind = match (nan, infinite) {
            (true, _) => BadKind::Nan,
            (_, true) => BadKind::Infinite,
            _ => BadKind::Negative,
        };
        bad.first = bad.first.or(Some((x + column as i32, y, kind)));
    }
    bad
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_that_are_not_finite_are_counted_once_and_large_ones_are_finite() {
        let most = f32::MAX;
        let pixels = [
            [most, most, -most, f32::NAN],
            [f32::NAN, f32::INFINITY, 0.0, 1.0],
            [0.0, 0.0, f32::NEG_INFINITY, 1.0],
            [f32::INFINITY, f32::NEG_INFINITY, 1.0, 1.0],
        ];
        assert_eq!(not_finite(&pixels), 3);
    }

    #[test]
    fn each_kind_is_counted_and_the_first_is_told() {
        let mut pixels = vec![[0.5, -0.0, 1e30, 1.0]; 6];
        assert!(survey(&Photo::new(3, 2, pixels.clone())).is_clean(), "negative zero and alpha are fine");
        pixels[2] = [0.0, -1e-9, 0.0, f32::NAN];
        pixels[4] = [f32::NAN, f32::INFINITY, -1.0, 1.0];
        pixels[5] = [f32::NEG_INFINITY, 0.0, 0.0, 1.0];
        let mut photo = Photo::new(3, 2, pixels);
        photo.frame.window.x = -1;
        let bad = survey(&photo);
        assert_eq!((bad.nan, bad.infinite, bad.negative), (1, 2, 2));
        assert_eq!(bad.first, Some((1, 0, BadKind::Negative)));
    }
}
