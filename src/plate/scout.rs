//! Where the field of a photo's ghosts is likely to be largest: each bell is taken to be a pyramid of the same variance, which two sums over
//! boxes have for all pixels at once.

use glam::DVec2;
use rayon::prelude::*;

use super::seat::Seat;
use crate::frame::Frame;
use crate::problem::{Image, Images};

/// Places of each colour.
const PLACES: usize = 3;

/// Half the side of what is looked over about a place before the next, in pixels, at least.
const APART: usize = 2;

/// Pixels at which the field of a frame is likely to be largest, the likeliest of each colour first.
pub(crate) fn bright_places(images: &Images, frame: Frame) -> Vec<[i32; 2]> {
    let window = frame.window;
    let size = [window.width as usize, window.height as usize];
    let apart = images.all().iter().map(|image| (image.ghost.size / frame.pixel_sides()).min_element());
    let apart = (0.5 * apart.fold(f64::INFINITY, f64::min)).min(1e3) as usize + APART;
    let of = |colour: usize| {
        let mut field = vec![0.0; size[0] * size[1]];
        images.all().iter().for_each(|image| add(images, image, frame, colour, &mut field));
        largest(field, size, apart)
    };
    let places: Vec<Vec<[usize; 2]>> = (0..3usize).into_par_iter().map(of).collect();
    let mut all: Vec<[i32; 2]> = Vec::new();
    for place in (0..PLACES).flat_map(|rank| places.iter().filter_map(move |places| places.get(rank))) {
        let pixel = [window.x + place[0] as i32, window.y + place[1] as i32];
        if !all.contains(&pixel) {
            all.push(pixel);
        }
    }
    all
}

/// The largest values that are apart.
fn largest(mut field: Vec<f64>, [width, height]: [usize; 2], apart: usize) -> Vec<[usize; 2]> {
    let mut found = Vec::new();
    for _ in 0..PLACES {
        let one = field.iter().enumerate().max_by(|one, other| one.1.total_cmp(other.1).then(other.0.cmp(&one.0)));
        let Some((place, value)) = one else { break };
        if *value <= 0.0 {
            break;
        }
        let [column, row] = [place % width, place / width];
        found.push([column, row]);
        for row in row.saturating_sub(apart)..(row + apart + 1).min(height) {
            field[row * width..][column.saturating_sub(apart)..(column + apart + 1).min(width)].fill(0.0);
        }
    }
    found
}

/// Adds about what an image is in a colour, by its magnitude.
fn add(images: &Images, image: &Image, frame: Frame, colour: usize, field: &mut [f64]) {
    let radiance = image.ghost.radiance[colour].abs();
    if radiance == 0.0 {
        return;
    }
    let seat = Seat::new(images, image, frame);
    let shape = image.ghost.bell.shape();
    // Of a pyramid of two boxes of b pixels the variance is (b² − 1)/6.
    let pixels = image.ghost.size / frame.pixel_sides();
    let half = |pixels: f64| (0.5 * ((6.0 * shape.variance() * pixels * pixels + 1.0).sqrt() - 1.0)).clamp(0.0, 1e6);
    let half = [half(pixels.x), half(pixels.y)].map(|half| half.round() as usize);
    let size = seat.size();
    let margin = [0, 1].map(|axis| (2 * half[axis] + 1).min(4 * size[axis].max(seat.sources()[axis])));
    let wide = [0, 1].map(|axis| size[axis] + 2 * margin[axis]);
    let mut light = vec![0.0; wide[0] * wide[1]];
    let place = |axis: usize| -> Vec<Option<usize>> {
        let cell = |at: &f64| {
            let cell = at.round() + margin[axis] as f64;
            (0.0..wide[axis] as f64).contains(&cell).then_some(cell as usize)
        };
        seat.in_pixels(axis).iter().map(cell).collect()
    };
    let [across, down] = [place(0), place(1)];
    for (row, cell) in down.iter().enumerate() {
        let Some(cell) = cell else { continue };
        let (values, factor) = seat.light(row, colour);
        let out = &mut light[cell * wide[0]..][..wide[0]];
        for (value, cell) in values.iter().zip(&across) {
            if let Some(cell) = cell {
                out[*cell] += factor * f64::from(*value);
            }
        }
    }
    for _ in 0..2 {
        light.chunks_exact_mut(wide[0]).for_each(|row| boxed(row, half[0]));
        columns_boxed(&mut light, wide, half[1]);
    }
    // A bell that is smaller than a pixel is seen at its peak at most.
    let sides = [0, 1].map(|axis| (2 * half[axis] + 1) as f64);
    let volume = shape.integral(image.ghost.size).abs() / frame.pixel_sides().element_product();
    let peak = radiance * (volume / (sides[0] * sides[1]).powi(2)).min(1.0);
    for (row, out) in field.chunks_exact_mut(size[0]).enumerate() {
        let from = &light[(row + margin[1]) * wide[0] + margin[0]..];
        out.iter_mut().zip(from).for_each(|(out, value)| *out += peak * value);
    }
}

/// The sum of what is no farther than `half` from each place.
fn boxed(row: &mut [f64], half: usize) {
    if half == 0 {
        return;
    }
    let sums: Vec<f64> = std::iter::once(0.0)
        .chain(row.iter().scan(0.0, |sum, value| {
            *sum += value;
            Some(*sum)
        }))
        .collect();
    let last = row.len();
    for (place, out) in row.iter_mut().enumerate() {
        *out = sums[(place + half + 1).min(last)] - sums[place.saturating_sub(half)];
    }
}

/// The same along columns.
fn columns_boxed(light: &mut [f64], [width, height]: [usize; 2], half: usize) {
    if half == 0 {
        return;
    }
    let mut sums = vec![0.0; (height + 1) * width];
    for row in 0..height {
        let (before, after) = sums.split_at_mut((row + 1) * width);
        let before = &before[row * width..];
        for ((sum, before), value) in after.iter_mut().zip(before).zip(&light[row * width..][..width]) {
            *sum = before + value;
        }
    }
    for (row, out) in light.chunks_exact_mut(width).enumerate() {
        let above = &sums[row.saturating_sub(half) * width..];
        let below = &sums[(row + half + 1).min(height) * width..];
        out.iter_mut().zip(below.iter().zip(above)).for_each(|(out, (below, above))| *out = below - above);
    }
}

/// About how many values of bells it takes to have the field at one point.
pub(crate) fn effort(images: &Images, image: &Image) -> f64 {
    let [low, high] = images.centres(image);
    let reached = (2.0 * image.reached() / (high - low).max(DVec2::splat(1e-9))).min(DVec2::ONE);
    images.raster_of(image).pixels() as f64 * reached.element_product()
}
