//! How a veil on the sphere is summed, and how far that is from what was wanted.
//!
//! The bound is the largest |realised − wanted| / wanted over pairs of pixels: targets spread over the picture, and for
//! each of them all near sources and far ones by distances and directions. Realised values are enclosed over all phases between lattice
//! points, as on a plane. Between the pairs that are looked at, kernels and geometry vary slowly; [`BETWEEN`] allows for it
//! ([`super::measure`]).

use super::Sphere;
use super::camera::{Camera, Point};
use super::fit::{error, fit};
use super::measure::{BETWEEN, beyond, far, near as near_error};
use super::model::{Layout, Mixture, Model, Term, Wanted};
use super::tiles::{FARTHEST, Slopes, Tiles, middle};
use crate::veil::error::Error;
use crate::veil::kernel::Gaussian;
use crate::veil::plan::OWN_SHARE;
use crate::veil::simd::Real;

/// A cell over a pixel in the middle, that are tried.
const PITCHES: [f64; 6] = [0.5, 0.7, 1.0, 1.4, 2.0, 2.8];

/// Least widths on a lattice that are tried, in its pitches.
const WIDTHS: [f64; 6] = [1.6, 2.0, 2.6, 3.4, 4.5, 6.0];

/// Sizes of tiles that are tried, in columns and rows.
const TILES: [[usize; 2]; 8] = [[64, 32], [32, 16], [16, 16], [16, 8], [8, 8], [4, 4], [2, 2], [1, 1]];

/// Layouts that are looked at closely before the tolerance counts as out of reach.
const LOOKS: usize = 24;

/// Of those that meet the tolerance, so many are compared.
const COMPARED: usize = 3;

/// The share of the tolerance below which a Gaussian's tail is cut off.
const TAIL: f64 = 0.02;

/// The share of the tolerance that what the image alone misses beyond the small kernels may take.
const BEYOND: f64 = 0.75;

/// The share of the tolerance that the slopes of the small kernels may leave in a corner of a tile.
const SLOPES: f64 = 0.5;

/// From a Gaussian's width to the next at a tolerance of 1e-2, and the power of the tolerance that it goes by.
const LADDER: [f64; 2] = [1.6, 0.052];

/// The widest Gaussian, by its chord.
const WIDEST: f64 = 2.5;

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

/// A layout that has been looked at.
struct Look {
    model: Model,
    /// The chord as far as small kernels reach.
    near: f64,
    tile: [usize; 2],
    bound: f64,
    unit: f64,
    roundings: f64,
    operations: f64,
}

/// Why a layout will not do: the bound that it comes to and where, in pixels, or that its small kernels would be too large.
enum Fails {
    Tolerance(f64, f64),
    Core,
}

/// The cheapest layout that meets the tolerance.
pub(in crate::veil) fn choose(task: &Task) -> Result<Chosen, Error> {
    let longest = task.longest();
    let from = task.from(longest);
    let wanted = |chord: f64| task.wanted(chord) - task.constant;
    let terms = task.terms(from, longest);
    let reaches: Vec<f64> = terms.iter().map(|term| task.reach(term, longest)).collect();
    let range = [from, longest];
    let mixture = Mixture {
        terms: &terms,
        reaches: &reaches,
        constant: task.constant,
        wanted: &wanted,
        range,
        tolerance: task.tolerance,
    };
    let mut closest = (f64::INFINITY, 0.0);
    let mut found: Vec<Look> = Vec::new();
    for (layout, estimate) in task.layouts(&mixture).into_iter().take(LOOKS) {
        let least = found.iter().map(|look| look.operations).fold(f64::INFINITY, f64::min);
        if found.len() == COMPARED || estimate > least {
            break;
        }
        match task.look(&mixture, layout) {
            Ok(look) => found.push(look),
            Err(Fails::Tolerance(bound, distance)) if bound < closest.0 => closest = (bound, distance),
            Err(_) => {}
        }
    }
    found.sort_by(|one, other| one.operations.total_cmp(&other.operations));
    for look in found {
        let wanted = Wanted { profile: task.profile, near: look.near };
        if let Some(tiles) = Tiles::new(&look.model, &wanted, look.tile) {
            let model = look.model;
            let on = |level: usize| model.placed.iter().filter(|placed| placed.level == level).count();
            return Ok(Chosen {
                bound: look.bound + OWN_SHARE * task.tolerance,
                rounding: look.unit,
                roundings: look.roundings,
                operations: look.operations,
                lattices: (0..model.lattices()).map(on).collect(),
                reach: look.near * task.camera.focal,
                sphere: Sphere::new(model, tiles),
            });
        }
    }
    if closest.0.is_finite() {
        return Err(Error::OutOfReach {
            asked: task.tolerance,
            best: closest.0 / (1.0 - OWN_SHARE),
            distance: closest.1,
        });
    }
    Err(Error::Core { asked: task.tolerance, most: FARTHEST })
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

    /// The chord from which on a mixture is to follow the kernel: a pixel's, or where it begins to fall.
    fn from(&self, longest: f64) -> f64 {
        let mut from = (1.5 / self.camera.focal).min(0.5 * longest);
        // What is flat, as a kernel that is defined from some angle on, is left to the small kernels.
        let flat = |chord: f64| self.wanted(1.05 * chord) >= (1.0 - 1e-4) * self.wanted(0.5 * chord);
        if flat(from) {
            while from < 0.2 * longest && flat(from / 1.08) {
                from *= 1.03;
            }
        }
        from
    }

    /// Weights for Gaussians of the chord.
    fn terms(&self, from: f64, longest: f64) -> Vec<Term> {
        let given: Vec<(f64, f64)> = self.mixture.iter().map(|term| (term.sigma.to_radians(), term.weight)).collect();
        // A ladder of widths: a step by step finer one errs by half as much.
        let step = LADDER[0] * (self.tolerance / 1e-2).clamp(1e-3, 10.0).powf(LADDER[1]);
        let mut widths = vec![0.35 * from];
        while widths.last().is_some_and(|width| *width < WIDEST) {
            widths.extend(widths.last().map(|width| width * step));
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

    /// Layouts that may do and some operations that they will cost, the cheapest first.
    fn layouts(&self, mixture: &Mixture) -> Vec<(Layout, f64)> {
        let mut layouts = Vec::new();
        for pitch in PITCHES {
            for width in WIDTHS {
                let layout = Layout { pitch, width };
                let near = self.near_of_mixture(mixture, layout);
                if self.radius(near)[1] <= 2.0 * FARTHEST as f64 {
                    layouts.push((layout, self.operations(mixture, layout, near, TILES[0])));
                }
            }
        }
        layouts.sort_by(|one, other| one.1.total_cmp(&other.1));
        layouts
    }

    /// From which chord on the Gaussians that a layout takes do without the others.
    fn near_of_mixture(&self, mixture: &Mixture, layout: Layout) -> f64 {
        let least = layout.width * layout.pitch / self.camera.focal;
        let wide = || mixture.terms.iter().filter(|term| term.width >= 1.05 * least);
        let image = |chord: f64| {
            wide().map(|term| term.weight * (-0.5 * (chord / term.width).powi(2)).exp()).sum::<f64>() + self.constant
        };
        let mut near = mixture.range[1];
        while near > 0.7 / self.camera.focal {
            if (image(near) / self.wanted(near) - 1.0).abs() > BEYOND * self.tolerance {
                return 1.03 * near;
            }
            near /= 1.03;
        }
        near
    }

    /// A chord in pixels, in the middle and at most in the corner.
    fn radius(&self, chord: f64) -> [f64; 2] {
        let middle = chord * self.camera.focal;
        [middle, middle / self.camera.corner().scale.powi(2)]
    }

    /// Multiply-adds for each pixel.
    fn operations(&self, mixture: &Mixture, layout: Layout, near: f64, tile: [usize; 2]) -> f64 {
        let least = layout.width * layout.pitch / self.camera.focal;
        let cells = self.camera.focal / layout.pitch;
        let wide = mixture.terms.iter().zip(mixture.reaches).filter(|(term, _)| term.width >= 1.05 * least);
        let kernels: f64 = wide
            .map(|(term, reach)| {
                let level = (term.width * cells / layout.width).log2().floor().max(0.0);
                let half = (reach * cells / level.exp2()).min(6.0 * layout.width * 2.0);
                2.0 * (2.0 * half + 3.0) * 0.25f64.powf(level)
            })
            .sum();
        // A vector is as wide as the widest processors'; narrower tiles leave parts of it idle.
        let idle = (16.0 / tile[0] as f64).max(1.0) * (4.0 / tile[1] as f64).max(1.0);
        let scale = self.camera.corner().scale;
        let taps = std::f64::consts::PI * (self.radius(near)[0] + 0.5).powi(2) / scale;
        // Slopes make a tap half as dear again. Pixels are scattered to 16 points and gathered, and what is to be done for each cell is
        // some 24 operations.
        1.5 * idle * taps + (kernels + 24.0) / layout.pitch.powi(2) + 60.0
    }

    /// Looks closely at a layout.
    fn look(&self, mixture: &Mixture, layout: Layout) -> Result<Look, Fails> {
        let model = Model::new(self.camera, mixture, layout);
        let share = self.tolerance * (1.0 - OWN_SHARE);
        let unit = |near: f64| {
            // Phases on the lattice are rounded as well: at both ends, where a Gaussian falls by up to 4 of its widths a width.
            let roundings = roundings(&model, self.radius(near)[1].min(FARTHEST as f64)) + 8.0 / layout.width;
            (roundings, roundings * <f32 as Real>::UNIT)
        };
        let limit = (share - unit(0.0).1 - model.drift[0]) / BETWEEN;
        let (chord, worst) = beyond(&model, self.profile, 0.99 * limit);
        // What is near is told at the middle of tiles, and chords differ a little between pixels of one.
        let near = if chord > 0.0 { 1.02 * chord + 0.3 / self.camera.focal } else { 0.0 };
        if self.radius(near)[0] > FARTHEST as f64 {
            // What it would take for this image to do without small kernels that far.
            let bound = BETWEEN * worst + unit(0.0).1 + model.drift[0];
            return Err(if worst < 1.0 { Fails::Tolerance(bound, chord * self.camera.focal) } else { Fails::Core });
        }
        let (roundings, unit) = unit(near);
        let limit = (share - unit - model.drift[0]) / BETWEEN;
        let wanted = Wanted { profile: self.profile, near };
        let all = |worst: f64| BETWEEN * worst + unit + model.drift[0];
        let far = far(&model, &wanted);
        if far.0 > limit {
            return Err(Fails::Tolerance(all(far.0), far.1));
        }
        let mut closest = (f64::INFINITY, 0.0);
        let fine = TILES.into_iter().filter(|tile| self.tile_suffices(*tile));
        for tile in fine {
            let (worst, distance) = near_error(&model, &wanted, tile, limit);
            let bound = all(worst.max(far.0));
            if worst <= limit {
                let operations = self.operations(mixture, layout, near, tile);
                return Ok(Look { near, tile, bound, unit, roundings, operations, model });
            }
            if bound < closest.0 {
                closest = (bound, distance);
            }
        }
        Err(Fails::Tolerance(closest.0, closest.1))
    }

    /// Whether slopes are right enough at a tile's corner, for sources a few pixels away.
    fn tile_suffices(&self, tile: [usize; 2]) -> bool {
        let tiles = [0, 1].map(|side| self.camera.size[side] / tile[side]);
        let value = |source: &Point, target: &Point| {
            self.wanted(target.chord(source)) * (source.solid_angle * target.solid_angle).sqrt()
        };
        let places =
            [[0, 0], tiles.map(|tiles| tiles / 2), [0, tiles[1] / 2], [tiles[0] / 2, 0], tiles.map(|tiles| tiles / 4)];
        places.into_iter().all(|place| {
            let centre = middle(place, tile);
            let slopes = Slopes::new(centre, tile);
            let [x, y] = tile.map(|side| -0.5 * (side as f64 - 1.0));
            [[1, 0], [0, 1], [2, 2], [5, 0], [0, 5], [4, -4]].into_iter().all(|offset| {
                let [middle, across, down] = slopes.of(&self.camera, offset, value);
                let target = self.camera.point(centre[0] + x, centre[1] + y);
                let source = self.camera.point(centre[0] + x + offset[0] as f64, centre[1] + y + offset[1] as f64);
                ((middle + x * across + y * down) / value(&source, &target) - 1.0).abs() < SLOPES * self.tolerance
            })
        })
    }
}

/// The longest chain of roundings.
fn roundings(model: &Model, radius: f64) -> f64 {
    let taps = |placed: &super::model::Placed| 2 * placed.half.len() + 1;
    let chain = |placed: &super::model::Placed| {
        // Those of one slot are added to what is there, tap by tap.
        let added: usize = model.placed.iter().filter(|other| other.slot == placed.slot).map(taps).sum();
        taps(placed) + added + 16 * placed.level
    };
    let longest = model.placed.iter().map(chain).max().unwrap_or(0) + 80;
    // A small kernel is summed in a row.
    (longest + model.placed.len()) as f64 + std::f64::consts::PI * radius * radius
}
