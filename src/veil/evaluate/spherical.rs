//! The veil of a part of the sphere, and its lonely pixels.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::{FLOOR, Veil};
use crate::veil::geometry::Border;
use crate::veil::photo::{BadSources, Photo, Scale, Sources};
use crate::veil::plan::{OWN_SHARE, Road, Spherical};
use crate::veil::simd::{Plane, Real};
use crate::veil::sphere::{Flat, Sphere, Workspace};

/// Lonely pixels that are taken at a time.
const BATCH: usize = 8192;

impl Spherical {
    pub(super) fn evaluate(&self, photo: &Photo) -> Veil {
        let size = self.camera.size;
        let new = || [0, 1, 2].map(|_| Sources { plane: Plane::new(size[0], size[1]), exponent: 0 });
        let mut sources = self.sources.take(new);
        let bad = photo.sources(Border::None, [0, 0], &mut sources);
        let veil = match &self.road {
            Road::Lattices(sphere, roundings) => {
                let mut workspace = sphere.pool.take(|| sphere.workspace());
                sphere.sum(&sources, &mut workspace);
                let lonely = [0, 1, 2].map(|channel| {
                    let lonely = self.lonely(sphere, *roundings, &sources[channel], &workspace.veils[channel]);
                    self.mend(sphere, &mut sources[channel].plane, &lonely, &mut workspace, channel);
                    lonely.len()
                });
                let veil = finished(&sources, &workspace.veils, bad, lonely);
                sphere.pool.give_back(workspace);
                veil
            }
            Road::Flat(flat) => {
                let mut sums = flat.sum(&sources);
                let lonely = [0, 1, 2].map(|channel| self.alone(flat, &sources[channel].plane, &mut sums[channel]));
                finished(&sources, &sums, bad, lonely)
            }
            // Each pixel leaves its own light out.
            Road::Tree(tree) => finished(&sources, &tree.sum(&sources), bad, [0; 3]),
        };
        self.sources.give_back(sources);
        veil
    }

    /// Pixels whose own light may be too much for their veil.
    fn lonely(&self, sphere: &Sphere, roundings: f64, sources: &Sources, sum: &Plane<f32>) -> Vec<[usize; 2]> {
        let arch = Arch::new();
        let [width, height] = self.camera.size;
        let rest = sphere.own_largest() * (sphere.spread + roundings * <f32 as Real>::UNIT);
        let share = OWN_SHARE * self.tolerance / (1.0 + OWN_SHARE * self.tolerance);
        let floor = (FLOOR * largest(sum, width)) as f32;
        // Above the next float, so that none is missed.
        let rest = (rest / share * (1.0 + 1e-6)) as f32;
        let row = |y: usize| {
            let (light, sum) = (&sources.plane.row(y)[..width], &sum.row(y)[..width]);
            let mut found = Vec::new();
            if arch.dispatch(Any { light, sum, rest, floor }) {
                let pixels = light.iter().zip(sum).enumerate();
                let lonely = pixels.filter(|(_, (light, sum))| **light * rest > sum.max(floor));
                found.extend(lonely.map(|(x, _)| [x, y]));
            }
            found
        };
        (0..height).into_par_iter().flat_map_iter(row).collect()
    }

    /// Sums them again without their light, and adds what they send each other pair by pair.
    fn mend(
        &self,
        sphere: &Sphere,
        light: &mut Plane<f32>,
        lonely: &[[usize; 2]],
        workspace: &mut Workspace,
        channel: usize,
    ) {
        let mut before: &[[usize; 2]] = &[];
        for batch in lonely.chunks(BATCH) {
            let lights: Vec<f32> = batch.iter().map(|[x, y]| std::mem::take(&mut light.row_mut(*y)[*x])).collect();
            let without = sphere.at(light, batch, &lights, before, workspace, channel);
            let pairs = |at: &[usize; 2]| {
                let others = batch.iter().zip(&lights).filter(|(other, _)| *other != at);
                others.map(|(other, light)| f64::from(*light) * self.wanted(*other, *at)).sum::<f64>()
            };
            let pairs: Vec<f64> = batch.par_iter().map(pairs).collect();
            for ((([x, y], own), pairs), without) in batch.iter().zip(lights).zip(pairs).zip(without) {
                light.row_mut(*y)[*x] = own;
                workspace.veils[channel].row_mut(*y)[*x] = (without + pairs).max(0.0) as f32;
            }
            before = batch;
        }
    }

    /// Sums the veil of a pixel that sends more than all others together by the definition, if there is one; how many there are.
    fn alone(&self, flat: &Flat, light: &Plane<f32>, sum: &mut Plane<f32>) -> usize {
        let Some(at) = flat.lonely(light) else { return 0 };
        let row = |y: usize| {
            let sources = light.row(y)[..light.width()].iter().enumerate();
            let others = sources.filter(|(x, light)| **light != 0.0 && [*x, y] != at);
            others.map(|(x, light)| f64::from(*light) * self.wanted([x, y], at)).sum::<f64>()
        };
        // In the order of the rows, so that the sum does not depend on the threads.
        let rows: Vec<f64> = (0..light.height()).into_par_iter().map(row).collect();
        sum.row_mut(at[1])[at[0]] = rows.iter().sum::<f64>() as f32;
        1
    }
}

/// The veil in the photo's scale.
fn finished(sources: &[Sources; 3], sums: &[Plane<f32>; 3], bad: BadSources, lonely: [usize; 3]) -> Veil {
    let arch = Arch::new();
    let [width, height] = [sources[0].plane.width(), sources[0].plane.height()];
    let mut veil = Veil { planes: Default::default(), bad, dark: [0; 3], lonely, certified: [0.0; 3] };
    for (channel, (sum, sources)) in sums.iter().zip(sources).enumerate() {
        let floor = (FLOOR * largest(sum, width)) as f32;
        let scale = Scale::new(-sources.exponent);
        let mut plane = vec![0.0; width * height];
        let rows = plane.par_chunks_mut(width).enumerate();
        veil.dark[channel] =
            rows.map(|(y, out)| arch.dispatch(Finish { sum: &sum.row(y)[..width], scale, floor, out })).sum();
        veil.planes[channel] = plane;
    }
    veil
}

/// The largest value of a plane.
fn largest(plane: &Plane<f32>, width: usize) -> f64 {
    let arch = Arch::new();
    let row = |y: usize| arch.dispatch(Largest(&plane.row(y)[..width]));
    f64::from((0..plane.height()).into_par_iter().map(row).reduce(|| 0.0, f32::max))
}

/// Values that are looked at side by side.
const LANES: usize = 16;

/// The largest value of a row.
struct Largest<'a>(&'a [f32]);

impl WithSimd for Largest<'_> {
    type Output = f32;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f32 {
        let (chunks, rest) = self.0.as_chunks::<LANES>();
        let mut largest = [0f32; LANES];
        for chunk in chunks {
            for (largest, value) in largest.iter_mut().zip(chunk) {
                *largest = if *value > *largest { *value } else { *largest };
            }
        }
        rest.iter().chain(&largest).copied().fold(0.0, f32::max)
    }
}

/// Whether a pixel of a row is lonely.
struct Any<'a> {
    light: &'a [f32],
    sum: &'a [f32],
    rest: f32,
    floor: f32,
}

impl WithSimd for Any<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        let Self { light, sum, rest, floor } = self;
        let mut any = 0u32;
        for (light, sum) in light.iter().zip(sum) {
            let least = if *sum > floor { *sum } else { floor };
            any |= u32::from(light * rest > least);
        }
        any != 0
    }
}

/// A row in the photo's scale; counts what is below the floor.
struct Finish<'a> {
    sum: &'a [f32],
    scale: Scale,
    floor: f32,
    out: &'a mut [f32],
}

impl WithSimd for Finish<'_> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> usize {
        let Self { sum, scale, floor, out } = self;
        let mut dark = 0u32;
        for (sum, out) in sum.iter().zip(out) {
            dark += u32::from(*sum < floor);
            *out = scale.of(*sum);
        }
        dark as usize
    }
}
