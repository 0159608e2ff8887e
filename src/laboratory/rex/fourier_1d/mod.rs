//! The notes' sum of two periodic Gaussians from the coefficients of each (002), computed on the CPU.

mod bells;
mod figures;

pub(super) use bells::{Bells, Kind, PERIOD, largest};
pub(super) use figures::{Curve, drawn};

use super::chart::COLOURS;
use super::{Lab, Report, Table};
use crate::series::numeric::{Coefficients, Rule, Slips};
use crate::{Error, Result};

/// Two periodic Gaussians summed through their coefficients, on the CPU
///
/// Samples each function, computes the coefficients of both, adds them up, and draws the series of the sum as the
/// prototype's plug-in does; before and after the means move.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    #[command(flatten)]
    pub common: Common,
}

/// The parameters of the experiments on the CPU and on the GPU.
#[derive(Debug, Clone, clap::Args)]
pub struct Common {
    /// μ of each bell
    #[arg(long, value_name = "μ,…", value_delimiter = ',', default_values_t = [0.5, 0.0], allow_negative_numbers = true)]
    pub mean: Vec<f64>,

    /// μ of each bell after it has moved
    #[arg(long, value_name = "μ,…", value_delimiter = ',', default_values_t = [0.4, 0.15], allow_negative_numbers = true)]
    pub moved: Vec<f64>,

    /// Weight of each bell
    #[arg(long, value_name = "W,…", value_delimiter = ',', default_values_t = [1.0, 0.5], allow_negative_numbers = true)]
    pub weight: Vec<f64>,

    /// σ of the bells
    #[arg(long, value_name = "σ", default_value_t = 0.1)]
    pub sigma: f64,

    /// The notes' degree
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=500))]
    pub degree: u32,

    /// A degree at which the series has converged
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=500))]
    pub converged: u32,

    /// Samples of each bell; by default 100 for each of the notes' degree
    #[arg(long, value_name = "M", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub samples: Option<u32>,

    /// Add what the plug-ins compute: all of their slips
    #[arg(long)]
    pub as_printed: bool,

    /// Add what some of the slips give
    #[arg(long, value_enum, value_delimiter = ',', conflicts_with = "as_printed")]
    pub slip: Vec<Slip>,
}

/// One of the plug-ins' slips.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Slip {
    /// Samples of (-1, 1) are integrated as if they covered (-T, T)
    Interval,
    /// The integral over two periods is divided by one
    Twice,
    /// The period is π instead of 2π
    HalfPeriod,
}

impl Common {
    /// The bells before or after the move.
    ///
    /// # Errors
    /// [`Error::Usage`] where the lists differ in length, a number makes no bell, or the samples are too few.
    pub(super) fn bells(&self, means: &[f64]) -> Result<Bells> {
        if means.len() != self.weight.len() || means.is_empty() {
            return Err(Error::Usage("--mean, --moved and --weight need as many numbers each, at least one".into()));
        }
        let finite = means.iter().chain(&self.weight).chain([&self.sigma]).all(|value| value.is_finite());
        if !finite || self.sigma < 1e-3 {
            return Err(Error::Usage("--sigma must be at least 0.001, and every number finite".into()));
        }
        let samples = self.rule(Slips::default()).samples;
        let highest = self.degree.max(self.converged);
        if samples <= 2 * highest {
            return Err(Error::Usage(format!("{samples} samples are too few for a degree of {highest}")));
        }
        let bells = means.iter().zip(&self.weight).map(|(&mean, &weight)| [mean, weight]).collect();
        Ok(Bells { kind: Kind::Sine, sigma: self.sigma, bells })
    }

    pub(super) fn rule(&self, slips: Slips) -> Rule {
        let samples = self.samples.unwrap_or_else(|| (100 * self.degree).max(4 * self.converged));
        Rule { period: PERIOD, samples, slips }
    }

    /// The slips asked for; none where it is none.
    pub(super) fn slips(&self) -> Option<Slips> {
        let has = |slip| self.as_printed || self.slip.contains(&slip);
        let [interval, twice, half_period] = [Slip::Interval, Slip::Twice, Slip::HalfPeriod].map(has);
        Some(Slips { interval, twice, half_period }).filter(|&slips| slips != Slips::default())
    }

    pub(super) fn describe(&self, report: &mut Report) {
        let list = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
        report.parameter("means μ", list(&self.mean));
        report.parameter("means after moving", list(&self.moved));
        report.parameter("weights", list(&self.weight));
        report.parameter("σ", self.sigma);
        report.parameter("degree N", self.degree);
        report.parameter("degree of the converged series", self.converged);
        report.parameter("samples of each bell", self.rule(Slips::default()).samples);
    }
}

/// Runs the experiment.
///
/// # Errors
/// [`Error::Usage`] for parameters that do not go together; [`Error::NoContext`] without OpenGL.
pub fn run(lab: &mut Lab, args: &Args) -> Result<Report> {
    let common = &args.common;
    let mut report = Report::new("Two periodic Gaussians through their coefficients, on the CPU");
    report.say(
        "The first step towards a sum of any number of bells at a fixed cost: each bell becomes a series, the series \
         are added coefficient by coefficient, and the curve of the sum is drawn from these alone. The notes' bell is \
         exp(−(sin x − μ)²/2σ²), its period 2π.",
    );
    report.say(
        "What is shown is the right computation, the mean over one period. The notes' plug-ins take the period for π, \
         integrate samples of (−1, 1) as if they covered (−T, T), and divide the integral over two periods by one; \
         the table has what each of these does. At N = 10 the series has not converged either.",
    );
    common.describe(&mut report);
    let compute = |bells: &Bells, rule: Rule, degree: u32| Ok(bells.coefficients(rule, degree));
    figures_and_measures(lab, common, &mut report, compute)?;
    report.figures.push(figures::parts(&common.bells(&common.mean)?, common.rule(Slips::default()), common.degrees())?);
    let before = common.bells(&common.mean)?;
    report.figures.push(figures::convergence(&before, common.rule(Slips::default()), common.degrees())?);
    report.figures.push(figures::meant(common.sigma)?);
    Ok(report)
}

impl Common {
    fn degrees(&self) -> [u32; 2] {
        [self.degree, self.converged]
    }
}

/// The two scenes drawn, what was measured at them, and the table of slips. `compute` gives the coefficients of a sum.
pub(super) fn figures_and_measures(
    lab: &mut Lab,
    common: &Common,
    report: &mut Report,
    mut compute: impl FnMut(&Bells, Rule, u32) -> Result<Coefficients>,
) -> Result<()> {
    let right = common.rule(Slips::default());
    let scenes =
        [("before", "Before the means move", &common.mean), ("moved", "After the means have moved", &common.moved)];
    for (stem, title, means) in scenes {
        let bells = common.bells(means)?;
        let (low, high) = (compute(&bells, right, common.degree)?, compute(&bells, right, common.converged)?);
        let curve = |label: String, series, index: usize| Curve { label, series, colour: COLOURS[index] };
        let mut curves = vec![
            curve(format!("series, N = {}", common.degree), &low, 0),
            curve(format!("series, N = {}", common.converged), &high, 2),
        ];
        for (degree, series) in [(common.degree, &low), (common.converged, &high)] {
            let what = format!("{}: largest error at N = {degree}", title.to_lowercase());
            report.measure(what, format!("{:.2e}", bells.error(series)));
        }
        let slipped = match common.slips() {
            Some(slips) => Some(compute(&bells, common.rule(slips), common.degree)?),
            None => None,
        };
        if let Some(series) = &slipped {
            let name = if common.as_printed { "as printed" } else { "with slips" };
            curves.push(curve(format!("{name}, N = {}", common.degree), series, 1));
            let difference = largest(|x| series.value(x) - low.value(x));
            report.measure(format!("{}: largest difference {name}", title.to_lowercase()), format!("{difference:.2e}"));
        }
        report.figures.push(drawn(lab.runner()?, stem, title, &bells, &curves)?);
    }
    report.tables.push(slips_table(common, &mut compute)?);
    Ok(())
}

fn slips_table(common: &Common, compute: &mut impl FnMut(&Bells, Rule, u32) -> Result<Coefficients>) -> Result<Table> {
    let none = Slips::default();
    let mut table = Table::new(
        "slips",
        "What each slip does to the sum before the move: the largest error over a period of 2π",
        &["slip", "period in parts of π", "N", "largest error"],
    );
    let bells = common.bells(&common.mean)?;
    for (name, slips) in [
        ("none", none),
        ("interval (−1, 1) taken for (−T, T)", Slips { interval: true, ..none }),
        ("twice the mean", Slips { twice: true, ..none }),
        ("half the period", Slips { half_period: true, ..none }),
        ("all, as printed", Slips::ALL),
    ] {
        let rule = common.rule(slips);
        let period = if rule.series_period() < PERIOD { "1" } else { "2" };
        for degree in common.degrees() {
            let error = bells.error(&compute(&bells, rule, degree)?);
            table.row([name.to_owned(), period.to_owned(), degree.to_string(), format!("{error:.2e}")]);
        }
    }
    Ok(table)
}
