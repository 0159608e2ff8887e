//! What a camera sees of all directions, and what its hood accepts of the others.

use std::f64::consts::FRAC_PI_2;
use std::ops::RangeInclusive;

use glam::DVec3;

use crate::motion::Camera;

/// Angles from a lens's axis, in degrees, from which on a hood may cut.
pub const HOODS: RangeInclusive<f64> = 1.0..=90.0;

/// Where it cuts unless somebody says otherwise: what a lens without a hood still catches, the last ten degrees less and less.
pub const USUAL_HOOD: f64 = 80.0;

/// The degrees within which a hood takes all light away.
const PENUMBRA: f64 = 10.0;

/// The band around a picture, as a share of its longer side, on each side of it; and in the panorama's pixels, at least.
const BAND: f64 = 1.0 / 16.0;
const BAND_PIXELS: f64 = 6.0;

/// A camera with a rectilinear picture, a band around it, and a hood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// Unit vectors to the right, up and ahead.
    axes: [DVec3; 3],
    /// Pixels from the eye to the picture.
    focal: f64,
    sides: [u32; 2],
    beyond: [u32; 2],
    /// The cosines of the angles at which the hood begins and ends to cut.
    hood: [f64; 2],
}

/// Directions in front of a camera within a rectangle about its axis, or all of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rectangle {
    /// How far its edges are from the middle, over the focal length, and the cosines of the angles there.
    edges: [f64; 2],
    cosines: [f64; 2],
}

impl Rectangle {
    pub fn new(edges: [f64; 2]) -> Self {
        Self { edges, cosines: edges.map(|edge| edge.hypot(1.0).recip()) }
    }

    /// How far its edges are from the middle.
    pub fn edges(&self) -> [f64; 2] {
        self.edges
    }

    /// Vectors whose product with a direction, as the camera has it, is below 0 where that lies outside: left, right, below, above.
    pub fn normals(&self) -> [DVec3; 4] {
        let [x, y] = self.edges;
        [DVec3::new(1.0, 0.0, x), DVec3::new(-1.0, 0.0, x), DVec3::new(0.0, 1.0, y), DVec3::new(0.0, -1.0, y)]
    }

    /// How far inside its edges a direction, as the camera has it, lies: the sine of the angle to the nearest one, below 0 outside.
    pub fn inside(&self, seen: DVec3) -> f64 {
        let [x, y] = self.sides(seen);
        x.min(y)
    }

    /// The share of a small disc of some radius that lies inside, about.
    pub fn share(&self, seen: DVec3, radius: f64) -> f64 {
        let share = |side: f64| (0.5 + 0.5 * side / radius).clamp(0.0, 1.0);
        // Of two edges that are opposite to each other no small disc meets both.
        self.sides(seen).map(share).into_iter().product()
    }

    fn sides(&self, seen: DVec3) -> [f64; 2] {
        [0, 1].map(|side| self.cosines[side] * (self.edges[side] * seen.z - seen[side].abs()))
    }
}

/// Columns and rows to be stored beyond each edge of a picture whose width spans `fov` degrees, before a panorama of so many rows:
/// beyond them no light is so near that few directions would not do.
pub fn band(fov: f64, sides: [u32; 2], rows: u32) -> [u32; 2] {
    let longer = f64::from(sides[0].max(sides[1]));
    let pixel = focal(fov, sides) * std::f64::consts::PI / f64::from(rows);
    let band = (BAND * longer).max(BAND_PIXELS * pixel).min(0.5 * longer).ceil().max(1.0);
    [band as u32; 2]
}

fn focal(fov: f64, sides: [u32; 2]) -> f64 {
    0.5 * f64::from(sides[0]) / (0.5 * fov).to_radians().tan()
}

impl Sight {
    /// Of a picture of so many columns and rows whose width spans `fov` degrees, below 180, with `beyond` columns and rows stored
    /// beyond each edge; of the rest is accepted what comes from less than `hood` degrees off the axis, and less and less of what
    /// comes from up to ten degrees more, at most 90.
    pub fn new(camera: &Camera, fov: f64, sides: [u32; 2], beyond: [u32; 2], hood: f64) -> Self {
        let hood = [hood.min(90.0), (hood + PENUMBRA).min(90.0)].map(|angle| angle.to_radians().cos());
        Self { axes: camera.axes(), focal: focal(fov, sides), sides, beyond, hood }
    }

    /// Columns and rows of the picture.
    pub(super) fn sides(&self) -> [u32; 2] {
        self.sides
    }

    /// Columns and rows that are stored beyond each edge.
    pub(super) fn beyond(&self) -> [u32; 2] {
        self.beyond
    }

    /// Pixels from the eye to the picture.
    pub(super) fn focal(&self) -> f64 {
        self.focal
    }

    /// Along the lens's axis.
    pub(super) fn ahead(&self) -> DVec3 {
        self.axes[2]
    }

    /// How far the outermost pixels' centres, and the band's edge, are from the middle, over the focal length.
    pub(super) fn edges(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|side| {
            let (all, beyond) = (f64::from(self.sides[side]), f64::from(self.beyond[side]));
            [0.5 * (all - 1.0) / self.focal, (0.5 * all + beyond) / self.focal]
        })
    }

    /// A direction as the camera has it: to the right, up, ahead.
    pub(super) fn seen(&self, direction: DVec3) -> DVec3 {
        DVec3::from(self.axes.map(|axis| axis.dot(direction)))
    }

    /// The direction of what the camera has to the right, up, ahead.
    pub(super) fn unseen(&self, seen: DVec3) -> DVec3 {
        seen.x * self.axes[0] + seen.y * self.axes[1] + seen.z * self.axes[2]
    }

    /// The unit vector towards a place right of and above the middle, over the focal length.
    pub(super) fn direction(&self, [x, y]: [f64; 2]) -> DVec3 {
        (self.axes[2] + x * self.axes[0] + y * self.axes[1]).normalize()
    }

    /// What the picture and its band show.
    pub(super) fn shown(&self) -> Rectangle {
        Rectangle::new(self.edges().map(|[_, edge]| edge))
    }

    /// A: what the hood lets through of light whose angle from the axis has a cosine, 0 to 1.
    pub(super) fn accepts(&self, cosine: f64) -> f64 {
        let [begins, ends] = self.hood;
        if begins <= ends {
            return f64::from(cosine > ends);
        }
        let t = ((cosine - ends) / (begins - ends)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }

    /// Whether the hood accepts all, or nothing, of what lies within a chord of a direction whose cosine this is; none where it cuts.
    pub(super) fn accepts_around(&self, cosine: f64, reach: f64) -> Option<bool> {
        let [begins, ends] = self.hood;
        if cosine - reach >= begins {
            return Some(true);
        }
        (cosine + reach <= ends).then_some(false)
    }

    /// The cosine of the angle between the axis and the picture's corners.
    pub(super) fn corner(&self) -> f64 {
        let [x, y] = self.sides.map(|side| 0.5 * f64::from(side) / self.focal);
        x.hypot(y).hypot(1.0).recip()
    }

    /// ∫ cos ψ dΩ over the picture.
    pub(super) fn projected(&self) -> f64 {
        // Of a rectangle about the axis, as of a plane that a rectangle lights (Lambert's formula for its four corners).
        let [x, y] = self.sides.map(|side| 0.5 * f64::from(side) / self.focal);
        let (a, b) = (x.hypot(1.0), y.hypot(1.0));
        let projected = 2.0 * (x / a * (y / a).atan() + y / b * (x / b).atan());
        debug_assert!((0.0..=2.0 * FRAC_PI_2).contains(&projected));
        projected
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sight(fov: f64, hood: f64) -> Sight {
        let camera = Camera { yaw: 30.0, pitch: -10.0, roll: 5.0, fov: None };
        Sight::new(&camera, fov, [160, 90], [5, 5], hood)
    }

    #[test]
    fn the_light_that_a_picture_gets_is_weighted_by_cosines() {
        for fov in [5.0, 60.0, 150.0] {
            let sight = sight(fov, 80.0);
            let [x, y] = [80.0, 45.0].map(|half| half / sight.focal());
            let steps = 400;
            let mut sum = 0.0;
            for row in 0..steps {
                for column in 0..steps {
                    let at = |k: i32, half: f64| half * (2.0 * (f64::from(k) + 0.5) / f64::from(steps) - 1.0);
                    let square = 1.0 + at(column, x).powi(2) + at(row, y).powi(2);
                    sum += 4.0 * x * y / f64::from(steps * steps) / (square * square);
                }
            }
            assert!((sight.projected() / sum - 1.0).abs() < 1e-4, "{fov}: {} for {sum}", sight.projected());
        }
    }

    #[test]
    fn a_hood_cuts_smoothly() {
        let sight = sight(60.0, 50.0);
        let accepts = |angle: f64| sight.accepts(angle.to_radians().cos());
        assert_eq!((accepts(49.9), accepts(60.1)), (1.0, 0.0));
        let all: Vec<f64> = (500..=600).map(|k| accepts(f64::from(k) * 0.1)).collect();
        assert!(all.windows(2).all(|pair| pair[1] <= pair[0] && pair[0] - pair[1] < 0.02));
        // Nothing comes from behind, whatever the hood.
        for hood in [85.0, 90.0] {
            let bare = self::sight(60.0, hood);
            assert_eq!((bare.accepts(-1e-9), bare.accepts((hood - 0.1).to_radians().cos())), (0.0, 1.0));
        }
    }

    #[test]
    fn what_lies_inside_the_band_is_told_from_what_does_not() {
        let sight = sight(60.0, 80.0);
        let [[_, right], [_, top]] = sight.edges();
        let shown = sight.shown();
        let is_inside = |x: f64, y: f64| shown.inside(sight.seen(sight.direction([x, y]))) > 0.0;
        assert!(is_inside(0.99 * right, 0.99 * top) && is_inside(-0.99 * right, 0.0));
        assert!(!is_inside(1.01 * right, 0.0) && !is_inside(0.0, -1.01 * top));
        assert!(shown.inside(sight.seen(-sight.ahead())) < 0.0);
        let edge = sight.seen(sight.direction([right, 0.0]));
        assert!((shown.share(edge, 0.01) - 0.5).abs() < 1e-9 && shown.share(sight.seen(sight.ahead()), 0.01) == 1.0);
    }
}
