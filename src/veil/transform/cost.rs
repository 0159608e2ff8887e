//! What a transform costs, beside what else there is.
//!
//! Nanoseconds of one thread, by medians on two cores with 256-bit vectors; only their ratios count.

use super::passes::BLOCK;
use super::taps::Taps;
use super::{MOST_MEMORY, Task};
use crate::fast_length::fast_length;
use crate::veil::error::Error;
use crate::veil::geometry::Border;
use crate::veil::simd::padded;

/// An addition or a multiplication of a transform.
const FLOP: f64 = 0.12;

/// A multiply-add of a sum over taps.
const TAP: f64 = 0.075;

/// A pixel's passage through memory, in and out.
const PIXEL: f64 = 9.0;

/// A multiply-add of lattices and kernels on the pixels.
const OPERATION: f64 = 0.1;

/// A pixel's passage up and down the lattices, besides.
const LATTICES: f64 = 5.0;

/// What a border makes of these two: nine pictures are sources, and three have their rows summed.
const WITH_BORDER: [f64; 2] = [4.0, 9.0];

/// Nanoseconds that the pyramid takes for a channel.
pub(in crate::veil) fn pyramid_nanoseconds(operations: f64, task: &Task) -> f64 {
    let [each, passage] = if task.border == Border::None { [1.0; 2] } else { WITH_BORDER };
    (OPERATION * operations * each + LATTICES * passage) * (task.size[0] * task.size[1]) as f64
}

/// What one channel takes.
#[derive(Debug, Clone, Copy)]
pub(in crate::veil) struct Cost {
    /// Nanoseconds of one thread.
    pub nanoseconds: f64,
    /// The same of a sum over all taps.
    taps: f64,
    /// Bytes of the plan and of an evaluation.
    pub bytes: usize,
    bytes_of_taps: usize,
}

impl Cost {
    pub(super) fn new(task: &Task, taps: &[Taps], points: [usize; 2]) -> Self {
        let [width, height] = task.size;
        let table: usize = taps.iter().map(|taps| size_of_val(taps.values.as_slice())).sum();
        let products = taps.iter().map(|taps| taps.columns.offsets() * taps.rows.offsets()).max().unwrap_or(0);
        let bytes_of_taps = table + size_of::<f64>() * (padded(width) + taps[0].columns.offsets()) * height;
        let even = taps.iter().all(Taps::is_even);
        Self {
            nanoseconds: nanoseconds(task, points),
            taps: TAP * products as f64 * (padded(width) * height) as f64 + PIXEL * (width * height) as f64,
            bytes: table + bytes(task, points, even, taps.len()),
            bytes_of_taps,
        }
    }

    /// That of a function as wide as the photo.
    pub fn of_widest(task: &Task) -> Self {
        let most = task.most();
        let beyond = if task.border == Border::None { [0, 0] } else { task.size };
        let points = [0, 1].map(|side| fast_length(task.size[side] + beyond[side] + most[side]));
        let bytes = size_of::<f64>() * (most[0] + 1) * (most[1] + 1) + bytes(task, points, true, 1);
        Self { nanoseconds: nanoseconds(task, points), taps: f64::INFINITY, bytes, bytes_of_taps: bytes }
    }

    /// Whether a sum over all taps costs less.
    pub fn by_taps(&self) -> bool {
        self.taps < self.nanoseconds
    }

    /// The cost of that.
    pub fn of_taps(&self) -> Self {
        Self { nanoseconds: self.taps, bytes: self.bytes_of_taps, ..*self }
    }

    /// Refuses what takes too much memory.
    pub fn check(&self) -> Result<(), Error> {
        if self.bytes > MOST_MEMORY {
            return Err(Error::Memory { needed: self.bytes, most: MOST_MEMORY });
        }
        Ok(())
    }

    /// As many multiply-adds of the pyramid at each pixel as take the same time.
    pub fn operations(&self, task: &Task) -> f64 {
        self.nanoseconds / (OPERATION * (task.size[0] * task.size[1]) as f64)
    }
}

fn nanoseconds(task: &Task, points: [usize; 2]) -> f64 {
    let [columns, rows] = points.map(|points| points as f64);
    // There and back: the photo's rows, which are real, and all columns of half the frequencies.
    let along_rows = 2.0 * task.size[1] as f64 * 2.5 * columns * columns.log2();
    let along_columns = 2.0 * 0.5 * columns * 5.0 * rows * rows.log2();
    FLOP * (along_rows + along_columns) + PIXEL * (task.size[0] * task.size[1]) as f64
}

fn bytes(task: &Task, points: [usize; 2], even: bool, channels: usize) -> usize {
    let columns = points[0] / 2 + 1 + BLOCK;
    let spectrum = if even { 8 * (points[1] / 2 + 1) } else { 16 * points[1] };
    columns.saturating_mul(channels * spectrum + 16 * task.size[1])
}
