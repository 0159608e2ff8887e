//! What carrying light to a lattice is off by.
//!
//! At a pixel y, the ghost of a light at c is I f(y − c) in place of f(y − c), I f the interpolation of the bell from the lattice's points: the
//! pixels are among these. So no pixel is off by more than Σ_p L_p |f − I f|(y − c_p). For the light of a pixel about another that is
//! `half a pixel` to either side, the largest of |f − I f| over as much is taken, and one convolution has the bound for all pixels, by
//! how the photo's light is spread.

use rayon::prelude::*;

use super::kernel::Kernel;
use super::lattice::{BEFORE, Lattice, ORDER, weights};
use super::seat::Seat;
use super::waves::{Rows, Waves};
use crate::fast_length::fast_length;

/// Places between two points that are looked at, and what may lie between them.
const BETWEEN: usize = 4;
const SAFE: f64 = 1.25;

/// What doubles lose in transforms, over all light at one place.
pub(super) const DOUBLES: f64 = 1e-13;

/// The bound of an image on a lattice.
pub(super) struct Envelope {
    waves: Waves,
    /// Of |f − I f|, about each pixel; none where nothing is off.
    kernel: Option<Rows>,
    /// Columns and rows of pixels that lights may be about, from the first on.
    first: [isize; 2],
    count: [usize; 2],
}

impl Envelope {
    pub fn new(seat: &Seat, lattice: &Lattice) -> Self {
        let margin = |axis: usize| lattice.far[axis] + ORDER as isize + 1;
        let near = [0, 1].map(|axis| -margin(axis)..seat.size()[axis] as isize + margin(axis));
        let count = near.each_ref().map(|near| (near.end - near.start) as usize);
        let first = near.map(|near| near.start);
        let far = [0, 1].map(|axis| {
            let reach = seat.reach_in_pixels()[axis] + (ORDER / 2) as f64 / lattice.finer as f64 + 2.0;
            (reach.min(1e9) as isize).min(count[axis] as isize)
        });
        let size = [0, 1].map(|axis| fast_length(count[axis].max(2 * far[axis] as usize + 1) + far[axis] as usize + 1));
        let waves = Waves::new(size);
        let kernel = (!lattice.exact).then(|| off_by(&waves, seat, lattice, far));
        Self { waves, kernel, first, count }
    }

    /// The largest error at any pixel of the window, in units of the field's scale, where no pixel of more than a weight is carried.
    pub fn largest(&self, seat: &Seat, weights: [f64; 3], alone_above: f64) -> f64 {
        let Some(kernel) = &self.kernel else { return 0.0 };
        let cells = self.cells(seat, weights, alone_above);
        let [columns, rows] = self.count;
        let width = self.waves.size[0] as isize;
        let light = self.waves.rows(self.first[1], rows, |row, real| {
            for (column, light) in (self.first[0]..).zip(&cells[row * columns..][..columns]) {
                real[column.rem_euclid(width) as usize] = *light;
            }
        });
        let mut sums = self.waves.sums(1);
        self.waves.add(&mut sums, kernel, &[light]);
        let [width, height] = seat.size();
        let mut largest = vec![0.0; width * height];
        self.waves.back(sums, width, &mut [&mut largest], |_, row, out| out.copy_from_slice(row));
        SAFE * largest.into_iter().fold(0.0, f64::max)
    }

    /// What the pixels weigh whose ghosts lie about each pixel of the window and near it.
    fn cells(&self, seat: &Seat, weights: [f64; 3], alone_above: f64) -> Vec<f64> {
        let [columns, rows] = self.count;
        let place = |axis: usize| -> Vec<Option<usize>> {
            let cell = |at: &f64| {
                let cell = at.round() - self.first[axis] as f64;
                (0.0..self.count[axis] as f64).contains(&cell).then_some(cell as usize)
            };
            seat.in_pixels(axis).iter().map(cell).collect()
        };
        let [across, down] = [place(0), place(1)];
        let mut sources: Vec<Vec<usize>> = vec![Vec::new(); rows];
        down.iter().enumerate().for_each(|(row, cell)| cell.iter().for_each(|&cell| sources[cell].push(row)));
        let mut cells = vec![0.0; columns * rows];
        cells.par_chunks_exact_mut(columns).zip(&sources).for_each(|(out, rows)| {
            for &row in rows {
                for (weight, cell) in seat.weights(row, weights).into_iter().zip(&across) {
                    if let Some(cell) = cell.filter(|_| weight <= alone_above) {
                        out[cell] += weight;
                    }
                }
            }
        });
        cells
    }
}

/// The transform of the largest |f − I f| within half a pixel of each pixel up to so far.
fn off_by(waves: &Waves, seat: &Seat, lattice: &Lattice, far: [isize; 2]) -> Rows {
    let width = waves.size[0] as isize;
    let fine = Fine::new(seat, lattice, far[0]);
    waves.rows(-far[1], 2 * far[1] as usize + 1, |row, real| {
        let largest = fine.row(row as isize - far[1]);
        for (offset, value) in (-far[0]..).zip(largest) {
            real[offset.rem_euclid(width) as usize] = value;
        }
    })
}

/// Places between the points of a lattice along a row of pixels.
struct Fine<'a> {
    seat: &'a Seat<'a>,
    kernel: Kernel<'a>,
    finer: isize,
    far: isize,
    /// x of the points, and of the places.
    points: Vec<f64>,
    places: Vec<f64>,
    weights: [[f64; ORDER]; BETWEEN],
}

impl<'a> Fine<'a> {
    fn new(seat: &'a Seat, lattice: &Lattice, far: isize) -> Self {
        let (finer, side) = (lattice.finer, seat.frame.pixel_sides().x);
        let between = BETWEEN as isize;
        // From half a pixel before the first pixel to half a pixel after the last; points from a stencil's beginning on.
        let [first, last] = Self::ends(-far, far, finer);
        let point = |place: isize| place.div_euclid(between);
        let points = point(first) - BEFORE..=point(last) + BEFORE + 1;
        let points = points.map(|point| point as f64 / finer as f64 * side).collect();
        let places = (first..=last).map(|place| place as f64 / (between * finer) as f64 * side).collect();
        let weights = std::array::from_fn(|place| weights(place as f64 / BETWEEN as f64));
        Self { seat, kernel: Kernel::new(&seat.image.ghost), finer, far, points, places, weights }
    }

    /// The places within half a pixel of some pixels.
    fn ends(first: isize, last: isize, finer: isize) -> [isize; 2] {
        let all = BETWEEN as isize * finer;
        [first * all - all / 2, last * all + all / 2]
    }

    /// A row of the bell, at the points, carried to the places.
    fn interpolated(&self, y: f64) -> Vec<f64> {
        let mut values = vec![0.0; self.points.len()];
        self.kernel.row(&self.points, y, &mut values);
        let [first, last] = Self::ends(-self.far, self.far, self.finer);
        let start = first.div_euclid(BETWEEN as isize);
        let one = |place: isize| {
            let from = (place.div_euclid(BETWEEN as isize) - start) as usize;
            let weights = &self.weights[place.rem_euclid(BETWEEN as isize) as usize];
            weights.iter().zip(&values[from..]).map(|(weight, value)| weight * value).sum()
        };
        (first..=last).map(one).collect()
    }

    /// The largest error about each pixel of a row.
    fn row(&self, row: isize) -> Vec<f64> {
        let (between, side) = (BETWEEN as isize, self.seat.frame.pixel_sides().y);
        let [first, last] = Self::ends(row, row, self.finer);
        // Rows are counted downwards.
        let y = |points: f64| -points / self.finer as f64 * side;
        let points = first.div_euclid(between) - BEFORE..=last.div_euclid(between) + BEFORE + 1;
        let start = *points.start();
        let rows: Vec<Vec<f64>> = points.map(|point| self.interpolated(y(point as f64))).collect();
        let mut worst = vec![0.0f64; self.places.len()];
        let (mut truth, mut sum) = (vec![0.0; self.places.len()], vec![0.0; self.places.len()]);
        for place in first..=last {
            self.kernel.row(&self.places, y(place as f64 / between as f64), &mut truth);
            sum.fill(0.0);
            let from = (place.div_euclid(between) - BEFORE - start) as usize;
            let weights = &self.weights[place.rem_euclid(between) as usize];
            for (weight, row) in weights.iter().zip(&rows[from..]).filter(|(weight, _)| **weight != 0.0) {
                sum.iter_mut().zip(row).for_each(|(sum, value)| *sum += weight * value);
            }
            let off = truth.iter().zip(&sum).map(|(truth, sum)| (truth - sum).abs());
            worst.iter_mut().zip(off).for_each(|(worst, off)| *worst = worst.max(off));
        }
        let each = (between * self.finer) as usize;
        (0..2 * self.far as usize + 1)
            .map(|pixel| worst[pixel * each..=(pixel + 1) * each].iter().fold(0.0, |worst: f64, off| worst.max(*off)))
            .collect()
    }
}
