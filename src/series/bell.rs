//! What a bell is, to all who use one.

use std::fmt;
use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::cosine_squared::CosineSquared;
use super::gaussian::Gaussian;
use super::parabola::Parabola;
use super::paraboloid::Paraboloid;
use super::{Disc, Iris, Profile, SineGaussian, VonMises, kappa};

/// A bell: a ghost's profile.
#[derive(Debug, Clone, PartialEq)]
pub enum Bell {
    /// exp(−x²/2σx² − y²/2σy²).
    Gaussian,
    /// cos²(πx/2hx) cos²(πy/2hy) within |x| ≤ hx, |y| ≤ hy: the Hann window in two dimensions.
    CosineSquared,
    /// (1 − x²/hx²)(1 − y²/hy²) within |x| ≤ hx, |y| ≤ hy; its floor is a rectangle.
    Parabola,
    /// 1 − x²/ρx² − y²/ρy² where that is positive; its floor is an ellipse.
    Paraboloid,
    /// The periodic bell with one lobe a period.
    VonMises(VonMises),
    /// The prototype's "periodic Gaussian", which has two lobes a period.
    SineGaussian(SineGaussian),
    /// A radial profile, as a table.
    Profile(Arc<Profile>),
    /// A flat disc, round or with blades.
    Disc(Disc),
    /// An opening with a smooth edge, round or with blades.
    Iris(Iris),
}

impl Bell {
    /// What the bell is, mathematically.
    pub fn shape(&self) -> &dyn Shape {
        match self {
            Self::Gaussian => &Gaussian,
            Self::CosineSquared => &CosineSquared,
            Self::Parabola => &Parabola,
            Self::Paraboloid => &Paraboloid,
            Self::VonMises(bell) => bell,
            Self::SineGaussian(bell) => bell,
            Self::Profile(profile) => &**profile,
            Self::Disc(disc) => disc,
            Self::Iris(iris) => iris,
        }
    }

    /// The same bell in another period, where it is periodic itself; any other as it is.
    pub fn in_period(self, period: DVec2) -> Self {
        match self {
            Self::VonMises(_) => Self::VonMises(VonMises { period }),
            Self::SineGaussian(bell) => Self::SineGaussian(SineGaussian { period, ..bell }),
            other => other,
        }
    }

    /// How many kinds there are.
    pub(crate) const KINDS: u32 = 10;

    /// Which bell it is, below [`Bell::KINDS`], as `shaders/bells/any.glsl` counts them: each that is a shader of its own.
    pub(crate) fn kind(&self) -> u32 {
        match self {
            Self::Gaussian => 0,
            Self::CosineSquared => 1,
            Self::Parabola => 2,
            Self::Paraboloid => 3,
            Self::VonMises(_) => 4,
            Self::SineGaussian(_) => 5,
            Self::Profile(_) => 6,
            Self::Disc(disc) if disc.is_round() => 7,
            Self::Disc(_) => 8,
            Self::Iris(_) => 9,
        }
    }

    /// One bell of each kind, in this order, those with parameters by an example: the registry that
    /// tests walk.
    pub fn examples() -> Vec<Self> {
        let period = DVec2::new(4.0, 3.0);
        let ([round, bladed], [_, iris]) = (Disc::examples(), Iris::examples());
        vec![
            Self::Gaussian,
            Self::CosineSquared,
            Self::Parabola,
            Self::Paraboloid,
            Self::VonMises(VonMises { period }),
            Self::SineGaussian(SineGaussian { period, mean: 0.5 }),
            Self::Profile(Arc::new(Profile::example())),
            Self::Disc(round),
            Self::Disc(bladed),
            Self::Iris(iris),
        ]
    }
}

impl fmt::Display for Bell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.shape().name())
    }
}

impl serde::Serialize for Bell {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.shape().name())
    }
}

/// A bell, mathematically. Its largest absolute value is 1. Offsets, sizes and periods are in one unit, whichever.
pub trait Shape: Sync {
    /// The name that files and reports use.
    fn name(&self) -> &'static str;

    /// The bell's file in `shaders/`: it defines `bell_value` and, unless [`Shape::tabulated`], `bell_coefficient`.
    fn shader(&self) -> &'static str;

    /// The bell at an offset from its centre.
    fn value(&self, offset: DVec2, size: DVec2) -> f64;

    /// The bell at all offsets of a lattice, given along either axis: `visit` gets the number of a row, and its values.
    fn over(&self, xs: &[f64], ys: &[f64], size: DVec2, visit: &mut dyn FnMut(usize, &[f64])) {
        each_row(self, xs, ys, size, visit);
    }

    /// A bound of the bell along one axis: no value at offsets of at least (x, y) is beyond `along(x) * along(y)`.
    fn along(&self, distance: f64, size: f64) -> f64;

    /// The offset from `low` to `high` along an axis at which the bell is largest: the nearest to its centre.
    fn brightest(&self, _axis: usize, low: f64, high: f64, _size: f64) -> f64 {
        0.0f64.clamp(low, high)
    }

    /// A bound of what the copies of [`Shape::along`], `period` apart, add within `distance` < `period` of the centre.
    fn wrap(&self, period: f64, distance: f64, size: f64) -> f64;

    /// How steep the bell is at most at an offset of at least `distance` sizes along an axis, for each size, but for
    /// [`Shape::jump`].
    fn steepest(&self, distance: f64) -> f64;

    /// The offset, in sizes, from which on along either axis the bell is nothing.
    fn ends(&self) -> f64 {
        f64::INFINITY
    }

    /// How far from its centre the bell may be above `share` > 0 of its peak, in sizes: no value at an offset of more than
    /// that along either axis is. Infinite where the bell comes back.
    fn reach(&self, share: f64) -> f64;

    /// What the bell falls by all at once where it ends.
    fn jump(&self) -> f64 {
        0.0
    }

    /// Offsets in sizes, along an axis or the radius, at which the bell is steep or has a kink: where to look for errors.
    fn edges(&self) -> Vec<f64> {
        vec![1.0, 2.5]
    }

    /// How far from the centre an edge at 1 is in a direction of length 1, in sizes: 1 for what is round.
    fn outline(&self, _towards: DVec2) -> f64 {
        1.0
    }

    /// ∫∫ over the plane; over one period, for a periodic bell.
    fn integral(&self, size: DVec2) -> f64;

    /// The mean square distance from the centre along one axis, in sizes squared; what a light's extent adds to.
    fn variance(&self) -> f64;

    /// How the series comes about, if there is one.
    fn modes(&self) -> Modes<'_>;

    /// Whether the coefficients come from a table that ghosts of one size share, instead of a formula in GLSL.
    fn tabulated(&self) -> bool {
        true
    }

    /// The period that the bell is defined with, for those that are periodic themselves.
    fn period(&self) -> Option<DVec2> {
        None
    }

    /// What `bell_value` needs to know beside offset and size.
    fn parameters(&self) -> Vec<[f64; 4]> {
        Vec::new()
    }
}

/// [`Shape::over`], value by value.
pub(super) fn each_row<S: Shape + ?Sized>(
    shape: &S,
    xs: &[f64],
    ys: &[f64],
    size: DVec2,
    visit: &mut dyn FnMut(usize, &[f64]),
) {
    let mut row = vec![0.0; xs.len()];
    for (index, &y) in ys.iter().enumerate() {
        row.iter_mut().zip(xs).for_each(|(value, &x)| *value = shape.value(DVec2::new(x, y), size));
        visit(index, &row);
    }
}

/// How the coefficients of a bell are found.
#[derive(Clone, Copy)]
pub enum Modes<'a> {
    /// The bell is a product of one factor for each axis.
    Product(&'a dyn Factor),
    /// The bell depends on the radius alone, the axes scaled by the sizes.
    Radial(&'a dyn Radial),
    /// It is neither.
    Plane(&'a dyn Plane),
    /// Not at all: the bell has no series, and is summed, where it reaches or at every pixel.
    None,
}

/// A factor u of a product bell, along one axis. Sizes are in periods.
pub trait Factor: Sync {
    /// a_n and b_n for n = 0 ..= `highest`.
    fn coefficients(&self, highest: u32, size: f64) -> Vec<[f64; 2]>;

    /// At index N, for N = 0 ..= `highest`, an upper bound of Σ_{n>N} 2|a_n + i b_n| for every size from `size` to √2
    /// times that (of `size` alone, for a tabulated bell). No series cut after N is further off than that.
    fn tails(&self, highest: u32, size: f64) -> Vec<f64>;

    /// An upper bound of |a_0| at `size`, and together with the first of the tails of the sum of all |a_n + i b_n| at any
    /// of the same sizes.
    fn mean(&self, size: f64) -> f64;

    /// What finding out how the coefficients of a size in periods fall off up to a harmonic costs, about, in nanoseconds.
    fn work(&self, highest: f64, _size: f64) -> f64 {
        150.0 * highest
    }

    /// About the harmonic beyond which no more than `error` is left.
    fn degree(&self, error: f64, size: f64) -> f64;
}

/// How fast the transform of a bell that is no product falls; lengths are in sizes.
pub trait Bounded: Sync {
    /// An upper bound of how far the series is off at any point if it has all modes below `z`, on a lattice of modes
    /// whose cells have the half diagonal `cell`, in the same unit.
    fn beyond(&self, z: f64, cell: f64) -> f64;

    /// A bound of |ĝ| at z and beyond.
    fn envelope(&self, z: f64) -> f64;

    /// The radius that it ends at.
    fn end(&self) -> f64 {
        1.0
    }

    /// A bound of ∫ m(√(a² + s²)) ds, s ≥ 0, where m is the envelope: by steps that grow with s, from each of which on the
    /// envelope is what it is at its beginning. The envelope of no bell that ends falls more slowly than z^(−3/2).
    fn envelope_across(&self, a: f64) -> f64 {
        const RATIO: f64 = 1.2;
        let mut s = 0.2 / self.end() + 0.2 * a;
        let mut sum = s * self.envelope(a);
        for _ in 0..64 {
            sum += (RATIO - 1.0) * s * self.envelope(a.hypot(s));
            s *= RATIO;
        }
        sum + 2.0 * s * self.envelope(s)
    }

    /// What the first of the bounds costs, about, in nanoseconds.
    fn preparation(&self) -> f64 {
        0.0
    }

    /// And each of them, or a transform.
    fn work(&self) -> f64 {
        30.0
    }
}

/// A bell of the radius alone; lengths are in sizes.
pub trait Radial: Bounded {
    /// ĝ(z) = 2π ∫ r g(r) J0(zr) dr, z in radians for each size.
    fn transform(&self, z: f64) -> f64;

    /// [`Radial::transform`] at each of these z ≥ 0, as a table of coefficients asks for it.
    fn transforms(&self, at: &[f64]) -> Vec<f64> {
        at.par_iter().map(|&z| self.transform(z)).collect()
    }
}

/// A bell whose transform depends on the direction as well; lengths are in sizes.
pub trait Plane: Bounded {
    /// For each of the kept modes, harmonic by harmonic of x, ∫∫ of the bell of a size in periods times c_n c_m, s_n s_m, c_n s_m and
    /// s_n c_m, about its centre.
    fn parts(&self, counts: &[u32], size: DVec2) -> Vec<[f64; 4]>;
}

impl dyn Radial + '_ {
    /// The mean coefficients of the kept modes, harmonic by harmonic of x, of a size in periods; without the weight κ.
    pub fn means(&self, counts: &[u32], size: DVec2) -> Vec<f64> {
        let turn = std::f64::consts::TAU * size;
        let volume = size.element_product();
        let frequency = |(n, m)| (turn * DVec2::new(f64::from(n), f64::from(m))).length();
        let transforms = self.transforms(&modes(counts).map(frequency).collect::<Vec<_>>());
        transforms.into_iter().map(|transform| volume * transform).collect()
    }
}

impl Modes<'_> {
    /// What one mode of a table takes, about, in nanoseconds.
    pub fn work(&self) -> f64 {
        match self {
            Self::Product(_) | Self::None => 0.0,
            Self::Radial(_) => 15.0,
            // Of 20 waves of a transform, forth and back.
            Self::Plane(_) => 80.0,
        }
    }

    /// The coefficients of the kept modes, harmonic by harmonic of x, of a size in periods: what stands before c_n c_m,
    /// s_n s_m, c_n s_m and s_n c_m in the bell's series about its centre, the weight κ included. Of a bell without a series
    /// they are not numbers.
    pub fn table(&self, counts: &[u32], size: DVec2) -> Vec<[f64; 4]> {
        let highest = counts.iter().max().map_or(0, |&most| most.max(1) - 1);
        match self {
            Self::Product(factor) => {
                let x = factor.coefficients(counts.len().max(1) as u32 - 1, size.x);
                let y = factor.coefficients(highest, size.y);
                let product = |n: usize, m: usize| {
                    let ([a, b], [c, d], kappa) = (x[n], y[m], kappa(n as u32, m as u32));
                    [kappa * a * c, kappa * b * d, kappa * a * d, kappa * b * c]
                };
                modes(counts).map(|(n, m)| product(n as usize, m as usize)).collect()
            }
            Self::Radial(radial) => {
                let coefficient = |((n, m), mean)| [kappa(n, m) * mean, 0.0, 0.0, 0.0];
                modes(counts).zip(radial.means(counts, size)).map(coefficient).collect()
            }
            Self::Plane(plane) => {
                let weighed = |((n, m), parts): (_, [f64; 4])| parts.map(|part| kappa(n, m) * part);
                modes(counts).zip(plane.parts(counts, size)).map(weighed).collect()
            }
            Self::None => modes(counts).map(|_| [f64::NAN; 4]).collect(),
        }
    }
}

fn modes(counts: &[u32]) -> impl Iterator<Item = (u32, u32)> {
    (0..).zip(counts).flat_map(|(n, &count)| (0..count).map(move |m| (n, m)))
}
