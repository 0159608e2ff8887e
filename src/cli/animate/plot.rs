//! The mean glare over the frames, drawn: `--plot`.

use std::path::Path;

use super::report::{FrameLog, Log};
use super::shot::Shot;
use crate::Result;
use crate::chart::{Chart, Kind, Series, Stroke};
use crate::cli::luminance::Brightness;
use crate::photo::Photo;

/// The mean of a frame's glare, over all that the picture shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// RGB.
    pub colour: [f64; 3],
    brightness: Brightness,
}

impl Mean {
    /// Of a frame's glare.
    pub fn of(glare: &Photo) -> Self {
        Self { colour: glare.mean(), brightness: Brightness::of(glare) }
    }
}

/// Draws the mean luminance of the glare over the frames, and beside it what of it comes from beyond the picture and its band.
///
/// # Errors
/// [`crate::Error::Chart`] where it cannot be drawn; those of writing.
pub fn write(path: &Path, log: &Log<'_>, shot: &Shot, overwrite: bool) -> Result<()> {
    let means = || log.frames.iter().enumerate().filter_map(|(index, frame)| Some((index, frame, frame.mean?)));
    let unit = means().next().map_or("", |(.., mean)| mean.brightness.unit);
    let points = |of: &dyn Fn(&FrameLog, Mean) -> Option<[f64; 3]>| -> Vec<[f64; 2]> {
        let point = |(index, frame, mean): (usize, &FrameLog, Mean)| {
            Some([shot.number(index) as f64, mean.brightness.at(of(frame, mean)?)])
        };
        means().filter_map(point).collect()
    };
    let all = points(&|_, mean| Some(mean.colour));
    let outside = points(&|frame, _| Some(frame.told.outside.as_ref()?.mean));
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
