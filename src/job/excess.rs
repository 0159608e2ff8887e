//! Glare that a slip of a strength or of a flux has made too bright for anything.

use rayon::prelude::*;

use super::Found;
use crate::choices::Normalize;
use crate::photo::Photo;
use crate::plan::Plan;

/// Glare that is more than so many times as bright as the brightest pixel is a mistake: a veil from a sun outside the
/// picture is some times as bright as a dark room.
const ABSURD: f64 = 1000.0;

impl Found<'_> {
    /// Says so where the glare is out of all proportion to the photo, which is not yet overlaid.
    pub(super) fn absurd(&self, plan: &Plan) -> Option<String> {
        let (strength, scale) = (self.look.strength, plan.scale.into_iter().fold(0.0, f64::max));
        if self.look.normalize != Normalize::None || self.scene.is_dark() {
            return None;
        }
        let peak = self.scene.found.as_ref().map_or_else(|| brightest(&self.photo), |found| found.peak);
        let times = strength * scale / peak;
        // A black photo is dark beside any glare.
        (times.is_finite() && times > ABSURD).then(|| {
            format!(
                "the glare is up to {times:.1e} times as bright as the photo's brightest pixel; is a strength of \
                 {strength:?} meant, and are the lights in the photo's unit?"
            )
        })
    }
}

/// The largest finite channel of a photo.
fn brightest(photo: &Photo) -> f64 {
    let largest = |[r, g, b, _]: &[f32; 4]| [*r, *g, *b].into_iter().filter(|c| c.is_finite()).fold(0.0, f32::max);
    photo.pixels.par_iter().map(largest).reduce(|| 0.0, f32::max).into()
}
