//! How strong each mode of the whole field is, with the phases that the ghosts' places give them.
//!
//! A bound by weights alone adds up all ghosts as if they stood at one place. Ghosts that are scattered hardly add up:
//! where it is cheap, the plan looks.

use std::ops::Range;
use std::time::Instant;

use glam::DVec2;
use rayon::prelude::*;

use super::bands::Folded;
use super::modes::{Mode, Modes};
use super::rounding::Strength;
use super::sums::{Axis, Sums, mode, through, times};
use super::weigh::weight;
use super::{CostModel, Group, Transform, gather, images};
use crate::problem::{Images, Problem};
use crate::scene::Ghost;
use crate::series::{Factor, Modes as Bells, kappa};

/// Ghosts times modes that are looked at, whatever else they would take: some ten milliseconds.
const EFFORT: usize = 8_000_000;
/// Ghosts that one task goes through. Tasks are joined in their order, whatever the number of cores.
const CHUNK: usize = 128;
/// Modes that all tasks have between them, of 96 bytes each: there are fewer tasks where there are many modes.
const ROOM: usize = 1 << 20;
const FEWEST_TASKS: usize = 4;
/// Nanoseconds of [`work`], at most.
const MOST_WORK: f64 = 3e8;
/// More modes than this are not kept track of: a series of so many takes seconds at any size of picture, where a device sums it.
const MOST_MODES: usize = 1 << 18;
/// And where the CPU is sooner done with them, of which each takes some hundred bytes a task.
const MOST_SOONER: usize = 1 << 19;
/// And where a photo's images have no other way.
const MOST_OF_IMAGES: usize = 1 << 20;

/// Whether so many ghosts could be looked at in a series of a few modes; a photo's images are not left to a device.
pub(super) fn worth_a_try(groups: &[Group]) -> bool {
    const FEW: usize = 16;
    FEW * members(groups) <= EFFORT || groups.iter().any(|group| matches!(group.transform, Transform::Photo(_)))
}

/// Whether to look at so many modes: where the plan needs to know them for any series at all, at more of them; and where the device would
/// take as long for them as the CPU does, by what is known of it.
pub(super) fn worth_looking(groups: &[Group], counts: &[u32], period: DVec2, needed: bool, model: &CostModel) -> bool {
    let modes: usize = counts.iter().map(|&count| count as usize).sum();
    let apart = groups.iter().filter(|group| !matches!(group.transform, Transform::Gather(_) | Transform::Photo(_)));
    let few = modes.saturating_mul(apart.clone().map(|group| group.members.len()).sum()) <= EFFORT;
    // A photo's images have no other way.
    let only = groups.iter().any(|group| matches!(group.transform, Transform::Photo(_)));
    let work = work(groups, counts, period);
    let sooner = work <= apart.map(|group| gather::cost(group, &Transform::Dispatch, model)).sum::<f64>();
    let most = match (only, sooner) {
        (true, _) => MOST_OF_IMAGES,
        (_, true) => MOST_SOONER,
        _ => MOST_MODES,
    };
    modes <= most && (only || (few || needed || sooner) && work <= MOST_WORK)
}

/// What a ghost takes for each mode, about, in nanoseconds.
pub(super) const MODE: f64 = 3.0;

/// What looking at so many modes costs about, in nanoseconds.
pub(super) fn work(groups: &[Group], counts: &[u32], period: DVec2) -> f64 {
    // Of each mode: what it adds, and what of it is kept.
    const ALONE: f64 = 60.0;
    let one = |group: &Group| {
        if let Transform::Gather(_) | Transform::Photo(_) = group.transform {
            return gather::cost(group, &group.transform, &CostModel { pass: 0.0, ..CostModel::default() });
        }
        let [n, m] = group.degree;
        let (modes, ghosts) =
            (group.counts(counts).into_iter().map(f64::from).sum::<f64>(), group.members.len() as f64);
        let size = group.smallest / period;
        let bell = group.bell.shape();
        let tables = match bell.modes() {
            Bells::Radial(_) | Bells::Plane(_) => bell.modes().work() * modes,
            // All ghosts of it have one size.
            Bells::Product(factor) if bell.tabulated() => {
                factor.work(f64::from(n), size.x) + factor.work(f64::from(m), size.y)
            }
            Bells::Product(_) | Bells::None => 0.0,
        };
        MODE * modes * ghosts + tables
    };
    let modes: f64 = counts.iter().map(|&count| f64::from(count)).sum();
    ALONE * modes + groups.iter().map(one).sum::<f64>()
}

fn members(groups: &[Group]) -> usize {
    groups.iter().map(|group| group.members.len()).sum()
}

/// Red, green, blue; or their bounds.
pub(super) type Rgb = [f64; 3];

/// Every mode of the field, and an upper bound of what it adds at any point, relative to the field's largest value.
pub(super) struct Amplitudes {
    modes: Modes,
    /// Harmonic by harmonic of x.
    values: Vec<Rgb>,
    /// Of each mode and all that lie beyond it in its row: the sum, and the largest.
    rest: Vec<Rgb>,
    largest: Vec<f64>,
}

impl Amplitudes {
    /// Of these modes.
    ///
    /// With the complex coefficients u_n and v_m of a ghost's factors about its centre (φ, ψ), the phases of which are
    /// in turns, mode (n, m) of the field is
    ///
    /// ```text
    /// κ/2 Re(Z₊ e^{i(nωx + mωy)} + Z₋ e^{i(nωx − mωy)})    Z± = Σ_k w_k u_n e^{−2πinφ} (v_m e^{−2πimψ})^(*)
    /// ```
    ///
    /// and at most κ/2 (|Z₊| + |Z₋|). For a radial bell the transform stands in the place of u_n v_m.
    pub fn new(problem: &Problem, groups: &[Group], counts: &[u32], period: DVec2, scale: Rgb) -> Self {
        Self::beside(problem, groups, counts, period, scale, &[])
    }

    /// The same with what was folded into their period, of no more harmonics than they have.
    pub fn beside(
        problem: &Problem,
        groups: &[Group],
        counts: &[u32],
        period: DVec2,
        scale: Rgb,
        folded: &[Folded],
    ) -> Self {
        let started = Instant::now();
        let mut sums = View::new(problem, counts, period, scale).sums(groups);
        folded.iter().for_each(|folded| sums.add_folded(counts, folded));
        let kappas: Vec<f64> = (0..).zip(counts).flat_map(|(n, &count)| (0..count).map(move |m| kappa(n, m))).collect();
        let (terms, values): (Vec<Mode>, Vec<Rgb>) =
            sums.0.par_iter().zip(kappas).map(|(sums, kappa)| mode(sums, kappa)).unzip();
        let milliseconds = started.elapsed().as_secs_f64() * 1e3;
        let (rest, largest) = beyond(&values, counts);
        Self { modes: Modes::new(counts.to_vec(), terms, milliseconds), values, rest, largest }
    }

    /// The modes themselves.
    pub fn modes(&self) -> &Modes {
        &self.modes
    }

    /// What f32 has to do with modes that have these marginals.
    pub fn strength([x, y]: &[Vec<Rgb>; 2]) -> Strength {
        let square = |rgb: Rgb| rgb.map(|value| value * value);
        let squares = |held: &[Rgb]| held.iter().fold([0.0; 3], |sum, &value| add(sum, square(value)));
        let turning = |held: &[Rgb]| {
            (0u32..).zip(held).fold([0.0; 3], |sum, (n, &value)| add(sum, value.map(|value| f64::from(n) * value)))
        };
        Strength {
            total: x.iter().fold([0.0; 3], |sum, &value| add(sum, value)),
            across: [squares(x), squares(y)].map(|squares| squares.map(f64::sqrt)),
            turning: add(turning(x), turning(y)),
        }
    }

    /// The strongest modes, so few that what is left out stays within the budget, for each harmonic of x how many of y;
    /// and what is left out.
    pub fn kept(&self, budget: f64) -> (Vec<u32>, f64) {
        let strongest =
            self.rows().filter_map(|row| self.largest.get(row.start)).fold(f64::MIN_POSITIVE, |a, &b| a.max(b));
        let (mut low, mut high) = ((1e-6 * budget / strongest / self.values.len() as f64).ln(), 0.0f64);
        for _ in 0..18 {
            let middle = 0.5 * (low + high);
            let left = self.left(&self.above(strongest * middle.exp()));
            if left > budget { high = middle } else { low = middle }
        }
        let counts = self.above(strongest * low.exp());
        let left = self.left(&counts);
        if left > budget { (self.modes.counts().to_vec(), 0.0) } else { (counts, left) }
    }

    /// For each harmonic of x, and for each of y, what it holds together with all of the other axis that are kept.
    pub fn marginals(&self, counts: &[u32]) -> [Vec<Rgb>; 2] {
        let mut held = [vec![[0.0; 3]; counts.len()], vec![[0.0; 3]; counts[0] as usize]];
        for (n, (row, &kept)) in self.rows().zip(counts).enumerate() {
            for (m, &value) in self.values[row].iter().take(kept as usize).enumerate() {
                held[0][n] = add(held[0][n], value);
                held[1][m] = add(held[1][m], value);
            }
        }
        held
    }

    /// The modes of each harmonic of x.
    fn rows(&self) -> impl Iterator<Item = Range<usize>> {
        rows(self.modes.counts())
    }

    /// The modes of at least some strength, and those that a never growing row has beside them; one at least.
    fn above(&self, threshold: f64) -> Vec<u32> {
        let last = |row: Range<usize>| self.largest[row].partition_point(|&largest| largest >= threshold) as u32;
        let mut counts: Vec<u32> = self.rows().map(last).collect();
        let mut most = 0;
        for count in counts.iter_mut().rev() {
            most = most.max(*count);
            *count = most;
        }
        counts.truncate(counts.iter().position(|&count| count == 0).unwrap_or(counts.len()));
        if counts.is_empty() { vec![1] } else { counts }
    }

    /// What is left out of each colour, the worst of them.
    fn left(&self, counts: &[u32]) -> f64 {
        let kept = counts.iter().copied().chain(std::iter::repeat(0));
        let beyond = self.rows().zip(kept).filter_map(|(row, kept)| self.rest[row].get(kept as usize));
        largest(beyond.fold([0.0; 3], |sum, &value| add(sum, value)))
    }
}

/// The modes of each harmonic of x, one row after the other.
pub(super) fn rows(counts: &[u32]) -> impl Iterator<Item = Range<usize>> {
    let mut end = 0;
    counts.iter().map(move |&count| {
        let start = end;
        end += count as usize;
        start..end
    })
}

/// Of each mode and all that lie beyond it in its row: the sum, and the largest.
fn beyond(values: &[Rgb], counts: &[u32]) -> (Vec<Rgb>, Vec<f64>) {
    let (mut rest, mut most) = (values.to_vec(), values.iter().copied().map(largest).collect::<Vec<f64>>());
    for row in rows(counts) {
        for k in row.rev().skip(1) {
            rest[k] = add(rest[k], rest[k + 1]);
            most[k] = most[k].max(most[k + 1]);
        }
    }
    (rest, most)
}

/// The modes of groups alone, without what they add.
pub(super) fn modes(problem: &Problem, groups: &[Group], counts: &[u32], period: DVec2, scale: Rgb) -> Vec<Mode> {
    let sums = View::new(problem, counts, period, scale).sums(groups);
    let kappas = (0..).zip(counts).flat_map(|(n, &count)| (0..count).map(move |m| kappa(n, m)));
    sums.0.iter().zip(kappas).map(|(sums, kappa)| mode(sums, kappa).0).collect()
}

/// What all tasks look at.
struct View<'a> {
    ghosts: &'a [Ghost],
    images: Option<&'a Images>,
    counts: &'a [u32],
    period: DVec2,
    scale: Rgb,
}

impl<'a> View<'a> {
    fn new(problem: &'a Problem, counts: &'a [u32], period: DVec2, scale: Rgb) -> Self {
        Self { ghosts: problem.ghosts(), images: problem.images(), counts, period, scale }
    }

    /// The sums over all groups, of every mode that each of them adds to, but for the modes' weights κ.
    fn sums(&self, groups: &[Group]) -> Sums {
        let of_photo = |group: &&Group| matches!(group.transform, Transform::Photo(_));
        let gathered = |group: &&Group| matches!(group.transform, Transform::Gather(_));
        let (of_photo, others): (Vec<&Group>, Vec<&Group>) = groups.iter().partition(of_photo);
        let (gathered, others): (Vec<&Group>, Vec<&Group>) = others.into_iter().partition(gathered);
        let mut sums = self.one_by_one(&others);
        gathered.into_iter().for_each(|group| self.add_gathered(&mut sums, group));
        let added =
            self.images.and_then(|images| images::sums(images, &of_photo, self.counts, self.period, self.scale));
        if let Some(added) = added {
            sums.add(&Sums(added));
        }
        sums
    }

    /// Adds a group's sums for each of a few sizes, times the coefficients of these: those of an even bell.
    fn add_gathered(&self, sums: &mut Sums, group: &Group) {
        let (Transform::Gather(gathering), Bells::Product(factor)) = (&group.transform, group.bell.shape().modes())
        else {
            return;
        };
        let columns = group.degree[0] as usize + 1;
        for (size, gathered) in gathering.sums(self.ghosts, group, self.period, self.scale) {
            let size = size / self.period;
            let [x, y] = [(0, size.x), (1, size.y)].map(|(axis, size)| factor.coefficients(group.degree[axis], size));
            let mut rest = &mut sums.0[..];
            for (n, ([a, _], &count)) in x.iter().zip(self.counts).enumerate() {
                let (row, others) = rest.split_at_mut(count as usize);
                for (m, (sums, [b, _])) in row.iter_mut().zip(&y).enumerate() {
                    for (colour, waves) in gathered[m * columns + n].iter().enumerate() {
                        let [cos_cos, cos_sin, sin_cos, sin_sin] = waves.map(|wave| a * b * wave);
                        for (part, value) in [cos_cos, -sin_cos, -cos_sin, sin_sin].into_iter().enumerate() {
                            sums[3 * part + colour] += value;
                        }
                    }
                }
                rest = others;
            }
        }
    }

    fn one_by_one(&self, groups: &[&Group]) -> Sums {
        let modes = self.counts.iter().map(|&count| count as usize).sum();
        let tasks = (ROOM / usize::max(modes, 1)).max(FEWEST_TASKS);
        let members: usize = groups.iter().map(|group| group.members.len()).sum();
        let batches = batches(groups, CHUNK.max(members.div_ceil(tasks)));
        let batches: Vec<Sums> = batches.par_iter().map(|batch| self.batch(batch, modes)).collect();
        let mut batches = batches.into_iter();
        let first = batches.next().unwrap_or_else(|| Sums::zero(modes));
        batches.fold(first, |mut all, batch| {
            all.add(&batch);
            all
        })
    }

    fn batch(&self, pieces: &[(&Group, &[u32])], modes: usize) -> Sums {
        let mut sums = Sums::zero(modes);
        for &(group, members) in pieces {
            let mut axes = [Axis::new(group.degree[0]), Axis::new(group.degree[1])];
            let (mine, size) = (group.counts(self.counts), group.smallest / self.period);
            let mut phases = || {
                let mut phases = Sums::zero(mine.iter().map(|&count| count as usize).sum());
                self.add(&mut phases, &mine, members, None, &mut axes);
                phases
            };
            match group.bell.shape().modes() {
                Bells::Product(factor) => self.add(&mut sums, self.counts, members, Some(factor), &mut axes),
                // Ghosts of a bell that brings a table have one size.
                Bells::Radial(radial) => {
                    let (phases, means) = (phases(), radial.means(&mine, size));
                    sums.add_some(self.counts, &mine, |at| times(&phases.0[at], means[at]));
                }
                Bells::Plane(plane) => {
                    let (phases, parts) = (phases(), plane.parts(&mine, size));
                    sums.add_some(self.counts, &mine, |at| through(&phases.0[at], parts[at]));
                }
                // Finding modes enough for it has failed before anyone looks at them.
                Bells::None => {}
            }
        }
        sums
    }

    /// Adds some ghosts of a group to so many modes, with the coefficients of a factor or with phases alone.
    fn add(&self, sums: &mut Sums, counts: &[u32], members: &[u32], factor: Option<&dyn Factor>, axes: &mut [Axis; 2]) {
        for &index in members {
            let ghost = &self.ghosts[index as usize];
            let (size, turns) = (ghost.size / self.period, ghost.center / self.period);
            axes[0].turn(factor, size.x, turns.x);
            axes[1].turn(factor, size.y, turns.y);
            sums.add_ghost(counts, weight(ghost, self.scale), axes);
        }
    }
}

/// The ghosts of all groups in batches of about so many, each with the group that its ghosts belong to.
fn batches<'a>(groups: &[&'a Group], chunk: usize) -> Vec<Vec<(&'a Group, &'a [u32])>> {
    let pieces = groups.iter().flat_map(|&group| group.members.chunks(chunk).map(move |members| (group, members)));
    let mut batches: Vec<Vec<(&Group, &[u32])>> = Vec::new();
    let mut room = 0;
    for piece in pieces {
        match batches.last_mut().filter(|_| piece.1.len() <= room) {
            Some(batch) => batch.push(piece),
            None => {
                batches.push(vec![piece]);
                room = chunk;
            }
        }
        room -= piece.1.len();
    }
    batches
}

fn add(a: Rgb, b: Rgb) -> Rgb {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The worst colour.
pub(super) fn largest(rgb: Rgb) -> f64 {
    rgb[0].max(rgb[1]).max(rgb[2])
}
