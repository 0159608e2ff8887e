//! How a veil is summed on pictures of one size, and how far that is from what was wanted.
//!
//! The Gaussians of the mixture are dealt out by their widths: the widest to coarse lattices, narrower ones to finer lattices,
//! the next to separable kernels on the pixels, and the narrowest to a small kernel that is not separable and holds, offset
//! by offset, what is wanted less what the others realise. The plan tries several ways to deal, bounds the error of each, and takes the one with the fewest
//! operations among those that meet the tolerance.
//!
//! # The bound
//!
//! Along one dimension a Gaussian on a lattice is realised as R(x, x + d), which depends on the offset d and on where x lies
//! between two points of the lattice; its least and largest value over all such phases enclose it (`lattice`). Products of two
//! such intervals, summed over the mixture, enclose the realised kernel at an offset; their distance from the wanted value, over
//! that value, is the bound (`samples` says at which offsets). Rounding adds n u Σ |terms| over the wanted value, n the length
//! of the longest chain of sums and u half the distance from 1 to the next float.

mod choose;
mod lattice;
mod near;
mod own;
mod samples;
mod spherical;

use std::sync::Arc;

pub(super) use lattice::{Lattice, kernel, weights};
pub(crate) use near::Near;
pub(crate) use own::{Own, PERIOD};
pub(super) use spherical::{Road, Spherical};

use super::error::Error;
use super::evaluate::{Pool, Workspace};
use super::geometry::{Border, Geometry};
use super::kernel::{Gaussian, Kernel};
use super::picture::Picture;
use super::rings::{self, Rings};
use super::transform::{self, Choice, Transform, pyramid_nanoseconds};
use choose::{Chooser, Chosen};
use samples::Samples;

/// The longest side of a picture.
pub const LONGEST_SIDE: usize = 1 << 16;

/// The error of a direct sum: of its rounding to 32 bits.
pub(super) const DIRECT: f64 = 1e-7;

/// The share of the tolerance that is kept for what remains of a pixel's own light.
pub(super) const OWN_SHARE: f64 = 0.05;

/// A Gaussian that has found its place.
#[derive(Debug, Clone)]
pub(crate) struct Placed {
    /// Its value at 0, the pixel's weight included.
    pub weight: f64,
    /// Pixels from a point of its lattice to the next; 1 where it is a kernel on the pixels.
    pub pitch: usize,
    /// Its kernel on that lattice, from 0 on.
    pub half: Vec<f64>,
}

/// What is summed.
#[derive(Debug, Clone)]
pub(crate) struct Layers {
    /// Separable kernels on the pixels.
    pub direct: Vec<Placed>,
    /// Those of each lattice, from pitch 2 on.
    pub lattices: Vec<Vec<Placed>>,
    /// What is missing near a source.
    pub near: Near,
    /// What arrives at the source itself.
    pub own: Own,
    /// What each source adds everywhere.
    pub constant: f64,
    /// What each source adds, times the square of the distance in pixels.
    pub quadratic: f64,
}

/// What a plan promises and costs.
#[derive(Debug, Clone, PartialEq)]
pub struct Predicted {
    /// Bound of the error relative to the local veil, rounding included; at most the tolerance. Of a transform it is that: the plan
    /// does not know the photo, and [`super::Veil::certified`] says what holds for it.
    pub bound: f64,
    /// The part of it that is rounding; of a transform, that of a photo that is even.
    pub rounding: f64,
    /// Multiply-adds for each pixel of one channel; of a transform, as many as take its time.
    pub operations: f64,
    /// Gaussians that are summed on the pixels.
    pub direct: usize,
    /// Gaussians that are summed on each lattice, of pitch 2, 4, 8, … pixels.
    pub lattices: Vec<usize>,
    /// Gaussians that are left out: the narrow ones, which the small kernel takes, and those that this picture cannot show at its tolerance.
    pub dropped: usize,
    /// How far the small kernel reaches, in pixels; 0 where there is none.
    pub reach: f64,
}

/// A way to sum a veil on pictures of one size.
#[derive(Debug, Clone)]
pub struct Plan {
    size: [usize; 2],
    predicted: Predicted,
    pub(super) way: Way,
}

/// How.
#[derive(Debug, Clone)]
pub(super) enum Way {
    Plane(Box<Planar>),
    Sphere(Box<Spherical>),
    /// Every source at every pixel, for pictures so small that it is quick.
    Direct(Geometry, Kernel),
    /// On a plane, by the transform of photo and kernel.
    Transform(Arc<Transform>),
    /// On the whole sphere, by transforms along its rows.
    Rings(Arc<Rings>),
}

/// How a veil is summed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// Gaussians on lattices and on the pixels of a plane.
    Pyramid,
    /// The same on the sphere.
    Sphere,
    /// Transforms along the rows of an equirectangular picture.
    Rings,
    /// Every source at every pixel.
    Sum,
    /// The transform of the photo times that of the kernel.
    Transform {
        /// Columns and rows, with the padding.
        points: [usize; 2],
    },
}

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Pyramid => "pyramid",
            Self::Sphere => "sphere",
            Self::Rings => "rings",
            Self::Sum => "sum",
            Self::Transform { .. } => "transform",
        })
    }
}

/// On a plane.
#[derive(Debug, Clone)]
pub(super) struct Planar {
    kernel: Kernel,
    pitch: f64,
    solid_angle: f64,
    pub size: [usize; 2],
    pub border: Border,
    pub margin: [usize; 2],
    pub tolerance: f64,
    pub layers: Layers,
    pub roundings: f64,
    pub pool: Pool<Workspace>,
}

impl Plan {
    /// The cheapest way that is known to sum the veil of `kernel` on pictures of `size` columns and rows to `tolerance`, relative to
    /// the local veil or to [`super::FLOOR`] of the channel's largest.
    ///
    /// # Errors
    /// A size, geometry or tolerance that is none; a kernel that is negative or no number on this picture; a tolerance that its
    /// mixture or 32-bit floats do not reach.
    pub fn new(
        geometry: &Geometry,
        kernel: &Kernel,
        size: [usize; 2],
        border: Border,
        tolerance: f64,
    ) -> Result<Self, Error> {
        geometry.check(size, border)?;
        check_picture(size, tolerance)?;
        match (*geometry, geometry.camera(size)) {
            (Geometry::Planar { pitch, solid_angle }, _) => {
                Self::on_plane([pitch, solid_angle], kernel, transform::Task { size, border, tolerance })
            }
            (Geometry::Equirectangular, _) => Self::rings(kernel, size, tolerance),
            (_, Some(camera)) => Self::spherical(geometry, camera, kernel, tolerance),
            _ => Err(Error::Geometry("this geometry has no camera".into())),
        }
    }

    /// On the whole sphere.
    fn rings(kernel: &Kernel, size: [usize; 2], tolerance: f64) -> Result<Self, Error> {
        for step in 0..=1800 {
            let angle = 0.1 * f64::from(step);
            check(kernel.at(angle), angle)?;
        }
        let rings = Rings::new(kernel, size);
        // Written so that a bound that is no number is refused, too.
        if rings.bound <= tolerance {
            let predicted = Predicted {
                bound: rings.bound,
                rounding: rings::ROUNDING,
                operations: rings.operations(),
                direct: 0,
                lattices: Vec::new(),
                dropped: kernel.mixture().terms.len(),
                reach: 0.0,
            };
            return Ok(Self { size, predicted, way: Way::Rings(Arc::new(rings)) });
        }
        Err(Error::OutOfReach { asked: tolerance, best: rings.bound, distance: 0.0 })
    }

    /// The veil on a plane of any function of the distance or angle: it may be negative, steep, or wide. Where it is negative, the
    /// veil may be; the error is relative to its magnitude.
    ///
    /// # Errors
    /// A size, geometry or tolerance that is none, or a geometry that is no plane; a function that is no number on this picture; a
    /// tolerance that 32-bit floats do not reach; a picture whose transform takes too much memory.
    pub fn for_profile(
        geometry: &Geometry,
        profile: impl Fn(f64) -> f64 + Sync,
        size: [usize; 2],
        border: Border,
        tolerance: f64,
    ) -> Result<Self, Error> {
        geometry.check(size, border)?;
        check_picture(size, tolerance)?;
        let Geometry::Planar { pitch, solid_angle } = *geometry else {
            return Err(Error::Geometry("a function without a mixture of Gaussians has a veil on a plane only".into()));
        };
        let value = |distance: f64| solid_angle * profile(pitch * distance);
        let task = transform::Task { size, border, tolerance };
        Ok(Self::transform(task, Transform::of_profile(task, value, true, Choice::Cheaper)?))
    }

    /// The veil of a picture as the kernel, on a plane.
    ///
    /// # Errors
    /// A size or a tolerance that is none or that 32-bit floats do not reach; a picture whose transform takes too much memory.
    pub fn for_picture(picture: &Picture, size: [usize; 2], border: Border, tolerance: f64) -> Result<Self, Error> {
        check_picture(size, tolerance)?;
        let task = transform::Task { size, border, tolerance };
        Ok(Self::transform(task, Transform::of_picture(task, picture, Choice::Cheaper)?))
    }

    fn transform(task: transform::Task, transform: Transform) -> Self {
        let [bound, rounding] = transform.predicted();
        let predicted = Predicted {
            bound,
            rounding,
            operations: transform.cost.operations(&task),
            direct: 0,
            lattices: Vec::new(),
            dropped: 0,
            reach: 0.0,
        };
        Self { size: task.size, predicted, way: Way::Transform(Arc::new(transform)) }
    }

    /// By the pyramid, or by the transform where that costs less or the pyramid cannot.
    fn on_plane(planar: [f64; 2], kernel: &Kernel, task: transform::Task) -> Result<Self, Error> {
        let transform::Task { size, border, tolerance } = task;
        let [pitch, solid_angle] = planar;
        let transform = || {
            let value = |distance: f64| solid_angle * kernel.at(pitch * distance);
            let mut plan = Self::transform(task, Transform::of_profile(task, value, false, Choice::Cheaper)?);
            plan.predicted.dropped = kernel.mixture().terms.len();
            Ok(plan)
        };
        match Self::planar(planar, kernel, size, border, tolerance) {
            Ok(plan) => {
                let cost = pyramid_nanoseconds(plan.predicted.operations, &task);
                let cheaper = cost > Transform::least_nanoseconds(&task);
                if cheaper { transform().or(Ok(plan)) } else { Ok(plan) }
            }
            Err(refused @ (Error::OutOfReach { .. } | Error::Core { .. })) => {
                transform().map_err(|error| if matches!(error, Error::Memory { .. }) { refused } else { error })
            }
            Err(error) => Err(error),
        }
    }

    fn planar(
        [pitch, solid_angle]: [f64; 2],
        kernel: &Kernel,
        size: [usize; 2],
        border: Border,
        tolerance: f64,
    ) -> Result<Self, Error> {
        let margin = if border == Border::None { [0, 0] } else { size };
        let most = [0, 1].map(|side| size[side] - 1 + margin[side]);
        let pixels = (size[0] + 2 * margin[0]) * (size[1] + 2 * margin[1]);
        let samples = Samples::new(|distance| solid_angle * kernel.at(pitch * distance), most, pixels);
        for sample in &samples.pairs {
            check(sample.wanted / solid_angle, sample.distance() * pitch)?;
        }
        let mixture = kernel.mixture();
        let scaled = |term: &Gaussian| Gaussian { sigma: term.sigma / pitch, weight: term.weight * solid_angle };
        let mut terms: Vec<Gaussian> = mixture.terms.iter().filter(|term| term.weight > 0.0).map(scaled).collect();
        terms.sort_by(|one, other| one.sigma.total_cmp(&other.sigma));
        let moments = [mixture.constant * solid_angle, mixture.quadratic * solid_angle * pitch * pitch];
        let Chosen { layers, mut predicted, placed, roundings } =
            Chooser::new(&samples, &terms, moments, most, tolerance).choose()?;
        predicted.dropped = mixture.terms.len() - placed;
        let pool = Pool::default();
        let kernel = kernel.clone();
        let planar = Planar { kernel, pitch, solid_angle, size, border, margin, tolerance, layers, roundings, pool };
        Ok(Self { size, predicted, way: Way::Plane(Box::new(planar)) })
    }

    fn direct(geometry: &Geometry, kernel: &Kernel, size: [usize; 2]) -> Self {
        let predicted = Predicted {
            bound: DIRECT,
            rounding: DIRECT,
            operations: (size[0] * size[1]) as f64,
            direct: 0,
            lattices: Vec::new(),
            dropped: kernel.mixture().terms.len(),
            reach: (size[0] as f64).hypot(size[1] as f64),
        };
        Self { size, predicted, way: Way::Direct(*geometry, kernel.clone()) }
    }

    /// What it promises and costs.
    pub fn predicted(&self) -> &Predicted {
        &self.predicted
    }

    /// Columns and rows of the pictures it is for.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// How it is summed.
    pub fn method(&self) -> Method {
        match &self.way {
            Way::Plane(_) => Method::Pyramid,
            Way::Sphere(_) => Method::Sphere,
            Way::Rings(_) => Method::Rings,
            Way::Direct(..) => Method::Sum,
            Way::Transform(transform) => match transform.points() {
                Some(points) => Method::Transform { points },
                None => Method::Sum,
            },
        }
    }

    /// Bytes that a transform and its evaluation take besides photo and veil; none of other methods is told.
    pub fn memory(&self) -> Option<usize> {
        match &self.way {
            Way::Transform(transform) => Some(transform.cost.bytes),
            _ => None,
        }
    }
}

impl Planar {
    /// What a pixel of light 1 should send to another, `distance` pixels apart.
    pub fn wanted(&self, distance: f64) -> f64 {
        self.solid_angle * self.kernel.at(self.pitch * distance)
    }
}

/// Whether a picture may have this size, and a veil this tolerance.
fn check_picture([width, height]: [usize; 2], tolerance: f64) -> Result<(), Error> {
    if width == 0 || height == 0 || width.max(height) > LONGEST_SIDE {
        return Err(Error::Size { width, height, most: LONGEST_SIDE });
    }
    if !(tolerance > 0.0 && tolerance < 1.0) {
        return Err(Error::Tolerance(tolerance));
    }
    Ok(())
}

/// Whether a kernel may have this value at an angle or a distance.
fn check(value: f64, at: f64) -> Result<(), Error> {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    Err(Error::Kernel(format!("the kernel of a veil is a number that is not negative, and not {value} at {at}")))
}
