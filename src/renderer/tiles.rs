//! Tiles: pictures beyond the driver's limits, or beyond what memory should hold at once, are done piece by piece.
//!
//! Every pass is pointwise once the spectrum is known, and what a pixel sees is computed from its place in the picture
//! alone, so tiles meet without a seam, bit for bit.

use std::f64::consts::TAU;

use glam::DVec2;
use rustfft::num_complex::Complex;

use crate::frame::{Frame, Window};
use crate::gpu::evaluators::{LatticeTile, SummedTile};
use crate::gpu::exact::{self, ExactTile};
use crate::gpu::layout::{FINE_BITS, KNOT_BITS, Knots};
use crate::plan::{DOUBLE_ORDER, Lattice, Series};
use crate::series::{phase, spline_gains, waves};

const _: () = assert!(DOUBLE_ORDER == exact::ORDER);

/// The largest tile: 4 Mpx, 64 MiB for each texture of RGBA f32.
pub(super) const PIXELS: usize = 4 << 20;

/// What a pixel takes on a canvas of doubles, and a little.
pub(super) const CANVAS_BYTES: u64 = 25;

/// Bells that one draw may evaluate.
pub(super) const BELLS: usize = 20_000_000_000;

/// Most nodes along an axis that places in 32 bits tell apart, the first and the last of which may lie a pixel outside.
const MOST_NODES: u32 = 4000;
const _: () = assert!(MOST_NODES < (1 << (32 - KNOT_BITS)) - 1);

/// Splits a window into tiles of at most so many columns and rows, and `pixels` in all; whole rows where possible.
pub(super) fn split(window: Window, [columns, rows]: [u32; 2], pixels: usize) -> Vec<Window> {
    let width = window.width.min(columns).min(u32::try_from(pixels).unwrap_or(u32::MAX)).max(1);
    let height = u32::try_from(pixels / width as usize).unwrap_or(u32::MAX).clamp(1, rows);
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

/// The most columns and rows of a tile whose lattice a shader can index, and textures of so many texels a side hold: three of
/// them for each node of a row.
pub(super) fn sides_on(lattice: &Lattice, frame: Frame, texture_size: u32) -> [u32; 2] {
    let pitch = (frame.pixel_sides() / lattice.step).to_array();
    let most = [texture_size / 3, texture_size].map(|most| f64::from(most.min(MOST_NODES)));
    // So many nodes hold a pixel, and rounding may ask for one more.
    let hold = f64::from(lattice.order + 1);
    [0, 1].map(|axis| ((most[axis] - hold) / pitch[axis]).floor().max(0.0) as u32).map(|side| side.saturating_add(1))
}

/// The most columns and rows of a tile whose waves, sums and nodes of doubles each fit a storage block of so many bytes.
pub(super) fn sides_of_doubles(series: &Series, frame: Frame, block: u64) -> [u32; 2] {
    const WAVE: f64 = 16.0;
    const PROFILE: f64 = 48.0;
    const NODE: f64 = 24.0;
    // A wave more says how many there are.
    let block = block as f64 - WAVE;
    let [across, along] = series.degree().map(|degree| f64::from(degree + 1));
    let (columns, rows) = (block / (WAVE * across), block / (WAVE * along).max(PROFILE * across));
    let whole = |sides: [f64; 2]| sides.map(|side| (side as u32).max(1));
    let Some(lattice) = series.lattice else { return whole([columns, rows]) };
    // Nodes a pixel, and those that a tile has beside.
    let (pitch, beside) = (frame.pixel_sides() / lattice.step, f64::from(lattice.order + 2));
    let width = ((columns - beside) / pitch.x).min(f64::from(frame.window.width));
    let columns = width.max(1.0) * pitch.x + beside;
    let lines = block / (NODE * columns);
    whole([width, ((rows.min(lines) - beside) / pitch.y).min(lines)])
}

/// The same positions in periods, within half of one.
pub(super) fn turns(count: u32, position: impl Fn(f64) -> f64, period: f64) -> Vec<f64> {
    let turns = |index| position(f64::from(index)) / period;
    (0..count).map(|index| turns(index) - turns(index).round()).collect()
}

/// The lattice's nodes that a tile needs, and where its columns and rows lie among them.
pub(super) struct Nodes {
    first: [f64; 2],
    counts: [u32; 2],
    origin: DVec2,
    step: DVec2,
    planned: DVec2,
    period: DVec2,
    knots: [Knots; 2],
    height: u32,
}

impl Nodes {
    pub fn new(lattice: &Lattice, period: DVec2, frame: Frame, tile: Window) -> Self {
        // The lattice hangs from the window's top left pixel, whichever tile asks.
        let origin = frame.position(f64::from(frame.window.x), f64::from(frame.window.y));
        let pixel = frame.pixel_sides();
        let [pitch_x, pitch_y] = (pixel / lattice.step).to_array().map(Pitch::new);
        let columns = pitch_x.span(lattice.order, tile.x - frame.window.x, tile.width);
        let rows = pitch_y.span(lattice.order, tile.y - frame.window.y, tile.height);
        // The step that the pitch stands for exactly; it differs from the plan's by rounding.
        let step = pixel / DVec2::new(pitch_x.nodes(), pitch_y.nodes());
        // The second of four nodes is the last that is not beyond the pixel, the fourth of eight.
        let before = f64::from(lattice.order / 2 - 1);
        Self {
            first: [columns.first as f64 - before, rows.first as f64 - before],
            counts: [columns.nodes, rows.nodes],
            origin,
            step,
            planned: lattice.step,
            period,
            knots: [columns.knots, rows.knots],
            height: tile.height,
        }
    }

    /// Where a node lies along an axis.
    fn position(&self, axis: usize, index: f64) -> f64 {
        self.place(axis, index, self.step[axis])
    }

    fn place(&self, axis: usize, index: f64, step: f64) -> f64 {
        let away = (self.first[axis] + index) * step;
        self.origin[axis] + if axis == 0 { away } else { -away }
    }

    /// How many nodes there are along an axis.
    pub fn count(&self, axis: usize) -> usize {
        self.counts[axis] as usize
    }

    /// The nodes' phases along an axis.
    pub fn phases(&self, axis: usize) -> Vec<u32> {
        phases(self.counts[axis], |index| self.position(axis, index), self.period[axis])
    }

    /// The nodes around a period along an axis, of which a whole number makes one, and the harmonics at them, divided by what the
    /// B-spline makes of these. Along y they go down.
    pub fn ring(&self, axis: usize, degree: u32, order: u32) -> Ring {
        // That of the plan: where a period is very long, that of the pitch is rounded, and no pixel sees the difference.
        let step = self.planned[axis];
        let around = self.period[axis] / step;
        debug_assert!((around - around.round()).abs() < 1e-6 * around, "{around} nodes make a period");
        let before = f64::from(order / 2 - 1);
        let first = self.first[axis] + before;
        let turns = self.place(axis, -first, step) / self.period[axis];
        let turned = |(n, gain): (usize, f64)| {
            let turns = n as f64 * turns;
            let wave = Complex::from_polar(if n == 0 { gain } else { 0.5 * gain }, TAU * (turns - turns.round()));
            Wave::new(wave.re as f32, wave.im as f32)
        };
        let gains = spline_gains(order, degree, step / self.period[axis]);
        Ring {
            nodes: around.round() as usize,
            first: first as usize,
            turned: gains.into_iter().enumerate().map(turned).collect(),
        }
    }

    /// What a lattice in 32-bit floats takes beside phases.
    pub fn tile<'a>(&self, node_phases: [&'a [u32]; 2]) -> LatticeTile<'a> {
        let steps = [phase(self.step.x, self.period.x), phase(self.step.y, self.period.y)];
        LatticeTile { node_phases, steps, knots: self.knots, height: self.height }
    }

    /// What one takes whose nodes have their values.
    pub fn summed_tile<'a>(&self, values: &'a [[f32; 4]]) -> SummedTile<'a> {
        SummedTile { nodes: self.counts, values, knots: self.knots, height: self.height }
    }

    /// And what one in 64-bit floats does.
    pub fn exact_tile(&self) -> ExactTile {
        ExactTile { knots: self.knots, height: self.height }
    }

    /// cos and sin of the harmonics at the nodes along an axis, divided by what the B-spline makes of them.
    pub fn waves(&self, axis: usize, degree: u32, order: u32) -> Vec<[f64; 2]> {
        let gains = spline_gains(order, degree, self.step[axis] / self.period[axis]);
        waves(&turns(self.counts[axis], |index| self.position(axis, index), self.period[axis]), &gains)
    }
}

/// A wave of a lattice that is transformed.
pub(super) type Wave = Complex<f32>;

/// The nodes of one period along an axis, from the first of the whole window on, and how the harmonics come to that: what a transform
/// takes, whichever tile asks, so that all of them have the same bits.
pub(super) struct Ring {
    /// How many there are.
    pub nodes: usize,
    /// Which of them is the first that the tile needs.
    pub first: usize,
    /// Of each harmonic its gain times e^{inθ} with the first node's phase θ, and but for the first harmonic one half of that.
    pub turned: Vec<Wave>,
}

/// Nodes from pixel to pixel, with as many bits after the point as [`Knots`] have.
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
    const BITS: u32 = KNOT_BITS + FINE_BITS;
    const ONE: u64 = 1 << Self::BITS;

    /// Rounded so that the nodes lie closer together than the plan wants, never farther apart.
    fn new(nodes: f64) -> Self {
        Self(((nodes * Self::ONE as f64).ceil() as u64).max(1))
    }

    fn nodes(self) -> f64 {
        self.0 as f64 / Self::ONE as f64
    }

    /// For `count` pixels, the first of them `from` pixels after the lattice's origin.
    fn span(self, order: u32, from: i32, count: u32) -> Span {
        let place = |index: u32| (from as u64 + u64::from(index)) * self.0;
        let first = place(0) >> Self::BITS;
        let last = place(count - 1) >> Self::BITS;
        let nodes = (last - first) as u32 + order;
        let [[start, fine_start], [pitch, fine_pitch]] = [place(0) - (first << Self::BITS), self.0]
            .map(|place| [place >> FINE_BITS, place % (1 << FINE_BITS)].map(|bits| bits as u32));
        Span { first, nodes, knots: Knots { start, pitch, nodes, fine: (fine_start << FINE_BITS) | fine_pitch } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Evaluator, Precision};

    #[test]
    fn tiles_cover_every_pixel_once() {
        let window = Window { x: -3, y: 5, width: 17, height: 31 };
        for ([columns, rows], pixels) in
            [([16384; 2], 1 << 22), ([16384; 2], 40), ([5; 2], 1 << 22), ([9, 4], 1 << 22), ([7; 2], 9), ([1; 2], 1)]
        {
            let tiles = split(window, [columns, rows], pixels);
            assert!(tiles.iter().all(|tile| tile.width <= columns && tile.height <= rows && tile.pixels() <= pixels));
            let mut seen = vec![0; window.pixels()];
            for tile in &tiles {
                for j in 0..tile.height as i32 {
                    for i in 0..tile.width as i32 {
                        seen[((tile.y + j - window.y) * 17 + tile.x + i - window.x) as usize] += 1;
                    }
                }
            }
            assert!(seen.iter().all(|&count| count == 1), "{columns} {rows} {pixels}");
        }
    }

    #[test]
    fn a_tile_as_large_as_its_lattice_allows_has_no_more_nodes_than_can_be_told_apart() {
        let frame = Frame::full(3000, 2000);
        let mut tightest = 0;
        for step in [1e-9, 1e-5, 3.3e-5, 1e-4, 7e-4, 2e-3, 0.1, 40.0] {
            let lattice = Lattice {
                order: 4,
                step: DVec2::splat(step),
                nodes: [0; 2],
                oversampling: DVec2::ONE,
                on_cpu: false,
                error: 0.0,
            };
            for texture_size in [256, 16384] {
                let most = [(texture_size / 3).min(MOST_NODES), texture_size.min(MOST_NODES)];
                let [width, height] = sides_on(&lattice, frame, texture_size);
                let [width, height] = [width.min(frame.width), height.min(frame.height)];
                for from in [0, 1, 7].map(|from| from.min(frame.width - width).min(frame.height - height) as i32) {
                    let tile = Window { x: from, y: from, width, height };
                    let nodes = Nodes::new(&lattice, DVec2::new(5.0, 4.0), frame, tile);
                    for axis in [0, 1] {
                        let count = nodes.count(axis) as u32;
                        assert!(count <= most[axis], "{step} {texture_size}: {count} nodes");
                        let last = [width, height][axis] - 1;
                        let Knots { start, pitch, fine, .. } = nodes.knots[axis];
                        let carry = (u64::from(fine >> 16) + u64::from(last) * u64::from(fine & 0xffff)) >> 16;
                        let end = u64::from(start) + u64::from(last) * u64::from(pitch) + carry;
                        assert!(end <= u64::from(u32::MAX), "{step}: the last pixel's place is beyond 32 bits");
                        tightest = tightest.max(count);
                    }
                }
            }
        }
        assert!(tightest > MOST_NODES - 100, "{tightest}");
    }

    #[test]
    fn what_a_tile_of_doubles_takes_fits_a_block() {
        let frame = Frame::full(16384, 9000);
        let lattice = |nodes: [u32; 2]| {
            let (low, high) = frame.bounds();
            let step = (high - low) / DVec2::new(f64::from(nodes[0]), f64::from(nodes[1]));
            Lattice { order: 8, step, nodes, oversampling: DVec2::ONE, on_cpu: false, error: 0.0 }
        };
        for (degree, lattice) in
            [(100, None), (4000, None), (900, Some(lattice([3000, 2000]))), (4000, Some(lattice([4000, 3900])))]
        {
            let series = Series {
                evaluator: if lattice.is_some() { Evaluator::Grid } else { Evaluator::Rows },
                precision: Precision::Double,
                period: DVec2::new(8.0, 6.0),
                counts: vec![degree + 1; degree as usize + 1].into(),
                groups: Vec::new(),
                modes: None,
                lattice,
            };
            for block in [16u64 << 20, 128 << 20] {
                let sides = sides_of_doubles(&series, frame, block);
                let [width, height] = [sides[0].min(frame.width), sides[1].min(frame.height)];
                assert!(width > 1 && height > 1, "{degree}, {block}: {width} x {height}");
                // Wherever it lies.
                let tile = Window { x: 16384 - width as i32, y: 9000 - height as i32, width, height };
                let [columns, rows] = match &lattice {
                    Some(lattice) => {
                        let nodes = Nodes::new(lattice, series.period, frame, tile);
                        [nodes.count(0), nodes.count(1)]
                    }
                    None => [width, height].map(|side| side as usize),
                };
                let harmonics = degree as usize + 1;
                let strips = if lattice.is_some() { 24 * columns * height as usize } else { 0 };
                let nodes = if lattice.is_some() { 24 * columns * rows } else { 0 };
                for bytes in
                    [16 * (columns * harmonics + 1), 16 * (rows * harmonics + 1), 48 * rows * harmonics, nodes, strips]
                {
                    assert!(bytes as u64 <= block, "{degree}, {block}: {bytes} of a tile of {width} x {height}");
                }
            }
        }
    }

    #[test]
    fn a_tile_sees_the_nodes_that_the_whole_window_sees() {
        let lattice = Lattice {
            order: 4,
            step: DVec2::new(0.037, 0.051),
            nodes: [0; 2],
            oversampling: DVec2::ONE,
            on_cpu: false,
            error: 0.0,
        };
        let frame = Frame::full(640, 480);
        let whole = Nodes::new(&lattice, DVec2::new(5.0, 4.0), frame, frame.window);
        let tile = Window { x: 200, y: 113, width: 77, height: 64 };
        let part = Nodes::new(&lattice, DVec2::new(5.0, 4.0), frame, tile);
        let place = |knots: Knots, index: u64| {
            // In u32, like the shader.
            let fine = (knots.fine >> FINE_BITS) + index as u32 * (knots.fine & 0xffff);
            let place =
                knots.start.wrapping_add((index as u32).wrapping_mul(knots.pitch)).wrapping_add(fine >> FINE_BITS);
            ((place >> KNOT_BITS) as usize, place & ((1 << KNOT_BITS) - 1))
        };
        for (axis, from, count) in [(0, 200, 77), (1, 113, 64)] {
            for index in 0..count {
                let (first, fraction) = place(whole.knots[axis], from + index);
                let (of_part, same_fraction) = place(part.knots[axis], index);
                assert_eq!(fraction, same_fraction);
                for node in 0..4 {
                    assert_eq!(whole.phases(axis)[first + node], part.phases(axis)[of_part + node]);
                }
            }
        }
    }
}
