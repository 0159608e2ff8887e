//! The laboratory: what is measured and drawn instead of applied to photos. [`chart`] draws it.
//!
//! | module | what it does |
//! | --- | --- |
//! | `page` | a page of results, and the folder that it lies in |
//! | [`rex`] | the research prototype's experiments, as figures and numbers |
//! | [`tradeoff`] | a photo and its ghosts → accuracy against time, measured here |
//! | [`psf`] | a point-spread function → its transform and its mixture of Gaussians |
//! | [`lens`] | a real lens → its surfaces, its ghosts, and drawings of both |
//! | [`harmonics`] | a photo → its spherical harmonic coefficients |
//! | [`mod@bench`] | what each pass costs here, as ratios |
//! | [`index`] | a look, or a photo of a chart → a veiling glare index |
//! | [`calibrate`] | the cost model of plans, fitted to this machine |

pub mod bench;
pub mod calibrate;
pub mod harmonics;
pub mod index;
pub mod lens;
mod page;
pub mod psf;
pub mod rex;
pub mod tradeoff;

pub use crate::chart;
