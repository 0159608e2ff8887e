//! The iris: the opening of a lens, seen a little out of focus. It is flat, with a smooth edge, and round or a regular polygon with as
//! many sides as the opening has blades.
//!
//! A polygon is the product of one logistic step for each side, a round iris one step of the radius squared: functions without a kink
//! anywhere, so that their transforms fall exponentially, and a series of some hundred harmonics has what a disc's smoothstep needs
//! thousands for.
//!
//! Rims of the lens may cut it (`cut`): each is one more step, of the radius squared about the middle of its circle.

mod cut;
mod transform;

use std::f64::consts::PI;
use std::sync::{Arc, Mutex, OnceLock};

use glam::DVec2;
use pulp::Arch;

use super::bell::{Modes, Shape};
use super::disc::MOST_BLADES;
use super::tails::copies;
pub use cut::Cut;
use transform::Waves;

/// The softest edge, and the sharpest: of a sharper one a disc does as well, which ends.
const EDGES: [f64; 2] = [0.01, 0.3];

/// Where a step is less than any float of the field would show: e^−30.
const NOTHING: f64 = 30.0;

/// An opening with a smooth edge.
#[derive(Debug, Clone)]
pub struct Iris(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    edge: f64,
    blades: u32,
    rotation: f64,
    /// Where the sides are, as directions; none where it is round.
    sides: Vec<DVec2>,
    /// How far the sides are from the centre.
    apothem: f64,
    /// Rims that cut it.
    cuts: Vec<Cut>,
    /// What the product of steps has to be multiplied by to be 1 at the centre, or, where it is cut, at most.
    peak: f64,
    /// That of the whole opening.
    whole_peak: f64,
    /// The steepest place of all.
    steepest: f64,
    moments: OnceLock<Moments>,
    /// What is known of its transform.
    waves: Mutex<Option<Arc<Waves>>>,
}

/// ∫∫ of it, and the mean square distance from its centroid along one axis, the mean of both.
#[derive(Debug, Clone, Copy)]
struct Moments {
    area: f64,
    variance: f64,
}

impl PartialEq for Iris {
    fn eq(&self, other: &Self) -> bool {
        let opening = |iris: &Self| (iris.edge(), iris.blades(), iris.rotation());
        opening(self) == opening(other) && self.cuts() == other.cuts()
    }
}

impl Iris {
    /// An opening whose edge falls by a logistic step, e-fold within `edge` sizes far from its middle; from 90 to 10 % it takes 4.4
    /// of those. `blades` is 0 for a round one, or how many sides it has, its corners on the circle of radius 1: the
    /// first of them to the right, turned by `rotation` degrees against the clock.
    ///
    /// # Errors
    /// What is wrong, for people: an edge that is not from 0.01 to 0.3, one or two blades or more than [`MOST_BLADES`], a rotation that
    /// is no number, or one of a round iris.
    pub fn new(edge: f64, blades: u32, rotation: f64) -> Result<Self, String> {
        let [sharpest, softest] = EDGES;
        if !(sharpest..=softest).contains(&edge) {
            return Err(format!("the edge of an iris is from {sharpest} to {softest} sizes wide, and not {edge}"));
        }
        if blades != 0 && !(3..=MOST_BLADES).contains(&blades) {
            return Err(format!(
                "an iris has from 3 to {MOST_BLADES} blades, or 0 where it is round, and not {blades}"
            ));
        }
        if !rotation.is_finite() {
            return Err(format!("the rotation of an iris is a number of degrees, and not {rotation}"));
        }
        if blades == 0 && rotation != 0.0 {
            return Err("a round iris has no rotation: it has no `blades` to be turned".into());
        }
        Ok(Self::made(edge, blades, rotation + 0.0))
    }

    fn made(edge: f64, blades: u32, rotation: f64) -> Self {
        let step = PI / f64::from(blades.max(1));
        // Whole turns go first, and exactly.
        let turn = (rotation % 360.0).to_radians();
        let sides: Vec<DVec2> = (0..blades).map(|k| DVec2::from_angle(turn + f64::from(2 * k + 1) * step)).collect();
        let apothem = if blades == 0 { 1.0 } else { step.cos() };
        let peak = match blades {
            0 => 1.0 + (-0.5 / edge).exp(),
            _ => (1.0 + (-apothem / edge).exp()).powi(blades as i32),
        };
        let steepest = match blades {
            0 => peak * steepest_of_round(edge),
            // Of Σ σ_k s_k times the product of the (1 − σ_k) no more than 1/4 is to be had from one side, and from neighbours,
            // whose directions differ, less than this.
            _ => 0.3 * peak / edge,
        };
        let (moments, waves) = Default::default();
        let (cuts, whole_peak) = (Vec::new(), peak);
        Self(Arc::new(Inner {
            edge,
            blades,
            rotation,
            sides,
            apothem,
            cuts,
            peak,
            whole_peak,
            steepest,
            moments,
            waves,
        }))
    }

    /// A round one and a polygon, for tests.
    pub(super) fn examples() -> [Self; 2] {
        [Self::made(0.1, 0, 0.0), Self::made(0.08, 5, 17.0)]
    }

    /// How wide the edge is, in sizes.
    pub fn edge(&self) -> f64 {
        self.0.edge
    }

    /// How many sides there are; 0 for a round one.
    pub fn blades(&self) -> u32 {
        self.0.blades
    }

    /// By how many degrees it is turned against the clock.
    pub fn rotation(&self) -> f64 {
        self.0.rotation
    }

    /// Whether it is round.
    pub fn is_round(&self) -> bool {
        self.0.blades == 0
    }

    /// How many steps it is the product of.
    pub(crate) fn steps(&self) -> usize {
        self.0.sides.len().max(1) + self.0.cuts.len()
    }

    /// At a point in sizes. `bells/iris.glsl` does the same, in the same order.
    fn at(&self, at: DVec2) -> f64 {
        let Inner { edge, sides, apothem, cuts, peak, .. } = &*self.0;
        let opening = match self.is_round() {
            true => peak * step_down(0.5 * (at.length_squared() - 1.0) / edge),
            false => sides.iter().fold(*peak, |product, side| product * step_down((side.dot(at) - apothem) / edge)),
        };
        cuts.iter().fold(opening, |product, cut| product * step_down(cut.exponent(at) / edge))
    }

    /// What it is at most at a radius or beyond: every point is beyond one side by no less than the radius times the apothem.
    fn beyond_radius(&self, radius: f64) -> f64 {
        let Inner { edge, apothem, peak, .. } = &*self.0;
        let step = match self.is_round() {
            true => step_down(0.5 * (radius * radius - 1.0) / edge),
            false => step_down(apothem * (radius - 1.0) / edge),
        };
        (peak * step).min(1.0)
    }

    /// The radius beyond which the steps are below e^−x.
    fn radius_of(&self, exponent: f64) -> f64 {
        let Inner { edge, apothem, .. } = &*self.0;
        if self.is_round() { (1.0 + 2.0 * edge * exponent).sqrt() } else { 1.0 + edge / apothem * exponent }
    }

    fn moments(&self) -> Moments {
        *self.0.moments.get_or_init(|| {
            let (step, values) = self.samples(0.0);
            let side = values.nrows();
            let middle = 0.5 * (side as f64 - 1.0);
            let (mut sum, mut first, mut square) = (0.0, DVec2::ZERO, 0.0);
            for ((row, column), value) in values.indexed_iter() {
                let at = step * DVec2::new(column as f64 - middle, row as f64 - middle);
                sum += value;
                first += *value * at;
                square += value * at.length_squared();
            }
            let centroid = first / sum;
            Moments { area: sum * step * step, variance: 0.5 * (square / sum - centroid.length_squared()) }
        })
    }
}

/// Of a round one that is 1 at its brightest, the steepest slope: f (1 − f) r / e is steepest a little beyond the edge.
fn steepest_of_round(edge: f64) -> f64 {
    let slope = |k: u32| {
        let radius = 0.002 * f64::from(k);
        let step = step_down(0.5 * (radius * radius - 1.0) / edge);
        step * (1.0 - step) * radius / edge
    };
    1.01 * (0..1000).map(slope).fold(0.0, f64::max)
}

/// 1/(1 + e^t): what a step has left.
fn step_down(t: f64) -> f64 {
    let small = (-t.abs()).exp();
    if t > 0.0 { small / (1.0 + small) } else { 1.0 / (1.0 + small) }
}

impl Shape for Iris {
    fn name(&self) -> &'static str {
        "iris"
    }

    fn shader(&self) -> &'static str {
        "bells/iris.glsl"
    }

    fn value(&self, offset: DVec2, size: DVec2) -> f64 {
        self.at(offset / size).min(1.0)
    }

    /// The radius is not below either offset, so the root of what both allow bounds the iris.
    fn along(&self, distance: f64, size: f64) -> f64 {
        self.beyond_radius((distance / size).abs()).sqrt()
    }

    fn wrap(&self, period: f64, distance: f64, size: f64) -> f64 {
        // Beyond, it is below what f64 holds.
        copies(period, distance, size * self.radius_of(750.0), |x| self.along(x, size))
    }

    fn steepest(&self, distance: f64) -> f64 {
        let Inner { edge, blades, cuts, steepest, .. } = &*self.0;
        // What is left, times the sum of the sides that it lies beyond.
        let sides = if *blades == 0 { distance.max(1.0) } else { 1.0 + f64::from(*blades) / PI };
        let sides = sides + cuts.iter().map(|cut| cut.slope_at(distance.max(1.0))).sum::<f64>();
        steepest.min(self.beyond_radius(distance) * sides / edge)
    }

    fn reach(&self, share: f64) -> f64 {
        let Inner { peak, .. } = &*self.0;
        if share >= 1.0 {
            return 0.0;
        }
        // peak/(1 + e^x) is the share.
        let exponent = (peak / share - 1.0).ln();
        let radius = if exponent.is_finite() { self.radius_of(exponent.max(self.innermost())) } else { 0.0 };
        radius * (1.0 + 1e-12)
    }

    /// Where it is steep, and both ends of that.
    fn edges(&self) -> Vec<f64> {
        let Inner { edge, .. } = &*self.0;
        vec![1.0 - 2.2 * edge, 1.0, 1.0 + 2.2 * edge]
    }

    fn outline(&self, towards: DVec2) -> f64 {
        let Inner { sides, apothem, cuts, .. } = &*self.0;
        let farthest = sides.iter().map(|side| side.dot(towards)).fold(f64::MIN, f64::max);
        let opening = if self.is_round() { 1.0 } else { apothem / farthest };
        cuts.iter().filter_map(|cut| cut.rim(towards)).fold(opening, f64::min)
    }

    /// A step's exponential is one along x times one along y: a side's, and that of the radius squared.
    fn over(&self, xs: &[f64], ys: &[f64], size: DVec2, visit: &mut dyn FnMut(usize, &[f64])) {
        let Inner { edge, sides, apothem, cuts, peak, .. } = &*self.0;
        // Farther than this all steps are nothing, or there is nothing left of one; and no product is beyond what f64 holds.
        let exponential = |exponent: f64| (exponent / edge).clamp(-340.0, 340.0).exp();
        let round = |x: f64| exponential(0.5 * (x / size.x).powi(2));
        let mut across: Vec<Vec<f64>> = match self.is_round() {
            true => vec![xs.iter().copied().map(round).collect()],
            false => sides.iter().map(|side| xs.iter().map(|x| exponential(side.x * x / size.x)).collect()).collect(),
        };
        let opening = across.len();
        across.extend(cuts.iter().map(|cut| xs.iter().map(|x| exponential(cut.across(x / size.x))).collect()));
        let down = |step: usize, y: f64| match (sides.get(step), cuts.get(step.wrapping_sub(opening))) {
            (Some(side), _) => exponential(side.y * y / size.y - apothem),
            (None, Some(cut)) => exponential(cut.down(y / size.y)),
            (None, None) => exponential(0.5 * ((y / size.y).powi(2) - 1.0)),
        };
        let mut row = vec![0.0; xs.len()];
        for (index, y) in ys.iter().enumerate() {
            // By the widest vectors that the processor has.
            Arch::new().dispatch(
                #[inline(always)]
                || {
                    row.fill(1.0);
                    for (step, across) in across.iter().enumerate() {
                        let down = down(step, *y);
                        row.iter_mut().zip(across).for_each(|(row, across)| *row *= 1.0 + across * down);
                    }
                    row.iter_mut().for_each(|row| *row = (peak / *row).min(1.0));
                },
            );
            visit(index, &row);
        }
    }

    fn integral(&self, size: DVec2) -> f64 {
        self.moments().area * size.element_product()
    }

    fn variance(&self) -> f64 {
        self.moments().variance
    }

    fn modes(&self) -> Modes<'_> {
        Modes::Plane(self)
    }

    /// One over the edge, where the sides are, what is multiplied, and how many sides and, 32 for each, cuts; then two sides a row, and
    /// a row for each cut.
    fn parameters(&self) -> Vec<[f64; 4]> {
        let Inner { edge, blades, sides, apothem, cuts, peak, .. } = &*self.0;
        let steps = *blades + cut::IN_SHADERS * cuts.len() as u32;
        let mut rows = vec![[1.0 / edge, *apothem, *peak, f64::from(steps)]];
        rows.extend(sides.chunks(2).map(|pair| {
            let second = pair.get(1).copied().unwrap_or_default();
            [pair[0].x, pair[0].y, second.x, second.y]
        }));
        rows.extend(cuts.iter().map(Cut::row));
        rows
    }
}

impl Iris {
    /// The exponent at the centre.
    fn innermost(&self) -> f64 {
        let Inner { edge, apothem, .. } = &*self.0;
        if self.is_round() { -0.5 / edge } else { -apothem / edge }
    }
}

#[cfg(test)]
mod tests;
