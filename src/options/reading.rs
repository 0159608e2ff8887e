//! How photos are read.

use clap::ValueEnum;
use glam::DVec2;

use crate::Result;
use crate::options::numbers::finite;
use crate::photo::{MAX_PIXELS, Missing, Primaries, ReadOptions, WhiteLuminance};

/// How photos are read.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Reading")]
pub struct ReadArgs {
    /// The primaries of the photo's numbers, whatever its file says of them: rec709, p3-d65, rec2020, adobe-rgb,
    /// prophoto, acescg, aces2065-1, xyz, or the chromaticities RX,RY,GX,GY,BX,BY,WX,WY [default: the file's]
    #[arg(long, value_name = "NAME", value_parser = primaries)]
    primaries: Option<Primaries>,

    /// What becomes of pixels that an unfinished OpenEXR file lacks
    #[arg(long, value_enum, default_value_t = MissingArg::Refuse)]
    missing: MissingArg,

    /// What part of the file's width and height lies beyond each edge of the picture, from 0 to below 0.5: what is there shines, so that a
    /// lamp that leaves the picture fades, but only OpenEXR keeps it, beyond its display window [default: 0]
    #[arg(long, value_name = "F", value_parser = overscan, allow_hyphen_values = true)]
    overscan: Option<f64>,

    /// The most pixels that a photo's file may say it has, from 1 to 536870912; a larger one is refused before memory is taken
    #[arg(long, value_name = "N", default_value_t = MAX_PIXELS as u64, value_parser = clap::value_parser!(u64).range(1..=MAX_PIXELS as u64))]
    max_pixels: u64,
    /// The part of an OpenEXR file that the picture is in, by name or by number, from 0 on [default: see docs/photos.md]
    #[arg(long, value_name = "NAME|NUMBER")]
    part: Option<String>,

    /// The layer of an OpenEXR file that is the picture, as beauty where its channels are beauty.R, beauty.G and beauty.B; the others stay as
    /// they are. `vglare info` lists them. '' is the one without a name [default: see docs/photos.md]
    #[arg(long, value_name = "NAME")]
    layer: Option<String>,
}

/// `--missing`.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum MissingArg {
    /// The file is refused
    Refuse,
    /// They are 0
    Zero,
}

impl ReadArgs {
    /// The library's options, for a photo whose white is so many cd/m², where that is given.
    pub fn of_white(&self, white_luminance: Option<WhiteLuminance>) -> ReadOptions {
        ReadOptions { white_luminance, ..self.options() }
    }

    /// The library's options.
    pub fn options(&self) -> ReadOptions {
        let missing = match self.missing {
            MissingArg::Refuse => Missing::Refuse,
            MissingArg::Zero => Missing::Zero,
        };
        let overscan = self.overscan.unwrap_or(0.0);
        ReadOptions {
            missing,
            primaries: self.primaries,
            overscan,
            max_pixels: Some(self.max_pixels as usize),
            part: self.part.clone(),
            layer: self.layer.clone(),
            ..ReadOptions::default()
        }
    }
}

/// Less than what would leave nothing.
fn overscan(text: &str) -> Result<f64, String> {
    let part = finite(text)?;
    if (0.0..0.5).contains(&part) { Ok(part) } else { Err("expected a number from 0 to below 0.5".into()) }
}

/// Primaries by a name, or by eight chromaticities.
fn primaries(text: &str) -> Result<Primaries, String> {
    if let Some(primaries) = Primaries::named(text) {
        return Ok(primaries);
    }
    let numbers: Result<Vec<f64>, String> = text.split(',').map(|part| finite(part.trim())).collect();
    let numbers = numbers.ok().and_then(|numbers| <[f64; 8]>::try_from(numbers).ok());
    let points = numbers.map(|n| [0, 2, 4, 6].map(|k| DVec2::new(n[k], n[k + 1])));
    let span = points.and_then(|[red, green, blue, white]| Primaries { red, green, blue, white }.sound());
    let names = Primaries::NAMES.map(|(name, _)| name).join(", ");
    span.ok_or_else(|| {
        format!("expected one of {names}, or eight chromaticities that span a colour space, RX,RY,GX,GY,BX,BY,WX,WY")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn primaries_are_named_or_listed() {
        assert_eq!(primaries("acescg").unwrap(), Primaries::ACESCG);
        assert_eq!(primaries("0.64,0.33, 0.30,0.60, 0.15,0.06, 0.3127,0.3290").unwrap(), Primaries::REC709);
        for bad in ["aces", "0.64,0.33", "0.3,0.3,0.3,0.3,0.3,0.3,0.3,0.3", "nan,0,0,0,0,0,0,0", ""] {
            assert!(primaries(bad).unwrap_err().contains("rec2020"), "{bad}");
        }
    }
}
