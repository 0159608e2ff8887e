//! One thing that was measured: a row of results.csv.

use serde::Serialize;

use super::bench::Timing;
use super::sample::Quality;
use crate::Error;
use crate::frame::Frame;
use crate::job::Trial;
use crate::plan::{Evaluator, Plan};

/// What was varied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Sweep {
    /// The tolerance, for each evaluator and for the planner's own choice.
    Tolerance,
    /// The degree, in a fixed period.
    Degree,
    /// The nodes of `grid`'s lattice.
    Oversampling,
    /// The format of the spectrum's terms.
    Storage,
    /// The number of ghosts.
    Ghosts,
    /// The picture's size.
    Size,
    /// The tolerance of the veil, relative to the veil at each pixel.
    Veil,
}

/// How the spectrum's terms are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Storage {
    /// 32-bit floats, as vglare has them.
    Float,
    /// Rounded as 16-bit floats would be.
    Half,
}

/// A setting with what it costs and how exact it is. What does not apply or was not measured is none. Errors are
/// relative to the field's largest value of the same colour, those of a veil to the veil at each pixel; times are medians in
/// milliseconds.
#[derive(Debug, Clone, Serialize)]
pub struct Point {
    /// The sweep that it belongs to.
    pub sweep: Sweep,
    /// How many ghosts are summed.
    pub ghosts: usize,
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// The tolerance that was asked for.
    pub asked: Option<f64>,
    /// Whether the planner chooses this where no evaluator is named.
    pub planner: bool,
    /// None where the planner found no plan.
    pub evaluator: Option<Evaluator>,
    /// The series' period in x, in half picture heights.
    pub period_x: Option<f64>,
    /// The same in y.
    pub period_y: Option<f64>,
    /// The series' highest harmonic in x.
    pub degree_x: Option<u32>,
    /// The same in y.
    pub degree_y: Option<u32>,
    /// How many terms of the series are kept; of a veil, the Gaussians that stand for its function.
    pub terms: Option<usize>,
    /// How a veil is summed: by a `pyramid`, on the `sphere`, by a `transform` or by a `sum`.
    pub summed_by: Option<String>,
    /// Nodes a half wave of the highest harmonic, the fewer of x and y.
    pub oversampling: Option<f64>,
    /// What the spectrum is kept as.
    pub storage: Storage,
    /// The plan's bound.
    pub predicted: Option<f64>,
    /// The largest error at the sample's pixels.
    pub measured: Option<f64>,
    /// The root of the mean square of the errors at the sample's pixels.
    pub rms: Option<f64>,
    /// Of the tone-mapped composite, in dB.
    pub psnr_db: Option<f64>,
    /// ΔE2000 of the tone-mapped composite, the largest.
    pub delta_e_max: Option<f64>,
    /// The mean of ΔE2000.
    pub delta_e_mean: Option<f64>,
    /// Spectrum, field and composite: the median of the rounds.
    pub ms: Option<f64>,
    /// The fastest round.
    pub least_ms: Option<f64>,
    /// The slowest round.
    pub most_ms: Option<f64>,
    /// The spectrum alone.
    pub spectrum_ms: Option<f64>,
    /// The part of the picture that was drawn to measure the field's time.
    pub timed_share: Option<f64>,
    /// Why there is no plan.
    pub refused: Option<String>,
}

impl Point {
    /// A plan, not measured yet.
    pub(super) fn planned(sweep: Sweep, frame: Frame, asked: Option<f64>, plan: &Plan) -> Self {
        let series = plan.evaluator().is_series();
        Self {
            evaluator: Some(plan.evaluator()),
            period_x: series.then_some(plan.period().x),
            period_y: series.then_some(plan.period().y),
            degree_x: series.then_some(plan.degree()[0]),
            degree_y: series.then_some(plan.degree()[1]),
            terms: series.then_some(plan.terms()),
            oversampling: plan.lattice().map(|lattice| lattice.oversampling.min_element()),
            predicted: Some(plan.predicted.total()),
            ..Self::empty(sweep, frame, plan.ghosts() + plan.dropped, asked)
        }
    }

    /// A request without a plan.
    pub(super) fn refused(sweep: Sweep, frame: Frame, ghosts: usize, asked: Option<f64>, reason: &Error) -> Self {
        Self { refused: Some(reason.reason()), ..Self::empty(sweep, frame, ghosts, asked) }
    }

    /// A veil at a tolerance: its terms are Gaussians.
    pub(super) fn of_veil(frame: Frame, asked: f64, trial: &Trial) -> Self {
        Self {
            terms: Some(trial.terms),
            summed_by: Some(trial.summed_by.clone()),
            predicted: Some(trial.predicted),
            measured: Some(trial.measured),
            ms: Some(trial.times.median()),
            least_ms: Some(trial.times.min()),
            most_ms: Some(trial.times.max()),
            ..Self::empty(Sweep::Veil, frame, 0, Some(asked))
        }
    }

    fn empty(sweep: Sweep, frame: Frame, ghosts: usize, asked: Option<f64>) -> Self {
        Self {
            sweep,
            ghosts,
            width: frame.width,
            height: frame.height,
            asked,
            planner: false,
            evaluator: None,
            period_x: None,
            period_y: None,
            degree_x: None,
            degree_y: None,
            terms: None,
            summed_by: None,
            oversampling: None,
            storage: Storage::Float,
            predicted: None,
            measured: None,
            rms: None,
            psnr_db: None,
            delta_e_max: None,
            delta_e_mean: None,
            ms: None,
            least_ms: None,
            most_ms: None,
            spectrum_ms: None,
            timed_share: None,
            refused: None,
        }
    }

    pub(super) fn with_quality(self, quality: &Quality) -> Self {
        Self {
            measured: Some(quality.measured),
            rms: Some(quality.rms),
            psnr_db: Some(quality.psnr),
            delta_e_max: Some(quality.delta_e),
            delta_e_mean: Some(quality.delta_e_mean),
            ..self
        }
    }

    pub(super) fn with_timing(self, timing: &Timing) -> Self {
        Self {
            ms: Some(timing.whole.median()),
            least_ms: Some(timing.whole.min()),
            most_ms: Some(timing.whole.max()),
            spectrum_ms: Some(timing.spectrum.median()),
            timed_share: Some(timing.share),
            ..self
        }
    }

    /// The degree in words; a dash where there is none.
    pub fn degree(&self) -> String {
        self.degree_x.zip(self.degree_y).map_or("–".to_owned(), |(n, m)| format!("{n} × {m}"))
    }
}
