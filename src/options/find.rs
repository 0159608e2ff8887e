//! Which pixels of a photo are lights.

use super::numbers::{factor, not_negative};
use crate::choices::{Beyond, LightBy, LightShape};
use crate::scene::{FindOptions, Recover};

/// What counts as a light in a photo.
#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Lights in the photo")]
pub struct FindArgs {
    /// What tells light from the rest: a pixel's brightest channel, by which a red lamp is as bright as a white one, or its
    /// luminance [default: brightest]
    #[arg(long, value_enum, value_name = "WHAT")]
    by: Option<LightBy>,

    /// Pixels of this brightness or more are light: scene-linear, in the photo's unit, 0 or more. By default the value
    /// that splits the photo's flux best into light and scene, at least 4 times its mean. Where every pixel is a source, only what
    /// is brighter shines
    #[arg(long, value_name = "L", allow_hyphen_values = true, value_parser = not_negative)]
    threshold: Option<f64>,

    /// Regions that are this close to a brighter one join it, in the look's unit (see --unit); 0 merges none
    /// [default: 0.02]
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = not_negative)]
    merge: Option<f64>,

    /// What a light is that is long, bent or hollow: several that keep its shape, or one ball [default: kept]
    #[arg(long, value_enum, value_name = "HOW")]
    shape: Option<LightShape>,

    /// At most so many lights, the brightest; who says how many means --sources lights [default: 4096]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    max_lights: Option<usize>,

    /// What becomes of the others: each joins the nearest light that is kept, or they are left out [default: join]
    #[arg(long, value_enum, value_name = "HOW")]
    beyond: Option<Beyond>,

    /// A single pixel that is more than so many times as bright as each of its neighbours is a firefly or a hot pixel,
    /// and no light; 0 takes it as it is [default: 1000]
    #[arg(long, value_name = "F", allow_hyphen_values = true, value_parser = factor)]
    firefly_limit: Option<f64>,

    /// How soft a threshold is: pixels begin to shine so far below it, and so far above it all of them shines that is above it, so
    /// that a lamp which flickers around it does not come and go at once. Where every pixel is a source the threshold is one of its brightest
    /// channel; lights that are found shine in full from the threshold on where this is 0 [default: 0]
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = not_negative)]
    knee: Option<f64>,

    /// How many stops brighter than they are shown clipped highlights shine, 0 to 20: as lights, as pixels of the whole photo and in
    /// a veil, while the picture keeps what it shows. `auto` guesses it for pictures for displays, as 8-bit files are, and leaves
    /// others alone; `none` leaves all alone [default: auto]
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true)]
    recover: Option<Recover>,
}

impl FindArgs {
    /// Whether lights are counted, which means that there are some.
    pub fn counts_lights(&self) -> bool {
        self.max_lights.is_some()
    }

    /// What is given wins over what was set before.
    pub fn over(&self, set: FindOptions) -> FindOptions {
        FindOptions {
            by: self.by.unwrap_or(set.by),
            threshold: self.threshold.or(set.threshold),
            merge: self.merge.unwrap_or(set.merge),
            shape: self.shape.unwrap_or(set.shape),
            max_lights: self.max_lights.unwrap_or(set.max_lights),
            beyond: self.beyond.unwrap_or(set.beyond),
            firefly_limit: self.firefly_limit.unwrap_or(set.firefly_limit),
            knee: self.knee.unwrap_or(set.knee),
            recover: self.recover.unwrap_or(set.recover),
        }
    }
}
