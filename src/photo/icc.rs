//! ICC profiles: from a profile's encoding to linear light of Rec.709 primaries, through moxcms.

use std::sync::Arc;

use glam::{DMat3, DVec3, Mat3A, Vec3A};
use moxcms::{
    ColorProfile, DataColorSpace, Layout, RenderingIntent, ToneReprCurve, TransformExecutor, TransformOptions,
};

use super::Reason;

/// The way from an ICC profile to linear light.
pub(super) struct Profile(Way);

enum Way {
    /// The profile is linear itself: a matrix, with no limits to the values.
    Matrix(Mat3A),
    /// Three curves and a matrix, or tables: 0..1 in.
    Rgb(Arc<dyn TransformExecutor<f32> + Send + Sync>),
    /// One curve.
    Grey(Arc<dyn TransformExecutor<f32> + Send + Sync>),
}

impl Profile {
    /// The way of an embedded profile; none if it is for other than RGB or grey samples (a decoder has converted them).
    ///
    /// # Errors
    /// Where the profile is damaged or of a kind that moxcms cannot read.
    pub fn new(icc: &[u8], grey_samples: bool) -> Result<Option<Self>, Reason> {
        let complain = |error| Reason::from(format!("its ICC profile cannot be read: {error}"));
        let profile = ColorProfile::new_from_slice(icc).map_err(complain)?;
        let light = linear_rec709();
        // Relative colorimetric: white to white, and every colour that the target has stays as it is.
        let intent = RenderingIntent::RelativeColorimetric;
        let options = TransformOptions {
            rendering_intent: intent,
            // Without this, colours outside Rec.709 are clipped.
            allow_extended_range_rgb_xyz: true,
            ..TransformOptions::default()
        };
        let way = match profile.color_space {
            DataColorSpace::Rgb if is_linear(&profile) => Way::Matrix(matrix(&profile, &light)),
            DataColorSpace::Rgb => {
                Way::Rgb(profile.create_transform_f32(Layout::Rgb, &light, Layout::Rgb, options).map_err(complain)?)
            }
            DataColorSpace::Gray if grey_samples => {
                Way::Grey(profile.create_transform_f32(Layout::Gray, &light, Layout::Rgb, options).map_err(complain)?)
            }
            _ => return Ok(None),
        };
        Ok(Some(Self(way)))
    }

    /// The light of a row of encoded colours.
    pub fn to_light(&self, colours: Vec<[f32; 3]>) -> Result<Vec<[f32; 3]>, Reason> {
        let mut light = vec![[0.0; 3]; colours.len()];
        match &self.0 {
            Way::Matrix(matrix) => {
                let converted = colours.iter().map(|&c| (*matrix * Vec3A::from(c)).to_array());
                light.iter_mut().zip(converted).for_each(|(l, c)| *l = c);
            }
            Way::Rgb(way) => way.transform(colours.as_flattened(), light.as_flattened_mut())?,
            Way::Grey(way) => {
                let grey: Vec<f32> = colours.iter().map(|c| c[0]).collect();
                way.transform(&grey, light.as_flattened_mut())?;
            }
        }
        Ok(light)
    }
}

/// Rec.709 primaries without a curve.
fn linear_rec709() -> ColorProfile {
    let straight = Some(ToneReprCurve::Lut(Vec::new()));
    let mut profile = ColorProfile::new_srgb();
    (profile.red_trc, profile.green_trc, profile.blue_trc) = (straight.clone(), straight.clone(), straight);
    profile.cicp = None;
    profile
}

/// Whether a profile consists of a matrix alone.
fn is_linear(profile: &ColorProfile) -> bool {
    let straight = |curve: &Option<ToneReprCurve>| match curve {
        Some(ToneReprCurve::Lut(table)) => table.is_empty() || table[..] == [256],
        Some(ToneReprCurve::Parametric(p)) => p[..] == [1.0],
        None => false,
    };
    let curves = [&profile.red_trc, &profile.green_trc, &profile.blue_trc];
    profile.is_matrix_shaper() && curves.into_iter().all(straight)
}

fn matrix(from: &ColorProfile, to: &ColorProfile) -> Mat3A {
    let rows = from.transform_matrix(to).v.map(DVec3::from_array);
    DMat3::from_cols(rows[0], rows[1], rows[2]).transpose().as_mat3().into()
}

#[cfg(test)]
mod tests {
    use super::super::{Primaries, transfer::Curve};
    use super::*;

    fn light_of(profile: &ColorProfile, colour: [f32; 3]) -> [f32; 3] {
        Profile::new(&profile.encode().unwrap(), false).unwrap().unwrap().to_light(vec![colour]).unwrap()[0]
    }

    fn close(got: [f32; 3], want: [f32; 3], tolerance: f32) {
        assert!(got.iter().zip(want).all(|(g, w)| (g - w).abs() < tolerance), "{got:?} for {want:?}");
    }

    #[test]
    fn display_p3_becomes_rec709_and_may_leave_its_gamut() {
        let p3 = ColorProfile::new_display_p3();
        let matrix = Primaries::P3_D65.to_rec709();
        for colour in [[1.0, 1.0, 1.0], [0.5, 0.5, 0.5], [0.9, 0.2, 0.4], [1.0, 0.0, 0.0], [0.02, 0.5, 0.01]] {
            let light = DVec3::from(colour.map(|c| Curve::Srgb.light(f64::from(c))));
            let want = (matrix * light).to_array().map(|c| c as f32);
            // moxcms promises 14 bits, and profiles store their matrices in 16.
            close(light_of(&p3, colour), want, 1e-3);
        }
        assert!(light_of(&p3, [0.0, 1.0, 0.0])[0] < -0.1, "out of gamut stays out of gamut");
    }

    #[test]
    fn srgb_is_srgb_and_a_linear_profile_has_no_ceiling() {
        for code in 0..=255 {
            let encoded = code as f32 / 255.0;
            let want = Curve::Srgb.light(f64::from(encoded)) as f32;
            close(light_of(&ColorProfile::new_srgb(), [encoded; 3]), [want; 3], 3e-4 * want + 1e-9);
        }
        close(light_of(&linear_rec709(), [0.25, 12.5, -3.0]), [0.25, 12.5, -3.0], 1e-3);
    }

    #[test]
    fn a_damaged_profile_is_an_error_and_a_foreign_one_is_passed_over() {
        assert!(Profile::new(&[0; 200], false).is_err());
        let grey = ColorProfile::new_gray_with_gamma(2.2).encode().unwrap();
        assert!(Profile::new(&grey, false).unwrap().is_none());
        let light = Profile::new(&grey, true).unwrap().unwrap().to_light(vec![[0.5; 3]]).unwrap();
        close(light[0], [0.5_f32.powf(2.2); 3], 1e-3);
    }
}
