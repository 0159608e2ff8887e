//! Bells that are products along x and y: a sum along each row of the photo for each column that is wanted, then one along columns.

use glam::DVec2;
use ndarray::{Array2, Axis, s};
use rayon::prelude::*;

use super::Sheet;
use super::seat::{Seat, within};

/// Nanoseconds that they take.
pub(super) fn cost(seat: &Seat) -> f64 {
    const PRODUCT: f64 = 0.4;
    let [width, height] = seat.size().map(|side| side as f64);
    let [columns, across] = seat.reached(0);
    let [rows, down] = seat.reached(1);
    3.0 * PRODUCT * (rows * (columns * across + 8.0 * width) + width * (rows * down + 8.0 * height))
}

/// What each place along an axis has of the centres in its reach: which, and the bell's factor for each.
fn factors(seat: &Seat, axis: usize, value: impl Fn(f64) -> f64) -> Vec<(std::ops::Range<usize>, Vec<f64>)> {
    let centres = &seat.centres[axis];
    let one = |place: &f64| {
        let range = within(centres, place - seat.reach[axis], place + seat.reach[axis]);
        let values = centres[range.clone()].iter().map(|centre| value(place - centre)).collect();
        (range, values)
    };
    seat.places[axis].iter().map(one).collect()
}

/// Adds an image.
pub(super) fn add(seat: &Seat, sheet: &mut Sheet) {
    let ghost = &seat.image.ghost;
    let (shape, size) = (ghost.bell.shape(), ghost.size);
    let peak = shape.value(DVec2::ZERO, size);
    let across = factors(seat, 0, |x| shape.value(DVec2::new(x, 0.0), size));
    let down = factors(seat, 1, |y| shape.value(DVec2::new(0.0, y), size) / peak);
    let (width, rows) = (seat.size()[0], seat.sources()[1]);
    // Rows that nothing wanted meets.
    let mut met = vec![false; rows];
    down.iter().for_each(|(range, _)| met[range.clone()].fill(true));
    let mut along = Array2::<f64>::zeros((rows, 3 * width));
    along.axis_iter_mut(Axis(0)).into_par_iter().enumerate().filter(|(row, _)| met[*row]).for_each(
        |(row, mut along)| {
            for (column, (range, factors)) in across.iter().enumerate() {
                let sums = seat.raster.along_row(row, range.clone(), factors);
                sums.into_iter().enumerate().for_each(|(colour, sum)| along[colour * width + column] = sum);
            }
        },
    );
    for (colour, plane) in sheet.planes.iter_mut().enumerate() {
        let radiance = ghost.radiance[colour];
        let along = along.slice(s![.., colour * width..(colour + 1) * width]);
        plane.par_chunks_mut(width).zip(&down).for_each(|(out, (range, factors))| {
            for (row, factor) in range.clone().zip(factors) {
                let factor = radiance * factor;
                out.iter_mut().zip(along.row(row)).for_each(|(out, value)| *out += factor * value);
            }
        });
    }
}
