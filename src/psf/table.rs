//! A measured function: rows of radius and value.

use std::f64::consts::TAU;

use super::Fault;
use super::integral::{integral, integral_from_zero};

/// What a radius or a value may be; beyond, squares leave what f32 holds.
const RANGE: [f64; 2] = [1e-18, 1e18];

/// A function by its values at radii, in the look's unit, made to unit energy.
///
/// Between two rows it is a monotone cubic in ln value over ln radius (Fritsch & Carlson 1980), so that a power law is
/// met exactly and nothing overshoots. Before the first radius above 0 it keeps that row's value, or comes from a row
/// at 0 as a Gaussian does. It ends with its last row: beyond that radius it is 0, so that its energy is all of its light.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// ln radius, ln value and the slope of one over the other, of each row but one at 0.
    rows: Vec<[f64; 3]>,
    /// ln of the value at 0, where there is a row.
    centre: Option<f64>,
    /// The radius of the last row.
    end: f64,
}

impl Table {
    /// Rows of radius and value: at least two radii above 0, which grow; all values above 0.
    ///
    /// # Errors
    /// On the key `table`, with the row that is wrong, counted from 1.
    pub fn new(rows: &[[f64; 2]]) -> Result<Self, Fault> {
        for (i, &[radius, value]) in rows.iter().enumerate() {
            let fault = |reason: String| Err(Fault::new("table", format!("row {}: {reason}", i + 1)));
            let is_centre = i == 0 && radius == 0.0;
            if !is_centre && !(RANGE[0]..=RANGE[1]).contains(&radius) {
                return fault(format!("a radius is from 1e-18 to 1e18, or 0 in the first row, and not {radius}"));
            }
            if !(RANGE[0]..=RANGE[1]).contains(&value) {
                return fault(format!(
                    "a value is from 1e-18 to 1e18, and not {value}; end the table where the light ends"
                ));
            }
            if i > 0 && radius <= rows[i - 1][0] {
                return fault(format!("its radius, {radius}, is not above the one before, {}", rows[i - 1][0]));
            }
        }
        let centre = rows.first().filter(|row| row[0] == 0.0).map(|row| row[1].ln());
        let positive: Vec<[f64; 2]> =
            rows[usize::from(centre.is_some())..].iter().map(|row| row.map(f64::ln)).collect();
        if positive.len() < 2 {
            return Err(Fault::new(
                "table",
                format!("two rows at radii above 0 are the least, and there are {}", positive.len()),
            ));
        }
        let last = rows[rows.len() - 1][0];
        let slopes = monotone_slopes(&positive);
        let rows = positive.iter().zip(slopes).map(|(&[x, y], slope)| [x, y, slope]).collect();
        let mut table = Self { rows, centre, end: last };
        let energy = table.raw_energy(table.end());
        if !(energy.is_finite() && energy > 0.0) {
            return Err(Fault::new("table", "its values are too large or too small for an energy"));
        }
        table.rows.iter_mut().for_each(|row| row[1] -= energy.ln());
        table.centre = table.centre.map(|centre| centre - energy.ln());
        Ok(table)
    }

    /// Of the text of a CSV file: two columns, radius and value. A first line of names is passed over, and so are empty
    /// lines and lines that begin with #.
    ///
    /// # Errors
    /// As of [`Table::new`], and on what is not two numbers.
    pub fn parse(text: &str) -> Result<Self, Fault> {
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        let mut rows = Vec::new();
        for (i, record) in reader.records().enumerate() {
            let record = record.map_err(|error| Fault::new("table", error.to_string()))?;
            let line = record.position().map_or(i as u64 + 1, csv::Position::line);
            let numbers: Vec<f64> = record.iter().map_while(|field| field.parse().ok()).collect();
            match numbers[..] {
                [radius, value] if record.len() == 2 => rows.push([radius, value]),
                [] if i == 0 && record.len() == 2 => {}
                _ => {
                    return Err(Fault::new(
                        "table",
                        format!("line {line} is not a radius and a value, two numbers with a comma between"),
                    ));
                }
            }
        }
        Self::new(&rows)
    }

    /// The radius of the last row.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// The first radius above 0.
    pub(super) fn first(&self) -> f64 {
        self.rows[0][0].exp()
    }

    /// The value at the radius r ≥ 0, per squared unit; 0 beyond the last row.
    pub fn value(&self, r: f64) -> f64 {
        if r > self.end {
            return 0.0;
        }
        let (first, last) = (self.rows[0], self.rows[self.rows.len() - 1]);
        let x = r.ln();
        if x < first[0] {
            // e^2x is (r/r₁)², and 0 at 0.
            return self
                .centre
                .map_or(first[1], |centre| centre + (first[1] - centre) * (2.0 * (x - first[0])).exp())
                .exp();
        }
        if x >= last[0] {
            return last[1].exp();
        }
        let next = self.rows.partition_point(|row| row[0] <= x);
        hermite(self.rows[next - 1], self.rows[next], x).exp()
    }

    /// 2π ∫ r k dr to `to`, row by row: between rows it is smooth.
    fn raw_energy(&self, to: f64) -> f64 {
        let ring = |r: f64| TAU * r * self.value(r);
        let first = self.first();
        let inner = integral_from_zero(&ring, first.min(to), first.min(to));
        let in_logarithm = |x: f64| ring(x.exp()) * x.exp();
        let end = to.ln();
        let pieces = self.rows.windows(2).map(|pair| [pair[0][0].min(end), pair[1][0].min(end)]);
        inner + pieces.filter(|[from, to]| to > from).map(|[from, to]| integral(&in_logarithm, from, to)).sum::<f64>()
    }

    /// The energy within the radius `to`, at most all of it, 1.
    pub fn energy_within(&self, to: f64) -> f64 {
        self.raw_energy(to.min(self.end()))
    }
}

/// Slopes at the points of a monotone cubic: harmonic means of the neighbouring secants, by the lengths of their
/// intervals (Fritsch & Butland 1984), 0 at a turn; at the ends the secant itself.
fn monotone_slopes(points: &[[f64; 2]]) -> Vec<f64> {
    let secants: Vec<[f64; 2]> = points
        .windows(2)
        .map(|pair| [pair[1][0] - pair[0][0], (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])])
        .collect();
    let between = |pair: &[[f64; 2]]| {
        let [[h0, before], [h1, after]] = [pair[0], pair[1]];
        if before * after <= 0.0 {
            return 0.0;
        }
        let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
        (w0 + w1) / (w0 / before + w1 / after)
    };
    let mut slopes = vec![secants[0][1]];
    slopes.extend(secants.windows(2).map(between));
    slopes.push(secants[secants.len() - 1][1]);
    slopes
}

/// The cubic between two rows of place, value and slope.
fn hermite([x0, y0, m0]: [f64; 3], [x1, y1, m1]: [f64; 3], x: f64) -> f64 {
    let h = x1 - x0;
    let t = (x - x0) / h;
    let s = 1.0 - t;
    s * s * ((1.0 + 2.0 * t) * y0 + t * h * m0) + t * t * ((1.0 + 2.0 * s) * y1 - s * h * m1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A power law is met between the rows, whatever these are scaled by, and ends with them.
    #[test]
    fn a_power_law_is_met_everywhere() {
        let rows: Vec<[f64; 2]> = [0.01, 0.02, 0.07, 0.3, 1.0].iter().map(|&r: &f64| [r, 5e6 * r.powf(-2.5)]).collect();
        let table = Table::new(&rows).unwrap();
        let scale = table.value(0.02) * 0.02_f64.powf(2.5);
        for r in [0.011, 0.05, 0.5, 0.99, 1.0] {
            assert!((table.value(r) / (scale * r.powf(-2.5)) - 1.0).abs() < 1e-12, "at {r}");
        }
        assert_eq!([1.0 + 1e-15, 7.0, 1e300, f64::INFINITY].map(|r| table.value(r)), [0.0; 4]);
        // 2π (∫₀^r₁ r r₁^−2.5 dr + ∫ r^−1.5 dr) = 1.
        let known = TAU * scale * (0.5 * 0.01_f64.powf(-0.5) + 2.0 * (0.01_f64.powf(-0.5) - 1.0));
        assert!((known - 1.0).abs() < 1e-10, "{known}");
        assert!((table.energy_within(f64::INFINITY) - 1.0).abs() < 1e-12);
    }

    /// From a row at 0 on it falls as a Gaussian; nothing overshoots where the rows are flat.
    #[test]
    fn rows_are_not_overshot() {
        let table = Table::parse("# a step\nradius, value\n0, 10\n0.1, 10\n0.2,10\n\n0.3,1\n0.5,1\n").unwrap();
        let [high, low] = [table.value(0.0), table.value(0.5)];
        assert!((high / low - 10.0).abs() < 1e-12);
        for i in 0..=500 {
            let value = table.value(f64::from(i) * 1e-3);
            assert!((low * (1.0 - 1e-12)..=high * (1.0 + 1e-12)).contains(&value), "{value} at {i}");
        }
        let gaussian = Table::new(&[[0.0, 1.0], [0.1, (-0.5_f64).exp()], [0.2, 0.1]]).unwrap();
        assert!((gaussian.value(0.05) / gaussian.value(0.0) - (-0.125_f64).exp()).abs() < 1e-12);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_row() {
        let cases: [(&str, &str); 8] = [
            ("", "two rows"),
            ("0,1\n1,2", "two rows"),
            ("r,k\n0.1,1\n0.2", "line 3"),
            ("0.1,1\nx,2", "line 2"),
            ("0.1,1\n0.1,2", "row 2"),
            ("0.1,1\n0.2,0", "row 2"),
            ("0.1,NaN\n0.2,1", "row 1"),
            ("0.1,1\n0.2,inf", "row 2"),
        ];
        for (text, told) in cases {
            let fault = Table::parse(text).unwrap_err();
            assert!(fault.key == "table" && fault.reason.contains(told), "{text:?}: {fault}");
        }
    }
}
