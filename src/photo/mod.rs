//! Pictures in and out: linear light, RGBA f32.

use crate::frame::Frame;

/// A picture in linear light.
#[derive(Debug, Clone)]
pub struct Photo {
    /// The picture and the window of it that `pixels` holds.
    pub frame: Frame,
    /// RGBA, row by row from the top, `frame.window.width` × `frame.window.height` of them.
    pub pixels: Vec<[f32; 4]>,
}
