//! `vglare lights`: the lights found in a photo.

use std::io::{self, Write};
use std::path::PathBuf;

use comfy_table::{CellAlignment, Table, presets};
use serde::Serialize;

use super::found::{self, short};
use crate::Result;
use crate::choices::{LengthUnit, LightBy};
use crate::frame::Frame;
use crate::look::Look;
use crate::options::{FindArgs, ReadArgs, UnitArgs};
use crate::photo;
use crate::scene::threshold::Rule;
use crate::scene::{FindOptions, Found, Light};
use crate::terminal::stderr::warn;
use crate::terminal::stdout;

/// Find the lights in a photo
///
/// Prints each connected region of bright pixels as a light: where its centre is, what flux it has and how large it is.
/// Positions and sizes are in halves of the picture's shorter side, or in what --unit says, from the picture's centre, x to the right and y up;
/// flux is radiance times area, in the photo's unit.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The photo: OpenEXR, Radiance HDR, PFM, TIFF, PNG, JPEG or JPEG XL; - for standard input
    photo: PathBuf,

    /// Print JSON, which can be edited and read back as a file of lights
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    reading: ReadArgs,

    #[command(flatten)]
    find: FindArgs,

    #[command(flatten)]
    unit: UnitArgs,
}

const EXAMPLES: &str = "\
Examples:
  vglare lights night.exr                         What glares in this photo?
  vglare lights night.exr --threshold 50          Only what is brighter than 50
  vglare lights night.exr --json > lights.json    To be edited and used again";

/// Reads the photo, finds its lights and prints them.
///
/// # Errors
///
/// Where the photo cannot be read or standard output cannot be written.
pub fn run(args: &Args) -> Result<()> {
    let photo = photo::read_with(&args.photo, &args.reading.options())?;
    warn(&photo.source.notes);
    let options = args.find.over(FindOptions::default());
    let look = args.unit.over(Look { find: options, ..Look::default() });
    args.unit.check(&look)?;
    let frame = look.frame(&photo)?;
    let found = look.find(&photo, &look.recovered(&photo), &frame);
    if args.json {
        stdout::json(|out| json(out, &found, look.unit))
    } else {
        stdout::print(|out| table(out, &found, &options, &frame))
    }
}

/// Found lights as `scene::read_lights` reads them.
#[derive(Serialize)]
struct Json {
    unit: LengthUnit,
    by: LightBy,
    threshold: f64,
    rule: Rule,
    regions: usize,
    merged: usize,
    dropped: usize,
    dropped_share: f64,
    joined: usize,
    joined_share: f64,
    fireflies: FirefliesJson,
    lights: Vec<LightJson>,
}

/// Pixels that outshine their neighbours and are no light, and column and row of the first.
#[derive(Serialize)]
pub struct FirefliesJson {
    count: usize,
    first: Option<[i32; 2]>,
}

impl From<&Found> for FirefliesJson {
    fn from(found: &Found) -> Self {
        Self { count: found.fireflies, first: found.first_firefly.map(Into::into) }
    }
}

#[derive(Serialize)]
struct LightJson {
    position: [f64; 2],
    flux: [f64; 3],
    size: f64,
}

impl From<&Light> for LightJson {
    fn from(light: &Light) -> Self {
        Self { position: light.position.to_array(), flux: light.flux, size: light.size }
    }
}

fn json(out: &mut dyn Write, found: &Found, unit: LengthUnit) -> io::Result<()> {
    let json = Json {
        unit,
        by: found.by,
        threshold: found.threshold,
        rule: found.rule,
        regions: found.regions,
        merged: found.merged(),
        dropped: found.dropped,
        dropped_share: found.dropped_share,
        joined: found.joined,
        joined_share: found.joined_share,
        fireflies: found.into(),
        lights: found.lights.iter().map(LightJson::from).collect(),
    };
    serde_json::to_writer_pretty(&mut *out, &json)?;
    writeln!(out)
}

fn table(out: &mut dyn Write, found: &Found, options: &FindOptions, frame: &Frame) -> io::Result<()> {
    if !found.lights.is_empty() {
        let mut table = Table::new();
        table.load_style(presets::NOTHING);
        table.set_header(["#", "x", "y", "column", "row", "flux R", "flux G", "flux B", "size", "share %"]);
        for (k, (light, share)) in found.lights.iter().zip(&found.shares).enumerate() {
            table.add_row(row(k + 1, light, *share, frame));
        }
        table.column_iter_mut().for_each(|column| column.set_cell_alignment(CellAlignment::Right));
        writeln!(out, "{}", table.trim_fmt())?;
    }
    writeln!(out, "{}", summary(found, options))
}

fn row(number: usize, light: &Light, share: f64, frame: &Frame) -> [String; 10] {
    let pixel = frame.pixel(light.position);
    let [r, g, b] = light.flux.map(short);
    let (x, y) = (format!("{:.4}", light.position.x), format!("{:.4}", light.position.y));
    let (column, row) = (format!("{:.1}", pixel.x), format!("{:.1}", pixel.y));
    [number.to_string(), x, y, column, row, r, g, b, format!("{:.4}", light.size), format!("{:.2}", 100.0 * share)]
}

fn summary(found: &Found, options: &FindOptions) -> String {
    let told = if found.regions == 0 {
        format!("No lights: {}.", found::none(found))
    } else {
        let (by, threshold, rule) = (found.by, short(found.threshold), found::rule(found));
        let (regions, lights, merged) = (found.regions, found.lights.len(), found.merged());
        let beyond = found::beyond(found).map_or(String::new(), |beyond| format!("\nBeyond them: {beyond}."));
        format!(
            "Threshold of the {by} {threshold}, {rule}. {regions} regions: {lights} lights, {merged} merged.{beyond}"
        )
    };
    match found::fireflies(found, options) {
        Some(fireflies) => format!("{told}\nFireflies: {fireflies}."),
        None => told,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{find, read_lights, read_lights_in};

    #[derive(clap::Parser)]
    struct Cli {
        #[command(flatten)]
        args: Args,
    }

    fn parsed(args: &[&str]) -> Result<Args, clap::Error> {
        clap::Parser::try_parse_from(["lights"].iter().chain(args)).map(|Cli { args }| args)
    }

    fn found() -> (Found, Frame) {
        let frame = Frame::full(40, 20);
        let mut pixels = vec![[0.1, 0.1, 0.1, 1.0]; 800];
        pixels[2 * 40 + 30] = [900.1, 800.2, 700.3, 1.0];
        pixels[12 * 40 + 5] = [50.0, 30.0, 0.0, 1.0];
        pixels[18 * 40 + 5] = [500.0, 30.0, 0.0, 1.0];
        let options = FindOptions { max_lights: 2, ..FindOptions::VERSION_1 };
        (find(&pixels, &frame, [0.2126, 0.7152, 0.0722], &options), frame)
    }

    fn printed(print: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> String {
        let mut out = Vec::new();
        print(&mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn options_are_those_given_or_the_librarys() {
        let options = |args: &[&str]| parsed(args).unwrap().find.over(FindOptions::default());
        assert_eq!(options(&["a.exr"]), FindOptions::default());
        let given =
            options(&["a.exr", "--threshold", "2.5", "--merge", "0", "--max-lights", "7", "--firefly-limit", "1"]);
        assert_eq!(
            given,
            FindOptions {
                threshold: Some(2.5),
                merge: 0.0,
                max_lights: 7,
                firefly_limit: 1.0,
                ..FindOptions::default()
            }
        );
        for bad in [
            ["--threshold", "nan"],
            ["--threshold=-1", "--json"],
            ["--merge", "inf"],
            ["--max-lights", "-1"],
            ["--firefly-limit", "0.5"],
        ] {
            assert!(parsed(&["a.exr", bad[0], bad[1]]).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn the_json_is_read_back_bit_for_bit() {
        let (found, _) = found();
        let path = tempfile::NamedTempFile::new().unwrap().into_temp_path();
        std::fs::write(&path, printed(|out| json(out, &found, LengthUnit::Diagonal))).unwrap();
        assert_eq!(found.lights.len(), 2);
        assert_eq!(read_lights(&path).unwrap(), found.lights);
        assert_eq!(read_lights_in(&path, LengthUnit::Diagonal).unwrap(), found.lights);
        let said = read_lights_in(&path, LengthUnit::Height).unwrap_err().to_string();
        assert!(said.contains("`diagonal`") && said.contains("`height`"), "{said}");
    }

    #[test]
    fn the_table_has_a_row_for_each_light_and_a_summary() {
        let (found, frame) = found();
        let text = printed(|out| table(out, &found, &FindOptions::default(), &frame));
        assert!(text.contains("30.0") && text.contains("18.0"), "{text}");
        let summary: Vec<_> = text.lines().rev().take(2).collect();
        assert!(summary[1].contains("3 regions: 2 lights, 0 merged."), "{text}");
        assert!(summary[0].starts_with("Beyond them: 1 fainter one left out, "), "{text}");
    }

    #[test]
    fn a_photo_without_lights_says_so() {
        let frame = Frame::full(2, 2);
        let found = find(&[[0.5; 4]; 4], &frame, [0.2126, 0.7152, 0.0722], &FindOptions::default());
        let text = printed(|out| table(out, &found, &FindOptions::default(), &frame));
        assert!(text.starts_with("No lights: nothing stands out: ") && text.lines().count() == 1, "{text}");
    }
}
