//! Lights that are long, bent or hollow, as several that are round: a light is a ball to all who see it, and a tube that were one would
//! glow in its middle, a ring in its empty centre.
//!
//! A region that covers an area A has the variance A/4π along each axis where it is a disc. One that has far more is halved across its
//! longest axis, and each half again, until each is about as round as a square.

use std::f64::consts::PI;

use glam::DVec2;

use super::emission::is_light;
use super::lit::Lit;
use super::regions::Moments;

/// How much more variance than a disc's a light may have: a square has 1.05 times as much, two of them side by side 1.31, three 1.75 times.
const ROUND: f64 = 1.5;

/// Pixels that are not looked at any closer, and parts of one region, at most.
const FEW: usize = 4;
const MOST: usize = 4096;

/// Whether a region is about as round as a ball.
pub(super) fn is_round(region: &Moments) -> bool {
    // A pixel is a square of light.
    let variance = region.variance() + 1.0 / 12.0;
    4.0 * PI * variance <= ROUND * region.area
}

/// The parts of regions, one region after the other, each from one end to the other; a region itself where there are no more.
pub(super) fn parts(lit: &Lit<'_>, threshold: f32, aspect: f64, regions: &[Moments]) -> Vec<Moments> {
    let mut parts = Vec::new();
    if regions.is_empty() {
        return parts;
    }
    let mut seen = vec![false; lit.pixels().len()];
    for region in regions {
        let mut pixels = flood(lit, threshold, region.first, &mut seen);
        halve(&mut pixels, &|pixel| Moments::of_pixel(lit, *pixel, aspect), MOST, &mut parts);
    }
    parts
}

/// The pixels of light that hang together with one, also at corners, from the top and then from the left; of those that were not seen.
fn flood(lit: &Lit<'_>, threshold: f32, first: [u32; 2], seen: &mut [bool]) -> Vec<[u32; 2]> {
    let width = lit.width();
    let size = [width as i64, (lit.pixels().len() / width) as i64];
    seen[first[1] as usize * width + first[0] as usize] = true;
    let mut found = vec![first];
    let mut next = 0;
    while let Some(&[i, j]) = found.get(next) {
        next += 1;
        for (di, dj) in (-1..=1).flat_map(|dj| (-1..=1).map(move |di| (di, dj))) {
            let [x, y] = [i64::from(i) + di, i64::from(j) + dj];
            if !(0..size[0]).contains(&x) || !(0..size[1]).contains(&y) {
                continue;
            }
            let at = y as usize * width + x as usize;
            if !seen[at] && is_light(lit.brightness([x as usize, y as usize]), threshold) {
                seen[at] = true;
                found.push([x as u32, y as u32]);
            }
        }
    }
    // Whichever way they were found.
    found.sort_unstable_by_key(|&[i, j]| (j, i));
    found
}

/// Adds the parts of some pixels to those that there are, `most` of them at most.
fn halve(pixels: &mut [[u32; 2]], light: &impl Fn(&[u32; 2]) -> Moments, most: usize, parts: &mut Vec<Moments>) {
    let mut whole = Moments::default();
    pixels.iter().for_each(|pixel| whole.absorb(&light(pixel)));
    if pixels.len() <= FEW || most < 2 || is_round(&whole) {
        parts.push(whole);
        return;
    }
    let axis = longest(pixels);
    let along = |[i, j]: &[u32; 2]| axis.dot(DVec2::new(f64::from(*i), f64::from(*j)));
    pixels.sort_by(|a, b| along(a).total_cmp(&along(b)));
    // Halves of the extent and not of the light, so that a bright end does not leave a long one.
    let middle = 0.5 * (along(&pixels[0]) + along(&pixels[pixels.len() - 1]));
    let at = pixels.partition_point(|pixel| along(pixel) < middle).clamp(1, pixels.len() - 1);
    let (one, other) = pixels.split_at_mut(at);
    halve(one, light, most / 2, parts);
    halve(other, light, most - most / 2, parts);
}

/// The direction in which pixels spread most.
fn longest(pixels: &[[u32; 2]]) -> DVec2 {
    let places = || pixels.iter().map(|&[i, j]| DVec2::new(f64::from(i), f64::from(j)));
    let mean = places().sum::<DVec2>() / pixels.len() as f64;
    let [mut xx, mut xy, mut yy] = [0.0; 3];
    for away in places().map(|place| place - mean) {
        (xx, xy, yy) = (xx + away.x * away.x, xy + away.x * away.y, yy + away.y * away.y);
    }
    DVec2::from_angle(0.5 * (2.0 * xy).atan2(xx - yy))
}

#[cfg(test)]
mod tests {
    use super::super::emission::Emission;
    use super::super::regions::regions;
    use super::*;
    use crate::choices::LightBy;

    const EMISSION: Emission = Emission { weights: [0.25, 0.5, 0.25], straight: false, by: LightBy::Brightest };

    /// The parts of the one region of a picture.
    fn parts_of(size: [usize; 2], lit_at: impl Fn(f64, f64) -> bool) -> (Moments, Vec<Moments>) {
        let value = |k: usize| if lit_at((k % size[0]) as f64, (k / size[0]) as f64) { 3.0 } else { 0.0 };
        let pixels: Vec<[f32; 4]> = (0..size[0] * size[1]).map(|k| [value(k); 4]).collect();
        let lit = Lit::new(&pixels, size[0], EMISSION, 0.0);
        let found = regions(&lit, 1.0, 1.0);
        assert_eq!(found.len(), 1);
        (found[0], parts(&lit, 1.0, 1.0, &found))
    }

    fn keeps(whole: &Moments, parts: &[Moments]) {
        let sum = |of: fn(&Moments) -> f64| parts.iter().map(of).sum::<f64>();
        assert!((sum(|part| part.weight) / whole.weight - 1.0).abs() < 1e-12);
        assert!((sum(|part| part.flux[1]) / whole.flux[1] - 1.0).abs() < 1e-12);
        assert!((sum(|part| part.area) - whole.area).abs() < 1e-9);
        let mut joined = Moments::default();
        parts.iter().for_each(|part| joined.absorb(part));
        assert!(joined.mean.distance(whole.mean) < 1e-9 && (joined.spread / whole.spread - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_disc_and_a_square_are_one() {
        for of in [
            |x: f64, y: f64| (x - 20.0).hypot(y - 20.0) < 9.0,
            |x: f64, y: f64| (x - 20.0).abs().max((y - 20.0).abs()) < 7.0,
        ] {
            let (whole, parts) = parts_of([40, 40], of);
            assert!(is_round(&whole) && parts.len() == 1);
            keeps(&whole, &parts);
        }
        let (dot, parts) = parts_of([3, 3], |x, y| x == 1.0 && y == 1.0);
        assert!(is_round(&dot) && parts.len() == 1);
    }

    #[test]
    fn a_tube_is_a_row_of_lights_from_end_to_end() {
        for turned in [false, true] {
            let (whole, parts) = parts_of([300, 300], |x, y| {
                let (along, across) = if turned { (0.6 * x + 0.8 * y, 0.8 * x - 0.6 * y) } else { (x, y - 100.0) };
                (100.0..260.0).contains(&along) && (0.0..8.0).contains(&across)
            });
            assert!(!is_round(&whole) && (8..=40).contains(&parts.len()), "{}", parts.len());
            keeps(&whole, &parts);
            let farthest = parts.iter().map(|part| part.mean.distance(whole.mean)).fold(0.0, f64::max);
            assert!(farthest > 70.0 && parts.iter().all(|part| part.variance().sqrt() < 8.0), "{farthest}");
        }
    }

    #[test]
    fn a_ring_shines_where_it_is_and_not_in_its_middle() {
        let (whole, parts) = parts_of([200, 200], |x, y| ((x - 100.0).hypot(y - 100.0) - 70.0).abs() < 4.0);
        assert!(whole.mean.distance(DVec2::splat(100.0)) < 1e-9 && !is_round(&whole));
        keeps(&whole, &parts);
        assert!((24..=120).contains(&parts.len()), "{}", parts.len());
        for part in &parts {
            let radius = part.mean.distance(whole.mean);
            assert!((62.0..75.0).contains(&radius) && part.variance().sqrt() < 8.0, "{radius} {}", part.variance());
        }
    }
}
