//! What a photo's file says of itself.

use std::io::{self, Write};
use std::path::Path;

use serde::Serialize;

use crate::choices::Projection;
use crate::cli::photo_told::PhotoTold;
use crate::options::ReadArgs;
use crate::photo::{self, LuminanceScale, Part, Photo};
use crate::terminal::{digits, stderr, stdout};
use crate::{Result, printable};

/// Channels of a part that are listed.
const MOST_CHANNELS: usize = 40;

#[derive(Serialize)]
struct Report {
    #[serde(flatten)]
    photo: PhotoTold,
    primaries: String,
    /// Whether the file says so; else they are taken for Rec. 709's.
    says_primaries: bool,
    display_referred: bool,
    /// The shares of red, green and blue in luminance.
    luminance_weights: [f64; 3],
    /// What the numbers are in cd/m², where that is known.
    luminance: Option<LuminanceScale>,
    fov: Option<f64>,
    fov_from: Option<String>,
    /// Of an OpenEXR file.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    parts: Vec<Part>,
    notes: Vec<String>,
}

/// Reads a photo and prints what is known of it.
///
/// # Errors
/// Those of [`photo::read_with`], and where standard output cannot be written.
pub fn run(path: &Path, reading: &ReadArgs, as_json: bool) -> Result<()> {
    let report = report(path, photo::read_with(path, &reading.options())?);
    if as_json {
        return stdout::json(|out| {
            serde_json::to_writer_pretty(&mut *out, &report)?;
            writeln!(out)
        });
    }
    stderr::warn(&report.notes);
    stdout::print(|out| text(out, &report))
}

fn report(path: &Path, photo: Photo) -> Report {
    let (facts, mut notes) = (photo.facts(), photo.source.notes.clone());
    let view = photo.view().unwrap_or_else(|doubt| {
        notes.push(doubt);
        None
    });
    let primaries = match (&photo.source.space, photo.source.primaries) {
        (Some(space), _) => format!("Rec. 709, converted from {space}"),
        (None, None) => "Rec. 709".to_owned(),
        (None, Some(primaries)) => primaries.title().unwrap_or("of its own").to_owned(),
    };
    Report {
        photo: PhotoTold::new(path, &facts),
        primaries,
        says_primaries: photo.source.knows_primaries || photo.source.display_referred,
        display_referred: photo.source.display_referred,
        luminance_weights: photo.luminance_weights(),
        luminance: photo.luminance_scale(),
        fov: view.as_ref().map(|view| view.across(&facts.frame, Projection::Rectilinear)),
        fov_from: view.map(|view| view.from),
        parts: photo.parts(),
        notes,
    }
}

/// The names to choose from, where there is a choice.
fn parts(out: &mut dyn Write, parts: &[Part]) -> io::Result<()> {
    let is_one = |part: &Part| part.layers.len() == 1;
    if parts.len() == 1 && parts.iter().all(is_one) {
        return Ok(());
    }
    for (number, Part { name, channels, .. }) in parts.iter().enumerate() {
        let first = channels.iter().take(MOST_CHANNELS).map(String::as_str).collect::<Vec<_>>().join(", ");
        let more = channels.len().saturating_sub(MOST_CHANNELS);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let name = name.as_ref().map_or_else(String::new, |name| format!("{name}: "));
        let line = printable::line(&format!("{name}{first}{more}"));
        writeln!(out, "  {:<19}{line}", format!("part {number}"))?;
    }
    Ok(())
}

fn text(out: &mut dyn Write, report: &Report) -> io::Result<()> {
    let PhotoTold { file, format, depth, layer, picture: [width, height], window, pixel_aspect } = &report.photo;
    let [left, top, columns, rows] = window;
    writeln!(out, "{file}")?;
    writeln!(out, "  format             {format}, {depth}")?;
    layer.iter().try_for_each(|layer| writeln!(out, "  layer              {layer}"))?;
    parts(out, &report.parts)?;
    writeln!(out, "  picture            {width} x {height}")?;
    if [*left, *top, *columns, *rows] != [0, 0, i64::from(*width), i64::from(*height)] {
        writeln!(out, "  stored             {columns} x {rows} from column {left}, row {top}")?;
    }
    if *pixel_aspect != 1.0 {
        writeln!(out, "  pixels             {pixel_aspect:.4} times as wide as high")?;
    }
    let numbers = if report.display_referred { "made for a display, in linear light" } else { "scene-linear" };
    writeln!(out, "  numbers            {numbers}")?;
    let taken = if report.says_primaries { "" } else { ", which the file does not say" };
    writeln!(out, "  primaries          {}{taken}", report.primaries)?;
    let [red, green, blue] = report.luminance_weights;
    writeln!(out, "  luminance          {red:.4} R + {green:.4} G + {blue:.4} B")?;
    match &report.luminance {
        Some(scale) => writeln!(out, "  cd/m²              {} of white, {}", digits(scale.cd_m2_per_unit), scale.from)?,
        None => writeln!(
            out,
            "  cd/m²              not known: the file does not name them, and --luminance of other commands may"
        )?,
    }
    match report.fov.zip(report.fov_from.as_ref()) {
        Some((fov, from)) => writeln!(out, "  field of view      {fov:.2}° across, {from}"),
        None => writeln!(out, "  field of view      not known"),
    }
}
