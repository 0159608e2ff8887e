//! Rows of a lens's table as they depend on where light is, for integrals over all places: no bell is made for each.

use glam::DVec2;

use super::rows;
use crate::optics::GhostPath;
use crate::scene::LensGhost;
use crate::series::{Bell, Cut};

/// A row of the table, by where the light is.
pub(crate) struct Rimmed<'a> {
    /// The row, of light on the axis.
    pub row: &'a LensGhost,
    /// Which of the lens's ghosts it is of.
    pub path: usize,
    pub(super) ghost: &'a GhostPath,
    /// Of the angle of light that is a unit from the axis.
    pub(super) tangent: f64,
}

impl Rimmed<'_> {
    /// Whether it matters where the light is.
    pub fn is_cut(&self) -> bool {
        self.ghost.clips.len() > 1
    }

    /// What rims leave of the light of the row, so far from the axis.
    pub fn left(&self, distance: f64) -> f64 {
        self.ghost.vignetting(distance * self.tangent).clamp(0.0, 1.0)
    }

    /// How far the middle of what rims leave is from the ghost's own centre, in its radii, towards the light's own image.
    pub fn shift(&self, distance: f64) -> f64 {
        let [_, radius, _] = self.ghost.radius_mm;
        if radius > 0.0 { self.ghost.shift(distance * self.tangent) / radius } else { 0.0 }
    }

    /// The row for light at a place, counted from the axis: with what rims leave of its shape and of its light.
    pub fn at(&self, place: DVec2) -> LensGhost {
        rows::cut(self.row, self.ghost, place.length() * self.tangent, place.normalize_or_zero())
    }

    /// The rims that bite into its iris, in its sizes, of light so far from the axis in the direction of x; none of another bell.
    pub fn cuts(&self, distance: f64) -> Vec<Cut> {
        let Bell::Iris(iris) = &self.row.bell else { return Vec::new() };
        iris.biting(&rows::rims(self.ghost, iris.edge(), distance * self.tangent, DVec2::X))
    }
}
