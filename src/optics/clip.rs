//! Rims of a lens as circles in the plane of its entrance pupil, and what they leave of it.

use serde::Serialize;

/// A rim that light passes, as a circle in the entrance pupil's plane: paraxially, rays within it pass.
///
/// Its centre goes with the light's direction, along the same line from the axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Clip {
    /// The rim's surface, from 1.
    pub surface: usize,
    /// Whether its image in the pupil is upside down, which tells of a rim that is no circle.
    pub inverted: bool,
    /// The centre, in mm for a tangent of 1 of the light's angle from the axis.
    pub center_per_tangent: f64,
    /// In mm.
    pub radius: f64,
}

impl Clip {
    /// Whether all that is within `other` is within this as well, for all light up to this tangent; of this, all that is
    /// nearer to its centre than `inner` times the radius is open.
    fn spares(&self, other: &Self, tangent: f64, inner: f64) -> bool {
        let apart = (self.center_per_tangent - other.center_per_tangent).abs() * tangent;
        other.radius + apart <= self.radius * inner
    }
}

/// Those that can bite for light up to a tangent, the smallest first, which alone counts on the axis. The surface `stop` is
/// known to be open within `inner` times its radius only.
pub(super) fn that_bite(mut clips: Vec<Clip>, tangent: f64, stop: usize, inner: f64) -> Vec<Clip> {
    clips.sort_by(|a, b| a.radius.total_cmp(&b.radius));
    let mut kept: Vec<Clip> = Vec::new();
    for clip in clips {
        let inner = if clip.surface == stop { inner } else { 1.0 };
        let same = |other: &Clip| other.surface == clip.surface && other.inverted == clip.inverted;
        let spared = |other: &Clip| clip.spares(other, tangent, if same(other) { 1.0 } else { inner });
        if !kept.iter().any(spared) {
            kept.push(clip);
        }
    }
    kept
}

/// The area, in mm², that all circles have in common, for light of this tangent. Infinite without circles.
///
/// Their centres are on one line, so that the half height over it is that of the lowest circle at each place: the sum of
/// closed forms between the places at which two of them cross.
pub fn common_area(clips: &[Clip], tangent: f64) -> f64 {
    let circles: Vec<(f64, f64)> = clips.iter().map(|clip| (clip.center_per_tangent * tangent, clip.radius)).collect();
    let low = circles.iter().map(|(centre, radius)| centre - radius).fold(f64::NEG_INFINITY, f64::max);
    let high = circles.iter().map(|(centre, radius)| centre + radius).fold(f64::INFINITY, f64::min);
    if circles.is_empty() {
        return f64::INFINITY;
    }
    if low >= high || circles.iter().any(|(centre, radius)| centre.is_nan() || radius.is_nan()) {
        return 0.0;
    }
    let mut places = vec![low, high];
    for (k, &(centre, radius)) in circles.iter().enumerate() {
        for &(other, its) in &circles[k + 1..] {
            // Where r² − (x − c)² is the same for both.
            let crossing = 0.5 * (centre + other + (radius + its) * (radius - its) / (other - centre));
            places.extend(Some(crossing).filter(|crossing| *crossing > low && *crossing < high));
        }
    }
    places.sort_by(f64::total_cmp);
    let piece = |pair: &[f64]| {
        let middle = 0.5 * (pair[0] + pair[1]);
        let square = |&(centre, radius): &(f64, f64)| (radius - (middle - centre)) * (radius + (middle - centre));
        let lowest = circles.iter().min_by(|a, b| square(a).total_cmp(&square(b)));
        lowest.map_or(0.0, |&(centre, radius)| segment(radius, pair[1] - centre) - segment(radius, pair[0] - centre))
    };
    places.windows(2).map(piece).sum::<f64>().max(0.0)
}

/// The abscissa of the centroid of what all circles have in common, for light of this tangent; that of the first circle's centre where they
/// have nothing in common.
pub fn common_middle(clips: &[Clip], tangent: f64) -> f64 {
    /// Strips, whose midpoints are off by less than some thousandth of a radius.
    const STRIPS: u32 = 256;
    let circles = || clips.iter().map(|clip| (clip.center_per_tangent * tangent, clip.radius));
    let low = circles().map(|(centre, radius)| centre - radius).fold(f64::NEG_INFINITY, f64::max);
    let high = circles().map(|(centre, radius)| centre + radius).fold(f64::INFINITY, f64::min);
    let first = circles().next().map_or(0.0, |(centre, _)| centre);
    if low.is_nan() || high.is_nan() || low >= high || clips.is_empty() {
        return first;
    }
    let strip = |k: u32| {
        let x = low + (high - low) * (f64::from(k) + 0.5) / f64::from(STRIPS);
        let square = |(centre, radius): (f64, f64)| (radius - (x - centre)) * (radius + (x - centre));
        (x, circles().map(square).fold(f64::INFINITY, f64::min).max(0.0).sqrt())
    };
    let (moment, area) =
        (0..STRIPS).map(strip).fold((0.0, 0.0), |(moment, area), (x, height)| (moment + x * height, area + height));
    if area > 0.0 { moment / area } else { first }
}

/// The area of a circle about the origin up to the abscissa `x`, counted from 0.
fn segment(radius: f64, x: f64) -> f64 {
    let sine = (x / radius).clamp(-1.0, 1.0);
    radius * radius * (sine.asin() + sine * (1.0 - sine * sine).sqrt())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn clip(center_per_tangent: f64, radius: f64) -> Clip {
        Clip { surface: 1, inverted: false, center_per_tangent, radius }
    }

    #[test]
    fn one_circle_has_its_area_and_two_have_a_lens_in_common() {
        assert!((common_area(&[clip(3.0, 2.0)], 0.7) - 4.0 * PI).abs() < 1e-13);
        let apart: f64 = 1.5;
        let (large, small) = (2.0_f64, 1.0_f64);
        // The classical formula of the lens of two circles.
        let part = |r: f64, other: f64| r * r * ((apart * apart + r * r - other * other) / (2.0 * apart * r)).acos();
        let kite =
            (-apart + large + small) * (apart + large - small) * (apart - large + small) * (apart + large + small);
        let lens = part(large, small) + part(small, large) - 0.5 * kite.sqrt();
        let found = common_area(&[clip(0.0, large), clip(apart, small)], 1.0);
        assert!((found - lens).abs() < 1e-13, "{found} {lens}");
    }

    #[test]
    fn circles_within_and_beside_each_other() {
        assert!((common_area(&[clip(0.0, 2.0), clip(0.5, 1.0)], 1.0) - PI).abs() < 1e-13);
        assert_eq!(common_area(&[clip(0.0, 1.0), clip(3.0, 1.0)], 1.0), 0.0);
        assert_eq!(common_area(&[clip(0.0, 1.0), clip(2.0, 1.0), clip(1.0, f64::INFINITY)], 1.0), 0.0);
        assert!((common_area(&[clip(0.0, 1.0), clip(0.0, 1.0)], 1.0) - PI).abs() < 1e-13);
        assert_eq!(common_area(&[], 1.0), f64::INFINITY);
        assert_eq!(common_area(&[clip(0.0, 1.0), clip(f64::NAN, 1.0)], 1.0), 0.0);
    }

    #[test]
    fn many_circles_have_what_a_grid_counts() {
        let clips = [clip(0.0, 1.0), clip(0.8, 1.1), clip(-0.5, 1.4), clip(0.3, 0.95), clip(2.0, 2.4)];
        for tangent in [0.2, 0.6, 1.0] {
            let step = 1e-3;
            let within = |x: f64, y: f64| {
                clips.iter().all(|clip| (x - clip.center_per_tangent * tangent).hypot(y) <= clip.radius)
            };
            let grid = (-2000..2000).flat_map(|j| (-2000..2000).map(move |i| (f64::from(i), f64::from(j))));
            let counted = grid.filter(|(i, j)| within((i + 0.5) * step, (j + 0.5) * step)).count();
            let found = common_area(&clips, tangent);
            assert!((found - counted as f64 * step * step).abs() < 1e-4, "{tangent}: {found}");
        }
    }

    #[test]
    fn the_middle_is_where_a_grid_has_it() {
        let clips = [clip(0.0, 1.0), clip(0.8, 1.1), clip(-0.5, 1.4), clip(2.0, 2.4)];
        for tangent in [0.0, 0.2, 0.6, 1.0] {
            let step = 2e-3;
            let within = |x: f64, y: f64| {
                clips.iter().all(|clip| (x - clip.center_per_tangent * tangent).hypot(y) <= clip.radius)
            };
            let grid = (-700..700).flat_map(|j| (-700..700).map(move |i| (f64::from(i) * step, f64::from(j) * step)));
            let inside: Vec<f64> = grid.filter(|(x, y)| within(*x, *y)).map(|(x, _)| x).collect();
            let wanted = inside.iter().sum::<f64>() / inside.len() as f64;
            let found = common_middle(&clips, tangent);
            assert!((found - wanted).abs() < 3e-3, "{tangent}: {found} {wanted}");
        }
        assert_eq!(common_middle(&[clip(0.5, 1.0), clip(9.0, 1.0)], 1.0), 0.5);
        assert_eq!(common_middle(&[], 1.0), 0.0);
    }

    #[test]
    fn what_never_bites_is_left_out_and_what_does_is_not() {
        let clips = vec![clip(0.0, 5.0), clip(2.0, 5.9), clip(2.0, 6.1), clip(0.0, 1.0)];
        assert_eq!(that_bite(clips.clone(), 0.5, 2, 1.0), [clip(0.0, 1.0)]);
        assert_eq!(that_bite(clips[..3].to_vec(), 0.5, 2, 1.0), [clip(0.0, 5.0), clip(2.0, 5.9)]);
        for tangent in [0.0, 0.2, 0.5] {
            let kept = that_bite(clips[..3].to_vec(), 0.5, 2, 1.0);
            assert!((common_area(&kept, tangent) - common_area(&clips[..3], tangent)).abs() < 1e-12);
        }
    }
    #[test]
    fn an_iris_of_blades_bites_within_its_circle() {
        let iris = Clip { surface: 2, ..clip(0.0, 5.5) };
        let hexagon = 30.0_f64.to_radians().cos();
        let kept = |inner| that_bite(vec![clip(0.0, 5.0), iris], 0.5, 2, inner).len();
        assert_eq!((kept(1.0), kept(hexagon)), (1, 2));
        // By itself it is met once, however often light passes it.
        assert_eq!(that_bite(vec![iris; 3], 0.5, 2, hexagon).len(), 1);
    }
}
