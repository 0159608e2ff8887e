//! What is left out, and what f32 costs, at the worst place of the window.
//!
//! The window is cut into cells, which are small for small ghosts and large for large ones: a ghost counts, in each cell that
//! it reaches, for the most that it can be there. Then each of the finest cells has all that is in the cells around it.

use std::f64::consts::TAU;
use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use super::area::Area;
use super::slopes::{Kind, Slopes};
use crate::frame::Frame;
use crate::plan::direct::{HALF_A_UNIT, PER_OFFSET, PER_WEIGHT, SINE};
use crate::plan::weigh::Weighed;
use crate::plan::{Group, Precision};
use crate::problem::Problem;
use crate::scene::Ghost;
use crate::series::{Bell, Distinct};

/// The sides of a ghost's cells are at most so many of its sizes, or of where it ends: from the finest to the coarsest. They are
/// as fine as so many cells of all ghosts together allow, of a ghost that reaches as far as most do: bounds are the closer. Of
/// more ghosts than so many there are fewer cells in all, since a closer bound of them saves less than it costs.
const OF_SIZE: [f64; 2] = [0.45, 3.0];
const OF_END: [f64; 2] = [0.1, 0.5];
const CELLS: f64 = 2e5;
const CLOSELY: f64 = 1024.0;
const EXTENT: f64 = 15.0;

/// A ghost has at most so many cells, and the window so many for each ghost, but for the fewest and the most of all.
const MOST_OF_ONE: usize = 1024;
const MOST_FOR_EACH: usize = 16;
const MOST: [usize; 2] = [1 << 15, 1 << 18];

/// Far from a ghost all that is left of it, and of all others, together counts for this part of what may be left out.
const FAR: f64 = 0.005;

/// What f64 costs of what f32 does: its functions are off by a little more of its unit.
const DOUBLE: f64 = 5e-9;

/// Ghosts from which on the work is shared, and by how many: so many for any number of cores.
const MANY: usize = 128;
const CHUNKS: usize = 4;

/// The worst over all places.
#[derive(Debug, Clone, Copy)]
pub(super) struct Worst {
    /// What is left out, at most.
    pub cut: f64,
    /// What 32-bit floats cost, at most.
    pub single: f64,
    /// Pixels that the ghosts are computed at, all added up.
    pub reached: f64,
}

impl Worst {
    /// What floats cost, at most, before what 64 bits give is stored in 32.
    pub fn rounding(&self, precision: Precision) -> f64 {
        match precision {
            Precision::Single => self.single,
            // The same roundings, of so much smaller units.
            Precision::Double => DOUBLE * self.single,
        }
    }
}

pub(super) struct Map<'a> {
    problem: &'a Problem,
    weighed: &'a Weighed,
    groups: &'a [Group],
    /// The bells, and which of them each group has.
    bells: Vec<Slopes<'a>>,
    of_group: Vec<usize>,
    pub kept: usize,
    /// What may be left out, at most.
    budget: f64,
}

/// What may meet in a cell.
#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    /// What is left out.
    cut: f64,
    /// What the bells are off by in 32-bit floats.
    off: f64,
    /// The sum of what they are, without a sign, and how many there are.
    sum: f64,
    count: f64,
}

/// Cells of 2^shift pixels along each side.
struct Level {
    shift: u32,
    columns: usize,
    cells: Vec<Cell>,
}

impl<'a> Map<'a> {
    pub fn new(problem: &'a Problem, weighed: &'a Weighed, groups: &'a [Group], budget: f64) -> Self {
        let (mut bells, mut distinct) = (Vec::<Slopes<'_>>::new(), Distinct::by_bounds());
        let of_group = groups.iter().map(|group| {
            let (number, new) = distinct.number(&group.bell);
            if new {
                bells.push(Slopes::new(&group.bell));
            }
            number
        });
        let of_group = of_group.collect();
        let kept = groups.iter().map(|group| group.members.len()).sum();
        Self { problem, weighed, groups, bells, of_group, kept, budget }
    }

    /// The worst where each ghost is left out below a level; or an estimate of it by each `step`-th ghost of a group.
    pub fn worst(&self, level: f64, step: usize) -> Worst {
        let chunk = if self.kept > MANY { self.kept.div_ceil(CHUNKS) } else { self.kept.max(1) };
        let starts: Vec<usize> = (0..self.kept).step_by(chunk).collect();
        let parts: Vec<Part> =
            starts.into_par_iter().map(|start| self.part(start..start + chunk, level, step)).collect();
        let (times, leaves) = (step as f64, parts.iter().any(|part| part.leaves));
        let reached = times * parts.iter().map(|part| part.reached).sum::<f64>();
        let mut worst = Worst { cut: 0.0, single: PER_WEIGHT, reached };
        for cell in finest(parts) {
            worst.cut = worst.cut.max(times * cell.cut);
            let additions = HALF_A_UNIT * (times * cell.count - 1.0).max(0.0) * cell.sum;
            worst.single = worst.single.max(times * (cell.off + additions));
        }
        if leaves {
            worst.cut += self.far(level);
        }
        worst
    }

    /// What all ghosts together may be where none of them counts.
    fn far(&self, level: f64) -> f64 {
        (FAR * self.budget).min(level)
    }

    /// Some of the ghosts, counted group by group, each standing for `step` of them.
    fn part(&self, range: Range<usize>, level: f64, step: usize) -> Part {
        let mut part = Part::new(self.problem.frame(), level, self.far(level), self.kept);
        let mut first = 0;
        for (group, &bell) in self.groups.iter().zip(&self.of_group) {
            let count = group.members.len();
            let within = |place: usize| place.clamp(first, first + count) - first;
            let (start, end) = (within(range.start), within(range.end));
            let start = ((first + start).next_multiple_of(step) - first).min(end);
            for &index in group.members[start..end].iter().step_by(step) {
                let index = index as usize;
                part.add(&self.problem.ghosts()[index], self.weighed.weights[index], &self.bells[bell]);
            }
            first += count;
        }
        part
    }
}

/// All that is in the finest cells, and in the larger ones around them.
fn finest(parts: Vec<Part>) -> Vec<Cell> {
    let mut levels: Vec<Level> = Vec::new();
    for level in parts.into_iter().flat_map(|part| part.levels) {
        match levels.iter_mut().find(|other| other.shift == level.shift) {
            Some(other) => other.cells.iter_mut().zip(&level.cells).for_each(|(cell, more)| cell.add(more)),
            None => levels.push(level),
        }
    }
    levels.sort_by_key(|level| std::cmp::Reverse(level.shift));
    let mut levels = levels.into_iter();
    let Some(mut around) = levels.next() else { return Vec::new() };
    for mut level in levels {
        let shift = around.shift - level.shift;
        for (row, cells) in level.cells.chunks_mut(level.columns).enumerate() {
            let larger = &around.cells[(row >> shift) * around.columns..];
            cells.iter_mut().enumerate().for_each(|(column, cell)| cell.add(&larger[column >> shift]));
        }
        around = level;
    }
    around.cells
}

impl Cell {
    fn add(&mut self, other: &Self) {
        self.cut += other.cut;
        self.off += other.off;
        self.sum += other.sum;
        self.count += other.count;
    }
}

/// Some of the ghosts.
struct Part {
    frame: Frame,
    level: f64,
    /// What a ghost may be where it does not count.
    far: f64,
    /// The sides of a ghost's cells, in sizes, and in where it ends.
    of_size: f64,
    of_end: f64,
    least: u32,
    levels: Vec<Level>,
    reached: f64,
    /// Whether anything is left out of a ghost.
    leaves: bool,
    columns: Vec<Along>,
    rows: Vec<Along>,
}

/// A bell along one axis, in the cells of a column or a row.
#[derive(Debug, Clone, Copy)]
struct Along {
    cell: usize,
    /// The most that it is.
    value: f64,
    /// What that is off by in f32: by rounding, with the exponent; and by the slope, times what the offset is shifted by.
    off: f64,
    steep: f64,
    shift: f64,
    /// Whether some of the pixels, and all of them, are reached.
    some: bool,
    all: bool,
}

impl Part {
    /// Of a level, and of what all ghosts together may be where none of them counts.
    fn new(frame: Frame, level: f64, far: f64, kept: usize) -> Self {
        let far = far / kept as f64;
        let all = CELLS * (CLOSELY / kept as f64).min(1.0).sqrt();
        let along = (all / kept as f64).sqrt();
        let [of_size, of_end] =
            [(EXTENT, OF_SIZE), (2.0, OF_END)].map(|(extent, [least, most])| (extent / along).clamp(least, most));
        let cells = |shift: u32| {
            let along = |side: u32| (u64::from(side) >> shift) + 1;
            along(frame.window.width) * along(frame.window.height)
        };
        let most = kept.saturating_mul(MOST_FOR_EACH).clamp(MOST[0], MOST[1]) as u64;
        let least = (0..32).find(|&shift| cells(shift) <= most).unwrap_or(31);
        let (levels, columns, rows) = (Vec::new(), Vec::new(), Vec::new());
        Self { frame, level, far, of_size, of_end, least, levels, reached: 0.0, leaves: false, columns, rows }
    }

    fn add(&mut self, ghost: &Ghost, weight: f64, slopes: &Slopes<'_>) {
        let (frame, window) = (self.frame, self.frame.window);
        let corner = DVec2::new(f64::from(window.x), f64::from(window.y));
        let sides = [window.width, window.height];
        let bell = Seen {
            slopes,
            center: (frame.pixel(ghost.center) - corner).to_array(),
            size: (ghost.size / frame.pixel_sides()).to_array(),
            beside: beside(ghost),
        };
        let area = Area::new(ghost, self.level / weight, frame);
        let whole = Area::reach(slopes.shape, self.level / weight) >= slopes.ends;
        let pixels = area.pixels(frame);
        self.reached += pixels;
        self.leaves |= !(whole || pixels == window.pixels() as f64);
        let farthest = slopes.shape.reach(self.far / weight);
        let spans = [0, 1].map(|axis| {
            let last = f64::from(sides[axis]) - 1.0;
            let far = farthest * bell.size[axis];
            let origin = [window.x, window.y][axis];
            let [first, end] = [area.first, area.last].map(|place| f64::from(place[axis] - origin));
            let (low, high) = ((bell.center[axis] - far).ceil(), (bell.center[axis] + far).floor());
            let (low, high) = if end > first { (low.min(first), high.max(end - 1.0)) } else { (low, high) };
            // Between two pixels there is none.
            (low <= high && high >= 0.0 && low <= last).then(|| Span {
                low: low.max(0.0) as u32,
                high: high.min(last) as u32,
                reached: [first as i64, end as i64],
                last: sides[axis] - 1,
            })
        });
        let [Some(x), Some(y)] = spans else { return };
        let shift = self.shift(&bell, &x, &y);
        bell.along(0, &x, shift, &mut self.columns);
        bell.along(1, &y, shift, &mut self.rows);
        self.deposit(shift, weight, &bell, whole);
    }

    /// The cells of a bell that has to do with these columns and rows.
    fn shift(&self, bell: &Seen<'_>, x: &Span, y: &Span) -> u32 {
        let ends = bell.slopes.ends;
        let part = if ends.is_finite() { self.of_end * ends } else { self.of_size };
        let finest = part * bell.size[0].min(bell.size[1]);
        let mut shift = self.least.max((finest.max(1.0).log2() as u32).min(31));
        let count = |span: &Span, shift: u32| (span.high >> shift) as usize - (span.low >> shift) as usize + 1;
        while shift < 31 && count(x, shift) * count(y, shift) > MOST_OF_ONE {
            shift += 1;
        }
        shift
    }

    /// Adds a bell to the cells of its columns and rows, which is cut off nowhere where it is `whole`.
    fn deposit(&mut self, shift: u32, weight: f64, bell: &Seen<'_>, whole: bool) {
        let sides = [self.frame.window.width, self.frame.window.height];
        let index = self.levels.iter().position(|level| level.shift == shift).unwrap_or_else(|| {
            let [columns, rows] = sides.map(|side| ((side - 1) >> shift) as usize + 1);
            self.levels.push(Level { shift, columns, cells: vec![Cell::default(); columns * rows] });
            self.levels.len() - 1
        });
        let level = &mut self.levels[index];
        // What f32 flushes to nothing.
        let lost = weight * f64::from(f32::MIN_POSITIVE);
        let (radial, jump) = (bell.slopes.kind == Kind::Radial, bell.slopes.jump);
        // Those that are reached follow each other.
        let begin = self.columns.iter().position(|x| x.some).unwrap_or(self.columns.len());
        let reached = self.columns[begin..].iter().take_while(|x| x.some).count();
        let first = self.columns[0].cell;
        for y in self.rows.iter().filter(|y| y.value > 0.0) {
            let from = y.cell * level.columns + first;
            let cells = &mut level.cells[from..from + self.columns.len()];
            if !whole {
                for (cell, x) in cells.iter_mut().zip(&self.columns) {
                    let cut = self.level.min(weight * x.value * y.value);
                    cell.cut += if x.all && y.all { 0.0 } else { cut };
                }
            }
            if !y.some {
                continue;
            }
            for (cell, x) in cells[begin..].iter_mut().zip(&self.columns[begin..begin + reached]) {
                let value = x.value * y.value;
                let (slope, most) = if radial {
                    (x.steep.min(y.steep) * (x.shift + y.shift) + jump, 2.0)
                } else {
                    (x.steep * x.shift * y.value + y.steep * y.shift * x.value, 1.0)
                };
                cell.off += weight * (x.off * y.value + y.off * x.value + slope.min(most * value)) + lost;
                cell.sum += weight * value;
                cell.count += 1.0;
            }
        }
    }
}

/// Pixels of the window along an axis, to the last of them; which are reached, and the window's own last.
struct Span {
    low: u32,
    high: u32,
    reached: [i64; 2],
    last: u32,
}

/// What a sine-Gaussian is shifted by beside its offset, in sizes.
fn beside(ghost: &Ghost) -> [f64; 2] {
    match &ghost.bell {
        Bell::SineGaussian(bell) => (SINE / TAU * bell.period / ghost.size).to_array(),
        _ => [0.0; 2],
    }
}

/// A bell in pixels of the window.
struct Seen<'a> {
    slopes: &'a Slopes<'a>,
    center: [f64; 2],
    size: [f64; 2],
    beside: [f64; 2],
}

impl Seen<'_> {
    /// The bell in each cell along an axis.
    fn along(&self, axis: usize, span: &Span, shift: u32, cells: &mut Vec<Along>) {
        let (center, per_pixel) = (self.center[axis], 1.0 / self.size[axis]);
        let nearest = center.round();
        let away = |low: f64, high: f64| (nearest.clamp(low, high) - center).abs() * per_pixel;
        let anchor = away(0.0, f64::from(span.last));
        let [begin, end] = span.reached;
        let of_offset = match self.slopes.kind {
            Kind::Exponential => 0.0,
            Kind::Periodic => 2.0 * PER_OFFSET,
            Kind::Product | Kind::Radial => self.slopes.per_offset,
        };
        let exponential = if self.slopes.kind == Kind::Exponential { 0.5 } else { 0.0 };
        cells.clear();
        for cell in span.low >> shift..=span.high >> shift {
            let first = cell << shift;
            let last = (u64::from(cell + 1) << shift).min(u64::from(span.last) + 1) as u32 - 1;
            let [low, high] = [first, last].map(f64::from);
            let near = away(low, high);
            let (some, all) = (
                i64::from(last) >= begin && i64::from(first) < end,
                i64::from(first) >= begin && i64::from(last) < end,
            );
            let mut here = Along { cell: cell as usize, value: 0.0, off: 0.0, steep: 0.0, shift: 0.0, some, all };
            if some {
                let (low, high) = (low.max(begin as f64), high.min(end as f64 - 1.0));
                let far = ((low - center).abs().max((high - center).abs()) * per_pixel).min(self.slopes.ends);
                here.shift = PER_OFFSET * anchor + of_offset * far + self.beside[axis];
                // f32 may see a bell that has ended.
                [here.value, here.steep] = self.slopes.at((near - here.shift).max(0.0));
                here.off = PER_WEIGHT * here.value * (0.5 + exponential * near * near);
            } else {
                [here.value, _] = self.slopes.at(near);
            }
            cells.push(here);
        }
    }
}
