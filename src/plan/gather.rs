//! Whether a group's spectrum is summed ghost by ghost, or gathered from the moments of cells.

use glam::DVec2;

use super::decay::Decay;
use super::{CostModel, Group, Prediction, share};
use crate::series::moments::{Cells, order_within};

/// How the spectrum of a group comes about.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(tag = "by", rename_all = "lowercase")]
pub enum Transform {
    /// Every ghost meets every mode, on the device.
    Dispatch,
    /// Every ghost meets the moments of its cell, on the CPU, and the moments meet the modes: `series::moments`. For
    /// ghosts of one size, which their bell's coefficients can multiply afterwards.
    Gather(Cells),
    /// Not at all: the ghosts are summed at every pixel, or where they reach.
    Direct,
}

impl Transform {
    /// What a gathered ghost has to do, in moments: its own, and what it takes to find its cell and its polynomials.
    pub fn moments(&self) -> f64 {
        match self {
            Self::Dispatch | Self::Direct => 0.0,
            Self::Gather(cells) => EACH + f64::from(cells.orders[0]) * f64::from(cells.orders[1]),
        }
    }
}

/// What a ghost costs in moments beside its own.
const EACH: f64 = 25.0;

/// Fewer ghosts than this are never worth the moments that their cells have.
const FEWEST: usize = 25;

/// Groups whose dispatches cost less than so many passes are not worth the thought.
const FEW: f64 = 10.0;

/// No period is cut into more cells: each has a list of its ghosts in every chunk of them.
const MOST_CELLS: u32 = 1 << 15;

/// Chooses for each group, within a part of the tolerance of which so much is predicted already; and gives the error that
/// this adds.
pub(super) fn choose(
    groups: &mut [Group],
    period: DVec2,
    tolerance: f64,
    predicted: &Prediction,
    model: &CostModel,
) -> f64 {
    let left = tolerance - predicted.total();
    let most = share::GATHERING * tolerance;
    // What was asked for by hand may be beyond the tolerance already; then this adds nothing that could be seen.
    let budget = if left > 0.0 { most.min(left) } else { most };
    let part = budget / groups.len().max(1) as f64;
    let mut added = 0.0;
    for group in groups {
        if let Some((cells, error)) = cheaper(group, period, part, model) {
            group.transform = Transform::Gather(cells);
            added += error;
        }
    }
    added
}

/// The cells that are cheapest for a group, and the error that they leave; none where a dispatch is cheaper.
fn cheaper(group: &Group, period: DVec2, budget: f64, model: &CostModel) -> Option<(Cells, f64)> {
    if group.ghosts < FEWEST {
        return None;
    }
    let dispatch = cost(group, &Transform::Dispatch, model);
    if group.smallest != group.largest || dispatch < FEW * model.pass {
        return None;
    }
    // Every mode is off by its coefficient times what its waves are, so the field by the sum of them.
    let [held, _] = Decay::new(group, period).marginals(group.degree);
    let gain = Some(group.weight * held.iter().sum::<f64>()).filter(|gain| gain.is_finite())?;
    // Half of it for each axis, and a little for their product.
    let each = 0.49 * (budget / gain).min(0.05);
    let axis = |degree: u32| candidates(degree).map(move |count| (count, order_within(degree, count, each)));
    let (mut best, mut least) = (None, dispatch);
    for (count_x, order_x) in axis(group.degree[0]) {
        for (count_y, order_y) in axis(group.degree[1]).filter(|(count_y, _)| count_x * count_y <= MOST_CELLS) {
            let cells = Cells { counts: [count_x, count_y], orders: [order_x, order_y] };
            let cost = cost(group, &Transform::Gather(cells), model);
            if cost < least {
                (best, least) = (Some(cells), cost);
            }
        }
    }
    best.map(|cells| (cells, gain * cells.error(group.degree)))
}

/// Numbers of cells along an axis that are worth a try: from a few harmonics a cell to a few cells a harmonic.
fn candidates(degree: u32) -> impl Iterator<Item = u32> {
    let counts = (-4..=7).map(move |step| (f64::from(degree.max(1)) * 2f64.powf(0.5 * f64::from(step))).ceil());
    counts.map(|count| count as u32)
}

/// What the spectrum of a group costs, in nanoseconds.
pub(super) fn cost(group: &Group, transform: &Transform, model: &CostModel) -> f64 {
    let modes = group.degree.map(|degree| f64::from(degree + 1));
    let ghosts = group.ghosts as f64;
    match transform {
        Transform::Direct => 0.0,
        Transform::Dispatch => ghosts * modes[0] * modes[1] * model.spectrum,
        Transform::Gather(cells) => {
            let ([x, y], [p, q]) = (cells.counts.map(f64::from), cells.orders.map(f64::from));
            // Then along x for each cell that has a ghost, and along y for each row of them: four sums of products.
            let spread = ghosts.min(x * y) * modes[0] * (p + 4.0) * q + 4.0 * ghosts.min(y) * modes[0] * modes[1] * q;
            model.moment * (ghosts * transform.moments() + spread) + model.pass
        }
    }
}
