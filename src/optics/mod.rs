//! A lens as its maker knows it: surfaces, glasses, coatings.
mod coating;
mod error;
mod glass;
mod prescription;
mod read;
mod thin_film;

pub use coating::{Coating, DESIGN_NM};
pub use error::{OpticsError, Result};
pub use glass::{Dispersion, Glass, LINE_C, LINE_D, LINE_F, catalogue};
pub use prescription::{Iris, MOST_SURFACES, Prescription, Setting, Surface};
pub use read::LensFormat;
pub use thin_film::{Layer, Polarised, Response, response};

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
}
