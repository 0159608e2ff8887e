//! The smallest and the largest value of the field, by a chain of levels as long as a mip chain's.

use bytemuck::{Pod, Zeroable};

use super::layout::{FIELD, PASS, RANGE};
use super::resource::{Buffer, Texel, Texture};
use super::runner::Runner;
use crate::Result;

/// One step's uniforms; as in `range.frag`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Step {
    pub scale: [f32; 4],
    pub size: [i32; 2],
    pub pad: [i32; 2],
}
const _: () = assert!(size_of::<Step>() == 32);

/// Reduces fields, tile after tile, to one pair on the device.
pub(crate) struct RangePass {
    chain: Option<Texture>,
    total: Texture,
    uniforms: Buffer<Step>,
}

impl RangePass {
    pub fn new(runner: &Runner) -> Result<Self> {
        let device = runner.device();
        Ok(Self { chain: None, total: Texture::new(device, Texel::Rg, 1, 1)?, uniforms: Buffer::new(device, 1)? })
    }

    /// Forgets the tiles so far.
    pub fn reset(&self) {
        self.total.clear(f32::INFINITY);
    }

    /// Takes a range for that of all tiles.
    pub fn set(&self, [least, largest]: [f32; 2]) {
        self.total.fill([least, -largest, 0.0, 0.0]);
    }

    /// Takes in a tile's field, whose values are multiplied by `scale` first.
    pub fn add(&mut self, runner: &Runner, field: &Texture, scale: [f32; 3]) -> Result<()> {
        let [width, height] = [field.level_width(0), field.level_height(0)].map(|side| (side / 2).max(1));
        if !self.chain.as_ref().is_some_and(|chain| chain.is(Texel::Rg, width, height)) {
            self.chain = None;
            let levels = width.max(height).ilog2() + 1;
            self.chain = Some(Texture::with_levels(runner.device(), Texel::Rg, width, height, levels)?);
        }
        let chain = self.chain.as_ref().expect("made above");

        let mut step = |source: &Texture, level: u32| {
            let size = [source.level_width(level) as i32, source.level_height(level) as i32];
            self.uniforms.store(&[Step { scale: [scale[0], scale[1], scale[2], 0.0], size, pad: [0; 2] }])?;
            self.uniforms.bind_uniform(PASS);
            Ok::<_, crate::Error>(())
        };
        step(field, 0)?;
        field.bind(FIELD);
        runner.draw("range.frag", &[("FROM_FIELD", "1")], chain, 0)?;
        for level in 1..chain.levels() {
            step(chain, level - 1)?;
            chain.bind_level(RANGE, level - 1);
            runner.draw("range.frag", &[], chain, level)?;
        }
        step(chain, chain.levels() - 1)?;
        chain.bind_level(RANGE, chain.levels() - 1);
        runner.draw_minimum("range.frag", &[], &self.total, 0)
    }

    /// Makes the range visible to the composite.
    pub fn bind(&self) {
        self.total.bind(RANGE);
    }

    /// The smallest and the largest value of the tiles taken in, after waiting for the device.
    pub fn read(&self) -> [f32; 2] {
        let ends = self.total.read_level(0);
        [ends[0], -ends[1]]
    }
}
