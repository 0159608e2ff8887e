//! Charts: what is on them. `paint` draws them, `axis` places the numbers, `field` makes pictures of scalar fields; `sheet` is
//! for drawings that have no axes, `legend` for fields in false colours there.

mod axis;
mod field;
mod kind;
mod layout;
mod legend;
mod line;
mod paint;
mod sheet;

use std::path::Path;

use image::RgbImage;

pub use crate::false_colour::Map;
pub use axis::Axis;
pub use field::{Scalar, side_by_side};
pub use kind::Kind;
pub(crate) use kind::{png_bytes, write_png};
pub use sheet::{Anchor, Shape, Sheet, text_width};

use crate::{Error, Result, target};

/// A colour, sRGB.
pub type Colour = [u8; 3];

/// Colours that people with any colour vision tell apart (Okabe and Ito, "Color Universal Design", 2008), the darker
/// ones first: they stand on white.
pub const COLOURS: [Colour; 7] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233], [0, 0, 0]];

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Stroke {
    /// A line.
    #[default]
    Solid,
    /// A line of dashes.
    Dashed,
    /// A line of dots.
    Dotted,
    /// A disc at each point and no line.
    Points,
    /// A disc at each point, joined by a line.
    Joined,
    /// A ring around each point and no line: picks points of other series out.
    Rings,
    /// In the legend only: for what a backdrop shows.
    Legend,
}

/// Points of one kind, in their order along the line. A point that has no place, NaN say, breaks the line.
#[derive(Debug, Clone)]
pub struct Series {
    /// What the legend calls it.
    pub label: String,
    /// x and y of each point, in the axes' units.
    pub points: Vec<[f64; 2]>,
    /// How it is drawn.
    pub stroke: Stroke,
    /// By default the next of [`COLOURS`].
    pub colour: Option<Colour>,
}

impl Series {
    /// A solid line.
    pub fn new(label: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self { label: label.into(), points, stroke: Stroke::default(), colour: None }
    }

    /// A solid line through `f` at `count` places evenly from `from` to `to`, both included.
    pub fn function(label: impl Into<String>, [from, to]: [f64; 2], count: u32, f: impl Fn(f64) -> f64) -> Self {
        let last = f64::from(count.max(2) - 1);
        let x = |i: u32| from + (to - from) * f64::from(i) / last;
        Self::new(label, (0..count.max(2)).map(|i| [x(i), f(x(i))]).collect())
    }

    /// The same, drawn in another way.
    #[must_use]
    pub fn stroke(self, stroke: Stroke) -> Self {
        Self { stroke, ..self }
    }

    /// The same in a colour of its own.
    #[must_use]
    pub fn colour(self, colour: Colour) -> Self {
        Self { colour: Some(colour), ..self }
    }
}

/// A line across the whole plot, up or along.
#[derive(Debug, Clone)]
pub struct Mark {
    /// Stands beside the line.
    pub label: String,
    /// The place on the axis that it crosses, in its units.
    pub at: f64,
    /// Which way it runs.
    pub along: Along,
}

/// Which way a mark runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// At a place of the x axis, upwards.
    Vertical,
    /// At a place of the y axis, across.
    Horizontal,
}

/// A colour bar beside the plot.
#[derive(Debug, Clone)]
pub struct Bar {
    /// What the colours stand for.
    pub axis: Axis,
    /// The colours.
    pub map: Map,
}

/// Columns of numbers, each with a name of its own; NaN is written as an empty cell.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Numbers {
    /// The columns' names.
    pub columns: Vec<String>,
    /// As many numbers in each as there are columns.
    pub rows: Vec<Vec<f64>>,
    /// The series that each row is of, where they stand below each other; empty where they stand side by side.
    pub series: Vec<String>,
}

/// One chart.
#[derive(Debug, Clone)]
pub struct Chart {
    /// What stands above; may be empty.
    pub title: String,
    /// The axis along.
    pub x: Axis,
    /// The axis upwards.
    pub y: Axis,
    /// What is drawn, the first one lowest.
    pub series: Vec<Series>,
    /// Lines across the plot.
    pub marks: Vec<Mark>,
    /// A picture that fills the plot, corner to corner.
    pub backdrop: Option<RgbImage>,
    /// The colour bar of the backdrop.
    pub bar: Option<Bar>,
    /// Pixels of the whole chart.
    pub size: [u32; 2],
}

impl Chart {
    /// An empty chart.
    pub fn new(title: impl Into<String>, x: impl Into<String>, y: impl Into<String>) -> Self {
        let axis = |label| Axis { label, ..Axis::default() };
        Self {
            title: title.into(),
            x: axis(x.into()),
            y: axis(y.into()),
            series: Vec::new(),
            marks: Vec::new(),
            backdrop: None,
            bar: None,
            size: [960, 600],
        }
    }

    /// With one more series.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// With a mark.
    #[must_use]
    pub fn mark(mut self, label: impl Into<String>, along: Along, at: f64) -> Self {
        self.marks.push(Mark { label: label.into(), at, along });
        self
    }

    /// With a logarithmic x axis.
    #[must_use]
    pub fn log_x(mut self) -> Self {
        self.x.log = true;
        self
    }

    /// With a logarithmic y axis.
    #[must_use]
    pub fn log_y(mut self) -> Self {
        self.y.log = true;
        self
    }

    /// With ends of the x axis.
    #[must_use]
    pub fn range_x(mut self, low: f64, high: f64) -> Self {
        self.x.range = Some([low, high]);
        self
    }

    /// With ends of the y axis.
    #[must_use]
    pub fn range_y(mut self, low: f64, high: f64) -> Self {
        self.y.range = Some([low, high]);
        self
    }

    /// With a picture that fills the plot.
    #[must_use]
    pub fn backdrop(mut self, picture: RgbImage) -> Self {
        self.backdrop = Some(picture);
        self
    }

    /// The chart as a picture.
    ///
    /// # Errors
    /// [`crate::Error::Chart`] where it cannot be drawn.
    pub fn picture(&self) -> Result<RgbImage> {
        paint::picture(self)
    }

    /// The chart as SVG; none for one that has pictures in it.
    ///
    /// # Errors
    /// [`crate::Error::Chart`] where it cannot be drawn.
    pub fn svg(&self) -> Result<Option<String>> {
        if self.backdrop.is_some() || self.bar.is_some() { Ok(None) } else { paint::svg(self).map(Some) }
    }

    /// Writes the chart.
    ///
    /// # Errors
    /// [`crate::Error::Chart`] where it cannot be drawn, [`Error::Write`] and [`Error::Exists`] where it cannot be written: one that has
    /// pictures in it is no SVG.
    pub fn write(&self, path: &Path, kind: Kind, overwrite: bool) -> Result<()> {
        match kind {
            Kind::Png => write_png(path, &self.picture()?, overwrite),
            Kind::Svg => {
                let svg =
                    self.svg()?.ok_or_else(|| Error::write(path, "a chart with pictures in it is written as .png"))?;
                target::write_text(path, &svg, overwrite)
            }
        }
    }

    /// The numbers of all series: side by side where all share their x, otherwise below each other.
    pub fn numbers(&self) -> Numbers {
        let drawn: Vec<&Series> = self.series.iter().filter(|series| series.stroke != Stroke::Legend).collect();
        let mut names = vec![self.x.label.clone()];
        for series in &drawn {
            let name = unused(&names, &series.label);
            names.push(name);
        }
        let places = |series: &Series| series.points.iter().map(|point| point[0].to_bits()).collect::<Vec<_>>();
        if drawn.windows(2).all(|pair| places(pair[0]) == places(pair[1])) {
            let row = |index: usize| {
                let y = drawn.iter().map(|series| series.points[index][1]);
                drawn.first().map(|series| series.points[index][0]).into_iter().chain(y).collect()
            };
            let rows = (0..drawn.first().map_or(0, |series| series.points.len())).map(row).collect();
            return Numbers { columns: names, rows, ..Numbers::default() };
        }
        let columns = vec![self.x.label.clone(), unused(&names[..1], &self.y.label)];
        let of = |(series, name): (&&Series, &String)| vec![name.clone(); series.points.len()];
        let series = drawn.iter().zip(&names[1..]).flat_map(of).collect();
        let rows = drawn.iter().flat_map(|series| &series.points).map(|point| point.to_vec()).collect();
        Numbers { columns, rows, series }
    }
}

/// A name that none of `names` is: `name` itself, or that of the series before it with a number where it has none.
fn unused(names: &[String], name: &str) -> String {
    let name = if name.is_empty() { names.last().map_or("", String::as_str) } else { name };
    let mut numbered = (2..).map(|number| format!("{name} ({number})"));
    match names.iter().any(|other| other == name) {
        true => numbered.find(|numbered| !names.contains(numbered)).unwrap_or_default(),
        false => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_series_that_share_their_x_stand_side_by_side() {
        let chart = Chart::new("title", "x", "y")
            .with(Series::new("a", vec![[0.0, 1.0], [1.0, 2.0]]))
            .with(Series::new("b", vec![[0.0, 3.0], [1.0, 4.0]]))
            .with(Series::new("", vec![[0.0, 5.0], [1.0, 6.0]]))
            .with(Series::new("a", vec![[0.0, 7.0], [1.0, 8.0]]));
        let Numbers { columns, rows, series } = chart.numbers();
        assert_eq!(columns, ["x", "a", "b", "b (2)", "a (2)"]);
        assert_eq!(rows, [[0.0, 1.0, 3.0, 5.0, 7.0], [1.0, 2.0, 4.0, 6.0, 8.0]]);
        assert!(series.is_empty());
        assert_eq!(Chart::new("title", "x", "y").numbers().rows, Vec::<Vec<f64>>::new());
    }

    #[test]
    fn numbers_of_series_with_an_x_of_their_own_stand_below_each_other() {
        let chart = Chart::new("title", "x", "y")
            .with(Series::new("a", vec![[0.0, 1.0], [1.0, 2.0]]))
            .with(Series::new("b", vec![[5.0, 6.0]]));
        let Numbers { columns, rows, series } = chart.numbers();
        assert_eq!(
            (columns, series),
            (["x", "y"].map(String::from).to_vec(), ["a", "a", "b"].map(String::from).to_vec())
        );
        assert_eq!(rows, [[0.0, 1.0], [1.0, 2.0], [5.0, 6.0]]);
    }

    /// How many pixels have about this colour.
    fn count(picture: &RgbImage, colour: Colour) -> usize {
        let near = |pixel: &image::Rgb<u8>| pixel.0.iter().zip(colour).all(|(&a, b)| a.abs_diff(b) < 12);
        picture.pixels().filter(|pixel| near(pixel)).count()
    }

    #[test]
    fn every_series_leaves_its_colour_and_stays_within_the_plot() {
        let wave = |phase: f64| Series::function("wave", [0.0, 6.0], 200, move |x| (x + phase).sin());
        let chart = Chart::new("Waves", "x", "y")
            .with(wave(0.0))
            .with(wave(1.0).stroke(Stroke::Dashed))
            .with(wave(2.0).stroke(Stroke::Dotted))
            .with(Series::new("points", vec![[1.0, 0.5], [2.0, 0.9]]).stroke(Stroke::Points))
            .mark("here", Along::Vertical, 3.0)
            .range_y(-0.5, 1.5);
        let picture = chart.picture().unwrap();
        assert_eq!([picture.width(), picture.height()], chart.size);
        let counts: Vec<_> = COLOURS[..4].iter().map(|&colour| count(&picture, colour)).collect();
        assert!(counts[0] > 900 && counts[1] > 400 && counts[2] > 150 && counts[3] > 50, "{counts:?}");
        assert!(counts[0] > counts[1] && counts[1] > counts[2], "dashes and dots leave gaps: {counts:?}");
        // What lies below the range is cut off: nothing of the waves reaches the numbers below the plot.
        let below = image::imageops::crop_imm(&picture, 0, 550, 960, 50).to_image();
        assert!(COLOURS[..4].iter().all(|&colour| count(&below, colour) == 0));
    }

    #[test]
    fn letters_are_drawn() {
        let with = Chart::new("A title", "x", "y").picture().unwrap();
        let without = Chart::new("", "x", "y").picture().unwrap();
        assert!(count(&with, [0, 0, 0]) + count(&with, [40, 40, 40]) > count(&without, [0, 0, 0]) + 50);
        assert!(Chart::new("A <title>", "x", "y").svg().unwrap().unwrap().contains("A &lt;title&gt;"));
    }
}
