//! `apply --veil`: every pixel a source.

use vglare::choices::Processor;
use vglare::frame::{Frame, Window};
use vglare::gpu::{Backend, Device};
use vglare::job::{Computer, Found, Known, Stages, Unwatched, Wanted};
use vglare::look::Look;
use vglare::photo::{self, Photo};
use vglare::scene::read_scene;

use super::{Workplace, night};
use crate::support::turn;

const WIDTH: usize = 160;
const HEIGHT: usize = 100;

/// Black but for one pixel.
fn point(column: usize, row: usize, light: f32) -> Photo {
    let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; WIDTH * HEIGHT];
    pixels[row * WIDTH + column] = [light, 0.5 * light, 0.0, 1.0];
    Photo::new(WIDTH as u32, HEIGHT as u32, pixels)
}

/// What a person types, word by word.
fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// Where a pixel of a rectilinear picture looks, and its solid angle; by `fov` degrees across the width.
fn direction(column: usize, row: usize, fov: f64) -> ([f64; 3], f64) {
    let focal = 0.5 * WIDTH as f64 / (0.5 * fov).to_radians().tan();
    let [x, y] = [(column, WIDTH), (row, HEIGHT)].map(|(at, side)| (at as f64 - 0.5 * (side as f64 - 1.0)) / focal);
    let z = 1.0 / (1.0 + x * x + y * y).sqrt();
    ([x * z, y * z, z], z.powi(3) / (focal * focal))
}

/// CIE 146's general disability glare equation at age 25 and pigment 0.5, per steradian.
fn cie(degrees: f64) -> f64 {
    let theta = degrees.max(0.1);
    10.0 / theta.powi(3) + (5.0 / theta.powi(2) + 0.05 / theta) * (1.0 + (25.0f64 / 62.5).powi(4)) + 0.00125
}

#[test]
fn one_pixel_makes_the_glare_that_the_equation_says_anywhere() {
    let place = Workplace::new();
    for (fov, column, row) in [(5.0, 80, 50), (50.0, 3, 95), (90.0, 150, 4)] {
        place.write("in.exr", &point(column, row, 1e4));
        let fov_text = fov.to_string();
        let line = ["apply", "in.exr", "--glare", "veil.exr", "--veil", "cie", "--lens", "none", "--fov", &fov_text];
        place.vglare(&[&line[..], &["--force", "--tolerance", "2e-3"]].concat()).succeeded();
        let veil = photo::read(&place.path("veil.exr")).unwrap();
        let (source, area) = direction(column, row, fov);
        let mut worst = 0.0f64;
        for pixel in (0..WIDTH * HEIGHT).filter(|&pixel| pixel != row * WIDTH + column) {
            let (target, _) = direction(pixel % WIDTH, pixel / WIDTH, fov);
            let chord: f64 = (0..3).map(|k| (source[k] - target[k]).powi(2)).sum::<f64>().sqrt();
            let wanted = 1e4 * area * cie((2.0 * (0.5 * chord).asin()).to_degrees());
            worst = worst.max((f64::from(veil.pixels[pixel][0]) / wanted - 1.0).abs());
            assert_eq!(veil.pixels[pixel][2], 0.0);
        }
        assert!(worst < 2e-3, "{fov}: {worst:e}");
        assert_eq!(veil.pixels[row * WIDTH + column][0], 0.0, "a pixel is no source of its own veil");
    }
}

#[test]
fn light_is_neither_made_nor_lost_on_its_way() {
    let place = Workplace::new();
    place.photo("in.exr");
    let line = words("apply in.exr -o out.exr --veil gaussian --width 0.1 --scatter 0.3 --lens none");
    place.vglare(&[&line[..], &["--report", "report.json", "--force"]].concat()).succeeded();
    let report = place.read_json("report.json");
    let sums = |name: &str| {
        let photo = photo::read(&place.path(name)).unwrap();
        [0, 1, 2].map(|k| photo.pixels.iter().map(|pixel| f64::from(pixel[k])).sum::<f64>())
    };
    let ([before, after], veil) = ([sums("in.exr"), sums("out.exr")], &report["veil"]);
    let area = (2.0f64 / 64.0).powi(2);
    for k in 0..3 {
        let part = |name: &str| veil["ledger"][name][k].as_f64().unwrap();
        assert!((part("light") / (area * before[k]) - 1.0).abs() < 1e-6);
        assert!(((part("kept") + part("inside")) / (area * after[k]) - 1.0).abs() < 1e-5);
        assert!((part("light") - part("kept") - part("inside") - part("lost")).abs() < 1e-9 * part("light"));
        // The photo's lights stand near its edges.
        assert!(part("lost") > 0.0 && part("lost") < 0.3 * part("light"));
    }
    let error = |name: &str| veil["error"][name].as_f64().unwrap();
    assert!(error("measured") <= error("predicted") && error("predicted") <= 1e-2 && error("pixels") > 500.0);
    assert_eq!(report["plan"], serde_json::Value::Null, "without ghosts there is nothing to plan for them");
    // To add is to keep what was there.
    place.vglare(&[&line[..], &["--mix", "add", "--glare", "veil.exr", "--force"]].concat()).succeeded();
    let (added, veil) = (sums("out.exr"), sums("veil.exr"));
    assert!((0..3).all(|k| (added[k] / (before[k] + veil[k]) - 1.0).abs() < 1e-6));
}

#[test]
fn ghosts_and_veil_add_up_and_files_say_what_options_do() {
    let place = Workplace::new();
    place.photo("in.exr");
    let glare = |name: &str, args: &[&str]| {
        place.vglare(&[&["apply", "in.exr", "--glare", name, "--force"], args].concat()).succeeded();
        photo::read(&place.path(name)).unwrap().pixels
    };
    let options = ["--veil", "spencer", "--luminance", "scotopic", "--fov", "40", "--scatter", "0.2"];
    let both = glare("both.exr", &options);
    let ghosts = glare("ghosts.exr", &["--veil", "none"]);
    let veil = glare("veil.exr", &[&options[..], &["--lens", "none"]].concat());
    for (both, (ghosts, veil)) in both.iter().zip(ghosts.iter().zip(&veil)) {
        assert!((0..3).all(|k| (both[k] - ghosts[k] - veil[k]).abs() <= 1e-6 * both[k]));
    }
    place.text(
        "look.toml",
        "version = 2\n[veil]\npsf = \"spencer\"\nluminance = \"scotopic\"\nfov = 40\nscatter = 0.2\n[look]\nstrength = 1.0\n",
    );
    assert_eq!(glare("filed.exr", &["--scene", "look.toml"]), both);
    assert_eq!(glare("none.exr", &["--scene", "look.toml", "--veil", "none"]), ghosts);
}

#[test]
fn a_bad_pixel_harms_itself_alone() {
    let place = Workplace::new();
    let mut photo = night();
    place.write("good.exr", &photo);
    let line = words("--veil cie --fov 50 --lens none --report report.json --force");
    place.vglare(&[&["apply", "good.exr", "-o", "good-out.exr"], &line[..]].concat()).succeeded();
    for (at, value) in [(100, f32::NAN), (200, f32::INFINITY), (300, -5.0)] {
        photo.pixels[at][0] = value;
    }
    place.write("bad.exr", &photo);
    place.vglare(&[&["apply", "bad.exr", "-o", "bad-out.exr"], &line[..]].concat()).succeeded();
    let [good, bad] = ["good-out.exr", "bad-out.exr"].map(|name| photo::read(&place.path(name)).unwrap().pixels);
    assert!(bad[100][0].is_nan() && bad[200][0] == f32::INFINITY && (-5.0..-4.9).contains(&bad[300][0]));
    for at in (0..good.len()).filter(|at| ![100, 200, 300].contains(at)) {
        assert!((0..3).all(|k| (good[at][k] - bad[at][k]).abs() < 1e-2 * good[at][k]), "{at}");
    }
    let report = place.read_json("report.json");
    let count = |kind: &str| report["veil"]["no_sources"][kind][0].as_u64().unwrap();
    assert_eq!(["nan", "infinite", "negative"].map(count), [1, 1, 1]);
}

#[test]
fn what_no_veil_can_be_is_refused_by_name() {
    let place = Workplace::new();
    place.photo("in.exr");
    place.text("table.csv", "0,1\n0.1,nonsense\n");
    place.text("bad.toml", "[veil]\npsf = \"cie\"\nage = 200\n");
    place.text("odd.toml", "[veil]\npsf = \"gaussian\"\nwidth = 0.1\nluminance = \"photopic\"\n");
    place.text("key.toml", "[veil]\npsf = \"cie\"\ncolour = 3\n");
    for (line, words) in [
        ("--veil cie", ["--fov", "field of view"]),
        ("--veil cie --fov 0.01", ["--fov", "0.1 to 179"]),
        ("--veil cie --fov 50 --age 130", ["--age", "0 to 120"]),
        ("--lens none --age 60", ["--veil", "cie"]),
        ("--preset v1/classic-prime --age 60", ["--veil", "cie"]),
        ("--veil none --age 60", ["--veil", "cie"]),
        ("--age 60", ["--age", "camera"]),
        ("--veil gaussian", ["--width", "needs it"]),
        ("--veil gaussian --width 0.1", ["strength", "all of it"]),
        ("--veil gaussian --width 0.1 --age 30 --scatter 0.1", ["--age", "gaussian"]),
        ("--veil gaussian --width 0.1 --scatter 0.1 --projection rectilinear", ["--projection", "plane"]),
        ("--strength 60", ["strength of 60", "all of it"]),
        ("--veil camera --scatter 0.03 --strength 40", ["strength of 40", "all of it"]),
        ("--lens none --veil camera --strength 40", ["strength of 40", "all of it"]),
        ("--veil cie --fov 50 --normalize minmax", ["--normalize none", "physical"]),
        ("--veil table --table table.csv", ["--table", "2"]),
        // Numbers that begin with a minus are numbers, and told by their range.
        ("--veil cie --fov 50 --age -1", ["--age", "0 to 120"]),
        ("--veil cie --fov 50 --pigment -0.5", ["--pigment", "and not -0.5"]),
        ("--veil cie --fov -50", ["--fov", "0.1 to 179"]),
        ("--veil abg --abg -1,1e-3,2.5", ["--abg", "-1"]),
        ("--veil abg --abg 1,-1e-3,2.5", ["--abg", "-0.001"]),
        ("--veil gaussian --width -0.1 --scatter 0.1", ["--width", "-0.1"]),
        ("--veil gaussian --width 0.1 --scatter -0.1", ["--scatter", "-0.1"]),
        ("--veil mixture --widths -0.1,0.2 --scatter 0.1", ["--widths", "-0.1"]),
        ("--veil mixture --widths 0.1,0.2 --weights -1,2 --scatter 0.1", ["--weights", "-1"]),
        ("--veil mixture --widths 0.1 --tints -1,0,0 --scatter 0.1", ["--tints", "not negative"]),
        ("--strength -1", ["--strength", "not negative"]),
        ("--tint -1,0,0", ["--tint", "not negative"]),
        ("--size -1", ["--size", "positive"]),
        ("--tolerance -1e-3", ["--tolerance", "-1e-3"]),
        ("--merge -1", ["--merge", "not negative"]),
        ("--degree -1,2", ["--degree", "-1,2"]),
        ("--veil cie --fov 350 --projection fisheye", ["fisheye", "330"]),
        ("--veil cie --fov 50 --border mirror", ["border", "plane"]),
    ] {
        let args: Vec<&str> = ["apply", "in.exr", "-o", "out.exr"].into_iter().chain(line.split(' ')).collect();
        place.vglare(&args).failed(2, &words);
    }
    for (file, words) in [("bad.toml", "age"), ("odd.toml", "luminance"), ("key.toml", "colour")] {
        place.vglare(&["apply", "in.exr", "-o", "out.exr", "--scene", file]).failed(1, &[file, words]);
    }
    // A file that cannot be read is one, as a scene or a photo is.
    std::fs::create_dir(place.path("folder.csv")).unwrap();
    place.text("text.exr", "this is no picture");
    let missing = place.vglare(&["apply", "in.exr", "-o", "out.exr", "--scene", "nothing.toml"]);
    missing.failed(1, &["nothing.toml: cannot be read: No such file"]);
    for (name, words) in [
        ("table --table nothing.csv", "nothing.csv: cannot be read: No such file"),
        ("table --table folder.csv", "folder.csv: cannot be read: it is a folder"),
        ("kernel --kernel nothing.exr", "nothing.exr: cannot be read: No such file"),
        ("kernel --kernel text.exr", "text.exr: cannot be read: "),
    ] {
        for command in [&["apply", "in.exr", "-o", "out.exr", "--veil"][..], &["psf"]] {
            let line: Vec<&str> = command.iter().copied().chain(name.split(' ')).collect();
            let ran = place.vglare(&line);
            assert!(!ran.stderr().contains("the photo"), "{}", ran.stderr());
            ran.failed(1, &[words]);
        }
    }
    assert!(!place.files().contains(&"out.exr".to_owned()));
}

#[test]
fn what_is_wrong_in_a_file_is_told_where_it_stands() {
    let place = Workplace::new();
    place.photo("in.exr");
    for (text, words) in [
        (
            "[veil]\npsf = \"cie\"\nage = 60\nprojektion = \"planar\"\n",
            [
                "line 4, column 1",
                "`projektion`",
                "`psf`, `age`",
                "`fov`, `projection`, `border`, `tolerance` in `veil`",
            ],
        ),
        ("[look]\nsize = 1\n[veil]\npsf = \"gaussan\"\n", ["line 4, column 7", "`gaussan`", "`gaussian`", "`kernel`"]),
        ("[veil]\npsf = \"gaussian\"\nwidth = \"x\"\n", ["line 3, column 9", "\"x\"", "f64", "veil.width"]),
        ("[veil]\nborder = \"mirorr\"\npsf = \"cie\"\n", ["line 2, column 10", "`mirorr`", "`mirror`", "veil.border"]),
        ("[veil]\npsf = \"cie\"\nage = 200\n", ["line 3, column 7", "0 to 120", "200", "veil.age"]),
        ("[veil]\npsf = \"cie\"\nfov = 720\n", ["line 3, column 7", "0.1 to 179", "720", "veil.fov"]),
        ("[veil]\npsf = \"cie\"\ntolerance = 2\n", ["line 3, column 13", "0 and 1", "2", "veil.tolerance"]),
        ("[veil]\npsf = \"cie\"\nwidth = 0.1\n", ["line 3, column 9", "cie does not take it", "age", "veil.width"]),
        ("[veil]\npsf = \"table\"\ntable = \"none.csv\"\n", ["line 3", "none.csv", "cannot be read", "veil.table"]),
        ("[veil]\nage = 3\n", ["line 1", "missing", "`psf`", "`veil`"]),
        ("[veil]\npsf = \"none\"\nage = 3\n", ["line 3, column 1", "veil.age", "no veil", "none"]),
        ("[veil]\npsf = \"cie\"\nreplaces_ghosts = true\n", ["line 3", "`replaces_ghosts`", "`psf`", "`border`"]),
    ] {
        place.text("look.toml", text);
        place.vglare(&["apply", "in.exr", "-o", "out.exr", "--scene", "look.toml"]).failed(1, &words);
    }
    // A lens has a key more.
    let lens = "[[lens_ghost]]\nalong = -1\nsize = 0.1\nshare = 0.1\n[veil]\npsf = \"cie\"\nreplace_ghosts = true\n";
    place.text("lens.toml", lens);
    let line = ["apply", "in.exr", "-o", "out.exr", "--lens", "lens.toml"];
    place
        .vglare(&line)
        .failed(1, &["lens.toml: line 7, column 1", "`replace_ghosts`", "`tolerance`, `replaces_ghosts`"]);
}

#[test]
fn each_colour_has_its_own_gaussians() {
    let place = Workplace::new();
    let mut photo = point(80, 50, 1.0);
    photo.pixels[50 * WIDTH + 80] = [1.0, 2.0, 4.0, 1.0];
    place.write("in.exr", &photo);
    let line = "apply in.exr --glare veil.exr --lens none --veil mixture --widths 0.2,0.4 --weights 3,1 --tints 1,0.5,0;0,0.5,1 \
                --scatter 0.1 --strict --report report.json";
    place.vglare(&words(line)).succeeded();
    let veil = photo::read(&place.path("veil.exr")).unwrap();
    let area = (2.0f64 / HEIGHT as f64).powi(2);
    // Three quarters of the energy in the narrow one, red to cyan; the rest in the wide one, blue to yellow.
    let gaussian =
        |width: f64, r: f64| 0.1 * (-0.5 * (r / width).powi(2)).exp() / (std::f64::consts::TAU * width * width);
    for (column, row) in [(81, 50), (90, 60), (20, 50), (80, 99)] {
        let r = 2.0 / HEIGHT as f64 * f64::hypot(column as f64 - 80.0, row as f64 - 50.0);
        let [narrow, wide] = [0.75 * gaussian(0.2, r), 0.25 * gaussian(0.4, r)];
        let wanted = [narrow, narrow + wide, 4.0 * wide].map(|value| area * value);
        for (value, wanted) in veil.pixels[row * WIDTH + column].iter().zip(wanted) {
            assert!((f64::from(*value) / wanted - 1.0).abs() < 1e-2, "{column}, {row}: {value:e} {wanted:e}");
        }
    }
}

#[test]
fn a_tolerance_that_nobody_asked_for_gives_way() {
    let place = Workplace::new();
    place.photo("in.exr");
    let line = words("apply in.exr -o out.exr --lens none --veil gaussian --width 0.1 --scatter 0.1");
    place.vglare(&[&line[..], &["--tolerance", "1e-8"]].concat()).failed(3, &["1.0e-8"]);
    let said = place.vglare(&[&line[..], &["--tolerance", "1e-8", "--allow-floor"]].concat()).succeeded().stdout();
    assert!(said.contains("instead of 1.0e-8"), "{said}");
}

#[test]
fn functions_are_shown_drawn_and_written() {
    let place = Workplace::new();
    for name in ["cie", "cie135", "spencer", "stiles-holladay", "camera"] {
        let said =
            place.vglare(&["psf", name, "--plot", "psf.svg", "--csv", "psf.csv", "--force"]).succeeded().stdout();
        assert!(said.contains(name) && said.contains("Gaussians"), "{said}");
    }
    let line = "psf starburst --fstop 16 --plot star.svg --csv star.csv";
    let said = place.vglare(&words(line)).succeeded().stdout();
    assert!(said.contains("µm") && said.contains("none: a picture is not round"), "{said}");
    place.vglare(&["psf", "starburst"]).failed(2, &["--fstop", "needs it"]);
    place.vglare(&["psf", "starburst", "--fstop", "16", "--blades", "2"]).failed(2, &["--blades", "and not 2"]);
    place.vglare(&["psf", "cie", "--age", "60", "--plot", "psf.png", "--csv", "cie.csv"]).succeeded();
    let picture = photo::read(&place.path("psf.png")).unwrap();
    assert!(picture.width() > picture.height() && picture.pixels.iter().any(|pixel| pixel[0] < 0.5));
    let text = std::fs::read_to_string(place.path("cie.csv")).unwrap();
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert_eq!((rows.len(), rows[0].len()), (400, 7));
    for row in &rows {
        let (theta, wanted) = (row[0], |theta: f64| {
            10.0 / theta.powi(3) + (5.0 / theta.powi(2) + 0.05 / theta) * (1.0 + (60.0f64 / 62.5).powi(4)) + 0.00125
        });
        assert!((row[1] / wanted(theta) - 1.0).abs() < 1e-9 && row[3].abs() < 1e-2, "{row:?}");
    }
    assert!(rows.windows(2).all(|pair| pair[0][4] < pair[1][4]) && (rows[399][4] - 1.0).abs() < 1e-6);
    let svg = std::fs::read_to_string(place.path("psf.svg")).unwrap();
    assert_eq!(svg.matches("<svg").count(), 5);
    place.vglare(&["psf", "cie", "--plot", "psf.pdf"]).failed(1, &["psf.pdf", ".svg"]);
    place.vglare(&["psf", "cie", "--csv", "cie.csv"]).failed(1, &["cie.csv"]);
}

/// One lamp: its spikes as the iris is turned, upwards where its blades are level, and all of the light in the ledger.
#[test]
fn an_iris_throws_spikes_from_a_lamp() {
    let place = Workplace::new();
    let mut photo = point(80, 50, 1e4);
    photo.pixels[50 * WIDTH + 80] = [1e4, 1e4, 1e4, 1.0];
    place.write("in.exr", &photo);
    place.text(
        "look.toml",
        "version = 2\npreset = \"none\"\n[veil]\npsf = \"starburst\"\nfstop = 16\nblades = 4\nsensor = 3\n",
    );
    let line = "apply in.exr -o out.exr --glare veil.exr --scene look.toml --rotation 65 --strict --force --report report.json";
    place.vglare(&words(line)).succeeded();
    let veil = photo::read(&place.path("veil.exr")).unwrap();
    let at = |angle: f64| {
        let [x, y] = [40.0 * angle.to_radians().cos(), 40.0 * angle.to_radians().sin()];
        // Row 0 is at the top.
        veil.pixels[(50.0 - y).round() as usize * WIDTH + (80.0 + x).round() as usize]
    };
    // A corner at 65° has blades beside it whose spikes are at 20 and 110.
    let [on, off] = [20.0, -20.0].map(at);
    assert!(on[1] > 20.0 * off[1] && at(110.0)[1] > 20.0 * off[1], "{on:?} and {off:?}");
    assert!(on[0] > on[1] && on[1] > on[2], "{on:?}");
    let veil = &place.read_json("report.json")["veil"];
    assert_eq!((&veil["psf"], &veil["fstop"], &veil["rotation"]), (&"starburst".into(), &16.0.into(), &65.0.into()));
    for channel in 0..3 {
        let part = |name: &str| veil["ledger"][name][channel].as_f64().unwrap() / 1e4;
        let scattered = veil["scattered"][channel].as_f64().unwrap();
        assert!((part("kept") - (1.0 - scattered)).abs() < 1e-6 && part("lost") > 0.0, "{veil}");
        assert!((part("kept") + part("inside") + part("lost") - 1.0).abs() < 1e-6, "{veil}");
    }
    // So strong it would scatter more than there is.
    place.vglare(&words("apply in.exr -o no.exr --scene look.toml --strength 9")).failed(2, &["strength of 9"]);
}

#[test]
fn a_picture_as_kernel_is_seen_as_it_lies_in_its_file() {
    let place = Workplace::new();
    // No two pixels alike, and no way to turn it that leaves it the same; its centre is the fourth of seven columns, the third of four rows.
    let kernel = |column: usize, row: usize| [0, 1, 2].map(|channel| ((7 * row + column + 1) * (channel + 1)) as f32);
    let pixels = (0..28).map(|at| kernel(at % 7, at / 7)).map(|[r, g, b]| [r, g, b, 1.0]).collect();
    place.write("star.exr", &Photo::new(7, 4, pixels));
    let mut photo = point(80, 50, 1.0);
    photo.pixels[50 * WIDTH + 80] = [1.0, 10.0, 100.0, 1.0];
    place.write("in.exr", &photo);
    let line = "apply in.exr --glare veil.exr --lens none --veil kernel --kernel star.exr --scatter 0.4 --tolerance 1e-6 --strict \
                --report report.json";
    place.vglare(&words(line)).succeeded();
    let veil = photo::read(&place.path("veil.exr")).unwrap();
    // A mean energy of 1 over the channels: the sum of 1 to 28, twice.
    let energy = 812.0;
    for row in 46..54 {
        for column in 75..86 {
            let (x, y) = ((column + 3usize).wrapping_sub(80), (row + 2usize).wrapping_sub(50));
            let inside = (column, row) != (80, 50) && x < 7 && y < 4;
            let wanted = if inside { kernel(x, y) } else { [0.0; 3] };
            for (channel, light) in [1.0, 10.0, 100.0].into_iter().enumerate() {
                let wanted = light * 0.4 * wanted[channel] / energy;
                let value = veil.pixels[row * WIDTH + column][channel];
                assert!((value - wanted).abs() <= 1e-6 * wanted, "{column}, {row}, {channel}: {value:e} {wanted:e}");
            }
        }
    }
    let report = place.read_json("report.json");
    assert!(report["veil"]["error"]["predicted"].as_f64().unwrap() <= 1e-6, "{report}");
}

#[test]
fn what_no_gaussians_follow_is_transformed() {
    let place = Workplace::new();
    place.write("in.exr", &point(80, 50, 1.0));
    // A ring, which rises fivefold within a pixel.
    place.text("ring.csv", "0,1\n0.1,1\n0.12,0.2\n0.2,0.2\n0.22,1\n0.3,1\n0.32,0.1\n0.4,0.1\n0.42,1e-4\n");
    let line = "apply in.exr --glare veil.exr --lens none --veil table --table ring.csv --scatter 0.3 --tolerance 1e-6 --strict \
                --verify full --report report.json";
    place.vglare(&words(line)).succeeded();
    let veil = photo::read(&place.path("veil.exr")).unwrap();
    let [hollow, ring, skirt] = [88, 92, 97].map(|column| f64::from(veil.pixels[50 * WIDTH + column][0]));
    assert!((hollow / ring - 0.2).abs() < 1e-5 && (skirt / ring - 0.1).abs() < 1e-5, "{hollow:e} {ring:e} {skirt:e}");
    let report = place.read_json("report.json");
    let [predicted, measured] = ["predicted", "measured"].map(|key| report["veil"]["error"][key].as_f64().unwrap());
    assert!(measured <= predicted && predicted <= 1e-6, "{report}");
    // On the sphere there is no such way yet.
    place.text(
        "fov.toml",
        "[veil]\npsf = \"table\"\ntable = \"ring.csv\"\nprojection = \"rectilinear\"\nscatter = 0.3\n",
    );
    place.vglare(&["apply", "in.exr", "-o", "out.exr", "--scene", "fov.toml"]).failed(2, &["projection"]);
}

/// Where the rows of a table end, or a tail is told to, light ends: none lies beyond, and none that the energy does not count.
#[test]
fn a_function_ends_where_it_says() {
    let place = Workplace::new();
    place.write("in.exr", &point(80, 50, 1.0));
    place.text("flat.csv", "0,1\n0.3,1\n0.3001,1\n");
    let radius = 0.3001 / 0.02;
    let line = "apply in.exr --glare veil.exr --lens none --scatter 0.5 --tolerance 1e-6 --strict --report report.json --force --veil";
    for function in ["table --table flat.csv", "abg --abg 1,1e-18,0.5,0.3001"] {
        place.vglare(&[words(line), words(function)].concat()).succeeded();
        let veil = photo::read(&place.path("veil.exr")).unwrap();
        for (at, pixel) in veil.pixels.iter().enumerate().filter(|(at, _)| *at != 50 * WIDTH + 80) {
            let distance = ((at % WIDTH) as f64 - 80.0).hypot((at / WIDTH) as f64 - 50.0);
            // Of unit energy: 1/πR², or 3/(4πR^1.5) r^−½.
            let share = if function.starts_with("table") { 1.0 } else { 0.75 * (radius / distance).sqrt() };
            let wanted = if distance > radius { 0.0 } else { 0.5 * share / (std::f64::consts::PI * radius * radius) };
            let value = f64::from(pixel[0]);
            assert!((value - wanted).abs() <= 2e-6 * wanted, "{function}, {distance} pixels off: {value:e} {wanted:e}");
        }
        let report = place.read_json("report.json");
        let part = |name: &str| report["veil"]["ledger"][name][0].as_f64().unwrap();
        // As far as so many pixels are a disc, but for the source's own, where the tail has its peak.
        if function.starts_with("table") {
            assert!(part("lost").abs() < 3e-3 * part("light"), "{report}");
        }
    }
    place.vglare(&words("psf table --table flat.csv --plot psf.svg --csv psf.csv --range 0.01,3")).succeeded();
    let text = std::fs::read_to_string(place.path("psf.csv")).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect())
        .collect();
    let beyond = rows.iter().filter(|row| row[0] > 0.3001);
    assert!(beyond.clone().count() > 100 && beyond.clone().all(|row| row[1] == 0.0 && (row[4] - 1.0).abs() < 1e-9));
    // Nothing of it reaches another pixel.
    place.text("dot.csv", "0,1\n0.001,1\n0.002,0.5\n");
    place.vglare(&[words(line), words("table --table dot.csv")].concat()).succeeded();
    let veil = photo::read(&place.path("veil.exr")).unwrap();
    assert!(veil.pixels.iter().all(|pixel| pixel[..3] == [0.0; 3]));
}

/// A camera looks along the middle of its picture, and not of the pixels of it that are stored.
#[test]
fn stored_pixels_are_seen_where_they_lie() {
    let place = Workplace::new();
    let windows = [
        Window { x: 100, y: 4, width: 50, height: 40 },
        Window { x: -20, y: 30, width: 70, height: 45 },
        Window { x: 0, y: 0, width: 160, height: 30 },
    ];
    for window in windows {
        let frame = Frame::full(WIDTH as u32, HEIGHT as u32).with_window(window);
        let columns = window.width as usize;
        let (column, row) = (columns / 3, 7);
        let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; window.pixels()];
        pixels[row * columns + column] = [1e4, 5e3, 0.0, 1.0];
        place.write("in.exr", &Photo { frame, ..Photo::new(window.width, window.height, pixels) });
        let line = "apply in.exr -o out.exr --glare veil.exr --veil cie --lens none --fov 80 --tolerance 5e-3 --report report.json --force";
        place.vglare(&words(line)).succeeded();
        let veil = photo::read(&place.path("veil.exr")).unwrap();
        assert_eq!(veil.frame.window, window);
        let looks = |pixel: usize| {
            let [x, y] = [window.x + (pixel % columns) as i32, window.y + (pixel / columns) as i32].map(f64::from);
            let focal = 80.0 / 40f64.to_radians().tan();
            let [u, v] = [(x - 79.5) / focal, (y - 49.5) / focal];
            let z = 1.0 / (1.0 + u * u + v * v).sqrt();
            ([u * z, v * z, z], z.powi(3) / (focal * focal))
        };
        let (source, area) = looks(row * columns + column);
        for pixel in (0..window.pixels()).filter(|&pixel| pixel != row * columns + column) {
            let (target, _) = looks(pixel);
            let chord: f64 = (0..3).map(|k| (source[k] - target[k]).powi(2)).sum::<f64>().sqrt();
            let wanted = 1e4 * area * cie((2.0 * (0.5 * chord).asin()).to_degrees());
            let off = (f64::from(veil.pixels[pixel][0]) / wanted - 1.0).abs();
            assert!(off < 5e-3, "{window:?}, pixel {pixel}: {off:e}");
        }
        // The lamp keeps what it does not scatter.
        let [light, kept] =
            ["light", "kept"].map(|name| place.read_json("report.json")["veil"]["ledger"][name][0].as_f64().unwrap());
        let out = f64::from(photo::read(&place.path("out.exr")).unwrap().pixels[row * columns + column][0]);
        assert!((light / (1e4 * area) - 1.0).abs() < 1e-9 && (kept / light / (out / 1e4) - 1.0).abs() < 1e-6);
    }
    let mut wide = Photo::new(4, 3, vec![[1.0; 4]; 12]);
    wide.source.pixel_aspect = 2.0;
    place.write("wide.exr", &wide);
    for veil in ["cie --fov 50", "gaussian --width 0.1 --scatter 0.1", "cie --fov 50 --projection planar"] {
        let line = [words("apply wide.exr -o no.exr --lens none --veil"), words(veil)].concat();
        place.vglare(&line).failed(2, &["square pixels", "2 times as wide as high"]);
    }
}

/// Who embeds the crate may say what sums veils; the report tells, and the veil is the same.
#[test]
fn a_device_sums_the_same_veil() {
    let place = Workplace::new();
    let photo = place.photo("in.exr");
    let _turn = turn();
    let device = Device::open(&Backend::ALL).unwrap_or_else(|error| panic!("this test needs GL: {error}"));
    let software = device.info().software;
    let mut computer = Computer::new(device, Known::default());
    let looks = [
        "preset = \"none\"\n[veil]\npsf = \"cie\"\nfov = 40\nprojection = \"planar\"\nborder = \"mirror\"\n",
        "[veil]\npsf = \"mixture\"\nwidths = [0.2, 0.4]\nweights = [3, 1]\ntints = [[1, 0.5, 0], [0, 0.5, 1]]\nscatter = 0.1\n",
    ];
    for text in looks {
        let look = Look::from_scene(read_scene(&place.text("look.toml", text)).unwrap()).unwrap();
        let mut veil = |by| {
            computer.sum_veils_by(by);
            let found = Found::new(&look, photo::read(&photo).unwrap(), Stages::default()).unwrap();
            let wanted = Wanted { glare: true, ..Wanted::default() };
            let done = found.compute(Some(&mut computer), wanted, &Unwatched).unwrap();
            done.check().unwrap();
            (done.glare.unwrap().pixels, done.veiled.unwrap())
        };
        let [(by_cpu, cpu), (by_device, device)] = [Processor::Cpu, Processor::Gl].map(|by| veil(Some(by)));
        assert_eq!([cpu.computed_by, device.computed_by], [Processor::Cpu, Processor::Gl]);
        assert_eq!(serde_json::to_value(&device).unwrap()["computed_by"], "gl");
        assert!(device.error.predicted >= cpu.error.predicted && device.error.predicted <= device.error.asked);
        let mut alike = 0;
        for (a, b) in by_cpu.as_flattened().iter().zip(by_device.as_flattened()) {
            assert!((a - b).abs() <= 1e-4 * a.abs(), "{text}: {b:e} for {a:e}");
            alike += usize::from(a == b);
        }
        // Alpha is.
        assert!(alike < by_cpu.len() * 4, "two sums, and not one");
        // Left to itself a software renderer is not taken.
        if software {
            assert_eq!(veil(None).1.computed_by, Processor::Cpu);
        }
    }
}
