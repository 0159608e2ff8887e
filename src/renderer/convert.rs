//! From scene, plan and settings to what the passes take; one way only.

use super::settings::{Normalize, Settings};
use crate::gpu::composite::{Composite, Variant};
use crate::gpu::field::Source;
use crate::gpu::layout::{DirectGhost, SpectralGhost};
use crate::plan::{Evaluator, Plan};
use crate::scene::Ghost;
use crate::series::{Bell, phase};

/// The GLSL function that an evaluator has readied.
pub(super) fn source(evaluator: Evaluator) -> Source {
    match evaluator {
        // The Gaussian is the only bell so far; `direct` would run once for each bell.
        Evaluator::Direct => {
            Source { evaluator: "\"evaluators/direct.glsl\"", bell: Some(Bell::Gaussian.shape().shader()) }
        }
        Evaluator::Series => Source { evaluator: "\"evaluators/series.glsl\"", bell: None },
        Evaluator::Rows => Source { evaluator: "\"evaluators/rows.glsl\"", bell: None },
        Evaluator::Grid => Source { evaluator: "\"evaluators/grid.glsl\"", bell: None },
    }
}

/// The composite that the settings ask for.
pub(super) fn variant(source: Source, settings: &Settings) -> Variant {
    let normalize = match settings.normalize {
        Normalize::None => "0",
        Normalize::Clamp => "1",
        Normalize::Minmax => "2",
    };
    Variant { source, normalize, take_light: settings.light_gain != [1.0; 3] }
}

/// The members of a group, as the spectrum takes them.
pub(super) fn spectral_ghosts(ghosts: &[Ghost], plan: &Plan, members: &[u32]) -> Vec<SpectralGhost> {
    let convert = |&index: &u32| {
        let ghost = &ghosts[index as usize];
        let size = ghost.size / plan.period;
        SpectralGhost {
            phase: [phase(ghost.center.x, plan.period.x), phase(ghost.center.y, plan.period.y)],
            size: [size.x as f32, size.y as f32],
            weight: weight(ghost, plan),
            pad: 0.0,
        }
    };
    members.iter().map(convert).collect()
}

/// All ghosts that the plan keeps, as the direct sum takes them.
pub(super) fn direct_ghosts(ghosts: &[Ghost], plan: &Plan) -> Vec<DirectGhost> {
    let convert = |&index: &u32| {
        let ghost = &ghosts[index as usize];
        let inverse = 1.0 / ghost.size;
        DirectGhost {
            center: [ghost.center.x as f32, ghost.center.y as f32],
            inverse_size: [inverse.x as f32, inverse.y as f32],
            weight: weight(ghost, plan),
            pad: 0.0,
        }
    };
    plan.groups.iter().flat_map(|group| &group.members).map(convert).collect()
}

/// The composite's uniforms.
pub(super) fn uniforms(plan: &Plan, settings: &Settings) -> Composite {
    let rgb = |v: [f64; 3], w: f64| [v[0] as f32, v[1] as f32, v[2] as f32, w as f32];
    Composite {
        scale: rgb(plan.scale, 0.0),
        light_gain: rgb(settings.light_gain, 1.0),
        luminance: rgb(settings.luminance, settings.threshold),
        strength: settings.strength as f32,
        pad: [0.0; 3],
    }
}

fn weight(ghost: &Ghost, plan: &Plan) -> [f32; 3] {
    [0, 1, 2].map(|colour| (ghost.radiance[colour] / plan.scale[colour]) as f32)
}
