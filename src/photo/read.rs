//! Opens a file, tells its format by its content, and decodes it.

use std::cell::Cell;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, IsTerminal as _, Read, Seek};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use super::{Format, Photo, Primaries, Reason, WhiteLuminance, exr, jpeg, jxl, luminance, pfm, png, radiance, tiff};
use crate::error::{Error, Result};
use crate::frame::Frame;
use crate::target;

/// The most pixels that a photo may have, 2^29: 8 GiB in memory.
pub const MAX_PIXELS: usize = 1 << 29;

thread_local! {
    /// The most pixels of the photo that this thread is reading: decoders ask for it from deep within.
    static MOST_PIXELS: Cell<usize> = const { Cell::new(MAX_PIXELS) };
}

/// What becomes of pixels that an unfinished file lacks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Missing {
    /// The file is refused.
    #[default]
    Refuse,
    /// They are 0.
    Zero,
}

/// How a photo is read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadOptions {
    /// What becomes of pixels that an unfinished file lacks (OpenEXR only).
    pub missing: Missing,
    /// The primaries of the file's numbers, whatever the file says of them.
    pub primaries: Option<Primaries>,
    /// What white is in cd/m²; without it what the file itself says, if anything.
    pub white_luminance: Option<WhiteLuminance>,
    /// What part of the file's width and height lies beyond each edge of the picture, from 0 to less than 1/2: pixels there are stored,
    /// and shine, but are none of the picture.
    pub overscan: f64,
    /// The most pixels that the file may say it has, at most [`MAX_PIXELS`], which is the default.
    pub max_pixels: Option<usize>,
    /// The part of an OpenEXR file that the picture is in: its name, or its number from 0 on.
    pub part: Option<String>,
    /// The layer of an OpenEXR file that is the picture, `beauty` where its channels are `beauty.R`, `beauty.G`, `beauty.B`: what their names begin
    /// with, or the name of the part where they begin with nothing; empty for those without any such name.
    pub layer: Option<String>,
}

/// Reads a photo; `-` is standard input.
///
/// # Errors
/// [`Error::ReadPhoto`] with the reason: missing, empty, cut short, damaged, of another kind, of no or more than
/// [`MAX_PIXELS`] pixels.
pub fn read(path: &Path) -> Result<Photo> {
    read_with(path, &ReadOptions::default())
}

/// Reads a photo in the way that is asked for.
///
/// # Errors
/// Those of [`read`], and where there is no such part or layer; the reason lists those that there are.
pub fn read_with(path: &Path, options: &ReadOptions) -> Result<Photo> {
    let decoded = || -> std::result::Result<Photo, Reason> {
        let mut reader = open(path)?;
        let format = Format::from_magic(reader.fill_buf()?)?;
        if format != Format::OpenExr && (options.part.is_some() || options.layer.is_some()) {
            return Err(format!("it is {}, which has no parts and layers to choose from", format.name()).into());
        }
        let mut photo = decode(reader, format, options)?;
        // What is decoded for a display has become Rec. 709.
        photo.source.knows_primaries |= photo.source.display_referred || photo.source.space.is_some();
        // A JPEG with a gain map is scene-linear, and of Rec. 709's primaries whatever its own are, as is what comes of JPEG XL.
        if let Some(primaries) = options.primaries
            && !photo.source.display_referred
            && !matches!(format, Format::Jpeg | Format::JpegXl)
        {
            photo.source.primaries = primaries.other_than_rec709();
            photo.source.knows_primaries = true;
        }
        luminance::settle(&mut photo, options.white_luminance)?;
        shape_pixels(&mut photo);
        overscanned(&mut photo, options.overscan);
        Ok(photo)
    };
    // Decoders of foreign files are the one place where a panic is not a bug of ours.
    MOST_PIXELS.set(options.max_pixels.map_or(MAX_PIXELS, |most| most.min(MAX_PIXELS)));
    let result = catch_unwind(AssertUnwindSafe(decoded));
    MOST_PIXELS.set(MAX_PIXELS);
    match result {
        Ok(Ok(photo)) => Ok(photo),
        Ok(Err(reason)) => Err(Error::read_photo(path, explain(&*reason))),
        Err(_) => Err(Error::read_photo(path, "the file is damaged, and its decoder gave up")),
    }
}

/// Leaves a part of the picture at each edge outside of it, where it is stored all the same.
fn overscanned(photo: &mut Photo, part: f64) {
    let Frame { width, height, window, .. } = &mut photo.frame;
    let beyond =
        [*width, *height].map(|side| ((part * f64::from(side)).round() as u32).min(side.saturating_sub(1) / 2));
    (*width, *height) = (*width - 2 * beyond[0], *height - 2 * beyond[1]);
    (window.x, window.y) = (window.x - beyond[0] as i32, window.y - beyond[1] as i32);
    photo.source.overscan = beyond;
    // Nobody else has it yet.
    if let Some(rest) = photo.source.exr.as_mut().and_then(std::sync::Arc::get_mut) {
        rest.overscan(beyond);
    }
}

/// Gives the picture the shape of its pixels, where that is one that pixels have.
fn shape_pixels(photo: &mut Photo) {
    let aspect = photo.source.pixel_aspect;
    if Frame::PIXEL_ASPECTS.contains(&aspect) {
        photo.frame.pixel_aspect = aspect;
        return;
    }
    let note = format!("it says that a pixel is {aspect:e} times as wide as high; they are taken to be square");
    photo.source.notes.push(note);
    photo.source.pixel_aspect = 1.0;
}

fn decode(reader: Box<dyn Input>, format: Format, options: &ReadOptions) -> std::result::Result<Photo, Reason> {
    match format {
        Format::OpenExr => exr::read(reader, options),
        Format::Radiance => radiance::read(reader, options),
        Format::Pfm => pfm::read(reader),
        Format::Tiff => tiff::read(reader, options),
        Format::Png => png::read(reader, options),
        Format::Jpeg => jpeg::read(reader, options),
        Format::JpegXl => jxl::read(reader, options),
    }
}

/// What decoders read from.
trait Input: BufRead + Seek {}
impl<T: BufRead + Seek> Input for T {}

fn open(path: &Path) -> std::result::Result<Box<dyn Input>, Reason> {
    if target::is_standard(path) {
        if io::stdin().is_terminal() {
            return Err("it is a terminal; give a file, or lead a photo into it by < or |".into());
        }
        return whole(io::stdin().lock());
    }
    let file = File::open(path)?;
    let kind = file.metadata()?;
    if kind.is_dir() {
        return Err("it is a folder".into());
    }
    if kind.is_file() {
        return Ok(Box::new(BufReader::with_capacity(1 << 16, file)));
    }
    whole(file)
}

/// All that a stream has: decoders jump about, which a pipe cannot. One that never ends is turned away by its first bytes.
fn whole(mut stream: impl Read) -> std::result::Result<Box<dyn Input>, Reason> {
    let mut head = Vec::new();
    stream.by_ref().take(64).read_to_end(&mut head)?;
    Format::from_magic(&head)?;
    stream.read_to_end(&mut head)?;
    Ok(Box::new(Cursor::new(head)))
}

/// The number of pixels of a picture, if it has any and not too many.
pub(super) fn check_size(width: u32, height: u32) -> std::result::Result<usize, Reason> {
    match width as usize * height as usize {
        0 => Err(format!("it has no pixels: {width} × {height}").into()),
        count if count > MOST_PIXELS.get() => {
            let most = MOST_PIXELS.get();
            let why = if most < MAX_PIXELS { "that --max-pixels allows" } else { "that vglare reads" };
            Err(format!("it says that it has {width} × {height} pixels, more than the {most} {why}").into())
        }
        count => {
            // Pixels, and the samples that they are made from.
            crate::limits::room(24 * count as u64, &format!("a photo of {width} × {height} pixels"))?;
            Ok(count)
        }
    }
}

/// The reason in words. All decoders mean the same by an early end, and wrap it each in its own way.
fn explain(reason: &(dyn std::error::Error + 'static)) -> String {
    let text = reason.to_string();
    let early = io::Error::from(io::ErrorKind::UnexpectedEof).to_string();
    // The words of `Read::read_exact`.
    if text.contains("failed to fill whole buffer") || text.contains(&early) {
        return "the file is cut short".into();
    }
    text
}
