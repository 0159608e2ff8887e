//! The drawing: four charts on one sheet.

use std::path::Path;

use image::RgbImage;
use image::imageops::replace;

use super::Shown;
use crate::chart::{Chart, Kind, Series, Stroke};
use crate::laboratory::page::write_png;
use crate::psf::{Mode, Row};
use crate::{Result, target};

/// Pixels of each chart.
const SIZE: [u32; 2] = [760, 500];

/// Draws a function and writes that.
///
/// # Errors
/// [`crate::Error::Chart`] where it cannot be drawn, [`crate::Error::Write`] and [`crate::Error::Exists`] where it cannot be written.
pub fn write(path: &Path, kind: Kind, shown: &Shown, force: bool) -> Result<()> {
    let charts = charts(shown);
    match kind {
        Kind::Svg => target::write_text(path, &svg(&charts)?, force),
        Kind::Png => write_png(path, &png(&charts)?, force),
    }
}

fn charts(shown: &Shown) -> [Chart; 4] {
    let Shown { psf, range: _, mixture, profile, axis } = shown;
    let ((angle, area), factor) = (shown.units(), shown.factor());
    let angle = format!("angle or radius,{}", angle.replace('°', " degrees"));
    let of = |value: fn(&Row) -> f64| profile.rows.iter().map(|row| [row.angle, value(row)]).collect::<Vec<_>>();
    let on_axis = axis.map_or_else(String::new, |axis| format!(", on the axis of {}° across", axis.fov));
    let sized = |chart: Chart| Chart { size: SIZE, ..chart };
    let mut values =
        Chart::new(format!("{}: value", psf.name()), &angle, format!("per {area}{on_axis}")).log_x().log_y();
    let scaled = |value: fn(&Row) -> f64| of(value).into_iter().map(|[angle, value]| [angle, factor * value]).collect();
    values = values.with(Series::new("the function", scaled(|row| row.value)));
    let mut error = Chart::new("Error of the Gaussians", &angle, "relative").log_x();
    if let Some(mixture) = mixture {
        let label = format!("{} Gaussians", mixture.terms.len());
        values = values.with(Series::new(&label, scaled(|row| row.mixture)).stroke(Stroke::Dashed));
        error = error.with(Series::new(label, of(|row| row.error)));
    }
    let encircled = Chart::new("Encircled energy", &angle, "share of all").log_x().range_y(0.0, 1.0);
    let encircled = encircled.with(Series::new("within the angle", of(|row| row.encircled)));
    let modes = profile.modes.iter().map(|&Mode { frequency, transform }| [frequency, transform]).collect();
    let transform = Chart::new("Transform", "cycles for each degree or unit", "in the measure of the energy").log_x();
    let transform = transform.with(Series::new("Hankel transform", modes));
    [values, error, encircled, transform].map(sized)
}

/// Where a chart stands: two beside each other.
fn place(index: usize) -> [u32; 2] {
    [SIZE[0] * (index as u32 % 2), SIZE[1] * (index as u32 / 2)]
}

fn svg(charts: &[Chart; 4]) -> Result<String> {
    let [width, height] = SIZE.map(|side| 2 * side);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
    );
    for (index, chart) in charts.iter().enumerate() {
        let [x, y] = place(index);
        let drawn = chart.svg()?.unwrap_or_default();
        text += &drawn.replacen("<svg ", &format!("<svg x=\"{x}\" y=\"{y}\" "), 1);
    }
    text += "</svg>\n";
    Ok(text)
}

fn png(charts: &[Chart; 4]) -> Result<RgbImage> {
    let [width, height] = SIZE.map(|side| 2 * side);
    let mut sheet = RgbImage::new(width, height);
    for (index, chart) in charts.iter().enumerate() {
        let [x, y] = place(index).map(i64::from);
        replace(&mut sheet, &chart.picture()?, x, y);
    }
    Ok(sheet)
}
