//! Light from outside the frame: what a lens scatters over a picture of all that its camera does not see.
//!
//! A photo knows its own light alone. A panorama of the place knows the rest: the veil at a pixel in the direction u gets
//!
//! ```text
//! V(u) = ∫ L(v) A(v) k(∠(u, v)) dΩ      over all v that the stored pixels do not show
//! ```
//!
//! L the panorama's radiance, even within each of its pixels, k the point-spread function per steradian, and A what a hood lets
//! through: [`Sight::accepts`]. Stored are the picture and a band around it ([`band`]), whose pixels are the photo's as far as
//! glare goes: what is next to the frame, where k is steep, is computed as all of a photo's veil is, and nothing counts twice.
//!
//! What lies beyond the band is summed by a tree over the panorama, built once: each cell has its light, where that lies and how
//! far it is spread, by colours, so that a cell that is far enough from a pixel counts at once, to the second order (Barnes and
//! Hut, "A hierarchical O(N log N) force-calculation algorithm", Nature 324, 1986). For a camera only those cells are made anew that
//! the band's edge, the hood, or the border between two zones cuts. Sums are of positive terms, without a difference, in few
//! directions, since no light is near; between them go polynomials.
//!
//! | module | what it does |
//! | --- | --- |
//! | `sight` | what a camera sees, what its hood accepts of the rest |
//! | `tree` | a panorama → cells of light |
//! | `cut` | what of the cells lies outside of a sight |
//! | `clip` | what of a pixel at its edge does |
//! | `sum` | cells → their veil in a direction, with its bound |
//! | `lanes` | the same in a tile of directions at once |
//! | `plan` | in which directions of a picture that is, and what goes between them |
//! | `field` | the veil of a whole picture |
//! | `lamps` | what is bright and small in a panorama, as lights beside a picture |
//! | `reference` | the veil by definition |

mod clip;
mod cut;
mod field;
mod lamps;
mod lanes;
mod plan;
mod reference;
mod sight;
mod sum;
#[cfg(test)]
mod tests;
mod tree;

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use crate::frame::Frame;
use crate::motion::Panorama;
use crate::scene::{FindOptions, Light};

use cut::{Cut, Whole, Zone};
pub use field::{Field, StrayError};
use lamps::Lamp;
pub use plan::StrayPlan;
pub use sight::{HOODS, Sight, USUAL_HOOD, band};
use tree::Tree;

/// A panorama, ready to be looked at by any camera.
pub struct Environment {
    panorama: Panorama,
    tree: Tree,
    lamps: Vec<Lamp>,
}

/// What of an environment a camera does not see.
pub struct Outside<'a> {
    environment: &'a Environment,
    sight: Sight,
    plan: Option<Arc<StrayPlan>>,
    /// By the plan's zones; without one, of all of it.
    cuts: Vec<Cut>,
}

impl Environment {
    /// Of a panorama, in which lights are found by `find`. Time and memory go with its pixels, and it is done once.
    pub fn new(panorama: Panorama, find: &FindOptions) -> Self {
        let (tree, lamps) = rayon::join(|| Tree::new(panorama.photo()), || lamps::found(panorama.photo(), find));
        Self { panorama, tree, lamps }
    }

    /// The panorama.
    pub fn panorama(&self) -> &Panorama {
        &self.panorama
    }

    /// What a camera does not see: as much work as there are cells at the edge of its picture. `plan` says how its veil is summed, where
    /// that is wanted.
    pub fn outside(&self, sight: Sight, plan: Option<Arc<StrayPlan>>) -> Outside<'_> {
        let all = Zone { shown: sight.shown(), inner: None, outer: None };
        let zones =
            plan.as_ref().map_or_else(|| vec![all], |plan| plan.layers.iter().map(|layer| layer.zone).collect());
        let whole = Whole { photo: self.panorama.photo(), tree: &self.tree };
        let cuts = zones.par_iter().map(|zone| Cut::new(whole, &sight, zone)).collect();
        Outside { environment: self, sight, plan, cuts }
    }
}

impl Outside<'_> {
    /// Columns and rows beyond each edge of the picture that are seen.
    pub fn beyond(&self) -> [u32; 2] {
        self.sight.beyond()
    }

    /// The light from outside that the hood accepts, RGB: ∫ L A dΩ, in the panorama's unit times steradians.
    pub fn flux(&self) -> [f64; 3] {
        self.all(Cut::flux)
    }

    /// What of it an even share puts on the picture, as radiance, RGB: `share` of all light that falls into the lens from outside,
    /// ∫ L A cos ψ dΩ, is spread evenly over the picture, which by itself gets ∫ L cos ψ dΩ; ψ is the angle from the axis.
    pub fn even(&self, share: f64) -> [f64; 3] {
        let into = self.all(|cut| cut.towards(self.sight.ahead()));
        into.map(|light| share * light / self.sight.projected())
    }

    /// Lights outside of the picture and its band, in front of the camera, as a look has lights: places and sizes on the picture's
    /// plane in the frame's unit, flux as radiance times area there. What of a light lies in the band is left to its pixels.
    pub fn lights(&self, frame: &Frame) -> Vec<Light> {
        lamps::beside(&self.environment.lamps, &self.sight, frame)
    }

    /// The veil of all that light on the picture, where it was planned.
    pub fn veil(&self) -> Option<Field> {
        let plan = self.plan.as_ref()?;
        Some(Field::new(&self.environment.tree, &self.cuts, &self.sight, plan))
    }

    /// How exact its veil is: at some pixels, against the definition in 64-bit floats.
    pub fn measured(&self, field: &Field) -> StrayError {
        let photo = self.environment.panorama.photo();
        let sources = photo.pixels.len();
        let directions: Vec<DVec3> =
            field.samples(sources).into_iter().map(|place| self.sight.direction(place)).collect();
        let truth = reference::at(photo, &self.sight, field.psf(), &directions);
        field.held_against((&self.environment.tree, &self.cuts), sources, &directions, &truth)
    }

    fn all(&self, of: impl Fn(&Cut) -> [f64; 3]) -> [f64; 3] {
        let add = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[k] + b[k]);
        self.cuts.iter().map(of).fold([0.0; 3], add)
    }
}
