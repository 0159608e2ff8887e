//! What exact rays make of ghosts, beside what the matrices say of them.

use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;

use crate::Result;
use crate::optics::{Clip, GhostPath, LensGhosts, OpticsError, Path, Spot, System, Tracer, common_area, direction};

/// Decides the shifts of the rays: the same in every run.
const SEED: u64 = 1;

/// A ghost by exact rays of one wavelength, the green one. Shares are of the light of the direct image on the axis, as
/// rays have it; intervals hold with 99 % confidence.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Exact {
    pub wavelength_nm: f64,
    /// Of a light on the axis.
    pub share: f64,
    pub share_interval: [f64; 2],
    /// By the matrices, at the same wavelength.
    pub paraxial_share: f64,
    /// The root mean square distance of the light on the sensor from its centroid.
    pub rms_mm: f64,
    pub paraxial_rms_mm: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub off_axis: Option<OffAxis>,
}

/// The same for a light at an angle. Places are from the axis, positive towards the light's own image.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct OffAxis {
    pub angle_degrees: f64,
    pub share: f64,
    pub share_interval: [f64; 2],
    pub paraxial_share: f64,
    /// None where no light arrives.
    pub centroid_mm: Option<f64>,
    pub paraxial_centroid_mm: Option<f64>,
    pub rms_mm: f64,
}

/// What is wanted of exact rays.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rays {
    /// For each image.
    pub count: usize,
    /// Of a light off the axis, in degrees.
    pub angle: Option<f64>,
}

/// Traces so many of a lens's ghosts, the brightest first.
///
/// # Errors
/// Fewer rays than the tracer takes, an angle that is not from 0 to below 90°, and a lens through which no ray comes straight.
pub(super) fn exact(system: &System, ghosts: &LensGhosts, most: usize, rays: Rays) -> Result<Vec<Exact>> {
    if let Some(angle) = rays.angle.filter(|angle| !(0.0..90.0).contains(angle)) {
        return Err(OpticsError::Setup(format!("a light at {angle}° from the axis is not from 0 to below 90°")).into());
    }
    let [_, wavelength, _] = ghosts.wavelengths;
    let tracer = Tracer::new(system, wavelength)?;
    let direct = tracer.spot(&Path::direct(system), DVec3::Z, rays.count, SEED)?;
    if direct.hits == 0 {
        return Err(OpticsError::Setup(format!("no ray along the axis comes through {}", system.name())).into());
    }
    let bench = Bench { system, ghosts, tracer, wavelength, direct, rays };
    let shown = &ghosts.ghosts[..most.min(ghosts.ghosts.len())];
    shown.par_iter().map(|ghost| bench.exact(ghost)).collect()
}

/// A lens before which lights are put.
struct Bench<'a> {
    system: &'a System,
    ghosts: &'a LensGhosts,
    tracer: Tracer<'a>,
    wavelength: f64,
    /// The light's own image on the axis.
    direct: Spot,
    rays: Rays,
}

impl Bench<'_> {
    fn exact(&self, ghost: &GhostPath) -> Result<Exact> {
        let path = Path::new(self.system, &ghost.reflections)?;
        let spot = self.tracer.spot(&path, DVec3::Z, self.rays.count, SEED)?;
        let (share, share_interval) = self.share(&spot);
        let paraxial_share = self.paraxial_share(ghost);
        let off_axis = self.rays.angle.map(|angle| self.off_axis(ghost, &path, paraxial_share, angle)).transpose()?;
        Ok(Exact {
            wavelength_nm: self.wavelength,
            share,
            share_interval,
            paraxial_share,
            rms_mm: spot.rms,
            // Of an even disc.
            paraxial_rms_mm: ghost.radius_mm[1] / 2.0_f64.sqrt(),
            off_axis,
        })
    }

    fn off_axis(&self, ghost: &GhostPath, path: &Path, axial: f64, angle: f64) -> Result<OffAxis> {
        let spot = self.tracer.spot(path, direction(angle), self.rays.count, SEED)?;
        let tangent = angle.to_radians().tan();
        let image = self.ghosts.image_per_tangent * tangent;
        let (share, share_interval) = self.share(&spot);
        let ahead = image.signum();
        Ok(OffAxis {
            angle_degrees: angle,
            share,
            share_interval,
            paraxial_share: axial * ghost.vignetting(tangent),
            centroid_mm: (spot.hits > 0).then_some(ahead * spot.centroid.x),
            paraxial_centroid_mm: centroid(ghost, tangent, image).map(|place| ahead * place),
            rms_mm: spot.rms,
        })
    }

    /// Of a flux that of the direct image, and its interval: relative errors of independent estimates add in squares.
    fn share(&self, spot: &Spot) -> (f64, [f64; 2]) {
        let share = spot.flux / self.direct.flux;
        let error = (spot.flux_error / self.direct.flux).hypot(share * self.direct.flux_error / self.direct.flux);
        (share, [(share - error).max(0.0), share + error])
    }

    /// The share that the matrices give on the axis at one wavelength: what the two surfaces reflect and those between them
    /// pass twice more, by the area in the pupil.
    fn paraxial_share(&self, ghost: &GhostPath) -> f64 {
        let &[b, a] = &ghost.reflections[..] else { return f64::NAN };
        let indices = self.system.indices(self.wavelength);
        let surfaces = self.system.surfaces();
        let reflectance = |k: usize| surfaces[k - 1].reflectance(indices[k - 1], indices[k], self.wavelength);
        let between: f64 = (a + 1..b).map(|k| (1.0 - reflectance(k)).powi(2)).product();
        let area = common_area(&ghost.clips, 0.0) / common_area(&self.ghosts.clips, 0.0);
        reflectance(a) * reflectance(b) * between * area
    }
}

/// The middle of the light of a ghost on the sensor by its rims, of a light at a tangent whose own image is at `image` mm; none
/// where they let none pass.
fn centroid(ghost: &GhostPath, tangent: f64, image: f64) -> Option<f64> {
    /// Strips of the opening; the error falls with the power 3/2 of their number.
    const STRIPS: u32 = 2000;
    let circles: Vec<_> = ghost.clips.iter().map(|clip: &Clip| ghost.on_sensor(clip, tangent, image)).collect();
    let low = circles.iter().map(|(centre, radius)| centre - radius).fold(f64::NEG_INFINITY, f64::max);
    let high = circles.iter().map(|(centre, radius)| centre + radius).fold(f64::INFINITY, f64::min);
    if !(low <= high && low.is_finite() && high.is_finite()) {
        return None;
    }
    let strip = |k: u32| low + (high - low) * (f64::from(k) + 0.5) / f64::from(STRIPS);
    let height = |x: f64| {
        let squares = circles.iter().map(|(centre, radius)| (radius - (x - centre)) * (radius + (x - centre)));
        squares.fold(f64::INFINITY, f64::min).max(0.0).sqrt()
    };
    let sums = (0..STRIPS).map(strip).map(|x| (x * height(x), height(x)));
    let (moment, area) = sums.fold((0.0, 0.0), |sum, next| (sum.0 + next.0, sum.1 + next.1));
    Some(if area > 0.0 { moment / area } else { 0.5 * (low + high) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::{GhostOptions, Setup};
    use crate::scene::lenses;

    fn stopped(name: &str, fstop: f64) -> (System, LensGhosts) {
        let lens = lenses::find(name).unwrap().prescription().unwrap();
        let system = System::new(&lens, &Setup { fstop: Some(fstop), ..Setup::default() }).unwrap();
        let ghosts = system.ghosts(&GhostOptions::default()).unwrap();
        (system, ghosts)
    }

    #[test]
    fn stopped_down_rays_are_where_the_matrices_say() {
        let (system, ghosts) = stopped("tessar", 22.0);
        let found = exact(&system, &ghosts, usize::MAX, Rays { count: 4096, angle: Some(0.5) }).unwrap();
        assert_eq!(found.len(), ghosts.ghosts.len());
        let (mut compared, mut alike) = (0, 0);
        for (ghost, exact) in ghosts.ghosts.iter().zip(&found) {
            let [low, high] = exact.share_interval;
            assert!(low <= exact.share && exact.share < high && high < 1.3 * exact.share, "{exact:?}");
            // Others are of light that meets the stop only after its reflections, and is as wide as the front element.
            if ghost.clips[0].surface != system.stop_number() {
                continue;
            }
            let off = exact.off_axis.as_ref().unwrap();
            let [rays, matrices] = [off.centroid_mm, off.paraxial_centroid_mm].map(Option::unwrap);
            let radius = ghost.radius_mm[1];
            compared += 1;
            alike += usize::from(
                (exact.paraxial_share / exact.share - 1.0).abs() < 0.05
                    && (exact.rms_mm - exact.paraxial_rms_mm).abs() < 0.05 * radius + 0.01
                    && (rays - matrices).abs() < 0.1 * radius + 0.02,
            );
        }
        println!("{alike} of {compared} alike");
        assert!(compared >= 8 && 10 * alike >= 9 * compared, "{alike} of {compared}");
    }

    #[test]
    fn the_middle_of_a_cut_disc_is_that_of_what_is_left() {
        let (_, ghosts) = stopped("tessar", 5.6);
        let ghost = GhostPath {
            scale: [1.0; 3],
            magnification: [0.0; 3],
            clips: [(0.0, 1.0), (1.0, 1.0)]
                .map(|(center_per_tangent, radius)| Clip { surface: 1, inverted: false, center_per_tangent, radius })
                .to_vec(),
            ..ghosts.ghosts[0].clone()
        };
        assert!(centroid(&ghost, 0.0, 0.0).unwrap().abs() < 1e-12);
        // The common part of two equal circles is symmetric about the middle between them.
        assert!((centroid(&ghost, 1.0, 0.0).unwrap() - 0.5).abs() < 1e-9);
        assert_eq!(centroid(&ghost, 2.5, 0.0), None);
    }

    #[test]
    fn rays_that_cannot_be_are_refused() {
        let (system, ghosts) = stopped("singlet", 8.0);
        for (count, angle, said) in [
            (63, None, "63 rays"),
            (4096, Some(90.0), "90° from the axis"),
            (4096, Some(-1.0), "-1° from the axis"),
            (4096, Some(f64::NAN), "NaN° from the axis"),
        ] {
            let error = exact(&system, &ghosts, 1, Rays { count, angle }).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }
}
