//! The commands, one file each.

pub mod bench;
pub mod lights;
pub mod presets;
mod stdout;
