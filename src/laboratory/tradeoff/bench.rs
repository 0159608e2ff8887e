//! Timing of plans in turns: the spectrum, then the field and its composite, on a photo that is on the device already.

use std::rc::Rc;
use std::time::Instant;

use crate::frame::{Frame, Window};
use crate::gpu::Device;
use crate::measure::{Rounds, Samples, in_turns};
use crate::plan::{CostModel, Evaluator, Plan, Request};
use crate::renderer::{Picture, Settings};
use crate::{Result, job};

/// The part of a picture, one over this many rows, that a first try of a slow evaluator draws.
const TRY: u32 = 64;

/// The renderer, and how often and how long to measure.
pub(super) struct Bench {
    device: Rc<Device>,
    /// What plans reckon with.
    cost_model: CostModel,
    pub renderer: Picture,
    pub rounds: Rounds,
    /// How long one draw of a slow evaluator may take, in milliseconds: where a picture would take longer, a part of it
    /// is drawn and its time scaled.
    patience: f64,
}

/// One of the things that are timed in turns.
pub(super) struct Arm<'a> {
    pub plan: &'a Plan,
}

impl Arm<'_> {
    fn frame(&self) -> Frame {
        self.plan.problem().frame()
    }
}

/// What an arm took, in milliseconds, to glFinish.
#[derive(Debug, Clone)]
pub(super) struct Timing {
    pub spectrum: Samples,
    /// Spectrum, field and composite.
    pub whole: Samples,
    /// The part of the picture that was drawn, by its rows; the field's time is scaled by its inverse.
    pub share: f64,
}

impl Bench {
    /// A bench for pictures of up to `pixels` pixels, each drawn in one piece.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn new(device: &Rc<Device>, cost_model: CostModel, quick: bool, pixels: usize) -> Result<Self> {
        let mut renderer = Picture::new(device)?;
        renderer.field.set_tile_pixels(pixels);
        let (rounds, patience) = if quick { (Rounds::new(1, 4), 40.0) } else { (Rounds::new(2, 10), 250.0) };
        Ok(Self { device: device.clone(), cost_model, renderer, rounds, patience })
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// What to ask of a plan for this device.
    pub fn request(&self, tolerance: f64) -> Request {
        job::request(Some(self.device.info()), tolerance, self.cost_model)
    }

    /// Times the arms in turns; `tick` hears how much of it is done, from 0 to 1.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn time(&mut self, arms: &[Arm<'_>], tick: &mut dyn FnMut(f64)) -> Result<Vec<Timing>> {
        let mut parts = Vec::new();
        for (index, arm) in arms.iter().enumerate() {
            parts.push(self.part(arm)?);
            tick(0.3 * (index + 1) as f64 / arms.len() as f64);
        }
        let (mut done, all) = (0.0, (arms.len() * (self.rounds.timed() + 1)) as f64);
        let times = in_turns(self.rounds, arms.len(), |index| {
            done += 1.0;
            tick((0.3 + 0.7 * done / all).min(1.0));
            self.run(&arms[index], parts[index])
        })?;
        Ok(parts.iter().zip(arms).zip(&times).map(|((part, arm), times)| timing(*part, arm, times)).collect())
    }

    /// The part of an arm's picture that there is patience for.
    fn part(&mut self, arm: &Arm<'_>) -> Result<Window> {
        let whole = arm.frame().window;
        if !matches!(arm.plan.evaluator(), Evaluator::Direct | Evaluator::Series | Evaluator::Local) {
            return Ok(whole);
        }
        let least = whole.height.div_ceil(TRY);
        let tried = rows(whole, least);
        // The first run compiles shaders.
        self.run(arm, tried)?;
        let [spectrum, all] = self.run(arm, tried)?;
        let expected = (all - spectrum) * f64::from(whole.height) / f64::from(least);
        let share = (self.patience / expected).min(1.0);
        Ok(rows(whole, ((share * f64::from(whole.height)) as u32).max(least)))
    }

    /// The spectrum and then a part of the picture: milliseconds until the one and until the other is done.
    fn run(&mut self, arm: &Arm<'_>, part: Window) -> Result<[f64; 2]> {
        let frame = arm.frame().with_window(part);
        self.renderer.load(frame, &vec![[0.5; 4]; part.pixels()])?;
        self.renderer.field.forget_scene();
        self.renderer.field.finish();
        let started = Instant::now();
        self.renderer.field.set_scene(arm.plan)?;
        self.renderer.field.finish();
        let spectrum = started.elapsed();
        self.renderer.draw(frame, &Settings::default())?;
        self.renderer.field.finish();
        Ok([spectrum, started.elapsed()].map(|time| time.as_secs_f64() * 1e3))
    }
}

/// `count` rows from the middle of a window.
fn rows(window: Window, count: u32) -> Window {
    Window { y: window.y + (window.height - count) as i32 / 2, height: count, ..window }
}

fn timing(part: Window, arm: &Arm<'_>, times: &[[f64; 2]]) -> Timing {
    let share = f64::from(part.height) / f64::from(arm.frame().window.height);
    Timing {
        spectrum: times.iter().map(|[spectrum, _]| *spectrum).collect(),
        whole: times.iter().map(|[spectrum, all]| spectrum + (all - spectrum) / share).collect(),
        share,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_keeps_the_middle_and_never_leaves_the_window() {
        let whole = Window { x: 3, y: -4, width: 10, height: 9 };
        assert_eq!(rows(whole, 9), whole);
        assert_eq!(rows(whole, 1), Window { y: 0, height: 1, ..whole });
    }
}
