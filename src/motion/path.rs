//! What lights, or a camera, do at a time.

use glam::{DVec2, DVec3};

use super::Track;
use crate::scene::Light;

/// What moves.
#[derive(Debug, Clone, PartialEq)]
pub enum Path {
    /// Lights in the picture, in the order in which they are first named.
    Lights(Vec<LightPath>),
    /// A camera.
    Camera(Track<4>, Sees),
}

/// What a camera's rows say of its field of view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sees {
    /// A field each.
    Field,
    /// Nothing.
    Unsaid,
}

/// A light, which keeps its name.
#[derive(Debug, Clone, PartialEq)]
pub struct LightPath {
    /// What tells it from others.
    pub name: String,
    /// x, y, red, green and blue of its flux, and its size.
    pub(super) track: Track<6>,
}

/// How a camera is held; angles in degrees.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Camera {
    /// To the right of the panorama's centre.
    pub yaw: f64,
    /// Above its horizon.
    pub pitch: f64,
    /// About what is ahead, clockwise as the photographer has it.
    pub roll: f64,
    /// What the picture's width spans, where that is said.
    pub fov: Option<f64>,
}

impl Path {
    /// When it begins and when it ends.
    pub fn span(&self) -> [f64; 2] {
        match self {
            Self::Camera(track, _) => [track.first(), track.last()],
            Self::Lights(lights) => {
                let tracks = || lights.iter().map(|light| &light.track);
                let first = tracks().map(Track::first).fold(f64::INFINITY, f64::min);
                [first, tracks().map(Track::last).fold(f64::NEG_INFINITY, f64::max)]
            }
        }
    }

    /// The time of a frame of so many, the first of which is at the path's beginning and the last at its end.
    pub fn time(&self, frame: usize, frames: usize) -> f64 {
        let [first, last] = self.span();
        if frames < 2 {
            return first;
        }
        // By whole steps, which rows that count frames are met by to the bit.
        first + (last - first) * frame as f64 / (frames - 1) as f64
    }
}

impl LightPath {
    /// Where it is at a time, and how bright; none before its first row and after its last.
    pub fn at(&self, time: f64) -> Option<Light> {
        let [x, y, red, green, blue, size] = self.track.at(time)?;
        // What a cubic's rounding may leave below 0.
        let flux = [red, green, blue].map(|flux| flux.max(0.0));
        Some(Light { position: DVec2::new(x, y), flux, size: size.max(0.0), muted: false })
    }
}

impl Camera {
    /// Unit vectors to its right, up and ahead; the panorama's centre is +x, what is left of it +y, its top +z.
    pub fn axes(&self) -> [DVec3; 3] {
        let [(sin_yaw, cos_yaw), (sin_pitch, cos_pitch), (sin_roll, cos_roll)] =
            [self.yaw, self.pitch, self.roll].map(|degrees| degrees.to_radians().sin_cos());
        let ahead = DVec3::new(cos_pitch * cos_yaw, -cos_pitch * sin_yaw, sin_pitch);
        let level = DVec3::new(-sin_yaw, -cos_yaw, 0.0);
        let above = level.cross(ahead);
        [cos_roll * level - sin_roll * above, cos_roll * above + sin_roll * level, ahead]
    }

    /// That of a path at a time.
    pub fn at(track: &Track<4>, sees: Sees, time: f64) -> Option<Self> {
        let [yaw, pitch, roll, fov] = track.at(time)?;
        Some(Self { yaw, pitch, roll, fov: (sees == Sees::Field).then_some(fov) })
    }
}
