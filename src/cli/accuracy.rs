//! How exact the glare is to be and how it is computed: the options, and the plan that they ask for.

use std::path::PathBuf;

use glam::DVec2;

use super::BackendChoice;
use super::calibration::{self, CalibrationArgs};
use super::numbers::finite;
use super::scene::Gathered;
use crate::Result;
use crate::frame::Frame;
use crate::gpu::Info;
use crate::plan::{self, CostModel, Evaluator, Plan, Request};

/// How exact the glare is, and how it is computed.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Accuracy")]
pub struct AccuracyArgs {
    /// Largest error at any pixel, relative to the largest glare of the same colour
    #[arg(long, value_name = "E", default_value_t = 1e-3, value_parser = tolerance)]
    tolerance: f64,

    /// Be as exact as this many milliseconds allow, by the cost model, instead of to a tolerance: for the spectrum and
    /// the field, without reading, compiling and writing. `vglare calibrate` fits the cost model to this machine
    #[arg(long, value_name = "MILLISECONDS", conflicts_with = "tolerance", value_parser = budget)]
    pub budget: Option<f64>,

    /// Where 32-bit floats cannot be as exact as asked, be as exact as they can, instead of failing
    #[arg(long)]
    allow_floor: bool,

    /// Highest harmonic in x and y, 0 to 4096 [default: planned]
    #[arg(long, value_name = "N,M", value_parser = degree)]
    degree: Option<Degree>,

    /// Period of the series in x and y, in half picture heights [default: planned]
    #[arg(long, value_name = "X,Y", value_parser = period)]
    period: Option<DVec2>,

    /// How the field is computed [default: planned]
    #[arg(long, value_enum)]
    evaluator: Option<Evaluator>,

    /// Where OpenGL comes from
    #[arg(long, value_enum, default_value_t = BackendChoice::Auto)]
    pub backend: BackendChoice,

    #[command(flatten)]
    calibration: CalibrationArgs,
}

/// A plan, and what it rests on.
pub struct Planned {
    pub plan: Plan,
    /// The cost model that decided.
    pub model: CostModel,
    /// The file that the cost model is from; none for the built-in one.
    pub calibration: Option<PathBuf>,
    /// What a person ought to know: of a tolerance that was raised to the floor.
    pub notes: Vec<String>,
    /// What went wrong without keeping the plan from being made.
    pub warnings: Vec<String>,
}

impl AccuracyArgs {
    /// The plan for the scene's ghosts on a device, or, without one, on a device without limits.
    ///
    /// # Errors
    /// Those of [`plan::plan`], [`plan::plan_at_least`] and [`plan::plan_within`].
    pub fn plan(&self, scene: &Gathered, frame: Frame, device: Option<&Info>) -> Result<Planned> {
        let known = self.calibration.known(device);
        let unlimited = Request::new(frame, self.tolerance);
        let request = Request {
            period: self.period.or(scene.period),
            degree: self.degree.map(|degree| degree.0).or(scene.degree),
            evaluator: self.evaluator,
            loop_rounds: device.and_then(Info::loop_rounds).unwrap_or(usize::MAX),
            // A term takes three vec4.
            most_terms: device.map_or(unlimited.most_terms, |info| (info.limits.storage_block / 48) as usize),
            cost_model: known.model,
            ..unlimited
        };
        let plan = match self.budget {
            Some(budget) => plan::plan_within(&scene.ghosts, &request, budget)?,
            None if self.allow_floor => plan::plan_at_least(&scene.ghosts, &request)?,
            None => plan::plan(&scene.ghosts, &request)?,
        };
        let raised = self.budget.is_none() && plan.tolerance > self.tolerance;
        let note = raised.then(|| {
            let (asked, floor) = (self.tolerance, plan.tolerance);
            let by = plan.evaluator;
            format!("the tolerance is {floor:.1e} instead of {asked:.1e}: what 32-bit floats can give here, by {by}")
        });
        let calibration::Known { model, file, warning } = known;
        Ok(Planned {
            plan,
            model,
            calibration: file,
            notes: note.into_iter().collect(),
            warnings: warning.into_iter().collect(),
        })
    }
}

/// `--degree`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Degree([u32; 2]);

fn tolerance(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|&x| x > 0.0 && x < 1.0).ok_or_else(|| "expected a number between 0 and 1".to_owned())
}

fn budget(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|&x| x > 0.0).ok_or_else(|| "expected a positive number of milliseconds".to_owned())
}

fn pair(text: &str) -> Option<(&str, &str)> {
    text.split_once(',').map(|(a, b)| (a.trim(), b.trim()))
}

fn degree(text: &str) -> Result<Degree, String> {
    let one = |text: &str| text.parse::<u32>().ok().filter(|&n| n <= plan::HIGHEST_DEGREE);
    pair(text)
        .and_then(|(n, m)| Some(Degree([one(n)?, one(m)?])))
        .ok_or_else(|| format!("expected two whole numbers from 0 to {}, like 32,24", plan::HIGHEST_DEGREE))
}

fn period(text: &str) -> Result<DVec2, String> {
    let one = |text: &str| finite(text).ok().filter(|&t| t > 0.0);
    pair(text)
        .and_then(|(x, y)| Some(DVec2::new(one(x)?, one(y)?)))
        .ok_or_else(|| "expected two positive numbers, like 4.5,3".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_make_no_sense_are_refused() {
        for bad in ["0", "1", "-1e-3", "nan", "inf", "x"] {
            assert!(tolerance(bad).is_err(), "{bad}");
        }
        assert_eq!(tolerance("1e-4"), Ok(1e-4));
        for bad in ["0", "-5", "nan", "inf", "x"] {
            assert!(budget(bad).is_err(), "{bad}");
        }
        assert_eq!(budget("16.7"), Ok(16.7));
        for bad in ["3", "3,", "-1,2", "3,5000", "1.5,2", "a,b"] {
            assert!(degree(bad).is_err(), "{bad}");
        }
        assert_eq!(degree("32, 24"), Ok(Degree([32, 24])));
        for bad in ["3", "0,1", "1,-1", "nan,1", "inf,1"] {
            assert!(period(bad).is_err(), "{bad}");
        }
        assert_eq!(period("4.5,3"), Ok(DVec2::new(4.5, 3.0)));
    }
}
