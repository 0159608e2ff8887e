//! Files of coefficients.

use std::fmt::Write as _;
use std::path::Path;

use serde::Serialize;

use super::{Angles, Args};
use crate::series::sphere::{Coefficients, Phase};
use crate::target;
use crate::{Error, Result};

/// What the coefficients are of.
#[derive(Debug, Clone, Copy, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    Radiance,
    Irradiance,
}

/// The file, as JSON.
#[derive(Serialize)]
struct Json<'a> {
    panorama: String,
    of: Kind,
    degree: usize,
    phase: Phase,
    /// Yaw, pitch, roll in degrees.
    rotation: [f64; 3],
    /// RGB, c_lm at index l(l+1)+m.
    coefficients: &'a [[f64; 3]],
}

/// Whether the file may be written: asked before the long work starts.
///
/// # Errors
/// Those of [`target::check`], and [`Error::Write`] for an extension other than .csv and .json.
pub fn check(path: &Path, overwrite: bool) -> Result<()> {
    is_csv(path)?;
    target::check(path, overwrite)
}

/// Writes coefficients, in the convention that was asked for.
///
/// # Errors
/// Those of [`check`], and [`Error::Write`] where the disk is full or the system refuses.
pub fn write(path: &Path, args: &Args, coefficients: &Coefficients, of: Kind) -> Result<()> {
    let phase = if args.condon_shortley { Phase::CondonShortley } else { Phase::Plain };
    let coefficients = coefficients.clone().in_phase(phase);
    if is_csv(path)? {
        return target::write_text(path, &csv(&coefficients), args.force);
    }
    let json = Json {
        panorama: args.panorama.display().to_string(),
        of,
        degree: coefficients.degree(),
        phase,
        rotation: args.rotate.map_or([0.0; 3], |Angles(angles)| angles),
        coefficients: coefficients.values(),
    };
    target::write_json(path, &json, args.force)
}

fn csv(coefficients: &Coefficients) -> String {
    let mut text = "l,m,red,green,blue\n".to_owned();
    for l in 0..=coefficients.degree() {
        for (m, [r, g, b]) in (-(l as isize)..).zip(coefficients.band(l)) {
            // Writing to a string cannot fail; `e` keeps tiny values short, and every bit.
            let _ = writeln!(text, "{l},{m},{r:e},{g:e},{b:e}");
        }
    }
    text
}

fn is_csv(path: &Path) -> Result<bool> {
    match path.extension().unwrap_or_default().to_string_lossy().to_lowercase().as_str() {
        "csv" => Ok(true),
        "json" => Ok(false),
        _ => Err(Error::write(path, "coefficients are written as .csv or .json")),
    }
}
