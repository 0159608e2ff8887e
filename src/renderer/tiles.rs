//! Tiles: pictures beyond the driver's limits, or beyond what memory should hold at once, are done piece by piece.
//!
//! Every pass is pointwise once the spectrum is known, and what a pixel sees is computed from its place in the picture
//! alone, so tiles meet without a seam, bit for bit.

use glam::DVec2;

use crate::frame::{Frame, Window};
use crate::gpu::evaluators::LatticeTile;
use crate::gpu::layout::Knot;
use crate::plan::Lattice;
use crate::series::phase;

/// The largest tile: 4 Mpx, 64 MiB for each texture of RGBA f32.
pub(super) const PIXELS: usize = 4 << 20;

/// Bells that one draw may evaluate.
pub(super) const BELLS: usize = 20_000_000_000;

/// Splits a window into tiles of at most `side` pixels a side and `pixels` in all; whole rows where possible.
pub(super) fn split(window: Window, side: u32, pixels: usize) -> Vec<Window> {
    let width = window.width.min(side).min(u32::try_from(pixels).unwrap_or(u32::MAX)).max(1);
    let height = ((pixels / width as usize) as u32).clamp(1, side);
    let mut tiles = Vec::new();
    for y in (0..window.height).step_by(height as usize) {
        for x in (0..window.width).step_by(width as usize) {
            tiles.push(Window {
                x: window.x + x as i32,
                y: window.y + y as i32,
                width: width.min(window.width - x),
                height: height.min(window.height - y),
            });
        }
    }
    tiles
}

/// Phases of `count` positions along one axis.
pub(super) fn phases(count: u32, position: impl Fn(f64) -> f64, period: f64) -> Vec<u32> {
    (0..count).map(|index| phase(position(f64::from(index)), period)).collect()
}

/// The lattice's nodes that a tile needs, and where its columns and rows lie among them.
pub(super) struct Nodes {
    phases: [Vec<u32>; 2],
    steps: [u32; 2],
    knots: [Vec<Knot>; 2],
}

impl Nodes {
    pub fn new(lattice: &Lattice, period: DVec2, frame: Frame, tile: Window) -> Self {
        // The lattice hangs from the window's top left pixel, whichever tile asks.
        let origin = frame.position(f64::from(frame.window.x), f64::from(frame.window.y));
        let pixel = frame.pixel_size();
        let columns = knots(tile.x - frame.window.x, tile.width, pixel / lattice.step.x);
        let rows = knots(tile.y - frame.window.y, tile.height, pixel / lattice.step.y);
        let node_phases = |first: u32, count: u32, position: &dyn Fn(f64) -> f64, period: f64| {
            phases(count, |index| position(f64::from(first) + index - 1.0), period)
        };
        let x = |k: f64| origin.x + k * lattice.step.x;
        let y = |k: f64| origin.y - k * lattice.step.y;
        Self {
            phases: [
                node_phases(columns.first, columns.count, &x, period.x),
                node_phases(rows.first, rows.count, &y, period.y),
            ],
            steps: [phase(lattice.step.x, period.x), phase(lattice.step.y, period.y)],
            knots: [columns.knots, rows.knots],
        }
    }

    pub fn tile(&self) -> LatticeTile<'_> {
        LatticeTile {
            node_phases: [&self.phases[0], &self.phases[1]],
            steps: self.steps,
            knots: [&self.knots[0], &self.knots[1]],
        }
    }
}

struct Knots {
    /// The first node that the tile needs, and how many.
    first: u32,
    count: u32,
    /// Counted from that node.
    knots: Vec<Knot>,
}

/// Where `count` pixels lie, the first of them `from` pixels after the lattice's origin, `pitch` nodes apart.
fn knots(from: i32, count: u32, pitch: f64) -> Knots {
    let place = |index: u32| (f64::from(from) + f64::from(index)) * pitch;
    let first = place(0).floor() as u32;
    let last = place(count - 1).floor() as u32;
    let knot = |index| {
        let place = place(index);
        Knot { first: place.floor() as u32 - first, fraction: place.fract() as f32 }
    };
    Knots { first, count: last - first + 4, knots: (0..count).map(knot).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        let window = Window { x: -3, y: 5, width: 17, height: 31 };
        for (side, pixels) in [(16384, 1 << 22), (16384, 40), (5, 1 << 22), (7, 9), (1, 1)] {
            let tiles = split(window, side, pixels);
            assert!(tiles.iter().all(|tile| tile.width <= side && tile.height <= side && tile.pixels() <= pixels));
            let mut seen = vec![0; window.pixels()];
            for tile in &tiles {
                for j in 0..tile.height as i32 {
                    for i in 0..tile.width as i32 {
                        seen[((tile.y + j - window.y) * 17 + tile.x + i - window.x) as usize] += 1;
                    }
                }
            }
            assert!(seen.iter().all(|&count| count == 1), "{side} {pixels}");
        }
    }

    #[test]
    fn a_tile_sees_the_nodes_that_the_whole_window_sees() {
        let lattice = Lattice { step: DVec2::new(0.037, 0.051), nodes: [0; 2], oversampling: DVec2::ONE, error: 0.0 };
        let frame = Frame::full(640, 480);
        let whole = Nodes::new(&lattice, DVec2::new(5.0, 4.0), frame, frame.window);
        let tile = Window { x: 200, y: 113, width: 77, height: 64 };
        let part = Nodes::new(&lattice, DVec2::new(5.0, 4.0), frame, tile);
        for (axis, from, count) in [(0, 200, 77), (1, 113, 64)] {
            for index in 0..count {
                let (a, b) = (whole.knots[axis][from + index], part.knots[axis][index]);
                assert_eq!(a.fraction, b.fraction);
                for node in 0..4 {
                    let phase_of = |nodes: &Nodes, knot: Knot| nodes.phases[axis][knot.first as usize + node];
                    assert_eq!(phase_of(&whole, a), phase_of(&part, b));
                }
            }
        }
    }
}
