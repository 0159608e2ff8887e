//! A picture in false colours with its legend, as a sheet: numbers from some decades, without axes of its own.

use image::imageops::{FilterType, resize};
use image::{Rgb, RgbImage};

use super::axis::Scale;
use super::sheet::text_width;
use super::{Anchor, Axis, Colour, Map, Scalar, Shape, Sheet};

/// Sizes in pixels of the sheet.
const MARGIN: u32 = 24;
/// Of the line that the title and the unit stand on.
const HEAD: u32 = 44;
/// Between picture and bar.
const GAP: u32 = 18;
const BAR: u32 = 22;
/// What numbers beside the bar take.
const NUMBERS: u32 = 70;
const TITLE_FONT: f64 = 21.0;
const FONT: f64 = 18.0;
const GROUND: Colour = [255; 3];
const INK: Colour = [30; 3];

/// The longer side of a picture that is drawn: larger ones are means of squares of their pixels, smaller ones are enlarged.
const LARGEST: u32 = 1400;
const SMALLEST: u32 = 480;

/// Decades of the legend, at most.
const DECADES: f64 = 5.0;

impl Scalar {
    /// The field in logarithmic false colours below a title, beside a bar with ticks and the label of `value`; each of its pixels is
    /// `pixel_aspect` times as wide as high.
    ///
    /// The bar spans the range of `value`, or else what is above 0, but no more than five decades, from and to a 1, 2 or 5 times a
    /// power of ten; what lies below, 0 and negative values too, has the colour of its lower end. Magenta is no number.
    pub fn logarithmic_map(&self, title: &str, value: Axis, map: Map, pixel_aspect: f64) -> Sheet {
        let drawn = self.reduced(LARGEST);
        let range = value.range.unwrap_or_else(|| drawn.decades());
        let unit = &value.label;
        let logarithm = |value: &f64| if value.is_nan() { f64::NAN } else { value.max(0.0).log10() };
        let logarithms = Self { values: drawn.values.iter().map(logarithm).collect(), ..drawn };
        let colours = logarithms.colours(map, range.map(f64::log10));
        let times = (SMALLEST / colours.width().max(colours.height())).max(1);
        let [width, height] = [colours.width(), colours.height()].map(|side| side * times);
        let width = (f64::from(width) * pixel_aspect).round().clamp(1.0, 4.0 * f64::from(LARGEST)) as u32;
        let picture = resize(&colours, width, height, FilterType::Nearest);
        let head = MARGIN / 2 + HEAD;
        let beside = GAP + BAR + NUMBERS;
        let mut sheet = Sheet::new([MARGIN + width + beside, head + height + MARGIN], GROUND);
        sheet.shapes.push(Shape::Picture { picture, at: [MARGIN, head] });
        let middle = f64::from(MARGIN / 2 + HEAD / 2);
        let right = f64::from(sheet.size[0]) - 12.0;
        sheet.text(unit.as_str(), [right, middle], FONT, INK, Anchor::Right);
        // A title that is too long becomes smaller instead of losing its end.
        let room = right - text_width(unit, FONT) - 24.0 - f64::from(MARGIN);
        let size = TITLE_FONT * (room / text_width(title, TITLE_FONT).max(1.0)).min(1.0);
        sheet.text(title, [f64::from(MARGIN), middle], size, INK, Anchor::Left);
        let value = Axis { range: Some(range), log: true, ..value };
        sheet.colour_bar([MARGIN + width + GAP, head], height, &value, map);
        sheet
    }

    /// Means of squares of as few pixels as leave neither side longer than `largest`.
    fn reduced(&self, largest: u32) -> Self {
        let by = self.width.max(self.height).div_ceil(largest).max(1);
        if by == 1 {
            return self.clone();
        }
        Self::from_fn(self.width.div_ceil(by), self.height.div_ceil(by), |column, row| {
            let rows = row * by..((row + 1) * by).min(self.height);
            let columns = column * by..((column + 1) * by).min(self.width);
            let (mut sum, mut count) = (0.0, 0.0);
            for y in rows {
                for x in columns.clone() {
                    sum += self.values[y as usize * self.width as usize + x as usize];
                    count += 1.0;
                }
            }
            sum / count
        })
    }

    /// The range of what is above 0, to the next 1, 2 or 5 times a power of ten; 0.1 to 1 where nothing is.
    fn decades(&self) -> [f64; 2] {
        let above = self.values.iter().copied().filter(|value| value.is_finite() && *value > 0.0);
        let [low, high] =
            above.fold([f64::INFINITY, 0.0], |[low, high], value| [f64::min(low, value), f64::max(high, value)]);
        if high == 0.0 {
            return [0.1, 1.0];
        }
        let low = low.max(high * 10f64.powf(-DECADES));
        let [low, top] = [rounded_down(low), rounded_down(high)];
        [low, if top < high || top == low { next(top) } else { top }]
    }
}

/// The factors of a power of ten that have numbers, and the first of the next decade.
const NICE: [f64; 4] = [1.0, 2.0, 5.0, 10.0];

/// A number's power of ten, of which it is at least 1 and less than 10 times.
fn power(value: f64) -> f64 {
    10f64.powf((value.log10() + 1e-9).floor())
}

/// The largest 1, 2 or 5 times a power of ten that is not above a number.
fn rounded_down(value: f64) -> f64 {
    let power = power(value);
    NICE.map(|nice| nice * power).into_iter().filter(|nice| *nice <= value * (1.0 + 1e-9)).fold(power, f64::max)
}

/// The next larger of those.
fn next(value: f64) -> f64 {
    let power = power(value);
    NICE.map(|nice| nice * power).into_iter().find(|nice| *nice > value * (1.0 + 1e-9)).unwrap_or(10.0 * power)
}

impl Sheet {
    /// Adds a bar of all colours, the last on top, with ticks and numbers on its right; `at` is its upper left corner.
    pub(super) fn colour_bar(&mut self, at: [u32; 2], height: u32, axis: &Axis, map: Map) {
        let place = |row: u32| 1.0 - (f64::from(row) + 0.5) / f64::from(height);
        let picture = RgbImage::from_fn(BAR, height, |_, row| Rgb(map.colour(place(row))));
        self.shapes.push(Shape::Picture { picture, at });
        let [left, top] = at.map(f64::from);
        let [right, bottom] = [left + f64::from(BAR), top + f64::from(height)];
        self.line(vec![[left, top], [right, top], [right, bottom], [left, bottom], [left, top]], INK, 1.0);
        for tick in Scale::new(axis, std::iter::empty()).ticks((height / 30).max(2) as usize) {
            let y = bottom - tick.place * (bottom - top);
            let length = if tick.label.is_some() { 6.0 } else { 3.0 };
            self.line(vec![[right, y], [right + length, y]], INK, 1.0);
            if let Some(label) = tick.label {
                self.text(label, [right + 10.0, y], FONT, INK, Anchor::Left);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(values: &[f64]) -> Scalar {
        Scalar { width: values.len() as u32, height: 1, values: values.to_vec() }
    }

    /// The numbers on a sheet with the places of their middles, top first.
    fn numbers(sheet: &Sheet) -> Vec<(String, f64)> {
        let texts = sheet.shapes.iter().filter_map(|shape| match shape {
            Shape::Text { text, at, .. } if text.parse::<f64>().is_ok() => Some((text.clone(), at[1])),
            _ => None,
        });
        let mut all: Vec<_> = texts.collect();
        all.sort_by(|one, other| one.1.total_cmp(&other.1));
        all
    }

    #[test]
    fn a_legend_ends_at_round_numbers_and_spans_five_decades_at_most() {
        assert_eq!(field(&[3.0, 40.0]).decades(), [2.0, 50.0]);
        assert_eq!(field(&[0.0, -1.0, f64::NAN, 0.1, 1.0]).decades(), [0.1, 1.0]);
        assert_eq!(field(&[1e-30, 1000.0]).decades(), [0.01, 1000.0]);
        assert_eq!(field(&[3.0; 2]).decades(), [2.0, 5.0]);
        assert_eq!(field(&[2.0]).decades(), [2.0, 5.0]);
        assert_eq!(field(&[0.0]).decades(), [0.1, 1.0]);
        let [low, high] = field(&[0.97, 999.999]).decades();
        assert!((low / 0.5 - 1.0).abs() < 1e-12 && (high / 1000.0 - 1.0).abs() < 1e-12, "{low} to {high}");
    }

    /// Ten times as much is as far up the bar, everywhere, and the colour beside a number is that of a pixel which has it.
    #[test]
    fn ticks_stand_where_their_numbers_have_their_colours() {
        let values = [1.0, 10.0, 100.0, 1000.0];
        let sheet = field(&values).logarithmic_map("title", Axis::default(), Map::Inferno, 1.0);
        let numbers = numbers(&sheet);
        assert_eq!(numbers.iter().map(|(text, _)| text.as_str()).collect::<Vec<_>>(), ["1000", "100", "10", "1"]);
        let steps: Vec<f64> = numbers.windows(2).map(|pair| pair[1].1 - pair[0].1).collect();
        assert!(steps.iter().all(|step| (step / steps[0] - 1.0).abs() < 1e-9), "{steps:?}");
        let pictures: Vec<_> = sheet.pictures().collect();
        let [(field, _), (bar, at)] = pictures[..] else { panic!("a picture and a bar: {}", pictures.len()) };
        for ((_, y), k) in numbers.iter().zip([3, 2, 1, 0]) {
            let row = (y - f64::from(at[1])).clamp(0.0, f64::from(bar.height()) - 1.0) as u32;
            let shown = field.get_pixel(k * field.width() / 4 + field.width() / 8, 0).0;
            assert!(bar.get_pixel(0, row).0.iter().zip(shown).all(|(a, b)| a.abs_diff(b) <= 4), "{y}: {shown:?}");
        }
    }

    #[test]
    fn a_range_that_is_given_is_that_of_the_bar() {
        let axis = Axis { label: "cd/m²".into(), range: Some([1e-2, 1e2]), log: true };
        let sheet = field(&[1.0, 1e5]).logarithmic_map("title", axis, Map::Grey, 1.0);
        let told: Vec<String> = numbers(&sheet).into_iter().map(|(text, _)| text).collect();
        assert_eq!(told, ["100", "10", "1", "0.1", "0.01"]);
        let (picture, _) = sheet.pictures().next().unwrap();
        assert_eq!([0, picture.width() - 1].map(|column| picture.get_pixel(column, 0).0[0]), [128, 255]);
        assert!(sheet.shapes.iter().any(|shape| matches!(shape, Shape::Text { text, .. } if text == "cd/m²")));
    }

    #[test]
    fn a_large_field_is_drawn_by_means() {
        let reduced = Scalar::from_fn(7, 3, |column, row| f64::from(column + 10 * row)).reduced(4);
        assert_eq!([reduced.width, reduced.height], [4, 2]);
        assert_eq!(reduced.values, [5.5, 7.5, 9.5, 11.0, 20.5, 22.5, 24.5, 26.0]);
        let sheet = field(&[0.0, f64::NAN]).logarithmic_map("a title", Axis::default(), Map::Inferno, 2.0);
        let (picture, _) = sheet.pictures().next().unwrap();
        assert_eq!(picture.get_pixel(0, 0).0, Map::Inferno.colour(0.0), "0 is darkest");
        assert_eq!(picture.get_pixel(picture.width() - 1, 0).0, [255, 0, 255], "what is no number stands out");
        assert_eq!([picture.width(), picture.height()], [960, 240], "a pixel is twice as wide as high");
    }
}
