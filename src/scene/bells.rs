//! The bells that scene and lens files name.

use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use glam::DVec2;
use serde::Deserialize;
use toml::Spanned;

use super::file::contents;
use super::number::Finite;
use crate::series::{Bell, Disc, Iris, Profile, SineGaussian, VonMises};

/// The names of bells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum BellName {
    Gaussian,
    CosineSquared,
    Parabola,
    Paraboloid,
    VonMises,
    SineGaussian,
    Profile,
    Disc,
    Iris,
}

/// A radial profile: rows in the file itself, or in a CSV file beside it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ProfileTable {
    name: Spanned<String>,
    rows: Option<Vec<[Finite; 2]>>,
    file: Option<String>,
}

/// The rim of a disc that says nothing of it, in sizes.
const RIM: f64 = 0.1;
/// The edge of an iris that says nothing of it.
const EDGE: f64 = 0.05;

/// What a table says of its ghost's bell.
pub(super) struct BellKeys {
    pub bell: Option<Spanned<BellName>>,
    pub profile: Option<Spanned<String>>,
    pub mean: Option<Spanned<Finite>>,
    pub rim: Option<Spanned<Finite>>,
    pub edge: Option<Spanned<Finite>>,
    pub blades: Option<Spanned<u32>>,
    pub rotation: Option<Spanned<Finite>>,
}

impl BellKeys {
    /// The keys of an opening, and where they are.
    fn of_opening(&self) -> [(&'static str, Option<Range<usize>>); 4] {
        [
            ("rim", self.rim.as_ref().map(Spanned::span)),
            ("edge", self.edge.as_ref().map(Spanned::span)),
            ("blades", self.blades.as_ref().map(Spanned::span)),
            ("rotation", self.rotation.as_ref().map(Spanned::span)),
        ]
    }
}

/// What is wrong with a part of a file.
pub(super) struct Fault {
    pub span: Range<usize>,
    pub message: String,
}

fn fault<T>(at: &Spanned<T>, message: impl Into<String>) -> Fault {
    Fault { span: at.span(), message: message.into() }
}

/// What the bells of a file may refer to.
#[derive(Default)]
pub(super) struct Bells {
    period: Option<DVec2>,
    profiles: HashMap<String, Arc<Profile>>,
}

impl Bells {
    /// The profiles of a file at `path`, which may refer to others beside it, and its period.
    pub fn new(path: &Path, tables: Vec<ProfileTable>, period: Option<DVec2>) -> Result<Self, Fault> {
        let mut profiles = HashMap::new();
        for ProfileTable { name, rows, file } in tables {
            let rows = match (rows, file) {
                (Some(rows), None) => rows.iter().map(|[radius, value]| [radius.0, value.0]).collect(),
                (None, Some(file)) => {
                    let file = path.parent().unwrap_or(Path::new("")).join(file);
                    read_rows(&file).map_err(|reason| fault(&name, reason))?
                }
                _ => return Err(fault(&name, "a profile has either `rows` or a `file`")),
            };
            let profile = Profile::new(&rows).map_err(|reason| fault(&name, reason))?;
            if profiles.insert(name.as_ref().clone(), Arc::new(profile)).is_some() {
                return Err(fault(&name, "there is a profile of that name already"));
            }
        }
        Ok(Self { period, profiles })
    }

    /// The bell that a ghost has.
    pub fn bell(&self, keys: &BellKeys) -> Result<Bell, Fault> {
        let Some(name) = &keys.bell else {
            self.only(keys, None)?;
            return Ok(Bell::Gaussian);
        };
        self.only(keys, Some(*name.as_ref()))?;
        let period = || {
            let reason = format!("a {} bell is periodic, so a scene file must give the series' `period`", spelt(name));
            self.period.ok_or_else(|| fault(name, reason))
        };
        Ok(match name.as_ref() {
            BellName::Gaussian => Bell::Gaussian,
            BellName::CosineSquared => Bell::CosineSquared,
            BellName::Parabola => Bell::Parabola,
            BellName::Paraboloid => Bell::Paraboloid,
            BellName::VonMises => Bell::VonMises(VonMises { period: period()? }),
            BellName::SineGaussian => {
                let mean = keys.mean.as_ref().map_or(0.0, |mean| mean.as_ref().0);
                Bell::SineGaussian(SineGaussian { period: period()?, mean })
            }
            BellName::Profile => {
                let Some(wanted) = &keys.profile else {
                    return Err(fault(name, "a profile bell needs `profile`, the name of a [[profile]]"));
                };
                let unknown = || fault(wanted, format!("there is no [[profile]] called {:?}", wanted.as_ref()));
                Bell::Profile(self.profiles.get(wanted.as_ref()).ok_or_else(unknown)?.clone())
            }
            BellName::Disc => Bell::Disc(disc(keys, name)?),
            BellName::Iris => Bell::Iris(iris(keys, name)?),
        })
    }

    /// Refuses keys that mean nothing for the bell, and numbers that make no sense.
    fn only(&self, keys: &BellKeys, name: Option<BellName>) -> Result<(), Fault> {
        if let Some(profile) = keys.profile.as_ref().filter(|_| name != Some(BellName::Profile)) {
            return Err(fault(profile, "`profile` belongs to a bell = \"profile\""));
        }
        let given = keys.of_opening().into_iter().filter_map(|(key, span)| Some((key, span?)));
        for (key, span) in given {
            let owners: &[(BellName, &str)] = match key {
                "rim" => &[(BellName::Disc, "disc")],
                "edge" => &[(BellName::Iris, "iris")],
                _ => &[(BellName::Disc, "disc"), (BellName::Iris, "iris")],
            };
            if !owners.iter().any(|(owner, _)| name == Some(*owner)) {
                let owners: Vec<String> = owners.iter().map(|(_, spelt)| format!("\"{spelt}\"")).collect();
                let message = format!("`{key}` belongs to a bell = {}", owners.join(" or "));
                return Err(Fault { span, message });
            }
        }
        let Some(mean) = &keys.mean else { return Ok(()) };
        if name != Some(BellName::SineGaussian) {
            return Err(fault(mean, "`mean` belongs to a bell = \"sine-gaussian\""));
        }
        if mean.as_ref().0.abs() > 1.0 {
            return Err(fault(mean, "the mean of a sine-gaussian bell is from -1 to 1, like a sine"));
        }
        Ok(())
    }
}

/// The disc that a table says.
fn disc(keys: &BellKeys, name: &Spanned<BellName>) -> Result<Disc, Fault> {
    let number = |key: &Option<Spanned<Finite>>| key.as_ref().map(|number| number.as_ref().0);
    let (rim, rotation) = (number(&keys.rim).unwrap_or(RIM), number(&keys.rotation).unwrap_or(0.0));
    let blades = keys.blades.as_ref().map_or(0, |blades| *blades.as_ref());
    let [of_rim, _, of_blades, of_rotation] = keys.of_opening().map(|(_, span)| {
        let span = span.unwrap_or(name.span());
        move |message: String| Fault { span, message }
    });
    // Key by key, each with what is right by itself for those that follow.
    Disc::new(rim, 0, 0.0).map_err(of_rim)?;
    Disc::new(RIM, blades, 0.0).map_err(of_blades)?;
    Disc::new(rim, blades, rotation).map_err(of_rotation)
}

/// The iris that a table says.
fn iris(keys: &BellKeys, name: &Spanned<BellName>) -> Result<Iris, Fault> {
    let number = |key: &Option<Spanned<Finite>>| key.as_ref().map(|number| number.as_ref().0);
    let (edge, rotation) = (number(&keys.edge).unwrap_or(EDGE), number(&keys.rotation).unwrap_or(0.0));
    let blades = keys.blades.as_ref().map_or(0, |blades| *blades.as_ref());
    let [_, of_edge, of_blades, of_rotation] = keys.of_opening().map(|(_, span)| {
        let span = span.unwrap_or(name.span());
        move |message: String| Fault { span, message }
    });
    // Key by key, as those of a disc.
    Iris::new(edge, 0, 0.0).map_err(of_edge)?;
    Iris::new(EDGE, blades, 0.0).map_err(of_blades)?;
    Iris::new(edge, blades, rotation).map_err(of_rotation)
}

fn spelt(name: &Spanned<BellName>) -> &'static str {
    match name.as_ref() {
        BellName::SineGaussian => "sine-gaussian",
        _ => "von-mises",
    }
}

/// Radius and value from the first two columns of a CSV file; lines that begin with # are comments, and the first line
/// may be a heading.
fn read_rows(path: &Path) -> Result<Vec<[f64; 2]>, String> {
    let named = |reason: &dyn std::fmt::Display| format!("the profile {} {reason}", path.display());
    let bytes = contents(path).map_err(|reason| named(&reason))?;
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(&*bytes);
    let mut rows = Vec::new();
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|error| named(&format_args!("cannot be read: {error}")))?;
        let number = |column: usize| record.get(column).and_then(|text| text.parse::<f64>().ok());
        match (number(0), number(1)) {
            (Some(radius), Some(value)) => rows.push([radius, value]),
            _ if index == 0 => {}
            _ => {
                let line = record.position().map_or(0, csv::Position::line);
                return Err(named(&format_args!("has no two numbers in line {line}")));
            }
        }
    }
    Ok(rows)
}
