//! Where a sample looks: not everywhere, but wherever each source of error is at its largest.

use std::collections::HashSet;
use std::f64::consts::TAU;

use glam::DVec2;
use rayon::prelude::*;

use super::whole::crossings;
use crate::frame::Frame;
use crate::plan::{self, Area, Plan};
use crate::scene::Ghost;

/// Pixels that a certificate looks at, at least and at most.
pub(super) const FEWEST: usize = 32;
const MOST: usize = 384;
/// Bells that it may evaluate in f64: many ghosts get fewer pixels.
const EFFORT: usize = 20_000_000;
/// More pixels where ghosts are so few that these bells are a millisecond or two.
const MOST_OF_FEW: usize = 1500;
const EFFORT_OF_FEW: usize = 150_000;

/// Ghosts that are looked at closely, in each of the orders that make a ghost notable.
const NOTABLE: usize = 16;
/// Angles at which a ring about a ghost is tried.
const ANGLES: usize = 96;
/// Pixels along each border.
const ALONG_BORDERS: i32 = 12;

/// Where to look: the borders, where copies come in; where the field was found largest; centres, flanks and rims of the
/// ghosts that are strongest, steepest, steepest far from the origin, or left out, and where `local` computes them no more;
/// and the rest spread evenly over the window.
pub(crate) fn sample_pixels(plan: &Plan) -> Vec<[i32; 2]> {
    let (ghosts, frame) = (plan.problem().ghosts(), plan.problem().frame());
    if let Some(images) = plan.problem().images() {
        return crossings(plan, images);
    }
    let count = ghosts.len().max(1);
    let most = (EFFORT / count).clamp(FEWEST, MOST).max((EFFORT_OF_FEW / count).min(MOST_OF_FEW));
    let mut sample = Sample { frame, pixels: Vec::new(), seen: HashSet::new() };
    sample.borders(if most < MOST { 2 } else { ALONG_BORDERS });
    sample.all(plan.peaks.iter().copied());
    let special = 2 * most / 3;
    let notable = notable(plan);
    // One pixel of each first: with many ghosts there may be no more.
    sample.all(notable.iter().map(|&k| sample.nearest(&ghosts[k])).collect::<Vec<_>>());
    let ends = notable.iter().flat_map(|&k| beyond(&ghosts[k], plan)).filter(|&pixel| sample.holds(pixel));
    sample.all(ends.take(special / 3).collect::<Vec<_>>());
    let each = special.saturating_sub(sample.pixels.len()) / notable.len().max(1);
    let rings: Vec<[i32; 2]> = notable.iter().flat_map(|&k| sample.rings(&ghosts[k], each)).collect();
    sample.all(rings);
    let stride = ghosts.len().div_ceil(most / 6).max(1);
    sample.all(ghosts.iter().step_by(stride).map(|ghost| sample.nearest(ghost)).collect::<Vec<_>>());
    sample.pixels.truncate(special);
    sample.spread(most);
    sample.pixels.sort_unstable();
    sample.pixels.dedup();
    sample.pixels
}

/// The pixels next to those at which a local layer computes a ghost, level with its centre: there what it leaves out is most.
fn beyond(ghost: &Ghost, plan: &Plan) -> Vec<[i32; 2]> {
    let Some(local) = plan.local() else { return Vec::new() };
    let weight = plan::weight(ghost, plan.scale).into_iter().fold(0.0f64, |largest, weight| largest.max(weight.abs()));
    let frame = plan.problem().frame();
    let Area { first, last, .. } = local.area(ghost, weight, frame);
    let [x, y] = frame.pixel(ghost.center).round().as_ivec2().to_array();
    vec![[first[0] - 1, y], [last[0], y], [x, first[1] - 1], [x, last[1]]]
}

/// The ghosts to look at closely, by their indices.
fn notable(plan: &Plan) -> Vec<usize> {
    let ghosts = plan.problem().ghosts();
    let bounds = <[DVec2; 2]>::from(plan.problem().frame().bounds());
    let keys: Vec<[f64; 3]> = ghosts.par_iter().map(|ghost| keys(ghost, plan, bounds)).collect();
    let mut chosen: Vec<usize> = (0..3).flat_map(|key| largest(&keys, key, |_| true)).collect();
    if plan.dropped > 0 {
        let mut kept = vec![false; ghosts.len()];
        let members = plan.groups().flat_map(|group| group.members.iter());
        members.for_each(|&member| kept[member as usize] = true);
        chosen.extend(largest(&keys, 0, |k| !kept[k]));
    }
    let mut seen = HashSet::new();
    chosen.retain(|&k| seen.insert(k));
    chosen
}

/// The ghosts with the largest of these keys, the largest first; none whose key is nothing.
fn largest(keys: &[[f64; 3]], key: usize, among: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut order: Vec<usize> = (0..keys.len()).filter(|&k| keys[k][key] > 0.0 && among(k)).collect();
    let by = |a: &usize, b: &usize| keys[*b][key].total_cmp(&keys[*a][key]);
    if order.len() > NOTABLE {
        order.select_nth_unstable_by(NOTABLE, by);
        order.truncate(NOTABLE);
    }
    order.sort_unstable_by(by);
    order
}

/// How strong a ghost is in the window, how steep it is there, and how far a rounding of the position goes on that slope.
fn keys(ghost: &Ghost, plan: &Plan, [low, high]: [DVec2; 2]) -> [f64; 3] {
    let shape = ghost.bell.shape();
    let weights = ghost.radiance.iter().zip(plan.scale).map(|(radiance, scale)| (radiance / scale).abs());
    let weight = weights.fold(0.0, f64::max);
    let near = ghost.center.clamp(low, high);
    let offset = ((near - ghost.center) / ghost.size).abs();
    let strong = weight * shape.along(offset.x, 1.0) * shape.along(offset.y, 1.0);
    // A jump is steeper than anything, and still to be held against other jumps.
    let slope = shape.steepest(offset.x.max(offset.y)) + 1e7 * shape.jump();
    let steep = strong.min(weight) * slope / ghost.size.min_element();
    [strong, steep, steep * near.length()]
}

/// A sample as it grows; every pixel once.
struct Sample {
    frame: Frame,
    pixels: Vec<[i32; 2]>,
    seen: HashSet<[i32; 2]>,
}

impl Sample {
    fn all(&mut self, pixels: impl IntoIterator<Item = [i32; 2]>) {
        for pixel in pixels {
            if self.seen.insert(pixel) {
                self.pixels.push(pixel);
            }
        }
    }

    /// The last column and row, counted from the window's first.
    fn last(&self) -> [i32; 2] {
        [self.frame.window.width as i32 - 1, self.frame.window.height as i32 - 1]
    }

    /// Whether a pixel is in the window.
    fn holds(&self, [i, j]: [i32; 2]) -> bool {
        let ([right, bottom], window) = (self.last(), self.frame.window);
        (window.x..=window.x + right).contains(&i) && (window.y..=window.y + bottom).contains(&j)
    }

    /// The corners, and pixels between them along the borders.
    fn borders(&mut self, steps: i32) {
        let ([right, bottom], window) = (self.last(), self.frame.window);
        let along = |last: i32, k: i32| (i64::from(last) * i64::from(k) / i64::from(steps)) as i32;
        let local = (0..=steps).flat_map(|k| {
            let (i, j) = (along(right, k), along(bottom, k));
            [[i, 0], [i, bottom], [0, j], [right, j]]
        });
        self.all(local.map(|[i, j]| [window.x + i, window.y + j]).collect::<Vec<_>>());
        self.all([[window.x + right / 2, window.y + bottom / 2]]);
    }

    /// The pixel nearest to a place, where it is in the window.
    fn inside(&self, place: DVec2) -> Option<[i32; 2]> {
        let ([right, bottom], window) = (self.last(), self.frame.window);
        let p = self.frame.pixel(place).round();
        let [i, j] = [p.x - f64::from(window.x), p.y - f64::from(window.y)];
        let within = (0.0..=f64::from(right)).contains(&i) && (0.0..=f64::from(bottom)).contains(&j);
        within.then(|| [i as i32 + window.x, j as i32 + window.y])
    }

    /// The pixel nearest to a ghost's centre.
    fn nearest(&self, ghost: &Ghost) -> [i32; 2] {
        let (low, high) = self.frame.bounds();
        // Bounds are pixels, but for rounding.
        self.inside(ghost.center.clamp(low, high)).unwrap_or([self.frame.window.x, self.frame.window.y])
    }

    /// About so many pixels on the rings where the ghost is steep or has a kink, each with its neighbours on both sides.
    fn rings(&self, ghost: &Ghost, count: usize) -> Vec<[i32; 2]> {
        let shape = ghost.bell.shape();
        let edges = shape.edges();
        let each = count / (3 * edges.len().max(1));
        let mut pixels = Vec::new();
        if each == 0 {
            return pixels;
        }
        for edge in edges {
            let ring = |k: usize| {
                let angle = TAU * (k as f64 + 0.25) / ANGLES as f64;
                let towards = DVec2::from_angle(angle);
                let towards = shape.outline(towards) * towards * ghost.size;
                self.inside(ghost.center + edge * towards).map(|_| (ghost.center + edge * towards, towards))
            };
            let ring: Vec<_> = (0..ANGLES).filter_map(ring).collect();
            let step = ring.len() as f64 / each.min(ring.len()).max(1) as f64;
            for k in 0..each.min(ring.len()) {
                let (place, towards) = ring[(k as f64 * step) as usize];
                let beside = 0.8 * self.frame.pixel_sides() * towards.normalize_or_zero();
                pixels.extend([place, place - beside, place + beside].into_iter().filter_map(|at| self.inside(at)));
            }
        }
        pixels
    }

    /// Fills up to `most` evenly. The additive recurrence of the plastic number fills a square more evenly than chance does
    /// (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
    fn spread(&mut self, most: usize) {
        const PLASTIC: f64 = 1.324_717_957_244_746;
        let ([right, bottom], window) = (self.last(), self.frame.window);
        let at =
            |index: usize, step: f64, last: i32| ((index as f64 * step + 0.5).fract() * f64::from(last + 1)) as i32;
        let left = most.saturating_sub(self.pixels.len());
        self.pixels.extend((1..=left).map(|index| {
            let (i, j) = (at(index, 1.0 / PLASTIC, right), at(index, PLASTIC.powi(-2), bottom));
            [window.x + i.min(right), window.y + j.min(bottom)]
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Window;
    use crate::plan::{Request, plan};
    use crate::problem::Problem;
    use crate::series::{Bell, Disc};

    #[test]
    fn samples_lie_in_the_window_and_hold_its_corners() {
        let window = Window { x: -5, y: 7, width: 33, height: 12 };
        let frame = Frame::full(40, 30).with_window(window);
        let pixels = sample_pixels(&plan(&Problem::new([], frame), &Request::new(1e-3)).unwrap());
        assert!(pixels.iter().all(|&[i, j]| (-5..28).contains(&i) && (7..19).contains(&j)), "{pixels:?}");
        for corner in [[-5, 7], [27, 7], [-5, 18], [27, 18]] {
            assert!(pixels.contains(&corner), "{corner:?} of {pixels:?}");
        }
        assert!(pixels.len() >= FEWEST, "{}", pixels.len());
    }

    #[test]
    fn the_sides_of_a_polygon_are_looked_at_from_both_sides() {
        let frame = Frame::full(320, 180);
        let bell = Disc::new(0.0, 3, 20.0).map(Bell::Disc).unwrap();
        let disc = Ghost { bell, center: DVec2::new(0.3, -0.2), size: DVec2::new(0.8, 0.5), radiance: [1.0; 3] };
        let pixels = sample_pixels(&plan(&Problem::new([disc.clone()], frame), &Request::new(1e-3)).unwrap());
        let value = |x: f64, y: f64| disc.bell.shape().value(frame.position(x, y) - disc.center, disc.size);
        // A neighbour is on the other side.
        let beside = |i: f64, j: f64| {
            let here = value(i, j);
            [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].iter().any(|(x, y)| value(i + x, j + y) != here)
        };
        let near = pixels.iter().map(|&[i, j]| (f64::from(i), f64::from(j))).filter(|&(i, j)| beside(i, j));
        let (inside, outside): (Vec<_>, Vec<_>) = near.partition(|&(i, j)| value(i, j) == 1.0);
        assert!(inside.len() > 60 && outside.len() > 60, "{} {}", inside.len(), outside.len());
    }

    #[test]
    fn a_rim_is_looked_at_from_both_sides_and_a_centre_too() {
        let frame = Frame::full(320, 180);
        let disc = Ghost {
            bell: Bell::Paraboloid,
            center: DVec2::new(0.3, -0.2),
            size: DVec2::splat(0.4),
            radiance: [1.0; 3],
        };
        let pixels = sample_pixels(&plan(&Problem::new([disc.clone()], frame), &Request::new(1e-3)).unwrap());
        let radii: Vec<f64> = pixels
            .iter()
            .map(|&[i, j]| ((frame.position(f64::from(i), f64::from(j)) - disc.center) / disc.size).length())
            .collect();
        let pixel = frame.pixel_size() / disc.size.x;
        let (inside, outside): (Vec<f64>, Vec<f64>) =
            radii.iter().filter(|&&r| (r - 1.0).abs() < pixel).partition(|&&r| r < 1.0);
        assert!(inside.len() > 60 && outside.len() > 60, "{} {}", inside.len(), outside.len());
        assert!(radii.iter().any(|&r| r < pixel));
    }
}
