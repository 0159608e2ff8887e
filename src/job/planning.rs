//! The plan that a look asks for, and what it rests on.

use std::path::PathBuf;
use std::sync::Arc;

use super::each_pixel::Darkest;
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

/// What is asked of a plan at a tolerance on a device, or, without one, on a device without limits.
pub(crate) fn request(device: Option<&Info>, tolerance: f64, cost_model: CostModel) -> Request {
    let unlimited = Request { cost_model, ..Request::new(tolerance) };
    device.map_or(unlimited, |info| Request {
        loop_rounds: info.loop_rounds().unwrap_or(usize::MAX),
        doubles: info.limits.doubles,
        // A term takes three vec4.
        most_terms: (info.limits.storage_block / 48) as usize,
        most_nodes: info.limits.texture_size,
        ..unlimited
    })
}

/// The plan for a problem on a device, or, without one, on a device without limits; by what is known of its speed. Where it matters how
/// dark the picture is, the tolerance is of that as well.
///
/// # Errors
/// Those of [`plan::plan`], [`plan::plan_at_least`] and [`plan::plan_within`].
pub fn plan(
    accuracy: &Accuracy,
    darkest: Option<&Darkest>,
    problem: &Arc<Problem>,
    device: Option<&Info>,
    known: Known,
) -> Result<Planning> {
    let planned = plan_to(accuracy, problem, device, known.clone())?;
    let (Some(darkest), Goal::Tolerance(asked)) = (darkest, accuracy.goal) else { return Ok(planned) };
    let needed = darkest.tolerance(asked, planned.plan.scale);
    if needed >= planned.plan.tolerance {
        return Ok(planned);
    }
    let mut planned = plan_to(&Accuracy { goal: Goal::Tolerance(needed), ..*accuracy }, problem, device, known)?;
    planned.notes.insert(
        0,
        format!("held to {needed:.1e} of the largest glare, for {asked:.1e} of photo and glare at the darkest pixel"),
    );
    Ok(planned)
}

fn plan_to(accuracy: &Accuracy, problem: &Arc<Problem>, device: Option<&Info>, known: Known) -> Result<Planning> {
    let &Accuracy { goal, allow_floor, each_pixel: _, degree, period, evaluator } = accuracy;
    // A budget is bought from the loosest tolerance on, whatever the request says.
    let asked = match goal {
        Goal::Tolerance(tolerance) => tolerance,
        Goal::Budget(_) => plan::LOOSEST,
    };
    let request = Request { period, degree, evaluator, ..request(device, asked, known.model) };
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
