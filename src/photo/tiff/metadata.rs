//! What a TIFF says beside its picture: tags of the picture's directory, and directories of Exif and GPS that it leads to.

use std::io::{Read, Seek, Write};

use image::metadata::Orientation;
use tiff::Directory as Entries;
use tiff::encoder::{DirectoryEncoder, Rational, TiffEncoder, TiffKind};
use tiff::tags::{ResolutionUnit, Tag, Type};

use super::super::Reason;
use super::super::metadata::{Directories, Entry, Metadata, Resolution, Unit};
use super::directory::{Directory, File};

const X_RESOLUTION: u16 = 282;
const Y_RESOLUTION: u16 = 283;
const RESOLUTION_UNIT: u16 = 296;
const XMP: u16 = 700;
const IPTC: u16 = 33723;
const EXIF_IFD: u16 = 34665;
const GPS_IFD: u16 = 34853;
const INTEROP_IFD: u16 = 40965;

/// A tag larger than this is left aside.
const LARGEST: u64 = 16 << 20;

/// Of a picture that was turned so; what is wrong with it does the picture no harm.
pub(super) fn read<R: Read + Seek>(file: &mut File<R>, page: &Directory, turn: Orientation) -> Metadata {
    let mut metadata = Metadata::default();
    if let Some(exif) = directories(file, page).to_exif() {
        metadata.take_exif(exif.bytes(), turn);
    }
    if let Some(xmp) = bytes(file, page, XMP) {
        match std::str::from_utf8(&xmp) {
            Ok(packet) => metadata.take_xmp(packet.trim_end_matches('\0'), turn),
            Err(_) => metadata.left_out.push("its XMP cannot be read, and is left out".into()),
        }
    }
    // A record begins with its marker; words of the other byte order do not.
    metadata.iptc = bytes(file, page, IPTC).filter(|records| records.first() == Some(&0x1c));
    let mut number = |tag| file.reals(page, tag, 1).ok().flatten().and_then(|reals| reals.first().copied());
    let unit = match number(RESOLUTION_UNIT) {
        Some(1.0) => Unit::None,
        Some(3.0) => Unit::Centimetre,
        _ => Unit::Inch,
    };
    let resolution = number(X_RESOLUTION).zip(number(Y_RESOLUTION));
    metadata.take_resolution(resolution.and_then(|(x, y)| Resolution::new([x, y], unit)), turn);
    metadata
}

fn bytes<R: Read + Seek>(file: &mut File<R>, page: &Directory, tag: u16) -> Option<Vec<u8>> {
    if file.size_of(page, tag) > LARGEST {
        return None;
    }
    file.raw(page, tag).ok().flatten().filter(|bytes| !bytes.is_empty())
}

fn directories<R: Read + Seek>(file: &mut File<R>, page: &Directory) -> Directories {
    let mut sub = |of: &Directory, tag| {
        let at = file.number(of, tag).ok().flatten()?;
        file.directory(at).ok()
    };
    let exif = sub(page, EXIF_IFD);
    let gps = sub(page, GPS_IFD);
    let interop = exif.as_ref().and_then(|exif| sub(exif, INTEROP_IFD));
    let mut entries = |directory: Option<Directory>| {
        directory.map_or(Vec::new(), |directory| file.entries(&directory, Directories::is_movable, LARGEST))
    };
    let (exif, gps, interop) = (entries(exif), entries(gps), entries(interop));
    Directories { main: file.entries(page, Directories::is_descriptive, LARGEST), exif, gps, interop }
}

/// Writes the directories beside the picture's; what leads to them.
pub(super) fn write_beside<W: Write + Seek, K: TiffKind>(
    encoder: &mut TiffEncoder<W, K>,
    directories: &Directories,
) -> Result<Vec<(u16, K::OffsetType)>, Reason> {
    let mut led = Vec::new();
    let mut interop = None;
    let all = [(INTEROP_IFD, &directories.interop), (EXIF_IFD, &directories.exif), (GPS_IFD, &directories.gps)];
    for (tag, entries) in all {
        let inner = if tag == EXIF_IFD { interop.take() } else { None };
        if entries.is_empty() && inner.is_none() {
            continue;
        }
        let mut directory = encoder.extra_directory()?;
        write_entries(&mut directory, entries)?;
        if let Some(at) = inner {
            directory.write_tag(Tag::Unknown(INTEROP_IFD), at)?;
        }
        let at = directory.finish_with_offsets()?.offset;
        if tag == INTEROP_IFD {
            interop = Some(at);
        } else {
            led.push((tag, at));
        }
    }
    Ok(led)
}

/// Writes what stands in the picture's own directory.
pub(super) fn write_within<W: Write + Seek, K: TiffKind>(
    directory: &mut DirectoryEncoder<'_, W, K>,
    metadata: &Metadata,
    exif: Option<&Directories>,
) -> Result<(), Reason> {
    if let Some(exif) = exif {
        write_entries(directory, &exif.main)?;
    }
    if let Some(xmp) = &metadata.xmp {
        directory.write_tag(Tag::Unknown(XMP), xmp.as_bytes())?;
    }
    if let Some(iptc) = &metadata.iptc {
        directory.write_tag(Tag::Unknown(IPTC), &iptc[..])?;
    }
    if let Some(resolution) = metadata.resolution {
        let unit = match resolution.unit {
            Unit::None => ResolutionUnit::None,
            Unit::Inch => ResolutionUnit::Inch,
            Unit::Centimetre | Unit::Metre => ResolutionUnit::Centimeter,
        };
        // Metres are what PNG counts in, and are inches more often than not.
        let (unit, kept) = match (resolution.unit, resolution.in_unit(Unit::Inch)) {
            (Unit::Metre, inches) if inches.iter().all(|n| n.fract() == 0.0) => (ResolutionUnit::Inch, inches),
            (Unit::Metre, _) => (unit, resolution.in_unit(Unit::Centimetre)),
            _ => (unit, resolution.pixels),
        };
        directory.write_tag(Tag::ResolutionUnit, unit.to_u16())?;
        directory.write_tag(Tag::XResolution, rational(kept[0]))?;
        directory.write_tag(Tag::YResolution, rational(kept[1]))?;
    }
    Ok(())
}

/// A number above 0 as a fraction: exact to a thousandth, as far as 32 bits go.
fn rational(number: f64) -> Rational {
    let d: u32 = if number.fract() == 0.0 || number > 4e6 { 1 } else { 1000 };
    Rational { n: (number * f64::from(d)).round().clamp(1.0, f64::from(u32::MAX)) as u32, d }
}

fn write_entries<W: Write + Seek, K: TiffKind>(
    directory: &mut DirectoryEncoder<'_, W, K>,
    entries: &[Entry],
) -> Result<(), Reason> {
    for Entry { tag, kind, values } in entries {
        let Some(kind) = Type::from_u16(*kind) else { continue };
        let written = directory.write_entry_bytes(kind, values)?;
        let mut one = Entries::empty();
        one.extend([(Tag::from_u16_exhaustive(*tag), written)]);
        directory.extend_from(&one);
    }
    Ok(())
}

/// The directories of Exif for a file in the photo's own colour space, or in sRGB.
pub(super) fn exif_of(metadata: &Metadata, srgb: bool) -> Option<Directories> {
    Directories::of(&metadata.exif_of(srgb)?)
}
