//! The error of a field that was rendered, measured against the direct sum in f64, at sample pixels or at all of them.

mod rims;
mod sample;
mod whole;

use std::sync::Arc;

use crate::compare::{Comparison, compare_in};
use crate::frame::Window;
use crate::plan::Plan;
use crate::problem::{Images, Problem};
use crate::renderer::Field;
use crate::{Error, Result};

pub(crate) use sample::sample_pixels;

/// Pixels of which the direct sum is taken at once where all are: little memory, and enough for every core.
const BATCH: usize = 1 << 14;

/// Where a field is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Verify {
    /// At some hundred pixels
    #[default]
    Sample,
    /// At every pixel: as slow as the direct sum on the CPU
    Full,
}

/// What was asked, what was predicted and what was measured; all relative to the field's largest value.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Certificate {
    /// The tolerance.
    pub asked: f64,
    /// The plan's bound.
    pub predicted: f64,
    /// The largest error at the pixels looked at, the worst colour.
    pub measured: f64,
    /// Which pixels those are.
    pub verify: Verify,
    /// How many pixels were looked at.
    pub pixels: usize,
    /// The pixel with the largest error, as column and row of the picture.
    pub worst_pixel: [i32; 2],
    /// Values that are NaN or infinite.
    pub not_finite: usize,
}

impl Certificate {
    /// Renders the plan's field, and measures it at sample pixels.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub fn measure(field: &mut Field, plan: &Plan) -> Result<Self> {
        Ok(Samples::take(field, plan)?.certify())
    }

    /// Renders the plan's field, and measures it at every pixel of its window; `advance` is told how many more are done.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub fn measure_all(field: &mut Field, plan: &Plan, mut advance: impl FnMut(usize)) -> Result<Self> {
        let (problem, frame) = (plan.problem(), plan.problem().frame());
        field.set_scene(plan)?;
        let mut comparison = Comparison::in_units(plan.scale);
        // Where each tile's values begin among all of them.
        let mut tiles: Vec<(usize, Window)> = Vec::new();
        field.visit(frame, |tile, rendered| {
            tiles.push((comparison.count(), tile));
            // Columns are summed once for all rows that cross them.
            let batched = if problem.images().is_some_and(Images::are_products) { rendered.len() } else { BATCH };
            for (batch, rendered) in rendered.chunks(batched.max(1)).enumerate() {
                let pixels: Vec<_> = (0..rendered.len()).map(|k| place(tile, batch * batched + k)).collect();
                comparison.add(&problem.truth(&pixels), rendered);
                advance(rendered.len());
            }
        })?;
        let difference = comparison.difference();
        let worst = tiles.iter().rev().find(|(first, _)| *first <= difference.worst.0);
        Ok(Self {
            asked: plan.tolerance,
            predicted: plan.predicted.total(),
            measured: difference.relative,
            verify: Verify::Full,
            pixels: comparison.count(),
            worst_pixel: worst.map_or([0; 2], |&(first, tile)| place(tile, difference.worst.0 - first)),
            not_finite: difference.not_finite,
        })
    }

    /// An error where the field is further from the truth than was asked.
    ///
    /// # Errors
    /// [`Error::ToleranceMissed`].
    pub fn check(&self) -> Result<()> {
        // Written so that a NaN would be an error too.
        if self.measured <= self.asked {
            return Ok(());
        }
        Err(Error::ToleranceMissed { asked: self.asked, measured: self.measured })
    }
}

/// A field's field at sample pixels, not yet held against the truth: that needs no device, and may be done elsewhere.
pub(crate) struct Samples {
    problem: Arc<Problem>,
    pixels: Vec<[i32; 2]>,
    rendered: Vec<[f64; 3]>,
    unit: [f64; 3],
    asked: f64,
    predicted: f64,
}

impl Samples {
    /// Renders the plan's field, and looks it up.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub fn take(field: &mut Field, plan: &Plan) -> Result<Self> {
        let problem = plan.problem().clone();
        let pixels = sample_pixels(plan);
        field.set_scene(plan)?;
        let rendered = field.probe(problem.frame(), &pixels)?;
        Ok(Self {
            problem,
            pixels,
            rendered,
            unit: plan.scale,
            asked: plan.tolerance,
            predicted: plan.predicted.total(),
        })
    }

    /// Holds them against the direct sum of the same ghosts.
    pub fn certify(&self) -> Certificate {
        // In the plan's own unit where that is larger: light that cancels, or that does not reach the picture, is nothing.
        let difference = compare_in(&self.problem.truth(&self.pixels), &self.rendered, self.unit);
        Certificate {
            asked: self.asked,
            predicted: self.predicted,
            measured: difference.relative,
            verify: Verify::Sample,
            pixels: self.pixels.len(),
            worst_pixel: self.pixels.get(difference.worst.0).copied().unwrap_or_default(),
            not_finite: difference.not_finite,
        }
    }
}

/// The pixel of a tile by its number, row by row from the top.
fn place(tile: Window, index: usize) -> [i32; 2] {
    let (row, column) = (index / tile.width as usize, index % tile.width as usize);
    [tile.x + column as i32, tile.y + row as i32]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_misses_the_tolerance_is_an_error_and_so_is_nan() {
        let certificate = |measured| Certificate {
            asked: 1e-3,
            predicted: 5e-4,
            measured,
            verify: Verify::Sample,
            pixels: 1,
            worst_pixel: [0, 0],
            not_finite: 0,
        };
        assert!(certificate(1e-3).check().is_ok());
        assert!(certificate(1.001e-3).check().is_err());
        assert!(certificate(f64::NAN).check().is_err());
        assert!(certificate(f64::INFINITY).check().is_err());
    }
}
