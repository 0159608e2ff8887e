//! Writes a photo beside its target, then renames it.

use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, Cursor, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use super::display::Look;
use super::{Depth, Format, Photo, Reason, ToneMap, exr, jpeg, pfm, png, radiance, tiff};
use crate::error::{Error, Result};

/// How a photo is written.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WriteOptions {
    /// How samples are stored. By default OpenEXR and TIFF keep the input's depth if it was of the same format, else
    /// they are float; PNG is 16 bit if the input was, else 8; the others have one depth.
    pub depth: Option<Depth>,
    /// In stops; for display formats only (PNG, JPEG, integer TIFF).
    pub exposure: f64,
    /// For display formats only. By default none if the input was display-referred, else [`ToneMap::Agx`].
    pub tone_map: Option<ToneMap>,
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

enum Target {
    /// A file, written under another name in `folder` first.
    File { path: PathBuf, folder: PathBuf },
    /// A pipe or a device: written to as it is.
    Stream,
}

/// Whether [`write()`] knows the format that a name's extension asks for.
///
/// # Errors
/// [`Error::Write`] where it does not.
pub fn check_name(path: &Path) -> Result<()> {
    Format::from_extension(path).map(drop).map_err(|reason| Error::write(path, reason))
}

/// Whether [`write()`] would accept this target and these options: ask before the long work starts.
///
/// # Errors
/// [`Error::Exists`] where the file is there and must not be replaced; [`Error::Write`] for an extension that is no
/// format, a depth that the format cannot hold, an exposure or a tone map for a scene-linear format, a picture too
/// large for the format, a folder that is missing or cannot be written to.
pub fn check_target(path: &Path, photo: &Photo, options: &WriteOptions) -> Result<()> {
    let plan = plan(path, photo, options)?;
    match &plan.target {
        // A file made and removed again is the one honest test.
        Target::File { folder, .. } => temporary(folder).map(drop).map_err(|reason| Error::write(path, reason)),
        Target::Stream => Ok(()),
    }
}

/// Writes a photo in the format that the extension names (`.exr .hdr .pfm .tif .tiff .png .jpg .jpeg`).
///
/// Scene-linear formats get the pixels as they are; display formats get exposure, tone map and the sRGB curve, and at
/// 8 bit a dither that leaves values alone which sit on a code. All but OpenEXR get the picture only, padded with
/// transparent black, in Rec.709 primaries. OpenEXR keeps all else that the input file held, if it was OpenEXR.
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
/// Those of [`write`], and [`Error::Cancelled`]; nothing is left behind then, unless `path` is a pipe.
pub fn write_unless(path: &Path, photo: &Photo, options: &WriteOptions, cancelled: impl Fn() -> bool) -> Result<()> {
    let plan = plan(path, photo, options)?;
    let complain = |reason: Reason| if cancelled() { Error::Cancelled } else { Error::write(path, reason) };
    match &plan.target {
        Target::File { path: target, folder } => {
            let file = temporary(folder).map_err(complain)?;
            let guarded = Guarded { file: file.as_file(), cancelled: &cancelled };
            plan.encode(guarded, photo).map_err(complain)?;
            if cancelled() {
                return Err(Error::Cancelled);
            }
            persist(file, path, target, options.overwrite)
        }
        Target::Stream => {
            // Encoders jump back to fill in sizes, which a pipe cannot.
            let mut memory = Cursor::new(Vec::new());
            plan.encode(&mut memory, photo).map_err(complain)?;
            let stream = File::options().write(true).open(path);
            stream.and_then(|mut stream| stream.write_all(memory.get_ref())).map_err(|e| complain(e.into()))
        }
    }
}

/// A file that takes no more once it is called off.
struct Guarded<'a, F> {
    file: F,
    cancelled: &'a dyn Fn() -> bool,
}

impl<F: Write> Write for Guarded<'_, F> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if (self.cancelled)() { Err(io::Error::other("cancelled")) } else { self.file.write(bytes) }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl<F: Seek> Seek for Guarded<'_, F> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl Plan {
    fn encode(&self, file: impl Write + Seek, photo: &Photo) -> Result<(), Reason> {
        let mut writer = BufWriter::with_capacity(1 << 18, file);
        match (self.format, self.depth) {
            (Format::OpenExr, depth) => exr::write(&mut writer, photo, depth)?,
            (Format::Radiance, _) => radiance::write(&mut writer, photo)?,
            (Format::Pfm, _) => pfm::write(&mut writer, photo)?,
            (Format::Tiff, depth) => tiff::write(&mut writer, photo, depth, self.look)?,
            (Format::Png, Depth::Sixteen) => png::write::<u16>(&mut writer, photo, self.look)?,
            (Format::Png, _) => png::write::<u8>(&mut writer, photo, self.look)?,
            (Format::Jpeg, _) => jpeg::write(&mut writer, photo, self.look)?,
        }
        Ok(writer.flush()?)
    }
}

fn plan(path: &Path, photo: &Photo, options: &WriteOptions) -> Result<Plan> {
    let resolved = Format::from_extension(path).and_then(|format| {
        check_picture(photo, format)?;
        let depth = depth(format, photo, options.depth)?;
        Ok((format, depth, look(format, depth, photo, options)?))
    });
    let (format, depth, look) = resolved.map_err(|reason| Error::write(path, reason))?;
    Ok(Plan { format, depth, look, target: target(path, options.overwrite)? })
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

fn look(format: Format, depth: Depth, photo: &Photo, options: &WriteOptions) -> Result<Look, Reason> {
    if !options.exposure.is_finite() {
        return Err(format!("an exposure of {} stops makes no picture", options.exposure).into());
    }
    let asks = options.exposure != 0.0 || options.tone_map.is_some_and(|map| map != ToneMap::None);
    if asks && !depth.is_display() {
        let (format, depth) = (format.name(), depth.name());
        return Err(format!("{depth} {format} holds scene-linear light, which gets no exposure and no tone map").into());
    }
    let fallback = if photo.source.display_referred { ToneMap::None } else { ToneMap::default() };
    Ok(Look { gain: options.exposure.exp2() as f32, tone_map: options.tone_map.unwrap_or(fallback) })
}

fn target(path: &Path, overwrite: bool) -> Result<Target> {
    // A link is followed, so that it stays a link.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    match fs::symlink_metadata(&target) {
        Ok(kind) if kind.is_dir() => return Err(Error::write(path, "it is a folder")),
        Ok(kind) if !kind.is_file() && !kind.is_symlink() => return Ok(Target::Stream),
        Ok(_) if !overwrite => return Err(Error::Exists { path: path.to_owned() }),
        _ => {}
    }
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    if !folder.is_dir() {
        return Err(Error::write(path, format!("there is no folder {}", folder.display())));
    }
    Ok(Target::File { path: target, folder })
}

/// A file in `folder` that vanishes unless it is persisted.
fn temporary(folder: &Path) -> Result<NamedTempFile, Reason> {
    let mut builder = Builder::new();
    builder.prefix(".vglare-").suffix(".part");
    // The library's own default is for secrets; a picture gets what the umask leaves, like any other file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    Ok(builder.tempfile_in(folder)?)
}

fn persist(file: NamedTempFile, path: &Path, target: &Path, overwrite: bool) -> Result<()> {
    let before: Option<Permissions> = fs::metadata(target).ok().map(|old| old.permissions());
    if let Some(permissions) = before.filter(|_| overwrite) {
        file.as_file().set_permissions(permissions).map_err(|error| Error::write(path, error))?;
    }
    let done = if overwrite { file.persist(target) } else { file.persist_noclobber(target) };
    match done {
        Ok(_) => Ok(()),
        Err(error) if error.error.kind() == std::io::ErrorKind::AlreadyExists => {
            Err(Error::Exists { path: path.to_owned() })
        }
        Err(error) => Err(Error::write(path, error.error)),
    }
}
