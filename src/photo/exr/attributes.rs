//! Attributes of our own, and those that the crate does not write as it reads them.

use exr::meta::attribute::{AttributeValue, KeyCode, Text};
use exr::meta::header::Header;

use super::super::Made;

/// Of the program's version, of the settings, and of what tells settings apart.
const VERSION: &str = "vglare.version";
const SETTINGS: &str = "vglare.settings";
const LOOK: &str = "vglare.look";

/// Says how the picture was made, in place of what an earlier run said; of a picture that is none of ours it says nothing.
pub(super) fn tell_origin(header: &mut Header, made: Option<&Made>) {
    let Some(Made { version, settings, look }) = made else { return };
    let other = &mut header.own_attributes.other;
    for (name, value) in [(VERSION, version), (SETTINGS, settings), (LOOK, look)] {
        // From bytes: the crate's own way from text knows Latin letters only.
        other.insert(Text::from(name), AttributeValue::Text(Text::from_slice_unchecked(value.as_bytes())));
    }
}

/// Gives key codes all of their seven numbers: the crate (1.74.2) reads them, and writes six, after which nobody can read the file.
pub(super) fn whole_key_codes(header: &mut Header) {
    let own = &mut header.own_attributes;
    if let Some(code) = own.film_key_code.take() {
        own.other.insert(Text::from("keyCode"), AttributeValue::KeyCode(code));
    }
    for value in own.other.values_mut() {
        if let AttributeValue::KeyCode(code) = value {
            let bytes = numbers(code).iter().flat_map(|number| number.to_le_bytes()).collect();
            *value = AttributeValue::Custom { kind: Text::from("keycode"), bytes };
        }
    }
}

fn numbers(code: &KeyCode) -> [i32; 7] {
    [
        code.film_manufacturer_code,
        code.film_type,
        code.film_roll_prefix,
        code.count,
        code.perforation_offset,
        code.perforations_per_frame,
        code.perforations_per_count,
    ]
}
