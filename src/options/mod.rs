//! The options that more than one command has, and the command line that says a look.

mod accuracy;
mod backend;
mod command_line;
mod find;
pub(crate) mod numbers;
mod optics;
pub(crate) mod psf;
mod reading;
mod scene;
mod surroundings;
mod unit;
mod veil;

pub use accuracy::{AccuracyArgs, CalibrationArgs};
pub use backend::BackendChoice;
pub use command_line::command_line;
pub use find::FindArgs;
pub use optics::{ApertureArgs, OpticsArgs};
pub use psf::PsfArgs;
pub use reading::ReadArgs;
pub use scene::SceneArgs;
pub use surroundings::{EnvironmentArgs, HoodArgs};
pub use unit::UnitArgs;
pub use veil::VeilArgs;
