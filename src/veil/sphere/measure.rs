//! How far what is realised is from what is wanted.

use rayon::prelude::*;

use super::camera::{Camera, Point, angle};
use super::model::{Model, Wanted};
use super::tiles::{FARTHEST, Slopes, middle};

/// By how much the bound over all pairs can be above that over those that are looked at.
pub(super) const BETWEEN: f64 = 1.1;

/// Shares of the picture at which targets are. What is symmetric about the middle is looked at once.
pub(super) const TARGETS: [[f64; 2]; 12] = [
    [0.0, 0.0],
    [0.5, 0.5],
    [0.0, 0.5],
    [0.25, 0.25],
    [0.5, 0.0],
    [0.12, 0.4],
    [0.4, 0.12],
    [0.75, 0.9],
    [0.0, 0.25],
    [0.25, 0.0],
    [0.0, 0.1],
    [0.1, 0.0],
];

/// Places along a side of the picture at which sources are that any target is held to; the edges are among them.
const SOURCES: usize = 13;

/// Tiles whose small kernels are looked at, from the middle of the picture to an edge, to the other and to the corner: what is
/// wrong depends on the distance from the middle, and a kink may be in a few tiles only.
const TILES: usize = 24;

/// From a distance to the next at which sources are, for the targets and for the tiles.
const DENSE: f64 = 1.05;
const SPARSE: f64 = 1.25;

/// The pixel there.
pub(super) fn target(camera: &Camera, share: [f64; 2]) -> [usize; 2] {
    [0, 1].map(|side| (share[side] * (camera.size[side] - 1) as f64) as usize)
}

/// The largest chord at which the image alone is wrong by more than `limit`, and the largest error beyond a hundred pixels.
pub(super) fn beyond(model: &Model, profile: &(dyn Fn(f64) -> f64 + Sync), limit: f64) -> (f64, f64) {
    let far = FARTHEST as f64 / model.camera.focal;
    let around = |share: &[f64; 2]| {
        let at = target(&model.camera, *share);
        let here = model.camera.point(at[0] as f64, at[1] as f64);
        let mut found = (0.0f64, 0.0f64);
        for source in offsets(&model.camera, at) {
            let there = model.camera.point(source[0] as f64, source[1] as f64);
            let chord = here.chord(&there);
            if chord <= found.0 {
                continue;
            }
            let error = missed(model, profile(angle(chord)), &there, &here);
            if error > limit {
                found.0 = chord;
                found.1 = if chord > far { found.1.max(error) } else { found.1 };
            }
        }
        found
    };
    let all = TARGETS.par_iter().map(around);
    all.reduce(|| (0.0, 0.0), |one, other| (one.0.max(other.0), one.1.max(other.1)))
}

/// The largest relative error of the image alone over pairs farther apart than the small kernels reach, and the distance in pixels
/// where it is.
pub(super) fn far(model: &Model, wanted: &Wanted) -> (f64, f64) {
    let around = |share: &[f64; 2]| {
        let at = target(&model.camera, *share);
        let here = model.camera.point(at[0] as f64, at[1] as f64);
        let mut worst = (0.0f64, 0.0);
        for source in offsets(&model.camera, at) {
            let there = model.camera.point(source[0] as f64, source[1] as f64);
            let chord = here.chord(&there);
            if chord <= wanted.near {
                continue;
            }
            let error = missed(model, wanted.at(chord), &there, &here);
            if error > worst.0 {
                let [x, y] = [0, 1].map(|side| source[side].abs_diff(at[side]) as f64);
                worst = (error, x.hypot(y));
            }
        }
        worst
    };
    TARGETS.par_iter().map(around).reduce(|| (0.0, 0.0), |one, other| if other.0 > one.0 { other } else { one })
}

/// The largest relative error of the image alone at one pair, whose truth is given; what is no number is wrong without bounds.
fn missed(model: &Model, truth: f64, source: &Point, target: &Point) -> f64 {
    let [low, high] = model.between(source, target, true);
    let error = (high - truth).max(truth - low) / truth;
    if error.is_nan() { f64::INFINITY } else { error }
}

/// The largest relative error over pairs that small kernels of tiles take, and the distance in pixels where it is; any above `enough`
/// will do.
pub(super) fn near(model: &Model, wanted: &Wanted, tile: [usize; 2], enough: f64) -> (f64, f64) {
    let [width, height] = model.camera.size;
    let mut targets = Vec::new();
    let mut add = |share: [f64; 2], step: f64| {
        let at = target(&model.camera, share);
        // A tile's corners are where its kernel is most wrong, but for kinks.
        let origin = [0, 1].map(|side| at[side] / tile[side] * tile[side]);
        for quarters in [[0, 0], [4, 0], [0, 4], [4, 4], [2, 2], [1, 1], [3, 1], [1, 3], [3, 3]] {
            let within = |side: usize| origin[side] + quarters[side] * (tile[side] - 1) / 4;
            targets.push(([within(0).min(width - 1), within(1).min(height - 1)], step));
        }
    };
    TARGETS.into_iter().for_each(|share| add(share, DENSE));
    for ray in [[0.5, 0.0], [0.0, 0.5], [0.5, 0.5]] {
        (0..TILES).for_each(|index| add(ray.map(|side| 0.5 - side * index as f64 / (TILES - 1) as f64), SPARSE));
    }
    // Of equals the one that is looked at more closely.
    targets.sort_unstable_by(|one, other| one.0.cmp(&other.0).then(one.1.total_cmp(&other.1)));
    targets.dedup_by_key(|(target, _)| *target);
    let worst = std::sync::Mutex::new((0.0f64, 0.0f64));
    let peek = || worst.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    targets.par_iter().for_each(|&(target, step)| {
        if peek().0 > enough {
            return;
        }
        let found = around(model, wanted, tile, target, step);
        let mut worst = peek();
        if found.0 > worst.0 || found.0.is_nan() {
            *worst = (if found.0.is_nan() { f64::INFINITY } else { found.0 }, found.1);
        }
    });
    let worst = peek();
    *worst
}

/// Sources of a target: by distances and directions, and spread over the picture and its edges, where pairs are farthest apart.
pub(super) fn offsets(camera: &Camera, target: [usize; 2]) -> Vec<[usize; 2]> {
    let sides = camera.size.map(|side| (side - 1) as f64);
    let at = |index: usize, side: usize| (index as f64 / (SOURCES - 1) as f64 * sides[side]).round() as usize;
    let spread = (0..SOURCES * SOURCES).map(|index| [at(index % SOURCES, 0), at(index / SOURCES, 1)]);
    let mut sources = rings(camera, target, sides[0] + sides[1], DENSE);
    sources.extend(spread.filter(|source| *source != target));
    sources.sort_unstable();
    sources.dedup();
    sources
}

/// Sources in 24 directions, each `step` times as far as the last or half a pixel farther, to a distance in pixels.
fn rings(camera: &Camera, target: [usize; 2], to: f64, step: f64) -> Vec<[usize; 2]> {
    let [width, height] = camera.size.map(|side| side as f64);
    let [x, y] = target.map(|at| at as f64);
    let mut sources = Vec::new();
    let mut distance = 1.0f64;
    while distance <= to {
        for direction in 0..24 {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(direction) / 24.0).sin_cos();
            let (x, y) = ((x + distance * cosine).round(), (y + distance * sine).round());
            if x >= 0.0 && y >= 0.0 && x < width && y < height {
                sources.push([x as usize, y as usize]);
            }
        }
        distance = (distance * step).max(distance + 0.5);
    }
    sources.retain(|source| *source != target);
    sources.sort_unstable();
    sources.dedup();
    sources
}

/// The largest relative error of sources at one target that its small kernel takes, and its distance in pixels.
fn around(model: &Model, wanted: &Wanted, tile: [usize; 2], target: [usize; 2], step: f64) -> (f64, f64) {
    let point = |at: [f64; 2]| -> Point { model.camera.point(at[0], at[1]) };
    let centre_at = middle([0, 1].map(|side| target[side] / tile[side]), tile);
    let (centre, slopes) = (point(centre_at), Slopes::new(centre_at, tile));
    let at = target.map(|at| at as f64);
    let here = point(at);
    let mut worst = (0.0, 0.0);
    // In a corner of the picture a chord is most pixels; and what is just beyond the reach is looked at as well.
    let reach = wanted.near * model.camera.focal / model.camera.corner().scale.powi(2) + 2.0;
    for source in rings(&model.camera, target, reach, step) {
        let offset = [0, 1].map(|side| source[side] as isize - target[side] as isize);
        let there = point(source.map(|at| at as f64));
        let truth = wanted.at(here.chord(&there));
        let [low, high] = model.between(&there, &here, true);
        let stands_in = point([0, 1].map(|side| centre_at[side] + offset[side] as f64));
        let mut near = 0.0;
        if centre.chord(&stands_in) <= wanted.near {
            let [middle, across, down] = slopes.tap(model, wanted, offset).map(f64::from);
            let tap = middle + (at[0] - centre_at[0]) * across + (at[1] - centre_at[1]) * down;
            near = tap / (there.solid_angle * here.solid_angle).sqrt();
        }
        let error = (high + near - truth).max(truth - low - near) / truth;
        // NaN counts as worst.
        if error > worst.0 || error.is_nan() {
            worst = (error, (offset[0] as f64).hypot(offset[1] as f64));
        }
    }
    worst
}
