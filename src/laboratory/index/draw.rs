//! The drawing: the index by the diameter of the spot.

use std::path::Path;

use super::told::{Told, luminance};
use crate::Result;
use crate::chart::{Chart, Kind, Series, Stroke};

/// Draws what was measured and writes that.
///
/// # Errors
/// [`crate::Error::Chart`] where it cannot be drawn, [`crate::Error::Write`] and [`crate::Error::Exists`] where it cannot be written.
pub fn write(path: &Path, kind: Kind, told: &Told<'_>, force: bool) -> Result<()> {
    let mut chart = Chart::new(told.name(), "diameter of the spot, degrees", "glare index, %");
    let mut highest = 0.0f64;
    for (number, place) in told.places.iter().enumerate() {
        let of = told.all.iter().skip(number).step_by(told.places.len());
        let points: Vec<_> = of.map(|spot| [spot.diameter_degrees, 100.0 * luminance(spot.index)]).collect();
        highest = points.iter().map(|[_, index]| *index).fold(highest, f64::max);
        let label = format!("{}, {:.1}° off axis", place.name, told.field.off_axis(place.pixel));
        chart = chart.with(Series::new(label, points).stroke(Stroke::Joined));
    }
    let chart = chart.range_y(0.0, if highest > 0.0 { 1.1 * highest } else { 1.0 });
    chart.write(path, kind, force)
}
