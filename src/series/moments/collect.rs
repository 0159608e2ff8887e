//! From points to moments.

use std::ops::Range;

use rayon::prelude::*;

use super::{Cells, Point};

/// Points that one task sorts: as many as a core's cache holds, or so many that there are only this many tasks, because
/// each has a list of all cells.
const CHUNK: usize = 1 << 14;
const MOST_CHUNKS: usize = 64;
/// A cell with more points than this is several tasks.
const PIECE: usize = 1 << 14;
/// Points that are added together, and values of a row of moments that are.
pub(super) const LANES: usize = 4;

/// Four values of a row.
pub(super) type Lanes = [f64; LANES];

/// The moments of a cell in which there is a point: for each T_i(u) a row of T_j(v), red, green, blue, padded with zeros
/// to whole lanes.
pub(super) struct Moments {
    pub cell: [u32; 2],
    pub rows: Vec<Lanes>,
}

/// A point within its cell, −1 to 1.
#[derive(Clone, Copy, Default)]
struct Placed {
    offset: [f64; 2],
    weight: [f64; 3],
}

/// A chunk of points, cell by cell.
struct Sorted {
    points: Vec<Placed>,
    /// Where the points of each cell begin, and where those of the last end.
    starts: Vec<u32>,
}

impl Sorted {
    fn of(&self, cell: usize) -> &[Placed] {
        &self.points[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}

/// Some of the points of a cell: those in a range of the chunks.
struct Piece {
    cell: usize,
    chunks: Range<usize>,
}

/// How many lanes a row of moments has.
pub(super) fn row_lanes(cells: &Cells) -> usize {
    (3 * cells.orders[1] as usize).div_ceil(LANES)
}

/// The moments of all cells that have points, row by row of cells.
pub(super) fn collect(cells: &Cells, count: usize, point: impl Fn(usize) -> Point + Sync) -> Vec<Moments> {
    let length = CHUNK.max(count.div_ceil(MOST_CHUNKS));
    let chunks: Vec<Sorted> = (0..count.div_ceil(length))
        .into_par_iter()
        .map(|chunk| sorted(cells, (chunk * length..count.min((chunk + 1) * length)).map(&point)))
        .collect();
    let moments: Vec<Moments> = pieces(cells, &chunks).par_iter().map(|piece| moments(cells, &chunks, piece)).collect();
    let mut joined = Vec::<Moments>::with_capacity(moments.len());
    for one in moments {
        match joined.last_mut().filter(|last| last.cell == one.cell) {
            Some(last) => {
                last.rows.as_flattened_mut().iter_mut().zip(one.rows.as_flattened()).for_each(|(a, b)| *a += b)
            }
            None => joined.push(one),
        }
    }
    joined
}

/// Sorts a chunk by counting.
fn sorted(cells: &Cells, points: impl Iterator<Item = Point>) -> Sorted {
    let placed: Vec<(u32, Placed)> = points.map(|point| place(cells, &point)).collect();
    let mut starts = vec![0; (cells.counts[0] * cells.counts[1]) as usize + 1];
    for &(cell, _) in &placed {
        starts[cell as usize + 1] += 1;
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    let mut next = starts.clone();
    let mut points = vec![Placed::default(); placed.len()];
    for (cell, point) in placed {
        let next = &mut next[cell as usize];
        points[*next as usize] = point;
        *next += 1;
    }
    Sorted { points, starts }
}

/// A point's cell, row by row, and where in it the point lies.
fn place(cells: &Cells, point: &Point) -> (u32, Placed) {
    let [(i, u), (j, v)] = [0, 1].map(|axis| {
        let place = point.turns[axis] * f64::from(cells.counts[axis]);
        let cell = (place as u32).min(cells.counts[axis] - 1);
        (cell, 2.0 * (place - f64::from(cell)) - 1.0)
    });
    (j * cells.counts[0] + i, Placed { offset: [u, v], weight: point.weight })
}

fn pieces(cells: &Cells, chunks: &[Sorted]) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for cell in 0..(cells.counts[0] * cells.counts[1]) as usize {
        let (mut first, mut points) = (0, 0);
        for (index, chunk) in chunks.iter().enumerate() {
            points += chunk.of(cell).len();
            if points >= PIECE {
                pieces.push(Piece { cell, chunks: first..index + 1 });
                (first, points) = (index + 1, 0);
            }
        }
        if points > 0 {
            pieces.push(Piece { cell, chunks: first..chunks.len() });
        }
    }
    pieces
}

fn moments(cells: &Cells, chunks: &[Sorted], piece: &Piece) -> Moments {
    let lanes = row_lanes(cells);
    let mut batch = Batch::new(cells);
    let mut rows = vec![[0.0; LANES]; lanes * cells.orders[0] as usize];
    let mut four = [Placed::default(); LANES];
    let mut filled = 0;
    for &point in chunks[piece.chunks.clone()].iter().flat_map(|chunk| chunk.of(piece.cell)) {
        four[filled] = point;
        filled += 1;
        if filled == LANES {
            batch.add(&four, &mut rows);
            filled = 0;
        }
    }
    if filled > 0 {
        four[filled..].fill(Placed::default());
        batch.add(&four, &mut rows);
    }
    let (cell, width) = (piece.cell as u32, cells.counts[0]);
    Moments { cell: [cell % width, cell / width], rows }
}

/// Room for the polynomials of four points.
struct Batch {
    /// T_i(u), point beside point.
    x: Vec<Lanes>,
    /// T_j(v), point beside point.
    y: Vec<Lanes>,
    /// w T_j(v) as a row of moments has it: of each of its lanes, the four points'.
    row: Vec<[Lanes; LANES]>,
}

impl Batch {
    fn new(cells: &Cells) -> Self {
        let [x, y] = cells.orders.map(|order| vec![[0.0; LANES]; order as usize]);
        Self { x, y, row: vec![[[0.0; LANES]; LANES]; row_lanes(cells)] }
    }

    fn add(&mut self, points: &[Placed; LANES], rows: &mut [Lanes]) {
        chebyshev(points.map(|point| point.offset[0]), &mut self.x);
        chebyshev(points.map(|point| point.offset[1]), &mut self.y);
        for colour in 0..3 {
            for (j, y) in self.y.iter().enumerate() {
                let place = colour * self.y.len() + j;
                let lanes = &mut self.row[place / LANES];
                for k in 0..LANES {
                    lanes[k][place % LANES] = points[k].weight[colour] * y[k];
                }
            }
        }
        for (x, moments) in self.x.iter().zip(rows.chunks_exact_mut(self.row.len())) {
            for (moment, [a, b, c, d]) in moments.iter_mut().zip(&self.row) {
                for lane in 0..LANES {
                    moment[lane] += (x[0] * a[lane] + x[1] * b[lane]) + (x[2] * c[lane] + x[3] * d[lane]);
                }
            }
        }
    }
}

/// T_0, T_1, … at four places, by T_{j+1}(u) = 2u T_j(u) − T_{j−1}(u).
fn chebyshev(u: Lanes, values: &mut [Lanes]) {
    let (mut last, mut value) = (u, [1.0; LANES]);
    for out in values {
        *out = value;
        for k in 0..LANES {
            (last[k], value[k]) = (value[k], 2.0 * u[k] * value[k] - last[k]);
        }
    }
}
