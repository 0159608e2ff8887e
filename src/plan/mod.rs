//! Tolerance in, plan out: the cheapest computation whose predicted error stays below what was asked.
//!
//! Pure: ghosts, a picture's size and a tolerance decide everything. The error is split by its sources, each with its
//! bound; docs/accuracy.md says where each comes from.

mod amplitudes;
mod bands;
mod candidate;
mod check;
mod cost;
mod decay;
mod decided;
mod direct;
mod effort;
mod floor;
mod gather;
mod images;
mod lattice;
mod layer;
mod local;
mod modes;
mod period;
mod plate;
mod prediction;
mod request;
mod rounding;
mod search;
mod series;
mod slots;
mod split;
mod sums;
mod terms;
mod unit;
mod weigh;

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use crate::problem::{Images, Problem};
use crate::scene::Ghost;
use crate::{Error, Result};

pub use crate::choices::Evaluator;
pub use crate::plate::{Part, Way};
pub use cost::{Cost, CostModel, GRID_PASSES};
pub use decided::{Faint, Plan};
pub use direct::Precision;
pub use gather::{Gatherer, Gathering, Transform};
pub(crate) use images::MANY_IMAGES;
pub(crate) use lattice::DOUBLE_ORDER;
pub use lattice::Lattice;
pub use layer::{Layer, Series};
pub use local::Local;
pub(crate) use local::{Area, LARGEST_POINT, block_shift};
pub use modes::{Mode, Modes};
pub use plate::Plate;
pub use prediction::{Prediction, Source};
pub(crate) use request::GHOSTS_A_ROUND;
pub use request::Request;
pub use search::{LOOSEST, plan_at_least, plan_within};
pub use terms::Group;
pub(crate) use weigh::weight;

use candidate::{Survey, candidate};
use series::Wide;
use split::Apart;

/// Highest harmonic that a plan may use along one axis.
pub const HIGHEST_DEGREE: u32 = 4096;

/// Tolerances from which on layers in 32-bit floats may be refused for what these cost.
const BEYOND_SINGLE: f64 = 1e-4;

/// An evaluator that a plan could not choose.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Refusal {
    /// The evaluator.
    pub evaluator: Evaluator,
    /// Why, in words.
    pub reason: String,
}

/// Ghosts from which on planning to sum them at every pixel takes longer than planning all else.
const MANY: usize = 4096;
/// And from which on layers come before a series of all, which costs more to plan.
const SOME: usize = 256;

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
    /// Of a photo's moments, which every image takes; what is beyond the part before this the terms make up for.
    pub const IMAGES: f64 = 0.08;
}

/// The cheapest plan that meets the request.
///
/// # Errors
/// [`Error::ToleranceBelowFloor`] where f32 cannot be as exact as asked; [`Error::Plan`] where the series that was
/// asked for cannot be had.
pub fn plan(problem: &Arc<Problem>, asked: &Request) -> Result<Plan> {
    attempt(problem, asked)?.map_err(|refusals| floor::most_helpful(problem, asked, refusals))
}

/// The cheapest plan, or why each of the evaluators that were asked for cannot be had.
///
/// # Errors
/// [`Error::Plan`] where there is no planning for what was asked.
fn attempt(problem: &Arc<Problem>, asked: &Request) -> Result<std::result::Result<Plan, Vec<Error>>> {
    if !(asked.tolerance > 0.0 && asked.tolerance < 1.0) {
        return Err(Error::Plan(format!("a tolerance of {} is not between 0 and 1", asked.tolerance)));
    }
    let ghosts = problem.ghosts();
    check::request(asked)?;
    check::ghosts(ghosts)?;
    if let Some(images) = problem.images() {
        return attempt_with(images, problem, asked);
    }
    if asked.evaluator == Some(Evaluator::Plate) && !ghosts.is_empty() {
        return Err(Error::Plan(
            "a plate has the ghosts of all pixels of a photo, and these are of single lights; give --sources photo, or another evaluator".into(),
        ));
    }
    let request = &Request { period: own_period(ghosts, asked)?, ..*asked };
    request.period.map_or(Ok(()), check::period)?;
    let survey = Survey::new(problem, request);
    check::scale(survey.weighed.scale)?;
    // A period or a degree asks for a series, but for the one period that periodic bells have: it is theirs by `direct` too.
    let periodic = ghosts.par_iter().any(|ghost| ghost.bell.shape().period().is_some());
    let series = asked.degree.is_some() || (asked.period.is_some() && !periodic);
    // Who asks for an evaluator in a period gets it as it comes.
    let given = series || (asked.period.is_some() && asked.evaluator.is_some());
    let wanted = |evaluator: &Evaluator| match request.evaluator {
        Some(only) => only == *evaluator,
        None => !series || evaluator.is_series(),
    };
    let mut found = Found::default();
    // The direct sum of a few ghosts costs next to nothing to plan, and what it would take bounds what planning the others may.
    // That of many, which is hardly ever the cheapest, is an estimate until all others are known.
    let mut direct = wanted(&Evaluator::Direct).then(|| direct::estimate(problem, &survey, request));
    if direct.take_if(|_| request.evaluator.is_some() || survey.kept() <= MANY).is_some() {
        found.take(Evaluator::Direct, candidate(problem, &survey, None, request, Evaluator::Direct));
        found.bound(&survey);
    } else if let Some(cost) = direct.as_ref().filter(|cost| candidate::rounds(cost.summed) <= request.loop_rounds) {
        survey.effort.beside(cost.milliseconds);
    }
    // What reaches few pixels is as soon planned; where it is not, the others come first.
    let mut local = wanted(&Evaluator::Local).then(|| local::Estimate::new(problem, &survey, request));
    let early = |estimate: &mut local::Estimate| estimate.likely && survey.effort.affords(estimate.work);
    if let Some(estimate) = local.take_if(early) {
        found.local(problem, &survey, request, estimate);
    }
    // To know the modes of many ghosts takes longer than to cut them: where there are layers, no series of all is planned, or only
    // where that is little beside them.
    let series = found.worth_a_try(problem, request, wanted);
    let first = survey.kept() > SOME;
    let cut = first && found.layers(problem, &survey, request, &series);
    if cut && survey.kept() > MANY {
        found.refuse(&series, "layers of it and others are expected to take less time");
    } else {
        found.series(problem, &survey, request, &series, given);
    }
    if let Some(estimate) = local {
        found.local(problem, &survey, request, estimate);
    }
    if !first {
        found.layers(problem, &survey, request, &series);
    }
    if let Some(cost) = direct {
        found.direct(problem, &survey, request, cost);
        if found.plans.is_empty() {
            // What the others were held to cannot be had.
            survey.effort.lift();
            found.refusals.retain(|(evaluator, _)| !series.contains(evaluator));
            found.series(problem, &survey, request, &series, given);
        }
    }
    Ok(found.cheapest())
}

/// The same where the whole photo shines: all is one series, whose modes are the photo's own; or what is too sharp for one is summed on
/// the plate.
fn attempt_with(
    images: &Images,
    problem: &Arc<Problem>,
    asked: &Request,
) -> Result<std::result::Result<Plan, Vec<Error>>> {
    check::images(images)?;
    let on_plate = |evaluator: &Evaluator| *evaluator == Evaluator::Plate;
    if let Some(evaluator) = asked.evaluator.filter(|evaluator| !evaluator.is_series() && !on_plate(evaluator)) {
        let (pixels, each) = (images.raster().pixels(), images.all().len());
        return Err(Error::Plan(format!(
            "the ghosts of all pixels are {pixels} times {each}, which a series or a plate adds up and {evaluator} cannot; give --sources \
             lights, or another evaluator"
        )));
    }
    // What is given by hand is that of a series.
    let given = asked.degree.is_some() || asked.period.is_some();
    if asked.evaluator.is_some_and(|evaluator| on_plate(&evaluator)) {
        return if given { Err(plate::by_hand()) } else { plate::plan(images, problem, asked, &[]) };
    }
    let by_series = by_series(images, problem, asked);
    if given || asked.evaluator.is_some() {
        return by_series;
    }
    let errors = match by_series {
        Ok(Ok(plan)) => return Ok(Ok(plan)),
        Ok(Err(errors)) => errors,
        Err(error) => vec![error],
    };
    // Where it is floats that are not exact enough, a plate's are not, either.
    let sharp = errors.iter().any(|error| !matches!(error, Error::ToleranceBelowFloor { .. }));
    if sharp { plate::plan(images, problem, asked, &errors) } else { Ok(Err(errors)) }
}

/// All of a photo's images as one series.
fn by_series(
    images: &Images,
    problem: &Arc<Problem>,
    asked: &Request,
) -> Result<std::result::Result<Plan, Vec<Error>>> {
    let bells: Vec<Ghost> =
        images.all().iter().map(|image| image.ghost.clone()).chain(problem.ghosts().to_vec()).collect();
    let request = &Request { period: own_period(&bells, asked)?, ..*asked };
    request.period.map_or(Ok(()), check::period)?;
    let survey = Survey::of(problem, unit::weighed(problem, images, request)?);
    check::scale(survey.weighed.scale)?;
    let mut found = Found::default();
    let wanted = |evaluator: &Evaluator| request.evaluator.is_none_or(|only| only == *evaluator);
    let series: Vec<Evaluator> =
        [Evaluator::Grid, Evaluator::Rows, Evaluator::Series].into_iter().filter(wanted).collect();
    let given = request.degree.is_some() || (asked.period.is_some() && asked.evaluator.is_some());
    found.series(problem, &survey, request, &series, given);
    Ok(found.cheapest())
}

/// The plans that could be had, and the evaluators that could not.
#[derive(Default)]
struct Found {
    plans: Vec<Plan>,
    refusals: Vec<(Evaluator, Error)>,
    /// What was not planned, since it costs more.
    others: Vec<Cost>,
}

impl Found {
    fn take(&mut self, evaluator: Evaluator, plan: Result<Plan>) {
        match plan {
            Ok(plan) => self.plans.push(plan),
            Err(error) => self.refusals.push((evaluator, error)),
        }
    }

    /// Lets the rest of planning cost no more than a part of the cheapest of the plans.
    fn bound(&self, survey: &Survey) {
        self.plans.iter().filter_map(Plan::cost).for_each(|milliseconds| survey.effort.beside(milliseconds));
    }

    /// Whether something that costs at least so many milliseconds may be cheaper than all of the plans.
    fn may_lose_to(&self, least: f64) -> bool {
        self.plans.iter().filter_map(Plan::cost).all(|milliseconds| least < milliseconds)
    }

    /// Plans the sum at every pixel, unless it cannot be the cheapest.
    fn direct(&mut self, problem: &Arc<Problem>, survey: &Survey, request: &Request, estimate: Cost) {
        if self.may_lose_to(estimate.milliseconds) {
            self.take(Evaluator::Direct, candidate(problem, survey, None, request, Evaluator::Direct));
        } else {
            self.others.push(estimate);
        }
    }

    /// Plans a local sum, unless it cannot be the cheapest.
    fn local(&mut self, problem: &Arc<Problem>, survey: &Survey, request: &Request, estimate: local::Estimate) {
        if request.evaluator.is_none() && !self.may_lose_to(estimate.cost.milliseconds) {
            // That is all there is to know.
            self.others.push(estimate.cost);
            return;
        }
        self.take(Evaluator::Local, local::candidate(problem, survey, request));
        self.bound(survey);
    }

    /// The series that are wanted, but for those that cannot be the cheapest: the cheapest of them, more often than not, first.
    fn worth_a_try(
        &mut self,
        problem: &Problem,
        request: &Request,
        wanted: impl Fn(&Evaluator) -> bool,
    ) -> Vec<Evaluator> {
        let least = |evaluator| cost::least(evaluator, problem.frame(), &request.cost_model);
        let (tried, dear): (Vec<Evaluator>, Vec<Evaluator>) = [Evaluator::Grid, Evaluator::Rows, Evaluator::Series]
            .into_iter()
            .filter(wanted)
            .partition(|&evaluator| request.evaluator.is_some() || self.may_lose_to(least(evaluator)));
        for evaluator in dear {
            self.take(evaluator, Err(Error::Plan(format!("the passes of {evaluator} alone would take longer"))));
        }
        tried
    }

    /// Says of evaluators why none of them was planned alone.
    fn refuse(&mut self, evaluators: &[Evaluator], reason: &str) {
        evaluators.iter().for_each(|&evaluator| self.take(evaluator, Err(Error::Plan(reason.to_owned()))));
    }

    /// Plans these series, which are predicted as they come where they are `given`.
    fn series(
        &mut self,
        problem: &Arc<Problem>,
        survey: &Survey,
        request: &Request,
        series: &[Evaluator],
        given: bool,
    ) {
        let wide = if series.is_empty() { None } else { Wide::new(problem, survey, request) };
        for &evaluator in series {
            let plan = candidate(problem, survey, wide.as_ref(), request, evaluator).and_then(|plan| {
                // In the period that periodic bells bring with them the copies of others may land on the picture.
                let total = plan.predicted.total();
                if given || total <= request.tolerance {
                    return Ok(plan);
                }
                Err(Error::Plan(format!("{evaluator} would be off by {total:.1e} in the period of the bells")))
            });
            self.take(evaluator, plan);
            self.bound(survey);
        }
    }

    /// Plans several layers, where that is likely to be cheaper; and says whether there are such. What cannot be had was never
    /// asked for by that name.
    fn layers(&mut self, problem: &Arc<Problem>, survey: &Survey, request: &Request, series: &[Evaluator]) -> bool {
        // Where 32-bit floats are of no use, 64 may be.
        self.layers_in(Precision::Single, problem, survey, request, series)
            || request.doubles
                && request.tolerance < BEYOND_SINGLE
                && self.layers_in(Precision::Double, problem, survey, request, series)
    }

    fn layers_in(
        &mut self,
        floats: Precision,
        problem: &Arc<Problem>,
        survey: &Survey,
        request: &Request,
        series: &[Evaluator],
    ) -> bool {
        let plans: Vec<Plan> = match split::apart(problem, survey, request, floats) {
            Some(Apart::Series(survey)) => {
                self.bound(&survey);
                let wide = Wide::new(problem, &survey, request);
                let plan = |&evaluator: &Evaluator| candidate(problem, &survey, wide.as_ref(), request, evaluator);
                series.iter().map(plan).filter_map(Result::ok).collect()
            }
            Some(Apart::Sums(plan)) => vec![*plan],
            None => Vec::new(),
        };
        let known = self.plans.len();
        self.plans.extend(plans.into_iter().filter(|plan| plan.predicted.total() <= request.tolerance));
        self.bound(survey);
        self.plans.len() > known
    }

    fn cheapest(self) -> std::result::Result<Plan, Vec<Error>> {
        let Self { plans, mut refusals, others } = self;
        refusals.sort_by_key(|(evaluator, _)| Evaluator::ALL.iter().position(|other| other == evaluator));
        let mut costs: Vec<Cost> = plans.iter().flat_map(|plan| plan.costs.clone()).chain(others).collect();
        costs.sort_by(|a, b| a.milliseconds.total_cmp(&b.milliseconds));
        let told = |(evaluator, error): &(Evaluator, Error)| Refusal { evaluator: *evaluator, reason: error.reason() };
        let refused = refusals.iter().map(told).collect();
        let cheapest = plans.into_iter().min_by(|a, b| a.costs[0].milliseconds.total_cmp(&b.costs[0].milliseconds));
        match cheapest {
            Some(plan) => Ok(Plan { costs, refused, ..plan }),
            None => Err(refusals.into_iter().map(|(_, error)| error).collect()),
        }
    }
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
