//! Tolerance in, plan out: the cheapest computation whose predicted error stays below what was asked.
//!
//! Pure: ghosts, a picture's size and a tolerance decide everything. The error is split by its sources, each with its
//! bound; docs/accuracy.md says where each comes from.

mod amplitudes;
mod candidate;
mod check;
mod cost;
mod decay;
mod decided;
mod direct;
mod gather;
mod lattice;
mod layer;
mod modes;
mod period;
mod prediction;
mod request;
mod rounding;
mod search;
mod series;
mod slots;
mod split;
mod terms;
mod weigh;

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use crate::problem::Problem;
use crate::scene::Ghost;
use crate::{Error, Result};

pub use crate::choices::Evaluator;
pub use cost::{Cost, CostModel, GRID_PASSES};
pub use decided::Plan;
pub use direct::Precision;
pub use gather::Transform;
pub use lattice::{Lattice, MOST_NODES};
pub use layer::{Layer, Series};
pub use modes::{Mode, Modes};
pub use prediction::{Prediction, Source};
pub use request::Request;
pub use search::{LOOSEST, plan_at_least, plan_within};
pub use terms::Group;
pub(crate) use weigh::weight;

use candidate::{Survey, candidate};
use series::Wide;

/// Highest harmonic that a plan may use along one axis.
pub const HIGHEST_DEGREE: u32 = 4096;

/// An evaluator that a plan could not choose.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Refusal {
    /// The evaluator.
    pub evaluator: Evaluator,
    /// Why, in words.
    pub reason: String,
}

/// Parts of the tolerance that the sources may use up, after what rounding takes.
mod share {
    pub const DROPPED: f64 = 0.02;
    pub const PERIODISATION: f64 = 0.08;
    /// Of `series` and `rows`.
    pub const TRUNCATION: f64 = 0.9;
    /// Of `grid`: truncation, and interpolation. For a smooth bell the degree grows with the logarithm of its part only,
    /// the lattice with the fourth root of its own, so interpolation gets most; for a bell with a kink the degree grows
    /// like one over its part. The plan tries both.
    pub const GRID: [(f64, f64); 2] = [(0.15, 0.75), (0.7, 0.2)];
    /// Of gathered groups, out of the tenth of its part that periodisation never uses: each digit costs one moment more
    /// along each axis, so there is no need for more.
    pub const GATHERING: f64 = 0.005;
}

/// The cheapest plan that meets the request.
///
/// # Errors
/// [`Error::ToleranceBelowFloor`] where f32 cannot be as exact as asked; [`Error::Plan`] where the series that was
/// asked for cannot be had.
pub fn plan(problem: &Arc<Problem>, asked: &Request) -> Result<Plan> {
    if !(asked.tolerance > 0.0 && asked.tolerance < 1.0) {
        return Err(Error::Plan(format!("a tolerance of {} is not between 0 and 1", asked.tolerance)));
    }
    let ghosts = problem.ghosts();
    check::request(asked)?;
    check::ghosts(ghosts)?;
    let request = &Request { period: own_period(ghosts, asked)?, ..*asked };
    request.period.map_or(Ok(()), check::period)?;
    let survey = Survey::new(problem, request);
    check::scale(survey.weighed.scale)?;
    // A period or a degree asks for a series, but for the one period that periodic bells have: it is theirs by `direct` too.
    let periodic = ghosts.par_iter().any(|ghost| ghost.bell.shape().period().is_some());
    let series = asked.degree.is_some() || (asked.period.is_some() && !periodic);
    // Who asks for an evaluator in a period gets it as it comes.
    let given = series || (asked.period.is_some() && asked.evaluator.is_some());
    let wanted = |evaluator| match request.evaluator {
        Some(only) => only == evaluator,
        None => !(series && evaluator == Evaluator::Direct),
    };
    let wide = Wide::new(problem, &survey, request);
    let mut candidates = Vec::new();
    let mut refusals = Vec::new();
    let wanted: Vec<Evaluator> = Evaluator::ALL.into_iter().filter(|&evaluator| wanted(evaluator)).collect();
    for &evaluator in &wanted {
        match candidate(problem, &survey, wide.as_ref(), request, evaluator) {
            // In the period that periodic bells bring with them the copies of others may land on the picture.
            Ok(plan) if !given && plan.predicted.total() > request.tolerance => {
                let total = plan.predicted.total();
                let reason = format!("{evaluator} would be off by {total:.1e} in the period of the bells");
                refusals.push((evaluator, Error::Plan(reason)));
            }
            Ok(plan) => candidates.push(plan),
            Err(error) => refusals.push((evaluator, error)),
        }
    }
    if let Some(survey) = split::apart(problem, &survey, request) {
        let wide = Wide::new(problem, &survey, request);
        let series = wanted.iter().filter(|&&evaluator| evaluator != Evaluator::Direct);
        // One that cannot be had was never asked for by that name.
        candidates.extend(series.flat_map(|&evaluator| candidate(problem, &survey, wide.as_ref(), request, evaluator)));
    }
    let mut costs: Vec<Cost> = candidates.iter().flat_map(|plan: &Plan| plan.costs.clone()).collect();
    costs.sort_by(|a, b| a.milliseconds.total_cmp(&b.milliseconds));
    let cheapest = candidates.into_iter().min_by(|a, b| a.costs[0].milliseconds.total_cmp(&b.costs[0].milliseconds));
    match cheapest {
        Some(plan) => {
            let told = |(evaluator, error): (Evaluator, Error)| Refusal { evaluator, reason: error.reason() };
            Ok(Plan { costs, refused: refusals.into_iter().map(told).collect(), ..plan })
        }
        None => {
            let refusals = refusals.into_iter().map(|(_, error)| error).collect();
            Err(most_helpful(problem, &survey, request, &wanted, refusals))
        }
    }
}

/// The refusal that says what can be had: the lowest tolerance at which there is a plan, where rounding is the reason.
fn most_helpful(
    problem: &Arc<Problem>,
    survey: &Survey,
    request: &Request,
    wanted: &[Evaluator],
    mut refusals: Vec<Error>,
) -> Error {
    let lowest = |refusals: &[Error]| {
        let floors = refusals.iter().filter_map(|refusal| match refusal {
            Error::ToleranceBelowFloor { floor, .. } => Some(*floor),
            _ => None,
        });
        floors.min_by(f64::total_cmp)
    };
    let mut next = lowest(&refusals);
    // A series may be refused at its floor for another reason, its degree; what is left is the next floor.
    while let Some(floor) = next.filter(|floor| *floor < 0.99) {
        let eased = Request { tolerance: 1.0001 * floor, ..*request };
        let tried = wanted.iter().map(|&evaluator| candidate(problem, survey, None, &eased, evaluator));
        let (plans, others): (Vec<_>, Vec<_>) = tried.partition(Result::is_ok);
        if plans.iter().flatten().any(|plan| plan.predicted.total() <= eased.tolerance) {
            return Error::ToleranceBelowFloor { asked: request.tolerance, floor };
        }
        next = lowest(&others.into_iter().filter_map(Result::err).collect::<Vec<_>>());
    }
    refusals.pop().unwrap_or_else(|| Error::Plan("no evaluator is left".into()))
}

/// The period that was asked for, or that periodic bells bring with them.
///
/// # Errors
/// [`Error::Plan`] where they do not agree.
fn own_period(ghosts: &[Ghost], request: &Request) -> Result<Option<DVec2>> {
    let mut period = request.period;
    if !ghosts.par_iter().any(|ghost| ghost.bell.shape().period().is_some()) {
        return Ok(period);
    }
    for ghost in ghosts {
        let Some(own) = ghost.bell.shape().period() else { continue };
        let other = *period.get_or_insert(own);
        if other != own {
            return Err(Error::Plan(format!(
                "the {} bell has a period of {} x {}, and the series one of {} x {}",
                ghost.bell, own.x, own.y, other.x, other.y
            )));
        }
    }
    Ok(period)
}

#[cfg(test)]
mod tests;
