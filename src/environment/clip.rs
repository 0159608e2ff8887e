//! What of a small quadrilateral of directions lies outside of a rectangle, exactly but for how the sphere bends within it.
//!
//! The rectangle's edges and the quadrilateral's sides are great circles, straight on the plane that touches the sphere in the
//! quadrilateral's middle. There it is clipped by one half plane after the other (I. E. Sutherland and G. W. Hodgman, "Reentrant polygon
//! clipping", 1974).

use glam::{DVec2, DVec3};

use super::sight::Rectangle;

/// Corners, one after the other, as unit vectors that the camera has as right, up, ahead; two may be the same.
pub(super) type Quad = [DVec3; 4];

/// What of a quadrilateral is left: the share of its area, a direction in the middle of that, and how far it reaches from there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outside {
    pub share: f64,
    pub middle: DVec3,
    pub radius: f64,
}

/// What of a quadrilateral lies outside; none where that is nothing, or there is no quadrilateral.
pub(super) fn outside(quad: &Quad, rectangle: &Rectangle) -> Option<Outside> {
    let ahead = quad.iter().sum::<DVec3>().try_normalize()?;
    let (right, up) = ahead.any_orthonormal_pair();
    let flat = quad.map(|corner| DVec2::new(corner.dot(right), corner.dot(up)) / corner.dot(ahead));
    // How far inside of each edge ahead + x right + y up lies.
    let edges = rectangle.normals().map(|normal| {
        let [constant, x, y] = [ahead, right, up].map(|axis| normal.dot(axis));
        move |place: DVec2| constant + x * place.x + y * place.y
    });
    let polygon = edges.iter().fold(flat.to_vec(), |polygon, edge| clipped(&polygon, edge));
    let ((all, moment), (inside, of_inside)) = (area(&flat), area(&polygon));
    // Rounding may leave a trace of what lies inside altogether.
    const LEAST: f64 = 1e-9;
    let share = 1.0 - inside / all;
    if share.is_nan() || share < LEAST {
        return None;
    }
    let middle = (moment - of_inside) / (all - inside);
    // Its corners are those that lie outside, and those that clipping made.
    let reach = |places: &[DVec2]| {
        let corners = places.iter().filter(|&&place| edges.iter().any(|edge| edge(place) < LEAST));
        corners.map(|corner| corner.distance(middle)).fold(0.0, f64::max)
    };
    let radius = reach(&flat).max(reach(&polygon));
    Some(Outside { share: share.min(1.0), middle: (ahead + middle.x * right + middle.y * up).normalize(), radius })
}

/// A convex polygon where a linear function is not below 0.
fn clipped(polygon: &[DVec2], inside: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &corner) in polygon.iter().enumerate() {
        let before = polygon[(k + polygon.len() - 1) % polygon.len()];
        let [here, there] = [corner, before].map(&inside);
        if (here < 0.0) != (there < 0.0) {
            kept.push(before.lerp(corner, there / (there - here)));
        }
        if here >= 0.0 {
            kept.push(corner);
        }
    }
    kept
}

/// The area of a polygon, with the sign of its sense, and its first moments.
fn area(polygon: &[DVec2]) -> (f64, DVec2) {
    let mut sum = (0.0, DVec2::ZERO);
    for (k, &from) in polygon.iter().enumerate() {
        let to = polygon[(k + 1) % polygon.len()];
        let triangle = 0.5 * from.perp_dot(to);
        sum = (sum.0 + triangle, sum.1 + triangle / 3.0 * (from + to));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chance::Chance;

    /// Held against many directions, each of which lies inside or not: pixels at edges, at corners, within and without, of
    /// either sense, and triangles.
    #[test]
    fn what_lies_outside_is_what_directions_say() {
        let rectangle = Rectangle::new([0.8, 0.5]);
        let mut chance = Chance::new(7);
        let side = 0.004;
        let mut cut = 0;
        for case in 0..60 {
            let place = match case % 4 {
                0 => DVec2::new(0.8, chance.between(-0.5, 0.5)),
                1 => DVec2::new(chance.between(-0.8, 0.8), -0.5),
                2 => DVec2::new(-0.8, 0.5),
                _ => DVec2::new(chance.between(-1.0, 1.0), chance.between(-0.7, 0.7)),
            } + DVec2::new(chance.between(-side, side), chance.between(-side, side));
            let turn = DVec2::from_angle(chance.between(0.0, 6.0));
            let at = |x: f64, y: f64| (place + side * turn.rotate(DVec2::new(x, y))).extend(1.0).normalize();
            let mut quad = [at(-0.5, -0.5), at(0.5, -0.5), at(0.5, 0.5), at(-0.5, 0.5)];
            if case % 3 == 0 {
                quad.reverse();
            }
            // Even on the plane of the picture is nearly even on the sphere over so small a side.
            let (mut count, mut sum) = (0, DVec3::ZERO);
            const STEPS: i32 = 400;
            for k in 0..STEPS * STEPS {
                let along = |k: i32| (f64::from(k) + 0.5) / f64::from(STEPS) - 0.5;
                let direction = at(along(k % STEPS), along(k / STEPS));
                if rectangle.inside(direction) < 0.0 {
                    (count, sum) = (count + 1, sum + direction);
                }
            }
            let share = f64::from(count) / f64::from(STEPS * STEPS);
            let found = outside(&quad, &rectangle).map_or((0.0, quad[0]), |found| (found.share, found.middle));
            assert!((found.0 - share).abs() < 2e-3, "{case}: {found:?} for {share}");
            if share > 0.02 {
                assert!(found.1.distance(sum.normalize()) < 0.01 * side, "{case}: {found:?} for {sum}");
            }
            cut += u32::from(share > 0.01 && share < 0.99);
        }
        assert!(cut > 30, "{cut}");
        // At a pole two corners are one.
        let at = |x: f64, y: f64| DVec3::new(x, y, 1.0).normalize();
        let triangle = [at(0.79, 0.0), at(0.79, 0.0), at(0.81, 0.01), at(0.81, -0.01)];
        let share = outside(&triangle, &rectangle).unwrap().share;
        assert!((share - 0.75).abs() < 1e-2, "{share}");
        assert!(outside(&[DVec3::Z; 4], &rectangle).is_none());
    }
}
