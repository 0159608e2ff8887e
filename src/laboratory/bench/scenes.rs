//! What the bench lets glare: always the same.

use std::sync::Arc;

use glam::DVec2;

use crate::Result;
use crate::frame::Frame;
use crate::plan::{Evaluator, Plan, Request, plan};
use crate::problem::Problem;
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
    let aspect = frame.half_width();
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

/// A round Gaussian.
pub(super) fn gaussian(center: DVec2, size: f64, radiance: [f64; 3]) -> Ghost {
    Ghost { bell: Bell::Gaussian, center, size: DVec2::splat(size), radiance }
}

/// The plan of one evaluator for ghosts, at a tolerance, by the built-in cost model.
pub(in crate::laboratory) fn by(
    evaluator: Evaluator,
    ghosts: impl Into<Arc<[Ghost]>>,
    frame: Frame,
    tolerance: f64,
) -> Result<Plan> {
    plan(&Problem::new(ghosts, frame), &Request { evaluator: Some(evaluator), ..Request::new(tolerance) })
}

/// The plan of a series of one evaluator in a given degree. That decides the error; the tolerance, how finely `grid`
/// interpolates.
pub(in crate::laboratory) fn by_hand(
    evaluator: Evaluator,
    ghosts: &[Ghost],
    frame: Frame,
    degree: [u32; 2],
) -> Result<Plan> {
    let period = Some(DVec2::new(2.0 * frame.half_width() + 2.0, 4.0));
    let request = Request { period, degree: Some(degree), evaluator: Some(evaluator), ..Request::new(1e-2) };
    plan(&Problem::new(ghosts, frame), &request)
}

/// `count` Gaussians from one size to another, each as likely, spread evenly over the picture.
pub(super) fn between(count: usize, [smallest, largest]: [f64; 2], frame: Frame) -> Vec<Ghost> {
    // What `scattered` has between its smallest size and twice that.
    let sized = |ghost: Ghost| {
        let size = smallest + (largest - smallest) * (ghost.size - 1.0);
        Ghost { center: ghost.center / 1.1, size, ..ghost }
    };
    scattered(count, 1.0, frame).into_iter().map(sized).collect()
}

/// `count` Gaussians of one size, spread evenly over the picture; benches/peers/peers.py has the same.
pub(super) fn alike(count: usize, size: f64, frame: Frame) -> Vec<Ghost> {
    let resized = |ghost: Ghost| Ghost { center: ghost.center / 1.1, size: DVec2::splat(size), ..ghost };
    scattered(count, size, frame).into_iter().map(resized).collect()
}
