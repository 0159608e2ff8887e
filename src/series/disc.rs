//! The disc: a light out of focus, as the opening of the lens shows it. It is flat, with a soft rim, and round or a regular
//! polygon with as many sides as the opening has blades.
//!
//! Its value is a smoothstep of one number ρ. For a round disc that is the radius; for a polygon it is the size of the
//! polygon of the same kind that the point lies on, by the circle through its corners. No point's ρ is below its radius, so that a bound of the round disc is one
//! of the polygon, but for the slope, which is steeper by one over the cosine of half a side.

mod transform;

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};
use std::sync::Arc;

use glam::DVec2;

use super::bell::{Modes, Shape};
use super::tails::copies;

/// The widest rim, which has no flat part left, and the narrowest but 0, in sizes: a narrower one is steeper than the sums of
/// 64-bit floats are exact.
const RIMS: [f64; 2] = [1e-6, 2.0];

/// Most blades: with more a disc can hardly be told from a round one, and three mirrors would not fold it up.
pub const MOST_BLADES: u32 = 16;

/// A hair for what f64 rounds.
const HAIR: f64 = 1.0 + 1e-12;

/// A flat disc.
#[derive(Debug, Clone, PartialEq)]
pub struct Disc {
    rim: f64,
    /// None where it is round.
    polygon: Option<Arc<Polygon>>,
}

/// A regular polygon whose corners lie on the unit circle.
#[derive(Debug)]
struct Polygon {
    blades: u32,
    rotation: f64,
    /// Cosine and sine of the rotation.
    turn: DVec2,
    /// Two mirrors through the centre: each takes what is on its side, by this direction times √2, to the other.
    mirrors: [DVec2; 2],
    /// The two sides that are left, by the directions in which they lie over their distance from the centre.
    sides: [DVec2; 2],
}

/// Everything else follows from the two.
impl PartialEq for Polygon {
    fn eq(&self, other: &Self) -> bool {
        (self.blades, self.rotation) == (other.blades, other.rotation)
    }
}

impl Disc {
    /// A disc that falls from 1 to 0 within a rim as wide as `rim`, in sizes: by a smoothstep, half of it within ρ = 1 and half
    /// beyond; one of 0 ends at ρ = 1, which is still part of it. `blades` is 0 for a round disc, or how many sides it has, its corners on the circle
    /// ρ = 1: the first of them to the right, turned by `rotation` degrees against the clock.
    ///
    /// # Errors
    /// What is wrong, for people: a rim that is neither 0 nor from 1e-6 to 2, one or two blades or more than
    /// [`MOST_BLADES`], a rotation that is no number, or one of a round disc.
    pub fn new(rim: f64, blades: u32, rotation: f64) -> Result<Self, String> {
        let [narrowest, widest] = RIMS;
        if rim != 0.0 && !(narrowest..=widest).contains(&rim) {
            return Err(format!("the rim of a disc is 0, or from {narrowest:e} to {widest} sizes wide, and not {rim}"));
        }
        if blades != 0 && !(3..=MOST_BLADES).contains(&blades) {
            return Err(format!("a disc has from 3 to {MOST_BLADES} blades, or 0 where it is round, and not {blades}"));
        }
        if !rotation.is_finite() {
            return Err(format!("the rotation of a disc is a number of degrees, and not {rotation}"));
        }
        if blades == 0 && rotation != 0.0 {
            return Err("a round disc has no rotation: it has no `blades` to be turned".into());
        }
        // Not below 0, which would be written as such.
        let polygon = (blades > 0).then(|| Arc::new(Polygon::new(blades, rotation + 0.0)));
        Ok(Self { rim: rim + 0.0, polygon })
    }

    /// A round one and a polygon, for tests.
    pub(super) fn examples() -> [Self; 2] {
        [(0.5, 0, 0.0), (0.3, 5, 17.0)].map(|(rim, blades, rotation)| Self {
            rim,
            polygon: (blades > 0).then(|| Arc::new(Polygon::new(blades, rotation))),
        })
    }

    /// How wide the rim is, in sizes.
    pub fn rim(&self) -> f64 {
        self.rim
    }

    /// How many sides there are; 0 for a round disc.
    pub fn blades(&self) -> u32 {
        self.polygon.as_ref().map_or(0, |polygon| polygon.blades)
    }

    /// By how many degrees it is turned against the clock.
    pub fn rotation(&self) -> f64 {
        self.polygon.as_ref().map_or(0.0, |polygon| polygon.rotation)
    }

    /// Whether it is round.
    pub fn is_round(&self) -> bool {
        self.polygon.is_none()
    }

    /// One over the rim's width; 0 where there is none.
    fn inverse_rim(&self) -> f64 {
        if self.rim == 0.0 { 0.0 } else { 1.0 / self.rim }
    }

    /// ρ of a point, in sizes. `bells/bladed_disc.glsl` does the same, in the same order.
    pub(crate) fn radius(&self, at: DVec2) -> f64 {
        match &self.polygon {
            None => at.length(),
            Some(polygon) => polygon.radius(at),
        }
    }

    /// The value at ρ.
    fn at(&self, radius: f64) -> f64 {
        if self.rim == 0.0 {
            return if radius <= 1.0 { 1.0 } else { 0.0 };
        }
        let within = ((self.ends() - radius) * self.inverse_rim()).clamp(0.0, 1.0);
        within * within * (3.0 - 2.0 * within)
    }

    /// How far the sides are from the centre.
    fn apothem(&self) -> f64 {
        self.polygon.as_ref().map_or(1.0, |polygon| polygon.apothem())
    }

    /// The means of ρ² and ρ⁴ over the rim, by how much the value falls there: of a bell that is a mixture of hard discs.
    fn mean_powers(&self) -> [f64; 2] {
        let square = self.rim * self.rim;
        // Of the smoothstep's slope, 6t(1 − t) for each unit of t, the variance is 1/20 and the fourth moment 3/560.
        [1.0 + square / 20.0, 1.0 + 0.3 * square + 3.0 / 560.0 * square * square]
    }
}

impl Polygon {
    fn new(blades: u32, rotation: f64) -> Self {
        // From a corner to the middle of a side, and on to the next corner: a mirror may stand at each.
        let step = PI / f64::from(blades);
        let half = blades.div_ceil(2);
        let mirror = |steps: u32| SQRT_2 * DVec2::from_angle(FRAC_PI_2 + step * f64::from(steps));
        let side = |steps: u32| DVec2::from_angle(step * f64::from(steps)) / step.cos();
        // Whole turns go first, and exactly.
        let turn = DVec2::from_angle((rotation % 360.0).to_radians());
        let mirrors = [mirror(half), mirror(half.div_ceil(2))];
        Self { blades, rotation, turn, mirrors, sides: [side(1), side(3)] }
    }

    fn apothem(&self) -> f64 {
        (PI / f64::from(self.blades)).cos()
    }

    /// A corner lies on the axis, so that the lower half is the mirror image of the upper one; of that two mirrors leave a
    /// quarter, at most two sides.
    fn radius(&self, at: DVec2) -> f64 {
        let DVec2 { x: cosine, y: sine } = self.turn;
        let mut x = cosine * at.x + sine * at.y;
        let mut y = (cosine * at.y - sine * at.x).abs();
        for mirror in self.mirrors {
            let beyond = (mirror.x * x + mirror.y * y).max(0.0);
            (x, y) = (x - beyond * mirror.x, y - beyond * mirror.y);
        }
        let [first, second] = self.sides.map(|side| side.x * x + side.y * y);
        first.max(second)
    }
}

impl Shape for Disc {
    fn name(&self) -> &'static str {
        "disc"
    }

    fn shader(&self) -> &'static str {
        if self.is_round() { "bells/disc.glsl" } else { "bells/bladed_disc.glsl" }
    }

    fn value(&self, offset: DVec2, size: DVec2) -> f64 {
        self.at(self.radius(offset / size))
    }

    /// The radius is not below either offset, so the root of what both allow bounds the disc.
    fn along(&self, distance: f64, size: f64) -> f64 {
        self.at((distance / size).abs()).sqrt()
    }

    fn wrap(&self, period: f64, distance: f64, size: f64) -> f64 {
        copies(period, distance, size * self.ends(), |x| self.along(x, size))
    }

    /// A smoothstep is steepest in its middle.
    fn steepest(&self, distance: f64) -> f64 {
        if self.rim == 0.0 {
            return 0.0;
        }
        let within = ((self.ends() - distance) * self.inverse_rim()).clamp(0.0, 0.5);
        HAIR * 6.0 * within * (1.0 - within) * self.inverse_rim() / self.apothem()
    }

    fn ends(&self) -> f64 {
        1.0 + 0.5 * self.rim
    }

    /// The smoothstep u²(3 − 2u) is s at u = 1/2 − sin(asin(1 − 2s)/3).
    fn reach(&self, share: f64) -> f64 {
        if share >= 1.0 {
            return 0.0;
        }
        let within = 0.5 - ((1.0 - 2.0 * share).asin() / 3.0).sin();
        (HAIR * (self.ends() - self.rim * within.clamp(0.0, 1.0))).min(self.ends())
    }

    fn jump(&self) -> f64 {
        if self.rim == 0.0 { 1.0 } else { 0.0 }
    }

    /// Both ends of the rim and its middle.
    fn edges(&self) -> Vec<f64> {
        let mut edges = vec![1.0 - 0.5 * self.rim, 1.0, 1.0 + 0.5 * self.rim];
        edges.dedup();
        edges
    }

    fn outline(&self, towards: DVec2) -> f64 {
        1.0 / self.radius(towards)
    }

    fn integral(&self, size: DVec2) -> f64 {
        let area = match &self.polygon {
            None => PI,
            Some(polygon) => 0.5 * f64::from(polygon.blades) * (TAU / f64::from(polygon.blades)).sin(),
        };
        area * self.mean_powers()[0] * size.element_product()
    }

    fn variance(&self) -> f64 {
        let [square, fourth] = self.mean_powers();
        // Of a regular polygon, whose second moments are those of a round bell, with the distance a of its sides:
        // a² (3 + tan²(π/n))/12, where 1/cos² is 1 + tan².
        let apothem = self.apothem();
        (2.0 * apothem * apothem + 1.0) / 12.0 * fourth / square
    }

    /// A polygon's transform depends on the direction as well.
    fn modes(&self) -> Modes<'_> {
        if self.is_round() { Modes::Radial(self) } else { Modes::None }
    }

    fn tabulated(&self) -> bool {
        self.is_round()
    }

    /// Where it ends, one over the rim's width; of a polygon also cosine and sine of the rotation, its mirrors and its sides.
    fn parameters(&self) -> Vec<[f64; 4]> {
        let turn = self.polygon.as_ref().map_or(DVec2::X, |polygon| polygon.turn);
        let mut rows = vec![[self.ends(), self.inverse_rim(), turn.x, turn.y]];
        if let Some(polygon) = &self.polygon {
            rows.extend([polygon.mirrors, polygon.sides].map(|[first, second]| [first.x, first.y, second.x, second.y]));
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chance::Chance;

    fn discs(count: usize) -> Vec<Disc> {
        let mut chance = Chance::new(7);
        let mut one = |k: usize| {
            let rim = if k.is_multiple_of(5) { 0.0 } else { chance.between(1e-6f64.ln(), 2.0f64.ln()).exp() };
            let blades = [0, 3, 4, 5, 6, 9, 16][k % 7];
            let rotation = if blades == 0 { 0.0 } else { chance.between(-400.0, 400.0) };
            Disc::new(rim, blades, rotation).unwrap()
        };
        (0..count).map(&mut one).collect()
    }

    #[test]
    fn no_place_is_beyond_what_bounds_it() {
        let mut chance = Chance::new(8);
        for disc in discs(60) {
            for _ in 0..400 {
                let at = DVec2::new(chance.between(-2.0, 2.0), chance.between(-2.0, 2.0));
                let (value, radius) = (disc.value(at, DVec2::ONE), at.length());
                let allowed = disc.along(at.x, 1.0) * disc.along(at.y, 1.0);
                assert!(value <= allowed * HAIR, "{disc:?} at {at}: {value} {allowed}");
                assert!(radius <= disc.ends() || value == 0.0, "{disc:?} at {at}");
                let step = DVec2::from_angle(chance.between(0.0, TAU)) * 1e-9;
                let slope = (disc.value(at + step, DVec2::ONE) - value).abs() / 1e-9;
                let limit = disc.steepest(radius - 1e-9);
                assert!(slope <= limit + 1e-6 || disc.rim < 1e-3, "{disc:?} at {at}: {slope} {limit}");
                let share = chance.between(-20.0, 0.0).exp();
                let reach = disc.reach(share);
                assert!(value <= share || at.abs().max_element() <= reach, "{disc:?} at {at}: {share} {reach}");
            }
        }
    }

    #[test]
    fn bounds_are_reached() {
        for disc in discs(60) {
            let corner = DVec2::from_angle(disc.rotation().to_radians());
            for share in [0.999, 0.5, 1e-3, 1e-9] {
                let at = disc.reach(share);
                assert!((disc.value(at * corner, DVec2::ONE) - share).abs() < 1e-6 + disc.jump() || disc.rim < 1e-3);
            }
            if disc.rim > 1e-3 {
                // Across a side, which is where a polygon is steepest.
                let across = match disc.blades() {
                    0 => DVec2::X,
                    blades => DVec2::from_angle(disc.rotation().to_radians() + PI / f64::from(blades)),
                };
                let at = |away: f64| disc.value((disc.apothem() + away) * across, DVec2::ONE);
                let slope = (at(-1e-7) - at(1e-7)) / 2e-7;
                assert!((slope / disc.steepest(0.0) - 1.0).abs() < 1e-4, "{disc:?}: {slope} {}", disc.steepest(0.0));
            }
        }
    }

    /// By midpoints, in polar coordinates about the centre, where a polygon is smooth between its corners.
    #[test]
    fn integrals_and_variances_of_polygons_are_those_of_their_values() {
        for disc in discs(14) {
            let (radii, angles) = (4000, 48 * disc.blades().max(1));
            let (mut integral, mut moment) = (0.0, 0.0);
            for j in 0..angles {
                let angle = TAU * (f64::from(j) + 0.5) / f64::from(angles);
                let towards = DVec2::from_angle(angle + disc.rotation().to_radians());
                for i in 0..radii {
                    let step = disc.ends() / f64::from(radii);
                    let radius = (f64::from(i) + 0.5) * step;
                    let part = disc.value(radius * towards, DVec2::ONE) * radius * step * TAU / f64::from(angles);
                    integral += part;
                    moment += part * (radius * towards.x).powi(2);
                }
            }
            let expected = [disc.integral(DVec2::ONE), disc.variance()];
            assert!((integral / expected[0] - 1.0).abs() < 2e-3, "{disc:?}: {integral} {expected:?}");
            assert!((moment / integral / expected[1] - 1.0).abs() < 2e-3, "{disc:?}: {moment} {expected:?}");
        }
    }
}
