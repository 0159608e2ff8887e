//! Where a picture's pixels are on the sphere, and on its stereographic image.
//!
//! In stereographic coordinates a = tan(ψ/2) (cos φ, sin φ), ψ the angle from the axis, the chord c = 2 sin(θ/2) between two
//! directions is given by c² = 4 |a − b|² / ((1 + |a|²)(1 + |b|²)). The image is conformal, and what varies over it is one factor for each point.

/// How a camera forms its picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::veil) enum Projection {
    /// r = F tan ψ.
    Rectilinear,
    /// r = F ψ.
    Equidistant,
}

/// A camera that looks along its picture's middle.
#[derive(Debug, Clone, Copy)]
pub(in crate::veil) struct Camera {
    pub projection: Projection,
    /// The focal length, in pixels.
    pub focal: f64,
    /// Columns and rows.
    pub size: [usize; 2],
}

/// A pixel's centre on the sphere.
#[derive(Debug, Clone, Copy)]
pub(in crate::veil) struct Point {
    /// Unit vector; the axis is the third coordinate.
    pub direction: [f64; 3],
    /// Stereographic coordinates.
    pub at: [f64; 2],
    /// −ln(1 + |a|²).
    pub depth: f64,
    /// The pixel's solid angle, in steradians.
    pub solid_angle: f64,
    /// The mean of what a step of a pixel is along the radius and across it, over what it is at the middle: √ of their product.
    pub scale: f64,
}

impl Camera {
    /// Of the pixel at a column and row, which may lie beyond the picture.
    pub fn point(&self, x: f64, y: f64) -> Point {
        let [u, v] =
            [(x, self.size[0]), (y, self.size[1])].map(|(at, side)| (at - 0.5 * (side as f64 - 1.0)) / self.focal);
        let radius = u.hypot(v);
        // The direction, and the solid angle over that of the middle.
        let (direction, solid_angle) = match self.projection {
            Projection::Rectilinear => {
                let z = 1.0 / (1.0 + radius * radius).sqrt();
                ([u * z, v * z, z], z * z * z)
            }
            Projection::Equidistant => {
                let ratio = if radius == 0.0 { 1.0 } else { radius.sin() / radius };
                ([u * ratio, v * ratio, radius.cos()], ratio.abs())
            }
        };
        let at = [0, 1].map(|side| direction[side] / (1.0 + direction[2]));
        let depth = -(1.0 + at[0] * at[0] + at[1] * at[1]).ln();
        Point { direction, at, depth, solid_angle: solid_angle / (self.focal * self.focal), scale: solid_angle.sqrt() }
    }

    /// The point farthest from the axis.
    pub fn corner(&self) -> Point {
        self.point(0.0, 0.0)
    }
}

impl Point {
    /// The chord between two directions.
    pub fn chord(&self, other: &Self) -> f64 {
        let square = |side: usize| (self.direction[side] - other.direction[side]).powi(2);
        (square(0) + square(1) + square(2)).sqrt()
    }
}

/// The angle that has a chord, in degrees.
pub(in crate::veil) fn angle(chord: f64) -> f64 {
    (2.0 * (0.5 * chord).min(1.0).asin()).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_follow_from_stereographic_coordinates() {
        for projection in [Projection::Rectilinear, Projection::Equidistant] {
            let camera = Camera { projection, focal: 70.0, size: [160, 90] };
            let [one, two] = [camera.point(3.0, 80.0), camera.point(120.0, 11.0)];
            let square: f64 = (0..2).map(|side| (one.at[side] - two.at[side]).powi(2)).sum();
            let chord = (4.0 * square * (one.depth + two.depth).exp()).sqrt();
            assert!((chord / one.chord(&two) - 1.0).abs() < 1e-14);
        }
    }

    /// The sum over a fine picture is the solid angle of its pyramid, 4 asin(sin a sin b) for half fields a and b.
    #[test]
    fn pixels_fill_the_field() {
        let camera = Camera { projection: Projection::Rectilinear, focal: 200.0, size: [400, 300] };
        let all: f64 =
            (0..400 * 300).map(|pixel| camera.point((pixel % 400) as f64, (pixel / 400) as f64).solid_angle).sum();
        let [a, b] = [200.0f64, 150.0].map(|half| (half / 200.0).atan().sin());
        assert!((all / (4.0 * (a * b).asin()) - 1.0).abs() < 1e-5);
    }
}
