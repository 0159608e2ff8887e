//! Pictures in and out: linear light, RGBA f32.
//!
//! [`read()`] takes OpenEXR, Radiance HDR, PFM, TIFF, PNG, JPEG and JPEG XL, told apart by their content; [`write()`] writes
//! all but the last, told apart by the name's extension or by what is asked for.
//!
//! # What the numbers mean
//!
//! OpenEXR, Radiance HDR, PFM, float TIFF and float JPEG XL hold *scene-linear* light; their values are taken over untouched. Integer
//! TIFF, PNG, JPEG and JPEG XL are *display-referred*: an embedded ICC profile (PNG also: cICP, gAMA, cHRM) decodes them, and
//! where there is none the sRGB curve. Their pixels come out in linear light of Rec.709 primaries, 1 is display white.
//! What a file says wrongly or in an unknown way becomes one of [`Source::notes`], and what an output cannot hold of a
//! photo's colours is told by [`lost()`]. Pictures for displays are written in the colour space that they were in, or as
//! sRGB, and say so.
//! A JPEG with a gain map (Ultra HDR) is brightened by it, and counts as scene-linear light of Rec.709 primaries.
//!
//! What a number is in cd/m² is known where a person or the file says it: [`Photo::luminance_scale`].
//!
//! # Alpha
//!
//! Alpha is carried as it is and written back bit for bit at the same depth. OpenEXR's is premultiplied; PNG's and
//! TIFF's (unless it says otherwise) straight. Straight colours are premultiplied when they go into an OpenEXR file;
//! premultiplied colours are never divided: PNG, which knows straight alpha only, gets them as they stand, opaque.
//! JPEG, HDR and PFM hold no alpha. Integer TIFF of associated alpha holds codes of the colour itself times alpha: they
//! are divided by it, decoded, and multiplied again.
//!
//! # Negative, infinite and undefined pixels
//!
//! Finite negative values are legitimate (wide gamuts, filters that ring) and kept. NaN and infinities are kept as
//! they are, payload included, in formats that can hold them (OpenEXR, PFM, float TIFF), and never count as light.
//! Display formats and Radiance HDR write NaN, −∞ and negative values as 0, and +∞ as the largest value they hold.

mod bad;
mod beside;
mod camera;
mod cicp;
mod decode;
mod display;
mod exr;
mod foreign;
mod format;
mod icc;
mod jpeg;
mod jxl;
mod lost;
mod luminance;
mod metadata;
mod native;
mod pfm;
mod png;
mod primaries;
mod radiance;
mod read;
mod shown;
mod tiff;
mod tone;
mod transfer;
mod write;

use std::sync::Arc;

use glam::DMat3;
use rayon::prelude::*;

pub(crate) use bad::not_finite;
pub use bad::{BadKind, BadPixels, survey};
pub use beside::{Beside, Made, Part};
pub use camera::View;
pub use format::{Depth, Format};
pub use lost::lost;
pub use luminance::{LuminanceScale, WhiteLuminance};
pub use primaries::Primaries;
pub use read::{MAX_PIXELS, Missing, ReadOptions, read, read_with};
pub(crate) use shown::Shown;
pub use tone::ToneMap;
pub(crate) use transfer::srgb_encode;
pub(crate) use write::holds;
pub use write::{WriteOptions, check_name, check_target, largest_value, write, write_unless};

use crate::frame::{Frame, Window};

/// Why a decoder or encoder gave up; [`read()`] and [`write()`] add the file's name.
type Reason = Box<dyn std::error::Error + Send + Sync>;

/// A picture in linear light.
#[derive(Debug, Clone)]
pub struct Photo {
    /// The picture and the window of it that `pixels` holds.
    pub frame: Frame,
    /// RGBA, row by row from the top, `frame.window.width` × `frame.window.height` of them; alpha is 1 where the file
    /// has none.
    pub pixels: Vec<[f32; 4]>,
    /// What its file said about itself.
    pub source: Source,
}

/// How alpha relates to colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Alpha {
    /// There is none: opaque.
    None,
    /// Colour is not multiplied by alpha (PNG, most TIFF).
    Straight,
    /// Colour is multiplied by alpha (OpenEXR).
    Premultiplied,
}

/// What a photo's file said about itself; all that is needed to write the photo back.
#[derive(Debug, Clone)]
pub struct Source {
    /// The file's format; none for a picture that comes from no file.
    pub format: Option<Format>,
    /// How a colour sample was stored.
    pub depth: Depth,
    /// Whether there was an alpha channel, and which kind.
    pub alpha: Alpha,
    /// Whether there was a single channel of luminance instead of three colours.
    pub grey: bool,
    /// Whether the values were meant for a display (PNG, JPEG, integer TIFF) and not scene-linear light.
    pub display_referred: bool,
    /// The colours of (1,0,0), (0,1,0), (0,0,1) and (1,1,1), where they are not Rec.709's (scene-linear formats only).
    pub primaries: Option<Primaries>,
    /// Whether the file, or a person, says what the primaries are; else they are taken for Rec.709's.
    pub knows_primaries: bool,
    /// Width of a pixel over its height as it is shown, > 0; 1 in most files. The frame of a photo that was read has it too.
    pub pixel_aspect: f64,
    /// What the picture is called in a file that holds several: a layer, a part, a page.
    pub picture: Option<String>,
    /// The colour space of a file whose pixels have been converted to Rec.709's primaries when it was read.
    pub space: Option<String>,
    /// What a person ought to know of how the file was read: what was damaged, missing, or taken for something else.
    pub notes: Vec<String>,
    /// Columns and rows beyond each edge of the picture that are pixels of the file's: see [`ReadOptions::overscan`].
    overscan: [u32; 2],
    /// What is known of its numbers in cd/m²; [`Photo::luminance_scale`] tells it.
    pub(crate) luminance: Option<luminance::Said>,
    /// What it says of the camera; [`Photo::view`] tells what follows.
    camera: Option<camera::Camera>,
    /// The colour space in which a picture for displays is written again, where that is not sRGB.
    native: Option<Arc<native::Native>>,
    /// What a picture for displays, or a TIFF, says beside its pixels.
    metadata: Option<Arc<metadata::Metadata>>,
    /// Whether it is more to be written fast than small.
    quick: bool,
    /// How the picture was made, for files that can say so (OpenEXR).
    pub made: Option<Arc<Made>>,
    /// Layers that an OpenEXR file gets beside the picture.
    pub beside: Vec<Beside>,
    /// Whether formats that know no other primaries than Rec.709's get the pixels as they are.
    keeps_space: bool,
    /// Everything else that an OpenEXR file held.
    exr: Option<Arc<exr::Rest>>,
    /// What the header of a Radiance file held.
    radiance: Option<Arc<radiance::Header>>,
}

/// What is told of a photo, pixels apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Facts {
    /// The picture and the window of it that is stored.
    pub frame: Frame,
    /// The name of the format that it was read from.
    pub format: &'static str,
    /// How a colour sample was stored in the file, in words.
    pub depth: &'static str,
    /// What the picture is called in a file that holds several.
    pub picture: Option<String>,
}

impl Source {
    /// Scene-linear RGB without alpha, from no file.
    fn plain() -> Self {
        Self {
            format: None,
            depth: Depth::Float,
            alpha: Alpha::None,
            grey: false,
            display_referred: false,
            primaries: None,
            knows_primaries: false,
            pixel_aspect: 1.0,
            picture: None,
            space: None,
            notes: Vec::new(),
            overscan: [0; 2],
            luminance: None,
            camera: None,
            native: None,
            metadata: None,
            quick: false,
            made: None,
            beside: Vec::new(),
            keeps_space: false,
            exr: None,
            radiance: None,
        }
    }
}

impl Photo {
    /// A scene-linear picture of Rec.709 primaries without alpha, all pixels stored, row by row from the top.
    ///
    /// # Panics
    /// If there are not `width` × `height` pixels.
    pub fn new(width: u32, height: u32, pixels: Vec<[f32; 4]>) -> Self {
        let frame = Frame::full(width, height);
        assert_eq!(pixels.len(), frame.window.pixels(), "a photo needs as many pixels as its window");
        Self { frame, pixels, source: Source::plain() }
    }

    /// Another picture in the same frame and of the same primaries, which comes from no file: scene-linear, without
    /// alpha, with the attributes that an OpenEXR photo has and the header of a Radiance one, on which the numbers' unit
    /// depends, but with nothing else of what this photo's file held. As OpenEXR it is written fast rather than small.
    ///
    /// # Panics
    /// If there are not as many pixels as the window holds.
    pub fn companion(&self, pixels: Vec<[f32; 4]>) -> Self {
        assert_eq!(pixels.len(), self.frame.window.pixels(), "a photo needs as many pixels as its window");
        let Source { primaries, knows_primaries, pixel_aspect, luminance, radiance, exr, .. } = &self.source;
        let exr = exr.as_ref().map(|rest| Arc::new(rest.attributes_only()));
        let (primaries, knows_primaries, pixel_aspect) = (*primaries, *knows_primaries, *pixel_aspect);
        let (radiance, luminance) = (radiance.clone(), luminance.clone());
        let own = Source { primaries, knows_primaries, pixel_aspect, luminance, radiance, exr, ..Source::plain() };
        let source = Source { quick: true, ..own };
        Self { frame: self.frame, pixels, source }
    }

    /// The picture alone, without what is stored beyond it; transparent black where none of it is stored.
    #[must_use]
    pub fn cropped(self) -> Self {
        if self.frame.is_whole() {
            return self;
        }
        let Frame { width, height, .. } = self.frame;
        let pixels = (0..height).flat_map(|row| self.picture_row(row).into_owned()).collect();
        Self { frame: self.frame.with_window(Window { x: 0, y: 0, width, height }), pixels, ..self }
    }

    /// The same picture with other pixels beyond it: those of a larger window of `around`, whose picture is as large.
    ///
    /// # Panics
    /// If the pictures differ in size, or if that window does not hold all of what is stored of this one.
    #[must_use]
    pub fn surrounded(mut self, around: Self) -> Self {
        let (own, window) = (self.frame.window, around.frame.window);
        assert_eq!([self.width(), self.height()], [around.width(), around.height()], "pictures of one size");
        let [left, top] = [own.x - window.x, own.y - window.y]
            .map(|before| usize::try_from(before).expect("the window holds all of the picture"));
        let (columns, stored) = (own.width as usize, window.width as usize);
        let mut pixels = around.pixels;
        for (row, from) in self.pixels.chunks_exact(columns.max(1)).enumerate() {
            pixels[(top + row) * stored + left..][..columns].copy_from_slice(from);
        }
        self.frame = self.frame.with_window(window);
        self.pixels = pixels;
        self
    }

    /// What is known of the picture without any of its pixels, and without what else an OpenEXR file held.
    pub(crate) fn without_pixels(&self) -> Self {
        Self { frame: self.frame, pixels: Vec::new(), source: Source { exr: None, ..self.source.clone() } }
    }

    /// Columns of the picture.
    pub fn width(&self) -> u32 {
        self.frame.width
    }

    /// Rows of the picture.
    pub fn height(&self) -> u32 {
        self.frame.height
    }

    /// The name of the format that the photo was read from.
    pub fn format_name(&self) -> &'static str {
        self.source.format.map_or("none", Format::name)
    }

    /// How a colour sample was stored in the file, in words.
    pub fn depth_name(&self) -> &'static str {
        match self.source.format {
            Some(Format::Radiance) => "RGBE, 8 bit with a shared exponent",
            _ => self.source.depth.name(),
        }
    }

    /// What is told of it.
    pub fn facts(&self) -> Facts {
        let (format, depth) = (self.format_name(), self.depth_name());
        Facts { frame: self.frame, format, depth, picture: self.source.picture.clone() }
    }

    /// The parts of the OpenEXR file that it was read from; none of other formats.
    pub fn parts(&self) -> Vec<Part> {
        self.source.exr.as_ref().map_or_else(Vec::new, |rest| rest.parts())
    }

    /// The share of red, green and blue in luminance (Y of CIE 1931); they add up to 1.
    ///
    /// Rec.709's 0.2126, 0.7152, 0.0722 unless the file names other primaries.
    pub fn luminance_weights(&self) -> [f64; 3] {
        self.source.primaries.map_or([0.2126, 0.7152, 0.0722], |primaries| primaries.luminance_weights())
    }

    /// From the photo's primaries to Rec.709, white to white; none where they are the same.
    pub(crate) fn to_rec709(&self) -> Option<DMat3> {
        self.source.primaries.map(|primaries| primaries.to_rec709())
    }

    /// From the photo's primaries to those of a file that can name none; none where they are the same.
    fn to_file(&self) -> Option<DMat3> {
        if self.source.keeps_space { None } else { self.to_rec709() }
    }

    /// The same picture in other primaries, white to white, to be written in them whatever the format.
    fn in_primaries(&self, primaries: Primaries) -> Self {
        let mut photo = self.clone();
        let own = self.source.primaries.unwrap_or(Primaries::REC709);
        if !own.near(primaries) {
            let matrix = primaries.to_rec709().inverse() * own.to_rec709();
            let convert = |pixel: &mut [f32; 4]| {
                let rgb = pfm::rec709(*pixel, Some(&matrix));
                pixel[..3].copy_from_slice(&rgb);
            };
            photo.pixels.par_iter_mut().for_each(convert);
            photo.source.beside.iter_mut().for_each(|layer| layer.pixels.par_iter_mut().for_each(convert));
        }
        photo.source.primaries = primaries.other_than_rec709();
        photo.source.knows_primaries = true;
        photo.source.keeps_space = true;
        photo
    }

    /// The mean of what the picture shows, RGB.
    pub(crate) fn mean(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for row in 0..self.height() {
            self.picture_row(row).iter().for_each(|pixel| (0..3).for_each(|k| sum[k] += f64::from(pixel[k])));
        }
        sum.map(|sum| sum / (f64::from(self.width()) * f64::from(self.height())))
    }

    /// The pixels of row `y` of the picture, transparent black where none are stored.
    pub(crate) fn picture_row(&self, y: u32) -> std::borrow::Cow<'_, [[f32; 4]]> {
        let window = self.frame.window;
        let stored = usize::try_from(i64::from(y) - i64::from(window.y)).ok().filter(|&r| r < window.height as usize);
        let row = stored.map_or(&[][..], |r| &self.pixels[r * window.width as usize..][..window.width as usize]);
        if !row.is_empty() && window.x == 0 && window.width == self.frame.width {
            return row.into();
        }
        let mut full = vec![[0.0; 4]; self.frame.width as usize];
        // A window may begin left of the picture, right of it, or within.
        let skip = (-i64::from(window.x)).max(0) as usize;
        let start = i64::from(window.x).max(0) as usize;
        if let (Some(from), Some(to)) = (row.get(skip..), full.get_mut(start..)) {
            let count = from.len().min(to.len());
            to[..count].copy_from_slice(&from[..count]);
        }
        full.into()
    }
}

/// Zeroed memory for `count` elements, or a reason instead of an abort where there is not enough.
///
/// The system hands it out page by page as it is touched, so that a file which lies about its size costs nothing.
fn zeroed<T: bytemuck::Zeroable>(count: usize) -> Result<Vec<T>, Reason> {
    match bytemuck::allocation::try_zeroed_slice_box(count) {
        Ok(memory) => Ok(memory.into_vec()),
        Err(()) => Err(format!("not enough memory for {count} samples of {} bytes", size_of::<T>()).into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of numbers from `first` on.
    fn photo(width: u32, height: u32, first: u32) -> Photo {
        Photo::new(width, height, (first..first + width * height).map(|k| [k as f32, 0.0, 0.0, 1.0]).collect())
    }

    fn red(photo: &Photo) -> Vec<f32> {
        photo.pixels.iter().map(|pixel| pixel[0]).collect()
    }

    #[test]
    fn what_is_stored_beyond_the_picture_is_cut_off_and_put_there_again() {
        let mut wide = photo(5, 4, 0);
        wide.frame = Frame::full(3, 2).with_window(Window { x: -1, y: -1, width: 5, height: 4 });
        let cropped = wide.clone().cropped();
        assert!(cropped.frame.is_whole());
        assert_eq!(red(&cropped), [6.0, 7.0, 8.0, 11.0, 12.0, 13.0]);
        assert_eq!(red(&cropped.surrounded(wide.clone())), red(&wide));
        let other = photo(3, 2, 100).surrounded(wide.clone());
        assert_eq!((other.frame, red(&other.cropped())), (wide.frame, red(&photo(3, 2, 100))));
    }
}
