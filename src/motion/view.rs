//! What a camera sees of a panorama.
//!
//! The panorama is equirectangular: its centre is ahead, its left half to the left, its top up, as OpenEXR's
//! latitude-longitude environment maps have it. The view is rectilinear, as lenses draw.
//!
//! Each pixel of a view is the mean of rays through it, which lie no farther apart than the panorama's pixels, and each ray
//! the cubic B-spline through these: a filter that is never negative, so that no sun has a dark rim, and that hands a light
//! from pixel to pixel without a flicker, for its spectrum is nothing where these rays alias.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use rayon::prelude::*;

use super::Camera;
use crate::frame::{Frame, Window};
use crate::photo::Photo;

/// The field of view across the picture's width where none is said, in degrees.
pub const VIEW_FOV: f64 = 60.0;

/// The most rays along one side of a pixel.
const MOST_RAYS: f64 = 64.0;

/// A picture of all directions.
pub struct Panorama {
    photo: Photo,
    width: usize,
    height: usize,
}

/// A camera's axes, and how far the picture is from its eye in pixels.
struct Eye {
    ahead: DVec3,
    right: DVec3,
    up: DVec3,
    focal: f64,
}

impl Panorama {
    /// Of a picture that is twice as wide as high. What is no number in it, or infinite, becomes black.
    ///
    /// # Errors
    /// Why a picture is no panorama, in words.
    pub fn new(mut photo: Photo) -> Result<Self, String> {
        let Frame { width, height, pixel_aspect, .. } = photo.frame;
        if width != 2 * height || height == 0 {
            return Err(format!(
                "a panorama of all directions is twice as wide as high, and this is {width} x {height}"
            ));
        }
        if !photo.frame.is_whole() || pixel_aspect != 1.0 {
            return Err("a panorama has all of its pixels stored, and square ones".into());
        }
        photo.pixels.par_iter_mut().for_each(|pixel| {
            pixel[..3].iter_mut().filter(|value| !value.is_finite()).for_each(|value| *value = 0.0);
        });
        Ok(Self { photo, width: width as usize, height: height as usize })
    }

    /// Its pixels, rows from the zenith down; none is infinite or no number.
    pub fn photo(&self) -> &Photo {
        &self.photo
    }

    /// What a camera sees, on a picture of so many columns and rows whose width spans `fov` degrees; `beyond` are columns and
    /// rows outside each edge that are stored, too.
    pub fn view(&self, camera: &Camera, fov: f64, [columns, rows]: [u32; 2], beyond: [u32; 2]) -> Photo {
        let eye = Eye::new(camera, 0.5 * f64::from(columns) / (0.5 * fov).to_radians().tan());
        let window = Window {
            x: -(beyond[0] as i32),
            y: -(beyond[1] as i32),
            width: columns + 2 * beyond[0],
            height: rows + 2 * beyond[1],
        };
        let across = window.width as usize;
        let middle = [0.5 * (f64::from(columns) - 1.0), 0.5 * (f64::from(rows) - 1.0)];
        let mut pixels = vec![[0.0f32; 4]; window.pixels()];
        pixels.par_chunks_mut(across).enumerate().for_each(|(row, pixels)| {
            let y = middle[1] - f64::from(window.y) - row as f64;
            for (column, pixel) in pixels.iter_mut().enumerate() {
                let x = f64::from(window.x) + column as f64 - middle[0];
                *pixel = self.pixel(&eye, x, y);
            }
        });
        let mut view = Photo::new(window.width, window.height, pixels);
        view.frame = Frame::full(columns, rows).with_window(window);
        view.source.primaries = self.photo.source.primaries;
        view.source.luminance = self.photo.source.luminance.clone();
        view.source.display_referred = self.photo.source.display_referred;
        view
    }

    /// The mean over a pixel, by its centre in pixels right of and above the middle.
    fn pixel(&self, eye: &Eye, x: f64, y: f64) -> [f32; 4] {
        // What a pixel spans is the less the farther it is from the middle; seen from its side, by the cosine of that angle.
        let spans = eye.focal.hypot(x).hypot(y).recip();
        let rays = (spans * self.height as f64 / PI).ceil().clamp(1.0, MOST_RAYS);
        let step = rays.recip();
        let mut sum = [0.0; 3];
        for j in 0..rays as usize {
            for i in 0..rays as usize {
                let [dx, dy] = [i, j].map(|k| (k as f64 + 0.5) * step - 0.5);
                let light = self.at(eye.ray(x + dx, y + dy));
                sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += light);
            }
        }
        let [r, g, b] = sum.map(|sum| (sum * step * step) as f32);
        [r, g, b, 1.0]
    }

    /// The panorama in a direction, not necessarily of length 1.
    fn at(&self, direction: DVec3) -> [f64; 3] {
        let turns = 0.5 - direction.y.atan2(direction.x) / TAU;
        let theta = direction.truncate().length().atan2(direction.z);
        let (u, v) = (turns * self.width as f64 - 0.5, theta / PI * self.height as f64 - 0.5);
        let ((left, across), (above, down)) = (spline(u), spline(v));
        let mut sum = [0.0; 3];
        for (row, down) in (above..).zip(down) {
            for (column, across) in (left..).zip(across) {
                let pixel = self.pixel_at(column, row);
                let weight = across * down;
                sum.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += weight * f64::from(*value));
            }
        }
        sum
    }

    /// A pixel by column and row; across a pole stand the pixels half way round.
    fn pixel_at(&self, column: isize, row: isize) -> &[f32; 4] {
        let (width, height) = (self.width as isize, self.height as isize);
        let (column, row) = match row {
            row if row < 0 => (column + width / 2, -1 - row),
            row if row >= height => (column + width / 2, 2 * height - 1 - row),
            row => (column, row),
        };
        let row = row.clamp(0, height - 1);
        &self.photo.pixels[(row * width + column.rem_euclid(width)) as usize]
    }
}

impl Eye {
    fn new(camera: &Camera, focal: f64) -> Self {
        let [right, up, ahead] = camera.axes();
        Self { ahead, right, up, focal }
    }

    fn ray(&self, x: f64, y: f64) -> DVec3 {
        self.focal * self.ahead + x * self.right + y * self.up
    }
}

/// The first of four neighbours of a place, and the weight of each by the cubic B-spline.
fn spline(place: f64) -> (isize, [f64; 4]) {
    let below = place.floor();
    let t = place - below;
    let s = 1.0 - t;
    let sixth = |x: f64| x * x * x / 6.0;
    let inner = |x: f64| 2.0 / 3.0 - x * x * (1.0 - 0.5 * x);
    (below as isize - 1, [sixth(s), inner(t), inner(s), sixth(t)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of light by the direction's angles in degrees, to the right and up.
    fn panorama(height: u32, light: impl Fn(f64, f64) -> f32) -> Panorama {
        let (w, h) = (2 * height as usize, height as usize);
        let of = |at: usize| {
            let right = ((at % w) as f64 + 0.5) / w as f64 * 360.0 - 180.0;
            let up = 90.0 - ((at / w) as f64 + 0.5) / h as f64 * 180.0;
            let light = light(right, up);
            [light, 0.5 * light, 0.0, 1.0]
        };
        Panorama::new(Photo::new(2 * height, height, (0..w * h).map(of).collect())).unwrap()
    }

    fn camera(yaw: f64, pitch: f64, roll: f64) -> Camera {
        Camera { yaw, pitch, roll, fov: None }
    }

    /// The place of the brightest pixel, right of and above the middle.
    fn brightest(photo: &Photo) -> [f64; 2] {
        let best = (0..photo.pixels.len()).max_by(|&a, &b| photo.pixels[a][0].total_cmp(&photo.pixels[b][0])).unwrap();
        let (width, height) = (photo.width() as usize, f64::from(photo.height()));
        [(best % width) as f64 - 0.5 * (width as f64 - 1.0), 0.5 * (height - 1.0) - (best / width) as f64]
    }

    fn spot(right: f64, up: f64) -> impl Fn(f64, f64) -> f32 {
        move |x, y| {
            let [a, b] = [[right, up], [x, y]].map(|[x, y]: [f64; 2]| {
                let ((sx, cx), (sy, cy)) = (x.to_radians().sin_cos(), y.to_radians().sin_cos());
                DVec3::new(cx * cy, sx * cy, sy)
            });
            (-0.5 * (a.angle_between(b).to_degrees() / 2.0).powi(2)).exp() as f32
        }
    }

    #[test]
    fn a_camera_sees_what_lies_where_it_looks() {
        for (right, up) in [(90.0, 0.0), (0.0, 0.0), (-135.0, 30.0), (179.9, -40.0), (20.0, 85.0)] {
            let view = panorama(180, spot(right, up)).view(&camera(right, up, 0.0), 50.0, [81, 61], [0; 2]);
            let [x, y] = brightest(&view);
            assert!(x.abs() <= 1.0 && y.abs() <= 1.0, "{right}, {up}: {x}, {y}");
        }
    }

    #[test]
    fn a_view_is_as_a_lens_draws_it() {
        // tan 20° / tan 30° of half the width, to the right and up.
        let expected = 20.0_f64.to_radians().tan() / 30.0_f64.to_radians().tan() * 100.0;
        let panorama = panorama(360, |x, y| spot(20.0, 0.0)(x, y) + 0.5 * spot(0.0, 20.0)(x, y));
        let [x, y] = brightest(&panorama.view(&camera(0.0, 0.0, 0.0), 60.0, [201, 201], [0; 2]));
        assert!((x - expected).abs() <= 1.5 && y.abs() <= 1.0, "{x}, {y}");
        // Rolled clockwise by a quarter, what was to the right is above.
        let [x, y] = brightest(&panorama.view(&camera(0.0, 0.0, 90.0), 60.0, [201, 201], [0; 2]));
        assert!((y - expected).abs() <= 1.5 && x.abs() <= 1.0, "{x}, {y}");
    }

    #[test]
    fn the_filter_keeps_light_and_is_never_negative() {
        let even = panorama(64, |_, _| 3.0);
        for fov in [5.0, 60.0, 150.0] {
            let view = even.view(&camera(33.0, -70.0, 12.0), fov, [24, 16], [3, 2]);
            assert_eq!((view.frame.window.width, view.frame.window.height, view.frame.width), (30, 20, 24));
            assert!(view.pixels.iter().all(|pixel| (pixel[0] - 3.0).abs() < 1e-5 && pixel[3] == 1.0));
        }
        // A sun of one pixel, seen by pixels that are larger and smaller, wherever it falls among them.
        let sun = |x: f64, y: f64| if (0.0..1.0).contains(&x) && (0.0..1.0).contains(&y) { 1e5 } else { 0.0 };
        let panorama = panorama(180, sun);
        for (fov, columns) in [(40.0, 20), (40.0, 120), (20.0, 160)] {
            let flux = |yaw: f64| {
                let view = panorama.view(&camera(yaw, 0.5, 0.0), fov, [columns, columns], [0; 2]);
                assert!(view.pixels.iter().all(|pixel| pixel[0] >= 0.0));
                view.pixels.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>()
            };
            let fluxes: Vec<f64> = (0..20).map(|k| flux(0.4 + 0.05 * f64::from(k))).collect();
            let (low, high) =
                fluxes.iter().fold((f64::MAX, 0.0), |(low, high), &f| (f64::min(low, f), f64::max(high, f)));
            assert!(high / low < 1.02, "{fov} over {columns}: {low} to {high}");
        }
    }

    #[test]
    fn what_is_no_panorama_is_refused() {
        for (width, height) in [(64, 64), (65, 32), (32, 64)] {
            assert!(Panorama::new(Photo::new(width, height, vec![[0.0; 4]; (width * height) as usize])).is_err());
        }
        let mut photo = Photo::new(8, 4, vec![[1.0, f32::NAN, f32::INFINITY, 1.0]; 32]);
        photo.pixels[0][0] = -1.0;
        let view = Panorama::new(photo).unwrap().view(&camera(0.0, 0.0, 0.0), 40.0, [4, 4], [0; 2]);
        assert!(view.pixels.iter().all(|pixel| pixel[..3].iter().all(|value| value.is_finite())));
    }
}
