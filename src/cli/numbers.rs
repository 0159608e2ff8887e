//! Numbers on the command line.

/// A number that is neither NaN nor infinite.
pub fn finite(text: &str) -> Result<f64, String> {
    text.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(|| "expected a finite number".to_owned())
}

/// A number from 0 on, not infinite.
pub fn not_negative(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|&x| x >= 0.0).ok_or_else(|| "expected a finite number that is not negative".to_owned())
}
