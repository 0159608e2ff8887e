//! The shortest period whose wrapped copies stay away from the picture.

use std::collections::BTreeMap;

use glam::DVec2;

use super::weigh::Weighed;
use crate::frame::Frame;
use crate::scene::Ghost;
use crate::series::{Bell, Shape};

/// Ghosts of about one size and one distance, as the bounds see them: the worst of each.
pub(super) struct Reach {
    bell: Bell,
    size: DVec2,
    /// Largest distance from a ghost to a pixel along each axis.
    farthest: DVec2,
    /// What is left of the bell at the nearest pixel along each axis.
    nearest: DVec2,
    weight: f64,
}

/// Gathers the ghosts into some hundreds of reaches, so that trying a period costs the same for any number of them.
pub(super) fn reaches(ghosts: &[Ghost], weighed: &Weighed, frame: Frame) -> Vec<Reach> {
    let (low, high) = frame.bounds();
    let mut bells: Vec<&Bell> = Vec::new();
    let mut bins: BTreeMap<(usize, [i32; 6]), Reach> = BTreeMap::new();
    for (ghost, &weight) in ghosts.iter().zip(&weighed.weights).filter(|(_, weight)| **weight > 0.0) {
        let shape = ghost.bell.shape();
        let bell = bells.iter().position(|&bell| *bell == ghost.bell).unwrap_or_else(|| {
            bells.push(&ghost.bell);
            bells.len() - 1
        });
        let farthest = (ghost.center - low).abs().max((high - ghost.center).abs());
        let offset = ghost.center.clamp(low, high) - ghost.center;
        let nearest = DVec2::new(shape.along(offset.x, ghost.size.x), shape.along(offset.y, ghost.size.y));
        let octave = |value: f64, steps: f64| (value.max(1e-300).log2() * steps).floor() as i32;
        let key = [
            octave(ghost.size.x, 4.0),
            octave(ghost.size.y, 4.0),
            octave(farthest.x, 8.0),
            octave(farthest.y, 8.0),
            octave(nearest.x, 1.0).max(-40),
            octave(nearest.y, 1.0).max(-40),
        ];
        let reach = bins.entry((bell, key)).or_insert_with(|| Reach {
            bell: ghost.bell.clone(),
            size: ghost.size,
            farthest,
            nearest,
            weight: 0.0,
        });
        reach.size = reach.size.max(ghost.size);
        reach.farthest = reach.farthest.max(farthest);
        reach.nearest = reach.nearest.max(nearest);
        reach.weight += weight;
    }
    bins.into_values().collect()
}

/// The shortest period along each axis that leaves at most half of the budget to its copies.
pub(super) fn shortest(reaches: &[Reach], budget: f64) -> DVec2 {
    // Copies along x are seen through the bell's y factor, which is at most its value at the nearest pixel.
    let along = |axis: fn(DVec2) -> f64, across: fn(DVec2) -> f64| {
        let error = |period: f64| -> f64 {
            let wrap = |reach: &Reach| {
                reach.bell.shape().wrap(period, axis(reach.farthest), axis(reach.size)) * across(reach.nearest)
            };
            reaches.iter().map(|reach| reach.weight * wrap(reach)).sum()
        };
        // The bound holds for periods longer than every distance.
        let farthest = reaches.iter().map(|reach| axis(reach.farthest)).fold(0.0, f64::max);
        let widest = reaches.iter().map(|reach| axis(reach.size)).fold(0.0, f64::max);
        let mut low = if farthest > 0.0 || widest > 0.0 { farthest } else { 1.0 };
        let mut high = low + widest.max(1e-6 * low);
        while error(high) > 0.45 * budget {
            high = low + 2.0 * (high - low);
        }
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if error(middle) > 0.45 * budget { low = middle } else { high = middle }
        }
        high
    };
    DVec2::new(along(|v| v.x, |v| v.y), along(|v| v.y, |v| v.x))
}

/// A bound of what all wrapped copies add at any pixel.
pub(super) fn error(reaches: &[Reach], period: DVec2) -> f64 {
    let wrap = |shape: &dyn Shape, period: f64, distance: f64, size: f64| {
        if period > distance {
            return shape.wrap(period, distance, size);
        }
        // A given period may be shorter than the picture: the copy that lands on it counts in full, the others are
        // those of a ghost that is nearer.
        let landed = (distance / period).floor();
        2.0 * landed + 2.0 + shape.wrap(period, distance - landed * period, size)
    };
    let one = |reach: &Reach| {
        let shape = reach.bell.shape();
        let x = wrap(shape, period.x, reach.farthest.x, reach.size.x);
        let y = wrap(shape, period.y, reach.farthest.y, reach.size.y);
        reach.weight * (x * reach.nearest.y + y * reach.nearest.x + x * y)
    };
    reaches.iter().map(one).sum()
}
