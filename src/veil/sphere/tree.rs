//! Any field: tiles of pixels that send to each other by interpolation, and those that are too near, pixel by pixel.
//!
//! Between two tiles that are far apart for their size the kernel is smooth, and is interpolated between a few Chebyshev points of the
//! pixels' coordinates in each. The light of a tile is taken to its points by the transpose of that, and tiles of tiles likewise. So
//! nothing is asked of the geometry or of the kernel; it costs several times what lattices do.

use rayon::prelude::*;

use super::block::{ALL, POINTS, Tile, looked_at, square};
use super::camera::{Camera, angle};
use super::choose::Task;
use super::measure::{TARGETS, target};
use crate::veil::photo::Sources;
use crate::veil::simd::Plane;

/// Columns and rows of the smallest tiles.
const LEAF: usize = 8;

/// Radii of two tiles over their distance, up to which they are far apart: those that are tried.
const APART: [f64; 6] = [0.7, 0.5, 0.36, 0.25, 0.18, 0.12];

/// By how much the error within two tiles can be above that at their corners and middles, where it is looked at: 1.3 was seen.
const WITHIN: f64 = 1.5;

/// How much of that distance counts that a tile is from what is opposite another.
const FROM_OPPOSITE: f64 = 1.5;

/// Steps of an octave of the squared chord by which the kernel is tabled.
const STEPS: usize = 2048;

/// The table's first squared chord, 2^`FIRST`, and its octaves, up to 4.
const FIRST: i32 = -48;
const OCTAVES: usize = 51;

/// Roundings: the table's, times what interpolation may add up on both sides.
pub(in crate::veil) const ROUNDING: f64 = 2e-6;

/// Kernel values for a pixel that are too many.
const MOST: f64 = 60_000.0;

/// A veil summed over tiles.
#[derive(Clone)]
pub(in crate::veil) struct Tree {
    camera: Camera,
    /// From the smallest tiles on.
    levels: Vec<Vec<Tile>>,
    /// Tiles in a row and in a column, by levels.
    counts: Vec<[usize; 2]>,
    /// By levels and tiles: directions of the points.
    points: Vec<Vec<[[f64; 3]; ALL]>>,
    table: Vec<[f32; 2]>,
    apart: f64,
    pub bound: f64,
    pub operations: f64,
}

impl std::fmt::Debug for Tree {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Tree").field("camera", &self.camera).field("bound", &self.bound).finish_non_exhaustive()
    }
}

/// What tiles send to one: those that are far, by level and number, and the smallest that are near.
#[derive(Default)]
struct Senders {
    far: Vec<[usize; 2]>,
    near: Vec<usize>,
}

/// By levels and tiles: three channels at each point.
type Moments = Vec<Vec<[[f64; 3]; ALL]>>;

impl Tree {
    /// Tiles for a task, if they can be had to its tolerance and at a cost that can be borne.
    pub fn new(task: &Task) -> Option<Self> {
        let camera = task.camera;
        let (mut levels, mut counts, mut size) = (Vec::new(), Vec::new(), LEAF);
        loop {
            let count = camera.size.map(|side| side.div_ceil(size));
            let tile = |index: usize| Tile::new(&camera, [index % count[0] * size, index / count[0] * size], size);
            levels.push((0..count[0] * count[1]).into_par_iter().map(tile).collect::<Vec<Tile>>());
            counts.push(count);
            if count == [1, 1] {
                break;
            }
            size *= 2;
        }
        let of_tile = |tile: &Tile| -> [[f64; 3]; ALL] {
            std::array::from_fn(|index| {
                camera.point(tile.place(0, index % POINTS), tile.place(1, index / POINTS)).direction
            })
        };
        let points = levels.iter().map(|tiles| tiles.par_iter().map(of_tile).collect()).collect();
        let (table, off) = table(task);
        let mut tree = Self { camera, levels, counts, points, table, apart: 0.0, bound: 0.0, operations: 0.0 };
        for apart in APART {
            tree.apart = apart;
            let (error, operations) = tree.error(task);
            tree.bound = WITHIN * error + off + ROUNDING;
            tree.operations = operations;
            if operations > MOST {
                return None;
            }
            if tree.bound < task.tolerance {
                return Some(tree);
            }
        }
        None
    }

    /// The table at a squared chord.
    #[inline(always)]
    fn kernel(&self, square: f64) -> f64 {
        const BASE: u32 = ((127 + FIRST) as u32) << 23;
        const SHIFT: u32 = 23 - STEPS.ilog2();
        let bits = (square as f32).to_bits().saturating_sub(BASE);
        let index = (bits >> SHIFT) as usize;
        let [value, slope] = self.table[index.min(OCTAVES * STEPS - 1)];
        f64::from(value + slope * (bits & ((1 << SHIFT) - 1)) as f32)
    }

    /// Which tiles send to a small one.
    fn senders(&self, leaf: usize) -> Senders {
        let here = &self.levels[0][leaf];
        let mut senders = Senders::default();
        let mut open = vec![[self.levels.len() - 1, 0]];
        while let Some([level, index]) = open.pop() {
            let there = &self.levels[level][index];
            let square = square(here.middle, there.middle);
            // Opposite a tile the angle has a kink: it falls again beyond 180 degrees.
            let apart = square.sqrt().min(FROM_OPPOSITE * (4.0 - square).max(0.0).sqrt());
            if here.radius + there.radius <= self.apart * apart {
                senders.far.push([level, index]);
            } else if level == 0 {
                senders.near.push(index);
            } else {
                let (count, below) = (self.counts[level][0], self.counts[level - 1]);
                let [x, y] = [2 * (index % count), 2 * (index / count)];
                for [x, y] in [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]] {
                    if x < below[0] && y < below[1] {
                        open.push([level - 1, y * below[0] + x]);
                    }
                }
            }
        }
        senders
    }

    /// The largest relative error between far tiles, at the corners and in the middle of both, for some targets; and kernel values for a pixel.
    fn error(&self, task: &Task) -> (f64, f64) {
        let leaf = |share: &[f64; 2]| {
            let at = target(&self.camera, *share).map(|at| at / LEAF);
            at[1] * self.counts[0][0] + at[0]
        };
        let around = |share: &[f64; 2]| {
            let leaf = leaf(share);
            let senders = self.senders(leaf);
            let here = &self.levels[0][leaf];
            let mut worst = 0.0f64;
            for [level, index] in &senders.far {
                let there = &self.levels[*level][*index];
                let points = &self.points[*level][*index];
                for target in looked_at(here) {
                    let into = here.shares(target[0], target[1]);
                    let mut sums = [0.0; ALL];
                    for (here, into) in self.points[0][leaf].iter().zip(into) {
                        for (sum, there) in sums.iter_mut().zip(points) {
                            *sum += into * (task.profile)(angle(square(*here, *there).sqrt()));
                        }
                    }
                    let at = self.camera.point(target[0], target[1]);
                    for source in looked_at(there) {
                        let from = there.shares(source[0], source[1]);
                        let found: f64 = from.iter().zip(&sums).map(|(from, sum)| from * sum).sum();
                        let wanted = (task.profile)(angle(at.chord(&self.camera.point(source[0], source[1]))));
                        let error = (found / wanted - 1.0).abs();
                        worst = if error.is_nan() { f64::INFINITY } else { worst.max(error) };
                    }
                }
            }
            let pixels = (LEAF * LEAF) as f64;
            (worst, senders.near.len() as f64 * pixels + senders.far.len() as f64 * (ALL * ALL) as f64 / pixels)
        };
        let all: Vec<(f64, f64)> = TARGETS.par_iter().map(around).collect();
        let worst = all.iter().map(|(worst, _)| *worst).fold(0.0, f64::max);
        (worst, all.iter().map(|(_, operations)| operations).sum::<f64>() / all.len() as f64)
    }

    /// The veil of three channels, in the scale of each.
    pub fn sum(&self, sources: &[Sources; 3]) -> [Plane<f32>; 3] {
        let [width, height] = self.camera.size;
        let lights = sources.each_ref().map(|sources| &sources.plane);
        let moments = self.moments(lights);
        let dark = |level: usize, index: usize| moments[level][index] == [[0.0; 3]; ALL];
        let count = self.counts[0][0];
        let mut veils = lights.map(|_| Plane::new(width, height));
        let stride = veils[0].stride();
        let [red, green, blue] = &mut veils;
        let bands = red.par_groups_mut(LEAF).zip(green.par_groups_mut(LEAF)).zip(blue.par_groups_mut(LEAF));
        bands.enumerate().for_each(|(band, ((red, green), blue))| {
            let mut out = [red, green, blue];
            for leaf in band * count..(band + 1) * count {
                let senders = self.senders(leaf);
                let mut at_points = [[0.0; 3]; ALL];
                for [level, index] in senders.far {
                    if !dark(level, index) {
                        self.far(leaf, &self.points[level][index], &moments[level][index], &mut at_points);
                    }
                }
                let mut near = Near::default();
                senders
                    .near
                    .into_iter()
                    .filter(|index| !dark(0, *index))
                    .for_each(|index| self.take(index, lights, &mut near));
                let tile = &self.levels[0][leaf];
                for y in tile.first[1]..tile.end[1] {
                    for x in tile.first[0]..tile.end[0] {
                        let direction = self.camera.point(x as f64, y as f64).direction;
                        let mut sum = self.near(&near, direction, (y * width + x) as u32);
                        for (share, point) in tile.shares(x as f64, y as f64).into_iter().zip(&at_points) {
                            sum.iter_mut().zip(point).for_each(|(sum, point)| *sum += share * point);
                        }
                        for (out, sum) in out.iter_mut().zip(sum) {
                            out[(y - tile.first[1]) * stride + x] = sum.max(0.0) as f32;
                        }
                    }
                }
            }
        });
        veils
    }

    /// The light of all tiles at their points, from the smallest up.
    fn moments(&self, lights: [&Plane<f32>; 3]) -> Moments {
        let of_leaf = |tile: &Tile| {
            let mut moments = [[0.0; 3]; ALL];
            for y in tile.first[1]..tile.end[1] {
                for x in tile.first[0]..tile.end[0] {
                    let light = lights.map(|light| light.row(y)[x]);
                    if light != [0.0; 3] {
                        let solid_angle = self.camera.point(x as f64, y as f64).solid_angle;
                        let light = light.map(|light| solid_angle * f64::from(light));
                        add(&mut moments, &tile.shares(x as f64, y as f64), light);
                    }
                }
            }
            moments
        };
        let mut all: Moments = vec![self.levels[0].par_iter().map(of_leaf).collect()];
        for level in 1..self.levels.len() {
            let (count, below) = (self.counts[level][0], self.counts[level - 1]);
            let of_tile = |(index, tile): (usize, &Tile)| {
                let mut moments = [[0.0; 3]; ALL];
                let [x, y] = [2 * (index % count), 2 * (index / count)];
                for [x, y] in [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]] {
                    if x >= below[0] || y >= below[1] {
                        continue;
                    }
                    let child = y * below[0] + x;
                    let small = &self.levels[level - 1][child];
                    for (point, light) in all[level - 1][child].iter().enumerate() {
                        if *light != [0.0; 3] {
                            let at = [small.place(0, point % POINTS), small.place(1, point / POINTS)];
                            add(&mut moments, &tile.shares(at[0], at[1]), *light);
                        }
                    }
                }
                moments
            };
            let next = self.levels[level].par_iter().enumerate().map(of_tile).collect();
            all.push(next);
        }
        all
    }

    /// Adds what a far tile sends to a small one's points.
    fn far(&self, leaf: usize, points: &[[f64; 3]; ALL], moments: &[[f64; 3]; ALL], sums: &mut [[f64; 3]; ALL]) {
        for (here, sum) in self.points[0][leaf].iter().zip(sums) {
            for (there, light) in points.iter().zip(moments) {
                let value = self.kernel(square(*here, *there));
                sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += value * light);
            }
        }
    }

    /// Adds the pixels of a small tile to the near ones.
    fn take(&self, leaf: usize, lights: [&Plane<f32>; 3], near: &mut Near) {
        let tile = &self.levels[0][leaf];
        for y in tile.first[1]..tile.end[1] {
            for x in tile.first[0]..tile.end[0] {
                let light = lights.map(|light| light.row(y)[x]);
                if light != [0.0; 3] {
                    let point = self.camera.point(x as f64, y as f64);
                    near.directions.push(point.direction);
                    near.lights.push(light.map(|light| point.solid_angle * f64::from(light)));
                    near.pixels.push((y * self.camera.size[0] + x) as u32);
                }
            }
        }
    }

    /// What near pixels send.
    fn near(&self, near: &Near, direction: [f64; 3], own: u32) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for ((there, light), pixel) in near.directions.iter().zip(&near.lights).zip(&near.pixels) {
            let value = if *pixel == own { 0.0 } else { self.kernel(square(direction, *there)) };
            sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += value * light);
        }
        sum
    }
}

/// Pixels that send one by one.
#[derive(Default)]
struct Near {
    directions: Vec<[f64; 3]>,
    lights: Vec<[f64; 3]>,
    pixels: Vec<u32>,
}

fn add(moments: &mut [[f64; 3]; ALL], shares: &[f64; ALL], light: [f64; 3]) {
    for (moments, share) in moments.iter_mut().zip(shares) {
        moments.iter_mut().zip(light).for_each(|(moment, light)| *moment += share * light);
    }
}

/// The kernel by the squared chord, each value with what is to be added for each bit after it; and the largest relative error halfway.
fn table(task: &Task) -> (Vec<[f32; 2]>, f64) {
    let at = |square: f64| (task.profile)(angle(square.sqrt()));
    // Steps are even within an octave.
    let place = |index: usize, share: f64| {
        let octave = (index / STEPS) as i32 + FIRST;
        2f64.powi(octave) * (1.0 + ((index % STEPS) as f64 + share) / STEPS as f64)
    };
    let count = OCTAVES * STEPS;
    let bits = f64::from(1u32 << (23 - STEPS.ilog2()));
    let least = 0.05 * nearest(&task.camera).powi(2);
    let values: Vec<f64> = (0..=count).into_par_iter().map(|index| at(place(index, 0.0).min(4.0))).collect();
    let table = values.windows(2).map(|pair| [pair[0] as f32, ((pair[1] - pair[0]) / bits) as f32]).collect();
    let halfway = |index: usize| {
        let (square, middle) = (place(index, 0.5), 0.5 * (values[index] + values[index + 1]));
        if square < least || square > 4.0 { 0.0 } else { (middle / at(square) - 1.0).abs() }
    };
    let off = (0..count).into_par_iter().map(halfway).reduce(|| 0.0, f64::max);
    // A bend may lie elsewhere than halfway.
    (table, 2.0 * off)
}

/// The shortest chord between two pixels.
fn nearest(camera: &Camera) -> f64 {
    let corner = camera.corner();
    [camera.point(1.0, 0.0), camera.point(0.0, 1.0), camera.point(1.0, 1.0)]
        .iter()
        .map(|other| corner.chord(other))
        .filter(|chord| *chord > 0.0)
        .fold(1.0, f64::min)
}
