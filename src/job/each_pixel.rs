//! A tolerance of photo and glare at each pixel, beside that of the largest glare: where one ghost is in focus and brighter than all
//! others together, these are held to it as well.

use rayon::prelude::*;

use crate::choices::Normalize;
use crate::frame::Frame;
use crate::look::Look;
use crate::photo::Photo;
use crate::plan::Plan;
use crate::problem::Problem;
use crate::{Error, Result, reference};

/// What is darker than this part of the picture's mean is held to as much as that: twelve stops below, where no camera tells light
/// from noise.
const DARKEST: f64 = 1.0 / 4096.0;

/// Cells along the longer side of the picture, at whose middles glare is looked at.
const CELLS: u32 = 24;
/// What there is at least of it between them, over that.
const BETWEEN: f64 = 0.5;
/// Ghosts of lights that are looked at; those of more, and of all pixels, are taken for nothing.
const MOST: usize = 20_000;

/// How dark the picture is at its darkest pixel, RGB, in units of the photo.
pub struct Darkest {
    least: [f64; 3],
    strength: f64,
}

/// How exact the glare is over photo and glare at each pixel: at the pixel where that is darkest, the worst colour.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct EachPixel {
    /// The tolerance.
    pub asked: f64,
    /// The plan's bound.
    pub predicted: f64,
    /// The largest error that was measured anywhere, as if it were there.
    pub measured: f64,
    /// Pixels that are darker than a part of the picture's mean, and were taken to be as bright as that; RGB.
    pub darker: [usize; 3],
    /// That brightness, RGB.
    pub dark: [f64; 3],
}

impl Darkest {
    /// Of a photo with the glare of a problem, where the look asks for it.
    ///
    /// # Errors
    /// [`Error::Usage`] for glare that is normalised: the photo is no measure of that.
    pub fn new(look: &Look, photo: &Photo, problem: &Problem) -> Result<Option<Self>> {
        if !look.accuracy.each_pixel || look.strength == 0.0 {
            return Ok(None);
        }
        if look.normalize != Normalize::None {
            return Err(Error::Usage("a tolerance at each pixel needs --normalize none".into()));
        }
        let cells = cells(problem.frame());
        let glare = glare(problem, &cells.iter().map(|&(middle, _)| middle).collect::<Vec<_>>());
        let light = |[r, g, b, _]: &[f32; 4]| [*r, *g, *b].map(light);
        let sum = photo.pixels.par_iter().map(light).reduce(|| [0.0; 3], |a, b| [0, 1, 2].map(|c| a[c] + b[c]));
        let (pixels, looked_at) = (photo.pixels.len() as f64, cells.len() as f64);
        let mean = [0, 1, 2]
            .map(|c| sum[c] / pixels + look.strength * glare.iter().map(|glare| glare[c]).sum::<f64>() / looked_at);
        let frame = photo.frame;
        let darkest = cells.par_iter().zip(&glare).map(|((_, [columns, rows]), glare)| {
            let mut least = [f64::INFINITY; 3];
            for row in rows.clone() {
                let first = row as usize * frame.window.width as usize;
                for pixel in &photo.pixels[first + columns.start as usize..first + columns.end as usize] {
                    least = [0, 1, 2].map(|c| least[c].min(light(pixel)[c]));
                }
            }
            [0, 1, 2].map(|c| (least[c] + look.strength * BETWEEN * glare[c].max(0.0)).max(DARKEST * mean[c]))
        });
        let least = darkest.reduce(|| [f64::INFINITY; 3], |a, b| [0, 1, 2].map(|c| a[c].min(b[c])));
        Ok(Some(Self { least, strength: look.strength }))
    }

    /// What the error may be, over the largest glare, to be no more than `tolerance` at the darkest pixel; RGB glare.
    pub fn tolerance(&self, tolerance: f64, largest: [f64; 3]) -> f64 {
        let part = |c: usize| self.least[c] / (self.strength * largest[c]);
        // A colour of which there is no light anywhere has no glare either.
        let parts = (0..3).map(part).filter(|part| *part > 0.0);
        tolerance * parts.fold(1.0, f64::min)
    }
}

impl EachPixel {
    /// Of a finished picture, to `asked`; `errors` are what was predicted and measured over the plan's scale.
    pub fn of(picture: &Photo, plan: &Plan, strength: f64, asked: f64, errors: [f64; 2]) -> Self {
        let light = |[r, g, b, _]: &[f32; 4]| [*r, *g, *b].map(light);
        let sum = picture.pixels.par_iter().map(light).reduce(|| [0.0; 3], |a, b| [0, 1, 2].map(|c| a[c] + b[c]));
        let dark = sum.map(|sum| DARKEST * sum / picture.pixels.len() as f64);
        let one = |pixel: &[f32; 4]| {
            let light = light(pixel);
            ([0, 1, 2].map(|c| light[c].max(dark[c])), [0, 1, 2].map(|c| usize::from(light[c] < dark[c])))
        };
        let (least, darker) = picture.pixels.par_iter().map(one).reduce(
            || ([f64::INFINITY; 3], [0; 3]),
            |(a, m), (b, n)| ([0, 1, 2].map(|c| a[c].min(b[c])), [0, 1, 2].map(|c| m[c] + n[c])),
        );
        let over = |c: usize| strength * plan.scale[c] / least[c];
        let most = (0..3).filter(|&c| least[c] > 0.0).map(over).fold(0.0, f64::max);
        let [predicted, measured] = errors.map(|error| error * most);
        Self { asked, predicted, measured, darker, dark }
    }

    /// An error where the bound is more than was asked.
    ///
    /// # Errors
    /// [`Error::EachPixelMissed`].
    pub fn check(&self) -> Result<()> {
        let Self { asked, predicted, .. } = *self;
        if predicted <= asked { Ok(()) } else { Err(Error::EachPixelMissed { asked, predicted }) }
    }
}

/// What counts as light.
fn light(value: f32) -> f64 {
    if value > 0.0 && value.is_finite() { f64::from(value) } else { 0.0 }
}

/// A cell's middle pixel, of the picture; and its columns and rows, of the window.
type Cell = ([i32; 2], [std::ops::Range<u32>; 2]);

fn cells(frame: Frame) -> Vec<Cell> {
    let window = frame.window;
    let side = window.width.max(window.height).div_ceil(CELLS).max(1);
    let along = |length: u32| (0..length).step_by(side as usize).map(move |first| first..(first + side).min(length));
    let middle = |range: &std::ops::Range<u32>, from: i32| from + ((range.start + range.end) / 2) as i32;
    let cell = |columns: &std::ops::Range<u32>, rows: std::ops::Range<u32>| {
        ([middle(columns, window.x), middle(&rows, window.y)], [columns.clone(), rows])
    };
    along(window.width).flat_map(|columns| along(window.height).map(move |rows| cell(&columns, rows))).collect()
}

/// The glare of lights at pixels.
fn glare(problem: &Problem, pixels: &[[i32; 2]]) -> Vec<[f64; 3]> {
    if problem.ghosts().len() > MOST {
        return vec![[0.0; 3]; pixels.len()];
    }
    let frame = problem.frame();
    let points: Vec<_> = pixels.iter().map(|&[i, j]| frame.position(f64::from(i), f64::from(j))).collect();
    reference::direct_at(problem.ghosts(), &points)
}
