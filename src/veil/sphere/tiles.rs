//! The small kernel around each pixel, which varies over the picture: one for each tile.

use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use super::model::{Model, Wanted};
use crate::veil::simd::{Plane, Real};

/// Most rows that are summed at a time, which share a tap.
const ROWS: usize = 8;

/// Most taps of all kernels together: a quarter of a gigabyte.
const MOST_TAPS: usize = 1 << 26;

/// The farthest any kernel reaches, in pixels: beyond, it would cost more than it is worth.
pub(super) const FARTHEST: usize = 72;

/// A run of taps in a row.
#[derive(Debug, Clone, Copy)]
struct Run {
    /// From the target to the first tap.
    column: isize,
    row: isize,
    /// Where the taps are.
    start: usize,
    end: usize,
}

/// The kernel around the pixels of a tile.
#[derive(Debug, Clone, Default)]
struct Kernel {
    runs: Vec<Run>,
    taps: Vec<f32>,
}

/// All of them.
#[derive(Debug, Clone)]
pub(in crate::veil) struct Tiles {
    /// Columns and rows of a tile.
    pub size: [usize; 2],
    /// Columns and rows of the picture.
    picture: [usize; 2],
    /// Tiles in a row.
    across: usize,
    kernels: Vec<Kernel>,
    /// How far the largest kernel reaches.
    pub reach: usize,
}

impl Tiles {
    /// For all tiles of a picture; none if a kernel would reach too far.
    pub fn new(model: &Model, wanted: &Wanted, size: [usize; 2]) -> Option<Self> {
        let counts = [0, 1].map(|side| model.camera.size[side].div_ceil(size[side]));
        // Where whole tiles fill the picture, the left and the upper half are mirror images of the others.
        let mirrored = [0, 1].map(|side| model.camera.size[side].is_multiple_of(size[side]));
        let distinct = [0, 1].map(|side| if mirrored[side] { counts[side].div_ceil(2) } else { counts[side] });
        let kernel = |index: usize| {
            let tile = [index % distinct[0], index / distinct[0]];
            Kernel::new(model, wanted, middle(tile, size))
        };
        let first: Option<Vec<Kernel>> = (0..distinct[0] * distinct[1]).into_par_iter().map(kernel).collect();
        let first = first?;
        let kernel = |index: usize| {
            let tile = [index % counts[0], index / counts[0]];
            let other = [0, 1]
                .map(|side| tile[side].min(if mirrored[side] { counts[side] - 1 - tile[side] } else { tile[side] }));
            first[other[1] * distinct[0] + other[0]].mirrored([0, 1].map(|side| other[side] != tile[side]))
        };
        if first.iter().map(|kernel| kernel.taps.len()).sum::<usize>() / first.len().max(1) * counts[0] * counts[1]
            > MOST_TAPS
        {
            return None;
        }
        let kernels: Vec<Kernel> = (0..counts[0] * counts[1]).into_par_iter().map(kernel).collect();
        let reach = kernels.iter().map(Kernel::reach).max().unwrap_or(0);
        Some(Self { size, picture: model.camera.size, across: counts[0], kernels, reach })
    }

    /// The sum at one pixel, of sources by column and row.
    pub fn at(&self, x: usize, y: usize, source: impl Fn(usize, usize) -> f64) -> f64 {
        let kernel = &self.kernels[y / self.size[1] * self.across + x / self.size[0]];
        let run = |run: &Run| {
            let Some(row) = y.checked_add_signed(run.row).filter(|row| *row < self.picture[1]) else { return 0.0 };
            let taps = kernel.taps[run.start..run.end].iter().enumerate();
            let each = taps.filter_map(|(index, tap)| {
                let column =
                    x.checked_add_signed(run.column + index as isize).filter(|column| *column < self.picture[0])?;
                Some(f64::from(*tap) * source(column, row))
            });
            each.sum::<f64>()
        };
        kernel.runs.iter().map(run).sum()
    }

    /// Columns and rows of the sources with room for all kernels on all sides.
    pub fn extent(&self) -> [usize; 2] {
        let rows = self.kernels.len() / self.across;
        [self.across * self.size[0] + 2 * self.reach, rows * self.size[1] + 2 * self.reach]
    }

    /// Sums a row of tiles, of 1, 2, 4 or a multiple of 8 rows, into rows of `stride` floats; `sources` has the reach as its margin.
    pub fn sum(&self, arch: pulp::Arch, sources: &Plane<f32>, row: usize, stride: usize, out: &mut [f32]) {
        for (tile, kernel) in self.kernels[row * self.across..][..self.across].iter().enumerate() {
            for part in (0..self.size[1]).step_by(ROWS) {
                let at = [tile * self.size[0] + self.reach, row * self.size[1] + part + self.reach];
                let out = &mut out[part * stride + tile * self.size[0]..];
                let width = self.size[0];
                match self.size[1] {
                    1 => arch.dispatch(Part::<1> { kernel, sources, at, width, stride, out }),
                    2 => arch.dispatch(Part::<2> { kernel, sources, at, width, stride, out }),
                    4 => arch.dispatch(Part::<4> { kernel, sources, at, width, stride, out }),
                    _ => arch.dispatch(Part::<ROWS> { kernel, sources, at, width, stride, out }),
                }
            }
        }
    }
}

/// The middle of a tile, in pixels.
pub(super) fn middle(tile: [usize; 2], size: [usize; 2]) -> [f64; 2] {
    [0, 1].map(|side| (tile[side] * size[side]) as f64 + 0.5 * (size[side] as f64 - 1.0))
}

impl Kernel {
    /// Around a target: rows from the middle up and down, and in each from where the last had its middle to both sides, for as long as the
    /// source is near enough.
    fn new(model: &Model, wanted: &Wanted, target: [f64; 2]) -> Option<Self> {
        let mut kernel = Self::default();
        let centre = model.camera.point(target[0], target[1]);
        let source = |column: isize, row: isize| model.camera.point(target[0] + column as f64, target[1] + row as f64);
        for direction in [1isize, -1] {
            let (mut middle, mut slope) = (0.0f64, 0.0);
            for step in usize::from(direction < 0)..=FARTHEST {
                let row = direction * step as isize;
                let near = |column: isize| centre.chord(&source(column, row)) <= wanted.near;
                let guess = (middle + slope).round() as isize;
                let Some(start) =
                    [0, 1, -1, 2, -2].into_iter().map(|offset| guess + offset).find(|column| near(*column))
                else {
                    break;
                };
                let [mut first, mut last] = [start; 2];
                while near(first - 1) {
                    first -= 1;
                }
                while near(last + 1) {
                    last += 1;
                }
                if step == FARTHEST || first < -(FARTHEST as isize) || last > FARTHEST as isize {
                    return None;
                }
                let next = 0.5 * (first + last) as f64;
                (slope, middle) = (if step > 0 { next - middle } else { 0.0 }, next);
                let start = kernel.taps.len();
                kernel
                    .taps
                    .extend((first..=last).map(|column| wanted.missing(model, &centre, &source(column, row)) as f32));
                kernel.runs.push(Run { column: first, row, start, end: kernel.taps.len() });
            }
        }
        Some(kernel)
    }

    /// Its mirror image along columns, rows or both.
    fn mirrored(&self, sides: [bool; 2]) -> Self {
        let mut mirror = self.clone();
        for run in &mut mirror.runs {
            if sides[0] {
                mirror.taps[run.start..run.end].reverse();
                run.column = 1 - run.column - (run.end - run.start) as isize;
            }
            if sides[1] {
                run.row = -run.row;
            }
        }
        mirror
    }

    fn reach(&self) -> usize {
        let farthest = |run: &Run| {
            let last = run.column + (run.end - run.start) as isize - 1;
            run.row.unsigned_abs().max(run.column.unsigned_abs()).max(last.unsigned_abs())
        };
        self.runs.iter().map(farthest).max().unwrap_or(0)
    }
}

/// Some rows of a tile.
struct Part<'a, const R: usize> {
    kernel: &'a Kernel,
    sources: &'a Plane<f32>,
    /// The first pixel's column and row among the sources.
    at: [usize; 2],
    width: usize,
    stride: usize,
    out: &'a mut [f32],
}

impl<const R: usize> WithSimd for Part<'_, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { kernel, sources, at, width, stride, out } = self;
        let lanes = S::F32_LANES;
        for column in (0..width).step_by(lanes) {
            let mut sums = [simd.splat_f32s(0.0); R];
            for run in &kernel.runs {
                let taps = &kernel.taps[run.start..run.end];
                let first = (at[0] + column).wrapping_add_signed(run.column);
                let row = at[1].wrapping_add_signed(run.row);
                let rows: [&[f32]; R] =
                    std::array::from_fn(|index| &sources.row(row + index)[first..][..taps.len() + lanes - 1]);
                for (index, tap) in taps.iter().enumerate() {
                    let tap = simd.splat_f32s(*tap);
                    for (sum, row) in sums.iter_mut().zip(rows) {
                        let values = f32::vectors::<S>(&row[index..index + lanes]);
                        *sum = simd.mul_add_e_f32s(tap, values[0], *sum);
                    }
                }
            }
            for (index, sum) in sums.into_iter().enumerate() {
                f32::vectors_mut::<S>(&mut out[index * stride + column..][..lanes])[0] = sum;
            }
        }
    }
}
