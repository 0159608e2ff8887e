//! The glare in false colours: `--map`.

use std::path::Path;

use crate::Result;
use crate::chart::{Axis, Kind, Map, Scalar};
use crate::cli::luminance::Brightness;
use crate::photo::Photo;

/// Draws the luminance of a photo's glare, in cd/m² where that is known and in the photo's numbers elsewhere, and writes that. `range` is where the
/// scale begins and ends, by default what there is.
///
/// # Errors
/// [`crate::Error::Chart`] where it cannot be drawn; those of writing.
pub fn write(path: &Path, input: &Path, glare: &Photo, range: Option<[f64; 2]>, overwrite: bool) -> Result<()> {
    let brightness = Brightness::of(glare);
    let luminance = |&[red, green, blue, _]: &[f32; 4]| brightness.at([red, green, blue].map(f64::from));
    let mut values = Vec::with_capacity(glare.width() as usize * glare.height() as usize);
    (0..glare.height()).for_each(|row| values.extend(glare.picture_row(row).iter().map(luminance)));
    let field = Scalar { width: glare.width(), height: glare.height(), values };
    let name = input.file_name().unwrap_or(input.as_os_str()).to_string_lossy();
    let title = format!("Luminance of the glare in {name}");
    let axis = Axis { label: brightness.unit.to_owned(), range, log: true };
    field.logarithmic_map(&title, axis, Map::Inferno, glare.frame.pixel_aspect).write(path, Kind::of(path)?, overwrite)
}
