//! Where a sample looks where the whole photo shines: at the crossings of a few columns and rows, since what all pixels make of a
//! bell that is a product costs one sum over them for each column, however many rows cross it.

use glam::DVec2;

use super::rims::rims;
use crate::plan::Plan;
use crate::problem::Images;
use crate::series::{Bell, Modes};

/// Products that a certificate may take in f64; a fraction of a second.
const PRODUCTS: f64 = 1.2e9;
/// And values of bells that are no products: each meets every pixel that it reaches.
const BELLS: f64 = 5e7;

/// Columns and rows, at least and at most.
const FEWEST: usize = 2;
const MOST: usize = 20;

/// Pixels at rims, at least and at most.
const FEWEST_AT_RIMS: usize = 9;
const MOST_AT_RIMS: usize = 108;

/// The pixels to look at: the corners, those where the field was found largest, and others spread between them.
pub(super) fn crossings(plan: &Plan, images: &Images) -> Vec<[i32; 2]> {
    let window = plan.problem().frame().window;
    let [columns, rows] = counts(images);
    let points = columns * rows;
    let peaks: Vec<[i32; 2]> = plan.peaks.iter().rev().copied().collect();
    let columns = lines(window.x, window.width, columns, peaks.iter().map(|peak| peak[0]));
    let rows = lines(window.y, window.height, rows, peaks.iter().map(|peak| peak[1]));
    let crossings = columns.iter().flat_map(|&i| rows.iter().map(move |&j| [i, j]));
    let mut pixels: Vec<[i32; 2]> =
        crossings.chain(rims(plan, images, points.clamp(FEWEST_AT_RIMS, MOST_AT_RIMS))).collect();
    pixels.sort_unstable();
    pixels.dedup();
    pixels
}

/// How many columns and rows there is time for.
fn counts(images: &Images) -> [usize; 2] {
    let (mut products, mut bells) = (0.0, 0.0);
    for image in images.all() {
        let (shape, pixels) = (image.ghost.bell.shape(), images.raster_of(image).pixels() as f64);
        if let Modes::Product(_) = shape.modes() {
            products += 3.0 * pixels;
        } else {
            let [low, high] = images.centres(image);
            let reached = (2.0 * image.reached() / (high - low).max(DVec2::splat(1e-9))).min(DVec2::ONE);
            bells += pixels * reached.element_product() * effort(&image.ghost.bell);
        }
    }
    let columns = (PRODUCTS / products.max(1.0)).min(MOST as f64);
    let points = (BELLS / f64::max(bells, 1.0)).min((MOST * MOST) as f64);
    let columns = columns.min(points.sqrt()).max(FEWEST as f64);
    [columns as usize, ((points / columns) as usize).clamp(FEWEST, MOST)]
}

/// What a value of a bell takes, about, over that of the simplest.
fn effort(bell: &Bell) -> f64 {
    if let Bell::Iris(iris) = bell { 0.5 + 0.5 * iris.steps() as f64 } else { 2.0 }
}

/// So many lines of `length` from `first` on: both ends, some that are wanted, and others between them.
fn lines(first: i32, length: u32, count: usize, wanted: impl Iterator<Item = i32>) -> Vec<i32> {
    // The fractional parts of multiples of the golden ratio spread more evenly than chance does.
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let last = first + length as i32 - 1;
    let spread = (1..).map(|k| first + ((f64::from(k) * GOLDEN).fract() * f64::from(length)) as i32);
    let mut lines = Vec::with_capacity(count);
    // Of two there is one for what is wanted, and none for the ends, where least is.
    let (ends, wanted): (&[i32], _) =
        if count > 2 { (&[first, last], wanted.take(count / 3)) } else { (&[], wanted.take(1)) };
    let all = ends.iter().copied().chain(wanted).chain(spread.take(4 * count));
    for line in all {
        if lines.len() < count && (first..=last).contains(&line) && !lines.contains(&line) {
            lines.push(line);
        }
    }
    lines.sort_unstable();
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_distinct_and_hold_both_ends_and_what_is_wanted() {
        let lines = lines(-5, 100, 12, [40, 40, 200, 41].into_iter());
        assert_eq!((lines.len(), lines[0], lines[11]), (12, -5, 94));
        assert!(lines.contains(&40) && !lines.contains(&200), "{lines:?}");
        assert!(lines.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(super::lines(3, 2, 9, std::iter::empty()), [3, 4]);
    }
}
