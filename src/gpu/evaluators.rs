//! The four ways to the field. Each readies what its GLSL function `glare(pixel)` reads for one tile of the picture;
//! `field`, `composite` and `probe` then include that function.

use bytemuck::{Pod, Zeroable};

use super::harmonics::Harmonics;
use super::layout::{
    CELLS, DIRECT, EVALUATOR, FEW_GHOSTS, GHOSTS, HARMONICS_X, HARMONICS_Y, Knots, LATTICE, PROFILES, SHAPES, STRIPS,
    SummedGhost,
};
use super::resource::{Buffer, Scratch, Texel};
use super::runner::Runner;
use super::spectrum::Spectrum;
use crate::frame::Frame;
use crate::{Error, Result};

/// Where there are many ghosts, `direct` sums this many of them in a round of its loop.
pub(crate) const STEP: usize = 8;
/// And this many before what is lost of their sum is made up for.
pub(super) const BATCH: usize = 64;
/// Kinds of bells, and one more for the end of the last, in whole `uvec4`.
pub(crate) const RUNS: usize = 16;
/// What a uniform block must hold for the ghosts that fit one.
pub(super) const FEW_BYTES: u32 = 64 << 10;

/// What ghosts and parameters of bells are made of, in whichever floats.
pub(super) type Words = [u32; 4];

/// A lattice over one tile, and where the tile's pixels lie on it.
pub(crate) struct LatticeTile<'a> {
    /// Phases of the lattice's columns and rows, in 2⁻³² of a period.
    pub node_phases: [&'a [u32]; 2],
    /// Phase from one node to the next.
    pub steps: [u32; 2],
    /// Where the columns and the rows of the tile lie.
    pub knots: [Knots; 2],
    /// Rows of the tile.
    pub height: u32,
}

/// A tile of a lattice whose nodes have their values.
pub(crate) struct SummedTile<'a> {
    /// Columns and rows.
    pub nodes: [u32; 2],
    /// Row by row.
    pub values: &'a [[f32; 4]],
    /// Where the columns and the rows of the tile lie.
    pub knots: [Knots; 2],
    /// Rows of the tile.
    pub height: u32,
}

/// The uniforms of `direct`, as its shaders have them.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Direct {
    pub corner: [i32; 2],
    pub size: [i32; 2],
    pub count: u32,
    pub pad: u32,
    pub unit: [f32; 2],
    pub aspect: [f64; 2],
    pub runs: [u32; RUNS],
}

/// What the evaluators keep from frame to frame.
pub(crate) struct Evaluators {
    harmonics_x: Harmonics,
    harmonics_y: Harmonics,
    profiles: Scratch,
    lattice: Scratch,
    cells: Scratch,
    strips: Scratch,
    knots: Buffer<Knots>,
    ghosts: Buffer<Words>,
    shapes: Buffer<Words>,
    direct: Buffer<Direct>,
    /// Where the ghosts of each kind of bell begin, and where the last of them end.
    runs: [u32; RUNS],
    many: bool,
}

impl Evaluators {
    pub fn new(runner: &Runner) -> Result<Self> {
        let device = runner.device();
        Ok(Self {
            harmonics_x: Harmonics::new(runner, HARMONICS_X)?,
            harmonics_y: Harmonics::new(runner, HARMONICS_Y)?,
            profiles: Scratch::default(),
            lattice: Scratch::default(),
            cells: Scratch::default(),
            strips: Scratch::default(),
            knots: Buffer::new(device, 2)?,
            // A uniform block's buffer has to be as long as the block.
            ghosts: Buffer::new(device, FEW_BYTES as usize / size_of::<Words>())?,
            shapes: Buffer::new(device, 0)?,
            direct: Buffer::new(device, 1)?,
            runs: [0; RUNS],
            many: false,
        })
    }

    /// Uploads the ghosts that `direct` sums, one list for each kind of bell in the order of the registry, and what their
    /// bells need to know beside: in 32-bit floats or in 64.
    ///
    /// # Errors
    /// [`Error::Gl`] where they are more than the software renderer goes through for one pixel.
    pub fn set_ghosts<G: SummedGhost, S: Pod>(
        &mut self,
        runner: &Runner,
        ghosts: &[Vec<G>],
        shapes: &[S],
    ) -> Result<()> {
        let few = FEW_BYTES as usize / size_of::<G>();
        let count = ghosts.iter().map(Vec::len).sum();
        self.many = count > few || runner.device().info().limits.uniform_block < FEW_BYTES;
        // Ghosts without weight fill the last round of each kind.
        let step = if self.many { STEP } else { 1 };
        let (mut padded, mut rounds) = (Vec::with_capacity(count + step * ghosts.len()), 0);
        self.runs = [0; RUNS];
        for (kind, ghosts) in ghosts.iter().enumerate() {
            let before = padded.len();
            padded.extend_from_slice(ghosts);
            if let Some(last) = ghosts.last() {
                padded.resize(padded.len().next_multiple_of(step), last.without_weight());
            }
            self.runs[kind + 1..].fill(padded.len() as u32);
            let mine = padded.len() - before;
            rounds += mine / step + mine.div_ceil(BATCH);
        }
        within_rounds(runner, rounds, "direct", count, "ghosts")?;
        self.shapes.store(bytemuck::cast_slice(shapes))?;
        self.ghosts.store(bytemuck::cast_slice(&padded))
    }

    /// Readies `direct` for a tile whose first pixel is `corner` in the picture of a frame.
    pub fn direct(&mut self, corner: [i32; 2], frame: Frame) -> Result<()> {
        let size = [frame.width as i32, frame.height as i32];
        let unit = (0.5 * frame.pixel_sides()).to_array().map(|half| half as f32);
        let (count, aspect) = (self.runs[RUNS - 1], [frame.pixel_aspect, frame.unit]);
        self.direct.store(&[Direct { corner, size, count, pad: 0, unit, aspect, runs: self.runs }])?;
        self.direct.bind_uniform(DIRECT);
        if self.many {
            self.ghosts.bind_storage(GHOSTS);
        } else {
            self.ghosts.bind_uniform(FEW_GHOSTS);
        }
        self.shapes.bind_storage(SHAPES);
        Ok(())
    }

    /// Whether `direct` has more ghosts than fit a uniform block.
    pub fn many(&self) -> bool {
        self.many
    }

    /// Readies `series` for pixels at these phases of columns and rows, in 2⁻³² of a period.
    ///
    /// # Errors
    /// [`Error::Gl`] where there are more terms than the software renderer goes through for one pixel.
    pub fn series(&mut self, runner: &Runner, phases: [&[u32]; 2], spectrum: &Spectrum) -> Result<()> {
        let degree = spectrum.degree();
        within_rounds(runner, spectrum.terms() + degree[0] as usize + 1, "series", spectrum.terms(), "terms")?;
        spectrum.bind();
        self.harmonics_x.fill(runner, phases[0], degree[0], None)?;
        self.harmonics_y.fill(runner, phases[1], degree[1], None)
    }

    /// Readies `rows` for pixels at these phases of columns and rows.
    pub fn rows(&mut self, runner: &Runner, phases: [&[u32]; 2], spectrum: &Spectrum) -> Result<()> {
        self.profiles(runner, phases, [None; 2], spectrum)
    }

    /// Readies `grid`: the series on the lattice by rows, then its columns stretched to every row of the tile.
    pub fn grid(&mut self, runner: &Runner, tile: &LatticeTile<'_>, spectrum: &Spectrum) -> Result<()> {
        let device = runner.device();
        self.profiles(runner, tile.node_phases, tile.steps.map(Some), spectrum)?;
        let [columns, rows] = tile.node_phases.map(|phases| phases.len() as u32);
        let lattice = self.lattice.get(device, Texel::Rgba, columns, rows)?;
        runner.draw("lattice.frag", &[("EVALUATOR", "\"evaluators/rows.glsl\"")], lattice, 0)?;
        self.strips_of(runner, [columns, rows], tile.knots, tile.height)
    }

    /// The same where the nodes have their values already.
    pub fn grid_of(&mut self, runner: &Runner, tile: &SummedTile<'_>) -> Result<()> {
        let [columns, rows] = tile.nodes;
        let lattice = self.lattice.get(runner.device(), Texel::Rgba, columns, rows)?;
        lattice.write(tile.values, columns as usize, columns, rows);
        self.strips_of(runner, tile.nodes, tile.knots, tile.height)
    }

    /// The cubics of a tile's rows, of the lattice that is there.
    fn strips_of(&mut self, runner: &Runner, [columns, rows]: [u32; 2], knots: [Knots; 2], height: u32) -> Result<()> {
        let device = runner.device();
        let lattice = self.lattice.get(device, Texel::Rgba, columns, rows)?;
        lattice.bind(LATTICE);
        // Three texels for each cell, of which there are three fewer than nodes.
        let cells = self.cells.get(device, Texel::Rgba, 3 * (columns - 3), rows)?;
        runner.draw("cells.frag", &[], cells, 0)?;

        self.knots.store(&knots)?;
        self.knots.bind_uniform(EVALUATOR);
        cells.bind(CELLS);
        let strips = self.strips.get(device, Texel::Rgba, 3 * (columns - 3), height)?;
        runner.draw("strips.frag", &[], strips, 0)?;
        strips.bind(STRIPS);
        Ok(())
    }

    fn profiles(
        &mut self,
        runner: &Runner,
        phases: [&[u32]; 2],
        steps: [Option<u32>; 2],
        spectrum: &Spectrum,
    ) -> Result<()> {
        let degree = spectrum.degree();
        spectrum.bind();
        self.harmonics_y.fill(runner, phases[1], degree[1], steps[1])?;
        self.harmonics_y.bind();
        let (width, height) = (2 * (degree[0] + 1), phases[1].len() as u32);
        let profiles = self.profiles.get(runner.device(), Texel::Rgba, width, height)?;
        runner.draw("profiles.frag", &[], profiles, 0)?;
        profiles.bind(PROFILES);
        self.harmonics_x.fill(runner, phases[0], degree[0], steps[0])
    }
}

/// Refuses a loop that the software renderer would end too early: a wrong picture without any error.
pub(super) fn within_rounds(runner: &Runner, rounds: usize, evaluator: &str, count: usize, what: &str) -> Result<()> {
    if runner.device().info().loop_rounds().is_some_and(|most| rounds > most) {
        return Err(Error::Gl(format!(
            "the software renderer cannot go through {count} {what} for each pixel, as `{evaluator}` would; \
             `rows` and `grid` need not"
        )));
    }
    Ok(())
}
