//! Scenes by chance, the same in every run.

use glam::DVec2;
use vglare::frame::{Frame, Window};
use vglare::plan::Plan;
use vglare::scene::Ghost;
use vglare::series::Bell;

#[path = "../../../src/chance.rs"]
mod chance;

pub(crate) use chance::Chance;

impl Chance {
    /// From `low` to `high`, every octave as likely.
    pub fn octaves(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// 0 ..= `last`.
    pub fn up_to(&mut self, last: u32) -> u32 {
        self.below(u64::from(last) + 1) as u32
    }

    /// Below `count`.
    pub fn below(&mut self, count: u64) -> u64 {
        self.bits() % count
    }
}

/// `count` ghosts: sizes 0.05 to 1, one in four of them stretched up to fourfold, colours that differ, one in eight
/// centres off the picture by up to half its size.
pub fn random(seed: u64, count: usize, frame: Frame) -> Vec<Ghost> {
    sized(seed, count, frame, 0.05, 1.0)
}

/// As [`random`] with sizes between `smallest` and `largest`.
pub fn sized(seed: u64, count: usize, frame: Frame, smallest: f64, largest: f64) -> Vec<Ghost> {
    let mut chance = Chance::new(seed);
    let half = DVec2::new(f64::from(frame.width) / f64::from(frame.height), 1.0);
    let ghost = |_| {
        let reach = half * if chance.up_to(7) == 0 { 1.5 } else { 1.0 };
        let size = chance.octaves(smallest, largest);
        let stretch = if chance.up_to(3) == 0 { chance.octaves(0.5, 2.0) } else { 1.0 };
        Ghost {
            bell: Bell::Gaussian,
            center: DVec2::new(chance.between(-reach.x, reach.x), chance.between(-reach.y, reach.y)),
            size: DVec2::new((size * stretch).clamp(smallest, largest), (size / stretch).clamp(smallest, largest)),
            radiance: [chance.octaves(0.02, 2.0), chance.octaves(0.1, 1.0), chance.octaves(0.001, 10.0)],
        }
    };
    (0..count).map(ghost).collect()
}

/// A ghost of a bell, of a size from a pixel to two pictures.
pub fn of(chance: &mut Chance, bell: Bell, frame: Frame) -> Ghost {
    let half = frame.half_width();
    let center = DVec2::new(chance.between(-1.3 * half, 1.3 * half), chance.between(-1.3, 1.3));
    let size = DVec2::splat(chance.octaves(frame.pixel_size(), 4.0));
    Ghost { bell, center, size, radiance: [(); 3].map(|()| chance.octaves(0.05, 2.0)) }
}

/// One round ghost.
pub fn one(center: [f64; 2], size: f64, radiance: [f64; 3]) -> Ghost {
    Ghost { bell: Bell::Gaussian, center: center.into(), size: DVec2::splat(size), radiance }
}

/// Pixels of the window worth a look: corners, borders, one in each stratum of an 6 × 6 grid, the ghosts' centres, and
/// where the plan found the field large.
pub fn probes(seed: u64, ghosts: &[Ghost], plan: &Plan, frame: Frame) -> Vec<[i32; 2]> {
    const STRATA: u32 = 6;
    const CENTRES: usize = 12;
    let Window { x, y, width, height } = frame.window;
    let mut chance = Chance::new(seed);
    let mut pixels = plan.peaks.clone();
    let last = [width - 1, height - 1];
    for [i, j] in [[0, 0], [last[0], 0], [0, last[1]], last] {
        pixels.push([i as i32 + x, j as i32 + y]);
    }
    for edge in 0..2 {
        let (i, j) = (chance.up_to(last[0]), chance.up_to(last[1]));
        pixels.push([i as i32 + x, (edge * last[1]) as i32 + y]);
        pixels.push([(edge * last[0]) as i32 + x, j as i32 + y]);
    }
    for stratum in 0..STRATA * STRATA {
        let mut within = |index: u32, length: u32| {
            let at = (f64::from(index) + chance.between(0.0, 1.0)) / f64::from(STRATA) * f64::from(length);
            (at as u32).min(length - 1) as i32
        };
        pixels.push([within(stratum % STRATA, width) + x, within(stratum / STRATA, height) + y]);
    }
    for ghost in ghosts.iter().step_by((ghosts.len() / CENTRES).max(1)) {
        let pixel = frame.pixel(ghost.center).round().as_ivec2();
        if (x..x + width as i32).contains(&pixel.x) && (y..y + height as i32).contains(&pixel.y) {
            pixels.push(pixel.to_array());
        }
    }
    pixels.sort_unstable();
    pixels.dedup();
    pixels
}

/// Every pixel of the window, row by row from the top.
pub fn every_pixel(frame: Frame) -> Vec<[i32; 2]> {
    let Window { x, y, width, height } = frame.window;
    (y..y + height as i32).flat_map(|j| (x..x + width as i32).map(move |i| [i, j])).collect()
}

/// Where pixels lie on the picture plane.
pub fn positions(frame: Frame, pixels: &[[i32; 2]]) -> Vec<DVec2> {
    pixels.iter().map(|&[i, j]| frame.position(f64::from(i), f64::from(j))).collect()
}
