//! The window: a photo with its glare, live.
//!
//! | file | what it does |
//! | --- | --- |
//! | [`command`] | `vglare view` |
//! | `window` | winit's events, the surface, when to draw; nothing else knows of a window |
//! | `app` | [`App`]: what is open, and one frame of it, with or without a window |
//! | `document` | an open photo: its pixels, its look, how it is looked at |
//! | `model` | what a person sets of the glare: looks, their history, their command line; no egui, no GL |
//! | `viewing` | what a person sets of the view, and where pixels lie on the screen for it |
//! | `stage` | the picture on the device; computes what has changed, and nothing else |
//! | `ask`, `dialog` | questions for paths, in the window and by the desktop |
//! | `export` | pictures written in the background |
//! | `input` | the pointer's buttons, a frame each |
//! | `loader` | files, read in the background |
//! | `timings` | how long the last frames took |
//! | `study` | what is found out about a picture at rest, in the background |
//! | `veiling` | the veil of the photo that is shown |
//! | `task` | other work in the background |
//! | `canvas` | the picture under the pointer: moving, magnifying, the lights' handles, the loupe |
//! | `panels` | the controls, one file a panel |
//! | `control` | what every control has: a name, a unit, a range, a way back |
//! | `replay` | scripts of what a person does, played without a window |
//! | `status` | what is shown, for whoever drives the window from outside |
//! | `shortcuts` | the keyboard |
//!
//! A frame runs egui, which changes the document; then the stage is brought up to date with the document, shown on the
//! screen, and egui's shapes are painted over it.

mod app;
mod ask;
mod canvas;
pub mod command;
mod control;
mod dialog;
mod document;
mod export;
mod input;
mod loader;
pub mod model;
mod panels;
mod removing;
pub mod replay;
mod shortcuts;
mod shrink;
mod stage;
mod status;
mod study;
mod task;
mod timings;
mod veiling;
mod viewing;
mod window;

pub use app::{App, PIXEL_BYTES, Shown};
pub use control::Told;
pub use document::{Document, LIVE_PIXELS};
pub use export::Subject;
pub use loader::Wake;
pub use shortcuts::KEYS;
pub use stage::{Counts, Times};
pub use status::Status;
pub use study::{Cut, CutPoint, Degree, Plot, Study, Wanted};
pub use timings::Timings;
pub use viewing::{Placement, Shows, Viewing, Zoom};
pub use window::{Harness, run};
