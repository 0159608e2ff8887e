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
//! | [`look`] | everything that a person sets: from options, from a scene file, or by hand |
//! | [`series`] | bells, their Fourier coefficients and their tails, in f64 |
//! | [`problem`] | ghosts and picture, as one thing that never changes |
//! | [`plan`] | problem, tolerance → period, degree, kept terms, evaluator, predicted error |
//! | [`gpu`] | the plan's tables and passes on OpenGL 4.3; the only folder with `unsafe` |
//! | [`renderer`] | the main path: spectrum → field → normalise → composite |
//! | [`mod@reference`] | the definition of the field in f64, by direct sum and by direct series |
//! | [`compare`], [`certificate`] | the one error metric, and a rendered field held against the definition |
//! | [`job`] | a look laid over a photo: find, plan, render, certify |
//! | [`measure`] | arms timed in turns, and their ratios |
//! | [`chart`] | numbers → charts and pictures in false colours |
//! | [`rex`] | the research prototype's experiments, as figures and numbers |
//! | [`tradeoff`] | a photo and its ghosts → accuracy against time, measured here |
//! | [`viewer`] | the window: a photo with its glare, live |
//! | [`cli`] | the commands |
//!
//! Beside them stand [`panics`], which makes errors of them, `limits`, which asks the system for room and threads before
//! they are needed, and `printable`, by which no text of a file commands a terminal.

#![warn(clippy::print_stderr, clippy::print_stdout)]

mod calibration;
pub mod certificate;
mod chance;
pub mod chart;
pub mod choices;
pub mod cli;
pub mod compare;
pub mod error;
pub mod frame;
pub mod gpu;
pub mod job;
mod limits;
pub mod look;
pub mod measure;
mod page;
pub mod panics;
pub mod photo;
pub mod plan;
mod printable;
pub mod problem;
pub mod reference;
pub mod renderer;
pub mod rex;
pub mod scene;
pub mod series;
mod target;
pub mod tradeoff;
pub mod viewer;

pub use error::{Error, Result};
