//! Which ghosts a direct sum takes beside the series: a few small ones can ask for more terms than all the others.

use glam::DVec2;

use super::candidate::Survey;
use super::decay::Decay;
use super::weigh::Weighed;
use super::{CostModel, Evaluator, Group, Precision, Request, Transform, cost, direct, gather, period, share};
use crate::frame::Frame;
use crate::problem::Problem;

/// Ghosts that may be summed beside a series, at most.
const FEW: usize = 512;

/// What of the tolerance their rounding may take before they are summed in 64-bit floats.
const SUMMED: f64 = 0.1;

/// The others should cost less than this part of all of them, by the estimate, to be planned for.
const WORTH_IT: f64 = 0.9;

/// Nodes a half wave that a lattice is taken to have before it is planned.
const NODES: f64 = 1.6;

/// What is left for a series, and what is not, where that is likely to be cheaper than either a series or a direct sum of
/// all ghosts.
///
/// Groups go over in the order of the terms that they need: the union of all terms only shrinks with the neediest. How
/// many do is decided by bounds by weights, which are cheap; what comes of it is planned like any other candidate.
pub(super) fn apart(problem: &Problem, survey: &Survey, request: &Request) -> Option<Survey> {
    // Everything is to be a series, or in one period.
    if request.evaluator.is_some() || request.degree.is_some() || request.period.is_some() {
        return None;
    }
    let summed = neediest(survey, problem.frame(), request)?;
    let (mut left, mut moved) = (Vec::new(), Vec::new());
    for (index, group) in survey.groups.iter().enumerate() {
        if summed.contains(&index) { &mut moved } else { &mut left }.push(Group {
            transform: if summed.contains(&index) { Transform::Direct } else { group.transform },
            ..group.clone()
        });
    }
    let weighed = only(&survey.weighed, &left);
    let bounds = direct::bounds(problem, &only(&survey.weighed, &moved));
    let reaches = period::reaches(problem, &weighed);
    let (effort, prepared) = (survey.effort.clone(), survey.prepared.clone());
    let summed_in = bounds.within(SUMMED * request.tolerance);
    Some(Survey { weighed, groups: left, reaches, summed: moved, summed_in, effort, prepared })
}

/// The weights of these groups' ghosts alone.
fn only(weighed: &Weighed, groups: &[Group]) -> Weighed {
    let mut weights = vec![0.0; weighed.weights.len()];
    for &member in groups.iter().flat_map(|group| group.members.iter()) {
        weights[member as usize] = weighed.weights[member as usize];
    }
    Weighed { weight: weights.iter().sum(), weights, ..weighed.clone() }
}

/// The groups to be summed directly, by their indices; none where a series of all, or a sum of all, is estimated to be about
/// as cheap.
fn neediest(survey: &Survey, frame: Frame, request: &Request) -> Option<Vec<usize>> {
    let (groups, model) = (&survey.groups, &request.cost_model);
    let small = |group: &&Group| group.ghosts <= FEW;
    if groups.len() < 2 || !groups.iter().any(|group| small(&group)) {
        return None;
    }
    let period = period::shortest(&survey.reaches, request.tolerance * share::PERIODISATION);
    let part = request.tolerance * share::TRUNCATION / groups.len() as f64;
    // What no series can have is infinitely needy.
    let mut needs: Vec<Option<Vec<u32>>> = Vec::with_capacity(groups.len());
    survey.prepare().ok()?;
    for group in groups {
        let decay = Decay::new(group, period);
        let kept = decay.kept(part / group.weight).ok();
        survey.effort.spend(decay.work(kept.as_ref().map_or(0, |counts| counts.len() + counts[0] as usize))).ok()?;
        needs.push(kept);
    }
    let terms =
        |index: usize| needs[index].as_ref().map_or(u64::MAX, |counts| counts.iter().map(|&c| u64::from(c)).sum());
    let mut order: Vec<usize> = (0..groups.len()).collect();
    order.sort_by_key(|&index| std::cmp::Reverse(terms(index)));
    let estimate = |moved: usize| -> Option<f64> {
        let (summed, left) = order.split_at(moved);
        let summed = cost::direct(summed.iter().map(|&index| &groups[index]), Precision::Single, frame, model);
        let mut counts = vec![1u32];
        for &index in left {
            let needed = needs[index].as_ref()?;
            counts.resize(counts.len().max(needed.len()), 1);
            for (count, &needed) in counts.iter_mut().zip(needed) {
                *count = needed.max(*count);
            }
        }
        let series = left.iter().map(|&index| {
            let needed = needs[index].as_ref().map_or([0; 2], |counts| [counts.len() as u32 - 1, counts[0] - 1]);
            gather::cost(&Group { degree: needed, ..groups[index].clone() }, &Transform::Dispatch, model)
        });
        Some(series.sum::<f64>() + cheapest_field(&counts, period, frame, model) + summed)
    };
    let most = order.iter().scan(0, |sum, &index| {
        *sum += groups[index].ghosts;
        (*sum <= FEW).then_some(())
    });
    // The last group stays: all of them are `direct` itself.
    let most = most.count().min(groups.len() - 1);
    let direct = cost::direct(groups, Precision::Single, frame, model);
    let whole = estimate(0).map_or(direct, |series| series.min(direct));
    let costs = (1..=most).filter_map(|moved| Some((estimate(moved)?, moved)));
    let (least, moved) = costs.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (least < WORTH_IT * whole).then(|| order[..moved].to_vec())
}

/// What the field of so many terms is estimated to cost by the evaluator that is best at it, in nanoseconds.
fn cheapest_field(counts: &[u32], period: DVec2, frame: Frame, model: &CostModel) -> f64 {
    let (low, high) = frame.bounds();
    let degree = [counts.len() as u32 - 1, counts[0] - 1];
    let nodes = |k: usize| 2.0 * NODES * f64::from(degree[k].max(1)) * (high - low)[k] / period[k] + 4.0;
    let size =
        cost::Size { terms: counts.iter().map(|&count| f64::from(count)).sum(), degree, nodes: [nodes(0), nodes(1)] };
    let series = [Evaluator::Series, Evaluator::Rows, Evaluator::Grid];
    series.into_iter().map(|evaluator| cost::field(evaluator, &size, frame, model)).fold(f64::INFINITY, f64::min)
}
