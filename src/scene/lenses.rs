//! Real lenses that come with vglare, from `media/lenses`: their surfaces, as patents have them.

use crate::optics::Prescription;
use crate::{Error, Result};

/// A prescription that is compiled in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RealLens {
    /// Its name, in kebab case.
    pub name: &'static str,
    /// The file itself, to copy and change.
    pub toml: &'static str,
}

macro_rules! lens {
    ($name:literal) => {
        RealLens { name: $name, toml: include_str!(concat!("../../media/lenses/", $name, ".toml")) }
    };
}

/// From the oldest form to the newest; the last, a single lens, is for tests.
static LENSES: [RealLens; 18] = [
    lens!("petzval"),
    lens!("triplet"),
    lens!("tessar"),
    lens!("heliar"),
    lens!("biotar"),
    lens!("sonnar"),
    lens!("double-gauss"),
    lens!("biogon"),
    lens!("angenieux"),
    lens!("sonnar-180"),
    lens!("takumar"),
    lens!("retrofocus"),
    lens!("planar"),
    lens!("zoom"),
    lens!("telephoto"),
    lens!("macro"),
    lens!("fisheye"),
    lens!("singlet"),
];

/// Every real lens.
pub fn all() -> &'static [RealLens] {
    &LENSES
}

/// The lens that is called `name`.
///
/// # Errors
///
/// [`Error::UnknownLens`], which lists the names there are.
pub fn find(name: &str) -> Result<&'static RealLens> {
    let found = LENSES.iter().find(|lens| lens.name == name);
    found.ok_or_else(|| Error::UnknownLens {
        name: name.to_owned(),
        known: LENSES.iter().map(|lens| lens.name.to_owned()).collect(),
    })
}

impl RealLens {
    /// Its surfaces.
    ///
    /// # Errors
    ///
    /// None for the lenses that are compiled in; a test reads them all.
    pub fn prescription(&self) -> Result<Prescription> {
        Ok(Prescription::parse(self.toml.as_bytes(), self.name)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::{Setup, System};

    /// What a patent states of a lens follows from its surfaces.
    #[test]
    fn every_lens_has_the_focal_length_and_the_f_number_that_its_file_states() {
        assert!(LENSES.len() >= 13);
        for lens in all() {
            let read = lens.prescription().unwrap();
            let names: Vec<String> = read.settings.iter().map(|setting| setting.name.clone()).collect();
            let set: Vec<_> = match names.as_slice() {
                [] => vec![read],
                names => names.iter().map(|name| read.setting(name).unwrap()).collect(),
            };
            for lens in set {
                let system = System::new(&lens, &Setup::default()).unwrap();
                let first = system.first_order();
                for (found, stated) in [(first.focal_length, lens.focal_length), (first.f_number, lens.f_number)] {
                    let stated = stated.unwrap_or_else(|| panic!("{} states it", lens.name));
                    assert!((found / stated - 1.0).abs() < 0.01, "{}: {found} for {stated}", lens.name);
                }
                assert!(first.sensor_distance > 0.0, "{}", lens.name);
            }
        }
    }

    #[test]
    fn lenses_go_by_name() {
        assert_eq!(find("tessar").unwrap().name, "tessar");
        let said = find("tesar").unwrap_err().to_string();
        assert!(said.contains("did you mean tessar?") && said.contains("petzval"), "{said}");
    }
}
