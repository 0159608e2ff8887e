//! Colours that are neither grey nor RGB: CMYK, YCbCr, Lab.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use moxcms::{ColorProfile, DataColorSpace, Layout, RenderingIntent, TransformExecutor, TransformOptions};
use rayon::prelude::*;

use super::super::transfer::Curve;
use super::super::{Primaries, Reason, icc};

/// Pixels that are converted at a time.
const CHUNK: usize = 1 << 12;

/// The way from inks to RGB.
pub(super) enum Cmyk {
    /// Each ink takes its share of what the paper reflects; the result is read as sRGB.
    Naive,
    /// Through the file's profile, to sRGB.
    Profile(Arc<dyn TransformExecutor<f32> + Send + Sync>),
}

impl Cmyk {
    pub fn new(icc: Option<&[u8]>, notes: &mut Vec<String>) -> Self {
        let why = match icc.map(Self::by_profile) {
            Some(Ok(way)) => {
                notes.push("its CMYK colours are taken through its ICC profile, and are within sRGB".into());
                return way;
            }
            Some(Err(why)) => format!("its ICC profile cannot be used: {why}"),
            None => "it has no ICC profile".into(),
        };
        notes.push(format!("its CMYK colours are taken as (1 − ink)(1 − black): {why}"));
        Self::Naive
    }

    fn by_profile(icc: &[u8]) -> Result<Self, Reason> {
        let mut icc = icc.to_vec();
        icc::tell_lab(&mut icc);
        let profile = ColorProfile::new_from_slice(&icc)?;
        if profile.color_space != DataColorSpace::Cmyk {
            return Err("it is of another colour space".into());
        }
        let srgb = ColorProfile::new_srgb();
        let way = |rendering_intent| {
            let options = TransformOptions { rendering_intent, ..TransformOptions::default() };
            profile.create_transform_f32(Layout::Rgba, &srgb, Layout::Rgb, options)
        };
        // A profile without the table of an intent means that of the perceptual one: ICC.1:2022, 8.4.1.
        let way = way(RenderingIntent::RelativeColorimetric).or_else(|_| way(RenderingIntent::Perceptual))?;
        Ok(Self::Profile(way))
    }

    /// What decodes the RGB.
    pub fn curve(&self) -> Curve {
        Curve::Srgb
    }

    /// RGB, and alpha where a pixel has a fifth value.
    pub fn convert(&self, inks: &[f32], channels: usize) -> Result<Vec<f32>, Reason> {
        let out = channels - 1;
        let mut rgb = super::super::zeroed::<f32>(inks.len() / channels * out)?;
        let chunks = rgb.par_chunks_mut(CHUNK * out).zip(inks.par_chunks(CHUNK * channels));
        chunks.try_for_each(|(rgb, inks)| {
            match self {
                Self::Naive => {
                    for (rgb, inks) in rgb.chunks_exact_mut(out).zip(inks.chunks_exact(channels)) {
                        (0..3).for_each(|c| rgb[c] = (1.0 - inks[c]) * (1.0 - inks[3]));
                    }
                }
                Self::Profile(way) => {
                    let four: Vec<f32> =
                        inks.chunks_exact(channels).flat_map(|inks| inks[..4].iter().copied()).collect();
                    let mut three = vec![0.0; four.len() / 4 * 3];
                    way.transform(&four, &mut three)?;
                    for (rgb, three) in rgb.chunks_exact_mut(out).zip(three.chunks_exact(3)) {
                        rgb[..3].copy_from_slice(three);
                    }
                }
            }
            for (rgb, inks) in rgb.chunks_exact_mut(out).zip(inks.chunks_exact(channels)) {
                rgb[3..].copy_from_slice(&inks[4..]);
            }
            Ok::<_, Reason>(())
        })?;
        Ok(rgb)
    }
}

/// TIFF 6.0, sections 20 and 21: the way from YCbCr to RGB.
pub(super) struct YCbCr {
    /// The shares of red, green and blue in Y.
    luma: [f64; 3],
    /// Black and white of Y, then of Cb and Cr, for samples of which 1 is the largest.
    reference: [f64; 6],
}

impl Default for YCbCr {
    /// ITU-R BT.601, full range, 8 bit.
    fn default() -> Self {
        let middle = 128.0 / 255.0;
        Self { luma: [0.299, 0.587, 0.114], reference: [0.0, 1.0, middle, 1.0, middle, 1.0] }
    }
}

impl YCbCr {
    pub fn new(luma: Option<Vec<f64>>, reference: Option<Vec<f64>>, bits: u32) -> Result<Self, Reason> {
        let top = f64::from(u32::MAX >> (32 - bits));
        let mut ycbcr = Self::default();
        let middle = f64::from(1_u32 << (bits - 1)) / top;
        ycbcr.reference = [0.0, 1.0, middle, 1.0, middle, 1.0];
        if let Some(luma) = luma {
            ycbcr.luma = luma.try_into().map_err(|_| "it has not three YCbCr coefficients")?;
        }
        if let Some(reference) = reference {
            let reference: [f64; 6] = reference.try_into().map_err(|_| "it has not six references of YCbCr")?;
            ycbcr.reference = reference.map(|code| code / top);
        }
        let spans = ycbcr.reference.chunks_exact(2).all(|pair| pair[0].is_finite() && (pair[1] - pair[0]).abs() > 1e-6);
        if !spans || ycbcr.luma.iter().any(|share| !(1e-6..=1.0).contains(share)) {
            return Err("its YCbCr coefficients or references make no colours".into());
        }
        Ok(ycbcr)
    }

    /// Converts the first three values of a pixel.
    pub fn convert(&self, pixel: &mut [f32]) {
        let [black, white, ..] = self.reference;
        let scaled = |i: usize| f64::from(pixel[i]) - self.reference[2 * i];
        let y = scaled(0) / (white - black);
        // 127 of 255 is the reach of Cb and Cr.
        let chroma = |i: usize| scaled(i) / (self.reference[2 * i + 1] - self.reference[2 * i]) * 127.0 / 255.0;
        let [lr, lg, lb] = self.luma;
        let r = y + chroma(2) * (2.0 - 2.0 * lr);
        let b = y + chroma(1) * (2.0 - 2.0 * lb);
        let g = (y - lr * r - lb * b) / lg;
        pixel[..3].copy_from_slice(&[r, g, b].map(|c| c.clamp(0.0, 1.0) as f32));
    }
}

/// CIE L*a*b* of D50 (CIE 15:2004, 8.2.1) to linear light of Rec.709 primaries, white to white. Alpha, a fourth
/// sample, goes along. `share` is the way of a code to 0..1, `signed` that to a* or b*.
pub(super) fn lab_to_light<C: Copy + Send + Sync>(
    codes: &[C],
    channels: usize,
    share: impl Fn(C) -> f64 + Sync,
    signed: impl Fn(C) -> f64 + Sync,
) -> Vec<f32> {
    let d50 = DVec2::new(0.3457, 0.3585);
    let matrix = Primaries::relative_xyz_to_rec709(d50);
    let inverse = |t: f64| if t > 6.0 / 29.0 { t.powi(3) } else { 3.0 * (6.0_f64 / 29.0).powi(2) * (t - 4.0 / 29.0) };
    let light = |pixel: &[C]| {
        let l = (100.0 * share(pixel[0]) + 16.0) / 116.0;
        let (a, b) = (signed(pixel[1]) / 500.0, signed(pixel[2]) / 200.0);
        let [r, g, b] = (matrix * DVec3::new(inverse(l + a), inverse(l), inverse(l - b))).as_vec3().to_array();
        [r, g, b, pixel.get(3).map_or(1.0, |&alpha| share(alpha) as f32)]
    };
    codes.par_chunks_exact(channels).flat_map_iter(|pixel| light(pixel).into_iter().take(channels)).collect()
}
