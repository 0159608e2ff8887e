//! The promises, one module each.

mod photo;
mod scene;
