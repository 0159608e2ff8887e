//! The ghosts of a local layer, as its pass takes them.

use glam::{DVec2, IVec2};
use rayon::prelude::*;

use super::convert::{self, double_ghost, weight};
use crate::Result;
use crate::frame::Frame;
use crate::gpu::layout::{DoubleGhost, LocalGhost};
use crate::gpu::local::{Drawn, Kind, Listed, LocalPass, list_step};
use crate::gpu::runner::Runner;
use crate::plan::{self, Area, Local, Plan, Precision};
use crate::scene::Ghost;
use crate::series::{Bell, Distinct};

const _: () = assert!(plan::LARGEST_POINT as i32 == crate::gpu::layout::LARGEST_POINT);
const _: () = assert!(plan::GHOSTS_A_ROUND == crate::gpu::evaluators::STEP);

/// A ghost with what is known of it.
struct Placed<'a> {
    ghost: &'a Ghost,
    weight: [f64; 3],
    area: Area,
    /// Where its bell's parameters begin.
    bell: u32,
}

impl Placed<'_> {
    fn kind(&self) -> u32 {
        self.ghost.bell.kind()
    }
}

/// Uploads the ghosts of a plan's local layer for a frame.
///
/// # Errors
/// [`crate::Error::Gl`] where the driver refuses.
pub(super) fn upload(plan: &Plan, local: &Local, frame: Frame, pass: &mut LocalPass, runner: &Runner) -> Result<()> {
    let as_drawn = local.precision == Precision::Single && pass.can_draw();
    let shapes = Shapes::of(plan, local, as_drawn);
    let mut placed = Vec::new();
    for (group, &begin) in local.groups.iter().zip(&shapes.begins) {
        let one = |(place, &index): (usize, &u32)| {
            let ghost = &plan.problem().ghosts()[index as usize];
            let weight = weight(ghost, plan);
            let largest = weight.iter().fold(0.0f64, |largest, weight| largest.max(weight.abs()));
            let bell = begin + if shapes.each(&group.bell) { place as u32 } else { 0 };
            Placed { ghost, weight, area: local.area(ghost, largest, frame), bell }
        };
        let members = group.members.par_iter().enumerate().map(one);
        placed.par_extend(members.filter(|placed| placed.area.first != placed.area.last));
    }
    if as_drawn {
        let mut kinds: Vec<Kind> = Vec::new();
        // Stable: the order in which ghosts are added up is that of the scene but for this.
        placed.sort_by_key(|placed| (placed.kind(), !placed.area.point));
        for ghosts in placed.chunk_by(|a, b| a.kind() == b.kind()) {
            let first = kinds.last().map_or(0, |kind| kind.quads.end);
            let points = first + ghosts.iter().take_while(|placed| placed.area.point).count();
            let bell = ghosts[0].ghost.bell.shape().shader();
            kinds.push(Kind { bell, points: first..points, quads: points..first + ghosts.len() });
        }
        let ghosts: Vec<_> = placed.par_iter().map(|placed| drawn(placed, frame)).collect();
        let single: Vec<[f32; 4]> = shapes.rows.iter().map(|row| row.map(|x| x as f32)).collect();
        return pass.set_drawn(&Drawn { ghosts: &ghosts, kinds: &kinds }, &single);
    }
    let kinds = if convert::bells(&local.groups).are_several() { Bell::KINDS } else { 1 };
    let lists = Lists::new(&placed, kinds, frame, plan::block_shift(local.side()));
    let mut ghosts: Vec<_> =
        placed.par_iter().map(|placed| double_ghost(placed.ghost, placed.weight, placed.bell)).collect();
    ghosts.push(DoubleGhost::NONE);
    pass.set_listed(runner, &lists.of(&ghosts), &shapes.rows)
}

/// The parameters of the bells of a layer.
struct Shapes {
    /// Where those of each group begin.
    begins: Vec<u32>,
    /// Where they are drawn, for offsets in sizes: then a periodic bell has a row for each ghost.
    rows: Vec<[f64; 4]>,
    drawn: bool,
}

impl Shapes {
    fn of(plan: &Plan, local: &Local, drawn: bool) -> Self {
        let mut shapes = Self { begins: Vec::new(), rows: Vec::new(), drawn };
        let (mut distinct, mut begins) = (Distinct::new(), Vec::new());
        for group in &local.groups {
            let parameters = group.bell.shape().parameters();
            if shapes.each(&group.bell) {
                shapes.begins.push(shapes.rows.len() as u32);
                let rows = group.members.iter().flat_map(|&index| {
                    let size = plan.problem().ghosts()[index as usize].size;
                    parameters.iter().map(move |&[x, y, z, w]| [x * size.x, y * size.y, z, w])
                });
                shapes.rows.extend(rows);
                continue;
            }
            let rows = &mut shapes.rows;
            let (number, new) = distinct.number(&group.bell);
            if new {
                begins.push(rows.len() as u32);
                rows.extend(parameters);
            }
            shapes.begins.push(begins[number]);
        }
        shapes
    }

    /// Whether each ghost has parameters of its own.
    fn each(&self, bell: &Bell) -> bool {
        self.drawn && bell.shape().period().is_some()
    }
}

/// A ghost as it is drawn. Its offsets are counted from the pixel of the window that is nearest to its centre.
fn drawn(placed: &Placed<'_>, frame: Frame) -> LocalGhost {
    // Beyond this a bell is nothing, and its square is still a number.
    const FARTHEST: f64 = 1e18;
    let (Placed { ghost, weight, area, bell }, window) = (placed, frame.window);
    let low = IVec2::new(window.x, window.y);
    let high = low + IVec2::new(window.width as i32 - 1, window.height as i32 - 1);
    let center = frame.pixel(ghost.center);
    let anchor = center.round().clamp(low.as_dvec2(), high.as_dvec2());
    let step = (frame.pixel_sides() / ghost.size).min(DVec2::splat(FARTHEST));
    let away =
        ((anchor - center) * frame.pixel_sides() / ghost.size).clamp(DVec2::splat(-FARTHEST), DVec2::splat(FARTHEST));
    LocalGhost {
        area: [area.first[0], area.first[1], area.last[0], area.last[1]],
        anchor: anchor.as_ivec2().to_array(),
        // Rows are counted downwards.
        offset: [away.x as f32, -away.y as f32],
        step: [step.x as f32, -step.y as f32],
        weight: weight.map(|weight| weight as f32),
        bell: *bell,
    }
}

/// The ghosts that reach each block of pixels.
struct Lists {
    /// As [`Listed`] has them.
    numbers: Vec<u32>,
    kinds: u32,
    blocks: [u32; 2],
    shift: u32,
    longest: usize,
}

impl Lists {
    /// A list for each of so many kinds of bells: all of them, or the one that all ghosts have.
    fn new(placed: &[Placed<'_>], kinds: u32, frame: Frame, shift: u32) -> Self {
        let window = frame.window;
        let blocks = [window.width, window.height].map(|side| side.div_ceil(1 << shift));
        let count = (blocks[0] * blocks[1]) as usize;
        let of = |placed: &Placed<'_>| {
            let span = |axis: usize, origin: i32| {
                let side = [window.width, window.height][axis] as i32;
                let [first, last] = [placed.area.first[axis], placed.area.last[axis] - 1]
                    .map(|place| (place - origin).clamp(0, side - 1) as u32);
                first >> shift..=last >> shift
            };
            let (columns, rows) = (span(0, window.x), span(1, window.y));
            let kind = if kinds == 1 { 0 } else { placed.kind() as usize * count };
            rows.flat_map(move |row| columns.clone().map(move |column| kind + (row * blocks[0] + column) as usize))
        };
        let mut lengths = vec![0usize; kinds as usize * count];
        placed.iter().for_each(|placed| of(placed).for_each(|list| lengths[list] += 1));
        let in_block = |block: usize| lengths.iter().skip(block).step_by(count).sum();
        let longest = (0..count).map(in_block).max().unwrap_or(0);
        let step = list_step(longest);
        let mut starts = Vec::with_capacity(lengths.len() + 1);
        let mut end = lengths.len() + 1;
        for length in &lengths {
            starts.push(end as u32);
            end += length.next_multiple_of(step);
        }
        starts.push(end as u32);
        // What fills a list up is the ghost that is none.
        let mut numbers = vec![placed.len() as u32; end];
        let mut next: Vec<usize> = starts.iter().map(|&start| start as usize).collect();
        numbers[..starts.len()].copy_from_slice(&starts);
        for (index, placed) in placed.iter().enumerate() {
            for list in of(placed) {
                numbers[next[list]] = index as u32;
                next[list] += 1;
            }
        }
        Self { numbers, kinds, blocks, shift, longest }
    }

    fn of<'a>(&'a self, ghosts: &'a [DoubleGhost]) -> Listed<'a> {
        let &Self { ref numbers, kinds, blocks, shift, longest } = self;
        Listed { ghosts, lists: numbers, kinds, blocks, shift, longest }
    }
}
