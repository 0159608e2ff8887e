//! The commands for photos, one file each.

pub mod apply;
mod found;
pub mod info;
pub mod lights;
pub mod plan;
pub mod presets;
