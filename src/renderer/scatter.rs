//! The veil of a photo by the device: the twin of `veil`'s own sums, three channels at a time.

use std::rc::Rc;

use crate::gpu::Device;
use crate::gpu::resource::{Scratch, Texel, Texture};
use crate::gpu::runner::Runner;
use crate::gpu::veil::{Axis, Convolve, Expand, Finish, MOST_TAPS, PERIOD, VeilPass};
use crate::veil::sweep::{FIRST, NEXT, Step, points};
use crate::veil::{self, Layers, Lights, OnDevice, Photo, Placed, Plan, Veil};
use crate::{Error, Result};

const _: () = assert!(PERIOD == veil::PERIOD);

/// Sums veils on a device, by plans whose method is [`veil::Method::Pyramid`].
pub struct Scatter {
    runner: Runner,
    pass: VeilPass,
    sources: Scratch,
    lattices: Vec<Lattice>,
    pixels: Sums,
    veil: Scratch,
}

/// What a lattice has on the device.
#[derive(Default)]
struct Lattice {
    /// Moments that are taken along rows only.
    strips: Scratch,
    moments: Scratch,
    sums: Sums,
}

/// The sums of a lattice or of the pixels in the making.
#[derive(Default)]
struct Sums {
    /// The coarser lattice's sums, along rows.
    spread: Scratch,
    /// What was convolved along rows.
    across: Scratch,
    /// What was summed last, and what it was added to.
    last: Scratch,
    before: Scratch,
    /// Whether there is anything.
    any: bool,
}

/// What is summed on a lattice or on the pixels.
struct Onto<'a> {
    size: [u32; 2],
    /// The point of `source`, and of the finer side of `step`, that is the first.
    first: [i32; 2],
    step: &'static Step,
    terms: &'a [Placed],
}

impl Scatter {
    /// One that has done nothing yet; its shaders are compiled with the first veil.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses an object.
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        let runner = Runner::new(device)?;
        Ok(Self {
            pass: VeilPass::new(&runner)?,
            runner,
            sources: Scratch::default(),
            lattices: Vec::new(),
            pixels: Sums::default(),
            veil: Scratch::default(),
        })
    }

    /// Whether this device sums the veil of a plan.
    ///
    /// # Errors
    /// [`Error::Plan`] that says why it does not.
    pub fn check(&self, plan: &Plan) -> Result<()> {
        planned(plan, &self.runner).map(|_| ())
    }

    /// The veil of a photo, within the bound that it says is certified: the plan's, or a little more where this takes more
    /// roundings. The few pixels that are far brighter than their own veil are mended by the CPU.
    ///
    /// # Errors
    /// [`Error::Plan`] as [`Scatter::check`] and for a photo of another size; [`Error::Gl`] where the driver refuses.
    pub fn evaluate(&mut self, plan: &Plan, photo: &Photo<'_>) -> Result<Veil> {
        let planned = planned(plan, &self.runner)?;
        let summed =
            planned.evaluate(photo, |lights, texels| self.sum(&planned, lights, texels).map_err(Failed::Device));
        summed.map_err(|failed| match failed {
            Failed::Device(error) => error,
            Failed::Photo(error) => Error::Plan(error.to_string()),
        })
    }

    /// Sums the light of `texels`, and leaves the veil there.
    fn sum(&mut self, planned: &OnDevice<'_>, lights: &Lights<'_>, texels: &mut [[f32; 4]]) -> Result<()> {
        let [width, height] = planned.sources_size().map(|side| side as u32);
        let sources = self.sources.get(self.runner.device(), Texel::Rgba, width, height)?;
        sources.write(texels, width as usize, width, height);
        let layers = planned.layers();
        self.up(planned)?;
        for level in (0..layers.lattices.len()).rev() {
            self.down(level, &layers.lattices[level])?;
        }
        let veil = self.at_the_pixels(planned, lights)?;
        let [width, height] = planned.size().map(|side| side as u32);
        veil.read(texels, width as usize, width, height);
        self.runner.device().check("summing a veil")
    }

    /// The moments of all lattices.
    fn up(&mut self, planned: &OnDevice<'_>) -> Result<()> {
        let count = planned.layers().lattices.len();
        let [columns, rows] = planned.sources_size().map(|side| points(side, count));
        self.lattices.resize_with(count, Lattice::default);
        for level in 0..count {
            let (finer, this) = self.lattices.split_at_mut(level);
            let Lattice { strips, moments, .. } = &mut this[0];
            let (source, step) = match finer.last() {
                Some(finer) => (current(&finer.moments)?, &NEXT),
                None => (current(&self.sources)?, &FIRST),
            };
            let [width, height] = [columns[level] as u32, rows[level] as u32];
            let up = |axis| Convolve { axis, taps: step.up, first: -(step.before as i32), stride: 2, aside: 0 };
            let strips = strips.get(self.runner.device(), Texel::Rgba, width, source.level_height(0))?;
            self.pass.convolve(&self.runner, up(Axis::X), source, None, strips)?;
            let moments = moments.get(self.runner.device(), Texel::Rgba, width, height)?;
            self.pass.convolve(&self.runner, up(Axis::Y), strips, None, moments)?;
        }
        Ok(())
    }

    /// The sums of a lattice, once those of the coarser ones are there.
    fn down(&mut self, level: usize, terms: &[Placed]) -> Result<()> {
        let (these, coarser) = self.lattices.split_at_mut(level + 1);
        let Lattice { moments, sums, .. } = &mut these[level];
        let moments = current(moments)?;
        let size = [moments.level_width(0), moments.level_height(0)];
        let coarse = coarser.first().map(|coarse| current(&coarse.sums.last)).transpose()?;
        sums.sum(&self.runner, &mut self.pass, moments, coarse, &Onto { size, first: [0; 2], step: &NEXT, terms })
    }

    /// The veil.
    fn at_the_pixels(&mut self, planned: &OnDevice<'_>, lights: &Lights<'_>) -> Result<&Texture> {
        let Layers { direct, near, own, .. } = planned.layers();
        let size = planned.size().map(|side| side as u32);
        let first = planned.margin().map(|side| side as i32);
        let sources = current(&self.sources)?;
        let coarse = self.lattices.first().map(|lattice| current(&lattice.sums.last)).transpose()?;
        let onto = Onto { size, first, step: &FIRST, terms: direct };
        self.pixels.sum(&self.runner, &mut self.pass, sources, coarse, &onto)?;
        let before = if self.pixels.any { self.pixels.last.current() } else { None };
        let veil = self.veil.get(self.runner.device(), Texel::Rgba, size[0], size[1])?;
        let finish =
            Finish { first, middle: lights.middle(), moments: lights.moments, own: &own.table, near: &near.rows };
        self.pass.finish(&self.runner, &finish, sources, before, veil)?;
        Ok(veil)
    }
}

impl Sums {
    /// What the coarser lattice has, where there is one, and each term of `source`.
    fn sum(
        &mut self,
        runner: &Runner,
        pass: &mut VeilPass,
        source: &Texture,
        coarse: Option<&Texture>,
        onto: &Onto<'_>,
    ) -> Result<()> {
        let &Onto { size: [width, height], first, step, terms } = onto;
        let device = runner.device();
        self.any = false;
        if let Some(coarse) = coarse {
            let onto_finer = |axis, first| Expand { axis, even: step.even, odd: step.odd, first };
            let spread = self.spread.get(device, Texel::Rgba, width, coarse.level_height(0))?;
            pass.expand(runner, onto_finer(Axis::X, first[0]), coarse, spread)?;
            let sums = self.last.get(device, Texel::Rgba, width, height)?;
            pass.expand(runner, onto_finer(Axis::Y, first[1]), spread, sums)?;
            self.any = true;
        }
        for placed in terms {
            let radius = placed.half.len() as i32 - 1;
            let whole: Vec<f64> = placed.half.iter().skip(1).rev().chain(&placed.half).copied().collect();
            // The weight goes with the first half, as on the CPU.
            let weighted: Vec<f64> = whole.iter().map(|tap| placed.weight * tap).collect();
            // Only the rows that are met.
            let top = (first[1] - radius).max(0);
            let bottom = (first[1] + height as i32 + radius).min(source.level_height(0) as i32);
            let across = self.across.get(device, Texel::Rgba, width, (bottom - top) as u32)?;
            let rows = Convolve { axis: Axis::X, taps: &weighted, first: first[0] - radius, stride: 1, aside: top };
            pass.convolve(runner, rows, source, None, across)?;
            std::mem::swap(&mut self.last, &mut self.before);
            let before = if self.any { self.before.current() } else { None };
            let sums = self.last.get(device, Texel::Rgba, width, height)?;
            let columns = Convolve { axis: Axis::Y, taps: &whole, first: first[1] - radius - top, stride: 1, aside: 0 };
            pass.convolve(runner, columns, across, before, sums)?;
            self.any = true;
        }
        Ok(())
    }
}

/// What went wrong.
enum Failed {
    Device(Error),
    Photo(veil::Error),
}

impl From<veil::Error> for Failed {
    fn from(error: veil::Error) -> Self {
        Self::Photo(error)
    }
}

/// A plan as the device takes it.
fn planned<'a>(plan: &'a Plan, runner: &Runner) -> Result<OnDevice<'a>> {
    let refused = |why: &str| Err(Error::Plan(format!("the device does not sum this veil: {why}")));
    let Some(planned) = plan.on_device() else {
        return refused("it is not planned on lattices of a plane, or is too dim for 32-bit floats there");
    };
    let limits = &runner.device().info().limits;
    let most = limits.texture_size.min(limits.viewport[0]).min(limits.viewport[1]);
    if planned.sources_size().iter().any(|side| *side > most as usize) {
        return refused(&format!("with its border the picture is larger than {most} pixels"));
    }
    let layers = planned.layers();
    let mut terms = layers.direct.iter().chain(layers.lattices.iter().flatten());
    if terms.any(|placed| 2 * placed.half.len() - 1 > MOST_TAPS) {
        return refused("it has a kernel of too many taps");
    }
    Ok(planned)
}

fn current(texture: &Scratch) -> Result<&Texture> {
    texture.current().ok_or_else(|| Error::Gl("a veil's texture is not there".into()))
}
