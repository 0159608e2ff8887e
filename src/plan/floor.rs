//! What can be had where what was asked cannot.

use std::sync::Arc;

use super::{Request, attempt};
use crate::Error;
use crate::problem::Problem;

/// Floors are looked for from here on, in steps of this ratio, up to where a tolerance means nothing.
const TIGHTEST: f64 = 1e-9;
const RATIO: f64 = 1.01;
const LOOSEST: f64 = 0.98;

/// A hair above the floor, so that its own rounding does not put the tolerance below it.
pub(super) const ABOVE: f64 = 1.0001;

/// The refusal that says what can be had: where rounding is the reason of one, the lowest tolerance at which there is a
/// plan. It is the same whatever was asked.
pub(super) fn most_helpful(problem: &Arc<Problem>, asked: &Request, mut refusals: Vec<Error>) -> Error {
    let named = refusals.iter().filter_map(|refusal| match refusal {
        Error::ToleranceBelowFloor { floor, .. } => Some(*floor),
        _ => None,
    });
    let Some(named) = named.min_by(f64::total_cmp) else {
        return refusals.pop().unwrap_or_else(|| Error::Plan("no evaluator is left".into()));
    };
    if let Some(floor) = floor(problem, asked) {
        return Error::ToleranceBelowFloor { asked: asked.tolerance, floor };
    }
    // No tolerance below 1 will do. Where that is not for rounding alone, the other reason says more.
    let other = refusals.iter().position(|refusal| !matches!(refusal, Error::ToleranceBelowFloor { .. }));
    match other.filter(|_| named < LOOSEST) {
        Some(other) => refusals.swap_remove(other),
        None => Error::ToleranceBelowFloor { asked: asked.tolerance, floor: named },
    }
}

/// The lowest tolerance with a plan, by bisection.
fn floor(problem: &Arc<Problem>, asked: &Request) -> Option<f64> {
    let at = |step: u32| TIGHTEST * RATIO.powi(step as i32);
    let reached = |step: u32| {
        let tolerance = ABOVE * at(step);
        let plan = attempt(problem, &Request { tolerance, ..*asked });
        matches!(plan, Ok(Ok(plan)) if plan.predicted.total() <= tolerance)
    };
    let mut high = ((LOOSEST / TIGHTEST).ln() / RATIO.ln()) as u32;
    if !reached(high) {
        return None;
    }
    let mut low = 0;
    while high - low > 1 {
        let middle = (low + high) / 2;
        if reached(middle) { high = middle } else { low = middle }
    }
    // There may be tolerances with a plan below one without.
    while at(high) <= asked.tolerance {
        high += 1;
    }
    Some(at(high))
}
