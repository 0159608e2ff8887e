//! The lenses that come with vglare, a line each.

use std::io::{self, Write};

use serde::Serialize;

use super::text::{left, table};
use crate::Result;
use crate::optics::{FirstOrder, GhostOptions, Setup, System};
use crate::scene::lenses;

/// A lens, wide open and at infinity, at its first setting.
#[derive(Debug, Serialize)]
pub(super) struct Entry {
    /// By which it is asked for.
    name: &'static str,
    /// What it is, for people.
    title: String,
    patent: Option<String>,
    focal_length_mm: f64,
    f_number: f64,
    /// The one that the source states; that of the sensor's corner where it states none.
    half_field_degrees: f64,
    surfaces: usize,
    /// Of surfaces that reflect: as many as there are ghosts.
    pairs: usize,
    coating: &'static str,
    settings: Vec<String>,
}

/// All of them.
///
/// # Errors
/// None for what is compiled in.
pub(super) fn entries() -> Result<Vec<Entry>> {
    lenses::all().iter().map(Entry::new).collect()
}

impl Entry {
    fn new(lens: &lenses::RealLens) -> Result<Self> {
        let read = lens.prescription()?;
        let system = System::new(&read, &Setup::default())?;
        let FirstOrder { focal_length, f_number, half_field, .. } = *system.first_order();
        Ok(Self {
            name: lens.name,
            title: read.name,
            patent: read.patent,
            focal_length_mm: focal_length,
            f_number,
            half_field_degrees: read.field.unwrap_or(half_field),
            surfaces: read.surfaces.len(),
            pairs: system.ghosts(&GhostOptions::default())?.ghosts.len(),
            coating: read.coating.name(),
            settings: read.settings.into_iter().map(|setting| setting.name).collect(),
        })
    }
}

/// As JSON.
pub(super) fn json(out: &mut dyn Write, entries: &[Entry]) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, entries)?;
    writeln!(out)
}

/// As a table.
pub(super) fn text(out: &mut dyn Write, entries: &[Entry]) -> io::Result<()> {
    let mut table = table(["name", "f mm", "f-number", "half field", "surfaces", "pairs", "coating", "patent"]);
    for entry in entries {
        // Who is named in it, and its example, are told with the lens.
        let patent = entry.patent.as_deref().map_or("", |patent| patent.split(" (").next().unwrap_or(patent));
        table.add_row([
            entry.name,
            &format!("{:.1}", entry.focal_length_mm),
            &format!("{:.1}", entry.f_number),
            &format!("{:.1}°", entry.half_field_degrees),
            &entry.surfaces.to_string(),
            &entry.pairs.to_string(),
            entry.coating,
            patent,
        ]);
    }
    left(&mut table, &[0, 6, 7]);
    writeln!(out, "{}\n\nvglare lens NAME tells of one, and of what it makes of a light.", table.trim_fmt())
}
