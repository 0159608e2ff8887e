//! The picture on the device. Computes what has changed since it was last asked, and nothing else.

use std::rc::Rc;
use std::time::Instant;

use glam::DVec2;

use super::document::Document;
use super::loader::Wake;
use super::model::{self, Accuracy, Look, Work};
use super::study::{Picture, Study};
use super::timings::Timings;
use super::viewing::{Placement, Shows};
use crate::frame::Frame;
use crate::gpu::{Device, Region, Screen};
use crate::job::{self, Known};
use crate::look::Gathered;
use crate::plan::Plan;
use crate::problem::Problem;
use crate::renderer::{Live, Mask, Part, Settings, View};
use crate::scene::{Emission, Goal};
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
}

/// What the picture on the device was made from.
#[derive(Default)]
struct Made {
    document: Option<u64>,
    scene: Option<Gathered>,
    /// The look of the field, as it was planned for, and the pixels that it was planned for.
    look: Option<Look>,
    frame: Option<Frame>,
    picture: Option<(Settings, Shows)>,
    /// The light of the photo's bright pixels, for a threshold and a unit of lengths.
    bright: Option<((f64, f64), [f64; 3])>,
    /// The constant term of the spectrum that is there, once it was asked for.
    constant: Option<[f64; 3]>,
    /// Whether that picture was drawn; a view can often do without.
    drawn: bool,
    /// A look that there is no picture of, and why.
    refused: Option<(Look, String)>,
    preview: bool,
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
            study: Study::new(wake),
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
        match self.render(document, &look, shows, preview) {
            Err(error @ Error::Gl(_)) => return Err(error),
            Err(error) => self.made.refused = Some((look, error.to_string())),
            Ok(()) => self.made.preview = preview,
        }
        Ok(())
    }

    /// Does again what a look that has changed asks for.
    fn render(&mut self, document: &Document, look: &Look, shows: Shows, preview: bool) -> Result<()> {
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
        if work >= Work::Ghosts {
            self.made.scene = Some(look.gather_from(Some(document.found.clone())));
        }
        let Some(scene) = &self.made.scene else { return Ok(()) };
        let bright = &mut self.made.bright;
        let (mut settings, _) = job::settings(look, &document.photo, scene, |threshold| match *bright {
            Some((known, light)) if known == (threshold, whole.unit) => light,
            _ => bright.insert(((threshold, whole.unit), job::bright_light(&document.photo, &whole, threshold))).1,
        })?;
        if work >= Work::Plan {
            // Pixels are not looked at one by one while they move.
            let frame = if preview && settings.is_affine() { halved(document.frame) } else { document.frame };
            self.update_field(frame, look)?;
        }
        self.made.look = Some(look.clone());
        if document.viewing.without_constant {
            let constant = &mut self.made.constant;
            settings.constant =
                *constant.get_or_insert_with(|| self.live.picture.field.constant_term().unwrap_or_default());
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
            Shows::Picture | Shows::Photo => self.live.picture.draw(document.frame, &settings)?,
        }
        self.made.drawn = true;
        Ok(())
    }

    /// Plans as `vglare apply` does, and computes the spectrum.
    fn update_field(&mut self, frame: Frame, look: &Look) -> Result<()> {
        let Some(scene) = &self.made.scene else { return Ok(()) };
        let started = Instant::now();
        let device = self.live.picture.field.device().info();
        let problem = Problem::new(scene.ghosts.clone(), frame);
        let planned = job::plan(&look.accuracy, &problem, Some(device), self.known.clone())?;
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

    /// Shows the document on its place of the screen.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn show(
        &mut self,
        document: &Document,
        placement: &Placement,
        surround: [f32; 3],
        screen: &Screen,
    ) -> Result<()> {
        let width = f64::from(placement.region.width);
        let wipe = match (document.viewing.shows, document.viewing.wipe) {
            (Shows::Photo, _) => width,
            _ if self.made.picture.is_none() => width,
            (_, Some(wipe)) => wipe * width,
            (_, None) => 0.0,
        };
        let view = View { wipe, surround, ..view(document, placement.origin, placement.pitch) };
        let started = Instant::now();
        let region = placement.region;
        let shown = Shown { view, uploads: self.counts.uploads, composites: self.counts.composites };
        let size = [region.width, region.height];
        let canvas = match self.canvas.take() {
            Some((canvas, was)) if was == shown && canvas.size() == size => canvas,
            old => {
                let reused = old.map(|(canvas, _)| canvas).filter(|canvas| canvas.size() == size);
                let canvas = reused.map_or_else(|| Screen::hidden(self.live.picture.field.device(), size), Ok)?;
                self.draw(document, &view, &canvas, canvas.whole())?;
                canvas
            }
        };
        canvas.copy_to(screen, region);
        self.canvas = Some((canvas, shown));
        self.times.view = self.elapsed(started);
        self.timings.keep(self.counts.composites, self.times);
        Ok(())
    }

    /// Marks on the screen which pixels of the shown photo are light by the threshold as it is set, searched for or not.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn mask(&mut self, document: &Document, placement: &Placement, screen: &Screen) -> Result<()> {
        let threshold = document.look.find.threshold.unwrap_or(document.found.threshold);
        let mask = Mask {
            threshold,
            // A lamp in the dark outshines its neighbours, too.
            firefly_limit: if document.found.fireflies > 0 { document.look.find.firefly_limit } else { 0.0 },
            emission: Emission::of(&document.photo),
            origin: placement.origin,
            pitch: placement.pitch,
        };
        self.live.mask(&mask, screen, placement.region)
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

    /// Shows a part of the document again, as the loupe does: `center` of the picture in the middle of a region, each of
    /// its pixels a square of `side` pixels of the screen.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn magnify(
        &mut self,
        document: &Document,
        center: DVec2,
        side: u32,
        before: bool,
        screen: &Screen,
        region: Region,
    ) -> Result<()> {
        let pitch = 1.0 / f64::from(side);
        let half = DVec2::new(f64::from(region.width), f64::from(region.height)) * (0.5 * pitch);
        let wipe = if before { f64::from(region.width) } else { 0.0 };
        self.draw(document, &View { wipe, ..view(document, center - half, pitch) }, screen, region)
    }

    fn draw(&mut self, document: &Document, view: &View, screen: &Screen, region: Region) -> Result<()> {
        self.counts.views += 1;
        match self.made.picture {
            Some((settings, shows)) if !self.made.drawn => {
                let part = if shows == Shows::Glare { Part::Glare } else { Part::Picture };
                let frame = self.made.frame.unwrap_or(document.frame);
                self.live.view_mixed(frame, &settings, part, view, screen, region)
            }
            _ => self.live.view(view, screen, region),
        }
    }

    /// A pixel of the photo and of the picture, linear, where there are both.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn pixel(&mut self, document: &Document, column: u32, row: u32) -> Result<Option<[[f32; 4]; 2]>> {
        if self.made.picture.is_none() {
            return Ok(None);
        }
        self.draw_picture(document)?;
        Ok(self.live.picture.pixel(column, row))
    }

    /// Leaves the stage empty, so that everything is computed anew.
    pub fn clear(&mut self) {
        self.made = Made::default();
        self.canvas = None;
        self.live.unload();
        self.live.picture.field.forget_scene();
        self.plan = None;
    }

    /// The plan of the picture on the device.
    pub fn plan(&self) -> Option<&Plan> {
        self.plan.as_ref()
    }

    /// Whether the picture on the device is coarser than its look asks for.
    pub fn is_preview(&self) -> bool {
        self.made.preview
    }

    /// Why there is no picture of the look that was asked for last; that on the device is of another then.
    pub fn problem(&self) -> Option<&str> {
        self.made.refused.as_ref().map(|(_, reason)| reason.as_str())
    }

    /// How often each kind of work was done.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// How long each kind of work last took.
    pub fn times(&self) -> Times {
        self.times
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

/// A document without surroundings, the picture from the first column on.
fn view(document: &Document, origin: DVec2, pitch: f64) -> View {
    let (exposure, tone_map) = (document.viewing.exposure, document.viewing.tone_map);
    View { origin, pitch, exposure, tone_map, gamut: document.gamut, wipe: 0.0, surround: [0.0; 3] }
}
