//! Which veil is taken away.

use std::path::PathBuf;

use crate::choices::Mix;
use crate::look::Look;
use crate::options::numbers::{not_negative, positive};
use crate::options::{FindArgs, OpticsArgs, SceneArgs, UnitArgs, VeilArgs};
use crate::photo::WhiteLuminance;
use crate::{Error, Result};

/// The veil that the photo has, as `vglare apply` would lay it over the clean one.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Veil")]
pub struct ModelArgs {
    /// A scene file whose veil it is (docs/scenes.md). Options win over what the file says
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,

    /// The veil of a lens, one of `vglare presets`
    #[arg(long, value_name = "NAME", conflicts_with = "lens")]
    preset: Option<String>,

    /// The veil of a lens: a preset, or a file that has one; `none` for no other than --veil says
    #[arg(long, value_name = "NAME|FILE")]
    lens: Option<PathBuf>,

    #[command(flatten)]
    veil: VeilArgs,

    #[command(flatten)]
    unit: UnitArgs,

    #[command(flatten)]
    optics: OpticsArgs,

    /// What the veil was multiplied by, 0 or more; 0 writes the photo as it is [default: 1]
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = not_negative)]
    strength: Option<f64>,

    /// What the size of a veil on the picture's plane was multiplied by, above 0 [default: 1]
    #[arg(long, value_name = "F", allow_hyphen_values = true, value_parser = positive)]
    size: Option<f64>,

    /// Whether the veil was added to a photo that kept its light, or took its light from there [default: energy]
    #[arg(long, value_enum)]
    mix: Option<Mix>,
}

impl ModelArgs {
    /// The look whose veil it is.
    ///
    /// # Errors
    /// [`Error::Usage`] where options contradict each other or no veil is named; those of files that cannot be read.
    pub fn look(&self) -> Result<Look> {
        let none = self.scene.is_none() && self.preset.is_none() && self.lens.is_none();
        let lens = if none { Some("none".into()) } else { self.lens.clone() };
        let (unit, optics) = (self.unit.clone(), self.optics.clone());
        let scene = SceneArgs::of(self.scene.clone(), self.preset.clone(), lens, unit, optics);
        let look = self.veil.over(scene.look(&FindArgs::default())?, None, &self.optics.aperture)?;
        let veil = look.veil.map(|veil| match self.mix {
            Some(mix) => veil.adding(mix == Mix::Add),
            None => veil,
        });
        let (strength, size) = (self.strength.unwrap_or(look.strength), self.size.unwrap_or(look.size));
        let look = Look { veil, strength, size, ..look };
        self.unit.check(&look)?;
        if look.veil.is_none() {
            return Err(Error::Usage(
                "there is no veil to take away: name its function by --veil, as camera, or a --preset or --scene that has one".into(),
            ));
        }
        Ok(look)
    }

    /// What the photo's white is in cd/m², where that is given.
    pub fn white_luminance(&self) -> Option<WhiteLuminance> {
        self.veil.white_luminance()
    }

    /// The files that the veil is read from, those among them that others refer to.
    pub fn files(&self) -> Vec<PathBuf> {
        let lens = self.lens.clone();
        let scene = SceneArgs::of(self.scene.clone(), None, lens, UnitArgs::default(), OpticsArgs::default());
        scene.files().into_iter().chain(self.veil.files().cloned()).collect()
    }
}

/// Says so where a look has ghosts, too.
pub fn ghosts_stay(look: &Look) -> Option<String> {
    let any = !look.lens_ghosts().is_empty() || !look.ghosts.is_empty();
    any.then(|| "the ghosts of the lens are not taken away, its veil alone is".to_owned())
}
