//! How the glare is laid over the photo.

use crate::choices::{Mix, Normalize};
use crate::look::Look;
use crate::options::numbers::{colour, not_negative, positive};

/// How the glare is laid over the photo.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Look")]
pub struct LookArgs {
    /// What the glare is multiplied by, 0 or more; 0 writes the photo as it is [default: 1]
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = not_negative)]
    strength: Option<f64>,

    /// What the size of every ghost, and of a veil on the picture's plane, is multiplied by, above 0; its light stays as much as it
    /// is [default: 1]
    #[arg(long, value_name = "F", allow_hyphen_values = true, value_parser = positive)]
    size: Option<f64>,

    /// What the colour of every ghost is multiplied by, 0 or more each [default: 1,1,1]
    #[arg(long, value_name = "R,G,B", allow_hyphen_values = true, value_parser = colour)]
    tint: Option<[f64; 3]>,

    /// Whether the ghosts' light is added, or taken from the photo's lights [default: add]. A veil takes its light from every
    /// pixel, unless `add` is asked for
    #[arg(long, value_enum)]
    mix: Option<Mix>,

    /// What becomes of the glare's values before they are added: nothing, clamped to 0..1, or stretched to 0..1 by the
    /// smallest and the largest in the picture [default: none]
    #[arg(long, value_enum)]
    normalize: Option<Normalize>,
}

impl LookArgs {
    /// What is given wins over what was set before.
    pub fn over(&self, look: Look) -> Look {
        let Self { strength, size, tint, mix, normalize } = *self;
        Look {
            strength: strength.unwrap_or(look.strength),
            size: size.unwrap_or(look.size),
            tint: tint.unwrap_or(look.tint),
            // Who asks to add means the veil, too, which would take its light from the photo.
            veil: look.veil.map(|veil| match mix {
                Some(mix) => veil.adding(mix == Mix::Add),
                None => veil,
            }),
            mix: mix.unwrap_or(look.mix),
            normalize: normalize.unwrap_or(look.normalize),
            ..look
        }
    }
}
