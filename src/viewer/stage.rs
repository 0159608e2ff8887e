//! The picture on the device. Computes what has changed since it was last asked, and nothing else.

use std::rc::Rc;
use std::time::Instant;

use glam::DVec2;

use super::document::Document;
use super::look::Optics;
use super::viewing::{Placement, Shows};
use crate::Result;
use crate::gpu::{Device, Region, Screen};
use crate::plan::{self, Plan, Request};
use crate::renderer::{Renderer, Settings, View};
use crate::scene::Ghost;

/// The tolerance of a preview, unless the look's own is coarser: half a code of an 8-bit display is 2e-3 of white.
const PREVIEW_TOLERANCE: f64 = 1e-2;

/// How often each kind of work was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Photos that went to the device.
    pub uploads: u64,
    /// Plans made, each with the spectrum that it asks for.
    pub spectra: u64,
    /// Pictures composited.
    pub composites: u64,
    /// Regions of the screen drawn.
    pub views: u64,
}

/// How long each kind of work last took, in milliseconds; until the device had done it, only where it is software.
#[derive(Debug, Clone, Copy, Default)]
pub struct Times {
    /// Planning.
    pub plan: f64,
    /// Spectrum.
    pub spectrum: f64,
    /// Field and composite.
    pub composite: f64,
}

/// What the picture on the device was made from.
#[derive(Default)]
struct Made {
    document: Option<u64>,
    field: Option<(Optics, f64)>,
    picture: Option<(Settings, Shows)>,
}

/// Renders the current document.
pub struct Stage {
    renderer: Renderer,
    made: Made,
    ghosts: Vec<Ghost>,
    plan: Option<Plan>,
    counts: Counts,
    times: Times,
}

impl Stage {
    /// A stage with nothing on it.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        Ok(Self {
            renderer: Renderer::new(device)?,
            made: Made::default(),
            ghosts: Vec::new(),
            plan: None,
            counts: Counts::default(),
            times: Times::default(),
        })
    }

    /// Brings the picture up to date; `number` tells documents apart. A preview may be coarser than the look asks for.
    ///
    /// # Errors
    /// Those of [`plan::plan_at_least`], and [`crate::Error::Gl`] where the driver refuses. What was there stays.
    pub fn update(&mut self, number: u64, document: &Document, preview: bool) -> Result<()> {
        if self.made.document != Some(number) {
            self.made = Made::default();
            self.renderer.forget_scene();
            self.renderer.load(document.frame, &document.pixels)?;
            self.counts.uploads += 1;
            self.made.document = Some(number);
        }
        let shows = document.viewing.shows;
        if shows == Shows::Photo {
            return Ok(());
        }
        self.update_field(document, preview)?;
        if self.made.picture == Some((document.look.settings, shows)) {
            return Ok(());
        }
        let started = Instant::now();
        if self.made.picture.is_some() {
            // The settings change while the field stays: they may well change again.
            self.renderer.hold_field(document.frame)?;
        }
        match shows {
            Shows::Glare => self.renderer.draw_glare(document.frame, &document.look.settings)?,
            Shows::Picture | Shows::Photo => self.renderer.draw(document.frame, &document.look.settings)?,
        }
        self.times.composite = self.elapsed(started);
        self.counts.composites += 1;
        self.made.picture = Some((document.look.settings, shows));
        Ok(())
    }

    fn update_field(&mut self, document: &Document, preview: bool) -> Result<()> {
        let look = &document.look;
        let tolerance = if preview { look.tolerance.max(PREVIEW_TOLERANCE) } else { look.tolerance };
        let wanted = (look.optics(), tolerance);
        if self.made.field.as_ref() == Some(&wanted) {
            return Ok(());
        }
        if self.made.field.as_ref().is_none_or(|(optics, _)| *optics != wanted.0) {
            self.ghosts = wanted.0.ghosts();
        }
        let started = Instant::now();
        let info = self.renderer.device().info();
        let unlimited = Request::new(document.frame, tolerance);
        let request = Request {
            loop_rounds: info.loop_rounds().unwrap_or(usize::MAX),
            // A term takes three vec4.
            most_terms: (info.limits.storage_block / 48) as usize,
            ..unlimited
        };
        let plan = plan::plan_at_least(&self.ghosts, &request)?;
        self.times.plan = started.elapsed().as_secs_f64() * 1e3;
        let started = Instant::now();
        self.renderer.set_scene(&self.ghosts, &plan)?;
        self.times.spectrum = self.elapsed(started);
        self.counts.spectra += 1;
        self.plan = Some(plan);
        self.made.field = Some(wanted);
        self.made.picture = None;
        Ok(())
    }

    fn elapsed(&self, started: Instant) -> f64 {
        // A graphics card goes on by itself, and must not be waited for.
        if self.renderer.device().info().software {
            self.renderer.finish();
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
            (_, Some(wipe)) => wipe * width,
            (_, None) => 0.0,
        };
        let view = View { wipe, surround, ..view(document, placement.origin, placement.pitch) };
        self.draw(&view, screen, placement.region)
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
        self.draw(&View { wipe, ..view(document, center - half, pitch) }, screen, region)
    }

    fn draw(&mut self, view: &View, screen: &Screen, region: Region) -> Result<()> {
        self.counts.views += 1;
        self.renderer.view(view, screen, region)
    }

    /// A pixel of the photo and of the picture, linear, where both are on the device.
    pub fn pixel(&self, column: u32, row: u32) -> Option<[[f32; 4]; 2]> {
        self.renderer.pixel(column, row)
    }

    /// Leaves the stage empty, so that everything is computed anew.
    pub fn clear(&mut self) {
        self.made = Made::default();
        self.renderer.unload();
        self.renderer.forget_scene();
        self.plan = None;
    }

    /// The plan of the picture on the device.
    pub fn plan(&self) -> Option<&Plan> {
        self.plan.as_ref()
    }

    /// Whether the picture on the device is coarser than the document's look asks for.
    pub fn is_preview(&self, document: &Document) -> bool {
        self.made.field.as_ref().is_some_and(|(_, tolerance)| *tolerance > document.look.tolerance)
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

/// A document without surroundings, the picture from the first column on.
fn view(document: &Document, origin: DVec2, pitch: f64) -> View {
    let (exposure, tone_map) = (document.viewing.exposure, document.viewing.tone_map);
    View { origin, pitch, exposure, tone_map, gamut: document.gamut, wipe: 0.0, surround: [0.0; 3] }
}
