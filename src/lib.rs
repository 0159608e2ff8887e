//! Veiling glare for HDR photographs.
//!
//! A lens scatters bright light into many faint, wide blobs. vglare models each blob (a *ghost*) as a bell, expands
//! the sum of all of them once in a two-dimensional Fourier series on the GPU, and evaluates the series at every
//! pixel, so that a pixel's cost does not depend on how many ghosts there are.
//!
//! The data flows through the modules in this order:
//!
//! | module | from → to |
//! | --- | --- |
//! | [`choices`] | what a person chooses by name |
//! | [`photo`] | a file → linear light, RGBA f32, and back |
//! | [`frame`] | pixels ↔ the picture plane |
//! | [`scene`] | photo → lights → ghosts; presets and scene files |
//! | [`optics`] | a lens's surfaces → the ghosts of a light, by matrices and by exact rays |
//! | [`look`] | everything that a person sets: from options, from a scene file, or by hand |
//! | [`series`] | bells, their Fourier coefficients and their tails, in f64 |
//! | [`problem`] | ghosts and picture, as one thing that never changes |
//! | [`plan`] | problem, tolerance → period, degree, kept terms, evaluator, predicted error |
//! | [`gpu`] | the plan's tables and passes on OpenGL 4.3; the only folder with `unsafe` |
//! | [`renderer`] | the main path: spectrum → field → normalise → composite |
//! | [`mod@reference`] | the definition of the field in f64, by direct sum and by direct series |
//! | [`psf`] | what an eye or a lens scatters how far: point-spread functions, and their mixtures of Gaussians |
//! | [`veil`] | photo, point-spread function → the veil of every pixel, with its bound |
//! | [`compare`], [`certificate`] | the one error metric, and a rendered field held against the definition |
//! | [`job`] | a look laid over a photo: find, plan, render, certify |
//! | [`shot`] | frames by their numbers, and which of them are done |
//! | [`motion`] | lights and cameras that move: where they are at a time, and what is seen then |
//! | [`environment`] | light from outside the frame: what a lens scatters of all that its camera does not see |
//! | [`measure`] | arms timed in turns, and their ratios |
//!
//! Beside them stand [`panics`], which makes errors of them, `limits`, which asks the system for room and threads before
//! they are needed, and `printable`, by which no text of a file commands a terminal.
//!
//! That much is the core, which knows neither windows nor command lines. On top of it stand three rooms, each a feature
//! of the crate, and none imports another; what two of them need stands below them.
//!
//! | module | feature | what it does |
//! | --- | --- | --- |
//! | `cli` | `cli` | the commands for photos |
//! | `viewer` | `window` | the window: a photo with its glare, live |
//! | `laboratory` | `laboratory` | experiments, charts, benches: what is measured and drawn instead of applied |
//! | `chart` | `cli` or `laboratory` | numbers → charts, drawings and pictures in false colours |
//! | `false_colour` | any of these | numbers → colours |
//! | `options`, `terminal` | any of these | what commands share: options; printing, progress, signals |
//!
//! The program lists the commands of all three, in `src/program`.

// What the core has for the rooms on top alone looks unused without them.
#![cfg_attr(not(all(feature = "cli", feature = "laboratory", feature = "window")), allow(dead_code, unused_imports))]

mod calibration;
pub mod certificate;
mod chance;
#[cfg(feature = "chart")]
pub mod chart;
pub mod choices;
#[cfg(feature = "cli")]
pub mod cli;
pub mod compare;
pub mod environment;
pub mod error;
#[cfg(any(feature = "chart", feature = "window"))]
pub mod false_colour;
mod fast_length;
pub mod frame;
pub mod gpu;
pub mod job;
#[cfg(feature = "laboratory")]
pub mod laboratory;
mod limits;
pub mod look;
pub mod measure;
pub mod motion;
pub mod optics;
#[cfg(feature = "terminal")]
pub mod options;
pub mod panics;
pub mod photo;
pub mod plan;
pub(crate) mod plate;
mod printable;
pub mod problem;
pub mod psf;
pub mod raster;
pub mod reference;
pub mod renderer;
pub mod scene;
pub mod series;
pub mod shot;
mod target;
#[cfg(feature = "terminal")]
pub mod terminal;
pub mod veil;
#[cfg(feature = "window")]
pub mod viewer;

pub use error::{Error, Result};
