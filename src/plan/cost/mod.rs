//! What an evaluator costs: a handful of constants, one for each kind of work.

mod model;

use glam::DVec2;

use super::{Evaluator, Group, Lattice, Layer, Precision, Series, Transform, block_shift, gather};
use crate::frame::Frame;
use crate::series::Bell;

pub use model::CostModel;

/// What one evaluator is expected to cost.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Cost {
    /// The evaluator.
    pub evaluator: Evaluator,
    /// Ghosts that are summed directly at every pixel: all of them by `direct`, a few or none beside other layers.
    pub summed: usize,
    /// Ghosts that are summed where they reach: all of them by `local`, some or none beside other layers.
    pub reaching: usize,
    /// Milliseconds for spectrum and field on the machine that the cost model was measured on.
    pub milliseconds: f64,
}

impl Cost {
    /// The ghosts that are not computed by the evaluator, in words; none, where it has all of them.
    pub fn beside(&self) -> Option<String> {
        let mut words = Vec::new();
        if self.evaluator != Evaluator::Local && self.reaching > 0 {
            words.push(format!("{} summed where they reach", self.reaching));
        }
        if self.evaluator != Evaluator::Direct && self.summed > 0 {
            words.push(format!("{} summed at every pixel", self.summed));
        }
        (!words.is_empty()).then(|| words.join(" and "))
    }
}

/// The cost of layers, by the name of their series where there is one.
pub(super) fn estimate(layers: &[Layer], precision: Precision, frame: Frame, model: &CostModel) -> Cost {
    let ghosts = |evaluator: Evaluator| {
        let mine = layers.iter().filter(|layer| layer.evaluator() == evaluator);
        mine.flat_map(Layer::groups).map(|group| group.ghosts).sum()
    };
    let one = |layer: &Layer| match layer {
        Layer::Direct(groups) if layers.len() == 1 => direct(groups, precision, frame, model) + model.pass,
        // Beside a series it is no pass of its own.
        Layer::Direct(groups) => direct(groups, precision, frame, model),
        Layer::Local(layer) => {
            let beside = layers.len() > 1 && layer.precision == Precision::Double;
            let canvas = if beside { doubles_canvas(frame, model) } else { 0.0 };
            local(&layer.groups, layer.reached, layer.precision, frame, model) + canvas
        }
        // By the CPU's cores, as veils are.
        Layer::Plate(plate) => plate.nanoseconds * PLATE * model.veil_add,
        Layer::Series(series) => {
            spectrum(series, model) + field(series.evaluator, series.precision, &Size::of(series), frame, model)
        }
    };
    let evaluator = layers.first().map_or(Evaluator::Direct, Layer::evaluator);
    let nanoseconds: f64 = layers.iter().map(one).sum();
    let (summed, reaching) = (ghosts(Evaluator::Direct), ghosts(Evaluator::Local));
    Cost { evaluator, summed, reaching, milliseconds: nanoseconds * 1e-6 }
}

/// What the spectrum of a series costs, in nanoseconds.
fn spectrum(series: &Series, model: &CostModel) -> f64 {
    let one = |group: &Group| match (&group.transform, &series.modes) {
        (Transform::Dispatch, Some(_)) => gather::looked_at(group),
        (transform, _) => gather::cost(group, transform, model),
    };
    series.groups.iter().map(one).sum()
}

/// What a plate's nanoseconds of one core take two of our day, over a multiply-add of theirs.
const PLATE: f64 = 0.5 / 0.06;

/// What of a series its field's cost depends on.
pub(super) struct Size {
    pub terms: f64,
    pub degree: [u32; 2],
    /// Of the lattice, where there is one; and how many of them make a period.
    pub nodes: [f64; 2],
    pub around: [f64; 2],
    /// Whether the CPU sums the series at them.
    pub on_cpu: bool,
}

impl Size {
    fn of(series: &Series) -> Self {
        Self {
            terms: series.terms() as f64,
            degree: series.degree(),
            nodes: series.lattice.map_or([0.0; 2], |lattice| lattice.nodes.map(f64::from)),
            around: series.lattice.map_or([0.0; 2], |lattice| (series.period / lattice.step).to_array()),
            on_cpu: series.lattice.is_some_and(|lattice| lattice.on_cpu),
        }
    }
}

/// What the field of a series costs with all the passes that it takes, in nanoseconds.
pub(super) fn field(evaluator: Evaluator, precision: Precision, size: &Size, frame: Frame, model: &CostModel) -> f64 {
    let model = &model.in_floats(precision);
    let window = frame.window;
    let pixels = window.pixels() as f64;
    let rows = |rows: f64, columns: f64| {
        rows * size.terms * model.profile
            + rows * columns * (f64::from(size.degree[0] + 1) + AROUND_HARMONICS) * model.harmonic
    };
    match evaluator {
        Evaluator::Direct | Evaluator::Local | Evaluator::Plate => 0.0,
        Evaluator::Series => pixels * size.terms * model.term + 4.0 * model.pass,
        Evaluator::Rows => rows(f64::from(window.height), f64::from(window.width)) + 5.0 * model.pass,
        Evaluator::Grid => {
            let [columns, lines] = size.nodes;
            let strips = columns * f64::from(window.height) * model.strip;
            let summed = if size.on_cpu { by_cpu(size, model) } else { rows(lines, columns) };
            summed + strips + pixels * model.interpolation + GRID_PASSES * model.pass
        }
    }
}

/// What it takes the CPU's cores to transform a series to the nodes of a lattice, in nanoseconds.
fn by_cpu(size: &Size, model: &CostModel) -> f64 {
    // Multiply-adds for each node of a period and each time that it can be halved, of three colours.
    const DOWN: f64 = 15.0;
    const ACROSS: f64 = 7.5;
    // Bringing the terms from the device, and the values to it.
    const TERM: f64 = 10.0;
    const NODE: f64 = 15.0;
    let Size { terms, nodes: [columns, rows], around, .. } = *size;
    let [across, down] = around.map(|around| around * around.max(2.0).log2());
    let added = DOWN * f64::from(size.degree[0] + 1) * down + ACROSS * rows * across;
    added * model.veil_add + TERM * terms + NODE * rows * columns + model.pass
}

impl Size {
    /// The same, the nodes' values by the CPU's cores where these are sooner done than the device.
    pub fn sooner(self, model: &CostModel) -> Self {
        let [columns, rows] = self.nodes;
        let device = rows * self.terms * model.profile
            + rows * columns * (f64::from(self.degree[0] + 1) + AROUND_HARMONICS) * model.harmonic;
        Self { on_cpu: by_cpu(&self, model) < device, ..self }
    }
}

/// Whether the CPU's cores are sooner done with a lattice than the device.
pub(super) fn cpu_is_cheaper(counts: &[u32], lattice: &Lattice, period: DVec2, model: &CostModel) -> bool {
    let size = Size {
        terms: counts.iter().map(|&count| f64::from(count)).sum(),
        degree: [counts.len() as u32 - 1, counts[0] - 1],
        nodes: lattice.nodes.map(f64::from),
        around: (period / lattice.step).to_array(),
        on_cpu: false,
    };
    size.sooner(model).on_cpu
}

/// What a series costs at least, whatever its terms, in milliseconds.
pub(super) fn least(evaluator: Evaluator, frame: Frame, model: &CostModel) -> f64 {
    const FEWEST_NODES: f64 = 4.0;
    1e-6 * field(
        evaluator,
        Precision::Single,
        &Size { terms: 1.0, degree: [0; 2], nodes: [FEWEST_NODES; 2], around: [FEWEST_NODES; 2], on_cpu: false },
        frame,
        model,
    )
}

/// What summing these ghosts at every pixel costs, in nanoseconds.
pub(super) fn direct<'a>(
    groups: impl IntoIterator<Item = &'a Group>,
    precision: Precision,
    frame: Frame,
    model: &CostModel,
) -> f64 {
    let mut summed = Summed::default();
    groups.into_iter().for_each(|group| summed.add(group, precision));
    summed.nanoseconds(frame, model)
}

/// Ghosts that are summed at every pixel.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Summed {
    ghosts: usize,
    /// In Gaussians of 32-bit floats.
    bells: f64,
    /// What its loops take to end, in the same; and of which kinds of bells there is one.
    loops: f64,
    kinds: u32,
}

impl Summed {
    pub fn add(&mut self, group: &Group, precision: Precision) {
        let (bell, kind) = (in_gaussians(&group.bell, precision), 1 << group.bell.kind());
        self.ghosts += group.ghosts;
        self.bells += group.ghosts as f64 * bell;
        if self.kinds & kind == 0 {
            self.kinds |= kind;
            self.loops += ENDING * bell;
        }
    }

    /// What they cost.
    pub fn nanoseconds(&self, frame: Frame, model: &CostModel) -> f64 {
        frame.window.pixels() as f64 * (self.bells * slower(self.ghosts) + self.loops + AROUND_BELLS) * model.bell
    }
}

/// How many times as long as a Gaussian in 32-bit floats a bell takes at a pixel: on llvmpipe, 28 and 280 of them.
fn in_gaussians(bell: &Bell, precision: Precision) -> f64 {
    let [single, double] = match bell {
        Bell::Gaussian => [1.0, 3.0],
        Bell::CosineSquared => [1.4, 2.5],
        Bell::Parabola => [1.05, 1.7],
        Bell::Paraboloid => [1.0, 1.3],
        Bell::VonMises(_) | Bell::SineGaussian(_) => [2.5, 5.5],
        // A row is looked for.
        Bell::Profile(_) => [7.5, 7.5],
        Bell::Disc(disc) if disc.is_round() => [1.5, 2.5],
        // Three rows of a table are read.
        Bell::Disc(_) => [5.0, 7.5],
        // An exponential for each side.
        Bell::Iris(iris) if iris.is_round() && iris.cuts().is_empty() => [2.0, 4.0],
        Bell::Iris(iris) => [2.0, 4.0].map(|one| 1.0 + one * iris.steps() as f64),
    };
    if precision == Precision::Single { single } else { double }
}

/// What drawing ghosts where they reach so many pixels in all costs, in nanoseconds.
pub(super) fn local<'a>(
    groups: impl IntoIterator<Item = &'a Group>,
    reached: f64,
    precision: Precision,
    frame: Frame,
    model: &CostModel,
) -> f64 {
    let (mut ghosts, mut bells) = (0.0, 0.0);
    for group in groups {
        ghosts += group.ghosts as f64;
        bells += group.ghosts as f64 * in_gaussians(&group.bell, precision);
    }
    let pixels = frame.window.pixels() as f64;
    let canvas = pixels * model.canvas + 2.0 * model.pass + ghosts * model.quad;
    if ghosts == 0.0 {
        return canvas;
    }
    match precision {
        Precision::Single => reached * splat(bells / ghosts, model) + canvas,
        Precision::Double => listed(ghosts, reached.min(ghosts * pixels), bells / ghosts, model) + canvas,
    }
}

/// What it costs in nanoseconds that a canvas is one of doubles, and read beside other layers.
pub(super) fn doubles_canvas(frame: Frame, model: &CostModel) -> f64 {
    const CANVASES: f64 = 3.0;
    CANVASES * frame.window.pixels() as f64 * model.canvas
}

/// What ghosts of so many Gaussians each cost in lists of blocks, which hold some that they hardly reach.
fn listed(ghosts: f64, reached: f64, bell: f64, model: &CostModel) -> f64 {
    let side = (reached / ghosts.max(1.0)).sqrt();
    let side = side + f64::from((1u32 << block_shift(side)) - 1);
    ghosts * side * side * model.bell * LISTED * bell / in_gaussians(&Bell::Gaussian, Precision::Double)
}

/// What a bell costs that is drawn at one pixel, of as many Gaussians.
fn splat(in_gaussians: f64, model: &CostModel) -> f64 {
    model.splat + (in_gaussians - 1.0) * model.bell
}

/// What a group that reaches so many pixels adds to a local layer, in nanoseconds.
pub(super) fn reaching(group: &Group, reached: f64, floats: Precision, model: &CostModel) -> f64 {
    let bells = match floats {
        Precision::Single => reached * splat(in_gaussians(&group.bell, floats), model),
        Precision::Double => listed(group.ghosts as f64, reached, in_gaussians(&group.bell, floats), model),
    };
    group.ghosts as f64 * model.quad + bells
}

/// How many times as long as by `direct` a bell takes in 64-bit floats where it comes from a list, a Gaussian: 5 to 7
/// on llvmpipe.
const LISTED: f64 = 6.0;

/// What `direct` does at a pixel beside its bells, in Gaussians; and how many bells of each kind a loop computes until it ends: on
/// llvmpipe, which goes once through each of two loops that have nothing to do, for 2 to 8 ghosts.
const AROUND_BELLS: f64 = 3.0;
const ENDING: f64 = 2.0;

/// What a row's pixel takes beside its harmonics, in harmonics: on llvmpipe, by `rows` of degree 2 to 12.
const AROUND_HARMONICS: f64 = 1.5;

/// How many times as long `direct` takes for a bell where there are more ghosts than a uniform block holds: 3 to 5 times
/// on llvmpipe, and a graphics card has other reasons to take the series then.
fn slower(ghosts: usize) -> f64 {
    const FEW: usize = 2048;
    if ghosts > FEW { 4.0 } else { 1.0 }
}

/// Passes that spectrum and field take by `grid`.
pub const GRID_PASSES: f64 = 7.0;
