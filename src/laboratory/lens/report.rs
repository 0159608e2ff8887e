//! What is told of a lens: names, units and places as they stand in JSON.

use serde::Serialize;

use super::exact::Exact;
use crate::optics::{Coating, FirstOrder, GhostPath, LINE_D, Prescription, Pupil, Surface, System};
use crate::scene::Optical;

/// A lens, how it is set, and its ghosts. Colours are red, green and blue of linear Rec. 709.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    pub name: String,
    pub description: String,
    pub patent: Option<String>,
    /// What its file leaves open, a sentence each.
    pub notes: Vec<String>,
    /// The names of a zoom's settings.
    pub settings: Vec<String>,
    pub focal_length_mm: f64,
    /// As it is set.
    pub f_number: f64,
    /// Wide open.
    pub widest_f_number: f64,
    /// The angle from the axis of a light whose image is in a corner of the sensor, by f tan θ.
    pub half_field_degrees: f64,
    /// The one that the source states.
    pub stated_half_field_degrees: Option<f64>,
    /// From the first vertex.
    pub entrance_pupil_mm: PupilRow,
    /// From the last vertex; none at infinity.
    pub exit_pupil_mm: Option<PupilRow>,
    pub back_focus_mm: f64,
    /// From the last vertex.
    pub sensor_distance_mm: f64,
    /// From the first vertex to the sensor.
    pub total_length_mm: f64,
    /// Width and height.
    pub sensor_mm: [f64; 2],
    /// Straight blades; none of a round iris.
    pub blades: Option<u32>,
    pub surfaces: Vec<SurfaceRow>,
    /// The wavelengths at which red, green and blue rays are taken.
    pub wavelengths_nm: [f64; 3],
    /// The brightest on the sensor first; as many as are shown.
    pub ghosts: Vec<GhostRow>,
    /// How many ghosts there are.
    pub ghosts_in_all: usize,
    /// The part of a light's own image on the axis that all its ghosts have together.
    pub share: [f64; 3],
    /// Ghosts of four reflections, as pictures have them.
    pub four_reflections: FoursRow,
}

/// Ghosts of four reflections.
#[derive(Debug, Serialize)]
pub(super) struct FoursRow {
    /// How many Gaussians stand for all of them.
    pub gaussians: usize,
    /// The part of a light's own image on the axis that they have beside the others.
    pub share: [f64; 3],
}

/// A place on the axis, and a diameter there.
#[derive(Debug, Clone, Copy, Serialize)]
pub(super) struct PupilRow {
    pub z: f64,
    pub diameter: f64,
}

/// A surface, and what is behind it.
#[derive(Debug, Serialize)]
pub(super) struct SurfaceRow {
    /// From 1.
    pub number: usize,
    /// Positive where the centre lies towards the sensor; none of a plane.
    pub radius_mm: Option<f64>,
    /// To the next vertex, of the last to the sensor.
    pub thickness_mm: f64,
    pub glass: String,
    /// At the d line.
    pub index: f64,
    /// None where the index is the same at every wavelength.
    pub abbe: Option<f64>,
    /// Of the stop, as far as it is open.
    pub semi_aperture_mm: f64,
    pub conic: f64,
    /// None where nothing is refracted.
    pub coating: Option<&'static str>,
    pub stop: bool,
    pub label: Option<String>,
}

/// A ghost of a distant light.
#[derive(Debug, Serialize)]
pub(super) struct GhostRow {
    /// The surfaces that reflect it, in the light's order.
    pub pair: Vec<usize>,
    /// Its centre, as a multiple of where the light's own image is.
    pub magnification: [f64; 3],
    /// Of a light on the axis.
    pub radius_mm: [f64; 3],
    /// The share in each colour, the largest being 1.
    pub tint: [f64; 3],
    /// Of the light of the image on the axis.
    pub share: [f64; 3],
    /// From the sensor, positive behind it; none where its rays are parallel.
    pub focus_mm: Option<f64>,
    /// What rims leave of it for a light in a corner of the sensor.
    pub vignetting: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exact: Option<Exact>,
}

/// Of all ghosts together.
fn share(ghosts: &[GhostPath]) -> [f64; 3] {
    [0, 1, 2].map(|colour| ghosts.iter().map(|ghost| ghost.share[colour]).sum())
}

impl Report {
    /// All of a lens but for its exact rays, with `most` of its ghosts.
    pub fn new(optical: &Optical, system: &System, most: usize) -> Self {
        let (lens, ghosts, fours) = (optical.prescription(), optical.ghosts(), optical.fours());
        let first = system.first_order();
        let FirstOrder { focal_length, back_focus, sensor_distance, half_field, .. } = *first;
        let corner = half_field.to_radians().tan();
        Self {
            name: lens.name.clone(),
            description: lens.description.clone(),
            patent: lens.patent.clone(),
            notes: lens.notes.clone(),
            settings: lens.settings.iter().map(|setting| setting.name.clone()).collect(),
            focal_length_mm: focal_length,
            f_number: first.f_number,
            widest_f_number: first.widest_f_number,
            half_field_degrees: half_field,
            stated_half_field_degrees: lens.field,
            entrance_pupil_mm: first.entrance_pupil.into(),
            exit_pupil_mm: first.exit_pupil.map(PupilRow::from),
            back_focus_mm: back_focus,
            sensor_distance_mm: sensor_distance,
            total_length_mm: system.sensor_z(),
            sensor_mm: system.setup().sensor,
            blades: lens.iris.blades,
            surfaces: surfaces(lens, system),
            wavelengths_nm: ghosts.wavelengths,
            ghosts: ghosts.ghosts.iter().take(most).map(|ghost| GhostRow::new(ghost, corner)).collect(),
            ghosts_in_all: ghosts.ghosts.len(),
            share: share(&ghosts.ghosts),
            four_reflections: FoursRow { gaussians: fours.len(), share: share(fours) },
        }
    }
}

impl From<Pupil> for PupilRow {
    fn from(Pupil { z, radius }: Pupil) -> Self {
        Self { z, diameter: 2.0 * radius.abs() }
    }
}

impl GhostRow {
    fn new(ghost: &GhostPath, corner: f64) -> Self {
        Self {
            pair: ghost.reflections.clone(),
            magnification: ghost.magnification,
            radius_mm: ghost.radius_mm,
            tint: ghost.tint(),
            share: ghost.share,
            focus_mm: ghost.focus_mm,
            vignetting: ghost.vignetting(corner),
            exact: None,
        }
    }
}

fn surfaces(lens: &Prescription, system: &System) -> Vec<SurfaceRow> {
    let placed = system.surfaces();
    let next = placed.iter().skip(1).map(|surface| surface.z).chain([system.sensor_z()]);
    let row = |(k, (surface, next)): (usize, (&Surface, f64))| SurfaceRow {
        number: k + 1,
        radius_mm: surface.radius.filter(|radius| radius.is_finite()),
        thickness_mm: next - placed[k].z,
        glass: surface.glass.name.clone(),
        index: surface.glass.index(LINE_D),
        abbe: Some(surface.glass.abbe()).filter(|abbe| abbe.is_finite()),
        semi_aperture_mm: placed[k].semi_aperture,
        conic: surface.conic,
        coating: coating(lens, k).map(Coating::name),
        stop: surface.stop,
        label: surface.label.clone(),
    };
    lens.surfaces.iter().zip(next).enumerate().map(row).collect()
}

/// What lies on the surface of this index, from 0; none where air is on both sides of it.
pub(super) fn coating(lens: &Prescription, k: usize) -> Option<&Coating> {
    let surface = &lens.surfaces[k];
    let air = [before(lens, k).is_none_or(|before| before.glass.is_air()), surface.glass.is_air()];
    surface.coating.as_ref().or(match air {
        [true, true] => None,
        [false, false] => Some(&Coating::None),
        _ => Some(&lens.coating),
    })
}

/// The surface before the one of this index.
pub(super) fn before(lens: &Prescription, k: usize) -> Option<&Surface> {
    k.checked_sub(1).map(|before| &lens.surfaces[before])
}
