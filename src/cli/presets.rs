//! `vglare presets`: the lenses that come with vglare.

use std::io::{self, Write};

use comfy_table::{CellAlignment, Table, presets as styles};
use serde::Serialize;

use crate::Result;
use crate::scene::presets::{self, DEFAULT_PRESET};
use crate::scene::{Lens, Optical, OpticsSection, VeilFunction, lenses};
use crate::terminal::stdout;

/// List the lenses that come with vglare, or print one of them
///
/// A lens is a table of ghosts, as it turns any light into them; the part of a light's flux that they carry is shown in per cent.
/// Some have a veil, too: the part of every pixel's light that is scattered. --veil none leaves it out.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Print the lens file of this preset instead, to start a lens of your own from
    name: Option<String>,

    /// List those of looks of version 1, too, which files without a version mean
    #[arg(long, conflicts_with = "name")]
    all: bool,

    /// Print the list as JSON
    #[arg(long, conflicts_with = "name")]
    json: bool,
}

/// The last preset of the list.
const LAST: &str = "eye";

const EXAMPLES: &str = "\
Examples:
  vglare presets                           What is there?
  vglare presets --all                     And in looks of version 1?
  vglare presets anamorphic > mine.toml    Begin a lens file of your own";

/// Prints the list, or the lens file of the preset that is named.
///
/// # Errors
///
/// [`crate::Error::UnknownPreset`], or where standard output cannot be written.
pub fn run(args: &Args) -> Result<()> {
    if let Some(name) = &args.name {
        let toml = match lenses::find(name) {
            Ok(real) if presets::find(name).is_err() => real.toml,
            _ => presets::find(name)?.toml,
        };
        return stdout::print(|out| out.write_all(toml.as_bytes()));
    }
    let older = if args.all { presets::of_version_1() } else { &[] };
    let mut lenses = presets::all().iter().chain(older).map(|preset| preset.lens()).collect::<Result<Vec<_>>>()?;
    lenses.extend(real()?);
    if args.json { stdout::json(|out| json(out, &lenses)) } else { stdout::print(|out| table(out, &lenses)) }
}

/// The tables of real lenses that no preset is called like, wide open on a picture of their sensor's shape.
fn real() -> Result<Vec<Lens>> {
    let named = lenses::all().iter().map(|lens| lens.name).filter(|name| presets::find(name).is_err());
    let lens = |name: &str| {
        let section = OpticsSection { lens: Some(name.to_owned()), ..OpticsSection::default() };
        Ok(Lens::clone(Optical::new(section)?.lens()))
    };
    named.map(lens).collect()
}

#[derive(Serialize)]
struct Entry<'a> {
    name: &'a str,
    default: bool,
    ghosts: usize,
    /// Part of a light's luminous flux that the ghosts carry, 0 to 1.
    veil: f64,
    /// Part of every pixel's light that is scattered, 0 to 1; none where the lens has no veil.
    scatter: Option<f64>,
    /// Whether the ghosts are left out where there is a veil.
    replaces_ghosts: bool,
    description: &'a str,
}

impl<'a> From<&'a Lens> for Entry<'a> {
    fn from(lens: &'a Lens) -> Self {
        Self {
            name: &lens.name,
            default: lens.name == DEFAULT_PRESET,
            ghosts: lens.ghosts.len(),
            veil: lens.veiling_share(),
            scatter: lens
                .veil
                .as_ref()
                .and_then(|veil| Some(VeilFunction::new(&veil.section.parameters).ok()?.psf().energy())),
            replaces_ghosts: lens.veil.as_ref().is_some_and(|veil| veil.replaces_ghosts),
            description: &lens.description,
        }
    }
}

fn json(out: &mut dyn Write, lenses: &[Lens]) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, &lenses.iter().map(Entry::from).collect::<Vec<_>>())?;
    writeln!(out)
}

fn table(out: &mut dyn Write, lenses: &[Lens]) -> io::Result<()> {
    let mut table = Table::new();
    table.load_style(styles::NOTHING);
    table.set_header(["name", "ghosts", "mirrored %", "scattered %", "description"]);
    for Entry { name, ghosts, veil, scatter, description, .. } in lenses.iter().map(Entry::from) {
        let description = description.rsplit_once("; scatters ").map_or(description, |(text, _)| text);
        let percent = |part: f64| format!("{:.2}", 100.0 * part);
        table.add_row([
            name,
            &ghosts.to_string(),
            &percent(veil),
            &scatter.map(percent).unwrap_or_default(),
            description,
        ]);
    }
    table.column_iter_mut().skip(1).take(3).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    writeln!(
        out,
        "{}\n\nWhere no lens is named, it is {DEFAULT_PRESET}. Those after {LAST} are real lenses, by their surfaces: vglare lens tells more of \
         them. Those of looks of version 1 are called v1/NAME: --all lists them.",
        table.trim_fmt()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn real_lenses_are_listed_once_by_their_names() {
        let real = real().unwrap();
        assert!(real.iter().any(|lens| lens.name == "tessar" && lens.ghosts.len() > 10 && lens.veil.is_some()));
        assert!(real.iter().all(|lens| lens.name != "zoom"), "a preset is called so");
    }

    #[test]
    fn the_list_names_every_preset_and_the_default() {
        let lenses: Vec<_> = presets::all().iter().map(|preset| preset.lens().unwrap()).collect();
        let (mut text, mut list) = (Vec::new(), Vec::new());
        table(&mut text, &lenses).unwrap();
        json(&mut list, &lenses).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert!(lenses.iter().all(|lens| text.contains(&lens.name)), "{text}");
        let list: Vec<serde_json::Value> = serde_json::from_slice(&list).unwrap();
        assert_eq!(list.len(), lenses.len());
        assert_eq!(list.iter().filter(|entry| entry["default"] == true).count(), 1);
    }
}
