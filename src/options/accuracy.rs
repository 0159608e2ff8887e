//! How exact the glare is to be and how it is computed.

use glam::DVec2;

use crate::calibration::Known;
use crate::choices::Evaluator;
use crate::gpu::Info;
use crate::look::Accuracy;
use crate::options::BackendChoice;
use crate::options::numbers::{finite, positive, tolerance};
use crate::plan;
use crate::scene::Goal;

/// How exact the glare is, and how it is computed.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Accuracy")]
pub struct AccuracyArgs {
    /// Largest error at any pixel, relative to the largest glare of the same colour [default: 0.001]; of a veil, relative to
    /// itself at that pixel [default: 0.01]
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = tolerance)]
    tolerance: Option<f64>,

    /// Be as exact as this many milliseconds allow, by the cost model, instead of to a tolerance: for the spectrum and
    /// the field, without reading, compiling and writing. `vglare calibrate` fits the cost model to this machine
    #[arg(long, value_name = "MILLISECONDS", conflicts_with = "tolerance", allow_hyphen_values = true, value_parser = budget)]
    budget: Option<f64>,

    /// Where the tolerance cannot be had, take the lowest that can, instead of failing
    #[arg(long)]
    allow_floor: bool,

    /// Hold the error at each pixel to the tolerance of photo and glare there, too, so that one bright ghost excuses no
    /// other; what is darker than 1/4096 of the picture's mean is held to as much as that
    #[arg(long, conflicts_with = "budget")]
    each_pixel: bool,

    /// Highest harmonic in x and y, 0 to 4096 [default: planned]
    #[arg(long, value_name = "N,M", allow_hyphen_values = true, value_parser = degree)]
    degree: Option<Degree>,

    /// Period of the series in x and y, in the look's unit (see --unit) [default: planned]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = period)]
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

/// Whether what was measured of this machine is used.
#[derive(Debug, Clone, Copy, clap::Args)]
pub struct CalibrationArgs {
    /// Plan by the built-in cost model, whatever `vglare calibrate` measured here: the same plan on any machine
    #[arg(long)]
    pub no_calibration: bool,
}

impl CalibrationArgs {
    /// The cost model for a device.
    pub fn known(self, device: Option<&Info>) -> Known {
        match device {
            Some(device) if !self.no_calibration => Known::of(device),
            _ => Known::default(),
        }
    }
}

impl AccuracyArgs {
    /// The tolerance, where it is given.
    pub fn tolerance(&self) -> Option<f64> {
        self.tolerance
    }

    /// What is given wins over what was set before.
    pub fn over(&self, set: Accuracy) -> Accuracy {
        let tolerance = self.tolerance.map(Goal::Tolerance);
        Accuracy {
            goal: self.budget.map(Goal::Budget).or(tolerance).unwrap_or(set.goal),
            allow_floor: self.allow_floor || set.allow_floor,
            // A budget takes the tolerance's place.
            each_pixel: self.each_pixel || set.each_pixel && self.budget.is_none(),
            degree: self.degree.map(|degree| degree.0).or(set.degree),
            period: self.period.or(set.period),
            evaluator: self.evaluator.or(set.evaluator),
        }
    }

    /// The cost model for a device.
    pub fn known(&self, device: Option<&Info>) -> Known {
        self.calibration.known(device)
    }
}

/// `--degree`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Degree([u32; 2]);

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
    let one = |text: &str| positive(text).ok();
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
