//! Rows of floats, by the widest vectors that the processor has.
//!
//! Rows are padded to whole blocks of [`BLOCK`] floats, so that loops over them have no remainders. What stands in the padding of
//! a result means nothing.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Floats that rows are padded to: four of the widest vectors.
pub(super) const BLOCK: usize = 64;

/// Vectors that a loop carries at a time, which hides the latency of multiply-adds.
const CARRIED: usize = 4;

/// f32 and f64.
pub trait Real:
    Copy + Default + Send + Sync + std::ops::Mul<Output = Self> + std::ops::Add<Output = Self> + 'static
{
    /// As many as the processor takes at a time.
    type Vector<S: Simd>: Copy;
    /// Half the distance from 1 to the next number.
    const UNIT: f64;

    /// The nearest number.
    fn from_f64(value: f64) -> Self;
    /// The value in each lane.
    fn splat<S: Simd>(simd: S, value: Self) -> Self::Vector<S>;
    /// a b + c, rounded once where the processor can, and twice where it cannot.
    fn mul_add<S: Simd>(simd: S, a: Self::Vector<S>, b: Self::Vector<S>, c: Self::Vector<S>) -> Self::Vector<S>;
    /// Whole vectors of the front of `values`.
    fn vectors<S: Simd>(values: &[Self]) -> &[Self::Vector<S>];
    /// The same, to be written.
    fn vectors_mut<S: Simd>(values: &mut [Self]) -> &mut [Self::Vector<S>];
}

macro_rules! real {
    ($type:ty, $vector:ident, $splat:ident, $mul_add:ident, $vectors:ident, $vectors_mut:ident) => {
        impl Real for $type {
            type Vector<S: Simd> = S::$vector;
            const UNIT: f64 = <$type>::EPSILON as f64 / 2.0;

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $type
            }

            #[inline(always)]
            fn splat<S: Simd>(simd: S, value: Self) -> S::$vector {
                simd.$splat(value)
            }

            #[inline(always)]
            fn mul_add<S: Simd>(simd: S, a: S::$vector, b: S::$vector, c: S::$vector) -> S::$vector {
                simd.$mul_add(a, b, c)
            }

            #[inline(always)]
            fn vectors<S: Simd>(values: &[Self]) -> &[S::$vector] {
                S::$vectors(values).0
            }

            #[inline(always)]
            fn vectors_mut<S: Simd>(values: &mut [Self]) -> &mut [S::$vector] {
                S::$vectors_mut(values).0
            }
        }
    };
}

real!(f32, f32s, splat_f32s, mul_add_e_f32s, as_simd_f32s, as_mut_simd_f32s);
real!(f64, f64s, splat_f64s, mul_add_e_f64s, as_simd_f64s, as_mut_simd_f64s);

/// A grid of numbers in rows; the rows are padded.
#[derive(Debug, Clone)]
pub struct Plane<T> {
    width: usize,
    height: usize,
    stride: usize,
    data: Vec<T>,
}

impl<T: Real> Plane<T> {
    /// Zeros.
    pub fn new(width: usize, height: usize) -> Self {
        let stride = padded(width);
        Self { width, height, stride, data: vec![T::default(); stride * height] }
    }

    /// Another of its values, padding included.
    pub fn map<U: Real>(&self, of: impl Fn(T) -> U) -> Plane<U> {
        let Self { width, height, stride, ref data } = *self;
        Plane { width, height, stride, data: data.iter().map(|value| of(*value)).collect() }
    }

    /// Columns that mean something.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// A row, padding included.
    pub fn row(&self, y: usize) -> &[T] {
        &self.data[y * self.stride..][..self.stride]
    }

    /// A row to be written.
    pub(super) fn row_mut(&mut self, y: usize) -> &mut [T] {
        &mut self.data[y * self.stride..][..self.stride]
    }

    /// A row if there is one.
    pub(super) fn get_row(&self, y: isize) -> Option<&[T]> {
        (0..self.height as isize).contains(&y).then(|| self.row(y as usize))
    }

    /// All rows from one on.
    pub(super) fn rows_from_mut(&mut self, y: usize) -> &mut [T] {
        &mut self.data[y * self.stride..]
    }

    /// All rows, for many threads.
    pub(super) fn par_rows_mut(&mut self) -> impl IndexedParallelIterator<Item = &mut [T]> {
        self.data.par_chunks_mut(self.stride).with_min_len(8)
    }

    /// Rows by groups of `rows`, for many threads.
    pub(super) fn par_groups_mut(&mut self, rows: usize) -> impl IndexedParallelIterator<Item = &mut [T]> {
        self.data.par_chunks_mut(self.stride * rows)
    }

    /// Floats from a row to the next.
    pub(super) fn stride(&self) -> usize {
        self.stride
    }
}

/// The least number of whole blocks that holds `length` floats.
pub(super) fn padded(length: usize) -> usize {
    length.next_multiple_of(BLOCK)
}

/// Whether a result is added to what stands there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Into {
    Set,
    Add,
}

/// out\[x\] = Σ taps\[i\] values[x + i], for whole blocks: `values` has `out.len() + taps.len() − 1` floats at least.
pub(super) fn slide<T: Real>(arch: Arch, values: &[T], taps: &[T], out: &mut [T], into: Into) {
    arch.dispatch(Slide { values, taps, out, into });
}

struct Slide<'a, T> {
    values: &'a [T],
    taps: &'a [T],
    out: &'a mut [T],
    into: Into,
}

impl<T: Real> WithSimd for Slide<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { values, taps, out, into } = self;
        let length = out.len();
        let blocks = T::vectors_mut::<S>(out).chunks_exact_mut(CARRIED);
        let floats = length / blocks.len().max(1);
        for (block, out) in blocks.enumerate() {
            let mut sums = [T::splat(simd, T::default()); CARRIED];
            if into == Into::Add {
                sums.copy_from_slice(out);
            }
            let window = &values[block * floats..][..floats + taps.len() - 1];
            for (values, tap) in window.windows(floats).zip(taps) {
                let tap = T::splat(simd, *tap);
                let values = &T::vectors::<S>(values)[..CARRIED];
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum = T::mul_add(simd, tap, *value, *sum);
                }
            }
            out.copy_from_slice(&sums);
        }
    }
}

/// out\[x\] = Σ factor · row\[x\] over `rows`, each at least as long as `out`, for whole blocks.
pub(super) fn blend<T: Real>(arch: Arch, rows: &[(&[T], T)], out: &mut [T], into: Into) {
    arch.dispatch(Blend { rows, out, into });
}

struct Blend<'a, 'b, T> {
    rows: &'a [(&'b [T], T)],
    out: &'a mut [T],
    into: Into,
}

impl<T: Real> WithSimd for Blend<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { rows, out, into } = self;
        let length = out.len();
        let blocks = T::vectors_mut::<S>(out).chunks_exact_mut(CARRIED);
        let floats = length / blocks.len().max(1);
        for (block, out) in blocks.enumerate() {
            let mut sums = [T::splat(simd, T::default()); CARRIED];
            if into == Into::Add {
                sums.copy_from_slice(out);
            }
            for (row, factor) in rows {
                let factor = T::splat(simd, *factor);
                let values = &T::vectors::<S>(&row[block * floats..][..floats])[..CARRIED];
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum = T::mul_add(simd, factor, *value, *sum);
                }
            }
            out.copy_from_slice(&sums);
        }
    }
}

/// Every second float to `even`, those between to `odd`; `values` has twice as many as either.
pub(super) fn deal<T: Real>(arch: Arch, values: &[T], even: &mut [T], odd: &mut [T]) {
    arch.dispatch(Deal { values, even, odd });
}

struct Deal<'a, T> {
    values: &'a [T],
    even: &'a mut [T],
    odd: &'a mut [T],
}

impl<T: Real> WithSimd for Deal<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (([first, second], even), odd) in self.values.as_chunks().0.iter().zip(self.even).zip(self.odd) {
            (*even, *odd) = (*first, *second);
        }
    }
}

/// The reverse.
pub(super) fn shuffle<T: Real>(arch: Arch, even: &[T], odd: &[T], out: &mut [T]) {
    arch.dispatch(Shuffle { even, odd, out });
}

struct Shuffle<'a, T> {
    even: &'a [T],
    odd: &'a [T],
    out: &'a mut [T],
}

impl<T: Real> WithSimd for Shuffle<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (([first, second], even), odd) in self.out.as_chunks_mut().0.iter_mut().zip(self.even).zip(self.odd) {
            (*first, *second) = (*even, *odd);
        }
    }
}
