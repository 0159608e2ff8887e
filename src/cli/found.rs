//! What is said of a search for lights.

use crate::choices::LightBy;
use crate::problem::{Images, Rims};
use crate::scene::threshold::{FLOOR, Rule};
use crate::scene::{FindOptions, Found};

/// Why there are none, and what to do about it; only where no pixel is light.
pub fn none(found: &Found) -> String {
    let (peak, threshold) = (short(found.peak), short(found.threshold));
    let instead = "--sources photo takes every pixel, and --lights FILE and --scene FILE list lights by hand";
    let brightest = match found.by {
        LightBy::Luminance => "the photo's brightest luminance",
        LightBy::Brightest => "the brightest channel of the photo's brightest pixel",
    };
    // A lamp of one colour has no more luminance than its colour has of white.
    let colours = match found.by {
        LightBy::Luminance => ", and --by brightest finds coloured lamps",
        LightBy::Brightest => "",
    };
    match found.rule {
        _ if found.peak == 0.0 => format!("the photo is black; {instead}"),
        Rule::Given => {
            format!("the threshold is {threshold}, and {brightest} is {peak}; a lower --threshold finds more{colours}")
        }
        // What is made for a display ends at its white.
        _ if found.peak <= 1.0 && found.threshold > 1.0 => format!(
            "nothing stands out: the photo ends at white, as those made for a display do, and none of its pixels can be as bright as \
             {threshold}, {}; --threshold {} takes its brightest{colours}, {instead}",
            rule(found),
            short(0.9 * found.peak)
        ),
        _ => format!(
            "nothing stands out: {brightest}, {peak}, is below the threshold, {threshold}, {}; \
             --threshold L takes what is L or brighter{colours}, {instead}",
            rule(found)
        ),
    }
}

/// What became of lights beyond the most that are kept, if there were any, and how much of the flux they have.
pub fn beyond(found: &Found) -> Option<String> {
    // Never none where there is some.
    let share = |share: f64| match 100.0 * share {
        percent if percent < 0.05 => "less than 0.1 % of the flux".to_owned(),
        percent => format!("{percent:.1} % of the flux"),
    };
    let ones = |count: usize| format!("{count} fainter {}", if count == 1 { "one" } else { "ones" });
    match (found.joined, found.dropped) {
        (0, 0) => None,
        (0, dropped) => Some(format!(
            "{} left out, {}: --max-lights N keeps more, --beyond join their light",
            ones(dropped),
            share(found.dropped_share)
        )),
        (joined, _) => {
            let whose = if joined == 1 { "its" } else { "their" };
            Some(format!("{} joined {whose} nearest, {}", ones(joined), share(found.joined_share)))
        }
    }
}

/// How the threshold was chosen.
pub fn rule(found: &Found) -> String {
    match found.rule {
        Rule::Given => "as given".to_owned(),
        Rule::Split => "which splits the photo's flux best into light and scene".to_owned(),
        Rule::Mean => format!("{FLOOR} times the mean {}", found.by),
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

/// What the rims of a real lens do where every pixel is a source, if they do anything.
pub fn rims(images: &Images) -> Option<String> {
    let Rims { cut, images, misplaced } = *images.rims().filter(|rims| rims.cut > 0)?;
    Some(format!(
        "rims cut {cut} of them, as {images} images of the photo's parts: by estimate {:.1} % of the ghosts' light is not where \
         they would leave it",
        100.0 * misplaced
    ))
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
        let options = &FindOptions { by: LightBy::Luminance, ..*options };
        let mut pixels = [[level, level, level, 1.0]; 100];
        pixels[42] = [100.0 * level, 0.0, 0.0, 1.0];
        find(&pixels, &Frame::full(10, 10), [0.2126, 0.7152, 0.0722], options)
    }

    #[test]
    fn photos_without_lights_have_a_reason_and_a_way_out() {
        let said = |level, options: FindOptions| none(&found(level, &FindOptions { firefly_limit: 10.0, ..options }));
        let said_of = |threshold| said(50.0, FindOptions { threshold, ..FindOptions::default() });
        assert!(said(0.0, FindOptions::default()).starts_with("the photo is black;"));
        let flat = said_of(None);
        assert!(
            flat.contains("50.00") && flat.contains("4 times the mean") && flat.contains("--threshold L"),
            "{flat}"
        );
        // Grey of mean 0.3 has its threshold above white.
        let display =
            Found { by: LightBy::Brightest, peak: 0.9, threshold: 1.2, ..found(0.3, &FindOptions::default()) };
        let display = none(&display);
        let words = ["ends at white", "1.200", "--threshold 0.8100 takes", "--sources photo", "--lights"];
        assert!(words.iter().all(|word| display.contains(word)), "{display}");
        let given = said_of(Some(3000.0));
        assert!(given.contains("3000") && given.contains("50.00") && given.contains("lower --threshold"), "{given}");
    }

    #[test]
    fn what_is_beyond_the_most_is_told_with_its_share() {
        let found = found(0.5, &FindOptions::default());
        assert_eq!(beyond(&found), None);
        let said = |found: Found| beyond(&found).unwrap();
        let dropped = said(Found { dropped: 28, dropped_share: 0.183, ..found.clone() });
        assert!(dropped.starts_with("28 fainter ones left out, 18.3 % of the flux: --max-lights"), "{dropped}");
        let joined = said(Found { joined: 3, joined_share: 1e-5, ..found });
        assert_eq!(joined, "3 fainter ones joined their nearest, less than 0.1 % of the flux");
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
