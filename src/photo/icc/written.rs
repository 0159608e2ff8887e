//! The profiles that go into files for displays.

use std::sync::LazyLock;

use glam::{DMat3, DVec3};
use moxcms::{ColorProfile, LocalizableString, ProfileText, ToneReprCurve, Xyzd};

use super::super::decode::Shaper;
use super::super::transfer::Curve;
use super::super::{Primaries, Reason};

/// Steps of a curve that stands in a table.
const STEPS: u32 = 4096;

static RGB: LazyLock<Option<Vec<u8>>> = LazyLock::new(|| encoded(ColorProfile::new_srgb(), "sRGB"));
static GREY: LazyLock<Option<Vec<u8>>> = LazyLock::new(|| {
    let mut profile = ColorProfile::new_gray_with_gamma(2.2);
    profile.gray_trc = ColorProfile::new_srgb().red_trc;
    encoded(profile, "sRGB grey")
});

/// The profile that says sRGB, for pictures of three colours or of grey.
///
/// # Errors
/// None that is known: moxcms makes them both.
pub(in super::super) fn srgb_profile(grey: bool) -> Result<&'static [u8], Reason> {
    let profile = if grey { &GREY } else { &RGB };
    profile.as_deref().ok_or_else(|| "there is no ICC profile of sRGB".into())
}

/// A profile that says what a shaper does; none where it has curves that \[ICC\] has no type for, as PQ.
pub(in super::super) fn profile_of(shaper: &Shaper) -> Option<Vec<u8>> {
    let mut profile = ColorProfile::new_srgb();
    let pcs = Primaries::pcs_to_rec709().inverse() * shaper.matrix.unwrap_or(DMat3::IDENTITY);
    let colorant = |column: DVec3| Xyzd { x: column.x, y: column.y, z: column.z };
    profile.red_colorant = colorant(pcs.x_axis);
    profile.green_colorant = colorant(pcs.y_axis);
    profile.blue_colorant = colorant(pcs.z_axis);
    let [red, green, blue] = &shaper.curves;
    profile.red_trc = Some(trc(red)?);
    profile.green_trc = Some(trc(green)?);
    profile.blue_trc = Some(trc(blue)?);
    encoded(profile, shaper.space.as_deref().unwrap_or("Rec. 709 with a curve of its own"))
}

/// \[ICC\] 10.6 and 10.18.
fn trc(curve: &Curve) -> Option<ToneReprCurve> {
    let parametric = |values: &[f64]| ToneReprCurve::Parametric(values.iter().map(|&value| value as f32).collect());
    Some(match curve {
        Curve::Linear => ToneReprCurve::Lut(Vec::new()),
        Curve::Srgb => ColorProfile::new_srgb().red_trc?,
        Curve::Power(exponent) => parametric(&[*exponent]),
        Curve::Rec709 => parametric(&[1.0 / 0.45, 1.0 / 1.099, 0.099 / 1.099, 1.0 / 4.5, 0.081]),
        Curve::Parametric(values) => parametric(values),
        Curve::Table(_) => {
            let step = |k: u32| curve.light(f64::from(k) / f64::from(STEPS - 1)).clamp(0.0, 1.0);
            ToneReprCurve::Lut((0..STEPS).map(|k| (step(k) * 65535.0).round() as u16).collect())
        }
        Curve::Pq | Curve::Hlg => return None,
    })
}

fn encoded(mut profile: ColorProfile, name: &str) -> Option<Vec<u8>> {
    let text =
        |value: &str| ProfileText::Localizable(vec![LocalizableString::new("en".into(), "GB".into(), value.into())]);
    profile.description = Some(text(name));
    profile.copyright = Some(text("No copyright, use freely"));
    profile.cicp = None;
    let mut profile = profile.encode().ok()?;
    // The same picture is the same file, whenever it is written: [ICC] 4.2, a date of 12 bytes.
    profile[24..36].copy_from_slice(&[7, 234, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0]);
    Some(profile)
}
