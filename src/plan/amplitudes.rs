//! How strong each mode of the whole field is, with the phases that the ghosts' places give them.
//!
//! A bound by weights alone adds up all ghosts as if they stood at one place. Ghosts that are scattered hardly add up:
//! where it is cheap, the plan looks.

use std::f64::consts::TAU;

use glam::DVec2;
use rayon::prelude::*;

use super::Group;
use crate::scene::Ghost;
use crate::series::{Factor, Modes, kappa};

/// Ghosts times modes that are looked at, at most: some ten milliseconds, and less than a dispatch over them would take.
const EFFORT: usize = 8_000_000;
/// Ghosts that one task goes through. Tasks are joined in their order, whatever the number of cores.
const CHUNK: usize = 128;

/// Whether so many ghosts could be looked at in a series of a few modes.
pub(super) fn worth_a_try(groups: &[Group]) -> bool {
    const FEW: usize = 16;
    FEW * members(groups) <= EFFORT
}

fn members(groups: &[Group]) -> usize {
    groups.iter().map(|group| group.members.len()).sum()
}

/// Red, green, blue; or their bounds.
pub(super) type Rgb = [f64; 3];

/// For every mode an upper bound of what it adds at any point, relative to the field's largest value.
pub(super) struct Amplitudes {
    /// How many harmonics of y there are beside each of x, never growing.
    counts: Vec<u32>,
    /// Harmonic by harmonic of x.
    values: Vec<Rgb>,
}

impl Amplitudes {
    /// Of these modes; none where looking would take too long.
    ///
    /// With the complex coefficients u_n and v_m of a ghost's factors about its centre (φ, ψ), the phases of which are
    /// in turns, mode (n, m) of the field is
    ///
    /// ```text
    /// κ/2 Re(Z₊ e^{i(nωx + mωy)} + Z₋ e^{i(nωx − mωy)})    Z± = Σ_k w_k u_n e^{−2πinφ} (v_m e^{−2πimψ})^(*)
    /// ```
    ///
    /// and at most κ/2 (|Z₊| + |Z₋|). For a radial bell the transform stands before the sum instead.
    pub fn new(ghosts: &[Ghost], groups: &[Group], counts: &[u32], period: DVec2, scale: Rgb) -> Option<Self> {
        let modes: usize = counts.iter().map(|&count| count as usize).sum();
        if modes.saturating_mul(members(groups)) > EFFORT {
            return None;
        }
        let view = View { ghosts, counts, period, scale };
        let mut products = Sums::zero(modes);
        let mut all = vec![[0.0; 3]; modes];
        for group in groups {
            match group.bell.shape().modes() {
                Modes::Product(factor) => products.add(&view.sums(group, Some(factor))),
                // Ghosts of a bell that brings a table have one size.
                modes @ Modes::Radial(_) => {
                    let table = modes.table(counts, group.smallest / period);
                    let sums = view.sums(group, None);
                    for ((all, value), coefficient) in all.iter_mut().zip(sums.amplitudes()).zip(table) {
                        *all = add(*all, value.map(|value| value * coefficient[0].abs()));
                    }
                }
            }
        }
        let kappas = (0..).zip(counts).flat_map(|(n, &count)| (0..count).map(move |m| kappa(n, m)));
        for ((all, value), kappa) in all.iter_mut().zip(products.amplitudes()).zip(kappas) {
            *all = add(*all, value.map(|value| kappa * value));
        }
        Some(Self { counts: counts.to_vec(), values: all })
    }

    /// The strongest modes, so few that what is left out stays within the budget, for each harmonic of x how many of y;
    /// and what is left out.
    pub fn kept(&self, budget: f64) -> (Vec<u32>, f64) {
        let strongest = self.values.iter().map(|&value| largest(value)).fold(f64::MIN_POSITIVE, f64::max);
        let (mut low, mut high) = ((1e-6 * budget / strongest / self.values.len() as f64).ln(), 0.0f64);
        for _ in 0..18 {
            let middle = 0.5 * (low + high);
            let left = self.left(&self.above(strongest * middle.exp()));
            if left > budget { high = middle } else { low = middle }
        }
        let counts = self.above(strongest * low.exp());
        let left = self.left(&counts);
        if left > budget { (self.counts.clone(), 0.0) } else { (counts, left) }
    }

    /// For each harmonic of x, and for each of y, what it holds together with all of the other axis that are kept.
    pub fn marginals(&self, counts: &[u32]) -> [Vec<Rgb>; 2] {
        let mut held = [vec![[0.0; 3]; counts.len()], vec![[0.0; 3]; counts[0] as usize]];
        for (n, (row, &kept)) in self.rows().zip(counts).enumerate() {
            for (m, &value) in row.iter().take(kept as usize).enumerate() {
                held[0][n] = add(held[0][n], value);
                held[1][m] = add(held[1][m], value);
            }
        }
        held
    }

    /// The modes of each harmonic of x.
    fn rows(&self) -> impl Iterator<Item = &[Rgb]> {
        let mut rest = &self.values[..];
        self.counts.iter().map(move |&count| {
            let (row, others) = rest.split_at(count as usize);
            rest = others;
            row
        })
    }

    /// The modes of at least some strength, and those that a never growing row has beside them; one at least.
    fn above(&self, threshold: f64) -> Vec<u32> {
        let last = |row: &[Rgb]| row.iter().rposition(|&value| largest(value) >= threshold).map_or(0, |m| m as u32 + 1);
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
        let beyond = self.rows().zip(kept).flat_map(|(row, kept)| &row[kept as usize..]);
        largest(beyond.fold([0.0; 3], |sum, &value| add(sum, value)))
    }
}

/// What all tasks look at.
struct View<'a> {
    ghosts: &'a [Ghost],
    counts: &'a [u32],
    period: DVec2,
    scale: Rgb,
}

impl View<'_> {
    /// The sums over a group, with the coefficients of a factor or with phases alone.
    fn sums(&self, group: &Group, factor: Option<&dyn Factor>) -> Sums {
        let modes = self.counts.iter().map(|&count| count as usize).sum();
        let chunks: Vec<Sums> = group
            .members
            .par_chunks(CHUNK)
            .map(|members| {
                let mut sums = Sums::zero(modes);
                let mut axes = [Axis::new(group.degree[0]), Axis::new(group.degree[1])];
                for &index in members {
                    let ghost = &self.ghosts[index as usize];
                    let (size, turns) = (ghost.size / self.period, ghost.center / self.period);
                    axes[0].turn(factor, size.x, turns.x);
                    axes[1].turn(factor, size.y, turns.y);
                    let weight = [0, 1, 2].map(|colour| ghost.radiance[colour] / self.scale[colour]);
                    sums.add_ghost(self.counts, weight, &axes);
                }
                sums
            })
            .collect();
        chunks.into_iter().fold(Sums::zero(modes), |mut all, chunk| {
            all.add(&chunk);
            all
        })
    }
}

/// A ghost's coefficients along one axis, turned to its place.
struct Axis {
    /// What they are about the bell's centre, and for which size.
    centred: Vec<[f64; 2]>,
    size: f64,
    turned: Vec<[f64; 2]>,
}

impl Axis {
    fn new(degree: u32) -> Self {
        Self {
            centred: vec![[1.0, 0.0]; degree as usize + 1],
            size: f64::NAN,
            turned: vec![[0.0; 2]; degree as usize + 1],
        }
    }

    fn turn(&mut self, factor: Option<&dyn Factor>, size: f64, turns: f64) {
        // Equal sizes come one after the other more often than not.
        if let Some(factor) = factor.filter(|_| self.size != size) {
            self.centred = factor.coefficients(self.centred.len() as u32 - 1, size);
            self.size = size;
        }
        let (sin, cos) = (TAU * (turns - turns.round())).sin_cos();
        let mut phase = [1.0, 0.0];
        for (turned, [a, b]) in self.turned.iter_mut().zip(&self.centred) {
            // (a − ib) (cos − i sin)
            *turned = [a * phase[0] - b * phase[1], -a * phase[1] - b * phase[0]];
            phase = [phase[0] * cos - phase[1] * sin, phase[1] * cos + phase[0] * sin];
        }
    }
}

/// For each mode the sums of the products of real and imaginary parts: re·re and im·re, then re·im and im·im, each for
/// three colours.
struct Sums(Vec<[f64; 12]>);

impl Sums {
    fn zero(modes: usize) -> Self {
        Self(vec![[0.0; 12]; modes])
    }

    fn add(&mut self, other: &Self) {
        for (mine, theirs) in self.0.as_flattened_mut().iter_mut().zip(other.0.as_flattened()) {
            *mine += theirs;
        }
    }

    fn add_ghost(&mut self, counts: &[u32], weight: Rgb, [x, y]: &[Axis; 2]) {
        let mut rest = &mut self.0[..];
        for ([re, im], &count) in x.turned.iter().zip(counts) {
            let (row, others) = rest.split_at_mut(count as usize);
            let [r, g, b] = weight;
            let across = [r * re, g * re, b * re, r * im, g * im, b * im];
            for (sums, [re, im]) in row.iter_mut().zip(&y.turned) {
                for (k, across) in across.into_iter().enumerate() {
                    sums[k] += across * re;
                    sums[6 + k] += across * im;
                }
            }
            rest = others;
        }
    }

    /// (|Z₊| + |Z₋|) / 2 of each mode.
    fn amplitudes(&self) -> impl Iterator<Item = Rgb> {
        self.0.iter().map(|sums| {
            [0, 1, 2].map(|colour| {
                let [re_re, im_re, re_im, im_im] = [0, 3, 6, 9].map(|part| sums[part + colour]);
                let (sum, difference) = ((re_re - im_im).hypot(re_im + im_re), (re_re + im_im).hypot(im_re - re_im));
                0.5 * (sum + difference)
            })
        })
    }
}

fn add(a: Rgb, b: Rgb) -> Rgb {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The worst colour.
pub(super) fn largest(rgb: Rgb) -> f64 {
    rgb[0].max(rgb[1]).max(rgb[2])
}
