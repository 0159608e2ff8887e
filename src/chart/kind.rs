//! What a drawing is written as.

use std::io::Cursor;
use std::path::Path;

use image::{ImageFormat, RgbImage};

use crate::{Error, Result, target};

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

/// Writes a picture, in place of one that is there if need be.
///
/// # Errors
/// [`Error::Write`] where it cannot be written, [`Error::Exists`].
pub(crate) fn write_png(path: &Path, picture: &RgbImage, overwrite: bool) -> Result<()> {
    target::write(path, &png_bytes(path, picture)?, overwrite)
}

/// What a picture's file is to hold.
///
/// # Errors
/// [`Error::Write`] where there is no room for it.
pub(crate) fn png_bytes(path: &Path, picture: &RgbImage) -> Result<Vec<u8>> {
    let mut png = Cursor::new(Vec::new());
    picture.write_to(&mut png, ImageFormat::Png).map_err(|error| Error::write(path, error))?;
    Ok(png.into_inner())
}
