//! The chart: an even field with round black spots, as a rectilinear camera sees it.

use std::f64::consts::TAU;

use glam::DVec3;
use rayon::prelude::*;

use crate::photo::Photo;
use crate::{Error, Result};

/// The field is measured at so many diameters of a spot from its centre: of one of 1°, at 1° 30'.
pub const RING: f64 = 1.5;

/// Pixels across a spot, at least: a coarser one has no centre.
const FEWEST_PIXELS: f64 = 4.0;

/// A field that a camera sees.
#[derive(Debug, Clone, Copy)]
pub struct Field {
    /// Columns and rows.
    pub size: [u32; 2],
    /// The focal length, in pixels.
    pub focal: f64,
}

/// Where a spot is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// In words.
    pub name: &'static str,
    /// Column and row of its centre.
    pub pixel: [usize; 2],
}

impl Field {
    /// A picture whose width spans `fov` degrees.
    pub fn new(size: [u32; 2], fov: f64) -> Self {
        Self { size, focal: 0.5 * f64::from(size[0]) / (0.5 * fov).to_radians().tan() }
    }

    fn middle(&self) -> [f64; 2] {
        self.size.map(|side| 0.5 * (f64::from(side) - 1.0))
    }

    /// Where a point of the picture looks.
    fn direction(&self, [x, y]: [f64; 2]) -> DVec3 {
        let [cx, cy] = self.middle();
        DVec3::new(x - cx, y - cy, self.focal).normalize()
    }

    /// The angle between what two points look at, in degrees.
    fn angle(&self, one: DVec3, other: DVec3) -> f64 {
        (2.0 * (0.5 * one.distance(other)).asin()).to_degrees()
    }

    /// From the picture's middle to a pixel, in degrees.
    pub fn off_axis(&self, [x, y]: [usize; 2]) -> f64 {
        self.angle(DVec3::Z, self.direction([x as f64, y as f64]))
    }

    /// Whether all that is `degrees` from a point is in the picture.
    fn holds(&self, place: [f64; 2], degrees: f64) -> bool {
        let towards = self.direction(place);
        let [across, up] = {
            let across = towards.cross(DVec3::Y).normalize();
            [across, across.cross(towards)]
        };
        let (sine, cosine) = degrees.to_radians().sin_cos();
        (0..72).all(|step| {
            let (up_part, across_part) = (TAU * f64::from(step) / 72.0).sin_cos();
            let seen = cosine * towards + sine * (across_part * across + up_part * up);
            let [cx, cy] = self.middle();
            let [x, y] = [cx + self.focal * seen.x / seen.z, cy + self.focal * seen.y / seen.z];
            seen.z > 0.0 && (0.5..2.0 * cx - 0.5).contains(&x) && (0.5..2.0 * cy - 0.5).contains(&y)
        })
    }

    /// The centre, and as near to edges and a corner as a ring about a spot of this diameter, in degrees, is in the picture.
    ///
    /// # Errors
    /// [`Error::Usage`] where it is not even in the middle, or the spot is of a few pixels.
    pub fn places(&self, widest: f64, smallest: f64) -> Result<Vec<Place>> {
        let [cx, cy] = self.middle();
        let pixels = smallest.to_radians() * self.focal;
        if pixels < FEWEST_PIXELS {
            return Err(Error::Usage(format!(
                "a spot of {smallest}° is {pixels:.1} pixels across here, and less than {FEWEST_PIXELS}: ask for more --pixels or a larger spot, or a \
                 smaller --fov"
            )));
        }
        let place = |name, [dx, dy]: [f64; 2]| {
            let at = |part: f64| [(cx + part * dx * cx).round(), (cy + part * dy * cy).round()];
            let part =
                (0..=500).rev().map(|step| f64::from(step) / 500.0).find(|part| self.holds(at(*part), RING * widest));
            part.map(|part| Place { name, pixel: at(part).map(|value| value as usize) })
        };
        let all = [("centre", [0.0, 0.0]), ("side", [1.0, 0.0]), ("top", [0.0, -1.0]), ("corner", [1.0, -1.0])];
        let places: Option<Vec<Place>> = all.into_iter().map(|(name, way)| place(name, way)).collect();
        places.ok_or_else(|| {
            Error::Usage(format!(
                "the field is measured {:.1}° about a spot of {widest}°, which is more than the picture shows: ask for a smaller spot or a larger --fov",
                RING * widest
            ))
        })
    }

    /// The chart, of this luminance, with black spots of a diameter in degrees; pixels at a rim are as black as they are covered.
    pub fn photo(&self, places: &[Place], diameter: f64, level: f32) -> Photo {
        const PARTS: usize = 8;
        let [width, height] = self.size;
        let centres: Vec<DVec3> = places.iter().map(|place| self.direction(place.pixel.map(|at| at as f64))).collect();
        let pitch = 1.5 * (1.0 / self.focal).to_degrees();
        let lit = |point: [f64; 2]| {
            let towards = self.direction(point);
            centres.iter().map(|centre| self.angle(*centre, towards) - 0.5 * diameter).fold(f64::INFINITY, f64::min)
        };
        let value = |at: usize| {
            let [x, y] = [at % width as usize, at / width as usize].map(|at| at as f64);
            let from_rim = lit([x, y]);
            if from_rim.abs() > pitch {
                return if from_rim > 0.0 { level } else { 0.0 };
            }
            let part = |part: usize| (part as f64 + 0.5) / PARTS as f64 - 0.5;
            let all = (0..PARTS * PARTS).map(|k| [x + part(k % PARTS), y + part(k / PARTS)]);
            let count = all.filter(|point| lit(*point) > 0.0).count();
            level * count as f32 / (PARTS * PARTS) as f32
        };
        let pixels = (0..width as usize * height as usize).into_par_iter().map(value);
        Photo::new(width, height, pixels.map(|value| [value, value, value, 1.0]).collect())
    }

    /// The pixels at which the field about a spot is measured.
    pub fn ring(&self, place: &Place, diameter: f64) -> Vec<[usize; 2]> {
        let centre = self.direction(place.pixel.map(|at| at as f64));
        let half = 0.5 * (1.0 / self.focal).to_degrees();
        let [width, height] = self.size.map(|side| side as usize);
        let all = (0..width * height).map(|at| [at % width, at / width]);
        let near = |pixel: &[usize; 2]| {
            let towards = self.direction(pixel.map(|at| at as f64));
            // A pixel spans less of an angle far from the axis.
            (self.angle(centre, towards) - RING * diameter).abs() <= half * towards.z
        };
        all.filter(near).collect()
    }
}
