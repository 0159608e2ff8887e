//! TIFF: what a photographer meets is read; 8 and 16 bit integers and 32-bit floats are written.
//!
//! | module | what it does |
//! | --- | --- |
//! | `directory` | header, directories, tags |
//! | `page` | chooses the picture of a file that holds several |
//! | `layout` | what the tags say of how samples are stored, and where |
//! | `compression`, `fax`, `picture`, `sgi_log` | unpack a strip or tile |
//! | `samples` | its bits, bytes and predictors |
//! | `pieces` | reads all strips or tiles into one picture |
//! | `light`, `colour` | from samples to a photo |
//! | `metadata` | what stands beside the picture |
//! | `write` | writes, through the `tiff` crate |
//!
//! That crate's decoder is not used: it reads no picture whose directory holds anything that it does not know, takes
//! spare channels for colours, and decodes few of the formats.
//!
//! Integers are display-referred (an ICC profile decodes them, else sRGB), floats scene-linear unless a profile says
//! otherwise.

mod colour;
mod compression;
mod directory;
mod fax;
mod layout;
mod light;
mod metadata;
mod page;
mod picture;
mod pieces;
mod samples;
mod sgi_log;
mod write;

use std::collections::HashMap;
use std::io::{Read, Seek};

use self::compression::Compression;
use self::directory::{Directory, File, tag};
use self::layout::Layout;
use self::light::Meaning;
use super::camera::{self, Camera};
use super::decode::is_quarter_turn;
use super::{Photo, ReadOptions, Reason};

pub(super) use write::write;

pub(super) fn read(reader: impl Read + Seek, options: &ReadOptions) -> Result<Photo, Reason> {
    let mut file = File::open(reader)?;
    let mut page = page::choose(&mut file)?;
    let layout = Layout::of(&mut file, &page.directory)?;
    let meaning = Meaning::of(&mut file, &page.directory, &layout, options.clone())?;
    let camera = camera(&mut file, &page.directory);
    let tables = match layout.compression {
        Compression::Jpeg => file.raw(&page.directory, tag::JPEG_TABLES)?,
        _ => None,
    };
    let codes = pieces::read(&mut file, &layout, tables.as_deref())?;
    let turn = meaning.orientation();
    let beside = metadata::read(&mut file, &page.directory, turn);
    let mut photo = light::into_photo(codes, &layout, meaning)?;
    photo.source.camera = camera.map(|camera| if is_quarter_turn(turn) { camera.turned() } else { camera });
    beside.attach(&mut photo);
    photo.source.picture = page.name;
    page.notes.append(&mut photo.source.notes);
    photo.source.notes = page.notes;
    Ok(photo)
}

/// What Exif says of the camera; what is wrong with it does the picture no harm.
fn camera<R: Read + Seek>(file: &mut File<R>, page: &Directory) -> Option<Camera> {
    let at = file.number(page, tag::EXIF_IFD).ok().flatten()?;
    let exif = file.directory(at).ok()?;
    let mut values = HashMap::new();
    for (tag, _) in camera::tag::NAMES {
        values.extend(file.reals(&exif, tag, 1).ok().flatten().and_then(|reals| Some((tag, *reals.first()?))));
    }
    Camera::of_exif(|tag| values.get(&tag).copied())
}
