//! The pixels of a photo as light, without its fireflies.
//!
//! A firefly is one pixel that outshines each of its eight neighbours by far: a path that a renderer's sampling met once,
//! or a hot pixel of a sensor. What a lens has drawn is never like that, since it spreads a point over several pixels;
//! nor is a small light in a picture made smaller, as long as its pixels are means. A pixel that has nearly all of the
//! photo's light is what the photo shows, and none, unless something else stands out from the rest.

use std::ops::Range;

use rayon::prelude::*;

use super::emission::{Emission, is_light};

/// A pixel with so many times the light of all that are no fireflies is a lamp in the dark.
const ALL_THE_LIGHT: f64 = 100.0;

/// What is so many times as bright as the mean of these is a lamp, too, beside which no other is to be looked for.
const STANDS_OUT: f64 = 16.0;

/// A photo's pixels, row by row.
pub(super) struct Lit<'a> {
    pixels: &'a [[f32; 4]],
    /// Pixels in a row, not 0.
    width: usize,
    emission: Emission,
    /// Indices of pixels, in order.
    fireflies: Vec<usize>,
    peak: f32,
}

/// What is seen of some rows, fireflies apart.
#[derive(Default)]
struct Seen {
    /// Pixels that outshine their neighbours, in order, with their brightness.
    alone: Vec<(usize, f32)>,
    /// The brightness of all others.
    sum: f64,
    peak: f32,
}

impl<'a> Lit<'a> {
    /// A pixel may be `limit` times as bright as its brightest neighbour; 0 takes every pixel as it is.
    pub fn new(pixels: &'a [[f32; 4]], width: usize, emission: Emission, limit: f64) -> Self {
        let mut lit = Self { pixels, width: width.max(1), emission, fireflies: Vec::new(), peak: 0.0 };
        let limit = if limit > 0.0 { limit as f32 } else { f32::INFINITY };
        let bands: Vec<Seen> = lit.bands().map(|rows| lit.see(rows, limit)).collect();
        let sum: f64 = bands.iter().map(|seen| seen.sum).sum();
        lit.peak = bands.iter().fold(0.0, |peak, seen| seen.peak.max(peak));
        let has_lamp = f64::from(lit.peak) * pixels.len() as f64 > STANDS_OUT * sum;
        let dark = if has_lamp { f64::INFINITY } else { sum * ALL_THE_LIGHT };
        for &(index, brightness) in bands.iter().flat_map(|seen| &seen.alone) {
            if f64::from(brightness) > dark {
                lit.peak = lit.peak.max(brightness);
            } else {
                lit.fireflies.push(index);
            }
        }
        lit
    }

    /// The same with other light in its pixels; a firefly stays one, and the peak is that of before.
    pub fn shining(self, pixels: &'a [[f32; 4]]) -> Self {
        Self { pixels, ..self }
    }

    fn see(&self, rows: Range<usize>, limit: f32) -> Seen {
        let mut seen = Seen::default();
        for row in rows {
            // Nearly every pixel fails to outshine the one before it, which costs nothing to find out.
            let mut before = f32::NEG_INFINITY;
            for (column, pixel) in self.row(row).iter().enumerate() {
                let brightness = self.emission.brightness(pixel);
                if brightness > limit * before && self.outshines(column, row, brightness, limit) {
                    seen.alone.push((row * self.width + column, brightness));
                } else {
                    seen.sum += f64::from(brightness);
                    seen.peak = seen.peak.max(brightness);
                }
                before = brightness;
            }
        }
        seen
    }

    /// Whether a pixel of this brightness outshines all its neighbours, of which it has at least one.
    fn outshines(&self, column: usize, row: usize, brightness: f32, limit: f32) -> bool {
        if brightness <= 0.0 || limit.is_infinite() || self.pixels.len() == 1 {
            return false;
        }
        let rows = row.saturating_sub(1)..(row + 2).min(self.pixels.len() / self.width);
        let columns = column.saturating_sub(1)..(column + 2).min(self.width);
        rows.flat_map(|j| columns.clone().map(move |i| (i, j)))
            .filter(|&at| at != (column, row))
            .all(|(i, j)| brightness > limit * self.emission.brightness(&self.pixels[j * self.width + i]))
    }

    fn row(&self, row: usize) -> &'a [[f32; 4]] {
        &self.pixels[row * self.width..][..self.width]
    }

    /// How bright a pixel is, by column and row; a firefly is not.
    pub fn brightness(&self, [column, row]: [usize; 2]) -> f32 {
        let at = row * self.width + column;
        if self.fireflies.binary_search(&at).is_ok() { 0.0 } else { self.emission.brightness(&self.pixels[at]) }
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

    /// Calls `each(column, brightness)` for the pixels of a row from the left; that of a firefly is 0.
    pub fn each(&self, row: usize, mut each: impl FnMut(usize, f32)) {
        let start = row * self.width;
        let mut fireflies = self.fireflies[self.fireflies.partition_point(|&index| index < start)..].iter().peekable();
        for (column, pixel) in self.row(row).iter().enumerate() {
            let is_firefly = fireflies.next_if(|&&index| index == start + column).is_some();
            each(column, if is_firefly { 0.0 } else { self.emission.brightness(pixel) });
        }
    }

    /// Fireflies of at least this brightness: columns and rows, in the order of the pixels.
    pub fn fireflies(&self, threshold: f32) -> Vec<(usize, usize)> {
        let bright = |&&index: &&usize| is_light(self.emission.brightness(&self.pixels[index]), threshold);
        self.fireflies.iter().filter(bright).map(|index| (index % self.width, index / self.width)).collect()
    }

    /// The largest brightness, fireflies left out; 0 where there is none.
    pub fn peak(&self) -> f32 {
        self.peak
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fireflies of a picture of these levels beyond a limit of 10.
    fn fireflies(width: usize, levels: &[f32]) -> Vec<(usize, usize)> {
        let pixels: Vec<_> = levels.iter().map(|&l| [l, l, l, 1.0]).collect();
        Lit::new(&pixels, width, [0.25, 0.5, 0.25].into(), 10.0).fireflies(0.5)
    }

    #[test]
    fn a_firefly_outshines_all_its_neighbours() {
        assert_eq!(fireflies(3, &[1.0, 1.0, 1.0, 1.0, 10.5, 1.0, 1.0, 1.0, 1.0]), [(1, 1)]);
        assert_eq!(fireflies(3, &[1.0, 1.0, 1.0, 1.0, 10.0, 1.0, 1.0, 1.0, 1.0]), []);
        for neighbour in [0, 1, 2, 3, 5, 6, 7, 8] {
            let mut levels = [1.0; 9];
            (levels[4], levels[neighbour]) = (50.0, 5.0);
            assert_eq!(fireflies(3, &levels), [], "{neighbour}");
        }
    }

    #[test]
    fn it_may_be_on_the_edge_and_is_none_alone() {
        assert_eq!(fireflies(3, &[50.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 50.0]), [(0, 0), (2, 2)]);
        assert_eq!(fireflies(1, &[1.0, 50.0, 1.0]), [(0, 1)]);
        assert_eq!(fireflies(1, &[50.0]), []);
    }

    #[test]
    fn a_lamp_in_the_dark_is_none() {
        let mut levels = [0.0; 100];
        levels[37] = 50.0;
        assert_eq!(fireflies(10, &levels), []);
        // The rest has a hundredth of its light, and a little more.
        (levels[90], levels[91]) = (0.3, 0.3);
        assert_eq!(fireflies(10, &levels), [(7, 3)]);
        let pixels: Vec<_> = levels.iter().map(|&l| [l, l, l, 1.0]).collect();
        let lit = Lit::new(&pixels, 10, [0.25, 0.5, 0.25].into(), 10.0);
        let mut seen = Vec::new();
        lit.each(3, |_, brightness| seen.push(brightness));
        assert_eq!((seen, lit.peak()), (vec![0.0; 10], 0.3));
    }

    #[test]
    fn a_firefly_in_the_dark_does_not_outdo_a_lamp() {
        // A lamp of four pixels, which have a thousandth of the firefly's light.
        let mut levels = [0.01; 400];
        levels[37] = 5e4;
        assert_eq!(fireflies(20, &levels), []);
        [200, 201, 220, 221].iter().for_each(|&lamp| levels[lamp] = 12.5);
        assert_eq!(fireflies(20, &levels), [(17, 1)]);
    }
}
