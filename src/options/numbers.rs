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

/// Three finite angles in degrees.
pub fn angles(text: &str) -> Result<[f64; 3], String> {
    let parts: Result<Vec<f64>, String> = text.split(',').map(|part| finite(part.trim())).collect();
    let angles = parts.ok().and_then(|parts| parts.try_into().ok());
    angles.ok_or_else(|| "expected three angles in degrees, like 90,0,-10".to_owned())
}

/// Two positive finite numbers, the smaller one first.
pub fn range(text: &str) -> Result<[f64; 2], String> {
    let ends: Vec<f64> = text.split(',').filter_map(|end| positive(end.trim()).ok()).collect();
    match (ends[..].first_chunk(), text.split(',').count()) {
        (Some(&[from, to]), 2) if from < to => Ok([from, to]),
        _ => Err("expected two numbers above 0, the smaller one first, like 0.1,30".to_owned()),
    }
}

/// Columns and rows, as 1920x1080.
pub fn sides(text: &str) -> Result<[u32; 2], String> {
    const MOST: u32 = 32768;
    let side = |text: &str| text.trim().parse().ok().filter(|side| (1..=MOST).contains(side));
    let both = text.split_once(['x', 'X', '×']).and_then(|(width, height)| Some([side(width)?, side(height)?]));
    both.ok_or_else(|| format!("expected columns and rows, each from 1 to {MOST}, like 1920x1080"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_are_two_whole_numbers() {
        assert_eq!((sides("1920x1080"), sides("96 × 54")), (Ok([1920, 1080]), Ok([96, 54])));
        for bad in ["", "96", "0x54", "96x-1", "1e3x2", "40000x10", "96x54x3"] {
            assert!(sides(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_range_is_two_numbers_in_their_order() {
        assert_eq!(range("0.1, 30"), Ok([0.1, 30.0]));
        for bad in ["", "1", "2,1", "1,1", "0,1", "-1,1", "1,nan", "1,2,3"] {
            assert!(range(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn angles_are_three_numbers() {
        for bad in ["", "1,2", "1,2,3,4", "1,2,nan", "1,x,3", "1,,2,3", "inf,0,0"] {
            assert!(angles(bad).is_err(), "{bad}");
        }
        assert_eq!(angles("-90, 0,1e1"), Ok([-90.0, 0.0, 10.0]));
    }
}
