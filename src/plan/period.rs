//! The shortest period whose wrapped copies stay away from the picture.

use glam::DVec2;

use super::slots::{Slots, by_chunks};
use super::weigh::{Weighed, along};
use crate::problem::Problem;
use crate::scene::Ghost;
use crate::series::{Bell, Modes, Shape};

/// Ghosts of about one size and one distance, as the bounds see them: the worst of each.
#[derive(Clone)]
pub(super) struct Reach {
    bell: Bell,
    size: DVec2,
    /// Largest distance from a ghost to a pixel along each axis.
    farthest: DVec2,
    /// What is left of the bell at the nearest pixel along each axis.
    nearest: DVec2,
    weight: f64,
}

impl Reach {
    fn new(ghost: &Ghost, weight: f64, [low, high]: [DVec2; 2]) -> Self {
        let shape = ghost.bell.shape();
        let offset = (ghost.center.clamp(low, high) - ghost.center) / ghost.size;
        Self {
            bell: ghost.bell.clone(),
            size: ghost.size,
            farthest: (ghost.center - low).abs().max((high - ghost.center).abs()),
            nearest: DVec2::new(along(shape, offset.x.abs()), along(shape, offset.y.abs())),
            weight,
        }
    }

    /// Of an image: its ghosts, the centres of which lie anywhere between two places.
    pub fn of_image(ghost: &Ghost, weight: f64, [least, most]: [DVec2; 2], [low, high]: [DVec2; 2]) -> Self {
        let shape = ghost.bell.shape();
        let gap = (least - high).max(low - most).max(DVec2::ZERO) / ghost.size;
        Self {
            bell: ghost.bell.clone(),
            size: ghost.size,
            farthest: (most - low).abs().max((high - least).abs()),
            nearest: DVec2::new(along(shape, gap.x), along(shape, gap.y)),
            weight,
        }
    }

    /// The bin that it belongs to: a few for each octave.
    fn bin(&self) -> [u16; 6] {
        // Exponent and first bits of the mantissa are the steps of a logarithm, near enough.
        let octave = |value: f64, bits: u32| (value.max(1e-12).to_bits() >> (52 - bits)) as u16;
        [
            octave(self.size.x, 2),
            octave(self.size.y, 2),
            octave(self.farthest.x, 3),
            octave(self.farthest.y, 3),
            octave(self.nearest.x, 0),
            octave(self.nearest.y, 0),
        ]
    }

    /// The worst of both.
    fn join(&mut self, other: &Self) {
        self.size = self.size.max(other.size);
        self.farthest = self.farthest.max(other.farthest);
        self.nearest = self.nearest.max(other.nearest);
        self.weight += other.weight;
    }
}

/// Gathers the ghosts into some hundreds of reaches, so that trying a period costs the same for any number of them.
pub(super) fn reaches(problem: &Problem, weighed: &Weighed) -> Vec<Reach> {
    let all: Vec<u32> = (0..weighed.images.len() as u32).collect();
    let (ghosts, images) = (reaches_of_ghosts(problem, weighed), reaches_of_images(problem, weighed, &all));
    joined(ghosts.iter().chain(&images).map(|reach| (&reach.bell, reach.clone())))
}

/// Of ghosts that are no images.
pub(super) fn reaches_of_ghosts(problem: &Problem, weighed: &Weighed) -> Vec<Reach> {
    let bounds = <[DVec2; 2]>::from(problem.frame().bounds());
    let chunks = by_chunks(problem.ghosts(), &weighed.weights, |ghosts| {
        joined(ghosts.map(|(_, ghost, weight)| (&ghost.bell, Reach::new(ghost, weight, bounds))))
    });
    joined(chunks.iter().flatten().map(|reach| (&reach.bell, reach.clone())))
}

/// Of some of the images.
pub(super) fn reaches_of_images(problem: &Problem, weighed: &Weighed, members: &[u32]) -> Vec<Reach> {
    let bounds = <[DVec2; 2]>::from(problem.frame().bounds());
    let Some(images) = problem.images() else { return Vec::new() };
    let reach = |member: &u32| {
        let image = &images.all()[*member as usize];
        Reach::of_image(&image.ghost, weighed.images[*member as usize], images.centres(image), bounds)
    };
    let all: Vec<Reach> = members.iter().map(reach).collect();
    joined(all.iter().map(|reach| (&reach.bell, reach.clone())))
}

/// The reaches of each bell and bin joined.
fn joined<'a>(all: impl Iterator<Item = (&'a Bell, Reach)>) -> Vec<Reach> {
    let (mut slots, mut reaches) = (Slots::new(), Vec::<Reach>::new());
    for (bell, reach) in all {
        match reaches.get_mut(slots.slot(bell, reach.bin())) {
            Some(joined) => joined.join(&reach),
            None => reaches.push(reach),
        }
    }
    reaches
}

/// The shortest period along each axis that leaves at most half of the budget to its copies.
pub(super) fn shortest(reaches: &[Reach], budget: f64) -> DVec2 {
    // Copies along x are seen through the bell's y factor, which is at most its value at the nearest pixel.
    let along = |axis: fn(DVec2) -> f64, across: fn(DVec2) -> f64| {
        let wrap = |reach: &Reach, period: f64| {
            let wrap = reach.bell.shape().wrap(period, axis(reach.farthest), axis(reach.size));
            reach.weight * wrap * across(reach.nearest)
        };
        // The bound holds for periods longer than every distance.
        let farthest = reaches.iter().map(|reach| axis(reach.farthest)).fold(0.0, f64::max);
        let widest = reaches.iter().map(|reach| axis(reach.size)).fold(0.0, f64::max);
        // The rims of round bells must not meet: what a series leaves out of one of them is bounded, not of several.
        let round = reaches.iter().filter(|reach| matches!(reach.bell.shape().modes(), Modes::Radial(_)));
        let apart = round.map(|reach| 2.0 * (1.0 + 1e-9) * axis(reach.size)).fold(0.0, f64::max);
        let farthest = farthest.max(apart);
        let low = if farthest > 0.0 || widest > 0.0 { farthest } else { 1.0 };
        bisect(reaches, wrap, 0.45 * budget, [low, low + widest.max(1e-6 * low)])
    };
    DVec2::new(along(|v| v.x, |v| v.y), along(|v| v.y, |v| v.x))
}

/// The least period, from `low` on, whose error is within the budget; `high` is a first guess.
fn bisect(reaches: &[Reach], wrap: impl Fn(&Reach, f64) -> f64, budget: f64, [mut low, mut high]: [f64; 2]) -> f64 {
    // Of most ghosts nothing that counts is left at a period that is too short for others, nor at any longer one.
    const NOTHING: f64 = 1e-12;
    // The shortest to a millionth of the widest ghost.
    const HALVINGS: u32 = 20;
    let nothing = NOTHING * budget / reaches.len().max(1) as f64;
    let (mut counting, mut rest): (Vec<(&Reach, f64)>, f64) = (reaches.iter().map(|reach| (reach, 0.0)).collect(), 0.0);
    let mut fits = |period: f64| {
        counting.iter_mut().for_each(|(reach, error)| *error = wrap(reach, period));
        let too_much = rest + counting.iter().map(|(_, error)| error).sum::<f64>() > budget;
        if too_much {
            let (nothings, others) = std::mem::take(&mut counting).into_iter().partition(|&(_, error)| error < nothing);
            let nothings: Vec<(&Reach, f64)> = nothings;
            rest += nothings.iter().map(|(_, error)| error).sum::<f64>();
            counting = others;
        }
        !too_much
    };
    while !fits(high) {
        high = low + 2.0 * (high - low);
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if fits(middle) { high = middle } else { low = middle }
    }
    high
}

/// A bound of what all wrapped copies add at any pixel.
pub(super) fn error(reaches: &[Reach], period: DVec2) -> f64 {
    let wrap = |shape: &dyn Shape, period: f64, distance: f64, size: f64| {
        if period > distance {
            return shape.wrap(period, distance, size);
        }
        // A given period may be shorter than the picture: the copy that lands on it counts in full, the others are
        // those of a ghost that is nearer.
        let landed = (distance / period).floor();
        2.0 * landed + 2.0 + shape.wrap(period, distance - landed * period, size)
    };
    let one = |reach: &Reach| {
        let shape = reach.bell.shape();
        // The copies of a bell that is periodic itself are the bell.
        if shape.period() == Some(period) {
            return 0.0;
        }
        let x = wrap(shape, period.x, reach.farthest.x, reach.size.x);
        let y = wrap(shape, period.y, reach.farthest.y, reach.size.y);
        reach.weight * (x * reach.nearest.y + y * reach.nearest.x + x * y)
    };
    reaches.iter().map(one).sum()
}
