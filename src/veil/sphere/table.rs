//! Where a picture's pixels are on the lattice, and how they count.

use rayon::prelude::*;

use super::model::Model;

/// Rows of pixels that a thread scatters at a time, into a part of the lattice of its own.
pub(super) const BAND: usize = 48;

/// A pixel on the image.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Entry {
    /// The lattice's column and row before it.
    pub cell: [u32; 2],
    /// How far after them it is, from 0 to 1.
    pub phase: [f32; 2],
    /// 1 + |a|² to the first group's power.
    pub growth: f32,
    /// √ of the solid angle.
    pub root: f32,
    /// What the image and the constant return of the pixel's own light.
    pub own: f32,
}

/// The upper left quarter of the picture: the others are its mirror images.
#[derive(Debug, Clone)]
pub(in crate::veil) struct Table {
    pub size: [usize; 2],
    columns: usize,
    entries: Vec<Entry>,
    /// From the first column and row to the last, in cells.
    length: [u32; 2],
    /// For each band of pixels, the lattice's rows that it meets.
    pub bands: Vec<[usize; 2]>,
}

impl Entry {
    /// Seen in a mirror that turns columns or rows of so many cells.
    #[inline(always)]
    fn mirrored(mut self, side: usize, length: u32) -> Self {
        // A pixel on the last point would have no cell after it: it is the end of the one before.
        let before = u32::from(self.cell[side] < length);
        self.phase[side] = before as f32 - self.phase[side];
        self.cell[side] = length - self.cell[side] - before;
        self
    }
}

impl Table {
    pub fn new(model: &Model) -> Self {
        let size = model.camera.size;
        let [columns, rows] = size.map(|side| side.div_ceil(2));
        let own = model.own();
        let entry = |index: usize| {
            let point = model.camera.point((index % columns) as f64, (index / columns) as f64);
            let at = [0, 1].map(|side| ((point.at[side] - model.first[side]) / model.cell).max(0.0));
            Entry {
                cell: at.map(|at| at as u32),
                phase: at.map(|at| at.fract() as f32),
                growth: (-point.depth * model.first_power()).exp() as f32,
                root: point.solid_angle.sqrt() as f32,
                own: (point.solid_angle * own.at(point.depth, at)) as f32,
            }
        };
        let entries: Vec<Entry> = (0..columns * rows).into_par_iter().with_min_len(4096).map(entry).collect();
        let length = model.first.map(|first| (-2.0 * first / model.cell).round() as u32);
        let mut table = Self { size, columns, entries, length, bands: Vec::new() };
        let points = model.points()[1];
        table.bands = (0..size[1].div_ceil(BAND)).map(|band| table.band(band, points)).collect();
        table
    }

    /// A pixel.
    pub fn entry(&self, x: usize, y: usize) -> Entry {
        let [u, v] = [(x, 0), (y, 1)].map(|(at, side)| at.min(self.size[side] - 1 - at));
        let mut entry = self.entries[v * self.columns + u];
        for (side, turned) in [u != x, v != y].into_iter().enumerate() {
            if turned {
                entry = entry.mirrored(side, self.length[side]);
            }
        }
        entry
    }

    /// The pixels of a row.
    #[inline(always)]
    pub fn row(&self, y: usize) -> Row<'_> {
        let v = y.min(self.size[1] - 1 - y);
        let quarter = &self.entries[v * self.columns..][..self.columns];
        Row { quarter, last: self.size[0] - 1, turned: v != y, length: self.length }
    }

    /// The largest that is returned of a pixel's own light.
    pub fn own_largest(&self) -> f64 {
        f64::from(self.entries.iter().map(|entry| entry.own).fold(0.0, f32::max))
    }

    fn band(&self, band: usize, points: usize) -> [usize; 2] {
        let rows = band * BAND..((band + 1) * BAND).min(self.size[1]);
        let [mut least, mut largest] = [u32::MAX, 0];
        for y in [rows.start, rows.end - 1] {
            for x in 0..self.size[0] {
                let [_, row] = self.row(y).at(x).cell;
                (least, largest) = (least.min(row), largest.max(row));
            }
        }
        [least as usize, (largest as usize + 4).min(points)]
    }
}

/// The pixels of a row.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    quarter: &'a [Entry],
    /// The last column.
    last: usize,
    turned: bool,
    length: [u32; 2],
}

impl Row<'_> {
    /// The pixel of a column.
    #[inline(always)]
    pub fn at(&self, x: usize) -> Entry {
        let mut entry = self.quarter[x.min(self.last - x)];
        if x >= self.quarter.len() {
            entry = entry.mirrored(0, self.length[0]);
        }
        if self.turned { entry.mirrored(1, self.length[1]) } else { entry }
    }
}
