//! The veil of a whole picture by that of few directions.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use super::cut::Cut;
use super::plan::{Axis, NODES, StrayPlan};
use super::sight::Sight;
use super::sum::Sum;
use super::tree::Tree;
use crate::chance::Chance;
use crate::psf::Psf;
use crate::{Error, Result};

/// Products that measuring the error may cost, and the directions that are measured at least and at most.
const EFFORT: usize = 4_000_000;
const MEASURED: Range<usize> = 6..40;

/// The veil of what is outside, on a picture.
pub struct Field {
    plan: Arc<StrayPlan>,
    /// Of all zones, at the nodes of the nearest: RGB, row by row from the lowest.
    nodes: Vec<[f32; 4]>,
}

/// How exact a field is, relative to itself.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct StrayError {
    /// What it was to be.
    pub asked: f64,
    /// What it may be off by.
    pub predicted: f64,
    /// What it was found to be off by, against the sum over all of the panorama's pixels in 64-bit floats.
    pub measured: f64,
    /// At how many pixels.
    pub pixels: usize,
}

impl StrayError {
    /// An error where the veil from outside is further from the truth than was asked.
    ///
    /// # Errors
    /// [`Error::VeilMissed`].
    pub fn check(&self) -> Result<()> {
        // Written so that a NaN would be an error too.
        if self.measured <= self.asked {
            return Ok(());
        }
        Err(Error::VeilMissed { asked: self.asked, measured: self.measured })
    }
}

impl Field {
    pub(super) fn new(tree: &Tree, cuts: &[Cut], sight: &Sight, plan: &Arc<StrayPlan>) -> Self {
        let mut nodes: Vec<[f32; 4]> = Vec::new();
        // From the farthest zone on, each at its own nodes.
        for (index, (layer, cut)) in plan.layers.iter().zip(cuts).enumerate().rev() {
            let sum = Sum { tree, cut, scatter: &plan.scatter, opening: plan.opening };
            let [across, down] = &layer.axes;
            let places = down.nodes.iter().flat_map(|&y| across.nodes.iter().map(move |&x| [x, y]));
            let directions: Vec<DVec3> = places.map(|place| sight.direction(place)).collect();
            let veils = sum.at(&plan.summed, &directions, across.nodes.len());
            let own = veils.into_iter().map(|[r, g, b]| [r as f32, g as f32, b as f32, 0.0]);
            let mut all: Vec<[f32; 4]> = own.collect();
            if let Some(farther) = plan.layers.get(index + 1) {
                let farther = spread(&nodes, &farther.axes);
                all.iter_mut().zip(farther).for_each(|(all, farther)| (0..3).for_each(|k| all[k] += farther[k]));
            }
            nodes = all;
        }
        Self { plan: plan.clone(), nodes }
    }

    /// Adds so many times the veil to the colours of a picture's pixels, row by row, in a window of so many columns that begins
    /// so many columns and rows before the picture.
    pub fn add_to(&self, pixels: &mut [[f32; 4]], columns: usize, before: [u32; 2], times: f64) {
        let [width, height] = self.plan.sides.map(|side| side as usize);
        let [left, top] = before.map(|side| side as usize);
        let rows = pixels.par_chunks_mut(columns).skip(top).take(height).enumerate();
        rows.for_each(|(row, pixels)| {
            let across = self.row(height - 1 - row, times as f32);
            for (pixel, (first, weights)) in pixels[left..left + width].iter_mut().zip(&self.axes()[0].weights) {
                let veil = weighted(&across[*first..], weights);
                (0..3).for_each(|k| pixel[k] += veil[k]);
            }
        });
    }

    /// Of the nearest zone, which the pixels go by.
    fn axes(&self) -> &[Axis; 2] {
        &self.plan.layers[0].axes
    }

    /// So many times the nodes' veil in a row of pixels, counted from the lowest.
    fn row(&self, row: usize, times: f32) -> Vec<[f32; 4]> {
        let [across, down] = self.axes();
        between_rows(&self.nodes, across.nodes.len(), &down.weights[row], times)
    }

    /// The veil at a pixel, by its column and its row from the lowest, RGB.
    fn at(&self, [column, row]: [usize; 2]) -> [f64; 3] {
        let (first, weights) = &self.axes()[0].weights[column];
        let [r, g, b, _] = weighted(&self.row(row, 1.0)[*first..], weights);
        [r, g, b].map(f64::from)
    }

    /// The function that it is of.
    pub(super) fn psf(&self) -> &Psf {
        &self.plan.psf
    }

    /// The mean over the picture, RGB.
    pub fn mean(&self) -> [f64; 3] {
        let share = |axis: &Axis| {
            let mut share = vec![0.0; axis.nodes.len()];
            for (first, weights) in &axis.weights {
                (0..NODES).for_each(|k| share[first + k] += f64::from(weights[k]) / axis.weights.len() as f64);
            }
            share
        };
        let [across, down] = self.axes().each_ref().map(share);
        let mut mean = [0.0; 3];
        for (row, down) in self.nodes.chunks_exact(across.len()).zip(&down) {
            for (node, across) in row.iter().zip(&across) {
                (0..3).for_each(|k| mean[k] += down * across * f64::from(node[k]));
            }
        }
        mean
    }

    /// In how many directions it was summed.
    pub fn directions(&self) -> usize {
        self.plan.directions()
    }

    /// Pixels at which it is measured, by column and row from the lowest: the corners, the middle, and some by chance.
    fn sampled(&self, sources: usize) -> Vec<[usize; 2]> {
        let [width, height] = self.plan.sides.map(|side| side as usize);
        let count = (EFFORT / sources.max(1)).clamp(MEASURED.start, MEASURED.end);
        let mut chance = Chance::new(sources as u64);
        let mut within = |side: usize| (chance.between(0.0, side as f64) as usize).min(side - 1);
        let first =
            [[0, 0], [width - 1, height - 1], [width / 2, height / 2], [0, height / 2], [width / 2, height - 1]];
        first.into_iter().chain((first.len()..count).map(|_| [within(width), within(height)])).collect()
    }

    /// Where those are, over the focal length.
    pub(super) fn samples(&self, sources: usize) -> Vec<[f64; 2]> {
        self.sampled(sources).into_iter().map(|pixel| self.plan.place(pixel)).collect()
    }

    /// How exact it is by the truth at some of its pixels.
    pub(super) fn held_against(
        &self,
        (tree, cuts): (&Tree, &[Cut]),
        sources: usize,
        directions: &[DVec3],
        truth: &[[f64; 3]],
    ) -> StrayError {
        let (mut predicted, mut measured) = (0.0f64, 0.0f64);
        let pixels = self.sampled(sources);
        let plan = &self.plan;
        let sums: Vec<Sum<'_>> =
            cuts.iter().map(|cut| Sum { tree, cut, scatter: &plan.scatter, opening: plan.opening }).collect();
        for ((pixel, direction), truth) in pixels.iter().zip(directions).zip(truth) {
            let bounds: Vec<[f64; 3]> = sums.iter().map(|sum| sum.bound(*direction)).collect();
            let veil = self.at(*pixel);
            for k in (0..3).filter(|&k| truth[k] > 0.0) {
                predicted = predicted.max(bounds.iter().map(|bound| bound[k]).sum::<f64>() / truth[k]);
                let error = (veil[k] - truth[k]).abs() / truth[k];
                measured = if error <= measured { measured } else { error };
            }
        }
        StrayError {
            asked: plan.tolerance,
            predicted: predicted + plan.between + plan.summed.rounding(),
            measured,
            pixels: pixels.len(),
        }
    }
}

/// What goes between nodes, at all places of two axes.
fn spread(nodes: &[[f32; 4]], [across, down]: &[Axis; 2]) -> Vec<[f32; 4]> {
    let row = |weights| {
        let row = between_rows(nodes, across.nodes.len(), weights, 1.0);
        across.weights.iter().map(move |(first, weights)| weighted(&row[*first..], weights)).collect::<Vec<_>>()
    };
    down.weights.iter().flat_map(row).collect()
}

/// So many times what goes between rows of so many nodes.
fn between_rows(
    nodes: &[[f32; 4]],
    columns: usize,
    (first, weights): &(usize, [f32; NODES]),
    times: f32,
) -> Vec<[f32; 4]> {
    let weights = weights.map(|weight| times * weight);
    let column = |column: usize| {
        let nodes: [[f32; 4]; NODES] = std::array::from_fn(|k| nodes[(first + k) * columns + column]);
        weighted(&nodes, &weights)
    };
    (0..columns).map(column).collect()
}

fn weighted(values: &[[f32; 4]], weights: &[f32; NODES]) -> [f32; 4] {
    let mut sum = [0.0f32; 4];
    for (value, weight) in values.iter().zip(weights) {
        (0..4).for_each(|k| sum[k] += weight * value[k]);
    }
    sum
}
