//! A photo into a file of any format.

use std::path::Path;

use super::display::Look;
use super::{Depth, Format, Photo, Primaries, Reason, ToneMap, exr, jpeg, pfm, png, radiance, tiff};
use crate::error::{Error, Result};
use crate::target::{Sink, Target};

/// How a photo is written.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WriteOptions {
    /// The format, where the file's name does not tell it; an error where it tells another.
    pub format: Option<Format>,
    /// How samples are stored. By default OpenEXR and TIFF keep the input's depth if it was of the same format, else
    /// they are float; PNG is 16 bit if the input was, else 8; the others have one depth.
    pub depth: Option<Depth>,
    /// In stops; for display formats only (PNG, JPEG, integer TIFF).
    pub exposure: f64,
    /// For display formats only. By default none if the input was display-referred, else [`ToneMap::Agx`].
    pub tone_map: Option<ToneMap>,
    /// The primaries that the picture is written in, for scene-linear formats only. By default those of the photo where the format can say so, else
    /// Rec.709's.
    pub primaries: Option<Primaries>,
    /// Whether an existing file is replaced.
    pub overwrite: bool,
}

/// What an output will be, once the options are resolved.
struct Plan {
    format: Format,
    depth: Depth,
    look: Look,
    target: Target,
}

/// Whether [`write()`] knows the format that a name's extension asks for, or that is asked for where it does not tell.
///
/// # Errors
/// [`Error::Write`] where it does not, or where the two differ.
pub fn check_name(path: &Path, format: Option<Format>) -> Result<()> {
    Format::of_name(path, format).map(drop).map_err(|reason| Error::write(path, reason))
}

/// Whether the format that a name or `format` asks for holds samples of this depth.
pub(crate) fn holds(path: &Path, format: Option<Format>, depth: Depth) -> bool {
    Format::of_name(path, format).is_ok_and(|format| format.depths().contains(&depth))
}

/// Whether [`write()`] would accept this target and these options: ask before the long work starts.
///
/// # Errors
/// [`Error::Exists`] where the file is there and must not be replaced; [`Error::Write`] for an extension that is no
/// format, a depth that the format cannot hold, an exposure or a tone map for a scene-linear format, a picture too
/// large for the format, a folder that is missing or cannot be written to.
pub fn check_target(path: &Path, photo: &Photo, options: &WriteOptions) -> Result<()> {
    plan(path, photo, options)?.target.try_out()
}

/// The largest value of light that the file would hold: beyond it a pixel is not what it was. Infinite for a display's
/// formats, which show what is brighter than white as white.
///
/// # Errors
/// [`Error::Write`] for an extension that is no format, or a depth that the format cannot hold.
pub fn largest_value(path: &Path, photo: &Photo, options: &WriteOptions) -> Result<f32> {
    let (_, depth) = kind(path, photo, options).map_err(|reason| Error::write(path, reason))?;
    Ok(match depth {
        Depth::Half => half::f16::MAX.to_f32(),
        Depth::Float => f32::MAX,
        Depth::Uint => u32::MAX as f32,
        Depth::Eight | Depth::Sixteen => f32::INFINITY,
    })
}

/// Writes a photo in the format that the extension names (`.exr .hdr .pfm .tif .tiff .png .jpg .jpeg`), or the options
/// where it names none; `-` is standard output.
///
/// Scene-linear formats get the pixels as they are; display formats get exposure, tone map and the curves of the photo's
/// own colour space, where it was display-referred, or of sRGB, and at 8 bit a dither that leaves values alone which sit
/// on a code. All but OpenEXR get the picture only, padded with transparent black; what is scene-linear, in Rec.709
/// primaries. OpenEXR keeps all else that the input file held, if it was OpenEXR; PNG, TIFF and JPEG keep Exif, XMP, IPTC
/// and the resolution of one of these, as far as they can hold them.
///
/// The file appears under its name only when it is complete.
///
/// # Errors
/// Those of [`check_target`], and [`Error::Write`] where the disk is full or the system refuses.
pub fn write(path: &Path, photo: &Photo, options: &WriteOptions) -> Result<()> {
    write_unless(path, photo, options, || false)
}

/// The same, unless it is called off: `cancelled` is asked with every quarter of a megabyte, and before the file gets
/// its name.
///
/// # Errors
/// Those of [`write()`], and [`Error::Cancelled`]; nothing is left behind then, unless `path` is a pipe.
pub fn write_unless(path: &Path, photo: &Photo, options: &WriteOptions, cancelled: impl Fn() -> bool) -> Result<()> {
    let plan = plan(path, photo, options)?;
    let converted = options.primaries.map(|primaries| photo.in_primaries(primaries));
    let photo = converted.as_ref().unwrap_or(photo);
    plan.target.write(&cancelled, |sink| plan.encode(sink, photo))
}

impl Plan {
    fn encode(&self, mut writer: &mut dyn Sink, photo: &Photo) -> Result<(), Reason> {
        match (self.format, self.depth) {
            (Format::OpenExr, depth) => exr::write(&mut writer, photo, depth),
            (Format::Radiance, _) => radiance::write(&mut writer, photo),
            (Format::Pfm, _) => pfm::write(&mut writer, photo),
            (Format::Tiff, depth) => tiff::write(&mut writer, photo, depth, self.look),
            (Format::Png, Depth::Sixteen) => png::write::<u16>(&mut writer, photo, self.look),
            (Format::Png, _) => png::write::<u8>(&mut writer, photo, self.look),
            (Format::Jpeg, _) => jpeg::write(&mut writer, photo, self.look),
            (Format::JpegXl, _) => Err("vglare does not write JPEG XL".into()),
        }
    }
}

fn plan(path: &Path, photo: &Photo, options: &WriteOptions) -> Result<Plan> {
    // Field by field: a new one has to be used here, or not to be.
    let &WriteOptions { format, depth: asked, exposure, tone_map, primaries, overwrite } = options;
    let resolved = Format::of_name(path, format).and_then(|format| {
        check_picture(photo, format)?;
        let depth = depth(format, photo, asked)?;
        primaries.map_or(Ok(()), |_| check_space(photo, format, depth))?;
        Ok((format, depth, look(format, depth, photo, exposure, tone_map)?))
    });
    let (format, depth, look) = resolved.map_err(|reason| Error::write(path, reason))?;
    let target = Target::new(path, overwrite)?;
    if target.is_terminal() {
        return Err(Error::write(
            path,
            "standard output is a terminal; lead it into a file by >, or into a program by |",
        ));
    }
    Ok(Plan { format, depth, look, target })
}

/// The format and the depth that a photo is written in.
///
/// # Errors
/// Where the name or the options ask for what there is not.
pub(super) fn kind(path: &Path, photo: &Photo, options: &WriteOptions) -> Result<(Format, Depth), Reason> {
    let &WriteOptions { format, depth: asked, exposure: _, tone_map: _, primaries: _, overwrite: _ } = options;
    let format = Format::of_name(path, format)?;
    Ok((format, depth(format, photo, asked)?))
}

fn check_picture(photo: &Photo, format: Format) -> Result<(), Reason> {
    let (width, height) = (photo.width(), photo.height());
    if photo.pixels.len() != photo.frame.window.pixels() {
        return Err("the photo has not as many pixels as its window".into());
    }
    if width == 0 || height == 0 || photo.pixels.is_empty() {
        return Err(format!("the picture has no pixels: {width} × {height}").into());
    }
    let longest = jpeg::LONGEST_SIDE;
    if format == Format::Jpeg && width.max(height) > longest {
        return Err(format!("JPEG holds at most {longest} columns and rows, not {width} × {height}").into());
    }
    Ok(())
}

fn depth(format: Format, photo: &Photo, asked: Option<Depth>) -> Result<Depth, Reason> {
    let source = &photo.source;
    let same_format = source.format == Some(format);
    let depths = format.depths();
    match asked {
        Some(depth) if depths.contains(&depth) => Ok(depth),
        Some(depth) => {
            let names: Vec<_> = depths.iter().map(|d| d.name()).collect();
            Err(format!("{} holds {}, not {}", format.name(), names.join(", "), depth.name()).into())
        }
        // OpenEXR keeps integers, which it cannot be asked for; TIFF does not write the half floats that it reads.
        None if same_format && (depths.contains(&source.depth) || source.depth == Depth::Uint) => Ok(source.depth),
        None if format == Format::Png && source.depth == Depth::Sixteen => Ok(Depth::Sixteen),
        None => Ok(*depths.last().expect("a format has a depth")),
    }
}

/// Whether a file can be written in other primaries.
fn check_space(photo: &Photo, format: Format, depth: Depth) -> Result<(), Reason> {
    if depth.is_display() {
        let (format, depth) = (format.name(), depth.name());
        return Err(format!("{depth} {format} is made for a display, and is written as sRGB").into());
    }
    if format == Format::OpenExr && photo.source.exr.as_ref().is_some_and(|rest| rest.is_xyz()) {
        return Err("its channels X, Y and Z hold CIE XYZ, and no other primaries".into());
    }
    Ok(())
}

fn look(format: Format, depth: Depth, photo: &Photo, exposure: f64, tone_map: Option<ToneMap>) -> Result<Look, Reason> {
    if !exposure.is_finite() {
        return Err(format!("an exposure of {exposure} stops makes no picture").into());
    }
    let asks = exposure != 0.0 || tone_map.is_some_and(|map| map != ToneMap::None);
    if asks && !depth.is_display() {
        let (format, depth) = (format.name(), depth.name());
        return Err(format!("{depth} {format} holds scene-linear light, which gets no exposure and no tone map").into());
    }
    let fallback = if photo.source.display_referred { ToneMap::None } else { ToneMap::default() };
    Ok(Look { gain: exposure.exp2() as f32, tone_map: tone_map.unwrap_or(fallback) })
}
