//! Graf's theorem on the device against Graf's theorem in f64, and both against the bells themselves.

use glam::DVec2;
use vglare::frame::{Frame, Window};
use vglare::gpu::Backend;
use vglare::renderer::{GrafRenderer, GrafScene};
use vglare::series::fourier_bessel::{Chain, FourierBessel, Graf, Kappa, Paraboloid, Spot, exact, truncation};
use vglare::series::special::{bessel_cubics, bessel_j};

use crate::support::check::Worst;
use crate::support::on_device;
use crate::support::scenes::{Chance, every_pixel, positions};

const BELL: Paraboloid = Paraboloid { peak: 1.0, curvature: 4.0 };
const RADIUS: f64 = 2.0;

/// Runs `test` with a renderer of its own.
fn on_backend<T: Send>(backend: Backend, test: impl FnOnce(Backend, &mut GrafRenderer) -> T + Send) -> T {
    on_device(backend, |device| test(backend, &mut GrafRenderer::new(device).unwrap()))
}

/// The largest difference between a rendered field and f64, over the pixels and in parts of what all peaks add up to.
fn off(renderer: &mut GrafRenderer, scene: &GrafScene<'_>, frame: Frame, expected: &[f64]) -> f64 {
    let field = renderer.render(scene, frame).unwrap();
    assert_eq!(field.len(), expected.len());
    let weight: f64 = scene.spots.iter().map(|spot| spot.weight).sum();
    let error = |(got, expected): (&f32, &f64)| (f64::from(*got) - expected).abs();
    let differences: Vec<f64> = field.iter().zip(expected).map(error).collect();
    assert!(differences.iter().all(|difference| difference.is_finite()));
    differences.into_iter().fold(0.0, f64::max) / (BELL.peak * weight)
}

fn spots(count: usize, reach: f64) -> Vec<Spot> {
    let mut chance = Chance::new(5);
    let mut spot = || {
        let (distance, angle) = (reach * chance.between(0.0, 1.0).sqrt(), chance.between(-4.0, 4.0));
        Spot { center: distance * DVec2::from_angle(angle), weight: chance.between(0.2, 1.0) / count as f64 }
    };
    (0..count).map(|_| spot()).collect()
}

#[test]
fn cubics_carry_bessel_functions() {
    const CELLS: u32 = 2000;
    let (highest, step) = (120, 1.0 / 16.0);
    let cubics = bessel_cubics(highest, step, CELLS);
    let (mut worst, mut chance) = (Worst::default(), Chance::new(3));
    for _ in 0..4000 {
        let (cell, m, t) = (chance.up_to(CELLS - 1), chance.up_to(highest), chance.between(0.0, 1.0));
        let [a, b, c, d] = cubics[(cell * (highest + 1) + m) as usize].map(f64::from);
        let got = a + t * (b + t * (c + t * d));
        let error = (got - bessel_j(m, (f64::from(cell) + t) * step)).abs();
        assert!(error < step.powi(4) / 384.0 + 6e-8, "J_{m} in cell {cell} at {t}: {error:e}");
        worst.take(error, || format!("J_{m} in cell {cell}"));
    }
    println!("worst error {worst}");
}

#[test]
fn the_device_renders_what_f64_says() {
    let frame = Frame::full(75, 48);
    let at = positions(frame, &every_pixel(frame));
    for (terms, highest, count) in [(1, 0, 1), (12, 9, 2), (60, 70, 3), (100, 100, 9)] {
        let series = FourierBessel::new(BELL, RADIUS, terms, Chain::Whole);
        let spots = spots(count, 0.6);
        let [right, printed] = [Kappa::Right, Kappa::Printed { zeroth: 0.0 }].map(|kappa| {
            let scene = GrafScene { series: &series, spots: &spots, highest, kappa };
            let graf = Graf::new(&series, &spots, highest, kappa);
            (scene, at.iter().map(|&at| graf.value(at)).collect::<Vec<_>>())
        });
        for backend in Backend::ALL {
            on_backend(backend, |backend, renderer| {
                for (name, (scene, expected)) in [("right", &right), ("printed", &printed)] {
                    if name == "printed" && highest == 0 {
                        continue; // nothing at all
                    }
                    let error = off(renderer, scene, frame, expected);
                    println!("{backend}, N = {terms}, M = {highest}, {name}: {error:.1e}");
                    // Tables in f32, a Hermite cubic (6e-7 of the fastest term), and some hundred roundings in f32.
                    assert!(error < 2e-6, "{backend}, N = {terms}, M = {highest}, {name}: {error:e}");
                }
                let error = off(renderer, &right.0, frame, &printed.1);
                assert!(error > 1e-2, "the printed weights give another field");
            });
        }
    }
}

#[test]
fn many_ghosts_go_in_batches_and_still_give_the_bells() {
    // The batches hold 4096 ghosts.
    const TERMS: u32 = 40;
    let frame = Frame::full(40, 40);
    let at = positions(frame, &every_pixel(frame));
    let series = FourierBessel::new(BELL, RADIUS, TERMS, Chain::Whole);
    let spots = spots(5000, 0.5);
    let scene = GrafScene { series: &series, spots: &spots, highest: 60, kappa: Kappa::Right };
    let expected: Vec<f64> = at.iter().map(|&at| exact(BELL, &spots, at)).collect();
    on_backend(Backend::Egl, |backend, renderer| {
        let error = off(renderer, &scene, frame, &expected);
        let law = truncation(BELL, RADIUS, TERMS);
        println!("{backend}: {error:.1e}, {law:.1e} if all stood in one place");
        assert!(error < law, "{backend}: {error:e}");
    });
}

#[test]
fn a_window_is_cut_from_the_same_field() {
    let series = FourierBessel::new(BELL, RADIUS, 30, Chain::Whole);
    let spots = spots(2, 0.5);
    let scene = GrafScene { series: &series, spots: &spots, highest: 60, kappa: Kappa::Right };
    // Within one quadrant, across one axis, beyond the picture, and about an odd middle.
    for (width, height, [x, y]) in [(64, 48, [40, 3]), (64, 48, [5, 30]), (64, 48, [20, -3]), (63, 47, [25, 20])] {
        let part = Frame::full(width, height).with_window(Window { x, y, width: 19, height: 13 });
        let expected: Vec<f64> =
            positions(part, &every_pixel(part)).iter().map(|&at| series.unseparated(&spots, at)).collect();
        on_backend(Backend::Egl, |backend, renderer| {
            let error = off(renderer, &scene, part, &expected);
            println!("{backend}, from {x}, {y}: {error:.1e}");
            assert!(error < 2e-6, "{backend}, from {x}, {y}: {error:e}");
        });
    }
}
