//! The series in 64-bit floats: the ways of `evaluators` to it, whose passes leave their results to each other in buffers of
//! doubles, since no texture has them.

use super::layout::{EVALUATOR, Knots, NODES, OFFSETS, SPECTRUM, SUMS, WAVES};
use super::resource::Buffer;
use super::runner::Runner;
use crate::{Error, Result};

/// Invocations of a work group.
pub(super) const GROUP: u32 = 64;

/// Nodes that a pixel's B-spline has along each axis: the error falls with so high a power of the distance between them that
/// few more are needed for a digit more.
pub(crate) const ORDER: u32 = 8;

/// cos and sin of each harmonic at every position along an axis, harmonic after harmonic; all harmonics 0 to the degree.
pub(crate) struct Waves<'a> {
    pub positions: usize,
    pub values: &'a [[f64; 2]],
}

/// A lattice over one tile, and where the tile's pixels lie on it.
pub(crate) struct ExactTile {
    pub knots: [Knots; 2],
    /// Rows of the tile.
    pub height: u32,
}

/// What a series in 64-bit floats keeps from frame to frame.
pub(crate) struct Exact {
    terms: Buffer<[f64; 4]>,
    offsets: Buffer<u32>,
    /// Harmonics of x, 0 included.
    harmonics: usize,
    term_count: usize,
    waves: Buffer<[f64; 2]>,
    sums: Buffer<[f64; 2]>,
    nodes: Buffer<[f64; 2]>,
    knots: Buffer<Knots>,
}

impl Exact {
    pub fn new(runner: &Runner) -> Result<Self> {
        let device = runner.device();
        Ok(Self {
            terms: Buffer::new(device, 0)?,
            offsets: Buffer::from_slice(device, &[0, 0])?,
            harmonics: 0,
            term_count: 0,
            waves: Buffer::new(device, 0)?,
            sums: Buffer::new(device, 0)?,
            nodes: Buffer::new(device, 0)?,
            knots: Buffer::new(device, 2)?,
        })
    }

    /// Takes the spectrum: three terms a mode, A, B, C, D of red, green and blue, harmonic by harmonic of x, of which the n-th
    /// has `counts[n]` modes.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub fn set_spectrum(&mut self, counts: &[u32], terms: &[[f64; 4]]) -> Result<()> {
        let mut offsets = vec![counts.len() as u32, 0];
        offsets.extend(counts.iter().scan(0, |end, count| {
            *end += count;
            Some(*end)
        }));
        assert_eq!(terms.len(), 3 * offsets[offsets.len() - 1] as usize, "three for each kept mode");
        (self.harmonics, self.term_count) = (counts.len(), terms.len());
        self.offsets.store(&offsets)?;
        self.terms.store(terms)
    }

    /// The terms.
    pub fn spectrum(&self) -> Vec<[f64; 4]> {
        self.terms.read(self.term_count)
    }

    /// Readies `series`.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses.
    pub fn series(&mut self, runner: &Runner, [x, y]: [Waves<'_>; 2]) -> Result<()> {
        self.bind();
        store(runner, &mut self.waves, &x)?;
        store(runner, &mut self.sums, &y)?;
        self.waves.bind_storage(WAVES);
        self.sums.bind_storage(SUMS);
        Ok(())
    }

    /// Readies `rows`: what it sums over x, harmonic by harmonic, for every row of the tile.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses, or its storage blocks are too small for a tile of this size.
    pub fn rows(&mut self, runner: &Runner, [x, y]: [Waves<'_>; 2]) -> Result<()> {
        self.bind();
        room(runner, &mut self.sums, 3 * self.harmonics * y.positions)?;
        store(runner, &mut self.waves, &y)?;
        self.waves.bind_storage(WAVES);
        self.sums.bind_storage(SUMS);
        let groups = (y.positions as u32).div_ceil(GROUP);
        runner.dispatch("profiles_double.comp", &[], [groups, self.harmonics as u32, 1])?;
        store(runner, &mut self.waves, &x)?;
        self.waves.bind_storage(WAVES);
        Ok(())
    }

    /// Readies `grid`: the series on the lattice by `rows`, then its columns stretched to every row of the tile. The waves are
    /// those of the lattice's nodes, divided by what the B-spline makes of them.
    ///
    /// # Errors
    /// [`Error::Gl`] where the driver refuses, or its storage blocks are too small for a tile of this size.
    pub fn grid(&mut self, runner: &Runner, waves: [Waves<'_>; 2], tile: &ExactTile) -> Result<()> {
        let [columns, rows] = [0, 1].map(|axis| waves[axis].positions);
        self.rows(runner, waves)?;
        // Two doubles an element.
        room(runner, &mut self.nodes, (3 * columns * rows).div_ceil(2))?;
        self.nodes.bind_storage(NODES);
        runner.dispatch("lattice_double.comp", &[], [(columns as u32).div_ceil(GROUP), rows as u32, 1])?;

        room(runner, &mut self.sums, (3 * columns * tile.height as usize).div_ceil(2))?;
        self.sums.bind_storage(SUMS);
        self.knots.store(&tile.knots)?;
        self.knots.bind_uniform(EVALUATOR);
        runner.dispatch("strips_double.comp", &[], [(3 * columns as u32).div_ceil(GROUP), tile.height, 1])
    }

    fn bind(&self) {
        self.terms.bind_storage(SPECTRUM);
        self.offsets.bind_storage(OFFSETS);
    }
}

/// Uploads waves with how many positions they are of.
fn store(runner: &Runner, buffer: &mut Buffer<[f64; 2]>, waves: &Waves<'_>) -> Result<()> {
    let mut data = Vec::with_capacity(waves.values.len() + 1);
    data.push([f64::from_bits(waves.positions as u64), 0.0]);
    data.extend_from_slice(waves.values);
    room(runner, buffer, data.len())?;
    buffer.store(&data)
}

/// Makes room for so many pairs of doubles.
pub(super) fn room(runner: &Runner, buffer: &mut Buffer<[f64; 2]>, length: usize) -> Result<()> {
    let (bytes, most) = (length * size_of::<[f64; 2]>(), runner.device().info().limits.storage_block);
    if bytes as u64 > most {
        return Err(Error::Gl(format!("a tile needs {bytes} bytes of 64-bit floats, and a storage block has {most}")));
    }
    if buffer.length() < length {
        *buffer = Buffer::new(runner.device(), length)?;
    }
    Ok(())
}
