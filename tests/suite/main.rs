//! The promises, one module each.

mod cli;
mod photo;
mod scene;
