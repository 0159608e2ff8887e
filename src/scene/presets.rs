//! Lenses that come with vglare, from `media/presets`.

use std::path::Path;

use super::file;
use super::lens::Lens;
use crate::{Error, Result};

/// A lens file that is compiled in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Preset {
    /// Its name, in kebab case.
    pub name: &'static str,
    /// The lens file itself, to copy and change.
    pub toml: &'static str,
}

/// The lens that is used where none is named: visible, and within what a good lens of its time does.
pub const DEFAULT_PRESET: &str = "classic-prime";

macro_rules! preset {
    ($name:literal) => {
        Preset { name: $name, toml: include_str!(concat!("../../media/presets/", $name, ".toml")) }
    };
}

/// From the cleanest lens to the dirtiest, then the eye.
static PRESETS: [Preset; 7] = [
    preset!("modern-prime"),
    preset!("classic-prime"),
    preset!("anamorphic"),
    preset!("zoom"),
    preset!("vintage-uncoated"),
    preset!("haze-filter"),
    preset!("eye"),
];

/// Every preset.
pub fn all() -> &'static [Preset] {
    &PRESETS
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
        return Ok(Lens { name: name.to_owned(), description: "No ghosts.".to_owned(), ghosts: Vec::new() });
    }
    find(name)?.lens()
}

/// The preset that is called `name`.
///
/// # Errors
///
/// [`Error::UnknownPreset`], which lists the names there are.
pub fn find(name: &str) -> Result<&'static Preset> {
    let known = || PRESETS.iter().map(|preset| preset.name.to_owned()).collect();
    let found = PRESETS.iter().find(|preset| preset.name == name);
    found.ok_or_else(|| Error::UnknownPreset { name: name.to_owned(), known: known() })
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

    #[test]
    fn every_preset_keeps_what_its_description_says() {
        assert!(PRESETS.len() >= 5);
        for preset in all() {
            let lens = preset.lens().unwrap();
            let (_, percent) = lens.description.rsplit_once("; veil ").expect(preset.name);
            let percent: f64 = percent.trim_end_matches(" %").parse().unwrap();
            let share = lens.veiling_share();
            assert!((100.0 * share - percent).abs() <= 0.05, "{}: {share} is not {percent} %", preset.name);
            assert!((0.01..=0.15).contains(&share), "{}: {share}", preset.name);
        }
    }

    #[test]
    fn presets_are_wide_blobs_and_few() {
        for preset in all() {
            let lens = preset.lens().unwrap();
            assert!((6..=14).contains(&lens.ghosts.len()), "{}", preset.name);
            for ghost in &lens.ghosts {
                assert!(
                    ghost.size.min_element() >= 0.06 && ghost.size.max_element() <= 1.0,
                    "{} {ghost:?}",
                    preset.name
                );
                assert!((-1.5..=1.2).contains(&ghost.along), "{} {ghost:?}", preset.name);
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

    /// The eye's preset against the function that it stands for, from 2.5 to 11 degrees.
    #[test]
    fn the_eye_follows_the_published_point_spread_function() {
        let lens = named("eye").unwrap();
        let steradian = (180.0 / std::f64::consts::PI).powi(2);
        for degrees in [2.5, 3.0, 4.0, 6.0, 9.0, 11.0_f64] {
            let of = |ghost: &super::super::LensGhost| {
                let sigma = 20.0 * ghost.size.x;
                let peak = ghost.share / (std::f64::consts::TAU * sigma * sigma) * steradian;
                peak * (-0.5 * (degrees / sigma).powi(2)).exp()
            };
            let ours: f64 = lens.ghosts.iter().map(of).sum();
            let published = 0.478 * 20.91 / (degrees + 0.02).powi(3) + 0.138 * 72.37 / (degrees + 0.02).powi(2);
            println!("{degrees} degrees: {ours:.4} of {published:.4}, {:+.1} %", 100.0 * (ours / published - 1.0));
            assert!((ours / published - 1.0).abs() < 0.1, "{degrees} degrees: {ours} {published}");
        }
    }
}
