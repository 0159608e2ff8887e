//! The notes' round bell (000, "fourier-bessel series separability"): A − B r² as a Fourier-Bessel series, made separable
//! by Graf's addition theorem.

use std::time::Instant;

use glam::DVec2;
use rayon::prelude::*;

use super::chart::{Axis, Chart, Map, Scalar, Series, Stroke};
use super::{Field, Figure, Lab, Report, Table};
use crate::frame::Frame;
use crate::renderer::{GrafRenderer, GrafScene};
use crate::scene::Ghost;
use crate::series::Bell;
use crate::series::fourier_bessel::{
    Chain, FourierBessel, Graf, Kappa, Paraboloid, Spot, angular_terms, exact, truncation,
};
use crate::{Error, Result};

mod closed_form;

/// A round paraboloid by Fourier-Bessel series and Graf's theorem
///
/// Two ghosts cut along the line through their centres for the notes' four (N, M), a field of 1024×1024 at
/// N = M = 100, which took the notes 28 minutes, and the same bell by its closed-form spectrum.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A of the bell A − B r²
    #[arg(long, value_name = "A", default_value_t = 1.0)]
    pub a: f64,

    /// B; the bell ends at √(A/B)
    #[arg(long, value_name = "B", default_value_t = 6.25)]
    pub b: f64,

    /// L: the disc about each ghost on which its series holds
    #[arg(long, value_name = "L", default_value_t = 2.0)]
    pub radius: f64,

    /// x of the two ghosts' centres
    #[arg(long, value_name = "X,X", value_delimiter = ',', num_args = 2, default_values_t = [-0.3, 0.4],
        allow_negative_numbers = true)]
    pub x: Vec<f64>,

    /// y of both centres
    #[arg(long, value_name = "Y", default_value_t = 0.2, allow_negative_numbers = true)]
    pub y: f64,

    /// Pixels along each side of the field
    #[arg(long, value_name = "PIXELS", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(16..=4096))]
    pub size: u32,

    /// Take the notes' weights in Graf's sum: 1 for m = 1, 2 beyond, and none for m = 0, where they name none
    #[arg(long)]
    pub as_printed: bool,
}

/// The notes' (N, M).
const CASES: [[u32; 2]; 4] = [[20, 20], [50, 50], [100, 20], [100, 100]];
/// Each ghost's weight in the notes.
const WEIGHT: f64 = 0.5;
/// Places along a cross-section.
const PLACES: u32 = 801;
const RED: [u8; 3] = [200, 30, 30];
const BLUE: [u8; 3] = [30, 60, 200];

/// What all parts of the experiment work on.
struct Setting {
    bell: Paraboloid,
    radius: f64,
    spots: [Spot; 2],
    kappa: Kappa,
}

impl Setting {
    fn new(args: &Args) -> Result<Self> {
        for (name, value) in [("--a", args.a), ("--b", args.b), ("--radius", args.radius)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(Error::Usage(format!("{name} must be a positive number, not {value}")));
            }
        }
        if !args.x.iter().chain([&args.y]).all(|place| place.is_finite()) {
            return Err(Error::Usage("the centres must be somewhere: --x and --y are to be finite".into()));
        }
        let bell = Paraboloid { peak: args.a, curvature: args.b };
        let spot = |x: f64| Spot { center: DVec2::new(x, args.y), weight: WEIGHT };
        let spots = [spot(args.x[0]), spot(args.x[1])];
        // Beyond 2L − ρ from a ghost, the series shows a ring that is not there (docs/math.md, "Fourier-Bessel and Graf").
        let farthest = (spots.iter()).map(|spot| (spot.center.abs() + 1.0).length()).fold(0.0, f64::max);
        if bell.edge() > args.radius || farthest > 2.0 * args.radius - bell.edge() {
            return Err(Error::Usage(format!(
                "the field reaches {farthest:.3} from a ghost, and a disc of --radius {} with a bell of {:.3} allows {:.3}",
                args.radius,
                bell.edge(),
                2.0 * args.radius - bell.edge()
            )));
        }
        let kappa = if args.as_printed { Kappa::Printed { zeroth: 0.0 } } else { Kappa::Right };
        Ok(Self { bell, radius: args.radius, spots, kappa })
    }

    fn exact(&self, at: DVec2) -> f64 {
        exact(self.bell, &self.spots, at)
    }

    /// The same two bells as the renderer takes them.
    fn ghosts(&self) -> Vec<Ghost> {
        let ghost = |spot: &Spot| Ghost {
            bell: Bell::Paraboloid,
            center: spot.center,
            size: DVec2::splat(self.bell.edge()),
            radiance: [spot.weight * self.bell.peak; 3],
        };
        self.spots.iter().map(ghost).collect()
    }

    fn series(&self, terms: u32) -> FourierBessel {
        FourierBessel::new(self.bell, self.radius, terms, Chain::Whole)
    }

    /// What a rendered field, by the index of its pixels, is off by at each of them.
    fn errors(&self, frame: Frame, value: impl Fn(usize) -> f64 + Sync) -> Vec<f64> {
        let width = frame.width as usize;
        let position = |index: usize| frame.position((index % width) as f64, (index / width) as f64);
        let pixels = (0..frame.window.pixels()).into_par_iter();
        pixels.map(|index| value(index) - self.exact(position(index))).collect()
    }

    /// M that Graf's sum needs for N terms and an error of 1e-3.
    fn needed(&self, series: &FourierBessel) -> u32 {
        let reach = self.spots.iter().map(|spot| spot.center.length()).fold(0.0, f64::max);
        let fastest = series.terms.last().map_or(0.0, |term| term.alpha);
        angular_terms(fastest * reach / self.radius, 1e-3)
    }
}

/// A field on the device: how long it took and how far it is off.
struct Measured {
    /// Seconds with every table built anew, shaders compiled before: the best of some.
    seconds: f64,
    /// The largest error, in parts of A.
    error: f64,
}

/// How often a field is timed after a first time, which compiles shaders.
const LATER: usize = 3;

/// Runs the experiment.
///
/// # Errors
/// [`Error::Usage`] where the field reaches beyond what the series hold for, [`Error::NoContext`] and [`Error::Gl`]
/// from the device.
pub fn run(lab: &mut Lab, args: &Args) -> Result<Report> {
    let setting = Setting::new(args)?;
    let mut report = Report::new("The paraboloid A − B r² by Fourier-Bessel series and Graf's theorem");
    describe(&mut report, args);
    let mut errors = Table::new(
        "sections",
        "Largest error along the cross-section, in parts of the peak A",
        &["N", "M", "M needed", "Graf", "not separated", "law 2AL/(π²ρN) × weight"],
    );
    for case in CASES {
        let (figure, row) = section(&setting, case)?;
        report.figures.push(figure);
        errors.row(row);
    }
    report.tables.push(errors);
    let graf = field(&mut report, lab, &setting, args.size)?;
    report.tables.push(closed_form::sections(&setting));
    report.tables.push(closed_form::fields(lab, &setting, args.size, &graf)?);
    Ok(report)
}

fn describe(report: &mut Report, args: &Args) {
    report.say(
        "A bell with a round floor is no product of a function of x and one of y, so the notes expand it in Bessel \
         functions about its own centre, Σ_k a_k J_0(α_k r/L), and separate the ghosts by Graf's theorem: \
         J_0(|r − dr|) = Σ_m κ_m J_m(r) J_m(dr) cos mθ, κ_0 = 1 and κ_m = 2 beyond. The notes draw the sum itself in \
         black, Graf's form in dashed red, the series without separation in dashed blue.",
    );
    report.say(
        "Red leaves blue where M is too small for the farthest ghost: M must reach α_N d/L and some more. The kink at \
         the edge makes both of them off by 2AL/(π²ρN). The notes' weights, 1 for m = 1 and 2 beyond, give another \
         field altogether (--as-printed).",
    );
    report.say(
        "The closed-form two-dimensional spectrum of the same bell converges at the same rate, N' = N T/(2L) at equal \
         error; it shifts exactly, needs no disc and no Bessel function beyond its table; by `grid` it is also the faster one.",
    );
    for (name, value) in [("A", args.a), ("B", args.b), ("L", args.radius), ("x₁", args.x[0]), ("x₂", args.x[1])] {
        report.parameter(name, value);
    }
    report.parameter("y of both", args.y);
    report.parameter("weight of each", WEIGHT);
    report.parameter("κ", if args.as_printed { "as printed, nothing for m = 0" } else { "1, 2, 2, …" });
}

/// The three curves along y = dy, and what they are off by.
fn section(setting: &Setting, [terms, highest]: [u32; 2]) -> Result<(Figure, Vec<String>)> {
    let series = setting.series(terms);
    let graf = Graf::new(&series, &setting.spots, highest, setting.kappa);
    let y = setting.spots[0].center.y;
    let places: Vec<f64> = (0..PLACES).map(|index| -1.0 + 2.0 * f64::from(index) / f64::from(PLACES - 1)).collect();
    let curve = |f: &(dyn Fn(DVec2) -> f64 + Sync)| -> Vec<[f64; 2]> {
        places.par_iter().map(|&x| [x, f(DVec2::new(x, y))]).collect()
    };
    let truth = curve(&|at| setting.exact(at));
    let separated = curve(&|at| graf.value(at));
    let unseparated = curve(&|at| series.unseparated(&setting.spots, at));
    let off = |curve: &[[f64; 2]]| {
        let errors = curve.iter().zip(&truth).map(|(a, b)| (a[1] - b[1]).abs());
        errors.fold(0.0, f64::max) / setting.bell.peak
    };
    let law = WEIGHT * truncation(setting.bell, setting.radius, terms) / setting.bell.peak;
    let row = vec![
        terms.to_string(),
        highest.to_string(),
        setting.needed(&series).to_string(),
        format!("{:.2e}", off(&separated)),
        format!("{:.2e}", off(&unseparated)),
        format!("{law:.2e}"),
    ];
    let chart = Chart::new(format!("N = {terms}, M = {highest}"), "x", format!("field at y = {y}"))
        .with(Series::new("sum of the bells", truth).colour([0; 3]))
        .with(Series::new("Graf", separated).stroke(Stroke::Dashed).colour(RED))
        .with(Series::new("not separated", unseparated).stroke(Stroke::Dashed).colour(BLUE));
    let caption =
        format!("Two ghosts of weight {WEIGHT}, cut through both centres, with {terms} zeros and {highest} orders.");
    Ok((Figure::chart(format!("section-{terms}-{highest}"), caption, &chart)?, row))
}

/// The whole field at the notes' largest N and M on the device, with its time and its error at every pixel.
fn field(report: &mut Report, lab: &mut Lab, setting: &Setting, size: u32) -> Result<Measured> {
    let [terms, highest] = CASES[CASES.len() - 1];
    let (series, frame) = (setting.series(terms), Frame::full(size, size));
    let scene = GrafScene { series: &series, spots: &setting.spots, highest, kappa: setting.kappa };
    let mut renderer = GrafRenderer::new(&lab.device()?)?;
    let (first, seconds, pixels) = timed(|| renderer.render(&scene, frame))?;
    let errors = setting.errors(frame, |index| pixels[index].into());
    let error = largest(&errors) / setting.bell.peak;
    let what = format!("{size}×{size} field, N = M = {highest}");
    report.measure(format!("{what}: all tables and the picture, first time, with shaders to compile"), time(first));
    report.measure(format!("{what}: the same again, best of {LATER}"), time(seconds));
    report.measure("the notes' time for N = M = 100", "28 min in Colab; they do not say how large the picture was");
    report.measure(format!("{what}: largest error, in parts of A"), format!("{error:.2e}"));
    let rounding = rounding(setting, &series, highest, &pixels, frame);
    report.measure("against Graf's form in f64, in parts of A", format!("{rounding:.1e}"));
    report.tables.push(passes(&mut renderer, &scene, frame)?);
    report.figures.extend(pictures(&pixels, errors, size)?);
    Ok(Measured { seconds, error })
}

/// Seconds of the first time and the best of the later ones, and what came of the last.
fn timed<T>(mut render: impl FnMut() -> Result<T>) -> Result<(f64, f64, T)> {
    let mut once = || {
        let started = Instant::now();
        let result = render()?;
        Ok::<_, Error>((started.elapsed().as_secs_f64(), result))
    };
    let (first, mut result) = once()?;
    let mut best = f64::INFINITY;
    for _ in 0..LATER {
        let (seconds, latest) = once()?;
        best = best.min(seconds);
        result = latest;
    }
    Ok((first, best, result))
}

fn time(seconds: f64) -> String {
    format!("{seconds:.3} s")
}

fn largest(errors: &[f64]) -> f64 {
    errors.iter().fold(0.0, |worst: f64, error| if error.is_nan() { f64::NAN } else { worst.max(error.abs()) })
}

/// The field and its error in false colours.
fn pictures(pixels: &[f32], errors: Vec<f64>, size: u32) -> Result<[Figure; 2]> {
    let side = |label: &str| Axis { label: label.into(), range: Some([-1.0, 1.0]), ..Axis::default() };
    let axes = [side("x"), side("y")];
    let grey = pixels.iter().map(|&value| [value, value, value, 1.0]).collect();
    let linear = Field { width: size, height: size, pixels: grey };
    let values = Scalar { width: size, height: size, values: pixels.iter().map(|&value| value.into()).collect() };
    let value = Axis { label: "field".into(), ..Axis::default() };
    let field = values.chart("Graf's form on the device", axes.clone(), value, Map::Inferno, 512);
    let end = largest(&errors);
    let difference = Axis { label: "field − sum of the bells".into(), range: Some([-end, end]), ..Axis::default() };
    let errors = Scalar { width: size, height: size, values: errors };
    let error = errors.chart("Its error", axes, difference, Map::RedBlue, 512);
    Ok([
        Figure::chart("field", "The field on the device, with N = M = 100.", &field)?.field(linear),
        Figure::chart("field-error", "What it is off by, against the bells themselves.", &error)?,
    ])
}

/// The largest difference between the device and Graf's form in f64, at a lattice of pixels.
fn rounding(setting: &Setting, series: &FourierBessel, highest: u32, pixels: &[f32], frame: Frame) -> f64 {
    const SIDE: u32 = 24;
    let graf = Graf::new(series, &setting.spots, highest, setting.kappa);
    let difference = |index: u32| {
        let pixel = |place: u32, length: u32| place * (length - 1) / (SIDE - 1);
        let (i, j) = (pixel(index % SIDE, frame.width), pixel(index / SIDE, frame.height));
        let got = f64::from(pixels[(j * frame.width + i) as usize]);
        (got - graf.value(frame.position(i.into(), j.into()))).abs()
    };
    (0..SIDE * SIDE).into_par_iter().map(difference).reduce(|| 0.0, f64::max) / setting.bell.peak
}

fn passes(renderer: &mut GrafRenderer, scene: &GrafScene<'_>, frame: Frame) -> Result<Table> {
    renderer.set_timing(true);
    renderer.render(scene, frame)?;
    renderer.set_timing(false);
    let mut table = Table::new("passes", "Where the time goes, pass after pass", &["pass", "ms"]);
    for time in renderer.take_times() {
        table.row([time.pass, format!("{:.1}", time.wall_ms)]);
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn args() -> Args {
        Args { a: 1.0, b: 6.25, radius: 2.0, x: vec![-0.3, 0.4], y: 0.2, size: 64, as_printed: false }
    }

    fn errors(args: &Args, case: [u32; 2]) -> [f64; 3] {
        let (_, row) = section(&Setting::new(args).unwrap(), case).unwrap();
        [3, 4, 5].map(|column| row[column].parse().unwrap())
    }

    #[test]
    fn enough_orders_leave_the_law_and_too_few_do_not() {
        let [graf, unseparated, law] = errors(&args(), [100, 100]);
        assert!((graf / unseparated - 1.0).abs() < 0.05 && unseparated < 1.3 * law, "{graf} {unseparated} {law}");
        let [graf, unseparated, _] = errors(&args(), [100, 20]);
        assert!(graf > 1.3 * unseparated, "{graf} {unseparated}");
        let [graf, unseparated, _] = errors(&Args { as_printed: true, ..args() }, [50, 50]);
        assert!(graf > 10.0 * unseparated, "{graf} {unseparated}");
    }

    #[test]
    fn a_field_beyond_the_disc_is_refused() {
        assert!(Setting::new(&Args { radius: 0.9, ..args() }).is_err());
        assert!(Setting::new(&Args { x: vec![0.0, f64::NAN], ..args() }).is_err());
        assert!(Setting::new(&Args { b: 0.0, ..args() }).is_err());
    }
}
