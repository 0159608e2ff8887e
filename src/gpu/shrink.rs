//! Means of a texture's light, for a view that makes it smaller: along its rows first, along its columns next.

use bytemuck::{Pod, Zeroable};
use glam::DVec2;

use super::layout::{PASS, PICTURE};
use super::resource::{Buffer, Scratch, Texel, Texture};
use super::runner::Runner;
use super::shader::Define;
use crate::Result;

/// Texels along one axis that a mean looks at, at most; of more, some are left out evenly.
const MOST: u32 = 12;

/// Where a view lies on what it shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    /// The view's top left corner, in texels from the top left corner of what is shown.
    pub origin: DVec2,
    /// Texels from one pixel of the view to the next; above 1.
    pub pitch: f64,
    /// Columns and rows of the view.
    pub size: [u32; 2],
}

/// One axis' uniforms; as in `shrink.frag`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Axis {
    pub origin: f32,
    pub pitch: f32,
    pub end: f32,
    pub taps: i32,
    pub stride: i32,
    pub aside: i32,
    pub last: i32,
    pub pad: i32,
}
const _: () = assert!(size_of::<Axis>() == 32);

/// Shrinks textures.
pub(crate) struct ShrinkPass {
    uniforms: Buffer<Axis>,
    /// Means along rows.
    strips: Scratch,
}

/// Means that are kept while neither the place nor what they are of changes.
#[derive(Default)]
pub(crate) struct Means {
    means: Scratch,
    of: Option<(u64, Place)>,
}

impl ShrinkPass {
    pub fn new(runner: &Runner) -> Result<Self> {
        Ok(Self { uniforms: Buffer::new(runner.device(), 1)?, strips: Scratch::default() })
    }

    /// Brings means up to date: of `source`, whose content `stamp` tells from any other, a texel for each pixel of the
    /// view. Where the view is off the source they mean nothing.
    pub fn draw<'a>(
        &mut self,
        runner: &Runner,
        (source, stamp): (&Texture, u64),
        place: &Place,
        into: &'a mut Means,
    ) -> Result<&'a Texture> {
        let Place { origin, pitch, size: [width, height] } = *place;
        let known = into.of == Some((stamp, *place));
        into.of = None;
        let means = into.means.get(runner.device(), Texel::Rgba, width, height)?;
        if known {
            into.of = Some((stamp, *place));
            return Ok(means);
        }
        let [columns, rows] = [source.level_width(0), source.level_height(0)];
        let (taps, stride) = taps(pitch);
        let axis = |origin: f64, length: u32, aside: u32| Axis {
            origin: origin as f32,
            pitch: pitch as f32,
            end: length as f32,
            taps: taps as i32,
            stride: stride as i32,
            aside: aside as i32,
            last: length as i32 - 1,
            pad: 0,
        };
        // Only the rows that are seen.
        let first = (origin.y.max(0.0) as u32).min(rows - 1);
        let end = ((origin.y + pitch * f64::from(height)).ceil().max(0.0) as u32).clamp(first + 1, rows);
        let strips = self.strips.get(runner.device(), Texel::Rgba, width, end - first)?;
        // A loop of known length takes half the time on a software renderer. Few lengths, so that magnifying compiles little.
        let unrolled = match taps {
            3 => Some(("TAPS", "3")),
            4 => Some(("TAPS", "4")),
            _ => None,
        };
        let mut run = |axis: Axis, source: &Texture, along: Option<Define<'_>>, target: &Texture| {
            let defines: Vec<_> = unrolled.into_iter().chain(along).collect();
            self.uniforms.store(&[axis])?;
            self.uniforms.bind_uniform(PASS);
            source.bind(PICTURE);
            runner.draw("shrink.frag", &defines, target, 0)
        };
        run(axis(origin.x, columns, first), source, None, strips)?;
        run(axis(origin.y - f64::from(first), end - first, 0), strips, Some(("ALONG_Y", "1")), means)?;
        into.of = Some((stamp, *place));
        Ok(means)
    }
}

/// Texels along one axis that a mean looks at, and from one of them to the next.
fn taps(pitch: f64) -> (u32, u32) {
    // Beginning anywhere in a texel, it reaches into one more than it is wide.
    let touched = pitch.ceil() as u32 + 1;
    let stride = touched.div_ceil(MOST);
    (touched.div_ceil(stride), stride)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_texel_that_is_touched_is_looked_at_up_to_twelve() {
        for (pitch, wanted) in [(1.2, (3, 1)), (11.0, (12, 1)), (11.5, (7, 2)), (64.0, (11, 6))] {
            assert_eq!(taps(pitch), wanted, "{pitch}");
        }
    }
}
