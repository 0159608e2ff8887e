//! The marks of a chart: lines across the plot, and their labels, which keep off the curves.

use plotters::prelude::{DrawingBackend, Rectangle};
use plotters::style::Color as _;
use plotters::style::text_anchor::{HPos, VPos};

use super::super::line::{Point, clipped, dashes};
use super::super::{Along, Mark, Series};
use super::{FINE, FONT, Painter, failed, text_width};
use crate::Result;

impl<B: DrawingBackend> Painter<'_, B> {
    /// The two ends of a mark's line; none where it has no place.
    fn mark(&self, mark: &Mark) -> Option<[Point; 2]> {
        let [left, top, right, bottom] = self.layout.plot.map(f64::from);
        match mark.along {
            Along::Vertical => {
                self.layout.x.place(mark.at).map(|place| self.layout.x(place)).map(|x| [[x, top], [x, bottom]])
            }
            Along::Horizontal => {
                self.layout.y.place(mark.at).map(|place| self.layout.y(place)).map(|y| [[left, y], [right, y]])
            }
        }
    }

    pub(super) fn marks(&self) -> Result<()> {
        for line in self.chart.marks.iter().filter_map(|mark| self.mark(mark)) {
            for dash in dashes(&line, 7.0 * f64::from(FINE), 4.0 * f64::from(FINE)) {
                self.line(&dash, [110; 3], 1.2)?;
            }
        }
        Ok(())
    }

    /// The marks' labels, on white, over the curves.
    pub(super) fn mark_labels(&self) -> Result<()> {
        for (mark, ends) in self.chart.marks.iter().filter_map(|mark| Some((mark, self.mark(mark)?))) {
            if mark.label.is_empty() {
                continue;
            }
            let turned = mark.along == Along::Vertical;
            let [low, high] = self.label_box(mark, ends).map(|corner| corner.map(|side| side as i32));
            let white = Rectangle::new([(low[0], low[1]), (high[0], high[1])], plotters::style::WHITE.filled());
            self.area.draw(&white).map_err(failed)?;
            let center = [0, 1].map(|axis| (low[axis] + high[axis]) / 2);
            self.text(&mark.label, FONT, center, (HPos::Center, VPos::Center), turned)?;
        }
        Ok(())
    }

    /// The corners of a mark's label: right of a line that goes up, at its top; above one that goes across, at its right
    /// end; or at the other end, where that covers no curve and this does.
    fn label_box(&self, mark: &Mark, [start, end]: [Point; 2]) -> [Point; 2] {
        let fine = f64::from(FINE);
        let (long, thick) = (f64::from(text_width(&mark.label, FONT)) + 8.0 * fine, 20.0 * fine);
        let (size, corners) = match mark.along {
            Along::Vertical => {
                let left = start[0] + 2.0 * fine;
                ([thick, long], [[left, start[1] + 3.0 * fine], [left, end[1] - 3.0 * fine - long]])
            }
            Along::Horizontal => {
                let top = start[1] - 2.0 * fine - thick;
                ([long, thick], [[end[0] - 3.0 * fine - long, top], [start[0] + 3.0 * fine, top]])
            }
        };
        let boxes = corners.map(|[x, y]| [[x, y], [x + size[0], y + size[1]]]);
        let free = |[low, high]: &[Point; 2]| {
            let covers = |series: &Series| {
                let points = series.points.iter().map(|&point| self.layout.point(point));
                !clipped(points, *low, *high).is_empty()
            };
            !self.chart.series.iter().any(covers)
        };
        *boxes.iter().find(|corners| free(corners)).unwrap_or(&boxes[0])
    }
}
