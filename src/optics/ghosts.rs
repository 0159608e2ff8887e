//! Ghosts by matrices (Lee and Eisemann, "Practical real-time lens-flare rendering", 2013; Hullin et al., "Physically-based
//! real-time lens flare rendering", 2011): every pair of surfaces reflects light twice towards the sensor, and paraxially
//! the place and the size of that image are linear in the light's direction and in the pupil.
//!
//! A ray of a distant light meets the plane of the entrance pupil at p, in mm, and has the tangent t of the light's angle.
//! Along a path, it is at the height A (p − z t) + B t on the sensor, where the pupil is at z and (A B; C D) is the path's
//! matrix from the first vertex to the sensor; at a rim on the way, in the same form by the matrix to that rim.
//!
//! What that leaves out is aberration: wide open, real rays of a ghost meet rims that paraxial ones clear. Beside optiland's
//! rays through seven lenses (`tests/golden-optics`), the light of all ghosts together on the axis is 0 to 24 % too much.
//! [`super::Tracer::spot`] has the truth of each.

mod survey;

use rayon::prelude::*;
use serde::Serialize;

use super::clip::{Clip, common_area, common_middle, that_bite};
use super::error::{OpticsError, Result};
use super::matrix::RayMatrix;
use super::path::Path;
use super::system::System;
use survey::Survey;

/// Which ghosts are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GhostOptions {
    /// The angle from the axis, in degrees, below 90, up to which lights shine: rims that bite beyond it only are left out.
    /// None for the corner of the sensor.
    pub half_field: Option<f64>,
    /// The least share of the direct light in any colour at which a path of four reflections counts; none for none of them.
    pub four_bounces: Option<f64>,
}

/// What a lens makes of a distant light besides its image.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LensGhosts {
    /// Where the light's image is on the sensor, in mm for a tangent of 1 of its angle from the axis.
    pub image_per_tangent: f64,
    /// The rims that bound the light of that image, the smallest first.
    pub clips: Vec<Clip>,
    /// The wavelengths, in nm, at which red, green and blue rays are taken.
    pub wavelengths: [f64; 3],
    /// The ghosts, by their irradiance on the sensor, the brightest first.
    pub ghosts: Vec<GhostPath>,
}

/// A ghost: the image of a distant light by one path of reflections. Colours are red, green and blue of linear Rec. 709.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GhostPath {
    /// The surfaces at which it is reflected, in the light's order, numbered from 1: `[b, a]` of a pair a < b.
    pub reflections: Vec<usize>,
    /// Where its centre is, as a multiple of where the light's own image is; negative on the other side of the axis. The
    /// centre is that of the circle by which the narrowest rim bounds it, which for light that passes the stop only after
    /// its reflections is not about the middle of the entrance pupil.
    pub magnification: [f64; 3],
    /// Millimetres on the sensor of a millimetre of the entrance pupil; negative where it is upside down.
    pub scale: [f64; 3],
    /// The radius in mm on the sensor, of a light on the axis.
    pub radius_mm: [f64; 3],
    /// The part of the light of the image on the axis that the ghost has.
    pub share: [f64; 3],
    /// Where it is in focus, in mm from the sensor, positive behind it; none where its rays are parallel.
    pub focus_mm: Option<f64>,
    /// The rims that bound its light in the entrance pupil's plane, the smallest first. Its image is what they have in
    /// common, by [`GhostPath::on_sensor`].
    pub clips: Vec<Clip>,
}

impl GhostPath {
    /// The share in each colour, the largest being 1; black where there is none.
    pub fn tint(&self) -> [f64; 3] {
        let largest = self.share.into_iter().fold(0.0, f64::max);
        if largest > 0.0 { self.share.map(|share| share / largest) } else { [0.0; 3] }
    }

    /// What rims leave of the ghost of a light at the tangent `tangent`, of that of a light on the axis: from 0, usually to 1.
    pub fn vignetting(&self, tangent: f64) -> f64 {
        common_area(&self.clips, tangent) / common_area(&self.clips, 0.0)
    }

    /// The circle on the sensor by which one of its rims cuts the ghost's green, of a light at the tangent `tangent` whose
    /// own image is at `image` mm from the axis: its centre, from the axis towards that image, and its radius, in mm.
    pub fn on_sensor(&self, clip: &Clip, tangent: f64, image: f64) -> (f64, f64) {
        let ([_, magnification, _], [_, scale, _]) = (self.magnification, self.scale);
        let narrowest = self.clips.first().map_or(0.0, |clip| clip.center_per_tangent);
        let apart = (clip.center_per_tangent - narrowest) * tangent;
        (magnification * image + scale * apart, scale.abs() * clip.radius)
    }

    /// How far the middle of what rims leave is from the centre of the ghost, on the sensor, towards the light's own image, in mm; of green.
    pub fn shift(&self, tangent: f64) -> f64 {
        let narrowest = self.clips.first().map_or(0.0, |clip| clip.center_per_tangent);
        self.scale[1] * (common_middle(&self.clips, tangent) - narrowest * tangent)
    }

    fn mean_share(&self) -> f64 {
        self.share.iter().sum::<f64>() / 3.0
    }
}

impl System {
    /// All ghosts of two reflections, and those of four that are strong enough.
    ///
    /// # Errors
    ///
    /// A field in [`GhostOptions`] that is not from 0 to below 90°, or a share that is not above 0.
    pub fn ghosts(&self, options: &GhostOptions) -> Result<LensGhosts> {
        let half_field = options.half_field.unwrap_or(self.first_order().half_field);
        options.check(half_field)?;
        let survey = Survey::of(self, half_field.to_radians().tan());
        let mut ghosts: Vec<GhostPath> =
            survey.pairs().iter().map(|pair| survey.ghost(&pair.reflections)).collect::<Result<_>>()?;
        if let Some(least) = options.four_bounces {
            let strong = |ghost: &GhostPath| ghost.share.into_iter().any(|share| share >= least);
            let fours: Vec<GhostPath> =
                survey.fours(least).par_iter().map(|four| survey.ghost(four)).collect::<Result<_>>()?;
            ghosts.extend(fours.into_iter().filter(strong));
        }
        // A focused ghost is no smaller than its diffraction.
        let airy = 1.22 * self.setup().wavelength * 1e-6 * self.first_order().f_number;
        let irradiance = |ghost: &GhostPath| ghost.mean_share() / (ghost.radius_mm[1].powi(2) + airy * airy);
        ghosts.sort_by(|a, b| irradiance(b).total_cmp(&irradiance(a)));
        let Survey { image_per_tangent, clips, observer, .. } = survey;
        Ok(LensGhosts { image_per_tangent, clips, wavelengths: observer.centres, ghosts })
    }

    fn that_bite(&self, clips: Vec<Clip>, tangent: f64) -> Vec<Clip> {
        that_bite(clips, tangent, self.stop_number(), self.iris().inner())
    }

    /// The height behind a matrix from the first vertex, in mm for a tangent of 1, of a ray through the pupil's centre.
    fn height_per_tangent(&self, matrix: &RayMatrix) -> f64 {
        matrix.b - matrix.a * self.first_order().entrance_pupil.z
    }
}

impl GhostOptions {
    fn check(&self, half_field: f64) -> Result<()> {
        let fault = |reason: String| Err(OpticsError::Setup(reason));
        if !(0.0..90.0).contains(&half_field) {
            return fault(format!("a half field of {half_field}° is not from 0 to below 90°"));
        }
        match self.four_bounces {
            Some(least) if !(least.is_finite() && least > 0.0) => fault(format!("a share of {least} is not above 0")),
            _ => Ok(()),
        }
    }
}

/// The matrix of a path to the sensor, and the rims on it as circles in the pupil's plane.
pub(super) fn clipped(system: &System, path: &Path, indices: &[f64]) -> (RayMatrix, Vec<Clip>) {
    let mut clips = Vec::new();
    let matrix = system.walk(&path.steps(), indices, |step, matrix| {
        // Where a rim is conjugate to the light itself, a circle without end passes or stops all of it.
        let a = if matrix.a.abs() < 1e-12 { 1e-12 } else { matrix.a };
        let radius = system.surfaces()[step.surface].semi_aperture / a.abs();
        let center_per_tangent = -system.height_per_tangent(matrix) / a;
        clips.push(Clip { surface: step.surface + 1, inverted: a < 0.0, center_per_tangent, radius });
    });
    (matrix, clips)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{double_gauss, singlet};
    use super::super::{Coating, Glass, Prescription, Setup, Surface};
    use super::*;

    const INDEX: f64 = 1.5;
    /// Of one surface.
    const BARE: f64 = 0.04;

    fn ghosts(lens: &Prescription, options: GhostOptions) -> LensGhosts {
        System::new(lens, &Setup::default()).unwrap().ghosts(&options).unwrap()
    }

    fn plate(thickness: f64, gap: Option<f64>) -> [Surface; 2] {
        let glass = Glass::model(INDEX, None);
        [Surface { glass, ..Surface::plane(Some(thickness), 10.0) }, Surface::plane(gap, 10.0)]
    }

    /// A thin lens of 50 mm with the stop in it, whose surfaces do not reflect to each other's like.
    fn thin(gap: Option<f64>) -> [Surface; 2] {
        let front = Surface { radius: Some(50.0), stop: true, ..Surface::plane(Some(0.0), 5.0) };
        let back = Surface { radius: Some(-50.0), ..Surface::plane(gap, 9.0) };
        [Surface { glass: Glass::model(INDEX, None), ..front }, back]
    }

    fn lens(parts: [[Surface; 2]; 2]) -> Prescription {
        Prescription { surfaces: parts.into_iter().flatten().collect(), ..singlet() }
    }

    fn of_pair(ghosts: &LensGhosts, pair: [usize; 2]) -> &GhostPath {
        ghosts.ghosts.iter().find(|ghost| ghost.reflections == pair).unwrap()
    }

    #[test]
    fn a_plate_before_the_lens_makes_a_second_image_over_the_first() {
        let found = ghosts(&lens([plate(3.0, Some(20.0)), thin(None)]), GhostOptions::default());
        let ghost = of_pair(&found, [2, 1]);
        for c in 0..3 {
            assert!((ghost.magnification[c] - 1.0).abs() < 1e-12);
            assert!(ghost.radius_mm[c] < 1e-12);
            assert!((ghost.share[c] - BARE * BARE).abs() < 1e-15, "{:?}", ghost.share);
        }
        assert!(ghost.focus_mm.unwrap().abs() < 1e-10);
        assert!(ghost.tint().iter().all(|part| (part - 1.0).abs() < 1e-12), "{:?}", ghost.tint());
    }

    #[test]
    fn a_plate_behind_the_lens_focuses_its_ghost_before_the_sensor() {
        let (thickness, gap) = (2.0, 10.0);
        let found = ghosts(&lens([thin(Some(gap)), plate(thickness, None)]), GhostOptions::default());
        let ghost = of_pair(&found, [4, 3]);
        // Light goes through the plate's thickness twice more, which is so much in air.
        let further = 2.0 * thickness / INDEX;
        assert!((ghost.focus_mm.unwrap() + further).abs() < 1e-10, "{ghost:?}");
        assert!((ghost.radius_mm[1] - further * 5.0 / 50.0).abs() < 1e-12, "{ghost:?}");
        assert!((ghost.magnification[1] - (1.0 + further / 50.0)).abs() < 1e-12);
        assert!((ghost.share[1] - BARE * BARE).abs() < 1e-15);
        assert!((found.image_per_tangent - 50.0).abs() < 1e-12);
    }

    #[test]
    fn every_pair_of_surfaces_makes_a_ghost_and_the_stop_none() {
        let found = ghosts(&double_gauss(), GhostOptions::default());
        assert_eq!(found.ghosts.len(), 45);
        assert!(found.ghosts.iter().all(|ghost| !ghost.reflections.contains(&6)));
        let irradiance = |ghost: &GhostPath| ghost.mean_share() / (ghost.radius_mm[1].powi(2) + 1e-5);
        assert!(irradiance(&found.ghosts[0]) > irradiance(&found.ghosts[44]));
        let sum: f64 = found.ghosts.iter().map(|ghost| ghost.share[1]).sum();
        assert!((0.005..0.06).contains(&sum), "ten bare surfaces: {sum}");
    }

    #[test]
    fn coatings_take_light_from_ghosts_and_tint_them() {
        let of = |coating: Coating| {
            let lens = Prescription { coating, ..double_gauss() };
            let found = ghosts(&lens, GhostOptions::default());
            let sum = |c: usize| found.ghosts.iter().map(|ghost| ghost.share[c]).sum::<f64>();
            [sum(0), sum(1), sum(2)]
        };
        let (none, mgf2, multi) = (of(Coating::None), of(Coating::MgF2), of(Coating::Multi));
        assert!(none[1] > 8.0 * mgf2[1] && mgf2[1] > 5.0 * multi[1], "{none:?} {mgf2:?} {multi:?}");
        // Bare glass without dispersion reflects all colours alike; a quarter wave at 550 nm least of green.
        assert!((none[0] - none[2]).abs() < 1e-12);
        assert!(mgf2[1] < 0.95 * mgf2[0] && mgf2[1] < 0.8 * mgf2[2], "{mgf2:?}");
    }

    #[test]
    fn a_rim_cuts_a_ghost_as_its_light_leaves_the_axis() {
        let wide = GhostOptions { half_field: Some(20.0), ..GhostOptions::default() };
        let found = ghosts(&double_gauss(), wide);
        let tangent = 20.0_f64.to_radians().tan();
        let cut = found.ghosts.iter().filter(|ghost| ghost.vignetting(tangent) < 0.5).count();
        assert!(cut > 10, "{cut}");
        for ghost in &found.ghosts {
            assert!((ghost.vignetting(0.0) - 1.0).abs() < 1e-12);
            let mirrored = ghost.vignetting(-tangent);
            assert!((mirrored - ghost.vignetting(tangent)).abs() < 1e-12, "the lens is round");
        }
        let narrow = ghosts(&double_gauss(), GhostOptions { half_field: Some(0.0), ..wide });
        assert!(narrow.ghosts.iter().all(|ghost| ghost.clips.len() == 1));
    }

    #[test]
    fn rims_are_on_the_sensor_where_the_paths_matrix_has_them() {
        let system = System::new(&double_gauss(), &Setup::default()).unwrap();
        let found = system.ghosts(&GhostOptions::default()).unwrap();
        let tangent = 0.2;
        for ghost in &found.ghosts {
            let path = Path::new(&system, &ghost.reflections).unwrap();
            let matrix = system.matrix(&path, &system.indices(found.wavelengths[1]));
            for clip in &ghost.clips {
                let (centre, radius) = ghost.on_sensor(clip, tangent, found.image_per_tangent * tangent);
                // The ray through the middle of the rim.
                let z = system.first_order().entrance_pupil.z;
                let expected = (matrix.a * (clip.center_per_tangent - z) + matrix.b) * tangent;
                assert!((centre - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{clip:?}: {centre} {expected}");
                assert!((radius - matrix.a.abs() * clip.radius).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn paths_of_four_reflections_are_those_that_are_strong_enough() {
        let lens = lens([plate(3.0, Some(20.0)), thin(None)]);
        let four = |least| ghosts(&lens, GhostOptions { four_bounces: Some(least), ..GhostOptions::default() });
        let count = |found: &LensGhosts| found.ghosts.iter().filter(|ghost| ghost.reflections.len() == 4).count();
        // Every [b, a, d, c] with a < b, a < d, c < d of four surfaces.
        let possible = (1..=4_i32).flat_map(|a| (a + 1..=4).flat_map(move |_| (a + 1..=4).map(|d| d - 1))).sum::<i32>();
        let all = four(1e-30);
        assert_eq!(count(&all), possible as usize);
        let least = 0.9 * BARE.powi(4);
        let strong = all.ghosts.iter().filter(|ghost| ghost.reflections.len() == 4 && ghost.share[1] >= least).count();
        assert_eq!(count(&four(least)), strong);
        assert!(strong > 0 && count(&four(1.0)) == 0);
        // Twice back and forth in the plate.
        let twice = all.ghosts.iter().find(|ghost| ghost.reflections == [2, 1, 2, 1]).unwrap();
        assert!((twice.share[1] - BARE.powi(4)).abs() < 1e-15);
    }

    #[test]
    fn options_that_mean_nothing_are_refused() {
        let system = System::new(&singlet(), &Setup::default()).unwrap();
        for half_field in [90.0, 179.0, -1.0, f64::NAN] {
            assert!(system.ghosts(&GhostOptions { half_field: Some(half_field), four_bounces: None }).is_err());
        }
        assert!(system.ghosts(&GhostOptions { half_field: None, four_bounces: Some(0.0) }).is_err());
    }
}
