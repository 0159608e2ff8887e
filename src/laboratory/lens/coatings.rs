//! What the coatings of a lens reflect, over wavelength.

use crate::chart::{COLOURS, Chart, Colour, Series, Stroke};
use crate::false_colour::Map;
use crate::optics::{Coating, Glass, LINE_D, Layer, Prescription, response};
use crate::printable::printable;

use super::report::{before, coating};

/// In nm.
const WAVELENGTHS: [f64; 2] = [380.0, 760.0];
/// Places along the axis: each 2 nm.
const PLACES: u32 = 191;
/// The angles of incidence in air, in degrees.
const ANGLES: [f64; 2] = [0.0, 30.0];

/// A coating on a glass, against air.
struct Coated {
    name: &'static str,
    /// From the air.
    layers: Vec<Layer>,
    glass: Glass,
    /// The surfaces that have it.
    surfaces: Vec<usize>,
}

/// The reflectance of each different coating on each glass that meets air.
pub(super) fn chart(lens: &Prescription) -> Chart {
    let all = coated(lens);
    let title = format!("{}: reflectance in air, at 0° and, dashed, at 30°", printable(&lens.name));
    let mut chart = Chart::new(title, "wavelength, nm", "reflectance of unpolarised light, %");
    let mut most = 0.0_f64;
    for (index, coated) in all.iter().enumerate() {
        let colour = colour(index, all.len());
        for (angle, stroke) in ANGLES.into_iter().zip([Stroke::Solid, Stroke::Dashed]) {
            let label = if angle == 0.0 { coated.label() } else { String::new() };
            let series = Series::function(label, WAVELENGTHS, PLACES, |nm| 100.0 * coated.reflectance(nm, angle));
            most = series.points.iter().map(|point| point[1]).fold(most, f64::max);
            chart = chart.with(series.stroke(stroke).colour(colour));
        }
    }
    // The legend takes a row for every few glasses.
    let rows = all.len().div_ceil(4) as u32;
    Chart {
        size: [1200, 640 + 27 * rows],
        ..chart.range_x(WAVELENGTHS[0], WAVELENGTHS[1]).range_y(0.0, 1.06 * most.max(0.01))
    }
}

/// All of them, by the index of the glass.
fn coated(lens: &Prescription) -> Vec<Coated> {
    let mut all: Vec<Coated> = Vec::new();
    for (k, surface) in lens.surfaces.iter().enumerate() {
        let air = Glass::air();
        let ahead = before(lens, k).map_or(&air, |before| &before.glass);
        let glass = match (ahead.is_air(), surface.glass.is_air()) {
            (true, false) => &surface.glass,
            (false, true) => ahead,
            _ => continue,
        };
        let coating = coating(lens, k).unwrap_or(&Coating::None);
        let layers = coating.layers();
        let same = |other: &&mut Coated| other.layers == layers && other.glass == *glass;
        match all.iter_mut().find(same) {
            Some(other) => other.surfaces.push(k + 1),
            None => all.push(Coated { name: coating.name(), layers, glass: glass.clone(), surfaces: vec![k + 1] }),
        }
    }
    all.sort_by(|a, b| a.glass.index(LINE_D).total_cmp(&b.glass.index(LINE_D)));
    all
}

impl Coated {
    fn label(&self) -> String {
        let surfaces = self.surfaces.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
        let glass = printable(&self.glass.name);
        match self.name {
            "none" => format!("bare {glass} ({surfaces})"),
            name => format!("{name} on {glass} ({surfaces})"),
        }
    }

    /// Of unpolarised light, at an angle in air in degrees.
    fn reflectance(&self, wavelength: f64, angle: f64) -> f64 {
        let cosine = angle.to_radians().cos();
        response(1.0, &self.layers, self.glass.index(wavelength), wavelength, cosine).reflectance.mean()
    }
}

/// Colours that are easily told apart, as long as there are as many; else the hues of an order.
fn colour(index: usize, count: usize) -> Colour {
    if count <= COLOURS.len() {
        return COLOURS[index];
    }
    // Without the palest, which white swallows.
    Map::Viridis.colour(0.9 * index as f64 / (count - 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::{OpticalSurface, Setup, System};
    use crate::scene::lenses;

    #[test]
    fn each_coating_on_each_glass_is_drawn_once_as_its_surfaces_reflect() {
        let lens = lenses::find("double-gauss").unwrap().prescription().unwrap();
        let all = coated(&lens);
        let surfaces: usize = all.iter().map(|coated| coated.surfaces.len()).sum();
        // Six elements, two of them cemented to others: eight surfaces in air.
        assert_eq!(surfaces, 8);
        assert!(all.iter().all(|coated| coated.name == "mgf2") && all.len() < 8);
        let system = System::new(&lens, &Setup::default()).unwrap();
        let indices = system.indices(450.0);
        for coated in &all {
            for &number in &coated.surfaces {
                let surface: &OpticalSurface = &system.surfaces()[number - 1];
                let found = surface.reflectance(indices[number - 1], indices[number], 450.0);
                assert!((coated.reflectance(450.0, 0.0) - found).abs() < 1e-14, "surface {number}");
            }
        }
        let drawn = chart(&lens);
        assert_eq!(drawn.series.len(), 2 * all.len());
        assert!(drawn.svg().unwrap().unwrap().contains("mgf2 on"));
    }
}
