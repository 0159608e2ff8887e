//! Frames of the benchmark, timed in turns.

use std::rc::Rc;

use super::super::plane::Scene;
use super::canvas;
use crate::Result;
use crate::frame::Frame;
use crate::gpu::{Device, PassTime};
use crate::measure::{Rounds, Samples, interleave};
use crate::plan::Evaluator;
use crate::renderer::{Picture, Settings};

/// The device, the picture and how often to measure.
pub(super) struct Stage {
    device: Rc<Device>,
    size: u32,
    pub rounds: Rounds,
}

/// One case's times, a sample a round.
pub(super) struct Timed {
    /// From the first command to the end of glFinish.
    pub frame: Samples,
    /// The pass that draws the glare.
    pub glare: Samples,
    /// All passes.
    pub all: Samples,
}

/// A renderer with a scene and a black photo, ready to draw frames.
struct Actor {
    renderer: Picture,
    frame: Frame,
}

impl Actor {
    /// A frame, to its end.
    fn draw(&mut self) -> Result<()> {
        self.renderer.draw(self.frame, &Settings::default())?;
        self.renderer.field.finish();
        Ok(())
    }
}

type Arm<'a> = &'a mut dyn FnMut() -> Result<()>;

impl Stage {
    pub fn new(device: Rc<Device>, size: u32, rounds: Rounds) -> Self {
        Self { device, size, rounds }
    }

    /// Whether the device's timer tells the truth: Mesa's software renderer answers 0, or leaves out what compute shaders
    /// do.
    pub fn trusted(&self) -> bool {
        !self.device.info().software
    }

    pub fn renderer_name(&self) -> &str {
        &self.device.info().renderer
    }

    /// A renderer that takes the whole picture for one tile, with its spectrum computed.
    fn actor(&self, (scene, evaluator): (&Scene, Evaluator)) -> Result<Actor> {
        let canvas = canvas(self.size);
        let mut renderer = Picture::new(&self.device)?;
        renderer.field.set_tile_pixels(canvas.frame.window.pixels());
        renderer.load(canvas.frame, &vec![[0.0; 4]; canvas.frame.window.pixels()])?;
        scene.set(&mut renderer, &canvas, evaluator)?;
        Ok(Actor { renderer, frame: canvas.frame })
    }

    /// Frames of two cases, in turns, in so many times the rounds.
    pub fn pair(&self, cases: [(&Scene, Evaluator); 2], times: usize) -> Result<[Samples; 2]> {
        let (mut a, mut b) = (self.actor(cases[0])?, self.actor(cases[1])?);
        let rounds = Rounds::new(1, times * self.rounds.timed());
        interleave(rounds, [&mut || a.draw(), &mut || b.draw()] as [Arm<'_>; 2])
    }

    /// Frames of four cases in turns, then their passes, the device idle before and after each.
    pub fn in_turns(&self, cases: [(&Scene, Evaluator); 4]) -> Result<[Timed; 4]> {
        let mut actors = Vec::new();
        for case in cases {
            actors.push(self.actor(case)?);
        }
        let Ok([a, b, c, d]) = <&mut [Actor; 4]>::try_from(&mut actors[..]) else { unreachable!("one for each case") };
        let arms: [Arm<'_>; 4] = [&mut || a.draw(), &mut || b.draw(), &mut || c.draw(), &mut || d.draw()];
        let frames = interleave(self.rounds, arms)?;
        let mut passes = Vec::new();
        for actor in &mut actors {
            actor.renderer.field.set_timing(true);
            passes.push([Vec::new(), Vec::new()]);
        }
        for _ in 0..self.rounds.timed() {
            for (actor, [glare, all]) in actors.iter_mut().zip(&mut passes) {
                actor.draw()?;
                let times = actor.renderer.field.take_times();
                glare.push(self.sum(times.iter().filter(|time| time.pass == GLARE)));
                all.push(self.sum(times.iter()));
            }
        }
        let mut passes = passes.into_iter();
        Ok(frames.map(|frame| {
            let [glare, all] = passes.next().expect("as many as frames").map(Samples::from_iter);
            Timed { frame, glare, all }
        }))
    }

    /// What passes take together: by the device's timer where all of them have it and it can be trusted.
    fn sum<'a>(&self, times: impl Iterator<Item = &'a PassTime> + Clone) -> f64 {
        let device: Option<f64> = times.clone().map(|time| time.gpu_ms).sum();
        device.filter(|_| self.trusted()).unwrap_or_else(|| times.map(|time| time.wall_ms).sum())
    }
}

/// The pass that evaluates the field at every pixel and adds it to the photo.
const GLARE: &str = "composite";
