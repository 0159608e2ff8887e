//! From pixels to the finest lattice of the stereographic image, and back.
//!
//! Pixels are scattered points there. Several values travel together: three channels by as many powers of the depth, as lanes.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::model::Model;
use crate::veil::simd::Plane;

/// Rows of pixels that a thread scatters at a time, into a part of the lattice of its own.
const BAND: usize = 48;

/// A pixel on the image.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Entry {
    /// In cells from the first column and row.
    pub at: [f32; 2],
    /// −ln(1 + |a|²) above half the middle of pairs' depths.
    pub depth: f32,
    /// The solid angle times 1 + |a|².
    pub weight: f32,
    /// √ of the solid angle.
    pub root: f32,
    /// What the image and the constant return of the pixel's own light.
    pub own: f32,
}

/// The upper left quarter of the picture: the others are its mirror images.
#[derive(Debug, Clone)]
pub(in crate::veil) struct Table {
    size: [usize; 2],
    columns: usize,
    entries: Vec<Entry>,
    /// From the first column and row to the last, in cells: whole numbers.
    length: [f32; 2],
    /// For each band of pixels, the lattice's rows that it meets.
    bands: Vec<[usize; 2]>,
}

impl Entry {
    /// 1 + |a|².
    #[inline(always)]
    pub fn growth(&self) -> f32 {
        self.weight / (self.root * self.root)
    }
}

impl Table {
    pub fn new(model: &Model) -> Self {
        let size = model.camera.size;
        let [columns, rows] = size.map(|side| side.div_ceil(2));
        let entry = |index: usize| {
            let point = model.camera.point((index % columns) as f64, (index / columns) as f64);
            let at = [0, 1].map(|side| ((point.at[side] - model.first[side]) / model.cell) as f32);
            let own = point.solid_angle * model.own(point.depth, at.map(f64::from));
            Entry {
                at,
                depth: (point.depth - 0.5 * model.depths.middle) as f32,
                weight: (point.solid_angle * (-point.depth).exp()) as f32,
                root: point.solid_angle.sqrt() as f32,
                own: own as f32,
            }
        };
        let entries: Vec<Entry> = (0..columns * rows).into_par_iter().with_min_len(4096).map(entry).collect();
        let length = model.first.map(|first| (-2.0 * first / model.cell).round() as f32);
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
                entry.at[side] = self.length[side] - entry.at[side];
            }
        }
        entry
    }

    /// All pixels of a row.
    pub fn row(&self, y: usize, row: &mut Vec<Entry>) {
        let v = y.min(self.size[1] - 1 - y);
        let quarter = &self.entries[v * self.columns..][..self.columns];
        row.clear();
        row.extend_from_slice(quarter);
        let mirrored = quarter[..self.size[0] - self.columns].iter().rev();
        row.extend(mirrored.map(|entry| Entry { at: [self.length[0] - entry.at[0], entry.at[1]], ..*entry }));
        if v != y {
            row.iter_mut().for_each(|entry| entry.at[1] = self.length[1] - entry.at[1]);
        }
    }

    /// The largest that is returned of a pixel's own light.
    pub fn own_largest(&self) -> f64 {
        f64::from(self.entries.iter().map(|entry| entry.own).fold(0.0, f32::max))
    }

    fn band(&self, band: usize, points: usize) -> [usize; 2] {
        let rows = band * BAND..((band + 1) * BAND).min(self.size[1]);
        let [mut least, mut largest] = [f32::INFINITY, 0.0f32];
        let mut row = Vec::new();
        for y in [rows.start, rows.end - 1] {
            self.row(y, &mut row);
            (least, largest) = row
                .iter()
                .fold((least, largest), |(least, largest), entry| (least.min(entry.at[1]), largest.max(entry.at[1])));
        }
        [least as usize, (largest as usize + 4).min(points)]
    }
}

/// β at the four points around `t`: the first of them, and the values.
#[inline(always)]
fn weights(t: f32) -> (usize, [f32; 4]) {
    let base = t as usize;
    let f = t - base as f32;
    let (g, square) = (1.0 - f, f * f);
    let sixth = 1.0 / 6.0;
    let inner = sixth * (4.0 - 3.0 * square * (2.0 - f));
    let first = sixth * g * g * g;
    let last = sixth * square * f;
    (base, [first, inner, 1.0 - first - inner - last, last])
}

/// Scatters light into `planes`, channel by channel for each power of the depth, by way of `parts` of the lattice.
pub(super) fn scatter<const N: usize>(
    arch: Arch,
    table: &Table,
    lights: [&Plane<f32>; 3],
    parts: &mut Vec<Vec<f32>>,
    planes: [Vec<&mut Plane<f32>>; 3],
) {
    let columns = planes[0][0].width();
    parts.resize_with(table.bands.len(), Vec::new);
    parts.par_iter_mut().zip(&table.bands).enumerate().for_each(|(band, (part, [first, end]))| {
        part.clear();
        part.resize((end - first) * columns * N, 0.0);
        let rows = [band * BAND, ((band + 1) * BAND).min(table.size[1])];
        arch.dispatch(Splat::<N> { table, lights, rows, first: *first, columns, part: part.as_chunks_mut().0 });
    });
    for (channel, planes) in planes.into_iter().enumerate() {
        for (power, plane) in planes.into_iter().enumerate() {
            plane.par_rows_mut().enumerate().for_each(|(row, out)| {
                let out = &mut out[..columns];
                out.fill(0.0);
                for (part, [first, end]) in parts.iter().zip(&table.bands) {
                    if (*first..*end).contains(&row) {
                        let values = &part.as_chunks::<N>().0[(row - first) * columns..][..columns];
                        out.iter_mut().zip(values).for_each(|(out, value)| *out += value[3 * power + channel]);
                    }
                }
            });
        }
    }
}

struct Splat<'a, const N: usize> {
    table: &'a Table,
    lights: [&'a Plane<f32>; 3],
    rows: [usize; 2],
    first: usize,
    columns: usize,
    part: &'a mut [[f32; N]],
}

impl<const N: usize> WithSimd for Splat<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { table, lights, rows, first, columns, part } = self;
        let mut entries = Vec::with_capacity(table.size[0]);
        for y in rows[0]..rows[1] {
            let light = lights.map(|light| &light.row(y)[..table.size[0]]);
            table.row(y, &mut entries);
            for (x, entry) in entries.iter().enumerate() {
                let light = light.map(|light| light[x]);
                if light == [0.0; 3] {
                    continue;
                }
                let mut lanes = [0.0; N];
                let mut factor = entry.weight;
                for power in 0..N / 3 {
                    for channel in 0..3 {
                        lanes[3 * power + channel] = factor * light[channel];
                    }
                    factor *= entry.depth;
                }
                let ((column, across), (row, down)) = (weights(entry.at[0]), weights(entry.at[1]));
                for (index, down) in down.into_iter().enumerate() {
                    let cells = &mut part[(row - first + index) * columns + column..][..4];
                    for (cell, across) in cells.iter_mut().zip(across) {
                        let weight = down * across;
                        for (cell, lane) in cell.iter_mut().zip(lanes) {
                            *cell = fused::<S>(weight, lane, *cell);
                        }
                    }
                }
            }
        }
    }
}

/// a b + c, rounded once where the processor can.
#[inline(always)]
fn fused<S: Simd>(a: f32, b: f32, c: f32) -> f32 {
    if S::IS_SCALAR { a * b + c } else { a.mul_add(b, c) }
}

/// The lattice with its lanes side by side.
pub(super) fn interleave<const N: usize>(planes: [&[&Plane<f32>]; 3], lattice: &mut Vec<f32>) {
    let (columns, rows) = (planes[0][0].width(), planes[0][0].height());
    lattice.resize(columns * rows * N, 0.0);
    lattice.par_chunks_mut(columns * N).enumerate().for_each(|(row, out)| {
        for (channel, planes) in planes.iter().enumerate() {
            for (power, plane) in planes.iter().enumerate() {
                let out = out.as_chunks_mut::<N>().0.iter_mut();
                out.zip(plane.row(row)).for_each(|(out, value)| out[3 * power + channel] = *value);
            }
        }
    });
}

/// What the lattice comes to along a row of pixels, with the target's factors.
pub(super) struct Gather<'a, const N: usize> {
    pub entries: &'a [Entry],
    pub lattice: &'a [[f32; N]],
    pub columns: usize,
    pub out: [&'a mut [f32]; 3],
}

impl<const N: usize> WithSimd for Gather<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { entries, lattice, columns, out } = self;
        for (x, entry) in entries.iter().enumerate() {
            let ((column, across), (row, down)) = (weights(entry.at[0]), weights(entry.at[1]));
            let mut lanes = [0.0; N];
            for (index, down) in down.into_iter().enumerate() {
                let cells = &lattice[(row + index) * columns + column..][..4];
                let mut along = [0.0; N];
                for (cell, across) in cells.iter().zip(across) {
                    for (along, cell) in along.iter_mut().zip(cell) {
                        *along = fused::<S>(across, *cell, *along);
                    }
                }
                for (lane, along) in lanes.iter_mut().zip(along) {
                    *lane = fused::<S>(down, along, *lane);
                }
            }
            let mut sums = [0.0; 3];
            let mut factor = entry.growth();
            for power in 0..N / 3 {
                for channel in 0..3 {
                    sums[channel] += factor * lanes[3 * power + channel];
                }
                factor *= entry.depth;
            }
            for channel in 0..3 {
                out[channel][x] += sums[channel];
            }
        }
    }
}
