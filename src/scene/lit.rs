//! The pixels of a photo as light, without its fireflies.
//!
//! A firefly is one pixel that outshines each of its eight neighbours by far: a path that a renderer's sampling met once,
//! or a hot pixel of a sensor. What a lens has drawn is never like that, since it spreads a point over several pixels;
//! nor is a small light in a picture made smaller, as long as its pixels are means.

use std::ops::Range;

use rayon::prelude::*;

use super::emission::Emission;

/// A photo's pixels, row by row.
#[derive(Clone, Copy)]
pub(super) struct Lit<'a> {
    pixels: &'a [[f32; 4]],
    /// Pixels in a row, not 0.
    width: usize,
    emission: Emission,
    /// How many times as bright as its brightest neighbour a pixel may be; infinite for whatever it likes.
    limit: f32,
}

impl<'a> Lit<'a> {
    /// `limit` is 0 where every pixel is taken as it is.
    pub fn new(pixels: &'a [[f32; 4]], width: usize, emission: Emission, limit: f64) -> Self {
        let limit = if limit > 0.0 { limit as f32 } else { f32::INFINITY };
        Self { pixels, width: width.max(1), emission, limit }
    }

    /// All pixels, fireflies too.
    pub fn pixels(&self) -> &'a [[f32; 4]] {
        self.pixels
    }

    /// Pixels in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// How they give light.
    pub fn emission(&self) -> Emission {
        self.emission
    }

    /// Rows in bands of about 2¹⁷ pixels, as ranges of rows; they depend on the picture alone.
    pub fn bands(&self) -> impl IndexedParallelIterator<Item = Range<usize>> {
        let (rows, height) = (((1 << 17) / self.width).max(1), self.pixels.len() / self.width);
        (0..height.div_ceil(rows)).into_par_iter().map(move |band| band * rows..((band + 1) * rows).min(height))
    }

    /// Calls `each(column, luminance)` for the pixels of a row from the left; that of a firefly is 0.
    pub fn each(&self, row: usize, mut each: impl FnMut(usize, f32)) {
        // Nearly every pixel fails to outshine the one before it, which costs nothing to find out.
        let mut before = f32::NEG_INFINITY;
        for (column, pixel) in self.pixels[row * self.width..][..self.width].iter().enumerate() {
            let luminance = self.emission.luminance(pixel);
            let firefly = luminance > self.limit * before && self.is_firefly(column, row, luminance);
            each(column, if firefly { 0.0 } else { luminance });
            before = luminance;
        }
    }

    /// Whether a pixel of this luminance outshines all its neighbours, of which it has at least one.
    pub fn is_firefly(&self, column: usize, row: usize, luminance: f32) -> bool {
        if luminance <= 0.0 || self.limit.is_infinite() || self.pixels.len() == 1 {
            return false;
        }
        let rows = row.saturating_sub(1)..(row + 2).min(self.pixels.len() / self.width);
        let columns = column.saturating_sub(1)..(column + 2).min(self.width);
        rows.flat_map(|j| columns.clone().map(move |i| (i, j)))
            .filter(|&at| at != (column, row))
            .all(|(i, j)| luminance > self.limit * self.emission.luminance(&self.pixels[j * self.width + i]))
    }

    /// What a threshold leaves out, and how bright the rest is.
    pub fn survey(&self, threshold: f32) -> Survey {
        let of_band = |rows: Range<usize>| {
            let mut survey = Survey::default();
            for row in rows {
                let mut before = f32::NEG_INFINITY;
                for (column, pixel) in self.pixels[row * self.width..][..self.width].iter().enumerate() {
                    let luminance = self.emission.luminance(pixel);
                    if !(luminance > self.limit * before && self.is_firefly(column, row, luminance)) {
                        survey.peak = survey.peak.max(luminance);
                    } else if luminance >= threshold {
                        survey.fireflies += 1;
                        survey.first = survey.first.or(Some((column, row)));
                    }
                    before = luminance;
                }
            }
            survey
        };
        let bands: Vec<_> = self.bands().map(of_band).collect();
        bands.into_iter().fold(Survey::default(), |all, band| Survey {
            fireflies: all.fireflies + band.fireflies,
            first: all.first.or(band.first),
            peak: all.peak.max(band.peak),
        })
    }
}

/// What is known of a photo's pixels beside its lights.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Survey {
    /// Fireflies that would be light.
    pub fireflies: usize,
    /// Column and row of the first.
    pub first: Option<(usize, usize)>,
    /// The largest luminance, fireflies left out.
    pub peak: f32,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fireflies of a picture of these luminances beyond a limit of 10.
    fn fireflies(width: usize, luminances: &[f32]) -> (usize, Option<(usize, usize)>) {
        let pixels: Vec<_> = luminances.iter().map(|&l| [l, l, l, 1.0]).collect();
        let survey = Lit::new(&pixels, width, [0.25, 0.5, 0.25].into(), 10.0).survey(0.5);
        (survey.fireflies, survey.first)
    }

    #[test]
    fn a_firefly_outshines_all_its_neighbours() {
        assert_eq!(fireflies(3, &[1.0, 1.0, 1.0, 1.0, 10.5, 1.0, 1.0, 1.0, 1.0]), (1, Some((1, 1))));
        assert_eq!(fireflies(3, &[1.0, 1.0, 1.0, 1.0, 10.0, 1.0, 1.0, 1.0, 1.0]), (0, None));
        for neighbour in [0, 1, 2, 3, 5, 6, 7, 8] {
            let mut luminances = [1.0; 9];
            (luminances[4], luminances[neighbour]) = (50.0, 5.0);
            assert_eq!(fireflies(3, &luminances), (0, None), "{neighbour}");
        }
    }

    #[test]
    fn it_may_be_on_the_edge_and_is_none_alone() {
        assert_eq!(fireflies(3, &[50.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 50.0]), (2, Some((0, 0))));
        assert_eq!(fireflies(1, &[1.0, 50.0, 1.0]), (1, Some((0, 1))));
        // The pixel before, in the row above, is no neighbour.
        assert_eq!(fireflies(3, &[1.0, 1.0, 50.0, 1.0, 1.0, 1.0, 50.0, 1.0, 1.0]), (2, Some((2, 0))));
        assert_eq!(fireflies(1, &[50.0]), (0, None));
        assert_eq!(fireflies(2, &[0.0; 4]), (0, None));
    }

    #[test]
    fn rows_have_the_luminance_of_all_but_fireflies() {
        let pixels: Vec<_> = [0.0, 7.0, 0.0, 3.0, 3.0, 90.0].map(|l: f32| [l, l, l, 1.0]).to_vec();
        let row = |limit: f64| {
            let mut row = Vec::new();
            Lit::new(&pixels, 6, [0.25, 0.5, 0.25].into(), limit).each(0, |_, luminance| row.push(luminance));
            row
        };
        assert_eq!(row(0.0), [0.0, 7.0, 0.0, 3.0, 3.0, 90.0]);
        assert_eq!(row(20.0), [0.0, 0.0, 0.0, 3.0, 3.0, 0.0]);
        let survey = |threshold| Lit::new(&pixels, 6, [0.25, 0.5, 0.25].into(), 20.0).survey(threshold);
        assert_eq!(survey(0.0), Survey { fireflies: 2, first: Some((1, 0)), peak: 3.0 });
        assert_eq!(survey(8.0), Survey { fireflies: 1, first: Some((5, 0)), peak: 3.0 });
    }
}
