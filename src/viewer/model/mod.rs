//! What the window edits, without a window: a look, its history, its command line, and where it is kept.

mod change;
mod edits;
mod history;
mod state;

pub use change::{Work, work};
pub use history::History;
pub use state::{State, Theme};

pub use crate::look::{Accuracy, Look, LookLens, LookLights};
