//! The table of a lens's surfaces, as patents and design programs print it.

use std::collections::BTreeMap;

use super::coating::Coating;
use super::error::{OpticsError, Result};
use super::first_order::FirstOrder;
use super::glass::Glass;

/// The most surfaces that a lens may have. Zoom lenses have some fifty.
pub const MOST_SURFACES: usize = 300;

/// Lengths and radii, in mm, that are no mistake.
const LONGEST: f64 = 1e9;

/// A lens: its surfaces from the scene to the sensor, focused at infinity, and what its maker states of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Prescription {
    /// What it is called.
    pub name: String,
    /// One line for people; may be empty.
    pub description: String,
    /// Where the numbers are from; a patent's number and example.
    pub patent: Option<String>,
    /// The focal length that the source states, in mm.
    pub focal_length: Option<f64>,
    /// The f-number that the source states, wide open.
    pub f_number: Option<f64>,
    /// The half angle of the field that the source states, in degrees.
    pub field: Option<f64>,
    /// What lies on surfaces between glass and air that name no coating.
    pub coating: Coating,
    /// The iris.
    pub iris: Iris,
    /// At least one, one of which is the stop.
    pub surfaces: Vec<Surface>,
    /// Other thicknesses, of a zoom lens.
    pub settings: Vec<Setting>,
    /// What a reader of the file has to be told of it, a sentence each.
    pub notes: Vec<String>,
}

/// The shape of the opening of a stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Iris {
    /// Straight blades; none for a round opening. At least 3.
    pub blades: Option<u32>,
    /// The angle of a corner from the x axis, in degrees.
    pub rotation: f64,
    /// From 0, straight edges, to 1, a circle.
    pub roundness: f64,
}

/// A surface, and what is behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// The radius at the vertex, in mm, positive where the centre lies towards the sensor; none of a plane.
    pub radius: Option<f64>,
    /// From its vertex to the next one's, in mm; of the last to the sensor, or none for the paraxial focus.
    pub thickness: Option<f64>,
    /// What is behind it.
    pub glass: Glass,
    /// Half the clear diameter, in mm.
    pub semi_aperture: f64,
    /// The conic constant: 0 of a sphere, −1 of a paraboloid.
    pub conic: f64,
    /// What lies on it; none for the lens's own coating where glass meets air.
    pub coating: Option<Coating>,
    /// Whether it is the aperture stop.
    pub stop: bool,
    /// A name for people.
    pub label: Option<String>,
}

/// A zoom setting.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// What it is called.
    pub name: String,
    /// The focal length that the source states for it, in mm.
    pub focal_length: Option<f64>,
    /// The f-number that the source states for it.
    pub f_number: Option<f64>,
    /// Thicknesses in mm that differ from the table's, by the surface's number, from 1.
    pub thickness: BTreeMap<usize, f64>,
}

/// Where a prescription was read, for its errors.
#[derive(Debug, Clone, Default)]
pub(super) struct Origin {
    /// The file's name.
    pub file: String,
    /// The line at which each surface begins, from 1.
    pub lines: Vec<usize>,
}

impl Origin {
    /// An error of the surface with this index, which counts from 0.
    pub fn surface(&self, index: usize, reason: impl Into<String>) -> OpticsError {
        OpticsError::Surface {
            lens: self.file.clone(),
            surface: index + 1,
            line: self.lines.get(index).copied(),
            reason: reason.into(),
        }
    }

    /// An error of the whole file.
    pub fn lens(&self, reason: impl Into<String>) -> OpticsError {
        OpticsError::Lens { lens: self.file.clone(), reason: reason.into() }
    }

    /// The glass of a name, for the surface with this index.
    pub fn glass(&self, index: usize, name: &str) -> Result<Glass> {
        Glass::named(name).map_err(|nearest| OpticsError::UnknownGlass {
            lens: self.file.clone(),
            surface: index + 1,
            line: self.lines.get(index).copied(),
            name: name.to_owned(),
            nearest,
        })
    }
}

impl Default for Iris {
    fn default() -> Self {
        Self { blades: None, rotation: 0.0, roundness: 0.0 }
    }
}

impl Iris {
    /// The radius of the largest circle within the opening, of the one through its corners.
    pub fn inner(&self) -> f64 {
        let straight = self.blades.map_or(1.0, |blades| (std::f64::consts::PI / f64::from(blades.max(3))).cos());
        straight + (1.0 - straight) * self.roundness.clamp(0.0, 1.0)
    }

    /// The straight sides that the opening shows in a lens as it is set: none where the blades are round, or where the lens
    /// is within a third of a stop of wide open, for then they are all but out of the way.
    pub fn sides(&self, lens: &FirstOrder) -> Option<u32> {
        let engaged = lens.f_number > 1.12 * lens.widest_f_number;
        // Rounded blades make an opening that is all but a circle.
        self.blades.filter(|_| engaged && self.roundness < 0.5)
    }
}

impl Surface {
    /// A plane in air: where a stop stands.
    pub fn plane(thickness: Option<f64>, semi_aperture: f64) -> Self {
        Self {
            radius: None,
            thickness,
            glass: Glass::air(),
            semi_aperture,
            conic: 0.0,
            coating: None,
            stop: false,
            label: None,
        }
    }

    /// 1/radius, in 1/mm; 0 of a plane.
    pub fn curvature(&self) -> f64 {
        self.radius.filter(|radius| radius.is_finite()).map_or(0.0, |radius| 1.0 / radius)
    }

    /// How far behind its vertex a point of the surface is at the height `height` off the axis, in mm; NaN beyond its rim.
    pub fn sag(&self, height: f64) -> f64 {
        let (curvature, square) = (self.curvature(), height * height);
        curvature * square / (1.0 + (1.0 - (1.0 + self.conic) * curvature * curvature * square).sqrt())
    }

    fn fault(&self, is_last: bool) -> Option<String> {
        let short = |value: f64| value.is_finite() && value.abs() <= LONGEST;
        if let Some(radius) = self.radius
            && (radius == 0.0 || radius.is_nan() || radius.is_finite() && !short(radius))
        {
            return Some(format!("a radius of {radius} mm; a plane has none"));
        }
        match self.thickness {
            None if !is_last => return Some("it has no thickness; only the last surface may leave it out".to_owned()),
            Some(thickness) if !(short(thickness) && thickness >= 0.0) => {
                return Some(format!("a thickness of {thickness} mm is not 0 or more"));
            }
            _ => {}
        }
        let semi_aperture = self.semi_aperture;
        if !(short(semi_aperture) && semi_aperture > 0.0) {
            return Some(format!("a semi-aperture of {semi_aperture} mm is not above 0"));
        }
        if !(self.conic.is_finite() && self.conic.abs() <= 1e6) {
            return Some(format!("a conic constant of {}", self.conic));
        }
        if self.sag(semi_aperture).is_nan() {
            return Some(format!("a semi-aperture of {semi_aperture} mm is wider than the surface itself"));
        }
        self.glass.fault().or_else(|| self.coating.as_ref().and_then(Coating::fault))
    }
}

impl Prescription {
    /// The number of the surface that is the stop, from 1; 0 where there is none.
    pub fn stop_number(&self) -> usize {
        self.surfaces.iter().position(|surface| surface.stop).map_or(0, |index| index + 1)
    }

    /// The lens at a zoom setting: its thicknesses, and what is stated of it there.
    ///
    /// # Errors
    ///
    /// [`OpticsError::UnknownSetting`], in which the names are that there are.
    pub fn setting(&self, name: &str) -> Result<Self> {
        let setting = self.settings.iter().find(|setting| setting.name == name).ok_or_else(|| {
            let known = self.settings.iter().map(|setting| setting.name.clone()).collect();
            OpticsError::UnknownSetting { lens: self.name.clone(), name: name.to_owned(), known }
        })?;
        let mut lens = self.clone();
        lens.focal_length = setting.focal_length.or(self.focal_length);
        lens.f_number = setting.f_number.or(self.f_number);
        for (&number, &thickness) in &setting.thickness {
            let surface = number.checked_sub(1).and_then(|index| lens.surfaces.get_mut(index));
            let fault = || self.origin().lens(format!("the setting {name:?} names surface {number}"));
            surface.ok_or_else(fault)?.thickness = Some(thickness);
        }
        lens.check()?;
        Ok(lens)
    }

    /// Whether all of its numbers mean something. Files are checked when they are read; this is for a lens made by hand.
    ///
    /// # Errors
    ///
    /// The first thing that is wrong, with the surface.
    pub fn check(&self) -> Result<()> {
        self.check_at(&self.origin())
    }

    pub(super) fn check_at(&self, origin: &Origin) -> Result<()> {
        let count = self.surfaces.len();
        if !(1..=MOST_SURFACES).contains(&count) {
            return Err(origin.lens(format!("it has {count} surfaces; a lens has 1 to {MOST_SURFACES}")));
        }
        for (index, surface) in self.surfaces.iter().enumerate() {
            if let Some(reason) = surface.fault(index + 1 == count) {
                return Err(origin.surface(index, reason));
            }
        }
        let stops: Vec<_> = (1..).zip(&self.surfaces).filter(|(_, surface)| surface.stop).map(|(n, _)| n).collect();
        match stops[..] {
            [_] => {}
            [] => return Err(origin.lens("none of its surfaces is the stop")),
            _ => return Err(origin.lens(format!("surfaces {stops:?} are all the stop; a lens has one"))),
        }
        self.stated_fault().or_else(|| self.coating.fault()).map_or(Ok(()), |reason| Err(origin.lens(reason)))?;
        self.settings.iter().try_for_each(|setting| match setting.fault(count) {
            Some(reason) => Err(origin.lens(format!("the setting {:?}: {reason}", setting.name))),
            None => Ok(()),
        })
    }

    /// What is wrong with what is stated of the whole lens.
    fn stated_fault(&self) -> Option<String> {
        let Iris { blades, rotation, roundness } = self.iris;
        let limits =
            [("focal length", self.focal_length, 1e6), ("f-number", self.f_number, 1e4), ("field", self.field, 180.0)];
        if let Some(reason) = limits.iter().find_map(|&(what, value, most)| positive_fault(what, value, most)) {
            return Some(reason);
        }
        if blades.is_some_and(|blades| !(3..=100).contains(&blades)) {
            return Some("an iris has 3 to 100 blades".to_owned());
        }
        if !rotation.is_finite() || !(0.0..=1.0).contains(&roundness) {
            return Some("the iris's rotation has to be an angle, and its roundness from 0 to 1".to_owned());
        }
        None
    }

    fn origin(&self) -> Origin {
        Origin { file: self.name.clone(), lines: Vec::new() }
    }
}

impl Setting {
    /// What is wrong with it, for a lens of so many surfaces.
    fn fault(&self, surfaces: usize) -> Option<String> {
        let limits = [("focal length", self.focal_length, 1e6), ("f-number", self.f_number, 1e4)];
        limits.iter().find_map(|&(what, value, most)| positive_fault(what, value, most)).or_else(|| {
            self.thickness.iter().find_map(|(number, thickness)| {
                if !(1..=surfaces).contains(number) {
                    return Some(format!("there is no surface {number}; there are {surfaces}"));
                }
                let bad = !(0.0..=LONGEST).contains(thickness);
                bad.then(|| format!("a thickness of {thickness} mm behind surface {number} is not 0 or more"))
            })
        })
    }
}

/// What is wrong with a number that has to be above 0 if it is stated.
fn positive_fault(what: &str, value: Option<f64>, most: f64) -> Option<String> {
    let value = value?;
    (!(value > 0.0 && value <= most)).then(|| format!("a {what} of {value} is not above 0 and at most {most}"))
}

#[cfg(test)]
mod tests {
    use super::super::tests::singlet;
    use super::super::{Setup, System};
    use super::*;

    /// What `check` says of the singlet after a change.
    fn said(change: impl FnOnce(&mut Prescription)) -> String {
        let mut lens = singlet();
        change(&mut lens);
        lens.check().map_or_else(|error| error.to_string(), |()| String::new())
    }

    #[test]
    fn numbers_that_mean_nothing_are_told_with_their_surface() {
        assert_eq!(said(|_| {}), "");
        let surface = |change: fn(&mut Surface)| said(|lens| change(&mut lens.surfaces[1]));
        for (said, reason) in [
            (surface(|s| s.radius = Some(f64::NAN)), "surface 2: a radius of NaN"),
            (surface(|s| s.radius = Some(0.0)), "surface 2: a radius of 0"),
            (surface(|s| s.thickness = None), "surface 2: it has no thickness"),
            (surface(|s| s.thickness = Some(-1.0)), "surface 2: a thickness of -1"),
            (surface(|s| s.semi_aperture = 0.0), "surface 2: a semi-aperture of 0"),
            (surface(|s| s.semi_aperture = f64::INFINITY), "surface 2: a semi-aperture of inf"),
            (surface(|s| s.semi_aperture = 60.0), "wider than the surface"),
            (surface(|s| s.conic = f64::NAN), "surface 2: a conic constant of NaN"),
            (surface(|s| s.glass = Glass::model(0.5, None)), "surface 2: an index of 0.5"),
            (said(|lens| lens.surfaces.clear()), "it has 0 surfaces"),
            (said(|lens| lens.surfaces = vec![Surface::plane(Some(1.0), 1.0); 301]), "it has 301 surfaces"),
            (said(|lens| lens.surfaces[0].stop = false), "none of its surfaces is the stop"),
            (said(|lens| lens.surfaces[2].stop = true), "surfaces [1, 3] are all the stop"),
            (said(|lens| lens.f_number = Some(0.0)), "a f-number of 0"),
            (said(|lens| lens.iris.blades = Some(2)), "3 to 100 blades"),
            (said(|lens| lens.iris.roundness = 1.5), "from 0 to 1"),
        ] {
            assert!(said.contains(reason), "{reason:?} is not in {said:?}");
        }
        assert_eq!(surface(|s| s.radius = Some(f64::INFINITY)), "", "which is a plane");
    }

    #[test]
    fn a_setting_replaces_thicknesses() {
        let mut lens = singlet();
        let thickness = BTreeMap::from([(1, 9.0)]);
        lens.settings = vec![Setting { name: "long".into(), focal_length: Some(70.0), f_number: None, thickness }];
        let long = lens.setting("long").unwrap();
        assert_eq!((long.surfaces[0].thickness, long.focal_length), (Some(9.0), Some(70.0)));
        let error = lens.setting("short").unwrap_err().to_string();
        assert!(error.contains("\"short\"; it has long"), "{error}");
        lens.settings[0].thickness = BTreeMap::from([(4, 9.0)]);
        assert!(lens.check().unwrap_err().to_string().contains("no surface 4; there are 3"));
        assert!(lens.setting("long").is_err());
    }

    #[test]
    fn an_iris_is_open_to_the_middles_of_its_blades() {
        let iris = |blades, roundness| Iris { blades, rotation: 0.0, roundness };
        assert!((iris(Some(6), 0.0).inner() - 0.75_f64.sqrt()).abs() < 1e-15);
        assert_eq!((iris(None, 0.0).inner(), iris(Some(5), 1.0).inner()), (1.0, 1.0));
    }

    #[test]
    fn blades_have_sides_once_they_are_a_third_of_a_stop_in() {
        let lens = Prescription { iris: Iris { blades: Some(6), ..Iris::default() }, ..singlet() };
        let first = |scale: f64| {
            let widest = System::new(&lens, &Setup::default()).unwrap().first_order().f_number;
            *System::new(&lens, &Setup { fstop: Some(widest * scale), ..Setup::default() }).unwrap().first_order()
        };
        assert_eq!([1.0, 1.11, 1.13, 4.0].map(|scale| lens.iris.sides(&first(scale))), [None, None, Some(6), Some(6)]);
        assert_eq!(Iris { roundness: 0.8, ..lens.iris }.sides(&first(4.0)), None);
        assert_eq!(Iris::default().sides(&first(4.0)), None);
    }

    #[test]
    fn the_sag_is_that_of_the_conic() {
        let mut surface = Surface { radius: Some(-50.0), ..Surface::plane(None, 10.0) };
        assert!((surface.sag(10.0) + (50.0 - 2400.0_f64.sqrt())).abs() < 1e-12);
        surface.conic = -1.0;
        assert!((surface.sag(10.0) + 1.0).abs() < 1e-15);
    }
}
