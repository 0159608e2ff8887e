//! Flat bells: along each row of the photo that crosses one, its flat part is a difference of two sums from the row's beginning, so that
//! nothing but the rim is evaluated.

use std::f64::consts::PI;

use glam::DVec2;
use rayon::prelude::*;

use super::Sheet;
use super::kernel::Flat;
use super::pairs;
use super::seat::{Seat, within};
use crate::series::Bell;

/// Nanoseconds that an image takes.
pub(super) fn cost(seat: &Seat) -> f64 {
    // A difference of sums, and finding a row's chords.
    const SPAN: f64 = 10.0;
    const CHORD: f64 = 4000.0;
    let ghost = &seat.image.ghost;
    let pixels = seat.size().iter().product::<usize>() as f64;
    let [sources, height] = [seat.sources(), seat.size()].map(|size| size[1] as f64);
    let pitch = seat.image.along.abs() * seat.raster.frame().pixel_sides() / ghost.size;
    let rows = (2.0 * ghost.bell.shape().ends() / pitch.y).min(sources).max(1.0);
    let band = match &ghost.bell {
        Bell::Disc(disc) => (2.0 * PI * disc.rim() / pitch.element_product()).min(seat.raster.pixels() as f64),
        _ => 0.0,
    };
    height * rows * CHORD + pixels * (rows * SPAN + band * (1.5 + pairs::value(&ghost.bell)))
}

/// Sums of a row's light up to each column, of columns in the order in which their centres rise.
struct Row {
    light: [Vec<f64>; 3],
    sums: [Vec<f64>; 3],
}

impl Row {
    fn new(seat: &Seat, row: usize, falls: bool) -> Self {
        let light = [0, 1, 2].map(|colour| {
            let (light, factor) = seat.light(row, colour);
            let mut light: Vec<f64> = light.iter().map(|light| factor * f64::from(*light)).collect();
            if falls {
                light.reverse();
            }
            light
        });
        let sums = light.each_ref().map(|light| {
            let mut sum = 0.0;
            std::iter::once(0.0)
                .chain(light.iter().map(|light| {
                    sum += light;
                    sum
                }))
                .collect()
        });
        Self { light, sums }
    }
}

/// Adds an image, or of a bell that has a step nothing but this.
pub(super) fn add(seat: &Seat, sheet: &mut Sheet) {
    let ghost = &seat.image.ghost;
    let Some(flat) = Flat::new(ghost) else { return };
    let falls = seat.centres[0].first() > seat.centres[0].last();
    let mut centres = seat.centres[0].clone();
    if falls {
        centres.reverse();
    }
    let [_, reaching] = pairs::reaching(seat);
    let rows: Vec<Row> = reaching.clone().into_par_iter().map(|row| Row::new(seat, row, falls)).collect();
    let width = sheet.width;
    let [red, green, blue] = &mut sheet.planes;
    let planes = red.par_chunks_mut(width).zip(green.par_chunks_mut(width)).zip(blue.par_chunks_mut(width));
    planes.zip(&seat.places[1]).with_max_len(4).for_each(|(((red, green), blue), place)| {
        let mut out = [red, green, blue];
        for row in within(&seat.centres[1], place - seat.reach.y, place + seat.reach.y) {
            let y = place - seat.centres[1][row];
            if let Some(chords) = flat.along(y) {
                let line = Line { seat, flat: &flat, centres: &centres, y };
                line.add(&rows[row - reaching.start], chords, &mut out);
            }
        }
    });
}

/// A row of the photo and a row of the window.
struct Line<'a> {
    seat: &'a Seat<'a>,
    flat: &'a Flat<'a>,
    centres: &'a [f64],
    y: f64,
}

impl Line<'_> {
    /// Adds what a row gives.
    fn add(&self, row: &Row, [flat, all]: [[f64; 2]; 2], out: &mut [&mut [f64]; 3]) {
        let mut ends = [0; 4];
        let ghost = &self.seat.image.ghost;
        let radiance = [0, 1, 2].map(|colour| self.flat.height * ghost.radiance[colour]);
        let centres = self.centres;
        for (column, place) in self.seat.places[0].iter().enumerate() {
            // Offsets fall as centres rise.
            let advance = |from: &mut usize, beyond: &dyn Fn(f64) -> bool| {
                while centres.get(*from).is_some_and(|centre| beyond(place - centre)) {
                    *from += 1;
                }
                *from
            };
            let first = advance(&mut ends[0], &|offset| offset > all[1]);
            let end = advance(&mut ends[3], &|offset| offset >= all[0]);
            if first >= end {
                continue;
            }
            let (mut from, mut to) = (first, first);
            if flat[0] <= flat[1] {
                from = advance(&mut ends[1], &|offset| offset > flat[1]);
                to = advance(&mut ends[2], &|offset| offset >= flat[0]).max(from);
            }
            for (colour, out) in out.iter_mut().enumerate() {
                out[column] += radiance[colour] * (row.sums[colour][to] - row.sums[colour][from]);
            }
            for rim in [first..from, to..end] {
                for centre in rim {
                    let offset = DVec2::new(place - centres[centre], self.y);
                    let value = ghost.bell.shape().value(offset, ghost.size);
                    for (colour, out) in out.iter_mut().enumerate() {
                        out[column] += ghost.radiance[colour] * value * row.light[colour][centre];
                    }
                }
            }
        }
    }
}
