//! A lens that is known by its surfaces, set as a photographer sets it, and the table of ghosts that it makes on a picture.

mod fours;
mod rimmed;
mod rows;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::lens::{Lens, LensVeil};
use super::veil::VeilSection;
use super::{Ghost, LensGhost, Light, lenses, presets};
use crate::frame::Frame;
use crate::optics::{Coating, GhostOptions, GhostPath, LensFormat, LensGhosts, Prescription, Setup, System};
use crate::psf::{Name, Parameters};
use crate::{Error, Result};

pub(crate) use rimmed::Rimmed;

/// Width and height of a sensor, in mm, where none is named: what these lenses are made for.
pub const SENSOR: [f64; 2] = [36.0, 24.0];

/// `[optics]`: a lens, and how it is set. What is `None` is as the lens's file has it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OpticsSection {
    /// The name of a lens that comes with vglare.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lens: Option<String>,
    /// A file of surfaces, instead.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// The f-number to which it is stopped down; wide open without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fstop: Option<f64>,
    /// The distance from the sensor to what is in focus, in m; infinity without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub focus: Option<f64>,
    /// Width and height of the sensor, in mm, the longer of which the picture's longer side spans; [`SENSOR`] without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor: Option<[f64; 2]>,
    /// Blades of the iris, which shape it when it is stopped down: 3 to 16, or 0 for a round one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blades: Option<u32>,
    /// The coating of all surfaces between glass and air: one of [`Coating::NAMES`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coating: Option<String>,
    /// Of a zoom, which of its settings.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub setting: Option<String>,
}

/// A lens, set up, and the table of its ghosts for pictures of one shape.
#[derive(Debug, Clone)]
pub struct Optical {
    section: OpticsSection,
    made: Arc<Made>,
    /// What a unit of lengths on the picture is on the sensor.
    millimetres: f64,
    lens: Arc<Lens>,
    /// Of each row of the table, which of the lens's ghosts it is.
    paths: Arc<[usize]>,
}

/// Lights whose ghosts have the outline that rims leave, at most; those of others have their light and their middle.
const MOST_CUT: usize = 4;
/// Where there are more, the brightest have it that outshine all others so many times.
const OUTSHINE: f64 = 2.0;

impl PartialEq for Optical {
    /// Whichever picture it was fitted to; and looks are compared again and again.
    fn eq(&self, other: &Self) -> bool {
        self.section == other.section && (Arc::ptr_eq(&self.made, &other.made) || self.made == other.made)
    }
}

/// What does not depend on the picture.
#[derive(Debug, PartialEq)]
struct Made {
    prescription: Prescription,
    /// Of two reflections.
    ghosts: LensGhosts,
    /// Of four, those that look alike as one.
    fours: Vec<GhostPath>,
    opening: rows::Opening,
    veil: Option<LensVeil>,
    /// The name for people.
    name: String,
    /// The f-number, as it is set and with the stop wide open.
    f_number: f64,
    widest: f64,
}

impl OpticsSection {
    /// Another way to set the lens, in what it says.
    pub fn set(&mut self, other: &Self) {
        let Self { lens: _, file: _, fstop, focus, sensor, blades, coating, setting } = other.clone();
        self.fstop = fstop.or(self.fstop);
        self.focus = focus.or(self.focus);
        self.sensor = sensor.or(self.sensor);
        self.blades = blades.or(self.blades);
        self.coating = coating.or(self.coating.take());
        self.setting = setting.or(self.setting.take());
    }

    /// Whether it says what is of a lens alone: an opening and a sensor may be a starburst's.
    pub fn sets_lens(&self) -> bool {
        self.focus.is_some() || self.coating.is_some() || self.setting.is_some()
    }

    /// The lens's surfaces, as they are set but for what a stop or a focus changes.
    ///
    /// # Errors
    /// [`Error::UnknownLens`], [`Error::Optics`], and [`Error::Usage`] for settings that cannot be.
    pub fn prescription(&self) -> Result<Prescription> {
        let mut lens = match (&self.lens, &self.file) {
            (Some(name), None) => lenses::find(name)?.prescription()?,
            (None, Some(path)) => Prescription::read(path)?,
            _ => return Err(Error::Usage("[optics] names either a `lens` or a `file`".into())),
        };
        if let Some(setting) = &self.setting {
            lens = lens.setting(setting)?;
        }
        if let Some(name) = &self.coating {
            let known = || format!("no coating is called {name:?}; there are {}", Coating::NAMES.join(", "));
            lens.coating = Coating::named(name).ok_or_else(|| Error::Usage(known()))?;
            lens.surfaces.iter_mut().for_each(|surface| surface.coating = None);
        }
        if let Some(blades) = self.blades {
            if blades != 0 && !(3..=16).contains(&blades) {
                return Err(Error::Usage(format!(
                    "an iris has from 3 to 16 blades, or 0 where it is round, and not {blades}"
                )));
            }
            lens.iris.blades = (blades != 0).then_some(blades);
        }
        Ok(lens)
    }

    /// How it is set.
    pub fn setup(&self) -> Setup {
        Setup { fstop: self.fstop, focus: self.focus, sensor: self.sensor.unwrap_or(SENSOR), ..Setup::default() }
    }
}

impl Optical {
    /// A lens, for pictures as wide as its sensor.
    ///
    /// # Errors
    /// Those of [`OpticsSection::prescription`], and [`Error::Optics`] for what the lens cannot be set to.
    pub fn new(section: OpticsSection) -> Result<Self> {
        let prescription = section.prescription()?;
        let setup = section.setup();
        let system = System::new(&prescription, &setup)?;
        let all = system.ghosts(&GhostOptions { four_bounces: Some(fours::LEAST), ..GhostOptions::default() })?;
        let (pairs, fours) = all.ghosts.into_iter().partition(|ghost| ghost.reflections.len() == 2);
        let ghosts = LensGhosts { ghosts: pairs, ..all };
        let half = 0.5 * setup.sensor[0].hypot(setup.sensor[1]);
        let name = match (&section.lens, &section.file) {
            (Some(name), _) => name.clone(),
            (None, file) => {
                file.as_deref().and_then(Path::file_stem).unwrap_or_default().to_string_lossy().into_owned()
            }
        };
        let made = Made {
            opening: rows::Opening::new(&prescription.iris, system.first_order(), setup.wavelength),
            // A file says what reflects, and nothing of what scatters.
            veil: section.lens.is_some().then(|| veil(&prescription.coating)),
            prescription,
            f_number: system.first_order().f_number,
            widest: system.first_order().widest_f_number,
            ghosts,
            fours: fours::gathered(fours, half),
            name,
        };
        let [width, height] = setup.sensor;
        Ok(Self::fit(section, made.into(), 0.5 * width.min(height)))
    }

    fn fit(section: OpticsSection, made: Arc<Made>, millimetres: f64) -> Self {
        let rows = rows::rows(&made.ghosts.ghosts, &made.fours, &made.opening, millimetres);
        let paths = rows.iter().map(|row| row.ghost).collect();
        let lens = Lens {
            name: made.name.clone(),
            description: made.prescription.description.clone(),
            ghosts: rows.into_iter().map(|row| row.lens).collect(),
            veil: made.veil.clone(),
        };
        Self { section, made, millimetres, paths, lens: lens.into() }
    }

    /// The same on a picture: the longer side of the sensor is what the picture's longer side spans.
    pub fn fitted(&self, frame: &Frame) -> Self {
        let [width, height] = self.section.sensor.unwrap_or(SENSOR);
        let millimetres = 0.5 * width.max(height) / frame.half_width().max(frame.half_height());
        if millimetres == self.millimetres {
            return self.clone();
        }
        Self::fit(self.section.clone(), self.made.clone(), millimetres)
    }

    /// The table of its ghosts, in the unit of the picture that it was fitted to.
    pub fn lens(&self) -> &Arc<Lens> {
        &self.lens
    }

    /// The table for lights that lie at `place`, counted from the axis in the unit of the picture that it was fitted to: the same rows,
    /// each with what the rims of the lens leave of it. A row of which nothing is left has no share.
    pub fn ghosts_at(&self, place: DVec2) -> Vec<LensGhost> {
        let rows: Vec<Rimmed<'_>> = self.rimmed().collect();
        rows.par_iter().map(|row| row.at(place)).collect()
    }

    /// The rows of the table, each as it depends on where light is.
    pub(crate) fn rimmed(&self) -> impl Iterator<Item = Rimmed<'_>> {
        let (tangent, _) = self.direction(DVec2::X);
        let of = move |(row, &path): (_, &usize)| Rimmed { row, path, ghost: self.path(path), tangent };
        self.lens.ghosts.iter().zip(&*self.paths).map(of)
    }

    /// The ghosts of all lights that are not muted, light by light in the table's order, as rims leave them. Each light has outlines of its
    /// own, which no two share and a series would have to transform one by one. So of many those that outshine the others have them, if
    /// these are few; all others keep their whole outline, about the middle of what is left, with the light of that.
    pub fn ghosts_of(&self, lights: &[Light], axis: DVec2) -> Vec<Ghost> {
        let shining: Vec<&Light> = lights.iter().filter(|light| !light.muted).collect();
        let least = outshining(shining.iter().map(|light| brightness(light)).collect());
        let of = |light: &&Light| -> Vec<Ghost> {
            if brightness(light) < least {
                return self.dimmed(light, axis);
            }
            self.ghosts_at(light.position - axis).iter().map(|ghost| ghost.of(light, axis)).collect()
        };
        shining.par_iter().flat_map_iter(of).collect()
    }

    /// What a row is of, by its number: of two reflections, then of four.
    fn path(&self, number: usize) -> &GhostPath {
        let pairs = &self.made.ghosts.ghosts;
        pairs.get(number).unwrap_or_else(|| &self.made.fours[number - pairs.len()])
    }

    /// The ghosts of a light, whole, each about the middle of what rims leave and with the light of that.
    fn dimmed(&self, light: &Light, axis: DVec2) -> Vec<Ghost> {
        let (tangent, towards) = self.direction(light.position - axis);
        let of = move |(row, path): (&LensGhost, &usize)| {
            let path = self.path(*path);
            let left = path.vignetting(tangent).clamp(0.0, 1.0);
            let ghost = row.of(light, axis);
            let center = ghost.center + path.shift(tangent) / self.millimetres * towards;
            Ghost { center, radiance: ghost.radiance.map(|radiance| left * radiance), ..ghost }
        };
        self.lens.ghosts.iter().zip(&*self.paths).map(of).collect()
    }

    /// The tangent of the angle of light from a place, and the direction of that from the axis.
    fn direction(&self, place: DVec2) -> (f64, DVec2) {
        (place.length() * self.millimetres / self.made.ghosts.image_per_tangent, place.normalize_or_zero())
    }

    /// How far from the axis light lies whose angle has this tangent, in the unit of the picture that it was fitted to.
    pub fn place(&self, tangent: f64) -> f64 {
        tangent * self.made.ghosts.image_per_tangent / self.millimetres
    }

    /// The f-number that it is set to.
    pub fn f_number(&self) -> f64 {
        self.made.f_number
    }

    /// The f-number with the stop wide open.
    pub fn widest(&self) -> f64 {
        self.made.widest
    }

    /// Which lens it is, and how it is set.
    pub fn section(&self) -> &OpticsSection {
        &self.section
    }

    /// Its surfaces.
    pub fn prescription(&self) -> &Prescription {
        &self.made.prescription
    }

    /// Its ghosts of two reflections, in millimetres on the sensor.
    pub fn ghosts(&self) -> &LensGhosts {
        &self.made.ghosts
    }

    /// Those of four, where they have any light to speak of: many that look alike as one.
    pub fn fours(&self) -> &[GhostPath] {
        &self.made.fours
    }
}

fn brightness(light: &Light) -> f64 {
    light.flux.iter().sum()
}

/// From which brightness on lights have outlines of their own, of the brightnesses of all.
fn outshining(mut all: Vec<f64>) -> f64 {
    all.sort_by(|a, b| b.total_cmp(a));
    if all.len() <= MOST_CUT {
        return f64::NEG_INFINITY;
    }
    let outshines = |count: &usize| all[count - 1] > OUTSHINE * all[*count];
    (1..=MOST_CUT).rev().find(outshines).map_or(f64::INFINITY, |count| all[count - 1])
}

/// What dust, barrel and rough glass scatter in a lens of a time, which its coating tells: a choice, in the range of ISO 9358's
/// index of good and old lenses.
fn veil(coating: &Coating) -> LensVeil {
    let scatter = match coating {
        Coating::None => 0.03,
        Coating::MgF2 => 0.02,
        Coating::V | Coating::W => 0.015,
        Coating::Multi | Coating::Layers(_) => 0.01,
    };
    let parameters = Parameters { scatter: Some(scatter), ..Parameters::new(Name::Camera) };
    let section = VeilSection { parameters, fov: None, projection: None, border: None, tolerance: None };
    LensVeil { section, replaces_ghosts: false }
}

/// A lens by its name, or by its file.
#[derive(Debug, Clone, PartialEq)]
pub enum NamedLens {
    /// One of `media/presets`.
    Preset(Lens),
    /// That of a file of ghosts.
    Table(PathBuf, Lens),
    /// One that is known by its surfaces.
    Optical(Optical),
}

impl NamedLens {
    /// A preset, of which nothing is set.
    ///
    /// # Errors
    /// [`Error::Usage`] where something is.
    pub fn preset(lens: Lens, settings: &OpticsSection) -> Result<Self> {
        without_surfaces(&lens.name, settings)?;
        Ok(Self::Preset(lens))
    }
}

/// The lens that a name or a path means, set as `settings` says: a file where there is one, else a real lens of that name, or a
/// preset. What a file is, its content tells.
///
/// # Errors
/// [`Error::UnknownLens`] for what is neither; [`Error::SceneFile`] and [`Error::Optics`] for files that cannot be read;
/// [`Error::Usage`] for settings of a lens that has no surfaces.
pub fn named_lens(name: &Path, settings: &OpticsSection) -> Result<NamedLens> {
    let text = name.to_string_lossy();
    let is_path = name.is_file() || name.extension().is_some() || name.components().count() > 1;
    let section = if is_path {
        if !is_prescription(name) {
            without_surfaces(&text, settings)?;
            return Ok(NamedLens::Table(name.to_owned(), super::read_lens(name)?));
        }
        OpticsSection { file: Some(name.to_owned()), ..settings.clone() }
    } else if let Err(unknown) = lenses::find(&text) {
        let Ok(preset) = presets::named(&text) else { return Err(unknown) };
        return NamedLens::preset(preset, settings);
    } else {
        OpticsSection { lens: Some(text.into_owned()), ..settings.clone() }
    };
    Ok(NamedLens::Optical(Optical::new(section)?))
}

fn without_surfaces(name: &str, settings: &OpticsSection) -> Result<()> {
    if settings.sets_lens() {
        return Err(Error::Usage(format!(
            "the lens {name} is a table of ghosts: focus, coating and setting are of lenses that are known by their surfaces (vglare lens \
             lists them)"
        )));
    }
    Ok(())
}

/// Whether a file is a lens's surfaces, and not a table of ghosts. Of one that cannot be read, the reader of either tells.
fn is_prescription(path: &Path) -> bool {
    let Ok(bytes) = fs::read(path) else { return path.extension().is_some_and(|end| end != "toml") };
    let text = String::from_utf8_lossy(&bytes);
    match text.parse::<toml::Table>() {
        Ok(table) => table.contains_key("surface"),
        // Zemax writes UTF-16.
        Err(_) => bytes.contains(&0) || LensFormat::of(&text) != LensFormat::Toml,
    }
}

#[cfg(test)]
mod tests;
