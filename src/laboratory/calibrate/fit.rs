//! From times to constants: each from a pair of arms that differ in its work, round by round.

use std::rc::Rc;

use super::arms::{Arm, Arms, moments, place};
use crate::gpu::Device;
use crate::measure::{Rounds, Samples};
use crate::plan::{CostModel, GRID_PASSES};
use crate::veil::Labour;
use crate::{Error, Result};

/// One constant of the cost model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Constant {
    /// Nanoseconds: the median of the rounds, or the built-in ratio to the others where that told nothing.
    pub value: f64,
    /// From the smallest to the largest of the rounds, in parts of the median; none where it is by ratio.
    pub spread: Option<f64>,
}

/// What was measured, in the order of [`CostModel::NAMES`].
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fitted {
    pub constants: [Constant; CostModel::COUNT],
}

impl Fitted {
    pub fn model(&self) -> CostModel {
        CostModel::from_values(self.constants.map(|constant| constant.value))
    }
}

/// Measures every constant on a device.
///
/// # Errors
/// [`Error::Gl`] where the driver refuses, or where most constants drown in noise.
pub(super) fn measure(device: &Rc<Device>, rounds: Rounds) -> Result<Fitted> {
    let mut arms = Arms::new(device)?;
    let times = arms.time(rounds)?;
    let rounds: Vec<[f64; CostModel::COUNT]> = times.iter().map(|times| constants(&arms.all, times)).collect();
    fitted(&rounds)
}

/// The constants of one round in nanoseconds, from the milliseconds of each arm.
fn constants(arms: &[Arm], times: &[f64]) -> [f64; CostModel::COUNT] {
    use place::*;
    let more = |[low, high]: [usize; 2]| 1e6 * (times[high] - times[low]);
    let terms = |[low, high]: [usize; 2]| arms[high].plan.terms() as f64 - arms[low].plan.terms() as f64;
    let ghosts = |[low, high]: [usize; 2]| arms[high].plan.ghosts() as f64 - arms[low].plan.ghosts() as f64;
    let harmonics = |index: usize| f64::from(arms[index].plan.degree()[0] + 1);
    let nodes = |index: usize| arms[index].plan.lattice().map_or([0.0; 2], |lattice| lattice.nodes.map(f64::from));

    let bell = more(DIRECT) / (arms[DIRECT[0]].pixels() * ghosts(DIRECT));
    let term = more(SERIES) / (arms[SERIES[0]].pixels() * terms(SERIES));
    let term_double = more(SERIES_DOUBLE) / (arms[SERIES_DOUBLE[0]].pixels() * terms(SERIES_DOUBLE));
    let of_rows = |[few, long, wide]: [usize; 3]| {
        let (pixels, rows) = (arms[few].pixels(), arms[few].rows());
        let profile = more([few, long]) / (rows * terms([few, long]));
        let profiles = rows * terms([few, wide]) * profile;
        let harmonic = (more([few, wide]) - profiles) / (pixels * (harmonics(wide) - harmonics(few)));
        (profile, harmonic)
    };
    let of_grid = |[coarse, fine, spread]: [usize; 3], harmonic: f64| {
        let ([columns, lines], [more_columns, _]) = (nodes(coarse), nodes(fine));
        let lattice = lines * (more_columns - columns) * harmonics(fine) * harmonic;
        let strip = (more([coarse, fine]) - lattice) / ((more_columns - columns) * arms[fine].rows());
        // The same lattice under a wider picture, less what a wider picture costs anyway.
        let wider = arms[spread].pixels() - arms[coarse].pixels();
        (strip, (more([coarse, spread]) - more([COPY, COPY_WIDE])) / wider)
    };
    let ((profile, harmonic), (profile_double, harmonic_double)) = (of_rows(ROWS), of_rows(ROWS_DOUBLE));
    let (strip, interpolation) = of_grid(GRID, harmonic);
    let (strip_double, interpolation_double) = of_grid(GRID_DOUBLE, harmonic_double);
    let modes = arms[SPECTRUM[0]].plan.terms() as f64;
    let spectrum = more(SPECTRUM) / (ghosts(SPECTRUM) * modes);
    let moment = more(MOMENTS) / (ghosts(MOMENTS) * moments(&arms[MOMENTS[0]].plan));
    let [one, many, large, spread] = LOCAL;
    let reached = |[low, high]: [usize; 2]| {
        let [low, high] = [low, high].map(|index| arms[index].plan.local().map_or(0.0, |local| local.reached));
        high - low
    };
    // Two sums of both, since not all of the small ones are in the picture.
    let [pixels_of_many, pixels_of_large] = [reached([one, many]), reached([one, large])];
    let [many, large] = [[one, many], [one, large]].map(|pair| (ghosts(pair), more(pair)));
    let determinant = pixels_of_many * large.0 - pixels_of_large * many.0;
    let splat = (many.1 * large.0 - large.1 * many.0) / determinant;
    let quad = (pixels_of_many * large.1 - pixels_of_large * many.1) / determinant;
    let beside = reached([one, spread]) * splat + ghosts([one, spread]) * quad + more([COPY, COPY_WIDE]);
    let canvas = (more([one, spread]) - beside) / (arms[spread].pixels() - arms[one].pixels());
    let pass = 1e6 * times[TINY] / GRID_PASSES;
    let adds = |index: usize| 3.0 * arms[index].pixels() * operations(&arms[index]);
    let veil_add = more(VEIL_BY_CPU) / (adds(VEIL_BY_CPU[1]) - adds(VEIL_BY_CPU[0]));
    let [few, many, wide] = VEIL_BY_DEVICE;
    let [of_few, of_many, of_wide] = [few, many, wide].map(|index| labour(&arms[index]));
    let passes = |one: Labour, other: Labour| (other.passes - one.passes) * pass;
    let veil_tap = (more([few, many]) - passes(of_few, of_many)) / (of_many.taps - of_few.taps);
    let veil_pixel = (more([few, wide]) - (of_wide.taps - of_few.taps) * veil_tap) / (of_wide.moved - of_few.moved);
    let series = [bell, term, harmonic, profile, strip, interpolation, spectrum, moment];
    let local = [splat, quad, canvas];
    let doubles = [term_double, harmonic_double, profile_double, strip_double, interpolation_double];
    let veils = [veil_add, veil_tap, veil_pixel];
    let all = series.into_iter().chain(local).chain(doubles).chain(veils).chain([pass]);
    all.collect::<Vec<_>>().try_into().expect("as many as there are")
}

/// Multiply-adds of an arm's veil, for each pixel and channel.
fn operations(arm: &Arm) -> f64 {
    arm.veil.as_ref().map_or(0.0, |plan| plan.predicted().operations)
}

/// What a device has to do for it.
fn labour(arm: &Arm) -> Labour {
    arm.veil.as_ref().and_then(|plan| Some(plan.on_device()?.labour())).unwrap_or_default()
}

/// The medians of the rounds; what is lost in noise follows the others.
///
/// # Errors
/// [`Error::Gl`] where half of the constants or more are.
fn fitted(rounds: &[[f64; CostModel::COUNT]]) -> Result<Fitted> {
    let built_in = CostModel::default().values();
    let samples: [Samples; CostModel::COUNT] = std::array::from_fn(|k| rounds.iter().map(|round| round[k]).collect());
    let told =
        samples.each_ref().map(|samples| Some(samples.median()).filter(|&value| value.is_finite() && value > 0.0));
    let ratios: Samples =
        told.iter().zip(built_in).filter_map(|(value, built_in)| Some((*value)? / built_in)).collect();
    let count = told.iter().flatten().count();
    if 2 * count <= told.len() {
        return Err(Error::Gl(format!(
            "of {} constants {count} could be told from noise; is the machine busy with something else?",
            told.len()
        )));
    }
    let ratio = ratios.median();
    let constant = |k: usize| match told[k] {
        Some(value) => Constant { value, spread: Some(samples[k].spread()) },
        None => Constant { value: ratio * built_in[k], spread: None },
    };
    Ok(Fitted { constants: std::array::from_fn(constant) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_lost_in_noise_follows_the_others() {
        let built_in = CostModel::default().values();
        let mut round = built_in.map(|value| 0.25 * value);
        round[4] = -1.0;
        let fitted = fitted(&[round, round]).unwrap();
        let [expected, got] = [built_in.map(|value| 0.25 * value), fitted.model().values()];
        assert!(expected.iter().zip(got).all(|(a, b)| (a / b - 1.0).abs() < 1e-12), "{got:?}");
        let scaled: Vec<_> = fitted.constants.iter().map(|constant| constant.spread.is_none()).collect();
        assert!(scaled.iter().enumerate().all(|(k, scaled)| *scaled == (k == 4)), "{scaled:?}");
        assert!(fitted.model().is_sound());
    }

    #[test]
    fn noise_alone_is_no_calibration() {
        let mut round = CostModel::default().values();
        round[..CostModel::COUNT.div_ceil(2)].fill(f64::NAN);
        assert!(fitted(&[round]).is_err());
    }

    #[test]
    fn the_median_of_the_rounds_counts() {
        let built_in = CostModel::default().values();
        let rounds = [1.0, 100.0, 2.0].map(|factor| built_in.map(|value| factor * value));
        assert_eq!(fitted(&rounds).unwrap().model().values(), built_in.map(|value| 2.0 * value));
    }

    /// Times made of known constants give these back.
    #[test]
    fn the_fit_inverts_the_cost_model() {
        let _turn = crate::gpu::tests::turn();
        let device = Device::open(&crate::gpu::Backend::ALL).expect("these tests need GL");
        let arms = Arms::new(&device).unwrap().all;
        let known = CostModel { bell: 3.0, strip: 19.0, interpolation: 11.0, ..CostModel::default() };
        let times: Vec<f64> = arms.iter().enumerate().map(|(k, arm)| expected(&known, k, arm)).collect();
        let found = constants(&arms, &times);
        for ((name, found), known) in CostModel::NAMES.iter().zip(found).zip(known.values()) {
            assert!((found / known - 1.0).abs() < 1e-9, "{name}: {found} for {known}");
        }
    }

    /// Milliseconds of an arm by the cost model, with 4 ns a pixel for a copy or a composite.
    fn expected(model: &CostModel, index: usize, arm: &Arm) -> f64 {
        use place::*;
        let plan = &arm.plan;
        let terms = plan.terms() as f64;
        let harmonics = f64::from(plan.degree()[0] + 1);
        let double = (SERIES_DOUBLE[0]..=GRID_DOUBLE[2]).contains(&index);
        let [term, profile, harmonic, strip, interpolation] = match double {
            false => [model.term, model.profile, model.harmonic, model.strip, model.interpolation],
            true => [
                model.term_double,
                model.profile_double,
                model.harmonic_double,
                model.strip_double,
                model.interpolation_double,
            ],
        };
        let rows = |rows: f64, columns: f64| rows * terms * profile + rows * columns * harmonics * harmonic;
        let base = 4.0 * arm.pixels();
        let nanoseconds = match index {
            COPY | COPY_WIDE => base,
            k if DIRECT.contains(&k) => base + arm.pixels() * plan.ghosts() as f64 * model.bell,
            k if SERIES.contains(&k) || SERIES_DOUBLE.contains(&k) => base + arm.pixels() * terms * term,
            k if ROWS.contains(&k) || ROWS_DOUBLE.contains(&k) => base + rows(arm.rows(), arm.pixels() / arm.rows()),
            k if SPECTRUM.contains(&k) => plan.ghosts() as f64 * terms * model.spectrum,
            k if MOMENTS.contains(&k) => plan.ghosts() as f64 * moments(plan) * model.moment,
            TINY => GRID_PASSES * model.pass,
            k if VEIL_BY_CPU.contains(&k) => base + 3.0 * arm.pixels() * operations(arm) * model.veil_add,
            k if VEIL_BY_DEVICE.contains(&k) => {
                let Labour { taps, passes, moved } = labour(arm);
                taps * model.veil_tap + passes * model.pass + moved * model.veil_pixel
            }
            k if LOCAL.contains(&k) => {
                let ghosts = plan.ghosts() as f64 * model.quad + plan.local().unwrap().reached * model.splat;
                base + ghosts + arm.pixels() * model.canvas
            }
            _ => {
                let [columns, lines] = plan.lattice().unwrap().nodes.map(f64::from);
                base + rows(lines, columns) + columns * arm.rows() * strip + arm.pixels() * interpolation
            }
        };
        1e-6 * nanoseconds
    }
}
