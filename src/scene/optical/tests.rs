use super::*;
use crate::scene::LensGhost;
use crate::series::Bell;

fn lens(name: &str) -> OpticsSection {
    OpticsSection { lens: Some(name.into()), ..OpticsSection::default() }
}

/// The light of all rows, RGB.
fn shares(rows: &[LensGhost]) -> [f64; 3] {
    rows.iter().fold([0.0; 3], |sum, row| [0, 1, 2].map(|c| sum[c] + row.share * row.tint[c]))
}

#[test]
fn rows_carry_the_light_of_all_pairs_whatever_the_picture() {
    for name in ["double-gauss", "tessar", "telephoto"] {
        let optical = Optical::new(lens(name)).unwrap();
        let wanted =
            optical.ghosts().ghosts.iter().fold([0.0; 3], |sum, ghost| [0, 1, 2].map(|c| sum[c] + ghost.share[c]));
        for frame in [Frame::full(1920, 1080), Frame::full(100, 400), Frame::full(1920, 1080).in_units_of(0.3)] {
            for (share, wanted) in shares(&optical.fitted(&frame).lens().ghosts).into_iter().zip(wanted) {
                assert!((share - wanted).abs() <= 1e-9 * wanted, "{name}: {share} {wanted}");
            }
        }
    }
}

/// 36 mm are the width of a photo, and its height where it stands upright; lengths are in the unit of the frame.
#[test]
fn the_longer_side_of_a_sensor_is_that_of_the_picture() {
    let optical = Optical::new(lens("double-gauss")).unwrap();
    let largest = |frame: Frame| optical.fitted(&frame).lens().ghosts.iter().map(|row| row.size.x).fold(0.0, f64::max);
    let wide = largest(Frame::full(1920, 1080));
    let radius = optical.ghosts().ghosts.iter().flat_map(|ghost| ghost.radius_mm).fold(0.0, f64::max);
    assert!((wide * 18.0 * 1080.0 / 1920.0 / radius - 1.0).abs() < 0.02, "{wide} {radius}");
    // Half the height is half the longer side then.
    assert!((largest(Frame::full(1080, 1920)) / wide - 1080.0 / 1920.0).abs() < 1e-12);
    assert!((largest(Frame::full(1920, 1080).in_units_of(0.5)) / wide - 2.0).abs() < 1e-12);
    // On a smaller sensor the same circle is more of the picture.
    let small = Optical::new(OpticsSection { sensor: Some([18.0, 12.0]), ..lens("double-gauss") }).unwrap();
    let small = small.fitted(&Frame::full(1920, 1080));
    let largest = small.lens().ghosts.iter().map(|row| row.size.x).fold(0.0, f64::max);
    assert!((largest / wide - 2.0).abs() < 0.05, "{largest} {wide}");
}

/// At the middle of the picture no rim but the narrowest bites; off it the light is what `vignetting` has of each ghost.
#[test]
fn rims_cut_the_ghosts_of_lights_off_the_axis() {
    let optical = Optical::new(lens("double-gauss")).unwrap().fitted(&Frame::full(1920, 1080));
    assert_eq!(optical.ghosts_at(DVec2::ZERO), optical.lens().ghosts);
    let total = |rows: &[LensGhost]| shares(rows).into_iter().sum::<f64>();
    let whole = total(&optical.lens().ghosts);
    // As far as 10 and 20 degrees, in half heights of a picture 36 mm wide.
    let place =
        |degrees: f64| optical.ghosts().image_per_tangent * degrees.to_radians().tan() / (18.0 * 1080.0 / 1920.0);
    for (degrees, left) in [(10.0, 0.77), (20.0, 0.40)] {
        for towards in [DVec2::X, DVec2::from_angle(2.0)] {
            let rows = optical.ghosts_at(place(degrees) * towards);
            assert!((total(&rows) / whole - left).abs() < 0.03, "{degrees}: {}", total(&rows) / whole);
        }
    }
    let rows = optical.ghosts_at(DVec2::new(place(15.0), 0.0));
    let cuts = |row: &&LensGhost| matches!(&row.bell, Bell::Iris(iris) if !iris.cuts().is_empty());
    assert!(rows.iter().filter(cuts).count() > 20);
    // What is cut off lies towards or away from the axis: halves above and below are alike.
    for row in rows.iter().filter(cuts) {
        let light = Light { position: DVec2::new(place(15.0), 0.0), flux: [1.0; 3], size: 0.0, muted: false };
        let ghost = row.of(&light, DVec2::ZERO);
        let value = |x: f64, y: f64| ghost.bell.shape().value(DVec2::new(x, y) * ghost.size, ghost.size);
        for (x, y) in [(0.3, 0.4), (-0.6, 0.5), (0.8, 0.1)] {
            assert!((value(x, y) - value(x, -y)).abs() < 1e-12);
        }
    }
}

/// A lamp that crosses the picture: no ghost jumps in light or in shape, as rims come and go, by more than its way explains.
#[test]
fn ghosts_of_a_lamp_that_crosses_the_picture_change_smoothly() {
    for name in ["double-gauss", "sonnar", "retrofocus"] {
        let optical = Optical::new(lens(name)).unwrap().fitted(&Frame::full(1920, 1080));
        let at = |x: f64| optical.ghosts_at(DVec2::new(x, 0.3));
        let step = 0.002;
        let value = |row: &LensGhost, x: f64, y: f64| {
            let shape = row.bell.shape();
            row.share * shape.value(DVec2::new(x, y), DVec2::ONE) / shape.integral(DVec2::ONE)
        };
        for place in (-12..12).map(|k| 0.15 * f64::from(k)) {
            let (before, after) = (at(place), at(place + step));
            for (number, (one, other)) in before.iter().zip(&after).enumerate() {
                let whole = optical.lens().ghosts[number].share;
                assert!(
                    (one.share - other.share).abs() < 0.03 * whole,
                    "{name} {number} at {place}: {one:?} {other:?}"
                );
                for (x, y) in [(0.0, 0.0), (0.7, 0.0), (0.0, 0.7), (-0.7, 0.0), (0.5, -0.5), (-0.9, 0.3)] {
                    let change = (value(one, x, y) - value(other, x, y)).abs();
                    assert!(change < 0.12 * whole, "{name} {number} at {place}, {x} {y}: {change} of {whole}");
                }
            }
        }
    }
}

/// Of few lights each ghost has the outline that rims leave, of many the light and the middle.
#[test]
fn many_lights_have_ghosts_of_the_light_and_the_middle_that_few_have() {
    let optical = Optical::new(lens("tessar")).unwrap().fitted(&Frame::full(1920, 1080));
    let light = |k: usize| {
        let position = DVec2::new(-1.7 + 3.4 * (k as f64 * 0.618).fract(), -0.9 + 1.8 * (k as f64 * 0.377).fract());
        Light { position, flux: [1.0, 2.0, 3.0], size: 0.0, muted: k % 5 == 4 }
    };
    let (axis, rows) = (DVec2::new(0.1, -0.05), optical.lens().ghosts.len());
    let many: Vec<Light> = (0..20).map(light).collect();
    let ghosts = optical.ghosts_of(&many, axis);
    assert_eq!(ghosts.len(), 16 * rows);
    let shining: Vec<Light> = many.into_iter().filter(|light| !light.muted).collect();
    let mut cut = 0;
    for (few, ghosts) in shining.chunks(MOST_CUT).zip(ghosts.chunks(MOST_CUT * rows)) {
        for (one, whole) in optical.ghosts_of(few, axis).iter().zip(ghosts) {
            assert!(
                one.flux().iter().zip(whole.flux()).all(|(a, b)| (a - b).abs() < 1e-9 * b + 1e-15),
                "{one:?} {whole:?}"
            );
            let Bell::Iris(iris) = &one.bell else { continue };
            if iris.cuts().is_empty() || one.flux()[1] == 0.0 {
                continue;
            }
            // The centroid, from values on a lattice.
            let (mut sum, mut moment) = (0.0, DVec2::ZERO);
            for (i, j) in (-60..=60).flat_map(|j| (-60..=60).map(move |i| (i, j))) {
                let at = 0.025 * DVec2::new(f64::from(i), f64::from(j));
                let value = one.bell.shape().value(at, DVec2::ONE);
                (sum, moment) = (sum + value, moment + value * at);
            }
            let middle = one.center + moment / sum * one.size;
            let apart = (middle - whole.center).length() / one.size.x;
            assert!(apart < 0.15 + 2.0 * iris.edge(), "{apart} radii: {iris:?}");
            cut += 1;
        }
    }
    assert!(cut > 40, "{cut}");
}

#[test]
fn blades_show_where_the_lens_is_stopped_down() {
    let blades = |section: OpticsSection| {
        let lens = Optical::new(section).unwrap().lens().clone();
        let of = |row: &LensGhost| if let Bell::Iris(iris) = &row.bell { Some(iris.blades()) } else { None };
        let mut found: Vec<u32> = lens.ghosts.iter().filter_map(of).collect();
        found.dedup();
        found
    };
    assert_eq!(blades(lens("tessar")), [0]);
    let stopped = OpticsSection { fstop: Some(8.0), blades: Some(5), ..lens("tessar") };
    assert_eq!(blades(stopped.clone()), [5]);
    assert_eq!(blades(OpticsSection { blades: Some(0), ..stopped }), [0]);
}

#[test]
fn coatings_take_the_ghosts_away() {
    let share = |coating: &str| {
        let section = OpticsSection { coating: Some(coating.into()), ..lens("double-gauss") };
        shares(&Optical::new(section).unwrap().lens().ghosts).into_iter().sum::<f64>()
    };
    let [none, single, many] = ["none", "mgf2", "multi"].map(share);
    assert!(none > 5.0 * single && single > 2.0 * many, "{none} {single} {many}");
}

#[test]
fn what_a_name_means_is_told_by_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let golden = |name: &str| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden-optics/")).join(name);
    let none = OpticsSection::default();
    let optical = |path: &Path| match named_lens(path, &none).unwrap() {
        NamedLens::Optical(optical) => optical,
        other => panic!("{other:?}"),
    };
    // One lens from vglare's own file, from Zemax's in two encodings, and from pbrt's.
    let own = optical(Path::new("double-gauss"));
    for name in ["double-gauss.zmx", "double-gauss-utf8.zmx", "double-gauss.dat"] {
        let (own, read) = (own.ghosts(), optical(&golden(name)));
        assert_eq!(read.lens().name, name.rsplit_once('.').unwrap().0);
        assert_eq!(read.lens().veil, None, "files have no veil but their own");
        assert_eq!(read.ghosts().ghosts.len(), own.ghosts.len(), "{name}");
    }
    let copy = folder.path().join("mine.toml");
    fs::write(&copy, lenses::find("tessar").unwrap().toml).unwrap();
    assert_eq!(optical(&copy).ghosts(), optical(Path::new("tessar")).ghosts());
    let table = folder.path().join("table.toml");
    fs::write(&table, presets::find("zoom").unwrap().toml).unwrap();
    assert!(matches!(named_lens(&table, &none), Ok(NamedLens::Table(..))));
    assert!(matches!(named_lens(Path::new("anamorphic"), &none), Ok(NamedLens::Preset(_))));
    assert!(matches!(named_lens(Path::new("none"), &none), Ok(NamedLens::Preset(_))));
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let none = OpticsSection::default();
    let golden = |name: &str| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden-optics/")).join(name);
    let said = |path: &Path, section: &OpticsSection| named_lens(path, section).unwrap_err().to_string();
    for (path, section, word) in [
        (PathBuf::from("tesar"), none.clone(), "did you mean tessar?"),
        (PathBuf::from("no-such-file.zmx"), none.clone(), "no-such-file.zmx"),
        (golden("aspheric.zmx"), none.clone(), "surface 2"),
        (golden("tilted.zmx"), none.clone(), "surface"),
        (PathBuf::from("anamorphic"), OpticsSection { focus: Some(2.0), ..none.clone() }, "table of ghosts"),
        (PathBuf::from("tessar"), OpticsSection { fstop: Some(1.0), ..none.clone() }, "f/"),
        (PathBuf::from("tessar"), OpticsSection { blades: Some(2), ..none.clone() }, "blades"),
        (PathBuf::from("tessar"), OpticsSection { coating: Some("gold".into()), ..none.clone() }, "gold"),
        (PathBuf::from("zoom"), OpticsSection { setting: Some("1000 mm".into()), ..none.clone() }, "1000 mm"),
        (PathBuf::from("tessar"), OpticsSection { focus: Some(0.01), ..none.clone() }, "focus"),
    ] {
        let said = said(&path, &section);
        assert!(said.contains(word), "{}: {said}", path.display());
    }
}

/// A candle beside four lamps changes nothing of what these look like; a fifth lamp as bright is one of many.
#[test]
fn lights_that_outshine_others_keep_their_outlines() {
    let optical = Optical::new(lens("double-gauss")).unwrap();
    let light = |k: u32, flux: f64| Light {
        position: 0.7 * DVec2::from_angle(f64::from(k)),
        flux: [flux; 3],
        size: 0.0,
        muted: false,
    };
    let lamps: Vec<Light> = (0..4).map(|k| light(k, 5.0 + f64::from(k))).collect();
    let beside = |fifth: Light| {
        let mut all = vec![fifth];
        all.extend_from_slice(&lamps);
        optical.ghosts_of(&all, DVec2::ZERO)
    };
    let (alone, rows) = (optical.ghosts_of(&lamps, DVec2::ZERO), optical.lens().ghosts.len());
    assert_eq!(beside(light(9, 0.1))[rows..], alone);
    assert_ne!(beside(light(9, 5.0))[rows..], alone);
}
