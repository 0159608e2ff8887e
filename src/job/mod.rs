//! A look laid over a photo: find, plan, render, certify. What the command line and the window do alike.
//!
//! ```no_run
//! # use std::path::Path;
//! # use vglare::{gpu::{Backend, Device}, job::{Computer, Job, Stages, Unwatched, Wanted}, look::Look, photo};
//! let mut computer = Computer::new(Device::open(&Backend::ALL)?);
//! let look = Look { strength: 1.5, ..Look::default() };
//! let mut job = Job::new(&look, photo::read(Path::new("night.exr"))?, Stages::default())?;
//! job.compute(Some(&mut computer), Wanted::default(), &Unwatched)?;
//! photo::write(Path::new("out.exr"), &job.photo, &photo::WriteOptions::default())?;
//! # Ok::<(), vglare::Error>(())
//! ```

mod excess;
mod planned;
mod settings;

use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;

use crate::certificate::{Certificate, Verify};
use crate::gpu::{Device, Info, PassTime};
use crate::look::{Gathered, Look};
use crate::photo::{self, BadPixels, Photo};
use crate::problem::Problem;
use crate::renderer::{Pending, Picture, Settings};
use crate::{Error, Result};

pub use crate::calibration::Known;
pub use planned::{Planned, plan};
pub use settings::{bright_light, settings};

/// A photo, and what has come to be known of it on its way to a picture.
pub struct Job<'a> {
    /// What is laid over it.
    pub look: &'a Look,
    /// The photo; the picture, once its glare is computed.
    pub photo: Photo,
    /// Its pixels that are no light.
    pub bad: BadPixels,
    /// What glares in it.
    pub scene: Gathered,
    settings: Settings,
    /// The glare alone, where that is asked for.
    pub glare: Option<Vec<[f32; 4]>>,
    /// What it was computed on; this and the next are there once it is computed.
    pub info: Option<Arc<Info>>,
    /// How.
    pub planned: Option<Planned>,
    /// How exactly.
    pub certificate: Option<Certificate>,
    /// How long each pass took.
    pub passes: Vec<PassTime>,
    /// Milliseconds that spectrum, field and composite took, without upload and readback; where passes were timed.
    pub measured_ms: Option<f64>,
    /// How long each stage took, from reading on.
    pub stages: Stages,
    /// What a person ought to know.
    pub warnings: Vec<String>,
}

/// What is wanted. The picture does not depend on what else is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// The picture; without it the photo stays as it is.
    pub picture: bool,
    /// The glare alone.
    pub glare: bool,
    /// How long each pass takes, at the price of doing one after the other.
    pub times: bool,
    /// Where the error is measured.
    pub verify: Verify,
    /// Whether to plan by what `vglare calibrate` measured here; otherwise by the built-in cost model.
    pub calibrated: bool,
}

impl Default for Wanted {
    /// The picture alone.
    fn default() -> Self {
        Self { picture: true, glare: false, times: false, verify: Verify::Sample, calibrated: true }
    }
}

/// Someone who watches a job, and may call it off.
pub trait Watch {
    /// What goes on now.
    fn step(&self, what: &'static str);

    /// From now on, so many pixels are to be measured.
    fn measured(&self, pixels: usize);

    /// So many more pixels have been measured.
    fn advance(&self, pixels: usize);

    /// Whether to stop: asked between the steps.
    fn cancelled(&self) -> bool {
        false
    }
}

/// No one.
pub struct Unwatched;

impl Watch for Unwatched {
    fn step(&self, _: &'static str) {}

    fn measured(&self, _: usize) {}

    fn advance(&self, _: usize) {}
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

impl Stages {
    /// Lets one stage have some of the milliseconds of another.
    fn shift(&mut self, from: &str, to: &str, milliseconds: f64) {
        for (stage, wall) in &mut self.0 {
            match stage {
                stage if *stage == from => *wall = (*wall - milliseconds).max(0.0),
                stage if *stage == to => *wall += milliseconds,
                _ => {}
            }
        }
    }
}

/// The device and what renders on it, made once for however many photos.
pub struct Computer {
    device: Rc<Device>,
    info: Arc<Info>,
    renderer: Option<Picture>,
    /// Whether what is wrong with the machine, and not with a photo, has been told.
    warned: bool,
}

impl Computer {
    /// What renders on `device`, whose shaders are compiled with the first photo.
    pub fn new(device: Rc<Device>) -> Self {
        let info = Arc::new(device.info().clone());
        Self { device, info, renderer: None, warned: false }
    }

    /// Lets go of what renders, as after a panic in it; the next photo gets another.
    pub fn start_over(&mut self) {
        self.renderer = None;
    }
}

impl<'a> Job<'a> {
    /// Finds what glares in a photo.
    ///
    /// # Errors
    /// Those of [`settings`].
    pub fn new(look: &'a Look, photo: Photo, mut stages: Stages) -> Result<Self> {
        let bad = stages.time("survey", || photo::survey(&photo));
        let scene = stages.time("lights", || look.gather(&photo));
        let mut warnings = photo.source.notes.clone();
        let (settings, warning) = settings(look, &photo, &scene, |threshold| bright_light(&photo, threshold))?;
        warnings.extend(warning);
        Ok(Self {
            look,
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
            warnings,
        })
    }

    /// Lays the glare over the photo. A look of strength 0 has none and needs no computer; without a computer there is
    /// none either.
    ///
    /// # Errors
    /// Where there is no plan, or the driver refuses; [`Error::NotFinite`]; [`Error::Cancelled`].
    pub fn compute(&mut self, computer: Option<&mut Computer>, wanted: Wanted, watch: &impl Watch) -> Result<()> {
        if let Some(computer) = computer.filter(|_| self.look.renders()) {
            return self.render(computer, wanted, watch);
        }
        let dark = || vec![[0.0, 0.0, 0.0, 1.0]; self.photo.frame.window.pixels()];
        self.glare = wanted.glare.then(dark);
        Ok(())
    }

    /// Plans, computes the spectrum, composites onto the photo and measures.
    fn render(&mut self, computer: &mut Computer, wanted: Wanted, watch: &impl Watch) -> Result<()> {
        begin(watch, "planning")?;
        let problem = Problem::new(self.scene.ghosts.clone(), self.photo.frame);
        let device = computer.device.info();
        let planned = self.stages.time("plan", || {
            let known = if wanted.calibrated { Known::of(device) } else { Known::default() };
            plan(&self.look.accuracy, &problem, Some(device), known)
        })?;
        if !std::mem::replace(&mut computer.warned, true) {
            self.warnings.extend(planned.warnings.iter().cloned());
        }
        self.settings.check(planned.plan.scale)?;
        self.info = Some(computer.info.clone());
        self.warnings.extend(self.absurd(&planned.plan));

        // What is not finite in the photo already is no fault of the glare's.
        let before = if self.bad.nan + self.bad.infinite > 0 { photo::not_finite(&self.photo.pixels) } else { 0 };
        begin(watch, "computing the glare")?;
        let renderer = match &mut computer.renderer {
            Some(renderer) => renderer,
            none => none.insert(Picture::new(&computer.device)?),
        };
        renderer.field.set_timing(wanted.times);
        let rendered = self.draw(renderer, &planned, wanted);
        renderer.field.set_timing(false);
        let pending = rendered?;

        self.certify(renderer, &planned, wanted.verify, watch)?;
        self.planned = Some(planned);
        renderer.collect(pending, &mut self.photo.pixels)?;
        self.stays_finite(before)
    }

    /// An error where the picture is not finite though the photo is, but for `before` pixels, or where the glare is not.
    fn stays_finite(&self, before: usize) -> Result<()> {
        let certificate = self.certificate.as_ref().map_or(0, |certificate| certificate.not_finite);
        let picture = photo::not_finite(&self.photo.pixels).saturating_sub(before);
        let glare = self.glare.as_deref().map_or(0, photo::not_finite);
        match picture.max(glare).max(certificate) {
            0 => Ok(()),
            pixels => Err(Error::NotFinite { pixels }),
        }
    }

    /// Draws the picture, some of which may still be on its way back then.
    fn draw(&mut self, renderer: &mut Picture, planned: &Planned, wanted: Wanted) -> Result<Pending> {
        let (frame, settings) = (self.photo.frame, &self.settings);
        self.stages.time("spectrum", || renderer.field.set_scene(&planned.plan))?;
        // What the plan has computed of the spectrum is the spectrum's.
        let computed = planned.plan.spectrum_milliseconds();
        self.stages.shift("plan", "spectrum", computed);
        self.passes = renderer.field.take_times();
        let spectrum = computed + milliseconds(&self.passes);
        if wanted.glare {
            self.glare = Some(self.stages.time("glare", || renderer.glare(frame, settings))?);
        }
        let times = renderer.field.take_times();
        if !wanted.picture {
            self.measured_ms = wanted.times.then(|| spectrum + milliseconds(&times));
            self.passes.extend(times);
            return Ok(Pending::default());
        }
        self.passes.extend(times);
        let pixels = &mut self.photo.pixels;
        let pending = self.stages.time("composite", || {
            if wanted.times {
                // A pass can only be timed while nothing else is under way.
                return renderer.composite(frame, pixels, settings).map(|()| Pending::default());
            }
            renderer.submit(frame, pixels, settings)
        })?;
        let composite = renderer.field.take_times();
        self.measured_ms = wanted.times.then(|| spectrum + milliseconds(&composite));
        self.passes.extend(composite);
        Ok(pending)
    }

    /// Holds the field against the direct sum, and warns where it is further off than was asked.
    fn certify(&mut self, renderer: &mut Picture, planned: &Planned, verify: Verify, watch: &impl Watch) -> Result<()> {
        let plan = &planned.plan;
        begin(watch, "measuring the error")?;
        let certificate = self.stages.time("certify", || match verify {
            Verify::Sample => Certificate::measure(&mut renderer.field, plan),
            Verify::Full => {
                watch.measured(self.photo.frame.window.pixels());
                Certificate::measure_all(&mut renderer.field, plan, |pixels| watch.advance(pixels))
            }
        })?;
        if let Err(error) = certificate.check() {
            self.warnings.push(error.to_string());
        }
        self.certificate = Some(certificate);
        Ok(())
    }
}

/// Says what begins, unless the job is called off.
fn begin(watch: &impl Watch, what: &'static str) -> Result<()> {
    if watch.cancelled() {
        return Err(Error::Cancelled);
    }
    watch.step(what);
    Ok(())
}

/// What a budget is for; moving the picture to the device and back is not in it.
fn milliseconds(passes: &[PassTime]) -> f64 {
    let counts = |time: &&PassTime| time.pass != "upload" && time.pass != "readback";
    passes.iter().filter(counts).map(|time| time.wall_ms).sum()
}
