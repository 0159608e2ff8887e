//! The plan that one evaluator asks for.

use std::cell::Cell;
use std::sync::Arc;

use super::direct::STORED;
use super::effort::Effort;
use super::period::{self, Reach};
use super::request::GHOSTS_A_ROUND;
use super::series::{self, Wide};
use super::weigh::{self, Weighed};
use super::{
    Evaluator, Group, Layer, Plan, Precision, Prediction, Request, cost, direct, images, rounding, share, terms,
};
use crate::problem::Problem;
use crate::series::{Distinct, Modes};
use crate::{Error, Result};

/// The part of the tolerance that a series needs for its own bounds.
pub(super) const NEEDED: f64 = 0.25;
/// And where 64-bit floats leave no more to be had: a digit more costs little.
const NEEDED_DOUBLE: f64 = 0.1;

/// What all evaluators' plans begin with.
pub(super) struct Survey {
    pub weighed: Weighed,
    pub groups: Vec<Group>,
    pub reaches: Vec<Reach>,
    /// Groups that are no part of the series, and what floats of the precision cost their sum.
    pub beside: Beside,
    /// What planning may cost, and whether that of the bells is in it.
    pub effort: Effort,
    pub prepared: Cell<bool>,
}

/// Layers that stand beside the series, and what they are off by at most.
#[derive(Clone, Default)]
pub(super) struct Beside {
    pub layers: Vec<Layer>,
    /// The floats in which ghosts are summed at every pixel.
    pub precision: Precision,
    /// What floats cost.
    pub rounding: f64,
    /// What is left out where bells are summed where they reach.
    pub cut: f64,
    /// Whether all of them are in 64-bit floats, and so is the series to be; then what storing the sum costs is not in it.
    pub exact: bool,
}

impl Survey {
    pub fn new(problem: &Problem, request: &Request) -> Self {
        Self::of(problem, weigh::weigh(problem, request.tolerance))
    }

    /// Of what was weighed.
    pub fn of(problem: &Problem, weighed: Weighed) -> Self {
        let mut groups = terms::group(problem.ghosts(), &weighed.weights);
        groups.extend(problem.images().into_iter().flat_map(|images| images::groups(images, &weighed)));
        let reaches = period::reaches(problem, &weighed);
        Self {
            weighed,
            groups,
            reaches,
            beside: Beside::default(),
            effort: Effort::unlimited(),
            prepared: Cell::new(false),
        }
    }
}

impl Survey {
    /// Ghosts that are not dropped.
    pub fn kept(&self) -> usize {
        self.groups.iter().map(|group| group.ghosts).sum()
    }

    /// Takes note of what it costs to have each bell ready for a series, once.
    ///
    /// # Errors
    /// [`Error::Plan`] where that is more than planning may cost.
    pub fn prepare(&self) -> Result<()> {
        if self.prepared.replace(true) {
            return Ok(());
        }
        let mut distinct = Distinct::new();
        let bells = self.groups.iter().map(|group| &group.bell).filter(|&bell| distinct.number(bell).1);
        let ready = bells.map(|bell| match bell.shape().modes() {
            Modes::Product(_) | Modes::None => 0.0,
            Modes::Radial(radial) => radial.preparation(),
            Modes::Plane(plane) => plane.preparation(),
        });
        self.effort.spend(ready.sum())
    }
}

/// The plan that one evaluator asks for.
///
/// # Errors
/// [`Error::ToleranceBelowFloor`] where f32 cannot be as exact; [`Error::Plan`] where there is no such series.
pub(super) fn candidate(
    problem: &Arc<Problem>,
    survey: &Survey,
    wide: Option<&Wide>,
    request: &Request,
    evaluator: Evaluator,
) -> Result<Plan> {
    if evaluator == Evaluator::Direct {
        let bounds = direct::bounds(problem, &survey.weighed);
        let of = |precision, rounding| Floats { series: precision, summed: precision, rounding };
        let single = of(Precision::Single, bounds.single);
        return match with_rounding(problem, single, survey, wide, request, evaluator) {
            Err(Error::ToleranceBelowFloor { .. }) if request.doubles => {
                let double = of(Precision::Double, STORED + bounds.double);
                with_rounding(problem, double, survey, wide, request, evaluator)
            }
            single => single,
        };
    }
    let series = |precision| series_in(precision, problem, survey, wide, request, evaluator);
    if survey.beside.exact {
        return series(Precision::Double);
    }
    // Layers beside it are of the floats that go with a series in 32 bits.
    let alone = survey.beside.layers.is_empty() && request.doubles;
    match series(Precision::Single) {
        Err(below @ Error::ToleranceBelowFloor { .. }) if alone => match series(Precision::Double) {
            // A looser tolerance has a series in 32-bit floats.
            Err(Error::Plan(_)) => Err(below),
            double => double,
        },
        // A series that is given in all is never refused.
        Ok(single) if alone && single.predicted.total() > request.tolerance => Ok(match series(Precision::Double) {
            Ok(double) if double.predicted.total() <= request.tolerance => double,
            _ => single,
        }),
        single => single,
    }
}

/// The floats of a plan, and what they cost.
#[derive(Clone, Copy)]
struct Floats {
    series: Precision,
    summed: Precision,
    rounding: f64,
}

/// The plan of a series in floats of this precision, beside what the survey has.
fn series_in(
    series: Precision,
    problem: &Arc<Problem>,
    survey: &Survey,
    wide: Option<&Wide>,
    request: &Request,
    evaluator: Evaluator,
) -> Result<Plan> {
    // What rounding costs depends on the degree, and the degree on what rounding leaves of the tolerance.
    let mut degree = request.degree.map_or(rounding::SEEN_DEGREE, |[n, m]| n.max(m));
    loop {
        let Beside { precision, rounding: beside, cut, .. } = survey.beside;
        let mut rounding = beside
            + match series {
                Precision::Single => rounding::bound(&survey.weighed, evaluator, degree),
                Precision::Double => STORED + rounding::of_exact(&survey.groups, [degree; 2]),
            };
        if series == Precision::Single
            && rounding + cut > (1.0 - NEEDED) * request.tolerance
            && let Some(wide) = wide
        {
            rounding = rounding.min(wide.rounding(evaluator) + beside);
        }
        let summed = if series == Precision::Double { series } else { precision };
        let plan = with_rounding(problem, Floats { series, summed, rounding }, survey, wide, request, evaluator)?;
        let needed = plan.degree()[0].max(plan.degree()[1]);
        if needed <= degree {
            return Ok(plan);
        }
        degree = needed + needed / 16;
    }
}

/// A plan of layers, with what they cost.
pub(super) fn made(
    problem: &Arc<Problem>,
    weighed: &Weighed,
    request: &Request,
    layers: Vec<Layer>,
    precision: Precision,
    predicted: Prediction,
) -> Plan {
    Plan {
        tolerance: request.tolerance,
        precision,
        scale: weighed.scale,
        peaks: weighed.peaks.clone(),
        dropped: weighed.dropped,
        predicted,
        costs: vec![cost::estimate(&layers, precision, problem.frame(), &request.cost_model)],
        ..Plan::by_hand(problem.clone(), layers)
    }
}

/// Rounds of a loop that `direct` takes for so many ghosts: eight of them a round where there are many, and a few rounds more to
/// gather them.
pub(super) fn rounds(ghosts: usize) -> usize {
    ghosts / (GHOSTS_A_ROUND - 1)
}

/// The plan of one evaluator in some floats.
fn with_rounding(
    problem: &Arc<Problem>,
    floats: Floats,
    survey: &Survey,
    wide: Option<&Wide>,
    request: &Request,
    evaluator: Evaluator,
) -> Result<Plan> {
    let (weighed, Floats { series, summed, rounding }) = (&survey.weighed, floats);
    // With the whole of the series given, there is nothing left to plan: the error is predicted as it comes.
    let given = request.period.is_some() && request.degree.is_some();
    let cut = survey.beside.cut;
    let usable = request.tolerance - rounding - cut;
    // A direct sum leaves out nothing but ghosts; a series needs room for its own bounds.
    let needed = match (evaluator, series) {
        (Evaluator::Direct, _) => share::DROPPED,
        (_, Precision::Single) => NEEDED,
        (_, Precision::Double) => NEEDED_DOUBLE,
    };
    if usable < needed * request.tolerance && !given {
        return Err(Error::ToleranceBelowFloor { asked: request.tolerance, floor: (rounding + cut) / (1.0 - needed) });
    }
    let storage = match series {
        Precision::Single => rounding::stored(weighed, evaluator).min(rounding),
        Precision::Double => STORED,
    };
    let mut predicted = Prediction {
        dropped: weighed.dropped_error,
        cut,
        rounding: rounding - storage,
        storage,
        ..Prediction::default()
    };
    let mut layers = Vec::new();
    if evaluator == Evaluator::Direct {
        layers.push(Layer::direct(survey.groups.iter().cloned()));
    } else {
        let (series, with_series) =
            series::plan_series((evaluator, series), survey, wide, problem.frame(), request, predicted, usable)?;
        predicted = with_series;
        layers.push(Layer::Series(series));
        layers.extend(survey.beside.layers.iter().cloned());
    }
    let plan = made(problem, weighed, request, layers, summed, predicted);
    let rounds = match evaluator {
        Evaluator::Direct => rounds(plan.ghosts()),
        Evaluator::Series => plan.terms() + plan.counts().len() + plan.summed(),
        Evaluator::Rows | Evaluator::Grid | Evaluator::Local | Evaluator::Plate => 0,
    };
    if rounds > request.loop_rounds {
        return Err(Error::Plan(format!("{evaluator} would need more rounds of a loop than this renderer runs")));
    }
    Ok(plan)
}
