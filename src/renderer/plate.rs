//! A plate's field on the device: as a texture of a tile, which the other layers are added to.

use crate::Result;
use crate::frame::{Frame, Window};
use crate::gpu::layout::CANVAS;
use crate::gpu::resource::{Scratch, Texel};
use crate::gpu::runner::Runner;
use crate::plan::{Plan, Plate};

/// The tile that was uploaded last.
#[derive(Default)]
pub(super) struct Plated {
    canvas: Scratch,
    tile: Option<(Frame, Window)>,
}

impl Plated {
    /// Uploads the plate's part of a tile, unless it is there, and binds it where local layers have their canvas.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses, or [`crate::Error::Memory`] where there is no room.
    pub fn draw(&mut self, plan: &Plan, plate: &Plate, runner: &Runner, frame: Frame, tile: Window) -> Result<()> {
        let canvas = self.canvas.get(runner.device(), Texel::Rgba, tile.width, tile.height)?;
        if self.tile != Some((frame, tile)) {
            let sheet = runner.run("plate", || plate.sheet(plan.problem(), frame))?;
            let units = plan.units();
            let window = frame.window;
            let mut pixels = Vec::with_capacity(tile.pixels());
            for row in 0..tile.height as usize {
                let row = (tile.y - window.y) as usize + row;
                let first = row * window.width as usize + (tile.x - window.x) as usize;
                pixels.extend((first..first + tile.width as usize).map(|place| {
                    let value = sheet.pixel(place);
                    let [red, green, blue] = [0, 1, 2].map(|colour| (value[colour] / units[colour]) as f32);
                    [red, green, blue, 0.0]
                }));
            }
            canvas.write(&pixels, tile.width as usize, tile.width, tile.height);
            self.tile = Some((frame, tile));
        }
        canvas.bind(CANVAS);
        Ok(())
    }

    /// Forgets what is there.
    pub fn forget(&mut self) {
        self.tile = None;
    }
}
