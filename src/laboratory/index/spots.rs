//! Spots of a photo.

use std::str::FromStr;

use serde::Serialize;

use super::field::RING;
use crate::options::numbers::finite;
use crate::photo::Photo;
use crate::{Error, Result};

/// Within this part of its diameter from the middle a spot is read.
const MIDDLE: f64 = 0.25;
/// And so wide, in diameters, is the ring on the field.
const WIDTH: f64 = 0.25;

/// `--spot`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpotArg {
    centre: [f64; 2],
    diameter: f64,
}

impl FromStr for SpotArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text.split(',').filter_map(|part| finite(part.trim()).ok()).collect();
        match (numbers[..].as_array(), text.split(',').count()) {
            (Some(&[x, y, diameter]), 3) if diameter > 0.0 => Ok(Self { centre: [x, y], diameter }),
            _ => Err("expected column, row and a diameter above 0, in pixels, like 480,270,40".to_owned()),
        }
    }
}

/// What was found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spot {
    /// Column and row.
    pub centre: [f64; 2],
    /// In pixels.
    pub diameter: f64,
    /// The means on the spot, N, and on the ring, D, in the photo's numbers: RGB.
    #[serde(skip)]
    pub levels: [[f64; 3]; 2],
    /// RGB.
    pub index: [f64; 3],
    /// Its standard error by what pixels of the spot and of the ring differ among themselves, each by itself, RGB.
    pub standard_error: [f64; 3],
    /// Pixels that were read: in the spot, and on the ring.
    pub pixels: [usize; 2],
}

/// The mean of some pixels, and its standard error.
struct Mean([f64; 2]);

impl Mean {
    fn of(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Self([mean, if count > 1.0 { (squares / (count - 1.0) / count).sqrt() } else { 0.0 }])
    }
}

/// The index of each spot.
///
/// # Errors
/// [`Error::Usage`] for a spot whose surroundings are not in the photo or hold a pixel that is no number, one of less than a pixel, or a
/// field that is black.
pub fn measured(photo: &Photo, spots: &[SpotArg]) -> Result<Vec<Spot>> {
    spots.iter().map(|spot| of(photo, spot)).collect()
}

fn of(photo: &Photo, &SpotArg { centre: [x, y], diameter }: &SpotArg) -> Result<Spot> {
    let window = photo.frame.window;
    let name = format!("--spot {x},{y},{diameter}");
    let reach = (RING + WIDTH) * diameter;
    let [left, top] = [x - f64::from(window.x), y - f64::from(window.y)];
    let inside = |at: f64, side: u32| at - reach >= 0.0 && at + reach <= f64::from(side) - 1.0;
    if !inside(left, window.width) || !inside(top, window.height) {
        return Err(Error::Usage(format!("{name}: the field up to {reach:.0} pixels about it is not in the photo")));
    }
    let [mut spot, mut ring] = [0, 1].map(|_| [const { Vec::new() }; 3]);
    for row in (top - reach).floor() as usize..=(top + reach).ceil() as usize {
        for column in (left - reach).floor() as usize..=(left + reach).ceil() as usize {
            let far = (column as f64 - left).hypot(row as f64 - top) / diameter;
            let into = match far {
                far if far <= MIDDLE => &mut spot,
                far if (far - RING).abs() <= 0.5 * WIDTH => &mut ring,
                _ => continue,
            };
            let Some(pixel) = photo.pixels.get(row * window.width as usize + column) else { continue };
            (0..3).for_each(|c| into[c].push(f64::from(pixel[c])));
        }
    }
    let pixels = [spot[0].len(), ring[0].len()];
    if pixels.contains(&0) {
        return Err(Error::Usage(format!("{name}: it is so small that no pixel is in its middle")));
    }
    if spot.iter().chain(&ring).flatten().any(|value| !value.is_finite()) {
        return Err(Error::Usage(format!("{name}: a pixel there is no finite number")));
    }
    let mut found =
        Spot { centre: [x, y], diameter, levels: [[0.0; 3]; 2], index: [0.0; 3], standard_error: [0.0; 3], pixels };
    for c in 0..3 {
        let (Mean([black, black_off]), Mean([around, around_off])) = (Mean::of(&spot[c]), Mean::of(&ring[c]));
        if around <= 0.0 {
            return Err(Error::Usage(format!("{name}: the field about it is black")));
        }
        (found.levels[0][c], found.levels[1][c]) = (black, around);
        found.index[c] = black / around;
        found.standard_error[c] = black_off.hypot(found.index[c] * around_off) / around;
    }
    Ok(found)
}
