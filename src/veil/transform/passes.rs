//! Real transforms in two dimensions, a row and a few columns at a time.
//!
//! Rows are transformed first, those that hold something; of each, half the frequencies are kept, the others being their conjugates.
//! They lie by blocks of [`BLOCK`] frequencies, within a block row by row. Then each block by itself has its columns filled up with
//! zeros, transformed, multiplied and transformed back, and the rows that are looked at take the place of the first. So there is
//! never more than the half spectra of the photo's own rows.

use std::fmt;
use std::sync::Arc;

use rayon::prelude::*;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

/// Frequencies that lie side by side: two lines of a cache.
pub(super) const BLOCK: usize = 8;

/// Rows that a thread takes at a time.
const GROUP: usize = 8;

type C = Complex<f64>;

/// Transforms of one size.
#[derive(Clone)]
pub(super) struct Passes {
    size: [usize; 2],
    row: Arc<dyn RealToComplex<f64>>,
    back_row: Arc<dyn ComplexToReal<f64>>,
    column: Arc<dyn Fft<f64>>,
    back_column: Arc<dyn Fft<f64>>,
}

impl fmt::Debug for Passes {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Passes").field("size", &self.size).finish_non_exhaustive()
    }
}

/// Half spectra of rows.
pub(super) struct Rows {
    count: usize,
    data: Vec<C>,
}

/// The transform of a kernel: for each block of frequencies along rows, the frequencies along columns of each.
pub(super) enum Spectrum {
    /// Of a kernel that is its own mirror image: real, and the same for frequencies of either sign, hence half of them.
    Even(Vec<f64>),
    Any(Vec<C>),
}

impl fmt::Debug for Spectrum {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Even(_) => "Even",
            Self::Any(_) => "Any",
        })
    }
}

/// Room for a block's columns.
struct Columns {
    values: Vec<C>,
    scratch: Vec<C>,
}

impl Passes {
    /// Of `size` columns and rows, an even number of columns.
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

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Frequencies along rows that are kept.
    fn frequencies(&self) -> usize {
        self.size[0] / 2 + 1
    }

    fn blocks(&self) -> usize {
        self.frequencies().div_ceil(BLOCK)
    }

    /// Room for so many rows.
    pub fn room(&self, count: usize) -> Rows {
        Rows { count, data: vec![C::default(); self.blocks() * BLOCK * count] }
    }

    /// Frequencies along columns, without those of negative sign.
    fn half(&self) -> usize {
        self.size[1] / 2 + 1
    }

    /// Transforms rows, each of which `fill` writes. Returns what that returns.
    pub fn rows<T: Send>(&self, rows: &mut Rows, fill: impl Fn(usize, &mut [f64]) -> T + Sync) -> Vec<T> {
        let count = rows.count;
        let mut groups: Vec<Vec<&mut [C]>> =
            (0..count.div_ceil(GROUP)).map(|_| Vec::with_capacity(self.blocks())).collect();
        for block in rows.data.chunks_exact_mut(count * BLOCK) {
            groups.iter_mut().zip(block.chunks_mut(GROUP * BLOCK)).for_each(|(group, part)| group.push(part));
        }
        let room = || {
            let half = vec![C::default(); self.blocks() * BLOCK];
            (self.row.make_input_vec(), half, self.row.make_scratch_vec())
        };
        let group = |(real, half, scratch): &mut (Vec<f64>, Vec<C>, Vec<C>),
                     (group, mut parts): (usize, Vec<&mut [C]>)| {
            let first = group * GROUP;
            let row = |row: usize| {
                let told = fill(first + row, real);
                let done = self.row.process_with_scratch(real, &mut half[..self.frequencies()], scratch);
                debug_assert!(done.is_ok());
                for (part, half) in parts.iter_mut().zip(half.chunks_exact(BLOCK)) {
                    part[row * BLOCK..][..BLOCK].copy_from_slice(half);
                }
                told
            };
            (0..GROUP.min(count - first)).map(row).collect::<Vec<T>>()
        };
        groups.into_par_iter().enumerate().map_init(room, group).collect::<Vec<_>>().into_iter().flatten().collect()
    }

    /// The transform of a kernel whose rows are `rows`; `row_of` says which of them stands at each place of a column.
    pub fn spectrum(&self, rows: &Rows, row_of: impl Fn(usize) -> Option<usize> + Sync, even: bool) -> Spectrum {
        let block = |columns: &mut Columns, block: usize| {
            let data = &rows.data[block * BLOCK * rows.count..][..BLOCK * rows.count];
            self.columns(columns, data, self.used(block), &row_of);
        };
        let length = self.size[1];
        let each = self.blocks() * BLOCK;
        if even {
            let mut values = vec![0.0; each * self.half()];
            let blocks = values.par_chunks_exact_mut(BLOCK * self.half()).enumerate();
            blocks.for_each_init(
                || self.room_of_columns(),
                |columns, (index, into)| {
                    block(columns, index);
                    let pairs = into.chunks_exact_mut(self.half()).zip(columns.values.chunks_exact(length));
                    pairs.for_each(|(into, column)| {
                        into.iter_mut().zip(column).for_each(|(into, value)| *into = value.re)
                    });
                },
            );
            return Spectrum::Even(values);
        }
        let mut values = vec![C::default(); each * length];
        let blocks = values.par_chunks_exact_mut(BLOCK * length).enumerate();
        blocks.for_each_init(
            || self.room_of_columns(),
            |columns, (index, into)| {
                block(columns, index);
                into.copy_from_slice(&columns.values);
            },
        );
        Spectrum::Any(values)
    }

    /// Multiplies by a kernel's transform: `row_of` says which row stands at each place of a column, and in the end row n is what stands at
    /// place `first` + n.
    pub fn multiply(
        &self,
        rows: &mut Rows,
        spectrum: &Spectrum,
        row_of: impl Fn(usize) -> Option<usize> + Sync,
        first: usize,
    ) {
        let count = rows.count;
        let blocks = rows.data.par_chunks_exact_mut(BLOCK * count).enumerate();
        blocks.for_each_init(
            || self.room_of_columns(),
            |columns, (block, data)| {
                let used = self.used(block);
                self.columns(columns, data, used, &row_of);
                for (index, column) in columns.values.chunks_exact_mut(self.size[1]).take(used).enumerate() {
                    spectrum.times(block * BLOCK + index, column);
                }
                let used = &mut columns.values[..used * self.size[1]];
                self.back_column.process_with_scratch(used, &mut columns.scratch);
                for (index, column) in used.chunks_exact(self.size[1]).enumerate() {
                    for (into, value) in data.chunks_exact_mut(BLOCK).zip(&column[first..]) {
                        into[index] = *value;
                    }
                }
            },
        );
    }

    /// The rows themselves, from the half spectra: each goes to `take`, with a row of `out`.
    pub fn back(&self, rows: &Rows, out: &mut [f32], take: impl Fn(usize, &[f64], &mut [f32]) + Sync) {
        let count = rows.count;
        let room = || {
            let half = vec![C::default(); self.blocks() * BLOCK];
            (half, self.back_row.make_output_vec(), self.back_row.make_scratch_vec())
        };
        let row = |(half, real, scratch): &mut (Vec<C>, Vec<f64>, Vec<C>), (row, out): (usize, &mut [f32])| {
            for (half, block) in half.chunks_exact_mut(BLOCK).zip(rows.data.chunks_exact(BLOCK * count)) {
                half.copy_from_slice(&block[row * BLOCK..][..BLOCK]);
            }
            let half = &mut half[..self.frequencies()];
            // The imaginary parts that only rounding gives.
            half[0].im = 0.0;
            half[self.size[0] / 2].im = 0.0;
            let done = self.back_row.process_with_scratch(half, real, scratch);
            debug_assert!(done.is_ok());
            take(row, real, out);
        };
        let width = out.len() / count;
        out.par_chunks_exact_mut(width).enumerate().with_min_len(GROUP).for_each_init(room, row);
    }

    /// Frequencies of a block that are no padding.
    fn used(&self, block: usize) -> usize {
        BLOCK.min(self.frequencies() - block * BLOCK)
    }

    fn room_of_columns(&self) -> Columns {
        let scratch = self.column.get_inplace_scratch_len().max(self.back_column.get_inplace_scratch_len());
        Columns { values: vec![C::default(); BLOCK * self.size[1]], scratch: vec![C::default(); scratch] }
    }

    /// The transformed columns of a block.
    fn columns(
        &self,
        columns: &mut Columns,
        data: &[C],
        used: usize,
        row_of: &(impl Fn(usize) -> Option<usize> + Sync),
    ) {
        let length = self.size[1];
        for place in 0..length {
            match row_of(place) {
                Some(row) => {
                    let row = &data[row * BLOCK..][..BLOCK];
                    row.iter().enumerate().for_each(|(index, value)| columns.values[index * length + place] = *value);
                }
                None => (0..BLOCK).for_each(|index| columns.values[index * length + place] = C::default()),
            }
        }
        self.column.process_with_scratch(&mut columns.values[..used * length], &mut columns.scratch);
    }
}

impl Spectrum {
    /// Multiplies the column of a frequency along rows.
    fn times(&self, frequency: usize, column: &mut [C]) {
        match self {
            Self::Even(values) => {
                let half = column.len() / 2 + 1;
                let values = &values[frequency * half..][..half];
                let (low, high) = column.split_at_mut(half);
                low.iter_mut().zip(values).for_each(|(value, factor)| *value *= factor);
                // The last of the upper ones is that of frequency −1.
                high.iter_mut().rev().zip(&values[1..]).for_each(|(value, factor)| *value *= factor);
            }
            Self::Any(values) => {
                let values = &values[frequency * column.len()..][..column.len()];
                column.iter_mut().zip(values).for_each(|(value, factor)| *value *= factor);
            }
        }
    }
}
