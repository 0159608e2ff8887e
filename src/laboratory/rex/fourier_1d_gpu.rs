//! The same sum with its coefficients computed on the GPU, a work group a ghost and a thread a mode (002).

use super::chart::{Chart, Series, Stroke};
use super::fourier_1d::{Bells, Common, PERIOD, figures_and_measures};
use super::{Figure, Lab, Report, Table};
use crate::Result;
use crate::gpu::coefficients::{CoefficientsPass, Sampling};
use crate::gpu::runner::Runner;
use crate::series::numeric::{Coefficients, Rule, Slips};

/// Two periodic Gaussians summed through their coefficients, on the GPU
///
/// The samples go to the device in a uniform block; a compute shader gives the coefficients of every ghost, a second one
/// adds them up. Compared with the coefficients in 64 bits.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    #[command(flatten)]
    pub common: Common,
}

/// Runs the experiment.
///
/// # Errors
/// [`crate::Error::Usage`] for parameters that do not go together, and more samples than a uniform block holds;
/// [`crate::Error::NoContext`] without OpenGL.
pub fn run(lab: &mut Lab, args: &Args) -> Result<Report> {
    let common = &args.common;
    let mut report = Report::new("Two periodic Gaussians through their coefficients, on the GPU");
    report.say(
        "The prototype's plug-in FS1D: the samples of each ghost in a uniform block, a work group for each ghost, a \
         thread for each mode, the coefficients in a shader storage buffer. Here the sum over the ghosts is a second \
         dispatch instead of a loop over numbers that were read back, and samples stand four to a vec4, so that 4096 \
         of them fit the 16 KiB that every OpenGL has; more ghosts than fit go in several dispatches.",
    );
    report.say(
        "Mended besides what the experiment on the CPU names: thread N no longer writes into the next ghost's \
         numbers, the samples are not pushed behind as many zeros, both Gaussians are uploaded, and phases are whole \
         numbers of 1/M of a turn instead of products in f32.",
    );
    common.describe(&mut report);
    let device = lab.device()?;
    let runner = Runner::new(&device)?;
    let mut pass = CoefficientsPass::new(&runner)?;
    let compute = |bells: &Bells, rule: Rule, degree: u32| on_gpu(&mut pass, &runner, bells, rule, degree);
    figures_and_measures(lab, common, &mut report, compute)?;
    compare(&mut pass, &runner, common, &mut report)?;
    Ok(report)
}

/// The coefficients of the sum by the GPU, as f64.
fn on_gpu(
    pass: &mut CoefficientsPass,
    runner: &Runner,
    bells: &Bells,
    rule: Rule,
    degree: u32,
) -> Result<Coefficients> {
    let sample = |&bell: &[f64; 2]| rule.sample(|x| bells.one(bell, x)).into_iter().map(|value| value as f32).collect();
    let samples: Vec<Vec<f32>> = bells.bells.iter().map(sample).collect();
    let how = Sampling { turns: rule.turns(), gain: rule.gain() as f32 };
    let terms = pass.sum(runner, &samples, degree, how)?;
    Ok(Coefficients {
        period: rule.series_period(),
        terms: terms.into_iter().map(|term| term.map(f64::from)).collect(),
    })
}

/// The GPU's coefficients beside the CPU's.
fn compare(pass: &mut CoefficientsPass, runner: &Runner, common: &Common, report: &mut Report) -> Result<()> {
    let (bells, rule) = (common.bells(&common.mean)?, common.rule(Slips::default()));
    let gpu = on_gpu(pass, runner, &bells, rule, common.converged)?;
    let cpu = bells.coefficients(rule, common.converged);
    let difference = |n: usize| (0..2).map(|i| (gpu.terms[n][i] - cpu.terms[n][i]).abs()).fold(0.0, f64::max);
    let worst = (0..gpu.terms.len()).map(difference).fold(0.0, f64::max);
    report.measure("largest difference of a coefficient from 64 bits", format!("{worst:.1e}"));

    let mut table = Table::new(
        "coefficients",
        "Coefficients of the sum before the move",
        &["n", "a_n, GPU", "a_n, CPU", "b_n, GPU", "b_n, CPU"],
    );
    for n in 0..=common.degree.min(common.converged) as usize {
        let cell = |value: f64| format!("{value:.8}");
        let [[ga, gb], [ca, cb]] = [gpu.terms[n], cpu.terms[n]];
        table.row([n.to_string(), cell(ga), cell(ca), cell(gb), cell(cb)]);
    }
    report.tables.push(table);

    let points = |f: &dyn Fn(usize) -> f64| (0..gpu.terms.len()).map(|n| [n as f64, f(n)]).collect();
    let size = |n: usize| cpu.terms[n][0].hypot(cpu.terms[n][1]);
    let chart = Chart::new("Coefficients on the GPU", "harmonic n", "size")
        .with(Series::new("√(a_n² + b_n²)", points(&size)))
        .with(Series::new("difference from 64 bits", points(&difference)).stroke(Stroke::Points))
        .log_y();
    let caption = format!(
        "How large the coefficients of the sum are (period {PERIOD:.4}), and by how much those of the GPU, in 32 bits, \
         differ from those of the CPU in 64 bits. A difference of exactly 0 has no place here."
    );
    report.figures.push(Figure::chart("coefficients", caption, &chart)?);
    Ok(())
}
