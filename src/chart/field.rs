//! Pictures of scalar fields in false colours.

use image::{Rgb, RgbImage};

use super::{Axis, Bar, Chart};
use crate::false_colour::Map;

/// A scalar at every pixel, row by row from the top.
#[derive(Debug, Clone)]
pub struct Scalar {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width` × `height` values.
    pub values: Vec<f64>,
}

/// What a value that is no number is painted with.
const NO_NUMBER: [u8; 3] = [255, 0, 255];

impl Scalar {
    /// The field of `f(column, row)`.
    pub fn from_fn(width: u32, height: u32, f: impl Fn(u32, u32) -> f64) -> Self {
        let values = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        Self { width, height, values: values.map(|(column, row)| f(column, row)).collect() }
    }

    /// The smallest and the largest finite value; 0 and 1 where there is none.
    pub fn range(&self) -> [f64; 2] {
        let finite = self.values.iter().copied().filter(|value| value.is_finite());
        let [low, high] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(v), h.max(v)]);
        if low <= high { [low, high] } else { [0.0, 1.0] }
    }

    /// The field in colours, a pixel a value; `range` is where the map begins and ends. Magenta is no number.
    pub fn colours(&self, map: Map, [low, high]: [f64; 2]) -> RgbImage {
        RgbImage::from_fn(self.width, self.height, |column, row| {
            let value = self.values[(row * self.width + column) as usize];
            let place = if high > low { (value - low) / (high - low) } else { 0.5 };
            Rgb(if value.is_nan() { NO_NUMBER } else { map.colour(place) })
        })
    }

    /// A chart of the field with a colour bar; its plot is about `side` pixels along its longer side.
    ///
    /// `x` and `y` say what the axes are and where the field begins and ends; `value` what the colours are, by default
    /// from the smallest to the largest value.
    pub fn chart(&self, title: &str, [x, y]: [Axis; 2], value: Axis, map: Map, side: u32) -> Chart {
        let range = value.range.unwrap_or_else(|| self.range());
        let longer = f64::from(self.width.max(self.height));
        let plot = [self.width, self.height].map(|pixels| (f64::from(side * pixels) / longer).round() as u32);
        let mut chart = Chart::new(title, x.label.clone(), y.label.clone()).backdrop(self.colours(map, range));
        (chart.x, chart.y) = (x, y);
        chart.bar = Some(Bar { axis: Axis { range: Some(range), ..value }, map });
        chart.size = super::paint::size_around(plot, true);
        chart
    }
}

/// Pictures beside one another, aligned at the top, with white between them.
pub fn side_by_side(pictures: &[RgbImage]) -> RgbImage {
    const GAP: u32 = 12;
    let height = pictures.iter().map(RgbImage::height).max().unwrap_or(1);
    let gaps = GAP * (pictures.len().max(1) as u32 - 1);
    let width = pictures.iter().map(RgbImage::width).sum::<u32>() + gaps;
    let mut all = RgbImage::from_pixel(width.max(1), height, Rgb([255; 3]));
    let mut left = 0;
    for picture in pictures {
        image::imageops::replace(&mut all, picture, i64::from(left), 0);
        left += picture.width() + GAP;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_has_the_colours_of_its_values_top_row_first() {
        let field = Scalar::from_fn(2, 2, |column, row| [[0.0, 1.0], [0.5, f64::NAN]][row as usize][column as usize]);
        assert_eq!(field.range(), [0.0, 1.0]);
        let picture = field.colours(Map::Grey, [0.0, 1.0]);
        assert_eq!(picture.pixels().map(|pixel| pixel.0).collect::<Vec<_>>(), [[0; 3], [255; 3], [128; 3], NO_NUMBER]);
        let error = [-1.0, 0.0, 1.0].map(|value| Map::RedBlue.colour(0.5 + 0.5 * value));
        assert!(error[0][2] > error[0][0] && error[2][0] > error[2][2], "blue below, red above: {error:?}");
        assert!(error[1].iter().all(|&c| c > 235), "white in the middle: {error:?}");
    }

    #[test]
    fn the_chart_of_a_field_shows_all_of_it() {
        let field = Scalar::from_fn(40, 20, |column, _| f64::from(column / 20));
        let axis = |label: &str, range| Axis { label: label.into(), range: Some(range), log: false };
        let value = Axis { label: "value".into(), ..Axis::default() };
        let chart = field.chart("Halves", [axis("x", [0.0, 2.0]), axis("y", [0.0, 1.0])], value, Map::Viridis, 400);
        let picture = chart.picture().unwrap();
        for colour in [0.0, 1.0].map(|place| Map::Viridis.colour(place)) {
            let count = picture.pixels().filter(|pixel| pixel.0 == colour).count();
            assert!((36_000..42_000).contains(&count), "half of 400 x 200 pixels, less the lines on it: {count}");
        }
    }

    #[test]
    fn pictures_stand_side_by_side() {
        let [red, blue] = [[255, 0, 0], [0, 0, 255]].map(|colour| RgbImage::from_pixel(3, 5, Rgb(colour)));
        let all = side_by_side(&[red, blue]);
        assert_eq!([all.width(), all.height()], [18, 5]);
        assert_eq!(
            [all.get_pixel(0, 4).0, all.get_pixel(10, 0).0, all.get_pixel(17, 4).0],
            [[255, 0, 0], [255; 3], [0, 0, 255]]
        );
    }
}
