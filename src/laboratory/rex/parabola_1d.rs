//! The notes' first bell (001): the parabola A² − B²(x − t)², zero outside, as a Fourier series of period T.

use std::f64::consts::{PI, TAU};

use super::chart::{Chart, Series, Stroke};
use super::{Figure, Lab, Report, Table};
use crate::series::printed::parabola_kernel_f32;
use crate::series::special::parabola_kernel;
use crate::{Error, Result};

/// The general parabola A² − B²(x − t)² as a Fourier series
///
/// Its series for several degrees, the error against the degree with the bound e, and what the printed coefficients
/// lose in 32 bits where their argument is small.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A: the peak is A²
    #[arg(long, value_name = "A", default_value_t = 1.0)]
    pub a: f64,

    /// B: the half-width is A/B
    #[arg(long, value_name = "B", default_value_t = 1.0)]
    pub b: f64,

    /// t: where the peak stands
    #[arg(long, value_name = "T", default_value_t = 0.5, allow_negative_numbers = true)]
    pub shift: f64,

    /// T: the period; narrower than twice the half-width, copies overlap
    #[arg(long, value_name = "T", default_value_t = 4.0)]
    pub period: f64,

    /// Degrees whose series are drawn
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_values_t = [2, 5, 20],
        value_parser = clap::value_parser!(u32).range(1..=5000))]
    pub degree: Vec<u32>,

    /// Compute the coefficients by the notes' formula, in 32 bits
    #[arg(long)]
    pub as_printed: bool,
}

/// The error is measured up to this degree, or the highest that is drawn.
const HIGHEST: u32 = 200;

/// Runs the experiment.
///
/// # Errors
/// [`Error::Usage`] where a parameter is not positive.
pub fn run(_lab: &mut Lab, args: &Args) -> Result<Report> {
    let parabola = Parabola::new(args)?;
    let mut report = Report::new("The parabola A² − B²(x − t)² in one dimension");
    describe(&mut report, args);
    let highest = args.degree.iter().copied().fold(HIGHEST, u32::max);
    let coefficients: Vec<f64> = (0..=highest)
        .map(|n| if args.as_printed { f64::from(parabola.printed(n)) } else { parabola.coefficient(n) })
        .collect();
    report.figures.push(shape(&parabola, &coefficients, args)?);
    let errors = errors(&parabola, &coefficients);
    report.figures.push(convergence(&parabola, &errors)?);
    report.figures.push(stability()?);
    report.tables.push(degrees(&parabola, &errors, &args.degree));
    measures(&mut report, &parabola, &errors, args);
    Ok(report)
}

fn describe(report: &mut Report, args: &Args) {
    report.say(
        "The prototype's first bell, chosen because its coefficients have a closed form. With h = A/B and q = 2πn/T \
         the mean coefficient is α_n = (4A²h/3T) Φ(qh), Φ(z) = 3 (sin z − z cos z)/z³, and a_n = 2 α_n cos qt, \
         b_n = 2 α_n sin qt.",
    );
    report.say(
        "The parabola has a kink at its foot, so its coefficients fall like 1/n² and the error like 1/N: a smooth bell \
         needs far fewer terms. The printed a_n and b_n are right for n ≥ 1, but they subtract two numbers that \
         become equal as z goes to 0; in 32 bits nothing is left of them below z = 0.001. b_0 as printed is 0/0.",
    );
    for (name, value) in [("A", args.a), ("B", args.b), ("t", args.shift), ("T", args.period)] {
        report.parameter(name, value);
    }
    let degrees: Vec<_> = args.degree.iter().map(u32::to_string).collect();
    report.parameter("degrees drawn", degrees.join(", "));
    report.parameter("coefficients", if args.as_printed { "as printed, f32" } else { "by Φ, f64" });
}

/// A²·max(0, 1 − ((x − t)/h)²), once a period.
struct Parabola {
    a: f64,
    b: f64,
    half: f64,
    shift: f64,
    period: f64,
}

impl Parabola {
    fn new(args: &Args) -> Result<Self> {
        for (name, value) in [("--a", args.a), ("--b", args.b), ("--period", args.period)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(Error::Usage(format!("{name} must be a positive number, not {value}")));
            }
        }
        if !args.shift.is_finite() || args.a / args.b > 100.0 * args.period {
            return Err(Error::Usage("the parabola must be somewhere, and no wider than 200 periods".into()));
        }
        Ok(Self { a: args.a, b: args.b, half: args.a / args.b, shift: args.shift, period: args.period })
    }

    fn peak(&self) -> f64 {
        self.a * self.a
    }

    /// The sum of all copies.
    fn value(&self, x: f64) -> f64 {
        let offset = (x - self.shift).rem_euclid(self.period);
        let copies = (self.half / self.period).ceil() as i32 + 1;
        let one = |j: i32| {
            let u = (offset + f64::from(j) * self.period) / self.half;
            self.peak() * (1.0 - u * u).max(0.0)
        };
        (-copies..=copies).map(one).sum()
    }

    /// α_n.
    fn coefficient(&self, n: u32) -> f64 {
        4.0 * self.peak() * self.half / (3.0 * self.period)
            * parabola_kernel(TAU * f64::from(n) / self.period * self.half)
    }

    /// α_n by the notes' formula (001) in f32, as the prototype's `float`s compute it: a_n and b_n are 2 α_n times cos
    /// and sin of the shift, a_0 is α_0.
    fn printed(&self, n: u32) -> f32 {
        let [a, b, period] = [self.a, self.b, self.period].map(|value| value as f32);
        if n == 0 {
            return 4.0 * a * a * a / (3.0 * b * period);
        }
        let p = 2.0 * std::f32::consts::PI * n as f32 / (b * period);
        4.0 / (b * period) * ((p * a).sin() / (p * p * p) - a * (p * a).cos() / (p * p))
    }

    /// cos nω(x − t), whose phase is reduced before it is scaled.
    fn cosine(&self, n: u32, x: f64) -> f64 {
        (TAU * (f64::from(n) * ((x - self.shift) / self.period)).fract()).cos()
    }

    fn series(&self, coefficients: &[f64], degree: u32, x: f64) -> f64 {
        let term = |n: u32| 2.0 * coefficients[n as usize] * self.cosine(n, x);
        coefficients[0] + (1..=degree).rev().map(term).sum::<f64>()
    }

    /// The bound on the error of degree N: A² times (2T/(π²hN)) (1 + T/(4πhN)) (docs/math.md,
    /// "The parabola of the notes").
    fn bound(&self, degree: u32) -> f64 {
        let ratio = self.period / (self.half * f64::from(degree));
        self.peak() * 2.0 * ratio / (PI * PI) * (1.0 + ratio / (4.0 * PI))
    }
}

/// Φ in f32, by the same series up to 1.5, where five factors are enough for f32.
fn phi_f32(z: f32) -> f32 {
    if z.abs() >= 1.5 {
        return 3.0 * (z.sin() - z * z.cos()) / (z * z * z);
    }
    let square = z * z;
    [130.0, 88.0, 54.0, 28.0, 10.0].iter().fold(1.0, |sum, divisor| 1.0 - square / divisor * sum)
}

/// 3 (sin z/z³ − cos z/z²) as it is printed, in f32.
fn printed_f32(z: f32) -> f32 {
    3.0 * parabola_kernel_f32(z)
}

/// |f/Φ − 1|.
fn relative(f: fn(f32) -> f32, z: f32) -> f64 {
    let truth = parabola_kernel(f64::from(z));
    ((f64::from(f(z)) - truth) / truth).abs()
}

/// The largest relative error within a tenth of `z`.
fn worst_near(f: fn(f32) -> f32, z: f32) -> f64 {
    (-100..=100).map(|i| relative(f, z * (1.0 + 1e-3 * i as f32))).fold(0.0, f64::max)
}

fn shape(parabola: &Parabola, coefficients: &[f64], args: &Args) -> Result<Figure> {
    let from = parabola.shift - 0.75 * parabola.period;
    let ends = [from, from + 1.5 * parabola.period];
    let mut chart = Chart::new("The parabola and its series", "x", "f(x)")
        .with(Series::function("parabola", ends, 1201, |x| parabola.value(x)).colour([120; 3]));
    for (index, &degree) in args.degree.iter().enumerate() {
        let series =
            Series::function(format!("N = {degree}"), ends, 1201, |x| parabola.series(coefficients, degree, x));
        let stroke = [Stroke::Solid, Stroke::Dashed, Stroke::Dotted][index % 3];
        chart = chart.with(series.stroke(stroke).colour(super::chart::COLOURS[index % 6]));
    }
    Figure::chart("series", "One period and a half of the parabola, and its Fourier series cut after degree N.", &chart)
}

/// The largest error of each degree, from 0: at even steps over a period, and close to the kinks, where it is.
fn errors(parabola: &Parabola, coefficients: &[f64]) -> Vec<f64> {
    const STEPS: u32 = 2000;
    let even = (0..STEPS).map(|i| parabola.period * f64::from(i) / f64::from(STEPS));
    let near = (-40..=40).map(|i| 1e-3 * parabola.period * f64::from(i) / 40.0);
    let kinks = near.flat_map(|offset| [parabola.half + offset, offset - parabola.half]);
    let mut worst = vec![0.0_f64; coefficients.len()];
    for x in even.chain(kinks).map(|offset| parabola.shift + offset) {
        let truth = parabola.value(x);
        let mut sum = 0.0;
        for (n, (coefficient, worst)) in (0..).zip(coefficients.iter().zip(&mut worst)) {
            sum += if n == 0 { *coefficient } else { 2.0 * coefficient * parabola.cosine(n, x) };
            let error = (sum - truth).abs();
            // A NaN is the worst there is, and must not be lost.
            *worst = if error.is_nan() || error > *worst { error } else { *worst };
        }
    }
    worst
}

fn convergence(parabola: &Parabola, errors: &[f64]) -> Result<Figure> {
    let degrees = 1..errors.len() as u32;
    let points = |f: &dyn Fn(u32) -> f64| degrees.clone().map(|n| [f64::from(n), f(n)]).collect();
    let chart = Chart::new("Error against degree", "degree N", "largest error over a period")
        .with(Series::new("measured", points(&|n| errors[n as usize])))
        .with(Series::new("bound e", points(&|n| parabola.bound(n))).stroke(Stroke::Dashed))
        .log_x()
        .log_y();
    Figure::chart(
        "error",
        "The largest error over a period against the degree, and the bound e = A² (2T/(π²hN)) (1 + T/(4πhN)).",
        &chart,
    )
}

/// Relative error of the printed coefficient and of Φ in f32 against Φ in f64.
fn stability() -> Result<Figure> {
    let points = |f: fn(f32) -> f32| -> Vec<[f64; 2]> {
        let place = |i: i32| 10f64.powf(f64::from(i) / 60.0) as f32;
        (-300..=28).map(place).map(|z| [f64::from(z), relative(f, z)]).collect()
    };
    let chart = Chart::new("What 32 bits leave of the coefficient", "z = 2πn h / T", "relative error")
        .with(Series::new("as printed: sin z/z³ − cos z/z²", points(printed_f32)))
        .with(Series::new("Φ by its power series below 1.5", points(phi_f32)))
        .log_x()
        .log_y();
    Figure::chart(
        "stability",
        "Relative error of the printed coefficient and of the stable form, both in f32. Small z are low harmonics in a \
         long period: just those that carry the bell. Where a curve has gaps, the error is exactly 0.",
        &chart,
    )
}

fn degrees(parabola: &Parabola, errors: &[f64], degrees: &[u32]) -> Table {
    let mut table = Table::new("degrees", "Error by degree", &["N", "largest error", "bound", "error / bound"]);
    for &degree in degrees.iter().chain([HIGHEST].iter().filter(|highest| !degrees.contains(highest))) {
        let (error, bound) = (errors[degree as usize], parabola.bound(degree));
        table.row([
            degree.to_string(),
            format!("{error:.2e}"),
            format!("{bound:.2e}"),
            format!("{:.2}", error / bound),
        ]);
    }
    table
}

fn measures(report: &mut Report, parabola: &Parabola, errors: &[f64], args: &Args) {
    let shares = (1..errors.len()).map(|n| errors[n] / parabola.bound(n as u32));
    let share = shares.fold(0.0, |worst: f64, share| if share.is_nan() || share > worst { share } else { worst });
    report.measure("largest share of the bound that the error takes", format!("{share:.2}"));
    for &degree in &args.degree {
        report.measure(format!("largest error at N = {degree}"), format!("{:.2e}", errors[degree as usize]));
    }
    for z in [1e-4_f32, 1e-3, 1e-2, 0.1] {
        let what = format!("relative error as printed, f32, the worst within 10 % of z = {z}");
        report.measure(what, format!("{:.1e}", worst_near(printed_f32, z)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parabola(a: f64, b: f64, shift: f64, period: f64) -> Parabola {
        let args = Args { a, b, shift, period, degree: vec![1], as_printed: false };
        Parabola::new(&args).unwrap()
    }

    #[test]
    fn the_printed_coefficients_are_right_from_one_on() {
        for (a, b, period) in [(1.0, 1.0, 2.0), (1.5, 0.5, 10.0), (0.8, 2.0, 4.0)] {
            let parabola = parabola(a, b, 0.3, period);
            for n in 0..20 {
                let (printed, right) = (f64::from(parabola.printed(n)), parabola.coefficient(n));
                assert!((printed - right).abs() < 2e-6 * parabola.coefficient(0), "{n}: {printed} {right}");
            }
        }
    }

    #[test]
    fn the_error_keeps_its_bound_and_the_bound_can_be_broken() {
        let parabola = parabola(1.3, 1.0, 0.2, 5.0);
        let mut coefficients: Vec<f64> = (0..=60).map(|n| parabola.coefficient(n)).collect();
        for (n, error) in errors(&parabola, &coefficients).into_iter().enumerate().skip(1) {
            let share = error / parabola.bound(n as u32);
            assert!((0.2..=1.0).contains(&share), "{n}: {share}");
        }
        coefficients[3] *= 1.5;
        assert!(errors(&parabola, &coefficients)[60] > parabola.bound(60));
    }

    #[test]
    fn copies_overlap_where_the_period_is_short() {
        let parabola = parabola(1.0, 1.0, 0.0, 1.0);
        let coefficients: Vec<f64> = (0..=400).map(|n| parabola.coefficient(n)).collect();
        for x in [0.0, 0.3, 0.77] {
            let (series, value) = (parabola.series(&coefficients, 400, x), parabola.value(x));
            assert!((series - value).abs() < parabola.bound(400), "{x}: {series} {value}");
        }
    }

    #[test]
    fn in_f32_the_printed_form_loses_everything_and_the_stable_one_nothing() {
        assert!(worst_near(printed_f32, 1e-4) > 1.0 && worst_near(printed_f32, 1e-2) > 1e-4);
        for i in 1..300 {
            let z = 0.01 * i as f32;
            assert!(relative(phi_f32, z) < 1e-6, "{z}: {:e}", relative(phi_f32, z));
        }
    }
}
