//! The veil of a part of the sphere, and its lonely pixels.

use rayon::prelude::*;

use super::{FLOOR, Veil};
use crate::veil::geometry::Border;
use crate::veil::photo::{Photo, Scale, Sources};
use crate::veil::plan::{OWN_SHARE, Spherical};
use crate::veil::simd::{Plane, Real};

/// Lonely pixels that are taken at a time.
const BATCH: usize = 8192;

impl Spherical {
    pub(super) fn evaluate(&self, photo: &Photo) -> Veil {
        let size = self.camera.size;
        let mut sources = [0, 1, 2].map(|_| Sources { plane: Plane::new(size[0], size[1]), exponent: 0 });
        let bad = photo.sources(Border::None, [0, 0], &mut sources);
        let mut sums = self.sphere.sum(&sources);
        let lonely = [0, 1, 2].map(|channel| self.lonely(&sources[channel], &sums[channel], size));
        self.mend(&mut sources, &lonely, &mut sums);
        let mut veil = Veil {
            planes: Default::default(),
            bad,
            dark: [0; 3],
            lonely: lonely.each_ref().map(Vec::len),
            certified: [0.0; 3],
        };
        for (channel, (sum, sources)) in sums.iter().zip(&sources).enumerate() {
            let floor = FLOOR * largest(sum);
            let rows = (0..size[1])
                .into_par_iter()
                .map(|y| sum.row(y)[..size[0]].iter().filter(|value| f64::from(**value) < floor).count());
            veil.dark[channel] = rows.sum();
            let scale = Scale::new(-sources.exponent);
            let mut plane = vec![0.0; size[0] * size[1]];
            plane.par_chunks_mut(size[0]).enumerate().for_each(|(y, out)| {
                out.iter_mut().zip(sum.row(y)).for_each(|(out, value)| *out = scale.of(*value));
            });
            veil.planes[channel] = plane;
        }
        veil
    }

    /// Pixels whose own light may be too much for their veil.
    fn lonely(&self, sources: &Sources, sum: &Plane<f32>, size: [usize; 2]) -> Vec<[usize; 2]> {
        let rest = self.sphere.own_largest() * (self.sphere.spread + self.roundings * <f32 as Real>::UNIT);
        let share = OWN_SHARE * self.tolerance / (1.0 + OWN_SHARE * self.tolerance);
        let floor = FLOOR * largest(sum);
        let row = |y: usize| {
            let pixels = sources.plane.row(y)[..size[0]].iter().zip(sum.row(y)).enumerate();
            let lonely =
                pixels.filter(|(_, (light, sum))| f64::from(**light) * rest > share * f64::from(**sum).max(floor));
            lonely.map(move |(x, _)| [x, y]).collect::<Vec<_>>()
        };
        (0..size[1]).into_par_iter().flat_map_iter(row).collect()
    }

    /// Sums them again without their light, and adds what they send each other pair by pair.
    fn mend(&self, sources: &mut [Sources; 3], lonely: &[Vec<[usize; 2]>; 3], sums: &mut [Plane<f32>; 3]) {
        let batches = lonely.iter().map(|lonely| lonely.len().div_ceil(BATCH)).max().unwrap_or(0);
        for batch in 0..batches {
            let batch: [Vec<([usize; 2], f32)>; 3] = [0, 1, 2].map(|channel| {
                let pixels = lonely[channel].chunks(BATCH).nth(batch).unwrap_or_default();
                let taken =
                    pixels.iter().map(|[x, y]| ([*x, *y], std::mem::take(&mut sources[channel].plane.row_mut(*y)[*x])));
                taken.collect()
            });
            let places = batch.each_ref().map(|batch| batch.iter().map(|(at, _)| *at).collect::<Vec<_>>());
            let without = self.sphere.at(sources, places.each_ref().map(Vec::as_slice));
            for (channel, (batch, without)) in batch.iter().zip(without).enumerate() {
                let pairs = |(at, _): &([usize; 2], f32)| {
                    let others = batch.iter().filter(|(other, _)| other != at);
                    others.map(|(other, light)| f64::from(*light) * self.wanted(*other, *at)).sum::<f64>()
                };
                let pairs: Vec<f64> = batch.par_iter().map(pairs).collect();
                for ((([x, y], light), pairs), without) in batch.iter().zip(pairs).zip(without) {
                    sources[channel].plane.row_mut(*y)[*x] = *light;
                    sums[channel].row_mut(*y)[*x] = (without + pairs).max(0.0) as f32;
                }
            }
        }
    }
}

/// The largest value of a plane.
fn largest(plane: &Plane<f32>) -> f64 {
    let row = |y: usize| plane.row(y)[..plane.width()].iter().copied().fold(0.0, f32::max);
    f64::from((0..plane.height()).into_par_iter().map(row).reduce(|| 0.0, f32::max))
}
