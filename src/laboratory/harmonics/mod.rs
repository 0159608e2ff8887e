//! `vglare harmonics`: the light of a panorama as spherical harmonics.

mod coefficients;
mod run;
mod summary;

use std::path::PathBuf;

use crate::options::ReadArgs;
use crate::options::numbers::{self, finite};
use crate::series::sphere::HIGHEST_DEGREE;

pub use run::run;

/// Turn a panorama into spherical harmonics and back
///
/// Projects an equirectangular panorama onto the real spherical harmonics up to a degree, turns them, and writes the
/// panorama that they make, or the irradiance that a matt surface facing each way gets. A low degree keeps the broad
/// light only, and rings around what is small and bright; values below 0 are part of that.
///
/// The centre of the picture is ahead (+x), its left half to the left (+y), its top up (+z).
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The panorama, twice as wide as high: OpenEXR, Radiance HDR, PFM, TIFF, PNG or JPEG
    panorama: PathBuf,

    /// The picture: .exr .hdr .pfm .tif .tiff .png .jpg .jpeg
    #[arg(short, long)]
    output: PathBuf,

    /// Highest degree, 0 to 1500 and below the panorama's rows: (L + 1)² coefficients for each colour
    #[arg(short = 'l', long, value_name = "L", default_value_t = 8, value_parser = degree)]
    degree: usize,

    /// Turn what is seen, in degrees: roll first, clockwise around what is ahead; then pitch, which lifts what is ahead;
    /// then yaw, which moves it to the left
    #[arg(long, value_name = "YAW,PITCH,ROLL", allow_hyphen_values = true, value_parser = angles)]
    rotate: Option<Angles>,

    /// Write the irradiance instead: radiance 1 all round makes π. Degree 2 gives Ramamoorthi and Hanrahan's nine
    /// coefficients: within 9.4 % of the strongest, and that only where all light comes from one point
    #[arg(long)]
    irradiance: bool,

    /// Columns and rows of the picture, twice as wide as high [default: the panorama's]
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<Size>,

    /// Write the coefficients of the picture as well, by extension: .csv or .json
    #[arg(long, value_name = "FILE")]
    coefficients: Option<PathBuf>,

    /// Write coefficients for a basis with the sign (−1)^m of Condon and Shortley
    #[arg(long, requires = "coefficients")]
    condon_shortley: bool,

    /// Turn the panorama as well, not only its coefficients, and say how far the two are apart; takes seconds, and
    /// minutes at high degrees
    #[arg(long, requires = "rotate")]
    check: bool,

    /// Exposure in stops, for PNG, JPEG and integer TIFF
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, allow_hyphen_values = true, value_parser = finite)]
    exposure: f64,

    /// Replace files that exist
    #[arg(long)]
    force: bool,

    /// Say nothing but errors and warnings
    #[arg(short, long)]
    quiet: bool,

    #[command(flatten)]
    reading: ReadArgs,
}

const EXAMPLES: &str = "\
Examples:
  vglare harmonics street.exr -o soft.exr --degree 8
  vglare harmonics street.exr -o turned.png --degree 40 --rotate 90,0,0 --check
  vglare harmonics street.exr -o light.exr --degree 2 --irradiance --size 256x128
  vglare harmonics street.exr -o soft.exr --coefficients light.csv";

/// `--rotate`: yaw, pitch, roll in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Angles([f64; 3]);

/// `--size`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Size {
    width: u32,
    height: u32,
}

fn degree(text: &str) -> Result<usize, String> {
    let degree = text.parse().ok().filter(|&l| l <= HIGHEST_DEGREE);
    degree.ok_or_else(|| format!("expected a whole number from 0 to {HIGHEST_DEGREE}"))
}

fn angles(text: &str) -> Result<Angles, String> {
    numbers::angles(text).map(Angles)
}

fn size(text: &str) -> Result<Size, String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    match sides {
        Some((width, height)) if height > 0 && Some(width) == 2u32.checked_mul(height) && height <= 16384 => {
            Ok(Size { width, height })
        }
        _ => Err("expected columns and twice as few rows, at most 32768x16384, like 1024x512".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_make_no_sense_are_refused() {
        for bad in ["-1", "1501", "2.5", "x", ""] {
            assert!(degree(bad).is_err(), "{bad}");
        }
        assert_eq!((degree("0"), degree("1500")), (Ok(0), Ok(1500)));
        for bad in ["", "512", "512x512", "0x0", "512x-256", "4294967296x2147483648", "40000x20000", "3x1"] {
            assert!(size(bad).is_err(), "{bad}");
        }
        assert_eq!(size("512x256"), Ok(Size { width: 512, height: 256 }));
    }
}
