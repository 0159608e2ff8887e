//! Light from outside the frame, and panoramas themselves.

use vglare::photo::{self, Photo};

use super::Workplace;

const WIDTH: usize = 256;
const HEIGHT: usize = 128;

/// A dim place with a sun at yaw 0, 20° up.
fn place() -> Workplace {
    let place = Workplace::new();
    let pixel = |at: usize| {
        let right = ((at % WIDTH) as f64 + 0.5) / WIDTH as f64 * 360.0 - 180.0;
        let up = 90.0 - ((at / WIDTH) as f64 + 0.5) / HEIGHT as f64 * 180.0;
        let sky = if up > 0.0 { 0.05 } else { 0.02 };
        let sun = if right.hypot(up - 20.0) < 2.0 { 5e3 } else { 0.0 };
        [(sky + sun) as f32, sky as f32, 0.5 * sky as f32, 1.0]
    };
    place.write("all.exr", &Photo::new(WIDTH as u32, HEIGHT as u32, (0..WIDTH * HEIGHT).map(pixel).collect()));
    place
}

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

fn mean(photo: &Photo) -> f64 {
    let sum: f64 = photo.pixels.iter().map(|pixel| f64::from(pixel[0])).sum();
    sum / photo.pixels.len() as f64
}

#[test]
fn the_surroundings_of_a_photo_scatter_light_over_it() {
    let place = place();
    // What a camera sees, by itself and amid the rest; and the same as a photo of its own.
    let camera = "--environment all.exr --view 50,10,0 --fov 60 --lens none --veil cie --report report.json --force";
    let line = format!("apply {camera} --frame 64x36 -o out.exr --glare glare.exr");
    let said = place.vglare(&words(&line)).succeeded().stdout();
    assert!(said.contains("outside") && said.contains("of the mean glare"), "{said}");
    let report = place.read_json("report.json");
    let told = &report["surroundings"];
    let error = |key: &str| told["error"][key].as_f64().unwrap();
    assert!(error("measured") <= error("predicted") && error("measured") <= error("asked"), "{told}");
    assert!(told["flux"][0].as_f64().unwrap() > 10.0 && told["share"].as_f64().unwrap() > 0.5, "{told}");
    assert_eq!((&told["view"][0], &told["fov"]), (&50.0.into(), &60.0.into()));
    assert_eq!(report["input"]["window"], serde_json::json!([0, 0, 64, 36]));
    let seen = photo::read(&place.path("out.exr")).unwrap();
    let glare = photo::read(&place.path("glare.exr")).unwrap();
    assert!(seen.frame.is_whole() && seen.width() == 64);
    // Brighter towards the sun, which is to the left.
    let column = |x: usize| (0..36).map(|y| f64::from(glare.pixels[64 * y + x][0])).sum::<f64>();
    assert!(column(0) > 2.0 * column(63), "{} {}", column(0), column(63));

    let line = "animate --path path.csv --panorama all.exr --frame 64x36 --lens none --veil cie -o o.####.exr --force";
    place.text("path.csv", "frame,yaw,pitch,fov\n1,50,10,60\n");
    place.vglare(&words(line)).succeeded();
    assert_eq!(photo::read(&place.path("o.0001.exr")).unwrap().pixels, seen.pixels);

    let dark = format!("{line} --surroundings dark");
    place.vglare(&words(&dark)).succeeded();
    assert!(mean(&photo::read(&place.path("o.0001.exr")).unwrap()) < mean(&seen));

    // A photo in its surroundings: black, so that all there is comes from outside.
    place.write("black.exr", &Photo::new(64, 36, vec![[0.0, 0.0, 0.0, 1.0]; 64 * 36]));
    place.vglare(&words(&format!("apply black.exr {camera} -o black.out.exr"))).succeeded();
    let lit = photo::read(&place.path("black.out.exr")).unwrap();
    assert!(lit.pixels.iter().all(|pixel| pixel[0] > 0.0) && mean(&lit) <= mean(&glare));

    // A hood takes some of it away, and what walls spread evenly adds some.
    place.vglare(&words(&format!("apply black.exr {camera} -o hood.exr --hood 35"))).succeeded();
    assert!(mean(&photo::read(&place.path("hood.exr")).unwrap()) < 0.9 * mean(&lit));
    place.vglare(&words(&format!("apply black.exr {camera} -o stray.exr --stray 0.01"))).succeeded();
    let even = place.read_json("report.json")["surroundings"]["even"][0].as_f64().unwrap();
    let more = mean(&photo::read(&place.path("stray.exr")).unwrap()) - mean(&lit);
    assert!(even > 0.0 && (more / even - 1.0).abs() < 1e-3, "{more} {even}");
}

#[test]
fn nothing_jumps_as_a_camera_turns_past_the_sun() {
    let place = place();
    place.text("path.csv", "frame,yaw,pitch\n1,-70,15\n36,70,15\n");
    let line = "animate --path path.csv --panorama all.exr --frame 64x36 --fov 50 --lens none --veil cie --glare g.####.exr --report r.json";
    place.vglare(&words(line)).succeeded();
    // As the sun's own way has it: the sum of its glare over all pixels that it is not in.
    let expected = |yaw: f64| {
        let direction = |right: f64, up: f64| {
            let ((sin, cos), (sin_up, cos_up)) = (right.to_radians().sin_cos(), up.to_radians().sin_cos());
            [cos_up * cos, cos_up * sin, sin_up]
        };
        let (focal, pitch) = (32.0 / 25f64.to_radians().tan(), 15f64.to_radians());
        let mut sum = 0.0;
        for at in 0..64 * 36 {
            let [x, y] = [f64::from(at % 64) - 31.5, 17.5 - f64::from(at / 64)];
            let (ahead, up) = (focal * pitch.cos() - y * pitch.sin(), focal * pitch.sin() + y * pitch.cos());
            let (length, (sin, cos)) = ((ahead * ahead + x * x + up * up).sqrt(), yaw.to_radians().sin_cos());
            let pixel = [(ahead * cos - x * sin) / length, (ahead * sin + x * cos) / length, up / length];
            for k in 0..25 {
                let [right, up] = [k % 5, k / 5].map(|k| 0.9 * (f64::from(k) - 2.0));
                let sun = direction(right, 20.0 + up);
                let cosine: f64 = (0..3).map(|axis| sun[axis] * pixel[axis]).sum();
                let angle = cosine.min(1.0).acos().to_degrees();
                if right.hypot(up) < 2.1 && angle > 0.5 {
                    sum += 10.0 / angle.powi(3) + 5.0 / angle.powi(2) + 0.05 / angle + 0.00125;
                }
            }
        }
        sum
    };
    let ratios: Vec<f64> = (1..=36)
        .map(|k| {
            let glare = mean(&photo::read(&place.path(&format!("g.{k:04}.exr"))).unwrap());
            glare / expected(-70.0 + 4.0 * f64::from(k - 1))
        })
        .collect();
    for (k, pair) in ratios.windows(2).enumerate() {
        assert!((pair[1] / pair[0]).ln().abs() < 0.2, "{k}: {ratios:?}");
    }
}

#[test]
fn a_sun_beside_the_picture_makes_ghosts() {
    let place = place();
    place.text("mirror.toml", "[[lens_ghost]]\nalong = -0.3\nsize = 0.2\nshare = 0.02\n");
    let line = "apply --environment all.exr --view 45,20,0 --fov 60 --frame 64x36 --lens mirror.toml --sources lights --glare g.exr --report r.json";
    place.vglare(&words(line)).succeeded();
    assert_eq!(place.read_json("r.json")["surroundings"]["lights"], 1);
    let glare = photo::read(&place.path("g.exr")).unwrap();
    let half = |right: bool| -> f64 {
        (0..64 * 36).filter(|at| (at % 64 >= 32) == right).map(|at| f64::from(glare.pixels[at][0])).sum()
    };
    // The sun is 45° to the left, its ghost on the right.
    assert!(half(true) > 10.0 * half(false).max(1e-9), "{} {}", half(true), half(false));
}

#[test]
fn surroundings_that_cannot_be_are_refused() {
    let place = place();
    place.write("square.exr", &Photo::new(64, 64, vec![[1.0; 4]; 64 * 64]));
    let mut bad = Photo::new(64, 32, vec![[1.0; 4]; 64 * 32]);
    bad.pixels[64 * 3 + 7][1] = f32::NAN;
    place.write("nan.exr", &bad);
    place.write("photo.exr", &Photo::new(64, 36, vec![[1.0; 4]; 64 * 36]));
    place.text("path.csv", "frame,yaw\n1,0\n");
    place.text("lights.csv", "frame,x,y\n1,0,0\n");
    let before = place.files();
    let veil = "--veil cie --lens none -o out.exr";
    for (code, line, said) in [
        (1, format!("apply --environment square.exr {veil}"), &["square.exr", "twice as wide as high"][..]),
        (1, format!("apply --environment nan.exr {veil}"), &["nan.exr", "NaN", "column 7, row 3"]),
        (1, format!("apply --environment none.exr {veil}"), &["none.exr"]),
        (2, format!("apply photo.exr --view 0,0,0 --fov 50 {veil}"), &["--environment"]),
        (2, format!("apply photo.exr --hood 40 --fov 50 {veil}"), &["--hood", "--environment"]),
        (2, format!("apply photo.exr --environment all.exr {veil}"), &["--fov"]),
        (2, format!("apply photo.exr --environment all.exr --fov 180 {veil}"), &["--fov", "179"]),
        (2, format!("apply --environment all.exr --fov 180 {veil}"), &["--fov", "179"]),
        (2, format!("apply photo.exr --environment all.exr --fov 50 --frame 64x64 {veil}"), &["--frame"]),
        (2, format!("apply --environment all.exr --view 1,2 {veil}"), &["--view", "three angles"]),
        (2, format!("apply --environment all.exr --hood 100 {veil}"), &["--hood", "from 1 to 90"]),
        (2, format!("apply --environment all.exr --stray 2 {veil}"), &["--stray", "from 0 to 1"]),
        (2, format!("apply --environment all.exr --projection fisheye --fov 90 {veil}"), &["rectilinear"]),
        (2, "apply photo.exr square.exr --environment all.exr --fov 50 -o out/".into(), &["one photo"]),
        (2, "apply --environment all.exr --veil cie -o all.exr --force".into(), &["would replace all.exr"]),
        (2, "animate --path lights.csv --frame 64x36 --hood 40 -o o.####.exr".into(), &["--hood"]),
        (
            2,
            "animate --path path.csv --panorama all.exr --surroundings dark --stray 0.1 -o o.####.exr".into(),
            &["dark"],
        ),
        (1, "animate --path path.csv --panorama nan.exr -o o.####.exr".into(), &["nan.exr", "NaN"]),
    ] {
        place.vglare(&words(&line)).failed(code, said);
        assert_eq!(place.files(), before, "{line} left something behind");
    }
}

#[test]
fn a_panorama_has_a_veil_all_the_way_round() {
    let place = place();
    let line = "apply all.exr --projection equirectangular --veil cie -o out.exr --glare g.exr --report r.json";
    place.vglare(&words(line)).succeeded();
    let report = place.read_json("r.json");
    let error = |key: &str| report["veil"]["error"][key].as_f64().unwrap();
    assert_eq!(report["veil"]["summed_by"], "rings");
    assert!(error("measured") <= error("predicted") && error("predicted") <= error("asked"), "{report}");
    assert!(report["warnings"].as_array().unwrap().iter().all(|text| !text.as_str().unwrap().contains("seam")));
    // Light is neither made nor lost on a whole sphere, but beyond the 100° that the function is for.
    let ledger = |key: &str| report["veil"]["ledger"][key][0].as_f64().unwrap();
    let whole = (ledger("kept") + ledger("inside")) / ledger("light");
    assert!((0.98..1.02).contains(&whole), "{whole}");
    // The same beside the seam: the sun is half way round from it.
    let glare = photo::read(&place.path("g.exr")).unwrap();
    for row in glare.pixels.chunks_exact(WIDTH) {
        assert!((row[0][0] / row[WIDTH - 1][0] - 1.0).abs() < 1e-3, "{:?} {:?}", row[0], row[WIDTH - 1]);
    }
    place.write("photo.exr", &Photo::new(64, 36, vec![[1.0; 4]; 64 * 36]));
    for (line, said) in [
        ("apply photo.exr --projection equirectangular --veil cie -o x.exr", &["twice as wide as high"][..]),
        ("apply all.exr --projection equirectangular --veil cie --lens tessar -o x.exr", &["--lens", "no ghosts"]),
        ("apply all.exr --projection equirectangular --veil cie --fov 90 -o x.exr", &["--fov", "360"]),
        ("apply all.exr --projection equirectangular --veil cie --border mirror -o x.exr", &["border"]),
    ] {
        place.vglare(&words(line)).failed(2, said);
    }
}
