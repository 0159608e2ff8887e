//! The last step, by groups of rows: from the finest lattice to the pixels, and what is summed there.

use pulp::{Arch, Simd, WithSimd};

use super::moments::Moments;
use super::{GROUP, PERIOD, Ready};
use crate::veil::photo::Scale;
use crate::veil::simd::{BLOCK, Into, Plane, blend, padded, slide};
use crate::veil::sweep::{Expansion, FIRST, Scratch, convolve_rows, expand_row};

/// A group of rows in the making.
pub(super) struct Rows {
    stride: usize,
    sums: Vec<f32>,
    expansion: Option<Expansion<f32>>,
    scratch: Scratch<f32>,
    /// Two rows of equal distance, folded, with room before and after.
    folded: Vec<f32>,
}

impl Rows {
    pub fn new(layers: &Ready, sources: &Plane<f32>, fine: Option<&Plane<f32>>) -> Self {
        let reach = layers.near.len();
        Self {
            stride: sources.stride(),
            sums: vec![0.0; GROUP * sources.stride()],
            expansion: fine.map(|fine| Expansion::new(&FIRST, fine)),
            scratch: Scratch::new(),
            folded: vec![0.0; padded(sources.width()) + 2 * reach + BLOCK],
        }
    }

    /// A row of the group, from the sources' first column on.
    pub fn row(&self, row: usize) -> &[f32] {
        &self.sums[row * self.stride..][..self.stride]
    }

    /// Everything but the moments for `count` rows from `first` on, the pixels' own light included.
    pub fn sum(
        &mut self,
        arch: Arch,
        layers: &Ready,
        sources: &Plane<f32>,
        fine: Option<&Plane<f32>>,
        first: usize,
        count: usize,
    ) {
        let mut rows: Vec<&mut [f32]> = self.sums.chunks_exact_mut(self.stride).take(count).collect();
        for (row, out) in rows.iter_mut().enumerate() {
            match (fine, &mut self.expansion) {
                (Some(fine), Some(expansion)) => expand_row(arch, fine, expansion, first + row, out),
                _ => out.fill(0.0),
            }
        }
        for kernel in &layers.direct {
            convolve_rows(arch, sources, kernel, &mut self.scratch, first, &mut rows, Into::Add);
        }
        for (row, out) in rows.iter_mut().enumerate() {
            near(arch, &layers.near, sources, &mut self.folded, first + row, out);
        }
    }
}

/// Adds the small kernel's share of a row.
fn near(arch: Arch, near: &[Vec<f32>], sources: &Plane<f32>, folded: &mut [f32], y: usize, out: &mut [f32]) {
    for (distance, taps) in near.iter().enumerate() {
        let reach = taps.len() / 2;
        let above = sources.get_row(y as isize - distance as isize);
        let below = sources.get_row((y + distance) as isize).filter(|_| distance > 0);
        let middle = &mut folded[reach..][..sources.stride()];
        // Rows of sources are zero in their padding, so that whole blocks may be taken.
        match [above, below] {
            [Some(above), Some(below)] => blend(arch, &[(above, 1.0), (below, 1.0)], middle, Into::Set),
            [Some(row), None] | [None, Some(row)] => middle.copy_from_slice(row),
            [None, None] => continue,
        }
        folded[..reach].fill(0.0);
        folded[reach + sources.stride()..].fill(0.0);
        slide(arch, folded, taps, out, Into::Add);
    }
}

/// What a row of a veil says of itself.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Finished {
    pub least: f32,
    pub largest: f32,
    /// Pixels whose own light may be too much for their veil.
    pub lonely: usize,
}

/// What is done to sums last.
pub(super) struct Finish<'a> {
    /// From the sources' scale to the photo's.
    pub scale: Scale,
    pub moments: &'a Moments,
    /// What of its own light may remain in a pixel's veil, over the share of that which it may make.
    pub rest: f32,
}

impl Finish<'_> {
    /// A row of the veil: `sums` and the moments, less the pixels' own light; never negative. The first of `out` is the pixel `at`.
    pub fn row(
        &self,
        arch: Arch,
        sums: &[f32],
        light: &[f32],
        own: &[[f32; BLOCK]],
        at: [usize; 2],
        out: &mut [f32],
    ) -> Finished {
        let [first, y] = at;
        let mut own = own[y % PERIOD];
        own.rotate_left(first % PERIOD);
        let (sums, light) = (&sums[first..][..out.len()], &light[first..][..out.len()]);
        match self.moments.everywhere() {
            Some(constant) => out.fill(constant),
            None => out.iter_mut().enumerate().for_each(|(x, out)| *out = self.moments.at(first + x, y) as f32),
        }
        arch.dispatch(Row { finish: self, sums, light, own: &own, out })
    }
}

struct Row<'a> {
    finish: &'a Finish<'a>,
    sums: &'a [f32],
    light: &'a [f32],
    own: &'a [f32; BLOCK],
    /// The moments.
    out: &'a mut [f32],
}

impl WithSimd for Row<'_> {
    type Output = Finished;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Finished {
        let Self { finish, sums, light, own, out } = self;
        for ((out, sums), light) in out.chunks_mut(BLOCK).zip(sums.chunks(BLOCK)).zip(light.chunks(BLOCK)) {
            for (((out, sum), light), own) in out.iter_mut().zip(sums).zip(light).zip(own) {
                *out = (*out + sum + light * own).max(0.0);
            }
        }
        let (mut least, mut largest, mut lonely) = ([f32::INFINITY; LANES], [0f32; LANES], [0u32; LANES]);
        let (rest, scale) = (finish.rest, finish.scale);
        let ((lights, last_lights), (chunks, last)) = (light.as_chunks::<LANES>(), out.as_chunks_mut::<LANES>());
        for (lights, chunk) in lights.iter().zip(chunks) {
            for lane in 0..LANES {
                lonely[lane] += u32::from(lights[lane] * rest > chunk[lane]);
                let value = scale.of(chunk[lane]);
                least[lane] = if value < least[lane] { value } else { least[lane] };
                largest[lane] = if value > largest[lane] { value } else { largest[lane] };
                chunk[lane] = value;
            }
        }
        for (light, out) in last_lights.iter().zip(last) {
            lonely[0] += u32::from(light * rest > *out);
            *out = scale.of(*out);
            least[0] = least[0].min(*out);
            largest[0] = largest[0].max(*out);
        }
        Finished {
            least: least.into_iter().fold(f32::INFINITY, f32::min),
            largest: largest.into_iter().fold(0.0, f32::max),
            lonely: lonely.into_iter().sum::<u32>() as usize,
        }
    }
}

/// Lanes by which a row's extremes are found.
const LANES: usize = 16;
