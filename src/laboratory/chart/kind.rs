//! What a drawing is written as.

use std::path::Path;

use crate::{Error, Result};

/// A kind of drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Shapes, to any size.
    Svg,
    /// Pixels.
    Png,
}

impl Kind {
    /// By the name's extension, in capitals or not.
    ///
    /// # Errors
    /// [`Error::Write`] for another one.
    pub fn of(path: &Path) -> Result<Self> {
        match path.extension().unwrap_or_default().to_string_lossy().to_lowercase().as_str() {
            "svg" => Ok(Self::Svg),
            "png" => Ok(Self::Png),
            _ => Err(Error::write(path, "a drawing is written as .svg or .png")),
        }
    }
}
