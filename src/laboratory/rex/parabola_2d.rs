//! The notes' parabola in two dimensions (001), (1 − x²)(1 − y²), whose floor is a square, beside the round paraboloid.

use glam::DVec2;
use image::{Rgb, RgbImage};

use super::chart::{Axis, Chart, Map, Series, Stroke, side_by_side};
use super::plane::{Canvas, Drawn, SIDE, Scene};
use super::{Figure, Lab, Report, Table};
use crate::Result;
use crate::renderer::{Picture, Settings};
use crate::series::Bell;
use crate::series::printed::Printed2d;

/// (1 − x²)(1 − y²) with its square floor, beside the round 1 − x² − y²
///
/// The notes turn down the product because its floor is a square, and the round bell because it is no product. It need
/// not be: its shift separates all the same. With --as-printed the notes' integral for the round bell is drawn, too.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// T: the period along both axes
    #[arg(long, value_name = "T", default_value_t = 4.0)]
    pub period: f64,

    /// Highest harmonic along both axes
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=200))]
    pub degree: u32,

    /// Pixels along a side of the picture
    #[arg(long, value_name = "PIXELS", default_value_t = 513, value_parser = clap::value_parser!(u32).range(17..=4097))]
    pub size: u32,

    /// Also draw the round bell by the notes' integral as it is printed
    #[arg(long)]
    pub as_printed: bool,
}

/// What is shown: x and y from −1.5 to 1.5.
const REACH: f64 = 1.5;
/// Heights at which the bells' outlines are compared.
const LEVELS: [f64; 4] = [0.5, 0.2, 0.1, 0.05];

/// A bell with its field.
struct Drawing {
    stem: &'static str,
    name: &'static str,
    scene: Scene,
    field: Drawn,
}

/// Runs the experiment.
///
/// # Errors
/// [`crate::Error::NoContext`] and [`crate::Error::Gl`] from OpenGL; [`crate::Error::Usage`] for a period that is
/// narrower than the bell.
pub fn run(lab: &mut Lab, args: &Args) -> Result<Report> {
    if !(args.period >= 2.0 && args.period.is_finite()) {
        return Err(crate::Error::Usage(format!("a period of {} is narrower than the bell, 2", args.period)));
    }
    let mut renderer = Picture::new(&lab.device()?)?;
    let mut report = Report::new("The parabola in two dimensions, square and round");
    describe(&mut report, args);
    let drawings = drawings(&mut renderer, args)?;
    for Drawing { stem, name, field, .. } in &drawings {
        report.figures.push(field.figure(stem, "Its Fourier series on the GPU.", name, [-0.05, 1.0])?);
    }
    let bands: Vec<_> = drawings.iter().map(|drawing| bands(&drawing.field)).collect();
    let caption = "The same fields in bands of a tenth, black below 0.05: the floor of the product is a square with \
                   rounded corners, that of the paraboloid a disc.";
    report.figures.push(Figure::new("floors", caption, side_by_side(&bands)));
    report.figures.push(cuts(&drawings)?);
    report.tables.push(outlines(&drawings));
    for Drawing { name, scene, field, .. } in &drawings {
        report.measure(format!("{name}: largest error"), format!("{:.2e}", field.worst(|at| scene.direct(at))));
    }
    if args.as_printed {
        as_printed(&mut report, &mut renderer, args)?;
    }
    Ok(report)
}

fn describe(report: &mut Report, args: &Args) {
    report.say(
        "The product of two parabolas has the product of their coefficients. Its level lines are round near the top only: \
         at the floor they become the square |x|, |y| ≤ 1, whose corners are √2 as far from the centre as its sides.",
    );
    report.say(
        "For 1 − x² − y² the notes take up Bessel functions, because the bell does not separate into x and y. Only its \
         shift has to: with E_nm = κ ĝ(q)/(T1 T2), ĝ(q) = 4π J2(q)/q², q = |(nω, mω)|, the same A, B, C and D carry it. \
         Both bells have a kink at the rim, so that the error falls like 1/N.",
    );
    if args.as_printed {
        report.say(
            "As printed, the round bell's integral covers half of the disc, which halves every coefficient, and gives one \
             index to both cosines: the modes n = m alone are no bell, but streaks along the diagonals.",
        );
    }
    report.parameter("T", args.period);
    report.parameter("N = M", args.degree);
    report.parameter("coefficients", if args.as_printed { "right, and as printed" } else { "right" });
}

fn scene(bell: Bell, args: &Args) -> Scene {
    let (period, degree) = (DVec2::splat(args.period), [args.degree; 2]);
    Scene { bell, size: 1.0, centers: vec![DVec2::ZERO], period, degree }
}

fn canvas(args: &Args) -> Canvas {
    Canvas::new([args.size; 2], [-REACH, REACH], [-REACH, REACH])
}

fn drawings(renderer: &mut Picture, args: &Args) -> Result<Vec<Drawing>> {
    let kinds = [("product", "(1 − x²)(1 − y²)", Bell::Parabola), ("paraboloid", "1 − x² − y²", Bell::Paraboloid)];
    let draw = |(stem, name, bell)| {
        let scene = scene(bell, args);
        let field = scene.draw(renderer, canvas(args), &Settings::default())?;
        Ok(Drawing { stem, name, scene, field })
    };
    kinds.into_iter().map(draw).collect()
}

/// The field in bands of a tenth, the lowest of them from 0.05 on.
fn bands(field: &Drawn) -> RgbImage {
    let scalar = &field.scalar;
    RgbImage::from_fn(scalar.width, scalar.height, |column, row| {
        let value = scalar.values[(row * scalar.width + column) as usize];
        let band = (10.0 * (value - 0.05)).floor();
        Rgb(if band < 0.0 { [0; 3] } else { Map::Viridis.colour(0.15 + 0.085 * band) })
    })
}

/// The field along the axis and along the diagonal, by the distance from the centre.
fn profiles(field: &Drawn) -> [Vec<[f64; 2]>; 2] {
    let (middle, side) = (field.scalar.height / 2, field.scalar.width);
    let at = |column: u32, row: u32| {
        let place = field.canvas.position(column, row);
        [place.length(), field.scalar.values[(row * side + column) as usize]]
    };
    let outwards = middle..side;
    [outwards.clone().map(|i| at(i, middle)).collect(), outwards.map(|i| at(i, side - 1 - i)).collect()]
}

/// How far from the centre a profile last reaches a level, between its points.
fn reach(profile: &[[f64; 2]], level: f64) -> f64 {
    let crossing = profile.windows(2).rev().find(|pair| pair[0][1] >= level && pair[1][1] < level);
    crossing.map_or(f64::NAN, |pair| {
        let part = (pair[0][1] - level) / (pair[0][1] - pair[1][1]);
        pair[0][0] + part * (pair[1][0] - pair[0][0])
    })
}

fn cuts(drawings: &[Drawing]) -> Result<Figure> {
    let mut chart = Chart::new("From the centre outwards", "distance from the centre", "value");
    for (Drawing { name, field, .. }, colour) in drawings.iter().zip(super::chart::COLOURS) {
        let [axis, diagonal] = profiles(field);
        chart = chart
            .with(Series::new(format!("{name}, along the axis"), axis).colour(colour))
            .with(Series::new(format!("{name}, along the diagonal"), diagonal).stroke(Stroke::Dashed).colour(colour));
    }
    Figure::chart("outwards", "Both fields along an axis and along a diagonal: the round bell's two are one.", &chart)
}

fn outlines(drawings: &[Drawing]) -> Table {
    let header = ["bell", "level", "along the axis", "along the diagonal", "ratio"];
    let mut table = Table::new("outlines", "How far the bells reach: 1 is round, √2 a square", &header);
    for Drawing { name, field, .. } in drawings {
        let [axis, diagonal] = profiles(field);
        for level in LEVELS {
            let (a, d) = (reach(&axis, level), reach(&diagonal, level));
            table.row([
                (*name).to_owned(),
                level.to_string(),
                format!("{a:.3}"),
                format!("{d:.3}"),
                format!("{:.3}", d / a),
            ]);
        }
    }
    table
}

/// The half disc's diagonal, as 000 prints it.
fn as_printed(report: &mut Report, renderer: &mut Picture, args: &Args) -> Result<()> {
    let scene = scene(Bell::Paraboloid, args);
    let table = Printed2d::HalfDisc.table(scene.period, scene.degree);
    let field = scene.draw_table(renderer, canvas(args), &table)?;
    let value = Axis { label: "value".into(), range: None, log: false };
    let chart = field.canvas.chart(&field.scalar, "Half of the disc, n = m alone", value, Map::Inferno, SIDE);
    let caption = "The round bell by the notes' integral as it is printed. The colours are not those of the others.";
    report.figures.push(Figure::chart("printed", caption, &chart)?.field(field.field()));
    report.measure("as printed: largest error", format!("{:.2e}", field.worst(|at| scene.direct(at))));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_reaches_a_level_between_its_points() {
        let profile = [[0.0, 1.0], [1.0, 0.5], [2.0, 0.1], [3.0, 0.3], [4.0, 0.0]];
        assert!((reach(&profile, 0.2) - (3.0 + 1.0 / 3.0)).abs() < 1e-12, "the last of three");
        assert!((reach(&profile, 0.75) - 0.5).abs() < 1e-12);
        assert!(reach(&profile, 2.0).is_nan());
    }
}
