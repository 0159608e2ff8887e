//! Scenes by chance: every promise holds in every one. `VGLARE_LONG_TESTS` makes them two hundred.

use glam::DVec2;
use vglare::Error;
use vglare::frame::Frame;
use vglare::gpu::Backend;
use vglare::plan::{Evaluator, Plan, Request};
use vglare::scene::Ghost;
use vglare::series::Bell;

use super::{measured, request};
use crate::support::scenes::{self, Chance};
use crate::support::{long, on_backend, plan};

/// Each evaluator has as many of them, and the plan's own choice, too.
const SCENES: u64 = 50;
const LONG: u64 = 200;
/// Terms that an evaluator is tried with in the short form: more of them take a CPU a minute, and are no other.
const MOST_TERMS: usize = 100_000;

struct Scene {
    name: String,
    frame: Frame,
    ghosts: Vec<Ghost>,
    plan: Plan,
    asked: f64,
}

/// The bells of a scene: one in three has Gaussians only, one in three one other bell, and one in three them all.
fn bells(chance: &mut Chance) -> Vec<Bell> {
    let period = DVec2::new(chance.between(5.0, 9.0), chance.between(3.0, 6.0));
    let all: Vec<Bell> = Bell::examples().into_iter().map(|bell| bell.in_period(period)).collect();
    match chance.up_to(2) {
        0 => vec![Bell::Gaussian],
        1 => vec![all[chance.up_to(all.len() as u32 - 1) as usize].clone()],
        _ => all,
    }
}

fn ghosts(chance: &mut Chance, seed: u64, frame: Frame) -> Vec<Ghost> {
    let bells = bells(chance);
    let most = if bells.len() == 1 && bells[0] == Bell::Gaussian { 2000.0 } else { 200.0 };
    let count = chance.octaves(1.0, most + 1.0) as usize;
    let smallest = chance.octaves(0.05, 1.0);
    let largest = smallest * chance.octaves(1.0, 8.0);
    let mut ghosts = scenes::sized(seed, count, frame, smallest, largest);
    let signs = chance.up_to(3) == 0;
    // Bells that bring a table have one for each size.
    let few: Vec<DVec2> = ghosts.iter().take(6).map(|ghost| ghost.size).collect();
    for (index, ghost) in ghosts.iter_mut().enumerate() {
        ghost.bell = bells[chance.up_to(bells.len() as u32 - 1) as usize].clone();
        if ghost.bell.shape().tabulated() {
            ghost.size = few[index % few.len()];
        }
        if signs && chance.up_to(2) == 0 {
            ghost.radiance = ghost.radiance.map(|value| -value);
        }
    }
    ghosts
}

/// A scene with a tolerance from 0.1 down to where f32 ends, and its plan.
fn scene(seed: u64) -> Scene {
    let mut chance = Chance::new(seed ^ 0x5EED_0000);
    let frame = Frame::full(chance.octaves(1.0, 200.0) as u32, chance.octaves(1.0, 120.0) as u32);
    let ghosts = ghosts(&mut chance, seed, frame);
    let tolerance = chance.octaves(1e-6, 1e-1);
    // Each evaluator in turn, and the plan's own choice; and that, too, where the one cannot do it.
    let turn = Evaluator::ALL.get(seed as usize % 6).copied();
    let mut reasons = Vec::new();
    for evaluator in [turn, None] {
        let mut asked = tolerance;
        for _ in 0..3 {
            let asked_for = Request { evaluator, ..request(asked) };
            match plan(&ghosts, frame, &asked_for) {
                Ok(plan) if evaluator.is_some() && plan.terms() > MOST_TERMS && !long() => {
                    println!("scene {seed}: {} terms by {} take long", plan.terms(), plan.evaluator());
                    break;
                }
                Ok(plan) => {
                    let name = format!("scene {seed}, {} x {}, {} ghosts", frame.width, frame.height, ghosts.len());
                    return Scene {
                        name: format!("{name}, {}, {asked:.1e}", plan.evaluator()),
                        frame,
                        ghosts,
                        plan,
                        asked,
                    };
                }
                // The floor that the error names is a tolerance that can be had, or nearly so.
                Err(Error::ToleranceBelowFloor { floor, .. }) if floor < 0.5 => asked = 1.02 * floor,
                Err(error) => {
                    reasons.push(error.to_string());
                    break;
                }
            }
        }
    }
    panic!("scene {seed} has no plan at {tolerance:e}: {reasons:?} {:?}", frame)
}

/// The value that a part of the sorted values stays below.
fn quantile(sorted: &[f64], part: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * part).round() as usize]
}

#[test]
fn scenes_keep_the_promise() {
    let count = if long() { LONG } else { SCENES };
    let scenes: Vec<Scene> = (0..count).map(scene).collect();
    for Scene { name, plan, asked, .. } in &scenes {
        assert!(plan.predicted.total() <= *asked, "{name}: {:?} for {asked:e}", plan.predicted);
    }
    let errors: Vec<f64> = on_backend(Backend::ALL[0], |renderer| {
        scenes
            .iter()
            .map(|Scene { name, frame, ghosts, plan, .. }| measured(renderer, name, ghosts, *frame, plan))
            .collect()
    });
    let mut ratios: Vec<(f64, &str)> = (scenes.iter().zip(&errors))
        .filter(|(_, error)| **error > 0.0)
        .map(|(scene, error)| (scene.plan.predicted.total() / error, &scene.name[..]))
        .collect();
    ratios.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (ratio, name) in &ratios[..6] {
        println!("{name}: predicted / measured = {ratio:.2}");
    }
    for evaluator in Evaluator::ALL {
        println!("{evaluator}: {} scenes", scenes.iter().filter(|scene| scene.plan.evaluator() == evaluator).count());
    }
    let values: Vec<f64> = ratios.iter().map(|(ratio, _)| *ratio).collect();
    let [low, median, high] = [0.25, 0.5, 0.75].map(|part| quantile(&values, part));
    println!(
        "{} scenes, {} of them without any error; predicted / measured: quartiles {low:.1} and {high:.1}, median {median:.1}",
        scenes.len(),
        scenes.len() - values.len()
    );
    // A bound so loose that it wastes work would be a defect.
    assert!(median <= 10.0, "predicted / measured is {median:.1} at the median");
}
