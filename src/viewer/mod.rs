//! The window, and the model behind it.

pub mod model;
