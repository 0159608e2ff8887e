//! Where an image's ghosts lie, and at which pixels they are wanted.

use glam::DVec2;

use crate::frame::Frame;
use crate::problem::{Image, Images};
use crate::raster::Raster;

/// An image on a frame. The numbers of places are those of [`Images::at`], to the last bit, so that both agree about what a jump falls on.
pub(super) struct Seat<'a> {
    pub image: &'a Image,
    pub raster: &'a Raster,
    pub frame: Frame,
    /// The centres of the ghosts of all columns of pixels, and of all rows.
    pub centres: [Vec<f64>; 2],
    /// Columns and rows of the window.
    pub places: [Vec<f64>; 2],
    /// How far from its centre a ghost is anything.
    pub reach: DVec2,
}

impl<'a> Seat<'a> {
    pub fn new(images: &'a Images, image: &'a Image, frame: Frame) -> Self {
        let window = frame.window;
        let columns = (0..window.width as i32).map(|i| frame.x(f64::from(window.x + i)));
        let rows = (0..window.height as i32).map(|j| frame.y(f64::from(window.y + j)));
        Self {
            image,
            raster: images.raster_of(image),
            frame,
            centres: images.centres_of_pixels(image),
            places: [columns.collect(), rows.collect()],
            reach: image.reached(),
        }
    }

    /// Columns and rows of the window.
    pub fn size(&self) -> [usize; 2] {
        self.places.each_ref().map(Vec::len)
    }

    /// Columns and rows of the photo.
    pub fn sources(&self) -> [usize; 2] {
        self.centres.each_ref().map(Vec::len)
    }

    /// The centres, in pixels from the window's first column and row.
    pub fn in_pixels(&self, axis: usize) -> Vec<f64> {
        let window = self.frame.window;
        let pixel = |centre: &f64| match axis {
            0 => self.frame.pixel(DVec2::new(*centre, 0.0)).x - f64::from(window.x),
            _ => self.frame.pixel(DVec2::new(0.0, *centre)).y - f64::from(window.y),
        };
        self.centres[axis].iter().map(pixel).collect()
    }

    /// The reach, in pixels.
    pub fn reach_in_pixels(&self) -> DVec2 {
        self.reach / self.frame.pixel_sides()
    }

    /// How many ghosts of pixels reach the window, and how many pixels each of these covers along an axis, at most.
    pub fn reached(&self, axis: usize) -> [f64; 2] {
        let (reach, count) = (self.reach_in_pixels()[axis], self.size()[axis] as f64);
        let near = self.in_pixels(axis).into_iter().filter(|at| (-reach..=count - 1.0 + reach).contains(at)).count();
        [near as f64, (2.0 * reach + 1.0).min(count)]
    }

    /// The flux of a row's pixels of a colour: floats, and what each is to be multiplied by.
    pub fn light(&self, row: usize, colour: usize) -> (&[f32], f64) {
        self.raster.light(row, colour)
    }

    /// What each pixel of a row weighs, by what a colour's flux does.
    pub fn weights(&self, row: usize, weights: [f64; 3]) -> Vec<f64> {
        let mut all = vec![0.0f64; self.sources()[0]];
        for (colour, weight) in weights.into_iter().enumerate() {
            let (light, factor) = self.light(row, colour);
            let weight = weight * factor;
            all.iter_mut().zip(light).for_each(|(all, light)| *all = all.max(weight * f64::from(*light)));
        }
        all
    }
}

/// Which of some numbers that rise or fall are from `low` to `high`.
pub(super) fn within(numbers: &[f64], low: f64, high: f64) -> std::ops::Range<usize> {
    let falls = numbers.first() > numbers.last();
    let [first, end] = if falls {
        [numbers.partition_point(|x| *x > high), numbers.partition_point(|x| *x >= low)]
    } else {
        [numbers.partition_point(|x| *x < low), numbers.partition_point(|x| *x <= high)]
    };
    first..end.max(first)
}
