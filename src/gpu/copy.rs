//! A copy pass: the yardstick that the bench holds the other passes against.

use super::layout::PHOTO;
use super::resource::{Scratch, Texel, Texture};
use super::runner::Runner;
use crate::Result;

/// Copies a texture into another of the same kind.
#[derive(Default)]
pub(crate) struct CopyPass {
    target: Scratch,
}

impl CopyPass {
    /// Copies `source`.
    pub fn draw(&mut self, runner: &Runner, source: &Texture) -> Result<()> {
        source.bind(PHOTO);
        let target = self.target.get(runner.device(), Texel::Rgba, source.level_width(0), source.level_height(0))?;
        runner.draw("copy.frag", &[], target, 0)
    }
}
