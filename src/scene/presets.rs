//! Lenses that come with vglare, from `media/presets`.

use std::path::Path;

use super::lens::Lens;
use super::sections::Version;
use super::{file, lenses};
use crate::{Error, Result};

/// A lens file that is compiled in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Preset {
    /// Its name, in kebab case; after `v1/`, where it is one of version 1.
    pub name: &'static str,
    /// The lens file itself, to copy and change.
    pub toml: &'static str,
}

/// The lens that is used where none is named: visible where bright light is, and within what a good lens of its time does.
pub const DEFAULT_PRESET: &str = "classic-prime";

macro_rules! preset {
    ($name:literal) => {
        Preset { name: $name, toml: include_str!(concat!("../../media/presets/", $name, ".toml")) }
    };
}

/// From the cleanest lens to the dirtiest, then the eye.
static PRESETS: [Preset; 8] = [
    preset!("modern-prime"),
    preset!("classic-prime"),
    preset!("classic-veil"),
    preset!("anamorphic"),
    preset!("zoom"),
    preset!("vintage-uncoated"),
    preset!("haze-filter"),
    preset!("eye"),
];

/// Those of looks of version 1, as they were: no table of these is changed.
static VERSION_1: [Preset; 8] = [
    preset!("v1/modern-prime"),
    preset!("v1/classic-prime"),
    preset!("v1/classic-veil"),
    preset!("v1/anamorphic"),
    preset!("v1/zoom"),
    preset!("v1/vintage-uncoated"),
    preset!("v1/haze-filter"),
    preset!("v1/eye"),
];

/// Every preset of today.
pub fn all() -> &'static [Preset] {
    &PRESETS
}

/// Every preset of looks of version 1, called `v1/` and the name that they have there.
pub fn of_version_1() -> &'static [Preset] {
    &VERSION_1
}

/// No lens: one without ghosts, for a veil alone.
pub const NO_LENS: &str = "none";

/// The lens of the preset that is called `name`, or [`NO_LENS`].
///
/// # Errors
///
/// [`Error::UnknownPreset`], which lists the names there are.
pub fn named(name: &str) -> Result<Lens> {
    if name == NO_LENS {
        let (name, description) = (name.to_owned(), "No ghosts.".to_owned());
        return Ok(Lens { name, description, ghosts: Vec::new(), veil: None });
    }
    find(name)?.lens()
}

/// The lens of the preset that a file of a version calls `name`: in one of version 1, that of then.
///
/// # Errors
///
/// [`Error::UnknownPreset`], which lists the names there are.
pub fn named_in(version: Version, name: &str) -> Result<Lens> {
    if version == Version::Two || name == NO_LENS {
        return named(name);
    }
    let plain = name.strip_prefix(V1).unwrap_or(name);
    let found = VERSION_1.iter().find(|preset| preset.name[V1.len()..] == *plain);
    found.ok_or_else(|| unknown(name, VERSION_1.iter().map(|preset| &preset.name[V1.len()..])))?.lens()
}

/// What stands before the names of presets of version 1.
const V1: &str = "v1/";

/// The preset that is called `name`.
///
/// # Errors
///
/// [`Error::UnknownPreset`], which lists the names there are, those of real lenses too.
pub fn find(name: &str) -> Result<&'static Preset> {
    let (list, real) = if name.starts_with(V1) { (&VERSION_1[..], &[][..]) } else { (&PRESETS[..], lenses::all()) };
    let found = list.iter().find(|preset| preset.name == name);
    let real = real.iter().map(|lens| lens.name).filter(|name| list.iter().all(|preset| preset.name != *name));
    found.ok_or_else(|| unknown(name, list.iter().map(|preset| preset.name).chain(real)))
}

fn unknown<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Error {
    Error::UnknownPreset { name: name.to_owned(), known: known.map(str::to_owned).collect() }
}

impl Preset {
    /// The lens itself.
    ///
    /// # Errors
    ///
    /// None for the presets that are compiled in; a test reads them all.
    pub fn lens(&self) -> Result<Lens> {
        file::lens(Path::new(self.name), self.name, self.toml)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::psf::Unit;
    use crate::scene::VeilFunction;
    use crate::series::Bell;

    #[test]
    fn every_preset_keeps_what_its_description_says() {
        assert!(PRESETS.len() >= 5);
        for preset in all() {
            let lens = preset.lens().unwrap();
            let (_, shares) = lens.description.rsplit_once("; scatters ").expect(preset.name);
            let (scattered, ghosts) = shares.trim_end_matches(" %").split_once(" %, ghosts ").expect(preset.name);
            let [scattered, ghosts] = [scattered, ghosts].map(|percent| percent.parse::<f64>().unwrap());
            let veil = lens.veil.as_ref().expect(preset.name);
            let function = VeilFunction::new(&veil.section.parameters).unwrap();
            let energy: f64 = [0.2126, 0.7152, 0.0722].iter().zip(function.psf().energies()).map(|(w, e)| w * e).sum();
            assert!((100.0 * energy - scattered).abs() <= 0.06, "{}: {energy}", preset.name);
            assert!(
                (100.0 * lens.veiling_share() - ghosts).abs() <= 0.006,
                "{}: {}",
                preset.name,
                lens.veiling_share()
            );
        }
    }

    /// A smaller one with as sharp an edge would cost a photo more waves than it has pixels.
    #[test]
    fn ghosts_of_presets_are_openings_that_a_series_can_have() {
        for preset in all() {
            for ghost in &preset.lens().unwrap().ghosts {
                let sharpest = match &ghost.bell {
                    Bell::Gaussian => ghost.size.min_element(),
                    Bell::Iris(iris) => iris.edge() * ghost.size.min_element(),
                    other => panic!("{}: {other}", preset.name),
                };
                assert!(sharpest >= 0.007 && ghost.size.max_element() <= 1.0, "{} {ghost:?}", preset.name);
                assert!((-1.5..=1.0).contains(&ghost.along), "{} {ghost:?}", preset.name);
            }
        }
    }

    #[test]
    fn presets_go_by_name() {
        assert_eq!(named(DEFAULT_PRESET).unwrap().name, DEFAULT_PRESET);
        let message = named("fish-eye").unwrap_err().to_string();
        assert!(
            message.contains("fish-eye") && PRESETS.iter().all(|preset| message.contains(preset.name)),
            "{message}"
        );
        assert!(PRESETS.iter().all(|p| p.name.chars().all(|c| c.is_ascii_lowercase() || c == '-')));
    }

    #[test]
    fn those_of_version_1_go_by_their_version_or_by_their_name() {
        let (eye, old) = (named("eye").unwrap(), named("v1/eye").unwrap());
        assert_eq!((&*eye.name, &*old.name), ("eye", "v1/eye"));
        for name in ["eye", "v1/eye"] {
            assert_eq!(named_in(Version::One, name).unwrap(), old);
        }
        assert_eq!(named_in(Version::Two, "eye").unwrap(), eye);
        assert_eq!(named_in(Version::One, NO_LENS).unwrap(), named(NO_LENS).unwrap());
        let veiled: Vec<_> = of_version_1().iter().filter(|preset| preset.lens().unwrap().veil.is_some()).collect();
        assert_eq!(veiled.iter().map(|preset| preset.name).collect::<Vec<_>>(), ["v1/classic-veil"]);
        for (said, ways) in [
            (named("zom"), ["did you mean zoom?", "v1/NAME"]),
            (named("v1/zom"), ["did you mean v1/zoom?", "v1/eye"]),
            (named_in(Version::One, "zom"), ["did you mean zoom?", "\"zom\""]),
        ] {
            let said = said.unwrap_err().to_string();
            assert!(ways.iter().all(|way| said.contains(way)), "{said}");
        }
    }

    #[test]
    fn veils_of_presets_need_no_field_of_view() {
        let lenses: Vec<_> = all().iter().map(|preset| preset.lens().unwrap()).collect();
        let veils = |lens: &Lens| {
            let veil = lens.veil.clone()?;
            assert_eq!(veil.section.fov, None, "{}", lens.name);
            let function = VeilFunction::new(&veil.section.parameters).unwrap();
            assert_eq!(function.psf().unit(), Unit::Look, "{}: no field of view is needed", lens.name);
            Some((lens.name.clone(), function.psf().energies(), veil.replaces_ghosts))
        };
        let found: Vec<_> = lenses.iter().filter_map(veils).collect();
        let names: Vec<_> = found.iter().map(|(name, _, replaces)| (&**name, *replaces)).collect();
        let all: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
        assert_eq!(names.iter().map(|(name, _)| *name).collect::<Vec<_>>(), all, "every lens scatters");
        assert!(names.iter().all(|(_, replaces)| !replaces), "a lens's ghosts are no veil: {names:?}");
    }

    /// Its veil against all of that function, from 0.1 to 60 degrees.
    #[test]
    fn the_eyes_veil_follows_the_published_function_to_a_hundredth() {
        let veil = named("eye").unwrap().veil.unwrap();
        let function = VeilFunction::new(&veil.section.parameters).unwrap();
        let to_steradian = (20.0f64.to_radians()).powi(-2);
        for place in 0..=200 {
            let degrees = 0.1 * 600.0f64.powf(f64::from(place) / 200.0);
            let published = 0.384 * 2.61e6 * (-(degrees / 0.02f64).powi(2)).exp()
                + 0.478 * 20.91 / (degrees + 0.02).powi(3)
                + 0.138 * 72.37 / (degrees + 0.02).powi(2);
            let ours = to_steradian * function.psf().value(degrees / 20.0);
            assert!((ours / published - 1.0).abs() < 1e-2, "{degrees} degrees: {ours} {published}");
        }
    }
}
