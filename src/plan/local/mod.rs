//! `local`: each ghost at the pixels that it reaches, and nowhere else.
//!
//! A ghost is left out wherever its bell is below one level for all of them, which is chosen by what is left out at any one
//! place: `map` adds that up, and what floats cost, over the ghosts that meet there.

mod area;
mod map;
mod slopes;

use std::sync::Arc;

use super::candidate::{Survey, made};
use super::direct::{HALF_A_UNIT, STORED};
use super::request::GHOSTS_A_ROUND;
use super::weigh::Weighed;
use super::{Cost, Evaluator, Group, Layer, Plan, Precision, Prediction, Request, Transform, cost, share};
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

/// How near to its budget what is left out should come, and how often that is tried.
const CLOSE: f64 = 0.4;
const TRIES: usize = 6;
const MOST_TRIES: usize = 40;

/// And of many ghosts, which are looked at all at once as seldom as may be: first, so many of them say where to begin, a little
/// below which it is.
const FAR_FROM: f64 = 0.02;
const SAMPLED: usize = 512;
const BELOW: f64 = 0.8;

/// Ghosts that are looked at for an estimate.
const SAMPLE: usize = 512;

/// What planning takes for each ghost, about, in nanoseconds.
const PLANNING: f64 = 500.0;

/// The most places in lists of blocks, each a ghost in a block.
const MOST_LISTED: f64 = (1 << 26) as f64;

/// Pixels along a side of the blocks that have lists of ghosts, as a power of two: small blocks hold little beside small ghosts,
/// and large ones do not hold a large ghost all too often. `side` is what the ghosts cover along an axis, in the mean.
pub(crate) fn block_shift(side: f64) -> u32 {
    if side < 64.0 { 3 } else { 5 }
}

impl Local {
    /// Pixels that a ghost covers along an axis, in the mean.
    pub(crate) fn side(&self) -> f64 {
        let ghosts: usize = self.groups.iter().map(|group| group.ghosts).sum();
        (self.reached / ghosts.max(1) as f64).sqrt()
    }

    /// The pixels at which a ghost of a weight is computed.
    pub(crate) fn area(&self, ghost: &Ghost, weight: f64, frame: Frame) -> Area {
        Area::new(ghost, self.level / weight, frame)
    }
}

impl Local {
    /// Whether the lists of 64-bit ghosts, some of them a round, are what a renderer goes through and has room for.
    ///
    /// # Errors
    /// [`Error::Plan`] where they are not.
    fn has_room(&self, loop_rounds: usize) -> Result<()> {
        if self.precision == Precision::Single {
            return Ok(());
        }
        let ghosts: usize = self.groups.iter().map(|group| group.ghosts).sum();
        if ghosts / GHOSTS_A_ROUND > loop_rounds {
            return Err(Error::Plan("local would need more rounds of a loop than this renderer runs".into()));
        }
        let blocks = self.side() / f64::from(1u32 << block_shift(self.side())) + 1.0;
        if ghosts as f64 * blocks * blocks > MOST_LISTED {
            return Err(Error::Plan("local would need longer lists than it has room for".into()));
        }
        Ok(())
    }
}

/// What floats cost, where storing what 64 bits give in 32 costs so much.
fn floats(worst: &Worst, precision: Precision, stored: f64) -> f64 {
    match precision {
        Precision::Single => worst.rounding(precision),
        Precision::Double => stored + worst.rounding(precision),
    }
}

/// The highest level found that stays within the budget, and in which floats.
struct Search {
    found: Option<(f64, Worst)>,
    precision: Precision,
}

impl Search {
    /// Looks at each `step`-th of the ghosts, from this level on: in floats that are given, or in 32 bits where these can.
    ///
    /// # Errors
    /// [`Error::ToleranceBelowFloor`] where floats cannot be as exact.
    fn new(
        map: &Map<'_>,
        step: usize,
        (part, stored): (f64, f64),
        given: Option<Precision>,
        mut level: f64,
    ) -> Result<Self> {
        let mut worst = map.worst(level, step);
        let single = worst.rounding(Precision::Single) <= SINGLE * part;
        let mut precision = given.unwrap_or(if single { Precision::Single } else { Precision::Double });
        let mut found: Option<(f64, Worst)> = None;
        for attempt in 0..MOST_TRIES {
            // What floats cost grows a little with the reach.
            if given.is_none() && precision == Precision::Single && worst.single > (1.0 - NEEDED) * part {
                (precision, found) = (Precision::Double, None);
            }
            let rounding = floats(&worst, precision, stored);
            if rounding > (1.0 - NEEDED) * part {
                return Err(Error::ToleranceBelowFloor { asked: part, floor: rounding / (1.0 - NEEDED) });
            }
            let budget = 0.98 * (part - rounding);
            if worst.cut <= budget {
                found = found.filter(|(highest, _)| *highest > level).or(Some((level, worst)));
            }
            // Each try with many ghosts costs more than it saves.
            let close = if map.kept > 2 * SAMPLED && step == 1 { FAR_FROM } else { CLOSE };
            let close = worst.cut <= budget && (worst.cut >= close * budget || worst.cut == 0.0 || level >= budget);
            if close || found.is_some() && (attempt >= TRIES || worst.cut > budget) {
                break;
            }
            // However many meet at a place, each leaves out no more than the level.
            let factor = if attempt < TRIES { 0.75 * budget / worst.cut } else { 0.1 };
            level = (level * factor).min(budget);
            worst = map.worst(level, step);
        }
        Ok(Self { found, precision })
    }
}

/// A local layer, and what it is off by at most.
pub(super) struct Bounded {
    pub local: Local,
    /// What is left out.
    pub cut: f64,
    /// What its floats cost.
    pub rounding: f64,
}

/// A local layer of groups, which stays within a part of the tolerance: in 32-bit floats where these can, or in floats that are
/// given. Of the part, so much is taken where 64 bits are stored in 32.
///
/// # Errors
/// [`Error::ToleranceBelowFloor`] where floats cannot be as exact.
pub(super) fn layer(
    problem: &Problem,
    weighed: &Weighed,
    groups: &[Group],
    (part, stored): (f64, f64),
    given: Option<Precision>,
    loop_rounds: usize,
) -> Result<Bounded> {
    let ghosts: usize = groups.iter().map(|group| group.ghosts).sum();
    let map = Map::new(problem, weighed, groups, part);
    // A few of many ghosts say about which level it will be.
    let step = if ghosts > 2 * SAMPLED { ghosts.div_ceil(SAMPLED) } else { 1 };
    let mut level = 0.7 * part / crowding(problem, weighed, groups, part);
    if step > 1
        && let Ok(Search { found: Some((few, _)), .. }) = Search::new(&map, step, (part, stored), given, level)
    {
        level = BELOW * few;
    }
    let Search { found, precision } = Search::new(&map, 1, (part, stored), given, level)?;
    let Some((level, worst)) = found else {
        return Err(Error::Plan("local would leave out too much at any reach".into()));
    };
    let rounding = floats(&worst, precision, stored);
    let groups = groups.iter().map(|group| Group { transform: Transform::Direct, ..group.clone() }).collect();
    let local = Local { groups, level, precision, reached: worst.reached };
    local.has_room(loop_rounds)?;
    Ok(Bounded { local, cut: worst.cut, rounding })
}

/// The plan by `local`.
///
/// # Errors
/// [`Error::ToleranceBelowFloor`] where floats cannot be as exact.
pub(super) fn candidate(problem: &Arc<Problem>, survey: &Survey, request: &Request) -> Result<Plan> {
    let weighed = &survey.weighed;
    let left = request.tolerance - weighed.dropped_error;
    let given = (!request.doubles).then_some(Precision::Single);
    let Bounded { local, cut, rounding } =
        layer(problem, weighed, &survey.groups, (left, STORED), given, request.loop_rounds).map_err(
            |error| match error {
                Error::ToleranceBelowFloor { floor, .. } => {
                    Error::ToleranceBelowFloor { asked: request.tolerance, floor: floor / (1.0 - share::DROPPED) }
                }
                error => error,
            },
        )?;
    let storage = match local.precision {
        Precision::Single => HALF_A_UNIT,
        Precision::Double => STORED,
    };
    let storage = storage.min(rounding);
    let dropped = weighed.dropped_error;
    let predicted = Prediction { dropped, cut, rounding: rounding - storage, storage, ..Prediction::default() };
    let precision = local.precision;
    let layers = vec![Layer::Local(local)];
    Ok(made(problem, weighed, request, layers, precision, predicted))
}

/// About how many times the level is left out at the worst place, for a start.
fn crowding(problem: &Problem, weighed: &Weighed, groups: &[Group], level: f64) -> f64 {
    let reached: f64 = groups.iter().map(|group| reached_by(problem, weighed, group, level)).sum();
    3.0 + 1.5 * reached / problem.frame().window.pixels() as f64
}

/// What planning a local layer of so many ghosts takes about, in nanoseconds.
pub(super) fn work(ghosts: usize) -> f64 {
    PLANNING * ghosts as f64
}

/// What is known of `local` before it is planned, by a few of the ghosts.
pub(super) struct Estimate {
    /// What it costs at least.
    pub cost: Cost,
    /// What it costs to plan it, in nanoseconds.
    pub work: f64,
    /// Whether so few bells meet at a pixel that it is likely to be worth that.
    pub likely: bool,
}

impl Estimate {
    pub fn new(problem: &Problem, survey: &Survey, request: &Request) -> Self {
        const FEW: f64 = 50.0;
        const ROUNDS: usize = 4;
        // The level that is found is hardly ever so many times as high.
        const SURE: f64 = 8.0;
        let (kept, frame) = (problem.ghosts().len() - survey.weighed.dropped, problem.frame());
        // Each of very many may be below the tolerance.
        let (mut level, mut meeting) = (request.tolerance, 0.0f64);
        for _ in 0..ROUNDS {
            meeting = reached(problem, &survey.weighed, level) / frame.window.pixels() as f64;
            level = request.tolerance / (3.0 + 1.5 * meeting);
        }
        let reached = reached(problem, &survey.weighed, (SURE * level).min(request.tolerance));
        let nanoseconds = cost::local(&survey.groups, reached, Precision::Single, frame, &request.cost_model);
        let milliseconds = 1e-6 * nanoseconds;
        let cost = Cost { evaluator: Evaluator::Local, summed: 0, reaching: kept, milliseconds };
        Self { cost, work: work(kept), likely: meeting <= FEW }
    }
}

/// Pixels that a group reaches where it is left out below a level, by a few of its ghosts.
pub(super) fn reached_by(problem: &Problem, weighed: &Weighed, group: &Group, level: f64) -> f64 {
    const FEW: usize = 64;
    let step = group.members.len().div_ceil(FEW).max(1);
    let area = |&member: &u32| {
        let (ghost, frame) = (&problem.ghosts()[member as usize], problem.frame());
        Area::new(ghost, level / weighed.weights[member as usize], frame).pixels(frame)
    };
    let reached: f64 = group.members.iter().step_by(step).map(area).sum();
    reached * group.members.len() as f64 / group.members.len().div_ceil(step) as f64
}

/// Pixels that the ghosts reach where they are left out below a level, by a few of them.
fn reached(problem: &Problem, weighed: &Weighed, level: f64) -> f64 {
    let (weights, frame) = (&weighed.weights, problem.frame());
    let step = weights.len().div_ceil(SAMPLE).max(1);
    let (mut reached, mut seen) = (0.0, 0.0);
    for (ghost, &weight) in problem.ghosts().iter().zip(weights).step_by(step) {
        if weight > 0.0 {
            reached += Area::new(ghost, level / weight, frame).pixels(frame);
        }
        seen += 1.0;
    }
    reached / f64::max(seen, 1.0) * weights.len() as f64
}
