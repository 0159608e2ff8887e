//! Parts of a photo, and where the light of each lies.

use std::sync::Arc;

use glam::DVec2;
use ndarray::parallel::prelude::*;
use ndarray::{Array2, Axis};

use super::Raster;
use crate::frame::Window;

/// What a part of a photo gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cell {
    /// Flux, all colours together.
    pub light: f64,
    /// Where that is on average, in the unit of lengths; the middle of a dark one.
    pub place: DVec2,
}

impl Raster {
    /// Of some of its pixels; `window` lies in that of its frame.
    ///
    /// # Panics
    /// For a window that does not.
    pub(crate) fn part(&self, window: Window) -> Arc<Self> {
        let whole = self.frame.window;
        let [x, y] = [window.x - whole.x, window.y - whole.y].map(|side| usize::try_from(side).expect("within it"));
        let [width, height] = [window.width, window.height].map(|side| side as usize);
        let scale = self.channels.each_ref().map(|channel| 2f64.powi(-channel.exponent));
        let light = |row: usize, column: usize| {
            let [r, g, b] = [0, 1, 2].map(|c| (f64::from(self.channels[c].plane.row(row)[column]) * scale[c]) as f32);
            [r, g, b, 1.0]
        };
        let rows = (y..y + height).into_par_iter();
        let pixels: Vec<[f32; 4]> =
            rows.flat_map_iter(|row| (x..x + width).map(move |column| light(row, column))).collect();
        Self::new(&pixels, self.frame.with_window(window)).expect("as many pixels as the window has")
    }

    /// Its pixels in squares of `side` by `side`, row by row from the top; those at the right and the lower end may be smaller.
    pub(crate) fn cells(&self, side: usize) -> Array2<Cell> {
        let [width, height] = self.size();
        let places = self.places();
        let mut cells =
            Array2::from_elem((height.div_ceil(side), width.div_ceil(side)), Cell { light: 0.0, place: DVec2::ZERO });
        cells.axis_iter_mut(Axis(0)).into_par_iter().enumerate().for_each(|(row, mut cells)| {
            let rows = row * side..((row + 1) * side).min(height);
            for (column, cell) in cells.iter_mut().enumerate() {
                let columns = column * side..((column + 1) * side).min(width);
                // Light, and its moments from the middle of the photo.
                let (mut light, mut moments) = (0.0, DVec2::ZERO);
                for (y, c) in rows.clone().flat_map(|y| (0..3).map(move |c| (y, c))) {
                    let row = &self.channels[c].plane.row(y)[columns.clone()];
                    let (mut sum, mut moment) = (0.0, 0.0);
                    for (value, x) in row.iter().zip(&places.from_middle[0][columns.clone()]) {
                        sum += f64::from(*value);
                        moment += f64::from(*value) * x;
                    }
                    light += self.factors[c] * sum;
                    moments += self.factors[c] * DVec2::new(moment, sum * places.from_middle[1][y]);
                }
                let between = |axis: usize, range: &std::ops::Range<usize>| {
                    0.5 * (places.from_middle[axis][range.start] + places.from_middle[axis][range.end - 1])
                };
                let middle = || DVec2::new(between(0, &columns), between(1, &rows));
                let place = places.middle + if light > 0.0 { moments / light } else { middle() };
                *cell = Cell { light, place };
            }
        });
        cells
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Frame;

    fn photo() -> (Frame, Vec<[f32; 4]>) {
        let frame = Frame::full(37, 21);
        let pixel = |k: u32| [k % 7, k % 5, k % 3].map(|value| 1e-3 * value as f32);
        let pixels = (0..37 * 21).map(|k| [pixel(k)[0], pixel(k)[1], pixel(k)[2] + 4.0 * (k == 100) as u8 as f32, 1.0]);
        (frame, pixels.collect())
    }

    #[test]
    fn parts_are_the_pixels_at_their_places() {
        let (frame, pixels) = photo();
        let raster = Raster::new(&pixels, frame).unwrap();
        let window = frame.window.part(5, 3, 20, 11);
        let part = raster.part(window);
        let inside = |k: &usize| (5..25).contains(&(k % 37)) && (3..14).contains(&(k / 37));
        let wanted: Vec<[f32; 4]> = (0..pixels.len()).filter(inside).map(|k| pixels[k]).collect();
        assert!(*part == *Raster::new(&wanted, frame.with_window(window)).unwrap());
        assert_eq!(part.places().from_middle[0].len(), 20);
        let at = part.places().middle.x + part.places().from_middle[0][0];
        assert!((at - frame.x(5.0)).abs() < 1e-12);
    }

    #[test]
    fn cells_hold_all_of_the_light_where_it_is() {
        let (frame, pixels) = photo();
        let raster = Raster::new(&pixels, frame).unwrap();
        let area = frame.pixel_sides().element_product();
        for side in [1, 5, 8, 64] {
            let cells = raster.cells(side);
            let (mut light, mut moments) = (0.0, DVec2::ZERO);
            for cell in &cells {
                (light, moments) = (light + cell.light, moments + cell.light * cell.place);
            }
            let (mut wanted, mut wanted_moments) = (0.0, DVec2::ZERO);
            for (k, [r, g, b, _]) in pixels.iter().enumerate() {
                let here = area * f64::from(r + g + b);
                wanted += here;
                wanted_moments += here * frame.position((k % 37) as f64, (k / 37) as f64);
            }
            assert!((light / wanted - 1.0).abs() < 1e-6, "{side}: {light} {wanted}");
            assert!((moments - wanted_moments).length() < 1e-6 * wanted, "{side}: {moments} {wanted_moments}");
        }
        // A dark photo's cells are where they lie.
        let dark = Raster::new(&vec![[0.0; 4]; 37 * 21], frame).unwrap();
        assert_eq!(dark.cells(64)[(0, 0)], Cell { light: 0.0, place: DVec2::ZERO });
    }
}
