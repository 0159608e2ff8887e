//! A photo's file, as reports tell of it.

use std::path::Path;

use serde::Serialize;

use crate::photo::Facts;

/// What a file holds.
#[derive(Debug, Clone, Serialize)]
pub struct PhotoTold {
    pub file: String,
    pub format: &'static str,
    pub depth: &'static str,
    /// What the picture is called in a file that holds several.
    pub layer: Option<String>,
    /// Columns and rows of the picture.
    pub picture: [u32; 2],
    /// Of what is stored: the first column and row, and how many of them.
    pub window: [i64; 4],
    /// Width of a pixel over its height.
    pub pixel_aspect: f64,
}

impl PhotoTold {
    /// By what was read of a file.
    pub fn new(path: &Path, Facts { frame, format, depth, picture }: &Facts) -> Self {
        let window = frame.window;
        Self {
            file: path.display().to_string(),
            format,
            depth,
            layer: picture.clone(),
            picture: [frame.width, frame.height],
            window: [window.x.into(), window.y.into(), window.width.into(), window.height.into()],
            pixel_aspect: frame.pixel_aspect,
        }
    }
}
