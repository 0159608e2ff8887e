//! The iris's transform, by the trapezium rule, which converges exponentially for a function that has no kink; and bounds of it, by
//! moving the path of integration off the real axis: for every η to which the steps have no pole
//!
//! ```text
//! |ĝ(k)| = |∫∫ g(x + iη k/|k|) e^{−ik·x} dx| e^{−η|k|} ≤ M(η) e^{−η|k|},    M(η) = ∫∫ |g(x + iη k/|k|)| dx
//! ```
//!
//! Of a polygon |1 + e^{t + iβ}| ≥ (1 + e^t) cos(β/2), so that M is no more than the area times the product of all
//! 1/cos(η s_k·k/2e|k|).

use std::f64::consts::TAU;

use glam::DVec2;
use ndarray::Array2;

use super::{Inner, Iris, NOTHING};
use crate::series::bell::{Bounded, Plane};

/// A way off the real axis: η, and M(η) in the direction where it is largest, and in the mean over all.
#[derive(Debug, Clone, Copy)]
pub(super) struct Strip {
    height: f64,
    largest: f64,
    mean: f64,
}

/// How far each path is from the axis, as parts of the way to the poles.
const HEIGHTS: [f64; 8] = [0.0, 0.3, 0.5, 0.65, 0.75, 0.82, 0.88, 0.92];

/// What directions between those that were looked at may have more, and what a sum over points has less than the integral.
const MARGIN: f64 = 1.2;

impl Iris {
    /// Values at points of a square lattice about the centre, row by row, and their distance: such that sums of them over waves no faster
    /// than z are integrals but for some 1e-15.
    pub(super) fn samples(&self, z: f64) -> (f64, Array2<f64>) {
        // What the rule is off by is the transform as far from 2π over the distance.
        let step = TAU / (z + NOTHING / self.widest_strip());
        let half = (self.radius_of(NOTHING) / step).ceil();
        let side = 2 * half as usize + 1;
        let place = |index: usize| step * (index as f64 - half);
        (step, Array2::from_shape_fn((side, side), |(row, column)| self.at(DVec2::new(place(column), place(row)))))
    }

    fn strips(&self) -> &[Strip] {
        self.0.strips.get_or_init(|| {
            let strip = |part: f64| {
                let height = part * self.widest_strip();
                let [largest, mean] = self.masses(height).map(|mass| if part == 0.0 { mass } else { MARGIN * mass });
                Strip { height, largest, mean }
            };
            HEIGHTS.map(strip).to_vec()
        })
    }

    /// M in the direction where it is largest, and in the mean over those that tell what all do.
    fn masses(&self, height: f64) -> [f64; 2] {
        let Inner { edge, sides, .. } = &*self.0;
        let area = self.moments().area;
        if height == 0.0 || self.is_round() {
            return [if height == 0.0 { area } else { self.round_mass(height) }; 2];
        }
        let product = |towards: DVec2| -> f64 {
            sides.iter().map(|side| (0.5 * height * side.dot(towards) / edge).cos().recip()).product()
        };
        let products: Vec<f64> = self.directions().into_iter().map(product).collect();
        let mean = products.iter().sum::<f64>() / products.len() as f64;
        [products.into_iter().fold(1.0, f64::max), mean].map(|product| area * product)
    }

    /// Summed, of a round one, whose steps are not as far apart everywhere.
    fn round_mass(&self, height: f64) -> f64 {
        let Inner { edge, peak, .. } = &*self.0;
        let step = 0.25 * (self.widest_strip() - height).min(*edge);
        let half = (self.radius_of(NOTHING) / step).ceil() as i32;
        let at = |x: f64, y: f64| {
            let (t, beta) = (0.5 * (x * x + y * y - height * height - 1.0) / edge, height * x / edge);
            // Beyond, e^t may be no number.
            if t > NOTHING {
                return 0.0;
            }
            peak / (1.0 + 2.0 * t.exp() * beta.cos() + (2.0 * t).exp()).sqrt()
        };
        let row = |j: i32| -> f64 {
            (0..=half).map(|i| if i == 0 { 0.5 } else { 1.0 } * at(step * f64::from(i), step * f64::from(j))).sum()
        };
        let rows: f64 = (0..=half).map(|j| if j == 0 { 0.5 } else { 1.0 } * row(j)).sum();
        4.0 * step * step * rows
    }
}

impl Bounded for Iris {
    /// Modes beyond z are no more than an integral over what is beyond z less half a cell's diagonal, of the envelope as much nearer.
    fn beyond(&self, z: f64, cell: f64) -> f64 {
        let from = (z - cell).max(0.0);
        let strip = |strip: &Strip| {
            let Strip { height, mean, .. } = *strip;
            mean / TAU * (-height * (from - cell)).exp() * (from / height + 1.0 / (height * height))
        };
        self.strips().iter().filter(|strip| strip.height > 0.0).map(strip).fold(f64::INFINITY, f64::min)
    }

    fn envelope(&self, z: f64) -> f64 {
        self.strips().iter().map(|strip| strip.largest * (-strip.height * z).exp()).fold(f64::INFINITY, f64::min)
    }

    /// The lattice's own values, once.
    fn preparation(&self) -> f64 {
        let side = 2.0 * self.radius_of(NOTHING) * NOTHING / (TAU * self.widest_strip());
        side * side * (10.0 + 8.0 * f64::from(self.blades()))
    }
}

impl Plane for Iris {
    fn parts(&self, counts: &[u32], size: DVec2) -> Vec<[f64; 4]> {
        let turn = TAU * size;
        let most = counts.iter().max().map_or(0, |&count| count as usize);
        let fastest = turn * DVec2::new(counts.len() as f64, most as f64);
        let (step, values) = self.samples(fastest.max_element());
        let half = (values.nrows() / 2) as f64;
        let tables = |harmonics: usize, first: f64| {
            let angle = |point: usize, n: usize| first * n as f64 * step * (point as f64 - half);
            let table = |wave: fn(f64) -> f64| {
                Array2::from_shape_fn((values.nrows(), harmonics), |(point, n)| wave(angle(point, n)))
            };
            [table(f64::cos), table(f64::sin)]
        };
        let ([cos_x, sin_x], [cos_y, sin_y]) = (tables(counts.len(), turn.x), tables(most, turn.y));
        // Rows of points first: a row of a sum for each of them, then one for each harmonic of y.
        let [along_cos, along_sin] = [cos_x, sin_x].map(|wave| values.dot(&wave));
        let down = |along: &Array2<f64>, wave: &Array2<f64>| wave.t().dot(along);
        let parts =
            [down(&along_cos, &cos_y), down(&along_sin, &sin_y), down(&along_cos, &sin_y), down(&along_sin, &cos_y)];
        let scale = step * step * size.element_product();
        let modes = counts.iter().enumerate().flat_map(|(n, &count)| (0..count as usize).map(move |m| (m, n)));
        modes.map(|at| parts.each_ref().map(|part| scale * part[at])).collect()
    }
}
