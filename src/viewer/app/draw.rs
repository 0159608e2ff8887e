//! The picture of a frame: brought up to date with the document, drawn, and looked into.

use std::time::Duration;

use super::{App, SETTLED, SLOW, opaque};
use crate::Result;
use crate::gpu::Screen;
use crate::viewer::canvas::Probe;

impl App {
    /// Brings the picture up to date and draws it; says when it is to be drawn again by itself.
    pub(super) fn draw(&mut self, screen: &Screen) -> Result<Duration> {
        let Some(placement) = self.canvas.placement else { return Ok(Duration::MAX) };
        let Some((number, document)) = self.documents.get(self.current) else { return Ok(Duration::MAX) };
        if document.is_asleep() {
            // Nothing of another photo under its name.
            self.stage.clear();
            return Ok(Duration::MAX);
        }
        let still = self.context.time() - self.moved;
        let preview = self.cost > SLOW && still < SETTLED && self.context.egui_is_using_pointer();
        let done = self.stage.counts();
        let (problem, veiling) = (self.stage.problem().is_some(), self.is_veiling());
        self.stage.update(*number, document, preview)?;
        let surround = opaque(self.context.global_style().visuals.extreme_bg_color);
        self.stage.show(document, &placement, surround, screen)?;
        if document.viewing.mask || document.sets_threshold {
            self.stage.mask(document, &placement, screen)?;
        }
        if !preview && self.stage.counts().spectra > done.spectra {
            let times = self.stage.times();
            self.cost = times.plan + times.spectrum + times.composite + times.view;
        }
        let mut again = if preview { Duration::from_secs_f64(SETTLED - still) } else { Duration::MAX };
        if (problem, veiling) != (self.stage.problem().is_some(), self.is_veiling()) {
            again = Duration::ZERO;
        }
        let held = self.context.egui_is_using_pointer();
        let moving = still < SETTLED || held || self.stage.counts().spectra > done.spectra;
        let (news, later) = self.stage.study(document, moving, &self.context)?;
        if news {
            again = Duration::ZERO;
        } else if later && !held {
            // A frame of its own, where a script and no person changed the look.
            again = again.min(Duration::from_secs_f64((SETTLED - still).max(0.02)));
        }
        if let Some(loupe) = self.canvas.loupe {
            self.stage.magnify(document, loupe.center, loupe.side, loupe.before, screen, loupe.region)?;
            let [column, row] = loupe.pixel;
            let probe = self.stage.pixel(document, column, row)?;
            let probe = probe.map(|[photo, picture]| Probe { pixel: loupe.pixel, photo, picture });
            if probe != self.probe {
                // The numbers are known once the picture is; the next frame shows them.
                self.probe = probe;
                again = Duration::ZERO;
            }
        }
        Ok(again)
    }
}
