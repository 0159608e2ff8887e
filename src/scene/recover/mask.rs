//! Which pixels are clipped.

use rayon::prelude::*;

/// A pixel for each of a picture's, row by row.
pub(super) struct Mask {
    pub width: usize,
    pub pixels: Vec<bool>,
    /// Whether there is one that is clipped, for each row: most rows have none.
    rows: Vec<bool>,
}

/// Of the eight pixels about one that is nearly clipped so many have to be clipped, for it to be as well.
const ABOUT: usize = 5;

impl Mask {
    /// Of a picture's pixels, of which `clipped` tells those that are.
    pub fn new(pixels: &[[f32; 4]], width: usize, clipped: impl Fn(&[f32; 4]) -> bool + Sync + Send) -> Self {
        let pixels = pixels.par_iter().map(clipped).collect();
        Self::of(pixels, width)
    }

    /// Of a mask itself.
    pub fn of(pixels: Vec<bool>, width: usize) -> Self {
        let rows = pixels.par_chunks(width.max(1)).map(|row| row.contains(&true)).collect();
        Self { width, pixels, rows }
    }

    /// Whether nothing is clipped.
    pub fn is_empty(&self) -> bool {
        !self.rows.contains(&true)
    }

    /// The rows in which something is clipped.
    pub fn rows(&self) -> impl Iterator<Item = (usize, &[bool])> {
        let rows = self.pixels.chunks_exact(self.width.max(1)).enumerate();
        rows.zip(&self.rows).filter_map(|(row, clipped)| clipped.then_some(row))
    }

    /// Takes for clipped what is nearly so, and has clipped pixels about it.
    pub fn close(&mut self, nearly: impl Fn(&[f32; 4]) -> bool + Sync, pixels: &[[f32; 4]]) {
        let (width, height) = (self.width, self.rows.len());
        let about = |x: usize, y: usize| -> usize {
            let rows = y.saturating_sub(1)..(y + 2).min(height);
            let columns = x.saturating_sub(1)..(x + 2).min(width);
            rows.map(|j| self.pixels[j * width..][columns.clone()].iter().filter(|clipped| **clipped).count()).sum()
        };
        // A row without any has at most three about it above and three below.
        let of_row = |y: usize| {
            let row = y * width..(y + 1) * width;
            let is_in = |at: &usize| !self.pixels[*at] && nearly(&pixels[*at]) && about(at % width, y) >= ABOUT;
            row.filter(is_in).collect::<Vec<_>>()
        };
        let near = |y: &usize| self.rows[y.saturating_sub(1)..(y + 2).min(height)].contains(&true);
        let more: Vec<usize> = (0..height).into_par_iter().filter(near).flat_map_iter(of_row).collect();
        for at in more {
            self.pixels[at] = true;
            self.rows[at / width] = true;
        }
    }
}
