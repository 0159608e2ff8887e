//! How a veil on the sphere is summed, and how far that is from what was wanted.
//!
//! The bound is the largest |realised − wanted| / wanted over pairs of pixels: targets spread over the picture, and for
//! each of them all near sources and far ones by distances and directions. Realised values are enclosed over all phases between lattice
//! points, as on a plane. Between the pairs that are looked at, kernels and geometry vary slowly; [`BETWEEN`] allows for it.

use rayon::prelude::*;

use super::Sphere;
use super::camera::{Camera, Point};
use super::depths::Depths;
use super::fit::{error, fit};
use super::model::{Layout, Model, Term, Wanted};
use super::tiles::{FARTHEST, Tiles, middle};
use crate::veil::error::Error;
use crate::veil::kernel::Gaussian;
use crate::veil::plan::OWN_SHARE;
use crate::veil::simd::Real;

/// A cell over a pixel in the middle, that are tried.
const PITCHES: [f64; 4] = [1.0, 1.4, 2.0, 2.8];

/// Least widths on a lattice that are tried, in its pitches.
const WIDTHS: [f64; 4] = [1.6, 2.0, 2.6, 3.4];

/// Most nodes of the depth.
const NODES: usize = 3;

/// Sizes of tiles that are tried, in columns and rows.
const TILES: [[usize; 2]; 8] = [[64, 32], [32, 16], [16, 16], [16, 8], [8, 8], [4, 4], [2, 2], [1, 1]];

/// Of those that a first look finds fine enough, so many are tried, from the largest on.
const TRIED: usize = 3;

/// By how much the bound over all pairs can be above that over those that are looked at.
const BETWEEN: f64 = 1.1;

/// Layouts that are looked at closely before the tolerance counts as out of reach.
const LOOKS: usize = 48;

/// Layouts whose small kernels may turn out too large before all count as such.
const ATTEMPTS: usize = 2;

/// The share of the tolerance below which a Gaussian's tail is cut off.
const TAIL: f64 = 0.02;

/// The share of the tolerance that what the image alone misses beyond the small kernels may take.
const BEYOND: f64 = 0.75;

/// Gaussians from this width on, in pixels, are doubled in number.
const WIDE: f64 = 20.0;

/// What was chosen.
pub(in crate::veil) struct Chosen {
    pub sphere: Sphere,
    pub bound: f64,
    pub rounding: f64,
    pub roundings: f64,
    pub operations: f64,
    pub lattices: Vec<usize>,
    pub reach: f64,
}

/// What is asked for.
pub(in crate::veil) struct Task<'a> {
    pub camera: Camera,
    /// Per steradian, by degrees.
    pub profile: &'a (dyn Fn(f64) -> f64 + Sync),
    /// The mixture of Gaussians of the angle, in degrees.
    pub mixture: &'a [Gaussian],
    pub constant: f64,
    pub tolerance: f64,
}

/// A layout, with what is known before it is looked at closely.
struct Candidate {
    layout: Layout,
    near: f64,
    tile: [usize; 2],
    operations: f64,
}

/// The cheapest layout that meets the tolerance.
pub(in crate::veil) fn choose(task: &Task) -> Result<Chosen, Error> {
    let longest = task.longest();
    let terms = task.terms(longest);
    let reaches: Vec<f64> = terms.iter().map(|term| task.reach(term, longest)).collect();
    let candidates = task.candidates(&terms, &reaches, longest);
    if candidates.is_empty() {
        return Err(Error::Core { asked: task.tolerance, most: FARTHEST });
    }
    let (mut closest, mut looks, mut too_large) = ((f64::INFINITY, 0.0), 0, 0);
    // Layouts whose image is wrong where no small kernel reaches, whatever the tiles.
    let mut hopeless: Vec<Layout> = Vec::new();
    for candidate in candidates {
        if hopeless.contains(&candidate.layout) {
            continue;
        }
        if looks == LOOKS {
            break;
        }
        looks += 1;
        let model = Model::new(task.camera, &terms, &reaches, candidate.layout, task.constant);
        let wanted = Wanted { profile: task.profile, near: candidate.near };
        let roundings = roundings(&model, candidate.near * task.camera.focal);
        // Positions on the lattice are rounded as well: at both ends, where a Gaussian falls by up to 4 of its widths a width.
        let positions = model.points().into_iter().max().unwrap_or(0) as f64 * 2.0 * 4.0 / candidate.layout.width;
        let unit = (roundings + positions) * <f32 as Real>::UNIT;
        let limit = task.tolerance * (1.0 - OWN_SHARE) / BETWEEN - unit;
        let (worst, distance) = bound(&model, &wanted, candidate.tile, limit);
        let total = BETWEEN * worst + unit;
        if worst > limit {
            if total < closest.0 {
                closest = (total, distance);
            }
            if distance > 2.0 * candidate.near * task.camera.focal / task.camera.corner().scale.powi(2) {
                hopeless.push(candidate.layout);
            }
            continue;
        }
        let Some(tiles) = Tiles::new(&model, &wanted, candidate.tile) else {
            too_large += 1;
            if too_large == ATTEMPTS {
                return Err(Error::Core { asked: task.tolerance, most: FARTHEST });
            }
            continue;
        };
        let lattices =
            (0..model.lattices()).map(|level| model.placed[0].iter().filter(|placed| placed.level == level).count());
        return Ok(Chosen {
            bound: total + OWN_SHARE * task.tolerance,
            rounding: unit,
            roundings,
            operations: candidate.operations,
            lattices: lattices.collect(),
            reach: candidate.near * task.camera.focal,
            sphere: Sphere::new(model, tiles),
        });
    }
    Err(Error::OutOfReach { asked: task.tolerance, best: closest.0 / (1.0 - OWN_SHARE), distance: closest.1 })
}

impl Task<'_> {
    fn wanted(&self, chord: f64) -> f64 {
        (self.profile)(super::angle(chord))
    }

    /// The longest chord between two pixels: between opposite corners.
    fn longest(&self) -> f64 {
        let [width, height] = self.camera.size.map(|side| side as f64 - 1.0);
        self.camera.corner().chord(&self.camera.point(width, height))
    }

    /// Weights for Gaussians of the chord, fitted from where the kernel begins to fall to the longest chord.
    fn terms(&self, longest: f64) -> Vec<Term> {
        let given: Vec<(f64, f64)> = self.mixture.iter().map(|term| (term.sigma.to_radians(), term.weight)).collect();
        let mut widths: Vec<f64> = given.iter().map(|(width, _)| *width).collect();
        widths.sort_by(f64::total_cmp);
        // The fit has to follow the chord as well, which wide Gaussians do, on lattices where they cost next to nothing.
        let between: Vec<f64> = widths.windows(2).map(|pair| (pair[0] * pair[1]).sqrt()).collect();
        widths.extend(between.into_iter().filter(|width| *width > WIDE / self.camera.focal));
        widths.extend([0.7, 1.2, 2.5]);
        widths.sort_by(f64::total_cmp);
        let step = 1.5 / self.camera.focal;
        let mut from = step.min(0.5 * longest);
        // What is flat, as a kernel that is defined from some angle on, is left to the small kernels.
        let flat = |chord: f64| self.wanted(1.05 * chord) >= (1.0 - 1e-4) * self.wanted(0.5 * chord);
        if flat(from) {
            while from < 0.2 * longest && flat(from / 1.08) {
                from *= 1.03;
            }
        }
        let wanted = |chord: f64| self.wanted(chord) - self.constant;
        let weights = fit(&widths, wanted, from, longest);
        let fitted: Vec<(f64, f64)> = widths.into_iter().zip(weights).collect();
        // On a narrow field an angle is its chord, and what was given for the one does for the other.
        let [ours, theirs] = [&fitted, &given].map(|terms| error(terms, wanted, from, longest));
        let terms = if theirs < ours { given } else { fitted };
        terms.into_iter().filter(|(_, weight)| *weight > 0.0).map(|(width, weight)| Term { width, weight }).collect()
    }

    /// The largest chord at which a term shows.
    fn reach(&self, term: &Term, longest: f64) -> f64 {
        let mut chord = longest;
        while chord > 0.2 / self.camera.focal {
            if term.weight * (-0.5 * (chord / term.width).powi(2)).exp() > TAIL * self.tolerance * self.wanted(chord) {
                return chord;
            }
            chord /= 1.03;
        }
        0.0
    }

    /// Whether one kernel for a tile in the corner is right enough at the tile's own corner, for sources a few pixels away.
    fn tile_suffices(&self, tile: [usize; 2]) -> bool {
        let centre = middle([0, 0], tile);
        let point = |x: f64, y: f64| self.camera.point(x, y);
        let [target, stands_in] = [point(0.0, 0.0), point(centre[0], centre[1])];
        let weight = |one: &Point, other: &Point| (one.solid_angle * other.solid_angle).sqrt();
        let wrong = |[x, y]: [f64; 2]| {
            let (source, other) = (point(x, y), point(centre[0] + x, centre[1] + y));
            let wanted = self.wanted(target.chord(&source)) * weight(&target, &source);
            (self.wanted(stands_in.chord(&other)) * weight(&stands_in, &other) / wanted - 1.0).abs()
        };
        let offsets = [[1.0, 0.0], [0.0, 1.0], [2.0, 2.0], [5.0, 0.0], [0.0, 5.0]];
        offsets.into_iter().map(wrong).fold(0.0, f64::max) < self.tolerance
    }

    /// Whether what the kernel has besides an inverse square is interpolated well enough between so many depths, far from its core.
    fn nodes_suffice(&self, nodes: usize) -> bool {
        let depths = Depths::new(2.0 * self.camera.corner().depth, nodes);
        let chords = [8.0, 60.0, 300.0].map(|pixels| pixels / self.camera.focal);
        let beside = |chord: f64, depth: f64| self.wanted(chord * (0.5 * depth).exp()) * depth.exp();
        let misses = |chord: f64| {
            let miss = |depth: f64| {
                let sum: f64 =
                    depths.shares(depth).zip(&depths.nodes).map(|(share, node)| share * beside(chord, *node)).sum();
                (sum / beside(chord, depth) - 1.0).abs()
            };
            miss(0.0).max(miss(depths.middle)).max(miss(2.0 * depths.middle))
        };
        chords.into_iter().filter(|chord| *chord < 0.5).all(|chord| misses(chord) < self.tolerance)
    }

    /// Layouts that may do, the cheapest first.
    fn candidates(&self, terms: &[Term], reaches: &[f64], longest: f64) -> Vec<Candidate> {
        let fine = TILES.into_iter().filter(|tile| self.tile_suffices(*tile));
        let tiles: Vec<[usize; 2]> = fine.take(TRIED).collect();
        let mut candidates = Vec::new();
        for pitch in PITCHES {
            for width in WIDTHS {
                for nodes in 1..=NODES {
                    if !self.nodes_suffice(nodes) {
                        continue;
                    }
                    for (tile, local) in tiles.iter().flat_map(|tile| [(*tile, 2), (*tile, 1), (*tile, 0)]) {
                        let layout = Layout { pitch, nodes, local, width };
                        if nodes > 1 || local == 0 {
                            candidates.extend(self.candidate(terms, reaches, layout, tile, longest));
                        }
                    }
                }
            }
        }
        candidates.sort_by(|one, other| one.operations.total_cmp(&other.operations));
        candidates
    }

    /// A layout if its small kernels are not too large.
    fn candidate(
        &self,
        terms: &[Term],
        reaches: &[f64],
        layout: Layout,
        tile: [usize; 2],
        longest: f64,
    ) -> Option<Candidate> {
        let least = layout.width * layout.pitch / self.camera.focal;
        // At the depth of the nearest node the finest lattice takes terms from this width on.
        let wide = || terms.iter().zip(reaches).filter(|(term, _)| term.width >= 1.05 * least);
        let image = |chord: f64| {
            wide().map(|(term, _)| term.weight * (-0.5 * (chord / term.width).powi(2)).exp()).sum::<f64>()
                + self.constant
        };
        let mut near = longest;
        while near > 0.7 / self.camera.focal {
            let wanted = self.wanted(near);
            if (image(near) / wanted - 1.0).abs() > BEYOND * self.tolerance {
                near *= 1.03;
                break;
            }
            near /= 1.03;
        }
        let scale = self.camera.corner().scale;
        let radius = near * self.camera.focal;
        if radius / (scale * scale) > 4.0 * FARTHEST as f64 || radius > FARTHEST as f64 {
            return None;
        }
        let nodes = layout.nodes as f64;
        let kernels: f64 = wide()
            .map(|(term, reach)| {
                let cells = self.camera.focal / layout.pitch;
                let level = (term.width * cells / layout.width).log2().floor().max(0.0);
                2.0 * (2.0 * (reach * cells / level.exp2()).min(6.0 * layout.width * 2.0) + 3.0)
                    * 0.25f64.powf(level)
                    * if level < layout.local as f64 { nodes } else { nodes * nodes }
            })
            .sum();
        let near_operations = std::f64::consts::PI * (radius + 0.5).powi(2) / scale.sqrt();
        // Scattered points cost more than rows: some 20 operations for each of 16 points there and back.
        // A vector is as wide as the widest processors'; narrower tiles leave parts of it idle.
        let idle = (16.0 / tile[0] as f64).max(1.0) * (4.0 / tile[1] as f64).max(1.0);
        let near_operations = near_operations * idle * (1.0 + 0.1 / tile[1] as f64);
        let operations = near_operations + kernels / layout.pitch.powi(2) + 40.0 * nodes;
        Some(Candidate { layout, near, tile, operations })
    }
}

/// The largest relative error over pairs, and the distance in pixels where it is; any above `enough` will do.
fn bound(model: &Model, wanted: &Wanted, tile: [usize; 2], enough: f64) -> (f64, f64) {
    let [width, height] = model.camera.size;
    let mut targets = Vec::new();
    for share in [[0.0, 0.0], [0.5, 0.5], [0.0, 0.5], [0.25, 0.25], [0.5, 0.0], [0.12, 0.4], [0.4, 0.12], [0.75, 0.9]] {
        let at = [share[0] * (width - 1) as f64, share[1] * (height - 1) as f64].map(|at: f64| at as usize);
        // A tile's corners are where its kernel is most wrong.
        let origin = [0, 1].map(|side| at[side] / tile[side] * tile[side]);
        for corner in [[0, 0], [tile[0] - 1, 0], [0, tile[1] - 1]] {
            targets.push([(origin[0] + corner[0]).min(width - 1), (origin[1] + corner[1]).min(height - 1)]);
        }
    }
    let worst = std::sync::Mutex::new((0.0f64, 0.0f64));
    let peek = || worst.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    targets.par_iter().for_each(|target| {
        if peek().0 > enough {
            return;
        }
        let found = around(model, wanted, tile, *target);
        let mut worst = peek();
        if found.0 > worst.0 {
            *worst = found;
        }
    });
    let worst = peek();
    *worst
}

/// Offsets around a target: near ones within two pixels, and by distances and directions.
fn offsets(model: &Model, target: [usize; 2]) -> Vec<[usize; 2]> {
    let [width, height] = model.camera.size;
    let mut sources = Vec::new();
    let mut add = |x: f64, y: f64| {
        let (x, y) = (x.round(), y.round());
        if x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64 {
            sources.push([x as usize, y as usize]);
        }
    };
    let [x, y] = target.map(|at| at as f64);
    let mut distance = 1.0f64;
    while distance < (width + height) as f64 {
        for direction in 0..24 {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(direction) / 24.0).sin_cos();
            add(x + distance * cosine, y + distance * sine);
        }
        distance = (distance * 1.05).max(distance + 0.5);
    }
    sources.retain(|source| *source != target);
    sources.sort_unstable();
    sources.dedup();
    sources
}

/// The largest relative error of sources at one target, and its distance in pixels.
fn around(model: &Model, wanted: &Wanted, tile: [usize; 2], target: [usize; 2]) -> (f64, f64) {
    let point = |at: [f64; 2]| -> Point { model.camera.point(at[0], at[1]) };
    let centre_at = middle([0, 1].map(|side| target[side] / tile[side]), tile);
    let centre = point(centre_at);
    let at = target.map(|at| at as f64);
    let here = point(at);
    let mut worst = (0.0, 0.0);
    for source in offsets(model, target) {
        let offset = [0, 1].map(|side| source[side] as f64 - at[side]);
        let there = point(source.map(|at| at as f64));
        let truth = wanted.at(here.chord(&there));
        let [low, high] = model.between(&there, &here, true);
        let stands_in = point([0, 1].map(|side| centre_at[side] + offset[side]));
        let near = wanted.missing(model, &centre, &stands_in) / (there.solid_angle * here.solid_angle).sqrt();
        let error = (high + near - truth).max(truth - low - near) / truth;
        // NaN counts as worst.
        if error > worst.0 || error.is_nan() {
            worst = (error, offset[0].hypot(offset[1]));
        }
    }
    worst
}

/// The longest chain of roundings.
fn roundings(model: &Model, radius: f64) -> f64 {
    let chain = |placed: &super::model::Placed| 2 * (2 * placed.half.len() + 1) + 16 * placed.level;
    let longest = model.placed.iter().flatten().map(chain).max().unwrap_or(0) + 80;
    // A column of a small kernel is summed in a row.
    (longest + model.placed.iter().map(Vec::len).sum::<usize>()) as f64 + std::f64::consts::PI * radius * radius
}
