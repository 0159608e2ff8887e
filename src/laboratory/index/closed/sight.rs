//! The chart on the picture's plane: a rectangle of even light with black spots. Lengths are in the look's unit, from the axis.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

/// An even field with spots that are black.
#[derive(Debug, Clone)]
pub struct Sight {
    /// Half the rectangle's sides.
    pub half: DVec2,
    /// The focal length, by which places on the plane are directions.
    pub focal: f64,
    pub spots: Vec<Spot>,
}

/// A round spot, which is an ellipse on the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    pub centre: DVec2,
    /// Its longer half axis lies in this direction: away from the axis.
    towards: DVec2,
    /// Half axes in that direction and across it.
    axes: DVec2,
}

impl Spot {
    /// The disc of the same area about the same middle.
    pub fn radius(&self) -> f64 {
        self.axes.element_product().sqrt()
    }

    pub fn area(&self) -> f64 {
        PI * self.axes.element_product()
    }

    pub fn holds(&self, place: DVec2) -> bool {
        self.straight(place - self.centre).length_squared() < 1.0
    }

    /// A vector as one of the plane in which the spot is the disc of radius 1.
    fn straight(&self, vector: DVec2) -> DVec2 {
        DVec2::new(vector.dot(self.towards), vector.perp_dot(self.towards)) / self.axes
    }

    /// How far along a line from a place in a direction of length 1 the spot begins and ends, from 0 on; none where it is not met.
    pub fn along(&self, from: DVec2, way: DVec2) -> Option<[f64; 2]> {
        let (from, way) = (self.straight(from - self.centre), self.straight(way));
        let (square, half) = (way.length_squared(), from.dot(way));
        let root = half * half - square * (from.length_squared() - 1.0);
        let [enters, leaves] = [-1.0, 1.0].map(|sign| (sign * root.sqrt() - half) / square);
        // Written so that a NaN is none.
        (leaves > 0.0).then_some([enters.max(0.0), leaves])
    }

    /// The directions in which a place beyond it sees its ends.
    pub fn ends(&self, from: DVec2) -> Option<[f64; 2]> {
        let seen = self.straight(from - self.centre);
        let square = seen.length_squared();
        if square <= 1.0 {
            return None;
        }
        // Where tangents from there touch the circle of radius 1.
        let (near, beside) = (seen / square, seen.perp() * (square - 1.0).sqrt() / square);
        Some([1.0, -1.0].map(|sign| {
            let touched = (near + sign * beside) * self.axes;
            let place = self.centre + touched.x * self.towards - touched.y * self.towards.perp();
            (place - from).to_angle()
        }))
    }
}

impl Sight {
    /// A field without spots.
    pub fn new(half: DVec2, focal: f64) -> Self {
        Self { half, focal, spots: Vec::new() }
    }

    /// Where a place on the plane looks.
    pub fn direction(&self, place: DVec2) -> DVec3 {
        place.extend(self.focal).normalize()
    }

    /// A spot about a place, of a diameter in degrees.
    pub fn spot(&self, about: DVec2, diameter: f64) -> Spot {
        // The cone's section by the plane (Casey, "Analytical geometry", on sections of a right cone).
        let (sine, cosine) = (0.5 * diameter).to_radians().sin_cos();
        let off = (about.length() / self.focal).atan();
        let square = off.cos().powi(2) - sine * sine;
        let axes = self.focal * sine * DVec2::new(cosine / square, square.sqrt().recip());
        let towards = about.try_normalize().unwrap_or(DVec2::X);
        let centre = self.focal * off.sin() * off.cos() / square * towards;
        Spot { centre, towards, axes }
    }

    /// Places `degrees` from one, so many of them evenly all around.
    pub fn ring(&self, about: DVec2, degrees: f64, count: u32) -> Vec<DVec2> {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let towards = self.direction(about);
        let [across, up] = self.beside(about);
        let at = |k: u32| {
            let (up_part, across_part) = (TAU * f64::from(k) / f64::from(count)).sin_cos();
            let seen = cosine * towards + sine * (across_part * across + up_part * up);
            self.focal * seen.truncate() / seen.z
        };
        (0..count).map(at).collect()
    }

    /// Two directions across that in which a place looks, and across each other.
    pub fn beside(&self, place: DVec2) -> [DVec3; 2] {
        let towards = self.direction(place);
        let across = DVec3::Y.cross(towards).normalize();
        [across, towards.cross(across)]
    }

    /// Whether a place of the plane is lit.
    pub fn is_lit(&self, place: DVec2) -> bool {
        place.abs().cmple(self.half).all() && !self.spots.iter().any(|spot| spot.holds(place))
    }

    /// The area of what is lit.
    pub fn area(&self) -> f64 {
        4.0 * self.half.element_product() - self.spots.iter().map(Spot::area).sum::<f64>()
    }

    /// How far the rectangle's edge is from a place within it, in a direction of length 1.
    pub fn edge(&self, from: DVec2, way: DVec2) -> f64 {
        let to =
            |from: f64, way: f64, half: f64| if way == 0.0 { f64::INFINITY } else { (half.copysign(way) - from) / way };
        to(from.x, way.x, self.half.x).min(to(from.y, way.y, self.half.y))
    }

    /// Whether two of the spots overlap.
    pub fn overlaps(&self) -> bool {
        let longest = |spot: &Spot| spot.axes.max_element();
        let pairs = self
            .spots
            .iter()
            .enumerate()
            .flat_map(|(k, one)| self.spots[k + 1..].iter().map(move |other| (one, other)));
        pairs.into_iter().any(|(one, other)| one.centre.distance(other.centre) < longest(one) + longest(other))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All that is as far from a direction as the spot's rim is on the ellipse, and is met there by a line from anywhere.
    #[test]
    fn a_spot_is_the_ellipse_that_its_cone_cuts() {
        let sight = Sight::new(DVec2::new(1.5, 1.0), 2.1);
        for (about, diameter) in [(DVec2::ZERO, 4.0), (DVec2::new(0.9, -0.6), 2.0), (DVec2::new(-1.2, 0.1), 8.0)] {
            let spot = sight.spot(about, diameter);
            for place in sight.ring(about, 0.5 * diameter, 12) {
                let rim = spot.straight(place - spot.centre);
                assert!((rim.length() - 1.0).abs() < 1e-12, "{about} {diameter}: {rim}");
                let cosine = sight.direction(about).dot(sight.direction(place));
                assert!((cosine - (0.5 * diameter).to_radians().cos()).abs() < 1e-14);
                let from = DVec2::new(0.2, 0.7);
                let way = (place - from).normalize();
                let [enters, leaves] = spot.along(from, way).unwrap();
                let far = place.distance(from);
                assert!((enters - far).abs().min((leaves - far).abs()) < 1e-9, "{enters} {leaves} {far}");
            }
            assert!(spot.holds(about) && sight.is_lit(about) && spot.along(about, DVec2::X).unwrap()[0] == 0.0);
            let with = Sight { spots: vec![spot], ..sight.clone() };
            assert!(!with.is_lit(about) && (with.area() - 6.0 + spot.area()).abs() < 1e-12);
            for end in spot.ends(DVec2::new(0.2, 0.7)).unwrap() {
                let meets = |turn: f64| spot.along(DVec2::new(0.2, 0.7), DVec2::from_angle(end + turn)).is_some();
                assert!(meets(1e-4) != meets(-1e-4), "{end} is an end");
            }
            assert!(spot.ends(about).is_none());
        }
        assert_eq!(sight.edge(DVec2::new(0.5, 0.0), DVec2::X), 1.0);
        assert_eq!(sight.edge(DVec2::new(0.5, 0.5), -DVec2::Y), 1.5);
        assert!((sight.edge(DVec2::ZERO, DVec2::new(0.6, 0.8)) - 1.25).abs() < 1e-15);
    }
}
