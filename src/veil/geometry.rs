//! Where the pixels of a picture lie, and what lies beyond its edges.

use super::error::Error;
use super::sphere::{Camera, Projection};

/// How pixels lie to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Geometry {
    /// On a plane: the angle between two pixels is their distance times `pitch`.
    Planar {
        /// From a pixel to the next, in the unit of the kernel's argument.
        pitch: f64,
        /// What a pixel weighs as a source: its solid angle for a kernel per steradian, its area for one per area.
        solid_angle: f64,
    },
    /// What a camera sees that looks along the picture's middle, as most lenses show it, lines staying lines: a pixel at the angle ψ from
    /// the axis lies `focal` · tan ψ from the middle. For kernels in degrees and per steradian.
    Rectilinear {
        /// The focal length, in pixels.
        focal: f64,
    },
    /// The same by a fisheye whose distances are angles: `focal` · ψ from the middle.
    Fisheye {
        /// The focal length, in pixels per radian.
        focal: f64,
    },
    /// All directions, as an equirectangular picture has them: twice as wide as high, columns even steps of azimuth, rows even steps from
    /// the zenith down. Its pixels are even all over their areas: what falls on a pixel of its own light is a part of its veil. For
    /// kernels in degrees and per steradian.
    Equirectangular,
}

/// The widest field that a picture may have, in degrees from corner to corner: beyond, no image of it is flat.
const WIDEST_FIELD: f64 = 330.0;

impl Geometry {
    /// A plane for a kernel in degrees and per steradian: `pitch` degrees from a pixel to the next, and the square of that
    /// in steradians as their solid angle.
    pub fn planar_degrees(pitch: f64) -> Self {
        Self::Planar { pitch, solid_angle: pitch.to_radians().powi(2) }
    }

    /// A rectilinear picture whose `width` columns span `field` degrees, above 0 and below 180.
    pub fn rectilinear(field: f64, width: usize) -> Self {
        Self::Rectilinear { focal: 0.5 * width as f64 / (0.5 * field).to_radians().tan() }
    }

    /// A fisheye's picture whose `width` columns span `field` degrees.
    pub fn fisheye(field: f64, width: usize) -> Self {
        Self::Fisheye { focal: width as f64 / field.to_radians() }
    }

    /// The camera of a picture of so many columns and rows; none of a plane.
    pub(super) fn camera(&self, size: [usize; 2]) -> Option<Camera> {
        match *self {
            Self::Planar { .. } | Self::Equirectangular => None,
            Self::Rectilinear { focal } => Some(Camera { projection: Projection::Rectilinear, focal, size }),
            Self::Fisheye { focal } => Some(Camera { projection: Projection::Equidistant, focal, size }),
        }
    }

    /// The angles or distances that there are between the pixels of a picture: from the least, some pixels being nearer than
    /// others, to the largest, with what lies beyond its border.
    pub fn angles(&self, [width, height]: [usize; 2], border: Border) -> [f64; 2] {
        let corner = [width, height].map(|side| side.saturating_sub(1) as f64);
        let diagonal = corner[0].hypot(corner[1]).max(1.0);
        let beyond = if border == Border::None { 1.0 } else { 2.0 };
        match *self {
            Self::Planar { pitch, .. } => [pitch, (beyond * diagonal * pitch).max(2.0 * pitch)],
            Self::Equirectangular => [180.0 / height.max(1) as f64 / 64.0, 180.0],
            Self::Rectilinear { focal } => {
                let half = 0.5 * diagonal / focal;
                let least = 1.0 / (focal * (1.0 + half * half));
                [least, (2.0 * half.atan()).max(2.0 * least)].map(f64::to_degrees)
            }
            Self::Fisheye { focal } => {
                let half = 0.5 * diagonal / focal;
                let least = if half > 0.0 { (half.sin().abs() / half).max(1e-3) / focal } else { 1.0 / focal };
                [least, (2.0 * half).min(std::f64::consts::PI).max(2.0 * least)].map(f64::to_degrees)
            }
        }
    }

    /// What a pixel at a column and row weighs as a source: its solid angle in steradians, or its area.
    pub fn solid_angle(&self, size: [usize; 2], [x, y]: [usize; 2]) -> f64 {
        match (*self, self.camera(size)) {
            (Self::Planar { solid_angle, .. }, _) => solid_angle,
            (Self::Equirectangular, _) => {
                let [width, height] = size.map(|side| side as f64);
                let end = |row: usize| (std::f64::consts::PI * row as f64 / height).cos();
                std::f64::consts::TAU / width * (end(y) - end(y + 1))
            }
            (_, Some(camera)) => camera.point(x as f64, y as f64).solid_angle,
            (_, None) => 0.0,
        }
    }

    pub(super) fn check(&self, size: [usize; 2], border: Border) -> Result<(), Error> {
        let usable = |value: f64| value.is_finite() && value > 0.0;
        match *self {
            Self::Planar { pitch, solid_angle } if !(usable(pitch) && usable(solid_angle)) => {
                Err(Error::Geometry(format!(
                    "the pixels of a veil lie apart and have an area: both are above 0, and not {pitch} and {solid_angle}"
                )))
            }
            Self::Rectilinear { focal } | Self::Fisheye { focal } if !usable(focal) => {
                Err(Error::Geometry(format!("a focal length is a number of pixels above 0, and not {focal}")))
            }
            Self::Equirectangular if size[0] != 2 * size[1] => Err(Error::Geometry(format!(
                "an equirectangular picture of all directions is twice as wide as high, and this is {} × {}",
                size[0], size[1]
            ))),
            Self::Rectilinear { .. } | Self::Fisheye { .. } | Self::Equirectangular if border != Border::None => Err(
                Error::Geometry("nothing is known of the sphere beyond a picture: only a plane has a border".into()),
            ),
            Self::Fisheye { focal } if (size[0] as f64).hypot(size[1] as f64) / focal > WIDEST_FIELD.to_radians() => {
                Err(Error::Geometry(format!("a fisheye's picture is at most {WIDEST_FIELD}° from corner to corner")))
            }
            _ => Ok(()),
        }
    }
}

pub use crate::choices::Border;

impl Border {
    /// The pixel of a row of `length` that stands at `index`, which is at most `length` beyond either end.
    pub(super) fn source(self, index: isize, length: usize) -> Option<usize> {
        let last = length as isize - 1;
        if (0..=last).contains(&index) {
            return Some(index as usize);
        }
        match self {
            Self::None => None,
            Self::Mirror => Some(if index < 0 { -1 - index } else { 2 * last + 1 - index }.clamp(0, last) as usize),
            Self::Extend => Some(index.clamp(0, last) as usize),
        }
    }
}
