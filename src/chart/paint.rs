//! Charts drawn with `plotters`: four times as large as they become, because its lines lie on whole pixels.

mod marks;

use std::sync::OnceLock;

use image::RgbImage;
use plotters::coord::Shift;
use plotters::prelude::{
    BitMapBackend, Circle, DrawingArea, DrawingBackend, IntoDrawingArea as _, PathElement, Rectangle, SVGBackend,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontStyle, FontTransform, IntoFont as _, RGBColor, ShapeStyle, TextStyle};

use super::axis::{Scale, Tick};
use super::layout::Layout;
use super::line::{Point, clipped, dashes};
use super::{Axis, COLOURS, Chart, Colour, Series, Stroke};
use crate::{Error, Result};

/// Drawn pixels along a side of a pixel of the picture.
pub(super) const FINE: i32 = 4;

/// Sizes in pixels of the picture.
pub(super) const MARGIN: [i32; 4] = [92, 24, 28, 68]; // left, top, right, bottom
pub(super) const TITLE: i32 = 40;
pub(super) const LEGEND_ROW: i32 = 27;
pub(super) const SWATCH: i32 = 40;
pub(super) const BAR: [i32; 3] = [24, 22, 84]; // gap, bar, numbers
const TITLE_FONT: f64 = 25.0;
const LABEL_FONT: f64 = 21.0;
pub(super) const FONT: f64 = 19.0;

/// `plotters` takes a font's box to be less high than it is.
pub(super) const BITMAP_DROP: i32 = 3 * FINE;

const INK: Colour = [30, 30, 30];
const GRID: Colour = [222, 222, 222];

/// The size of a chart around a plot of `plot` pixels, without a legend.
pub(super) fn size_around([width, height]: [u32; 2], bar: bool) -> [u32; 2] {
    let [left, top, right, bottom] = MARGIN;
    let beside = if bar { BAR.iter().sum() } else { 0 };
    [width + (left + right + beside) as u32, height + (top + TITLE + bottom) as u32]
}

pub(super) fn picture(chart: &Chart) -> Result<RgbImage> {
    let layout = Layout::new(chart);
    let [width, height] = chart.size.map(|side| side * FINE as u32);
    let mut fine = RgbImage::from_pixel(width, height, image::Rgb([255; 3]));
    if let Some(backdrop) = &chart.backdrop {
        let [left, top, right, bottom] = layout.plot;
        let size = [right - left, bottom - top].map(|side| side.max(1) as u32);
        // Whole texels stay sharp when enlarged; what must shrink is averaged.
        let enlarges = size[0] >= backdrop.width() && size[1] >= backdrop.height();
        let filter = if enlarges { image::imageops::Nearest } else { image::imageops::Triangle };
        let scaled = image::imageops::resize(backdrop, size[0], size[1], filter);
        image::imageops::replace(&mut fine, &scaled, i64::from(left), i64::from(top));
    }
    {
        let area = BitMapBackend::with_buffer(&mut fine, (width, height)).into_drawing_area();
        Painter { drop: BITMAP_DROP, area: &area, chart, layout: &layout }.paint()?;
        area.present().map_err(failed)?;
    }
    Ok(image::imageops::thumbnail(&fine, chart.size[0], chart.size[1]))
}

pub(super) fn svg(chart: &Chart) -> Result<String> {
    let layout = Layout::new(chart);
    let [width, height] = chart.size.map(|side| side * FINE as u32);
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
        area.fill(&plotters::style::WHITE).map_err(failed)?;
        Painter { drop: 0, area: &area, chart, layout: &layout }.paint()?;
        area.present().map_err(failed)?;
    }
    // Shown at the chart's own size; the view box keeps the fine coordinates.
    let size = |[width, height]: [u32; 2]| format!("width=\"{width}\" height=\"{height}\"");
    Ok(text.replacen(&size([width, height]), &size(chart.size), 1))
}

pub(super) fn failed(error: impl std::fmt::Display) -> Error {
    Error::Chart(error.to_string())
}

pub(super) fn font(size: f64) -> Result<TextStyle<'static>> {
    const COLOUR: RGBColor = RGBColor(INK[0], INK[1], INK[2]);
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    let register =
        || plotters::style::register_font("sans-serif", FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT).is_ok();
    if *REGISTERED.get_or_init(register) {
        Ok(TextStyle::from(("sans-serif", size * f64::from(FINE)).into_font()).color(&COLOUR))
    } else {
        Err(Error::Chart("the font that is built in is damaged".into()))
    }
}

pub(super) fn rgb([red, green, blue]: Colour) -> RGBColor {
    RGBColor(red, green, blue)
}

fn colour(series: &Series, index: usize) -> Colour {
    series.colour.unwrap_or(COLOURS[index % COLOURS.len()])
}

/// The drawn width of a text.
pub(super) fn text_width(text: &str, size: f64) -> i32 {
    let measured = font(size).ok().and_then(|style| style.font.box_size(text).ok());
    measured.map_or(0, |(width, _)| width as i32)
}

struct Painter<'a, B: DrawingBackend> {
    /// How far the backend's letters stand above where they should, in fine pixels.
    drop: i32,
    area: &'a DrawingArea<B, Shift>,
    chart: &'a Chart,
    layout: &'a Layout,
}

impl<B: DrawingBackend> Painter<'_, B> {
    fn paint(&self) -> Result<()> {
        self.grid()?;
        self.marks()?;
        for (index, series) in self.chart.series.iter().enumerate() {
            self.series(series, colour(series, index))?;
        }
        self.mark_labels()?;
        self.frame(self.layout.plot)?;
        self.numbers()?;
        self.bar()?;
        self.titles()?;
        self.legend()
    }

    fn line(&self, points: &[Point], colour: Colour, width: f64) -> Result<()> {
        let mut whole: Vec<(i32, i32)> = points.iter().map(|p| (p[0].round() as i32, p[1].round() as i32)).collect();
        whole.dedup();
        let style = ShapeStyle::from(rgb(colour)).stroke_width((width * f64::from(FINE)).round() as u32);
        self.area.draw(&PathElement::new(whole, style)).map_err(failed)
    }

    fn frame(&self, [left, top, right, bottom]: [i32; 4]) -> Result<()> {
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        self.line(&corners.map(|corner| corner.map(f64::from)), INK, 1.0)
    }

    fn text(&self, text: &str, size: f64, at: [i32; 2], anchor: (HPos, VPos), turned: bool) -> Result<()> {
        if text.is_empty() {
            return Ok(());
        }
        let style = font(size)?.pos(Pos::new(anchor.0, anchor.1));
        let style = if turned { style.transform(FontTransform::Rotate270) } else { style };
        let [right, down] = if turned { [self.drop, 0] } else { [0, self.drop] };
        self.area.draw_text(text, &style, (at[0] + right, at[1] + down)).map_err(failed)
    }

    fn grid(&self) -> Result<()> {
        let [left, top, right, bottom] = self.layout.plot.map(f64::from);
        if self.chart.backdrop.is_some() {
            return Ok(());
        }
        let (across, up) = self.ticks();
        for tick in across {
            let x = self.layout.x(tick.place);
            self.line(&[[x, top], [x, bottom]], GRID, if tick.label.is_some() { 1.0 } else { 0.5 })?;
        }
        for tick in up {
            let y = self.layout.y(tick.place);
            self.line(&[[left, y], [right, y]], GRID, if tick.label.is_some() { 1.0 } else { 0.5 })?;
        }
        Ok(())
    }

    /// The ticks of both axes, as many numbers as there is room for.
    fn ticks(&self) -> (Vec<Tick>, Vec<Tick>) {
        let [left, top, right, bottom] = self.layout.plot.map(|side| side / FINE);
        let room = |pixels: i32, each: i32| (pixels / each).max(2) as usize;
        (self.layout.x.ticks(room(right - left, 90)), self.layout.y.ticks(room(bottom - top, 50)))
    }

    fn numbers(&self) -> Result<()> {
        let [left, _, _, bottom] = self.layout.plot;
        let (across, up) = self.ticks();
        for Tick { place, label } in across {
            let x = self.layout.x(place);
            let length = if label.is_some() { 6 } else { 3 };
            self.line(&[[x, f64::from(bottom)], [x, f64::from(bottom + length * FINE)]], INK, 1.0)?;
            let at = [x as i32, bottom + 9 * FINE];
            self.text(label.as_deref().unwrap_or(""), FONT, at, (HPos::Center, VPos::Top), false)?;
        }
        for Tick { place, label } in up {
            let y = self.layout.y(place);
            let length = if label.is_some() { 6 } else { 3 };
            self.line(&[[f64::from(left), y], [f64::from(left - length * FINE), y]], INK, 1.0)?;
            let at = [left - 10 * FINE, y as i32];
            self.text(label.as_deref().unwrap_or(""), FONT, at, (HPos::Right, VPos::Center), false)?;
        }
        Ok(())
    }

    fn titles(&self) -> Result<()> {
        let [left, top, right, bottom] = self.layout.plot;
        let [width, height] = self.chart.size.map(|side| side as i32 * FINE);
        let (center, middle) = ((left + right) / 2, (top + bottom) / 2);
        // A title that is too long becomes smaller instead of losing its ends.
        let room = f64::from(width - 2 * 12 * FINE) / f64::from(text_width(&self.chart.title, TITLE_FONT).max(1));
        let title = TITLE_FONT * room.min(1.0);
        self.text(&self.chart.title, title, [width / 2, 28 * FINE], (HPos::Center, VPos::Center), false)?;
        let below = [center, height - 22 * FINE];
        self.text(&self.chart.x.label, LABEL_FONT, below, (HPos::Center, VPos::Center), false)?;
        self.text(&self.chart.y.label, LABEL_FONT, [18 * FINE, middle], (HPos::Center, VPos::Center), true)
    }

    fn legend(&self) -> Result<()> {
        for (row, y) in self.layout.legend.iter().zip((0..).map(|row| FINE * (MARGIN[1] + TITLE + LEGEND_ROW * row))) {
            for &(index, x) in row {
                let series = &self.chart.series[index];
                let middle = f64::from(y + FINE * 6);
                let ends = [f64::from(x), f64::from(x + SWATCH * FINE)];
                let swatch = [[ends[0], middle], [ends[1], middle]];
                self.stroke(&swatch, series.stroke, colour(series, index))?;
                self.point([0.5 * (ends[0] + ends[1]), middle], series.stroke, colour(series, index))?;
                let at = [x + (SWATCH + 9) * FINE, y + FINE * 6];
                self.text(&series.label, FONT, at, (HPos::Left, VPos::Center), false)?;
            }
        }
        Ok(())
    }

    fn series(&self, series: &Series, colour: Colour) -> Result<()> {
        if series.stroke == Stroke::Legend {
            return Ok(());
        }
        let [left, top, right, bottom] = self.layout.plot.map(f64::from);
        let points = || series.points.iter().map(|&point| self.layout.point(point));
        if !matches!(series.stroke, Stroke::Points | Stroke::Rings) {
            for part in clipped(points(), [left, top], [right, bottom]) {
                self.stroke(&part, series.stroke, colour)?;
            }
        }
        let inside = |p: &Point| p[0] >= left && p[0] <= right && p[1] >= top && p[1] <= bottom;
        points().flatten().filter(inside).try_for_each(|point| self.point(point, series.stroke, colour))
    }

    /// What a stroke draws at a point: a disc, a ring, or nothing.
    fn point(&self, [x, y]: Point, stroke: Stroke, colour: Colour) -> Result<()> {
        let (radius, style) = match stroke {
            Stroke::Points | Stroke::Joined => (4 * FINE + FINE / 2, rgb(colour).filled()),
            Stroke::Rings => (8 * FINE, rgb(colour).stroke_width(2 * FINE as u32)),
            _ => return Ok(()),
        };
        self.area.draw(&Circle::new((x.round() as i32, y.round() as i32), radius, style)).map_err(failed)
    }

    fn stroke(&self, line: &[Point], stroke: Stroke, colour: Colour) -> Result<()> {
        let fine = f64::from(FINE);
        let [on, off] = match stroke {
            Stroke::Points | Stroke::Rings => return Ok(()),
            Stroke::Solid | Stroke::Joined | Stroke::Legend => return self.line(line, colour, 2.2),
            Stroke::Dashed => [11.0, 6.0],
            Stroke::Dotted => [2.5, 5.0],
        };
        dashes(line, on * fine, off * fine).iter().try_for_each(|dash| self.line(dash, colour, 2.2))
    }

    fn bar(&self) -> Result<()> {
        let Some(bar) = &self.chart.bar else { return Ok(()) };
        let [_, top, right, bottom] = self.layout.plot;
        let [left, right] = [right + BAR[0] * FINE, right + (BAR[0] + BAR[1]) * FINE];
        let scale =
            Scale::new(&Axis { range: Some(bar.axis.range.unwrap_or([0.0, 1.0])), ..bar.axis.clone() }, [].into_iter());
        for y in top..bottom {
            let place = f64::from(bottom - y) / f64::from(bottom - top);
            let style = rgb(bar.map.colour(place)).filled();
            self.area.draw(&Rectangle::new([(left, y), (right, y + 1)], style)).map_err(failed)?;
        }
        self.frame([left, top, right, bottom])?;
        for Tick { place, label } in scale.ticks(((bottom - top) / FINE / 50).max(2) as usize) {
            let y = self.layout.y(place);
            self.line(&[[f64::from(right), y], [f64::from(right + 5 * FINE), y]], INK, 1.0)?;
            let at = [right + 9 * FINE, y as i32];
            self.text(label.as_deref().unwrap_or(""), FONT, at, (HPos::Left, VPos::Center), false)?;
        }
        let width = self.chart.size[0] as i32 * FINE;
        let at = [width - 14 * FINE, (top + bottom) / 2];
        self.text(&bar.axis.label, LABEL_FONT, at, (HPos::Center, VPos::Center), true)
    }
}
