//! Light carried to a lattice that the pixels are points of, and convolved there.
//!
//! A lattice of n points a pixel is n² lattices of one each. Each of these gets its part of the light, is convolved with the bell as it is
//! seen from there, and all are added up before the one transform back: what is held does not grow with n.

use std::ops::Range;

use rayon::prelude::*;

use super::Sheet;
use super::kernel::Kernel;
use super::seat::Seat;
use super::waves::{Rows, Waves};
use crate::fast_length::fast_length;
use crate::frame::Frame;
use crate::problem::{Image, Images};

/// Points along an axis that a pixel's light is carried to.
pub(super) const ORDER: usize = 8;

/// The first of them, counted from the one before a place.
pub(super) const BEFORE: isize = ORDER as isize / 2 - 1;

/// How far from points, in steps, all centres may be that are said to stand on them.
const SAME: f64 = 1e-10;

/// A lattice, as an image needs it.
pub(super) struct Lattice {
    pub finer: isize,
    /// Whether every pixel's ghost stands on a point, so that nothing is interpolated.
    pub exact: bool,
    /// From the pixels to the points next to them, in pixels: not 0 only where the points are made to stand where all ghosts do.
    shift: [f64; 2],
    pub axes: [Carried; 2],
    /// The length of transforms, and as far as a bell is looked at, in pixels.
    pub size: [usize; 2],
    pub far: [isize; 2],
}

/// What is carried along an axis.
pub(super) struct Carried {
    /// The sources whose ghosts may reach the window, each with the first of its points and their weights.
    taps: Vec<(usize, isize, [f64; ORDER])>,
    /// Pixels that these points belong to.
    pub pixels: Range<isize>,
}

impl Lattice {
    /// None where no ghost reaches the window.
    pub fn new(seat: &Seat, finer: u32) -> Option<Self> {
        let centres = [0, 1].map(|axis| seat.in_pixels(axis));
        let n = f64::from(finer);
        let steps = |at: f64| at - at.floor();
        let stands = |centres: &Vec<f64>| {
            let first = centres[0] * n;
            centres.iter().all(|centre| ((centre * n - first) - (centre * n - first).round()).abs() < SAME)
        };
        let exact = centres.iter().all(stands);
        let shift = centres.each_ref().map(|centres| if exact { steps(centres[0] * n) / n } else { 0.0 });
        let axis = |axis: usize| {
            let end = seat.reach_in_pixels()[axis] + ORDER as f64 / n + 1.0;
            let count = seat.size()[axis] as f64;
            let near = |at: &f64| (-end..=count - 1.0 + end).contains(at);
            let tap = |(source, at): (usize, &f64)| {
                let place = (at - shift[axis]) * n;
                let place = if exact { place.round() } else { place };
                (source, place.floor() as isize - BEFORE, weights(place - place.floor()))
            };
            let taps: Vec<_> = centres[axis].iter().enumerate().filter(|(_, at)| near(at)).map(tap).collect();
            let pixel = |point: isize| point.div_euclid(finer as isize);
            let first = taps.iter().map(|(_, first, _)| pixel(*first)).min()?;
            let end = taps.iter().map(|(_, first, _)| pixel(first + ORDER as isize - 1) + 1).max()?;
            Some(Carried { taps, pixels: first..end })
        };
        let axes = [axis(0)?, axis(1)?];
        let mut far = [0; 2];
        let size = [0, 1].map(|axis| {
            let (Range { start, end }, count) = (axes[axis].pixels.clone(), seat.size()[axis] as isize);
            let widest = end.max(count - start);
            far[axis] = (seat.reach_in_pixels()[axis].min(1e9) as isize + 3).min(widest);
            // Nothing wraps onto the window, and what is carried has room.
            let least = (far[axis] + widest).max(2 * far[axis] + 1).max(end - start).max(count);
            fast_length(least as usize)
        });
        Some(Self { finer: finer as isize, exact, shift, axes, size, far })
    }
}

/// Lagrange's polynomials of the points of a stencil, at `u` from 0 to 1 after the one that is before the place.
pub(super) fn weights(u: f64) -> [f64; ORDER] {
    let node = |k: usize| k as f64 - BEFORE as f64;
    std::array::from_fn(|k| {
        let others = (0..ORDER).filter(|other| *other != k);
        others.map(|other| (u - node(other)) / (node(k) - node(other))).product()
    })
}

/// Bytes that an image takes on a lattice.
pub(super) fn memory(images: &Images, image: &Image, frame: Frame) -> u64 {
    // Rows that are carried, of three colours, three half spectra of those, one of the bell, and three sums.
    const EACH: u64 = 80;
    let seat = Seat::new(images, image, frame);
    Lattice::new(&seat, 1).map_or(0, |lattice| EACH * lattice.size.iter().product::<usize>() as u64)
}

/// Nanoseconds that it takes.
pub(super) fn cost(seat: &Seat, lattice: &Lattice) -> f64 {
    const TRANSFORM: f64 = 14.0;
    const CARRIED: f64 = 1.0;
    let points = lattice.size.iter().product::<usize>() as f64;
    let n = lattice.finer as f64;
    let sources = lattice.axes.iter().map(|axis| axis.taps.len() as f64).product::<f64>();
    let bells: f64 = [0, 1].map(|axis| 2.0 * lattice.far[axis] as f64).iter().product();
    let parts = if lattice.exact { lattice.parts() } else { n * n };
    let part = 4.0 * TRANSFORM * points + bells * super::pairs::value(&seat.image.ghost.bell);
    parts * part + 3.0 * (TRANSFORM * points + ORDER as f64 * CARRIED * sources * (1.0 + parts.sqrt()))
}

/// The part of an axis's light that goes to one of the points of each pixel: of each source where to, and how much.
struct Part(Vec<(usize, isize, f64)>);

impl Carried {
    fn part(&self, finer: isize, point: isize) -> Part {
        let mut all = Vec::new();
        for (source, first, weights) in &self.taps {
            for (place, weight) in (*first..).zip(weights) {
                if *weight != 0.0 && place.rem_euclid(finer) == point {
                    all.push((*source, place.div_euclid(finer), *weight));
                }
            }
        }
        Part(all)
    }
}

impl Lattice {
    /// How many of the lattices of one point a pixel get any light.
    fn parts(&self) -> f64 {
        let along =
            |axis: &Carried| (0..self.finer).filter(|point| !axis.part(self.finer, *point).0.is_empty()).count();
        (along(&self.axes[0]) * along(&self.axes[1])) as f64
    }

    /// The bell, as it is seen from one of the points of a pixel.
    fn kernel(&self, waves: &Waves, seat: &Seat, point: [isize; 2]) -> Rows {
        let ghost = &seat.image.ghost;
        let (kernel, sides) = (Kernel::new(ghost), seat.frame.pixel_sides());
        let from = [0, 1].map(|axis| point[axis] as f64 / self.finer as f64 + self.shift[axis]);
        let [far, tall] = self.far;
        let near = |offset: isize| {
            let x = (offset as f64 - from[0]) * sides.x;
            (x.abs() <= seat.reach.x).then_some((offset, x))
        };
        let (offsets, xs): (Vec<isize>, Vec<f64>) = (-far..=far).filter_map(near).unzip();
        waves.rows(-tall, 2 * tall as usize + 1, |row, real| {
            // Rows are counted downwards.
            let y = (from[1] - (row as isize - tall) as f64) * sides.y;
            if y.abs() > seat.reach.y || xs.is_empty() {
                return;
            }
            let mut values = vec![0.0; xs.len()];
            kernel.row(&xs, y, &mut values);
            for (offset, value) in offsets.iter().zip(values) {
                real[offset.rem_euclid(self.size[0] as isize) as usize] = value;
            }
        })
    }
}

/// Adds an image's light of no more than a weight.
pub(super) fn add(seat: &Seat, finer: u32, weights: [f64; 3], alone_above: f64, sheet: &mut Sheet) {
    if Kernel::is_nothing(&seat.image.ghost) {
        return;
    }
    let Some(lattice) = Lattice::new(seat, finer) else { return };
    let colours: Vec<usize> = (0..3).filter(|&colour| seat.image.ghost.radiance[colour] != 0.0).collect();
    let waves = Waves::new(lattice.size);
    let mut sums = waves.sums(colours.len());
    for across in 0..lattice.finer {
        let part = lattice.axes[0].part(lattice.finer, across);
        if part.0.is_empty() {
            continue;
        }
        let along: Vec<Vec<f64>> =
            colours.iter().map(|&colour| along_rows(seat, &lattice, &part, colour, weights, alone_above)).collect();
        for down in 0..lattice.finer {
            let part = lattice.axes[1].part(lattice.finer, down);
            if part.0.is_empty() {
                continue;
            }
            let kernel = lattice.kernel(&waves, seat, [across, down]);
            let lights: Vec<Rows> = along.iter().map(|along| down_columns(&waves, &lattice, &part, along)).collect();
            waves.add(&mut sums, &kernel, &lights);
        }
    }
    let width = sheet.width;
    let mut planes: Vec<&mut [f64]> = Vec::new();
    for (colour, plane) in sheet.planes.iter_mut().enumerate() {
        if colours.contains(&colour) {
            planes.push(plane);
        }
    }
    waves.back(sums, width, &mut planes, |_, row, out| out.iter_mut().zip(row).for_each(|(out, value)| *out += value));
}

/// The light of a colour on one point of each pixel along rows: a row for each source that is carried down.
fn along_rows(
    seat: &Seat,
    lattice: &Lattice,
    part: &Part,
    colour: usize,
    weights: [f64; 3],
    alone_above: f64,
) -> Vec<f64> {
    let width = lattice.size[0];
    let rows = &lattice.axes[1].taps;
    let mut all = vec![0.0; rows.len() * width];
    let radiance = seat.image.ghost.radiance[colour];
    all.par_chunks_exact_mut(width).zip(rows).for_each(|(out, (row, _, _))| {
        let (light, factor) = seat.light(*row, colour);
        let weighed = seat.weights(*row, weights);
        for (source, pixel, weight) in &part.0 {
            if weighed[*source] <= alone_above {
                let place = pixel.rem_euclid(width as isize) as usize;
                out[place] += weight * radiance * factor * f64::from(light[*source]);
            }
        }
    });
    all
}

/// The transforms of that on one point of each pixel along columns, too.
fn down_columns(waves: &Waves, lattice: &Lattice, part: &Part, along: &[f64]) -> Rows {
    let (width, carried) = (lattice.size[0], &lattice.axes[1]);
    let Range { start, end } = carried.pixels;
    let first = carried.taps[0].0;
    let rows = (end - start) as usize;
    let mut of: Vec<Vec<(usize, f64)>> = vec![Vec::new(); rows];
    part.0.iter().for_each(|(source, pixel, weight)| of[(pixel - start) as usize].push((source - first, *weight)));
    waves.rows(start, rows, |row, real| {
        for (source, weight) in &of[row] {
            let light = &along[source * width..][..width];
            real.iter_mut().zip(light).for_each(|(real, light)| *real += weight * light);
        }
    })
}
