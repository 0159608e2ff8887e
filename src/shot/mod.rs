//! A shot: frames by their numbers, and which of them are done.
//!
//! | module | what it does |
//! | --- | --- |
//! | [`mod@frames`] | ranges of frame numbers, in and out |
//! | [`mod@ledger`] | what is known of each frame that was written, kept beside it |

pub mod frames;
pub mod ledger;

pub use frames::Frames;
pub use ledger::{Ledger, Measured, Stamp};
