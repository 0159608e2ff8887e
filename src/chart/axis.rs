//! From numbers to places along an axis, and where its ticks stand.

/// What an axis says and shows.
#[derive(Debug, Clone, Default)]
pub struct Axis {
    /// Its quantity and unit.
    pub label: String,
    /// Its ends, in its own numbers; by default those of what is drawn.
    pub range: Option<[f64; 2]>,
    /// Whether equal steps are equal ratios.
    pub log: bool,
}

/// An axis whose ends are settled.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    low: f64,
    high: f64,
    log: bool,
}

/// A tick: its place from 0 to 1, and its number where it has one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    pub place: f64,
    pub label: Option<String>,
}

impl Scale {
    /// The scale of an axis along which `values` are drawn. Values that the axis cannot show do not count.
    pub fn new(axis: &Axis, values: impl Iterator<Item = f64>) -> Self {
        let unit = |value: f64| if axis.log { value.log10() } else { value };
        let (mut low, mut high) = match axis.range {
            Some([low, high]) => (unit(low), unit(high)),
            None => values
                .map(unit)
                .filter(|value| value.is_finite())
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value))),
        };
        if !(low.is_finite() && high.is_finite()) {
            (low, high) = (0.0, 1.0);
        }
        if low == high {
            (low, high) = (low - 0.5, high + 0.5);
        }
        if axis.range.is_none() {
            let margin = 0.04 * (high - low);
            (low, high) = (low - margin, high + margin);
        }
        Self { low, high, log: axis.log }
    }

    /// Where a value lies, 0 to 1 between the ends; none for what has no place at all, like 0 on a logarithmic axis.
    pub fn place(&self, value: f64) -> Option<f64> {
        let unit = if self.log { value.log10() } else { value };
        unit.is_finite().then(|| (unit - self.low) / (self.high - self.low))
    }

    /// The ticks, about `most` of them with numbers.
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        let place = |unit: f64| (unit - self.low) / (self.high - self.low);
        let ticks = if self.log { self.decades(most) } else { self.steps(most) };
        ticks.into_iter().map(|(unit, label)| Tick { place: place(unit), label }).collect()
    }

    fn steps(&self, most: usize) -> Vec<(f64, Option<String>)> {
        let rough = (self.high - self.low) / most.max(1) as f64;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|nice| nice * power).into_iter().find(|&step| step >= rough);
        let step = step.unwrap_or(10.0 * power);
        let digits = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
        let slack = 1e-9 * step;
        let (first, last) = (((self.low - slack) / step).ceil() as i64, ((self.high + slack) / step).floor() as i64);
        let far = self.low.abs().max(self.high.abs());
        let label = |value: f64| {
            if far >= 1e6 || digits > 5 { short(value, step) } else { format!("{value:.digits$}") }
        };
        (first..=last)
            .map(|index| {
                let value = index as f64 * step;
                (value, Some(label(value)))
            })
            .collect()
    }

    fn decades(&self, most: usize) -> Vec<(f64, Option<String>)> {
        let (first, last) = (self.low.floor() as i32, self.high.ceil() as i32);
        let every = ((last - first) as usize).div_ceil(most.max(1)).max(1) as i32;
        let few = self.high - self.low < 1.5;
        let mut ticks = Vec::new();
        for decade in first..=last {
            for digit in 1..10 {
                let unit = f64::from(decade) + f64::from(digit).log10();
                let labelled = if digit == 1 { decade.rem_euclid(every) == 0 } else { few && [2, 5].contains(&digit) };
                let shown = every == 1 || digit == 1;
                if shown && unit >= self.low - 1e-9 && unit <= self.high + 1e-9 {
                    ticks.push((unit, labelled.then(|| power_label(digit, decade))));
                }
            }
        }
        ticks
    }
}

fn power_label(digit: i32, decade: i32) -> String {
    match decade {
        0..4 => format!("{}", digit * 10i32.pow(decade as u32)),
        -2..0 => format!("{:.*}", -decade as usize, f64::from(digit) * 10f64.powi(decade)),
        _ => format!("{digit}e{decade}"),
    }
}

/// A number with as many digits as tell it from its neighbours `step` away.
fn short(value: f64, step: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let exponent = |number: f64| (number.log10() + 1e-9).floor();
    let digits = (exponent(value.abs()) - exponent(step)).max(0.0) as usize;
    format!("{value:.digits$e}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, values: &[f64]) -> Vec<String> {
        Scale::new(axis, values.iter().copied()).ticks(6).into_iter().filter_map(|tick| tick.label).collect()
    }

    fn ranged(low: f64, high: f64, log: bool) -> Axis {
        Axis { range: Some([low, high]), log, ..Axis::default() }
    }

    #[test]
    fn linear_ticks_are_round_and_no_more_than_asked() {
        assert_eq!(labels(&ranged(0.0, 1.0, false), &[]), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(&ranged(-3.0, 9.0, false), &[]), ["-2", "0", "2", "4", "6", "8"]);
        assert_eq!(labels(&ranged(0.0, 2e-7, false), &[]), ["0", "5e-8", "1.0e-7", "1.5e-7", "2.0e-7"]);
    }

    #[test]
    fn logarithmic_ticks_are_decades_and_thinned_out() {
        assert_eq!(labels(&ranged(1e-2, 1e2, true), &[]), ["0.01", "0.1", "1", "10", "100"]);
        assert_eq!(labels(&ranged(1e-16, 1.0, true), &[]), ["1e-15", "1e-12", "1e-9", "1e-6", "1e-3", "1"]);
        assert_eq!(labels(&ranged(1.0, 20.0, true), &[]), ["1", "2", "5", "10", "20"]);
    }

    #[test]
    fn what_cannot_be_shown_does_not_count() {
        let log = Scale::new(&Axis { log: true, ..Axis::default() }, [0.0, f64::NAN, 1.0, 100.0].into_iter());
        assert_eq!(log.place(0.0), None);
        assert!((log.place(10.0).unwrap() - 0.5).abs() < 1e-12);
        let nothing = Scale::new(&Axis::default(), [f64::NAN].into_iter());
        assert_eq!(nothing.place(0.5), Some(0.5));
        let one = Scale::new(&Axis::default(), [3.0, 3.0].into_iter());
        assert!((one.place(3.0).unwrap() - 0.5).abs() < 1e-12);
    }
}
