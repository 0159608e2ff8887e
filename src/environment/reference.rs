//! The veil from outside by its definition: a sum over all of a panorama's pixels, in 64-bit floats.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use super::sight::Sight;
use crate::photo::Photo;
use crate::psf::Psf;
use crate::series::sphere::Grid;

/// A pixel that the band's edge crosses is taken by so many parts along each side; one that does not by as many as its distance asks
/// for.
const EDGED: usize = 16;
const MOST: usize = 12;

/// How many sides of a part there are at least between it and what it shines on.
const NEAR: f64 = 12.0;

/// ∫ L A k dΩ over what a sight does not see, L even within each pixel, in each direction, RGB; k is a function in degrees.
pub(super) fn at(photo: &Photo, sight: &Sight, psf: &Psf, directions: &[DVec3]) -> Vec<[f64; 3]> {
    let grid = Grid { width: photo.width() as usize, height: photo.height() as usize };
    let (side, shown) = (PI / grid.height as f64, sight.shown());
    let row = |row: usize| {
        let mut sums = vec![[0.0; 3]; directions.len()];
        let area = grid.solid_angle(row);
        for column in 0..grid.width {
            let pixel = photo.pixels[row * grid.width + column];
            let light = [0, 1, 2].map(|k| f64::from(pixel[k]).max(0.0));
            if light == [0.0; 3] {
                continue;
            }
            let centre = grid.direction(column as f64, row as f64);
            let nearest = shown.inside(sight.seen(centre));
            if nearest > side {
                continue;
            }
            for (sum, direction) in sums.iter_mut().zip(directions) {
                let parts = match nearest > -side {
                    true => EDGED,
                    false => ((NEAR * side / centre.distance(*direction)).ceil() as usize).clamp(1, MOST),
                };
                let mut weight = 0.0;
                for part in 0..parts * parts {
                    let offset = |k: usize| (k as f64 + 0.5) / parts as f64 - 0.5;
                    let (across, down) = (column as f64 + offset(part % parts), row as f64 + offset(part / parts));
                    let from = if parts == 1 { centre } else { grid.direction(across, down) };
                    let seen = sight.seen(from);
                    // Of a part that the edge crosses what lies beyond it.
                    let outside = if parts == EDGED { 1.0 - shown.share(seen, 0.5 * side / EDGED as f64) } else { 1.0 };
                    if outside == 0.0 {
                        continue;
                    }
                    let angle = 2.0 * (0.5 * from.distance(*direction)).min(1.0).asin();
                    weight += outside * sight.accepts(seen.z) * psf.value(angle.to_degrees());
                }
                weight *= area / (parts * parts) as f64;
                (0..3).for_each(|k| sum[k] += weight * light[k]);
            }
        }
        sums
    };
    let rows: Vec<Vec<[f64; 3]>> = (0..grid.height).into_par_iter().map(row).collect();
    let mut sums = vec![[0.0; 3]; directions.len()];
    for row in &rows {
        for (sum, part) in sums.iter_mut().zip(row) {
            (0..3).for_each(|k| sum[k] += part[k]);
        }
    }
    sums
}
