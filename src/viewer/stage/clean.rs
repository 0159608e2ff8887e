//! The photo on the screen without its veil.

use super::Stage;
use crate::Result;
use crate::frame::Frame;
use crate::renderer::Settings;
use crate::viewer::document::Document;
use crate::viewer::model::Look;
use crate::viewer::removing::Removing;

impl Stage {
    /// What makes the clean photo of the photo, once it is there, and nothing before.
    pub(super) fn cleaned(
        &mut self,
        number: u64,
        document: &Document,
        frame: Frame,
        look: &Look,
        preview: bool,
    ) -> Result<Settings> {
        if !preview {
            self.removing.ask(number, document, frame, look);
        }
        if self.removing.load(&mut self.live.picture)? {
            self.veiling.unload();
            self.made.picture = None;
        }
        let mut settings = Settings { strength: 0.0, ..Settings::default() };
        settings.overlay[0] = [self.removing.weight(number, frame, look); 3];
        Ok(settings)
    }

    /// The photo without its veil.
    pub fn removing(&self) -> &Removing {
        &self.removing
    }
}
