//! The run itself: read, gather, plan, render, certify, write.

use std::rc::Rc;
use std::time::Instant;

use super::report::Report;
use super::{Args, Mix, look, summary};
use crate::certificate::{Certificate, Verify};
use crate::cli::accuracy::Planned;
use crate::cli::progress::Progress;
use crate::cli::scene::{Files, Gathered};
use crate::frame::Frame;
use crate::gpu::{Device, PassTime};
use crate::photo::{self, Photo, WriteOptions};
use crate::renderer::{Renderer, Settings};
use crate::scene::Ghost;
use crate::target;
use crate::{Error, Result};

/// What a run has come to know, for the summary and the report.
pub struct Run<'a> {
    pub args: &'a Args,
    pub device: Option<Rc<Device>>,
    pub planned: Option<Planned>,
    pub certificate: Option<Certificate>,
    pub passes: Vec<PassTime>,
    /// Milliseconds that spectrum, field and composite took, without upload and readback; where passes were timed.
    pub measured_ms: Option<f64>,
    /// Stages and their milliseconds.
    pub stages: Vec<(&'static str, f64)>,
    pub warnings: Vec<String>,
}

/// Lays glare over a photo.
///
/// # Errors
/// Whatever keeps the picture from being written; nothing is left half-written then.
pub fn run(args: &Args) -> Result<()> {
    let progress = Progress::start(args.quiet);
    let mut run = Run {
        args,
        device: None,
        planned: None,
        certificate: None,
        passes: Vec::new(),
        measured_ms: None,
        stages: Vec::new(),
        warnings: Vec::new(),
    };
    let files = Files::read(&args.scene)?;
    progress.step("reading the photo");
    let mut photo = run.read()?;
    run.check_targets(&photo)?;

    progress.step("finding the lights");
    let bad = run.stage("survey", |_| photo::survey(&photo));
    let scene = run.stage("lights", |_| files.gather(&photo, &args.find, args.look.mix == Mix::Energy));
    let (settings, warning) = look::settings(&args.look, &photo, &scene)?;
    run.warnings.extend(warning);

    let glare = if args.look.strength == 0.0 {
        let dark = || vec![[0.0, 0.0, 0.0, 1.0]; photo.frame.window.pixels()];
        args.output_options.glare.as_ref().map(|_| dark())
    } else {
        run.render(&progress, &mut photo, &scene, &settings)?
    };

    progress.step("writing");
    run.write(&photo, glare)?;
    if let Some(path) = &args.output_options.report {
        target::write_json(path, &Report::new(&run, &photo, &bad, &scene), args.force)?;
    }
    drop(progress);
    summary::print(&run, &photo, &bad, &scene)?;
    match &run.certificate {
        Some(certificate) if args.proof.strict => certificate.check(),
        _ => Ok(()),
    }
}

impl Run<'_> {
    /// Runs one stage and notes how long it took.
    fn stage<T>(&mut self, name: &'static str, work: impl FnOnce(&mut Self) -> T) -> T {
        let started = Instant::now();
        let result = work(self);
        self.stages.push((name, started.elapsed().as_secs_f64() * 1e3));
        result
    }

    /// Reads the photo while the GL context opens: neither needs the other, and both take a while.
    fn read(&mut self) -> Result<Photo> {
        let (args, renders) = (self.args, self.args.look.strength != 0.0);
        self.stage("read", |run| {
            std::thread::scope(|scope| {
                let photo = scope.spawn(|| photo::read(&args.input));
                let device = renders.then(|| Device::open(args.accuracy.backend.backends()));
                let photo =
                    photo.join().unwrap_or_else(|_| Err(Error::read_photo(&args.input, "the reader failed")))?;
                run.device = device.transpose()?;
                Ok(photo)
            })
        })
    }

    /// Everything that could keep the results from being written, before the work begins.
    fn check_targets(&self, photo: &Photo) -> Result<()> {
        let outputs = &self.args.output_options;
        photo::check_target(&self.args.output, photo, &self.picture_options())?;
        if let Some(path) = &outputs.glare {
            photo::check_target(
                path,
                &photo.companion(vec![[0.0; 4]; photo.frame.window.pixels()]),
                &self.glare_options(),
            )?;
        }
        if let Some(path) = &outputs.report {
            target::check(path, self.args.force)?;
        }
        let paths = [Some(&self.args.output), outputs.glare.as_ref(), outputs.report.as_ref()];
        let paths: Vec<_> = paths.into_iter().flatten().collect();
        if (1..paths.len()).any(|k| paths[..k].contains(&paths[k])) {
            return Err(Error::Usage("--output, --glare and --report need a file each".into()));
        }
        Ok(())
    }

    fn picture_options(&self) -> WriteOptions {
        let outputs = &self.args.output_options;
        WriteOptions {
            depth: outputs.depth.map(Into::into),
            exposure: outputs.exposure,
            tone_map: outputs.tonemap.map(Into::into),
            overwrite: self.args.force,
        }
    }

    fn glare_options(&self) -> WriteOptions {
        // The glare is to be measured, not looked at: always as exact as the format allows.
        WriteOptions { depth: None, exposure: 0.0, tone_map: None, overwrite: self.args.force }
    }

    /// Plans, computes the spectrum, composites onto the photo and measures; gives the glare alone where asked for.
    fn render(
        &mut self,
        progress: &Progress,
        photo: &mut Photo,
        scene: &Gathered,
        settings: &Settings,
    ) -> Result<Option<Vec<[f32; 4]>>> {
        let device = self.device.clone().ok_or_else(|| Error::Gl("no device was opened".into()))?;
        let (args, frame) = (self.args, photo.frame);
        progress.step("planning");
        let planned = self.stage("plan", |_| args.accuracy.plan(scene, frame, Some(device.info())))?;
        self.warnings.extend(planned.warnings.iter().cloned());
        let plan = &planned.plan;

        progress.step("computing the glare");
        let mut renderer = Renderer::new(&device)?;
        let timing = args.verbose || args.output_options.report.is_some() || args.accuracy.budget.is_some();
        renderer.set_timing(timing);
        self.stage("spectrum", |_| renderer.set_scene(&scene.ghosts, plan))?;
        self.passes = renderer.take_times();
        let spectrum = milliseconds(&self.passes);
        let glare = match &args.output_options.glare {
            Some(_) => Some(self.stage("glare", |_| renderer.glare(frame, settings))?),
            None => None,
        };
        self.passes.extend(renderer.take_times());
        self.stage("composite", |_| renderer.composite(frame, &mut photo.pixels, settings))?;
        let composite = renderer.take_times();
        self.measured_ms = timing.then(|| spectrum + milliseconds(&composite));
        self.passes.extend(composite);
        renderer.set_timing(false);

        self.certify(progress, &mut renderer, &scene.ghosts, &planned, frame)?;
        self.planned = Some(planned);
        Ok(glare)
    }

    /// Holds the field against the direct sum, and warns where it is further off than was asked.
    fn certify(
        &mut self,
        progress: &Progress,
        renderer: &mut Renderer,
        ghosts: &[Ghost],
        planned: &Planned,
        frame: Frame,
    ) -> Result<()> {
        let (plan, verify) = (&planned.plan, self.args.proof.verify);
        // Of a budget or a raised floor, what was reached; otherwise what was asked.
        let asked = plan.tolerance;
        progress.step("measuring the error");
        let certificate = self.stage("certify", |_| match verify {
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

    fn write(&mut self, photo: &Photo, glare: Option<Vec<[f32; 4]>>) -> Result<()> {
        let args = self.args;
        self.stage("write", |run| {
            if let (Some(path), Some(pixels)) = (&args.output_options.glare, glare) {
                photo::write(path, &photo.companion(pixels), &run.glare_options())?;
            }
            photo::write(&args.output, photo, &run.picture_options())
        })
    }
}

/// What a budget is for; moving the picture to the device and back is not in it.
fn milliseconds(passes: &[PassTime]) -> f64 {
    let counts = |time: &&PassTime| time.pass != "upload" && time.pass != "readback";
    passes.iter().filter(counts).map(|time| time.wall_ms).sum()
}
