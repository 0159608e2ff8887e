//! What is told of a veil that is only planned, and of any.

use serde::Serialize;

use super::{Prepared, predicted, raised, summed_by, terms, without_size};
use crate::choices::{Border, Projection};
use crate::frame::Frame;
use crate::look::{Look, Veil as Wanted};
use crate::photo::View;
use crate::psf::Parameters;
use crate::veil::Predicted;

/// What is scattered in a picture, and how that is taken to be formed.
#[derive(Debug, Clone, Serialize)]
pub struct VeilSeen {
    /// The function, and what it was given.
    #[serde(flatten)]
    pub parameters: Parameters,
    /// How the picture is taken to be formed.
    pub projection: Projection,
    /// Degrees across its width; none where the function is not in degrees.
    pub fov: Option<f64>,
    /// What that follows from, in words.
    pub fov_from: Option<String>,
    /// What lies beyond its edges.
    pub border: Border,
}

/// How a veil would be computed, and how exactly.
#[derive(Debug, Clone, Serialize)]
pub struct VeilPlanned {
    /// What it is of.
    #[serde(flatten)]
    pub seen: VeilSeen,
    /// The share of the light that is scattered, by strength and function, RGB.
    pub scattered: [f64; 3],
    /// Gaussians of the mixture.
    pub terms: usize,
    /// How it is summed: by a `pyramid` of Gaussians, on the `sphere`, by a `transform`, or by a `sum` of every source at every pixel.
    pub summed_by: String,
    /// The error relative to the local veil that it is held to.
    pub asked: f64,
    /// The bound of that error.
    pub predicted: f64,
    /// The part of it that is rounding.
    pub rounding: f64,
    /// Multiply-adds for each pixel and channel.
    pub operations: f64,
    /// Gaussians that are summed on the pixels.
    pub direct: usize,
    /// Gaussians that are summed on lattices of pitch 2, 4, 8, … pixels.
    pub lattices: Vec<usize>,
    /// Gaussians that this picture cannot show, and those that a small kernel takes.
    pub dropped: usize,
    /// How far that kernel reaches, in pixels.
    pub reach: f64,
    /// What a person ought to know: of a tolerance that could not be had, of a size that changes nothing.
    pub notes: Vec<String>,
}

impl VeilSeen {
    pub(super) fn new(wanted: &Wanted, frame: &Frame, view: Option<View>) -> Self {
        Self {
            parameters: wanted.section().parameters,
            projection: wanted.projection(),
            fov: view.as_ref().map(|view| view.across(frame, wanted.projection())),
            fov_from: view.map(|view| view.from),
            border: wanted.border,
        }
    }
}

impl VeilPlanned {
    pub(super) fn new(look: &Look, frame: &Frame, prepared: Prepared) -> Self {
        let Prepared { wanted, view, channels, asked, .. } = prepared;
        let wanted = &wanted;
        let Predicted { bound, rounding, operations, direct, lattices, dropped, reach } = predicted(&channels);
        Self {
            seen: VeilSeen::new(wanted, frame, view),
            scattered: wanted.psf().energies().map(|energy| look.strength * energy),
            terms: terms(&channels),
            summed_by: summed_by(&channels),
            asked,
            predicted: bound,
            rounding,
            operations,
            direct,
            lattices,
            dropped,
            reach,
            notes: raised(asked, wanted.tolerance()).into_iter().chain(without_size(look, wanted)).collect(),
        }
    }
}
