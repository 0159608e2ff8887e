//! Lights and cameras that move, frame by frame.

use serde_json::Value;
use vglare::photo::{self, Photo};

use super::{Ran, Workplace, night};

/// A ghost that mirrors its light about the middle, and nothing else: what it does is plain to see.
const MIRROR: &str = "description = \"a mirror\"\n[[lens_ghost]]\nalong = -1.0\nsize = 0.15\nshare = 0.02\n";

/// A place with a path, and a lens that mirrors.
fn place(path: &str) -> Workplace {
    let place = Workplace::new();
    place.text("path.csv", path);
    place.text("mirror.toml", MIRROR);
    place
}

/// Animates the path through the mirror on small frames, as `o.0001.exr` and so on; `more` options replace none of these.
fn animate(place: &Workplace, frames: &str, more: &[&str]) -> Ran {
    let words =
        ["animate", "--path", "path.csv", "--frames", frames, "--lens", "mirror.toml", "--report", "report.json"];
    place.vglare(&[&words[..], &["-o", "o.####.exr", "--force"], more].concat())
}

const SMALL: [&str; 2] = ["--frame", "96x54"];

fn frame(place: &Workplace, number: usize) -> Photo {
    photo::read(&place.path(&format!("o.{number:04}.exr"))).expect("a frame")
}

fn bytes(place: &Workplace, name: &str) -> Vec<u8> {
    std::fs::read(place.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The light of a picture, and its centroid in half heights, x to the right.
fn light(photo: &Photo) -> (f64, f64) {
    let (mut sum, mut x) = (0.0, 0.0);
    for (at, pixel) in photo.pixels.iter().enumerate() {
        let value: f64 = pixel[..3].iter().map(|&value| f64::from(value)).sum();
        sum += value;
        x += value * photo.frame.x((at % photo.width() as usize) as f64);
    }
    (sum, x / sum)
}

/// How far two pictures are apart, as a sum over all pixels.
fn apart(one: &Photo, other: &Photo) -> f64 {
    let differences = one.pixels.iter().flatten().zip(other.pixels.iter().flatten());
    differences.map(|(a, b)| f64::from((a - b).abs())).sum()
}

fn frames(report: &Value) -> &[Value] {
    report["frames"].as_array().expect("frames")
}

#[test]
fn a_scene_that_stands_still_is_the_same_in_every_frame() {
    // One row; two that say the same; and two lights of which none moves.
    for path in [
        "time,x,y\n0,0.4,0.3\n",
        "time,x,y\n0,0.4,0.3\n7,0.4,0.3\n",
        "time,light,x,y\n0,a,0.4,0.3\n1,a,0.4,0.3\n0,b,-1,0\n1,b,-1,0\n",
    ] {
        let place = place(path);
        place.photo("night.exr");
        for more in [&["--glare", "g.####.exr", "--frame", "96x54"][..], &["night.exr"]] {
            let run = |frames: &str| {
                let words = ["animate", "--path", "path.csv", "--lens", "mirror.toml", "-o", "o.####.png", "--force"];
                place
                    .vglare(&[&words[..], more, &["--report", "report.json", "--frames", frames]].concat())
                    .succeeded();
            };
            run("4");
            let first = bytes(&place, "o.0001.png");
            for number in 2..=4 {
                assert!(first == bytes(&place, &format!("o.{number:04}.png")), "{path}");
                assert_eq!(frames(&place.read_json("report.json"))[number - 1]["same_as"], 1);
            }
            // Nor does it matter how many frames there are.
            run("1");
            assert!(first == bytes(&place, "o.0001.png"), "{path}: another run");
        }
    }
}

#[test]
fn behind_lights_without_light_is_what_apply_makes() {
    let place = place("time,x,y,flux\n0,0,0,0\n1,1,0,0\n");
    place.photo("night.exr");
    let look = ["--preset", "vintage-uncoated", "--mix", "energy"];
    place.vglare(&[&["apply", "night.exr", "-o", "one.exr", "--glare", "one-g.exr"][..], &look].concat()).succeeded();
    let words =
        ["animate", "night.exr", "--path", "path.csv", "--frames", "2", "-o", "o.####.exr", "--glare", "g.##.exr"];
    // What does not move, but might have, has a quarter of the tolerance: with that alone, apply does the same.
    place.vglare(&[&words[..], &look].concat()).succeeded();
    place.vglare(
        &[&["apply", "night.exr", "-o", "fine.exr", "--force"][..], &look, &["--tolerance", "2.5e-4"]].concat(),
    );
    let (one, fine, frame) = ("one.exr", "fine.exr", frame(&place, 2));
    let read = |name: &str| photo::read(&place.path(name)).unwrap();
    let largest = read("one-g.exr").pixels.iter().flat_map(|pixel| pixel[..3].to_vec()).fold(0.0, f32::max);
    for name in [one, fine] {
        let photo = read(name);
        let off = photo.pixels.iter().flatten().zip(frame.pixels.iter().flatten()).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f32::max) <= 2e-2 * largest, "{name}");
    }
    assert!(bytes(&place, "o.0001.exr") == bytes(&place, "o.0002.exr"));
}

#[test]
fn a_light_that_crosses_moves_its_ghost_the_other_way_and_nothing_jumps() {
    // From within the picture to well outside.
    let place = place("time,x,y\n0,-1.4,0.2\n1,2.6,0.2\n");
    let quiet = ["--lamps", "hidden", "--veil", "none"];
    animate(&place, "60", &[&SMALL[..], &quiet].concat()).succeeded();
    let frames: Vec<Photo> = (1..=60).map(|number| frame(&place, number)).collect();
    let lights: Vec<(f64, f64)> = frames.iter().map(light).collect();
    let there: Vec<&(f64, f64)> = lights.iter().filter(|(sum, _)| *sum > 0.5 * lights[20].0).collect();
    assert!(there.len() > 40 && there.windows(2).all(|pair| pair[1].1 < pair[0].1), "{lights:?}");
    assert_eq!(lights[59].0, 0.0, "it has left");
    let mut jumps: Vec<f64> =
        frames.windows(2).map(|pair| apart(&pair[0], &pair[1])).filter(|&jump| jump > 0.0).collect();
    jumps.sort_by(f64::total_cmp);
    let (median, largest) = (jumps[jumps.len() / 2], jumps[jumps.len() - 1]);
    assert!(largest < 2.0 * median, "{largest} beside {median}");
    // Who wants it to shine from outside has it.
    animate(&place, "60", &[&SMALL[..], &quiet, &["--outside", "keep"]].concat()).succeeded();
    let last = light(&self::frame(&place, 60));
    assert!(last.0 > 0.0 && self::frame(&place, 30).pixels == frames[29].pixels, "within, it is the same");
}

#[test]
fn every_frame_is_measured_and_lights_keep_their_names() {
    let place = place(
        "time,light,x,y,r,g,b\n0,red,-1,0.1,30,1,1\n0,blue,1,-0.1,1,1,30\n1,red,1,0.1,30,1,1\n1,blue,-1,-0.1,1,1,30\n",
    );
    place.photo("night.exr");
    animate(&place, "9", &["night.exr", "--first", "5"]).succeeded();
    let report = place.read_json("report.json");
    let number = |value: &Value| value.as_f64().expect("a number");
    for (index, frame) in frames(&report).iter().enumerate() {
        let error = &frame["error"];
        assert!(number(&error["measured"]) <= number(&error["predicted"]), "{frame}");
        assert!(number(&error["predicted"]) <= number(&error["asked"]) && number(&error["asked"]) == 1e-3, "{frame}");
        assert_eq!(
            (frame["frame"].as_u64(), frame["lights"][0]["light"].as_str()),
            (Some(index as u64 + 5), Some("red"))
        );
        let along = -1.0 + 2.0 * index as f64 / 8.0;
        for (light, x) in [(0, along), (1, -along)] {
            assert!((number(&frame["lights"][light]["position"][0]) - x).abs() < 1e-12, "{frame}");
        }
    }
    assert_eq!((report["summary"]["computed"].as_u64(), report["still"][0]["what"].as_str()), (Some(9), Some("photo")));
    assert!(place.path("o.0013.exr").exists() && !place.path("o.0014.exr").exists());
    // Where the two meet, each has its own colour above or below.
    let middle = frame(&place, 9);
    let at = |row: f64| middle.pixels[row.round() as usize * 96 + 48];
    let [above, below] = [0.1, -0.1].map(|y| at(middle.frame.pixel(glam::DVec2::new(0.0, y)).y));
    assert!(above[0] > 5.0 * above[2] && below[2] > 5.0 * below[0], "{above:?}, {below:?}");
}

#[test]
fn lamps_are_drawn_or_hidden() {
    let place = place("frame,x,y,flux,size\n3,0.5,0,2,0.05\n5,0.5,0.2,2,0.05\n");
    let words = ["animate", "--path", "path.csv", "--lens", "none", "-o", "o.####.exr", "--force"];
    place.vglare(&[&words[..], &SMALL].concat()).succeeded();
    let shown = frame(&place, 3);
    let area = shown.frame.pixel_size().powi(2);
    let (sum, x) = light(&shown);
    assert!((sum * area / 6.0 - 1.0).abs() < 1e-3 && (x - 0.5).abs() < 1e-3, "{}, {x}", sum * area);
    assert!(place.path("o.0005.exr").exists() && !place.path("o.0006.exr").exists(), "rows count the frames");
    place.vglare(&[&words[..], &SMALL, &["--lamps", "hidden"]].concat()).succeeded();
    assert_eq!(light(&frame(&place, 3)).0, 0.0);
}

/// A panorama with a spot at yaw 0, green, at 90, red, and at 180, blue.
fn panorama(place: &Workplace) {
    let (width, height) = (256usize, 128usize);
    let spot = |at: usize, column: f64, row: f64| {
        let x = (at % width) as f64 + 0.5 - column;
        let x = x - width as f64 * (x / width as f64).round();
        (-0.5 * (x.powi(2) + ((at / width) as f64 + 0.5 - row).powi(2)) / 9.0).exp() as f32
    };
    let pixel = |at| [spot(at, 192.0, 64.0), spot(at, 128.0, 64.0), spot(at, 256.0, 64.0), 1.0];
    place.write("all.exr", &Photo::new(width as u32, height as u32, (0..width * height).map(pixel).collect()));
}

/// The plot has the mean of each frame's glare, as the report and the glare itself have it.
#[test]
fn the_mean_glare_is_drawn_over_the_frames() {
    let place = place("time,x,y\n0,-1,0\n1,0.5,0.2\n");
    animate(&place, "5", &[&SMALL[..], &["--glare", "g.####.exr", "--plot", "mean.svg"]].concat()).succeeded();
    let report = place.read_json("report.json");
    for (index, frame) in frames(&report).iter().enumerate() {
        let glare = photo::read(&place.path(&format!("g.{:04}.exr", index + 1))).unwrap();
        let mean = glare.pixels.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>() / glare.pixels.len() as f64;
        let told = frame["glare_mean"][1].as_f64().unwrap();
        assert!(mean > 0.0 && (told / mean - 1.0).abs() < 1e-6, "{index}: {told} {mean}");
    }
    let plot = String::from_utf8(bytes(&place, "mean.svg")).unwrap();
    assert!(plot.contains("Mean glare, path.csv") && plot.contains("units of the photo"), "{plot}");
    // Alone, too; and nothing is written where it cannot be.
    let words = ["animate", "--path", "path.csv", "--frames", "2", "--lens", "mirror.toml", "--frame", "96x54"];
    place.vglare(&[&words[..], &["--plot", "alone.png"]].concat()).succeeded();
    assert!(image::open(place.path("alone.png")).is_ok());
    place.vglare(&[&words[..], &["--plot", "mean.jpg", "-o", "n.####.png"]].concat()).failed(1, &["drawing"]);
    place.vglare(&[&words[..], &["--plot", "alone.png", "-o", "n.####.png"]].concat()).failed(1, &["alone.png"]);
    assert!(!place.path("n.0001.png").exists());
}

#[test]
fn a_camera_sees_what_lies_where_it_looks() {
    let place = place("time,yaw,pitch,roll\n0,90,0,0\n1,180,0,0\n2,360,0,45\n");
    panorama(&place);
    let words = ["animate", "--path", "path.csv", "--panorama", "all.exr", "--frames", "3", "-o", "o.####.exr"];
    let all = [&words[..], &["--frame", "96x54", "--lens", "none", "--report", "report.json", "--force"]].concat();
    place.vglare(&all).succeeded();
    for (number, colour) in [(1, 0), (2, 2), (3, 1)] {
        let view = frame(&place, number);
        let middle = view.pixels[27 * 96 + 48];
        assert!((0..3).all(|other| other == colour || middle[colour] > 5.0 * middle[other]), "{number}: {middle:?}");
        assert!(middle[colour] > 0.8, "{number}: {middle:?}");
    }
    assert_eq!(place.read_json("report.json")["frames"][0]["camera"]["fov"], 60.0);
    // Its lights glare, and a camera that is held still makes one frame of all.
    place.text("path.csv", "time,yaw,fov\n0,80,50\n1,80,50\n");
    let lit = ["--lens", "mirror.toml", "--glare", "g.####.exr"];
    let words = ["animate", "--path", "path.csv", "--panorama", "all.exr", "--frames", "2", "-o", "o.####.png"];
    place.vglare(&[&words[..], &["--frame", "96x54", "--report", "report.json", "--force"], &lit].concat()).succeeded();
    assert!(bytes(&place, "o.0001.png") == bytes(&place, "o.0002.png"));
    let (sum, x) = light(&photo::read(&place.path("g.0001.exr")).unwrap());
    // The red spot is 10° to the right, the ghost as far to the left.
    let expected = -10f64.to_radians().tan() / 25f64.to_radians().tan() * 96.0 / 54.0;
    assert!(sum > 0.0 && (x - expected).abs() < 0.1, "{x}, {expected}");
    assert_eq!(place.read_json("report.json")["summary"]["computed"], 1);
}

#[test]
fn what_cannot_be_is_refused_before_anything_is_written() {
    let place = place("time,x,y\n0,0,0\n1,1,0\n");
    place.write("night.exr", &night());
    panorama(&place);
    place.text("bad.csv", "time,x,y\n0,0,0\n1,x,0\n");
    place.text("back.csv", "time,x,y\n1,0,0\n0,1,0\n");
    place.text("both.csv", "time,x,y,yaw\n1,0,0,0\n");
    place.text("camera.csv", "time,yaw\n0,0\n1,10\n");
    place.text("out.0002.exr", "mine");
    let before = place.files();
    let out = "o.####.exr";
    let to = |more: &[&'static str]| [&["--frames", "3"][..], more].concat();
    for (code, words, said) in [
        (1, to(&["--path", "bad.csv", "-o", out]), &["bad.csv:3: x: expected a finite number"][..]),
        (1, to(&["--path", "back.csv", "-o", out]), &["back.csv:3: times have to rise"]),
        (1, to(&["--path", "both.csv", "-o", out]), &["both.csv:1:", "lights", "camera"]),
        (1, to(&["--path", "none.csv", "-o", out]), &["none.csv: cannot be read"]),
        (2, to(&["--path", "path.csv", "-o", "o.exr"]), &["--output", "frame's number", "o.exr"]),
        (2, to(&["--path", "path.csv", "-o", out, "--glare", "g.exr"]), &["--glare", "g.exr"]),
        (
            2,
            to(&["--path", "path.csv", "-o", out, "--glare", "./o.####.exr"]),
            &["--output and --glare need a file each"],
        ),
        (2, to(&["--path", "path.csv", "-o", out, "--report", "path.csv"]), &["--report would replace path.csv"]),
        (1, to(&["--path", "path.csv", "-o", "out.####.exr"]), &["out.0002.exr exists already"]),
        (1, to(&["--path", "path.csv", "-o", "o.####.gif"]), &["o.0001.gif"]),
        (2, to(&["--path", "camera.csv", "-o", out]), &["--panorama"]),
        (2, to(&["--path", "path.csv", "-o", out, "--panorama", "all.exr"]), &["--panorama", "lights"]),
        (
            1,
            to(&["--path", "camera.csv", "-o", out, "--panorama", "night.exr"]),
            &["night.exr", "twice as wide as high"],
        ),
        (2, to(&["--path", "path.csv", "-o", out, "--normalize", "minmax"]), &["--normalize none"]),
        (2, to(&["night.exr", "--path", "path.csv", "-o", out, "--frame", "96x54"]), &["--frame"]),
        (2, vec!["--path", "path.csv", "-o", out], &["--frames"]),
        (2, vec!["--path", "path.csv", "-o", out, "--frames", "0"], &["--frames"]),
        (2, vec!["--path", "path.csv", "--frames", "3"], &["--output"]),
    ] {
        place.vglare(&[&["animate"], &words[..]].concat()).failed(code, said);
        assert_eq!(place.files(), before, "{words:?} left something behind");
    }
}

#[test]
fn the_summary_tells_what_was_done() {
    let place = place("time,x,y\n0,-1,0\n1,-1,0\n2,1,0.5\n3,4,0.5\n");
    let said = animate(&place, "10", &[&SMALL[..], &["-v"]].concat()).succeeded().stdout();
    for words in
        ["path.csv: a light from 0 to 3, in 10 frames", "as the one before", "the worst", "is frame 1", "wrote"]
    {
        assert!(said.contains(words), "{words:?} is not in: {said}");
    }
    assert!(animate(&place, "2", &[&SMALL[..], &["-q"]].concat()).succeeded().stdout().is_empty());
}
