//! A certificate that looks at every pixel finds the worst one, whatever the tiles.

use vglare::certificate::{Certificate, Verify};
use vglare::compare::compare;
use vglare::frame::{Frame, Window};
use vglare::gpu::Backend;
use vglare::plan::{Evaluator, Plan, Request};
use vglare::reference::direct_at;
use vglare::series::Bell;

use crate::support::{on_backend, plan, scenes};

#[test]
fn every_pixel_is_looked_at_and_the_worst_is_named() {
    let frame = Frame::full(90, 60).with_window(Window { x: -7, y: 11, width: 61, height: 37 });
    let ghosts = scenes::sized(5, 12, frame, 0.2, 1.0);
    let chosen = plan(&ghosts, frame, &Request::new(1e-3)).unwrap();
    // Too few modes, so that there is an error to find.
    let by_hand = Request { degree: Some([3; 2]), evaluator: Some(Evaluator::Rows), ..Request::new(1e-3) };
    let coarse = plan(&ghosts, frame, &by_hand).unwrap();
    let pixels = scenes::every_pixel(frame);
    let exact = direct_at(&ghosts, &scenes::positions(frame, &pixels));
    on_backend(Backend::OsMesa, |renderer| {
        renderer.field.set_scene(&coarse).unwrap();
        let worst = compare(&exact, &renderer.field.probe(frame, &pixels).unwrap());
        for tile in [1 << 20, 1000, 50] {
            renderer.field.set_tile_pixels(tile);
            let mut done = 0;
            let found = Certificate::measure_all(&mut renderer.field, &coarse, |pixels| done += pixels).unwrap();
            assert_eq!((found.pixels, done, found.verify), (61 * 37, 61 * 37, Verify::Full));
            assert!((found.measured / worst.relative - 1.0).abs() < 1e-9, "{} {}", found.measured, worst.relative);
            assert_eq!(found.worst_pixel, pixels[worst.worst.0], "in tiles of {tile}");
            assert!(found.check().is_err());
        }
        let sound = Certificate::measure_all(&mut renderer.field, &chosen, |_| ()).unwrap();
        assert!(sound.check().is_ok() && sound.measured <= sound.predicted, "{sound:?}");
        let sample = Certificate::measure(&mut renderer.field, &chosen).unwrap();
        // A sample may miss the field's largest value, the unit of the error, by a little.
        assert!(sample.measured <= 1.02 * sound.measured && sample.verify == Verify::Sample, "{sample:?} {sound:?}");
    });
}

/// Scenes of all bells, of sizes from a pixel on: a sample finds the order of what every pixel would.
#[test]
fn a_sample_is_low_by_no_more_than_two_in_nearly_all_scenes() {
    let frame = Frame::full(80, 45);
    let mut chance = scenes::Chance::new(20);
    let mut plans = Vec::new();
    while plans.len() < 24 {
        // Series of bells that are sharp or tabulated take their time to plan.
        let direct = plans.len() < 16;
        let bells = &Bell::examples()[..if direct { 6 } else { 2 }];
        let mut pick = || bells[chance.up_to(bells.len() as u32 - 1) as usize].clone();
        let kinds = [pick(), pick()];
        let count = 1 + chance.up_to(8) as usize;
        let ghosts: Vec<_> = (0..count).map(|k| scenes::of(&mut chance, kinds[k % 2].clone(), frame)).collect();
        let evaluator = Some(if direct { Evaluator::Direct } else { Evaluator::ALL[2 + plans.len() % 2] });
        let tolerance = 10f64.powi(-1 - chance.up_to(if direct { 4 } else { 1 }) as i32);
        // Series of what is small are refused.
        plans.extend(plan(&ghosts, frame, &Request { evaluator, ..Request::new(tolerance) }));
    }
    let low = on_backend(Backend::OsMesa, |renderer| {
        let low = |plan: &&Plan| {
            let whole = Certificate::measure_all(&mut renderer.field, plan, |_| ()).unwrap().measured;
            Certificate::measure(&mut renderer.field, plan).unwrap().measured < 0.5 * whole
        };
        plans.iter().filter(low).count()
    });
    assert!(low <= 1, "low by more than two in {low} of {}", plans.len());
}
