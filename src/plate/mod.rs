//! The plate: ghosts of a whole photo whose bells are too sharp for a series, summed over all pixels on the pixels themselves.
//!
//! An image g of the photo is Σ_p L_p f(y − c_p), f its bell and c_p = a (1 − m) + m x_p. There are four ways to it, of which the cheapest
//! that is close enough is taken for each image (`choose`):
//!
//! - `products`, exactly: bells that are products along x and y, in two sums over what each reaches;
//! - `pairs`, exactly: each pixel that shines at each pixel that its ghost reaches;
//! - `spans`, exactly: discs, whose flat part is a difference of sums along each row, so that only the rim is evaluated;
//! - `lattice`: light is carried to the points of a lattice of pitch h = 1/n pixel by polynomials, each of n² parts of which is convolved with
//!   the bell by a transform. As the pixels are points of the lattice, that is the bell's own interpolation,
//!   I f(v) = Σ_k w_k(v) f(v_k), and all that it is off by is Σ_p L_p |f − I f|(y − c_p), which `envelope` bounds by one more
//!   convolution. The brightest pixels may go by `pairs`, if that is what the bound asks for.
//!
//! All is in 64-bit floats and the same for any number of threads.

mod choose;
mod envelope;
mod kernel;
mod lattice;
mod pairs;
mod products;
mod scout;
mod seat;
mod spans;
mod waves;

use crate::frame::Frame;
use crate::problem::Images;
use crate::{Result, limits};

pub(crate) use choose::{Chosen, choose};
pub(crate) use scout::{bright_places, effort};

/// How an image is summed.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Way {
    /// Along x, then along y.
    Products,
    /// Each pixel at each that its ghost reaches.
    Pairs,
    /// Flat parts by sums along rows, the rim pixel by pixel.
    Spans,
    /// On a lattice of so many points a pixel; pixels of more than a weight, in units of the field's scale, by themselves.
    Lattice {
        /// Points a pixel along either axis.
        finer: u32,
        /// The weight.
        alone_above: f64,
    },
}

/// What an image of the problem is summed by.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// The image's place among the problem's.
    pub image: usize,
    /// The way.
    pub way: Way,
    /// What a colour's light weighs, in units of the field's scale.
    pub(crate) weights: [f64; 3],
}

/// A field of three colours at the pixels of a window, row by row from the top.
pub(crate) struct Sheet {
    width: usize,
    planes: [Vec<f64>; 3],
}

impl std::fmt::Debug for Sheet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Sheet").field("width", &self.width).finish_non_exhaustive()
    }
}

impl Sheet {
    fn new(frame: Frame) -> Self {
        let pixels = frame.window.pixels();
        Self { width: frame.window.width as usize, planes: [(); 3].map(|()| vec![0.0; pixels]) }
    }

    /// A pixel, by its place.
    pub fn pixel(&self, place: usize) -> [f64; 3] {
        self.planes.each_ref().map(|plane| plane[place])
    }
}

/// Memory for a sheet and what its ways need beside, bytes.
fn memory(images: &Images, parts: &[Part], frame: Frame) -> u64 {
    // Three planes of doubles, and of the largest of the ways three spectra with their rows.
    const PLANES: u64 = 24;
    let of = |part: &Part| match part.way {
        Way::Lattice { .. } => lattice::memory(images, &images.all()[part.image], frame),
        _ => PLANES * (images.raster_of(&images.all()[part.image]).pixels() + frame.window.pixels()) as u64,
    };
    PLANES * frame.window.pixels() as u64 + parts.iter().map(of).max().unwrap_or(0)
}

/// The sum of these parts at a frame's pixels.
///
/// # Errors
/// [`crate::Error::Memory`] where memory is limited and that is too little.
pub(crate) fn sheet(images: &Images, parts: &[Part], frame: Frame) -> Result<Sheet> {
    limits::room(memory(images, parts, frame), "the plate of sharp ghosts")?;
    let mut sheet = Sheet::new(frame);
    for part in parts {
        let seat = seat::Seat::new(images, &images.all()[part.image], frame);
        match part.way {
            Way::Products => products::add(&seat, &mut sheet),
            Way::Pairs => pairs::add(&seat, part.weights, &mut sheet),
            Way::Spans => spans::add(&seat, &mut sheet),
            Way::Lattice { finer, alone_above } => {
                if kernel::step(&seat.image.ghost).is_some() {
                    spans::add(&seat, &mut sheet);
                }
                lattice::add(&seat, finer, part.weights, alone_above, &mut sheet);
                if alone_above.is_finite() {
                    pairs::add_bright(&seat, part.weights, alone_above, &mut sheet);
                }
            }
        }
    }
    Ok(sheet)
}

#[cfg(test)]
mod tests;
