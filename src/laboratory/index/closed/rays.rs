//! The ghosts' part of an index by exact rays, beside that of the closed form.

use glam::DVec2;
use rayon::prelude::*;
use serde::Serialize;

use super::sight::Sight;
use super::{Closed, Model, Place};
use crate::laboratory::index::told::luminance;
use crate::look::LookLens;
use crate::optics::{BrightField, GhostPath, Irradiance, Path, System};
use crate::scene::Optical;
use crate::{Error, Result};

/// From which the shifts of all rays follow.
const SEED: u64 = 0x9358;
/// Rays of the direct light, which are few beside those of all ghosts.
const DIRECT: usize = 1 << 17;

/// The ghosts' part of an index, by rays.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ByRays {
    /// Rays for each pair of surfaces.
    pub rays: usize,
    /// Of N/D, RGB.
    pub ghosts: [f64; 3],
    /// Half the width of the interval of 99 % about it, RGB.
    pub interval: [f64; 3],
    /// The luminance of both.
    pub luminance: [f64; 2],
    /// What each ghost has of that, the brightest first.
    pub paths: Vec<OfPath>,
}

/// What light along a path has of an index; luminance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OfPath {
    /// The surfaces that reflect it, in the light's order, from 1.
    pub reflections: Vec<usize>,
    /// In closed form.
    pub closed: f64,
    /// By rays.
    pub rays: f64,
    /// Half the width of the interval of 99 % about that.
    pub interval: f64,
}

/// A lens, and what the middle of a field without glare has.
pub struct Tracing<'a> {
    optical: &'a Optical,
    system: &'a System,
    field: BrightField<'a>,
    direct: Irradiance,
    rays: usize,
}

/// The lens of a look, set up for rays.
///
/// # Errors
/// [`Error::Usage`] for a look whose ghosts are none of a lens as it is; those of [`System::new`].
pub fn system(model: &Model<'_>) -> Result<System> {
    let refuse = |why: &str| Err(Error::Usage(format!("--rays: {why}")));
    match &model.look.lens {
        LookLens::Optical(_) if model.look.size != 1.0 || model.look.tint != [1.0; 3] => {
            refuse("rays are of a lens as it is, of no other size or tint")
        }
        LookLens::Optical(optical) => Ok(System::new(optical.prescription(), &optical.section().setup())?),
        _ => refuse("rays are of a lens that is known by its surfaces: name one by --lens (vglare lens lists them)"),
    }
}

impl<'a> Tracing<'a> {
    /// By so many rays for each pair of surfaces, through the lens of a model that is set up.
    ///
    /// # Errors
    /// Those of [`system`] and of [`BrightField::irradiance`].
    pub fn new(model: &Model<'a>, system: &'a System, rays: usize) -> Result<Self> {
        let LookLens::Optical(optical) = &model.look.lens else {
            return Err(Error::Internal { what: "a lens without surfaces has no rays".into() });
        };
        let field = BrightField::new(system)?;
        let direct = field.irradiance(&Path::direct(system), DVec2::ZERO, even, DIRECT, SEED)?;
        Ok(Self { optical, system, field, direct, rays })
    }

    /// The ghosts' part of the index of a place, beside the closed form; `spots` are all that are black at once.
    ///
    /// # Errors
    /// Those of [`BrightField::irradiance`].
    pub fn index(&self, model: &Model<'_>, spots: &[Place], place: &Place, closed: &Closed) -> Result<ByRays> {
        let sight = model.with_spots(spots, closed.diameter_degrees)?;
        let per_tangent = self.optical.place(1.0);
        let lit = |tangent: DVec2| if sight.is_lit(per_tangent * tangent) { even(tangent) } else { 0.0 };
        let position = place.at * (self.optical.ghosts().image_per_tangent / per_tangent);
        let part = |light: [f64; 3]| [0, 1, 2].map(|c| model.look.strength * light[c] / closed.field[c]);
        let seen = |light: [f64; 3]| luminance(part(light));
        let of = |(number, ghost): (usize, &GhostPath)| {
            let path = Path::new(self.system, &ghost.reflections)?;
            let seed = SEED.wrapping_add(1 + number as u64);
            let light = self.field.irradiance(&path, position, lit, self.rays, seed)?.over(&self.direct);
            let [rays, interval] = light.of(seen);
            let closed = seen(of_path(model, &sight, number, place.at));
            Ok((light, OfPath { reflections: ghost.reflections.clone(), closed, rays, interval }))
        };
        let all: Vec<(Irradiance, OfPath)> =
            self.optical.ghosts().ghosts.par_iter().enumerate().map(of).collect::<Result<_>>()?;
        let whole = all.iter().fold(Irradiance::default(), |sum, (light, _)| sum.plus(light));
        let channels = [0, 1, 2].map(|c| whole.of(|light| part(light)[c]));
        let mut paths: Vec<OfPath> = all.into_iter().map(|(_, path)| path).collect();
        paths.sort_by(|one, other| other.rays.max(other.closed).total_cmp(&one.rays.max(one.closed)));
        Ok(ByRays {
            rays: self.rays,
            ghosts: channels.map(|[mean, _]| mean),
            interval: channels.map(|[_, interval]| interval),
            luminance: whole.of(seen),
            paths,
        })
    }
}

impl ByRays {
    /// What the closed form makes of the same ghosts, of luminance.
    pub fn closed(&self) -> f64 {
        self.paths.iter().map(|path| path.closed).sum()
    }
}

/// The radiance of a scene whose direct image is even: light aslant illuminates a plane by the fourth power of its cosine.
fn even(tangent: DVec2) -> f64 {
    (1.0 + tangent.length_squared()).powi(2)
}

/// What one of the lens's ghosts sends to a point, RGB.
fn of_path(model: &Model<'_>, sight: &Sight, path: usize, at: DVec2) -> [f64; 3] {
    let rows = model.rows.iter().filter(|row| row.path == path);
    rows.fold([0.0; 3], |sum, row| {
        let light = row.light(sight, at);
        [0, 1, 2].map(|c| sum[c] + row.share[c] * light)
    })
}
