//! What a person or a program asks of a plan.

use glam::DVec2;

use super::{CostModel, Evaluator};

/// Ghosts that a loop over many takes in one round.
pub(crate) const GHOSTS_A_ROUND: usize = 8;

/// What is asked of the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
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
    /// The most nodes that `grid`'s lattice may have along an axis: as many as a texture of the device has texels.
    pub most_nodes: u32,
    /// Rounds that the renderer runs a shader's loops for one pixel.
    pub loop_rounds: usize,
    /// Whether the device has 64-bit floats.
    pub doubles: bool,
    /// What each kind of work costs.
    pub cost_model: CostModel,
}

impl Request {
    /// A request that leaves everything but the tolerance to the plan.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            period: None,
            degree: None,
            evaluator: None,
            oversampling: None,
            most_terms: 2 << 20,
            // OpenGL 4.3 has no less.
            most_nodes: 16384,
            loop_rounds: usize::MAX,
            doubles: true,
            cost_model: CostModel::default(),
        }
    }
}
