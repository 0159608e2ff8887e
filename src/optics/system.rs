//! A lens that is set up: where its surfaces and its sensor are, and how wide its stop is open.

use super::coating::Coating;
use super::error::Result;
use super::first_order::FirstOrder;
use super::glass::Glass;
use super::matrix::RayMatrix;
use super::path::{Path, Step};
use super::prescription::{Iris, Prescription, Surface};
use super::setup::Setup;
use super::thin_film::{Layer, response};

/// A lens, a setup, and what follows from them. Lengths in mm; z goes from the first vertex towards the sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    name: String,
    setup: Setup,
    surfaces: Vec<OpticalSurface>,
    /// The stop's index, from 0.
    stop: usize,
    iris: Iris,
    /// Where the sensor is.
    sensor_z: f64,
    first_order: FirstOrder,
}

/// A surface of a lens that is set up.
#[derive(Debug, Clone, PartialEq)]
pub struct OpticalSurface {
    /// Its vertex's place on the axis, in mm.
    pub z: f64,
    /// 1/radius, in 1/mm; positive where the centre lies towards the sensor.
    pub curvature: f64,
    /// The conic constant.
    pub conic: f64,
    /// The radius of what is open, in mm; of the stop, that to which it is closed.
    pub semi_aperture: f64,
    /// What is behind it.
    pub glass: Glass,
    /// The films on it, from the scene's side.
    pub layers: Vec<Layer>,
}

impl System {
    /// A lens, set up.
    ///
    /// # Errors
    ///
    /// What [`Prescription::check`] refuses; a setup that means nothing or that the lens cannot have: wider than its glass,
    /// nearer than it focuses, closed to nothing; a lens that makes no image of distant light.
    pub fn new(lens: &Prescription, setup: &Setup) -> Result<Self> {
        lens.check()?;
        setup.check()?;
        let mut surfaces = surfaces(lens);
        let stop = lens.surfaces.iter().position(|surface| surface.stop).unwrap_or_default();
        let placed = |surface: &Surface| surface.thickness;
        let (first_order, semi_aperture) =
            FirstOrder::of(&lens.name, &surfaces, stop, lens.surfaces.last().and_then(placed), setup)?;
        surfaces[stop].semi_aperture = semi_aperture;
        let last = surfaces.last().map_or(0.0, |surface| surface.z);
        let sensor_z = last + first_order.sensor_distance;
        Ok(Self { name: lens.name.clone(), setup: *setup, surfaces, stop, iris: lens.iris, sensor_z, first_order })
    }

    /// The lens's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What it was set up by.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// Its surfaces, from the scene to the sensor.
    pub fn surfaces(&self) -> &[OpticalSurface] {
        &self.surfaces
    }

    /// The number of the stop, from 1.
    pub fn stop_number(&self) -> usize {
        self.stop + 1
    }

    /// The shape of the stop's opening. Its corners are on the circle of the stop's semi-aperture; rays take it for that circle.
    pub fn iris(&self) -> Iris {
        self.iris
    }

    /// The sensor's place on the axis, in mm.
    pub fn sensor_z(&self) -> f64 {
        self.sensor_z
    }

    /// Focal length, pupils and what else paraxial optics says of it, at the setup's wavelength.
    pub fn first_order(&self) -> &FirstOrder {
        &self.first_order
    }

    /// The index before the first surface, and that behind each, at a wavelength in nm.
    pub fn indices(&self, wavelength: f64) -> Vec<f64> {
        indices(&self.surfaces, wavelength)
    }

    /// The matrix from the first vertex to the sensor along a path of this lens, for indices of [`System::indices`].
    pub(super) fn matrix(&self, path: &Path, indices: &[f64]) -> RayMatrix {
        self.walk(&path.steps(), indices, |_, _| {})
    }

    /// [`System::matrix`], telling at each surface on the way the matrix from the first vertex to it.
    pub(super) fn walk(&self, steps: &[Step], indices: &[f64], tell: impl FnMut(&Step, &RayMatrix)) -> RayMatrix {
        let at_last = walk(&self.surfaces, steps, indices, tell);
        let (distance, index) = (self.first_order.sensor_distance, indices.last().copied().unwrap_or(1.0));
        RayMatrix::translation(distance, index) * at_last
    }
}

impl OpticalSurface {
    /// The part of unpolarised light that it reflects, between media of the indices `before` and `behind`, at a
    /// wavelength in nm, of light from the scene along the axis. Light from behind is reflected as much.
    pub fn reflectance(&self, before: f64, behind: f64, wavelength: f64) -> f64 {
        response(before, &self.layers, behind, wavelength, 1.0).reflectance.mean()
    }
}

pub(super) fn indices(surfaces: &[OpticalSurface], wavelength: f64) -> Vec<f64> {
    std::iter::once(1.0).chain(surfaces.iter().map(|surface| surface.glass.index(wavelength))).collect()
}

/// The matrix from the first vertex to behind the last surface, telling on the way that to each surface.
pub(super) fn walk(
    surfaces: &[OpticalSurface],
    steps: &[Step],
    indices: &[f64],
    mut tell: impl FnMut(&Step, &RayMatrix),
) -> RayMatrix {
    let mut matrix = RayMatrix::IDENTITY;
    let mut from: Option<usize> = None;
    for step in steps {
        let OpticalSurface { z, curvature, .. } = surfaces[step.surface];
        // Media before and behind it, as the light meets them.
        let [before, behind] = match step.forward {
            true => [indices[step.surface], indices[step.surface + 1]],
            false => [indices[step.surface + 1], indices[step.surface]],
        };
        if let Some(from) = from {
            matrix = RayMatrix::translation((z - surfaces[from].z).abs(), before) * matrix;
        }
        tell(step, &matrix);
        let curvature = if step.forward { curvature } else { -curvature };
        let surface = match step.reflects {
            true => RayMatrix::reflection(curvature, before),
            false => RayMatrix::refraction(curvature, before, behind),
        };
        matrix = surface * matrix;
        from = Some(step.surface);
    }
    matrix
}

fn surfaces(lens: &Prescription) -> Vec<OpticalSurface> {
    let (mut z, mut before_is_air) = (0.0, true);
    let place = |surface: &Surface| {
        let placed = OpticalSurface {
            z,
            curvature: surface.curvature(),
            conic: surface.conic,
            semi_aperture: surface.semi_aperture,
            glass: surface.glass.clone(),
            layers: layers(surface, before_is_air, &lens.coating),
        };
        z += surface.thickness.unwrap_or(0.0);
        before_is_air = surface.glass.is_air();
        placed
    };
    lens.surfaces.iter().map(place).collect()
}

/// The films of a surface from the scene's side: coatings are listed from the air.
fn layers(surface: &Surface, before_is_air: bool, usual: &Coating) -> Vec<Layer> {
    let air_behind = surface.glass.is_air();
    let usual = if before_is_air == air_behind { &Coating::None } else { usual };
    let mut layers = surface.coating.as_ref().unwrap_or(usual).layers();
    if air_behind && !before_is_air {
        layers.reverse();
    }
    layers
}
