//! What is bright and small in a panorama: lights, and where they lie beside a picture.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::sight::Sight;
use crate::frame::{Frame, Window};
use crate::motion::{LEAST_SHARE, Sheet};
use crate::photo::Photo;
use crate::scene::{self, Emission, FindOptions, Light};

/// A light that was found in a panorama.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lamp {
    direction: DVec3,
    /// Radiance times steradians, RGB.
    flux: [f64; 3],
    /// Rms along one axis, in radians.
    size: f64,
}

/// Lights of a panorama: those of a picture whose pixels count by their solid angles.
pub(super) fn found(photo: &Photo, find: &FindOptions) -> Vec<Lamp> {
    let frame = Frame::full(photo.width(), photo.height());
    let width = photo.width() as usize;
    let weighted = |(at, pixel): (usize, &[f32; 4])| {
        let up = FRAC_PI_2 * frame.y((at / width) as f64);
        let [r, g, b, a] = *pixel;
        let weight = up.cos() as f32;
        [weight * r, weight * g, weight * b, a]
    };
    let shining: Vec<[f32; 4]> = photo.pixels.iter().enumerate().map(weighted).collect();
    let found = scene::find_shining(&photo.pixels, &shining, &frame, Emission::of(photo), find);
    // Half the height is a quarter of a turn.
    let lamp = |light: Light| {
        let [right, up] = (FRAC_PI_2 * light.position).to_array();
        let ((sin, cos), (sin_up, cos_up)) = (right.sin_cos(), up.sin_cos());
        Lamp {
            direction: DVec3::new(cos_up * cos, -cos_up * sin, sin_up),
            flux: light.flux.map(|flux| FRAC_PI_2 * FRAC_PI_2 * flux),
            size: FRAC_PI_2 * light.size,
        }
    };
    found.lights.into_iter().map(lamp).collect()
}

/// Those that a camera does not see though they are before it, as far as they lie outside of the band, as lights on its picture's
/// plane.
pub(super) fn beside(lamps: &[Lamp], sight: &Sight, frame: &Frame) -> Vec<Light> {
    let [left, top] = sight.beyond();
    let [width, height] = sight.sides();
    let window = Window { x: -(left as i32), y: -(top as i32), width: width + 2 * left, height: height + 2 * top };
    let sheet = Sheet::new(frame.with_window(window));
    // Units on the picture's plane at a focal length of 1.
    let focal = sight.focal() * frame.pixel_size();
    // As a pixel counts by its area on the plane, whatever falls into the lens there, so does a light up to where the picture's corner
    // is; from there on by the fourth power of the cosine, which is what falls in.
    let corner = sight.corner();
    let light = |lamp: &Lamp| {
        let seen = sight.seen(lamp.direction);
        let accepted = sight.accepts(seen.z);
        if accepted <= 0.0 || seen.z <= 0.0 {
            return None;
        }
        // A solid angle is seen on the plane as so much area, by the cube of the cosine.
        let area = focal * focal / seen.z.powi(3);
        let dimmed = accepted * (seen.z / corner).min(1.0).powi(4);
        let whole = Light {
            position: focal / seen.z * seen.truncate(),
            flux: lamp.flux.map(|flux| dimmed * area * flux),
            size: lamp.size * area.sqrt(),
            muted: false,
        };
        let share = 1.0 - sheet.share(&whole);
        (share >= LEAST_SHARE).then(|| Light { flux: whole.flux.map(|flux| share * flux), ..whole })
    };
    lamps.iter().filter_map(light).collect()
}
