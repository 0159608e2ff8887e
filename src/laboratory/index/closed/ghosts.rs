//! The light of a ghost of an even field at a point.
//!
//! A source at p on the picture's plane makes a ghost at m p: its share of the light, by its bell g of the size s. So an even field A gives
//!
//! ```text
//! G(x) = share ∫_A g((x − m p)/s) dp / (s² ∫∫ g) = share / m² · ∫_B g / ∫∫ g,    B = (x − m A)/s
//! ```
//!
//! where A is a rectangle less discs, and B the same about another middle. A Gaussian over a rectangle is a product of error functions. A
//! round iris is a pile of discs, ∫_B g = ∫₀¹ |B ∩ {g > v}| dv, each of which has an area in common with a rectangle and with a disc that is
//! known. Where rims cut a ghost, its bell and its light depend on p, and the first integral is taken in polar coordinates about the
//! axis: at one distance from there all cuts are the same but for a turn.

use std::f64::consts::{PI, SQRT_2, TAU};

use glam::DVec2;

use super::area::{disc_in_disc, disc_in_rectangle};
use super::rule;
use super::sight::{Sight, Spot};
use crate::scene::{LensGhost, Rimmed};
use crate::series::special::erf;
use crate::series::{Bell, Cut, Iris};

/// Distances from the axis at which what rims leave is known; in between by straight lines.
const DISTANCES: u32 = 48;
/// Nodes across a ghost, from edge to edge of the sharpest, and at least, at most of a part.
const ACROSS: f64 = 40.0;
const FEWEST: usize = 8;
/// Widths at which a Gaussian ends, e^−18.
const WIDTHS: f64 = 6.0;
/// What of an iris is left out at its ends.
const NOTHING: f64 = 1e-7;

/// A row of a lens's table, of light from anywhere in a field.
pub struct Row<'a> {
    rimmed: Rimmed<'a>,
    /// Its share, RGB.
    pub share: [f64; 3],
    /// Which of the lens's ghosts it is of.
    pub path: usize,
    along: f64,
    size: f64,
    bell: Round<'a>,
    /// Where rims cut it: of even steps of the distance of light, what they leave, and that over the area of the bell that they leave.
    cut: Option<Vec<[f64; 2]>>,
    /// The farthest light.
    corner: f64,
}

/// The bells of a lens's ghosts.
#[derive(Clone, Copy)]
enum Round<'a> {
    Gaussian,
    Iris(&'a Iris),
}

impl<'a> Row<'a> {
    /// Of a row of the table, whose sizes are made `scale` times as large; none of a bell that no real lens has.
    pub fn new(rimmed: Rimmed<'a>, scale: f64, tint: [f64; 3], corner: f64) -> Option<Self> {
        let row: &'a LensGhost = rimmed.row;
        let bell = match &row.bell {
            Bell::Gaussian => Round::Gaussian,
            Bell::Iris(iris) => Round::Iris(iris),
            _ => return None,
        };
        let share = [0, 1, 2].map(|c| row.share * row.tint[c] * tint[c]);
        let (path, along, size) = (rimmed.path, row.along, scale * row.size.x);
        let mut known = Self { rimmed, share, path, along, size, bell, cut: None, corner };
        known.cut = known.rimmed.is_cut().then(|| (0..=DISTANCES).map(|k| known.table(k)).collect());
        Some(known)
    }

    fn table(&self, step: u32) -> [f64; 2] {
        let distance = self.corner * f64::from(step) / f64::from(DISTANCES);
        let left = self.rimmed.left(distance);
        let area = match self.bell {
            Round::Gaussian => TAU,
            Round::Iris(iris) => {
                let cuts = self.rimmed.cuts(distance);
                // Sides of a polygon lie as often this way to a rim as that.
                let turns = if iris.is_round() { vec![0.0] } else { vec![0.0, PI / f64::from(iris.blades())] };
                let turned =
                    |turn: &f64| iris.area_through(&cuts, DVec2::from_angle(turn + iris.rotation().to_radians()));
                turns.iter().map(turned).sum::<f64>() / turns.len() as f64
            }
        };
        [left, if left > 0.0 { left / area } else { 0.0 }]
    }

    /// What rims leave of light so far from the axis, and that over the area of the bell.
    fn left(&self, distance: f64) -> [f64; 2] {
        let Some(table) = &self.cut else { return [1.0, 1.0 / self.whole()] };
        let place = (distance / self.corner * f64::from(DISTANCES)).clamp(0.0, f64::from(DISTANCES) - 1e-9);
        let (row, part) = (place as usize, place.fract());
        [0, 1].map(|k| (1.0 - part) * table[row][k] + part * table[row + 1][k])
    }

    /// ∫∫ of the bell.
    fn whole(&self) -> f64 {
        match self.bell {
            Round::Gaussian => TAU,
            Round::Iris(iris) => crate::series::Shape::integral(iris, DVec2::ONE),
        }
    }

    /// Of how much of an even field's light, as a mean over all that is lit, there are ghosts at all.
    pub fn carried(&self, sight: &Sight) -> f64 {
        if self.cut.is_none() {
            return 1.0;
        }
        let quarter = rule::over(16, DVec2::ZERO, sight.half, |place| self.left(place.length())[0]);
        let black = |spot: &Spot| spot.area() * self.left(spot.centre.length())[0];
        (4.0 * quarter - sight.spots.iter().map(black).sum::<f64>()) / sight.area()
    }

    /// The light at a point of an even field of luminance 1, of a share of 1.
    pub fn light(&self, sight: &Sight, at: DVec2) -> f64 {
        let of_spots = |of: &dyn Fn(&Spot) -> f64| sight.spots.iter().map(of).sum::<f64>();
        // Where light is does not matter to where the ghost is.
        if (self.along * sight.half.length()).abs() < 1e-6 * self.size {
            return self.carried(sight) * sight.area() * self.value(at / self.size, &[], DVec2::X)
                / (self.whole() * self.size.powi(2));
        }
        match (&self.cut, self.bell) {
            (None, Round::Gaussian) => self.over_rectangle(sight.half, at) - of_spots(&|spot| self.over_spot(spot, at)),
            (None, Round::Iris(iris)) if iris.is_round() => {
                self.over_rectangle(sight.half, at) - of_spots(&|spot| self.over_spot(spot, at))
            }
            _ => self.around(sight.half, at) - of_spots(&|spot| self.cut_by_spot(spot, at)),
        }
    }

    /// The bell in proportion, at a point in its sizes, of light in the direction `way`.
    fn value(&self, at: DVec2, cuts: &[Cut], way: DVec2) -> f64 {
        match self.bell {
            Round::Gaussian => (-0.5 * at.length_squared()).exp(),
            Round::Iris(iris) => iris.through(at, cuts, way),
        }
    }

    /// How far from its middle it is anything, in the unit of lengths.
    fn reach(&self) -> f64 {
        self.size
            * match self.bell {
                Round::Gaussian => WIDTHS,
                Round::Iris(iris) => crate::series::Shape::reach(iris, NOTHING),
            }
    }

    /// What a whole bell has of a rectangle about the axis.
    fn over_rectangle(&self, half: DVec2, at: DVec2) -> f64 {
        let half = self.along.abs() * half / self.size;
        let at = at / self.size;
        let (low, high) = (-half - at, half - at);
        let part = match self.bell {
            Round::Gaussian => {
                let along = |low: f64, high: f64| 0.5 * (erf(high / SQRT_2) - erf(low / SQRT_2));
                along(low.x, high.x) * along(low.y, high.y)
            }
            Round::Iris(iris) => pile(iris, |radius| disc_in_rectangle(radius, low, high)) / self.whole(),
        };
        part / self.along.powi(2)
    }

    /// What a whole bell has of a disc as large as a spot.
    fn over_spot(&self, spot: &Spot, at: DVec2) -> f64 {
        let radius = self.along.abs() * spot.radius() / self.size;
        let apart = (at - self.along * spot.centre).length() / self.size;
        let part = match self.bell {
            Round::Gaussian => {
                let reach = radius.min(apart + WIDTHS);
                let line = |y: f64| {
                    let half = (radius * radius - y * y).max(0.0).sqrt();
                    let along = 0.5 * (erf((apart + half) / SQRT_2) - erf((apart - half) / SQRT_2));
                    along * (-0.5 * y * y).exp() / TAU.sqrt()
                };
                2.0 * rule::integral(32, 0.0, reach.min(WIDTHS), line)
            }
            Round::Iris(iris) => pile(iris, |own| disc_in_disc(own, radius, apart)) / self.whole(),
        };
        part / self.along.powi(2)
    }

    /// The light of sources within the rectangle, in polar coordinates about the axis.
    fn around(&self, half: DVec2, at: DVec2) -> f64 {
        let (middle, reach) = (at / self.along, self.reach() / self.along.abs());
        let (far, turned) = (middle.length(), middle.to_angle());
        let [from, to] = [(far - reach).max(0.0), (far + reach).min(half.length())];
        if from >= to {
            return 0.0;
        }
        let mut ends: Vec<f64> =
            [half.x, half.y, reach - far].into_iter().filter(|end| (from..to).contains(end)).collect();
        ends.extend([from, to]);
        ends.sort_by(f64::total_cmp);
        let nodes = |length: f64| ((ACROSS * 0.5 * length / reach).ceil() as usize + FEWEST).min(ACROSS as usize);
        let ring = |distance: f64| {
            let [left, over_area] = self.left(distance);
            if left <= 0.0 {
                return 0.0;
            }
            let cuts = self.rimmed.cuts(distance);
            let seen = seen(distance, far, reach);
            let light = |angle: f64| {
                let way = DVec2::from_angle(angle);
                let place = (at - self.along * distance * way) / self.size;
                self.value(place, &cuts, way)
            };
            let piece = |[low, high]: [f64; 2]| rule::integral(nodes(distance * (high - low)), low, high, light);
            over_area * distance * arcs(half, distance, turned, seen).into_iter().map(piece).sum::<f64>()
        };
        let parts = ends.windows(2).map(|pair| rule::integral(nodes(pair[1] - pair[0]), pair[0], pair[1], ring));
        parts.sum::<f64>() / self.size.powi(2)
    }

    /// What a ghost that rims cut, or that has blades, would have of a spot.
    fn cut_by_spot(&self, spot: &Spot, at: DVec2) -> f64 {
        let (middle, reach) = (at / self.along, self.reach() / self.along.abs());
        if middle.distance(spot.centre) > reach + spot.radius() {
            return 0.0;
        }
        // The image of a spot is larger than the ghost of a point, and all of its light is cut alike.
        if reach < spot.radius() {
            return self.left(spot.centre.length())[0] * self.over_spot(spot, at);
        }
        let (rings, around) = if spot.radius() < 0.1 * reach { (2, 6) } else { (6, 16) };
        let light = |place: DVec2| {
            let distance = place.length();
            let way = place.normalize_or(DVec2::X);
            let cuts = self.rimmed.cuts(distance);
            self.left(distance)[1] * self.value((at - self.along * place) / self.size, &cuts, way)
        };
        let ring = |radius: f64| {
            let step = TAU / f64::from(around);
            let place = |k: i32| spot.centre + radius * DVec2::from_angle((f64::from(k) + 0.5) * step);
            step * radius * (0..around).map(place).map(light).sum::<f64>()
        };
        rule::integral(rings, 0.0, spot.radius(), ring) / self.size.powi(2)
    }
}

/// ∫₀¹ `area`(radius within which a round iris is above v) dv, over the logistic density of its edge.
fn pile(iris: &Iris, area: impl Fn(f64) -> f64) -> f64 {
    const FAR: f64 = 18.0;
    let peak = 1.0 + (-0.5 / iris.edge()).exp();
    let disc = |t: f64| {
        let down = 1.0 / (1.0 + t.exp());
        peak * down * (1.0 - down) * area((1.0 + 2.0 * iris.edge() * t).max(0.0).sqrt())
    };
    rule::integral(40, -FAR.min(0.5 / iris.edge()), FAR, disc)
}

/// How far to both sides of the direction to a place `far` from the origin a circle about it is within `reach` of that.
fn seen(distance: f64, far: f64, reach: f64) -> f64 {
    if distance + far <= reach {
        return PI;
    }
    let cosine = (distance * distance + (far - reach) * (far + reach)) / (2.0 * distance * far);
    cosine.clamp(-1.0, 1.0).acos()
}

/// The arcs of a circle about the middle of a rectangle that are in it, and no farther than `seen` from a direction.
fn arcs(half: DVec2, distance: f64, middle: f64, seen: f64) -> Vec<[f64; 2]> {
    let (first, last) = ((half.x / distance).min(1.0).acos(), (half.y / distance).min(1.0).asin());
    let inside = match (first <= 0.0, last >= 0.5 * PI) {
        (true, true) => vec![[-PI, PI]],
        (true, false) => vec![[-last, last], [PI - last, PI + last]],
        (false, true) => vec![[first, PI - first], [-PI + first, -first]],
        (false, false) if first < last => {
            vec![[first, last], [PI - last, PI - first], [-last, -first], [-PI + first, -PI + last]]
        }
        _ => return Vec::new(),
    };
    if seen >= PI {
        return inside;
    }
    let turns = [-TAU, 0.0, TAU].map(|turn| [middle + turn - seen, middle + turn + seen]);
    let both = inside.iter().flat_map(|[low, high]| turns.map(|[from, to]| [low.max(from), high.min(to)]));
    both.filter(|[low, high]| low < high).collect()
}

#[cfg(test)]
mod tests;
