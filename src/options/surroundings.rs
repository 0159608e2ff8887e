//! Light from outside the frame.

use std::path::PathBuf;

use crate::environment::{HOODS, USUAL_HOOD};
use crate::motion::Camera;
use crate::options::numbers::{angles, finite, sides};
use crate::{Error, Result};

/// What is around a photo, and where its camera looked.
#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Surroundings")]
pub struct EnvironmentArgs {
    /// A picture of all directions around the photo, twice as wide as high: what its camera does not see of that scatters light over
    /// the photo, too. Without a photo, what its camera sees is the photo
    #[arg(long, value_name = "FILE")]
    pub environment: Option<PathBuf>,

    /// How the camera was held in it, in degrees: to the right of the panorama's centre, up, and turned clockwise [default: 0,0,0]
    #[arg(long, value_name = "YAW,PITCH,ROLL", value_parser = angles, allow_hyphen_values = true, requires = "environment")]
    view: Option<[f64; 3]>,

    /// Columns and rows of what the camera sees, where there is no photo [default: 1920x1080]
    #[arg(long, value_name = "WxH", value_parser = sides, requires = "environment", conflicts_with = "inputs")]
    frame: Option<[u32; 2]>,

    /// What of it reaches the picture.
    #[command(flatten)]
    pub hood: HoodArgs,
}

impl EnvironmentArgs {
    /// How the camera was held.
    pub fn camera(&self) -> Camera {
        let [yaw, pitch, roll] = self.view.unwrap_or_default();
        Camera { yaw, pitch, roll, fov: None }
    }

    /// Columns and rows where no photo gives them.
    pub fn sides(&self) -> [u32; 2] {
        self.frame.unwrap_or([1920, 1080])
    }

    /// Whether what is said has an environment to be of.
    ///
    /// # Errors
    /// [`Error::Usage`].
    pub fn check(&self) -> Result<()> {
        if self.environment.is_none() && !self.hood.is_empty() {
            return Err(Error::Usage(
                "--hood and --stray are of light from outside the frame: --environment names what is there".into(),
            ));
        }
        Ok(())
    }
}

/// What of the light from outside the frame reaches the picture.
#[derive(Debug, Clone, Copy, Default, PartialEq, clap::Args)]
#[command(next_help_heading = "Surroundings")]
pub struct HoodArgs {
    /// The angle from the lens's axis, in degrees, from 1 to 90, from which on a hood takes light away that comes from outside the
    /// frame: all of it ten degrees further, and at 90 [default: 80, which is no hood]
    #[arg(long, value_name = "DEGREES", value_parser = hood, allow_hyphen_values = true)]
    hood: Option<f64>,

    /// The share of the light that falls into the lens from outside the frame and ends evenly spread over the picture, by walls and
    /// edges inside, from 0 to 1: a model of it by this one number [default: 0]
    #[arg(long, value_name = "F", value_parser = share, allow_hyphen_values = true)]
    stray: Option<f64>,
}

impl HoodArgs {
    /// Whether anything is said.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The angle in degrees.
    pub fn hood(&self) -> f64 {
        self.hood.unwrap_or(USUAL_HOOD)
    }

    /// The share that is spread evenly.
    pub fn stray(&self) -> f64 {
        self.stray.unwrap_or(0.0)
    }
}

fn hood(text: &str) -> std::result::Result<f64, String> {
    finite(text).ok().filter(|angle| HOODS.contains(angle)).ok_or_else(|| "expected an angle from 1 to 90".to_owned())
}

fn share(text: &str) -> std::result::Result<f64, String> {
    finite(text)
        .ok()
        .filter(|share| (0.0..=1.0).contains(share))
        .ok_or_else(|| "expected a share from 0 to 1".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_make_no_sense_are_refused() {
        for bad in ["", "0", "90.1", "-5", "nan", "x"] {
            assert!(hood(bad).is_err(), "{bad}");
        }
        for bad in ["", "-0.1", "1.01", "inf"] {
            assert!(share(bad).is_err(), "{bad}");
        }
        assert_eq!((hood("90"), share("0.02")), (Ok(90.0), Ok(0.02)));
    }
}
