//! Every evaluator stays within what its plan predicts, and the plan within what was asked.

use glam::DVec2;
use vglare::Error;
use vglare::frame::{Frame, Window};
use vglare::gpu::Backend;
use vglare::plan::{Evaluator, Plan, Request};
use vglare::reference::direct_at;
use vglare::renderer::Picture;
use vglare::scene::Ghost;

use crate::support::check::{Worst, within};
use crate::support::{bits, glare, long, on_each_backend, on_one_backend, plan, plan_with, rgb, scenes};
use vglare::renderer::Settings;

const TOLERANCES: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// A plan, where to look, and the truth there.
struct Case {
    name: String,
    frame: Frame,
    plan: Plan,
    pixels: Vec<[i32; 2]>,
    exact: Vec<[f64; 3]>,
}

impl Case {
    /// `None` where f32 cannot do it; the error then has to say so, and the floor it names has to be the lowest
    /// tolerance that can be had.
    fn new(name: &str, ghosts: &[Ghost], frame: Frame, tolerance: f64, evaluator: Evaluator) -> Option<Self> {
        let name = format!("{evaluator}, {name}, {tolerance:e}");
        let request = Request { evaluator: Some(evaluator), ..Request::new(tolerance) };
        let plan = match plan(ghosts, frame, &request) {
            Ok(plan) => plan,
            Err(Error::ToleranceBelowFloor { asked, floor }) => {
                println!("{name}: the floor is {floor:.1e}");
                assert_eq!(asked, tolerance);
                assert!(floor > asked, "{name}: a floor of {floor:e} is no reason");
                return None;
            }
            Err(error) => panic!("{name}: {error}"),
        };
        assert!(plan.predicted.total() <= tolerance, "{name}: {:?}", plan.predicted);
        let pixels = scenes::probes(7, ghosts, &plan, frame);
        let exact = direct_at(ghosts, &scenes::positions(frame, &pixels));
        Some(Self { name, frame, plan, pixels, exact })
    }

    /// The error at the probes, relative to the largest value.
    fn measure(&self, backend: Backend, renderer: &mut Picture) -> f64 {
        renderer.field.set_scene(&self.plan).unwrap();
        let actual = renderer.field.probe(self.frame, &self.pixels).unwrap();
        let name = format!("{backend}, {}, predicted {:?}", self.name, self.plan.predicted);
        within(self.plan.predicted.total(), &name, &self.pixels, &self.exact, &actual).relative
    }
}

/// Plans every case, then measures them; `floors` is how many may be below the floor.
fn keep_the_promise(width: u32, height: u32, counts: &[usize], tolerances: &[f64], floors: usize) {
    keep_the_promise_by(&Evaluator::ALL, width, height, counts, tolerances, floors);
}

/// The same by some evaluators.
fn keep_the_promise_by(
    evaluators: &[Evaluator],
    width: u32,
    height: u32,
    counts: &[usize],
    tolerances: &[f64],
    floors: usize,
) {
    let frame = Frame::full(width, height);
    let mut refused = 0;
    let mut cases = Vec::new();
    for &count in counts {
        let ghosts = scenes::random(count as u64 + 1, count, frame);
        let name = format!("{width}x{height}, K = {count}");
        for &evaluator in evaluators {
            // Where most of them reach all of a large picture it is no faster than the direct sum, and looks at every pixel.
            if evaluator == Evaluator::Local && count * frame.window.pixels() > 100_000_000 {
                continue;
            }
            for &tolerance in tolerances {
                match Case::new(&name, &ghosts, frame, tolerance, evaluator) {
                    Some(case) => cases.push(case),
                    None => refused += 1,
                }
            }
        }
    }
    assert!(refused <= floors, "{refused} of {} plans are below f32's floor", cases.len() + refused);
    let measured = on_one_backend(|backend, renderer| -> Vec<f64> {
        cases.iter().map(|case| case.measure(backend, renderer)).collect()
    });
    for &evaluator in evaluators {
        let (mut error, mut share) = (Worst::default(), Worst::default());
        for (case, &relative) in cases.iter().zip(&measured) {
            if case.plan.evaluator() == evaluator {
                error.take(relative, || case.name.clone());
                share.take(relative / case.plan.predicted.total().max(f64::MIN_POSITIVE), || case.name.clone());
            }
        }
        println!("{width}x{height} {evaluator}: worst error {error}, worst share of the prediction {share}");
    }
}

const COUNTS: [usize; 6] = [0, 1, 2, 5, 100, 1000];

// Of 72 plans for a picture, those at 1e-4 for the direct sum may be below the floor where a picture of one pixel sees
// the flanks of small bells only: their weights are then many times the field.
#[test]
fn every_evaluator_keeps_its_promise_at_one_pixel() {
    keep_the_promise(1, 1, &COUNTS, &TOLERANCES, 12);
}

#[test]
fn every_evaluator_keeps_its_promise_at_1x7() {
    keep_the_promise(1, 7, &COUNTS, &TOLERANCES, 4);
}

#[test]
fn every_evaluator_keeps_its_promise_at_17x31() {
    keep_the_promise(17, 31, &COUNTS, &TOLERANCES, 4);
}

#[test]
fn every_evaluator_keeps_its_promise_at_640x480() {
    keep_the_promise(640, 480, &COUNTS, &TOLERANCES, 0);
}

#[test]
fn every_evaluator_keeps_its_promise_at_1921x1081() {
    keep_the_promise(1921, 1081, &COUNTS, &TOLERANCES, 0);
}

#[test]
fn every_evaluator_keeps_its_promise_for_a_hundred_thousand_ghosts() {
    // A series' evaluators differ in what comes after the spectrum, which knows nothing of how many ghosts there are: one
    // of them is enough for all but the long form.
    let evaluators = if long() { &Evaluator::ALL[..] } else { &[Evaluator::Direct, Evaluator::Rows] };
    keep_the_promise_by(evaluators, 1921, 1081, &[100_000], &[1e-4], 0);
}

#[test]
fn the_glare_of_small_pictures_keeps_the_promise_at_every_pixel() {
    for (width, height, tolerance) in [(1, 7, 1e-3), (17, 31, 1e-2), (17, 31, 1e-4), (64, 48, 1e-3)] {
        let frame = Frame::full(width, height);
        let ghosts = scenes::random(42, 20, frame);
        let pixels = scenes::every_pixel(frame);
        let exact = direct_at(&ghosts, &scenes::positions(frame, &pixels));
        let worst = on_one_backend(|backend, renderer| {
            Evaluator::ALL.map(|evaluator| {
                let plan = plan_with(&ghosts, frame, tolerance, evaluator);
                let actual = rgb(&glare(renderer, &plan, frame));
                let name = format!("{backend}, {evaluator}, {width}x{height}");
                within(plan.predicted.total(), &name, &pixels, &exact, &actual).relative
            })
        });
        println!("{width}x{height} at {tolerance:e}, direct, series, rows, grid, local: {worst:?}");
    }
}

#[test]
fn the_backends_give_the_same_bits() {
    // They share their code generator, so that what holds for the numbers of one holds for the other's.
    let frame = Frame::full(71, 41);
    let ghosts = scenes::random(3, 60, frame);
    let results = on_each_backend(|_, renderer| {
        Evaluator::ALL.map(|evaluator| {
            let plan = plan_with(&ghosts, frame, 1e-3, evaluator);
            let alone = bits(&glare(renderer, &plan, frame));
            let mut picture: Vec<[f32; 4]> =
                (0..frame.window.pixels()).map(|i| [i as f32 * 1e-3, 0.5, 2.0, 1.0]).collect();
            renderer.composite(frame, &mut picture, &Settings::default()).unwrap();
            (alone, bits(&picture))
        })
    });
    for (evaluator, (egl, osmesa)) in Evaluator::ALL.into_iter().zip(results[0].iter().zip(&results[1])) {
        assert!(egl.0 == osmesa.0, "{evaluator}: glare");
        assert!(egl.1 == osmesa.1, "{evaluator}: composite");
    }
}

// Each slice of the spectrum is summed by 32s; its last batch must not reach into the next slice. Few modes and some
// thousand like ghosts make many slices of uneven length.
#[test]
fn slices_of_the_spectrum_do_not_overlap() {
    let frame = Frame::full(64, 48);
    let ghosts = scenes::sized(5, 10_000, frame, 0.3, 0.31);
    let case = Case::new("10000 like ghosts", &ghosts, frame, 1e-3, Evaluator::Rows).unwrap();
    let worst = on_one_backend(|backend, renderer| case.measure(backend, renderer));
    println!("{worst:e}");
}

// A loop that the software renderer ends early gives a wrong picture without any error.
#[test]
fn what_the_software_renderer_cannot_sum_is_refused() {
    let frame = Frame::full(16, 9);
    let ghosts = vec![scenes::one([0.1, 0.2], 0.5, [1.0; 3]); 500_000];
    let direct = plan_with(&ghosts, frame, 1e-2, Evaluator::Direct);
    let few = &ghosts[..10];
    let degree = Some([299, 299]);
    let request = Request { evaluator: Some(Evaluator::Series), degree, ..Request::new(1e-2) };
    let series = plan(few, frame, &request).unwrap();
    on_each_backend(|_, renderer| {
        let refusal = renderer.field.set_scene(&direct).unwrap_err().to_string();
        assert!(refusal.contains("500000 ghosts"), "{refusal}");
        renderer.field.set_scene(&series).unwrap();
        let refusal = renderer.field.probe(frame, &[[0, 0]]).unwrap_err().to_string();
        assert!(refusal.contains("90000 terms"), "{refusal}");
    });
}

/// A series given by hand, on a lattice of more nodes along an axis than one tile can tell apart.
fn fine(along: usize, most_nodes: u32) -> Result<(Frame, Plan), Error> {
    let (mut degree, mut period) = ([3, 3], DVec2::splat(8.0));
    (degree[along], period[along]) = (70, 5.0);
    let wide = Frame::full(64, 36);
    let frame = [wide, Frame::full(12, 24).with_window(Window { x: -4, y: -10, width: 20, height: 44 })][along];
    let ghosts = scenes::sized(5, 5, wide, 0.2, 0.3);
    let (degree, period, oversampling) = (Some(degree), Some(period), Some(60.0));
    let evaluator = Some(Evaluator::Grid);
    let request = Request { evaluator, degree, period, oversampling, most_nodes, ..Request::new(1e-2) };
    plan(&ghosts, frame, &request).map(|plan| (frame, plan))
}

#[test]
fn a_lattice_finer_than_a_tile_can_index_is_that_of_rows() {
    for along in [0, 1] {
        let (frame, grid) = fine(along, 16384).unwrap();
        let nodes = grid.lattice().unwrap().nodes;
        assert!(nodes[along] > 4096, "{nodes:?}");
        let rows = grid.clone().with_series(|series| (series.evaluator, series.lattice) = (Evaluator::Rows, None));
        let allowed = 2.0 * grid.predicted.single() + grid.predicted.interpolation;
        let pixels = scenes::every_pixel(frame);
        on_one_backend(|_, renderer| {
            let mut values = |plan: &Plan| {
                renderer.field.set_scene(plan).unwrap();
                renderer.field.probe(frame, &pixels).unwrap()
            };
            let (exact, actual) = (values(&rows), values(&grid));
            within(allowed, &format!("{nodes:?} nodes"), &pixels, &exact, &actual);
            // Held as a whole, and drawn from that, it is the same as tile by tile.
            let settings = Settings::default();
            let mut tiles: Vec<[f32; 4]> = (0..pixels.len()).map(|i| [i as f32 * 1e-3, 0.5, 2.0, 1.0]).collect();
            let mut whole = tiles.clone();
            renderer.composite(frame, &mut tiles, &settings).unwrap();
            renderer.load(frame, &whole).unwrap();
            renderer.draw(frame, &settings).unwrap();
            renderer.fetch(frame, &mut whole).unwrap();
            assert!(bits(&tiles) == bits(&whole), "{nodes:?} nodes: drawn as a whole and tile by tile");
        });
    }
}

#[test]
fn a_lattice_beyond_the_devices_textures_is_refused_with_their_side() {
    let refusal = fine(0, 5000).unwrap_err().to_string();
    assert!(refusal.contains("beyond the 5000 a side that a texture of this device has"), "{refusal}");
}
