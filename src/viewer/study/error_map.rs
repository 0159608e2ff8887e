//! The error all over the picture, in false colours: coarse at first, then finer.

use egui::{Color32, ColorImage};

use crate::Result;
use crate::false_colour::Map;
use crate::frame::Frame;
use crate::plan::Plan;
use crate::problem::Problem;
use crate::renderer::Field;

/// How many decades below the tolerance the colours span.
pub const DECADES: f64 = 4.0;
/// The most pixels that are looked at.
const MOST: f64 = 160_000.0;
/// By how much each step is finer than the one before.
const STEP: u32 = 4;

/// From one pixel that is looked at to the next, at the finest.
fn finest(frame: Frame) -> u32 {
    (frame.window.pixels() as f64 / MOST).sqrt().ceil().max(1.0) as u32
}

/// The first step's.
pub fn coarsest(frame: Frame) -> u32 {
    finest(frame) * STEP * STEP
}

/// The step after one of `stride`.
pub fn finer(stride: u32, frame: Frame) -> Option<u32> {
    (stride > finest(frame)).then_some(stride / STEP)
}

/// The colour of an error in units of the tolerance; magenta beyond it, black from [`DECADES`] below it on.
pub fn colour(part: f64) -> Color32 {
    if part.is_nan() || part > 1.0 {
        return Color32::from_rgb(255, 0, 255);
    }
    let [r, g, b] = Map::Inferno.colour(1.0 + part.max(f64::MIN_POSITIVE).log10() / DECADES);
    Color32::from_rgb(r, g, b)
}

/// The field's field at pixels that are evenly spread.
pub struct Rendered {
    size: [usize; 2],
    pixels: Vec<[i32; 2]>,
    values: Vec<[f64; 3]>,
    unit: [f64; 3],
    frame: Frame,
}

impl Rendered {
    /// Reads the field.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn take(field: &mut Field, plan: &Plan, frame: Frame, stride: u32) -> Result<Self> {
        let window = frame.window;
        let size = [window.width.div_ceil(stride), window.height.div_ceil(stride)];
        // The middle of each square, so that the picture and its squares lie on each other.
        let middle = |k: u32, count: u32| (k * stride + stride / 2).min(count - 1) as i32;
        let at = |k: u32| [k % size[0], k / size[0]];
        let pixel = |[i, j]: [u32; 2]| [window.x + middle(i, window.width), window.y + middle(j, window.height)];
        let pixels: Vec<_> = (0..size[0] * size[1]).map(|k| pixel(at(k))).collect();
        let values = field.probe(frame, &pixels)?;
        let unit = plan.scale.map(|scale| scale * plan.tolerance);
        Ok(Self { size: size.map(|side| side as usize), pixels, values, unit, frame })
    }

    /// How far it is from the direct sum.
    pub fn image(&self, problem: &Problem) -> ColorImage {
        let worst = |(exact, value): (&[f64; 3], &[f64; 3])| {
            let off = [0, 1, 2].map(|colour| (value[colour] - exact[colour]).abs() / self.unit[colour]);
            if off.iter().any(|off| off.is_nan()) { f64::NAN } else { off.into_iter().fold(0.0, f64::max) }
        };
        let exact = problem.on(self.frame).truth(&self.pixels);
        ColorImage::new(self.size, exact.iter().zip(&self.values).map(worst).map(colour).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_become_finer_down_to_the_finest() {
        let frame = Frame::full(1200, 800);
        let mut stride = coarsest(frame);
        let mut steps = vec![stride];
        while let Some(next) = finer(stride, frame) {
            stride = next;
            steps.push(stride);
        }
        assert_eq!(steps, [48, 12, 3]);
    }

    #[test]
    fn beyond_the_tolerance_is_no_colour_of_the_scale() {
        assert_eq!(colour(1.01), colour(f64::NAN));
        assert!((0..=100).all(|part| colour(f64::from(part) / 100.0) != colour(1.01)));
        assert_eq!(colour(0.0), colour(10f64.powf(-DECADES)));
    }
}
