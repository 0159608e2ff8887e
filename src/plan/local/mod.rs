//! `local`: each ghost at the pixels that it reaches, and nowhere else.
//!
//! A ghost is left out wherever its bell is below one level for all of them, which is chosen by what is left out at any one
//! place: `map` adds that up, and what floats cost, over the ghosts that meet there.

mod area;
mod map;
mod slopes;

use std::sync::Arc;

use super::candidate::Survey;
use super::{Cost, Evaluator, Group, Layer, Plan, Precision, Prediction, Request, Transform, cost, direct, share};
use crate::frame::Frame;
use crate::problem::Problem;
use crate::scene::Ghost;
use crate::{Error, Result};

pub(crate) use area::{Area, LARGEST_POINT};
use map::{Map, Worst};

/// Ghosts that are summed at the pixels that they reach.
#[derive(Debug, Clone, PartialEq)]
pub struct Local {
    /// The ghosts, in groups of [`Transform::Direct`].
    pub groups: Vec<Group>,
    /// What a bell may be where it is left out, in units of the field's scale.
    pub level: f64,
    /// The floats that they are summed in.
    pub precision: Precision,
    /// Pixels of the window that each of them reaches, all added up.
    pub reached: f64,
}

/// The part of the tolerance that is kept for what is left out: it costs a reach that grows with the root of a logarithm.
const NEEDED: f64 = 0.1;

/// The most of the tolerance that rounding may take in 32-bit floats: with less left than the rest the reach grows, and 64-bit
/// floats cost some times as much.
const SINGLE: f64 = 0.8;

/// What 64-bit floats leave beside the rest: a canvas of f32, from which the glare is made.
const CANVAS: f64 = 0.5 * f32::EPSILON as f64;

/// How near to its budget what is left out should come, and how often that is tried.
const CLOSE: f64 = 0.4;
const TRIES: usize = 6;

/// Ghosts that are looked at for an estimate.
const SAMPLE: usize = 512;

/// What planning takes for each ghost, about, in nanoseconds.
const PLANNING: f64 = 500.0;

impl Local {
    /// The pixels at which a ghost of a weight is computed.
    pub(crate) fn area(&self, ghost: &Ghost, weight: f64, frame: Frame) -> Area {
        Area::new(ghost, self.level / weight, frame)
    }
}

/// The plan by `local`.
///
/// # Errors
/// [`Error::ToleranceBelowFloor`] where floats cannot be as exact.
pub(super) fn candidate(problem: &Arc<Problem>, survey: &Survey, request: &Request) -> Result<Plan> {
    let weighed = &survey.weighed;
    let map = Map::new(problem, weighed, &survey.groups);
    let left = request.tolerance - weighed.dropped_error;
    let budget = |rounding: f64| 0.98 * (left - rounding);
    let mut level = 0.7 * left / crowding(problem, survey, request);
    let mut worst = map.worst(level);
    let mut precision = Precision::Single;
    let mut rounding = worst.single;
    if rounding > SINGLE * request.tolerance {
        precision = Precision::Double;
        rounding = direct::bounds(problem, weighed).double + CANVAS;
        if left - rounding < NEEDED * request.tolerance {
            return Err(Error::ToleranceBelowFloor {
                asked: request.tolerance,
                floor: rounding / (1.0 - NEEDED - share::DROPPED),
            });
        }
    }
    // What floats cost grows a little with the reach.
    for _ in 0..TRIES {
        let budget = budget(rounding);
        if worst.cut <= budget && (worst.cut >= CLOSE * budget || worst.cut == 0.0) {
            break;
        }
        level = (level * 0.75 * budget / worst.cut).min(budget);
        worst = map.worst(level);
        rounding = if precision == Precision::Single { worst.single } else { rounding };
    }
    finish(problem, survey, request, level, &worst, (precision, rounding))
}

fn finish(
    problem: &Arc<Problem>,
    survey: &Survey,
    request: &Request,
    level: f64,
    worst: &Worst,
    (precision, rounding): (Precision, f64),
) -> Result<Plan> {
    let weighed = &survey.weighed;
    let storage = CANVAS.min(rounding);
    let predicted = Prediction {
        dropped: weighed.dropped_error,
        cut: worst.cut,
        rounding: rounding - storage,
        storage,
        ..Prediction::default()
    };
    let groups = survey.groups.iter().map(|group| Group { transform: Transform::Direct, ..group.clone() }).collect();
    let local = Local { groups, level, precision, reached: worst.reached };
    let layers = vec![Layer::Local(local)];
    Ok(Plan {
        tolerance: request.tolerance,
        precision,
        scale: weighed.scale,
        peaks: weighed.peaks.clone(),
        dropped: weighed.dropped,
        predicted,
        costs: vec![cost::estimate(&layers, precision, problem.frame(), &request.cost_model)],
        ..Plan::by_hand(problem.clone(), layers)
    })
}

/// About how many times the level is left out at the worst place, for a start.
fn crowding(problem: &Problem, survey: &Survey, request: &Request) -> f64 {
    3.0 + 1.5 * reached(problem, survey, request) / problem.frame().window.pixels() as f64
}

/// What `local` costs at least, by a few of the ghosts, and what it costs to plan it, in nanoseconds.
pub(super) fn estimate(problem: &Problem, survey: &Survey, request: &Request) -> (Cost, f64) {
    let (kept, frame) = (problem.ghosts().len() - survey.weighed.dropped, problem.frame());
    let reached = reached(problem, survey, request);
    let nanoseconds = cost::local(kept, reached, Precision::Single, frame, &request.cost_model);
    let cost = Cost { evaluator: Evaluator::Local, summed: 0, milliseconds: 1e-6 * nanoseconds };
    (cost, PLANNING * kept as f64)
}

/// Pixels that the ghosts reach at least, by a few of them.
fn reached(problem: &Problem, survey: &Survey, request: &Request) -> f64 {
    let (weights, frame) = (&survey.weighed.weights, problem.frame());
    let kept = weights.len() - survey.weighed.dropped;
    let step = weights.len().div_ceil(SAMPLE).max(1);
    let (mut reached, mut seen) = (0.0, 0.0);
    for (ghost, &weight) in problem.ghosts().iter().zip(weights).step_by(step).filter(|(_, weight)| **weight > 0.0) {
        reached += Area::new(ghost, request.tolerance / weight, frame).pixels(frame);
        seen += 1.0;
    }
    reached / f64::max(seen, 1.0) * kept as f64
}
