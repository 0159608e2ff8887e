//! The veil: every pixel of a photo scatters light over all others, by a radial point-spread function.
//!
//! At pixel b it is V(b) = Σ L(a) Ω k(θ_ab) over all pixels a ≠ b, angles between pixel centres. A [`Kernel`] gives k and
//! a mixture of Gaussians that comes close to it; [`Plan::new`] decides how to sum the mixture on a picture of some size,
//! and bounds how far what it sums is from k; [`Plan::evaluate`] does it. [`mod@reference`] has the sum itself, in 64 bits.
//!
//! # Method
//!
//! Wide Gaussians are smooth, and are summed on coarse lattices. Cubic B-splines are refinable, so that the moments of the
//! photo against splines of pitch 2, 4, 8, … pixels follow from each other exactly; on each lattice a few Gaussians are
//! convolved by short separable kernels, from which the splines' own smoothing is divided out; and the transposed steps
//! bring the sums back to the pixels ([`sweep`]). Narrow Gaussians are convolved on the pixels, and a small kernel
//! that is not separable adds what is missing near a source, which makes near offsets exact.
//!
//! What no mixture of positive Gaussians follows, and any tolerance down to 10⁻⁷, is convolved by a transform in 64 bits; so is what
//! costs less that way (`transform`). [`Plan::for_profile`] takes functions without a mixture, [`Plan::for_picture`] a
//! [`Picture`]: both are for planes.
//!
//! # Accuracy
//!
//! It is relative to the *local* veil. As no source is negative, |realised − wanted| ≤ ε · wanted at every offset makes the
//! same of the sum. The realised kernel depends on the offset and on where the source lies between lattice points; the
//! plan encloses both ([`plan`]). Sums are of positive terms, so that 32-bit floats round relative to the local veil as
//! well. Two things are not: the pixel's own light, which the lattices cannot leave out and which is subtracted; and a veil
//! darker than [`FLOOR`] of its channel's largest, which counts as that. Where the former could harm, in the rare lonely
//! pixel far brighter than its own veil, the channel is summed once more in 64 bits. A transform rounds relative to the whole photo:
//! [`Veil::certified`] says what that comes to in the veil of one.

mod error;
mod evaluate;
mod geometry;
mod kernel;
mod photo;
mod picture;
pub mod plan;
pub mod reference;
mod rings;
mod simd;
mod sphere;
pub mod sweep;
mod transform;

#[cfg(test)]
mod tests;

pub use error::Error;
pub use evaluate::Veil;
pub(crate) use evaluate::{Labour, Lights, OnDevice};
pub use geometry::{Border, Geometry};
pub use kernel::{Gaussian, Kernel, Mixture};
pub(crate) use photo::Sources;
pub use photo::{BadSources, Photo};
pub use picture::{Energy, Picture};
pub(crate) use plan::{Layers, Near, PERIOD, Placed};
pub use plan::{Method, Plan, Predicted};
pub(crate) use rings::Tabled;
pub(crate) use simd::{Plane, Real};
pub use transform::MOST_MEMORY;

/// A veil below this share of its channel's largest is held to the tolerance of that share, and not of itself.
pub const FLOOR: f64 = 1e-9;
