//! The veil by its definition, in 64 bits: every source at every pixel.

use rayon::prelude::*;

use super::geometry::{Border, Geometry};
use super::kernel::Kernel;
use super::photo::{Photo, light};
use super::picture::Picture;
use super::rings;
use super::sphere::{Camera, Point, angle};

/// A rectangle of pixels: its first column and row, and how many of each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// First column and row.
    pub first: [usize; 2],
    /// Columns and rows.
    pub size: [usize; 2],
}

impl Window {
    /// All of a picture.
    pub fn whole(size: [usize; 2]) -> Self {
        Self { first: [0, 0], size }
    }
}

/// The veil of `kernel` within a window, which is cut off at the photo's edges: rows of red, green and blue. Its cost is that of
/// every pixel of the photo for each pixel of the window.
pub fn veil(photo: &Photo, geometry: &Geometry, kernel: &Kernel, border: Border, window: Window) -> Vec<[f64; 3]> {
    let last = [0, 1].map(|side| (window.first[side] + window.size[side]).min(photo.size()[side]));
    let row = |y: usize| (window.first[0]..last[0]).map(move |x| [x, y]);
    at(photo, geometry, kernel, border, &(window.first[1]..last[1]).flat_map(row).collect::<Vec<_>>())
}

/// The veil of `kernel` at pixels of the photo, each a column and a row: red, green and blue of each.
pub fn at(photo: &Photo, geometry: &Geometry, kernel: &Kernel, border: Border, pixels: &[[usize; 2]]) -> Vec<[f64; 3]> {
    match (*geometry, geometry.camera(photo.size())) {
        (_, Some(camera)) => spherical(photo, &camera, kernel, pixels),
        (Geometry::Equirectangular, _) => rings::reference(photo, |angle| kernel.at(angle), pixels),
        (Geometry::Planar { pitch, solid_angle }, None) => {
            let value = |distance: f64| solid_angle * kernel.at(pitch * distance);
            planar(photo, value, border, pixels)
        }
        _ => Vec::new(),
    }
}

/// The veil of a picture as the kernel, at pixels of the photo, each a column and a row: red, green and blue of each.
pub fn of_picture(photo: &Photo, picture: &Picture, border: Border, pixels: &[[usize; 2]]) -> Vec<[f64; 3]> {
    let [width, height] = photo.size();
    let margin = if border == Border::None { [0, 0] } else { [width, height] };
    let sources = sources(photo, border, margin);
    let seen = [width + 2 * margin[0], height + 2 * margin[1]];
    // Sources from which a target is within the picture.
    let from = |side: usize, at: usize| {
        let [centre, length] = [picture.centre()[side], picture.size()[side]];
        let at = at + margin[side];
        (at + centre + 1).saturating_sub(length)..(at + centre + 1).min(seen[side])
    };
    let at = |[x, y]: [usize; 2]| {
        let mut sum = [0.0; 3];
        for row in from(1, y) {
            for column in from(0, x) {
                let offset =
                    [(x + margin[0], column), (y + margin[1], row)].map(|(to, from)| to as isize - from as isize);
                if offset != [0, 0] {
                    let (source, value) = (sources[row * seen[0] + column], picture.at(offset));
                    (0..3).for_each(|channel| sum[channel] += source[channel] * value[channel]);
                }
            }
        }
        sum
    };
    pixels.par_iter().copied().map(at).collect()
}

fn planar(photo: &Photo, value: impl Fn(f64) -> f64 + Sync, border: Border, pixels: &[[usize; 2]]) -> Vec<[f64; 3]> {
    let [width, height] = photo.size();
    let margin = if border == Border::None { [0, 0] } else { [width, height] };
    // By offsets in columns and rows.
    let reach = [width + margin[0], height + margin[1]];
    let mut table = vec![0.0; reach[0] * reach[1]];
    table.par_chunks_exact_mut(reach[0]).enumerate().for_each(|(row, table)| {
        // The square is a whole number that f64 holds.
        let square = row * row;
        table.iter_mut().enumerate().for_each(|(column, at)| *at = value(((column * column + square) as f64).sqrt()));
    });
    table[0] = 0.0;
    let sources = sources(photo, border, margin);
    let columns = width + 2 * margin[0];
    let at = |[x, y]: [usize; 2]| {
        let mut sum = [0.0; 3];
        for (row, sources) in sources.chunks_exact(columns).enumerate() {
            let table = &table[row.abs_diff(y + margin[1]) * reach[0]..][..reach[0]];
            for (column, source) in sources.iter().enumerate() {
                let value = table[column.abs_diff(x + margin[0])];
                for (sum, source) in sum.iter_mut().zip(source) {
                    *sum += source * value;
                }
            }
        }
        sum
    };
    pixels.par_iter().copied().map(at).collect()
}

fn spherical(photo: &Photo, camera: &Camera, kernel: &Kernel, pixels: &[[usize; 2]]) -> Vec<[f64; 3]> {
    let width = photo.size()[0];
    let sources: Vec<(usize, [f64; 3])> =
        sources(photo, Border::None, [0, 0]).into_iter().enumerate().filter(|(_, light)| *light != [0.0; 3]).collect();
    let point = |pixel: usize| camera.point((pixel % width) as f64, (pixel / width) as f64);
    let points: Vec<Point> = sources.iter().map(|(pixel, _)| point(*pixel)).collect();
    let at = |[x, y]: [usize; 2]| {
        let (target, index) = (camera.point(x as f64, y as f64), y * width + x);
        let mut sum = [0.0; 3];
        for ((pixel, light), point) in sources.iter().zip(&points) {
            if *pixel != index {
                let value = point.solid_angle * kernel.at(angle(point.chord(&target)));
                sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += value * light);
            }
        }
        sum
    };
    pixels.par_iter().copied().map(at).collect()
}

/// What each pixel sends, borders included.
fn sources(photo: &Photo, border: Border, margin: [usize; 2]) -> Vec<[f64; 3]> {
    let [width, height] = photo.size();
    let columns = width + 2 * margin[0];
    let mut sources = vec![[0.0; 3]; columns * (height + 2 * margin[1])];
    sources.par_chunks_exact_mut(columns).enumerate().for_each(|(row, sources)| {
        let y = border.source(row as isize - margin[1] as isize, height);
        for (column, source) in sources.iter_mut().enumerate() {
            let x = border.source(column as isize - margin[0] as isize, width);
            if let (Some(x), Some(y)) = (x, y) {
                *source = std::array::from_fn(|channel| light(photo.value(channel, x, y)));
            }
        }
    });
    sources
}
