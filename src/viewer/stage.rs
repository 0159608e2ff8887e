//! The picture on the device. Computes what has changed since it was last asked, and nothing else.

mod clean;
mod show;

use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;

use super::document::Document;
use super::loader::Wake;
use super::model::{self, Accuracy, Look, Work};
use super::removing::Removing;
use super::study::{Picture, Study};
use super::timings::Timings;
use super::veiling::Veiling;
use super::viewing::Shows;
use crate::choices::LightBy;
use crate::frame::Frame;
use crate::gpu::{Device, Screen};
use crate::job::{self, Darkest, Known};
use crate::look::Gathered;
use crate::plan::Plan;
use crate::raster::Raster;
use crate::renderer::{Live, Settings, View};
use crate::scene::{Goal, Knee, Recover, Recovered, Recovery};
use crate::{Error, Result};

/// The tolerance of a preview, unless the look's own is coarser: half a code of an 8-bit display is 2e-3 of white.
const PREVIEW_TOLERANCE: f64 = 1e-2;

/// How often each kind of work was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct Counts {
    /// Photos that went to the device.
    pub uploads: u64,
    /// Plans made, each with the spectrum that it asks for.
    pub spectra: u64,
    /// Veils summed.
    pub veils: u64,
    /// Photos from which a veil was taken away.
    pub removals: u64,
    /// Pictures composited.
    pub composites: u64,
    /// Regions of the screen drawn.
    pub views: u64,
    /// Times that a picture at rest was looked into.
    pub studies: u64,
}

/// How long each kind of work last took, in milliseconds; until the device had done it, only where it is software.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct Times {
    /// Planning.
    pub plan: f64,
    /// Spectrum.
    pub spectrum: f64,
    /// Field and composite.
    pub composite: f64,
    /// Drawing all of the picture on the screen.
    pub view: f64,
    /// Planning and summing the veil, in the background.
    pub veil: f64,
}

/// What the light of bright pixels goes by: which brightness, a threshold, a unit of lengths, and how clipped highlights shine.
type Bright = (LightBy, f64, f64, Recover);

/// What the picture on the device was made from.
#[derive(Default)]
struct Made {
    document: Option<u64>,
    scene: Option<Gathered>,
    /// The look of the field, as it was planned for, and the pixels that it was planned for.
    look: Option<Look>,
    frame: Option<Frame>,
    picture: Option<(Settings, Shows)>,
    /// The light of the photo's bright pixels, for a threshold of some brightness and a unit of lengths.
    bright: Option<(Bright, [f64; 3])>,
    /// The light of all pixels, once it was asked for, in the unit of its frame.
    raster: Option<((Knee, Recover), Arc<Raster>)>,
    /// How the photo's pixels shine.
    recovered: Option<Arc<Recovered>>,
    /// The constant term of the spectrum that is there, once it was asked for.
    constant: Option<[f64; 3]>,
    /// Whether that picture was drawn; a view can often do without.
    drawn: bool,
    /// A look that there is no picture of, and why.
    refused: Option<(Look, String)>,
    preview: bool,
}

impl Made {
    /// The light of all pixels of the document's photo as a look has it, on a frame.
    fn raster(&mut self, document: &Document, recovered: &Recovered, look: &Look, frame: &Frame) -> Arc<Raster> {
        let by = (look.find.knee(), recovered.by);
        let made = self.raster.take().filter(|(made, raster)| *made == by && raster.frame() == *frame);
        let made = made.unwrap_or_else(|| (by, look.raster(&document.photo, recovered, frame)));
        self.raster.insert(made).1.clone()
    }

    /// How the pixels of the document's photo shine by a look.
    fn recovered(&mut self, document: &Document, look: &Look) -> Arc<Recovered> {
        let made = self.recovered.take().filter(|made| made.by == look.find.recover);
        self.recovered.insert(made.unwrap_or_else(|| document.recovered(look))).clone()
    }
}

/// What the canvas shows: a view, of which picture.
#[derive(PartialEq)]
struct Shown {
    view: View,
    uploads: u64,
    composites: u64,
}

/// Renders the current document.
pub struct Stage {
    live: Live,
    /// The canvas as it was last drawn: where only a panel changes, it is copied.
    canvas: Option<(Screen, Shown)>,
    made: Made,
    /// What `vglare calibrate` measured on this device.
    known: Known,
    plan: Option<Plan>,
    counts: Counts,
    times: Times,
    timings: Timings,
    study: Study,
    veiling: Veiling,
    removing: Removing,
}

impl Stage {
    /// A stage with nothing on it; `wake` is called when something more is known of the picture.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn new(device: &Rc<Device>, wake: Wake) -> Result<Self> {
        Ok(Self {
            live: Live::new(device)?,
            canvas: None,
            made: Made::default(),
            known: Known::of(device.info()),
            plan: None,
            counts: Counts::default(),
            times: Times::default(),
            timings: Timings::default(),
            study: Study::new(wake.clone()),
            veiling: Veiling::new(wake.clone()),
            removing: Removing::new(wake),
        })
    }

    /// Brings the picture up to date; `number` tells documents apart. A preview may be coarser than the look asks for.
    /// Where there is no plan for the look, [`Stage::problem`] says why, and what was there stays.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn update(&mut self, number: u64, document: &Document, preview: bool) -> Result<()> {
        if self.made.document != Some(number) {
            self.made = Made::default();
            self.live.picture.field.forget_scene();
            self.live.picture.load(document.frame, document.pixels())?;
            self.veiling.clear();
            self.removing.clear();
            self.counts.uploads += 1;
            self.made.document = Some(number);
        }
        let shows = document.viewing.shows;
        if shows == Shows::Photo {
            return Ok(());
        }
        let look = wanted(document, preview);
        if self.made.refused.as_ref().is_some_and(|(refused, _)| *refused == look) {
            return Ok(());
        }
        self.made.refused = None;
        match self.render(number, document, &look, shows, preview) {
            Err(error @ Error::Gl(_)) => return Err(error),
            Err(error) => self.made.refused = Some((look, error.to_string())),
            Ok(()) => self.made.preview = preview,
        }
        Ok(())
    }

    /// Does again what a look that has changed asks for.
    fn render(&mut self, number: u64, document: &Document, look: &Look, shows: Shows, preview: bool) -> Result<()> {
        let mut work = self.made.look.as_ref().map_or(Work::Lights, |made| model::work(made, look));
        if preview != self.made.preview {
            work = work.max(Work::Plan);
        }
        if work >= Work::Plan {
            // Until all of it is done, what is there is of no look.
            self.made.look = None;
        }
        // A unit that cannot be had is told before anything is made in another.
        let whole = look.frame(&document.photo)?;
        // A preview is no other veil.
        let (known, frame) = (document.known_look(), document.frame.in_units_of(whole.unit));
        let recovered = self.made.recovered(document, &known);
        self.veiling.ask(number, document, &recovered, frame, &known, shows == Shows::Glare)?;
        if work >= Work::Ghosts {
            let images = look.images(&document.photo, || self.made.raster(document, &recovered, look, &whole));
            let recovery = recovered.told.clone();
            self.made.scene = Some(Gathered {
                images,
                recovery,
                ..look.gather_from(Some(document.found.clone()), &document.photo, &whole)
            });
        }
        let Some(scene) = &self.made.scene else { return Ok(()) };
        let (bright, by) = (&mut self.made.bright, look.find.by);
        let (mut settings, _) = job::settings(look, &document.photo, scene, |threshold| match *bright {
            Some((known, light)) if known == (by, threshold, whole.unit, recovered.by) => light,
            _ => {
                let light = job::bright_light(&document.photo, &recovered, &whole, by, threshold);
                bright.insert(((by, threshold, whole.unit, recovered.by), light)).1
            }
        })?;
        if work >= Work::Plan {
            // Pixels are not looked at one by one while they move.
            let frame = if preview && settings.is_affine() { halved(document.frame) } else { document.frame };
            let darkest = Darkest::new(look, &document.photo, &scene.problem(document.frame))?;
            self.update_field(frame, look, darkest)?;
        }
        self.made.look = Some(look.clone());
        if document.viewing.without_constant {
            let constant = &mut self.made.constant;
            settings.constant =
                *constant.get_or_insert_with(|| self.live.picture.field.constant_term().unwrap_or_default());
        }
        if shows == Shows::Clean {
            settings = self.cleaned(number, document, frame, &known, preview)?;
        } else {
            if self.veiling.load(&mut self.live.picture, document, shows == Shows::Glare)? {
                self.removing.unload();
                self.made.picture = None;
            }
            settings.overlay = self.veiling.weights();
        }
        if self.made.picture == Some((settings, shows)) {
            return Ok(());
        }
        let started = Instant::now();
        // The settings may well change again while the field stays.
        self.live.picture.field.hold(self.made.frame.unwrap_or(document.frame))?;
        (self.made.picture, self.made.drawn) = (Some((settings, shows)), false);
        if !settings.is_affine() {
            self.draw_picture(document)?;
        }
        self.times.composite = self.elapsed(started);
        self.counts.composites += 1;
        Ok(())
    }

    /// Draws the picture, unless it is drawn.
    fn draw_picture(&mut self, document: &Document) -> Result<()> {
        let Some((settings, shows)) = self.made.picture.filter(|_| !self.made.drawn) else { return Ok(()) };
        match shows {
            Shows::Glare => self.live.picture.draw_glare(document.frame, &settings)?,
            Shows::Picture | Shows::Photo | Shows::Clean => self.live.picture.draw(document.frame, &settings)?,
        }
        self.made.drawn = true;
        Ok(())
    }

    /// Plans as `vglare apply` does, and computes the spectrum.
    fn update_field(&mut self, frame: Frame, look: &Look, darkest: Option<Darkest>) -> Result<()> {
        let Some(scene) = &self.made.scene else { return Ok(()) };
        let started = Instant::now();
        let device = self.live.picture.field.device().info();
        let problem = scene.problem(frame);
        let known = self.known.clone();
        let planned = job::plan(&look.accuracy, darkest.as_ref(), &problem, Some(device), known)?;
        self.times.plan = started.elapsed().as_secs_f64() * 1e3;
        let started = Instant::now();
        self.live.picture.field.set_scene(&planned.plan)?;
        self.times.spectrum = self.elapsed(started);
        self.counts.spectra += 1;
        self.made.constant = None;
        self.plan = Some(planned.plan);
        (self.made.frame, self.made.picture) = (Some(frame), None);
        Ok(())
    }

    fn elapsed(&self, started: Instant) -> f64 {
        // A graphics card goes on by itself, and must not be waited for.
        if self.live.picture.field.device().info().software {
            self.live.picture.field.finish();
        }
        started.elapsed().as_secs_f64() * 1e3
    }

    /// Looks into the picture as the document wants it, unless it is a preview or `moving`. Says whether there is news
    /// to be shown, and, while it is moving, whether there is something to begin afterwards.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn study(&mut self, document: &Document, moving: bool, context: &egui::Context) -> Result<(bool, bool)> {
        let news = self.study.take_in(context)?;
        let (Some(plan), Some(_), Some(_)) = (&self.plan, &self.made.scene, &self.made.look) else {
            return Ok((news, false));
        };
        let picture = Picture { number: self.counts.spectra, plan };
        self.study.forget_others(picture.number);
        let wanted = &document.viewing.wanted;
        if self.made.preview || !self.study.is_due(picture.number, wanted, picture.plan.problem().frame()) {
            return Ok((news, false));
        }
        if moving {
            return Ok((news, true));
        }
        self.counts.studies += 1;
        let known = self.study.begin(&picture, wanted, &mut self.live.picture.field, context)?;
        Ok((news || known, false))
    }

    /// Takes in a veil that has been summed.
    pub fn take_in(&mut self) {
        self.veiling.take_in();
        self.removing.take_in();
    }

    /// The veil of the picture.
    pub fn veiling(&self) -> &Veiling {
        &self.veiling
    }

    /// What is known of the picture on the device.
    pub fn known(&self) -> &Study {
        &self.study
    }

    /// How long frames and their parts took.
    pub fn timings(&self) -> &Timings {
        &self.timings
    }

    /// A frame begins, at a time in seconds.
    pub fn tick(&mut self, time: f64) {
        self.timings.tick(time);
    }

    /// Leaves the stage empty, so that everything is computed anew.
    pub fn clear(&mut self) {
        self.made = Made::default();
        self.canvas = None;
        self.live.unload();
        self.live.picture.field.forget_scene();
        self.plan = None;
        self.veiling.clear();
        self.removing.clear();
    }

    /// The plan of the picture on the device.
    pub fn plan(&self) -> Option<&Plan> {
        self.plan.as_ref()
    }

    /// What became of clipped highlights in the picture on the device, if there are any.
    pub fn recovery(&self) -> Option<&Recovery> {
        self.made.scene.as_ref()?.recovery.as_ref()
    }

    /// Whether the picture on the device is coarser than its look asks for.
    pub fn is_preview(&self) -> bool {
        self.made.preview
    }

    /// Why there is no picture of the look that was asked for last; that on the device is of another then.
    pub fn problem(&self) -> Option<&str> {
        let refused = self.made.refused.as_ref().map(|(_, reason)| reason.as_str());
        refused.or_else(|| self.veiling.problem())
    }

    /// How often each kind of work was done.
    pub fn counts(&self) -> Counts {
        Counts { veils: self.veiling.effort().0, removals: self.removing.count(), ..self.counts }
    }

    /// How long each kind of work last took.
    pub fn times(&self) -> Times {
        Times { veil: self.veiling.effort().1, ..self.times }
    }
}

/// A frame of half as many columns and rows; the same where not all of it is stored.
fn halved(frame: Frame) -> Frame {
    let (width, height) = (frame.width, frame.height);
    let whole = frame == frame.resized(width, height);
    if whole { frame.resized(width.div_ceil(2), height.div_ceil(2)) } else { frame }
}

/// The look that is to be rendered.
fn wanted(document: &Document, preview: bool) -> Look {
    let mut look = document.known_look();
    if preview {
        let tolerance = match look.accuracy.goal {
            Goal::Tolerance(tolerance) => tolerance.max(PREVIEW_TOLERANCE),
            Goal::Budget(_) => PREVIEW_TOLERANCE,
        };
        let goal = Goal::Tolerance(tolerance);
        look.accuracy = Accuracy { goal, allow_floor: true, ..look.accuracy };
    }
    look
}
