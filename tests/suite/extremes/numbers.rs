//! Numbers that are none, and those that f32 has no room for: each is refused, and the ghost is named.

use glam::DVec2;
use vglare::frame::Frame;
use vglare::plan::Request;
use vglare::scene::Ghost;

use crate::support::{plan, scenes};

const FRAME: Frame = Frame::full(16, 9);

#[track_caller]
fn refused(ghost: Ghost, says: &str) {
    let plain = scenes::one([0.0, 0.0], 0.5, [1.0; 3]);
    let error = plan(&[plain.clone(), ghost, plain], FRAME, &Request::new(1e-2)).unwrap_err().to_string();
    assert!(error.contains("ghost 2 has") && error.contains(says), "{error}");
}

#[test]
fn sizes_that_are_none() {
    let plain = scenes::one([0.0, 0.0], 0.5, [1.0; 3]);
    for size in [0.0, -0.5, 1e-39, f64::MIN_POSITIVE, 5e-324, 1e39, f64::INFINITY, f64::NAN] {
        refused(Ghost { size: DVec2::new(size, 0.5), ..plain.clone() }, "sizes of");
        refused(Ghost { size: DVec2::new(0.5, size), ..plain.clone() }, "sizes of");
    }
}

#[test]
fn centres_and_radiances_that_are_none() {
    let plain = scenes::one([0.0, 0.0], 0.5, [1.0; 3]);
    for place in [1e39, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        refused(Ghost { center: DVec2::new(place, 0.0), ..plain.clone() }, "centre");
        refused(Ghost { center: DVec2::new(0.0, place), ..plain.clone() }, "centre");
    }
    for radiance in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for colour in 0..3 {
            let mut ghost = plain.clone();
            ghost.radiance[colour] = radiance;
            refused(ghost, "radiance");
        }
    }
}

#[test]
fn periods_that_are_none() {
    let ghosts = [scenes::one([0.0, 0.0], 0.5, [1.0; 3])];
    for period in [0.0, -3.0, f64::NAN, f64::INFINITY] {
        let request = Request { period: Some(DVec2::new(4.0, period)), ..Request::new(1e-2) };
        let error = plan(&ghosts, FRAME, &request).unwrap_err().to_string();
        assert!(error.contains("period"), "{error}");
    }
}
