//! Scenes by chance: every bell, sizes from a pixel to the picture, one ghost to thousands, and any tolerance.

use glam::DVec2;

use crate::chance::Chance;
use crate::frame::Frame;
use crate::scene::Ghost;
use crate::series::Bell;

/// A picture with ghosts, and a tolerance.
pub(super) struct Random {
    pub frame: Frame,
    pub ghosts: Vec<Ghost>,
    pub tolerance: f64,
    /// Which bells there are.
    pub bells: String,
}

/// Most ghosts of a scene.
const MOST: f64 = 10_000.0;

/// Sizes of which bells that bring a table have no more, in every other scene.
const FEW_SIZES: usize = 6;

/// A picture 64 to 1280 pixels wide, or of the size that is given; up to [`MOST`] ghosts of sizes from a pixel to half the
/// picture's width, within a factor of 30 of each other, somewhere in and around it; a tolerance from 1e-6 to 1e-1. Every
/// octave is as likely. A third of the scenes has Gaussians alone, a third one other bell, and a third all of them.
pub(super) fn random(seed: u64, size: Option<[u32; 2]>) -> Random {
    let mut chance = Chance::new(seed);
    let frame = frame(&mut chance, size);
    let count = octaves(&mut chance, 1.0, MOST) as usize;
    let tolerance = octaves(&mut chance, 1e-6, 1e-1);
    let bells = bells(&mut chance);
    let smallest = octaves(&mut chance, frame.pixel_size(), 0.5);
    let largest = (smallest * octaves(&mut chance, 1.0, 30.0)).min(1.0);
    let few = below(&mut chance, 2) == 0;
    let sizes: Vec<f64> = (0..FEW_SIZES).map(|_| octaves(&mut chance, smallest, largest)).collect();
    let half = 1.2 * DVec2::new(frame.half_width(), 1.0);
    let mut ghost = |_| {
        let bell = bells[below(&mut chance, bells.len())].clone();
        let tabulated = bell.shape().tabulated();
        let size = if few && tabulated {
            sizes[below(&mut chance, FEW_SIZES)]
        } else {
            octaves(&mut chance, smallest, largest)
        };
        let flat = if tabulated { 1.0 } else { chance.between(0.7, 1.0) };
        Ghost {
            bell,
            center: DVec2::new(chance.between(-half.x, half.x), chance.between(-half.y, half.y)),
            size: DVec2::new(size, size * flat),
            radiance: [0, 1, 2].map(|_| octaves(&mut chance, 0.05, 1.0)),
        }
    };
    let ghosts = (0..count).map(&mut ghost).collect();
    let bells = if let [bell] = &bells[..] { bell.to_string() } else { "all bells".to_owned() };
    Random { frame, ghosts, tolerance, bells }
}

fn frame(chance: &mut Chance, size: Option<[u32; 2]>) -> Frame {
    let width = octaves(chance, 64.0, 1280.0);
    let height = (width / chance.between(0.7, 2.4)).max(1.0);
    let [width, height] = size.unwrap_or([width as u32, height as u32]);
    Frame::full(width, height)
}

/// The bells of a scene. Periodic ones share one period, somewhat larger than the picture.
fn bells(chance: &mut Chance) -> Vec<Bell> {
    let period = DVec2::new(chance.between(5.0, 9.0), chance.between(3.0, 6.0));
    let mut all: Vec<Bell> = Bell::examples().into_iter().map(|bell| bell.in_period(period)).collect();
    match below(chance, 3) {
        0 => vec![Bell::Gaussian],
        1 => vec![all.swap_remove(1 + below(chance, all.len() - 1))],
        _ => all,
    }
}

fn octaves(chance: &mut Chance, low: f64, high: f64) -> f64 {
    chance.between(low.ln(), high.ln()).exp()
}

/// One of the first `count` numbers.
fn below(chance: &mut Chance, count: usize) -> usize {
    (chance.between(0.0, count as f64) as usize).min(count - 1)
}
