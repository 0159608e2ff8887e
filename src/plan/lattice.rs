//! The coarsest lattice that a cubic B-spline can carry the series on.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::terms::Group;
use super::{Plan, periodised_peak};
use crate::frame::Frame;
use crate::series::spline_error;
use crate::{Error, Result};

/// Nodes a half wave of the highest harmonic that are tried: from barely enough to plenty.
const SPARSEST: f64 = 1.02;
const DENSEST: f64 = 64.0;

/// Most nodes along an axis: places on the lattice are kept in 32 bits, 12 of them for whole nodes.
pub const MOST_NODES: u32 = 4000;

/// A lattice over the window of a picture. Node (1, 1) lies on the top left pixel; nodes count rightwards and downwards.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Lattice {
    /// Distance from node to node along x and y.
    pub step: DVec2,
    /// Nodes along x and y.
    pub nodes: [u32; 2],
    /// Nodes a half wave of the highest harmonic: the oversampling.
    pub oversampling: DVec2,
    /// A bound of the interpolation's error, relative to the field's largest value.
    #[serde(skip)]
    pub error: f64,
}

/// The coarsest lattice whose interpolation stays within the budget.
///
/// # Errors
/// [`Error::Plan`] where it would have more than [`MOST_NODES`] along an axis.
pub(super) fn coarsest(plan: &Plan, frame: Frame, budget: f64) -> Result<Lattice> {
    let (low, high) = frame.bounds();
    let extent = high - low;
    let axis = |degree: u32, period: f64, extent: f64, size: fn(DVec2) -> f64, which: usize| {
        if degree == 0 {
            // A constant: any step will do.
            return (extent.max(period), DENSEST);
        }
        let error = |oversampling: f64| -> f64 {
            let theta = PI / (oversampling * f64::from(degree));
            let one = |group: &Group| group.weight * axis_error(group, size, period, group.degree[which], theta);
            plan.groups.iter().map(one).sum()
        };
        // The other axis adds about as much, and their product a little.
        let part = 0.49 * budget;
        let (mut low, mut high) = (SPARSEST, DENSEST);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if error(middle) > part { low = middle } else { high = middle }
        }
        (period / (2.0 * high * f64::from(degree)), high)
    };
    let (step_x, over_x) = axis(plan.degree[0], plan.period.x, extent.x, |v| v.x, 0);
    let (step_y, over_y) = axis(plan.degree[1], plan.period.y, extent.y, |v| v.y, 1);
    let nodes = |extent: f64, step: f64| (extent / step).floor() as u32 + 4;
    let mut lattice = Lattice {
        step: DVec2::new(step_x, step_y),
        nodes: [nodes(extent.x, step_x), nodes(extent.y, step_y)],
        oversampling: DVec2::new(over_x, over_y),
        error: 0.0,
    };
    lattice.error = error(plan, &lattice);
    if lattice.nodes.iter().any(|&nodes| nodes > MOST_NODES) {
        let [x, y] = lattice.nodes;
        return Err(Error::Plan(format!(
            "a lattice of {x} x {y} nodes is beyond {MOST_NODES} a side; rows needs none"
        )));
    }
    Ok(lattice)
}

/// A bound of the interpolation's error: of each axis, and of one on top of the other.
fn error(plan: &Plan, lattice: &Lattice) -> f64 {
    let theta = TAU * lattice.step / plan.period;
    let one = |group: &Group| {
        let size = group.smallest / plan.period;
        let [peak_x, peak_y] = [size.x, size.y].map(|size| periodised_peak(group.bell, size));
        let x = axis_error(group, |v| v.x, plan.period.x, group.degree[0], theta.x);
        let y = axis_error(group, |v| v.y, plan.period.y, group.degree[1], theta.y);
        group.weight * (x * peak_y + y * peak_x + x * y)
    };
    plan.groups.iter().map(one).sum()
}

/// Σ 2α_n e(nθ) over a group's harmonics along one axis, for a bell of peak 1; the smallest size has the most of it.
fn axis_error(group: &Group, size: fn(DVec2) -> f64, period: f64, degree: u32, theta: f64) -> f64 {
    let (shape, size) = (group.bell.shape(), size(group.smallest) / period);
    (1..=degree).map(|n| 2.0 * shape.coefficient(n, size) * spline_error(f64::from(n) * theta)).sum()
}
