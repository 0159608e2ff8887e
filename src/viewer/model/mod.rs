//! What the window edits, without a window: a look, its history, its command line, and where it is kept.

mod change;
mod edits;
mod history;
mod state;
mod veil;

pub use change::{Work, same_veil, work};
pub use history::History;
pub use state::{State, Theme};

pub use crate::look::{Accuracy, Look, LookLens, LookLights};
