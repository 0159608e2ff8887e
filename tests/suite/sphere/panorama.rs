//! Equirectangular pictures: which way is which, what their coefficients are, and the rotation theorem on them.

use std::f64::consts::PI;

use glam::DVec3;
use vglare::photo;
use vglare::series::sphere::{Coefficients, Grid, Reading, project_panorama, project_samples, project_turned, turn};

use super::{directions, noise, random};

const GRID: Grid = Grid { width: 64, height: 32 };

/// Noise with a sun in it: nothing about it is smooth.
fn harsh(grid: Grid) -> Vec<[f64; 3]> {
    let mut next = noise(41);
    let mut pixels: Vec<_> = (0..grid.width * grid.height).map(|_| [next() + 1.0, next(), next() * next()]).collect();
    pixels[grid.width * (grid.height / 4) + 9] = [3e4, 2e4, 1e4];
    pixels
}

fn reader(grid: Grid, pixels: &[[f64; 3]]) -> impl Fn(usize, &mut [[f64; 3]]) + Sync {
    move |row, out: &mut [[f64; 3]]| out.copy_from_slice(&pixels[row * grid.width..][..grid.width])
}

fn projected(grid: Grid, degree: usize, reading: Reading, pixels: &[[f64; 3]]) -> Coefficients {
    project_panorama(grid, degree, reading, reader(grid, pixels))
}

#[test]
fn the_centre_is_ahead_the_left_is_left_and_the_top_is_up() {
    let near = |direction: DVec3, axis: DVec3| assert!((direction - axis).length() < 1e-15, "{direction} for {axis}");
    near(GRID.direction(31.5, 15.5), DVec3::X);
    near(GRID.direction(15.5, 15.5), DVec3::Y);
    near(GRID.direction(47.5, 15.5), DVec3::NEG_Y);
    near(GRID.direction(3.0, -0.5), DVec3::Z);
    for (column, row) in [(0, 0), (63, 31), (31, 16), (5, 20), (63, 0)] {
        assert_eq!(GRID.pixel(GRID.direction(column as f64, row as f64)), (column, row));
    }
    assert_eq!((GRID.pixel(DVec3::Z).1, GRID.pixel(DVec3::NEG_Z).1), (0, 31));
    assert_eq!(GRID.pixel(DVec3::new(-1.0, -0.0, 0.0)).0, 0, "the seam");
}

#[test]
fn interpolation_gives_pixels_at_their_centres_and_goes_round_the_seam_and_the_poles() {
    let pixels = harsh(GRID);
    let at = |column: f64, row: f64| {
        GRID.interpolate(GRID.direction(column, row), |column, row| pixels[row * 64 + column])[0]
    };
    let pixel = |column: usize, row: usize| pixels[row * 64 + column][0];
    for (column, row) in [(0, 0), (63, 31), (9, 8), (30, 17)] {
        assert!((at(column as f64, row as f64) - pixel(column, row)).abs() < 1e-8, "{column}, {row}");
    }
    let middle = |a: f64, b: f64| 0.5 * (a + b);
    for (got, expected) in [
        (at(5.5, 20.0), middle(pixel(5, 20), pixel(6, 20))),
        (at(5.0, 20.5), middle(pixel(5, 20), pixel(5, 21))),
        (at(63.5, 20.0), middle(pixel(63, 20), pixel(0, 20))),
        // Across the zenith and the nadir, half way round.
        (at(7.0, -0.25), 0.75 * pixel(7, 0) + 0.25 * pixel(39, 0)),
        (at(-0.5, 25.0), middle(pixel(63, 25), pixel(0, 25))),
        (at(50.0, 31.25), 0.75 * pixel(50, 31) + 0.25 * pixel(18, 31)),
    ] {
        assert!((got - expected).abs() < 1e-8, "{got} for {expected}");
    }
}

#[test]
fn an_even_picture_is_c_00_alone() {
    for grid in [GRID, Grid { width: 50, height: 25 }, Grid { width: 2, height: 1 }, Grid { width: 90, height: 45 }] {
        assert!((grid.integrate(|_| grid.width as f64) - 4.0 * PI).abs() < 1e-13, "{grid:?}: solid angles");
        let degree = grid.height - 1;
        let coefficients = project_panorama(grid, degree, Reading::Areas, |_, row| row.fill([1.0, -2.0, 0.0]));
        let mut expected = Coefficients::zero(degree);
        expected.values_mut()[0] = [1.0, -2.0, 0.0].map(|value| value * (4.0 * PI).sqrt());
        assert!(coefficients.difference(&expected) < 1e-13, "{grid:?}: {:e}", coefficients.difference(&expected));
    }
}

#[test]
fn samples_of_harmonics_come_back_exactly() {
    for (degree, height) in [(0, 1), (3, 8), (12, 32), (15, 33), (40, 90)] {
        let grid = Grid { width: 2 * height, height };
        let coefficients = random(degree, 3);
        let picture = coefficients.to_panorama(grid, |value| value);
        for (column, row) in [(0, 0), (height, height / 2), (2 * height - 1, height - 1)] {
            let at = coefficients.at(grid.direction(column as f64, row as f64));
            let [error] = [0].map(|i: usize| (picture[row * grid.width + column][i] - at[i]).abs());
            assert!(error < 1e-12, "degree {degree}, column {column}, row {row}: {error:e}");
        }
        let error = projected(grid, degree, Reading::Samples, &picture).difference(&coefficients);
        assert!(error < 1e-13, "degree {degree} from {height} rows: {error:e}");
    }
}

/// The same samples read as areas: each band is weaker by about l(l+1)/24 of a pixel's height squared, and no more.
#[test]
fn a_smooth_function_read_as_areas_is_off_by_a_pixel_squared() {
    let coefficients = random(8, 14);
    let error = |height: usize| {
        let grid = Grid { width: 2 * height, height };
        let picture = coefficients.to_panorama(grid, |value| value);
        projected(grid, 8, Reading::Areas, &picture).difference(&coefficients)
    };
    let [coarse, fine] = [128, 512].map(error);
    println!("degree 8: {coarse:.2e} with 128 rows, {fine:.2e} with 512");
    assert!(fine < 72.0 / 24.0 * (PI / 512.0f64).powi(2), "{fine:e}");
    assert!((coarse / fine - 16.0).abs() < 0.5, "second order: {coarse:e} and {fine:e}");
}

#[test]
fn areas_are_integrated_exactly() {
    // Without a turn, the long way round: harmonics by direction, pixel by pixel.
    for (grid, degree) in [(GRID, 8), (GRID, 31), (Grid { width: 21, height: 10 }, 9)] {
        let pixels = harsh(grid);
        let ours = projected(grid, degree, Reading::Areas, &pixels);
        let direct = project_turned(grid, degree, turn(0.0, 0.0, 0.0), reader(grid, &pixels));
        assert!(ours.difference(&direct) < 1e-13, "{grid:?}: {:e}", ours.difference(&direct));
    }
}

#[test]
fn a_yaw_by_whole_pixels_moves_the_picture_left() {
    let pixels = harsh(GRID);
    let coefficients = projected(GRID, 31, Reading::Areas, &pixels);
    for columns in [1, 16, 63] {
        let moved: Vec<_> =
            pixels.chunks_exact(64).flat_map(|row| [&row[columns..], &row[..columns]].concat()).collect();
        let turned = coefficients.rotated(turn(2.0 * PI * columns as f64 / 64.0, 0.0, 0.0));
        let error = turned.difference(&projected(GRID, 31, Reading::Areas, &moved));
        assert!(error < 1e-13, "{columns} columns: {error:e}");
        let wrong = coefficients.rotated(turn(-2.0 * PI * columns as f64 / 64.0, 0.0, 0.0));
        assert!(wrong.difference(&turned) > 0.1, "the other way is elsewhere");
    }
}

#[test]
fn turned_coefficients_are_those_of_the_turned_picture() {
    let pixels = harsh(GRID);
    let coefficients = projected(GRID, 12, Reading::Areas, &pixels);
    for rotation in [turn(0.3, 0.2, 0.1), turn(-2.0, 1.3, 0.4), turn(0.0, PI / 2.0, 0.0)] {
        let carried = project_turned(GRID, 12, rotation, reader(GRID, &pixels));
        let error = coefficients.rotated(rotation).difference(&carried);
        assert!(error < 1e-13, "{rotation}: {error:e}");
        let unturned = coefficients.difference(&carried);
        assert!(unturned > 0.1, "{rotation} turns");
    }
}

/// The same on a real panorama at degree 8: its pixels as areas, and a picture that is interpolated and sampled.
#[test]
fn a_real_panorama_obeys_the_rotation_theorem() {
    let photo = photo::read(concat!(env!("CARGO_MANIFEST_DIR"), "/media/courtyard.exr").as_ref()).unwrap();
    let grid = Grid { width: photo.width() as usize, height: photo.height() as usize };
    let pixel = |column: usize, row: usize| {
        let [r, g, b, _] = photo.pixels[row * grid.width + column];
        [r, g, b].map(f64::from)
    };
    let read = |row: usize, out: &mut [[f64; 3]]| {
        out.iter_mut().enumerate().for_each(|(column, out)| *out = pixel(column, row));
    };
    let rotation = turn(0.7, 0.4, -0.3);
    let turned = project_panorama(grid, 8, Reading::Areas, read).rotated(rotation);
    let carried = turned.difference(&project_turned(grid, 8, rotation, read));
    // The picture interpolated is another function, so that both sides are sampled, as finely.
    let [coarse, fine] = [1, 8].map(|times| {
        let fine = Grid { width: times * grid.width, height: times * grid.height };
        let at_rest = project_samples(fine, 8, |v| grid.interpolate(v, pixel));
        let back = rotation.inverse();
        at_rest.rotated(rotation).difference(&project_samples(fine, 8, |v| grid.interpolate(back * v, pixel)))
    });
    println!("pixels carried: {carried:.1e}; sampled: {coarse:.1e}, 8 x 8 samples for each pixel: {fine:.1e}");
    assert!(carried < 1e-12, "{carried:e}");
    assert!(fine < 1e-5 && fine < coarse, "{coarse:e}, {fine:e}");
}

#[test]
fn a_reconstruction_nears_the_picture_as_the_degree_grows() {
    let grid = Grid { width: 128, height: 64 };
    // A soft light low on the left, brighter than the rest.
    let light = DVec3::new(0.4, 0.8, -0.3).normalize();
    let picture = |v: DVec3| [0.2 + (20.0 * (v.dot(light) - 1.0)).exp(), 0.1, 0.3 + v.z];
    let pixels: Vec<_> =
        (0..64).flat_map(|row| (0..128).map(move |i| picture(grid.direction(f64::from(i), f64::from(row))))).collect();
    let mut before = f64::INFINITY;
    for degree in [2, 5, 10, 20] {
        let coefficients = projected(grid, degree, Reading::Samples, &pixels);
        let worst =
            directions(200, 31).into_iter().map(|v| (coefficients.at(v)[0] - picture(v)[0]).abs()).fold(0.0, f64::max);
        assert!(worst < 0.5 * before, "degree {degree}: {worst:e} after {before:e}");
        before = worst;
    }
    assert!(before < 2e-5, "{before:e} at degree 20");
}
