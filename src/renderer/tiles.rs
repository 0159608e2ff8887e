//! Tiles: pictures beyond the driver's limits, or beyond what memory should hold at once, are done piece by piece.
//!
//! Every pass is pointwise once the spectrum is known, and what a pixel sees is computed from its place in the picture
//! alone, so tiles meet without a seam, bit for bit.

use glam::DVec2;

use crate::frame::{Frame, Window};
use crate::gpu::evaluators::LatticeTile;
use crate::gpu::layout::{KNOT_BITS, Knots};
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
    knots: [Knots; 2],
    height: u32,
}

impl Nodes {
    pub fn new(lattice: &Lattice, period: DVec2, frame: Frame, tile: Window) -> Self {
        // The lattice hangs from the window's top left pixel, whichever tile asks.
        let origin = frame.position(f64::from(frame.window.x), f64::from(frame.window.y));
        let pixel = frame.pixel_sides();
        let [pitch_x, pitch_y] = (pixel / lattice.step).to_array().map(Pitch::new);
        let columns = pitch_x.span(tile.x - frame.window.x, tile.width);
        let rows = pitch_y.span(tile.y - frame.window.y, tile.height);
        // The step that the pitch stands for exactly; it differs from the plan's by rounding.
        let step = pixel / DVec2::new(pitch_x.nodes(), pitch_y.nodes());
        let node_phases = |span: &Span, position: &dyn Fn(f64) -> f64, period: f64| {
            phases(span.nodes, |index| position(span.first as f64 + index - 1.0), period)
        };
        let x = |k: f64| origin.x + k * step.x;
        let y = |k: f64| origin.y - k * step.y;
        Self {
            phases: [node_phases(&columns, &x, period.x), node_phases(&rows, &y, period.y)],
            steps: [phase(step.x, period.x), phase(step.y, period.y)],
            knots: [columns.knots, rows.knots],
            height: tile.height,
        }
    }

    pub fn tile(&self) -> LatticeTile<'_> {
        LatticeTile {
            node_phases: [&self.phases[0], &self.phases[1]],
            steps: self.steps,
            knots: self.knots,
            height: self.height,
        }
    }
}

/// Nodes from pixel to pixel, with [`KNOT_BITS`] bits after the point.
#[derive(Clone, Copy)]
struct Pitch(u64);

/// The nodes that a tile needs along one axis.
struct Span {
    /// The first, and how many.
    first: u64,
    nodes: u32,
    /// Where the tile's pixels lie, counted from that node.
    knots: Knots,
}

impl Pitch {
    const BITS: u32 = KNOT_BITS;

    /// Rounded so that the nodes lie closer together than the plan wants, never farther apart.
    fn new(nodes: f64) -> Self {
        Self(((nodes * f64::from(1 << Self::BITS)).ceil() as u64).max(1))
    }

    fn nodes(self) -> f64 {
        self.0 as f64 / f64::from(1 << Self::BITS)
    }

    /// For `count` pixels, the first of them `from` pixels after the lattice's origin.
    fn span(self, from: i32, count: u32) -> Span {
        let place = |index: u32| (from as u64 + u64::from(index)) * self.0;
        let first = place(0) >> Self::BITS;
        let last = place(count - 1) >> Self::BITS;
        let knots = Knots { start: (place(0) - (first << Self::BITS)) as u32, pitch: self.0 as u32, pad: [0; 2] };
        Span { first, nodes: (last - first) as u32 + 4, knots }
    }
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
        let place = |knots: Knots, index: u64| {
            // In u32, like the shader.
            let place = knots.start.wrapping_add((index as u32).wrapping_mul(knots.pitch));
            ((place >> Pitch::BITS) as usize, place & ((1 << Pitch::BITS) - 1))
        };
        for (axis, from, count) in [(0, 200, 77), (1, 113, 64)] {
            for index in 0..count {
                let (first, fraction) = place(whole.knots[axis], from + index);
                let (of_part, same_fraction) = place(part.knots[axis], index);
                assert_eq!(fraction, same_fraction);
                for node in 0..4 {
                    assert_eq!(whole.phases[axis][first + node], part.phases[axis][of_part + node]);
                }
            }
        }
    }
}
