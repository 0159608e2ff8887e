//! Code points for colour: ITU-T H.273 (2024), tables 2 and 3; in PNG's cICP, and in ICC profiles.

use glam::DVec2;

use super::Primaries;
use super::transfer::Curve;

const D65: DVec2 = DVec2::new(0.3127, 0.3290);

/// The primaries of table 2; none where they are unknown here, or unspecified (2).
pub(super) fn primaries(code: u8) -> Option<Primaries> {
    let of = |red: [f64; 2], green: [f64; 2], blue: [f64; 2], white: DVec2| Primaries {
        red: red.into(),
        green: green.into(),
        blue: blue.into(),
        white,
    };
    Some(match code {
        1 => Primaries::REC709,
        5 => of([0.64, 0.33], [0.29, 0.60], [0.15, 0.06], D65),
        6 | 7 => of([0.630, 0.340], [0.310, 0.595], [0.155, 0.070], D65),
        9 => Primaries::REC2020,
        11 => Primaries { white: DVec2::new(0.314, 0.351), ..Primaries::P3_D65 },
        12 => Primaries::P3_D65,
        22 => of([0.630, 0.340], [0.295, 0.605], [0.155, 0.077], D65),
        _ => return None,
    })
}

/// The transfer function of table 3; none where it is unknown here, or unspecified (2).
pub(super) fn curve(code: u8) -> Option<Curve> {
    Some(match code {
        1 | 6 | 11 | 14 | 15 => Curve::Rec709,
        4 => Curve::Power(2.2),
        5 => Curve::Power(2.8),
        8 => Curve::Linear,
        13 => Curve::Srgb,
        16 => Curve::Pq,
        18 => Curve::Hlg,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_points_are_those_of_the_tables() {
        assert_eq!((primaries(9), curve(16)), (Some(Primaries::REC2020), Some(Curve::Pq)));
        assert_eq!((primaries(12), curve(13)), (Some(Primaries::P3_D65), Some(Curve::Srgb)));
        assert_eq!((primaries(2), curve(2)), (None, None));
        assert_eq!((primaries(200), curve(200)), (None, None));
        assert!((1..=255).filter_map(primaries).all(|p| p.sound().is_some()));
    }
}
