//! A lens as its maker knows it, and the ghosts that follow from its surfaces. All in f64; no GL.
//!
//! | module | from → to |
//! | --- | --- |
//! | `read`, `prescription` | a file → the table of a lens's surfaces |
//! | `glass`, `coating`, `thin_film` | a medium → its index; films → what they reflect |
//! | `setup`, `system`, `first_order` | a table, f-number, focus, sensor → where all is, and what paraxial optics says of it |
//! | `path`, `matrix` | the surfaces that reflect light on its way → what that way does to rays near the axis |
//! | `ghosts`, `clip`, `colour` | a system → its ghosts: place, size, share of the light, and the rims that cut them |
//! | `trace`, `spot` | a ray → where it goes, exactly; a distant light → its image, by many of them |
//! | `back`, `bright` | a point of the sensor → where its light is from, exactly; what a bright field sends there, by many rays |
//!
//! Lengths are in mm, wavelengths in nm, angles in degrees unless they are said to be tangents. Surfaces are numbered from 1,
//! as in files. The axis is z, from the scene to the sensor; a radius is positive where its centre lies towards the sensor,
//! and a light whose direction leans towards positive x has its image there.
//!
//! The model: surfaces of revolution about one axis, spheres and conics; media without absorption; rays, not waves, save
//! within the films of a coating; distant lights. The sensor reflects nothing, and neither do barrel and blades.

mod back;
mod bright;
mod clip;
mod coating;
mod colour;
mod error;
mod first_order;
mod ghosts;
mod glass;
#[cfg(test)]
mod golden;
mod matrix;
mod path;
mod prescription;
mod read;
mod setup;
mod spot;
mod system;
mod thin_film;
mod trace;

pub use back::Origin;
pub use bright::{BrightField, Irradiance};
pub use clip::{Clip, common_area, common_middle};
pub use coating::{Coating, DESIGN_NM};
pub use colour::Sensitivity;
pub use error::{OpticsError, Result};
pub use first_order::{FirstOrder, Pupil};
pub use ghosts::{GhostOptions, GhostPath, LensGhosts};
pub use glass::{Dispersion, Glass, LINE_C, LINE_D, LINE_F, catalogue};
pub use matrix::RayMatrix;
pub use path::Path;
pub use prescription::{Iris, MOST_SURFACES, Prescription, Setting, Surface};
pub use read::LensFormat;
pub use setup::Setup;
pub use spot::Spot;
pub use system::{OpticalSurface, System};
pub use thin_film::{Amplitudes, Layer, Polarised, Response, amplitudes, response};
pub use trace::{Hit, Tracer, direction};

#[cfg(test)]
mod tests {
    use super::*;

    /// A plano-convex lens of N-BK7 with a stop before it.
    pub(super) fn singlet() -> Prescription {
        let plane = Surface::plane;
        Prescription {
            name: "singlet".into(),
            description: String::new(),
            patent: None,
            focal_length: None,
            f_number: None,
            field: None,
            coating: Coating::None,
            iris: Iris::default(),
            surfaces: vec![
                Surface { stop: true, ..plane(Some(2.0), 5.0) },
                Surface { radius: Some(51.68), glass: Glass::model(1.5168, Some(64.17)), ..plane(Some(4.0), 12.0) },
                plane(None, 12.0),
            ],
            settings: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// The double Gauss of Tronnier, US 2,673,491, at its 100 mm, as it is in many a table of lenses.
    pub(super) fn double_gauss() -> Prescription {
        let table = "58.95 7.52 1.670 50.4\n169.66 0.24 1 50.4\n38.55 8.05 1.670 46\n81.54 6.55 1.699 46\n\
            25.50 11.41 1 36\n0 9 0 34.2\n-28.99 2.36 1.603 34\n81.54 12.13 1.658 40\n-40.77 0.38 1 40\n\
            874.13 6.44 1.717 40\n-79.46 72.228 1 40\n";
        Prescription::parse(table.as_bytes(), "double-gauss.dat").unwrap()
    }
}
