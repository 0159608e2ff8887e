//! How well plans choose, and how far what they predict is from what is measured: over random scenes.

use super::report::{Report, Table, Target};
use super::scenes::{self, Random};
use super::stage::{Actor, Stage};
use crate::Result;
use crate::certificate::Certificate;
use crate::measure::{Ratio, Samples, in_turns};
use crate::plan::{Evaluator, Plan, Request, plan};
use crate::problem::Problem;
use crate::terminal::progress::Progress;

/// How many times as long as the fastest candidate a good choice takes, at most.
const GOOD: f64 = 1.25;
/// Per cent of the scenes that should have a good choice.
const MOSTLY: f64 = 95.0;
/// What is predicted should be at most this many times what is measured, at the median.
const LOOSE: f64 = 10.0;
/// Candidates that should take longer than this many times the choice are not run: they would take most of the time.
const HOPELESS: f64 = 12.0;
/// Scenes that are printed, the worst choices first.
const SHOWN: usize = 12;

/// What one scene gave.
struct Outcome {
    name: String,
    chosen: Evaluator,
    /// Whether some ghosts are summed beside a series.
    split: bool,
    fastest: Evaluator,
    /// Whether that is the choice itself.
    best: bool,
    wall: Samples,
    over: Ratio,
    asked: f64,
    predicted: f64,
    measured: f64,
}

/// Plans random scenes, and renders each by every evaluator that is not hopeless.
pub(super) fn of_random_scenes(stage: &Stage, report: &mut Report, count: u32) -> Result<()> {
    let progress = Progress::start(false);
    progress.say("random scenes");
    progress.measured(count as usize);
    let mut outcomes = Vec::new();
    for seed in 0..u64::from(count) {
        outcomes.push(outcome(stage, seed)?);
        progress.advance(1);
    }
    outcomes.sort_by(|a, b| b.over.of_medians.total_cmp(&a.over.of_medians));
    let mut table = Table::new(format!("What the plan chose in {count} random scenes"), "fastest").shown(SHOWN);
    for Outcome { name, chosen, split, fastest, best, wall, over, .. } in &outcomes {
        let beside = if *split { " beside a sum" } else { "" };
        let faster = if *best { String::new() } else { format!("; {fastest} is faster") };
        table.row(format!("{name}, by {chosen}{beside}{faster}"), wall, Some(*over));
    }
    report.table(table.note(format!("The worst first; --csv and --json have them all.\n{}", looseness(&outcomes))));
    let per_cent = |holds: &dyn Fn(&Outcome) -> bool| {
        100.0 * outcomes.iter().filter(|outcome| holds(outcome)).count() as f64 / outcomes.len().max(1) as f64
    };
    let good = per_cent(&|outcome| outcome.over.of_medians <= GOOD);
    let kept = per_cent(&|outcome| outcome.measured <= outcome.predicted && outcome.predicted <= outcome.asked);
    report.bar(format!("% of choices within {GOOD} times the fastest"), Target::AtLeast(MOSTLY), good);
    report.bar("% with measured <= predicted <= asked", Target::AtLeast(100.0), kept);
    report.bar("predicted / measured, at the median", Target::AtMost(LOOSE), ratios(&outcomes, None).median());
    Ok(())
}

fn outcome(stage: &Stage, seed: u64) -> Result<Outcome> {
    let Random { frame, ghosts, tolerance } = scenes::random(seed);
    let asked = |evaluator| Request { evaluator, ..stage.request(tolerance) };
    let problem = Problem::new(ghosts, frame);
    let chosen = plan(&problem, &asked(None))?;
    let limit = HOPELESS * chosen.cost().unwrap_or(f64::INFINITY);
    // The choice stands first; it may be none of the others, where it sums some ghosts beside a series.
    let others = Evaluator::ALL.into_iter().filter_map(|evaluator| plan(&problem, &asked(Some(evaluator))).ok());
    let others = others.filter(|plan| {
        let same = plan.evaluator() == chosen.evaluator() && plan.summed() == chosen.summed();
        !same && plan.cost().is_some_and(|cost| cost <= limit)
    });
    let plans: Vec<Plan> = std::iter::once(chosen.clone()).chain(others).collect();
    let mut actors = plans.iter().map(|plan| stage.actor(plan)).collect::<Result<Vec<Actor>>>()?;
    let times = in_turns(stage.rounds, actors.len(), |index| {
        let started = std::time::Instant::now();
        actors[index].everything()?;
        Ok(started.elapsed().as_secs_f64() * 1e3)
    })?;
    let times: Vec<Samples> = times.into_iter().map(|times| times.into_iter().collect()).collect();
    let fastest = (0..times.len()).min_by(|&a, &b| times[a].median().total_cmp(&times[b].median())).unwrap_or_default();
    let certificate = Certificate::measure(&mut actors[0].renderer().field, &chosen)?;
    Ok(Outcome {
        name: format!("{seed}: {} x {}, K = {}, {tolerance:.0e}", frame.width, frame.height, problem.ghosts().len()),
        chosen: chosen.evaluator(),
        split: chosen.evaluator() != Evaluator::Direct && chosen.summed() > 0,
        fastest: plans[fastest].evaluator(),
        best: fastest == 0,
        wall: times[0].clone(),
        over: times[0].over(&times[fastest]),
        asked: tolerance,
        predicted: certificate.predicted,
        measured: certificate.measured,
    })
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
