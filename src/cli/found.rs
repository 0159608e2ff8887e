//! What is said of a search for lights.

use crate::scene::threshold::{FLOOR, Rule};
use crate::scene::{FindOptions, Found};

/// Why there are none, and what to do about it; only where no pixel is light.
pub fn none(found: &Found) -> String {
    let (peak, threshold) = (short(found.peak), short(found.threshold));
    let instead = "--lights FILE and --scene FILE list lights by hand";
    match found.rule {
        _ if found.peak == 0.0 => format!("the photo is black; {instead}"),
        Rule::Given => {
            format!(
                "the threshold is {threshold} and the photo's brightest luminance {peak}; a lower --threshold finds more"
            )
        }
        _ => format!(
            "nothing stands out: the photo's brightest luminance, {peak}, is below the threshold, {threshold}, {}; \
             --threshold L takes what is L or brighter, {instead}",
            rule(found.rule)
        ),
    }
}

/// How the threshold was chosen.
pub fn rule(rule: Rule) -> String {
    match rule {
        Rule::Given => "as given".to_owned(),
        Rule::Split => "which splits the photo's flux best into light and scene".to_owned(),
        Rule::Mean => format!("{FLOOR} times the mean luminance"),
        Rule::Clipped => "just below the level at which highlights are clipped".to_owned(),
    }
}

/// Which pixels are no light because they outshine their neighbours, if any.
pub fn fireflies(found: &Found, options: &FindOptions) -> Option<String> {
    let ((column, row), limit) = (found.first_firefly?, options.firefly_limit);
    let place = format!("column {column}, row {row}");
    Some(match found.fireflies {
        1 => format!(
            "1 pixel outshines its neighbours more than {limit} times and is taken for a firefly, no light: {place}; \
             --firefly-limit 0 takes it for one"
        ),
        n => format!(
            "{n} pixels outshine their neighbours more than {limit} times and are taken for fireflies, no lights: the \
             first at {place}; --firefly-limit 0 takes them for lights"
        ),
    })
}

/// Four significant digits.
pub fn short(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    match x.abs().log10().floor() as i32 {
        exponent @ -4..=5 => format!("{x:.*}", (3 - exponent).max(0) as usize),
        _ => format!("{x:.3e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Frame;
    use crate::scene::find;

    fn found(level: f32, options: &FindOptions) -> Found {
        let mut pixels = [[level, level, level, 1.0]; 100];
        pixels[42] = [100.0 * level, 0.0, 0.0, 1.0];
        find(&pixels, &Frame::full(10, 10), [0.2126, 0.7152, 0.0722], options)
    }

    #[test]
    fn photos_without_lights_have_a_reason_and_a_way_out() {
        let said = |level, options: FindOptions| none(&found(level, &FindOptions { firefly_limit: 10.0, ..options }));
        let said_of = |threshold| said(0.5, FindOptions { threshold, ..FindOptions::default() });
        assert!(said(0.0, FindOptions::default()).starts_with("the photo is black;"));
        let flat = said_of(None);
        assert!(
            flat.contains("0.5000") && flat.contains("4 times the mean") && flat.contains("--threshold L"),
            "{flat}"
        );
        let given = said_of(Some(3.0));
        assert!(given.contains("3.000") && given.contains("0.5000") && given.contains("lower --threshold"), "{given}");
    }

    #[test]
    fn fireflies_are_counted_and_placed() {
        let limited = |firefly_limit| FindOptions { firefly_limit, ..FindOptions::default() };
        let said = |limit| fireflies(&found(0.5, &limited(limit)), &limited(limit));
        assert!(said(10.0).is_some_and(|said| said.starts_with("1 pixel ") && said.contains("column 2, row 4;")));
        assert_eq!(said(0.0), None);
        let two = Found { fireflies: 2, ..found(0.5, &limited(10.0)) };
        assert!(fireflies(&two, &limited(10.0)).is_some_and(|said| said.starts_with("2 pixels ")));
    }

    #[test]
    fn numbers_have_four_digits() {
        let cases = [(0.0, "0"), (13.5, "13.50"), (0.00012344, "0.0001234"), (123456.7, "123457"), (-2.0, "-2.000")];
        for (x, text) in cases.into_iter().chain([(1e-9, "1.000e-9"), (2.5e12, "2.500e12")]) {
            assert_eq!(short(x), text);
        }
    }
}
