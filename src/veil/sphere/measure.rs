//! How far what is realised is from what is wanted.

use rayon::prelude::*;

use super::camera::{Camera, Point, angle};
use super::model::{Model, Wanted};
use super::tiles::{FARTHEST, Slopes, middle};

/// By how much the bound over all pairs can be above that over those that are looked at.
pub(super) const BETWEEN: f64 = 1.1;

/// Shares of the picture at which targets are.
pub(super) const TARGETS: [[f64; 2]; 8] =
    [[0.0, 0.0], [0.5, 0.5], [0.0, 0.5], [0.25, 0.25], [0.5, 0.0], [0.12, 0.4], [0.4, 0.12], [0.75, 0.9]];

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
            let truth = profile(angle(chord));
            let [low, high] = model.between(&there, &here, true);
            let error = (high - truth).max(truth - low) / truth;
            // NaN counts as wrong.
            if error > limit || error.is_nan() {
                found.0 = chord;
                found.1 = if chord > far { found.1.max(error) } else { found.1 };
            }
        }
        found
    };
    let all = TARGETS.par_iter().map(around);
    all.reduce(|| (0.0, 0.0), |one, other| (one.0.max(other.0), one.1.max(other.1)))
}

/// The largest relative error over pairs, and the distance in pixels where it is; any above `enough` will do.
pub(super) fn bound(model: &Model, wanted: &Wanted, tile: [usize; 2], enough: f64) -> (f64, f64) {
    let [width, height] = model.camera.size;
    let mut targets = Vec::new();
    for share in TARGETS {
        let at = target(&model.camera, share);
        // A tile's corners are where its kernel is most wrong.
        let origin = [0, 1].map(|side| at[side] / tile[side] * tile[side]);
        for corner in [[0, 0], [tile[0] - 1, 0], [0, tile[1] - 1], [tile[0] / 2, tile[1] / 2]] {
            targets.push([(origin[0] + corner[0]).min(width - 1), (origin[1] + corner[1]).min(height - 1)]);
        }
    }
    targets.sort_unstable();
    targets.dedup();
    let worst = std::sync::Mutex::new((0.0f64, 0.0f64));
    let peek = || worst.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    targets.par_iter().for_each(|target| {
        if peek().0 > enough {
            return;
        }
        let found = around(model, wanted, tile, *target);
        let mut worst = peek();
        if found.0 > worst.0 || found.0.is_nan() {
            *worst = (if found.0.is_nan() { f64::INFINITY } else { found.0 }, found.1);
        }
    });
    let worst = peek();
    *worst
}

/// Offsets around a target: near ones within two pixels, and by distances and directions.
pub(super) fn offsets(camera: &Camera, target: [usize; 2]) -> Vec<[usize; 2]> {
    let [width, height] = camera.size;
    let mut sources = Vec::new();
    let mut add = |x: f64, y: f64| {
        let (x, y) = (x.round(), y.round());
        if x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64 {
            sources.push([x as usize, y as usize]);
        }
    };
    let [x, y] = target.map(|at| at as f64);
    let mut distance = 1.0f64;
    while distance < (width + height) as f64 {
        for direction in 0..24 {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(direction) / 24.0).sin_cos();
            add(x + distance * cosine, y + distance * sine);
        }
        distance = (distance * 1.05).max(distance + 0.5);
    }
    sources.retain(|source| *source != target);
    sources.sort_unstable();
    sources.dedup();
    sources
}

/// The largest relative error of sources at one target, and its distance in pixels.
fn around(model: &Model, wanted: &Wanted, tile: [usize; 2], target: [usize; 2]) -> (f64, f64) {
    let point = |at: [f64; 2]| -> Point { model.camera.point(at[0], at[1]) };
    let centre_at = middle([0, 1].map(|side| target[side] / tile[side]), tile);
    let (centre, slopes) = (point(centre_at), Slopes::new(centre_at, tile));
    let at = target.map(|at| at as f64);
    let here = point(at);
    let mut worst = (0.0, 0.0);
    for source in offsets(&model.camera, target) {
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
