//! What of a photo's meaning a file of another kind cannot hold.

use std::path::Path;

use super::{Format, Photo, Primaries, ToneMap, WriteOptions, metadata, native, write};

/// What a person ought to know of how `photo` becomes `path` with these options, a sentence each: nothing where it
/// keeps its colours' meaning, or where [`write()`](super::write()) would refuse.
pub fn lost(path: &Path, photo: &Photo, options: &WriteOptions) -> Vec<String> {
    let Ok((format, depth)) = write::kind(path, photo, options) else { return Vec::new() };
    let beside = metadata::of(photo).map_or(Vec::new(), |metadata| metadata.lost(format));
    let mapped = options.tone_map.is_some_and(|map| map != ToneMap::None);
    let colours = match options.primaries {
        Some(primaries) => space(photo, format, primaries),
        None => colours(photo, format, depth.is_display(), mapped).into_iter().collect(),
    };
    colours.into_iter().chain(exposure(photo, format)).chain(beside).collect()
}

/// What becomes of colours, in a file for displays, whose tone map may have been asked for, or in one of light.
fn colours(photo: &Photo, format: Format, display: bool, mapped: bool) -> Option<String> {
    let source = &photo.source;
    let name = |primaries: super::Primaries| primaries.title().unwrap_or("primaries of their own").to_owned();
    let own = source.primaries.map(name);
    if display {
        let from = own.or(source.space.clone())?;
        if native::of(photo, format).is_some() {
            return mapped.then(|| {
                format!("the tone map is sRGB's: of the photo's colours, {from}, those outside it are clipped")
            });
        }
        return Some(format!("the photo's colours, {from}, are written as sRGB, and those outside it are clipped"));
    }
    match format {
        // They keep primaries, or know no others, but those that are negative in Rec. 709.
        Format::OpenExr => None,
        Format::Radiance if source.radiance.is_some() && source.space.is_none() => None,
        Format::Radiance => {
            let from = own.or(source.space.clone())?;
            Some(format!("the photo's colours, {from}, are written as Rec. 709, and those outside it are clipped"))
        }
        _ => own.map(|from| format!("the photo's colours, {from}, are written as Rec. 709")),
    }
}

/// Of a file in primaries that were asked for.
fn space(photo: &Photo, format: Format, primaries: Primaries) -> Vec<String> {
    let source = &photo.source;
    let mut notes = Vec::new();
    if !source.knows_primaries && !source.display_referred {
        notes.push("the photo's file does not say what its primaries are: they are taken for Rec. 709's".to_owned());
    }
    let title = primaries.title().unwrap_or("primaries of their own");
    if matches!(format, Format::Tiff | Format::Pfm) {
        notes.push(format!("{} cannot say that its colours are {title}: --primaries does", format.name()));
    }
    if format == Format::OpenExr && source.exr.is_some() && source.picture.is_some() {
        notes.push("the photo's other layers stay in the primaries of its file".to_owned());
    }
    notes
}

fn exposure(photo: &Photo, format: Format) -> Option<String> {
    let exposure = photo.source.radiance.as_ref()?.exposure();
    // OpenEXR says what white is with it, where one number says that.
    let kept = match format {
        Format::Radiance => true,
        Format::OpenExr => photo.source.luminance.as_ref().is_some_and(|said| said.white().is_some()),
        _ => false,
    };
    let is_one = exposure == [1.0; 3] || exposure.iter().any(|factor| factor.is_nan());
    (!kept && !is_one).then(|| {
        let [r, g, b] = exposure;
        let value = if r == g && r == b { format!("{r}") } else { format!("{r} {g} {b}") };
        format!("the photo's EXPOSURE of {value} is lost: its pixels are written as they stand, multiplied by it")
    })
}
