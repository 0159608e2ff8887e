//! The commands for photos, one file each.

pub mod animate;
pub mod apply;
mod encoding;
mod found;
pub mod info;
pub mod job;
pub mod lights;
mod luminance;
mod photo_told;
pub mod plan;
pub mod presets;
pub mod remove;
mod surroundings;
