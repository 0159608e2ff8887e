//! A certificate that looks at every pixel finds the worst one, whatever the tiles.

use vglare::certificate::{Certificate, Verify};
use vglare::compare::compare;
use vglare::frame::{Frame, Window};
use vglare::gpu::Backend;
use vglare::plan::{Evaluator, Request};
use vglare::reference::direct_at;

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
        renderer.set_scene(&coarse).unwrap();
        let worst = compare(&exact, &renderer.probe(frame, &pixels).unwrap());
        for tile in [1 << 20, 1000, 50] {
            renderer.set_tile_pixels(tile);
            let mut done = 0;
            let found = Certificate::measure_all(renderer, &coarse, |pixels| done += pixels).unwrap();
            assert_eq!((found.pixels, done, found.verify), (61 * 37, 61 * 37, Verify::Full));
            assert!((found.measured / worst.relative - 1.0).abs() < 1e-9, "{} {}", found.measured, worst.relative);
            assert_eq!(found.worst_pixel, pixels[worst.worst.0], "in tiles of {tile}");
            assert!(found.check().is_err());
        }
        let sound = Certificate::measure_all(renderer, &chosen, |_| ()).unwrap();
        assert!(sound.check().is_ok() && sound.measured <= sound.predicted, "{sound:?}");
        let sample = Certificate::measure(renderer, &chosen).unwrap();
        // A sample may miss the field's largest value, the unit of the error, by a little.
        assert!(sample.measured <= 1.02 * sound.measured && sample.verify == Verify::Sample, "{sample:?} {sound:?}");
    });
}
