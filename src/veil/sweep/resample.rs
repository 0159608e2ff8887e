//! Up and down between lattices.

use pulp::Arch;
use rayon::prelude::*;

use super::{GROUP, Step};
use crate::veil::simd::{BLOCK, Into, Plane, Real, blend, deal, padded, shuffle, slide};

/// Rows of the two halves of a row.
struct Halves<T> {
    row: Vec<T>,
    even: Vec<T>,
    odd: Vec<T>,
}

impl<T: Real> Halves<T> {
    fn new(length: usize) -> Self {
        // What the taps read past a whole number of blocks.
        let half = padded(length) + BLOCK;
        let zeros = |length: usize| vec![T::default(); length];
        Self { row: zeros(2 * half), even: zeros(half), odd: zeros(half) }
    }
}

/// `taps` in this precision.
fn convert<T: Real>(taps: impl IntoIterator<Item = f64>) -> Vec<T> {
    taps.into_iter().map(T::from_f64).collect()
}

/// The moments on the next lattice.
pub(super) fn reduce<T: Real>(arch: Arch, from: &Plane<T>, step: &Step, coarse: &mut Plane<T>) {
    let up: Vec<T> = convert(step.up.iter().copied());
    // Of the row from `before` points on, those with an even index meet the first tap, the third, …
    let even: Vec<T> = convert(step.up.iter().step_by(2).copied());
    let odd: Vec<T> = convert(step.up.iter().skip(1).step_by(2).copied());
    let (width, points, stride) = (from.width(), coarse.width(), coarse.stride());
    let scratch = || (Halves::<T>::new(points), vec![T::default(); from.stride()]);
    coarse.par_groups_mut(GROUP / 2).enumerate().for_each_init(scratch, |(halves, column), (group, rows)| {
        for (row, out) in rows.chunks_exact_mut(stride).enumerate() {
            let first = (2 * (group * (GROUP / 2) + row)) as isize - step.before as isize;
            let taken =
                up.iter().enumerate().filter_map(|(tap, factor)| Some((from.get_row(first + tap as isize)?, *factor)));
            let taken: Vec<(&[T], T)> = taken.collect();
            blend(arch, &taken, column, Into::Set);
            halves.row[step.before..][..width].copy_from_slice(&column[..width]);
            deal(arch, &halves.row, &mut halves.even, &mut halves.odd);
            slide(arch, &halves.even, &even, out, Into::Set);
            slide(arch, &halves.odd, &odd, out, Into::Add);
        }
    });
}

/// What it takes to bring rows of a coarse lattice to the finer one.
pub(in crate::veil) struct Expansion<T> {
    even: Vec<T>,
    odd: Vec<T>,
    column: Vec<T>,
    halves: [Vec<T>; 2],
}

impl<T: Real> Expansion<T> {
    /// For rows of a coarse plane.
    pub(in crate::veil) fn new(step: &Step, coarse: &Plane<T>) -> Self {
        let zeros = |length: usize| vec![T::default(); length];
        Self {
            even: convert(step.even.iter().copied()),
            odd: convert(step.odd.iter().copied()),
            column: zeros(coarse.stride() + BLOCK),
            halves: [zeros(coarse.stride()), zeros(coarse.stride())],
        }
    }
}

/// Row `y` of the finer lattice.
pub(in crate::veil) fn expand_row<T: Real>(
    arch: Arch,
    coarse: &Plane<T>,
    expansion: &mut Expansion<T>,
    y: usize,
    out: &mut [T],
) {
    let Expansion { even, odd, column, halves: [first, second] } = expansion;
    let taps = if y.is_multiple_of(2) { &*even } else { &*odd };
    let rows =
        taps.iter().enumerate().filter_map(|(tap, factor)| Some((coarse.get_row((y / 2 + tap) as isize)?, *factor)));
    let rows: Vec<(&[T], T)> = rows.collect();
    let stride = coarse.stride();
    blend(arch, &rows, &mut column[..stride], Into::Set);
    slide(arch, column, even, first, Into::Set);
    slide(arch, column, odd, second, Into::Set);
    shuffle(arch, first, second, out);
}

/// The coarse lattice's sums on the finer one.
pub(in crate::veil) fn expand<T: Real>(arch: Arch, coarse: &Plane<T>, step: &Step, fine: &mut Plane<T>) {
    let stride = fine.stride();
    fine.par_groups_mut(GROUP).enumerate().for_each_init(
        || Expansion::new(step, coarse),
        |expansion, (group, rows)| {
            for (row, out) in rows.chunks_exact_mut(stride).enumerate() {
                expand_row(arch, coarse, expansion, group * GROUP + row, out);
            }
        },
    );
}
