//! Refractive indices of optical glass over wavelength, and the catalogue of glasses by name.
//!
//! Indices are relative to air, as makers state them: air itself has 1.

use std::sync::OnceLock;

use serde::Deserialize;

/// Helium d, the line at which a glass's index is stated, in nm.
pub const LINE_D: f64 = 587.5618;
/// Hydrogen F, in nm.
pub const LINE_F: f64 = 486.1327;
/// Hydrogen C, in nm.
pub const LINE_C: f64 = 656.2725;

/// Wavelengths in nm at which every glass has to have an index of at least 1: those that an eye sees.
pub(super) const VISIBLE: [f64; 2] = [380.0, 780.0];

/// A medium between two surfaces.
#[derive(Debug, Clone, PartialEq)]
pub struct Glass {
    /// The catalogue's name; what its numbers are where it has none.
    pub name: String,
    /// Its index over wavelength.
    pub dispersion: Dispersion,
}

/// How an index depends on the wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Dispersion {
    /// The same index for every wavelength.
    Constant(f64),
    /// Known by its index and its Abbe number alone: Cauchy's n = A + B/λ², whose two constants give exactly the index
    /// at d, and V = (n_d − 1)/(n_F − n_C) (Born & Wolf, Principles of Optics, §2.3.4 and §4.7.1).
    Abbe {
        /// n_d
        index: f64,
        /// V_d
        abbe: f64,
    },
    /// Sellmeier's n² − 1 = Σ bᵢ λ²/(λ² − cᵢ), λ in µm.
    Sellmeier {
        /// Strengths, without unit.
        b: [f64; 3],
        /// Squares of the resonances, in µm².
        c: [f64; 3],
    },
}

impl Glass {
    /// Air: an index of 1 at every wavelength.
    pub fn air() -> Self {
        Self { name: "air".to_owned(), dispersion: Dispersion::Constant(1.0) }
    }

    /// A glass known by its index at d, with an Abbe number or without dispersion.
    pub fn model(index: f64, abbe: Option<f64>) -> Self {
        match abbe {
            Some(abbe) => Self { name: format!("{index}/{abbe}"), dispersion: Dispersion::Abbe { index, abbe } },
            None => Self { name: index.to_string(), dispersion: Dispersion::Constant(index) },
        }
    }

    /// The catalogue's glass of this name, in capitals or not; or the names nearest to it.
    ///
    /// # Errors
    ///
    /// Up to three names that resemble `name`, the nearest first.
    pub fn named(name: &str) -> Result<Self, Vec<String>> {
        let name = name.trim();
        match catalogue().iter().find(|glass| glass.name.eq_ignore_ascii_case(name)) {
            Some(glass) => Ok(glass.clone()),
            None => Err(nearest(name)),
        }
    }

    /// Whether nothing refracts light in it.
    pub fn is_air(&self) -> bool {
        self.dispersion == Dispersion::Constant(1.0)
    }

    /// The index at a wavelength in nm. NaN where a Sellmeier formula has none.
    pub fn index(&self, wavelength: f64) -> f64 {
        self.dispersion.index(wavelength)
    }

    /// V_d = (n_d − 1)/(n_F − n_C); infinite without dispersion.
    pub fn abbe(&self) -> f64 {
        let [d, f, c] = [LINE_D, LINE_F, LINE_C].map(|line| self.index(line));
        (d - 1.0) / (f - c)
    }

    /// Why it cannot be used, if it cannot.
    pub(super) fn fault(&self) -> Option<String> {
        if let Dispersion::Abbe { abbe, .. } = self.dispersion
            && !(abbe.is_finite() && abbe > 0.0)
        {
            return Some(format!("an Abbe number of {abbe} is not above 0"));
        }
        let bad = VISIBLE.into_iter().chain([LINE_D]).find(|&line| {
            let index = self.index(line);
            !(index.is_finite() && index >= 1.0)
        })?;
        Some(format!("an index of {} at {bad} nm is not 1 or more", self.index(bad)))
    }
}

impl Dispersion {
    fn index(&self, wavelength: f64) -> f64 {
        match *self {
            Self::Constant(index) => index,
            Self::Abbe { index, abbe } => {
                let inverse_square = |line: f64| line.powi(-2);
                let b = (index - 1.0) / (abbe * (inverse_square(LINE_F) - inverse_square(LINE_C)));
                index + b * (inverse_square(wavelength) - inverse_square(LINE_D))
            }
            Self::Sellmeier { b, c } => {
                let square = (wavelength * 1e-3).powi(2);
                (1.0 + b.iter().zip(c).map(|(b, c)| b * square / (square - c)).sum::<f64>()).sqrt()
            }
        }
    }
}

/// The catalogue's file. It may say more of a glass than is read here.
#[derive(Deserialize)]
struct CatalogueTable {
    glass: Vec<GlassTable>,
}

#[derive(Deserialize)]
struct GlassTable {
    name: String,
    b: [f64; 3],
    c: [f64; 3],
}

/// All glasses that are known by name.
pub fn catalogue() -> &'static [Glass] {
    static CATALOGUE: OnceLock<Vec<Glass>> = OnceLock::new();
    CATALOGUE.get_or_init(|| {
        // A file within the program, which a test reads as well: should it be damaged, every name is unknown.
        let table = toml::from_str(include_str!("../../media/lenses/glass.toml"));
        let glasses = table.map_or_else(|_| Vec::new(), |CatalogueTable { glass }| glass);
        let glass = |GlassTable { name, b, c }: GlassTable| Glass { name, dispersion: Dispersion::Sellmeier { b, c } };
        glasses.into_iter().map(glass).collect()
    })
}

fn nearest(name: &str) -> Vec<String> {
    let name = name.to_uppercase();
    let alike = |known: &str| strsim::normalized_damerau_levenshtein(&name, &known.to_uppercase());
    let mut names: Vec<_> = catalogue().iter().map(|glass| (alike(&glass.name), &glass.name)).collect();
    names.retain(|&(alike, _)| alike >= 0.5);
    names.sort_by(|a, b| b.0.total_cmp(&a.0).then_with(|| a.1.cmp(b.1)));
    names.into_iter().take(3).map(|(_, name)| name.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_catalogue_gives_the_indices_that_the_maker_prints() {
        // SCHOTT's data sheets: n_d, V_d.
        for (name, index, abbe) in [("N-BK7", 1.5168, 64.17), ("F2", 1.62004, 36.37)] {
            let glass = Glass::named(&name.to_lowercase()).unwrap();
            assert_eq!(glass.name, name);
            assert!((glass.index(LINE_D) - index).abs() < 5e-6, "{name}: {}", glass.index(LINE_D));
            assert!((glass.abbe() - abbe).abs() < 5e-3, "{name}: {}", glass.abbe());
        }
    }

    #[test]
    fn every_glass_of_the_catalogue_can_be_used_and_is_named_once() {
        let glasses = catalogue();
        assert!(glasses.len() > 1);
        for (k, glass) in glasses.iter().enumerate() {
            assert_eq!(glass.fault(), None, "{}", glass.name);
            assert!((15.0..110.0).contains(&glass.abbe()), "{}: {}", glass.name, glass.abbe());
            let same = |other: &Glass| other.name.eq_ignore_ascii_case(&glass.name);
            assert!(!glasses[k + 1..].iter().any(same), "{} is there twice", glass.name);
        }
    }

    #[test]
    fn index_and_abbe_number_come_back() {
        let glass = Glass::model(1.6727, Some(32.25));
        assert!((glass.index(LINE_D) - 1.6727).abs() < 1e-15);
        assert!((glass.abbe() - 32.25).abs() < 1e-9);
        assert!(glass.index(400.0) > glass.index(700.0));
        assert_eq!(Glass::model(1.5, None).index(400.0), 1.5);
    }

    #[test]
    fn a_name_that_is_unknown_brings_those_that_resemble_it() {
        let near = Glass::named("N-BK77").unwrap_err();
        assert_eq!(near.first().map(String::as_str), Some("N-BK7"));
        assert!(Glass::named("Zerodur").unwrap_err().len() <= 3);
        assert!(Glass::named("").is_err());
    }

    #[test]
    fn indices_that_no_glass_has_are_told() {
        for (index, abbe) in [(0.9, None), (f64::NAN, None), (1.5, Some(0.0)), (1.5, Some(f64::NAN)), (1.0, Some(-3.0))]
        {
            assert!(Glass::model(index, abbe).fault().is_some(), "{index} {abbe:?}");
        }
        assert_eq!(Glass::air().fault(), None);
        assert!(Glass::air().is_air());
    }
}
