//! Where the parts of a chart stand.

use super::axis::Scale;
use super::line::Point;
use super::paint::{BAR, FINE, FONT, LEGEND_ROW, MARGIN, SWATCH, TITLE, text_width};
use super::{Along, Chart};

/// A line of the legend: entries by index, and where each begins.
pub(super) type LegendRow = Vec<(usize, i32)>;

/// Where things stand, in fine pixels.
pub(super) struct Layout {
    pub plot: [i32; 4],
    pub legend: Vec<LegendRow>,
    pub x: Scale,
    pub y: Scale,
}

impl Layout {
    pub fn new(chart: &Chart) -> Self {
        let [width, height] = chart.size.map(|side| side as i32 * FINE);
        let [left, top, right, bottom] = MARGIN.map(|side| side * FINE);
        let beside = if chart.bar.is_some() { BAR.iter().sum::<i32>() * FINE } else { 0 };
        let legend = legend(chart, left, width - right);
        let above = top + FINE * (TITLE + LEGEND_ROW * legend.len() as i32);
        let along = |axis: usize| chart.series.iter().flat_map(move |s| s.points.iter().map(move |point| point[axis]));
        let marks = |along: Along| chart.marks.iter().filter(move |mark| mark.along == along).map(|mark| mark.at);
        Self {
            plot: [left, above, width - right - beside, height - bottom],
            legend,
            x: Scale::new(&chart.x, along(0).chain(marks(Along::Vertical))),
            y: Scale::new(&chart.y, along(1).chain(marks(Along::Horizontal))),
        }
    }

    pub fn x(&self, place: f64) -> f64 {
        f64::from(self.plot[0]) + place * f64::from(self.plot[2] - self.plot[0])
    }

    pub fn y(&self, place: f64) -> f64 {
        f64::from(self.plot[3]) - place * f64::from(self.plot[3] - self.plot[1])
    }

    pub fn point(&self, [x, y]: [f64; 2]) -> Option<Point> {
        Some([self.x(self.x.place(x)?), self.y(self.y.place(y)?)])
    }
}

/// The legend's rows: as many entries in each as find room.
fn legend(chart: &Chart, left: i32, right: i32) -> Vec<LegendRow> {
    let mut rows: Vec<LegendRow> = Vec::new();
    let mut next = right;
    for (index, series) in chart.series.iter().enumerate().filter(|(_, series)| !series.label.is_empty()) {
        let width = text_width(&series.label, FONT) + FINE * (SWATCH + 34);
        if rows.is_empty() || next + width > right {
            rows.push(Vec::new());
            next = left;
        }
        rows.last_mut().expect("pushed above").push((index, next));
        next += width;
    }
    rows
}
