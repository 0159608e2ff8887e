//! What lengths and angles are counted in.

use crate::choices::LengthUnit;
use crate::look::{Look, Veil};
use crate::options::numbers::finite;
use crate::{Error, Result};

/// What lengths and angles are counted in.
#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Scene")]
pub struct UnitArgs {
    /// What lengths are counted in, those of sizes as well as of positions [default: short-side, and of a scene or of lights from a
    /// file what that says, or height]
    #[arg(long, value_enum)]
    unit: Option<LengthUnit>,

    /// The field of view across the picture's width, in degrees, for all that is in degrees: 0.1 to 179 [default: what the
    /// photo's file says]
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true, value_parser = finite)]
    fov: Option<f64>,
}

impl UnitArgs {
    /// What is given wins over what was set before.
    pub fn over(&self, look: Look) -> Look {
        Look { unit: self.unit.unwrap_or(look.unit), fov: self.fov.or(look.fov), ..look }
    }

    /// Whether a unit is given.
    pub fn names_one(&self) -> bool {
        self.unit.is_some()
    }

    /// Whether what is given counts for anything in a look.
    ///
    /// # Errors
    /// [`Error::Usage`] for a field of view where nothing is in degrees.
    pub fn check(&self, look: &Look) -> Result<()> {
        let has_degrees = look.unit == LengthUnit::Degrees || look.veil.as_ref().is_some_and(Veil::is_in_degrees);
        if self.fov.is_none() || has_degrees {
            return Ok(());
        }
        Err(Error::Usage(
            "--fov: nothing here is in degrees: a field of view is for a veil of an eye, as --veil cie, or for --unit degrees".into(),
        ))
    }
}
