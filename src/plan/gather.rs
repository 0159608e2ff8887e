//! Whether a group's spectrum is summed ghost by ghost, or gathered from the moments of cells.

use glam::DVec2;
use rayon::prelude::*;

use super::decay::Decay;
use super::{CostModel, Group, Prediction, amplitudes, images, share, weigh};
use crate::raster::Reduction;
use crate::scene::Ghost;
use crate::series::Bell;
use crate::series::moments::{Cells, Grid, Point, Sizes, Sums, order_within, sizes_within};

/// How the spectrum of a group comes about.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(tag = "by", rename_all = "lowercase")]
pub enum Transform {
    /// Every ghost meets every mode, on the device.
    Dispatch,
    /// Every ghost meets the moments of its cell, on the CPU, and the moments meet the modes: `series::moments`.
    Gather(Gathering),
    /// Every pixel of the photo makes them, on the CPU: the photo's own waves, from its moments.
    Photo(Reduction),
    /// Not at all: the ghosts are summed at every pixel, or where they reach.
    Direct,
}

/// How ghosts are gathered: those of one size, which their bell's coefficients multiply afterwards, or Gaussians of several, each
/// as so many of a few sizes.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Gathering {
    /// By what.
    #[serde(flatten)]
    pub by: Gatherer,
    /// How many sizes stand for all.
    pub sizes: u32,
}

/// What ghosts are gathered by.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Gatherer {
    /// The moments of cells: few harmonics.
    Cells(Cells),
    /// A transform of what is spread over a lattice: many.
    Grid(Grid),
}

impl Transform {
    /// What a gathered ghost has to do, in moments: its own, and what it takes to find its cell and its polynomials.
    pub fn moments(&self) -> f64 {
        match self {
            Self::Dispatch | Self::Direct | Self::Photo(_) => 0.0,
            Self::Gather(Gathering { by, sizes }) => {
                let moments = match by {
                    Gatherer::Cells(Cells { orders, .. }) => orders.iter().map(|&order| f64::from(order)).product(),
                    Gatherer::Grid(grid) => grid.work()[0],
                };
                f64::from(*sizes) * (EACH + moments)
            }
        }
    }
}

impl Gathering {
    /// For each of the sizes that stand for all of a group's, the sums over its ghosts of the phases of every mode up to the
    /// group's degree, with their weights in units of the scale.
    pub fn sums(&self, ghosts: &[Ghost], group: &Group, period: DVec2, scale: [f64; 3]) -> Vec<(DVec2, Vec<Sums>)> {
        let sizes = Sizes::new(group.smallest, group.largest, self.sizes);
        let of = |k: usize| &ghosts[group.members[k] as usize];
        let count = group.members.len();
        let each = self.sizes as usize;
        let mut weights = vec![[0.0; 3]; count * each];
        weights.par_chunks_exact_mut(each).with_min_len(CHUNK).enumerate().for_each(|(k, weights)| {
            let whole = weigh::weight(of(k), scale);
            let shares = sizes.weights(of(k).size);
            weights.iter_mut().zip(shares).for_each(|(to, share)| *to = whole.map(|whole| share * whole));
        });
        let turns = |k: usize| {
            let turns = of(k).center / period;
            (turns - turns.floor()).to_array()
        };
        let weight = |k: usize, size: usize| weights[k * each + size];
        let sums = match &self.by {
            Gatherer::Grid(grid) => grid.sums([count, each], turns, weight, group.degree),
            Gatherer::Cells(cells) => {
                let point = |k: usize, size: usize| Point { turns: turns(k), weight: weight(k, size) };
                let one = |size: usize| cells.sums(count, |k| point(k, size), group.degree);
                (0..each).map(one).collect()
            }
        };
        sizes.sizes().zip(sums).collect()
    }
}

/// Ghosts that one task shares out between sizes.
const CHUNK: usize = 1 << 10;

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
    for group in groups.iter_mut().filter(|group| group.transform == Transform::Dispatch) {
        let dispatch = cost(group, &Transform::Dispatch, model);
        if dispatch >= FEW * model.pass
            && let Some((gathering, error)) = cheaper(group, period, part, model, dispatch)
        {
            group.transform = Transform::Gather(gathering);
            added += error;
        }
    }
    added
}

/// Chooses for the groups of a series whose modes are computed on the CPU, within a budget, where a ghost takes so many
/// nanoseconds for a mode; and gives the error that this adds.
pub(super) fn choose_in_doubles(groups: &mut [Group], period: DVec2, budget: f64, each: f64) -> f64 {
    let part = budget / groups.len().max(1) as f64;
    let model = CostModel { pass: 0.0, ..CostModel::default() };
    let mut added = 0.0;
    for group in
        groups.iter_mut().filter(|group| group.bell == Bell::Gaussian && group.transform == Transform::Dispatch)
    {
        let modes = group.degree.map(|degree| f64::from(degree + 1));
        // Half of the rectangle is kept.
        let otherwise = 0.5 * each * group.ghosts as f64 * modes[0] * modes[1];
        if otherwise >= FEW * CostModel::default().pass
            && let Some((gathering, error)) = cheaper(group, period, part, &model, otherwise)
        {
            group.transform = Transform::Gather(gathering);
            added += error;
        }
    }
    added
}

/// What the spectrum of a group is likely to cost at least, in nanoseconds, before anyone knows how it comes about.
pub(super) fn likely(group: &Group, model: &CostModel) -> f64 {
    // Sizes, moments along an axis, and cells along one for each harmonic.
    const SIZES: f64 = 10.0;
    const MOMENTS: f64 = 8.0;
    let dispatch = cost(group, &Transform::Dispatch, model).min(looked_at(group));
    let sizes = if group.smallest == group.largest { 1.0 } else { SIZES };
    let alike = sizes == 1.0 || group.bell == Bell::Gaussian && group.proportional;
    if group.ghosts < FEWEST || !alike || dispatch < FEW * model.pass {
        return dispatch;
    }
    let [n, m] = group.degree.map(|degree| f64::from(degree + 1));
    let spread = (group.ghosts as f64).min(n * m) * n * (MOMENTS + 4.0) * MOMENTS + 4.0 * m * n * m * MOMENTS;
    let gathered = group.ghosts as f64 * (EACH + MOMENTS * MOMENTS) + spread;
    dispatch.min(sizes * (model.moment * gathered + model.pass))
}

/// The way that is cheapest for a group, and the error that it leaves; none where it is not cheaper than so many nanoseconds.
fn cheaper(group: &Group, period: DVec2, budget: f64, model: &CostModel, otherwise: f64) -> Option<(Gathering, f64)> {
    let alike = group.smallest == group.largest || group.bell == Bell::Gaussian && group.proportional;
    if group.ghosts < FEWEST || !alike {
        return None;
    }
    // A part for the sizes, where there are several.
    let (sizes, off) = sizes_within(group.smallest, group.largest, 0.3 * budget / group.weight)?;
    let left = budget - off * group.weight;
    // Every mode is off by its coefficient times what its waves are, so the field by the sum of them.
    let [held, _] = Decay::new(group, period).marginals(group.degree);
    let gain = Sizes::gain(sizes) * group.weight * held.iter().sum::<f64>();
    let gain = Some(gain).filter(|gain| gain.is_finite())?;
    // Half of it for each axis, and a little for their product.
    let each = 0.49 * (left / gain).min(0.05);
    let axis = |degree: u32| candidates(degree).map(move |count| (count, order_within(degree, count, each)));
    let (mut best, mut least) = (None, otherwise);
    let grid = Gathering { by: Gatherer::Grid(Grid::within(group.degree, each)), sizes };
    let of_grid = cost(group, &Transform::Gather(grid), model);
    if of_grid < least {
        (best, least) = (Some(grid), of_grid);
    }
    for (count_x, order_x) in axis(group.degree[0]) {
        for (count_y, order_y) in axis(group.degree[1]).filter(|(count_y, _)| count_x * count_y <= MOST_CELLS) {
            let cells = Cells { counts: [count_x, count_y], orders: [order_x, order_y] };
            let gathering = Gathering { by: Gatherer::Cells(cells), sizes };
            let cost = cost(group, &Transform::Gather(gathering), model);
            if cost < least {
                (best, least) = (Some(gathering), cost);
            }
        }
    }
    best.map(|gathering| {
        let error = match gathering.by {
            Gatherer::Cells(cells) => cells.error(group.degree),
            Gatherer::Grid(grid) => grid.error(group.degree),
        };
        (gathering, off * group.weight + gain * error)
    })
}

/// Numbers of cells along an axis that are worth a try: from a few harmonics a cell to a few cells a harmonic.
fn candidates(degree: u32) -> impl Iterator<Item = u32> {
    let counts = (-4..=7).map(move |step| (f64::from(degree.max(1)) * 2f64.powf(0.5 * f64::from(step))).ceil());
    counts.map(|count| count as u32)
}

/// What a core takes for a multiply-add of a transform, in nanoseconds.
const ADDED: f64 = 0.8;

/// What a nanosecond of a core takes on those that there are.
const CORES: f64 = 0.5;

/// What the spectrum of a group costs where the plan has looked at its modes, of each ghost by itself, in nanoseconds.
pub(super) fn looked_at(group: &Group) -> f64 {
    // Half of the rectangle.
    let modes: f64 = group.degree.iter().map(|&degree| f64::from(degree + 1)).product();
    0.5 * CORES * modes * (group.ghosts as f64 * amplitudes::MODE + group.bell.shape().modes().work())
}

/// What the spectrum of a group costs, in nanoseconds.
pub(super) fn cost(group: &Group, transform: &Transform, model: &CostModel) -> f64 {
    let modes = group.degree.map(|degree| f64::from(degree + 1));
    let ghosts = group.ghosts as f64;
    match transform {
        Transform::Direct => 0.0,
        Transform::Photo(reduction) => images::cost(group, *reduction),
        // What is tabulated the CPU computes before, of half of the rectangle.
        Transform::Dispatch => {
            let tables = 0.5 * group.bell.shape().modes().work() * CORES;
            modes[0] * modes[1] * (ghosts * model.spectrum + tables)
        }
        Transform::Gather(Gathering { by: Gatherer::Grid(grid), sizes }) => {
            let transformed = f64::from(*sizes) * (CORES * ADDED * grid.work()[1] + model.pass);
            model.moment * ghosts * transform.moments() + transformed
        }
        Transform::Gather(Gathering { by: Gatherer::Cells(cells), sizes }) => {
            let ([x, y], [p, q]) = (cells.counts.map(f64::from), cells.orders.map(f64::from));
            let sizes = f64::from(*sizes);
            // Then along x for each cell that has a ghost, and along y for each row of them: four sums of products.
            let spread = ghosts.min(x * y) * modes[0] * (p + 4.0) * q + 4.0 * ghosts.min(y) * modes[0] * modes[1] * q;
            model.moment * (ghosts * transform.moments() + sizes * spread) + sizes * model.pass
        }
    }
}
