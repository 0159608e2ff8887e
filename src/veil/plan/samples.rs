//! The offsets at which a plan's kernel is compared with the wanted one.
//!
//! Near offsets are taken all. Far ones by distances each 2 % further than the last, in nine directions of an eighth of the
//! circle; others follow by symmetry. Between two distances a Gaussian of a mixture changes smoothly: the relative error is
//! that of a sum whose parts have widths of at least a few pitches, and its extrema are as wide as those.

use super::super::FLOOR;

/// Offsets up to this one, in either direction, are taken all.
pub(super) const NEAR: usize = 48;

/// Each far distance over the one before.
pub(super) const STEP: f64 = 1.02;

/// Directions in an eighth of the circle, both ends included.
const DIRECTIONS: usize = 9;

/// An offset between two pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    /// Columns and rows, as indices into [`Samples::offsets`].
    pub index: [usize; 2],
    /// Columns and rows.
    pub offset: [usize; 2],
    /// What is wanted, the pixel's weight included.
    pub wanted: f64,
}

/// All of them.
#[derive(Debug)]
pub(super) struct Samples {
    /// Offsets of one dimension, in increasing order.
    pub offsets: Vec<usize>,
    pub pairs: Vec<Sample>,
    /// A kernel below this counts as this: all sources together make no more than [`FLOOR`] of the largest veil by it.
    pub floor: f64,
}

impl Samples {
    /// Of a kernel by distance in pixels, on a picture where pixels are at most `most` columns and rows apart.
    pub fn new(wanted: impl Fn(f64) -> f64, most: [usize; 2], pixels: usize) -> Self {
        let mut offsets = Vec::new();
        let add = |x: usize, y: usize, offsets: &mut Vec<[usize; 2]>| {
            if x <= most[0] && y <= most[1] && (x, y) != (0, 0) {
                offsets.push([x, y]);
            }
        };
        for y in 0..=NEAR.min(most[1]) {
            for x in 0..=NEAR.min(most[0]) {
                add(x, y, &mut offsets);
            }
        }
        let end = (most[0] as f64).hypot(most[1] as f64);
        let mut distance = NEAR as f64;
        while distance < end * STEP {
            for direction in 0..DIRECTIONS {
                let angle = std::f64::consts::FRAC_PI_4 * direction as f64 / (DIRECTIONS - 1) as f64;
                let [x, y] = [angle.cos(), angle.sin()].map(|part| (part * distance).round() as usize);
                add(x, y, &mut offsets);
                add(y, x, &mut offsets);
            }
            distance *= STEP;
        }
        for corner in [[most[0], 0], [0, most[1]], most] {
            add(corner[0], corner[1], &mut offsets);
        }
        offsets.sort_unstable();
        offsets.dedup();
        let mut single: Vec<usize> = offsets.iter().flatten().copied().collect();
        single.sort_unstable();
        single.dedup();
        let index = |offset: usize| single.binary_search(&offset).unwrap_or(0);
        let pair = |offset: &[usize; 2]| {
            let distance = (offset[0] as f64).hypot(offset[1] as f64);
            Sample { index: offset.map(index), offset: *offset, wanted: wanted(distance) }
        };
        let pairs = offsets.iter().map(pair).collect();
        let floor = FLOOR * corner_sum(&wanted, most) / pixels as f64;
        Self { offsets: single, pairs, floor }
    }
}

/// A lower bound of what the kernel sums to over a picture from its corner, which is where that is least. The largest veil
/// is at least the mean of all, hence at least that times the mean source.
fn corner_sum(wanted: impl Fn(f64) -> f64, most: [usize; 2]) -> f64 {
    let near = most.map(|most| most.min(NEAR));
    let mut sum = 0.0;
    for y in 0..=near[1] {
        for x in 0..=near[0] {
            if (x, y) != (0, 0) {
                sum += wanted((x as f64).hypot(y as f64));
            }
        }
    }
    // A quarter of rings; half of that, as a sum over pixels and an integral differ.
    let (mut distance, end) = (NEAR as f64 * std::f64::consts::SQRT_2, most[0].min(most[1]) as f64);
    while distance * STEP < end {
        let ring = distance * distance * (STEP - 1.0);
        sum += 0.5 * std::f64::consts::FRAC_PI_2 * ring * wanted(distance * STEP);
        distance *= STEP;
    }
    sum
}

impl Sample {
    /// In pixels.
    pub fn distance(&self) -> f64 {
        (self.offset[0] as f64).hypot(self.offset[1] as f64)
    }
}
