//! What an iris diffracts, against closed forms.

use std::f64::consts::{PI, TAU};

use super::spectrum::{Sensitivities, VISIBLE};
use super::*;

fn iris(fstop: f64, blades: u32, rotation: f64) -> Starburst {
    Starburst::new(fstop, blades, rotation, 0.0, 36.0).unwrap()
}

fn grid(stored: [usize; 2], across: usize) -> Grid {
    Grid { stored, across, pitch: 2.0 / stored[1] as f64 }
}

/// A kernel's pixel so many columns to the right of its centre and rows above it.
fn at(kernel: &Kernel, right: isize, above: isize) -> [f64; 3] {
    let [row, column] = kernel.centre();
    kernel.pixels()[(row as isize - above) as usize * kernel.columns() + (column as isize + right) as usize]
}

/// Wavelengths, 0.5 nm apart, so that fringes two hundred λN from the centre are told apart, and what the channels have of each.
fn wavelengths() -> impl Iterator<Item = (f64, [f64; 3])> {
    let seen = Sensitivities::new();
    let wavelength = |part: usize| VISIBLE[0] + (part as f64 + 0.5) * 5e-4;
    let all: Vec<_> = (0..700).map(wavelength).map(|wavelength| (wavelength, seen.at(wavelength))).collect();
    let whole = [0, 1, 2].map(|k| all.iter().map(|(_, seen)| seen[k]).sum::<f64>());
    all.into_iter().map(move |(wavelength, seen)| (wavelength, [0, 1, 2].map(|k| seen[k] / whole[k])))
}

/// The light of a pixel by channels: the mean over a pixel of `pattern`, of lengths in λN, by wavelengths; `side` is in micrometres.
fn mean(pattern: impl Fn(f64, f64) -> f64, fstop: f64, side: f64, right: f64, above: f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (wavelength, part) in wavelengths() {
        let unit = side / (wavelength * fstop);
        // Twice as fine as the pattern's narrowest ring.
        let samples = (4.0 * unit).ceil() as usize + 24;
        let off = |sample: usize| (sample as f64 + 0.5) / samples as f64 - 0.5;
        let mut light = 0.0;
        for y in 0..samples {
            for x in 0..samples {
                light += pattern((right + off(x)) * unit, (above + off(y)) * unit);
            }
        }
        let light = light * (unit / samples as f64).powi(2);
        (0..3).for_each(|k| sum[k] += part[k] * light);
    }
    sum
}

/// The pattern of a round opening, whose light is 1.
fn airy(x: f64, y: f64) -> f64 {
    let v = PI * x.hypot(y);
    let part = if v > 1e-6 { 2.0 * libm::j1(v) / v } else { 1.0 };
    0.25 * PI * part * part
}

/// Of a square whose diagonal is 1, with sides along the axes after it is turned back by `angle`.
fn square(x: f64, y: f64, angle: f64) -> f64 {
    let side = 0.5_f64.sqrt();
    let sinc = |x: f64| if x.abs() > 1e-9 { (PI * x).sin() / (PI * x) } else { 1.0 };
    let (sine, cosine) = angle.sin_cos();
    let parts = [x * cosine + y * sine, y * cosine - x * sine].map(|x| sinc(side * x));
    (parts[0] * parts[1]).powi(2) * side * side
}

#[test]
fn a_round_opening_makes_airys_disc_and_rings() {
    for fstop in [2.8, 16.0, 64.0] {
        let kernel = iris(fstop, 0, 0.0).kernel(&grid([121, 81], 1920));
        for (right, above) in [(1, 0), (1, 1), (0, -2), (3, 1), (-5, 4), (9, 0), (25, 30), (120, -80)] {
            let known = mean(airy, fstop, 36e3 / 1920.0, right as f64, above as f64);
            let found = at(&kernel, right, above);
            for k in 0..3 {
                let off = (found[k] / known[k] - 1.0).abs();
                assert!(off < 0.02, "f/{fstop}, {right}, {above}: {found:?} for {known:?}");
            }
        }
        // The whole against encircled energies: what the square of a pixel holds lies between its two circles.
        let side = 36e3 / 1920.0;
        let inside = |radius: f64| {
            let mut sum = [0.0; 3];
            for (wavelength, part) in wavelengths() {
                let v = PI * radius / (wavelength * fstop);
                let encircled = 1.0 - libm::j0(v).powi(2) - libm::j1(v).powi(2);
                (0..3).for_each(|k| sum[k] += part[k] * encircled);
            }
            sum
        };
        let (least, most) = (inside(0.5 * side), inside(0.5_f64.sqrt() * side));
        for k in 0..3 {
            let kept = 1.0 - kernel.energies()[k];
            assert!((least[k]..most[k]).contains(&kept), "f/{fstop}: {kept}, {least:?} to {most:?}");
        }
    }
}

#[test]
fn a_square_opening_makes_a_cross_as_it_is_turned() {
    for (rotation, fstop) in [(45.0, 22.0), (20.0, 22.0), (45.0, 5.6), (-70.0, 45.0)] {
        let kernel = iris(fstop, 4, rotation).kernel(&grid([200, 160], 1920));
        let angle = f64::to_radians(rotation - 45.0);
        let along = |distance: f64| [distance * angle.cos(), distance * angle.sin()].map(|x| x.round() as isize);
        let on = [1.0, 4.0, 20.0, 150.0].map(along);
        // Beside it there is next to nothing, and what fringes are left in that are not all told apart.
        let beside = [[1, 1], [2, -1], [-3, 5], [20, 22]].map(|pixel| (pixel, 0.05));
        for ([right, above], most) in on.map(|pixel| (pixel, 0.025)).into_iter().chain(beside) {
            let pattern = |x, y| square(x, y, angle);
            let known = mean(pattern, fstop, 36e3 / 1920.0, right as f64, above as f64);
            let found = at(&kernel, right, above);
            for k in 0..3 {
                let off = (found[k] / known[k] - 1.0).abs();
                assert!(off < most, "f/{fstop}, {rotation}: {right}, {above}: {found:?} for {known:?}");
            }
        }
        // ∫ sinc² over half a pixel to either side, both ways; only where its sides are the pixel's.
        if angle == 0.0 {
            let kept = mean(|x, y| square(x, y, 0.0), fstop, 36e3 / 1920.0, 0.0, 0.0);
            let left = kernel.energies();
            assert!((0..3).all(|k| (1.0 - left[k] - kept[k]).abs() < 5e-4), "{left:?} and {kept:?}");
        }
    }
}

/// Directions, in degrees, in which a ring of a kernel is brightest: above a third of its largest value, each run once.
fn spikes(kernel: &Kernel, radius: f64) -> Vec<f64> {
    let ring = |step: usize| {
        let direction = TAU * step as f64 / 1440.0;
        let [x, y] = [radius * direction.cos(), radius * direction.sin()].map(|x| x.round() as isize);
        // A spike of less than a pixel's width may lie between two.
        (-1..=1).flat_map(|up| (-1..=1).map(move |right| (right, up))).map(|(i, j)| at(kernel, x + i, y + j)[1]).sum()
    };
    let light: Vec<f64> = (0..1440).map(ring).collect();
    let most = light.iter().copied().fold(0.0, f64::max);
    let bright = |step: usize| light[step % 1440] > most / 3.0;
    let begins = (0..1440).filter(|step| bright(*step) && !bright(step + 1439));
    begins
        .map(|from| 0.25 * (from as f64 + 0.5 * ((from..).take_while(|step| bright(*step)).count() - 1) as f64))
        .collect()
}

#[test]
fn spikes_stand_at_right_angles_to_blades() {
    for (blades, count) in [(3, 6), (4, 4), (5, 10), (6, 6), (7, 14), (8, 8), (9, 18)] {
        for rotation in [0.0, 11.0] {
            let kernel = iris(16.0, blades, rotation).kernel(&grid([200, 200], 1920));
            let found = spikes(&kernel, 150.0);
            assert_eq!(found.len(), count, "{blades}: {found:?}");
            // Above the centre is to the top: row 0.
            let first = rotation + 180.0 / f64::from(blades);
            for direction in found {
                let turns = (direction - first) * count as f64 / 360.0;
                assert!(
                    (turns - turns.round()).abs() * 360.0 / (count as f64) < 0.6,
                    "{blades}, {rotation}: {direction}"
                );
            }
        }
    }
    // A round one has none: no ring is brighter than another part of it.
    assert!(spikes(&iris(16.0, 0, 0.0).kernel(&grid([200, 200], 1920)), 150.0).len() <= 1);
}

#[test]
fn all_of_the_light_is_accounted_for() {
    for (fstop, blades, roundness) in [(1.4, 9, 0.5), (8.0, 5, 0.0), (16.0, 6, 0.0), (22.0, 7, 0.02), (64.0, 15, 0.0)] {
        let iris = Starburst::new(fstop, blades, 3.0, roundness, 36.0).unwrap();
        let photo = grid([300, 200], 300);
        let kernel = iris.kernel(&photo);
        let (told, found) = (iris.energies(&photo), kernel.energies());
        assert!((0..3).all(|k| (told[k] - found[k]).abs() < 1e-3 && found[k] < 1.0), "{told:?} and {found:?}");
        // What is beyond a part of the picture is what the larger one has there, and what is beyond that.
        let small = iris.kernel(&Grid { stored: [40, 30], ..photo });
        let beyond = |kernel: &Kernel| {
            let within: [f64; 3] = [0, 1, 2].map(|k| kernel.pixels().iter().map(|pixel| pixel[k]).sum());
            [0, 1, 2].map(|k| kernel.energies()[k] - within[k])
        };
        let between: f64 =
            kernel.pixels().iter().map(|p| p[1]).sum::<f64>() - small.pixels().iter().map(|p| p[1]).sum::<f64>();
        let [larger, smaller] = [beyond(&kernel)[1], beyond(&small)[1]];
        assert!(larger > 0.0 && ((smaller - larger) / between - 1.0).abs() < 0.02, "{smaller}, {larger}, {between}");
        assert_eq!(at(&kernel, 0, 0), [0.0; 3]);
    }
}

/// Patterns grow with the wavelength: what is outside is red, and what stays is blue.
#[test]
fn ends_are_red_and_all_is_white() {
    let kernel = iris(16.0, 6, 0.0).kernel(&grid([600, 600], 1920));
    for above in [50, 200, 590] {
        let [red, green, blue] = at(&kernel, 0, above);
        assert!(red > 1.05 * green && green > 1.1 * blue, "{above}: {red}, {green}, {blue}");
    }
    let pattern = pattern_of(Aperture::new(6, 0.0));
    let all = pattern.outside(0.0, |_| 0.0);
    assert!(all.iter().all(|all| (all - 1.0).abs() < 3e-4), "{all:?}");
}

#[test]
fn twice_the_f_number_is_twice_the_size() {
    let small = Starburst::new(11.0, 7, 5.0, 0.1, 36.0).unwrap().kernel(&grid([90, 70], 2000));
    for (fstop, sensor, across) in [(22.0, 36.0, 1000), (22.0, 72.0, 2000), (22.0, 18.0, 500)] {
        let large = Starburst::new(fstop, 7, 5.0, 0.1, sensor).unwrap().kernel(&grid([90, 70], across));
        let pairs = small.pixels().as_flattened().iter().zip(large.pixels().as_flattened());
        assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() <= 1e-6 * a), "f/{fstop}, {sensor} mm");
        assert!((small.energies()[1] / large.energies()[1] - 1.0).abs() < 1e-9);
    }
}

/// Bent all the way, blades are a circle; a little, they spread their spikes to fans.
#[test]
fn bent_blades_spread_their_spikes() {
    let of =
        |blades, roundness| Starburst::new(16.0, blades, 0.0, roundness, 36.0).unwrap().kernel(&grid([260, 260], 1920));
    assert!(of(7, 1.0) == of(0, 0.0), "a circle");
    let nearly = (of(7, 0.999), of(0, 0.0));
    let [bent, round] = [at(&nearly.0, 60, 80)[1], at(&nearly.1, 60, 80)[1]];
    assert!((bent / round - 1.0).abs() < 0.05, "{bent} and {round}");
    // At the top there is a spike of six blades; beside it a fan of as many degrees as the blade's ends differ by.
    let (straight, fan) = (of(6, 0.0), of(6, 0.2));
    let beside = |kernel: &Kernel| at(kernel, 10, 250)[1] / at(kernel, 0, 250)[1];
    assert!(beside(&straight) < 0.01 && beside(&fan) > 0.3, "{} and {}", beside(&straight), beside(&fan));
}

/// The share of `camera` is all there, beside what is diffracted of the rest.
#[test]
fn the_lens_may_scatter_besides() {
    let photo = grid([160, 120], 160);
    let plain = iris(16.0, 6, 0.0);
    let both = plain.clone().scattering(0.04).unwrap();
    let (plain, kernel) = (plain.kernel(&photo), both.kernel(&photo));
    // Far from a spike it is what is seen; its values are those of the function.
    let camera = crate::psf::Psf::camera().scattering(0.04).unwrap();
    let known = photo.pitch * photo.pitch * camera.value(photo.pitch * 50.0_f64.hypot(10.0));
    let found = at(&kernel, 50, 10)[1] - 0.96 * at(&plain, 50, 10)[1];
    assert!((found / known - 1.0).abs() < 1e-9, "{found} for {known}");
    // The middle pixel keeps what is scattered within its circles.
    let (energies, plain) = (kernel.energies(), plain.energies());
    let scattered = energies[1] - 0.96 * plain[1];
    let [most, least] = [0.5, 0.5_f64.sqrt()].map(|r| 0.04 - camera.energy_within(r * photo.pitch));
    assert!((least..most).contains(&scattered), "{least}, {scattered}, {most}");
    assert!((0..3).all(|k| (both.energies(&photo)[k] - energies[k]).abs() < 1e-3));
}

#[test]
fn means_over_directions_are_those_of_the_opening() {
    let round = iris(8.0, 0, 0.0);
    for r in [0.5, 2.0, 10.0, 55.0, 900.0] {
        let mut known = [0.0; 2];
        for (wavelength, part) in wavelengths() {
            let (unit, part) = (wavelength * 8.0, part.iter().sum::<f64>() / 3.0);
            let v = PI * r / unit;
            known[0] += part * airy(r / unit, 0.0) / (unit * unit);
            known[1] += part * (1.0 - libm::j0(v).powi(2) - libm::j1(v).powi(2));
        }
        let found = [round.ring(r), round.within(r)];
        assert!((found[0] / known[0] - 1.0).abs() < 0.01, "{r}: {found:?} for {known:?}");
        assert!((found[1] - known[1]).abs() < 5e-4, "{r}: {found:?} for {known:?}");
    }
    for frequency in [0.0, 0.01, 0.1, 0.3] {
        let known: f64 = wavelengths()
            .map(|(wavelength, part)| {
                let lag = (frequency * wavelength * 8.0).min(1.0);
                part.iter().sum::<f64>() / 3.0 * 2.0 / PI * (lag.acos() - lag * (1.0 - lag * lag).sqrt())
            })
            .sum();
        let found = round.transform(frequency);
        assert!((found - known).abs() < 2e-4, "{frequency}: {found} for {known}");
    }
    // Near 0 the transform falls by the perimeter: 1 − 2Pν/(2πA).
    let (six, frequency) = (iris(8.0, 6, 0.0), 1e-3);
    let slope = 3.0 / (PI * 3.0 * 3.0_f64.sqrt() / 8.0);
    let mean: f64 = wavelengths().map(|(l, part)| l * part.iter().sum::<f64>() / 3.0).sum();
    let found = (1.0 - six.transform(frequency)) / (frequency * 8.0 * mean);
    assert!((found / slope - 1.0).abs() < 0.01, "{found} for {slope}");
}

#[test]
fn extremes_are_finite() {
    let iris = |fstop, blades, rotation, roundness, sensor| {
        Starburst::new(fstop, blades, rotation, roundness, sensor).and_then(|iris| iris.scattering(0.5)).unwrap()
    };
    for (iris, across) in [
        (iris(0.5, 3, 1e300, 1e-9, 500.0), 1),
        (iris(64.0, 16, -1e9, 0.5, 1.0), 60_000),
        (iris(64.0, 3, 0.0, 0.0, 1.0), 1 << 20),
        (iris(0.5, 0, 0.0, 0.0, 500.0), 10),
    ] {
        for stored in [[1, 1], [7, 1], [30, 20]] {
            let kernel = iris.kernel(&grid(stored, across));
            assert!(kernel.pixels().iter().flatten().all(|x| x.is_finite() && *x >= 0.0), "{iris:?}, {stored:?}");
            let energies = kernel.energies();
            assert!(energies.iter().all(|energy| *energy > 0.0 && *energy < 1.0 + 1e-3), "{iris:?}: {energies:?}");
        }
    }
}
