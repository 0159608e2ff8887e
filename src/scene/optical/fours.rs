//! Ghosts of light that is reflected four times: thousands in a large lens, each faint, and together up to an eighth of all where nothing is
//! coated. Those that look alike are taken for one.

use crate::optics::GhostPath;

/// A path counts from this part of the light's own image on, in any colour: what fainter ones have together is below a hundredth of what all
/// ghosts have in every lens that ships, bare or coated.
pub(super) const LEAST: f64 = 1e-6;

/// How far apart two ghosts are that look alike, at most, and how much wider one is, over the radius of the brighter.
const ALIKE: f64 = 0.25;

/// Ghosts that are narrower, over the farthest place from the axis, are as wide.
const NARROWEST: f64 = 0.02;

/// Ghosts at most; what looks like none of them is taken for the one that it looks most like.
const MOST: usize = 48;

/// A few ghosts for many, with the light of all: each is where the mean of those is that look like the brightest of them, and as wide. `half`
/// is how far from the axis lights count, in mm on the sensor.
pub(super) fn gathered(mut paths: Vec<GhostPath>, half: f64) -> Vec<GhostPath> {
    // Between how much light they have, which the wide ones lead in, and how bright they are, which those in focus do.
    let rank = |ghost: &GhostPath| ghost.share.iter().sum::<f64>() / width(ghost, half);
    paths.sort_by(|one, other| rank(other).total_cmp(&rank(one)));
    let mut groups: Vec<Vec<GhostPath>> = Vec::new();
    for path in paths {
        let apart = groups.iter().map(|group| unlikeness(&group[0], &path, half)).enumerate();
        match apart.min_by(|one, other| one.1.total_cmp(&other.1)) {
            Some((number, unlike)) if unlike <= ALIKE || groups.len() == MOST => groups[number].push(path),
            _ => groups.push(vec![path]),
        }
    }
    groups.into_iter().map(mean).collect()
}

/// The radius of a ghost, in mm.
fn width(ghost: &GhostPath, half: f64) -> f64 {
    ghost.radius_mm[1].max(NARROWEST * half)
}

/// How far apart two ghosts of a light at `half` are, or how much wider one is, over the radius of the brighter.
fn unlikeness(brighter: &GhostPath, other: &GhostPath, half: f64) -> f64 {
    let [radius, its] = [brighter, other].map(|ghost| width(ghost, half));
    let apart = (brighter.magnification[1] - other.magnification[1]).abs() * half;
    apart.max((its - radius).abs()) / radius
}

/// The brightest of a group, with the light of all, at the mean of their places and of their widths.
fn mean(group: Vec<GhostPath>) -> GhostPath {
    let weight = |ghost: &GhostPath, colour: usize| ghost.share[colour];
    let share = [0, 1, 2].map(|colour| group.iter().map(|ghost| weight(ghost, colour)).sum::<f64>());
    let all: f64 = share.iter().sum();
    let over = |value: &dyn Fn(&GhostPath, usize) -> f64, colour: usize| {
        let sum = |ghost: &GhostPath| ghost.share.iter().sum::<f64>() * value(ghost, colour);
        group.iter().map(sum).sum::<f64>() / all
    };
    let magnification = [0, 1, 2].map(|colour| over(&|ghost, colour| ghost.magnification[colour], colour));
    let radius_mm = [0, 1, 2].map(|colour| over(&|ghost, colour| ghost.radius_mm[colour].powi(2), colour).sqrt());
    GhostPath {
        magnification,
        radius_mm,
        share,
        ..group.into_iter().next().expect("a group has the path that began it")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::{Coating, GhostOptions, Setup, System};
    use crate::scene::lenses;

    fn fours(name: &str, least: f64) -> (Vec<GhostPath>, f64) {
        let mut lens = lenses::find(name).unwrap().prescription().unwrap();
        lens.coating = Coating::None;
        lens.surfaces.iter_mut().for_each(|surface| surface.coating = None);
        let system = System::new(&lens, &Setup::default()).unwrap();
        let all = system.ghosts(&GhostOptions { four_bounces: Some(least), ..GhostOptions::default() }).unwrap().ghosts;
        let (fours, pairs): (Vec<GhostPath>, Vec<GhostPath>) =
            all.into_iter().partition(|ghost| ghost.reflections.len() == 4);
        (fours, pairs.iter().map(|ghost| ghost.share[1]).sum())
    }

    #[test]
    fn a_few_ghosts_have_the_light_of_thousands_where_it_is() {
        for name in ["planar", "double-gauss"] {
            let (paths, pairs) = fours(name, LEAST);
            let few = gathered(paths.clone(), 21.6);
            let light = |ghosts: &[GhostPath]| ghosts.iter().map(|ghost| ghost.share[1]).sum::<f64>();
            assert!((light(&few) / light(&paths) - 1.0).abs() < 1e-12);
            // It matters: a twentieth of all or more.
            assert!(light(&paths) > 0.04 * pairs, "{name}: {} {pairs}", light(&paths));
            assert!(few.len() <= MOST && paths.len() > 300, "{name}: {} for {}", few.len(), paths.len());
            // Of a lamp at the edge they have it where the many do: the light on the sensor, in rings about the axis, as Gaussians.
            let within = |ghosts: &[GhostPath], radius: f64| -> f64 {
                let of = |ghost: &GhostPath| {
                    let (middle, sigma) = (ghost.magnification[1] * 12.0, 0.5 * width(ghost, 21.6));
                    let below = |x: f64| 0.5 * (1.0 + libm::erf((x - middle) / (sigma * std::f64::consts::SQRT_2)));
                    ghost.share[1] * (below(radius) - below(-radius))
                };
                ghosts.iter().map(of).sum()
            };
            for radius in [3.0, 6.0, 12.0, 21.6] {
                let (found, wanted) = (within(&few, radius), within(&paths, radius));
                let off = (found - wanted).abs() / light(&paths);
                assert!(off < 0.03, "{name}: {found} within {radius}, and {wanted} of all");
            }
            // What is fainter than the least is next to nothing.
            let all = fours(name, 1e-2 * LEAST).0;
            assert!(light(&all) - light(&paths) < 0.01 * pairs, "{name}: {} {}", light(&all), light(&paths));
        }
    }
}
