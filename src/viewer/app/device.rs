//! Another device in the place of one that was lost.

use std::path::PathBuf;
use std::rc::Rc;

use super::App;
use crate::Result;
use crate::gpu::Device;
use crate::gpu::paint::Painter;
use crate::viewer::stage::Stage;

impl App {
    /// Goes on with what is open on another device, which is current. The device before has to be abandoned; counts
    /// begin anew, and what was found out about the picture is found out again.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub fn rebuild(&mut self, device: &Rc<Device>) -> Result<()> {
        let mut painter = Painter::new(device)?;
        // There are fonts from the first frame on; later frames only tell of new letters.
        if self.context.cumulative_pass_nr() > 0 {
            painter.set_fonts(self.context.fonts(|fonts| fonts.image()));
        }
        self.stage = Stage::new(device, self.wake.clone())?;
        self.painter = painter;
        self.probe = None;
        self.devices += 1;
        Ok(())
    }

    /// Remembers the look now, whatever goes on; says in which file, if there is something to remember and a place.
    pub fn keep_look(&mut self) -> Option<PathBuf> {
        self.write_look();
        let state = self.files.state.as_ref()?;
        self.files.kept.as_ref().map(|_| state.look_file())
    }
}
