//! Plans for those who do not know the tolerance: what a time budget buys, and the best that f32 can give.

use std::sync::Arc;

use super::floor::ABOVE;
use super::{Plan, Request, plan};
use crate::problem::Problem;
use crate::{Error, Result};

/// The loosest tolerance that a budget is spent on: beyond it the glare has little to do with the truth.
pub const LOOSEST: f64 = 0.5;

/// The tightest one that is tried; the floor of f32 lies above it in every scene.
const TIGHTEST: f64 = 1e-9;

/// Where the search ends: tolerances that differ by less are as good as each other.
const CLOSE: f64 = 1.02;

/// The plan of a request whose tolerance may lie below the floor of f32: then the one at the floor, which
/// [`Plan::tolerance`] names.
///
/// # Errors
/// Those of [`plan`], but for [`Error::ToleranceBelowFloor`].
pub fn plan_at_least(problem: &Arc<Problem>, request: &Request) -> Result<Plan> {
    let mut request = *request;
    // The floor may rise where the evaluator that had the lowest is refused for another reason there, so at most once
    // for each evaluator; more often than that, it is an error like any other.
    for _ in 0..8 {
        match plan(problem, &request) {
            Err(Error::ToleranceBelowFloor { floor, .. }) if ABOVE * floor < 1.0 => request.tolerance = ABOVE * floor,
            result => return result,
        }
    }
    plan(problem, &request)
}

/// The most accurate plan found that is predicted to cost at most `budget` milliseconds; the request's tolerance does
/// not matter. [`Plan::tolerance`] says what was reached.
///
/// The cost falls as the tolerance grows, but for small steps where an evaluator takes over or a whole row of modes is
/// dropped; bisection finds a tolerance within 2 % of the crossing.
///
/// # Errors
/// [`Error::BudgetTooSmall`] where even a tolerance of [`LOOSEST`] costs more, with what that costs; otherwise those of
/// [`plan`] at that tolerance.
pub fn plan_within(problem: &Arc<Problem>, request: &Request, budget: f64) -> Result<Plan> {
    let at = |tolerance| Request { tolerance, ..*request };
    let mut best = plan(problem, &at(LOOSEST))?;
    if cost(&best) > budget {
        return Err(Error::BudgetTooSmall { asked: budget, least: cost(&best) });
    }
    let within = |plan: &Plan| cost(plan) <= budget;
    let tightest = match plan_at_least(problem, &at(TIGHTEST)) {
        Ok(plan) if within(&plan) => return Ok(reached(plan)),
        Ok(plan) => plan.tolerance,
        // A series may need a degree that cannot be had where a looser one does not.
        Err(_) => TIGHTEST,
    };
    let (mut low, mut high) = (tightest, LOOSEST);
    while high > CLOSE * low {
        let middle = (low * high).sqrt();
        match plan(problem, &at(middle)) {
            Ok(plan) if within(&plan) => (high, best) = (middle, plan),
            _ => low = middle,
        }
    }
    Ok(reached(best))
}

/// What a plan is expected to cost, in milliseconds.
fn cost(plan: &Plan) -> f64 {
    plan.cost().unwrap_or(f64::INFINITY)
}

/// Where the series was given by hand, the error comes as it comes, and may be beyond the tolerance.
fn reached(plan: Plan) -> Plan {
    Plan { tolerance: plan.tolerance.max(plan.predicted.total()), ..plan }
}
