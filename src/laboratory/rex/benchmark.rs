//! The notes' benchmark (003): few and many ghosts, by the series and by the direct sum.

mod stage;

use glam::DVec2;

use super::chance::Chance;
use super::chart::{Along, Chart, Series, Stroke};
use super::plane::{Canvas, Scene};
use super::{Figure, Lab, Numbers, Report, Table};
use crate::Result;
use crate::measure::{Ratio, Rounds, Samples, crossover};
use crate::plan::Evaluator;
use crate::series::Bell;

use stage::{Stage, Timed};

/// The notes' benchmark: K = 5 and K = 1000 ghosts, parametric and not
///
/// Parametric is the series, summed at every pixel; non-parametric the direct sum of the bells. Everything is measured in
/// turns, with medians. A sweep over K finds where the series overtakes the direct sum.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// Highest harmonic along both axes
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=200))]
    pub degree: u32,

    /// Pixels along a side of the picture
    #[arg(long, value_name = "PIXELS", default_value_t = 256, value_parser = clap::value_parser!(u32).range(16..=4096))]
    pub size: u32,

    /// How often each thing is measured; made even
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub rounds: u16,

    /// The most ghosts of the sweep
    #[arg(long, value_name = "K", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    pub most: u32,
}

/// Rounds for the parametric time at few and many ghosts, for each round of the rest.
const STEADY: usize = 4;
const FEW: u32 = 5;
const MANY: u32 = 1000;
/// How far the parametric time may move between few and many.
const BAR: f64 = 0.05;
/// The notes give the benchmark neither σ nor T; these are the ones they normalise with.
const SIGMA: f64 = 0.7;
const PERIOD: f64 = 20.0;
const SEED: u64 = 3;

/// A row of the notes' own figures: frames a second, from the least to the most, milliseconds of the glare pass, and of
/// all OpenGL.
struct Noted {
    ghosts: u32,
    evaluator: Evaluator,
    frames: [u32; 2],
    about: &'static str,
    glare: f64,
    all: f64,
}

/// 003, "Benchmark". The hardware is not stated.
const NOTED: [Noted; 4] = [
    Noted { ghosts: FEW, evaluator: Evaluator::Series, frames: [4000, 5000], about: "", glare: 0.080, all: 0.207 },
    Noted { ghosts: FEW, evaluator: Evaluator::Direct, frames: [5000, 6000], about: "", glare: 0.014, all: 0.161 },
    Noted { ghosts: MANY, evaluator: Evaluator::Series, frames: [4000, 5000], about: "", glare: 0.082, all: 0.207 },
    Noted {
        ghosts: MANY,
        evaluator: Evaluator::Direct,
        frames: [2000, 2000],
        about: "about 2000 frames a second",
        glare: 0.311,
        all: 0.442,
    },
];

/// Runs the experiment.
///
/// # Errors
/// [`crate::Error::NoContext`] and [`crate::Error::Gl`] from OpenGL.
pub fn run(lab: &mut Lab, args: &Args) -> Result<Report> {
    let stage = Stage::new(lab.device()?, args.size, Rounds::new(1, usize::from(args.rounds)));
    let mut report = Report::new("The benchmark of the notes");
    describe(&mut report, args, &stage);
    let (few, many) = (scene(FEW, args), scene(MANY, args));
    let timed = stage.in_turns([
        (&few, Evaluator::Series),
        (&few, Evaluator::Direct),
        (&many, Evaluator::Series),
        (&many, Evaluator::Direct),
    ])?;
    report.tables.push(table(&timed, &stage));
    // Next to each other and more often, because this ratio is held against a bar of a few percent.
    let [few, many] = stage.pair([(&few, Evaluator::Series), (&many, Evaluator::Series)], STEADY)?;
    steady(&mut report, many.over(&few));
    measure(&mut report, &timed);
    sweep(&mut report, &stage, args)?;
    Ok(report)
}

fn describe(report: &mut Report, args: &Args, stage: &Stage) {
    report.say(
        "The notes time K = 5 and K = 1000 ghosts, each by the series (parametric) and by the direct sum \
         (non-parametric), and give frames a second, the time of the pass that draws the glare and the mean time of all of \
         OpenGL in a frame. The hardware, the size of the picture, σ and T are not stated; here σ = 0.7 and T = 20. The \
         spectrum is there before the first frame, as in the prototype.",
    );
    report.say(
        "A pixel of the series costs the same for any K, one of the direct sum costs K bells. Which is faster depends on K \
         alone, and the sweep finds where they meet. Both are the prototype's ways to evaluate; `vglare bench` times the \
         faster ones.",
    );
    let how = if stage.trusted() {
        "The device's own timer gives the passes' times; frames are timed to the end of glFinish."
    } else {
        "This is a software renderer, whose timer queries cannot be trusted: all times here are wall times to the end of \
         glFinish."
    };
    report.say(how);
    report.parameter("device", stage.renderer_name());
    report.parameter("picture", format!("{0} × {0}", args.size));
    report.parameter("N = M", args.degree);
    report.parameter("σ, T", format!("{SIGMA}, {PERIOD}"));
    report.parameter("rounds", stage.rounds.timed());
}

/// `count` ghosts even over the period, the same ones at the same places for every picture.
fn scene(count: u32, args: &Args) -> Scene {
    let mut chance = Chance::new(SEED);
    let mut place = || chance.between(-0.5 * PERIOD, 0.5 * PERIOD);
    Scene {
        bell: Bell::Gaussian,
        size: SIGMA,
        centers: (0..count).map(|_| DVec2::new(place(), place())).collect(),
        period: DVec2::splat(PERIOD),
        degree: [args.degree; 2],
    }
}

/// The square of one period that all frames show.
fn canvas(size: u32) -> Canvas {
    let ends = [-0.5 * PERIOD, 0.5 * PERIOD];
    Canvas::new([size; 2], ends, ends)
}

fn name(evaluator: Evaluator) -> &'static str {
    if !evaluator.is_series() { "non-parametric" } else { "parametric" }
}

/// Milliseconds with three digits.
fn milliseconds(time: f64) -> String {
    let decimals = if time < 9.995 { 3 } else { usize::from(time < 99.95) };
    format!("{time:.decimals$}")
}

/// In the layout of the notes' table, with their figures beside.
fn table(timed: &[Timed; 4], stage: &Stage) -> Table {
    let header = [
        "K",
        "case",
        "FPS",
        "draw_glare, ms",
        "mean GL time, ms",
        "spread of a frame, %",
        "notes: FPS, least",
        "notes: FPS, most",
        "notes: draw_glare, ms",
        "notes: mean GL time, ms",
        "the notes say",
    ];
    let caption =
        format!("Measured on {}, and the notes' own figures on hardware that is not stated", stage.renderer_name());
    let mut table = Table::new("benchmark", caption, &header);
    for (noted, timed) in NOTED.iter().zip(timed) {
        table.row([
            noted.ghosts.to_string(),
            name(noted.evaluator).to_owned(),
            format!("{:.1}", 1e3 / timed.frame.median()),
            milliseconds(timed.glare.median()),
            milliseconds(timed.all.median()),
            format!("{:.0}", 100.0 * timed.frame.spread()),
            noted.frames[0].to_string(),
            noted.frames[1].to_string(),
            format!("{:.3}", noted.glare),
            format!("{:.3}", noted.all),
            noted.about.to_owned(),
        ]);
    }
    table
}

/// A ratio in words, by both ways of taking it.
fn ratio(over: Ratio) -> String {
    format!("{:.3} in pairs, {:.3} of the medians", over.paired, over.of_medians)
}

fn steady(report: &mut Report, over: Ratio) {
    let verdict = if (over.paired - 1.0).abs() <= BAR { "within 5 %" } else { "beyond 5 %" };
    report.measure("parametric, K = 1000 over K = 5 (notes: 1.03)", format!("{}: {verdict}", ratio(over)));
}

fn measure(report: &mut Report, [few_series, few_direct, many_series, many_direct]: &[Timed; 4]) {
    let growth = many_direct.frame.over(&few_direct.frame);
    report.measure("non-parametric, K = 1000 over K = 5 (notes: 22)", ratio(growth));
    let won = many_direct.frame.over(&many_series.frame);
    report.measure("non-parametric over parametric, K = 1000 (notes: 3.8)", ratio(won));
    let lost = few_direct.frame.over(&few_series.frame);
    report.measure("non-parametric over parametric, K = 5 (notes: 0.18)", ratio(lost));
}

/// Powers of two up to the most.
fn counts(most: u32) -> Vec<u32> {
    let mut counts: Vec<u32> = (0..).map(|power| 1 << power).take_while(|&count| count < most).collect();
    counts.push(most);
    counts
}

fn sweep(report: &mut Report, stage: &Stage, args: &Args) -> Result<()> {
    let counts = counts(args.most);
    let mut times: Vec<[Samples; 2]> = Vec::new();
    for &count in &counts {
        let scene = scene(count, args);
        times.push(stage.pair([(&scene, Evaluator::Series), (&scene, Evaluator::Direct)], 1)?);
    }
    let points = |arm: usize| -> Vec<[f64; 2]> {
        counts.iter().zip(&times).map(|(&count, pair)| [f64::from(count), pair[arm].median()]).collect()
    };
    let ratios: Vec<[f64; 2]> = counts
        .iter()
        .zip(&times)
        .map(|(&count, [series, direct])| [f64::from(count), direct.over(series).paired])
        .collect();
    let mut chart = Chart::new("A frame against the number of ghosts", "ghosts K", "frame, ms")
        .with(Series::new("parametric (series)", points(0)).stroke(Stroke::Joined))
        .with(Series::new("non-parametric (direct)", points(1)).stroke(Stroke::Joined))
        .log_x()
        .log_y();
    match crossover(&ratios) {
        Some(count) => {
            chart = chart.mark(format!("K = {count:.0}"), Along::Vertical, count);
            report.measure("the series overtakes the direct sum at K", format!("{count:.0}"));
        }
        None => report.measure("the series overtakes the direct sum", "nowhere in the sweep"),
    }
    let columns = ["K", "parametric, ms", "non-parametric, ms", "ratio in pairs"].map(String::from).to_vec();
    let row = |((&count, pair), ratio): ((&u32, &[Samples; 2]), &[f64; 2])| {
        vec![f64::from(count), pair[0].median(), pair[1].median(), ratio[1]]
    };
    let rows = counts.iter().zip(&times).zip(&ratios).map(row).collect();
    let caption = "Medians of frames timed in turns. The mark is where the two meet.";
    report.figures.push(Figure::chart("sweep", caption, &chart)?.numbers(Numbers {
        columns,
        rows,
        series: Vec::new(),
    }));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sweep_ends_where_it_is_asked_to() {
        assert_eq!(counts(8), [1, 2, 4, 8]);
        assert_eq!(counts(10), [1, 2, 4, 8, 10]);
        assert_eq!(counts(2), [1, 2]);
    }

    #[test]
    fn milliseconds_have_three_digits() {
        assert_eq!([0.0801, 5.4321, 12.345, 123.45].map(milliseconds), ["0.080", "5.432", "12.3", "123"]);
    }
}
