//! Pixel by pixel: each that shines at each that its ghost reaches.

use rayon::prelude::*;

use super::Sheet;
use super::kernel::Kernel;
use super::seat::{Seat, within};
use crate::series::Bell;

/// Rows of the window that a task takes.
const ROWS: usize = 16;

/// Nanoseconds for each pixel that a ghost reaches, and for each ghost beside.
pub(super) fn cost(seat: &Seat, ghosts: f64) -> f64 {
    const ADDED: f64 = 1.5;
    const GHOST: f64 = 500.0;
    let [_, across] = seat.reached(0);
    let [_, down] = seat.reached(1);
    ghosts * (GHOST + across * down * (ADDED + value(&seat.image.ghost.bell)))
}

/// What a value of a bell takes, in nanoseconds.
pub(super) fn value(bell: &Bell) -> f64 {
    match bell {
        Bell::Parabola | Bell::Paraboloid => 2.0,
        Bell::Disc(disc) if disc.is_round() => 4.0,
        Bell::Disc(_) => 10.0,
        Bell::Iris(iris) => 2.0 + 0.7 * f64::from(iris.blades()),
        _ => 15.0,
    }
}

/// How many pixels of more than a weight, or that shine at all, have ghosts that reach the window.
pub(super) fn shining(seat: &Seat, weights: [f64; 3], above: f64) -> usize {
    let [columns, rows] = reaching(seat);
    rows.into_par_iter().map(|row| bright(seat, row, columns.clone(), weights, above).len()).sum()
}

/// Columns and rows of pixels whose ghosts may reach the window.
pub(super) fn reaching(seat: &Seat) -> [std::ops::Range<usize>; 2] {
    [0, 1].map(|axis| {
        let places = &seat.places[axis];
        let [one, other] = [places[0], places[places.len() - 1]];
        within(&seat.centres[axis], one.min(other) - seat.reach[axis], one.max(other) + seat.reach[axis])
    })
}

/// Those of a row's pixels that weigh more.
fn bright(seat: &Seat, row: usize, columns: std::ops::Range<usize>, weights: [f64; 3], above: f64) -> Vec<usize> {
    let all = seat.weights(row, weights);
    columns.filter(|&column| all[column] > above).collect()
}

/// Adds the ghosts of all pixels that shine.
pub(super) fn add(seat: &Seat, weights: [f64; 3], sheet: &mut Sheet) {
    let shape = seat.image.ghost.bell.shape();
    let over = |xs: &[f64], ys: &[f64], visit: &mut dyn FnMut(usize, &[f64])| {
        shape.over(xs, ys, seat.image.ghost.size, visit);
    };
    add_by(seat, weights, 0.0, &over, sheet);
}

/// Adds the ghosts of the pixels of more than a weight, less their steps.
pub(super) fn add_bright(seat: &Seat, weights: [f64; 3], above: f64, sheet: &mut Sheet) {
    let kernel = Kernel::new(&seat.image.ghost);
    let over = |xs: &[f64], ys: &[f64], visit: &mut dyn FnMut(usize, &[f64])| {
        let mut row = vec![0.0; xs.len()];
        for (index, y) in ys.iter().enumerate() {
            kernel.row(xs, *y, &mut row);
            visit(index, &row);
        }
    };
    add_by(seat, weights, above, &over, sheet);
}

/// The bell at columns and rows of offsets, row by row.
type Over<'a> = dyn Fn(&[f64], &[f64], &mut dyn FnMut(usize, &[f64])) + Sync + 'a;

fn add_by(seat: &Seat, weights: [f64; 3], above: f64, over: &Over<'_>, sheet: &mut Sheet) {
    let [columns, rows] = reaching(seat);
    let all: Vec<(usize, Vec<usize>)> = rows
        .into_par_iter()
        .map(|row| (row, bright(seat, row, columns.clone(), weights, above)))
        .filter(|(_, bright)| !bright.is_empty())
        .collect();
    let width = sheet.width;
    let [red, green, blue] = &mut sheet.planes;
    let planes =
        red.par_chunks_mut(ROWS * width).zip(green.par_chunks_mut(ROWS * width)).zip(blue.par_chunks_mut(ROWS * width));
    planes.enumerate().with_max_len(1).for_each(|(number, ((red, green), blue))| {
        let places = &seat.places[1][number * ROWS..][..red.len() / width];
        let mut band = Band { seat, width, planes: [red, green, blue] };
        for (row, bright) in &all {
            let centre = seat.centres[1][*row];
            let near = within(places, centre - seat.reach.y, centre + seat.reach.y);
            let ys: Vec<f64> = places[near.clone()].iter().map(|place| place - centre).collect();
            if !ys.is_empty() {
                bright.iter().for_each(|column| band.add([*row, *column], near.start, &ys, over));
            }
        }
    });
}

/// Some rows of the window.
struct Band<'a> {
    seat: &'a Seat<'a>,
    width: usize,
    planes: [&'a mut [f64]; 3],
}

impl Band<'_> {
    /// Adds the ghost of one pixel on some of its rows, from the first on.
    fn add(&mut self, [row, column]: [usize; 2], first: usize, ys: &[f64], over: &Over<'_>) {
        let (seat, centre) = (self.seat, self.seat.centres[0][column]);
        let near = within(&seat.places[0], centre - seat.reach.x, centre + seat.reach.x);
        if near.is_empty() {
            return;
        }
        let xs: Vec<f64> = seat.places[0][near.clone()].iter().map(|place| place - centre).collect();
        let light = [0, 1, 2].map(|colour| {
            let (light, factor) = seat.light(row, colour);
            seat.image.ghost.radiance[colour] * factor * f64::from(light[column])
        });
        over(&xs, ys, &mut |index, values| {
            let from = (first + index) * self.width + near.start;
            for (plane, light) in self.planes.iter_mut().zip(light) {
                let out = &mut plane[from..][..values.len()];
                out.iter_mut().zip(values).for_each(|(out, value)| *out += light * value);
            }
        });
    }
}
