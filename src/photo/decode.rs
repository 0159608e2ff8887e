//! From the samples of PNG, JPEG and TIFF to linear light.

use std::sync::Arc;

use glam::{DMat3, Mat3A, Vec3A};
use image::metadata::Orientation;
use rayon::prelude::*;

use super::icc::{Profile, Way};
use super::native::Native;
use super::transfer::Curve;
use super::{Alpha, Depth, Format, Photo, Primaries, Reason, Source, zeroed};
use crate::frame::Frame;

/// What the file says its numbers mean.
pub(super) enum Encoding {
    /// Three curves, then a matrix.
    Curves(Box<Shaper>),
    /// An ICC profile.
    Icc(Profile),
}

/// A curve for each of red, green and blue, then the way to Rec.709.
#[derive(Debug, Clone)]
pub(super) struct Shaper {
    pub curves: [Curve; 3],
    /// None if the primaries are Rec.709's.
    pub matrix: Option<DMat3>,
    /// What the primaries are called, if they are others.
    pub space: Option<String>,
}

impl Shaper {
    /// Curves, and primaries if the file names any.
    pub fn new(curves: [Curve; 3], primaries: Option<Primaries>) -> Self {
        let primaries = primaries.and_then(Primaries::other_than_rec709);
        let space = primaries.map(|p| p.title().unwrap_or("primaries of their own").to_owned());
        // Rounding would make colours negative that two spaces share.
        let clean = |entry: f64| if entry.abs() < 1e-9 { 0.0 } else { entry };
        let matrix = primaries.map(|p| DMat3::from_cols_array(&p.to_rec709().to_cols_array().map(clean)));
        Self { curves, matrix, space }
    }

    /// Whether it is sRGB.
    pub fn is_srgb(&self) -> bool {
        self.matrix.is_none() && self.curves.iter().all(|curve| *curve == Curve::Srgb)
    }

    /// Whether there is a way from light back to the codes.
    pub fn has_inverse(&self) -> bool {
        let matrix = self.matrix.is_none_or(|matrix| matrix.determinant().abs() > 1e-6 && matrix.is_finite());
        matrix && self.curves.iter().all(Curve::has_inverse)
    }
}

impl Encoding {
    /// A curve, and primaries if the file names any.
    pub fn new(curve: Curve, primaries: Option<Primaries>) -> Self {
        Self::Curves(Box::new(Shaper::new([curve.clone(), curve.clone(), curve], primaries)))
    }

    /// The way from the light of the samples' own primaries to Rec. 709's, where it is a matrix and they are others.
    pub fn to_rec709(&self) -> Option<DMat3> {
        match self {
            Self::Curves(shaper) => shaper.matrix,
            Self::Icc(profile) => match profile.way() {
                Way::Shaper(shaper) => shaper.matrix,
                Way::Tables(_) => None,
            },
        }
    }

    /// The colour space that the samples are in, where its primaries are not Rec.709's.
    fn space(&self) -> Option<&String> {
        match self {
            Self::Curves(shaper) => shaper.space.as_ref(),
            Self::Icc(profile) => profile.space(),
        }
    }
}

/// The samples of a picture, as a decoder delivers them.
pub(super) struct Raster<T> {
    pub width: u32,
    pub height: u32,
    /// 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA.
    pub channels: usize,
    pub samples: Vec<T>,
    /// Whether each channel is stored by itself, one after another, and not pixel by pixel.
    pub planar: bool,
}

/// A sample: an integer code of a display format, or a float.
pub(super) trait Sample: Copy + Send + Sync {
    /// How it is stored.
    const DEPTH: Depth;
    /// Every value of the type, in order; empty where there are too many for a table.
    fn all() -> Vec<f64>;
    /// The encoded value, 0..=1 for integers.
    fn unit(self) -> f32;
    /// Its light, from the table that `all` gave, or by the curve.
    fn light(self, table: &[f32], curve: &Curve) -> f32;
}

impl Sample for u8 {
    const DEPTH: Depth = Depth::Eight;

    fn all() -> Vec<f64> {
        (0..=255).map(|c| f64::from(c) / 255.0).collect()
    }

    fn unit(self) -> f32 {
        f32::from(self) / 255.0
    }

    fn light(self, table: &[f32], _: &Curve) -> f32 {
        table[usize::from(self)]
    }
}

impl Sample for u16 {
    const DEPTH: Depth = Depth::Sixteen;

    fn all() -> Vec<f64> {
        (0..=65535).map(|c| f64::from(c) / 65535.0).collect()
    }

    fn unit(self) -> f32 {
        f32::from(self) / 65535.0
    }

    fn light(self, table: &[f32], _: &Curve) -> f32 {
        table[usize::from(self)]
    }
}

impl Sample for f32 {
    const DEPTH: Depth = Depth::Float;

    fn all() -> Vec<f64> {
        Vec::new()
    }

    fn unit(self) -> f32 {
        self
    }

    fn light(self, _: &[f32], curve: &Curve) -> f32 {
        match curve {
            Curve::Linear => self,
            _ => curve.light(f64::from(self)) as f32,
        }
    }
}

impl<T: Sample> Raster<T> {
    /// The photo of these samples, turned upright.
    pub fn into_photo(
        self,
        format: Format,
        alpha: Alpha,
        encoding: &Encoding,
        orientation: Orientation,
    ) -> Result<Photo, Reason> {
        let expected = self.width as usize * self.height as usize * self.channels;
        if self.samples.len() != expected {
            return Err(format!("there are {} samples where {expected} are needed", self.samples.len()).into());
        }
        let mut pixels = zeroed(self.width as usize * self.height as usize)?;
        match encoding {
            Encoding::Curves(shaper) => self.by_curves(shaper, &mut pixels),
            Encoding::Icc(profile) => match profile.way() {
                Way::Shaper(shaper) => self.by_curves(shaper, &mut pixels),
                Way::Tables(_) => self.by_profile(profile, &mut pixels)?,
            },
        }
        let has_alpha = self.channels.is_multiple_of(2);
        let source = Source {
            format: Some(format),
            depth: T::DEPTH,
            alpha: if has_alpha { alpha } else { Alpha::None },
            grey: self.channels < 3,
            display_referred: T::DEPTH.is_display(),
            space: encoding.space().cloned(),
            native: Native::of(encoding).map(Arc::new),
            ..Source::plain()
        };
        let (width, height) = (self.width, self.height);
        drop(self.samples);
        let (width, height, pixels) = upright(width, height, pixels, orientation);
        Ok(Photo { frame: Frame::full(width, height), pixels, source })
    }

    /// The pixel at `index` as RGBA, still encoded; grey is repeated, and alpha is none where there is none.
    fn rgba(&self, index: usize) -> ([T; 3], Option<T>) {
        let n = self.channels;
        let plane = if self.planar { self.samples.len() / n } else { 1 };
        let first = if self.planar { index } else { index * n };
        let at = |channel: usize| self.samples[first + channel * plane];
        match n {
            1 => ([at(0); 3], None),
            2 => ([at(0); 3], Some(at(1))),
            3 => ([at(0), at(1), at(2)], None),
            _ => ([at(0), at(1), at(2)], Some(at(3))),
        }
    }

    fn by_curves(&self, shaper: &Shaper, pixels: &mut [[f32; 4]]) {
        let [red, green, blue] = &shaper.curves;
        let table = |curve: &Curve| -> Vec<f32> { T::all().into_iter().map(|v| curve.light(v) as f32).collect() };
        let same = red == green && red == blue;
        let tables = if same { vec![table(red)] } else { shaper.curves.iter().map(table).collect() };
        let (r, g, b) = (&tables[0], &tables[tables.len() / 2], &tables[tables.len() - 1]);
        let matrix = shaper.matrix.map(|m| Mat3A::from(m.as_mat3()));
        let width = self.width as usize;
        pixels.par_chunks_exact_mut(width).enumerate().for_each(|(row, pixels)| {
            for (column, pixel) in pixels.iter_mut().enumerate() {
                let (colour, alpha) = self.rgba(row * width + column);
                let mut rgb = [colour[0].light(r, red), colour[1].light(g, green), colour[2].light(b, blue)];
                if let Some(matrix) = matrix {
                    rgb = (matrix * Vec3A::from(rgb)).to_array();
                }
                *pixel = [rgb[0], rgb[1], rgb[2], alpha.map_or(1.0, T::unit)];
            }
        });
    }

    fn by_profile(&self, profile: &Profile, pixels: &mut [[f32; 4]]) -> Result<(), Reason> {
        let width = self.width as usize;
        pixels.par_chunks_exact_mut(width).enumerate().try_for_each(|(row, pixels)| {
            let encoded: Vec<_> = (0..width).map(|column| self.rgba(row * width + column)).collect();
            let colours: Vec<[f32; 3]> = encoded.iter().map(|(colour, _)| colour.map(T::unit)).collect();
            let light = profile.to_light(&colours)?;
            for ((pixel, [r, g, b]), (_, alpha)) in pixels.iter_mut().zip(light).zip(encoded) {
                *pixel = [r, g, b, alpha.map_or(1.0, T::unit)];
            }
            Ok(())
        })
    }
}

/// The colour of which a pixel holds as much as it covers; none where it covers nothing, and none beyond white.
pub(super) fn divide_by_alpha(pixel: &mut [f32]) {
    let Some((&mut alpha, colours)) = pixel.split_last_mut() else { return };
    colours.iter_mut().for_each(|c| *c = if alpha > 0.0 { (*c / alpha).min(1.0) } else { 0.0 });
}

/// Whether what was the width becomes the height.
pub(super) fn is_quarter_turn(turn: Orientation) -> bool {
    use Orientation::{Rotate90, Rotate90FlipH, Rotate270, Rotate270FlipH};
    matches!(turn, Rotate90 | Rotate270 | Rotate90FlipH | Rotate270FlipH)
}

/// Turns and mirrors a picture as its EXIF or TIFF orientation asks.
fn upright(width: u32, height: u32, pixels: Vec<[f32; 4]>, turn: Orientation) -> (u32, u32, Vec<[f32; 4]>) {
    if turn == Orientation::NoTransforms {
        return (width, height, pixels);
    }
    let buffer = image::ImageBuffer::from_raw(width, height, pixels.into_flattened());
    let mut picture = image::DynamicImage::ImageRgba32F(buffer.expect("as many samples as the picture has"));
    picture.apply_orientation(turn);
    let (width, height) = (picture.width(), picture.height());
    let samples = picture.into_rgba32f().into_raw().into_boxed_slice();
    (width, height, bytemuck::allocation::cast_slice_box(samples).into_vec())
}
