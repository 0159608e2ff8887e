//! Layers of the photo's size whose weighted sum is laid over it: a veil's.

use super::layout::{Binding, OVERLAY, OVERLAY_LAYERS};
use super::resource::{Scratch, Texel, Texture};
use super::runner::Runner;
use super::shader::Define;
use crate::Result;

/// Every count of layers, as shaders are specialised with it.
const COUNTS: [&str; OVERLAY_LAYERS] = ["1", "2", "3", "4"];

/// What shaders are specialised with for so many layers.
pub(crate) fn defines(count: usize) -> Option<Define<'static>> {
    count.checked_sub(1).map(|index| ("OVERLAY_LAYERS", COUNTS[index]))
}

/// The binding of one layer.
pub(crate) fn binding(layer: usize) -> Binding {
    (OVERLAY.0, OVERLAY.1 + layer as u32)
}

/// The layers on the device.
#[derive(Default)]
pub(crate) struct Overlay {
    layers: [Scratch; OVERLAY_LAYERS],
    count: usize,
    /// How often they were filled.
    stamp: u64,
}

impl Overlay {
    /// Takes other layers, at most [`OVERLAY_LAYERS`] of them, each row by row from the top.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver cannot hold them; there are none then.
    pub fn load(&mut self, runner: &Runner, [width, height]: [u32; 2], layers: &[Vec<[f32; 4]>]) -> Result<()> {
        assert!(layers.len() <= OVERLAY_LAYERS, "no more layers than there are units");
        self.count = 0;
        self.stamp += 1;
        for (scratch, pixels) in self.layers.iter_mut().zip(layers) {
            let texture = scratch.get(runner.device(), Texel::Rgba, width, height)?;
            texture.write(pixels, width as usize, width, height);
        }
        for unused in &mut self.layers[layers.len()..] {
            *unused = Scratch::default();
        }
        self.count = layers.len();
        Ok(())
    }

    /// The layers, and what tells them from any before.
    pub fn layers(&self) -> impl ExactSizeIterator<Item = (&Texture, u64)> {
        self.layers[..self.count].iter().map(|layer| (layer.current().expect("it was loaded"), self.stamp))
    }

    /// Binds every layer.
    pub fn bind(&self) {
        self.layers().enumerate().for_each(|(index, (layer, _))| layer.bind(binding(index)));
    }

    /// Frees them.
    pub fn unload(&mut self) {
        let stamp = self.stamp;
        *self = Self { stamp, ..Self::default() };
    }
}
