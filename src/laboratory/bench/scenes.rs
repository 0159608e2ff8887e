//! What the bench lets glare: always the same.

use glam::DVec2;

use crate::Result;
use crate::chance::Chance;
use crate::frame::Frame;
use crate::scene::presets::{self, DEFAULT_PRESET};
use crate::scene::{Ghost, Light, ghosts};
use crate::series::Bell;

/// Five lights through the lens that is used where none is named.
pub(super) fn default_lens() -> Result<Vec<Ghost>> {
    let lights = [(-0.9, 0.6, 3.0), (0.2, 0.7, 1.0), (0.75, -0.1, 2.0), (-0.3, -0.5, 0.5), (1.3, 0.85, 1.5)];
    let light = |(x, y, flux): (f64, f64, f64)| Light {
        position: DVec2::new(x, y),
        flux: [flux, 0.9 * flux, 0.7 * flux],
        size: 0.02,
        muted: false,
    };
    Ok(ghosts(&lights.map(light), &presets::named(DEFAULT_PRESET)?, DVec2::ZERO))
}

/// `count` Gaussians spread evenly over the picture and a little beyond, of `smallest` to twice that size.
pub(in crate::laboratory) fn scattered(count: usize, smallest: f64, frame: Frame) -> Vec<Ghost> {
    let aspect = f64::from(frame.width) / f64::from(frame.height);
    // Multiples of irrational numbers, modulo 1: as even as a grid, and without its rows.
    let part = |k: usize, irrational: f64| (0.5 + k as f64 * irrational).fract();
    let one = |k: usize| Ghost {
        bell: Bell::Gaussian,
        center: 2.2 * DVec2::new(aspect * (part(k, 0.754_877_666) - 0.5), part(k, 0.569_840_291) - 0.5),
        size: DVec2::splat(smallest * (1.0 + part(k, 0.618_033_989))),
        radiance: [part(k, 0.414_213_562), part(k, 0.732_050_808), part(k, 0.236_067_977)],
    };
    (0..count).map(one).collect()
}

/// `count` Gaussians of one size, spread evenly over the picture; benches/peers/peers.py has the same.
pub(super) fn alike(count: usize, size: f64, frame: Frame) -> Vec<Ghost> {
    let resized = |ghost: Ghost| Ghost { center: ghost.center / 1.1, size: DVec2::splat(size), ..ghost };
    scattered(count, size, frame).into_iter().map(resized).collect()
}

/// A picture with Gaussians, and a tolerance.
pub(super) struct Random {
    pub frame: Frame,
    pub ghosts: Vec<Ghost>,
    pub tolerance: f64,
}

/// A picture 64 to 1280 pixels wide, 1 to 2000 ghosts of sizes within a factor of 6, somewhere in and around it, and a
/// tolerance from 1e-4 to 1e-1; every octave as likely.
pub(super) fn random(seed: u64) -> Random {
    let mut chance = Chance::new(seed);
    let octaves = |chance: &mut Chance, low: f64, high: f64| chance.between(low.ln(), high.ln()).exp();
    let width = octaves(&mut chance, 64.0, 1280.0);
    let frame = Frame::full(width as u32, (width / chance.between(0.7, 2.4)).max(1.0) as u32);
    let count = octaves(&mut chance, 1.0, 2000.0) as usize;
    let tolerance = octaves(&mut chance, 1e-4, 1e-1);
    let smallest = octaves(&mut chance, 0.02, 0.5);
    let largest = smallest * octaves(&mut chance, 1.0, 6.0);
    let half = 1.2 * DVec2::new(f64::from(frame.width) / f64::from(frame.height), 1.0);
    let mut ghost = |_| {
        let size = octaves(&mut chance, smallest, largest);
        Ghost {
            bell: Bell::Gaussian,
            center: DVec2::new(chance.between(-half.x, half.x), chance.between(-half.y, half.y)),
            size: DVec2::new(size, size * chance.between(0.7, 1.0)),
            radiance: [0, 1, 2].map(|_| octaves(&mut chance, 0.05, 1.0)),
        }
    };
    Random { frame, ghosts: (0..count).map(&mut ghost).collect(), tolerance }
}
