//! The series of a plan: period, kept terms, and the lattice where there is one.

use glam::DVec2;

use super::amplitudes::{self, Amplitudes};
use super::lattice::{self, Marginals};
use super::{Evaluator, Group, Plan, Prediction, Request, Survey, check, cost, gather, period, rounding, share, terms};
use crate::scene::Ghost;
use crate::{Error, Result};

/// What of the tolerance may lie beyond the modes of [`Wide`].
const BEYOND: f64 = 0.02;

/// A period that serves every evaluator, and more modes than any of them needs, each with what it adds to the field.
pub(super) struct Wide {
    period: DVec2,
    periodisation: f64,
    groups: Vec<Group>,
    amplitudes: Amplitudes,
    /// A bound of what lies beyond the modes.
    beyond: f64,
}

impl Wide {
    /// None where looking at every ghost's phases takes too long, or where the series is given.
    pub fn new(ghosts: &[Ghost], survey: &Survey, request: &Request) -> Option<Self> {
        let given = request.degree.is_some() || request.evaluator == Some(Evaluator::Direct);
        if given || !amplitudes::worth_a_try(&survey.groups) {
            return None;
        }
        let rounding = rounding::bound(&survey.weighed, Evaluator::Grid, rounding::SEEN_DEGREE);
        let usable = (request.tolerance - rounding).max(0.25 * request.tolerance);
        let period = request.period.unwrap_or_else(|| period::shortest(&survey.reaches, usable * share::PERIODISATION));
        let mut groups = survey.groups.clone();
        let counts = terms::fewest(&mut groups, period, usable * BEYOND).ok()?;
        let amplitudes = Amplitudes::new(ghosts, &groups, &counts, period, survey.weighed.scale)?;
        let beyond = terms::error(&groups, period, &counts);
        Some(Self { period, periodisation: period::error(&survey.reaches, period), groups, amplitudes, beyond })
    }

    /// Whether it leaves enough of what may be used up.
    fn fits(&self, request: &Request, usable: f64) -> bool {
        let period = request.period.is_some() || self.periodisation <= 1.5 * share::PERIODISATION * usable;
        period && self.beyond <= 2.0 * BEYOND * usable
    }

    /// The plan with the strongest of the modes, and what the kept ones hold.
    fn terms(&self, plan: &mut Plan, truncation: f64) -> Marginals {
        let (counts, left) = self.amplitudes.kept(truncation - self.beyond);
        plan.groups = self.groups.clone();
        for group in &mut plan.groups {
            let [n, m] = group.degree;
            group.degree = [n.min(counts.len() as u32 - 1), m.min(counts[0] - 1)];
        }
        plan.predicted.truncation = self.beyond + left;
        let marginals = Marginals::of(self.amplitudes.marginals(&counts));
        plan.counts = counts;
        marginals
    }
}

/// Chooses period, terms and lattice within what may be used up.
///
/// # Errors
/// [`Error::Plan`] where there is no such series.
pub(super) fn plan_series(
    plan: &mut Plan,
    survey: &Survey,
    wide: Option<&Wide>,
    request: &Request,
    usable: f64,
) -> Result<()> {
    let wide = wide.filter(|wide| wide.fits(request, usable));
    plan.period = match (request.period, wide) {
        (Some(period), _) => period,
        (None, Some(wide)) => wide.period,
        (None, None) => period::shortest(&survey.reaches, usable * share::PERIODISATION),
    };
    plan.predicted.periodisation =
        wide.map_or_else(|| period::error(&survey.reaches, plan.period), |w| w.periodisation);
    check::copies(plan.period, plan.predicted.periodisation)?;
    let excess = excess(plan, usable);
    if plan.evaluator != Evaluator::Grid {
        plan_terms(plan, wide, request, usable * share::TRUNCATION - excess)?;
        gather::choose(plan, request);
        return Ok(());
    }
    let mut cheapest: Option<(f64, Plan)> = None;
    let mut refusal = None;
    for (truncation, interpolation) in share::GRID {
        match with_lattice(plan.clone(), wide, request, usable * truncation - excess, usable * interpolation) {
            Ok(plan) => {
                let cost = cost::estimate(&plan, request).milliseconds;
                if cheapest.as_ref().is_none_or(|(least, _)| cost < *least) {
                    cheapest = Some((cost, plan));
                }
            }
            Err(error) => refusal = Some(error),
        }
    }
    match (cheapest, refusal) {
        (Some((_, cheapest)), _) => *plan = cheapest,
        (None, Some(refusal)) => return Err(refusal),
        (None, None) => {}
    }
    Ok(())
}

/// What is dropped and what copies add beyond their shares of what may be used up; the terms have to make up for it.
///
/// Ghosts are dropped by the tolerance, before anyone knows what rounding takes of it; a period that serves every
/// evaluator is no evaluator's own; and one that was given may be off by anything, which no number of terms mends.
fn excess(plan: &Plan, usable: f64) -> f64 {
    const MENDED: f64 = 0.1;
    let Prediction { dropped, periodisation, .. } = plan.predicted;
    let shares = share::DROPPED + share::PERIODISATION - share::GATHERING;
    // Nothing may be left at all, where the series is given.
    (dropped + periodisation - shares * usable).min(MENDED * usable).max(0.0)
}

/// The plan with terms and a lattice, each within its part of the tolerance.
fn with_lattice(
    mut plan: Plan,
    wide: Option<&Wide>,
    request: &Request,
    truncation: f64,
    interpolation: f64,
) -> Result<Plan> {
    let marginals = plan_terms(&mut plan, wide, request, truncation)?;
    let lattice = lattice::coarsest(&plan, &marginals, request.frame, request.oversampling, interpolation)?;
    plan.predicted.interpolation = lattice.error;
    plan.lattice = Some(lattice);
    gather::choose(&mut plan, request);
    Ok(plan)
}

/// Chooses the kept terms within a part of the tolerance, and gives what they hold.
fn plan_terms(plan: &mut Plan, wide: Option<&Wide>, request: &Request, truncation: f64) -> Result<Marginals> {
    let mut known = None;
    match (request.degree, wide) {
        (Some(degree), _) => plan.counts = terms::rectangle(&mut plan.groups, degree),
        (None, Some(wide)) => known = Some(wide.terms(plan, truncation)),
        (None, None) => plan.counts = terms::fewest(&mut plan.groups, plan.period, truncation)?,
    }
    plan.terms = plan.counts.iter().map(|&count| count as usize).sum();
    if plan.terms > request.most_terms {
        let most = request.most_terms;
        return Err(Error::Plan(format!("the series would have {} terms, and {most} fit on the device", plan.terms)));
    }
    plan.degree = [plan.counts.len() as u32 - 1, plan.counts[0] - 1];
    Ok(known.unwrap_or_else(|| {
        plan.predicted.truncation = terms::error(&plan.groups, plan.period, &plan.counts);
        Marginals::by_weights(plan)
    }))
}
