//! The profiles that go into files for displays.

use std::sync::LazyLock;

use moxcms::{ColorDateTime, ColorProfile, LocalizableString, ProfileText};

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
    // The same picture is the same file, whenever it is written.
    profile.creation_date_time =
        ColorDateTime { year: 2026, month: 1, day_of_the_month: 1, hours: 0, minutes: 0, seconds: 0 };
    profile.cicp = None;
    profile.encode().ok()
}
