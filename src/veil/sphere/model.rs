//! What is summed on the stereographic image and what near the source, by formula: the plan's side of it.

use super::camera::{Camera, Point, angle};
use super::depths::Depths;
use crate::veil::plan::{Lattice, kernel};

/// Steps of a cell by which lattice kernels are enclosed.
pub(super) const STEPS: usize = 16;

/// Steps of a cell by which the image's profile is tabled: of a Gaussian at least 1.6 cells wide, straight lines between them
/// miss 10⁻⁵.
const FINE: usize = 64;

/// Cells that the table reaches at most.
const PROFILE: usize = 96;

/// The pitch of the coarsest lattice that is its own mirror image, in cells of the finest.
pub(super) const MIRRORED: usize = 8;

/// A Gaussian of the chord: weight · exp(−c² / 2 width²).
#[derive(Debug, Clone, Copy)]
pub(super) struct Term {
    pub width: f64,
    pub weight: f64,
}

/// It at one node of the depths, on its lattice.
#[derive(Debug, Clone)]
pub(in crate::veil) struct Placed {
    /// 0 for the finest lattice, each next of twice the pitch.
    pub level: usize,
    /// Value at 0, the node's factor included.
    pub weight: f64,
    /// Its width, in cells of the finest lattice.
    pub width: f64,
    /// The kernel on its lattice, from 0 on.
    pub half: Vec<f64>,
    /// Least and largest of what is realised at offsets of `1 / STEPS` of the finest cell each.
    range: Vec<[f64; 2]>,
}

/// All that is summed on the image.
#[derive(Debug, Clone)]
pub(in crate::veil) struct Model {
    pub camera: Camera,
    pub depths: Depths,
    /// A cell of the finest lattice, in stereographic coordinates.
    pub cell: f64,
    /// Stereographic coordinates of the first pixel's column and row, negative.
    pub first: [f64; 2],
    /// By nodes.
    pub placed: Vec<Vec<Placed>>,
    /// On so many of the finest lattices the source's depth is taken to be the target's.
    pub local: usize,
    /// By nodes, on local lattices and on the others: what is wanted of the image at distances of `1 / FINE` of a cell each, as far as a small kernel reaches.
    profiles: Vec<[Vec<f64>; 2]>,
    /// What each source adds everywhere, per solid angle.
    pub constant: f64,
}

/// How to lay a model out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layout {
    /// A cell of the finest lattice over a pixel in the middle of the picture.
    pub pitch: f64,
    /// Nodes of the depth.
    pub nodes: usize,
    /// On so many of the finest lattices the source's depth is taken to be the target's: they do not reach far.
    pub local: usize,
    /// Least width of a Gaussian on its lattice, in pitches.
    pub width: f64,
}

impl Model {
    /// Of those terms that are wide enough for the finest lattice. `reaches` says where each ends, by its chord.
    pub fn new(camera: Camera, terms: &[Term], reaches: &[f64], layout: Layout, constant: f64) -> Self {
        let corner = camera.corner();
        let depths = Depths::new(2.0 * corner.depth, layout.nodes);
        let cell = 0.5 * layout.pitch / camera.focal;
        // The corner is farthest in both directions on a rectilinear picture, and the edges' middles are on a round one.
        let edges = [
            camera.point(0.0, 0.5 * (camera.size[1] as f64 - 1.0)),
            camera.point(0.5 * (camera.size[0] as f64 - 1.0), 0.0),
        ];
        // A whole number of cells of the first lattices from end to end, so that their halves are mirror images.
        let first = [0, 1].map(|side| {
            let half = -corner.at[side].min(edges[side].at[side]) / cell;
            -0.5 * cell * (2.0 * half / MIRRORED as f64).ceil().max(1.0) * MIRRORED as f64
        });
        let longest = first.iter().fold(0.0f64, |longest, first| longest.max(-2.0 * first / cell));
        let coarsest = (longest / 6.0).max(1.0).log2() as usize;
        let placed = depths.nodes.iter().map(|node| {
            let terms = terms.iter().zip(reaches).filter(|(_, reach)| **reach > 0.0);
            terms
                .filter_map(|(term, reach)| place(term, *reach, *node, cell, layout.width, coarsest, longest))
                .collect()
        });
        let placed: Vec<Vec<Placed>> = placed.collect();
        let end = PROFILE.min(longest as usize + 4) * FINE;
        let local = layout.local;
        let profile = |placed: &Vec<Placed>, of_local: bool| {
            let some = || placed.iter().filter(|placed| (placed.level < local) == of_local);
            let value = |index: usize| some().map(|placed| placed.value(index as f64 / FINE as f64, 0.0)).sum();
            (0..=end).map(value).collect()
        };
        let profiles = placed.iter().map(|placed| [true, false].map(|of_local| profile(placed, of_local))).collect();
        Self { camera, depths, cell, first, placed, local, profiles, constant }
    }

    /// As [`Self::between`], not enclosed, by tables.
    fn near(&self, source: &Point, target: &Point) -> f64 {
        let [u, v] = [0, 1].map(|side| source.at[side] - target.at[side]);
        let at = u.hypot(v) / self.cell * FINE as f64;
        let (index, share) = (at as usize, at.fract());
        if self.profiles.iter().flatten().any(|profile| index + 1 >= profile.len()) {
            return self.between(source, target, false)[0];
        }
        let depth = source.depth + target.depth;
        let read = |profile: &[f64]| profile[index] + share * (profile[index + 1] - profile[index]);
        let shares = self.depths.shares(2.0 * target.depth).zip(self.depths.shares(depth));
        let nodes = self.profiles.iter().zip(shares);
        let sum: f64 = nodes.map(|([local, far], shares)| shares.0 * read(local) + shares.1 * read(far)).sum();
        sum * (-depth).exp() + self.constant
    }

    /// Points of the finest lattice along each side.
    pub fn points(&self) -> [usize; 2] {
        self.first.map(|first| (-2.0 * first / self.cell) as usize + 4)
    }

    pub fn lattices(&self) -> usize {
        self.placed.iter().flatten().map(|placed| placed.level + 1).max().unwrap_or(0)
    }

    /// From a source to a target, per solid angle: what is wanted of the image, or, where `enclosed`, the least and the largest of
    /// what comes.
    pub fn between(&self, source: &Point, target: &Point, enclosed: bool) -> [f64; 2] {
        let depth = source.depth + target.depth;
        let [u, v] = [0, 1].map(|side| (source.at[side] - target.at[side]).abs() / self.cell);
        let mut sum = [0.0; 2];
        let shares = self.depths.shares(2.0 * target.depth).zip(self.depths.shares(depth));
        for (placed, (local, far)) in self.placed.iter().zip(shares) {
            for placed in placed {
                let share = if placed.level < self.local { local } else { far };
                let [low, high] = if enclosed { placed.enclosed(u, v) } else { [placed.value(u, v); 2] };
                let range = if share >= 0.0 { [share * low, share * high] } else { [share * high, share * low] };
                sum = [sum[0] + range[0], sum[1] + range[1]];
            }
        }
        // 1 / (exp(y_a) exp(y_b)), the factors of the source and of the target.
        sum.map(|sum| sum * (-depth).exp() + self.constant)
    }

    /// What the image returns to a pixel of its own light, per solid angle, if it lies at `cells` from the first column and row; lattices that
    /// are not their own mirror image count by their mean.
    pub fn own(&self, depth: f64, cells: [f64; 2]) -> f64 {
        let nodes = self.placed.iter().zip(self.depths.shares(2.0 * depth));
        let sums = nodes.map(|(placed, share)| {
            let each = placed.iter().map(|placed| {
                if placed.level > MIRRORED.ilog2() as usize {
                    let [low, high] = placed.enclosed(0.0, 0.0);
                    return 0.5 * (low + high);
                }
                let pitch = (1usize << placed.level) as f64;
                let [x, y] = cells.map(|at| own_along((at / pitch).fract(), &placed.half));
                placed.weight * x * y
            });
            share * each.sum::<f64>()
        });
        sums.sum::<f64>() * (-2.0 * depth).exp() + self.constant
    }

    /// By how much that can be wrong, over its value at the middle.
    pub fn own_spread(&self) -> f64 {
        let (mut all, mut wrong) = (0.0f64, 0.0f64);
        for placed in &self.placed {
            let [mut sum, mut error] = [0.0; 2];
            for placed in placed {
                let [low, high] = placed.enclosed(0.0, 0.0);
                sum += low;
                error += if placed.level > MIRRORED.ilog2() as usize { 0.5 * (high - low) } else { 0.0 };
            }
            (all, wrong) = (all.max(sum), wrong.max(error));
        }
        if all > 0.0 { wrong / all } else { 0.0 }
    }
}

/// Σ β(k) h(k − m) β(m) for a point `t` of a pitch after a lattice point.
fn own_along(t: f64, half: &[f64]) -> f64 {
    let weights = crate::veil::plan::weights(t);
    let at = |distance: usize| half.get(distance).copied().unwrap_or(0.0);
    (0..4)
        .map(|distance| {
            let products: f64 = (0..4 - distance).map(|k| weights[k] * weights[k + distance]).sum();
            if distance == 0 { at(0) * products } else { 2.0 * at(distance) * products }
        })
        .sum()
}

impl Placed {
    fn value(&self, u: f64, v: f64) -> f64 {
        self.weight * (-0.5 * (u * u + v * v) / (self.width * self.width)).exp()
    }

    /// Between two offsets that are tabled, both count.
    fn enclosed(&self, u: f64, v: f64) -> [f64; 2] {
        let [x, y] = [u, v].map(|offset| {
            let at = offset * STEPS as f64;
            let at =
                [at.floor() as usize, at.ceil() as usize].map(|at| self.range.get(at).copied().unwrap_or([0.0; 2]));
            let share = (offset * STEPS as f64).fract();
            [0, 1].map(|end| at[0][end] + share * (at[1][end] - at[0][end]))
        });
        [self.weight * x[0] * y[0], self.weight * x[1] * y[1]]
    }
}

/// A term at a node, if it is wide enough.
fn place(term: &Term, reach: f64, node: f64, cell: f64, least: f64, coarsest: usize, longest: f64) -> Option<Placed> {
    // From chords to cells at this depth.
    let cells = 0.5 * (-0.5 * node).exp() / cell;
    let width = term.width * cells;
    let octave = (width / least).log2();
    if octave < 0.0 {
        return None;
    }
    let level = (octave as usize).min(coarsest);
    let pitch = (1usize << level) as f64;
    let radius = ((reach * cells / pitch).ceil() + 1.0).min(longest / pitch + 4.0) as usize;
    let half = kernel(width / pitch, radius);
    let lattice = Lattice { pitch: STEPS << level, kernel: &half };
    let end = ((reach * cells).min(longest) * STEPS as f64) as usize + ((3 * STEPS) << level);
    // Where the lattice is coarse, offsets are read at as many places of a pitch as on the finest.
    let every = 1usize << level;
    let coarse: Vec<[f64; 2]> = (0..=end / every + 1).map(|index| lattice.range(index * every)).collect();
    let range = (0..=end).map(|index| {
        let share = (index % every) as f64 / every as f64;
        let [low, high] = [coarse[index / every], coarse[index / every + 1]];
        [0, 1].map(|end| low[end] + share * (high[end] - low[end]))
    });
    let range = range.collect();
    Some(Placed { level, weight: term.weight * node.exp(), width, half, range })
}

/// The wanted kernel per solid angle, and the small kernel around a target.
pub(super) struct Wanted<'a> {
    pub profile: &'a (dyn Fn(f64) -> f64 + Sync),
    /// The chord up to which the small kernel reaches.
    pub near: f64,
}

impl Wanted<'_> {
    pub fn at(&self, chord: f64) -> f64 {
        (self.profile)(angle(chord))
    }

    /// The value of the small kernel around `target` at `source`, over √ of the ratio of their solid angles, which is taken from
    /// each pixel instead.
    pub fn missing(&self, model: &Model, target: &Point, source: &Point) -> f64 {
        let chord = target.chord(source);
        if chord > self.near || chord == 0.0 {
            return 0.0;
        }
        (self.at(chord) - model.near(source, target)) * (source.solid_angle * target.solid_angle).sqrt()
    }
}
