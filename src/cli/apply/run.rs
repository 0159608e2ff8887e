//! The run itself: read, gather, plan, render, certify, write.

use std::rc::Rc;
use std::time::Instant;

use super::gather::{self, Files, Gathered};
use super::report::Report;
use super::{Args, Mix, summary};
use crate::certificate::Certificate;
use crate::cli::progress::Progress;
use crate::gpu::{Device, PassTime};
use crate::photo::{self, Photo, WriteOptions};
use crate::plan::{self, Plan, Request};
use crate::renderer::{Renderer, Settings};
use crate::target;
use crate::{Error, Result};

/// What a run has come to know, for the summary and the report.
pub struct Run<'a> {
    pub args: &'a Args,
    pub device: Option<Rc<Device>>,
    pub plan: Option<Plan>,
    pub certificate: Option<Certificate>,
    pub passes: Vec<PassTime>,
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
        plan: None,
        certificate: None,
        passes: Vec::new(),
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
    let (settings, warning) = gather::settings(args, &photo, &scene)?;
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
        Some(certificate) if args.accuracy.strict => certificate.check(),
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
        let request = Request {
            period: args.accuracy.period.or(scene.period),
            degree: args.accuracy.degree.map(|degree| degree.0).or(scene.degree),
            evaluator: args.accuracy.evaluator,
            loop_rounds: device.info().loop_rounds().unwrap_or(usize::MAX),
            most_terms: (device.info().limits.storage_block / 48) as usize,
            ..Request::new(frame, args.accuracy.tolerance)
        };
        let plan = self.stage("plan", |_| plan::plan(&scene.ghosts, &request))?;

        progress.step("computing the glare");
        let mut renderer = Renderer::new(&device)?;
        renderer.set_timing(args.verbose || args.output_options.report.is_some());
        self.stage("spectrum", |_| renderer.set_scene(&scene.ghosts, &plan))?;
        let glare = match &args.output_options.glare {
            Some(_) => Some(self.stage("glare", |_| renderer.glare(frame, settings))?),
            None => None,
        };
        self.stage("composite", |_| renderer.composite(frame, &mut photo.pixels, settings))?;
        self.passes = renderer.take_times();
        renderer.set_timing(false);

        progress.step("measuring the error");
        let asked = args.accuracy.tolerance;
        let certificate =
            self.stage("certify", |_| Certificate::measure(&mut renderer, &scene.ghosts, &plan, frame, asked))?;
        if let Err(error) = certificate.check() {
            self.warnings.push(error.to_string());
        }
        self.certificate = Some(certificate);
        self.plan = Some(plan);
        Ok(glare)
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
