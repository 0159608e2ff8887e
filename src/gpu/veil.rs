//! The passes of a veil: taps along an axis, from a lattice to the finer one, and what is left to do at the pixels.

use bytemuck::{Pod, Zeroable};

use super::layout::{PASS, PHOTO, PICTURE, TAPS};
use super::resource::{Buffer, Texture};
use super::runner::Runner;
use super::shader::Define;
use crate::{Error, Result};

/// Taps that a pass can have, or fours of them: what every driver's uniform block holds.
pub(crate) const MOST_TAPS: usize = 1024;

/// Columns and rows after which the table of a pixel's own light repeats.
pub(crate) const PERIOD: usize = 16;

/// Rows of the small kernel that there is room for, in fours: offsets of up to 51.
pub(super) const NEAR_ROWS: usize = 13;

/// An axis of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Axis {
    X,
    Y,
}

impl Axis {
    fn define(self) -> Option<Define<'static>> {
        (self == Self::Y).then_some(("ALONG_Y", "1"))
    }

    fn length(self, texture: &Texture) -> i32 {
        (if self == Self::X { texture.level_width(0) } else { texture.level_height(0) }) as i32
    }
}

/// Taps along an axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Convolve<'a> {
    pub axis: Axis,
    pub taps: &'a [f64],
    /// The texel of the source that the target's first meets with the first tap; negative before the source's first.
    pub first: i32,
    /// Texels of the source from one of the target to the next.
    pub stride: i32,
    /// The texel of the source, across the axis, that is beside the target's first.
    pub aside: i32,
}

/// From a lattice to the finer one, along an axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Expand<'a> {
    pub axis: Axis,
    /// What points with an even and with an odd number take from the coarse lattice, from half their number on.
    pub even: &'a [f64],
    pub odd: &'a [f64],
    /// The number of the target's first point.
    pub first: i32,
}

/// What is done at the pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Finish<'a> {
    /// The texel of the sources that is the picture's first pixel.
    pub first: [i32; 2],
    /// Where moments are counted from, in texels of the sources.
    pub middle: [f32; 2],
    /// RGB: a constant, and what is times u, v and u² + v².
    pub moments: [[f32; 4]; 3],
    /// What a pixel's own light comes to, over that light.
    pub own: &'a [[f64; PERIOD]],
    /// The small kernel: for each distance of rows the taps at distances of columns.
    pub near: &'a [Vec<f64>],
}

/// As in `veil/convolve.frag`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct ConvolveUniforms {
    pub first: i32,
    pub stride: i32,
    pub count: i32,
    pub end: i32,
    pub aside: i32,
    pub pad: [i32; 3],
}
const _: () = assert!(size_of::<ConvolveUniforms>() == 32);

/// As in `veil/expand.frag`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct ExpandUniforms {
    pub first: i32,
    pub even: i32,
    pub odd: i32,
    pub end: i32,
}
const _: () = assert!(size_of::<ExpandUniforms>() == 16);

/// As in `veil/finish.frag`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct FinishUniforms {
    pub first: [i32; 2],
    pub size: [i32; 2],
    pub middle: [f32; 2],
    pub rows: i32,
    pub pad: i32,
    pub constant: [f32; 4],
    pub across: [f32; 4],
    pub down: [f32; 4],
    pub square: [f32; 4],
    pub fours: [[i32; 4]; NEAR_ROWS],
}
const _: () = assert!(size_of::<FinishUniforms>() == 96 + 16 * NEAR_ROWS);

/// Sums veils, three channels at a time.
pub(crate) struct VeilPass {
    convolve: Buffer<ConvolveUniforms>,
    expand: Buffer<ExpandUniforms>,
    finish: Buffer<FinishUniforms>,
    taps: Buffer<[f32; 4]>,
}

impl VeilPass {
    pub fn new(runner: &Runner) -> Result<Self> {
        let device = runner.device();
        Ok(Self {
            convolve: Buffer::new(device, 1)?,
            expand: Buffer::new(device, 1)?,
            finish: Buffer::new(device, 1)?,
            taps: Buffer::new(device, MOST_TAPS)?,
        })
    }

    /// Taps of `source` along an axis, and what `before` holds, where there is that.
    ///
    /// # Errors
    /// [`Error::Gl`] for more than [`MOST_TAPS`], or where the driver refuses.
    pub fn convolve(
        &mut self,
        runner: &Runner,
        convolve: Convolve<'_>,
        source: &Texture,
        before: Option<&Texture>,
        target: &Texture,
    ) -> Result<()> {
        let Convolve { axis, taps, first, stride, aside } = convolve;
        self.set_taps(taps.iter().map(|tap| [*tap as f32, 0.0, 0.0, 0.0]))?;
        let (count, end) = (taps.len() as i32, axis.length(source));
        self.convolve.store(&[ConvolveUniforms { first, stride, count, end, aside, pad: [0; 3] }])?;
        self.convolve.bind_uniform(PASS);
        source.bind(PHOTO);
        let added = added(before);
        runner.draw("veil/convolve.frag", &defines([axis.define(), added]), target, 0)
    }

    /// What a coarse lattice holds, on the next finer one, along an axis.
    ///
    /// # Errors
    /// As [`VeilPass::convolve`].
    pub fn expand(&mut self, runner: &Runner, expand: Expand<'_>, source: &Texture, target: &Texture) -> Result<()> {
        let Expand { axis, even, odd, first } = expand;
        self.set_taps(even.iter().chain(odd).map(|tap| [*tap as f32, 0.0, 0.0, 0.0]))?;
        let [even, odd] = [even, odd].map(|taps| taps.len() as i32);
        self.expand.store(&[ExpandUniforms { first, even, odd, end: axis.length(source) }])?;
        self.expand.bind_uniform(PASS);
        source.bind(PHOTO);
        runner.draw("veil/expand.frag", &defines([axis.define(), None]), target, 0)
    }

    /// The veil at the pixels, from what was summed `before`.
    ///
    /// # Errors
    /// As [`VeilPass::convolve`].
    pub fn finish(
        &mut self,
        runner: &Runner,
        finish: &Finish<'_>,
        sources: &Texture,
        before: Option<&Texture>,
        target: &Texture,
    ) -> Result<()> {
        let own = finish.own.iter().flat_map(|row| row.as_chunks().0).map(|four: &[f64; 4]| four.map(|tap| tap as f32));
        if finish.near.len() > 4 * NEAR_ROWS {
            return Err(Error::Gl(format!(
                "a small kernel of {} rows is beyond the {} of a pass",
                finish.near.len(),
                4 * NEAR_ROWS
            )));
        }
        let near = finish.near.iter().enumerate().flat_map(|(y, row)| fours(row, y));
        self.set_taps(own.chain(near))?;
        self.finish.store(&[FinishUniforms::new(finish, sources)])?;
        self.finish.bind_uniform(PASS);
        sources.bind(PHOTO);
        let added = added(before);
        runner.draw("veil/finish.frag", &defines([None, added]), target, 0)
    }

    fn set_taps(&mut self, taps: impl Iterator<Item = [f32; 4]>) -> Result<()> {
        let taps: Vec<[f32; 4]> = taps.collect();
        if taps.len() > MOST_TAPS {
            return Err(Error::Gl(format!("a kernel of {} taps is beyond the {MOST_TAPS} of a pass", taps.len())));
        }
        self.taps.store(&taps)?;
        self.taps.bind_uniform(TAPS);
        Ok(())
    }
}

impl FinishUniforms {
    fn new(finish: &Finish<'_>, sources: &Texture) -> Self {
        let colours = |index: usize| {
            let [red, green, blue] = finish.moments.map(|moments| moments[index]);
            [red, green, blue, 0.0]
        };
        let mut rows = [[0; 4]; NEAR_ROWS];
        for (count, row) in rows.as_flattened_mut().iter_mut().zip(finish.near) {
            *count = row.len().div_ceil(4) as i32;
        }
        Self {
            first: finish.first,
            size: [sources.level_width(0) as i32, sources.level_height(0) as i32],
            middle: finish.middle,
            rows: finish.near.len() as i32,
            pad: 0,
            constant: colours(0),
            across: colours(1),
            down: colours(2),
            square: colours(3),
            fours: rows,
        }
    }
}

/// A row of the small kernel in fours; what is met twice is halved.
fn fours(row: &[f64], y: usize) -> impl Iterator<Item = [f32; 4]> {
    let of_row = if y == 0 { 0.5 } else { 1.0 };
    let tap = move |x: usize| row.get(x).map_or(0.0, |tap| tap * of_row * if x == 0 { 0.5 } else { 1.0 }) as f32;
    (0..row.len().div_ceil(4)).map(move |four| [0, 1, 2, 3].map(|k| tap(4 * four + k)))
}

/// Binds what a sum is added to, where there is that.
fn added(before: Option<&Texture>) -> Option<Define<'static>> {
    before?.bind(PICTURE);
    Some(("ADDED", "1"))
}

fn defines(some: [Option<Define<'static>>; 2]) -> Vec<Define<'static>> {
    some.into_iter().flatten().collect()
}
