//! Areas that a disc has in common with a rectangle and with another disc.

use std::f64::consts::PI;

use glam::DVec2;

/// What the disc of this radius about the origin has in common with a rectangle between two corners.
pub fn disc_in_rectangle(radius: f64, low: DVec2, high: DVec2) -> f64 {
    if !(radius > 0.0 && low.cmplt(high).all()) {
        return 0.0;
    }
    let part = |x: f64, y: f64| below(radius, x, y);
    part(high.x, high.y) - part(low.x, high.y) - part(high.x, low.y) + part(low.x, low.y)
}

/// What of it is left of `x` and below `y`.
fn below(radius: f64, x: f64, y: f64) -> f64 {
    let (x, y) = (x.clamp(-radius, radius), y.clamp(-radius, radius));
    // From where to where the line at y is within the disc.
    let half = ((radius - y) * (radius + y)).max(0.0).sqrt();
    let up_to = |x: f64| half_up_to(radius, x) - half_up_to(radius, -radius);
    // The upper bound is y between −half and half, and the circle beside that, where y is above the middle.
    let within = x.clamp(-half, half);
    let flat = (within + half) * y;
    if y < 0.0 {
        return flat + half_up_to(radius, within) - half_up_to(radius, -half);
    }
    let sides = half_up_to(radius, x.min(-half)) - half_up_to(radius, -radius) + half_up_to(radius, x.max(half))
        - half_up_to(radius, half);
    up_to(x) + flat + sides
}

/// ∫ √(r² − u²) du from 0 to x.
fn half_up_to(radius: f64, x: f64) -> f64 {
    let sine = (x / radius).clamp(-1.0, 1.0);
    0.5 * radius * radius * (sine.asin() + sine * (1.0 - sine * sine).sqrt())
}

/// What two discs have in common whose middles lie so far apart: a lens.
pub fn disc_in_disc(one: f64, other: f64, apart: f64) -> f64 {
    let (small, large) = (one.min(other), one.max(other));
    if small <= 0.0 || apart >= small + large {
        return 0.0;
    }
    if apart <= large - small {
        return PI * small * small;
    }
    // The chord through both circles' crossings, from either middle.
    let from_small = (apart * apart + (small - large) * (small + large)) / (2.0 * apart);
    let cap = |radius: f64, far: f64| 0.5 * PI * radius * radius - 2.0 * half_up_to(radius, far);
    cap(small, from_small) + cap(large, apart - from_small)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chance::Chance;

    /// The share of points by chance within the disc, evenly in the square about it, that are within something else, as an area.
    fn sampled(radius: f64, also: impl Fn(DVec2) -> bool) -> f64 {
        const POINTS: usize = 400_000;
        let mut chance = Chance::new(11);
        let mut point = || DVec2::from([0, 1].map(|_| chance.between(-radius, radius)));
        let inside = (0..POINTS).map(|_| point()).filter(|at| at.length() <= radius && also(*at)).count();
        4.0 * radius * radius * inside as f64 / POINTS as f64
    }

    #[test]
    fn a_disc_in_a_rectangle_has_the_area_that_points_by_chance_find() {
        let mut chance = Chance::new(3);
        for _ in 0..40 {
            let mut corner = || DVec2::from([0, 1].map(|_| chance.between(-1.6, 1.6)));
            let (one, other) = (corner(), corner());
            let (low, high) = (one.min(other), one.max(other));
            let found = disc_in_rectangle(1.2, low, high);
            let wanted = sampled(1.2, |at| at.cmpge(low).all() && at.cmple(high).all());
            assert!((found - wanted).abs() < 0.015, "{low} {high}: {found} for {wanted}");
        }
        let all = disc_in_rectangle(0.5, DVec2::splat(-1.0), DVec2::splat(1.0));
        assert!((all - 0.25 * PI).abs() < 1e-14);
        let quarter = disc_in_rectangle(2.0, DVec2::ZERO, DVec2::splat(9.0));
        assert!((quarter - PI).abs() < 1e-14);
        let square = disc_in_rectangle(9.0, DVec2::splat(-1.0), DVec2::new(2.0, 1.0));
        assert!((square - 6.0).abs() < 1e-12);
        assert_eq!(disc_in_rectangle(1.0, DVec2::splat(2.0), DVec2::splat(3.0)), 0.0);
        assert_eq!(disc_in_rectangle(1.0, DVec2::ZERO, DVec2::ZERO), 0.0);
    }

    #[test]
    fn two_discs_have_the_lens_that_points_by_chance_find() {
        for (one, other, apart) in [(1.0, 0.7, 0.9), (1.0, 0.3, 0.8), (0.6, 1.4, 0.9), (1.0, 1.0, 0.1), (1.0, 1.0, 1.9)]
        {
            let found = disc_in_disc(one, other, apart);
            let wanted = sampled(one, |at| at.distance(DVec2::new(apart, 0.0)) <= other);
            assert!((found - wanted).abs() < 0.01, "{one} {other} {apart}: {found} for {wanted}");
            assert_eq!(found, disc_in_disc(other, one, apart));
        }
        assert_eq!(disc_in_disc(1.0, 0.5, 1.5), 0.0);
        assert!((disc_in_disc(1.0, 0.5, 0.4) - 0.25 * PI).abs() < 1e-15);
        assert!((disc_in_disc(1.0, 1.0, 0.0) - PI).abs() < 1e-15);
    }
}
