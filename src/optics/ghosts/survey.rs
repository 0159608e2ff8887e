//! What all ghosts of a lens have in common, and each of them from it.

use std::f64::consts::PI;

use super::{GhostPath, clipped};
use crate::optics::clip::{Clip, common_area};
use crate::optics::colour::Sensitivity;
use crate::optics::error::Result;
use crate::optics::matrix::RayMatrix;
use crate::optics::path::Path;
use crate::optics::system::System;

/// What is computed once for all ghosts of a lens.
pub(super) struct Survey<'a> {
    /// Where a light's own image is, in mm for a tangent of 1.
    pub image_per_tangent: f64,
    /// The rims that bound the light of that image.
    pub clips: Vec<Clip>,
    pub observer: Sensitivity,
    system: &'a System,
    /// Reflectance of each surface at each of the observer's wavelengths, along the axis.
    reflectances: Vec<Vec<f64>>,
    /// The light that comes straight through, at each wavelength.
    direct: Vec<f64>,
    /// The image's area in the pupil, on the axis.
    area: f64,
    /// The radius in the pupil, on the axis, of what goes straight to each surface.
    reach: Vec<f64>,
    /// The tangent up to which rims count.
    tangent: f64,
    /// Indices at the setup's wavelength, and at those of the colours.
    indices: Vec<f64>,
    colours: [Vec<f64>; 3],
}

/// Two surfaces that reflect, the second in front of the first.
pub(super) struct MirrorPair {
    /// Their numbers, in the light's order.
    pub reflections: [usize; 2],
    /// The product of their reflectances at each wavelength.
    spectrum: Vec<f64>,
}

impl<'a> Survey<'a> {
    /// That of a lens, for lights up to this tangent of their angle from the axis.
    pub fn of(system: &'a System, tangent: f64) -> Self {
        let indices = system.indices(system.setup().wavelength);
        let path = Path::direct(system);
        let (matrix, clips) = clipped(system, &path, &indices);
        let narrowest = |narrowest: &mut f64, clip: &Clip| {
            *narrowest = narrowest.min(clip.radius);
            Some(*narrowest)
        };
        let reach = clips.iter().scan(f64::INFINITY, narrowest).collect();
        let clips = system.that_bite(clips, tangent);
        let observer = Sensitivity::standard_observer();
        let mut survey = Self {
            image_per_tangent: system.height_per_tangent(&matrix),
            area: common_area(&clips, 0.0),
            clips,
            reflectances: reflectances(system, &observer.wavelengths),
            colours: observer.centres.map(|wavelength| system.indices(wavelength)),
            observer,
            system,
            direct: Vec::new(),
            reach,
            tangent,
            indices,
        };
        survey.direct = survey.spectrum(&path);
        survey
    }

    /// The part of the light that a path leaves at each wavelength, along the axis.
    fn spectrum(&self, path: &Path) -> Vec<f64> {
        let mut spectrum = vec![1.0; self.observer.wavelengths.len()];
        for step in path.steps() {
            for (power, reflectance) in spectrum.iter_mut().zip(&self.reflectances[step.surface]) {
                *power *= if step.reflects { *reflectance } else { 1.0 - reflectance };
            }
        }
        spectrum
    }

    /// All pairs of surfaces that reflect.
    pub fn pairs(&self) -> Vec<MirrorPair> {
        // Less is rounding between equal media.
        let reflects = |of: &Vec<f64>| of.iter().any(|&reflectance| reflectance > 1e-12);
        let mirrors: Vec<_> = (1..).zip(&self.reflectances).filter(|(_, of)| reflects(of)).collect();
        let pair = |&(b, at_b): &(usize, &Vec<f64>), &(a, at_a): &(usize, &Vec<f64>)| MirrorPair {
            reflections: [b, a],
            spectrum: at_b.iter().zip(at_a).map(|(b, a)| b * a).collect(),
        };
        let before = |(k, b)| mirrors[..k].iter().map(move |a| pair(b, a));
        mirrors.iter().enumerate().flat_map(before).collect()
    }

    /// The reflections of all paths of four whose share may be as large as `least` in a colour.
    pub fn fours(&self, least: f64) -> Vec<[usize; 4]> {
        let pairs = self.pairs();
        let mut fours = Vec::new();
        for first in &pairs {
            let [b, a] = first.reflections;
            // Light goes straight as far as b, and so it has no more of the pupil than that lets through; it passes every
            // surface that reflects it as well, as the direct light does, and so it has no more besides than it is reflected.
            let area = PI * self.reach[b - 1].powi(2) / self.area;
            let most = |second: &MirrorPair| area * self.observer.most(&first.spectrum, &second.spectrum, &self.direct);
            let strong = pairs.iter().filter(|second| second.reflections[0] > a && most(second) >= least);
            fours.extend(strong.map(|second| [b, a, second.reflections[0], second.reflections[1]]));
        }
        fours
    }

    /// The ghost of these reflections.
    pub fn ghost(&self, reflections: &[usize]) -> Result<GhostPath> {
        let path = Path::new(self.system, reflections)?;
        let (matrix, clips) = clipped(self.system, &path, &self.indices);
        let clips = self.system.that_bite(clips, self.tangent);
        let (axial, centre) = clips.first().map_or((0.0, 0.0), |clip| (clip.radius, clip.center_per_tangent));
        let by_colour = self.colours.each_ref().map(|indices| self.system.matrix(&path, indices));
        let area = PI * axial * axial / self.area;
        let share = self.observer.relative(&self.spectrum(&path), &self.direct).map(|part| part * area);
        let focus = -self.indices.last().copied().unwrap_or(1.0) * matrix.a / matrix.c;
        let place = |matrix: RayMatrix| self.system.height_per_tangent(&matrix) + matrix.a * centre;
        Ok(GhostPath {
            reflections: path.reflections(),
            magnification: by_colour.map(|matrix| place(matrix) / self.image_per_tangent),
            scale: by_colour.map(|matrix| matrix.a),
            radius_mm: by_colour.map(|matrix| matrix.a.abs() * axial),
            share,
            focus_mm: Some(focus).filter(|focus| focus.is_finite()),
            clips,
        })
    }
}

/// Of each surface at each wavelength, along the axis.
fn reflectances(system: &System, wavelengths: &[f64]) -> Vec<Vec<f64>> {
    let media: Vec<_> = wavelengths.iter().map(|&wavelength| system.indices(wavelength)).collect();
    let surfaces = system.surfaces().iter().enumerate();
    let of_surface = |(k, surface): (usize, &crate::optics::OpticalSurface)| {
        let at = |(media, &wavelength): (&Vec<f64>, &f64)| surface.reflectance(media[k], media[k + 1], wavelength);
        media.iter().zip(wavelengths).map(at).collect()
    };
    surfaces.map(of_surface).collect()
}
