//! From scene, plan and settings to what the passes take; one way only.

use glam::DVec2;

use super::settings::Settings;
use crate::choices::{LightBy, Normalize};
use crate::gpu::composite::{Composite, Variant};
use crate::gpu::field::{Bells, Source};
use crate::gpu::layout::{
    Binding, DirectGhost, DoubleGhost, NORMALIZE_CLAMP, NORMALIZE_MINMAX, NORMALIZE_NONE, PROFILE_HALVINGS,
    SpectralGhost,
};
use crate::plan::{self, Evaluator, Group, Layer, Mode, Modes, Plan, Precision, Series};
use crate::scene::{Ghost, Knee};
use crate::series::{Bell, Distinct, Profile, phase};

// A profile that is not given at its centre has a row more.
const _: () = assert!(Profile::MOST_ROWS < 1 << PROFILE_HALVINGS);

/// A sum of layers, one of them local, and one that is missing; and the local one, in 32-bit floats and in 64.
const LAYERS: &str = "\"evaluators/layers.glsl\"";
const NONE: &str = "\"evaluators/none.glsl\"";
const LOCAL: [&str; 2] = ["\"evaluators/local.glsl\"", "\"evaluators/local_double.glsl\""];

/// The GLSL function that a plan's evaluator has readied, `direct` beside it where some ghosts are summed; there may be too
/// many of them for a uniform block.
pub(super) fn source(plan: &Plan, many_ghosts: bool) -> Source {
    let double = plan.precision == Precision::Double;
    let direct = if double { "\"evaluators/direct_double.glsl\"" } else { "\"evaluators/direct.glsl\"" };
    let exact = plan.is_exact();
    let of = |evaluator| Source { exact, ..Source::of(evaluator) };
    let summed = |evaluator| Source { bells: Some(bells(plan.summed_groups())), many_ghosts, double, ..of(evaluator) };
    let series = plan.series().map(series_file);
    let local = LOCAL[usize::from(plan.local().is_some_and(|local| local.precision == Precision::Double))];
    let has_direct = plan.layers().iter().any(|layer| matches!(layer, Layer::Direct(_)));
    // The plate's field stands where a local layer's canvas does; a photo's ghosts have no local layer.
    match (series, has_direct, plan.local().is_some() || plan.plate().is_some()) {
        (Some(series), false, false) => of(series),
        (Some(series), true, false) => {
            Source { parts: Some([series, direct, NONE]), ..summed("\"evaluators/split.glsl\"") }
        }
        (None, _, false) => summed(direct),
        // Rounded as it is drawn.
        (None, false, true) => Source::of(LOCAL[0]),
        (None, true, true) => Source { parts: Some([NONE, direct, local]), ..summed(LAYERS) },
        (Some(series), true, true) => Source { parts: Some([series, direct, local]), ..summed(LAYERS) },
        (Some(series), false, true) => Source { parts: Some([series, NONE, local]), ..of(LAYERS) },
    }
}

/// Whether ghosts are summed at every pixel; where there is nothing at all, none of them are.
pub(super) fn sums(plan: &Plan) -> bool {
    plan.series().is_none() && plan.local().is_none() && plan.plate().is_none() || plan.summed() > 0
}

/// The GLSL function of a series.
fn series_file(series: &Series) -> &'static str {
    match (series.evaluator, series.precision) {
        (Evaluator::Series, Precision::Single) => "\"evaluators/series.glsl\"",
        (Evaluator::Rows, Precision::Single) => "\"evaluators/rows.glsl\"",
        (_, Precision::Single) => "\"evaluators/grid.glsl\"",
        (Evaluator::Series, Precision::Double) => "\"evaluators/series_double.glsl\"",
        (Evaluator::Rows, Precision::Double) => "\"evaluators/rows_double.glsl\"",
        (_, Precision::Double) => "\"evaluators/grid_double.glsl\"",
    }
}

/// The bells that groups of ghosts have.
pub(super) fn bells<'a>(groups: impl IntoIterator<Item = &'a Group>) -> Bells {
    let (mut kinds, mut first) = (0u32, &Bell::Gaussian);
    for Group { bell, .. } in groups {
        first = if kinds == 0 { bell } else { first };
        kinds |= 1 << bell.kind();
    }
    if kinds.count_ones() > 1 { Bells::several(kinds) } else { Bells::one(first.shape().shader()) }
}

/// The composite that the settings ask for, of so many layers that are laid over the photo.
pub(super) fn variant(source: Source, settings: &Settings, layers: usize) -> Variant {
    let (take_light, straight) = (settings.light_gain != [1.0; 3], settings.emission.straight);
    let (soft, brightest) = (settings.knee.is_some(), settings.emission.by == LightBy::Brightest);
    Variant { source, normalize: normalize(settings), take_light, soft, straight, brightest, layers }
}

/// How values become glare.
pub(super) fn normalize(settings: &Settings) -> Binding {
    match settings.normalize {
        Normalize::None => NORMALIZE_NONE,
        Normalize::Clamp => NORMALIZE_CLAMP,
        Normalize::Minmax => NORMALIZE_MINMAX,
    }
}

/// The members of a group, as the spectrum takes them.
pub(super) fn spectral_ghosts(plan: &Plan, period: DVec2, members: &[u32]) -> Vec<SpectralGhost> {
    let convert = |&index: &u32| {
        let ghost = &plan.problem().ghosts()[index as usize];
        let size = ghost.size / period;
        SpectralGhost {
            phase: [phase(ghost.center.x, period.x), phase(ghost.center.y, period.y)],
            size: [size.x as f32, size.y as f32],
            weight: weight(ghost, plan).map(|weight| weight as f32),
            pad: 0.0,
        }
    };
    members.iter().map(convert).collect()
}

/// The ghosts that the plan sums directly, as the shader takes them, a list for each kind of bell; and the parameters of their
/// bells.
pub(super) fn direct_ghosts<G>(
    plan: &Plan,
    convert: impl Fn(&Ghost, [f64; 3], u32) -> G,
) -> (Vec<Vec<G>>, Vec<[f64; 4]>) {
    let mut shapes = Vec::new();
    // Where the parameters of the bells begin.
    let (mut distinct, mut begins) = (Distinct::new(), Vec::new());
    let mut direct: Vec<Vec<G>> = Vec::new();
    for group in plan.summed_groups() {
        let (number, new) = distinct.number(&group.bell);
        if new {
            begins.push(shapes.len() as u32);
            shapes.extend(group.bell.shape().parameters());
        }
        let begin = begins[number];
        let kind = group.bell.kind() as usize;
        direct.resize_with(direct.len().max(kind + 1), Vec::new);
        direct[kind].extend(group.members.iter().map(|&index| {
            let ghost = &plan.problem().ghosts()[index as usize];
            convert(ghost, weight(ghost, plan), begin)
        }));
    }
    (direct, shapes)
}

/// A ghost in 32-bit floats.
pub(super) fn single_ghost(ghost: &Ghost, weight: [f64; 3], bell: u32) -> DirectGhost {
    // Finite, so that no bell is asked for 0 · ∞ at its centre.
    let inverse = (1.0 / ghost.size).min(DVec2::splat(f64::from(f32::MAX)));
    DirectGhost {
        center: [ghost.center.x as f32, ghost.center.y as f32],
        inverse_size: [inverse.x as f32, inverse.y as f32],
        weight: weight.map(|weight| weight as f32),
        bell,
    }
}

/// A ghost as it is.
pub(super) fn double_ghost(ghost: &Ghost, weight: [f64; 3], bell: u32) -> DoubleGhost {
    DoubleGhost { center: ghost.center.to_array(), size: ghost.size.to_array(), weight, bell, pad: 0 }
}

/// The coefficients of a group's bell at one size, as the spectrum takes them.
pub(super) fn table(series: &Series, group: &Group, size: DVec2) -> Vec<[f32; 4]> {
    let single = |coefficient: [f64; 4]| coefficient.map(|x| x as f32);
    let mine = group.counts(&series.counts);
    let mut table = group.bell.shape().modes().table(&mine, size / series.period).into_iter().map(single);
    let mut all = Vec::with_capacity(series.terms());
    for (&count, mine) in series.counts.iter().zip(mine.iter().chain(std::iter::repeat(&0))) {
        let end = all.len() + count as usize;
        all.extend(table.by_ref().take(*mine as usize));
        all.resize(end, [0.0; 4]);
    }
    all
}

/// The modes that the series keeps of those that the plan has computed, as the spectrum has them: three vec4 a mode.
pub(super) fn terms(plan: &Plan, series: &Series, modes: &Modes) -> Vec<[f32; 4]> {
    let (scale, units) = (plan.scale, plan.units());
    let ratio = [0, 1, 2].map(|colour| scale[colour] / units[colour]);
    let single = |value: f64| value.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32;
    let turned = |mode: Mode| [0, 1, 2].map(|colour| mode[colour].map(|term| single(term * ratio[colour])));
    modes.kept(&series.counts).flat_map(turned).collect()
}

/// The composite's uniforms.
pub(super) fn uniforms(plan: &Plan, settings: &Settings) -> Composite {
    let rgb = |v: [f64; 3], w: f64| [v[0] as f32, v[1] as f32, v[2] as f32, w as f32];
    let constant = if settings.normalize == Normalize::Minmax { [0.0; 3] } else { settings.constant };
    Composite {
        scale: rgb(plan.units(), 0.0),
        constant: rgb(constant, 0.0),
        light_gain: rgb(settings.light_gain, 1.0),
        luminance: rgb(settings.emission.weights.map(f64::from), settings.threshold),
        strength: settings.strength as f32,
        flat: (2.0 * plan.predicted.single() * plan.scale.iter().fold(0.0, |a: f64, &b| a.max(b))) as f32,
        knee: settings.knee.map_or([0.0; 2], |Knee { threshold, width }| [threshold, width].map(|value| value as f32)),
        overlay: settings.overlay.map(|weights| rgb(weights, 0.0)),
    }
}

pub(super) fn weight(ghost: &Ghost, plan: &Plan) -> [f64; 3] {
    plan::weight(ghost, plan.units())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::evaluators::RUNS;

    #[test]
    fn every_kind_of_bell_has_its_run() {
        let last = Bell::examples().iter().map(Bell::kind).max().unwrap();
        assert!((last as usize) + 1 < RUNS, "`direct` has no run for a bell of kind {last}");
    }
}
