//! A kernel by the offsets between pixels.

use std::fmt;

use rayon::prelude::*;

use crate::veil::error::Error;
use crate::veil::photo::exp2;
use crate::veil::picture::Picture;

/// The offsets along one dimension: from −`before` to `after`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Axis {
    pub before: usize,
    pub after: usize,
    /// The values at offsets of either sign are the same, and kept once.
    even: bool,
}

impl Axis {
    fn even(reach: usize) -> Self {
        Self { before: reach, after: reach, even: true }
    }

    /// How many values are kept.
    pub fn kept(self) -> usize {
        self.after + 1 + if self.even { 0 } else { self.before }
    }

    /// How many offsets there are.
    pub fn offsets(self) -> usize {
        self.before + self.after + 1
    }

    /// Where the value at an offset is kept.
    pub fn index(self, offset: isize) -> Option<usize> {
        if offset < -(self.before as isize) || offset > self.after as isize {
            return None;
        }
        let origin = if self.even { 0 } else { self.before as isize };
        Some(if self.even { offset.unsigned_abs() } else { (origin + offset) as usize })
    }

    /// The same for the offset that stands at `place` of a period.
    pub fn wrapped(self, place: usize, period: usize) -> Option<usize> {
        let offset = place as isize;
        self.index(if place <= self.after { offset } else { offset - period as isize })
    }
}

/// Values by offset, from a source to a target.
#[derive(Clone, PartialEq)]
pub(super) struct Taps {
    pub columns: Axis,
    pub rows: Axis,
    /// Rows of columns, times 2^−`exponent`: the largest is from ½ to 1. 0 at the source itself.
    pub values: Vec<f64>,
    pub exponent: i32,
}

impl fmt::Debug for Taps {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut told = formatter.debug_struct("Taps");
        told.field("columns", &self.columns).field("rows", &self.rows).finish_non_exhaustive()
    }
}

impl Taps {
    /// Of a function of the distance in pixels, up to `most` columns and rows apart.
    pub fn of_profile(value: impl Fn(f64) -> f64 + Sync, most: [usize; 2], signed: bool) -> Result<Self, Error> {
        let [columns, rows] = most.map(Axis::even);
        let width = columns.kept();
        let mut values = vec![0.0; width * rows.kept()];
        let rows_of = values.par_chunks_exact_mut(width).enumerate();
        rows_of.for_each(|(y, row)| {
            let at = |x: usize| value((x as f64).hypot(y as f64));
            row.iter_mut().enumerate().for_each(|(x, into)| *into = at(x));
        });
        values[0] = 0.0;
        if let Some(index) = values.par_iter().position_first(|value| !value.is_finite() || *value < 0.0 && !signed) {
            let distance = ((index % width) as f64).hypot((index / width) as f64);
            let rule = if signed { "a number" } else { "a number that is not negative" };
            return Err(Error::Kernel(format!(
                "the kernel of a veil is {rule}, and not {} at {distance:.2} pixels",
                values[index]
            )));
        }
        Ok(Self { columns, rows, values, exponent: 0 }.trimmed().scaled())
    }

    /// Of a channel of a picture, up to `most` columns and rows apart.
    pub fn of_picture(picture: &Picture, channel: usize, most: [usize; 2]) -> Self {
        let [columns, rows] = [0, 1].map(|side| Axis {
            before: picture.centre()[side].min(most[side]),
            after: (picture.size()[side] - 1 - picture.centre()[side]).min(most[side]),
            even: false,
        });
        let offsets = |axis: Axis| -(axis.before as isize)..=axis.after as isize;
        let at = |offset: [isize; 2]| if offset == [0, 0] { 0.0 } else { picture.at(offset)[channel] };
        let values = offsets(rows).flat_map(|y| offsets(columns).map(move |x| [x, y])).map(at).collect();
        Self { columns, rows, values, exponent: 0 }.trimmed().folded().scaled()
    }

    /// The value at an offset of columns and rows, times 2^−exponent.
    pub fn at(&self, [x, y]: [isize; 2]) -> f64 {
        match (self.columns.index(x), self.rows.index(y)) {
            (Some(column), Some(row)) => self.values[row * self.columns.kept() + column],
            _ => 0.0,
        }
    }

    /// The row of an offset of rows.
    pub fn row(&self, y: isize) -> Option<&[f64]> {
        let width = self.columns.kept();
        self.rows.index(y).map(|row| &self.values[row * width..][..width])
    }

    /// Whether offsets of either sign have the same value, which makes the transform real.
    pub fn is_even(&self) -> bool {
        self.columns.even && self.rows.even
    }

    /// The sum of what `of` makes of each value, over all offsets.
    pub fn sum(&self, of: impl Fn(f64) -> f64 + Sync) -> f64 {
        let width = self.columns.kept();
        let twice = |axis: Axis, index: usize| if axis.even && index > 0 { 2.0 } else { 1.0 };
        let row = |(y, row): (usize, &[f64])| {
            let each = row.iter().enumerate().map(|(x, value)| twice(self.columns, x) * of(*value));
            twice(self.rows, y) * each.sum::<f64>()
        };
        // Row by row in their order, so that a sum is the same every time.
        self.values.par_chunks_exact(width).enumerate().map(row).collect::<Vec<f64>>().iter().sum()
    }

    /// Whether some value is negative.
    pub fn is_signed(&self) -> bool {
        self.values.par_iter().any(|value| *value < 0.0)
    }

    /// Without rows and columns of zeros at its ends.
    fn trimmed(self) -> Self {
        let width = self.columns.kept();
        let some_row = |row: usize| self.values[row * width..][..width].iter().any(|value| *value != 0.0);
        let some_column = |x: usize| self.values.chunks_exact(width).any(|row| row[x] != 0.0);
        let rows = cut(self.rows, some_row);
        let columns = cut(self.columns, some_column);
        if (columns, rows) == (self.columns, self.rows) {
            return self;
        }
        let first = [(self.columns, columns), (self.rows, rows)]
            .map(|(was, is)| if is.even { 0 } else { was.before - is.before });
        let row = |y: usize| &self.values[(first[1] + y) * width + first[0]..][..columns.kept()];
        let values = (0..rows.kept()).flat_map(row).copied().collect();
        Self { columns, rows, values, exponent: self.exponent }
    }

    /// A kernel that is its own mirror image in both directions, kept once.
    fn folded(self) -> Self {
        let (columns, rows) = (self.columns, self.rows);
        if columns.before != columns.after || rows.before != rows.after {
            return self;
        }
        let offsets = |axis: Axis| 0..=axis.after as isize;
        let same = |x: isize, y: isize| {
            let value = self.at([x, y]);
            [[-x, y], [x, -y], [-x, -y]].iter().all(|offset| self.at(*offset) == value)
        };
        if !offsets(rows).all(|y| offsets(columns).all(|x| same(x, y))) {
            return self;
        }
        let values = offsets(rows).flat_map(|y| offsets(columns).map(move |x| [x, y])).map(|at| self.at(at)).collect();
        Self { columns: Axis::even(columns.after), rows: Axis::even(rows.after), values, exponent: self.exponent }
    }

    /// By a power of two that takes the largest value to between ½ and 1, so that squares of all that counts can be had.
    fn scaled(mut self) -> Self {
        let largest = self.values.par_iter().copied().map(f64::abs).reduce(|| 0.0, f64::max);
        if largest > 0.0 {
            self.exponent = (largest.log2().floor() as i32 + 1).clamp(-1000, 1000);
            let scale = exp2(-self.exponent);
            self.values.par_iter_mut().for_each(|value| *value *= scale);
        }
        self
    }
}

/// The offsets of an axis without those at its ends that have nothing.
fn cut(axis: Axis, has: impl Fn(usize) -> bool) -> Axis {
    if axis.even {
        return Axis::even((0..=axis.after).rev().find(|offset| has(*offset)).unwrap_or(0));
    }
    let before = (1..=axis.before).rev().find(|offset| has(axis.before - offset)).unwrap_or(0);
    let after = (1..=axis.after).rev().find(|offset| has(axis.before + offset)).unwrap_or(0);
    Axis { before, after, even: false }
}
