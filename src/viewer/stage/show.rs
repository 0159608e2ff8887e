//! The picture on the screen: in its place, through the loupe, under the mask, and pixel by pixel.

use std::time::Instant;

use glam::DVec2;

use super::{Shown, Stage};
use crate::Result;
use crate::gpu::{Region, Screen};
use crate::renderer::{Mask, Part, View};
use crate::scene::Emission;
use crate::viewer::document::Document;
use crate::viewer::viewing::{Placement, Shows};

impl Stage {
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
        self.timings.keep(self.counts.composites, self.times());
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
            emission: Emission::of(&document.photo).by(document.look.find.by),
            origin: placement.origin,
            pitch: placement.pitch,
        };
        self.live.mask(&mask, screen, placement.region)
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
}

/// A document without surroundings, the picture from the first column on.
fn view(document: &Document, origin: DVec2, pitch: f64) -> View {
    let (exposure, tone_map) = (document.viewing.exposure, document.viewing.tone_map);
    View { origin, pitch, exposure, tone_map, gamut: document.gamut, wipe: 0.0, surround: [0.0; 3] }
}
