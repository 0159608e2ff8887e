//! Transforms of rows and columns of numbers, and products of them that are added up.

use std::sync::Arc;

use rayon::prelude::*;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

/// Frequencies, or rows, that are taken at a time: two lines of a cache.
const BLOCK: usize = 8;

type C = Complex<f64>;

/// Transforms of one size.
pub(super) struct Waves {
    /// Columns and rows.
    pub size: [usize; 2],
    row: Arc<dyn RealToComplex<f64>>,
    back_row: Arc<dyn ComplexToReal<f64>>,
    column: Arc<dyn Fft<f64>>,
    back_column: Arc<dyn Fft<f64>>,
}

/// The transforms of some rows, all others being nothing; the first of them may have a negative number.
pub(super) struct Rows {
    first: isize,
    count: usize,
    data: Vec<C>,
}

/// Sums of products, for each block of frequencies a few channels, column by column.
pub(super) struct Sums {
    channels: usize,
    data: Vec<C>,
}

impl Waves {
    /// Of columns and rows, an even number of columns.
    pub fn new(size: [usize; 2]) -> Self {
        let (mut real, mut complex) = (RealFftPlanner::new(), FftPlanner::new());
        Self {
            size,
            row: real.plan_fft_forward(size[0]),
            back_row: real.plan_fft_inverse(size[0]),
            column: complex.plan_fft_forward(size[1]),
            back_column: complex.plan_fft_inverse(size[1]),
        }
    }

    fn frequencies(&self) -> usize {
        self.size[0] / 2 + 1
    }

    /// Transforms so many rows from the first on, each of which `fill` writes by its number among them, into zeros.
    pub fn rows(&self, first: isize, count: usize, fill: impl Fn(usize, &mut [f64]) + Sync) -> Rows {
        let mut data = vec![C::default(); count * self.frequencies()];
        data.par_chunks_exact_mut(self.frequencies()).enumerate().for_each_init(
            || (self.row.make_input_vec(), self.row.make_scratch_vec()),
            |(real, scratch), (number, row)| {
                real.fill(0.0);
                fill(number, real);
                self.row.process_with_scratch(real, row, scratch).expect("buffers of the planner's lengths");
            },
        );
        Rows { first, count, data }
    }

    /// Room for sums of so many channels.
    pub fn sums(&self, channels: usize) -> Sums {
        let blocks = self.frequencies().div_ceil(BLOCK);
        Sums { channels, data: vec![C::default(); blocks * channels * BLOCK * self.size[1]] }
    }

    /// Adds the products of a kernel with each channel.
    pub fn add(&self, sums: &mut Sums, kernel: &Rows, channels: &[Rows]) {
        let block = BLOCK * self.size[1];
        debug_assert_eq!(sums.channels, channels.len());
        sums.data.par_chunks_exact_mut(sums.channels * block).enumerate().for_each_init(
            || {
                let scratch = self.column.get_inplace_scratch_len();
                (vec![C::default(); block], vec![C::default(); block], vec![C::default(); scratch])
            },
            |(factors, columns, scratch), (number, sums)| {
                self.columns(kernel, number, factors, scratch);
                for (sums, rows) in sums.chunks_exact_mut(block).zip(channels) {
                    self.columns(rows, number, columns, scratch);
                    let products = columns.iter().zip(factors.iter());
                    sums.iter_mut().zip(products).for_each(|(sum, (value, factor))| *sum += value * factor);
                }
            },
        );
    }

    /// The transformed columns of a block of frequencies.
    fn columns(&self, rows: &Rows, block: usize, into: &mut [C], scratch: &mut [C]) {
        let (length, each) = (self.size[1], self.frequencies());
        let used = BLOCK.min(each - block * BLOCK);
        into.fill(C::default());
        for (number, row) in (rows.first..).zip(rows.data.chunks_exact(each)).take(rows.count) {
            let place = number.rem_euclid(length as isize) as usize;
            let values = &row[block * BLOCK..][..used];
            values.iter().enumerate().for_each(|(column, value)| into[column * length + place] = *value);
        }
        self.column.process_with_scratch(&mut into[..used * length], scratch);
    }

    /// The sums themselves: `take` gets a channel's row of the first so many, and what is there of `out`, a plane for each channel.
    pub fn back(
        &self,
        mut sums: Sums,
        width: usize,
        out: &mut [&mut [f64]],
        take: impl Fn(usize, &[f64], &mut [f64]) + Sync,
    ) {
        let (length, channels) = (self.size[1], sums.channels);
        sums.data.par_chunks_exact_mut(BLOCK * length).for_each_init(
            || vec![C::default(); self.back_column.get_inplace_scratch_len()],
            |scratch, columns| self.back_column.process_with_scratch(columns, scratch),
        );
        let scale = ((self.size[0] * length) as f64).recip();
        for (channel, plane) in out.iter_mut().enumerate() {
            plane.par_chunks_mut(BLOCK * width).enumerate().for_each_init(
                || {
                    let halves = vec![C::default(); BLOCK * self.frequencies()];
                    (halves, self.back_row.make_output_vec(), self.back_row.make_scratch_vec())
                },
                |(halves, real, scratch), (group, out)| {
                    let (first, rows) = (group * BLOCK, out.len() / width);
                    for (frequency, column) in (0..self.frequencies()).zip(0..) {
                        let (block, within): (usize, usize) = (column / BLOCK, column % BLOCK);
                        let column = &sums.data[((block * channels + channel) * BLOCK + within) * length..][first..];
                        (0..rows).for_each(|row| halves[row * self.frequencies() + frequency] = scale * column[row]);
                    }
                    for (row, out) in out.chunks_exact_mut(width).enumerate() {
                        let half = &mut halves[row * self.frequencies()..][..self.frequencies()];
                        // The imaginary parts that only rounding gives.
                        half[0].im = 0.0;
                        half[self.size[0] / 2].im = 0.0;
                        self.back_row.process_with_scratch(half, real, scratch).expect("buffers of its lengths");
                        take(channel, &real[..width], out);
                    }
                },
            );
        }
    }
}
