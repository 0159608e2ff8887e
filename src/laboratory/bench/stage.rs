//! What every case needs: the device, the picture, and how to run and time frames.

use std::cell::RefCell;
use std::hint::black_box;
use std::rc::Rc;

use crate::certificate::Certificate;
use crate::frame::Frame;
use crate::gpu::{Device, PassTime};
use crate::measure::{Rounds, Samples, interleave};
use crate::plan::{CostModel, Plan, Request, plan};
use crate::renderer::{Picture, Settings};
use crate::{Result, job};

/// One of the things that are timed in turns.
pub(super) type Arm<'a> = &'a mut dyn FnMut() -> Result<()>;

/// The device, the picture and how often to measure.
pub(super) struct Stage {
    device: Rc<Device>,
    pub frame: Frame,
    pub rounds: Rounds,
    /// What the plan that is left to choose reckons with.
    pub cost_model: CostModel,
}

/// A renderer with a scene and a photo.
pub(super) struct Actor {
    renderer: Picture,
    trusted: bool,
    plan: Plan,
}

/// A plan, step by step, beside a copy of the picture.
pub(super) struct Steps {
    pub certificate: Certificate,
    pub copy: Samples,
    pub plan: Samples,
    pub spectrum: Samples,
    pub drawing: Samples,
    pub together: Samples,
}

/// One pass over the rounds.
pub(super) struct Pass {
    pub name: String,
    pub wall: Samples,
    pub gpu: Option<Samples>,
}

impl Stage {
    pub fn new(device: Rc<Device>, [width, height]: [u32; 2], rounds: Rounds, cost_model: CostModel) -> Self {
        Self { device, frame: Frame::full(width, height), rounds, cost_model }
    }

    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The device, for what keeps it.
    pub fn shared_device(&self) -> &Rc<Device> {
        &self.device
    }

    /// What is asked of a plan whose choices are to be measured here.
    pub fn request(&self, tolerance: f64) -> Request {
        job::request(Some(self.device.info()), tolerance, self.cost_model)
    }

    /// Whether the device's timer tells the truth. Mesa's software renderer leaves out what compute shaders do.
    pub fn trusted(&self) -> bool {
        !self.device.info().software
    }

    /// A renderer that takes the whole picture for one tile.
    pub fn renderer(&self) -> Result<Picture> {
        let mut renderer = Picture::new(&self.device)?;
        renderer.field.set_tile_pixels(self.frame.window.pixels());
        Ok(renderer)
    }

    /// A renderer of its own, with the plan's scene and a photo of its size.
    pub fn actor(&self, plan: &Plan) -> Result<Actor> {
        let (mut renderer, frame) = (self.renderer()?, plan.problem().frame());
        renderer.load(frame, &vec![[0.5; 4]; frame.window.pixels()])?;
        renderer.field.set_scene(plan)?;
        Ok(Actor { renderer, trusted: self.trusted(), plan: plan.clone() })
    }

    /// Times what a plan takes, step by step, in turns; `drawing` is the one between the spectrum and all together.
    pub fn steps(&self, planned: &Plan, request: &Request, drawing: fn(&mut Actor) -> Result<()>) -> Result<Steps> {
        let mut actor = self.actor(planned)?;
        let certificate = Certificate::measure(&mut actor.renderer().field, planned)?;
        let shared = RefCell::new(&mut actor);
        let arms: [Arm<'_>; 5] = [
            &mut || shared.borrow_mut().copy(),
            &mut || plan(planned.problem(), request).map(|plan| drop(black_box(plan))),
            &mut || shared.borrow_mut().spectrum(),
            &mut || drawing(&mut shared.borrow_mut()),
            &mut || shared.borrow_mut().everything(),
        ];
        let [copy, plan, spectrum, drawing, together] = interleave(self.rounds, arms)?;
        Ok(Steps { certificate, copy, plan, spectrum, drawing, together })
    }
}

impl Actor {
    /// What renders, the scene set.
    pub fn renderer(&mut self) -> &mut Picture {
        &mut self.renderer
    }

    /// The yardstick.
    pub fn copy(&mut self) -> Result<()> {
        self.renderer.draw_copy()?;
        self.finish()
    }

    /// The picture, from a spectrum that is there.
    pub fn frame(&mut self) -> Result<()> {
        self.renderer.draw(self.plan.problem().frame(), &Settings::default())?;
        self.finish()
    }

    /// The spectrum alone, anew.
    pub fn spectrum(&mut self) -> Result<()> {
        self.renderer.field.forget_scene();
        self.renderer.field.set_scene(&self.plan)?;
        self.finish()
    }

    /// The spectrum anew, then the field alone.
    pub fn field(&mut self) -> Result<()> {
        self.renderer.field.forget_scene();
        self.renderer.field.set_scene(&self.plan)?;
        self.renderer.field.hold(self.plan.problem().frame())?;
        self.finish()
    }

    /// The spectrum anew, then the picture.
    pub fn everything(&mut self) -> Result<()> {
        self.renderer.field.forget_scene();
        self.renderer.field.set_scene(&self.plan)?;
        self.frame()
    }

    /// Waits for the device.
    pub fn finish(&self) -> Result<()> {
        self.renderer.field.finish();
        Ok(())
    }

    /// Times every pass of `work`, round after round, after one that is not counted.
    pub fn passes(&mut self, rounds: Rounds, work: impl Fn(&mut Self) -> Result<()>) -> Result<Vec<Pass>> {
        work(self)?;
        self.renderer.field.set_timing(true);
        let mut times = Vec::new();
        for _ in 0..rounds.timed() {
            work(self)?;
            times.push(sums(self.renderer.field.take_times()));
        }
        self.renderer.field.set_timing(false);
        Ok(gathered(&times, self.trusted))
    }
}

/// One frame's passes, in order of their first run; those that run more than once are added up.
pub(super) fn sums(times: Vec<PassTime>) -> Vec<PassTime> {
    let mut sums: Vec<PassTime> = Vec::new();
    for time in times {
        match sums.iter_mut().find(|sum| sum.pass == time.pass) {
            Some(sum) => {
                sum.wall_ms += time.wall_ms;
                sum.gpu_ms = sum.gpu_ms.zip(time.gpu_ms).map(|(a, b)| a + b);
            }
            None => sums.push(time),
        }
    }
    sums
}

/// From frames of passes to passes over frames. The device's own times count only where it gave all of them.
fn gathered(frames: &[Vec<PassTime>], trusted: bool) -> Vec<Pass> {
    let Some(first) = frames.first() else { return Vec::new() };
    let one = |name: &str| {
        let mine = || frames.iter().flatten().filter(move |time| time.pass == name);
        Pass {
            name: name.to_owned(),
            wall: mine().map(|time| time.wall_ms).collect(),
            gpu: mine().map(|time| time.gpu_ms.filter(|_| trusted)).collect(),
        }
    };
    first.iter().map(|time| one(&time.pass)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time(pass: &str, wall_ms: f64, gpu_ms: Option<f64>) -> PassTime {
        PassTime { pass: pass.into(), wall_ms, gpu_ms }
    }

    #[test]
    fn passes_that_run_twice_add_up_and_a_missing_device_time_is_never_half_a_sum() {
        let frame = sums(vec![time("a", 1.0, Some(0.5)), time("b", 2.0, Some(1.0)), time("a", 3.0, None)]);
        assert_eq!(frame, [time("a", 4.0, None), time("b", 2.0, Some(1.0))]);
        let passes = gathered(&[frame.clone(), frame.clone()], true);
        assert_eq!((passes[0].wall.median(), passes[1].wall.median()), (4.0, 2.0));
        assert!(passes[0].gpu.is_none() && passes[1].gpu.is_some());
        assert!(gathered(&[frame], false)[1].gpu.is_none());
    }
}
