//! What is printed, and the table of numbers.

use std::fmt::Write as _;
use std::io;

use serde::Serialize;

use super::{Axis, Shown};
use crate::psf::{Mode, Profile, Row};

/// What is printed, in lines.
pub fn summary(shown: &Shown) -> String {
    let Shown { psf, range: [from, to], mixture, profile, axis } = shown;
    let ((angle, area), factor) = (shown.units(), shown.factor());
    let mut text = format!("psf      {}, from {from} to {to}{angle}\n", psf.name());
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "energy   {:.4} of the light; {:.4e} per {area} at the centre",
        psf.energy(),
        factor * psf.centre()
    );
    if let Some(Axis { fov, unit }) = axis {
        let degrees = unit.to_degrees();
        let _ = writeln!(
            text,
            "         on the axis of a picture of {fov}° across, where the look's unit is {degrees:.4}°"
        );
    }
    let places = [0.01, 0.1, 1.0, 10.0].into_iter().filter(|place| (*from..=*to).contains(place));
    let within: Vec<String> = places
        .map(|place| format!("{:.1} % within {place}{angle}", 100.0 * psf.energy_within(place) / psf.energy()))
        .collect();
    if !within.is_empty() {
        let _ = writeln!(text, "         {}", within.join(", "));
    }
    match mixture {
        Some(mixture) => {
            let _ = writeln!(
                text,
                "mixture  {} Gaussians, within {:.2e} of it from {} to {}{angle}",
                mixture.terms.len(),
                mixture.error,
                mixture.range[0],
                mixture.range[1]
            );
            for term in &mixture.terms {
                let _ = writeln!(
                    text,
                    "         sigma {:<12.6} value at its centre {:.6e}",
                    term.sigma,
                    factor * term.weight
                );
            }
            if mixture.constant != 0.0 || mixture.quadratic != 0.0 {
                let _ = writeln!(
                    text,
                    "         and {:.6e} + {:.6e} × angle², exactly",
                    mixture.constant, mixture.quadratic
                );
            }
        }
        None => {
            let _ = writeln!(text, "mixture  none: a picture is not round");
        }
    }
    let _ = writeln!(text, "rows     {} angles, {} frequencies", profile.rows.len(), profile.modes.len());
    text
}

/// As JSON; values are per `per`.
#[derive(Serialize)]
struct Json<'a> {
    vglare: &'static str,
    psf: String,
    unit: &'a str,
    per: &'a str,
    /// Degrees across the picture on whose axis the look's unit is so many degrees.
    fov: Option<f64>,
    unit_degrees: Option<f64>,
    range: [f64; 2],
    energy: f64,
    centre: f64,
    mixture: Option<MixtureJson>,
    rows: Vec<RowJson>,
    modes: Vec<ModeJson>,
}

#[derive(Serialize)]
struct MixtureJson {
    error: f64,
    range: [f64; 2],
    terms: Vec<TermJson>,
    /// What is added of the angle alone: constant + quadratic × angle².
    constant: f64,
    quadratic: f64,
}

#[derive(Serialize)]
struct TermJson {
    sigma: f64,
    value: f64,
}

#[derive(Serialize)]
struct RowJson {
    angle: f64,
    value: f64,
    mixture: f64,
    relative_error: f64,
    encircled_energy: f64,
}

#[derive(Serialize)]
struct ModeJson {
    frequency: f64,
    transform: f64,
}

/// Prints all of it, with the rows of [`csv`].
///
/// # Errors
/// Where it cannot be written.
pub fn json(out: &mut dyn io::Write, shown: &Shown) -> io::Result<()> {
    let Shown { psf, range, mixture, profile: Profile { rows, modes }, axis } = shown;
    let ((unit, per), factor) = (shown.units(), shown.factor());
    let row = |&Row { angle, value, mixture, error, encircled }: &Row| RowJson {
        angle,
        value: factor * value,
        mixture: factor * mixture,
        relative_error: error,
        encircled_energy: encircled,
    };
    let json = Json {
        vglare: env!("CARGO_PKG_VERSION"),
        psf: psf.name().to_string(),
        unit: if unit == "°" { "degrees" } else { unit.trim() },
        per,
        fov: axis.map(|axis| axis.fov),
        unit_degrees: axis.map(|axis| axis.unit.to_degrees()),
        range: *range,
        energy: psf.energy(),
        centre: factor * psf.centre(),
        mixture: mixture.as_ref().map(|mixture| MixtureJson {
            error: mixture.error,
            range: mixture.range,
            terms: mixture
                .terms
                .iter()
                .map(|term| TermJson { sigma: term.sigma, value: factor * term.weight })
                .collect(),
            constant: mixture.constant,
            quadratic: mixture.quadratic,
        }),
        rows: rows.iter().map(row).collect(),
        modes: modes.iter().map(|&Mode { frequency, transform }| ModeJson { frequency, transform }).collect(),
    };
    serde_json::to_writer_pretty(&mut *out, &json)?;
    writeln!(out)
}

/// All rows; the frequencies stand beside the angles, line by line, and have no more to do with them than that.
pub fn csv(shown: &Shown) -> String {
    let (Profile { rows, modes }, factor) = (&shown.profile, shown.factor());
    let mut text = "angle,value,mixture,relative error,encircled energy,frequency,transform\n".to_owned();
    for (Row { angle, value, mixture, error, encircled }, mode) in rows.iter().zip(modes) {
        let number = |value: f64| if value.is_nan() { String::new() } else { format!("{value:e}") };
        let line =
            [*angle, factor * value, factor * mixture, *error, *encircled, mode.frequency, mode.transform].map(number);
        let _ = writeln!(text, "{}", line.join(","));
    }
    text
}
