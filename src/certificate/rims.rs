//! Where a sample looks beside the crossings, where a plate has sharp ghosts: on both sides of the rims of what the brightest pixels make.

use std::f64::consts::TAU;

use glam::DVec2;

use crate::plan::Plan;
use crate::problem::{Image, Images};
use crate::raster::Raster;

/// Pixels whose ghosts are looked at.
const BRIGHTEST: usize = 3;

/// How far from a rim, in pixels, on either side.
const BESIDE: [f64; 3] = [-0.8, 0.0, 0.8];

/// About so many pixels of the window at the rims of ghosts that are summed on the plan's plate.
pub(super) fn rims(plan: &Plan, images: &Images, count: usize) -> Vec<[i32; 2]> {
    let Some(plate) = plan.plate() else { return Vec::new() };
    let all: Vec<&Image> = plate.parts.iter().map(|part| &images.all()[part.image]).collect();
    // Of many, the strongest and those between.
    let step = (all.len() * BRIGHTEST * BESIDE.len()).div_ceil(count.max(1)).max(1);
    let some: Vec<&Image> = all.into_iter().step_by(step).collect();
    let angles = count / (some.len() * BRIGHTEST * BESIDE.len()).max(1);
    let frame = plan.problem().frame();
    let mut pixels = Vec::new();
    for (number, image) in some.into_iter().enumerate() {
        for place in brightest(images.raster_of(image)) {
            let centre = images.axis() + image.along * (place - images.axis());
            let ghost = &image.ghost;
            let (shape, edges) = (ghost.bell.shape(), ghost.bell.shape().edges());
            for k in 0..angles.max(1) {
                let turns = (k as f64 + 0.618 * number as f64 + 0.25) / angles.max(1) as f64;
                let towards = DVec2::from_angle(TAU * turns);
                let edge = edges[edges.len() - 1 - k % edges.len()];
                let rim = centre + edge * shape.outline(towards) * towards * ghost.size;
                let across = (rim - centre).normalize_or_zero() * frame.pixel_sides();
                pixels.extend(BESIDE.map(|beside| frame.pixel(rim + beside * across).round().as_ivec2().to_array()));
            }
        }
    }
    let window = frame.window;
    let last = [window.x + window.width as i32, window.y + window.height as i32];
    pixels.retain(|[i, j]| (window.x..last[0]).contains(i) && (window.y..last[1]).contains(j));
    pixels
}

/// Where the brightest pixels are: those of a row are one.
fn brightest(raster: &Raster) -> Vec<DVec2> {
    let places = raster.places();
    let row = |row: usize| {
        let lights = [0, 1, 2].map(|colour| raster.light(row, colour));
        let light = |column: usize| {
            lights.iter().fold(0.0f64, |most, (light, factor)| most.max(factor * f64::from(light[column])))
        };
        let columns = (0..places.from_middle[0].len()).map(|column| (light(column), column, row));
        columns.max_by(|one, other| one.0.total_cmp(&other.0))
    };
    let mut rows: Vec<(f64, usize, usize)> = (0..places.from_middle[1].len()).filter_map(row).collect();
    rows.sort_by(|one, other| other.0.total_cmp(&one.0));
    let place = |(_, column, row): &(f64, usize, usize)| {
        places.middle + DVec2::new(places.from_middle[0][*column], places.from_middle[1][*row])
    };
    rows.iter().take(BRIGHTEST).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Frame;
    use crate::plan::{Evaluator, Request, plan};
    use crate::problem::Problem;
    use crate::scene::LensGhost;
    use crate::series::{Bell, Disc};

    #[test]
    fn rims_of_the_brightest_pixel_are_looked_at_from_both_sides() {
        let frame = Frame::full(96, 54);
        let mut pixels = vec![[1e-4, 1e-4, 1e-4, 1.0]; frame.window.pixels()];
        pixels[96 * 30 + 60] = [1e4; 4];
        let bell = Bell::Disc(Disc::new(0.1, 0, 0.0).unwrap());
        let lens = LensGhost { bell, along: -0.7, size: DVec2::splat(0.5), tint: [1.0; 3], share: 0.01 };
        let images = Images::new(Raster::new(&pixels, frame).unwrap(), &[lens], DVec2::ZERO, 1.0, [1.0; 3]);
        let request = Request { evaluator: Some(Evaluator::Plate), ..Request::new(1e-3) };
        let plan = plan(&Problem::with_images([], images.into(), frame), &request).unwrap();
        let (images, centre) = (plan.problem().images().unwrap(), -0.7 * frame.position(60.0, 30.0));
        let looked_at = rims(&plan, images, 108);
        let radius = |[i, j]: &[i32; 2]| (frame.position(f64::from(*i), f64::from(*j)) - centre).length();
        let near = |low: f64, high: f64| looked_at.iter().filter(|pixel| (low..high).contains(&radius(pixel))).count();
        assert!(near(0.45, 0.5) > 8 && near(0.5, 0.56) > 8, "{looked_at:?}");
    }
}
