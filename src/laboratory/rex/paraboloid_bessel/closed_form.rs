//! The same bell by its two-dimensional Fourier series: no Bessel function at any pixel, and no disc.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use rayon::prelude::*;

use super::super::{Lab, Table};
use super::{CASES, Measured, PLACES, Setting, WEIGHT, largest, timed};
use crate::Result;
use crate::frame::Frame;
use crate::plan::{Evaluator, Request, plan};
use crate::problem::Problem;
use crate::renderer::{Picture, Settings};
use crate::series::fourier_bessel::truncation;
use crate::series::{kappa, special};

/// E_nm = κ_nm ĝ(q)/T², ĝ(q) = (πAρ²/2) 8J_2(qρ)/(qρ)², q = 2π|(n, m)|/T, for n, m = 0 ..= N, and the series
/// Σ E_nm cos nω(x − x_k) cos mω(y − y_k) (docs/math.md, "Paraboloid").
struct ClosedForm {
    period: f64,
    degree: u32,
    coefficients: Vec<f64>,
}

impl ClosedForm {
    fn new(setting: &Setting, period: f64, degree: u32) -> Self {
        let edge = setting.bell.edge();
        let volume = 0.5 * PI * setting.bell.peak * edge * edge;
        let side = degree + 1;
        let coefficient = |index: u32| {
            let (n, m) = (index / side, index % side);
            let z = TAU / period * f64::from(n).hypot(f64::from(m)) * edge;
            kappa(n, m) * volume / (period * period) * special::paraboloid_kernel(z)
        };
        Self { period, degree, coefficients: (0..side * side).map(coefficient).collect() }
    }

    fn value(&self, offset: DVec2) -> f64 {
        let cosines = |x: f64| -> Vec<f64> {
            (0..=self.degree).map(|n| (TAU * (f64::from(n) * (x / self.period)).fract()).cos()).collect()
        };
        let (x, y) = (cosines(offset.x), cosines(offset.y));
        let row = |(row, x): (&[f64], &f64)| x * row.iter().zip(&y).map(|(a, b)| a * b).sum::<f64>();
        self.coefficients.chunks_exact(y.len()).zip(&x).map(row).sum()
    }
}

/// A period that keeps every copy out of the picture: a ghost's distance to the farthest border, and the bell's reach.
fn period(setting: &Setting) -> f64 {
    let farthest = setting.spots.iter().map(|spot| spot.center.abs().max_element() + 1.0).fold(0.0, f64::max);
    farthest + setting.bell.edge()
}

/// The degree whose error is that of so many Bessel terms: AT/(π²ρN') = 2AL/(π²ρN), so N' = N T/(2L) (docs/math.md,
/// sections 4.1 and 9).
fn degree(setting: &Setting, terms: u32) -> u32 {
    (f64::from(terms) * period(setting) / (2.0 * setting.radius)).ceil() as u32
}

/// In f64 along the cross-section, for each N of the notes.
pub(super) fn sections(setting: &Setting) -> Table {
    let mut table = Table::new(
        "closed-form",
        "The closed form E = κ 4πA J_2(qρ)/(q² T²) at the error of N Bessel terms, along the cross-section",
        &["N of the Bessel series", "degree N' of the closed form", "largest error, parts of A", "law for N"],
    );
    for &[terms, _] in CASES.iter().filter(|[terms, highest]| terms == highest) {
        let degree = degree(setting, terms);
        let closed = ClosedForm::new(setting, period(setting), degree);
        let y = setting.spots[0].center.y;
        let error = |index: u32| {
            let at = DVec2::new(-1.0 + 2.0 * f64::from(index) / f64::from(PLACES - 1), y);
            let sum: f64 = setting.spots.iter().map(|spot| spot.weight * closed.value(at - spot.center)).sum();
            (sum - setting.exact(at)).abs()
        };
        let largest = (0..PLACES).into_par_iter().map(error).reduce(|| 0.0, f64::max) / setting.bell.peak;
        let law = WEIGHT * truncation(setting.bell, setting.radius, terms) / setting.bell.peak;
        table.row([terms.to_string(), degree.to_string(), format!("{largest:.2e}"), format!("{law:.2e}")]);
    }
    table
}

/// The whole field on the device: Graf's form, and the closed form at the same error by `rows` and by `grid`.
pub(super) fn fields(lab: &mut Lab, setting: &Setting, size: u32, graf: &Measured) -> Result<Table> {
    let mut table = Table::new(
        "fields",
        "The field on the device at equal error: tables and picture, shaders compiled before. Graf's form has one colour \
         here and sums one quadrant for all four; the closed form has three colours and every pixel",
        &["how", "terms", "largest error, parts of A", "seconds", "times as fast as Graf's form"],
    );
    let [terms, highest] = CASES[CASES.len() - 1];
    let mut row = |how: String, terms: u32, error: f64, seconds: f64| {
        let ratio = graf.seconds / seconds;
        table.row([how, terms.to_string(), format!("{error:.2e}"), format!("{seconds:.3}"), format!("{ratio:.1}")]);
    };
    row("Graf's form".into(), terms * (highest + 1), graf.error, graf.seconds);
    let (frame, degree, period) = (Frame::full(size, size), degree(setting, terms), period(setting));
    let problem = Problem::new(setting.ghosts(), frame);
    let mut renderer = Picture::new(&lab.device()?)?;
    for evaluator in [Evaluator::Rows, Evaluator::Grid] {
        let request = Request {
            period: Some(DVec2::splat(period)),
            degree: Some([degree; 2]),
            evaluator: Some(evaluator),
            // For the lattice: finer than the series is off by anyway.
            ..Request::new(graf.error)
        };
        let plan = plan(&problem, &request)?;
        let (_, seconds, pixels) = timed(|| {
            renderer.field.forget_scene();
            renderer.field.set_scene(&plan)?;
            renderer.glare(frame, &Settings::default())
        })?;
        let errors = setting.errors(frame, |index| pixels[index][0].into());
        let error = largest(&errors) / setting.bell.peak;
        row(format!("closed form of degree {degree}, by {evaluator}"), plan.terms() as u32, error, seconds);
    }
    Ok(table)
}
