//! Drawings of shapes at places in pixels, to scale and without axes. Four times as fine as they become, as charts are.

use std::fmt::Write as _;
use std::io::Cursor;
use std::path::Path;

use image::{ImageFormat, RgbImage};
use plotters::coord::Shift;
use plotters::element::Polygon;
use plotters::prelude::{BitMapBackend, DrawingArea, DrawingBackend, IntoDrawingArea as _, PathElement, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, ShapeStyle};

use super::line::{clipped, dashes};
use super::paint::{self, BITMAP_DROP, FINE, failed, font, rgb};
use super::{Colour, Kind, write_png};
use crate::printable::printable;
use crate::{Result, target};

/// A place, in pixels from the left and from the top.
type Point = [f64; 2];

/// What can be on a sheet.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A polygon, filled.
    Area {
        /// Its corners.
        outline: Vec<Point>,
        /// The colour within.
        fill: Colour,
    },
    /// A line through points.
    Line {
        /// Its points.
        points: Vec<Point>,
        /// Its colour.
        colour: Colour,
        /// In pixels.
        width: f64,
        /// Lengths of dashes and of the gaps between them, in pixels; none where it is solid.
        dashed: Option<[f64; 2]>,
    },
    /// A line of text.
    Text {
        /// What it says.
        text: String,
        /// The middle of the end that the anchor names.
        at: Point,
        /// The height of its letters, in pixels.
        size: f64,
        /// Its colour.
        colour: Colour,
        /// Which end is at the place.
        anchor: Anchor,
    },
    /// A picture.
    Picture {
        /// Its pixels, one for each of the sheet.
        picture: RgbImage,
        /// Its upper left corner.
        at: [u32; 2],
    },
}

/// Which part of a text is at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Its left end.
    Left,
    /// Its middle.
    Middle,
    /// Its right end.
    Right,
}

/// A drawing.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// Width and height, in pixels.
    pub size: [u32; 2],
    /// The colour on which all else is.
    pub ground: Colour,
    /// What is drawn, the first lowest; but pictures lie below all shapes.
    pub shapes: Vec<Shape>,
}

/// The width of a text whose letters are so high, in pixels.
pub fn text_width(text: &str, size: f64) -> f64 {
    f64::from(paint::text_width(text, size)) / f64::from(FINE)
}

impl Sheet {
    /// A sheet with nothing on it.
    pub fn new(size: [u32; 2], ground: Colour) -> Self {
        Self { size, ground, shapes: Vec::new() }
    }

    /// Adds a polygon.
    pub fn area(&mut self, outline: Vec<Point>, fill: Colour) {
        self.shapes.push(Shape::Area { outline, fill });
    }

    /// Adds a line.
    pub fn line(&mut self, points: Vec<Point>, colour: Colour, width: f64) {
        self.shapes.push(Shape::Line { points, colour, width, dashed: None });
    }

    /// Adds what of a line is within a rectangle, by its corners.
    pub fn line_within(&mut self, [low, high]: [Point; 2], points: Vec<Point>, colour: Colour, width: f64) {
        for part in clipped(points.into_iter().map(Some), low, high) {
            self.line(part, colour, width);
        }
    }

    /// Adds a text.
    pub fn text(&mut self, text: impl Into<String>, at: Point, size: f64, colour: Colour, anchor: Anchor) {
        // What a file calls a lens may hold what no XML does.
        let text = printable(&text.into()).into_owned();
        self.shapes.push(Shape::Text { text, at, size, colour, anchor });
    }

    /// Writes the sheet.
    ///
    /// # Errors
    /// [`crate::Error::Chart`] where it cannot be drawn, [`crate::Error::Write`] and [`crate::Error::Exists`] where it cannot be written.
    pub fn write(&self, path: &Path, kind: Kind, overwrite: bool) -> Result<()> {
        match kind {
            Kind::Svg => target::write_text(path, &self.svg()?, overwrite),
            Kind::Png => write_png(path, &self.picture()?, overwrite),
        }
    }

    /// The sheet as pixels.
    ///
    /// # Errors
    /// [`crate::Error::Chart`] where it cannot be drawn.
    pub fn picture(&self) -> Result<RgbImage> {
        let [width, height] = self.size.map(|side| side * FINE as u32);
        let mut fine = RgbImage::from_pixel(width, height, image::Rgb(self.ground));
        for (picture, at) in self.pictures() {
            let [w, h] = [picture.width(), picture.height()].map(|side| side * FINE as u32);
            let large = image::imageops::resize(picture, w, h, image::imageops::Nearest);
            let [x, y] = at.map(|side| i64::from(side) * i64::from(FINE));
            image::imageops::replace(&mut fine, &large, x, y);
        }
        {
            let area = BitMapBackend::with_buffer(&mut fine, (width, height)).into_drawing_area();
            self.paint(&area, BITMAP_DROP)?;
            area.present().map_err(failed)?;
        }
        Ok(image::imageops::thumbnail(&fine, self.size[0], self.size[1]))
    }

    /// The sheet as SVG, with its pictures in it as PNG.
    ///
    /// # Errors
    /// [`crate::Error::Chart`] where it cannot be drawn.
    pub fn svg(&self) -> Result<String> {
        let [width, height] = self.size.map(|side| side * FINE as u32);
        let mut shapes = String::new();
        {
            let area = SVGBackend::with_string(&mut shapes, (width, height)).into_drawing_area();
            self.paint(&area, 0)?;
            area.present().map_err(failed)?;
        }
        let [red, green, blue] = self.ground;
        let mut below =
            format!("<rect width=\"{width}\" height=\"{height}\" fill=\"#{red:02X}{green:02X}{blue:02X}\"/>\n");
        for (picture, at) in self.pictures() {
            let mut png = Cursor::new(Vec::new());
            picture.write_to(&mut png, ImageFormat::Png).map_err(failed)?;
            let [x, y, w, h] = [at[0], at[1], picture.width(), picture.height()].map(|side| side * FINE as u32);
            let place = format!("x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"");
            // Writing to a string cannot fail.
            let _ = writeln!(below, "<image {place} href=\"data:image/png;base64,{}\"/>", base64(png.get_ref()));
        }
        // Behind the opening tag, which is shown at the sheet's own size; the view box keeps the fine coordinates.
        let size = |[width, height]: [u32; 2]| format!("width=\"{width}\" height=\"{height}\"");
        let (open, rest) = shapes.split_once('>').unwrap_or((&shapes, ""));
        Ok(format!("{}>\n{below}{rest}", open.replacen(&size([width, height]), &size(self.size), 1)))
    }

    pub(super) fn pictures(&self) -> impl Iterator<Item = (&RgbImage, [u32; 2])> {
        self.shapes.iter().filter_map(|shape| match shape {
            Shape::Picture { picture, at } => Some((picture, *at)),
            _ => None,
        })
    }

    fn paint<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, drop: i32) -> Result<()> {
        self.shapes.iter().try_for_each(|shape| match shape {
            Shape::Area { outline, fill } => {
                area.draw(&Polygon::new(fine(outline), rgb(*fill).filled())).map_err(failed)
            }
            Shape::Line { points, colour, width, dashed } => {
                let pieces = match dashed {
                    Some([on, off]) => dashes(points, *on, *off),
                    None => vec![points.clone()],
                };
                let wide = (width * f64::from(FINE)).round().max(1.0) as u32;
                let style = ShapeStyle::from(rgb(*colour)).stroke_width(wide);
                pieces.iter().try_for_each(|piece| area.draw(&PathElement::new(fine(piece), style)).map_err(failed))
            }
            Shape::Text { text, at, size, colour, anchor } => {
                let side = match anchor {
                    Anchor::Left => HPos::Left,
                    Anchor::Middle => HPos::Center,
                    Anchor::Right => HPos::Right,
                };
                let ink = rgb(*colour);
                let style = font(*size)?.color(&ink).pos(Pos::new(side, VPos::Center));
                let [x, y] = at.map(|side| (side * f64::from(FINE)).round() as i32);
                area.draw_text(text, &style, (x, y + drop)).map_err(failed)
            }
            Shape::Picture { .. } => Ok(()),
        })
    }
}

/// In the coordinates that are drawn; one point where several fall together.
fn fine(points: &[Point]) -> Vec<(i32, i32)> {
    let whole = |side: f64| (side * f64::from(FINE)).round() as i32;
    let mut points: Vec<_> = points.iter().map(|&[x, y]| (whole(x), whole(y))).collect();
    points.dedup();
    points
}

/// RFC 4648.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let word = three.iter().chain([&0; 2]).take(3).fold(0_u32, |word, &byte| word << 8 | u32::from(byte));
        for digit in 0..4 {
            let six = (word >> (18 - 6 * digit)) & 63;
            text.push(if digit <= three.len() { char::from(DIGITS[six as usize]) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_rfc() {
        for (bytes, text) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("fooba", "Zm9vYmE=")]
        {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }

    #[test]
    fn shapes_are_where_they_were_put_and_pictures_below_them() {
        let mut sheet = Sheet::new([40, 30], [0; 3]);
        sheet.area(vec![[5.0, 5.0], [15.0, 5.0], [15.0, 15.0], [5.0, 15.0]], [200, 0, 0]);
        sheet.line_within([[0.0, 0.0], [30.0, 30.0]], vec![[20.0, 10.0], [100.0, 10.0]], [0, 200, 0], 3.0);
        sheet
            .shapes
            .push(Shape::Picture { picture: RgbImage::from_pixel(20, 10, image::Rgb([0, 0, 200])), at: [0, 10] });
        let drawn = sheet.picture().unwrap();
        let at = |x, y| drawn.get_pixel(x, y).0;
        assert_eq!([at(10, 8), at(10, 13), at(25, 10)], [[200, 0, 0], [200, 0, 0], [0, 200, 0]]);
        assert_eq!([at(2, 15), at(18, 19), at(2, 5), at(35, 10)], [[0, 0, 200], [0, 0, 200], [0; 3], [0; 3]]);
        let svg = sheet.svg().unwrap();
        assert!(svg.starts_with("<svg width=\"40\" height=\"30\" viewBox=\"0 0 160 120\""), "{svg}");
        let [image, polygon] = ["<image", "<polygon"].map(|tag| svg.find(tag).unwrap());
        assert!(image < polygon && svg.trim_end().ends_with("</svg>"), "{svg}");
    }
}
