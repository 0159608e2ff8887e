//! The picture plane: where each pixel lies.
//!
//! The origin is the centre of the picture, x points right, y up, and the unit is half the picture's height, or what a look says
//! instead, so that a scene means the same at every resolution. Rows of pixels are counted from the top. This is the one place that turns
//! one into the other.

use std::ops::RangeInclusive;

use glam::DVec2;

/// A rectangle of pixels; (0, 0) is the top left pixel of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// Column of the left-most pixel; negative where the window begins left of the picture.
    pub x: i32,
    /// Row of the top pixel; negative where the window begins above the picture.
    pub y: i32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Window {
    /// How many pixels the window holds.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// So many of its columns and rows, from one on that is counted from its own corner.
    pub(crate) fn part(&self, x: u32, y: u32, width: u32, height: u32) -> Self {
        Self { x: self.x + x as i32, y: self.y + y as i32, width, height }
    }
}

/// The picture (OpenEXR's display window), and the window of pixels that is stored (its data window).
///
/// The picture alone sets the coordinates; the window may lie inside it, reach beyond it or miss it. Where pixels are not
/// square, the picture plane is that on which it is shown: a round ghost is round there, and not in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// The pixels that are stored.
    pub window: Window,
    /// Width of a pixel over its height as it is shown, [`Frame::PIXEL_ASPECTS`]; 1 in most pictures.
    pub pixel_aspect: f64,
    /// The unit of lengths, in half picture heights, > 0; 1 unless a look says otherwise.
    pub unit: f64,
}

impl Frame {
    /// What a pixel's width over its height may be.
    pub const PIXEL_ASPECTS: RangeInclusive<f64> = 1e-3..=1e3;

    /// A picture of `width` × `height` square pixels, all of them stored.
    pub const fn full(width: u32, height: u32) -> Self {
        Self { width, height, window: Window { x: 0, y: 0, width, height }, pixel_aspect: 1.0, unit: 1.0 }
    }

    /// Another picture of `width` × `height` pixels, all of them stored, that are shaped like these; half its height is as many
    /// units as half the height of this one.
    pub const fn resized(self, width: u32, height: u32) -> Self {
        Self { pixel_aspect: self.pixel_aspect, unit: self.unit, ..Self::full(width, height) }
    }

    /// The same picture with lengths in another unit, of so many half picture heights.
    pub const fn in_units_of(self, unit: f64) -> Self {
        Self { unit, ..self }
    }

    /// Whether what is stored is the picture, and nothing but it.
    pub fn is_whole(&self) -> bool {
        self.window == Self::full(self.width, self.height).window
    }

    /// The picture's height, in half units: what its rows are counted by.
    fn tall(&self) -> f64 {
        f64::from(self.height) * self.unit
    }

    /// The same picture with another window of pixels.
    pub const fn with_window(self, window: Window) -> Self {
        Self { window, ..self }
    }

    /// x of the centre of column `i`, which may be fractional: a (2i + 1 − W) / uH, with the pixels' aspect a and the unit u.
    pub fn x(&self, i: f64) -> f64 {
        self.pixel_aspect * (2.0 * i + 1.0 - f64::from(self.width)) / self.tall()
    }

    /// y of the centre of row `j`, counted from the top: (H − 2j − 1) / uH.
    pub fn y(&self, j: f64) -> f64 {
        (f64::from(self.height) - 2.0 * j - 1.0) / self.tall()
    }

    /// The centre of pixel (i, j) of the picture.
    pub fn position(&self, i: f64, j: f64) -> DVec2 {
        DVec2::new(self.x(i), self.y(j))
    }

    /// The column and row, fractional, whose centre is `position`: the inverse of [`Frame::position`].
    pub fn pixel(&self, position: DVec2) -> DVec2 {
        let (h, tall) = (f64::from(self.height), self.tall());
        let x = position.x / self.pixel_aspect;
        DVec2::new((x * tall + f64::from(self.width) - 1.0) / 2.0, (h - 1.0 - position.y * tall) / 2.0)
    }

    /// The height of a pixel, 2 / uH.
    pub fn pixel_size(&self) -> f64 {
        2.0 / self.tall()
    }

    /// The width of a pixel and its height, 2a / uH and 2 / uH.
    pub fn pixel_sides(&self) -> DVec2 {
        DVec2::new(self.pixel_aspect, 1.0) * self.pixel_size()
    }

    /// Half the picture's width on the picture plane, a W / uH.
    pub fn half_width(&self) -> f64 {
        self.pixel_aspect * f64::from(self.width) / self.tall()
    }

    /// Half its height, 1 / u.
    pub fn half_height(&self) -> f64 {
        self.unit.recip()
    }

    /// The smallest and the largest centre of the stored pixels, as (left bottom, right top).
    pub fn bounds(&self) -> (DVec2, DVec2) {
        let Window { x, y, width, height } = self.window;
        let (left, top) = (f64::from(x), f64::from(y));
        let (right, bottom) = (left + f64::from(width) - 1.0, top + f64::from(height) - 1.0);
        (self.position(left, bottom), self.position(right, top))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_pixel_is_top_left_and_the_unit_is_half_the_height() {
        let frame = Frame::full(4, 2);
        assert_eq!(frame.position(0.0, 0.0), DVec2::new(-1.5, 0.5));
        assert_eq!(frame.position(3.0, 1.0), DVec2::new(1.5, -0.5));
        assert_eq!(frame.bounds(), (DVec2::new(-1.5, -0.5), DVec2::new(1.5, 0.5)));
    }

    #[test]
    fn wide_pixels_spread_the_columns_and_nothing_else() {
        let frame = Frame { pixel_aspect: 2.0, ..Frame::full(4, 2) };
        assert_eq!(frame.position(0.0, 0.0), DVec2::new(-3.0, 0.5));
        assert_eq!(frame.bounds(), (DVec2::new(-3.0, -0.5), DVec2::new(3.0, 0.5)));
        assert_eq!((frame.pixel_sides(), frame.half_width()), (DVec2::new(2.0, 1.0), 4.0));
        assert_eq!(frame.pixel(DVec2::new(3.0, -0.5)), DVec2::new(3.0, 1.0));
    }

    #[test]
    fn another_unit_is_another_scale_about_the_centre() {
        let frame = Frame::full(4, 2).in_units_of(2.0);
        assert_eq!(frame.position(0.0, 0.0), DVec2::new(-0.75, 0.25));
        assert_eq!((frame.pixel_size(), frame.half_width(), frame.half_height()), (0.5, 1.0, 0.5));
        assert_eq!(frame.resized(8, 4).pixel_size(), 0.25);
    }

    #[test]
    fn pixel_undoes_position_also_outside_the_picture() {
        let frame = Frame { pixel_aspect: 1.25, ..Frame::full(1921, 1081) }.in_units_of(0.3);
        for (i, j) in [(0.0, 0.0), (1920.0, 1080.0), (-300.25, 2000.5)] {
            let back = frame.pixel(frame.position(i, j));
            assert!((back - DVec2::new(i, j)).length() < 1e-9, "{back}");
        }
    }
}
