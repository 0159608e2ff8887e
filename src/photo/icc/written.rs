//! The profiles that go into files for displays.

use std::sync::LazyLock;

use moxcms::{ColorProfile, LocalizableString, ProfileText};

use super::super::Reason;

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
