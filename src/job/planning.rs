//! The plan that a look asks for, and what it rests on.

use std::path::PathBuf;
use std::sync::Arc;

use crate::Result;
use crate::calibration::Known;
use crate::gpu::Info;
use crate::look::Accuracy;
use crate::plan::{self, CostModel, Plan, Request};
use crate::problem::Problem;
use crate::scene::Goal;

/// A plan, and what it rests on.
pub struct Planning {
    /// The plan.
    pub plan: Plan,
    /// The cost model that decided.
    pub model: CostModel,
    /// The file that the cost model is from; none for the built-in one.
    pub calibration: Option<PathBuf>,
    /// What a person ought to know: of a tolerance that was raised to the floor.
    pub notes: Vec<String>,
    /// What went wrong without keeping the plan from being made.
    pub warnings: Vec<String>,
}

/// The plan for a problem on a device, or, without one, on a device without limits; by what is known of its speed.
///
/// # Errors
/// Those of [`plan::plan`], [`plan::plan_at_least`] and [`plan::plan_within`].
pub fn plan(accuracy: &Accuracy, problem: &Arc<Problem>, device: Option<&Info>, known: Known) -> Result<Planning> {
    let &Accuracy { goal, allow_floor, degree, period, evaluator } = accuracy;
    // A budget is bought from the loosest tolerance on, whatever the request says.
    let asked = match goal {
        Goal::Tolerance(tolerance) => tolerance,
        Goal::Budget(_) => plan::LOOSEST,
    };
    let unlimited = Request::new(asked);
    let request = Request {
        period,
        degree,
        evaluator,
        loop_rounds: device.and_then(Info::loop_rounds).unwrap_or(usize::MAX),
        doubles: device.is_none_or(|info| info.limits.doubles),
        // A term takes three vec4.
        most_terms: device.map_or(unlimited.most_terms, |info| (info.limits.storage_block / 48) as usize),
        cost_model: known.model,
        ..unlimited
    };
    let (plan, note) = match goal {
        Goal::Budget(budget) => (plan::plan_within(problem, &request, budget)?, None),
        Goal::Tolerance(_) if allow_floor => {
            let plan = plan::plan_at_least(problem, &request)?;
            let (floor, by) = (plan.tolerance, plan.evaluator());
            let note = (floor > asked).then(|| {
                format!("the tolerance is {floor:.1e} instead of {asked:.1e}: the lowest that can be had here, by {by}")
            });
            (plan, note)
        }
        Goal::Tolerance(_) => (plan::plan(problem, &request)?, None),
    };
    let Known { model, file, warning } = known;
    Ok(Planning {
        plan,
        model,
        calibration: file,
        notes: note.into_iter().collect(),
        warnings: warning.into_iter().collect(),
    })
}
