//! The index of a look in closed form: what ghosts and veil make of an even field with black spots, without a picture.
//!
//! | file | what |
//! | --- | --- |
//! | `sight` | the field on the picture's plane, and its spots |
//! | `ghosts`, `area` | the light of a ghost of it at a point |
//! | `veil` | the veil of it at a point |
//! | `rule` | quadrature |
//! | `rays` | the ghosts' light by exact rays |
//! | `args`, `table` | what is asked for, and what is printed |

mod area;
mod args;
mod ghosts;
mod rays;
mod rule;
mod sight;
mod table;
#[cfg(test)]
mod tests;
mod veil;

use glam::DVec2;
use rayon::prelude::*;

use super::field::RING;
use crate::choices::{Border, Mix, Normalize, Projection};
use crate::frame::Frame;
use crate::look::{Look, LookLens};
use crate::psf::Unit;
use crate::scene::{FindOptions, Knee};
use crate::{Error, Result};

pub use args::ClosedArgs;
use ghosts::Row;
pub use rays::ByRays;
use sight::Sight;
pub use table::{columns, print, rays as rays_table};
use veil::Energies;

/// Points of the ring at which the field is measured: the veil's, and the ghosts', which hardly change from one to the next.
const RING_POINTS: u32 = 16;
const GHOST_POINTS: u32 = 8;

/// An index in closed form.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Closed {
    /// Where the spot is, in words, where it is one of a chart's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub place: Option<&'static str>,
    /// From the axis, in degrees.
    pub off_axis_degrees: f64,
    /// In degrees.
    pub diameter_degrees: f64,
    /// Of a lens of surfaces.
    pub f_number: Option<f64>,
    /// D, of a field that is 1 without glare, RGB.
    pub field: [f64; 3],
    /// N/D, RGB, 0 to 1.
    pub index: [f64; 3],
    /// What of it ghosts make, RGB.
    pub ghosts: [f64; 3],
    /// What of it the veil makes, RGB.
    pub veil: [f64; 3],
    /// What exact rays make of the ghosts' part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rays: Option<ByRays>,
}

/// A spot of a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// In words, where it has a name.
    pub name: Option<&'static str>,
    /// On the picture's plane, in the look's unit from the middle.
    pub at: DVec2,
}

/// A look, ready for the indices of any spots.
pub struct Model<'a> {
    /// Fitted to the picture.
    look: &'a Look,
    frame: Frame,
    sight: Sight,
    rows: Vec<Row<'a>>,
    energies: Option<Energies>,
}

/// Why a look has no index in closed form; none where it has one.
pub fn refusal(look: &Look) -> Option<String> {
    let FindOptions { threshold, .. } = look.find;
    let veil = look.veil.as_ref().filter(|_| look.strength != 0.0);
    let of_lens = matches!(look.lens, LookLens::Optical(_)) || look.lens_ghosts().is_empty();
    let why = match veil {
        _ if !of_lens => {
            "is of lenses that are known by their surfaces, or without ghosts: name one by --lens (vglare lens lists them)"
        }
        _ if !look.ghosts.is_empty() => "knows no ghosts that no light makes",
        _ if !look.takes_photo() && !look.lens_ghosts().is_empty() => {
            "is of a look whose every pixel is a source: --sources photo"
        }
        _ if threshold.is_some() || look.find.knee() != Knee::NONE => "is of all light, and of none above a threshold",
        _ if look.axis != DVec2::ZERO => "is of a lens whose axis meets the picture in its middle: leave --axis out",
        _ if look.normalize != Normalize::None => "is of glare that is not normalised",
        Some(veil) if !veil.psf().is_round() => "takes a veil by its radius, and a picture or a starburst has none",
        Some(veil) if veil.psf().energies().windows(2).any(|pair| pair[0] != pair[1]) => "takes veils without tints",
        Some(veil) if veil.border != Border::None => "knows nothing beyond the picture's edges: leave --border out",
        Some(veil) if veil.is_in_degrees() && veil.projection() != Projection::Rectilinear => {
            "takes a veil in degrees on the sphere: leave --projection out"
        }
        _ => return None,
    };
    Some(format!("the closed form {why}"))
}

impl<'a> Model<'a> {
    /// Of a look that was fitted to this frame, whose picture is `focal` pixels from the lens.
    ///
    /// # Errors
    /// [`Error::Usage`] for a look that has none; see [`refusal`].
    pub fn new(look: &'a Look, frame: Frame, focal: f64) -> Result<Self> {
        if let Some(why) = refusal(look) {
            return Err(Error::Usage(why));
        }
        let half = DVec2::new(frame.half_width(), frame.half_height());
        let sight = Sight::new(half, focal * frame.pixel_size());
        let rows = match &look.lens {
            LookLens::Optical(optical) if !look.lens_ghosts().is_empty() && look.strength != 0.0 => {
                let rows: Vec<_> = optical.rimmed().collect();
                rows.into_par_iter().filter_map(|row| Row::new(row, look.size, look.tint, half.length())).collect()
            }
            _ => Vec::new(),
        };
        let energies = look.veil_on(&frame).map(|veil| {
            // A look that is made larger is so by its veil, too, where that is on the picture's plane.
            let unit = if veil.psf().unit() == Unit::Look { look.size } else { 1.0 };
            Energies::new(veil.psf(), unit, &sight)
        });
        Ok(Self { look, frame, sight, rows, energies })
    }

    /// The field that is even but for these spots, of a diameter in degrees.
    fn with_spots(&self, places: &[Place], diameter: f64) -> Result<Sight> {
        let spots = places.iter().map(|place| self.sight.spot(place.at, diameter)).collect();
        let sight = Sight { spots, ..self.sight.clone() };
        if sight.overlaps() {
            return Err(Error::Usage(format!(
                "spots of {diameter}° overlap in this picture, and the closed form takes them one by one"
            )));
        }
        Ok(sight)
    }

    /// The indices of spots of a diameter, all of which are in the field at once.
    ///
    /// # Errors
    /// [`Error::Usage`] for spots that overlap.
    pub fn indices(&self, places: &[Place], diameter: f64) -> Result<Vec<Closed>> {
        let sight = self.with_spots(places, diameter)?;
        let carried = self.carried(&sight);
        Ok(places.par_iter().map(|place| self.index(&sight, place, diameter, carried)).collect())
    }

    /// What of all light is in ghosts, RGB.
    fn carried(&self, sight: &Sight) -> [f64; 3] {
        let parts = self.rows.iter().map(|row| row.share.map(|share| share * row.carried(sight)));
        parts.fold([0.0; 3], |sum, part| [0, 1, 2].map(|c| sum[c] + part[c]))
    }

    fn index(&self, sight: &Sight, place: &Place, diameter: f64, carried: [f64; 3]) -> Closed {
        let Look { strength, mix, .. } = *self.look;
        let ring = |points| sight.ring(place.at, RING * diameter, points);
        let ghosts_around = mean(&ring(GHOST_POINTS), |at| self.ghosts(sight, at));
        let veil_around = mean(&ring(RING_POINTS), |at| [self.veil(sight, at); 3]);
        // What the field loses to its ghosts, and to its veil.
        let scattered =
            self.look.veil_on(&self.frame).filter(|veil| !veil.adds).map_or([0.0; 3], |veil| veil.psf().energies());
        let around = [0, 1, 2].map(|c| {
            let lost = if mix == Mix::Energy { (strength * carried[c]).min(1.0) } else { 0.0 };
            1.0 - lost + strength * (ghosts_around[c] + veil_around[c] - scattered[c])
        });
        let of =
            |light: [f64; 3]| [0, 1, 2].map(|c| if around[c] > 0.0 { strength * light[c] / around[c] } else { 0.0 });
        let (ghosts, veil) = (of(self.ghosts(sight, place.at)), of([self.veil(sight, place.at); 3]));
        Closed {
            place: place.name,
            off_axis_degrees: (place.at.length() / sight.focal).atan().to_degrees(),
            diameter_degrees: diameter,
            f_number: self.f_number(),
            field: around,
            index: [0, 1, 2].map(|c| ghosts[c] + veil[c]),
            ghosts,
            veil,
            rays: None,
        }
    }

    /// Of a lens of surfaces.
    fn f_number(&self) -> Option<f64> {
        if let LookLens::Optical(optical) = &self.look.lens { Some(optical.f_number()) } else { None }
    }

    fn ghosts(&self, sight: &Sight, at: DVec2) -> [f64; 3] {
        let light = |row: &Row<'_>| {
            let light = row.light(sight, at);
            row.share.map(|share| share * light)
        };
        let all: Vec<[f64; 3]> = self.rows.par_iter().map(light).collect();
        all.into_iter().fold([0.0; 3], |sum, part| [0, 1, 2].map(|c| sum[c] + part[c]))
    }

    fn veil(&self, sight: &Sight, at: DVec2) -> f64 {
        self.energies.as_ref().map_or(0.0, |energies| energies.veil(sight, at))
    }

    /// Spots at field angles in degrees along the diagonal to the upper right corner.
    ///
    /// # Errors
    /// [`Error::Usage`] where the ring about one is not in the picture.
    pub fn on_diagonal(&self, angles: &[f64], diameter: f64) -> Result<Vec<Place>> {
        let Sight { half, focal, .. } = self.sight;
        let inside = |angle: f64| {
            let at = focal * angle.to_radians().tan() * half.normalize();
            let ring = || self.sight.ring(at, RING * diameter, 72).into_iter();
            let all = angle + RING * diameter < 90.0 && ring().all(|place| place.abs().cmple(half).all());
            all.then_some(Place { name: None, at })
        };
        let of = |&angle: &f64| {
            inside(angle).ok_or_else(|| {
                let most = (0..=900).rev().map(|step| 0.1 * f64::from(step)).find(|angle| inside(*angle).is_some());
                let room = most.map_or("no angle at all".to_owned(), |most| format!("angles from 0 to {most:.1}°"));
                Error::Usage(format!(
                    "--angles: about a spot of {diameter}° at {angle}° the field is measured beyond the picture's edge; along its diagonal it has room \
                     for {room}"
                ))
            })
        };
        angles.iter().map(of).collect()
    }
}

/// The mean over some places, RGB.
fn mean(places: &[DVec2], of: impl Fn(DVec2) -> [f64; 3] + Sync) -> [f64; 3] {
    let all: Vec<[f64; 3]> = places.par_iter().map(|place| of(*place)).collect();
    let sum = all.iter().fold([0.0; 3], |sum, one| [0, 1, 2].map(|c| sum[c] + one[c]));
    sum.map(|sum| sum / places.len() as f64)
}
