//! A photo's moments against cubic B-splines.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use ndarray::Array2;

use crate::frame::Frame;
use crate::series::frequencies::{self, Spectrum};
use crate::veil::sweep::{self, Pyramid};
use crate::veil::{Plane, Real};

/// Lattices at most: pitches from 2 pixels to 65,536.
pub(super) const MOST: usize = 16;

/// A lattice has at least so many intervals along its shorter side.
const FEWEST: u32 = 4;

/// How the photo is reduced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Reduction {
    /// The pitch is 2 to the power of this, in pixels; at 0 the pixels are taken as they are.
    pub level: u32,
    /// Whether the moments are taken in 64-bit floats.
    pub doubles: bool,
    /// Points along x and y.
    pub points: [u32; 2],
    /// Whether waves come from one transform of all moments, and not from the moments themselves.
    pub transformed: bool,
}

impl Reduction {
    /// The same by a transform.
    pub(crate) fn by_transform(self) -> Self {
        Self { transformed: true, ..self }
    }

    /// By how much a transform is off along x and y, over all light; 0 without one.
    pub(crate) fn off(&self) -> [f64; 2] {
        self.points.map(|points| if self.transformed { frequencies::error(points as usize) } else { 0.0 })
    }

    /// The pitch, in pixels.
    pub fn pitch(&self) -> f64 {
        f64::from(self.level).exp2()
    }

    /// What floats lose of a moment at most, over itself: no term of it is negative.
    ///
    /// The first lattice takes 7 taps down and 7 across, each rounded, and each next 5 and 5.
    pub fn rounding(&self) -> f64 {
        if self.level == 0 {
            return 0.0;
        }
        let steps = 18.0 + 14.0 * f64::from(self.level - 1);
        steps * if self.doubles { f64::UNIT } else { f32::UNIT }
    }
}

/// How many points the lattice of a level has along x and y.
pub(super) fn points(frame: Frame, level: u32) -> [u32; 2] {
    let along = |side: u32| sweep::points(side as usize, level as usize).last().map_or(side, |points| *points as u32);
    [along(frame.window.width), along(frame.window.height)]
}

/// How many lattices a photo has; one at least.
pub(super) fn levels(frame: Frame) -> u32 {
    let side = frame.window.width.min(frame.window.height);
    (side / FEWEST).max(2).ilog2().clamp(1, MOST as u32)
}

/// The moments of all lattices, as they were computed.
pub(super) enum Moments {
    Single([Vec<Plane<f32>>; 3]),
    Double([Vec<Plane<f64>>; 3]),
}

impl Moments {
    /// The transform of those of a level.
    pub fn spectrum(&self, level: u32) -> Spectrum {
        fn of<T: Real + Into<f64>>(planes: &[Vec<Plane<T>>; 3], level: u32) -> Spectrum {
            let planes = planes.each_ref().map(|planes| &planes[level as usize - 1]);
            let points = [planes[0].width(), planes[0].height()];
            Spectrum::new(3, points, |channel, x, y| planes[channel].row(y)[x].into())
        }
        match self {
            Self::Single(planes) => of(planes, level),
            Self::Double(planes) => of(planes, level),
        }
    }

    pub fn new(photo: [&Plane<f32>; 3], lattices: usize, doubles: bool) -> Self {
        if doubles {
            return Self::Double(photo.map(|plane| Pyramid::moments_of(&plane.map(f64::from), lattices)));
        }
        Self::Single(photo.map(|plane| Pyramid::moments_of(plane, lattices)))
    }

    /// Those of one.
    pub fn lattice(&self, level: u32, frame: Frame) -> Lattice {
        match self {
            Self::Single(planes) => Lattice::new(planes, level, frame),
            Self::Double(planes) => Lattice::new(planes, level, frame),
        }
    }
}

/// The moments on a lattice, folded about its middle: what two points at the same distance have together, and what one has more
/// than the other. A cosine needs the first alone, a sine the second, so that each meets half of the points.
pub(crate) struct Lattice {
    /// Even and odd along x: below each other even and odd along y, each with red, green and blue, row by row from the middle.
    pub folded: [Array2<f64>; 2],
    pub places: Places,
}

/// Where points lie, or pixels.
pub(crate) struct Places {
    /// The middle of them.
    pub middle: DVec2,
    /// How far from it they lie along x and along y: half of a lattice's points, or all pixels.
    pub from_middle: [Vec<f64>; 2],
}

impl Lattice {
    fn new<T: Real + Into<f64>>(planes: &[Vec<Plane<T>>; 3], level: u32, frame: Frame) -> Self {
        let planes = planes.each_ref().map(|planes| &planes[level as usize - 1]);
        let (columns, rows) = (planes[0].width(), planes[0].height());
        let [across, down] = [Fold::new(columns), Fold::new(rows)];
        let value = |channel: usize, column: usize, row: usize| -> f64 { planes[channel].row(row)[column].into() };
        let folded = [1.0, -1.0].map(|x_sign| {
            Array2::from_shape_fn((6 * down.half, across.half), |(row, column)| {
                let (y_sign, channel) = (if row < 3 * down.half { 1.0 } else { -1.0 }, row / down.half % 3);
                let ((left, right), (above, below)) = (across.pair(column), down.pair(row % down.half));
                let along = |row: usize| match left {
                    Some(left) => value(channel, right, row) + x_sign * value(channel, left, row),
                    // The middle is its own mirror image.
                    None if x_sign > 0.0 => value(channel, right, row),
                    None => 0.0,
                };
                match above {
                    Some(above) => along(below) + y_sign * along(above),
                    None if y_sign > 0.0 => along(below),
                    None => 0.0,
                }
            })
        });
        let at = |column: f64, row: f64| position(frame, level, [column, row]);
        let middle = at(across.middle, down.middle);
        let from_middle = [
            (0..across.half).map(|k| at(across.last(k), 0.0).x - middle.x).collect(),
            (0..down.half).map(|k| at(0.0, down.last(k)).y - middle.y).collect(),
        ];
        Self { folded, places: Places { middle, from_middle } }
    }

    /// Points along y, of which half are on either side.
    pub fn half_rows(&self) -> usize {
        self.places.from_middle[1].len()
    }
}

/// Where a point of a lattice lies.
pub(super) fn position(frame: Frame, level: u32, [column, row]: [f64; 2]) -> DVec2 {
    // The first point lies one before the first pixel, but where the points are the pixels.
    let before = if level == 0 { 0.0 } else { 1.0 };
    let pixel = |first: i32, point: f64| f64::from(first) + f64::from(level).exp2() * (point - before);
    frame.position(pixel(frame.window.x, column), pixel(frame.window.y, row))
}

/// So many points along an axis, folded about their middle.
struct Fold {
    points: usize,
    half: usize,
    middle: f64,
}

impl Fold {
    fn new(points: usize) -> Self {
        Self { points, half: points.div_ceil(2), middle: 0.5 * (points as f64 - 1.0) }
    }

    /// The k-th point from the middle on.
    fn last(&self, k: usize) -> f64 {
        (self.points - self.half + k) as f64
    }

    /// The two points at the k-th distance; the first is none where they are one.
    fn pair(&self, k: usize) -> (Option<usize>, usize) {
        let last = self.points - self.half + k;
        let first = self.points - 1 - last;
        ((first != last).then_some(first), last)
    }
}

/// The transform of the cubic B-spline at `theta` radians a point.
pub(crate) fn spline(theta: f64) -> f64 {
    let half = 0.5 * theta;
    if half.abs() < 1e-8 { 1.0 } else { (half.sin() / half).powi(4) }
}

/// Σ_{l≠0} (θ / (θ + 2πl))⁴ for |θ| < 2π, by Σ_l 1 / (x + πl)⁴ = 1 / sin⁴ x − ⅔ / sin² x; infinite beyond.
pub(crate) fn aliasing(theta: f64) -> f64 {
    let theta = theta.abs();
    if theta >= TAU {
        return f64::INFINITY;
    }
    // For small x nothing is left of the difference; there Σ 1 / l⁴ = π⁴ / 90.
    if theta < 0.05 {
        let ratio = theta / TAU;
        return 2.2 * PI.powi(4) / 90.0 * ratio.powi(4);
    }
    let half = 0.5 * theta;
    let sine = half.sin();
    (half / sine).powi(4) * (1.0 - 2.0 / 3.0 * sine * sine) - 1.0 + 1e-14
}
