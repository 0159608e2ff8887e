//! Rows count from the top, columns from the left, and a window is a crop of the picture.

use vglare::frame::{Frame, Window};
use vglare::plan::Evaluator;
use vglare::reference::direct_at;
use vglare::scene::Ghost;

use crate::support::check::within;
use crate::support::{bits, glare, on_each_backend, plan_with, rgb, scenes};

const FRAME: Frame = Frame::full(97, 61);

/// Red top right, blue bottom left, each on the centre of a pixel.
fn asymmetric() -> [Ghost; 2] {
    let at = |i, j| FRAME.position(i, j).to_array();
    [scenes::one(at(80.0, 9.0), 0.2, [1.0, 0.0, 0.0]), scenes::one(at(13.0, 50.0), 0.15, [0.0, 0.0, 2.0])]
}

fn brightest(pixels: &[[f32; 4]], colour: usize) -> [usize; 2] {
    let largest = (0..pixels.len()).max_by(|&a, &b| pixels[a][colour].total_cmp(&pixels[b][colour])).unwrap();
    [largest % FRAME.width as usize, largest / FRAME.width as usize]
}

#[test]
fn a_ghost_is_brightest_where_its_centre_is() {
    on_each_backend(|backend, renderer| {
        for evaluator in Evaluator::ALL {
            let plan = plan_with(&asymmetric(), FRAME, 1e-4, evaluator);
            let pixels = glare(renderer, &plan, FRAME);
            assert_eq!(brightest(&pixels, 0), [80, 9], "{backend}, {evaluator}: red");
            assert_eq!(brightest(&pixels, 2), [13, 50], "{backend}, {evaluator}: blue");
            assert_eq!(renderer.field.probe(FRAME, &[[80, 9]]).unwrap()[0][0] as f32, pixels[9 * 97 + 80][0]);
        }
    });
}

/// Windows within the picture, across its edges, and beside it.
const WINDOWS: [Window; 4] = [
    Window { x: 20, y: 7, width: 33, height: 20 },
    Window { x: -9, y: -5, width: 30, height: 17 },
    Window { x: 70, y: 40, width: 40, height: 35 },
    Window { x: 99, y: -30, width: 8, height: 12 },
];

#[test]
fn a_window_is_a_crop_of_the_picture() {
    // A larger window that holds them all stands for the picture.
    let whole = FRAME.with_window(Window { x: -20, y: -40, width: 140, height: 130 });
    on_each_backend(|backend, renderer| {
        for evaluator in [Evaluator::Direct, Evaluator::Series, Evaluator::Rows] {
            let plan = plan_with(&asymmetric(), whole, 1e-3, evaluator);
            let all = glare(renderer, &plan, whole);
            for window in WINDOWS {
                let part = glare(renderer, &plan, FRAME.with_window(window));
                let first = |j: u32| ((window.y + 40 + j as i32) * 140 + window.x + 20) as usize;
                let crop: Vec<_> =
                    (0..window.height).flat_map(|j| &all[first(j)..][..window.width as usize]).copied().collect();
                assert_eq!(bits(&part), bits(&crop), "{backend}, {evaluator}, {window:?}");
            }
        }
    });
}

// The lattice of `grid` hangs from the window's corner, so bits may differ; the promise may not.
#[test]
fn a_window_keeps_the_promise_of_its_own_plan() {
    on_each_backend(|backend, renderer| {
        for (window, evaluator) in WINDOWS.into_iter().flat_map(|window| Evaluator::ALL.map(|each| (window, each))) {
            let frame = FRAME.with_window(window);
            // Wide enough to be seen from every window.
            let ghosts = asymmetric().map(|ghost| Ghost { size: 8.0 * ghost.size, ..ghost });
            let plan = plan_with(&ghosts, frame, 1e-3, evaluator);
            let pixels = scenes::every_pixel(frame);
            let exact = direct_at(&ghosts, &scenes::positions(frame, &pixels));
            let actual = rgb(&glare(renderer, &plan, frame));
            within(plan.predicted.total(), &format!("{backend}, {evaluator}, {window:?}"), &pixels, &exact, &actual);
        }
    });
}

/// The second moments of a round ghost over the pixels, in closed form: σ²/(2a/H)² and σ²/(2/H)².
#[test]
fn a_round_ghost_is_round_where_wide_pixels_are_shown() {
    let ghosts = [scenes::one([0.0, 0.0], 0.15, [1.0; 3])];
    let window = Window { x: -40, y: -30, width: 177, height: 121 };
    on_each_backend(|backend, renderer| {
        for (frame, evaluator) in [0.5, 2.0].into_iter().flat_map(|pixel_aspect| {
            Evaluator::ALL.map(|evaluator| (Frame { pixel_aspect, ..FRAME }.with_window(window), evaluator))
        }) {
            let plan = plan_with(&ghosts, frame, 1e-4, evaluator);
            let pixels = rgb(&glare(renderer, &plan, frame));
            let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
                let value = |(k, pixel): (usize, &[f64; 3])| {
                    let (column, row) = ((k % 177) as f64 - 40.0 - 48.0, (k / 177) as f64 - 30.0 - 30.0);
                    pixel[0] * of(column, row)
                };
                pixels.iter().enumerate().map(value).sum()
            };
            let all = sum(&|_, _| 1.0);
            let variances = [sum(&|x, _| x * x) / all, sum(&|_, y| y * y) / all];
            let expected = [frame.pixel_aspect, 1.0].map(|aspect| (0.15 / (2.0 * aspect / 61.0)).powi(2));
            let name = format!("{backend}, {evaluator}, {}", frame.pixel_aspect);
            for (got, want) in variances.into_iter().zip(expected) {
                assert!((got / want - 1.0).abs() < 0.02, "{name}: {variances:?} for {expected:?}");
            }
            let places = scenes::every_pixel(frame);
            let exact = direct_at(&ghosts, &scenes::positions(frame, &places));
            within(plan.predicted.total(), &name, &places, &exact, &pixels);
        }
    });
}
