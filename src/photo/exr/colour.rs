//! What a part says of its colours, by the recommendation of the ASWF's Color Interop Forum, "Identifying the Color Space of OpenEXR
//! Files" (draft of May 2026).
//!
//! `acesImageContainerFlag` comes first, then `colorInteropID`, then `chromaticities`; where none of them says anything, nothing is known.

use exr::math::Vec2;
use exr::meta::attribute::{AttributeValue, Chromaticities, Text};
use exr::meta::header::Header;
use glam::DVec2;

use super::super::{Primaries, Source};
use super::layer::{Colours, Layer};
use super::names::text;
use super::read;

/// The attribute that names a colour space.
const ID: &str = "colorInteropID";

/// The attribute of files by SMPTE ST 2065-4, whose colours are those of ACES2065-1.
const ACES: &str = "acesImageContainerFlag";

/// The linear, scene-referred spaces of annex A, and CIE XYZ as it stands, whose white is that of D65.
const KNOWN: [(&str, Primaries); 7] = [
    ("lin_rec709_scene", Primaries::REC709),
    ("lin_p3d65_scene", Primaries::P3_D65),
    ("lin_rec2020_scene", Primaries::REC2020),
    ("lin_ap0_scene", Primaries::ACES2065_1),
    ("lin_ap1_scene", Primaries::ACESCG),
    ("lin_adobergb_scene", Primaries::ADOBE_RGB),
    ("lin_ciexyzd65_scene", Primaries::XYZ),
];

/// What a file says of the primaries of a part.
pub(super) enum Told {
    /// These.
    Primaries(Primaries),
    /// A space that is not known here, or not linear.
    Unknown(String),
    /// Nothing.
    Nothing,
}

/// Whether a part says that it holds data and no colours.
pub(super) fn is_data(header: &Header) -> bool {
    id(header).as_deref() == Some("data")
}

/// What the first of these parts says of its colours, or the first that says anything at all: not every writer repeats it in each.
pub(super) fn told(headers: &[&Header]) -> Told {
    if headers[0].own_attributes.other.get(ACES.as_bytes()) == Some(&AttributeValue::I32(1)) {
        return Told::Primaries(Primaries::ACES2065_1);
    }
    let named = headers.iter().find_map(|header| id(header).filter(|id| !["data", "unknown", ""].contains(&&**id)));
    let chromaticities = || headers.iter().find_map(|header| header.shared_attributes.chromaticities);
    match named {
        Some(id) => match KNOWN.into_iter().find(|(known, _)| *known == id) {
            Some((_, primaries)) => Told::Primaries(primaries),
            None => Told::Unknown(id),
        },
        None => chromaticities().map_or(Told::Nothing, |known| Told::Primaries(read::primaries(known))),
    }
}

fn id(header: &Header) -> Option<String> {
    match header.own_attributes.other.get(ID.as_bytes())? {
        AttributeValue::Text(id) => Some(text(id).into_owned()),
        _ => None,
    }
}

/// Has the headers of a photo's file say what its pixels' primaries are, where they say something else: a space that has a name by that alone,
/// as the recommendation has it, others by `chromaticities`. What no longer holds is dropped.
pub(super) fn tag(headers: &mut [Header], layer: &Layer, source: &Source) {
    if !source.knows_primaries || layer.colours == Colours::Xyz && source.primaries == Some(Primaries::XYZ) {
        return;
    }
    let primaries = source.primaries.unwrap_or(Primaries::REC709);
    let all: Vec<&Header> = std::iter::once(&headers[layer.part()]).chain(headers.iter()).collect();
    if matches!(told(&all), Told::Primaries(told) if told.near(primaries)) {
        return;
    }
    // All parts share their chromaticities, so that those of the others have to be said by name.
    for header in headers.iter_mut() {
        let name = header.shared_attributes.chromaticities.take().and_then(|known| name(read::primaries(known)));
        if let (Some(name), None) = (name, id(header)) {
            header.own_attributes.other.insert(Text::from(ID), AttributeValue::Text(Text::from(name)));
        }
    }
    let shared = name(primaries).is_none().then(|| chromaticities(primaries));
    headers.iter_mut().for_each(|header| header.shared_attributes.chromaticities = shared);
    layer.members.iter().for_each(|member| say(&mut headers[member.part], primaries));
}

/// Has a header say what primaries are, and nothing else of colours.
pub(super) fn say(header: &mut Header, primaries: Primaries) {
    let (own, shared) = (&mut header.own_attributes, &mut header.shared_attributes);
    own.other.remove(ACES.as_bytes());
    own.other.remove(ID.as_bytes());
    own.adopted_neutral = None;
    match name(primaries) {
        Some(name) => {
            own.other.insert(Text::from(ID), AttributeValue::Text(Text::from(name)));
            shared.chromaticities = None;
        }
        None => shared.chromaticities = Some(chromaticities(primaries)),
    }
}

/// What a space is called in `colorInteropID`.
fn name(primaries: Primaries) -> Option<&'static str> {
    KNOWN.iter().find(|(_, known)| known.near(primaries)).map(|(name, _)| *name)
}

fn chromaticities(primaries: Primaries) -> Chromaticities {
    let point = |p: DVec2| Vec2(p.x as f32, p.y as f32);
    let Primaries { red, green, blue, white } = primaries;
    Chromaticities { red: point(red), green: point(green), blue: point(blue), white: point(white) }
}
