//! The passes that ask an evaluator for the field: at every pixel of a tile, or at a list of its pixels.

use super::layout::{FIELD, PROBES};
use super::resource::{Buffer, Scratch, Texel, Texture};
use super::runner::Runner;
use crate::Result;
use crate::series::Bell;

/// The bells that ghosts are summed with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Bells {
    file: &'static str,
    /// One bit for each kind that the file with all of them has a loop for.
    kinds: u32,
}

impl Bells {
    /// One kind, which has a file in `shaders/`.
    pub const fn one(file: &'static str) -> Self {
        Self { file, kinds: 0 }
    }

    /// Several, one bit for each kind.
    pub const fn several(kinds: u32) -> Self {
        Self { file: "bells/any.glsl", kinds }
    }

    /// Whether there are several.
    pub const fn are_several(self) -> bool {
        self.kinds != 0
    }

    /// What a shader is specialised with to include them.
    pub fn defines(self) -> impl Iterator<Item = (&'static str, &'static str)> {
        const HAS: [&str; Bell::KINDS as usize] =
            ["HAS_0", "HAS_1", "HAS_2", "HAS_3", "HAS_4", "HAS_5", "HAS_6", "HAS_7", "HAS_8", "HAS_9"];
        let has = (0..).zip(HAS).filter(move |(kind, _)| self.kinds >> kind & 1 == 1).map(|(_, name)| (name, "1"));
        std::iter::once(("BELL", self.file)).chain(has)
    }
}

/// A GLSL function `glare(pixel)`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Source {
    /// Its file in `shaders/`.
    pub evaluator: &'static str,
    /// The files of the series, of the direct sum and of what is drawn where it reaches, where the function is their sum.
    pub parts: Option<[&'static str; 3]>,
    /// The bells that it includes, if any.
    pub bells: Option<Bells>,
    /// Whether there are more ghosts than fit a uniform block.
    pub many_ghosts: bool,
    /// Whether the bells are computed in 64-bit floats.
    pub double: bool,
    /// Whether parts are added up in 64-bit floats, since one of them is.
    pub exact: bool,
}

impl Source {
    /// The field that [`FieldPass::draw`] drew last, which [`FieldPass::bind`] binds.
    pub const HELD: Self = Self::of("\"evaluators/held.glsl\"");

    /// The function in a file that is one by itself.
    pub const fn of(evaluator: &'static str) -> Self {
        Self { evaluator, parts: None, bells: None, many_ghosts: false, double: false, exact: false }
    }

    /// What a shader is specialised with to include this function.
    pub fn defines(self) -> Vec<(&'static str, &'static str)> {
        let mut defines = vec![("EVALUATOR", self.evaluator)];
        let parts =
            |[series, direct, local]: [&'static str; 3]| [("SERIES", series), ("DIRECT", direct), ("LOCAL", local)];
        defines.extend(self.parts.into_iter().flat_map(parts));
        defines.extend(self.bells.into_iter().flat_map(Bells::defines));
        if self.many_ghosts {
            defines.push(("MANY_GHOSTS", "1"));
        }
        if self.double {
            defines.push(("DOUBLE", "1"));
        }
        if self.exact {
            defines.push(("EXACT", "1"));
        }
        defines
    }
}

/// Stores the field, and looks it up at probes.
pub(crate) struct FieldPass {
    field: Scratch,
    /// How often it was drawn.
    stamp: u64,
    piece: Scratch,
    probed: Scratch,
    probes: Buffer<[i32; 2]>,
}

impl FieldPass {
    pub fn new(runner: &Runner) -> Result<Self> {
        let probes = Buffer::new(runner.device(), 0)?;
        let [field, piece, probed] = [(); 3].map(|()| Scratch::default());
        Ok(Self { field, stamp: 0, piece, probed, probes })
    }

    /// The field of a tile of `width` × `height` pixels, in units of its scale.
    pub fn draw(&mut self, runner: &Runner, source: Source, width: u32, height: u32) -> Result<&Texture> {
        self.draw_in_bands(runner, source, [width, height], 1)
    }

    /// The same, by as many draws one above the other: drivers reset themselves when one takes seconds.
    pub fn draw_in_bands(
        &mut self,
        runner: &Runner,
        source: Source,
        [width, height]: [u32; 2],
        bands: u32,
    ) -> Result<&Texture> {
        self.stamp += 1;
        let field = self.field.get(runner.device(), Texel::Rgba, width, height)?;
        runner.draw_in_bands("field.frag", &source.defines(), field, bands)?;
        Ok(field)
    }

    /// Begins a field of so many columns and rows that comes in pieces.
    pub fn begin(&mut self, runner: &Runner, [width, height]: [u32; 2]) -> Result<()> {
        self.stamp += 1;
        self.field.get(runner.device(), Texel::Rgba, width, height).map(drop)
    }

    /// Draws a piece of the field that was begun, in its place; the function counts its pixels from the piece's corner.
    pub fn draw_piece(
        &mut self,
        runner: &Runner,
        source: Source,
        at: [u32; 2],
        [width, height]: [u32; 2],
        bands: u32,
    ) -> Result<()> {
        let piece = self.piece.get(runner.device(), Texel::Rgba, width, height)?;
        runner.draw_in_bands("field.frag", &source.defines(), piece, bands)?;
        if let Some(field) = self.field.current() {
            field.place(piece, at);
        }
        Ok(())
    }

    /// What was drawn last, and what tells it from any other before.
    pub fn drawn(&self) -> Option<(&Texture, u64)> {
        Some((self.field.current()?, self.stamp))
    }

    /// Binds what was drawn last, for [`Source::HELD`].
    pub fn bind(&self) {
        if let Some(field) = self.field.current() {
            field.bind(FIELD);
        }
    }

    /// The field at pixels of the tile, counted from its corner, in units of its scale.
    pub fn probe(&mut self, runner: &Runner, source: Source, pixels: &[[i32; 2]]) -> Result<Vec<[f32; 3]>> {
        if pixels.is_empty() {
            return Ok(Vec::new());
        }
        self.probes.store(pixels)?;
        self.probes.bind_storage(PROBES);
        let probed = self.probed.get(runner.device(), Texel::Rgba, pixels.len() as u32, 1)?;
        runner.draw("probe.frag", &source.defines(), probed, 0)?;
        let values = probed.read_level(0);
        Ok(values.chunks_exact(4).map(|value| [value[0], value[1], value[2]]).collect())
    }
}
