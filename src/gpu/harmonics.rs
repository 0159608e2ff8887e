//! cos and sin of every harmonic at a list of positions along one axis, as a texture.

use super::layout::{Binding, PASS, PHASES};
use super::resource::{Buffer, Scratch, Texel};
use super::runner::Runner;
use crate::Result;

/// The table of one axis.
pub(crate) struct Harmonics {
    texture: Scratch,
    phases: Buffer<u32>,
    uniforms: Buffer<[u32; 4]>,
    unit: Binding,
}

impl Harmonics {
    /// A table that passes will find at `unit`.
    pub fn new(runner: &Runner, unit: Binding) -> Result<Self> {
        let device = runner.device();
        Ok(Self {
            texture: Scratch::default(),
            phases: Buffer::new(device, 0)?,
            uniforms: Buffer::new(device, 1)?,
            unit,
        })
    }

    /// Fills the table for harmonics 0 to `degree` at `phases`, in 2⁻³² of a period, and binds it.
    ///
    /// For the nodes of a lattice, `spline_step` is the phase from one to the next: the harmonics are then divided by
    /// the cubic B-spline's response to them.
    pub fn fill(&mut self, runner: &Runner, phases: &[u32], degree: u32, spline_step: Option<u32>) -> Result<()> {
        self.phases.store(phases)?;
        self.phases.bind_storage(PHASES);
        self.uniforms.store(&[[u32::from(spline_step.is_some()), spline_step.unwrap_or(0), 0, 0]])?;
        self.uniforms.bind_uniform(PASS);
        let texture = self.texture.get(runner.device(), Texel::Rg, phases.len() as u32, degree + 1)?;
        runner.draw("harmonics.frag", &[], texture, 0)?;
        texture.bind(self.unit);
        Ok(())
    }

    /// Binds the table as it was last filled.
    pub fn bind(&self) {
        if let Some(texture) = self.texture.current() {
            texture.bind(self.unit);
        }
    }

    /// The table as it was last filled: (cos, sin) of each position, harmonic after harmonic.
    #[cfg(test)]
    pub fn values(&self) -> Vec<f32> {
        self.texture.current().map_or(Vec::new(), |texture| texture.read_level(0))
    }
}
