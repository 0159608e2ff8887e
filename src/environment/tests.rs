use super::*;
use crate::motion::Camera;
use crate::photo::Photo;
use crate::psf::{Observer, Psf};

fn panorama(height: u32, light: impl Fn(f64, f64) -> [f32; 3]) -> Panorama {
    let (w, h) = (2 * height as usize, height as usize);
    let of = |at: usize| {
        let right = ((at % w) as f64 + 0.5) / w as f64 * 360.0 - 180.0;
        let up = 90.0 - ((at / w) as f64 + 0.5) / h as f64 * 180.0;
        let [r, g, b] = light(right, up);
        [r, g, b, 1.0]
    };
    Panorama::new(Photo::new(2 * height, height, (0..w * h).map(of).collect())).unwrap()
}

/// A sky over a ground, windows, and a sun.
fn place(right: f64, up: f64) -> [f32; 3] {
    let sun = (right - 50.0).hypot(up - 30.0) < 1.0;
    let window = (right.rem_euclid(40.0) - 20.0).abs() < 4.0 && (up - 10.0).abs() < 5.0;
    match (sun, window, up > 0.0) {
        (true, ..) => [3e4, 2.7e4, 2e4],
        (_, true, _) => [20.0, 12.0, 5.0],
        (_, _, true) => [0.3, 0.5, 1.0],
        _ => [0.2, 0.15, 0.1],
    }
}

fn cie() -> Psf {
    Psf::cie(Observer::new(25.0, 0.5).unwrap())
}

fn camera(yaw: f64, pitch: f64, roll: f64) -> Camera {
    Camera { yaw, pitch, roll, fov: None }
}

fn sight(camera: &Camera, fov: f64, sides: [u32; 2], rows: u32, hood: f64) -> Sight {
    Sight::new(camera, fov, sides, band(fov, sides, rows), hood)
}

fn veil(environment: &Environment, camera: &Camera, fov: f64, sides: [u32; 2], hood: f64) -> Field {
    let sight = sight(camera, fov, sides, environment.panorama().photo().height(), hood);
    let plan = Arc::new(StrayPlan::new(&cie(), 1e-2, &sight));
    environment.outside(sight, Some(plan)).veil().expect("it is planned")
}

#[test]
fn a_field_is_the_sum_over_all_pixels_outside() {
    let environment = Environment::new(panorama(256, place), &FindOptions::default());
    let views = [
        (camera(0.0, 0.0, 0.0), 60.0, 80.0),
        (camera(50.0, 30.0, 20.0), 40.0, 45.0),
        // The sun just beyond the band, and a pole in the picture.
        (camera(12.0, 30.0, 0.0), 60.0, 80.0),
        (camera(-170.0, -70.0, 0.0), 90.0, 90.0),
    ];
    for tolerance in [1e-2, 1e-1] {
        for (camera, fov, hood) in views {
            let sight = sight(&camera, fov, [96, 54], 256, hood);
            let plan = Arc::new(StrayPlan::new(&cie(), tolerance, &sight));
            let outside = environment.outside(sight, Some(plan));
            let error = outside.measured(&outside.veil().unwrap());
            assert!(error.measured <= error.predicted, "{camera:?}: {error:?}");
            // The panorama's own pixels, coarse beside these views, are the finest cells.
            assert!(error.predicted <= 2.0 * tolerance, "{camera:?}: {error:?}");
        }
    }
}

/// Zones share out what is outside: with them and without there is as much light.
#[test]
fn nothing_is_lost_between_zones() {
    let environment = Environment::new(panorama(256, place), &FindOptions::default());
    let sight = sight(&camera(20.0, 15.0, 0.0), 60.0, [96, 54], 256, 80.0);
    let plan = Arc::new(StrayPlan::new(&cie(), 1e-2, &sight));
    let zones = environment.outside(sight, Some(plan)).flux();
    let whole = environment.outside(sight, None).flux();
    for (zones, whole) in zones.iter().zip(whole) {
        assert!(whole > 0.0 && (zones / whole - 1.0).abs() < 1e-3, "{zones} {whole}");
    }
}

/// A sun that crosses from one zone into the next is one sun, wherever on the way it is.
#[test]
fn a_sun_between_zones_shines_once() {
    // So fine that cells of several pixels are shared.
    let sun = |right: f64, up: f64| if right.hypot(up - 3.0) < 0.8 { [1e5; 3] } else { [1e-3; 3] };
    let environment = Environment::new(panorama(512, sun), &FindOptions::default());
    let plan = Arc::new(StrayPlan::new(&cie(), 1e-2, &sight(&camera(0.0, 0.0, 0.0), 60.0, [96, 54], 512, 80.0)));
    for step in 0..60 {
        let sight = sight(&camera(-60.0 + 0.5 * f64::from(step), 0.0, 0.0), 60.0, [96, 54], 512, 80.0);
        let zones = environment.outside(sight, Some(plan.clone())).flux()[0];
        let whole = environment.outside(sight, None).flux()[0];
        assert!((zones / whole - 1.0).abs() < 1e-3, "{step}: {zones} {whole}");
    }
}

/// An even place is as bright from every side: what the frame, its band and all beyond scatter is what the function scatters.
#[test]
fn an_even_place_scatters_evenly_whichever_way_the_camera_looks() {
    let environment = Environment::new(panorama(128, |_, _| [1.0, 2.0, 0.0]), &FindOptions::default());
    let means = [camera(0.0, 0.0, 0.0), camera(77.0, 50.0, 30.0), camera(-10.0, -90.0, 0.0)]
        .map(|camera| veil(&environment, &camera, 60.0, [48, 27], 80.0).mean());
    for mean in means {
        assert!((mean[0] / means[0][0] - 1.0).abs() < 2e-3 && (mean[1] / mean[0] - 2.0).abs() < 1e-4, "{means:?}");
        assert_eq!(mean[2], 0.0);
    }
}

/// Past the band, and into it: what the band's pixels scatter and what is outside together change as the sun's own way does.
#[test]
fn light_changes_smoothly_as_a_sun_comes_into_the_frame() {
    let sun = |right: f64, up: f64| if right.hypot(up) < 1.5 { [1e4; 3] } else { [0.0; 3] };
    let environment = Environment::new(panorama(256, sun), &FindOptions::default());
    let sides = [96, 54];
    let fluxes: Vec<f64> = (0..=60)
        .map(|step| {
            let camera = camera(-60.0 + f64::from(step), 0.0, 0.0);
            let sight = sight(&camera, 60.0, sides, 256, 90.0);
            let outside = environment.outside(sight, None).flux()[0];
            let band = band(60.0, sides, 256);
            let view = environment.panorama().view(&camera, 60.0, sides, band);
            let columns = sides[0] + 2 * band[0];
            let focal = sight.focal();
            let inside: f64 = (0..view.pixels.len())
                .map(|at| {
                    let x = (at as u32 % columns) as f64 + 0.5 - 0.5 * f64::from(columns);
                    let y = (at as u32 / columns) as f64 + 0.5 - 0.5 * f64::from(sides[1] + 2 * band[1]);
                    let square = 1.0 + (x * x + y * y) / (focal * focal);
                    f64::from(view.pixels[at][0]) * square.powf(-1.5) / (focal * focal)
                })
                .sum();
            outside + inside
        })
        .collect();
    let [low, high] = fluxes.iter().fold([f64::MAX, 0.0], |[low, high], &flux| [low.min(flux), flux.max(high)]);
    // While the band's edge passes over it, which the view's filter makes softer.
    assert!(high / low < 1.08, "{low} to {high}: {fluxes:?}");
    let far = fluxes.iter().filter(|flux| (**flux / fluxes[60] - 1.0).abs() < 2e-3).count();
    assert!(far >= 57, "{far}: {fluxes:?}");
}

#[test]
fn lights_beside_the_picture_are_where_they_are_seen() {
    let environment = Environment::new(panorama(256, place), &FindOptions::default());
    let camera = camera(0.0, 30.0, 0.0);
    let sight = sight(&camera, 60.0, [96, 54], 256, 80.0);
    let frame = Frame::full(96, 54);
    let lights = environment.outside(sight, None).lights(&frame);
    let brightest =
        lights.iter().max_by(|a, b| a.flux[0].total_cmp(&b.flux[0])).expect("the sun is beside the picture");
    // By the direction of the sun, on a plane at the focal length in half heights.
    let focal = 48.0 / 30f64.to_radians().tan() / 27.0;
    let ((sin, cos), (sin_up, cos_up)) = (50f64.to_radians().sin_cos(), 30f64.to_radians().sin_cos());
    let seen = sight.seen(glam::DVec3::new(cos_up * cos, -cos_up * sin, sin_up));
    let expected = focal / seen.z * seen.truncate();
    assert!((brightest.position - expected).length() < 0.02, "{brightest:?} for {expected}");
    let photo = environment.panorama().photo();
    let grid = crate::series::sphere::Grid { width: 512, height: 256 };
    let sun = photo.pixels.iter().enumerate().filter(|(_, pixel)| pixel[0] > 1e3);
    let whole: f64 = sun.map(|(at, pixel)| f64::from(pixel[0]) * grid.solid_angle(at / 512)).sum();
    let area = (focal * focal) / seen.z.powi(3) * (seen.z / sight.corner()).min(1.0).powi(4);
    assert!((brightest.flux[0] / (whole * area) - 1.0).abs() < 0.03, "{brightest:?} {}", whole * area);
    // What is behind the camera, and what is in the picture, is none.
    let sun_ahead = self::sight(&self::camera(50.0, 30.0, 0.0), 60.0, [96, 54], 256, 80.0);
    let brightest =
        environment.outside(sun_ahead, None).lights(&frame).iter().map(|light| light.flux[0]).fold(0.0, f64::max);
    assert!(brightest < 1e-2 * whole * area, "{brightest}");
}
