//! The reference in f64: Fourier's own identities hold it, beside the golden numbers.

use glam::DVec2;
use vglare::frame::Frame;
use vglare::reference::{direct, direct_at, series};
use vglare::scene::Ghost;

use crate::support::check::within;
use crate::support::scenes::{self, Chance};

const PERIOD: DVec2 = DVec2::new(12.0, 10.0);
/// Enough for the smallest bell below: exp(-(2 pi 40 0.3 / 12)^2 / 2) = 3e-9.
const COUNTS: [u32; 41] = [35; 41];

fn ghosts() -> Vec<Ghost> {
    scenes::sized(11, 12, Frame::full(16, 9), 0.3, 0.8)
}

fn points(count: usize) -> Vec<DVec2> {
    let mut chance = Chance::new(5);
    (0..count).map(|_| DVec2::new(chance.between(-1.8, 1.8), chance.between(-1.0, 1.0))).collect()
}

fn series_at(ghosts: &[Ghost], points: &[DVec2]) -> Vec<[f64; 3]> {
    points.iter().map(|&at| series(ghosts, PERIOD, &COUNTS, at)).collect()
}

#[test]
fn the_series_reconstructs_the_bells() {
    let points = points(40);
    let (bells, series) = (direct_at(&ghosts(), &points), series_at(&ghosts(), &points));
    // The tail beyond the 34th harmonic of y is erfc(sqrt 2 pi 34 0.3 / 10) = 1.4e-10 for each of about ten ghosts.
    println!("{:.1e}", within(1e-8, "series against bells", &[], &bells, &series).relative);
}

#[test]
fn both_are_linear_in_the_ghosts() {
    let (ghosts, points) = (ghosts(), points(10));
    let (some, others) = ghosts.split_at(5);
    for field in [direct_at, series_at] {
        let apart = field(some, &points).into_iter().zip(field(others, &points));
        let apart: Vec<_> = apart.map(|(a, b)| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]).collect();
        // Only the order of some additions differs.
        within(1e-14, "two parts against the whole", &[], &field(&ghosts, &points), &apart);
    }
    let doubled: Vec<_> = ghosts.iter().map(|g| Ghost { radiance: g.radiance.map(|r| 2.0 * r), ..g.clone() }).collect();
    for at in points {
        assert_eq!(direct(&doubled, at), direct(&ghosts, at).map(|value| 2.0 * value));
    }
}

#[test]
fn moving_ghosts_and_points_together_changes_nothing_and_whole_periods_neither() {
    let (ghosts, points) = (ghosts(), points(10));
    let moved =
        |by: DVec2| -> Vec<Ghost> { ghosts.iter().map(|g| Ghost { center: g.center + by, ..g.clone() }).collect() };
    let shift = DVec2::new(0.625, -0.375);
    let shifted: Vec<_> = points.iter().map(|&at| at + shift).collect();
    // Centres and points are rounded once more each, 1e-16 against sizes of 0.3.
    within(1e-13, "bells", &[], &direct_at(&ghosts, &points), &direct_at(&moved(shift), &shifted));
    within(1e-13, "series", &[], &series_at(&ghosts, &points), &series_at(&moved(shift), &shifted));
    within(1e-12, "periods", &[], &series_at(&ghosts, &points), &series_at(&moved(PERIOD), &points));
}

#[test]
#[should_panic(expected = "canary")]
fn a_series_of_too_few_harmonics_is_noticed() {
    let points = points(40);
    let few: Vec<_> = points.iter().map(|&at| series(&ghosts(), PERIOD, &COUNTS[..8], at)).collect();
    within(1e-8, "canary", &[], &direct_at(&ghosts(), &points), &few);
}
