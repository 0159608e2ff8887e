//! How a lens that is known by its surfaces is set.

use std::path::Path;

use crate::optics::Coating;
use crate::options::numbers::positive;
use crate::scene::{NamedLens, OpticsSection, named_lens};
use crate::{Error, Result};

/// What a photographer sets at a lens.
#[derive(Debug, Default, Clone, clap::Args)]
#[command(next_help_heading = "Lens")]
pub struct OpticsArgs {
    /// The f-number to which a lens of surfaces is stopped down; wide open without it
    #[arg(long, value_name = "N", value_parser = positive)]
    fstop: Option<f64>,

    /// What such a lens is focused on, in metres from the sensor; infinity without it
    #[arg(long, value_name = "METRES", value_parser = positive)]
    focus: Option<f64>,

    /// The sensor behind such a lens, in mm; the picture's longer side spans the longer side of it [default: 36x24]
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = sensor)]
    sensor: Option<[f64; 2]>,

    /// Blades of the iris of such a lens, 3 to 16, or 0 for a round one; they show when it is stopped down
    #[arg(long, value_name = "COUNT")]
    blades: Option<u32>,

    /// The coating of all surfaces of such a lens between glass and air
    #[arg(long, value_name = "NAME", value_parser = Coating::NAMES)]
    coating: Option<String>,

    /// Which setting of a zoom, by its name
    #[arg(long, value_name = "NAME")]
    setting: Option<String>,
}

impl OpticsArgs {
    /// What is set, of no lens.
    pub fn section(&self) -> OpticsSection {
        let Self { fstop, focus, sensor, blades, coating, setting } = self.clone();
        OpticsSection { lens: None, file: None, fstop, focus, sensor, blades, coating, setting }
    }

    /// The lens of this name or path, set like this.
    ///
    /// # Errors
    /// Those of [`named_lens`].
    pub fn lens(&self, name: &Path) -> Result<NamedLens> {
        named_lens(name, &self.section())
    }

    /// That nothing is set where there is no such lens.
    ///
    /// # Errors
    /// [`Error::Usage`] where something is.
    pub fn without_lens(&self) -> Result<()> {
        if self.section().sets() {
            return Err(Error::Usage(
                "--fstop, --focus, --sensor, --blades, --coating and --setting set a lens that is known by its surfaces: name one by --lens \
                 (vglare lens lists them)"
                    .into(),
            ));
        }
        Ok(())
    }
}

/// Two lengths in mm, as 36x24.
fn sensor(text: &str) -> Result<[f64; 2], String> {
    let parts: Vec<f64> = text.split(['x', 'X', '×', ',']).filter_map(|part| part.trim().parse().ok()).collect();
    match parts[..] {
        [width, height] if width > 0.0 && height > 0.0 && f64::max(width, height) <= 1e4 => Ok([width, height]),
        _ => Err("expected width and height in mm, as 36x24".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sensor_is_two_lengths() {
        assert_eq!([sensor("36x24"), sensor("23.5×15.6")], [Ok([36.0, 24.0]), Ok([23.5, 15.6])]);
        for wrong in ["36", "36x", "36x24x3", "0x24", "-1x2", "infx2", "NaNxNaN", "ax3"] {
            assert!(sensor(wrong).is_err(), "{wrong}");
        }
    }
}
