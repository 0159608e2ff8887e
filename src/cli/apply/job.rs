//! What is done with one photo: read, find, plan, render, certify, write.

use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;

use super::outputs::{Paths, glare_options, picture_options};
use super::{Args, Mix, look};
use crate::Result;
use crate::certificate::{Certificate, Verify};
use crate::cli::accuracy::Planned;
use crate::cli::progress::Progress;
use crate::cli::scene::{Files, Gathered};
use crate::frame::Frame;
use crate::gpu::{Device, Info, PassTime};
use crate::photo::{self, BadPixels, Photo};
use crate::renderer::{Pending, Renderer, Settings};
use crate::scene::Ghost;

/// A photo, and what a run has come to know of it.
pub struct Job<'a> {
    pub args: &'a Args,
    pub paths: &'a Paths,
    pub photo: Photo,
    pub bad: BadPixels,
    pub scene: Gathered,
    settings: Settings,
    /// The glare alone, where that is asked for.
    glare: Option<Vec<[f32; 4]>>,
    pub info: Option<Arc<Info>>,
    pub planned: Option<Planned>,
    pub certificate: Option<Certificate>,
    pub passes: Vec<PassTime>,
    /// Milliseconds that spectrum, field and composite took, without upload and readback; where passes were timed.
    pub measured_ms: Option<f64>,
    pub stages: Stages,
    pub warnings: Vec<String>,
}

/// Stages and their milliseconds.
#[derive(Default)]
pub struct Stages(pub Vec<(&'static str, f64)>);

impl Stages {
    /// Runs one stage and notes how long it took.
    pub fn time<T>(&mut self, name: &'static str, work: impl FnOnce() -> T) -> T {
        let started = Instant::now();
        let result = work();
        self.0.push((name, started.elapsed().as_secs_f64() * 1e3));
        result
    }
}

/// The device and what renders on it, made once for however many photos.
pub struct Computer {
    device: Rc<Device>,
    info: Arc<Info>,
    renderer: Option<Renderer>,
    /// Whether what is wrong with the machine, and not with a photo, has been told.
    warned: bool,
}

impl Computer {
    pub fn new(device: Rc<Device>) -> Self {
        let info = Arc::new(device.info().clone());
        Self { device, info, renderer: None, warned: false }
    }
}

impl<'a> Job<'a> {
    /// Reads a photo and finds what glares in it.
    ///
    /// # Errors
    /// Those of [`photo::read`] and [`Job::found`].
    pub fn read(args: &'a Args, paths: &'a Paths, files: &Files) -> Result<Self> {
        let mut stages = Stages::default();
        let photo = stages.time("read", || photo::read(&paths.input))?;
        Self::found(args, paths, files, photo, stages)
    }

    /// Finds what glares in a photo that has been read.
    ///
    /// # Errors
    /// Those of [`Paths::check`] and [`look::settings`].
    pub fn found(args: &'a Args, paths: &'a Paths, files: &Files, photo: Photo, mut stages: Stages) -> Result<Self> {
        paths.check(args, &photo)?;
        let bad = stages.time("survey", || photo::survey(&photo));
        let scene = stages.time("lights", || files.gather(&photo, &args.find, args.look.mix == Mix::Energy));
        let (settings, warning) = look::settings(&args.look, &photo, &scene)?;
        Ok(Self {
            args,
            paths,
            photo,
            bad,
            scene,
            settings,
            glare: None,
            info: None,
            planned: None,
            certificate: None,
            passes: Vec::new(),
            measured_ms: None,
            stages,
            warnings: warning.into_iter().collect(),
        })
    }

    /// Lays the glare over the photo; without a computer there is none.
    ///
    /// # Errors
    /// Where there is no plan, or the driver refuses.
    pub fn compute(&mut self, computer: Option<&mut Computer>, progress: &Progress) -> Result<()> {
        if let Some(computer) = computer {
            return self.render(computer, progress);
        }
        let dark = || vec![[0.0, 0.0, 0.0, 1.0]; self.photo.frame.window.pixels()];
        self.glare = self.args.output_options.glare.as_ref().map(|_| dark());
        Ok(())
    }

    /// Plans, computes the spectrum, composites onto the photo and measures.
    fn render(&mut self, computer: &mut Computer, progress: &Progress) -> Result<()> {
        let (args, frame) = (self.args, self.photo.frame);
        progress.step("planning");
        let planned =
            self.stages.time("plan", || args.accuracy.plan(&self.scene, frame, Some(computer.device.info())))?;
        if !std::mem::replace(&mut computer.warned, true) {
            self.warnings.extend(planned.warnings.iter().cloned());
        }
        self.info = Some(computer.info.clone());

        progress.step("computing the glare");
        let renderer = match &mut computer.renderer {
            Some(renderer) => renderer,
            none => none.insert(Renderer::new(&computer.device)?),
        };
        let timing = args.verbose || args.output_options.report.is_some() || args.accuracy.budget.is_some();
        renderer.set_timing(timing);
        let rendered = self.draw(renderer, &planned, timing);
        renderer.set_timing(false);
        let pending = rendered?;

        self.certify(progress, renderer, &planned, frame)?;
        self.planned = Some(planned);
        renderer.collect(pending, &mut self.photo.pixels)
    }

    /// Draws the picture, some of which may still be on its way back then.
    fn draw(&mut self, renderer: &mut Renderer, planned: &Planned, timing: bool) -> Result<Pending> {
        let (frame, settings) = (self.photo.frame, &self.settings);
        self.stages.time("spectrum", || renderer.set_scene(&self.scene.ghosts, &planned.plan))?;
        self.passes = renderer.take_times();
        let spectrum = milliseconds(&self.passes);
        if self.args.output_options.glare.is_some() {
            self.glare = Some(self.stages.time("glare", || renderer.glare(frame, settings))?);
        }
        self.passes.extend(renderer.take_times());
        let pixels = &mut self.photo.pixels;
        let pending = self.stages.time("composite", || {
            if timing {
                // A pass can only be timed while nothing else is under way.
                return renderer.composite(frame, pixels, settings).map(|()| Pending::default());
            }
            renderer.submit(frame, pixels, settings)
        })?;
        let composite = renderer.take_times();
        self.measured_ms = timing.then(|| spectrum + milliseconds(&composite));
        self.passes.extend(composite);
        Ok(pending)
    }

    /// Holds the field against the direct sum, and warns where it is further off than was asked.
    fn certify(&mut self, progress: &Progress, renderer: &mut Renderer, planned: &Planned, frame: Frame) -> Result<()> {
        let (plan, verify) = (&planned.plan, self.args.proof.verify);
        let ghosts: &[Ghost] = &self.scene.ghosts;
        // Of a budget or a raised floor, what was reached; otherwise what was asked.
        let asked = plan.tolerance;
        progress.step("measuring the error");
        let certificate = self.stages.time("certify", || match verify {
            Verify::Sample => Certificate::measure(renderer, ghosts, plan, frame, asked),
            Verify::Full => {
                progress.measured(frame.window.pixels());
                Certificate::measure_all(renderer, ghosts, plan, frame, asked, |pixels| progress.advance(pixels))
            }
        })?;
        if let Err(error) = certificate.check() {
            self.warnings.push(error.to_string());
        }
        self.certificate = Some(certificate);
        Ok(())
    }

    /// Writes the picture, and the glare alone where that is asked for.
    ///
    /// # Errors
    /// Those of [`photo::write`].
    pub fn write(&mut self) -> Result<()> {
        let (args, paths, photo) = (self.args, self.paths, &self.photo);
        let glare = self.glare.take();
        self.stages.time("write", || {
            if let (Some(path), Some(pixels)) = (&paths.glare, glare) {
                photo::write(path, &photo.companion(pixels), &glare_options(args))?;
            }
            photo::write(&paths.output, photo, &picture_options(args))
        })
    }
}

/// What a budget is for; moving the picture to the device and back is not in it.
fn milliseconds(passes: &[PassTime]) -> f64 {
    let counts = |time: &&PassTime| time.pass != "upload" && time.pass != "readback";
    passes.iter().filter(counts).map(|time| time.wall_ms).sum()
}
