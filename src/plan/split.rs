//! Which ghosts are no part of the series: small and sharp ones ask for more terms than all the others, and reach few pixels.
//!
//! Groups are put in the order of the terms that they need; the union of all terms only shrinks with the neediest. A cut through
//! that order has on one side what is summed, each group where it reaches or at every pixel, whichever is cheaper; and on the
//! other what is a series, or summed at every pixel as well where that is cheaper still. Where to cut is decided by bounds by
//! weights, which are cheap; what comes of it is planned like any other candidate.

use std::sync::Arc;

use glam::DVec2;

use super::candidate::{Beside, Survey, made, rounds};
use super::decay::Decay;
use super::direct::{HALF_A_UNIT, STORED};
use super::weigh::Weighed;
use super::{
    CostModel, Evaluator, Group, Layer, Plan, Precision, Prediction, Request, Transform, cost, direct, gather, local,
    period, share, terms,
};
use crate::frame::Frame;
use crate::problem::Problem;

/// What of the tolerance the rounding of ghosts that are summed at every pixel may take before that is in 64-bit floats.
const SUMMED: f64 = 0.1;

/// What a local layer may take of the tolerance: its cost grows with the logarithm of one over it, as that of a series does.
const LOCAL: f64 = 0.3;
/// And where there is no series, of what the rest leaves.
const LOCAL_ALONE: f64 = 0.98;
/// The level below which it leaves a bell out is about one in so many of that.
const CROWDING: f64 = 4.0;

/// Layers should cost less than this part of what any single evaluator does, by the estimate, to be planned.
const WORTH_IT: f64 = 0.9;

/// Nodes a half wave that a lattice is taken to have before it is planned.
const NODES: f64 = 1.6;

/// What is to be planned of the ghosts.
pub(super) enum Apart {
    /// A series of what is left, beside the layers that the survey has.
    Series(Box<Survey>),
    /// The whole plan, a sum without a series.
    Sums(Box<Plan>),
}

/// Layers that are likely to be cheaper than any single evaluator; none where there are no such.
///
/// All of them in 64-bit floats, the sum and the series as well, or in those that do beside a series in 32.
pub(super) fn apart(problem: &Arc<Problem>, survey: &Survey, request: &Request, floats: Precision) -> Option<Apart> {
    // Everything is to be a series, or in one period.
    if request.evaluator.is_some() || request.degree.is_some() || request.period.is_some() {
        return None;
    }
    let Cut { mut ways, series } = Cutting::new(problem, survey, request, floats)?.cheapest()?;
    if !series {
        ways.iter_mut().filter(|way| **way == Way::Series).for_each(|way| *way = Way::Everywhere);
    }
    let of = |wanted: Way| -> Vec<Group> {
        let mine = survey.groups.iter().zip(&ways).filter(|(_, way)| **way == wanted).map(|(group, _)| group);
        mine.map(|group| match wanted {
            Way::Series => group.clone(),
            _ => Group { transform: Transform::Direct, ..group.clone() },
        })
        .collect()
    };
    let [left, everywhere, reaching] = [Way::Series, Way::Everywhere, Way::Reaching].map(of);
    let exact = floats == Precision::Double;
    let mut beside = Beside { precision: floats, exact, ..Beside::default() };
    // What is stored is that of the sum, once.
    let stored = if exact { STORED } else { 0.0 };
    if rounds(everywhere.iter().map(|group| group.ghosts).sum()) > request.loop_rounds {
        return None;
    }
    if !everywhere.is_empty() {
        let bounds = direct::bounds(problem, &only(&survey.weighed, &everywhere));
        let part = SUMMED * request.tolerance;
        (beside.precision, beside.rounding) = if exact { (floats, bounds.double) } else { bounds.within(part) };
        if beside.precision == Precision::Double && !request.doubles {
            return None;
        }
        beside.layers.push(Layer::direct(everywhere));
    }
    if !reaching.is_empty() {
        let left_over = request.tolerance - survey.weighed.dropped_error - beside.rounding - stored;
        let part = match (series, exact) {
            (true, false) => LOCAL * request.tolerance,
            (true, true) => LOCAL * left_over,
            (false, _) => LOCAL_ALONE * left_over,
        };
        survey.effort.spend(local::work(reaching.iter().map(|group| group.ghosts).sum())).ok()?;
        let given = if exact { Some(floats) } else { (!request.doubles).then_some(Precision::Single) };
        let own = if exact { (part, 0.0) } else { (part, STORED) };
        let bounded = local::layer(problem, &survey.weighed, &reaching, own, given, request.loop_rounds).ok()?;
        // The first layer gives the plan its name.
        beside.layers.insert(0, Layer::Local(bounded.local));
        (beside.rounding, beside.cut) = (beside.rounding + bounded.rounding, bounded.cut);
    }
    if !series {
        return Some(Apart::Sums(Box::new(sums(problem, survey, beside, request))));
    }
    let weighed = only(&survey.weighed, &left);
    let reaches = period::reaches(problem, &weighed);
    let (effort, prepared) = (survey.effort.clone(), survey.prepared.clone());
    Some(Apart::Series(Box::new(Survey { weighed, groups: left, reaches, beside, effort, prepared })))
}

/// The plan of layers without a series.
fn sums(problem: &Arc<Problem>, survey: &Survey, beside: Beside, request: &Request) -> Plan {
    let Beside { layers, precision, rounding, cut, exact } = beside;
    let weighed = &survey.weighed;
    let rounding = if exact { rounding + STORED } else { rounding };
    let storage = if exact { STORED } else { (HALF_A_UNIT * layers.len() as f64).min(rounding) };
    let predicted = Prediction {
        dropped: weighed.dropped_error,
        cut,
        rounding: rounding - storage,
        storage,
        ..Prediction::default()
    };
    made(problem, weighed, request, layers, precision, predicted)
}

/// The weights of these groups' ghosts alone.
fn only(weighed: &Weighed, groups: &[Group]) -> Weighed {
    let mut weights = vec![0.0; weighed.weights.len()];
    for &member in groups.iter().flat_map(|group| group.members.iter()) {
        weights[member as usize] = weighed.weights[member as usize];
    }
    let Weighed { scale, peaks, nearest, dropped, dropped_error, .. } = weighed;
    Weighed {
        scale: *scale,
        peaks: peaks.clone(),
        weight: weights.iter().sum(),
        weights,
        images: Vec::new(),
        nearest: nearest.clone(),
        dropped: *dropped,
        dropped_error: *dropped_error,
    }
}

/// How a group is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Way {
    Series,
    /// Summed at every pixel.
    Everywhere,
    /// Summed where it reaches.
    Reaching,
}

/// A cut: the way of each group, and whether what is left is a series or summed at every pixel.
struct Cut {
    ways: Vec<Way>,
    series: bool,
}

/// What is known of the groups before they are cut.
struct Cutting<'a> {
    groups: &'a [Group],
    frame: Frame,
    model: &'a CostModel,
    floats: Precision,
    period: DVec2,
    /// The modes that each of them needs; none where no series can have it.
    needs: Vec<Option<Vec<u32>>>,
    /// What each of them costs where it reaches, in nanoseconds.
    reaching: Vec<f64>,
}

impl<'a> Cutting<'a> {
    /// None where looking at the groups costs too much.
    fn new(problem: &Problem, survey: &'a Survey, request: &'a Request, floats: Precision) -> Option<Self> {
        let (groups, model) = (&survey.groups[..], &request.cost_model);
        if groups.len() < 2 {
            return None;
        }
        let period = period::shortest(&survey.reaches, request.tolerance * share::PERIODISATION);
        let part = request.tolerance * share::TRUNCATION / groups.len() as f64;
        survey.prepare().ok()?;
        let mut needs = Vec::with_capacity(groups.len());
        for group in groups {
            let decay = Decay::new(group, period);
            survey.effort.expect(decay.expected_work(part / group.weight)).ok()?;
            let kept = decay.kept(part / group.weight).ok();
            survey.effort.spend(decay.work(kept.as_deref().map_or([0.0; 2], terms::harmonics))).ok()?;
            needs.push(kept);
        }
        let level = LOCAL * request.tolerance / CROWDING;
        let reaching = groups.iter().map(|group| {
            let reached = local::reached_by(problem, &survey.weighed, group, level);
            cost::reaching(group, reached, floats, model)
        });
        let reaching = reaching.collect();
        Some(Self { groups, frame: problem.frame(), model, floats, period, needs, reaching })
    }

    /// The cheapest cut, where that is cheaper than any single evaluator.
    fn cheapest(&self) -> Option<Cut> {
        let mut order: Vec<usize> = (0..self.groups.len()).collect();
        let terms = |index: usize| {
            self.needs[index].as_ref().map_or(u64::MAX, |counts| counts.iter().map(|&c| u64::from(c)).sum())
        };
        order.sort_by_key(|&index| std::cmp::Reverse(terms(index)));
        let (series, rest) = (self.series(&order), self.rest(&order));
        let all_reaching = self.reaching.iter().sum::<f64>() + self.canvas();
        let whole = series[0].min(rest[0]).min(all_reaching);
        let mut summed = Summed::default();
        let (mut least, mut best) = (WORTH_IT * whole, None);
        for cut in 1..=order.len() {
            self.add(&mut summed, order[cut - 1]);
            let (series, rest) = (series[cut], rest[cut]);
            let cost = self.cost(&summed) + series.min(rest);
            if cost < least {
                (least, best) = (cost, Some((cut, series <= rest && cut < order.len())));
            }
        }
        let (cut, series) = best?;
        let mut ways = vec![Way::Series; order.len()];
        order[..cut].iter().for_each(|&index| ways[index] = self.way(index));
        Some(Cut { ways, series })
    }

    /// What all that is left after each cut costs at every pixel, in nanoseconds.
    fn rest(&self, order: &[usize]) -> Vec<f64> {
        let mut costs = vec![0.0; order.len() + 1];
        let mut summed = cost::Summed::default();
        for (cut, &index) in order.iter().enumerate().rev() {
            summed.add(&self.groups[index], self.floats);
            costs[cut] = summed.nanoseconds(self.frame, self.model);
        }
        costs
    }

    /// What a series of all that is left after each cut is estimated to cost, in nanoseconds; infinite where there is none.
    fn series(&self, order: &[usize]) -> Vec<f64> {
        let mut costs = vec![f64::INFINITY; order.len() + 1];
        costs[order.len()] = 0.0;
        let (mut union, mut spectrum) = (vec![1u32], 0.0);
        for (cut, &index) in order.iter().enumerate().rev() {
            let Some(needed) = &self.needs[index] else { break };
            union.resize(union.len().max(needed.len()), 1);
            union.iter_mut().zip(needed).for_each(|(count, &needed)| *count = needed.max(*count));
            let degree = [needed.len() as u32 - 1, needed[0] - 1];
            let group = Group { degree, members: Arc::default(), ..self.groups[index].clone() };
            spectrum += gather::likely(&group, self.model);
            costs[cut] = spectrum + cheapest_field(&union, self.period, self.frame, self.floats, self.model);
        }
        costs
    }

    /// Whether a group is cheaper where it reaches, or at every pixel.
    fn way(&self, index: usize) -> Way {
        let everywhere = cost::direct([&self.groups[index]], self.floats, self.frame, self.model);
        if self.reaching[index] <= everywhere { Way::Reaching } else { Way::Everywhere }
    }

    /// What a local layer costs however few its ghosts are.
    fn canvas(&self) -> f64 {
        let doubles = match self.floats {
            Precision::Single => 0.0,
            Precision::Double => cost::doubles_canvas(self.frame, self.model),
        };
        cost::local([], 0.0, Precision::Single, self.frame, self.model) + doubles
    }

    fn add(&self, summed: &mut Summed, index: usize) {
        match self.way(index) {
            Way::Reaching => summed.reaching = Some(summed.reaching.unwrap_or(0.0) + self.reaching[index]),
            _ => summed.everywhere.get_or_insert_default().add(&self.groups[index], self.floats),
        }
    }

    fn cost(&self, summed: &Summed) -> f64 {
        let reaching = summed.reaching.map_or(0.0, |reaching| reaching + self.canvas());
        reaching + summed.everywhere.map_or(0.0, |everywhere| everywhere.nanoseconds(self.frame, self.model))
    }
}

/// What was cut off, where there is any.
#[derive(Default)]
struct Summed {
    /// What reaching costs, in nanoseconds.
    reaching: Option<f64>,
    everywhere: Option<cost::Summed>,
}

/// What the field of so many terms is estimated to cost by the evaluator that is best at it, in nanoseconds.
fn cheapest_field(counts: &[u32], period: DVec2, frame: Frame, floats: Precision, model: &CostModel) -> f64 {
    let (low, high) = frame.bounds();
    let degree = [counts.len() as u32 - 1, counts[0] - 1];
    let around = degree.map(|degree| 2.0 * NODES * f64::from(degree.max(1)));
    let nodes = |k: usize| around[k] * (high - low)[k] / period[k] + 4.0;
    let size = cost::Size {
        terms: counts.iter().map(|&count| f64::from(count)).sum(),
        degree,
        nodes: [nodes(0), nodes(1)],
        around,
        on_cpu: false,
    };
    let size = if floats == Precision::Single { size.sooner(model) } else { size };
    let series = [Evaluator::Series, Evaluator::Rows, Evaluator::Grid];
    series
        .into_iter()
        .map(|evaluator| cost::field(evaluator, floats, &size, frame, model))
        .fold(f64::INFINITY, f64::min)
}
