//! From pixels to the finest lattice of the stereographic image, and back.
//!
//! Pixels are scattered points there. The three channels travel together, as lanes.

use std::collections::HashSet;

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::table::{BAND, Table};
use crate::veil::simd::{Into, Plane};

/// A point of the lattice: three channels, and a lane that fills the vector.
pub(super) type Cell = [f32; 4];

/// β at the four points around `f`, from the one before it.
#[inline(always)]
fn weights(f: f32) -> [f32; 4] {
    let (g, square) = (1.0 - f, f * f);
    let sixth = 1.0 / 6.0;
    let inner = sixth * (4.0 - 3.0 * square * (2.0 - f));
    let first = sixth * g * g * g;
    let last = sixth * square * f;
    [first, inner, 1.0 - first - inner - last, last]
}

/// What a band of rows leaves besides the lattice.
pub(super) struct Sent<'a> {
    /// By channels: the light times √ of the solid angle, in rows that begin `margin` before the first pixel.
    pub near: [&'a mut [f32]; 3],
    pub stride: usize,
    pub margin: usize,
}

/// Scatters light into `planes` by way of `parts` of the lattice, one for each band, and into `near`, whose rows of pixels these are. Returns the
/// sums of light times solid angle.
pub(super) fn scatter(
    arch: Arch,
    table: &Table,
    lights: [&Plane<f32>; 3],
    parts: &mut Vec<Vec<Cell>>,
    planes: [&mut Plane<f32>; 3],
    (near, stride, margin): ([&mut [f32]; 3], usize, usize),
) -> [f64; 3] {
    let columns = planes[0].width();
    parts.resize_with(table.bands.len(), Vec::new);
    let [red, green, blue] = near.map(|near| near.chunks_mut(BAND * stride));
    let near = red.zip(green).zip(blue).take(table.bands.len());
    let mut sent: Vec<Sent> =
        near.map(|((red, green), blue)| Sent { near: [red, green, blue], stride, margin }).collect();
    let bands = parts.par_iter_mut().zip(&table.bands).zip(&mut sent).enumerate();
    let totals: Vec<[f64; 3]> = bands
        .map(|(band, ((part, [first, end]), sent))| {
            part.clear();
            part.resize((end - first) * columns, [0.0; 4]);
            let rows = [band * BAND, ((band + 1) * BAND).min(table.size[1])];
            arch.dispatch(Splat { table, lights, rows, first: *first, columns, part, sent })
        })
        .collect();
    let [red, green, blue] = planes;
    let rows = red.par_rows_mut().zip(green.par_rows_mut()).zip(blue.par_rows_mut()).enumerate();
    rows.for_each(|(row, ((red, green), blue))| {
        let mut out = [red, green, blue];
        let mut into = Into::Set;
        for (part, [first, end]) in parts.iter().zip(&table.bands) {
            if (*first..*end).contains(&row) {
                let cells = &part[(row - first) * columns..][..columns];
                arch.dispatch(Deal { cells, into, out: out.each_mut().map(|out| &mut out[..columns]) });
                into = Into::Add;
            }
        }
        if into == Into::Set {
            out.into_iter().for_each(|out| out.fill(0.0));
        }
    });
    [0, 1, 2].map(|channel| totals.iter().map(|total| total[channel]).sum())
}

/// Scatters anew around pixels whose light has changed: what the cells that they meet hold of all pixels.
pub(super) fn mend(table: &Table, light: &Plane<f32>, pixels: &[[usize; 2]], plane: &mut Plane<f32>) {
    let mut cells: Vec<[usize; 2]> = Vec::with_capacity(16 * pixels.len());
    let mut met: HashSet<[usize; 2]> = HashSet::new();
    for pixel in pixels {
        let [column, row] = table.entry(pixel[0], pixel[1]).cell.map(|cell| cell as usize);
        cells.extend((0..16).map(|index| [column + index % 4, row + index / 4]));
        // Whoever meets one of these is at most three cells away: from the pixel to its neighbours, and on.
        let (mut seen, mut open) = (HashSet::from([*pixel]), vec![*pixel]);
        while let Some([x, y]) = open.pop() {
            for v in y.saturating_sub(1)..(y + 2).min(table.size[1]) {
                for u in x.saturating_sub(1)..(x + 2).min(table.size[0]) {
                    let [other, below] = table.entry(u, v).cell.map(|cell| cell as usize);
                    if other.abs_diff(column) < 4 && below.abs_diff(row) < 4 && seen.insert([u, v]) {
                        open.push([u, v]);
                    }
                }
            }
        }
        met.extend(seen);
    }
    let mut met: Vec<[usize; 2]> = met.into_iter().collect();
    for list in [&mut cells, &mut met] {
        list.sort_unstable_by_key(|[x, y]| [*y, *x]);
        list.dedup();
    }
    for [x, y] in &cells {
        plane.row_mut(*y)[*x] = 0.0;
    }
    let held = |cell: [usize; 2]| cells.binary_search_by_key(&[cell[1], cell[0]], |[x, y]| [*y, *x]).is_ok();
    for [x, y] in met {
        let entry = table.entry(x, y);
        let light = light.row(y)[x] * entry.root * entry.root * entry.growth;
        if light == 0.0 {
            continue;
        }
        let ([column, row], [across, down]) = (entry.cell.map(|cell| cell as usize), entry.phase.map(weights));
        for (v, down) in down.into_iter().enumerate() {
            for (u, across) in across.into_iter().enumerate() {
                if held([column + u, row + v]) {
                    plane.row_mut(row + v)[column + u] += down * across * light;
                }
            }
        }
    }
}

struct Splat<'a, 'b> {
    table: &'a Table,
    lights: [&'a Plane<f32>; 3],
    rows: [usize; 2],
    first: usize,
    columns: usize,
    part: &'a mut [Cell],
    sent: &'a mut Sent<'b>,
}

impl WithSimd for Splat<'_, '_> {
    type Output = [f64; 3];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [f64; 3] {
        let Self { table, lights, rows, first, columns, part, sent } = self;
        let mut totals = [0.0; 3];
        for y in rows[0]..rows[1] {
            let light = lights.map(|light| &light.row(y)[..table.size[0]]);
            let mut sums = [0.0; 3];
            let row = table.row(y);
            let start = (y - rows[0]) * sent.stride + sent.margin;
            let mut near = sent.near.each_mut().map(|near| &mut near[start..][..table.size[0]]);
            for x in 0..table.size[0] {
                let entry = row.at(x);
                let light = light.map(|light| entry.root * light[x]);
                for (near, light) in near.iter_mut().zip(light) {
                    near[x] = light;
                }
                if light == [0.0; 3] {
                    continue;
                }
                let light = light.map(|light| entry.root * light);
                for (sum, light) in sums.iter_mut().zip(light) {
                    *sum += f64::from(light);
                }
                let light = light.map(|light| entry.growth * light);
                let [across, down] = entry.phase.map(weights);
                // Four points of a row, each with its lanes.
                let lanes: [f32; 16] =
                    std::array::from_fn(|lane| if lane % 4 < 3 { across[lane / 4] * light[lane % 4] } else { 0.0 });
                let [column, row] = entry.cell.map(|cell| cell as usize);
                for (index, down) in down.into_iter().enumerate() {
                    let cells = &mut part[(row - first + index) * columns + column..][..4];
                    let cells = cells.as_flattened_mut();
                    for (cell, lane) in cells.iter_mut().zip(lanes) {
                        *cell = fused::<S>(down, lane, *cell);
                    }
                }
            }
            totals.iter_mut().zip(sums).for_each(|(total, sum)| *total += sum);
        }
        totals
    }
}

/// a b + c, rounded once where the processor can.
#[inline(always)]
fn fused<S: Simd>(a: f32, b: f32, c: f32) -> f32 {
    if S::IS_SCALAR { a * b + c } else { a.mul_add(b, c) }
}

/// Cells to rows of channels.
struct Deal<'a> {
    cells: &'a [Cell],
    into: Into,
    out: [&'a mut [f32]; 3],
}

impl WithSimd for Deal<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { cells, into, out: [red, green, blue] } = self;
        let out = cells.iter().zip(red).zip(green).zip(blue);
        if into == Into::Set {
            for (((cell, red), green), blue) in out {
                (*red, *green, *blue) = (cell[0], cell[1], cell[2]);
            }
        } else {
            for (((cell, red), green), blue) in out {
                (*red, *green, *blue) = (*red + cell[0], *green + cell[1], *blue + cell[2]);
            }
        }
    }
}

/// The lattice with its lanes side by side.
pub(super) fn interleave(arch: Arch, planes: [&Plane<f32>; 3], lattice: &mut Vec<Cell>) {
    let (columns, rows) = (planes[0].width(), planes[0].height());
    lattice.resize(columns * rows, [0.0; 4]);
    lattice.par_chunks_mut(columns).with_min_len(8).enumerate().for_each(|(row, out)| {
        arch.dispatch(Shuffle { rows: planes.map(|plane| &plane.row(row)[..columns]), out });
    });
}

/// Rows of channels to cells.
struct Shuffle<'a> {
    rows: [&'a [f32]; 3],
    out: &'a mut [Cell],
}

impl WithSimd for Shuffle<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { rows: [red, green, blue], out } = self;
        for (((out, red), green), blue) in out.iter_mut().zip(red).zip(green).zip(blue) {
            *out = [*red, *green, *blue, 0.0];
        }
    }
}

/// What arrives along a row of pixels: the small kernels' sums with the target's factor, what all sources add everywhere, what the
/// lattice comes to with the target's factor, less the pixels' own light; never negative.
pub(super) struct Gather<'a> {
    pub table: &'a Table,
    pub y: usize,
    pub lights: [&'a [f32]; 3],
    pub everywhere: [f32; 3],
    pub lattice: &'a [Cell],
    pub columns: usize,
    /// The small kernels' sums, to be replaced.
    pub out: [&'a mut [f32]; 3],
}

impl WithSimd for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { table, y, lights, everywhere, lattice, columns, out } = self;
        let width = table.size[0];
        let lights = lights.map(|light| &light[..width]);
        let [red, green, blue] = out;
        let out = [&mut red[..width], &mut green[..width], &mut blue[..width]];
        let row = table.row(y);
        for x in 0..width {
            let entry = row.at(x);
            let mut sums = [0.0; 4];
            if !lattice.is_empty() {
                let [across, down] = entry.phase.map(weights);
                let [column, row] = entry.cell.map(|cell| cell as usize);
                let mut lanes = [0.0; 16];
                for (index, down) in down.into_iter().enumerate() {
                    let cells = lattice[(row + index) * columns + column..][..4].as_flattened();
                    for (lane, cell) in lanes.iter_mut().zip(cells) {
                        *lane = fused::<S>(down, *cell, *lane);
                    }
                }
                for (index, across) in across.into_iter().enumerate() {
                    for (sum, lane) in sums.iter_mut().zip(&lanes[4 * index..]) {
                        *sum = fused::<S>(across, *lane, *sum);
                    }
                }
            }
            let root = 1.0 / entry.root;
            for channel in 0..3 {
                let near = out[channel][x] * root + everywhere[channel];
                let sum = fused::<S>(entry.growth, sums[channel], near) - entry.own * lights[channel][x];
                out[channel][x] = sum.max(0.0);
            }
        }
    }
}
