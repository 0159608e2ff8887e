//! Tolerance in, plan out: the cheapest computation whose predicted error stays below what was asked.
//!
//! Pure: ghosts, a picture's size and a tolerance decide everything. The error is split by its sources, each with its
//! bound; docs/accuracy.md says where each comes from.

mod amplitudes;
mod check;
mod cost;
mod decay;
mod direct;
mod gather;
mod lattice;
mod period;
mod rounding;
mod search;
mod series;
mod slots;
mod split;
mod terms;
mod weigh;

use glam::DVec2;
use rayon::prelude::*;

use crate::frame::Frame;
use crate::scene::Ghost;
use crate::{Error, Result};

pub use crate::choices::Evaluator;
pub use cost::{Cost, CostModel, GRID_PASSES};
pub use direct::Precision;
pub use gather::Transform;
pub use lattice::{Lattice, MOST_NODES};
pub use search::{LOOSEST, plan_at_least, plan_within};
pub use terms::Group;

use period::Reach;
use series::Wide;
use weigh::Weighed;

/// Highest harmonic that a plan may use along one axis.
pub const HIGHEST_DEGREE: u32 = 4096;

/// What is asked of the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// The picture and the pixels at which the field is wanted.
    pub frame: Frame,
    /// Largest error over the pixels, relative to the largest value of the same colour.
    pub tolerance: f64,
    /// The period, where it is not to be planned.
    pub period: Option<DVec2>,
    /// The degree in x and y, where it is not to be planned; every group then has the whole rectangle of modes.
    pub degree: Option<[u32; 2]>,
    /// The evaluator, where it is not to be planned.
    pub evaluator: Option<Evaluator>,
    /// Nodes of `grid`'s lattice a half wave of the highest harmonic, 1.02 or more, where they are not to be planned.
    pub oversampling: Option<f64>,
    /// The most terms that the device can hold.
    pub most_terms: usize,
    /// Rounds that the renderer runs a shader's loops for one pixel.
    pub loop_rounds: usize,
    /// What each kind of work costs.
    pub cost_model: CostModel,
}

impl Request {
    /// A request that leaves everything but the tolerance to the plan.
    pub fn new(frame: Frame, tolerance: f64) -> Self {
        Self {
            frame,
            tolerance,
            period: None,
            degree: None,
            evaluator: None,
            oversampling: None,
            most_terms: 2 << 20,
            loop_rounds: usize::MAX,
            cost_model: CostModel::default(),
        }
    }
}

/// What was decided.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Plan {
    /// The tolerance that it was made for.
    pub tolerance: f64,
    /// How the field is computed.
    pub evaluator: Evaluator,
    /// The floats in which the summed ghosts are computed, where there are any.
    pub precision: Precision,
    /// The period in x and y.
    pub period: DVec2,
    /// Highest harmonic in x and y.
    pub degree: [u32; 2],
    /// How many harmonics of y are kept beside harmonic n of x.
    #[serde(skip)]
    pub counts: Vec<u32>,
    /// How many modes that are.
    pub terms: usize,
    /// The groups of ghosts, one part of the spectrum each.
    pub groups: Vec<Group>,
    /// The lattice, where the evaluator is `grid`.
    pub lattice: Option<Lattice>,
    /// The field's largest value or, where it is not known exactly, a lower bound of it, RGB; the field is computed in
    /// units of it.
    pub scale: [f64; 3],
    /// Pixels, as columns and rows of the picture, at which the field was found large.
    #[serde(skip)]
    pub peaks: Vec<[i32; 2]>,
    /// How many ghosts cannot reach the picture within the tolerance, and are left out.
    pub dropped: usize,
    /// The error that the plan expects at most.
    pub predicted: Prediction,
    /// The cost that the plan expects, and that of the evaluators it decided against, the cheapest first.
    pub costs: Vec<Cost>,
    /// The evaluators that could not be had, and why.
    pub refused: Vec<Refusal>,
}

impl Plan {
    /// How many ghosts the field is made of.
    pub fn ghosts(&self) -> usize {
        self.groups.iter().map(|group| group.members.len()).sum()
    }

    /// How many of them are summed directly at every pixel: all by `direct`, a few or none beside a series.
    pub fn summed(&self) -> usize {
        self.summed_groups().map(|group| group.members.len()).sum()
    }

    /// The groups of those.
    pub fn summed_groups(&self) -> impl Iterator<Item = &Group> {
        self.groups.iter().filter(|group| group.transform == Transform::Direct)
    }

    /// What it is expected to cost, in milliseconds.
    pub fn cost(&self) -> Option<f64> {
        self.costs.first().map(|cost| cost.milliseconds)
    }
}

/// An evaluator that a plan could not choose.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Refusal {
    /// The evaluator.
    pub evaluator: Evaluator,
    /// Why, in words.
    pub reason: String,
}

/// Upper bounds of the error, by source; relative to the field's largest value, like the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct Prediction {
    /// Ghosts that are left out.
    pub dropped: f64,
    /// Copies of the bells, a period away.
    pub periodisation: f64,
    /// Harmonics that are left out.
    pub truncation: f64,
    /// Between the lattice's nodes.
    pub interpolation: f64,
    /// Moments of cells that are left out.
    pub gathering: f64,
    /// f32 while it computes: phases, products, sums.
    pub rounding: f64,
    /// f32 as the format in which passes leave their results to each other: spectrum, tables, lattice.
    pub storage: f64,
}

impl Prediction {
    /// All of it.
    pub fn total(&self) -> f64 {
        self.dropped + self.periodisation + self.truncation + self.interpolation + self.gathering + self.single()
    }

    /// What single precision costs in all.
    pub fn single(&self) -> f64 {
        self.rounding + self.storage
    }
}

/// One source of error, as a prediction has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source {
    /// One word for it.
    pub name: &'static str,
    /// What the error comes from, in some words.
    pub about: &'static str,
    /// What it costs at most, relative to the largest glare of the same colour.
    pub error: f64,
}

impl Prediction {
    /// Every source with its error, in the order in which the data meets them.
    pub fn sources(&self) -> impl Iterator<Item = Source> + use<> {
        let &Self { dropped, periodisation, truncation, interpolation, gathering, rounding, storage } = self;
        let sources = [
            ("dropped", "ghosts left out", dropped),
            ("periodisation", "wrapped copies", periodisation),
            ("truncation", "harmonics left out", truncation),
            ("interpolation", "looking up between the lattice's nodes", interpolation),
            ("gathering", "moments left out", gathering),
            ("rounding", "32-bit floats while they compute", rounding),
            ("storage", "keeping results as 32-bit floats", storage),
        ];
        sources.into_iter().map(|(name, about, error)| Source { name, about, error })
    }
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
pub fn plan(ghosts: &[Ghost], asked: &Request) -> Result<Plan> {
    if !(asked.tolerance > 0.0 && asked.tolerance < 1.0) {
        return Err(Error::Plan(format!("a tolerance of {} is not between 0 and 1", asked.tolerance)));
    }
    check::request(asked)?;
    check::ghosts(ghosts)?;
    let request = &Request { period: own_period(ghosts, asked)?, ..*asked };
    request.period.map_or(Ok(()), check::period)?;
    let survey = Survey::new(ghosts, request);
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
    let wide = Wide::new(ghosts, &survey, request);
    let mut candidates = Vec::new();
    let mut refusals = Vec::new();
    let wanted: Vec<Evaluator> = Evaluator::ALL.into_iter().filter(|&evaluator| wanted(evaluator)).collect();
    for &evaluator in &wanted {
        match candidate(ghosts, &survey, wide.as_ref(), request, evaluator) {
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
    if let Some(survey) = split::apart(ghosts, &survey, request) {
        let wide = Wide::new(ghosts, &survey, request);
        let series = wanted.iter().filter(|&&evaluator| evaluator != Evaluator::Direct);
        // One that cannot be had was never asked for by that name.
        candidates.extend(series.flat_map(|&evaluator| candidate(ghosts, &survey, wide.as_ref(), request, evaluator)));
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
            Err(most_helpful(ghosts, &survey, request, &wanted, refusals))
        }
    }
}

/// The refusal that says what can be had: the lowest tolerance at which there is a plan, where rounding is the reason.
fn most_helpful(
    ghosts: &[Ghost],
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
        let tried = wanted.iter().map(|&evaluator| candidate(ghosts, survey, None, &eased, evaluator));
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

/// What all evaluators' plans begin with.
struct Survey {
    weighed: Weighed,
    groups: Vec<Group>,
    reaches: Vec<Reach>,
    /// Groups that are no part of the series, and what floats of the precision cost their sum.
    summed: Vec<Group>,
    summed_in: (Precision, f64),
}

impl Survey {
    fn new(ghosts: &[Ghost], request: &Request) -> Self {
        let weighed = weigh::weigh(ghosts, request);
        let groups = terms::group(ghosts, &weighed);
        let reaches = period::reaches(ghosts, &weighed, request.frame);
        Self { weighed, groups, reaches, summed: Vec::new(), summed_in: Default::default() }
    }
}

/// The plan that one evaluator asks for.
fn candidate(
    ghosts: &[Ghost],
    survey: &Survey,
    wide: Option<&Wide>,
    request: &Request,
    evaluator: Evaluator,
) -> Result<Plan> {
    if evaluator == Evaluator::Direct {
        let bounds = direct::bounds(ghosts, &survey.weighed, request.frame);
        let single = with_rounding((Precision::Single, bounds.single), survey, wide, request, evaluator);
        return match single {
            Err(Error::ToleranceBelowFloor { .. }) => {
                with_rounding((Precision::Double, bounds.double), survey, wide, request, evaluator)
            }
            single => single,
        };
    }
    // What rounding costs depends on the degree, and the degree on what rounding leaves of the tolerance.
    let mut degree = request.degree.map_or(rounding::SEEN_DEGREE, |[n, m]| n.max(m));
    loop {
        let (precision, summed) = survey.summed_in;
        let rounding = rounding::bound(&survey.weighed, evaluator, degree) + summed;
        let plan = with_rounding((precision, rounding), survey, wide, request, evaluator)?;
        let needed = plan.degree[0].max(plan.degree[1]);
        if needed <= degree {
            return Ok(plan);
        }
        degree = needed + needed / 16;
    }
}

/// The plan of one evaluator that rounding costs so much, its summed ghosts in floats of this precision.
fn with_rounding(
    (precision, rounding): (Precision, f64),
    survey: &Survey,
    wide: Option<&Wide>,
    request: &Request,
    evaluator: Evaluator,
) -> Result<Plan> {
    let weighed = &survey.weighed;
    // With the whole of the series given, there is nothing left to plan: the error is predicted as it comes.
    let between = evaluator != Evaluator::Grid || request.oversampling.is_some();
    let given = request.period.is_some() && request.degree.is_some() && between;
    let usable = request.tolerance - rounding;
    // A direct sum leaves out nothing but ghosts; a series needs room for its own bounds.
    let needed = if evaluator == Evaluator::Direct { share::DROPPED } else { 0.25 };
    if usable < needed * request.tolerance && !given {
        return Err(Error::ToleranceBelowFloor { asked: request.tolerance, floor: rounding / (1.0 - needed) });
    }
    let storage = rounding::stored(weighed, evaluator).min(rounding);
    let mut plan = Plan {
        tolerance: request.tolerance,
        evaluator,
        precision,
        period: DVec2::ONE,
        degree: [0; 2],
        counts: Vec::new(),
        terms: 0,
        groups: survey.groups.clone(),
        lattice: None,
        scale: weighed.scale,
        peaks: weighed.peaks.clone(),
        dropped: weighed.dropped,
        predicted: Prediction {
            dropped: weighed.dropped_error,
            rounding: rounding - storage,
            storage,
            ..Prediction::default()
        },
        costs: Vec::new(),
        refused: Vec::new(),
    };
    if evaluator == Evaluator::Direct {
        plan.groups.iter_mut().for_each(|group| group.transform = Transform::Direct);
    } else {
        series::plan_series(&mut plan, survey, wide, request, usable)?;
        plan.groups.extend_from_slice(&survey.summed);
    }
    // `direct` takes eight ghosts a round where there are many, and a few rounds more to gather them.
    let rounds = match evaluator {
        Evaluator::Direct => plan.ghosts() / 7,
        Evaluator::Series => plan.terms + plan.counts.len() + plan.summed(),
        Evaluator::Rows | Evaluator::Grid => 0,
    };
    if rounds > request.loop_rounds {
        return Err(Error::Plan(format!("{evaluator} would need more rounds of a loop than this renderer runs")));
    }
    plan.costs = vec![cost::estimate(&plan, request)];
    Ok(plan)
}

#[cfg(test)]
mod tests;
