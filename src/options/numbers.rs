//! Numbers on the command line.

use glam::DVec2;

/// A number that is neither NaN nor infinite, and is neither in 32-bit floats.
pub fn finite(text: &str) -> Result<f64, String> {
    let single = |x: &f64| x.abs() <= f64::from(f32::MAX);
    text.parse::<f64>().ok().filter(single).ok_or_else(|| "expected a finite number".to_owned())
}

/// A finite number above 0.
pub fn positive(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|&x| x > 0.0).ok_or_else(|| "expected a positive finite number".to_owned())
}

/// A number between 0 and 1.
pub fn tolerance(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|&x| x > 0.0 && x < 1.0).ok_or_else(|| "expected a number between 0 and 1".to_owned())
}

/// Two finite numbers, x and y.
pub fn point(text: &str) -> Result<DVec2, String> {
    let point =
        text.split_once(',').and_then(|(x, y)| Some(DVec2::new(finite(x.trim()).ok()?, finite(y.trim()).ok()?)));
    point.ok_or_else(|| "expected two finite numbers, like 0.5,-0.2".to_owned())
}

/// Three numbers from 0 on: R, G and B.
pub fn colour(text: &str) -> Result<[f64; 3], String> {
    let parts: Result<Vec<f64>, String> = text.split(',').map(|part| not_negative(part.trim())).collect();
    let colour = parts.ok().and_then(|parts| parts.try_into().ok());
    colour.ok_or_else(|| "expected three finite numbers that are not negative, like 1,0.9,0.7".to_owned())
}

/// A number from 0 on, not infinite.
pub fn not_negative(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|&x| x >= 0.0).ok_or_else(|| "expected a finite number that is not negative".to_owned())
}

/// 0 for none, or a finite number of at least 1.
pub fn factor(text: &str) -> Result<f64, String> {
    let allowed = |&x: &f64| x == 0.0 || x >= 1.0;
    finite(text).ok().filter(allowed).ok_or_else(|| "expected 0, or a finite number of at least 1".to_owned())
}
