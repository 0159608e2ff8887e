//! The ghosts of a lens as rows of a table: each a bell where its magnification says, as large and as bright as paraxial rays make it.
//!
//! A ghost of a distant light is its opening, out of focus: evenly bright, with the shape that the iris has and an edge that diffraction
//! softens. Fresnel's fringes of an edge that is d from focus are √(λ d) wide on the sensor.
//!
//! Off the axis the rims of the lens cut it: on the sensor each is a circle whose centre goes with the light's direction, and the narrowest
//! of them is the opening itself.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use glam::DVec2;

use crate::optics::{Clip, FirstOrder, GhostPath, Iris as Blades};
use crate::scene::LensGhost;
use crate::series::{Bell, Cut, Iris};

/// The edges that an [`Iris`] is given, over its radius: real ghosts have aberrations, too, and sharper ones cost a photo more
/// harmonics than they show. The softest is one that is no edge any more.
const EDGES: [f64; 2] = [0.05, 0.3];

/// No edge is sharper than this, in the unit of lengths: some three pixels at 1080p.
const SHARPEST: f64 = 0.007;

/// Ghosts of a smaller radius, in the unit of lengths, are Gaussians, the narrowest of which is half as wide: one that is in focus shows
/// the light itself, and not the iris.
const SMALLEST: f64 = 0.024;

/// Colours that lie less than this far apart are one ghost, over the width of its edge.
const APART: f64 = 1.0;

/// A logistic step falls from 90 to 10 % within so many of the edges that its iris is given.
const STEP: f64 = 4.4;

/// The next of some edges, so that ghosts share them, and what is computed of each.
fn stepped(edge: f64) -> f64 {
    const STEP: f64 = 1.2;
    let [sharpest, softest] = EDGES;
    let steps = (edge / sharpest).log(STEP).ceil().max(0.0);
    (sharpest * STEP.powf(steps)).min(softest)
}

/// What shapes the ghosts of a lens.
#[derive(Debug)]
pub(super) struct Opening {
    /// Straight sides; none where the iris is round, or open wider than its blades reach.
    blades: Option<u32>,
    /// In degrees.
    rotation: f64,
    /// In mm.
    wavelength: f64,
    /// By edge and rotation.
    known: Mutex<HashMap<(u64, u64), Iris>>,
}

impl PartialEq for Opening {
    fn eq(&self, other: &Self) -> bool {
        (self.blades, self.rotation, self.wavelength) == (other.blades, other.rotation, other.wavelength)
    }
}

impl Opening {
    /// Of an iris in a lens, at a wavelength in nm.
    pub fn new(iris: &Blades, lens: &FirstOrder, wavelength: f64) -> Self {
        Self {
            blades: iris.sides(lens),
            rotation: iris.rotation,
            wavelength: 1e-6 * wavelength,
            known: Mutex::default(),
        }
    }

    /// The bell of a ghost whose radius on the sensor is so many mm, upside down or not, and its size; lengths are in units of so many mm.
    fn bell(&self, radius: f64, upside_down: bool, focus: Option<f64>, unit: f64) -> (Bell, f64) {
        let size = radius / unit;
        if size < SMALLEST {
            return (Bell::Gaussian, 0.5 * SMALLEST.max(size));
        }
        let fringe = focus.map_or(f64::INFINITY, |focus| (self.wavelength * focus.abs()).sqrt());
        let edge = stepped((fringe / radius / STEP).max(SHARPEST / size));
        let turned = if upside_down { 180.0 } else { 0.0 };
        let (blades, rotation) = match self.blades {
            Some(blades) => (blades, (self.rotation + turned).rem_euclid(360.0 / f64::from(blades))),
            None => (0, 0.0),
        };
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let iris = match known.get(&(edge.to_bits(), rotation.to_bits())) {
            Some(iris) => iris.clone(),
            None => match Iris::new(edge, blades, rotation) {
                Ok(iris) => known.entry((edge.to_bits(), rotation.to_bits())).or_insert(iris).clone(),
                // Of what a lens may say, no iris is refused.
                Err(_) => return (Bell::Gaussian, 0.5 * size),
            },
        };
        (Bell::Iris(iris), size)
    }
}

/// A row of the table, and the ghost that it is of, by its place in the lens's list.
pub(super) struct Row {
    pub ghost: usize,
    pub lens: LensGhost,
}

/// The rows of all ghosts that have any light, those of two reflections and then the faint ones of four, where a unit of lengths is so many
/// mm on the sensor.
pub(super) fn rows(pairs: &[GhostPath], fours: &[GhostPath], opening: &Opening, unit: f64) -> Vec<Row> {
    let of = |(number, ghost)| of_ghost(ghost, opening, unit).into_iter().map(move |lens| Row { ghost: number, lens });
    let faint = |(number, ghost)| matched(ghost, unit).map(|lens| Row { ghost: pairs.len() + number, lens });
    pairs.iter().enumerate().flat_map(of).chain(fours.iter().enumerate().filter_map(faint)).collect()
}

/// The Gaussian of a ghost's variance, for all colours: a disc has a quarter of its radius squared along each axis.
fn matched(ghost: &GhostPath, unit: f64) -> Option<LensGhost> {
    let largest = ghost.share.into_iter().fold(0.0, f64::max);
    let total: f64 = ghost.share.iter().sum();
    let mean =
        |values: [f64; 3]| values.iter().zip(ghost.share).map(|(value, share)| value * share).sum::<f64>() / total;
    let (along, size) = (mean(ghost.magnification), 0.5 * (mean(ghost.radius_mm) / unit).max(SMALLEST));
    (largest > 0.0 && along.is_finite() && size.is_finite()).then(|| LensGhost {
        bell: Bell::Gaussian,
        along,
        size: DVec2::splat(size),
        tint: ghost.share.map(|share| share / largest),
        share: largest,
    })
}

/// The row of a ghost of a light on the axis, for a light at a tangent of its angle in the direction of a unit vector: with what rims
/// leave of the ghost's shape and of its light.
pub(super) fn cut(row: &LensGhost, ghost: &GhostPath, tangent: f64, towards: DVec2) -> LensGhost {
    let left = ghost.vignetting(tangent).clamp(0.0, 1.0);
    let (bell, left) = match &row.bell {
        Bell::Iris(iris) => match iris.cut(&rims(ghost, iris.edge(), tangent, towards)) {
            Some(iris) => (Bell::Iris(iris), left),
            None => (row.bell.clone(), 0.0),
        },
        other => (other.clone(), left),
    };
    LensGhost { bell, share: row.share * left, ..row.clone() }
}

/// All but the narrowest, in its radii and from its centre.
///
/// A rim that just touches the opening would take half of what the opening's own edge leaves there. So one that hardly bites lies a few
/// edges farther out, and ghosts change smoothly as it comes in.
pub(super) fn rims(ghost: &GhostPath, edge: f64, tangent: f64, towards: DVec2) -> Vec<Cut> {
    const FARTHER: f64 = Cut::SPARED;
    let Some((narrowest, others)) = ghost.clips.split_first() else { return Vec::new() };
    let rim = |clip: &Clip| {
        let apart = (clip.center_per_tangent - narrowest.center_per_tangent) * tangent;
        let centre = ghost.scale[1].signum() * apart / narrowest.radius * towards;
        let radius = clip.radius / narrowest.radius;
        let bites = (centre.length() + 1.0 - radius).max(0.0);
        Cut { centre, radius: radius + FARTHER * edge * (-bites / (FARTHER * edge)).exp() }
    };
    others.iter().map(rim).collect()
}

/// A row for all colours where they lie at one place, and one for each where dispersion moves or scales them.
fn of_ghost(ghost: &GhostPath, opening: &Opening, unit: f64) -> Vec<LensGhost> {
    let of = |magnification: f64, radius: f64, share: [f64; 3]| {
        let largest = share.into_iter().fold(0.0, f64::max);
        let (bell, size) = opening.bell(radius, ghost.scale[1] < 0.0, ghost.focus_mm, unit);
        let tint = share.map(|share| share / largest);
        (largest > 0.0 && magnification.is_finite() && size.is_finite()).then(|| LensGhost {
            bell,
            along: magnification,
            size: DVec2::splat(size),
            tint,
            share: largest,
        })
    };
    let total: f64 = ghost.share.iter().sum();
    let mean =
        |values: [f64; 3]| -> f64 { values.iter().zip(ghost.share).map(|(value, share)| value * share / total).sum() };
    let (magnification, radius) = (mean(ghost.magnification), mean(ghost.radius_mm));
    if total.is_nan() || total <= 0.0 {
        return Vec::new();
    }
    let shines = |c: &usize| ghost.share[*c] > 0.0;
    let spread = |values: [f64; 3]| {
        let (low, high) = (0..3)
            .filter(shines)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), c| (low.min(values[c]), high.max(values[c])));
        high - low
    };
    // As far as it matters for a light at the middle of an edge of the picture.
    let apart = unit * spread(ghost.magnification) + spread(ghost.radius_mm);
    let edge = match opening.bell(radius, false, ghost.focus_mm, unit) {
        (Bell::Iris(iris), size) => STEP * iris.edge() * size * unit,
        (_, size) => size * unit,
    };
    if apart <= APART * edge {
        return of(magnification, radius, ghost.share).into_iter().collect();
    }
    let alone = |c: usize| {
        let mut share = [0.0; 3];
        share[c] = ghost.share[c];
        of(ghost.magnification[c], ghost.radius_mm[c], share)
    };
    (0..3).filter(shines).filter_map(alone).collect()
}
