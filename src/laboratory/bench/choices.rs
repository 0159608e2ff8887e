//! How well plans choose, and how far what they predict is from what is measured: over random scenes.

use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

use super::random::{Random, random};
use super::report::{Report, Table, Target};
use super::stage::{Actor, Stage};
use crate::certificate::Certificate;
use crate::measure::{Ratio, Samples, in_turns};
use crate::plan::{Cost, Evaluator, Plan, Precision, Request, plan};
use crate::problem::Problem;
use crate::terminal::progress::Progress;
use crate::{Error, Result};

/// How many times as long as the fastest candidate a good choice takes, at most.
const GOOD: f64 = 1.25;
/// Per cent of the scenes that should have a good choice.
const MOSTLY: f64 = 95.0;
/// What is predicted should be at most this many times what is measured, at the median.
const LOOSE: f64 = 5.0;
/// And a floor that is named at most this many times what is measured there.
const LOOSE_FLOOR: f64 = 10.0;
/// Candidates that should take longer than this many times the choice are not run: they would take most of the time.
const HOPELESS: f64 = 3.0;
/// Planning should take no more than this part of what it plans is expected to take, or so many milliseconds.
const PLANNING: f64 = 0.1;
const PLANNING_LEAST: f64 = 5.0;
/// How often each scene is planned.
const PLANNED: usize = 3;
/// Scenes that are printed, the worst first.
const SHOWN: usize = 12;

/// What one scene gave.
struct Outcome {
    name: String,
    chosen: Evaluator,
    /// How the field is computed, in words; and how the fastest candidate does it, where that is another.
    by: String,
    faster: Option<String>,
    wall: Samples,
    over: Ratio,
    predicted: f64,
    measured: f64,
    /// The floor that was named, where what was asked first could not be had.
    floor: Option<f64>,
    /// Candidates that broke their promise, in words.
    broken: Vec<String>,
    planning: Samples,
    /// What the plan was expected to take, in milliseconds.
    expected: f64,
}

/// Plans the random scenes of these numbers, of one size if it is given, and renders each by every evaluator that is not
/// hopeless.
pub(super) fn of_random_scenes(
    stage: &Stage,
    report: &mut Report,
    numbers: Range<u32>,
    size: Option<[u32; 2]>,
) -> Result<()> {
    let progress = Progress::start(false);
    progress.say("random scenes");
    progress.measured(numbers.len());
    let (count, mut outcomes) = (numbers.len(), Vec::new());
    for seed in numbers {
        outcomes.push(outcome(stage, seed.into(), size)?);
        progress.advance(1);
    }
    outcomes.sort_by(|a, b| b.over.of_medians.total_cmp(&a.over.of_medians));
    let mut table = Table::new(format!("What the plan chose in {count} random scenes"), "fastest").shown(SHOWN);
    for Outcome { name, by, faster, wall, over, .. } in &outcomes {
        let faster = faster.as_ref().map_or(String::new(), |faster| format!("; {faster} is faster"));
        table.row(format!("{name}, by {by}{faster}"), wall, Some(*over));
    }
    let broken: Vec<&str> = outcomes.iter().flat_map(|outcome| &outcome.broken).map(String::as_str).collect();
    let looseness = looseness(&outcomes);
    let floors = outcomes.iter().filter_map(|outcome| {
        let (name, measured) = (&outcome.name, outcome.measured);
        Some(format!("A floor was named: {name}: {:.1e}, and {measured:.1e} measured there", outcome.floor?))
    });
    let floors: Vec<String> = floors.collect();
    let told = ["The worst first; --csv and --json have them all.", &looseness].into_iter();
    let told = told.chain(broken).chain(floors.iter().map(String::as_str));
    report.table(table.note(told.collect::<Vec<_>>().join("\n")));
    report.table(planning(&mut outcomes));
    bars(&outcomes, report);
    Ok(())
}

/// How long planning takes, against what it plans.
fn planning(outcomes: &mut [Outcome]) -> Table {
    outcomes.sort_by(|a, b| b.slow_planning().total_cmp(&a.slow_planning()));
    let mut table = Table::new("Planning them", "plan").shown(SHOWN);
    for Outcome { name, by, planning, expected, .. } in outcomes.iter() {
        let expected: Samples = std::iter::repeat_n(*expected, PLANNED).collect();
        table.row(format!("{name}, by {by}"), planning, Some(planning.over(&expected)));
    }
    table.note(format!("The ratio is to what the plan is expected to take; {PLANNING_LEAST} ms are always allowed."))
}

fn bars(outcomes: &[Outcome], report: &mut Report) {
    let per_cent = |holds: &dyn Fn(&Outcome) -> bool| {
        100.0 * outcomes.iter().filter(|outcome| holds(outcome)).count() as f64 / outcomes.len().max(1) as f64
    };
    let good = per_cent(&|outcome| outcome.over.of_medians <= GOOD);
    let quick = per_cent(&|outcome| outcome.slow_planning() <= 1.0);
    report.bar(format!("% of choices within {GOOD} times the fastest"), Target::AtLeast(MOSTLY), good);
    report.bar(
        "% with measured <= predicted <= asked",
        Target::AtLeast(100.0),
        per_cent(&|outcome| outcome.broken.is_empty()),
    );
    report.bar("predicted / measured, at the median", Target::AtMost(LOOSE), ratios(outcomes, None).median());
    let floors: Vec<f64> = outcomes.iter().filter_map(|outcome| Some(outcome.floor? / outcome.measured)).collect();
    if !floors.is_empty() {
        let what = format!("floor / measured, at most, in {} scenes with one", floors.len());
        report.bar(what, Target::AtMost(LOOSE_FLOOR), floors.into_iter().fold(0.0, f64::max));
    }
    let what = format!("% planned in {PLANNING} of what they should take, or {PLANNING_LEAST} ms");
    report.bar(what, Target::AtLeast(100.0), quick);
}

impl Outcome {
    /// How many times as long as it may planning took.
    fn slow_planning(&self) -> f64 {
        self.planning.median() / PLANNING_LEAST.max(PLANNING * self.expected)
    }
}

fn outcome(stage: &Stage, seed: u64, size: Option<[u32; 2]>) -> Result<Outcome> {
    let Random { frame, ghosts, tolerance, bells } = random(seed, size);
    let problem = Problem::new(ghosts, frame);
    let Choice { plan: chosen, floor } = choose(stage, &problem, tolerance)?;
    let asked = |evaluator| Request { evaluator, ..stage.request(chosen.tolerance) };
    let planning = (0..PLANNED).map(|_| {
        let started = Instant::now();
        let again = plan(&problem, &asked(None)).map(|plan| plan.spectrum_milliseconds());
        Ok(started.elapsed().as_secs_f64() * 1e3 - again?)
    });
    let planning: Samples = planning.collect::<Result<Vec<f64>>>()?.into_iter().collect();
    let expected = chosen.cost().unwrap_or(f64::INFINITY);
    // The choice stands first; it may be none of the others, where it sums some ghosts beside a series.
    let others = Evaluator::ALL.into_iter().filter_map(|evaluator| plan(&problem, &asked(Some(evaluator))).ok());
    let others = others
        .filter(|plan| plan.layers() != chosen.layers() && plan.cost().is_some_and(|cost| cost <= HOPELESS * expected));
    let plans: Vec<Plan> = std::iter::once(chosen.clone()).chain(others).collect();
    let mut actors = plans.iter().map(|plan| stage.actor(plan)).collect::<Result<Vec<Actor>>>()?;
    let times = in_turns(stage.rounds, actors.len(), |index| {
        let started = Instant::now();
        actors[index].everything()?;
        Ok(started.elapsed().as_secs_f64() * 1e3)
    })?;
    let times: Vec<Samples> = times.into_iter().map(|times| times.into_iter().collect()).collect();
    let fastest = (0..times.len()).min_by(|&a, &b| times[a].median().total_cmp(&times[b].median())).unwrap_or_default();
    let certificates =
        actors.iter_mut().zip(&plans).map(|(actor, plan)| Certificate::measure(&mut actor.renderer().field, plan));
    let certificates = certificates.collect::<Result<Vec<Certificate>>>()?;
    let count = problem.ghosts().len();
    let asked = chosen.tolerance;
    let name = format!("{seed}: {} x {}, K = {count}, {bells}, {asked:.0e}", frame.width, frame.height);
    let broken = plans.iter().zip(&certificates).filter_map(|(plan, &Certificate { measured, predicted, .. })| {
        let by = by(plan);
        let kept = measured <= predicted && predicted <= asked;
        (!kept).then(|| format!("Not kept: {name}, by {by}: {measured:.1e} measured, {predicted:.1e} predicted"))
    });
    Ok(Outcome {
        broken: broken.collect(),
        chosen: chosen.evaluator(),
        by: by(&chosen),
        faster: (fastest != 0).then(|| by(&plans[fastest])),
        wall: times[0].clone(),
        over: times[0].over(&times[fastest]),
        predicted: certificates[0].predicted,
        measured: certificates[0].measured,
        floor,
        planning,
        expected,
        name,
    })
}

/// How a plan computes its field.
fn by(plan: &Plan) -> String {
    let evaluator = plan.evaluator();
    let beside = plan.costs.first().and_then(Cost::beside).map_or(String::new(), |beside| format!(" with {beside}"));
    let precision = if plan.precision == Precision::Double { " in 64 bits" } else { "" };
    format!("{evaluator}{beside}{precision}")
}

/// What the plan chose, at the tolerance that was asked or, where that could not be had, just above the floor that was named.
struct Choice {
    plan: Plan,
    floor: Option<f64>,
}

fn choose(stage: &Stage, problem: &Arc<Problem>, tolerance: f64) -> Result<Choice> {
    match plan(problem, &stage.request(tolerance)) {
        Err(Error::ToleranceBelowFloor { floor, .. }) => {
            let plan = plan(problem, &stage.request(1.001 * floor))?;
            Ok(Choice { plan, floor: Some(floor) })
        }
        plan => Ok(Choice { plan: plan?, floor: None }),
    }
}

/// How many times what was measured the prediction is, in the scenes that one evaluator was chosen for, or in all.
fn ratios(outcomes: &[Outcome], only: Option<Evaluator>) -> Samples {
    let mine = outcomes.iter().filter(|outcome| only.is_none_or(|evaluator| outcome.chosen == evaluator));
    mine.filter(|outcome| outcome.measured > 0.0).map(|outcome| outcome.predicted / outcome.measured).collect()
}

/// [`ratios`] in words.
fn looseness(outcomes: &[Outcome]) -> String {
    let mut words = vec!["Predicted / measured (least, median, most):".to_owned()];
    for evaluator in Evaluator::ALL {
        let ratios = ratios(outcomes, Some(evaluator));
        let count = outcomes.iter().filter(|outcome| outcome.chosen == evaluator).count();
        if count > 0 {
            words.push(format!(
                "{evaluator} in {count} scenes {:.1}, {:.1}, {:.0};",
                ratios.min(),
                ratios.median(),
                ratios.max()
            ));
        }
    }
    words.join(" ").trim_end_matches(';').to_owned() + "."
}
