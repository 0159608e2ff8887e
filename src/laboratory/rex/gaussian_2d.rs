//! The notes' two-dimensional Gaussian (000): at the centre of a square period, and off the centre of an oblong one.

use glam::DVec2;

use super::chart::{Axis, COLOURS, Chart, Map, Series, Stroke};
use super::plane::{Canvas, Drawn, SIDE, Scene};
use super::{Figure, Lab, Report, Table};
use crate::Result;
use crate::renderer::{Picture, Settings};
use crate::series::Bell;
use crate::series::printed::{GaussianForm, gaussian_table, table_value};

/// The Gaussian in two dimensions: centred, and at (5, −10) in a period of 16 × 32
///
/// The bell, its Fourier series on the GPU, and cuts through both with the largest error. With --as-printed, all ways
/// in which the notes put the series together stand beside it, with what each makes of the peak.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// σ, in the notes' units
    #[arg(long, value_name = "S", default_value_t = 1.0)]
    pub sigma: f64,

    /// Highest harmonic along both axes
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=200))]
    pub degree: u32,

    /// Pixels along the picture's longer side
    #[arg(long, value_name = "PIXELS", default_value_t = 512, value_parser = clap::value_parser!(u32).range(16..=4096))]
    pub size: u32,

    /// Draw what the notes' formulas give as they are printed, beside the right series
    #[arg(long)]
    pub as_printed: bool,
}

/// One of the two bells: its scene, and the half-widths of what is shown, one period.
struct Case {
    stem: &'static str,
    title: &'static str,
    scene: Scene,
}

impl Case {
    fn canvas(&self, size: u32) -> Canvas {
        let period = self.scene.period;
        let pixels = (period / period.max_element() * f64::from(size)).round().as_uvec2();
        Canvas::new(pixels.to_array(), ends(period.x), ends(period.y))
    }
}

/// One period about 0.
fn ends(period: f64) -> [f64; 2] {
    [-0.5 * period, 0.5 * period]
}

fn cases(args: &Args) -> [Case; 2] {
    let scene = |center, period| Scene {
        bell: Bell::Gaussian,
        size: args.sigma,
        centers: vec![center],
        period,
        degree: [args.degree; 2],
    };
    [
        Case { stem: "centred", title: "centre (0, 0), T = 16", scene: scene(DVec2::ZERO, DVec2::splat(16.0)) },
        Case {
            stem: "off-centre",
            title: "centre (5, −10), T = 16 × 32",
            scene: scene(DVec2::new(5.0, -10.0), DVec2::new(16.0, 32.0)),
        },
    ]
}

/// Runs the experiment.
///
/// # Errors
/// [`crate::Error::NoContext`] and [`crate::Error::Gl`] from OpenGL; [`crate::Error::Usage`] for a σ that is no size.
pub fn run(lab: &mut Lab, args: &Args) -> Result<Report> {
    if !(args.sigma > 0.0 && args.sigma.is_finite()) {
        return Err(crate::Error::Usage(format!("σ has to be positive, and {} is not", args.sigma)));
    }
    let mut renderer = Picture::new(&lab.device()?)?;
    let mut report = Report::new("The Gaussian in two dimensions");
    describe(&mut report, args);
    for case in cases(args) {
        let field = case.scene.draw(&mut renderer, case.canvas(args.size), &Settings::default())?;
        pictures(&mut report, &case, &field)?;
        for section in Section::of(&case) {
            section.add(&mut report, &case, &mut renderer, args)?;
        }
        measure(&mut report, &case, &field);
        if args.as_printed {
            report.tables.push(forms(&case, args));
        }
    }
    Ok(report)
}

fn describe(report: &mut Report, args: &Args) {
    report.say(
        "The bell exp(−r²/2σ²) is a product, so its series is the product of two, and a shift stays exact. Its \
         coefficients are α_n = √(2π)(σ/T) exp(−(nωσ)²/2), those of the bell and all its copies a period away; there is \
         no error function in them.",
    );
    report.say(
        "At (5, −10) the copy at (−11, −10) reaches into the left of the picture: within 3 σ, where it is worth 0.011. \
         That is no error of the series, but of a period that is no longer than the picture.",
    );
    if args.as_printed {
        report.say(
            "As printed, prefactors of full-range and half-range integrals are mixed. Each form in the notes is a bell of \
             the right shape and a wrong height, or stands on a pedestal and a cross.",
        );
    }
    report.parameter("σ", args.sigma);
    report.parameter("N = M", args.degree);
    report.parameter("coefficients", if args.as_printed { "right, and as printed" } else { "right" });
}

fn pictures(report: &mut Report, case: &Case, field: &Drawn) -> Result<()> {
    let (stem, title) = (case.stem, case.title);
    let value = Axis { label: "value".into(), range: Some([0.0, 1.0]), log: false };
    let bell = field.canvas.scalar(|at| case.scene.direct(at));
    let chart = field.canvas.chart(&bell, &format!("Gaussian, {title}"), value, Map::Inferno, SIDE);
    report.figures.push(Figure::chart(format!("{stem}-bell"), "The bell itself, in f64.", &chart)?);
    let caption = "Its Fourier series, summed at every pixel on the GPU.";
    let title = format!("Series, {title}");
    report.figures.push(field.figure(&format!("{stem}-series"), caption, &title, [0.0, 1.0])?);
    let error = field.error(|at| case.scene.direct(at));
    let most = error.range().map(f64::abs).into_iter().fold(f64::MIN_POSITIVE, f64::max);
    let value = Axis { label: "series − bell".into(), range: Some([-most, most]), log: false };
    let chart = field.canvas.chart(&error, &format!("Error, {}", case.title), value, Map::RedBlue, SIDE);
    report.figures.push(Figure::chart(format!("{stem}-error"), "The series less the bell.", &chart)?);
    Ok(())
}

/// A cut through the bell's centre over one period.
struct Section {
    stem: &'static str,
    title: String,
    axis: &'static str,
    canvas: Canvas,
    /// Which coordinate runs along it.
    along: fn(DVec2) -> f64,
}

/// Points of a cut.
const POINTS: u32 = 800;

impl Section {
    /// The notes' cuts: one through the centred bell, both through the other.
    fn of(case: &Case) -> Vec<Self> {
        let (center, period) = (case.scene.centers[0], case.scene.period);
        let along_x = Self {
            stem: "cut-y",
            title: format!("Cut at y = {}, x over one period of {}", center.y, period.x),
            axis: "x",
            canvas: Canvas::along_x(POINTS, ends(period.x), center.y),
            along: |at| at.x,
        };
        let along_y = Self {
            stem: "cut-x",
            title: format!("Cut at x = {}, y over one period of {}", center.x, period.y),
            axis: "y",
            canvas: Canvas::along_y(POINTS, ends(period.y), center.x),
            along: |at| at.y,
        };
        if center == DVec2::ZERO { vec![along_x] } else { vec![along_x, along_y] }
    }

    fn points(&self, f: impl Fn(DVec2) -> f64) -> Vec<[f64; 2]> {
        let mut points: Vec<_> = self.canvas.positions().map(|at| [(self.along)(at), f(at)]).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        points
    }

    fn drawn(&self, field: &Drawn) -> Vec<[f64; 2]> {
        let places = self.canvas.positions().map(self.along).zip(&field.scalar.values);
        let mut points: Vec<_> = places.map(|(place, &value)| [place, value]).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        points
    }

    fn add(&self, report: &mut Report, case: &Case, renderer: &mut Picture, args: &Args) -> Result<()> {
        let scene = &case.scene;
        let field = scene.draw(renderer, self.canvas, &Settings::default())?;
        let mut chart = Chart::new(format!("{}, {}", self.title, case.title), self.axis, "value")
            .with(Series::new("Gaussian", self.points(|at| scene.direct(at))))
            .with(Series::new("series, GPU", self.drawn(&field)).stroke(Stroke::Dashed));
        report.figures.push(Figure::chart(
            format!("{}-{}", case.stem, self.stem),
            "The Gaussian and its series, along a line through the centre.",
            &chart,
        )?);
        if args.as_printed {
            chart.series[0] = chart.series[0].clone().colour([120; 3]);
            chart.series[1] = chart.series[1].clone().colour([0; 3]);
            for (index, form) in GaussianForm::ALL.into_iter().enumerate() {
                let printed = gaussian_table(args.sigma, form, scene.period, scene.degree);
                let field = scene.draw_table(renderer, self.canvas, &printed)?;
                // Six colours that differ from black, and three of them again, dotted.
                let stroke = if index < 6 { Stroke::Solid } else { Stroke::Dotted };
                let series = Series::new(form.name(), self.drawn(&field)).colour(COLOURS[index % 6]).stroke(stroke);
                chart = chart.with(series);
            }
            let chart = Chart { size: [960, 720], ..chart.log_y().range_y(1e-4, 100.0) };
            report.figures.push(Figure::chart(
                format!("{}-{}-printed", case.stem, self.stem),
                "The same cut through what each of the notes' forms gives, on a logarithmic scale.",
                &chart,
            )?);
        }
        Ok(())
    }
}

fn measure(report: &mut Report, case: &Case, field: &Drawn) {
    let scene = &case.scene;
    let name = case.title;
    report.measure(
        format!("{name}: largest error against the bell"),
        format!("{:.1e}", field.worst(|at| scene.direct(at))),
    );
    let periodised = field.worst(|at| scene.periodised(at));
    report.measure(format!("{name}: largest error against the bell and its copies"), format!("{periodised:.1e}"));
    let (place, peak) = peak(field);
    report.measure(format!("{name}: brightest pixel"), format!("{peak:.4} at ({:.2}, {:.2})", place.x, place.y));
}

/// The brightest pixel.
fn peak(field: &Drawn) -> (DVec2, f64) {
    let places = field.canvas.positions().zip(field.scalar.values.iter().copied());
    places.fold((DVec2::ZERO, f64::NEG_INFINITY), |best, (at, value)| if value > best.1 { (at, value) } else { best })
}

fn forms(case: &Case, args: &Args) -> Table {
    let (period, degree) = (case.scene.period, case.scene.degree);
    let mut table = Table::new(
        format!("{}-forms", case.stem),
        format!("What the notes' forms make of the peak, {}", case.title),
        &["form", "peak", "right", "half a period away"],
    );
    for form in GaussianForm::ALL {
        let modes = gaussian_table(args.sigma, form, period, degree);
        let at = |offset| table_value(&modes, period, degree, offset);
        let (peak, far) = (at(DVec2::ZERO), at(0.5 * period));
        table.row([form.name().to_owned(), format!("{peak:.4}"), "1".to_owned(), format!("{far:.1e}")]);
    }
    table
}
