//! What a plan's field is the sum of.

use std::sync::Arc;

use glam::DVec2;

use super::{Evaluator, Group, Lattice, Local, Modes, Plate, Precision, Transform};
use crate::plate::Way;

/// A part of the field, with the way that it is computed.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// A Fourier series of the ghosts.
    Series(Series),
    /// The ghosts' bells themselves, summed at every pixel; groups of [`Transform::Direct`].
    Direct(Vec<Group>),
    /// The bells, each at the pixels that it reaches.
    Local(Local),
    /// Images of a whole photo, summed on the picture's own pixels.
    Plate(Plate),
}

impl Layer {
    /// A layer of ghosts that are summed at every pixel.
    pub fn direct(groups: impl IntoIterator<Item = Group>) -> Self {
        Self::Direct(groups.into_iter().map(|group| Group { transform: Transform::Direct, ..group }).collect())
    }

    /// Its ghosts.
    pub fn groups(&self) -> &[Group] {
        match self {
            Self::Series(series) => &series.groups,
            Self::Direct(groups) => groups,
            Self::Local(local) => &local.groups,
            Self::Plate(plate) => &plate.groups,
        }
    }

    /// How it is computed.
    pub fn evaluator(&self) -> Evaluator {
        match self {
            Self::Series(series) => series.evaluator,
            Self::Direct(_) => Evaluator::Direct,
            Self::Local(_) => Evaluator::Local,
            Self::Plate(_) => Evaluator::Plate,
        }
    }
}

/// A Fourier series: its period, its kept modes, and how it is evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// [`Evaluator::Series`], [`Evaluator::Rows`] or [`Evaluator::Grid`].
    pub evaluator: Evaluator,
    /// The floats in which it is computed, from the spectrum to the sum.
    pub precision: Precision,
    /// The period in x and y, in half picture heights.
    pub period: DVec2,
    /// How many harmonics of y are kept beside harmonic n of x; never growing, one at least.
    pub counts: Arc<[u32]>,
    /// The groups of ghosts, one part of the spectrum each.
    pub groups: Vec<Group>,
    /// The modes of all groups, where the plan has computed them: they become the spectrum, and no group has to be
    /// transformed again.
    pub modes: Option<Modes>,
    /// The lattice, where the evaluator is `grid`.
    pub lattice: Option<Lattice>,
}

impl Series {
    /// Highest harmonic in x and y.
    pub fn degree(&self) -> [u32; 2] {
        [self.counts.len() as u32 - 1, self.counts[0] - 1]
    }

    /// How many modes are kept.
    pub fn terms(&self) -> usize {
        self.counts.iter().map(|&count| count as usize).sum()
    }
}

/// A layer as reports tell of it.
#[derive(serde::Serialize)]
pub(super) struct Told {
    evaluator: Evaluator,
    #[serde(skip_serializing_if = "Option::is_none")]
    precision: Option<Precision>,
    ghosts: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    terms: Option<usize>,
    /// What a bell may be where it is left out, in units of the scale; and the pixels that all bells reach.
    #[serde(skip_serializing_if = "Option::is_none")]
    level: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reached: Option<f64>,
    /// How each image is summed.
    #[serde(skip_serializing_if = "Option::is_none")]
    ways: Option<Vec<Way>>,
}

impl From<&Layer> for Told {
    fn from(layer: &Layer) -> Self {
        let ghosts = layer.groups().iter().map(|group| group.ghosts).sum();
        let terms = if let Layer::Series(series) = layer { Some(series.terms()) } else { None };
        let precision = match layer {
            Layer::Series(series) => Some(series.precision),
            Layer::Local(local) => Some(local.precision),
            // That of the plan.
            Layer::Direct(_) => None,
            Layer::Plate(_) => Some(Precision::Double),
        };
        let local = if let Layer::Local(local) = layer { Some(local) } else { None };
        let (level, reached) = (local.map(|local| local.level), local.map(|local| local.reached));
        let ways = if let Layer::Plate(plate) = layer { Some(plate.ways().collect()) } else { None };
        Self { evaluator: layer.evaluator(), precision, ghosts, terms, level, reached, ways }
    }
}
