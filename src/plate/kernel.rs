//! The bell as a kernel: what is left of it without the step that it may end in, and how far its flat parts go along a row.

use glam::DVec2;

use crate::scene::Ghost;
use crate::series::{Bell, Shape};

/// A bell, less its step.
pub(super) struct Kernel<'a> {
    shape: &'a dyn Shape,
    size: DVec2,
    step: Option<Step>,
}

/// What a bell falls by where it ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    pub height: f64,
    /// The radius that it is at; none where the value itself says it.
    end: Option<f64>,
}

/// The step of a bell that is not continuous.
pub(super) fn step(ghost: &Ghost) -> Option<Step> {
    match &ghost.bell {
        Bell::Disc(disc) if disc.rim() == 0.0 => Some(Step { height: 1.0, end: None }),
        Bell::Profile(profile) if profile.jump() > 0.0 => {
            let [end, height] = profile.rows().last().unwrap_or_default();
            Some(Step { height, end: Some(end) })
        }
        _ => None,
    }
}

impl<'a> Kernel<'a> {
    pub fn new(ghost: &'a Ghost) -> Self {
        Self { shape: ghost.bell.shape(), size: ghost.size, step: step(ghost) }
    }

    /// Whether nothing is left without the step.
    pub fn is_nothing(ghost: &Ghost) -> bool {
        matches!(&ghost.bell, Bell::Disc(disc) if disc.rim() == 0.0)
    }

    /// Its values along a row of offsets.
    pub fn row(&self, xs: &[f64], y: f64, out: &mut [f64]) {
        self.shape.over(xs, &[y], self.size, &mut |_, values| out.copy_from_slice(values));
        let Some(step) = self.step else { return };
        let inside = |x: f64| inside(self.shape, step, DVec2::new(x, y), self.size);
        out.iter_mut().zip(xs).for_each(|(out, x)| *out -= if inside(*x) { step.height } else { 0.0 });
    }
}

/// Whether an offset is within the end of a bell with a step.
fn inside(shape: &dyn Shape, step: Step, offset: DVec2, size: DVec2) -> bool {
    match step.end {
        // A profile may be nothing anywhere.
        Some(end) => (offset / size).length() <= end,
        None => shape.value(offset, size) > 0.0,
    }
}

/// The flat part of a bell, with a height of its own, and what it is all in all, along a row at an offset of y.
pub(super) struct Flat<'a> {
    ghost: &'a Ghost,
    step: Option<Step>,
    pub height: f64,
}

impl<'a> Flat<'a> {
    /// Of a disc, or of any bell that has a step: then it is the step alone.
    pub fn new(ghost: &'a Ghost) -> Option<Self> {
        let step = step(ghost);
        match (&ghost.bell, step) {
            (_, Some(step)) => Some(Self { ghost, step: Some(step), height: step.height }),
            (Bell::Disc(_), None) => Some(Self { ghost, step: None, height: 1.0 }),
            _ => None,
        }
    }

    /// Between which offsets along x the bell is flat, and between which it is anything; none where it is not. Without a rim they are one.
    pub fn along(&self, y: f64) -> Option<[[f64; 2]; 2]> {
        let (shape, size) = (self.ghost.bell.shape(), self.ghost.size);
        let chord = |inside: &dyn Fn(f64) -> bool| {
            // Convex: the chord is where a line from anywhere in it leaves it.
            let end = size.x * 1.001 * shape.ends();
            let within = self.somewhere(y).filter(|&x| inside(x))?;
            Some([last(within, -end, inside), last(within, end, inside)])
        };
        let value = |x: f64| shape.value(DVec2::new(x, y), size);
        match self.step {
            Some(step) => {
                let outer = chord(&|x| inside(shape, step, DVec2::new(x, y), size))?;
                Some([outer, outer])
            }
            None => {
                let outer = chord(&|x| value(x) > 0.0)?;
                // Nothing is flat where the row passes beside.
                Some([chord(&|x| value(x) >= 1.0).unwrap_or([1.0, 0.0]), outer])
            }
        }
    }

    /// An offset along x that is in the bell if any of the row is.
    fn somewhere(&self, y: f64) -> Option<f64> {
        let (shape, size) = (self.ghost.bell.shape(), self.ghost.size);
        let Bell::Disc(disc) = &self.ghost.bell else { return Some(0.0) };
        if disc.is_round() {
            return Some(0.0);
        }
        // What is convex has its least ρ along a row where a search by thirds ends.
        let radius = |x: f64| disc.radius(DVec2::new(x, y) / size);
        let (mut low, mut high) = (-1.001 * shape.ends() * size.x, 1.001 * shape.ends() * size.x);
        for _ in 0..80 {
            let third = (high - low) / 3.0;
            if radius(low + third) <= radius(high - third) { high -= third } else { low += third }
        }
        Some(0.5 * (low + high))
    }
}

/// The last of the offsets from `within` towards `end` that is inside.
fn last(within: f64, end: f64, inside: &dyn Fn(f64) -> bool) -> f64 {
    let (mut near, mut far) = (within, end);
    loop {
        let middle = 0.5 * (near + far);
        if middle == near || middle == far {
            return near;
        }
        if inside(middle) { near = middle } else { far = middle }
    }
}
