//! The half disc, the last mip level, and the indices.

use std::f64::consts::{PI, SQRT_2, TAU};

use glam::DVec2;
use vglare::series::kappa;
use vglare::series::printed::{Printed2d, ghosts_summed, half_disc, kappa_by_or, last_mip, table_value};

use super::{figure, worst};

/// ∫∫ (1 − r²) cos(qx) cos(qy) over the disc r ≤ 1: 4π J2(k)/k² with k = q√2.
fn disc(q: f64) -> f64 {
    let k = SQRT_2 * q;
    if k == 0.0 { PI / 2.0 } else { 4.0 * PI * libm::jn(2, k) / (k * k) }
}

#[test]
fn the_disc_integral_covers_half_of_the_disc() {
    for q in [0.0, 0.01, 0.3, 1.0, 2.5, 7.0, 33.0, 250.0] {
        let (got, whole) = (half_disc(q), disc(q));
        assert!((2.0 * got - whole).abs() < 1e-14, "q {q}: {got:e} of {whole:e}");
    }
}

#[test]
fn the_diagonal_alone_is_no_bell() {
    let (period, degree) = (DVec2::splat(6.0), [20; 2]);
    let table = Printed2d::HalfDisc.table(period, degree);
    let mean = PI / 2.0 / 36.0;
    assert!((table[0][0] - mean / 2.0).abs() < 1e-15, "half of the mean");
    for (index, mode) in table.iter().enumerate() {
        assert_eq!(mode[0] != 0.0, index / 21 == index % 21, "mode {}, {}", index / 21, index % 21);
    }
    figure("half disc: peak", table_value(&table, period, degree, DVec2::ZERO), 0.1355, 2e-3);
    // cos qx cos qy is a wave of x + y and one of x − y: no bell, but a cross of streaks along the diagonals.
    let at = |x, y| table_value(&table, period, degree, DVec2::new(x, y));
    assert!((at(3.0, 3.0) / at(0.0, 0.0) - 1.0).abs() < 1e-12, "the corner of the period is as bright as the centre");
    let error = worst(&table, period, degree, 60, |x, y| (1.0 - x * x - y * y).max(0.0));
    figure("half disc: worst error", error, 0.8645, 2e-3);
}

#[test]
fn the_last_mip_level_is_the_mean() {
    // 0 … 63 on 8 × 8.
    let values: Vec<f32> = (0..64).map(|i| i as f32).collect();
    assert_eq!(last_mip(&values, 8, 8), 31.5);
    assert_eq!(last_mip(&[3.0], 1, 1), 3.0);
    assert_eq!(last_mip(&[1.0, 3.0, 5.0, 7.0], 4, 1), 4.0);
    // Odd sides lose their last column and row.
    assert_eq!(last_mip(&[1.0, 3.0, 100.0, 5.0, 7.0, 100.0, 100.0, 100.0, 100.0], 3, 3), 4.0);
}

#[test]
fn kappa_by_or_doubles_the_mean() {
    for (n, m) in [(0, 1), (5, 0), (3, 4)] {
        assert_eq!(kappa_by_or(n, m), kappa(n, m));
    }
    assert_eq!((kappa_by_or(0, 0), kappa(0, 0)), (2.0, 1.0));
    let mean = TAU / (16.0 * 32.0);
    figure("κ by or: what is added everywhere", mean, 0.012_27, 1e-3);
}

#[test]
fn the_sum_over_ghosts_has_one_too_many() {
    assert_eq!([0, 1, 5, 1000].map(ghosts_summed), [1, 2, 6, 1001]);
}
