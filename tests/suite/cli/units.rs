//! What a look's lengths and angles are in a picture: `--unit`, `--fov`, and what a photo's file says of its camera.

use std::path::Path;

use serde_json::json;
use vglare::photo::{self, Photo};

use super::Workplace;

const WIDTH: usize = 96;
const HEIGHT: usize = 64;

/// Dim, with a lamp in the middle, by its centre's pixel.
fn lamp(width: usize, height: usize) -> Photo {
    let mut pixels = vec![[0.01, 0.01, 0.01, 1.0]; width * height];
    for (column, row) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        pixels[(height / 2 - 1 + row) * width + width / 2 - 1 + column] = [900.0, 700.0, 400.0, 1.0];
    }
    Photo::new(width as u32, height as u32, pixels)
}

/// A quarter turn.
fn turned(photo: &Photo) -> Photo {
    let (width, height) = (photo.width() as usize, photo.height() as usize);
    let pixels = (0..width * height).map(|at| photo.pixels[(height - 1 - at % height) * width + at / height]).collect();
    Photo::new(height as u32, width as u32, pixels)
}

/// The middle of a photo.
fn middle(photo: &Photo, [wide, high]: [usize; 2]) -> Photo {
    let (width, height) = (photo.width() as usize, photo.height() as usize);
    let rows = (0..high).flat_map(|row| {
        let at = ((height - high) / 2 + row) * width + (width - wide) / 2;
        photo.pixels[at..at + wide].to_vec()
    });
    Photo::new(wide as u32, high as u32, rows.collect())
}

/// The largest difference in parts of the largest value.
fn difference(one: &Photo, other: &Photo) -> f64 {
    assert_eq!([one.width(), one.height()], [other.width(), other.height()]);
    let pixels = || one.pixels.iter().flatten().zip(other.pixels.iter().flatten());
    let largest = pixels().fold(0.0f32, |most, (&value, _)| if value == 1.0 { most } else { most.max(value) });
    f64::from(pixels().fold(0.0f32, |most, (a, b)| most.max((a - b).abs())) / largest)
}

impl Workplace {
    /// The glare of a photo.
    fn glare_of(&self, photo: &Photo, options: &str) -> Photo {
        self.write("in.exr", photo);
        let mut line = vec!["apply", "in.exr", "--glare", "glare.exr", "--force", "--no-calibration"];
        line.extend(options.split_whitespace());
        self.vglare(&line).succeeded();
        photo::read(&self.path("glare.exr")).unwrap()
    }
}

#[test]
fn a_photo_that_is_turned_or_cut_keeps_its_halo() {
    let place = Workplace::new();
    place.text(
        "look.toml",
        "axis = [0.1, 0.1]\n[look]\nsize = 1.2\n[[lens_ghost]]\nalong = 1\nsize = 0.2\nshare = 0.05\n[veil]\npsf = \"gaussian\"\nwidth = \
         0.1\nscatter = 0.1\n",
    );
    let (whole, square) = (lamp(WIDTH, HEIGHT), [HEIGHT, HEIGHT]);
    for (scene, fine) in [("--scene look.toml", 1e-2), ("--preset haze-filter --tolerance 1e-4", 5e-4)] {
        for unit in ["short-side", "diagonal", "degrees --fov 40"] {
            // The field of a picture that is cut or turned is another across its width.
            let across = |width: usize| match unit.strip_prefix("degrees --fov ") {
                Some(fov) => {
                    let half = (0.5 * fov.parse::<f64>().unwrap()).to_radians().tan() * width as f64 / WIDTH as f64;
                    format!("{scene} --unit degrees --fov {} --size 20", 2.0 * half.atan().to_degrees())
                }
                None => format!("{scene} --unit {unit}"),
            };
            let glare = place.glare_of(&whole, &across(WIDTH));
            // An axis out of the middle does not turn with the picture.
            if !scene.contains("look") {
                let upright = place.glare_of(&turned(&whole), &across(HEIGHT));
                assert!(difference(&turned(&glare), &upright) < fine, "{unit}");
            }
            if unit != "diagonal" {
                let cut = place.glare_of(&middle(&whole, square), &across(HEIGHT));
                assert!(difference(&middle(&glare, square), &cut) < fine, "{unit}");
            }
        }
        if !scene.contains("look") {
            let by_height = format!("{scene} --unit height");
            let (lying, upright) = (place.glare_of(&whole, &by_height), place.glare_of(&turned(&whole), &by_height));
            assert!(difference(&turned(&lying), &upright) > 0.1, "half the height is another when it is turned");
        }
    }
}

#[test]
fn a_unit_is_a_scale_of_all_lengths() {
    let place = Workplace::new();
    let photo = lamp(HEIGHT, WIDTH);
    let scene = |k: f64, unit: &str| {
        format!(
            "axis = [{}, 0.0]\n[look]\nunit = \"{unit}\"\n[[light]]\nposition = [{}, {}]\nflux = [{f}, {f}, {f}]\nsize = {}\n[[lens_ghost]]\nalong \
             = -0.5\nsize = {}\nshare = 0.1\n[[ghost]]\ncenter = [{}, {}]\nsize = {}\nradiance = [0.1, 0.2, 0.3]\n",
            0.1 * k,
            0.3 * k,
            -0.2 * k,
            0.05 * k,
            0.2 * k,
            -0.3 * k,
            0.4 * k,
            0.15 * k,
            f = 3.0 * k * k
        )
    };
    let half = (HEIGHT as f64, WIDTH as f64);
    for (unit, pixels) in [("short-side", half.0), ("diagonal", half.0.hypot(half.1)), ("height", half.1)] {
        place.text("by-height.toml", &scene(1.0, "height"));
        place.text("by-unit.toml", &scene(half.1 / pixels, unit));
        for evaluator in ["direct", "grid", "local", "series"] {
            let options = |file: &str| format!("--scene {file} --evaluator {evaluator} --report report.json");
            let by_height = place.glare_of(&photo, &options("by-height.toml"));
            let by_unit = place.glare_of(&photo, &options("by-unit.toml"));
            assert!(difference(&by_height, &by_unit) < 2e-3, "{unit}, {evaluator}");
            let report = place.read_json("report.json");
            assert_eq!(report["unit"]["name"], json!(unit));
            assert!((report["unit"]["pixels"].as_f64().unwrap() - 0.5 * pixels).abs() < 1e-9);
        }
        // Sums in 64-bit floats find their pixels by themselves.
        let fine = |file: &str| format!("--scene {file} --evaluator direct --tolerance 1e-7 --strict");
        let (by_height, by_unit) =
            (place.glare_of(&photo, &fine("by-height.toml")), place.glare_of(&photo, &fine("by-unit.toml")));
        assert!(difference(&by_height, &by_unit) < 1e-6, "{unit}");
    }
}

#[test]
fn lights_say_their_unit_and_are_taken_in_no_other() {
    let place = Workplace::new();
    place.write("in.exr", &turned(&lamp(WIDTH, HEIGHT)));
    let said = place.vglare(&["lights", "in.exr", "--json"]).succeeded().stdout();
    place.text("lights.json", &said);
    let by_height = place.json(&["lights", "in.exr", "--json", "--unit", "height"]);
    let by_side = place.read_json("lights.json");
    assert_eq!((&by_side["unit"], &by_height["unit"]), (&json!("short-side"), &json!("height")));
    let ratio = |key: &str| {
        let of = |found: &serde_json::Value| {
            let value = &found["lights"][0][key];
            value[0].as_f64().or(value.as_f64()).unwrap()
        };
        of(&by_side) / of(&by_height)
    };
    // Half the height is half as long again as half the shorter side.
    assert!((ratio("size") - 1.5).abs() < 1e-9 && (ratio("flux") - 2.25).abs() < 1e-9);
    let line =
        ["apply", "in.exr", "--glare", "glare.exr", "--force", "--report", "report.json", "--lights", "lights.json"];
    place.text("scene.toml", "[look]\nstrength = 1\n");
    place.text("new.toml", "version = 2\n[look]\nunit = \"height\"\n");
    for other in [["--unit", "height"], ["--scene", "scene.toml"], ["--scene", "new.toml"]] {
        place.vglare(&[&line[..], &other].concat()).failed(1, &["lights.json", "short-side", "height"]);
    }
    let unit = |options: &[&str]| {
        place.vglare(&[&line[..], options].concat()).succeeded();
        place.read_json("report.json")["unit"]["name"].clone()
    };
    // What names its unit gives it to a look that nothing else says it of.
    assert_eq!([unit(&[]), unit(&["--unit", "short-side"])], [json!("short-side"), json!("short-side")]);
    // Lights that name none are in half picture heights, as ever.
    place.text("lights.toml", "[[light]]\nposition = [0.1, 0.2]\nflux = [1, 1, 1]\n");
    let line = ["apply", "in.exr", "--glare", "glare.exr", "--force", "--report", "report.json"];
    for option in ["--lights", "--add-lights"] {
        place.vglare(&[&line[..], &[option, "lights.toml"]].concat()).succeeded();
        assert_eq!(place.read_json("report.json")["unit"]["name"], json!("height"));
    }
    let both = ["--lights", "lights.json", "--add-lights", "lights.toml"];
    place.vglare(&[&line[..], &both].concat()).failed(1, &["lights.json", "short-side", "height"]);
}

/// No option says a unit, and no file: a look is the same one when its photo is turned.
#[test]
fn a_look_of_no_file_turns_with_its_photo() {
    let place = Workplace::new();
    let mut photo = lamp(WIDTH, HEIGHT);
    photo.pixels[13 * WIDTH + 20] = [80.0, 90.0, 100.0, 1.0];
    place.text("lens.toml", "[[lens_ghost]]\nalong = -0.5\nsize = 0.2\nshare = 0.05\n");
    // An opening of six blades is another when it is turned, and so the lens has to be turned with the camera.
    let lens = place.vglare(&["presets", "classic-prime"]).succeeded().stdout();
    let blades = lens.replace("\nrotation = 12\n", "\nrotation = 102\n");
    assert!(blades != lens);
    place.text("turned.toml", &blades);
    for (preset, when_turned) in [
        ("", "--lens turned.toml"),
        ("--preset v1/classic-prime", "--preset v1/classic-prime"),
        ("--preset eye", "--preset eye"),
        ("--preset classic-veil", "--preset classic-veil"),
        ("--lens lens.toml", "--lens lens.toml"),
    ] {
        let [preset, when_turned] = [preset, when_turned].map(|options| format!("{options} --firefly-limit 0"));
        let lying = place.glare_of(&photo, &preset);
        let off = difference(&turned(&lying), &place.glare_of(&turned(&photo), &when_turned));
        assert!(off < 2e-3, "{preset}: {off}");
        // A photo that lies is as it was, to the last bit, when half its height was the unit.
        let by_height = place.glare_of(&photo, &format!("{preset} --unit height"));
        assert_eq!(lying.pixels, by_height.pixels, "{preset}");
    }
}

/// Files that other programs wrote: Pillow, piexif and OpenEXR's own bindings.
fn input(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs").join(name).display().to_string()
}

#[test]
fn the_file_says_what_the_picture_spans() {
    let place = Workplace::new();
    // 36 × 24 mm and 28 mm: 2 atan(18 / 28) and 2 atan(12 / 28).
    let (wide, narrow) = (65.470_45, 46.397_18);
    for (name, across, words) in [
        ("jpeg-exif-28-mm-turned.jpg", narrow, "35 mm equivalent 28 mm: 46.4° across"),
        ("png-exif-28-mm.png", wide, "35 mm equivalent 28 mm: 65.5° across"),
        ("tiff-exif-focal-plane.tif", wide, "focal length 28 mm"),
        ("exr-field-of-view.exr", wide, "the file's own field: 65.5° across"),
        ("exr-sensor.exr", wide, "focal length 28 mm"),
        ("exr-exif-28-mm.exr", wide, "35 mm equivalent 28 mm"),
        ("hdr-exposure-and-view.hdr", 45.0, "the file's own field: 45° across"),
    ] {
        let path = input(name);
        let line = ["apply", &path, "--glare", "glare.exr", "--veil", "cie", "--lens", "none", "--force"];
        let said = place.vglare(&[&line[..], &["--report", "report.json"]].concat()).succeeded().stdout();
        assert!(said.contains(words), "{name}: {said}");
        let veil = &place.read_json("report.json")["veil"];
        let found = veil["fov"].as_f64().unwrap();
        assert!((found - across).abs() < 2e-3, "{name}: {found}");
        assert!(words.starts_with(veil["fov_from"].as_str().unwrap().split(',').next().unwrap()), "{veil}");
        // What a person says wins, and then what a scene file does.
        let given = place.vglare(&[&line[..], &["--fov", "30"]].concat()).succeeded().stdout();
        assert!(given.contains("as given: 30° across"), "{given}");
        place.text("scene.toml", "[veil]\npsf = \"cie\"\nfov = 20\n");
        let line = ["apply", &path, "--glare", "glare.exr", "--scene", "scene.toml", "--lens", "none", "--force"];
        assert!(place.vglare(&line).succeeded().stdout().contains("as given: 20° across"));
        assert!(
            place.vglare(&[&line[..], &["--fov", "30"]].concat()).succeeded().stdout().contains("as given: 30° across")
        );
    }
}

#[test]
fn what_no_file_says_has_to_be_given() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text("two.toml", "[look]\nfov = 40\n[veil]\npsf = \"cie\"\nfov = 50\n");
    let (alone, shape) = (input("jpeg-exif-focal-length-alone.jpg"), input("jpeg-exif-28-mm-of-another-shape.jpg"));
    for (photo, options, words) in [
        (&*alone, "--veil cie", ["--fov", "cie is in degrees"]),
        (&shape, "--veil cie", ["--fov", "6000 × 6000"]),
        ("in.exr", "--unit degrees", ["--fov", "unit of lengths"]),
        ("in.exr", "--unit degrees --fov 200", ["--fov", "0.1 to 179"]),
        ("in.exr", "--fov 50", ["--fov", "nothing here is in degrees"]),
        ("in.exr", "--veil gaussian --width 0.1 --scatter 0.1 --fov 50", ["--fov", "nothing here is in degrees"]),
        ("in.exr", "--scene two.toml", ["40°", "50°"]),
    ] {
        let line: Vec<&str> = ["apply", photo, "-o", "out.exr"].into_iter().chain(options.split(' ')).collect();
        place.vglare(&line).failed(2, &words);
    }
    // A degree is a thirteenth of half this picture's height: a lens of openings is as fine as no series can be.
    for (command, options) in [
        ("plan", &["--preset", "v1/classic-prime"][..]),
        ("plan", &["--sources", "lights"]),
        ("lights", &[]),
        ("apply", &["--glare", "glare.exr", "--size", "30"]),
    ] {
        let line = [&[command, "in.exr", "--unit", "degrees"], options].concat();
        place.vglare(&line).failed(2, &["--fov"]);
        place.vglare(&[&line[..], &["--fov", "40"]].concat()).succeeded();
    }
    assert!(!place.files().contains(&"out.exr".to_owned()));
}
