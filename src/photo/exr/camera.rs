//! What the attributes of a part say of the camera.
//!
//! Standard are three focal lengths and the distance of photosites; `fieldOfViewHorizontal` and `fieldOfViewVertical` are
//! written by 3Delight, and Exif's tags, under `Exif:` and their names, by OpenImageIO. The size of the whole sensor by itself says nothing, since the
//! picture may be of a part of it; nor does `screenWindowWidth`, which is 1 in files of renderers whose field is another than that
//! says, and `worldToNDC`, of which some have the picture from 0 to 1 and others from −1 to 1.

use exr::meta::attribute::{AttributeValue, Text};
use exr::meta::header::Header;

use super::super::camera::{Camera, tag};

/// The focal lengths, the best first: that by which a pinhole sees the same, then that of the lens, then what is engraved on it.
const FOCAL_LENGTHS: [&str; 3] = ["pinholeFocalLength", "effectiveFocalLength", "nominalFocalLength"];

pub(super) fn of(header: &Header) -> Option<Camera> {
    let (own, shared) = (&header.own_attributes, &header.shared_attributes);
    let value = |name: &str| {
        let name = Text::new_or_none(name)?;
        own.other.get(&name).or_else(|| shared.other.get(&name))
    };
    let number = |name: &str| match value(name)? {
        AttributeValue::F32(number) => Some(f64::from(*number)),
        AttributeValue::F64(number) => Some(*number),
        AttributeValue::I32(number) => Some(f64::from(*number)),
        &AttributeValue::Rational((number, of)) => Some(f64::from(number) / f64::from(of)),
        _ => None,
    };
    let by_angles =
        || Camera::of_angles([own.horizontal_field_of_view, own.vertical_field_of_view].map(|a| a.map(f64::from)));
    let by_sensor = || {
        let focal = FOCAL_LENGTHS.iter().find_map(|name| number(name).filter(|focal| *focal > 0.0))?;
        let AttributeValue::IntegerBounds(bounds) = value("sensorAcquisitionRectangle")? else { return None };
        Camera::of_sensor(
            focal,
            number("sensorPhotositePitch")?,
            [bounds.size.width() as f64, bounds.size.height() as f64],
        )
    };
    let by_exif = || {
        Camera::of_exif(|wanted| {
            let (_, name) = tag::NAMES.into_iter().find(|(known, _)| *known == wanted)?;
            number(&format!("Exif:{name}"))
        })
    };
    by_angles().or_else(by_sensor).or_else(by_exif)
}
