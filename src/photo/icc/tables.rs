//! Profiles of tables, through moxcms.

use std::sync::Arc;

use glam::{DMat3, DVec3, Mat3A, Vec3A};
use moxcms::{
    ColorProfile, DataColorSpace, Layout, LutWarehouse, RenderingIntent, ToneReprCurve, TransformExecutor,
    TransformOptions, Xyzd,
};

use super::super::{Primaries, Reason};
use super::shape;

/// \[ICC\] 7.2.16: the white of the PCS.
const D50: DVec3 = DVec3::new(0.9642, 1.0, 0.8249);

/// The way through a profile's tables.
pub struct Tables {
    way: Arc<dyn TransformExecutor<f32> + Send + Sync>,
    grey: bool,
}

/// The tables of a profile, if it has any; they go before curves and a matrix: \[ICC\] 8.10.2.
pub fn of(profile: &ColorProfile) -> Option<Result<Tables, Reason>> {
    let has = [&profile.lut_a_to_b_perceptual, &profile.lut_a_to_b_colorimetric, &profile.lut_a_to_b_saturation];
    has.iter().any(|table| table.is_some()).then(|| Tables::new(profile))
}

impl Tables {
    fn new(profile: &ColorProfile) -> Result<Self, Reason> {
        let mut profile = profile.clone();
        let tables = [
            &mut profile.lut_a_to_b_perceptual,
            &mut profile.lut_a_to_b_colorimetric,
            &mut profile.lut_a_to_b_saturation,
        ];
        tables.into_iter().flatten().try_for_each(straighten)?;
        // moxcms looks for the table of its intent alone; [ICC] 8.10.2 has the perceptual one serve for all.
        let colorimetric = profile.lut_a_to_b_colorimetric.take();
        let (perceptual, saturation) = (&profile.lut_a_to_b_perceptual, &profile.lut_a_to_b_saturation);
        profile.lut_a_to_b_colorimetric = colorimetric.or_else(|| perceptual.clone()).or_else(|| saturation.clone());
        // Relative colorimetric: white to white, and every colour that the target has stays as it is.
        let options = TransformOptions {
            rendering_intent: RenderingIntent::RelativeColorimetric,
            allow_extended_range_rgb_xyz: true,
            ..TransformOptions::default()
        };
        let grey = profile.color_space == DataColorSpace::Gray;
        let layout = if grey { Layout::Gray } else { Layout::Rgb };
        match profile.create_transform_f32(layout, &pcs(), Layout::Rgb, options) {
            Ok(way) => Ok(Self { way, grey }),
            Err(error) => Err(format!("cannot be read: {error}").into()),
        }
    }

    /// The light of a row of encoded colours.
    pub fn light(&self, colours: &[[f32; 3]]) -> Result<Vec<[f32; 3]>, Reason> {
        let mut light = vec![[0.0; 3]; colours.len()];
        if self.grey {
            let grey: Vec<f32> = colours.iter().map(|c| c[0]).collect();
            self.way.transform(&grey, light.as_flattened_mut())?;
        } else {
            self.way.transform(colours.as_flattened(), light.as_flattened_mut())?;
        }
        // White becomes white, whatever the rounding.
        let white = (Primaries::pcs_to_rec709() * D50).recip();
        let matrix = Mat3A::from((DMat3::from_diagonal(white) * Primaries::pcs_to_rec709()).as_mat3());
        light.iter_mut().for_each(|xyz| *xyz = (matrix * Vec3A::from(*xyz)).to_array());
        Ok(light)
    }
}

/// The PCS itself as a colour space, in which all that tables can hold lies within 0..=1, where moxcms clips.
fn pcs() -> ColorProfile {
    let straight = Some(ToneReprCurve::Lut(Vec::new()));
    let mut profile = ColorProfile::new_srgb();
    (profile.red_trc, profile.green_trc, profile.blue_trc) = (straight.clone(), straight.clone(), straight);
    profile.red_colorant = Xyzd { x: 1.0, y: 0.0, z: 0.0 };
    profile.green_colorant = Xyzd { x: 0.0, y: 1.0, z: 0.0 };
    profile.blue_colorant = Xyzd { x: 0.0, y: 0.0, z: 1.0 };
    profile.cicp = None;
    profile
}

/// moxcms takes powers of 0 for something else than 0, so curves by formula become tables of many steps.
fn straighten(tables: &mut LutWarehouse) -> Result<(), Reason> {
    const STEPS: u16 = 4096;
    let LutWarehouse::Multidimensional(tables) = tables else { return Ok(()) };
    let curves = [&mut tables.a_curves, &mut tables.b_curves, &mut tables.m_curves];
    for trc in curves.into_iter().flatten() {
        if matches!(trc, ToneReprCurve::Parametric(_)) || matches!(trc, ToneReprCurve::Lut(table) if table.len() == 1) {
            let curve = shape::curve(trc)?;
            let step = |k: u16| (curve.light(f64::from(k) / f64::from(STEPS - 1)) * 65535.0).round() as u16;
            *trc = ToneReprCurve::Lut((0..STEPS).map(step).collect());
        }
    }
    Ok(())
}
