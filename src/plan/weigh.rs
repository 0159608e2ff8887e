//! What each ghost means to the picture: the field's scale, and which ghosts never reach it.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::share;
use crate::frame::Frame;
use crate::problem::Problem;
use crate::scene::Ghost;
use crate::series::Shape;

/// Evaluations of a bell that finding the scale may cost.
const EFFORT: usize = 400_000;
/// Probes: at the pixels next to the ghosts that alone shine strongest, and on an even grid over the picture.
const STRONGEST: usize = 48;
const GRID: u32 = 6;

/// A field below this part of what its ghosts are at their centres is nothing: f32 could not hold both.
const UNSEEN: f64 = 1e-30;
/// And one below this part of the light that makes it up, some of it negative, is what f64 leaves when all cancels.
const CANCELLED: f64 = 1e-13;

/// The ghosts, weighed against the field's scale.
#[derive(Clone)]
pub(super) struct Weighed {
    /// A lower bound of the field's largest absolute value at any pixel, RGB; 1 for a colour that has nothing.
    pub scale: [f64; 3],
    /// The pixels that were probed to find it.
    pub peaks: Vec<[i32; 2]>,
    /// For each ghost its peak in units of the scale, the strongest colour; 0 for those that are dropped.
    pub weights: Vec<f64>,
    /// For each image of the photo what it would be at its brightest, were all of its light at one place.
    pub images: Vec<f64>,
    /// The sum of the weights, those of images too.
    pub weight: f64,
    /// For each ghost how far the nearest pixel is from its centre, in sizes.
    pub nearest: Arc<Vec<DVec2>>,
    /// How many are dropped, and at most how much that changes at any pixel.
    pub dropped: usize,
    pub dropped_error: f64,
}

/// A ghost's radiance in units of the scale.
///
/// The plan drops what is brighter than f32 holds, because too little of it reaches the picture; but a ghost may be kept
/// for another of its colours.
pub(crate) fn weight(ghost: &Ghost, scale: [f64; 3]) -> [f64; 3] {
    const BRIGHTEST: f64 = 1e36;
    [0, 1, 2].map(|colour| (ghost.radiance[colour] / scale[colour]).clamp(-BRIGHTEST, BRIGHTEST))
}

/// Weighs the ghosts against the picture.
pub(super) fn weigh(problem: &Problem, tolerance: f64) -> Weighed {
    weigh_by(problem, tolerance, None)
}

/// The same in a unit that is known.
pub(super) fn weigh_in(problem: &Problem, tolerance: f64, scale: [f64; 3]) -> Weighed {
    weigh_by(problem, tolerance, Some(scale))
}

fn weigh_by(problem: &Problem, tolerance: f64, known: Option<[f64; 3]>) -> Weighed {
    let (ghosts, frame) = (problem.ghosts(), problem.frame());
    let seen = |ghost: &Ghost| {
        let offset = nearest_offset(ghost, frame);
        let shape = ghost.bell.shape();
        let share = match shape.period() {
            Some(_) => shape.value(brightest(ghost, frame) - ghost.center, ghost.size),
            None => reached(ghost, offset.abs()),
        };
        (offset, share)
    };
    let (nearest, shares): (Vec<DVec2>, Vec<f64>) = ghosts.par_iter().map(seen).unzip();
    let peaks = probes(ghosts, &shares, frame);
    let points: Vec<DVec2> = peaks.iter().map(|&[i, j]| frame.position(f64::from(i), f64::from(j))).collect();
    let scale = known.unwrap_or_else(|| scale(ghosts, &shares, &points, tolerance));
    let weighed = |(ghost, share): (&Ghost, &f64)| {
        let weight = peak_weight(ghost, scale);
        (weight, weight * share)
    };
    let (mut weights, reached): (Vec<f64>, Vec<f64>) = ghosts.par_iter().zip(&shares).map(weighed).unzip();
    let (dropped, dropped_error) = drop_faint(&mut weights, &reached, share::DROPPED * tolerance);
    let weight = weights.iter().sum();
    let images = Vec::new();
    Weighed { scale, peaks, weights, images, weight, nearest: Arc::new(nearest), dropped, dropped_error }
}

/// The unit of each colour: the largest value found.
///
/// A colour of which nothing reaches the picture is held against the others' scale: nothing is not to be computed to a
/// thousandth of itself. Where that is so for all of them, what cancels is the scale, or else what the ghosts are at their
/// centres.
fn scale(ghosts: &[Ghost], shares: &[f64], points: &[DVec2], tolerance: f64) -> [f64; 3] {
    let (mut net, mut gross) = ([0.0f64; 3], [0.0f64; 3]);
    for (value, magnitude) in sums_at(ghosts, points) {
        for colour in 0..3 {
            net[colour] = net[colour].max(value[colour].abs());
            gross[colour] = gross[colour].max(magnitude[colour]);
        }
    }
    // The brightest of the ghosts that matter to the picture: one that is out of its reach may be as bright as it likes.
    let matters = net.map(|net| share::DROPPED * tolerance * net / ghosts.len().max(1) as f64);
    let matter = |(ghost, share): (&Ghost, &f64)| {
        let radiance = ghost.radiance.map(f64::abs);
        [0, 1, 2].map(|colour| if radiance[colour] * share > matters[colour] { radiance[colour] } else { 0.0 })
    };
    let brighter = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|colour| a[colour].max(b[colour]));
    let brightest = ghosts.par_iter().zip(shares).map(matter).reduce(|| [0.0; 3], brighter);
    let nothing = [0, 1, 2].map(|colour| (UNSEEN * brightest[colour]).max(CANCELLED * gross[colour]));
    let seen = [0, 1, 2].map(|colour| if net[colour] > nothing[colour] { net[colour] } else { 0.0 });
    let largest = |values: [f64; 3]| values.into_iter().fold(0.0, f64::max);
    let peak = ghosts.iter().flat_map(|ghost| ghost.radiance).fold(0.0f64, |a, b| a.max(b.abs()));
    let cancelled = [0, 1, 2].map(|colour| if gross[colour] > UNSEEN * peak { gross[colour] } else { 0.0 });
    let instead = [largest(seen), largest(cancelled), peak].into_iter().find(|&value| value > 0.0).unwrap_or(1.0);
    [0, 1, 2].map(|colour| if seen[colour] > 0.0 { seen[colour] } else { instead.max(nothing[colour]) })
}

/// The sum of the bells at many points, and that of their magnitudes.
fn sums_at(ghosts: &[Ghost], points: &[DVec2]) -> Vec<([f64; 3], [f64; 3])> {
    let at = |&point: &DVec2| {
        let mut sums = ([0.0; 3], [0.0; 3]);
        for ghost in ghosts {
            let value = ghost.bell.shape().value(point - ghost.center, ghost.size);
            for colour in 0..3 {
                sums.0[colour] += ghost.radiance[colour] * value;
                sums.1[colour] += (ghost.radiance[colour] * value).abs();
            }
        }
        sums
    };
    points.par_iter().map(at).collect()
}

/// What a bell of peak 1 is at most at any pixel, the nearest of which is `offset` sizes away.
fn reached(ghost: &Ghost, offset: DVec2) -> f64 {
    let shape = ghost.bell.shape();
    along(shape, offset.x) * along(shape, offset.y)
}

/// What a bell of peak 1 is at most at some distance or farther along an axis, in sizes. Where most ghosts stand, within a
/// hundredth of their size of a pixel, or of where they end, that is 1, and no exponential is worth its time.
pub(super) fn along(shape: &dyn Shape, distance: f64) -> f64 {
    if distance < 0.01 * shape.ends().min(1.0) { 1.0 } else { shape.along(distance, 1.0) }
}

pub(super) fn peak_weight(ghost: &Ghost, scale: [f64; 3]) -> f64 {
    ghost.radiance.iter().zip(scale).map(|(radiance, scale)| radiance.abs() / scale).fold(0.0, f64::max)
}

/// From the ghost's centre to the nearest centre of a pixel of the window, in sizes: a bell much smaller than a pixel
/// may well lie between pixels, and then nothing sees it.
fn nearest_offset(ghost: &Ghost, frame: Frame) -> DVec2 {
    let (low, high) = frame.bounds();
    let pixel = frame.pixel(ghost.center.clamp(low, high)).round();
    (frame.position(pixel.x, pixel.y) - ghost.center) / ghost.size
}

/// Where on the window a ghost is brightest: its centre or the edge next to that, but for the lobes of periodic bells.
fn brightest(ghost: &Ghost, frame: Frame) -> DVec2 {
    let (low, high) = frame.bounds();
    let (low, high) = (low - ghost.center, high - ghost.center);
    let along = |axis: usize| ghost.bell.shape().brightest(axis, low[axis], high[axis], ghost.size[axis]);
    ghost.center + DVec2::new(along(0), along(1))
}

/// Pixels at which the field may be largest.
fn probes(ghosts: &[Ghost], shares: &[f64], frame: Frame) -> Vec<[i32; 2]> {
    let window = frame.window;
    let inside = |p: DVec2| {
        let last = [window.x + window.width as i32 - 1, window.y + window.height as i32 - 1];
        [(p.x.round() as i32).clamp(window.x, last[0]), (p.y.round() as i32).clamp(window.y, last[1])]
    };
    let most = (EFFORT / ghosts.len().max(1)).clamp(4, STRONGEST + (GRID * GRID) as usize);
    let mut alone: Vec<(f64, usize)> = ghosts
        .par_iter()
        .zip(shares)
        .enumerate()
        .map(|(k, (ghost, share))| {
            let radiance = ghost.radiance.iter().fold(0.0f64, |a, b| a.max(b.abs()));
            (radiance * share, k)
        })
        .collect();
    let strongest = alone.len().min(most.div_ceil(2).min(STRONGEST));
    if strongest < alone.len() {
        alone.select_nth_unstable_by(strongest, |a, b| b.0.total_cmp(&a.0));
    }
    let mut pixels: Vec<[i32; 2]> =
        alone[..strongest].iter().map(|&(_, k)| inside(frame.pixel(brightest(&ghosts[k], frame)))).collect();
    let side = ((most - strongest) as f64).sqrt() as u32;
    for i in 0..side.min(GRID) {
        for j in 0..side.min(GRID) {
            let across =
                |k: u32, length: u32| (f64::from(k) + 0.5) / f64::from(side.min(GRID)) * f64::from(length) - 0.5;
            let corner = DVec2::new(f64::from(window.x), f64::from(window.y));
            pixels.push(inside(corner + DVec2::new(across(i, window.width), across(j, window.height))));
        }
    }
    pixels.sort_unstable();
    pixels.dedup();
    pixels
}

/// Sets the weights of the faintest ghosts to zero while all of them together stay within the budget.
///
/// Ghosts are told apart by powers of two only, so that no sorting is needed.
pub(super) fn drop_faint(weights: &mut [f64], reached: &[f64], budget: f64) -> (usize, f64) {
    const LOWEST: i32 = -200;
    // The exponent of a normal number is the power of two below it.
    let bin = |value: f64| ((value.to_bits() >> 52) as i32 - 1023).clamp(LOWEST, 55);
    let mut sums = [0.0f64; 256];
    for &value in reached {
        sums[(bin(value) - LOWEST) as usize] += value;
    }
    let mut error = 0.0;
    let mut limit = LOWEST;
    for sum in sums {
        if error + sum > budget {
            break;
        }
        error += sum;
        limit += 1;
    }
    let mut dropped = 0;
    for (weight, &value) in weights.iter_mut().zip(reached) {
        if bin(value) < limit {
            *weight = 0.0;
            dropped += 1;
        }
    }
    // A hair more: what is left out may be a single ghost's value, which is not computed the same way everywhere.
    (dropped, error * (1.0 + 1e-9))
}
