//! The passes on OpenGL 4.3, and the only folder with `unsafe`.
//!
//! | file | what it does |
//! | --- | --- |
//! | `context` | a device: in a window, EGL without one, or OSMesa |
//! | `layout` | what Rust and GLSL must agree on |
//! | `resource`, `shader` | GL objects that free themselves; shaders put together from `shaders/` |
//! | `pixels` | pixel buffers: pictures on their way in and out while the device works |
//! | `runner`, `timer` | runs passes and times them |
//! | `spectrum` | ghosts → A, B, C, D |
//! | `harmonics`, `evaluators` | spectrum → the function `glare(pixel)` of each evaluator |
//! | `exact` | the same in 64-bit floats, for a series |
//! | `field`, `range`, `composite` | that function → the field, its range, the picture |
//! | `local` | ghosts drawn where they reach → the canvas that `local`'s function reads |
//! | `graf` | bells on a disc → their Bessel spectrum → the function `glare(pixel)` of Graf's theorem |
//! | `coefficients` | samples of any function → its coefficients |
//! | `lines` | curves as line strips |
//! | `copy` | the yardstick of the bench |
//! | `screen`, `mask`, `paint` | where the viewer draws; what of a photo is light; egui's shapes |
//! | `shrink`, `view` | means of the picture, where it is made smaller; the picture as a display shows it |
//! | `veil` | taps along an axis, from a lattice to the finer one, and at the pixels |
//! | `precision` | how exact the driver's sin, cos and exp are, and vglare's phases |

// Calling OpenGL is unsafe; each block says what makes it sound. That a device keeps its context current on this thread rests
// on these: a device never leaves its thread; no more than one is opened on a thread at a time; one that was abandoned gives
// no functions; and who adopts a context promises it. So whatever lives on a thread is of the one device, and "its own".
#![allow(unsafe_code)]

pub(crate) mod coefficients;
pub(crate) mod composite;
mod context;
pub(crate) mod copy;
pub(crate) mod evaluators;
pub(crate) mod exact;
pub(crate) mod field;
pub(crate) mod graf;
mod harmonics;
pub(crate) mod layout;
pub(crate) mod lines;
pub(crate) mod local;
pub(crate) mod mask;
pub(crate) mod overlay;
#[cfg(feature = "window")]
pub(crate) mod paint;
pub(crate) mod pixels;
pub mod precision;
pub(crate) mod range;
pub(crate) mod resource;
pub(crate) mod runner;
mod screen;
mod shader;
pub(crate) mod shrink;
pub(crate) mod spectrum;
mod timer;
pub(crate) mod veil;
pub(crate) mod view;

#[cfg(feature = "window")]
pub use context::window::{Display, Surface, event_loop};
pub use context::{Backend, Device, Info, Limits, be_sparing};
pub use screen::{Region, Screen};
pub use timer::PassTime;

#[cfg(test)]
pub(crate) mod tests;
