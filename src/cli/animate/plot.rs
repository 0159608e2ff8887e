//! The mean glare over the frames, drawn: `--plot`.

use std::path::Path;

use super::report::{FrameLog, Log};
use super::shot::Shot;
use crate::Result;
use crate::chart::{Chart, Kind, Series, Stroke};
use crate::photo::Photo;

/// The luminance of a frame's glare, over all that the picture shows: in cd/m² where that is known, else in the photo's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// Of the glare.
    pub colour: [f64; 3],
    /// The luminance of that.
    pub luminance: f64,
    /// The luminance of one of each colour.
    weights: [f64; 3],
    in_cd_m2: bool,
}

impl Mean {
    /// Of a frame's glare.
    pub fn of(glare: &Photo) -> Self {
        let scale = glare.luminance_scale();
        let weights = scale.as_ref().map_or_else(|| glare.luminance_weights(), |scale| scale.weights);
        let colour = glare.mean();
        Self { colour, luminance: weighted(weights, colour), weights, in_cd_m2: scale.is_some() }
    }
}

fn weighted(weights: [f64; 3], colour: [f64; 3]) -> f64 {
    weights.iter().zip(colour).map(|(weight, part)| weight * part).sum()
}

/// Draws the mean luminance of the glare over the frames, and beside it what of it comes from beyond the picture and its band.
///
/// # Errors
/// [`crate::Error::Chart`] where it cannot be drawn; those of writing.
pub fn write(path: &Path, log: &Log<'_>, shot: &Shot, overwrite: bool) -> Result<()> {
    let means = || log.frames.iter().enumerate().filter_map(|(index, frame)| Some((index, frame, frame.mean?)));
    let unit = if means().any(|(.., mean)| mean.in_cd_m2) { "cd/m²" } else { "units of the photo" };
    let points = |of: &dyn Fn(&FrameLog, Mean) -> Option<f64>| -> Vec<[f64; 2]> {
        means().filter_map(|(index, frame, mean)| Some([shot.number(index) as f64, of(frame, mean)?])).collect()
    };
    let all = points(&|_, mean| Some(mean.luminance));
    let outside = points(&|frame, mean| Some(weighted(mean.weights, frame.told.outside.as_ref()?.mean)));
    let most = all.iter().map(|point| point[1]).fold(0.0, f64::max);
    let title = format!("Mean glare, {}", log.name());
    let mut chart = Chart::new(title, "frame", format!("luminance, {unit}")).with(Series::new("glare", all));
    if outside.iter().any(|point| point[1] != 0.0) {
        let label = "of it, from beyond the picture and its band";
        chart = chart.with(Series::new(label, outside).stroke(Stroke::Dashed));
    }
    if most > 0.0 {
        chart = chart.range_y(0.0, 1.05 * most);
    }
    chart.write(path, Kind::of(path)?, overwrite)
}
