//! Gain maps: a second, smaller JPEG behind the picture says how much brighter than the plain picture each place is.
//!
//! \[UHDR\] Ultra HDR Image Format 1.1, "Gain map decoding"; \[ADOBE\] Adobe's gain map specification 1.0, its XMP;
//! \[ISO\] ISO 21496-1, whose metadata are binary: layout as in libultrahdr's gainmapmetadata.cpp.
//!
//! The map is applied in full, as a display would show it whose white can be as much brighter as the file asks for:
//! the photo is then light beyond display white, and counts as scene-linear.

use glam::{DMat3, Mat3A, Vec3A};
use image::metadata::Orientation;
use image::{DynamicImage, ImageBuffer};
use rayon::prelude::*;

use super::super::{Photo, Reason};
use super::check;
use super::decode::{self, Decoded, Samples};
use super::recipe::Recipe;
use super::tags;
use super::walk::Walk;

/// So many pictures behind the first are looked at; files hold two or three, and films hold bytes that look like them.
const MOST_PICTURES: usize = 16;

const APPLE: &str = "http://ns.apple.com/HDRGainMap/";

/// Finds the gain map behind the picture, and brightens the photo by it; `orientation` is how the photo was turned, and
/// `to_rec709` how its own primaries became Rec. 709's.
///
/// Says in the photo's notes what was done, or why nothing was.
pub(super) fn apply(walk: &Walk, orientation: Orientation, to_rec709: Option<DMat3>, photo: &mut Photo) {
    let note = match find(walk.behind) {
        Found::Map(map, recipe) => match Map::new(&map, orientation) {
            Ok(map) => brighten(photo, &map, &recipe, to_rec709),
            Err(error) => format!("it has a gain map that cannot be read ({error}), and is read as SDR"),
        },
        Found::Apple => "it has a gain map of Apple's kind, which is not applied: it is read as SDR".into(),
        Found::Senseless(why) => format!("it has a gain map that {why}, and is read as SDR"),
        Found::Nothing if promised(walk) => {
            "it says that it has a gain map, which is not there: it is read as SDR".into()
        }
        Found::Nothing => return,
    };
    photo.source.notes.push(note);
}

enum Found<'a> {
    Nothing,
    Map(Walk<'a>, Recipe),
    Apple,
    Senseless(&'static str),
}

/// The first gain map among the pictures that stand behind another.
fn find(mut behind: &[u8]) -> Found<'_> {
    for _ in 0..MOST_PICTURES {
        let Some(start) = behind.windows(3).position(|head| head == [0xff, 0xd8, 0xff]) else { break };
        behind = &behind[start..];
        let Ok(walk) = Walk::new(behind) else {
            behind = &behind[2..];
            continue;
        };
        match Recipe::of(&walk) {
            Some(Ok(recipe)) => return Found::Map(walk, recipe),
            Some(Err(why)) => return Found::Senseless(why),
            None if tags::xmp(&walk).is_some_and(|xmp| xmp.contains(APPLE)) => return Found::Apple,
            None => behind = walk.behind,
        }
    }
    Found::Nothing
}

/// Whether the picture itself says that a gain map belongs to it.
fn promised(walk: &Walk) -> bool {
    tags::app2(walk, super::recipe::ISO).is_some() || tags::xmp(walk).is_some_and(super::recipe::is_named)
}

/// The map's codes, turned as the photo is: grey or RGB.
struct Map {
    width: usize,
    height: usize,
    channels: usize,
    codes: Vec<u8>,
}

impl Map {
    fn new(walk: &Walk, orientation: Orientation) -> Result<Self, Reason> {
        walk.check()?;
        check::check(walk, &mut Vec::new())?;
        let Decoded { channels, samples: Samples::Eight(codes) } = decode::decode(walk, &mut Vec::new())? else {
            return Err("it has more than 8 bits".into());
        };
        let (width, height) = (walk.frame.width, walk.frame.height);
        let missing = "it lacks samples";
        let mut turned = match channels {
            1 => DynamicImage::ImageLuma8(ImageBuffer::from_raw(width, height, codes).ok_or(missing)?),
            _ => DynamicImage::ImageRgb8(ImageBuffer::from_raw(width, height, codes).ok_or(missing)?),
        };
        turned.apply_orientation(orientation);
        let (width, height) = (turned.width() as usize, turned.height() as usize);
        Ok(Self { width, height, channels, codes: turned.into_bytes() })
    }

    /// The code of a channel, in 0..=1 and interpolated, at a place in columns and rows of the map, centres at ½.
    fn at(&self, x: f32, y: f32, channel: usize) -> f32 {
        let place = |at: f32, count: usize| {
            let at = (at - 0.5).clamp(0.0, (count - 1) as f32);
            let first = at as usize;
            (first, (first + 1).min(count - 1), at - first as f32)
        };
        let ((x0, x1, right), (y0, y1, down)) = (place(x, self.width), place(y, self.height));
        let code = |x: usize, y: usize| f32::from(self.codes[(y * self.width + x) * self.channels + channel]) / 255.0;
        let row = |y: usize| code(x0, y) * (1.0 - right) + code(x1, y) * right;
        row(y0) * (1.0 - down) + row(y1) * down
    }
}

/// \[UHDR\]: light = (light + offset) × 2 ^ gain − offset, in the plain picture's own primaries.
fn brighten(photo: &mut Photo, map: &Map, recipe: &Recipe, to_rec709: Option<DMat3>) -> String {
    let is_grey = map.channels == 1 && recipe.is_grey();
    // One gain for all three colours is the same in any primaries.
    let to_rec709 = to_rec709.filter(|_| !is_grey);
    let ways = to_rec709.map(|matrix| [matrix.inverse(), matrix].map(|way| Mat3A::from(way.as_mat3())));
    let turn = |pixel: &mut [f32; 4], way: usize| {
        if let Some(ways) = ways {
            let light = ways[way] * Vec3A::new(pixel[0], pixel[1], pixel[2]);
            pixel[..3].copy_from_slice(&light.to_array());
        }
    };
    let (width, height) = (photo.width() as usize, photo.height() as usize);
    let (across, down) = (map.width as f32 / width as f32, map.height as f32 / height as f32);
    photo.pixels.par_chunks_exact_mut(width).enumerate().for_each(|(row, pixels)| {
        let y = (row as f32 + 0.5) * down;
        for (column, pixel) in pixels.iter_mut().enumerate() {
            let x = (column as f32 + 0.5) * across;
            let mut code = [map.at(x, y, 0); 3];
            if map.channels == 3 {
                (code[1], code[2]) = (map.at(x, y, 1), map.at(x, y, 2));
            }
            turn(pixel, 0);
            for channel in 0..3 {
                pixel[channel] = recipe.light(pixel[channel], code[channel], channel);
            }
            turn(pixel, 1);
        }
    });
    photo.source.display_referred = false;
    photo.source.grey &= is_grey;
    let times = recipe.most();
    format!(
        "its gain map (Ultra HDR) was applied in full: it is light up to {times:.3} times the plain picture's white"
    )
}
