//! Scene, light and lens files, in TOML.
//!
//! ```toml
//! version = 2                 # what the file means by what it does not say; without it, 1
//! description = "a lamp and a blob"  # optional
//! preset = "zoom"             # optional: the lens, where the file has no [[lens_ghost]]
//! axis = [0.0, 0.1]           # optional: where the lens's axis meets the picture; the centre otherwise
//! period = [4.0, 3.0]         # optional, of the series, in x and y; planned otherwise
//! degree = [32, 24]           # optional, 0 to 4096; planned otherwise
//!
//! [look]                      # optional, like every key in it and in the next two
//! strength = 1.0              # what the glare is multiplied by; 0 or more
//! size = 1.0                  # what the ghosts' sizes are multiplied by
//! tint = [1.0, 1.0, 1.0]      # what the ghosts' colours are multiplied by; 0 or more
//! mix = "add"                 # or "energy"
//! normalize = "none"          # or "clamp", "minmax"
//! unit = "short-side"         # of lengths; or "height", as in version 1, "diagonal", "degrees"
//! sources = "photo"           # every pixel is a light; or "lights", as in version 1
//! fov = 50                    # degrees across the picture's width, for what is in degrees
//!
//! [find]                      # lights in the photo, where the file lists none or adds to them
//! by = "brightest"            # channel of a pixel; or "luminance", as in version 1
//! threshold = 20.0
//! merge = 0.02
//! max_lights = 4096           # 64 in version 1
//! beyond = "join"             # the nearest light; or "drop", as in version 1
//! firefly_limit = 1000        # a pixel that outshines its neighbours by more is no light; 0 takes it
//! add = false                 # whether the file's lights are added to the photo's
//!
//! [optics]                    # optional: a lens by its surfaces, in the place of a preset; docs/lenses.md has them
//! lens = "double-gauss"       # or file = "my-lens.zmx"
//! fstop = 8.0                 # f-number; wide open otherwise. focus, sensor, blades, coating, setting are optional, too
//!
//! [veil]                      # every pixel a source; docs/scenes.md has the functions and their keys
//! psf = "cie"                 # or "none", where the lens has a veil and there is to be none
//! age = 60
//! fov = 50                    # degrees across the picture's width
//!
//! [accuracy]
//! tolerance = 1e-3            # between 0 and 1; or budget = 20.0, in milliseconds
//! allow_floor = false
//! each_pixel = false          # true holds the error to the tolerance of photo and glare at each pixel, too
//! evaluator = "grid"          # or "direct", "series", "rows"; planned otherwise
//!
//! [[light]]
//! position = [0.3, 0.4]       # x, y; may lie outside the picture
//! flux = [12.0, 10.0, 8.0]    # radiance × area, RGB, 0 or more
//! size = 0.0                  # optional: rms distance from the centre along one axis; 0 is a point
//! muted = false               # optional: kept in the file, makes no ghosts
//!
//! [[ghost]]
//! bell = "gaussian"           # optional; docs/scenes.md has the others, and the keys that they need
//! center = [0.25, -0.5]
//! size = 0.2                  # σ of a Gaussian, half the width of a bell that ends; or one for each axis
//! radiance = [1.0, 0.8, 0.5]  # at its centre; may be negative, which takes light away
//!
//! [[lens_ghost]]
//! bell = "gaussian"           # optional
//! along = -0.7                # centre = axis + along × (the light's position − axis)
//! size = 0.15                 # σ for a light that is a point; or [σx, σy]
//! tint = [1.0, 0.9, 0.7]      # optional, white otherwise; 0 or more
//! share = 0.01                # of the light's flux; 0 or more
//! ```
//!
//! Lengths are in what `unit` in `[look]` says, the origin is the picture's centre, y points up. A lens file has `description`,
//! `[[lens_ghost]]` and `[veil]` only, a light file `[[light]]` only; a light file may also be what `vglare lights --json` prints.

use std::fs;
use std::io::Read as _;
use std::ops::Range;
use std::path::Path;

use glam::DVec2;
use serde::de::DeserializeOwned;

use super::bells::{Bells, Fault};
use super::lens::Lens;
use super::number::plain;
use super::sections::{AccuracySection, AccuracyTable, FindSection, LookSection, Version};
use super::tables::{LensTable, LightsJson, LightsTable, SceneTable, VersionTable};
use super::veil::{self, VeilSection};
use super::{Ghost, LensGhost, Light, OpticsSection};
use crate::choices::LengthUnit;
use crate::{Error, Result};

/// What a scene file says. Everything is optional in the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SceneFile {
    /// What it means by what it does not say.
    pub version: Version,
    /// One line for people.
    pub description: String,
    /// The lens, as the name of a preset that there is, with `v1/` before it where it is one of version 1; `None` beside lens ghosts.
    pub preset: Option<String>,
    /// The lens, by its surfaces, and how it is set; `None` beside a preset or lens ghosts.
    pub optics: Option<OpticsSection>,
    /// Where the lens's axis meets the picture; its centre where it is `None`.
    pub axis: Option<DVec2>,
    /// Period of the series in x and y, in the file's unit; planned where it is `None`.
    pub period: Option<DVec2>,
    /// Highest harmonic in x and y, 0 to 4096; planned where it is `None`.
    pub degree: Option<[u32; 2]>,
    /// How the glare looks.
    pub look: LookSection,
    /// What counts as a light in the photo.
    pub find: FindSection,
    /// How exact the glare is to be.
    pub accuracy: AccuracySection,
    /// What every pixel scatters; where it is `None`, what the lens says.
    pub veil: Option<VeilSection>,
    /// Whether the file says that there is none, though its lens have one.
    pub no_veil: bool,
    /// Lights, in the file's order; `None` where it leaves them to the photo, and empty for `light = []`.
    pub lights: Option<Vec<Light>>,
    /// Ghosts that no light makes.
    pub ghosts: Vec<Ghost>,
    /// The lens that the lights are seen through; empty where the file names none.
    pub lens_ghosts: Vec<LensGhost>,
}

/// Reads a scene file.
///
/// # Errors
///
/// [`Error::SceneFile`] with the line, the key and what was expected there, or why the file cannot be read.
pub fn read_scene(path: &Path) -> Result<SceneFile> {
    parse_scene(path, &text(path)?)
}

/// The scene that `text` describes, which came from `path`.
pub(super) fn parse_scene(path: &Path, text: &str) -> Result<SceneFile> {
    let located = |fault: Fault| Error::scene_file(path, pointed(text, fault.span, &fault.message));
    // First: all else depends on it. What is no TOML is told below.
    let version = toml::from_str(text).map_or(Ok(Version::One), |table: VersionTable| table.version());
    let version = version.map_err(located)?;
    let table: SceneTable = from_toml(path, text)?;
    let preset = table.preset(version).map_err(located)?;
    let optics = table.optics(path).map_err(located)?;
    let period = table.period.map(|period| DVec2::from_array(plain(period)));
    let accuracy = table.accuracy.map(AccuracyTable::section).transpose().map_err(located)?;
    let bells = Bells::new(path, table.profiles, period).map_err(located)?;
    let ghosts = table.ghosts.into_iter().map(|ghost| ghost.ghost(&bells));
    let lens_ghosts = table.lens_ghosts.into_iter().map(|ghost| ghost.lens_ghost(&bells));
    let veil = table.veil.map(|veil| veil::section(path, veil)).transpose().map_err(located)?;
    Ok(SceneFile {
        version,
        description: table.description,
        preset,
        optics,
        axis: table.axis.map(|axis| DVec2::from_array(plain(axis))),
        period,
        degree: table.degree.map(|degree| degree.map(|d| d.0)),
        look: table.look,
        find: table.find,
        accuracy: accuracy.unwrap_or_default(),
        no_veil: matches!(veil, Some(None)),
        veil: veil.flatten(),
        lights: table.lights.map(converted),
        ghosts: ghosts.collect::<Result<_, _>>().map_err(located)?,
        lens_ghosts: lens_ghosts.collect::<Result<_, _>>().map_err(located)?,
    })
}

/// Reads a file of lights: TOML with `[[light]]` tables, or the JSON that `vglare lights --json` prints.
///
/// # Errors
///
/// Like [`read_scene`].
pub fn read_lights(path: &Path) -> Result<Vec<Light>> {
    lights(path).map(|(lights, _)| lights)
}

/// The same for a look whose lengths are counted in `unit`.
///
/// # Errors
///
/// Like [`read_lights`]; also for a file that says that its lights are in another unit.
pub fn read_lights_in(path: &Path, unit: LengthUnit) -> Result<Vec<Light>> {
    let (lights, theirs) = lights(path)?;
    match theirs.filter(|theirs| *theirs != unit) {
        Some(theirs) => Err(Error::scene_file(
            path,
            format_args!(
                "its lights are in the unit `{theirs}`, and the look is in `{unit}`: give both the same --unit"
            ),
        )),
        None => Ok(lights),
    }
}

/// The unit that a file of lights names; none where it does not, which means [`LengthUnit::OF_FILES`].
///
/// # Errors
///
/// Like [`read_lights`].
pub fn unit_of_lights(path: &Path) -> Result<Option<LengthUnit>> {
    lights(path).map(|(_, unit)| unit)
}

/// The lights of a file, and their unit where it says that.
fn lights(path: &Path) -> Result<(Vec<Light>, Option<LengthUnit>)> {
    let text = text(path)?;
    // No TOML document begins with a brace, and all that we print as JSON does.
    if text.trim_start_matches('\u{feff}').trim_start().starts_with('{') {
        let json: LightsJson = serde_json::from_str(text.trim_start_matches('\u{feff}'))
            .map_err(|e| Error::scene_file(path, json_reason(&text, &e)))?;
        return Ok((converted(json.lights), json.unit));
    }
    let table: LightsTable = from_toml(path, &text)?;
    Ok((converted(table.lights), None))
}

/// Reads a lens file. The lens is called like the file, without the extension.
///
/// # Errors
///
/// Like [`read_scene`]; also for a lens that has neither ghosts nor a veil.
pub fn read_lens(path: &Path) -> Result<Lens> {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    lens(path, &name, &text(path)?)
}

/// The lens that `text` describes, which came from `path`.
pub(super) fn lens(path: &Path, name: &str, text: &str) -> Result<Lens> {
    let table: LensTable = from_toml(path, text)?;
    if table.ghosts.is_empty() && table.veil.is_none() {
        return Err(Error::scene_file(
            path,
            "the lens has no ghosts: expected at least one [[lens_ghost]], or a [veil]",
        ));
    }
    let located = |fault: Fault| Error::scene_file(path, pointed(text, fault.span, &fault.message));
    let bells = Bells::new(path, table.profiles, None).map_err(located)?;
    let ghosts = table.ghosts.into_iter().map(|ghost| ghost.lens_ghost(&bells));
    let ghosts = ghosts.collect::<Result<_, _>>().map_err(located)?;
    let veil = table.veil.map(|veil| veil::of_lens(path, veil)).transpose().map_err(located)?.flatten();
    Ok(Lens { name: name.to_owned(), description: table.description, ghosts, veil })
}

fn converted<T: Into<U>, U>(tables: Vec<T>) -> Vec<U> {
    tables.into_iter().map(Into::into).collect()
}

/// The most that a scene, lens, light or profile file may hold: some 150,000 lights as `vglare lights --json` prints them.
const MOST_BYTES: u64 = 32 << 20;

/// What a file holds.
///
/// # Errors
/// Why it cannot be read, for people: also where it is no regular file, which may have no end, or where it is too long.
pub(crate) fn contents(path: &Path) -> Result<Vec<u8>, String> {
    let told = |error: std::io::Error| format!("cannot be read: {error}");
    // Before it is opened: opening a pipe waits for someone to write to it.
    let kind = fs::metadata(path).map_err(told)?.file_type();
    if !kind.is_file() {
        let what = if kind.is_dir() { "a folder" } else { "a pipe or a device" };
        return Err(format!("cannot be read: it is {what}, and vglare reads regular files only"));
    }
    let mut bytes = Vec::new();
    fs::File::open(path).and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes)).map_err(told)?;
    match bytes.len() as u64 {
        0..=MOST_BYTES => Ok(bytes),
        _ => Err(format!("cannot be read: it is larger than {} MiB", MOST_BYTES >> 20)),
    }
}

fn text(path: &Path) -> Result<String> {
    let bytes = contents(path).map_err(|reason| Error::scene_file(path, reason))?;
    String::from_utf8(bytes).map_err(|e| {
        let line = 1 + e.as_bytes()[..e.utf8_error().valid_up_to()].iter().filter(|&&b| b == b'\n').count();
        Error::scene_file(path, format_args!("line {line}: this is not UTF-8 text"))
    })
}

fn from_toml<T: DeserializeOwned>(path: &Path, text: &str) -> Result<T> {
    toml::from_str(text).map_err(|mut e: toml::de::Error| {
        let span = e.span().unwrap_or(0..0);
        // Without the text, toml prints the message and the keys that lead to it, and we show the place ourselves.
        e.set_input(None);
        let message = e.to_string();
        Error::scene_file(path, pointed(text, span, &message.trim_end().replace("\nin `", " in `")))
    })
}

fn json_reason(text: &str, error: &serde_json::Error) -> String {
    let message = error.to_string();
    let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(message, _)| message);
    let line_start: usize = text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum();
    let at = (line_start + error.column().saturating_sub(1)).min(text.len());
    pointed(text, at..at, message)
}

/// The message, where it applies, and the line itself with a mark below:
///
/// ```text
/// line 3, column 8: expected a positive finite number, found -1 in `ghost.size`
///   3 | size = -1
///     |        ^^
/// ```
fn pointed(text: &str, span: Range<usize>, message: &str) -> String {
    let start = boundary(text, span.start);
    let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
    let line = text[line_start..].lines().next().unwrap_or_default();
    let number = text[..line_start].matches('\n').count() + 1;
    let column = text[line_start..start].chars().count();
    let end = boundary(text, span.end.min(line_start + line.len()).max(start));
    let marks = "^".repeat(text[start..end].chars().count().max(1));
    // A line may be megabytes long where someone wrote all on one; then its place must do.
    if line.len() > 160 {
        return format!("line {number}, column {}: {message}", column + 1);
    }
    let (gutter, line, indent) = (" ".repeat(number.to_string().len()), line.replace('\t', " "), " ".repeat(column));
    format!("line {number}, column {}: {message}\n  {number} | {line}\n  {gutter} | {indent}{marks}", column + 1)
}

/// The last place in `text` up to byte `at` that is between two characters; JSON columns count bytes.
fn boundary(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}

#[cfg(test)]
mod tests;
