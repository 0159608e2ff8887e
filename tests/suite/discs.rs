//! Discs, round and with blades: what they are by another formula, and every evaluator as exact as it promises.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use vglare::certificate::Certificate;
use vglare::frame::Frame;
use vglare::plan::{Evaluator, Layer, Plan, Precision, Request};
use vglare::reference;
use vglare::renderer::Settings;
use vglare::scene::Ghost;
use vglare::series::{Bell, Disc};

use crate::support::scenes::Chance;
use crate::support::{bits, on_each_backend, on_one_backend, plan, scenes};

const FRAME: Frame = Frame::full(96, 54);

fn disc(rim: f64, blades: u32, rotation: f64) -> Bell {
    Bell::Disc(Disc::new(rim, blades, rotation).unwrap())
}

/// By the angle: the smoothstep of the radius of the polygon that a point lies on.
fn by_angle(rim: f64, blades: u32, rotation: f64, at: DVec2) -> f64 {
    let radius = if blades == 0 {
        at.length()
    } else {
        let sector = TAU / f64::from(blades);
        let angle = (at.y.atan2(at.x) - rotation.to_radians()).rem_euclid(sector) - 0.5 * sector;
        at.length() * angle.cos() / (PI / f64::from(blades)).cos()
    };
    let t = (0.5 + (radius - 1.0) / rim).clamp(0.0, 1.0);
    1.0 - t * t * (3.0 - 2.0 * t)
}

/// Any disc: hard ones, soft ones, and those with blades.
fn any(chance: &mut Chance) -> (f64, u32, f64) {
    let rim = match chance.up_to(3) {
        0 => 0.0,
        1 => 2.0,
        _ => chance.octaves(1e-3, 2.0),
    };
    let blades = [0, 3, 5, 6, 7, 8, 11, 16][chance.up_to(7) as usize];
    (rim, blades, if blades == 0 { 0.0 } else { chance.between(-400.0, 400.0) })
}

/// Ghosts of one disc or another, of sizes from a pixel to the picture, some of them stretched.
fn scattered(chance: &mut Chance, count: usize, kinds: usize, frame: Frame) -> Vec<Ghost> {
    let bells: Vec<Bell> = (0..kinds).map(|_| any(chance)).map(|(rim, blades, turn)| disc(rim, blades, turn)).collect();
    let pixel = frame.pixel_size();
    let half = 1.2 * DVec2::new(frame.half_width(), 1.0);
    let mut ghost = |k: usize| {
        let size = chance.octaves(0.8 * pixel, 0.7);
        let stretch = if chance.up_to(2) == 0 { chance.octaves(0.3, 3.0) } else { 1.0 };
        Ghost {
            bell: bells[k % kinds].clone(),
            center: DVec2::new(chance.between(-half.x, half.x), chance.between(-half.y, half.y)),
            size: DVec2::new(size * stretch, size / stretch),
            radiance: [(); 3].map(|()| chance.octaves(0.05, 1.0)),
        }
    };
    (0..count).map(&mut ghost).collect()
}

/// Holds the plans' fields against the definition at every pixel.
fn hold(plans: &[(String, Plan)]) {
    on_one_backend(|_, renderer| {
        for (name, plan) in plans {
            let found = Certificate::measure_all(&mut renderer.field, plan, |_| ()).unwrap();
            let (measured, predicted) = (found.measured, found.predicted);
            println!("{name}: {:?}, {measured:.1e} measured, {predicted:.1e} predicted", plan.precision);
            assert!(measured <= predicted && predicted <= plan.tolerance, "{name}: {found:?}, {:?}", plan.predicted);
            assert_eq!(found.not_finite, 0);
        }
    });
}

#[test]
fn a_disc_is_the_smoothstep_of_its_polygons_radius() {
    let mut chance = Chance::new(3);
    for _ in 0..4000 {
        let (rim, blades, rotation) = any(&mut chance);
        let rim = if rim == 0.0 { 1e-6 } else { rim };
        let size = DVec2::new(chance.octaves(1e-3, 1e3), chance.octaves(1e-3, 1e3));
        let at = DVec2::new(chance.between(-2.2, 2.2), chance.between(-2.2, 2.2));
        let ghost = Ghost { bell: disc(rim, blades, rotation), center: DVec2::ZERO, size, radiance: [1.0, 0.0, -2.0] };
        let [red, green, blue] = reference::direct(&[ghost], at * size);
        let expected = by_angle(rim, blades, rotation, at);
        // An angle of some hundred degrees is off by some 1e-14, and the steepest rim has a slope of 3e6.
        assert!((red - expected).abs() < 1e-13 / rim, "{rim} {blades} {rotation} at {at}: {red} {expected}");
        assert!(green == 0.0 && blue == -2.0 * red);
    }
}

#[test]
fn what_makes_no_disc_is_refused() {
    for (rim, blades, rotation) in [
        (-0.1, 0, 0.0),
        (2.01, 0, 0.0),
        (f64::NAN, 0, 0.0),
        (1e-9, 0, 0.0),
        (0.1, 2, 0.0),
        (0.1, 17, 0.0),
        (0.1, 0, 1.0),
    ] {
        assert!(Disc::new(rim, blades, rotation).is_err(), "{rim} {blades} {rotation}");
    }
    assert!(Disc::new(0.1, 6, f64::INFINITY).is_err());
    assert!(Disc::new(1e-6, 16, -1e30).is_ok());
}

#[test]
fn discs_by_chance_are_as_exact_as_promised() {
    let mut chance = Chance::new(14);
    let mut plans = Vec::new();
    let choices = [Some(Evaluator::Direct), Some(Evaluator::Local), None];
    for round in 0..36 {
        let (count, kinds) = (chance.octaves(1.0, 60.0) as usize, 1 + chance.up_to(3) as usize);
        let ghosts = scattered(&mut chance, count, kinds, FRAME);
        let tolerance = chance.octaves(3e-7, 1e-1);
        let request = Request { evaluator: choices[round % 3], ..Request::new(tolerance) };
        let plan = plan(&ghosts, FRAME, &request).unwrap_or_else(|error| panic!("{ghosts:?}: {error}"));
        plans.push((format!("{count} of {kinds} kinds at {tolerance:.1e}, {:?}", request.evaluator), plan));
    }
    let singles = plans.iter().filter(|(_, plan)| plan.precision == Precision::Single).count();
    assert!(singles > 8 && singles < 32, "{singles}");
    hold(&plans);
}

#[test]
fn a_hard_rim_on_pixels_is_part_of_the_disc_and_decided_in_64_bits() {
    // 25 is 7, 24 and 15, 20; a square's corners lie on its sides' pixels.
    let (center, pixel) = (FRAME.position(48.0, 27.0), FRAME.pixel_size());
    let one = |blades, rotation, pixels: f64| Ghost {
        bell: disc(0.0, blades, rotation),
        center,
        size: DVec2::splat(pixels * pixel),
        radiance: [1.0, 0.5, 0.2],
    };
    let scenes = [("round", one(0, 0.0, 25.0)), ("a square", one(4, 0.0, 20.0)), ("six", one(6, 90.0, 24.0))];
    let plans: Vec<_> = scenes
        .iter()
        .flat_map(|(name, ghost)| {
            [Evaluator::Direct, Evaluator::Local].map(|evaluator| {
                let request = Request { evaluator: Some(evaluator), ..Request::new(1e-3) };
                (format!("{name} by {evaluator}"), plan(std::slice::from_ref(ghost), FRAME, &request).unwrap())
            })
        })
        .collect();
    assert!(plans.iter().all(|(_, plan)| plan.precision == Precision::Double || plan.local().is_some()));
    hold(&plans);
    // The rim itself, where no rounding is in the way.
    let at = |x: f64| {
        let ghost = Ghost { bell: disc(0.0, 0, 0.0), ..scenes::one([0.25, 0.0], 0.5, [1.0; 3]) };
        reference::direct(&[ghost], DVec2::new(x, 0.0))[0]
    };
    assert_eq!((at(0.75), at(0.75f64.next_up())), (1.0, 0.0));
}

#[test]
fn blades_have_no_series_and_stand_beside_that_of_others() {
    let frame = Frame::full(480, 270);
    let mut ghosts = scenes::sized(3, 200, frame, 0.5, 0.6);
    let blades = disc(0.1, 6, 10.0);
    ghosts.extend(
        scenes::sized(4, 20, frame, 0.05, 0.1).into_iter().map(|ghost| Ghost { bell: blades.clone(), ..ghost }),
    );
    let whole = plan(&ghosts, frame, &Request::new(1e-3)).unwrap();
    let (series, local) = (whole.series().expect("the wide ones"), whole.local().expect("the discs"));
    assert!(series.groups.iter().all(|group| group.bell == Bell::Gaussian));
    assert_eq!(local.groups.iter().map(|group| group.ghosts).sum::<usize>() + whole.dropped, 20);
    assert!(whole.layers().iter().all(|layer| !matches!(layer, Layer::Direct(_))));
    let found = on_one_backend(|_, renderer| Certificate::measure(&mut renderer.field, &whole).unwrap());
    assert!(found.measured <= found.predicted && found.predicted <= 1e-3, "{found:?}");
    for evaluator in Evaluator::ALL.into_iter().filter(|evaluator| evaluator.is_series()) {
        let asked = [
            Request { evaluator: Some(evaluator), ..Request::new(1e-3) },
            Request { evaluator: Some(evaluator), degree: Some([9, 9]), ..Request::new(1e-3) },
            Request {
                evaluator: Some(evaluator),
                degree: Some([9, 9]),
                period: Some(DVec2::splat(9.0)),
                ..Request::new(1e-3)
            },
        ];
        for request in asked {
            let refused = plan(&ghosts, frame, &request).unwrap_err().to_string();
            assert!(refused.contains("a disc with blades has no series"), "{refused}");
        }
    }
}

#[test]
fn tiles_and_backends_have_the_same_bits() {
    let ghosts = scattered(&mut Chance::new(5), 60, 4, FRAME);
    let planned = |evaluator, tolerance| {
        plan(&ghosts, FRAME, &Request { evaluator: Some(evaluator), ..Request::new(tolerance) }).unwrap()
    };
    let plans = [planned(Evaluator::Local, 0.5), planned(Evaluator::Local, 1e-6), planned(Evaluator::Direct, 1e-6)];
    let fields = on_each_backend(|_, renderer| {
        plans.each_ref().map(|plan| {
            let mut field = |tile_pixels| {
                renderer.field.set_tile_pixels(tile_pixels);
                renderer.field.forget_scene();
                renderer.field.set_scene(plan).unwrap();
                bits(&renderer.glare(FRAME, &Settings::default()).unwrap())
            };
            let whole = field(4 << 20);
            for tile_pixels in [7, 1000] {
                assert!(field(tile_pixels) == whole, "tiles of {tile_pixels}");
            }
            renderer.field.set_tile_pixels(4 << 20);
            whole
        })
    });
    assert!(fields[0] == fields[1], "both backends");
}
