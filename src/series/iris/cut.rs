//! Rims that cut an iris, as those of a lens do for light from off the axis: its opening and theirs are circles that lie apart.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::DVec2;

use super::{Inner, Iris, steepest_of_round, step_down};

/// Rims that cut one iris, at most.
const MOST: usize = 6;

/// The sharpest edge that is cut: with a sharper one a step's exponential is no product of doubles along x and y.
const SHARPEST: f64 = 0.02;

/// A rim so large is straight, about: its middle is drawn nearer.
const STRAIGHT: f64 = 30.0;

/// What is left of an iris that is this much darker at its brightest is nothing.
const DARKEST: f64 = 1e-3;

/// How shaders count cuts beside sides, of which there are fewer.
pub(super) const IN_SHADERS: u32 = 32;

/// A circle beyond which an iris is dark; lengths in its sizes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cut {
    /// The middle of the circle, from that of the iris.
    pub centre: DVec2,
    /// Its radius, above 0.
    pub radius: f64,
}

impl Cut {
    /// A rim that lies so many edges beyond the opening's is not seen.
    pub const SPARED: f64 = 5.0;

    /// What over the edge is a step's exponent: (|u − c|² / ρ − ρ) / 2, in the form in which nothing large cancels.
    pub(super) fn exponent(&self, at: DVec2) -> f64 {
        self.across(at.x) + self.down(at.y)
    }

    /// The part of the exponent that goes with x alone, and that with y and the constant.
    pub(super) fn across(&self, x: f64) -> f64 {
        x * (0.5 * x - self.centre.x) / self.radius
    }

    pub(super) fn down(&self, y: f64) -> f64 {
        y * (0.5 * y - self.centre.y) / self.radius + self.constant()
    }

    fn constant(&self) -> f64 {
        let distance = self.centre.length();
        0.5 * (distance / self.radius - 1.0) * (distance + self.radius)
    }

    /// How steep the exponent is, at most, at a distance from the middle of the iris.
    pub(super) fn slope_at(&self, distance: f64) -> f64 {
        (distance + self.centre.length()) / self.radius
    }

    /// How far away its rim is in a direction from the middle of the iris; none where that is not within it.
    pub(super) fn rim(&self, towards: DVec2) -> Option<f64> {
        let along = self.centre.dot(towards);
        let inside = (self.radius - self.centre.length()) * (self.radius + self.centre.length());
        (inside > 0.0).then(|| along + (along * along + inside).sqrt())
    }

    /// A row of a shader's table.
    pub(super) fn row(&self) -> [f64; 4] {
        let [x, y] = (self.centre / self.radius).to_array();
        [x, y, 0.5 / self.radius, self.constant()]
    }

    /// The same with a middle that is not far away.
    fn near(self) -> Self {
        let beyond = self.radius - STRAIGHT;
        if beyond <= 0.0 {
            return self;
        }
        let centre = self.centre - beyond.min(self.centre.length()) * self.centre.normalize_or_zero();
        Self { centre, radius: STRAIGHT }
    }

    /// How far an opening reaches from its middle.
    fn reach(&self) -> f64 {
        self.centre.length() + 1.0
    }
}

impl Iris {
    /// Rims that cut it.
    pub fn cuts(&self) -> &[Cut] {
        &self.0.cuts
    }

    /// What rims leave of a whole iris, 1 at its brightest; none where that is next to nothing. Rims that do not bite are left out, and
    /// their edges are as wide as the iris's own.
    ///
    /// # Panics
    /// For an iris that is cut already.
    pub fn cut(&self, cuts: &[Cut]) -> Option<Self> {
        assert!(self.cuts().is_empty(), "an iris is cut once");
        let edge = self.edge();
        if cuts.iter().any(|cut| cut.radius.is_nan() || cut.radius <= 0.0 || !cut.centre.is_finite()) {
            return None;
        }
        let cuts = self.biting(cuts);
        if cuts.is_empty() || edge < SHARPEST {
            return Some(self.clone());
        }
        let whole = &*self.0;
        // The product as it is, of which the brightest is looked for.
        let parts = Self::with(whole, cuts.clone(), 1.0);
        let peak = parts.brightest().recip();
        if peak.is_nan() || peak * DARKEST >= 1.0 {
            return None;
        }
        Some(Self::with(whole, cuts, peak))
    }

    /// Those rims that bite, the deepest first, as [`Iris::cut`] takes them.
    pub(crate) fn biting(&self, cuts: &[Cut]) -> Vec<Cut> {
        let mut biting: Vec<Cut> =
            cuts.iter().copied().filter(|cut| cut.reach() + Cut::SPARED * self.edge() > cut.radius).collect();
        biting.sort_by(|one, other| (other.reach() - other.radius).total_cmp(&(one.reach() - one.radius)));
        biting.into_iter().take(MOST).map(Cut::near).collect()
    }

    /// Its value at a point in sizes, times the steps of rims: in proportion to that of [`Iris::cut`], of which nothing is looked for.
    /// The rims are those of light in the direction of x, and are turned into the direction `way`, of length 1.
    pub(crate) fn through(&self, at: DVec2, cuts: &[Cut], way: DVec2) -> f64 {
        let turned = DVec2::new(at.dot(way), way.perp_dot(at));
        cuts.iter().fold(self.at(at), |product, cut| product * step_down(cut.exponent(turned) / self.edge()))
    }

    /// ∫∫ of that over the plane, by the trapezoidal rule, which is off by some e^−16.
    pub(crate) fn area_through(&self, cuts: &[Cut], way: DVec2) -> f64 {
        const EXACT: f64 = 16.0;
        let step = TAU * self.fall() / EXACT;
        let half = (self.radius_of(EXACT) / step).ceil() as i32;
        let places = (-half..=half).flat_map(|j| (-half..=half).map(move |i| DVec2::new(f64::from(i), f64::from(j))));
        step * step * places.map(|place| self.through(step * place, cuts, way)).sum::<f64>()
    }

    fn with(whole: &Inner, cuts: Vec<Cut>, peak: f64) -> Self {
        // The slopes of all factors, none of which is above 1.
        let of_cut = |cut: &Cut| steepest_of_round(whole.edge / cut.radius) / cut.radius;
        let steepest = peak * (whole.steepest / whole.peak + cuts.iter().map(of_cut).sum::<f64>());
        let (sides, whole_peak) = (whole.sides.clone(), whole.whole_peak);
        let Inner { edge, blades, rotation, apothem, .. } = *whole;
        let (moments, waves) = Default::default();
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

    /// Its value where it is largest. The logarithm of each step is concave, so that there is one such place: by golden sections along x
    /// of the largest along y.
    fn brightest(&self) -> f64 {
        let reach = 1.0 + 10.0 * self.edge();
        let along_y = |x: f64| -> f64 { largest([-reach, reach], |y| self.logarithm(DVec2::new(x, y))) };
        largest([-reach, reach], along_y).exp()
    }

    fn logarithm(&self, at: DVec2) -> f64 {
        let Inner { edge, sides, apothem, cuts, .. } = &*self.0;
        let of_cuts = cuts.iter().map(|cut| cut.exponent(at) / edge);
        // ln 1/(1 + e^t)
        let step = |t: f64| if t > 30.0 { -t } else { step_down(t).ln() };
        let opening = match self.is_round() {
            true => step(0.5 * (at.length_squared() - 1.0) / edge),
            false => sides.iter().map(|side| step((side.dot(at) - apothem) / edge)).sum(),
        };
        opening + of_cuts.map(step).sum::<f64>()
    }
}

/// The largest value of a concave function between two places.
fn largest([mut low, mut high]: [f64; 2], value: impl Fn(f64) -> f64) -> f64 {
    const STEPS: usize = 40;
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut at_left, mut at_right) = (value(left), value(right));
    for _ in 0..STEPS {
        if at_left < at_right {
            (low, left, at_left) = (left, right, at_right);
            right = low + GOLDEN * (high - low);
            at_right = value(right);
        } else {
            (high, right, at_right) = (right, left, at_left);
            left = high - GOLDEN * (high - low);
            at_left = value(left);
        }
    }
    at_left.max(at_right)
}
