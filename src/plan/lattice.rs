//! The coarsest lattice that a B-spline can carry the series on.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::amplitudes::{Rgb, largest};
use super::decay::Decay;
use super::{Group, Precision, Request};
use crate::fast_length::fast_length;
use crate::frame::Frame;
use crate::series::{CUBIC, spline_error_of};
use crate::{Error, Result};

/// Nodes a half wave of the highest harmonic that are tried: from barely enough to plenty.
const SPARSEST: f64 = 1.02;
const DENSEST: f64 = 64.0;

/// Nodes that a pixel's B-spline has along each axis where 64-bit floats ask for more digits: with as high a power of the step
/// the error falls.
pub(crate) const DOUBLE_ORDER: u32 = 8;

/// The same in floats of a precision.
pub(super) fn order_in(precision: Precision) -> u32 {
    match precision {
        Precision::Single => CUBIC,
        Precision::Double => DOUBLE_ORDER,
    }
}

/// A lattice over the window of a picture. Node (k, k) with k = order / 2 − 1 lies on the top left pixel; nodes count rightwards
/// and downwards.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Lattice {
    /// Nodes that a pixel's B-spline has along each axis: 4 for a cubic one.
    pub order: u32,
    /// Distance from node to node along x and y.
    pub step: DVec2,
    /// Nodes along x and y.
    pub nodes: [u32; 2],
    /// Nodes a half wave of the highest harmonic: the oversampling.
    pub oversampling: DVec2,
    /// Whether the CPU's cores sum the series at the nodes, so many of which make a period that transforms do it.
    pub on_cpu: bool,
    /// A bound of the interpolation's error, relative to the field's largest value.
    #[serde(skip)]
    pub error: f64,
}

/// What each harmonic along each axis may hold, relative to the field's largest value.
pub(super) struct Marginals([Vec<Rgb>; 2]);

impl Marginals {
    /// Known from the amplitudes of all modes.
    pub fn of(held: [Vec<Rgb>; 2]) -> Self {
        Self(held)
    }

    /// As if all ghosts stood at one place.
    pub fn by_weights(groups: &[Group], degree: [u32; 2], period: DVec2) -> Self {
        let mut sums = degree.map(|degree| vec![0.0; degree as usize + 1]);
        for group in groups {
            let held = Decay::new(group, period).marginals(group.degree);
            for (sums, held) in sums.iter_mut().zip(held) {
                for (sum, held) in sums.iter_mut().zip(held) {
                    *sum += group.weight * held;
                }
            }
        }
        Self(sums.map(|sums| sums.into_iter().map(|sum| [sum; 3]).collect()))
    }

    /// A bound of the interpolation's error along an axis, with θ from node to node for the first harmonic.
    fn error(&self, order: u32, axis: usize, theta: f64) -> f64 {
        let harmonics = (1..).zip(self.0[axis].iter().skip(1));
        let sum = harmonics.fold([0.0; 3], |sum, (n, held)| {
            let error = spline_error_of(order, f64::from(n) * theta);
            [0, 1, 2].map(|colour| sum[colour] + held[colour] * error)
        });
        largest(sum)
    }

    /// The fewest nodes a half wave of the highest harmonic along an axis within the budget.
    fn least(&self, order: u32, axis: usize, degree: u32, budget: f64) -> f64 {
        let (mut low, mut high) = (SPARSEST, DENSEST);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            let theta = PI / (middle * f64::from(degree.max(1)));
            if self.error(order, axis, theta) > budget { low = middle } else { high = middle }
        }
        high
    }
}

/// The coarsest lattice whose interpolation stays within the budget, or the one of the oversampling that is asked for.
///
/// # Errors
/// [`Error::Plan`] where it would have more nodes along an axis than the request allows, or where the oversampling is too little for a
/// spline.
pub(super) fn coarsest(
    precision: Precision,
    degree: [u32; 2],
    period: DVec2,
    marginals: &Marginals,
    frame: Frame,
    budget: f64,
    request: &Request,
) -> Result<Lattice> {
    let Request { oversampling, most_nodes: most, .. } = *request;
    if let Some(nodes) = oversampling.filter(|nodes| !(SPARSEST..=f64::MAX).contains(nodes)) {
        return Err(Error::Plan(format!("{nodes} nodes a half wave are fewer than {SPARSEST}")));
    }
    let order = order_in(precision);
    let (low, high) = frame.bounds();
    let extent = high - low;
    // The other axis adds about as much, and their product a little.
    let part = 0.49 * budget;
    let along = |axis: usize, period: f64| {
        let over = oversampling.unwrap_or_else(|| marginals.least(order, axis, degree[axis], part));
        step(degree[axis], period, over)
    };
    let (step_x, over_x) = along(0, period.x);
    let (step_y, over_y) = along(1, period.y);
    let nodes = |extent: f64, step: f64| (extent / step).floor().min(f64::from(u32::MAX - order)) as u32 + order;
    let step = DVec2::new(step_x, step_y);
    let nodes = [nodes(extent.x, step_x), nodes(extent.y, step_y)];
    if nodes.iter().any(|&nodes| nodes > most) {
        let [x, y] = nodes;
        return Err(Error::Plan(format!(
            "a lattice of {x} x {y} nodes is beyond the {most} a side that a texture of this device has; series and rows \
             need none"
        )));
    }
    let theta = TAU * step / period;
    let (x, y) = (marginals.error(order, 0, theta.x), marginals.error(order, 1, theta.y));
    Ok(Lattice { order, step, nodes, oversampling: DVec2::new(over_x, over_y), on_cpu: false, error: x + y + x * y })
}

/// The step from node to node for at least so many nodes a half wave of the highest harmonic, of which so many make a period that
/// transforms of it are quick; and how many a half wave these are.
fn step(degree: u32, period: f64, oversampling: f64) -> (f64, f64) {
    // A constant's are as good as any.
    let half_waves = 2.0 * f64::from(degree.max(1));
    let around = fast_length((oversampling * half_waves).ceil() as usize) as f64;
    (period / around, around / half_waves)
}
