//! A planned veil whose layers a device sums: what it is told, what it may be off by, and what is made of its sums.

use rayon::prelude::*;

use super::moments::Moments;
use super::{Finished, OwnLight, Workspace};
use crate::veil::error::Error;
use crate::veil::evaluate::Veil;
use crate::veil::geometry::Border;
use crate::veil::photo::{Photo, Scale, Sources};
use crate::veil::plan::{Layers, Placed, Plan, Planar, Way};
use crate::veil::simd::Real;
use crate::veil::sweep::{FIRST, NEXT, points};
use crate::veil::{FLOOR, Near};

/// A kernel whose nearest value is below this is left to the CPU: shaders may take what is below 10⁻³⁸ as 0, and the brightest
/// source is 2⁶⁰ there. What shows of a veil is then far above that.
const LEAST: f64 = 1e-24;

/// Roundings of what moments add to a pixel, over the sum of their magnitudes.
const OF_MOMENTS: f64 = 8.0;

/// What a pass does at each texel beside its taps, in taps: it is begun, and written.
const TEXEL: f64 = 2.0;

/// A plan by lattices on a plane, as a device takes it that adds and multiplies 32-bit floats, each rounded by itself.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OnDevice<'a> {
    planar: &'a Planar,
    /// The bound of the error that holds for it.
    bound: f64,
    roundings: f64,
    /// What of a pixel's own light moments may leave besides.
    of_moments: f64,
}

/// A photo's light, for a device to sum.
pub(crate) struct Lights<'a> {
    planar: &'a Planar,
    /// What moments of the photo add to a pixel, RGB: by its place (u, v) from the middle of the sources a constant, and what is times
    /// u, v and u² + v².
    pub moments: [[f32; 4]; 3],
}

/// What a device has to do, but for moving pixels.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Labour {
    /// Taps, of three channels each, and what a texel costs besides.
    pub taps: f64,
    pub passes: f64,
    /// Pixels that are moved to the device and back.
    pub moved: f64,
}

impl Plan {
    /// The plan for a device; none where it is no plan by lattices on a plane, or its kernel is too dim for shaders.
    pub(crate) fn on_device(&self) -> Option<OnDevice<'_>> {
        let Way::Plane(planar) = &self.way else { return None };
        let unit = <f32 as Real>::UNIT;
        let Layers { constant, quadratic, .. } = planar.layers;
        let farthest = planar.sources_size().map(|side| (side - 1) as f64);
        let farthest = farthest[0].hypot(farthest[1]);
        let magnitude = constant + quadratic * farthest * farthest;
        // No veil is below the light of all sources times the least of the kernel.
        let least = if quadratic > 0.0 { planar.least(farthest) } else { 1.0 };
        let moments = if quadratic > 0.0 { OF_MOMENTS * unit * magnitude } else { 0.0 };
        let roundings = roundings(&planar.layers);
        let more = (roundings / planar.roundings - 1.0).max(0.0);
        let predicted = self.predicted();
        let bound = predicted.bound + predicted.rounding * more + moments / least;
        let usable = bound.is_finite() && (planar.wanted(1.0) >= LEAST || farthest == 0.0);
        usable.then_some(OnDevice { planar, bound, roundings, of_moments: moments })
    }
}

impl Planar {
    /// Columns and rows of the sources, with what a border adds.
    fn sources_size(&self) -> [usize; 2] {
        [0, 1].map(|side| self.size[side] + 2 * self.margin[side])
    }

    /// The least that is wanted from 1 to `farthest` pixels, by distances each 2 % further than the last.
    fn least(&self, farthest: f64) -> f64 {
        const STEP: f64 = 1.02;
        let places = std::iter::successors(Some(1.0), |distance: &f64| Some(distance * STEP));
        let within = places.take_while(|distance| *distance < farthest).chain([farthest.max(1.0)]);
        within.map(|distance| self.wanted(distance)).fold(f64::INFINITY, f64::min)
    }
}

impl OnDevice<'_> {
    /// What is to be summed.
    pub fn layers(&self) -> &Layers {
        &self.planar.layers
    }

    /// Bound of the error relative to the local veil.
    pub fn bound(&self) -> f64 {
        self.bound
    }

    /// Columns and rows of the picture.
    pub fn size(&self) -> [usize; 2] {
        self.planar.size
    }

    /// Columns and rows that a border adds before the picture's first and after its last.
    pub fn margin(&self) -> [usize; 2] {
        self.planar.margin
    }

    /// Columns and rows of the sources.
    pub fn sources_size(&self) -> [usize; 2] {
        self.planar.sources_size()
    }

    /// What it takes.
    pub fn labour(&self) -> Labour {
        labour(&self.planar.layers, self.planar.size, self.sources_size())
    }

    /// Pixels of the picture.
    pub fn pixels(&self) -> f64 {
        (self.planar.size[0] * self.planar.size[1]) as f64
    }

    /// How many pictures the CPU has to do with: what a border adds is summed on lattices, and rows of three on the pixels.
    pub fn pictures(&self) -> f64 {
        if self.planar.border == Border::None { 1.0 } else { 4.0 }
    }

    /// The veil of a photo, which `sum` sums: it is given the sources as texels, row by row, and leaves the picture's veil there, in the
    /// sources' scale and without the pixels' own light, row by row from the first on. Lonely pixels are mended by the CPU.
    ///
    /// # Errors
    /// A photo of another size than was planned for; that of `sum`.
    pub fn evaluate<E: From<Error>>(
        &self,
        photo: &Photo<'_>,
        sum: impl FnOnce(&Lights<'_>, &mut [[f32; 4]]) -> Result<(), E>,
    ) -> Result<Veil, E> {
        let planar = self.planar;
        if photo.size() != planar.size {
            return Err(Error::OtherSize { planned: planar.size, found: photo.size() }.into());
        }
        let mut workspace = planar.pool.take(|| planar.workspace());
        let Workspace { sources, pyramid, texels } = &mut workspace;
        let bad = photo.sources(planar.border, planar.margin, sources);
        interleave(sources, planar.sources_size(), texels);
        let moments = sources.each_ref().map(|sources| {
            Moments::new(&planar.layers, &sources.plane).polynomial().map(|coefficient| coefficient as f32)
        });
        sum(&Lights { planar, moments }, texels)?;
        let own = self.own_light();
        let (mut planes, rows) = self.planes(texels, sources, own);
        let mut veil =
            Veil { planes: Default::default(), bad, dark: [0; 3], lonely: [0; 3], certified: [self.bound; 3] };
        for (channel, sources) in sources.iter_mut().enumerate() {
            let mut plane = std::mem::take(&mut planes[channel]);
            let rows: Vec<Finished> = rows.iter().map(|row| row[channel]).collect();
            let floor = FLOOR * f64::from(rows.iter().map(|row| row.largest).fold(0.0, f32::max));
            veil.lonely[channel] = planar.mend(sources, &rows, (floor, own), pyramid, &mut plane);
            veil.dark[channel] = planar.dark(&rows, floor, &plane);
            veil.planes[channel] = plane;
        }
        planar.pool.give_back(workspace);
        Ok(veil)
    }

    fn own_light(&self) -> OwnLight {
        let (own, planar) = (self.planar.own_light(), &self.planar.layers.own);
        let more = planar.largest * (self.roundings - self.planar.roundings).max(0.0) * <f32 as Real>::UNIT;
        OwnLight { rest: own.rest + more + self.of_moments, ..own }
    }

    /// The veil's planes in the photo's scale, and what is to be known of each of their rows.
    fn planes(
        &self,
        texels: &[[f32; 4]],
        sources: &[Sources; 3],
        own: OwnLight,
    ) -> ([Vec<f32>; 3], Vec<[Finished; 3]>) {
        let [width, height] = self.planar.size;
        let margin = self.planar.margin;
        let rest = own.of_computed() as f32;
        let scales = sources.each_ref().map(|sources| Scale::new(-sources.exponent));
        let mut planes = [0, 1, 2].map(|_| vec![0.0; width * height]);
        let mut rows = vec![[Finished { least: f32::INFINITY, largest: 0.0, lonely: 0 }; 3]; height];
        let [red, green, blue] = planes.each_mut().map(|plane| plane.par_chunks_exact_mut(width));
        let each = red.zip(green).zip(blue).zip(texels.par_chunks_exact(width)).zip(&mut rows).enumerate();
        each.with_min_len(8).for_each(|(y, ((((red, green), blue), texels), finished))| {
            for (channel, out) in [red, green, blue].into_iter().enumerate() {
                let light = &sources[channel].plane.row(y + margin[1])[margin[0]..][..width];
                let Finished { least, largest, lonely } = &mut finished[channel];
                for ((out, texel), light) in out.iter_mut().zip(texels).zip(light) {
                    *lonely += usize::from(light * rest > texel[channel]);
                    *out = scales[channel].of(texel[channel]);
                    *least = least.min(*out);
                    *largest = largest.max(*out);
                }
            }
        });
        (planes, rows)
    }
}

impl Lights<'_> {
    /// The middle of the sources, which moments are counted from.
    pub fn middle(&self) -> [f32; 2] {
        self.planar.sources_size().map(|side| 0.5 * (side as f32 - 1.0))
    }
}

/// The sources pixel by pixel.
fn interleave(sources: &[Sources; 3], [width, height]: [usize; 2], into: &mut Vec<[f32; 4]>) {
    into.resize(width * height, [0.0; 4]);
    into.par_chunks_exact_mut(width).with_min_len(8).enumerate().for_each(|(y, into)| {
        let [red, green, blue] = sources.each_ref().map(|sources| sources.plane.row(y));
        for (((into, red), green), blue) in into.iter_mut().zip(red).zip(green).zip(blue) {
            *into = [*red, *green, *blue, 0.0];
        }
    });
}

/// The longest chain of roundings from a source to a pixel where a product and its addition are rounded each: a sum of n products
/// rounds the first once as a product and then at every addition but the first, n times in all.
fn roundings(layers: &Layers) -> f64 {
    let terms = layers.direct.len() + layers.lattices.iter().map(Vec::len).sum::<usize>();
    // Taps along both axes, and these taps themselves.
    let kernel = |placed: &Placed| 2 * 2 * placed.half.len();
    let [first, next] = [&FIRST, &NEXT].map(|step| step.up.len() + step.even.len().max(step.odd.len()));
    let chain = |(level, terms): (usize, &Vec<Placed>)| {
        let steps = 2 * (first + 2) + level * 2 * next;
        terms.iter().map(|placed| kernel(placed) + steps).max().unwrap_or(0)
    };
    let lattices = layers.lattices.iter().enumerate().map(chain).max().unwrap_or(0);
    let direct = layers.direct.iter().map(kernel).max().unwrap_or(0);
    // What each term, and each lattice, is added to; what follows on the pixels.
    let sums = terms + layers.lattices.len() + 4;
    // Four pixels at a time, times the tap, which is rounded, in a row.
    let near = 3 + 1 + 1 + near_taps(&layers.near) as usize;
    (lattices.max(direct) + sums).max(near + 4) as f64
}

/// Fours of mirrored offsets of the small kernel.
fn near_taps(near: &Near) -> f64 {
    near.rows.iter().map(|row| row.len().next_multiple_of(4)).sum::<usize>() as f64
}

/// What the passes take, one by one.
fn labour(layers: &Layers, size: [usize; 2], sources: [usize; 2]) -> Labour {
    let mut labour = Labour { moved: ((size[0] * size[1]) + (sources[0] * sources[1])) as f64, ..Labour::default() };
    let [columns, rows] = sources.map(|side| points(side, layers.lattices.len()));
    let mut pass = |width: usize, height: usize, taps: f64| {
        labour.taps += (width * height) as f64 * (taps + TEXEL);
        labour.passes += 1.0;
    };
    let mut finer = sources;
    for (level, terms) in layers.lattices.iter().enumerate() {
        let (coarse, step) = ([columns[level], rows[level]], if level == 0 { &FIRST } else { &NEXT });
        let (up, down) = (step.up.len() as f64, 0.5 * (step.even.len() + step.odd.len()) as f64);
        pass(coarse[0], finer[1], up);
        pass(coarse[0], coarse[1], up);
        for placed in terms {
            let taps = (2 * placed.half.len() - 1) as f64;
            pass(coarse[0], coarse[1], taps);
            pass(coarse[0], coarse[1], taps);
        }
        let onto = if level == 0 { size } else { finer };
        pass(onto[0], coarse[1], down);
        pass(onto[0], onto[1], down);
        finer = coarse;
    }
    for placed in &layers.direct {
        let radius = placed.half.len() - 1;
        pass(size[0], (size[1] + 2 * radius).min(sources[1]), (2 * radius + 1) as f64);
        pass(size[0], size[1], (2 * radius + 1) as f64);
    }
    pass(size[0], size[1], 4.0 * near_taps(&layers.near) + 2.0);
    labour
}
