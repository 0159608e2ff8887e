//! Separable kernels.

use pulp::Arch;
use rayon::prelude::*;

use super::GROUP;
use crate::veil::simd::{BLOCK, Into, Plane, Real, blend, padded, slide};

/// A kernel that is the product of one along rows, with the weight, and one along columns.
#[derive(Debug, Clone)]
pub(crate) struct Separable<T> {
    /// From −radius to radius.
    pub across: Vec<T>,
    /// From −radius to radius.
    pub down: Vec<T>,
}

impl<T: Real> Separable<T> {
    /// Of one half of the kernel, from 0 on.
    pub(in crate::veil) fn new(half: &[f64], weight: f64) -> Self {
        let whole = || half.iter().skip(1).rev().chain(half);
        let convert = |factor: f64| whole().map(|tap| T::from_f64(factor * tap)).collect();
        Self { across: convert(weight), down: convert(1.0) }
    }

    pub(in crate::veil) fn radius(&self) -> usize {
        self.across.len() / 2
    }
}

/// What a group of rows needs, kept from one to the next.
pub(in crate::veil) struct Scratch<T> {
    /// A row with room before and after it.
    row: Vec<T>,
    /// Rows that have been convolved across.
    rows: Vec<T>,
}

impl<T: Real> Scratch<T> {
    pub(in crate::veil) fn new() -> Self {
        Self { row: Vec::new(), rows: Vec::new() }
    }

    fn fit(&mut self, radius: usize, width: usize, rows: usize) {
        self.row.clear();
        self.row.resize(padded(width) + 2 * radius + BLOCK, T::default());
        let all = padded(width) * (rows + 2 * radius);
        if self.rows.len() < all {
            self.rows.resize(all, T::default());
        }
    }
}

/// `from` convolved by `kernel`, nothing outside it, added to `sum` or set.
pub(in crate::veil) fn convolve<T: Real>(
    arch: Arch,
    from: &Plane<T>,
    kernel: &Separable<T>,
    sum: &mut Plane<T>,
    into: Into,
) {
    let stride = sum.stride();
    // A group of few rows would convolve more rows across than it has.
    let group = GROUP.max(2 * kernel.radius());
    sum.par_groups_mut(group).enumerate().for_each_init(Scratch::new, |scratch, (index, rows)| {
        convolve_rows(
            arch,
            from,
            kernel,
            scratch,
            index * group,
            &mut rows.chunks_exact_mut(stride).collect::<Vec<_>>(),
            into,
        );
    });
}

/// Rows from `first` on.
pub(in crate::veil) fn convolve_rows<T: Real>(
    arch: Arch,
    from: &Plane<T>,
    kernel: &Separable<T>,
    scratch: &mut Scratch<T>,
    first: usize,
    out: &mut [&mut [T]],
    into: Into,
) {
    let (radius, width, stride) = (kernel.radius(), from.width(), from.stride());
    scratch.fit(radius, width, out.len());
    let Scratch { row, rows: across } = scratch;
    let above = |y: usize| (first + y) as isize - radius as isize;
    for (y, across) in across.chunks_exact_mut(stride).take(out.len() + 2 * radius).enumerate() {
        if let Some(values) = from.get_row(above(y)) {
            row[radius..][..width].copy_from_slice(&values[..width]);
            slide(arch, row, &kernel.across, across, Into::Set);
        }
    }
    let mut taken: Vec<(&[T], T)> = Vec::with_capacity(kernel.down.len());
    for (y, out) in out.iter_mut().enumerate() {
        taken.clear();
        let present = (0..kernel.down.len()).filter(|tap| from.get_row(above(y + tap)).is_some());
        taken.extend(present.map(|tap| (&across[(y + tap) * stride..][..stride], kernel.down[tap])));
        blend(arch, &taken, out, into);
    }
}
