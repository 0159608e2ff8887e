//! Profiles of curves: \[ICC\] F.3 for three of them and a matrix, F.2 for grey.

use glam::{DMat3, DVec3};
use moxcms::{CicpProfile, ColorProfile, DataColorSpace, ToneReprCurve, Xyzd};

use super::super::decode::Shaper;
use super::super::transfer::Curve;
use super::super::{Primaries, Reason, cicp};

/// Colorants are rounded to 16 bits, and makers of profiles differ in the third decimal.
const SAME: f64 = 2e-3;

/// The curves and the matrix of a profile called `name`.
///
/// # Errors
/// Where it lacks a part, or its primaries span no colour space.
pub fn shaper(profile: &ColorProfile, name: Option<&str>) -> Result<Shaper, Reason> {
    if profile.color_space == DataColorSpace::Gray {
        let trc = profile.gray_trc.as_ref().ok_or("lacks its curve")?;
        let curve = if profile.pcs == DataColorSpace::Lab { of_lightness(&curve(trc)?) } else { curve(trc)? };
        return Ok(Shaper::new([curve.clone(), curve.clone(), curve], None));
    }
    if let Some(shaper) = profile.cicp.as_ref().and_then(of_code_points) {
        return Ok(shaper);
    }
    let curves = [&profile.red_trc, &profile.green_trc, &profile.blue_trc];
    let [Some(red), Some(green), Some(blue)] = curves else { return Err("lacks a curve".into()) };
    let curves = [curve(red)?, curve(green)?, curve(blue)?];
    let column = |c: Xyzd| DVec3::new(c.x, c.y, c.z);
    let colorants = [profile.red_colorant, profile.green_colorant, profile.blue_colorant].map(column);
    if colorants.contains(&DVec3::ZERO) {
        return Err("lacks a primary".into());
    }
    let matrix = DMat3::from_cols(colorants[0], colorants[1], colorants[2]);
    if !matrix.is_finite() || matrix.determinant().abs() < 1e-6 {
        return Err("has primaries that span no colour space".into());
    }
    Ok(to_rec709(curves, Primaries::pcs_to_rec709() * matrix, name))
}

/// Light of one encoded colour.
pub fn light(shaper: &Shaper, colour: [f32; 3]) -> [f32; 3] {
    let light = [0, 1, 2].map(|c| shaper.curves[c].light(f64::from(colour[c])));
    shaper.matrix.map_or(light, |matrix| (matrix * DVec3::from(light)).to_array()).map(|c| c as f32)
}

/// The shaper of a matrix to Rec.709, of which the rounding is taken away that would give grey a tint.
fn to_rec709(curves: [Curve; 3], matrix: DMat3, name: Option<&str>) -> Shaper {
    let near = |known: &DMat3| (0..3).all(|k| (known.col(k) - matrix.col(k)).abs().max_element() < SAME);
    if near(&DMat3::IDENTITY) {
        return Shaper::new(curves, None);
    }
    let known = Primaries::NAMES.iter().map(|&(_, primaries)| primaries).find(|known| near(&known.to_rec709()));
    if known.is_some() {
        return Shaper::new(curves, known);
    }
    let white = matrix * DVec3::ONE;
    let balance = if (white - 1.0).abs().max_element() < SAME { white.recip() } else { DVec3::ONE };
    let space = name.unwrap_or("the colours of their ICC profile").to_owned();
    Shaper { curves, matrix: Some(DMat3::from_diagonal(balance) * matrix), space: Some(space) }
}

/// PQ and HLG stand in profiles as code points, beside curves that other programs make do with.
fn of_code_points(code: &CicpProfile) -> Option<Shaper> {
    let curve = cicp::curve(code.transfer_characteristics as u8).filter(|c| matches!(c, Curve::Pq | Curve::Hlg))?;
    let primaries = cicp::primaries(code.color_primaries as u8)?;
    Some(Shaper::new([curve.clone(), curve.clone(), curve], Some(primaries)))
}

/// \[ICC\] 10.6 and 10.18.
///
/// # Errors
/// For numbers that are no curve.
pub fn curve(trc: &ToneReprCurve) -> Result<Curve, Reason> {
    let curve = match trc {
        ToneReprCurve::Lut(table) => match table[..] {
            [] => Curve::Linear,
            [gamma] => Curve::Power(f64::from(gamma) / 256.0),
            _ => Curve::Table(table.iter().map(|&step| f64::from(step) / 65535.0).collect()),
        },
        ToneReprCurve::Parametric(parameters) => {
            let p: Vec<f64> = parameters.iter().map(|&p| f64::from(p)).collect();
            match p[..] {
                [g] => Curve::Power(g),
                [g, a, b] if a != 0.0 => Curve::Parametric([g, a, b, 0.0, -b / a, 0.0, 0.0]),
                [g, a, b, c] if a != 0.0 => Curve::Parametric([g, a, b, 0.0, -b / a, c, c]),
                [g, a, b, c, d] => Curve::Parametric([g, a, b, c, d, 0.0, 0.0]),
                [g, a, b, c, d, e, f] => Curve::Parametric([g, a, b, c, d, e, f]),
                _ => return Err("has a curve that is none".into()),
            }
        }
    };
    let steps = (0..=64).map(|k| curve.light(f64::from(k) / 64.0));
    // Gamma 0 makes all codes white.
    let flat = curve.light(0.0) == curve.light(1.0);
    if flat || steps.clone().any(|light| !(-1.0..=100.0).contains(&light)) || steps.clone().all(|light| light <= 0.0) {
        return Err("has a curve that is none".into());
    }
    Ok(curve.recognised())
}

/// A curve whose values are lightness, CIE 1976 L* / 100, as one of light: \[ICC\] F.2 with PCSLAB.
fn of_lightness(curve: &Curve) -> Curve {
    const STEPS: u32 = 4096;
    let light = |lightness: f64| {
        let f = (100.0 * lightness + 16.0) / 116.0;
        if f > 6.0 / 29.0 { f * f * f } else { 3.0 * (6.0_f64 / 29.0).powi(2) * (f - 4.0 / 29.0) }
    };
    Curve::Table((0..=STEPS).map(|k| light(curve.light(f64::from(k) / f64::from(STEPS)))).collect())
}
