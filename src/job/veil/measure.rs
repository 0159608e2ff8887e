//! A veil held against its definition.

use rayon::prelude::*;

use super::{Channel, Definition, failed, light};
use crate::Result;
use crate::certificate::Verify;
use crate::chance::Chance;
use crate::choices::Border;
use crate::veil::{self, Geometry, Kernel};

/// Products that measuring the error may cost: at some pixels, or where every one is asked for, which large photos have too many of.
const EFFORT: [f64; 2] = [5e6, 2e10];
/// Bounds of the error from which on a kernel may be looked up in a table.
const LOOKED_UP: f64 = 1e-4;
/// Pixels that are measured at least.
const FEWEST: usize = 6;

/// Where the error is measured: the same places every time, spread by chance; the corners among them, and what is next to the
/// brightest pixel, and not far from it.
pub(super) fn looked_at([width, height]: [usize; 2], brightest: usize, verify: Verify) -> Vec<[usize; 2]> {
    let all = width * height;
    let effort = EFFORT[usize::from(verify == Verify::Full)];
    let count = ((effort / all as f64) as usize).clamp(FEWEST, all.max(FEWEST)).min(all);
    if count == all {
        return (0..all).map(|pixel| [pixel % width, pixel / width]).collect();
    }
    let mut chance = Chance::new(all as u64);
    let mut within = |side: usize| (chance.between(0.0, side as f64) as usize).min(side - 1);
    let beside = |x: usize, y: usize| [(brightest % width + x).min(width - 1), (brightest / width + y).min(height - 1)];
    let first = [[0, 0], [width - 1, height - 1], beside(1, 0), beside(5, 3)];
    first.into_iter().chain((first.len()..count).map(|_| [within(width), within(height)])).collect()
}

/// The pixel of which a channel is brightest.
pub(super) fn brightest(sources: &veil::Photo<'_>) -> usize {
    let [width, height] = sources.size();
    let value = |pixel: usize| [0, 1, 2].map(|channel| light(sources.value(channel, pixel % width, pixel / width)));
    let largest = |pixel: usize| value(pixel).into_iter().fold(0.0, f64::max);
    let all = (0..width * height).into_par_iter().map(|pixel| (largest(pixel), pixel));
    // Of equals the first, however they are shared out.
    let brighter = |a: (f64, usize), b: (f64, usize)| if b.0 > a.0 || b.0 == a.0 && b.1 < a.1 { b } else { a };
    all.reduce(|| (0.0, usize::MAX), brighter).1.min(width * height - 1)
}

/// The largest error that is found at these pixels, relative to the veil there.
pub(super) fn measured(
    channels: &[Channel],
    sources: &veil::Photo<'_>,
    geometry: &Geometry,
    border: Border,
    computed: &veil::Veil,
    pixels: &[[usize; 2]],
    predicted: f64,
) -> Result<f64> {
    let width = sources.size()[0];
    let largest = |plane: &Vec<f32>| f64::from(plane.par_iter().copied().reduce(|| 0.0, f32::max));
    let floors = computed.planes.each_ref().map(|plane| veil::FLOOR * largest(plane));
    let mut worst = 0.0f64;
    let truths = by_definition(channels, sources, geometry, border, pixels, predicted)?;
    for (&[x, y], truth) in pixels.iter().zip(truths) {
        for channel in 0..3 {
            let (value, truth) = (f64::from(computed.planes[channel][y * width + x]), truth[channel]);
            let unit = truth.max(floors[channel]);
            let error = if value == truth { 0.0 } else { (value - truth).abs() / unit };
            // What 32-bit floats do not hold is no number here, and told apart elsewhere.
            worst = if error.is_nan() { f64::INFINITY } else { worst.max(error) };
        }
    }
    Ok(worst)
}

/// The veil at these pixels by its definition in 64-bit floats, each channel of its own; a kernel is looked up where errors from
/// `predicted` on, relative to the veil, are told from it.
pub(super) fn by_definition(
    channels: &[Channel],
    sources: &veil::Photo<'_>,
    geometry: &Geometry,
    border: Border,
    pixels: &[[usize; 2]],
    predicted: f64,
) -> Result<Vec<[f64; 3]>> {
    let angles = geometry.angles(sources.size(), border);
    let truth = |definition: &Definition| -> Result<_> {
        Ok(match definition {
            Definition::Radial(kernel) if predicted < LOOKED_UP => {
                veil::reference::at(sources, geometry, kernel, border, pixels)
            }
            Definition::Radial(kernel) => {
                veil::reference::at(sources, geometry, &looked_up(kernel, angles)?, border, pixels)
            }
            Definition::Picture(picture) => veil::reference::of_picture(sources, picture, border, pixels),
        })
    };
    let mut all = vec![[0.0; 3]; pixels.len()];
    for (index, (_, definition)) in channels.iter().enumerate() {
        let mine: &[usize] = if channels.len() == 1 { &[0, 1, 2] } else { &[index] };
        for (all, truth) in all.iter_mut().zip(truth(definition)?) {
            mine.iter().for_each(|&channel| all[channel] = truth[channel]);
        }
    }
    Ok(all)
}

/// A kernel by a table, for sums of millions: off by less than 1e-5, most of it far out in a Gaussian, but for the one place in a
/// table at which cie has a kink.
///
/// Its places are evenly spread in each octave, so that the bits of an angle say between which two of them it lies.
fn looked_up(kernel: &Kernel, [from, to]: [f64; 2]) -> Result<Kernel> {
    const PLACES: u32 = 12;
    const REST: u32 = f64::MANTISSA_DIGITS - 1 - PLACES;
    let first = (0.9 * from).to_bits() >> REST;
    let last = (1.2 * to).to_bits() >> REST;
    let places: Vec<f64> = (first..=last + 1).map(|place| kernel.at(f64::from_bits(place << REST))).collect();
    let (exact, mixture) = (kernel.clone(), kernel.mixture().clone());
    let at = move |angle: f64| {
        let place = (angle.to_bits() >> REST).wrapping_sub(first) as usize;
        match places.get(place..place.wrapping_add(2)) {
            Some(&[below, above]) => {
                let part = (angle.to_bits() & ((1 << REST) - 1)) as f64 / (1u64 << REST) as f64;
                below + part * (above - below)
            }
            _ => exact.at(angle),
        }
    };
    Kernel::new(at, mixture).map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::psf::Psf;
    use crate::veil::Mixture;

    #[test]
    fn a_kernel_that_is_looked_up_is_the_kernel() {
        let camera = Psf::camera();
        let none = Mixture { terms: Vec::new(), constant: 0.0, quadratic: 0.0 };
        let kernel = Kernel::new(move |angle| camera.value(angle), none).unwrap();
        let range = [1e-3, 2.5];
        let table = looked_up(&kernel, range).unwrap();
        // Ends, what lies between, and what lies beyond.
        for step in 0..=10_000 {
            let angle = 5e-4 * 1e4f64.powf(f64::from(step) / 1e4);
            let (exact, looked_up) = (kernel.at(angle), table.at(angle));
            assert!((looked_up / exact - 1.0).abs() < 1e-5, "{angle}: {looked_up} for {exact}");
        }
    }
}
