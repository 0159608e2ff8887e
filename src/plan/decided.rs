//! The plan itself: what was decided, by whom it can be read and told.

use std::sync::Arc;

use glam::DVec2;
use serde::{Serialize, Serializer};

use super::layer::Told;
use super::modes::Mode;
use super::{
    Cost, Evaluator, Group, Lattice, Layer, Local, Modes, Plate, Precision, Prediction, Refusal, Series, amplitudes,
};
use crate::problem::Problem;

/// What was decided for a problem: the layers whose sum is the field, with the error and the cost that are expected.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    pub(super) problem: Arc<Problem>,
    pub(super) layers: Vec<Layer>,
    /// The tolerance that it was made for.
    pub tolerance: f64,
    /// The floats in which the summed ghosts are computed, where there are any.
    pub precision: Precision,
    /// The field's largest value or, where it is not known exactly, a lower bound of it, RGB; the field is computed in
    /// units of it, or of [`Plan::units`].
    pub scale: [f64; 3],
    /// Pixels, as columns and rows of the picture, at which the field was found large.
    pub peaks: Vec<[i32; 2]>,
    /// How many ghosts cannot reach the picture within the tolerance, and are left out.
    pub dropped: usize,
    /// The error that the plan expects at most.
    pub predicted: Prediction,
    /// The cost that the plan expects, and that of the evaluators it decided against, the cheapest first.
    pub costs: Vec<Cost>,
    /// The evaluators that could not be had, and why.
    pub refused: Vec<Refusal>,
}

impl Plan {
    /// A plan by hand, which promises nothing: these layers, in units of 1, at any error and any cost.
    ///
    /// The layers' groups name ghosts of the problem. The first series is the only one that is rendered, and the first sum.
    pub fn by_hand(problem: Arc<Problem>, layers: Vec<Layer>) -> Self {
        Self {
            problem,
            layers,
            tolerance: f64::INFINITY,
            precision: Precision::default(),
            scale: [1.0; 3],
            peaks: Vec::new(),
            dropped: 0,
            predicted: Prediction::default(),
            costs: Vec::new(),
            refused: Vec::new(),
        }
    }

    /// Whether any of its layers is computed in 64-bit floats; then all are added up in them, and rounded once.
    pub fn is_exact(&self) -> bool {
        self.layers.iter().any(|layer| match layer {
            Layer::Series(series) => series.precision == Precision::Double,
            Layer::Direct(groups) => self.precision == Precision::Double && !groups.is_empty(),
            Layer::Local(local) => local.precision == Precision::Double,
            Layer::Plate(_) => false,
        })
    }

    /// What the field is computed in units of on the device, RGB: its scale, or, where 64-bit floats compute it, the power of
    /// two below that, by which to multiply costs no rounding.
    pub fn units(&self) -> [f64; 3] {
        // Of numbers that f32 holds to its last digit.
        const SMALLEST: f64 = f32::MIN_POSITIVE as f64;
        let below = |scale: f64| f64::from_bits(scale.max(SMALLEST).to_bits() & !((1 << 52) - 1));
        if self.is_exact() { self.scale.map(below) } else { self.scale }
    }

    /// The modes that its series keeps in f64, in [`Plan::units`], harmonic by harmonic of x: those that it has computed, or else
    /// computed now, ghost by ghost.
    pub(crate) fn exact_modes(&self) -> Vec<Mode> {
        let Some(series) = self.series() else { return Vec::new() };
        let units = self.units();
        let Some(modes) = &series.modes else {
            return amplitudes::modes(&self.problem, &series.groups, &series.counts, series.period, units);
        };
        let ratio = [0, 1, 2].map(|colour| self.scale[colour] / units[colour]);
        let turned = |mode: Mode| [0, 1, 2].map(|colour| mode[colour].map(|term| term * ratio[colour]));
        modes.kept(&series.counts).map(turned).collect()
    }

    /// The same plan with its series changed by hand; what it predicts stays as it was.
    pub fn with_series(mut self, change: impl Fn(&mut Series)) -> Self {
        for layer in &mut self.layers {
            if let Layer::Series(series) = layer {
                let modes = series.modes.take();
                let (period, counts) = (series.period, series.counts.clone());
                change(series);
                series.modes = modes.filter(|_| series.period == period && series.counts == counts);
            }
        }
        self
    }

    /// The same plan with the groups of its series changed.
    pub(super) fn with_groups(mut self, change: impl Fn(&mut Group)) -> Self {
        for layer in &mut self.layers {
            if let Layer::Series(series) = layer {
                series.groups.iter_mut().for_each(&change);
            }
        }
        self
    }

    /// The same plan, its spectrum left to the device, ghost by ghost, even where the plan has computed it.
    pub fn without_modes(mut self) -> Self {
        for layer in &mut self.layers {
            if let Layer::Series(series) = layer {
                series.modes = None;
            }
        }
        self
    }

    /// What it solves.
    pub fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }

    /// The parts of the field.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// Its series, if it has one.
    pub fn series(&self) -> Option<&Series> {
        self.layers.iter().find_map(|layer| if let Layer::Series(series) = layer { Some(series) } else { None })
    }

    /// How the field is computed: by its series where it has one, whether ghosts are summed beside it or not; else by its
    /// first layer.
    pub fn evaluator(&self) -> Evaluator {
        let first = || self.layers.first().map_or(Evaluator::Direct, Layer::evaluator);
        self.series().map_or_else(first, |series| series.evaluator)
    }

    /// The series' period in x and y; 1 where there is no series.
    pub fn period(&self) -> DVec2 {
        self.series().map_or(DVec2::ONE, |series| series.period)
    }

    /// Highest harmonic in x and y.
    pub fn degree(&self) -> [u32; 2] {
        self.series().map_or([0; 2], Series::degree)
    }

    /// How many harmonics of y are kept beside harmonic n of x; none where there is no series.
    pub fn counts(&self) -> &[u32] {
        self.series().map_or(&[], |series| &series.counts)
    }

    /// How many modes the series keeps.
    pub fn terms(&self) -> usize {
        self.series().map_or(0, Series::terms)
    }

    /// The lattice, where the evaluator is `grid`.
    pub fn lattice(&self) -> Option<&Lattice> {
        self.series().and_then(|series| series.lattice.as_ref())
    }

    /// How long it took to compute the modes that become the spectrum, in milliseconds by the wall clock; 0 where the
    /// spectrum is left to the device.
    pub fn spectrum_milliseconds(&self) -> f64 {
        self.series().and_then(|series| series.modes.as_ref()).map_or(0.0, Modes::milliseconds)
    }

    /// The groups of all layers.
    pub fn groups(&self) -> impl Iterator<Item = &Group> {
        self.layers.iter().flat_map(Layer::groups)
    }

    /// How many ghosts the field is made of.
    pub fn ghosts(&self) -> usize {
        self.groups().map(|group| group.members.len()).sum()
    }

    /// What is left out of a photo's images; none where it has none.
    pub fn faint_images(&self) -> Option<Faint> {
        let images = self.problem.images()?;
        let mut kept = vec![false; images.all().len()];
        let of_layer = |layer: &Layer| matches!(layer, Layer::Plate(_));
        let of_photo = self
            .layers
            .iter()
            .flat_map(|layer| layer.groups().iter().filter(move |group| of_layer(layer) || group.is_of_photo()));
        of_photo.flat_map(|group| group.members.iter()).for_each(|&member| kept[member as usize] = true);
        let (mut light, mut all) = (0.0, 0.0);
        for (image, kept) in images.all().iter().zip(&kept) {
            let flux = images.gathered(image).flux().into_iter().map(f64::abs).sum::<f64>();
            all += flux;
            light += if *kept { 0.0 } else { flux };
        }
        let left = kept.iter().filter(|kept| !**kept).count();
        Some(Faint { images: left, of: kept.len(), light: if all > 0.0 { light / all } else { 0.0 } })
    }

    /// How many of them are summed directly at every pixel: all by `direct`, a few or none beside a series.
    pub fn summed(&self) -> usize {
        self.summed_groups().map(|group| group.members.len()).sum()
    }

    /// Its ghosts that are summed where they reach, if there are any.
    pub fn local(&self) -> Option<&Local> {
        self.layers.iter().find_map(|layer| if let Layer::Local(local) = layer { Some(local) } else { None })
    }

    /// Its plate, if there is one.
    pub fn plate(&self) -> Option<&Plate> {
        self.layers.iter().find_map(|layer| if let Layer::Plate(plate) = layer { Some(plate) } else { None })
    }

    /// The groups that are summed at every pixel.
    pub fn summed_groups(&self) -> impl Iterator<Item = &Group> {
        let summed = |layer: &&Layer| matches!(layer, Layer::Direct(_));
        self.layers.iter().filter(summed).flat_map(Layer::groups)
    }

    /// What it is expected to cost, in milliseconds.
    pub fn cost(&self) -> Option<f64> {
        self.costs.first().map(|cost| cost.milliseconds)
    }
}

/// Images of a photo that are too faint to show at the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Faint {
    /// How many are left out.
    pub images: usize,
    /// Of how many.
    pub of: usize,
    /// The part of the light of all of them that these have, 0 to 1.
    pub light: f64,
}

impl Serialize for Plan {
    /// By keys that scripts read.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Keys<'a> {
            tolerance: f64,
            evaluator: Evaluator,
            precision: Precision,
            period: DVec2,
            degree: [u32; 2],
            terms: usize,
            groups: Vec<&'a Group>,
            lattice: Option<&'a Lattice>,
            scale: [f64; 3],
            dropped: usize,
            #[serde(skip_serializing_if = "Option::is_none")]
            faint: Option<Faint>,
            predicted: &'a Prediction,
            costs: &'a [Cost],
            refused: &'a [Refusal],
            layers: Vec<Told>,
        }
        let Self { problem: _, layers, tolerance, precision, scale, peaks: _, dropped, predicted, costs, refused } =
            self;
        let keys = Keys {
            tolerance: *tolerance,
            evaluator: self.evaluator(),
            precision: *precision,
            period: self.period(),
            degree: self.degree(),
            terms: self.terms(),
            groups: self.groups().collect(),
            lattice: self.lattice(),
            scale: *scale,
            dropped: *dropped,
            faint: self.faint_images().filter(|faint| faint.images > 0),
            predicted,
            costs,
            refused,
            layers: layers.iter().map(Told::from).collect(),
        };
        keys.serialize(serializer)
    }
}
