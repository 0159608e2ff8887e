//! A tile of pixels whose light is taken to a few points of it.

use super::camera::Camera;

/// Points along each side of a tile.
pub(super) const POINTS: usize = 4;
/// And in all of it.
pub(super) const ALL: usize = POINTS * POINTS;

/// A tile: of pixels, or of four tiles of the level below.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tile {
    /// First column and row, and those after the last.
    pub first: [usize; 2],
    pub end: [usize; 2],
    pub middle: [f64; 3],
    /// The longest chord from there to a pixel.
    pub radius: f64,
}

/// Lagrange's polynomials of Chebyshev's points, at t from −1 to 1.
fn shares(t: f64) -> [f64; POINTS] {
    let points: [f64; POINTS] = std::array::from_fn(point);
    std::array::from_fn(|index| {
        let others = (0..POINTS).filter(|other| *other != index);
        others.map(|other| (t - points[other]) / (points[index] - points[other])).product()
    })
}

fn point(index: usize) -> f64 {
    -(std::f64::consts::PI * (index as f64 + 0.5) / POINTS as f64).cos()
}

impl Tile {
    pub fn new(camera: &Camera, first: [usize; 2], size: usize) -> Self {
        let end = [0, 1].map(|side| (first[side] + size).min(camera.size[side]));
        let at = |x: f64, y: f64| camera.point(x, y).direction;
        let [left, top] = first.map(|at| at as f64);
        let [right, bottom] = end.map(|at| at as f64 - 1.0);
        let middle = at(0.5 * (left + right), 0.5 * (top + bottom));
        // The farthest is at a corner, or nearly so where a tile is much of the sphere.
        let edges = [
            [left, top],
            [right, top],
            [left, bottom],
            [right, bottom],
            [0.5 * (left + right), top],
            [0.5 * (left + right), bottom],
            [left, 0.5 * (top + bottom)],
            [right, 0.5 * (top + bottom)],
        ];
        let radius = edges.into_iter().map(|[x, y]| square(middle, at(x, y)).sqrt()).fold(0.0, f64::max);
        Self { first, end, middle, radius }
    }

    /// A pixel's place along a side, from −1 to 1.
    fn along(&self, side: usize, at: f64) -> f64 {
        let half = 0.5 * (self.end[side] - self.first[side] - 1) as f64;
        if half == 0.0 { 0.0 } else { (at - self.first[side] as f64) / half - 1.0 }
    }

    /// The column or row of a point.
    pub fn place(&self, side: usize, index: usize) -> f64 {
        let half = 0.5 * (self.end[side] - self.first[side] - 1) as f64;
        self.first[side] as f64 + half * (1.0 + point(index))
    }

    /// What each point counts at a pixel.
    pub fn shares(&self, x: f64, y: f64) -> [f64; ALL] {
        let [across, down] = [shares(self.along(0, x)), shares(self.along(1, y))];
        std::array::from_fn(|index| across[index % POINTS] * down[index / POINTS])
    }
}

#[inline(always)]
pub(super) fn square(one: [f64; 3], other: [f64; 3]) -> f64 {
    let [x, y, z] = [one[0] - other[0], one[1] - other[1], one[2] - other[2]];
    x * x + y * y + z * z
}

/// The corners of a tile and its middle: there, and between the points, interpolation errs most.
pub(super) fn looked_at(tile: &Tile) -> [[f64; 2]; 5] {
    let [left, top] = tile.first.map(|at| at as f64);
    let [right, bottom] = tile.end.map(|at| at as f64 - 1.0);
    [
        [left, top],
        [right, top],
        [left, bottom],
        [right, bottom],
        [0.5 * (left + right), 0.5 * (top + bottom)].map(f64::round),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Polynomials of the third degree are interpolated exactly, and the shares sum to 1.
    #[test]
    fn four_points_have_all_cubics() {
        for t in [-1.0, -0.3, 0.2, 0.99] {
            let cubic = |t: f64| 2.0 + t - 3.0 * t * t + 0.5 * t * t * t;
            let found: f64 = shares(t).into_iter().enumerate().map(|(index, share)| share * cubic(point(index))).sum();
            assert!((found - cubic(t)).abs() < 1e-14 && (shares(t).iter().sum::<f64>() - 1.0).abs() < 1e-14);
        }
    }
}
