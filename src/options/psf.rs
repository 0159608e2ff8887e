//! What a person says of a point-spread function.

use std::path::PathBuf;

use clap::ValueEnum as _;

use crate::options::ApertureArgs;
use crate::options::numbers::{colour, finite, positive};
use crate::photo::WhiteLuminance;
use crate::psf::{Fault, Luminance, Name, Parameters};
use crate::scene::absolute;
use crate::{Error, Result};

/// The keys of point-spread functions. Each function takes its own.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct PsfArgs {
    /// Of cie, cie135, stiles-holladay: the observer's age in years, 0 to 120 [default: 25]
    #[arg(long, value_name = "YEARS", allow_hyphen_values = true, value_parser = finite)]
    age: Option<f64>,

    /// Of cie, cie135: the pigment of the observer's eyes, 0 (black) over 0.5 (brown) to 1.2 (light blue) [default: 0.5]
    #[arg(long, value_name = "P", allow_hyphen_values = true, value_parser = finite)]
    pigment: Option<f64>,

    /// Of spencer: what the eye is adapted to [default: photopic]
    #[arg(long, value_enum)]
    adaptation: Option<Luminance>,

    /// What white, 1,1,1, of the photo is in cd/m²: a number above 0, or `file` for what the photo's file says, a Radiance picture by
    /// its format, too [default: what the file names, if anything]. photopic, mesopic and scotopic are --adaptation's older spelling
    #[arg(long, value_name = "CD_M2|file", allow_hyphen_values = true, value_parser = luminance)]
    luminance: Option<LuminanceArg>,

    /// Of gaussian: the standard deviation, in the look's unit
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = finite)]
    width: Option<f64>,

    /// Of mixture: standard deviations, in the look's unit
    #[arg(long, value_name = "W,W,...", value_delimiter = ',', allow_hyphen_values = true, value_parser = finite)]
    widths: Option<Vec<f64>>,

    /// Of mixture: how much light each Gaussian has of it, as ratios [default: all as much]
    #[arg(long, value_name = "E,E,...", value_delimiter = ',', allow_hyphen_values = true, value_parser = finite)]
    weights: Option<Vec<f64>>,

    /// Of mixture: the colour of each Gaussian [default: all white]
    #[arg(long, value_name = "R,G,B;R,G,B;...", value_delimiter = ';', allow_hyphen_values = true, value_parser = colour)]
    tints: Option<Vec<[f64; 3]>>,

    /// Of abg: a / (b + r^g), r in the look's unit, up to the radius END, nothing beyond; below g = 2.05 there must be one
    #[arg(long, value_name = "A,B,G[,END]", allow_hyphen_values = true, value_parser = tail)]
    abg: Option<Tail>,

    /// Of table: a CSV file of radius, in the look's unit, and value; nothing beyond its last row
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,

    /// Of kernel: a picture of the point's light
    #[arg(long, value_name = "FILE")]
    kernel: Option<PathBuf>,

    /// Of starburst: degrees that the iris is turned by against the clock, from a corner on the right [default: 0]
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true, value_parser = finite)]
    rotation: Option<f64>,

    /// Of starburst: how far its blades are bent, from 0, straight, to 1, a circle [default: 0]
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = finite)]
    roundness: Option<f64>,

    /// The share of the light that is scattered, above 0 and at most 1 [default: the function's own]; of starburst, what the lens
    /// scatters besides [default: 0]
    #[arg(long, value_name = "F", allow_hyphen_values = true, value_parser = finite)]
    scatter: Option<f64>,
}

/// `--luminance`.
#[derive(Debug, Clone, Copy, PartialEq)]
enum LuminanceArg {
    /// Of the photo's white.
    White(WhiteLuminance),
    /// What is now `--adaptation`.
    Adaptation(Luminance),
}

fn luminance(text: &str) -> std::result::Result<LuminanceArg, String> {
    if text == "file" {
        return Ok(LuminanceArg::White(WhiteLuminance::File));
    }
    if let Ok(adaptation) = Luminance::from_str(text, false) {
        return Ok(LuminanceArg::Adaptation(adaptation));
    }
    let number = positive(text).ok().filter(|&number| (number as f32).is_normal());
    number.map(|number| LuminanceArg::White(WhiteLuminance::Given(number))).ok_or_else(|| {
        "expected cd/m² of the photo's white, a positive finite number, or file (or photopic, mesopic, scotopic, as --adaptation has it)"
            .to_owned()
    })
}

/// `--abg`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Tail([f64; 3], Option<f64>);

fn tail(text: &str) -> std::result::Result<Tail, String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| finite(part.trim()).ok()).collect();
    match (numbers[..].first_chunk(), numbers.len(), text.split(',').count()) {
        (Some(&tail), 3, 3) => Ok(Tail(tail, None)),
        (Some(&tail), 4, 4) => Ok(Tail(tail, Some(numbers[3]))),
        _ => Err("expected three or four finite numbers, like 1e-4,1e-3,2.5".to_owned()),
    }
}

impl PsfArgs {
    /// What is given wins over what was said before.
    pub fn over(&self, before: Parameters, aperture: &ApertureArgs) -> Parameters {
        let Self { age, pigment, width, widths, weights, tints, abg, table, kernel, .. } = self.clone();
        let Self { rotation, roundness, scatter, .. } = *self;
        // Those of other functions may be a lens's.
        let ApertureArgs { fstop, blades, sensor } = match before.psf {
            Name::Starburst => *aperture,
            _ => ApertureArgs::default(),
        };
        let sensor = sensor.map(|[width, _]| width);
        let (tail, end) = abg.map_or((None, None), |Tail(tail, end)| (Some(tail), end));
        let file = |given: Option<PathBuf>, before| given.map(|path| absolute(&path)).or(before);
        Parameters {
            psf: before.psf,
            age: age.or(before.age),
            pigment: pigment.or(before.pigment),
            luminance: self.adaptation().or(before.luminance),
            width: width.or(before.width),
            widths: widths.or(before.widths),
            weights: weights.or(before.weights),
            tints: tints.or(before.tints),
            a: tail.map(|[a, _, _]| a).or(before.a),
            b: tail.map(|[_, b, _]| b).or(before.b),
            g: tail.map(|[_, _, g]| g).or(before.g),
            end: if abg.is_some() { end } else { before.end },
            table: file(table, before.table),
            kernel: file(kernel, before.kernel),
            fstop: fstop.or(before.fstop),
            blades: blades.or(before.blades),
            rotation: rotation.or(before.rotation),
            roundness: roundness.or(before.roundness),
            sensor: sensor.or(before.sensor),
            scatter: scatter.or(before.scatter),
        }
    }

    /// What the eye is adapted to, by either spelling.
    fn adaptation(&self) -> Option<Luminance> {
        self.adaptation.or(match self.luminance {
            Some(LuminanceArg::Adaptation(adaptation)) => Some(adaptation),
            _ => None,
        })
    }

    /// What the photo's white is in cd/m², where that is given.
    pub fn white_luminance(&self) -> Option<WhiteLuminance> {
        match self.luminance {
            Some(LuminanceArg::White(white)) => Some(white),
            _ => None,
        }
    }

    /// Whether nothing is given of a function.
    pub fn is_empty(&self) -> bool {
        let Self { age, pigment, width, widths, weights, tints, abg, table, kernel, .. } = self;
        let Self { rotation, roundness, scatter, .. } = self;
        [age, pigment, width, rotation, roundness, scatter].iter().all(|number| number.is_none())
            && self.adaptation().is_none()
            && [widths, weights].iter().all(|list| list.is_none())
            && tints.is_none()
            && abg.is_none()
            && [table, kernel].iter().all(|file| file.is_none())
    }

    /// The files that the function is read from.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.table.iter().chain(&self.kernel)
    }
}

/// What is wrong with a function, by the option that says it, or by the file that cannot be read.
pub fn wrong(fault: &Fault) -> Error {
    if let Some(path) = &fault.unread {
        return Error::scene_file(path, &fault.reason);
    }
    let option = match fault.key {
        "a" | "b" | "g" | "end" => "abg",
        "psf" => "veil",
        "luminance" => "adaptation",
        key => key,
    };
    Error::Usage(format!("--{option}: {}", fault.reason))
}

/// A result whose fault names an option.
pub fn told<T>(result: std::result::Result<T, Fault>) -> Result<T> {
    result.map_err(|fault| wrong(&fault))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_luminance_is_a_number_or_the_files_or_an_older_word() {
        let white = |white| Ok(LuminanceArg::White(white));
        assert_eq!(luminance("250"), white(WhiteLuminance::Given(250.0)));
        assert_eq!(luminance("file"), white(WhiteLuminance::File));
        assert_eq!(luminance("scotopic"), Ok(LuminanceArg::Adaptation(Luminance::Scotopic)));
        for bad in ["", "0", "-1", "nan", "inf", "1e300", "1e-300", "bright", "File"] {
            assert!(luminance(bad).is_err_and(|told| told.contains("cd/m²")), "{bad}");
        }
        let older = PsfArgs { luminance: Some(LuminanceArg::Adaptation(Luminance::Mesopic)), ..PsfArgs::default() };
        let newer = PsfArgs { adaptation: Some(Luminance::Mesopic), ..PsfArgs::default() };
        for args in [older, newer] {
            let parameters = args.over(Parameters::new(Name::Spencer), &ApertureArgs::default());
            assert_eq!((parameters.luminance, args.white_luminance()), (Some(Luminance::Mesopic), None));
            assert!(!args.is_empty());
        }
        let scale = PsfArgs { luminance: Some(LuminanceArg::White(WhiteLuminance::File)), ..PsfArgs::default() };
        assert!(scale.is_empty() && scale.white_luminance().is_some());
    }

    #[test]
    fn a_tail_has_three_or_four_numbers() {
        assert_eq!(tail("1e-4, 1e-3,2.5"), Ok(Tail([1e-4, 1e-3, 2.5], None)));
        assert_eq!(tail("1,2,3,4"), Ok(Tail([1.0, 2.0, 3.0], Some(4.0))));
        for bad in ["", "1,2", "1,2,3,4,5", "1,x,3", "1,2,3,nan", "1,,2,3"] {
            assert!(tail(bad).is_err(), "{bad}");
        }
    }
}
