//! The veil from outside by its definition: a sum over all of a panorama's pixels, in 64-bit floats.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use super::cut::divided;
use super::sight::Sight;
use crate::photo::Photo;
use crate::psf::Psf;
use crate::series::sphere::Grid;

/// A pixel that the band's edge crosses is taken by so many parts along each side, and what of each lies beyond; one that does not by as
/// many as its distance asks for.
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
            let value = |from: DVec3, direction: &DVec3| {
                let angle = 2.0 * (0.5 * from.distance(*direction)).min(1.0).asin();
                sight.accepts(sight.seen(from).z) * psf.value(angle.to_degrees())
            };
            let edged = (nearest > -side).then(|| divided(grid, [column, row], EDGED, sight, &shown));
            for (sum, direction) in sums.iter_mut().zip(directions) {
                let weight = match &edged {
                    Some(parts) => parts.iter().map(|part| part.share * value(part.middle, direction)).sum::<f64>(),
                    None => {
                        let parts = ((NEAR * side / centre.distance(*direction)).ceil() as usize).clamp(1, MOST);
                        let offset = |k: usize| (k as f64 + 0.5) / parts as f64 - 0.5;
                        let part = |k: usize| {
                            if parts == 1 {
                                return centre;
                            }
                            grid.direction(column as f64 + offset(k % parts), row as f64 + offset(k / parts))
                        };
                        let all = (0..parts * parts).map(|k| value(part(k), direction)).sum::<f64>();
                        all / (parts * parts) as f64
                    }
                };
                (0..3).for_each(|k| sum[k] += area * weight * light[k]);
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
