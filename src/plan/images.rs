//! Ghosts of the whole photo, as parts of a series: how they are grouped, weighed and reduced, and what they add to each mode.
//!
//! An image g has its ghosts at a (1 − m) + m x_p, m its `along` and a the lens's axis. So with the coefficients u_n and v_m of its
//! bell (docs/math.md, "Ghosts of a whole photo"), what all pixels p add to mode (n, m) is
//!
//! ```text
//! w_g u_n v_m e^{−i(nω·a + mω'·a)(1 − m_g)} Σ_p L_p e^{−i m_g (nω x_p + mω' y_p)}
//! ```
//!
//! the photo's own waves at scaled frequencies: two small products of matrices on its moments, whatever the number of pixels.

use std::f64::consts::TAU;

use glam::DVec2;
use rayon::prelude::*;

use super::Transform;
use super::amplitudes::Rgb;
use super::decay::Decay;
use super::effort::Effort;
use super::series;
use super::sums::turned;
use super::terms::{self, Group};
use super::weigh::{Weighed, peak_weight};
use crate::Error;
use crate::problem::{Image, Images};
use crate::raster::{Raster, Reduction, aliasing, spline};
use crate::series::frequencies;
use crate::series::{Bell, Modes as Bells};

/// Images that one task goes through, at most, and tasks at least, where there are as many images. Tasks are joined in their order,
/// whatever the number of cores.
const CHUNK: usize = 8;
const TASKS: usize = 16;

/// Images from which on they may share a transform of all pixels, which takes much memory.
pub(crate) const MANY_IMAGES: usize = 8;

/// What f64 loses of a sum over a lattice, over the sum of its terms' magnitudes: some thousands of roundings.
const DOUBLES: f64 = 1e-12;

/// Nanoseconds of a product and its addition in such a sum, and of a pixel whose moments are taken in doubles.
const PRODUCT: f64 = 0.15;
const DOUBLED: f64 = 40.0;

/// For each image what it would be at its brightest, were all of its light at one place, in units of the scale.
pub(super) fn weights(images: &Images, scale: Rgb) -> Vec<f64> {
    images.all().iter().map(|image| peak_weight(&images.gathered(image), scale)).collect()
}

/// The images' groups, as [`terms::group`] makes them of ghosts; their reductions are still to be chosen.
pub(super) fn groups(images: &Images, weighed: &Weighed) -> Vec<Group> {
    let gathered: Vec<_> = images.all().iter().map(|image| images.gathered(image)).collect();
    let of_patch = |patch: usize| {
        let weight = |(image, weight): (&Image, &f64)| if image.patch == patch { *weight } else { 0.0 };
        let weights: Vec<f64> = images.all().iter().zip(&weighed.images).map(weight).collect();
        terms::group(&gathered, &weights)
    };
    // Ghosts of different pixels share no waves.
    let groups = (0..=images.patches()).flat_map(of_patch);
    let unreduced = |group: Group| {
        let raster = raster(images, &group);
        let transform = Transform::Photo(raster.reduction(1, true));
        Group { ghosts: raster.pixels() * group.ghosts, transform, ..group }
    };
    groups.map(unreduced).collect()
}

/// The pixels that a group's images are of.
fn raster<'a>(images: &'a Images, group: &Group) -> &'a Raster {
    group.members.first().map_or(images.raster(), |member| images.raster_of(&images.all()[*member as usize]))
}

/// As many modes as images are looked at with: so many that next to nothing lies beyond them, or, where that would be very many,
/// fewer.
pub(super) fn enough(groups: &mut [Group], period: DVec2, usable: f64, effort: &Effort) -> Option<Vec<u32>> {
    const MANY: usize = 1 << 13;
    const PARTS: [f64; 4] = [series::BEYOND, 0.1, 0.3, 0.5];
    let mut found = None;
    for part in PARTS {
        let mut tried = groups.to_vec();
        let Ok(counts) = terms::fewest(&mut tried, period, usable * part, effort) else { continue };
        let many = counts.iter().map(|&count| count as usize).sum::<usize>() > MANY;
        found = Some((tried, counts));
        if !many {
            break;
        }
    }
    let (tried, counts) = found?;
    groups.clone_from_slice(&tried);
    Some(counts)
}

/// Chooses for each group of images a lattice such that all of them are off by no more than a budget, and gives by how much they
/// are; the groups whose error falls most for what it costs are refined first.
pub(super) fn reduce(groups: &mut [Group], images: &Images, period: DVec2, budget: f64) -> f64 {
    let mut choices: Vec<Choice> = groups
        .iter_mut()
        .filter(|group| matches!(group.transform, Transform::Photo(_)))
        .map(|group| Choice::new(group, images, period))
        .collect();
    let mut off: f64 = choices.iter().map(Choice::error).sum();
    while off.is_nan() || off > budget {
        let refined = choices.iter_mut().filter_map(|choice| choice.gain().map(|gain| (gain, choice)));
        let Some((_, choice)) = refined.max_by(|one, other| one.0.total_cmp(&other.0)) else { break };
        choice.ways.remove(0);
        off = choices.iter().map(Choice::error).sum();
    }
    for choice in &mut choices {
        choice.group.transform = Transform::Photo(choice.ways[0].0);
    }
    off
}

/// A group, and the ways that are left to it: each dearer than the one before it, and less off.
struct Choice<'a> {
    group: &'a mut Group,
    ways: Vec<(Reduction, f64, f64)>,
}

impl<'a> Choice<'a> {
    fn new(group: &'a mut Group, images: &Images, period: DVec2) -> Self {
        let raster = raster(images, group);
        let sharing = images.all().iter().filter(|image| std::ptr::eq(images.raster_of(image), raster)).count();
        let ways = [false, true]
            .into_iter()
            .flat_map(|doubles| (1..=raster.levels()).rev().map(move |level| raster.reduction(level, doubles)))
            .flat_map(|reduction| [reduction, reduction.by_transform()])
            .chain((sharing >= MANY_IMAGES).then(|| raster.reduction(0, true).by_transform()))
            .chain([raster.reduction(0, true)]);
        let held = Decay::new(group, period).marginals(group.degree);
        let along = |image: &u32| images.all()[*image as usize].along.abs();
        let along = group.members.iter().map(along).fold(0.0, f64::max);
        let mut left: Vec<(Reduction, f64, f64)> = Vec::new();
        for way in ways {
            let theta = TAU * along * way.pitch() * raster.frame().pixel_sides() / period;
            let error = group.weight * off_by(&held, theta, way);
            // Moments in doubles take as long as those of many images do.
            // A transform serves all images.
            let points = way.points.map(|points| points as usize);
            let transform = if way.transformed { frequencies::work(points) / sharing as f64 } else { 0.0 };
            let doubled = if way.doubles { DOUBLED * raster.pixels() as f64 } else { 0.0 };
            let cost = cost(group, way) + transform * group.members.len() as f64 + doubled;
            left.retain(|(_, other, dear)| *other > error || *dear < cost);
            if left.iter().all(|(_, other, _)| *other > error) {
                left.push((way, error, cost));
            }
        }
        left.sort_by(|one, other| one.2.total_cmp(&other.2));
        Self { group, ways: left }
    }

    fn error(&self) -> f64 {
        self.ways.first().map_or(f64::INFINITY, |(_, error, _)| *error)
    }

    /// By how much the error falls with the next way, for what that costs more.
    fn gain(&self) -> Option<f64> {
        let [(_, error, cost), (_, next, dearer)] = self.ways.first_chunk()?;
        // From what is no bound at all to any.
        let falls = if error.is_finite() { error - next } else { f64::MAX };
        Some(falls / (dearer - cost).max(1.0))
    }
}

/// What a bell of peak 1 is off by where its waves are from moments, θ radians a point for each harmonic; `held` is what its
/// harmonics hold.
fn off_by(held: &[Vec<f64>; 2], theta: DVec2, reduction: Reduction) -> f64 {
    // The correction of a wave that the lattice hardly resolves would be larger than the wave.
    const RESOLVED: f64 = 0.9 * std::f64::consts::PI;
    let all: f64 = held[0].iter().sum();
    let highest = |axis: usize| theta[axis] * (held[axis].len() - 1) as f64;
    let [across, down] = reduction.off();
    let off = across + down + across * down;
    if reduction.level == 0 {
        let resolved = !reduction.transformed || highest(0).max(highest(1)) <= frequencies::FASTEST;
        return if resolved { (DOUBLES + off) * all } else { f64::INFINITY };
    }
    if highest(0).max(highest(1)) > RESOLVED {
        return f64::INFINITY;
    }
    let along = |axis: usize| -> f64 {
        held[axis].iter().enumerate().map(|(n, held)| held * aliasing(theta[axis] * n as f64)).sum()
    };
    let gain = |axis: usize| spline(highest(axis)).recip();
    // Moments are rounded as they come, and the waves multiply that by no more than the corrections.
    let rounding = (reduction.rounding() + DOUBLES) * gain(0) * gain(1) * all;
    // (1 + ε)(1 + ε') − 1
    // What a transform is off, each wave is, times what the correction is; those of both axes together.
    let transform = off * gain(0) * gain(1) * all;
    along(0) * (1.0 + aliasing(highest(1))) + along(1) + rounding + transform
}

/// Why there is no series of all images: by the sharpest of their bells.
pub(super) fn too_many(groups: &[Group]) -> Error {
    let images = groups.iter().filter(|group| matches!(group.transform, Transform::Photo(_)));
    // A Gaussian, the smoothest of bells, comes into question last.
    let size = |group: &&Group| group.smallest.min_element() * if group.bell == Bell::Gaussian { 10.0 } else { 1.0 };
    let sharpest = images.min_by(|one, other| size(one).total_cmp(&size(other)));
    let Some(Group { bell, smallest, .. }) = sharpest else { return Error::Plan("there are no images".into()) };
    if let Bells::None = bell.shape().modes() {
        return Error::Plan(format!(
            "a {bell} with blades has no series: the plate sums it, where no other evaluator is asked for"
        ));
    }
    Error::Plan(format!(
        "the ghosts of all pixels would need a series of too many modes, by a bell of {:.3} x {:.3} ({bell}): the plate sums them, where \
         neither another evaluator nor a period or degree is asked for",
        smallest.x, smallest.y,
    ))
}

/// What the waves of a group of images take, in nanoseconds.
pub(super) fn cost(group: &Group, reduction: Reduction) -> f64 {
    let [columns, rows] = reduction.points.map(f64::from);
    let [n, m] = group.degree.map(|degree| f64::from(degree + 1));
    if reduction.transformed {
        return group.members.len() as f64 * frequencies::work_of_waves([n, m]);
    }
    // Half of the points for each of cosines and sines; all pixels where they are taken as they are.
    let all = if reduction.level == 0 { 2.0 } else { 1.0 };
    PRODUCT * group.members.len() as f64 * 3.0 * rows * n * all * (columns + all * m)
}

/// What groups of images add to each mode, laid out as [`super::amplitudes`] has its sums.
pub(super) fn sums(
    images: &Images,
    groups: &[&Group],
    counts: &[u32],
    period: DVec2,
    scale: Rgb,
) -> Option<Vec<[f64; 12]>> {
    let each = |group: &&Group| {
        let Transform::Photo(reduction) = group.transform else { return Vec::new() };
        let degree = group.degree;
        group.members.iter().map(|member| (&images.all()[*member as usize], reduction, degree)).collect()
    };
    let all: Vec<(&Image, Reduction, [u32; 2])> = groups.iter().flat_map(each).collect();
    let modes = counts.iter().map(|&count| count as usize).sum();
    // Before any task asks for them: one that waits for another to have made them may never go on.
    all.iter().for_each(|(image, reduction, _)| images.raster_of(image).prepare(*reduction));
    let chunk = |chunk: &[(&Image, Reduction, [u32; 2])]| {
        let mut sums = vec![[0.0; 12]; modes];
        for (image, reduction, degree) in chunk {
            add((&mut sums, counts), images, (image, *reduction, *degree), period, scale);
        }
        sums
    };
    let chunks: Vec<Vec<[f64; 12]>> = all.par_chunks(all.len().div_ceil(TASKS).clamp(1, CHUNK)).map(chunk).collect();
    chunks.into_iter().reduce(|mut all, chunk| {
        all.as_flattened_mut().iter_mut().zip(chunk.as_flattened()).for_each(|(all, chunk)| *all += chunk);
        all
    })
}

/// Adds what an image adds to each mode up to a degree.
fn add(
    (sums, counts): (&mut [[f64; 12]], &[u32]),
    images: &Images,
    (image, reduction, degree): (&Image, Reduction, [u32; 2]),
    period: DVec2,
    scale: Rgb,
) {
    let size = image.ghost.size / period;
    // Its own modes among them.
    let own: Vec<u32> = counts.iter().take(degree[0] as usize + 1).map(|&count| count.min(degree[1] + 1)).collect();
    let (factor, parts) = match image.ghost.bell.shape().modes() {
        Bells::Product(factor) => (Some(factor), None),
        Bells::Radial(radial) => {
            (None, Some(radial.means(&own, size).into_iter().map(|mean| [mean, 0.0, 0.0, 0.0]).collect::<Vec<_>>()))
        }
        Bells::Plane(plane) => (None, Some(plane.parts(&own, size))),
        // Finding modes enough for it has failed before anyone looks at them.
        Bells::None => return,
    };
    let raster = images.raster_of(image);
    let first = TAU * image.along / period;
    let wanted = image.ghost.radiance.map(|radiance| radiance != 0.0);
    let waves = raster.waves(reduction, first, degree.map(|degree| degree as usize + 1), wanted);
    // Where the ghosts of the waves' middle are.
    let middle = images.axis() + image.along * (raster.middle(reduction) - images.axis());
    let spacing = if reduction.level == 0 { DVec2::ZERO } else { reduction.pitch() * raster.frame().pixel_sides() };
    let [x, y] = [0, 1].map(|axis| {
        let centred = match factor {
            Some(factor) => factor.coefficients(degree[axis], size[axis]),
            None => vec![[1.0, 0.0]; degree[axis] as usize + 1],
        };
        centred_at(&centred, middle[axis] / period[axis], first[axis] * spacing[axis])
    });
    let weights = [0, 1, 2].map(|colour| image.ghost.radiance[colour] / scale[colour]);
    let (mut start, mut own_start) = (0, 0);
    for ((n, x), (&count, &own)) in x.iter().enumerate().zip(counts.iter().zip(&own)) {
        for (m, y) in y.iter().enumerate().take(own as usize) {
            for (colour, (waves, weight)) in waves.iter().zip(weights).enumerate() {
                let waves = products(*x, *y, waves.each_ref().map(|wave| wave[(n, m)]));
                let waves = parts.as_ref().map_or(waves, |parts| turned(waves, parts[own_start + m]));
                for (part, value) in waves.into_iter().enumerate() {
                    sums[start + m][3 * part + colour] += weight * value;
                }
            }
        }
        (start, own_start) = (start + count as usize, own_start + own as usize);
    }
}

/// u_n e^{−inφ} / β̂(nθ), real and imaginary parts, of coefficients about a bell's centre, φ in turns.
fn centred_at(centred: &[[f64; 2]], turns: f64, theta: f64) -> Vec<[f64; 2]> {
    let (sin, cos) = (TAU * (turns - turns.round())).sin_cos();
    let mut phase = [1.0, 0.0];
    let turn = |(n, [a, b]): (usize, &[f64; 2])| {
        let corrected = spline(theta * n as f64).recip();
        // (a − ib) (cos − i sin)
        let turned = [a * phase[0] - b * phase[1], -a * phase[1] - b * phase[0]].map(|part| corrected * part);
        phase = [phase[0] * cos - phase[1] * sin, phase[1] * cos + phase[0] * sin];
        turned
    };
    centred.iter().enumerate().map(turn).collect()
}

/// Of (p + iq) (c − is) along x and the same along y the sums of the products of real and imaginary parts, re·re, im·re, re·im and
/// im·im, by those of cc, sc, cs and ss.
fn products([p, q]: [f64; 2], [r, t]: [f64; 2], [cc, sc, cs, ss]: [f64; 4]) -> [f64; 4] {
    let along = |c: f64, s: f64| [p * c + q * s, q * c - p * s];
    let ([re_c, im_c], [re_s, im_s]) = (along(cc, sc), along(cs, ss));
    [r * re_c + t * re_s, r * im_c + t * im_s, t * re_c - r * re_s, t * im_c - r * im_s]
}
