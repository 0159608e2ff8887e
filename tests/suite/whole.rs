//! Ghosts of the whole photo, held against a light for each pixel: the sum over all pixels and all ghosts of the lens.
//! `VGLARE_LONG_TESTS` tries a hundred looks.

use std::sync::Arc;

use glam::DVec2;
use vglare::certificate::Certificate;
use vglare::choices::{LengthUnit, Mix};
use vglare::compare::compare_in;
use vglare::frame::{Frame, Window};
use vglare::gpu::Backend;
use vglare::job::{Computer, Found, Known, Stages, Unwatched, Wanted};
use vglare::look::{LookLens, LookLights};
use vglare::photo::Photo;
use vglare::plan::{self, Evaluator, Request};
use vglare::problem::{Images, Problem};
use vglare::raster::Raster;
use vglare::reference;
use vglare::scene::{self, FindOptions, Ghost, Knee, Lens, LensGhost, Light};
use vglare::series::{Bell, Disc, Iris};

use crate::support::scenes::{Chance, every_pixel, positions};
use crate::support::{long, on_backend, on_device};

/// Looks that are tried.
const LOOKS: u64 = 16;
const LONG: u64 = 100;

/// A photo, a lens, and where its axis is.
struct Look {
    frame: Frame,
    pixels: Vec<[f32; 4]>,
    lens: Vec<LensGhost>,
    axis: DVec2,
    others: Vec<Ghost>,
    tolerance: f64,
}

impl Look {
    fn by_chance(chance: &mut Chance) -> Self {
        let [width, height] = [24, 18].map(|least| least + chance.below(40) as u32);
        let whole = Frame { pixel_aspect: [1.0, 1.0, 2.0][chance.below(3) as usize], ..Frame::full(width, height) };
        let window = Window { x: -3, y: 5, width: width - 9, height: height - 2 };
        let frame = if chance.below(4) == 0 { whole.with_window(window) } else { whole };
        let bells = [
            vec![Bell::Gaussian],
            vec![Bell::Gaussian, Bell::CosineSquared],
            vec![Bell::Gaussian, Bell::Disc(Disc::new(1.8, 0, 0.0).unwrap())],
        ];
        let kind = chance.below(3) as usize;
        let bells = &bells[kind];
        // The less smooth a bell is, the faster its degree grows with one over the tolerance.
        let tolerance = 10f64.powf(if kind == 0 { chance.between(-5.0, -2.0) } else { chance.between(-2.3, -1.5) });
        let lens = (0..1 + chance.below(9)).map(|_| {
            let smallest = if kind == 0 && chance.below(3) == 0 { 0.06 } else { 0.3 };
            let size = chance.octaves(smallest, 1.2);
            LensGhost {
                bell: bells[chance.below(bells.len() as u64) as usize].clone(),
                along: chance.between(-1.5, 1.5),
                size: DVec2::new(size, size * chance.octaves(0.7, 1.4)),
                tint: [0; 3].map(|_| chance.between(0.0, 1.0)),
                share: chance.octaves(1e-4, 1e-2),
            }
        });
        let lens = lens.collect();
        let axis = DVec2::new(chance.between(-0.3, 0.3), chance.between(-0.3, 0.3));
        let others = match chance.below(3) {
            0 => vec![crate::support::scenes::one([0.2, -0.1], 0.4, [1.0, 2.0, 0.5])],
            _ => Vec::new(),
        };
        Self { frame, pixels: photo(chance, frame.window.pixels()), lens, axis, others, tolerance }
    }

    fn problem(&self) -> Arc<Problem> {
        let raster = Raster::new(&self.pixels, self.frame).expect("the frame's pixels");
        let images = Images::new(raster, &self.lens, self.axis, 1.0, [1.0; 3]);
        Problem::with_images(self.others.clone(), images.into(), self.frame)
    }

    /// The ghosts that as many lights make, by the rule for lights. A pixel's extent is that of a square; where its sides differ,
    /// so do the extents, and lights have but one.
    fn ghosts(&self) -> Vec<Ghost> {
        let sides = self.frame.pixel_sides();
        let light = |(pixel, position): (&[f32; 4], DVec2)| {
            let flux =
                [0, 1, 2].map(|c| if pixel[c] > 0.0 { f64::from(pixel[c]) * sides.element_product() } else { 0.0 });
            Light { position, flux, size: sides.x / 12f64.sqrt(), muted: false }
        };
        let places = positions(self.frame, &every_pixel(self.frame));
        let lights: Vec<Light> = self.pixels.iter().zip(places).map(light).collect();
        let lens = Lens { name: String::new(), description: String::new(), ghosts: self.lens.clone(), veil: None };
        let mut ghosts = scene::ghosts(&lights, &lens, self.axis);
        if sides.x != sides.y {
            let each = self.lens.iter().map(|lens| lens.image(sides / 12f64.sqrt()));
            for (ghost, image) in ghosts.iter_mut().zip(each.collect::<Vec<_>>().iter().cycle()) {
                let peak = ghost.size.element_product() / image.size.element_product();
                ghost.size = image.size;
                ghost.radiance = ghost.radiance.map(|radiance| radiance * peak);
            }
        }
        ghosts.extend(self.others.iter().cloned());
        ghosts
    }
}

/// Noise over some decades, a few lamps, and what is no light.
fn photo(chance: &mut Chance, count: usize) -> Vec<[f32; 4]> {
    let decades = chance.between(0.0, 3.0);
    let mut pixels: Vec<[f32; 4]> =
        (0..count).map(|_| [0; 4].map(|_| 10f64.powf(-decades * chance.between(0.0, 1.0)) as f32)).collect();
    for _ in 0..chance.below(4) {
        let lamp = chance.octaves(10.0, 1e5) as f32;
        pixels[chance.below(count as u64) as usize] = [lamp, 0.7 * lamp, 0.3 * lamp, 1.0];
    }
    pixels[0] = [-1.0, 0.5, -0.0, 1.0];
    pixels
}

/// Openings that are no mirror images of themselves, turned and stretched, on either side of an axis that is not in the middle.
#[test]
fn openings_of_every_pixel_are_what_as_many_lights_make() {
    let iris = |edge, blades, rotation| Bell::Iris(Iris::new(edge, blades, rotation).unwrap());
    let bells = [iris(0.12, 5, 17.0), iris(0.2, 3, -40.0), iris(0.25, 0, 0.0)];
    let ghost = |(bell, along): (&Bell, f64)| LensGhost {
        bell: bell.clone(),
        along,
        size: DVec2::new(0.5, 0.35),
        tint: [1.0, 0.5, 0.25],
        share: 0.01,
    };
    let frame = Frame::full(44, 30);
    for (seed, tolerance) in [(1, 3e-2), (2, 1e-3)] {
        let look = Look {
            frame,
            pixels: photo(&mut Chance::new(seed), frame.window.pixels()),
            lens: bells.iter().zip([-0.7, 0.6, -1.2]).map(ghost).collect(),
            axis: DVec2::new(0.2, -0.1),
            others: Vec::new(),
            tolerance,
        };
        let (problem, pixels) = (look.problem(), every_pixel(frame));
        let truth = reference::direct_at(&look.ghosts(), &positions(frame, &pixels));
        // What is left out of a tail is far below any tolerance.
        let own = compare_in(&truth, &problem.truth(&pixels), [1e-300; 3]);
        assert!(own.relative < 1e-8, "{:e}", own.relative);
        let plan = plan::plan(&problem, &Request::new(tolerance)).expect("a series");
        on_backend(Backend::Egl, |renderer| {
            renderer.field.set_scene(&plan).expect("a spectrum");
            let field = renderer.field.probe(frame, &pixels).expect("a field");
            let measured = compare_in(&truth, &field, [1e-300; 3]).relative;
            assert!(measured <= plan.predicted.total() && plan.predicted.total() <= tolerance, "{measured:e}");
        });
    }
}

#[test]
fn every_pixel_makes_every_ghost_within_the_bound() {
    on_backend(Backend::Egl, |renderer| {
        let mut factors = Vec::new();
        for seed in 0..if long() { LONG } else { LOOKS } {
            let mut chance = Chance::new(seed);
            let look = Look::by_chance(&mut chance);
            let (problem, frame, tolerance) = (look.problem(), look.frame, look.tolerance);
            let pixels = every_pixel(frame);
            let truth = reference::direct_at(&look.ghosts(), &positions(frame, &pixels));
            // What a certificate goes by is the same sum.
            let own = compare_in(&truth, &problem.truth(&pixels), [1e-300; 3]);
            assert!(own.relative < 1e-12, "{seed}: {:e}", own.relative);
            let plan = plan::plan(&problem, &Request::new(tolerance)).unwrap_or_else(|error| panic!("{seed}: {error}"));
            assert!(plan.predicted.total() <= tolerance, "{seed}: {:?}", plan.predicted);
            renderer.field.set_scene(&plan).expect("a spectrum");
            let field = renderer.field.probe(frame, &pixels).expect("a field");
            // The unit is no more than the largest value.
            let difference = compare_in(&truth, &field, [1e-300; 3]);
            let measured = difference.relative;
            assert!(measured <= plan.predicted.total(), "{seed}: {measured:e}, {:?}", plan.predicted);
            for colour in 0..3 {
                let largest = truth.iter().fold(0.0f64, |most, value| most.max(value[colour]));
                assert!(plan.scale[colour] <= largest * (1.0 + 1e-12), "{seed}: {:?} for {largest}", plan.scale);
                assert!(largest <= 2.0 * plan.scale[colour], "{seed}: {:?} for {largest}", plan.scale);
            }
            factors.push(plan.predicted.total() / measured);
        }
        factors.sort_by(f64::total_cmp);
        let median = factors[factors.len() / 2];
        assert!(median < 10.0, "{median}: {factors:?}");
    });
}

/// A lens of two wide ghosts over a photo with a lamp.
fn two_ghosts() -> Look {
    let mut chance = Chance::new(3);
    let frame = Frame::full(48, 27);
    let ghost = |along, size| LensGhost {
        bell: Bell::Gaussian,
        along,
        size: DVec2::splat(size),
        tint: [1.0, 0.8, 0.6],
        share: 1e-3,
    };
    let lens = vec![ghost(-0.7, 0.3), ghost(1.0, 0.6)];
    Look {
        frame,
        pixels: photo(&mut chance, frame.window.pixels()),
        lens,
        axis: DVec2::ZERO,
        others: Vec::new(),
        tolerance: 1e-3,
    }
}

#[test]
fn every_series_does_it_and_nothing_else() {
    let look = two_ghosts();
    let (problem, pixels) = (look.problem(), every_pixel(look.frame));
    let truth = problem.truth(&pixels);
    on_backend(Backend::Egl, |renderer| {
        let mut measured = |request: &Request| {
            let plan = plan::plan(&problem, request).expect("a plan");
            renderer.field.set_scene(&plan).expect("a spectrum");
            let field = renderer.field.probe(look.frame, &pixels).expect("a field");
            let measured = compare_in(&truth, &field, [1e-300; 3]).relative;
            assert!(measured <= plan.predicted.total(), "{:?}: {measured:e}, {:?}", request.evaluator, plan.predicted);
            (measured, plan)
        };
        for evaluator in [Evaluator::Series, Evaluator::Rows, Evaluator::Grid] {
            for tolerance in [1e-2, 1e-5, 2e-7] {
                let request = Request { evaluator: Some(evaluator), ..Request::new(tolerance) };
                let (measured, plan) = measured(&request);
                assert!(plan.evaluator() == evaluator && measured <= tolerance, "{evaluator}: {measured:e}");
            }
        }
        // A degree that is given is taken as it comes.
        let given = Request { degree: Some([5, 4]), ..Request::new(1e-3) };
        let (measured, plan) = measured(&given);
        assert!(plan.degree() == [5, 4] && measured > 1e-3, "{measured:e}");
    });
    for evaluator in [Evaluator::Direct, Evaluator::Local] {
        let refused = plan::plan(&problem, &Request { evaluator: Some(evaluator), ..Request::new(1e-3) });
        let reason = refused.expect_err("no sum of single bells").to_string();
        assert!(reason.contains("--sources lights") && reason.contains(&evaluator.to_string()), "{reason}");
    }
}

/// The two wide ghosts, and sharp ones between and beside them: lenses that no series holds.
fn sharp_lenses() -> Vec<Vec<LensGhost>> {
    let disc = |rim, blades| Bell::Disc(Disc::new(rim, blades, 10.0 * f64::from(blades.min(1))).unwrap());
    let sharp = [
        vec![(Bell::Paraboloid, -1.3, 0.4)],
        vec![(disc(0.1, 0), -0.7, 0.25), (Bell::Parabola, 0.05, 0.2), (disc(0.1, 5), 2.5, 0.5)],
        vec![(disc(0.0, 7), 1.0, 0.3), (Bell::CosineSquared, -0.7, 0.03), (Bell::Gaussian, 0.8, 0.01)],
    ];
    let ghost = |(bell, along, size): (Bell, f64, f64)| LensGhost {
        bell,
        along,
        size: DVec2::splat(size),
        tint: [0.7, 0.8, 1.0],
        share: 1e-3,
    };
    sharp.into_iter().map(|sharp| two_ghosts().lens.into_iter().chain(sharp.into_iter().map(ghost)).collect()).collect()
}

#[test]
fn sharp_ghosts_of_every_pixel_are_within_the_bound_beside_smooth_ones() {
    on_backend(Backend::Egl, |renderer| {
        for (number, lens) in sharp_lenses().into_iter().enumerate() {
            let mut look = Look { lens, ..two_ghosts() };
            if number == 1 {
                let window = Window { x: -4, y: 3, width: 48, height: 27 };
                look.frame = Frame { pixel_aspect: 1.5, ..Frame::full(44, 30) }.with_window(window);
            }
            let (problem, pixels) = (look.problem(), every_pixel(look.frame));
            let truth = problem.truth(&pixels);
            for tolerance in [1e-2, 1e-3, 1e-4] {
                let plan = plan::plan(&problem, &Request::new(tolerance)).expect("a plan");
                assert!(plan.plate().is_some(), "{number} {tolerance}: no plate");
                assert!(plan.predicted.total() <= tolerance, "{number}: {:?}", plan.predicted);
                renderer.field.set_scene(&plan).expect("a scene");
                let field = renderer.field.probe(look.frame, &pixels).expect("a field");
                let measured = compare_in(&truth, &field, [1e-300; 3]).relative;
                assert!(measured <= plan.predicted.total(), "{number} {tolerance}: {measured:e}, {:?}", plan.predicted);
                for colour in 0..3 {
                    let largest = truth.iter().fold(0.0f64, |most, value| most.max(value[colour]));
                    let unit = plan.scale[colour];
                    assert!(unit <= largest * (1.0 + 1e-12) && largest <= 2.0 * unit, "{number}: {unit} {largest}");
                }
            }
        }
    });
}

#[test]
fn a_plate_is_asked_for_by_name_and_follows_the_frame() {
    let look = Look { lens: sharp_lenses().swap_remove(1), ..two_ghosts() };
    let problem = look.problem();
    let plan =
        plan::plan(&problem, &Request { evaluator: Some(Evaluator::Plate), ..Request::new(1e-3) }).expect("a plan");
    assert_eq!((plan.evaluator(), plan.layers().len()), (Evaluator::Plate, 1));
    // Another window, and a picture of other pixels.
    let other = Frame::full(31, 23);
    let window = Window { x: 6, y: 5, width: 20, height: 11 };
    on_backend(Backend::Egl, |renderer| {
        renderer.field.set_scene(&plan).expect("a scene");
        for frame in [look.frame.with_window(window), other, look.frame] {
            let pixels = every_pixel(frame);
            let truth = problem.on(frame).truth(&pixels);
            let field = renderer.field.probe(frame, &pixels).expect("a field");
            let measured = compare_in(&truth, &field, plan.scale).relative;
            assert!(measured <= 1e-3, "{frame:?}: {measured:e}");
        }
        let certificate = Certificate::measure_all(&mut renderer.field, &plan, |_| ()).expect("a certificate");
        assert!(certificate.measured <= certificate.predicted && certificate.measured > 0.0, "{certificate:?}");
    });
    for (request, words) in [
        (
            Request { evaluator: Some(Evaluator::Plate), degree: Some([4, 4]), ..Request::new(1e-3) },
            "neither a period nor a degree",
        ),
        (Request { evaluator: Some(Evaluator::Grid), ..Request::new(1e-3) }, "the plate sums"),
    ] {
        let refused = plan::plan(&problem, &request).expect_err("no such plan").to_string();
        assert!(refused.contains(words), "{refused}");
    }
    let lights = Problem::new(look.ghosts(), look.frame);
    let refused = plan::plan(&lights, &Request { evaluator: Some(Evaluator::Plate), ..Request::new(1e-3) });
    let refused = refused.expect_err("no plate of lights").to_string();
    assert!(refused.contains("a plate has the ghosts of all pixels"), "{refused}");
}

#[test]
fn a_photo_without_light_has_no_ghosts() {
    let look = Look { pixels: vec![[0.0, -1.0, f32::NAN, 1.0]; 48 * 27], ..two_ghosts() };
    let problem = look.problem();
    assert!(problem.is_dark() && problem.images().is_none());
    let plan = plan::plan(&problem, &Request::new(1e-3)).expect("a plan for nothing");
    assert_eq!(plan.ghosts(), 0);
}

#[test]
fn one_lamp_makes_what_one_light_makes() {
    let mut look = two_ghosts();
    look.pixels.fill([0.0, 0.0, 0.0, 1.0]);
    look.pixels[500] = [1e30, 2e30, 3e-30, 1.0];
    let (problem, pixels) = (look.problem(), every_pixel(look.frame));
    let ghosts: Vec<Ghost> = look.ghosts().into_iter().filter(|ghost| ghost.radiance != [0.0; 3]).collect();
    assert_eq!(ghosts.len(), 2);
    let truth = reference::direct_at(&ghosts, &positions(look.frame, &pixels));
    assert!(compare_in(&truth, &problem.truth(&pixels), [1e-300; 3]).relative < 1e-12);
    let plan = plan::plan(&problem, &Request::new(1e-3)).expect("a plan");
    on_backend(Backend::Egl, |renderer| {
        renderer.field.set_scene(&plan).expect("a spectrum");
        let field = renderer.field.probe(look.frame, &pixels).expect("a field");
        let measured = compare_in(&truth, &field, [1e-300; 3]).relative;
        assert!(measured <= plan.predicted.total() && measured <= 1e-3, "{measured:e}, {:?}", plan.predicted);
    });
}

/// What a photo becomes by a look's ghosts of every pixel, which take their light from it.
#[test]
fn what_ghosts_carry_is_missing_where_it_came_from() {
    missing_where_it_came_from(&two_ghosts());
    missing_where_it_came_from(&Look { lens: sharp_lenses().swap_remove(1), ..two_ghosts() });
}

fn missing_where_it_came_from(look: &Look) {
    let (frame, count) = (look.frame, look.frame.window.pixels());
    let share = [0, 1, 2].map(|c| look.lens.iter().map(|lens| lens.share * lens.tint[c]).sum::<f64>());
    for knee in [None, Some(Knee { threshold: 0.3, width: 0.1 })] {
        let find = FindOptions {
            threshold: knee.map(|knee| knee.threshold),
            knee: knee.map_or(0.0, |knee| knee.width),
            ..FindOptions::default()
        };
        let made = vglare::look::Look {
            lens: LookLens::Own(look.lens.clone().into()),
            lights: LookLights::Photo(Vec::new().into()),
            unit: LengthUnit::Height,
            veil: None,
            mix: Mix::Energy,
            find,
            ..vglare::look::Look::default()
        };
        let photo = Photo::new(frame.width, frame.height, look.pixels.clone());
        let done = on_device(Backend::Egl, |device| {
            let mut computer = Computer::new(device.clone(), Known::default());
            let found = Found::new(&made, photo, Stages::default()).expect("a look");
            let wanted = Wanted { picture: true, glare: true, ..Wanted::default() };
            let done = found.compute(Some(&mut computer), wanted, &Unwatched).expect("a picture");
            assert_eq!(done.warnings, Vec::<String>::new());
            (done.picture.expect("a picture").pixels, done.glare.expect("the glare").pixels)
        });
        for at in 0..count {
            let (before, after, glare) = (look.pixels[at], done.0[at], done.1[at]);
            let [r, g, b, _] = before;
            let shines = knee.unwrap_or(Knee::NONE).share(scene::brightest([r, g, b]).into());
            for colour in 0..3 {
                let light = f64::from(before[colour]);
                let lost = if light > 0.0 { shines * share[colour] * light } else { 0.0 };
                let expected = light - lost + f64::from(glare[colour]);
                let off = (f64::from(after[colour]) - expected).abs();
                assert!(off <= 4e-7 * (light.abs() + expected.abs()), "{knee:?}, {at}: {after:?} for {expected}");
            }
        }
    }
}

#[test]
fn what_is_below_a_knee_makes_no_ghosts() {
    let mut look = two_ghosts();
    let knee = Knee { threshold: 5.0, width: 1.0 };
    look.pixels = knee.shining(&look.pixels);
    let bright = look.problem().images().expect("a lamp").raster().flux();
    let all = two_ghosts().problem().images().expect("a photo").raster().flux();
    assert!((0..3).all(|colour| bright[colour] > 0.0 && bright[colour] < all[colour]), "{bright:?} {all:?}");
    let dark = Knee { threshold: 1e6, width: 0.0 };
    look.pixels = dark.shining(&look.pixels);
    assert!(look.problem().is_dark());
}
