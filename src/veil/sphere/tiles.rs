//! The small kernel around each pixel, which varies over the picture: linearly over each tile.

use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use super::camera::{Camera, Point};
use super::model::{Model, Wanted};
use crate::veil::simd::{Plane, Real};

/// Most rows that are summed at a time.
const ROWS: usize = 4;

/// Where in a tile, from its middle over half its size, the slopes of its kernel are taken: the remaining second order is
/// smallest then.
const SLOPE_AT: f64 = 0.7;

/// A second order that is more than this share of a tap may be a kink, as where a function is flat up to some angle.
const CURVED: f64 = 1e-3;

/// Most taps of all kernels together: less than half a gigabyte.
const MOST_TAPS: usize = 1 << 25;

/// The farthest any kernel reaches, in pixels: beyond, it would cost more than it is worth.
pub(super) const FARTHEST: usize = 96;

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
    taps: Vec<Tap>,
}

/// A value in the middle of a tile, and what is added to it for each column and row from there.
type Tap = [f32; 3];

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
            Kernel::new(model, wanted, middle(tile, size), size)
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
        let tile = [x / self.size[0], y / self.size[1]];
        let kernel = &self.kernels[tile[1] * self.across + tile[0]];
        let middle = middle(tile, self.size);
        let [u, v] = [x as f64 - middle[0], y as f64 - middle[1]];
        let run = |run: &Run| {
            let Some(row) = y.checked_add_signed(run.row).filter(|row| *row < self.picture[1]) else { return 0.0 };
            let taps = kernel.taps[run.start..run.end].iter().enumerate();
            let each = taps.filter_map(|(index, tap)| {
                let column =
                    x.checked_add_signed(run.column + index as isize).filter(|column| *column < self.picture[0])?;
                let [value, across, down] = tap.map(f64::from);
                Some((value + u * across + v * down) * source(column, row))
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

    /// Sums a row of tiles into rows of `stride` floats; `sources` have the reach as their margin.
    pub fn sum(&self, arch: pulp::Arch, sources: [&Plane<f32>; 3], row: usize, stride: usize, out: [&mut [f32]; 3]) {
        let [red, green, blue] = out;
        let (width, most) = (self.size[0], red.len() / stride);
        for (tile, kernel) in self.kernels[row * self.across..][..self.across].iter().enumerate() {
            for part in (0..self.size[1].min(most)).step_by(ROWS) {
                let at = [tile * width + self.reach, row * self.size[1] + part + self.reach];
                let from = part * stride + tile * width;
                let out = [&mut red[from..], &mut green[from..], &mut blue[from..]];
                let below = part as f32 - 0.5 * (self.size[1] as f32 - 1.0);
                let rows = most - part;
                match self.size[1] {
                    1 => arch.dispatch(Part::<1> { kernel, sources, at, width, below, rows, stride, out }),
                    2 => arch.dispatch(Part::<2> { kernel, sources, at, width, below, rows, stride, out }),
                    _ => arch.dispatch(Part::<ROWS> { kernel, sources, at, width, below, rows, stride, out }),
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
    fn new(model: &Model, wanted: &Wanted, target: [f64; 2], size: [usize; 2]) -> Option<Self> {
        let mut kernel = Self::default();
        let slopes = Slopes::new(target, size);
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
                // On a wide field all of a row may be near, however far it goes on beyond the picture.
                while first >= -(FARTHEST as isize) && near(first - 1) {
                    first -= 1;
                }
                while last <= FARTHEST as isize && near(last + 1) {
                    last += 1;
                }
                if step == FARTHEST || first < -(FARTHEST as isize) || last > FARTHEST as isize {
                    return None;
                }
                let next = 0.5 * (first + last) as f64;
                (slope, middle) = (if step > 0 { next - middle } else { 0.0 }, next);
                let start = kernel.taps.len();
                kernel.taps.extend((first..=last).map(|column| slopes.tap(model, wanted, [column, row])));
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
                mirror.taps[run.start..run.end].iter_mut().for_each(|tap| tap[1] = -tap[1]);
                run.column = 1 - run.column - (run.end - run.start) as isize;
            }
            if sides[1] {
                mirror.taps[run.start..run.end].iter_mut().for_each(|tap| tap[2] = -tap[2]);
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

/// Where a tile's kernel is looked at: in the middle, on both sides of it along columns and rows, and in the corners.
pub(super) struct Slopes {
    middle: [f64; 2],
    /// From the middle, in pixels.
    steps: [f64; 2],
    corner: [f64; 2],
}

impl Slopes {
    pub fn new(middle: [f64; 2], size: [usize; 2]) -> Self {
        let corner = size.map(|size| 0.5 * (size as f64 - 1.0));
        Self { middle, steps: corner.map(|side| SLOPE_AT * side), corner }
    }

    /// The small kernel's value for a source so many columns and rows away.
    pub fn tap(&self, model: &Model, wanted: &Wanted, offset: [isize; 2]) -> Tap {
        self.of(&model.camera, offset, |source, target| wanted.missing(model, target, source)).map(|value| value as f32)
    }

    /// A function of a source and its target in the middle, and its slopes.
    pub fn of(&self, camera: &Camera, offset: [isize; 2], value: impl Fn(&Point, &Point) -> f64) -> [f64; 3] {
        let at = |x: f64, y: f64| {
            let target = [self.middle[0] + x, self.middle[1] + y];
            let source = camera.point(target[0] + offset[0] as f64, target[1] + offset[1] as f64);
            value(&source, &camera.point(target[0], target[1]))
        };
        let middle = at(0.0, 0.0);
        let (mut linear, mut curved) = ([middle, 0.0, 0.0], 0.0);
        for side in [0, 1] {
            let step = self.steps[side];
            if step > 0.0 {
                let [before, after] = [-step, step].map(|step| if side == 0 { at(step, 0.0) } else { at(0.0, step) });
                linear[side + 1] = (after - before) / (2.0 * step);
                // Half of what is curved, so that it is as much too high as too low.
                let half = 0.5 * (0.5 * (before + after) - middle);
                linear[0] += half;
                curved += half.abs();
            }
        }
        if curved > CURVED * middle.abs() {
            let off = |share: f64, [x, y]: [f64; 2]| {
                let [x, y] = [share * x * self.corner[0], share * y * self.corner[1]];
                at(x, y) - linear[0] - x * linear[1] - y * linear[2]
            };
            let corners = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
            let all = [0.5, 1.0].into_iter().flat_map(|share| corners.map(|corner| off(share, corner)));
            let first = middle - linear[0];
            let [low, high] = all.fold([first; 2], |[low, high], off| [low.min(off), high.max(off)]);
            linear[0] += 0.5 * (low + high);
        }
        linear
    }
}

/// Some rows of a tile.
struct Part<'a, const R: usize> {
    kernel: &'a Kernel,
    sources: [&'a Plane<f32>; 3],
    /// The first pixel's column and row among the sources.
    at: [usize; 2],
    width: usize,
    /// From the tile's middle to the first row.
    below: f32,
    /// How many rows there are to be written.
    rows: usize,
    stride: usize,
    out: [&'a mut [f32]; 3],
}

impl<const R: usize> WithSimd for Part<'_, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { kernel, sources, at, width, below, rows, stride, mut out } = self;
        let lanes = S::F32_LANES;
        for column in (0..width).step_by(lanes) {
            // From the tile's middle, in columns.
            let across: [f32; 64] = std::array::from_fn(|lane| (column + lane) as f32 - 0.5 * (width as f32 - 1.0));
            let across = f32::vectors::<S>(&across)[0];
            let mut sums = [[simd.splat_f32s(0.0); 3]; R];
            for run in &kernel.runs {
                let taps = &kernel.taps[run.start..run.end];
                let first = (at[0] + column).wrapping_add_signed(run.column);
                let row = at[1].wrapping_add_signed(run.row);
                let values: [[&[f32]; 3]; R] = std::array::from_fn(|index| {
                    sources.map(|plane| &plane.row(row + index)[first..][..taps.len() + lanes - 1])
                });
                for (index, [value, slope, slant]) in taps.iter().enumerate() {
                    let along = simd.mul_add_e_f32s(across, simd.splat_f32s(*slope), simd.splat_f32s(*value));
                    let slant = simd.splat_f32s(*slant);
                    for (row, (sums, values)) in sums.iter_mut().zip(values).enumerate() {
                        let tap = simd.mul_add_e_f32s(simd.splat_f32s(below + row as f32), slant, along);
                        for (sum, values) in sums.iter_mut().zip(values) {
                            let values = f32::vectors::<S>(&values[index..index + lanes]);
                            *sum = simd.mul_add_e_f32s(tap, values[0], *sum);
                        }
                    }
                }
            }
            for (row, sums) in sums.into_iter().enumerate().take(rows) {
                for (sum, out) in sums.into_iter().zip(&mut out) {
                    f32::vectors_mut::<S>(&mut out[row * stride + column..][..lanes])[0] = sum;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::camera::Projection;
    use super::*;

    /// In a corner of the picture and of a tile, with a margin over what the middle alone would say.
    #[test]
    fn slopes_follow_the_geometry_over_a_tile() {
        let camera = Camera { projection: Projection::Rectilinear, focal: 300.0, size: [320, 200] };
        let size = [32, 16];
        let centre = middle([0, 0], size);
        let value = |source: &Point, target: &Point| source.chord(target).powi(-3) * source.solid_angle;
        for offset in [[1, 0], [0, 1], [3, -2]] {
            let [middle, across, down] = Slopes::new(centre, size).of(&camera, offset, value);
            for at in [[0.0, 0.0], [31.0, 15.0], [0.0, 15.0]] {
                let source = camera.point(at[0] + offset[0] as f64, at[1] + offset[1] as f64);
                let wanted = value(&source, &camera.point(at[0], at[1]));
                let found = middle + (at[0] - centre[0]) * across + (at[1] - centre[1]) * down;
                let off = [found, middle].map(|found| (found / wanted - 1.0).abs());
                assert!(off[0] < 5e-3 && off[0] < 0.2 * off[1].max(5e-3), "{offset:?} {at:?}: {off:?}");
            }
        }
    }
}
