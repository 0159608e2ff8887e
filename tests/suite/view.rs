//! The view on the screen: the CPU's tone maps, rows from the top, means of what is made smaller, the wipe.

use glam::DVec2;
use vglare::frame::Frame;
use vglare::gpu::{Backend, Region, Screen};
use vglare::photo::ToneMap;
use vglare::plan::Request;
use vglare::renderer::{Live, Mask, Normalize, Part, Settings, View};
use vglare::scene::{Emission, FindOptions, find};

use crate::support::{bits, on_live, plan, scenes};

const SURROUND: [f32; 3] = [0.2, 0.4, 0.6];

fn view() -> View {
    View {
        origin: DVec2::ZERO,
        pitch: 1.0,
        exposure: 0.0,
        tone_map: ToneMap::None,
        gamut: None,
        wipe: 0.0,
        surround: SURROUND,
    }
}

/// The code that a display gets for linear light in 0 to 1.
fn code(light: f32) -> f32 {
    255.0 * if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

/// A photo of one row or more on a screen of the same size or another.
fn shown(live: &mut Live, photo: &[[f32; 4]], width: u32, view: &View, size: [u32; 2]) -> Vec<[u8; 4]> {
    live.picture.load(Frame::full(width, photo.len() as u32 / width), photo).unwrap();
    let screen = Screen::hidden(live.picture.field.device(), size).unwrap();
    live.view(view, &screen, screen.whole()).unwrap();
    screen.read()
}

#[test]
fn tone_maps_are_those_of_the_cpu() {
    let mut photo: Vec<[f32; 4]> = Vec::new();
    for step in 0..600 {
        let light = 2.0f32.powf(step as f32 / 20.0 - 15.0);
        photo.push([light, 0.3 * light, 0.05, 1.0]);
    }
    for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.5, f32::MAX, 0.0] {
        photo.push([odd, 0.5, 0.25, 1.0]);
    }
    for backend in Backend::ALL {
        on_live(backend, |live| {
            for tone_map in [ToneMap::None, ToneMap::Reinhard, ToneMap::Aces, ToneMap::Agx] {
                for exposure in [0.0, -2.0] {
                    let view = View { tone_map, exposure, ..view() };
                    let got = shown(live, &photo, photo.len() as u32, &view, [photo.len() as u32, 1]);
                    for (light, got) in photo.iter().zip(got) {
                        let gain = (exposure as f32).exp2();
                        let want = tone_map.apply([light[0] * gain, light[1] * gain, light[2] * gain]).map(code);
                        let off = (0..3).map(|c| (f32::from(got[c]) - want[c]).abs()).fold(0.0, f32::max);
                        // Half a code for rounding, half for powers in f32.
                        assert!(off <= 1.0, "{tone_map:?} {exposure} {light:?}: {got:?} for {want:?}");
                    }
                }
            }
        })
    }
}

#[test]
fn rows_count_from_the_top_and_pixels_are_squares() {
    // Every pixel of its own colour: red by column, green by row.
    let light = |code: u32| ((code as f32 / 255.0 + 0.055) / 1.055).powf(2.4);
    let photo: Vec<_> = (0..12).map(|k| [light(40 + 20 * (k % 4)), light(50 + 30 * (k / 4)), 0.0, 1.0]).collect();
    for backend in Backend::ALL {
        on_live(backend, |live| {
            live.picture.load(Frame::full(4, 3), &photo).unwrap();
            let screen = Screen::hidden(live.picture.field.device(), [40, 30]).unwrap();
            screen.clear([0.0; 3]);
            let region = Region { x: 5, y: 7, width: 22, height: 20 };
            // The photo begins a pixel of its own right of and below the region's corner; 5 of the screen to one of it.
            live.view(&View { origin: DVec2::splat(-1.0), pitch: 0.2, ..view() }, &screen, region).unwrap();
            let pixels = screen.read();
            for (index, got) in pixels.iter().enumerate() {
                let (i, j) = (index as u32 % 40, index as u32 / 40);
                let inside = (5..27).contains(&i) && (7..27).contains(&j);
                let on_photo = inside && i >= 10 && j >= 12;
                let want = match (inside, on_photo) {
                    (false, _) => [0.0; 3],
                    (true, false) => SURROUND.map(|c| 255.0 * c),
                    (true, true) => [(40 + 20 * ((i - 10) / 5)) as f32, (50 + 30 * ((j - 12) / 5)) as f32, 0.0],
                };
                let off = (0..3).map(|c| (f32::from(got[c]) - want[c]).abs()).fold(0.0, f32::max);
                assert!(off <= 1.0, "column {i}, row {j}: {got:?} for {want:?}");
            }
        })
    }
}

#[test]
fn what_is_made_smaller_is_the_mean_of_its_light() {
    let photo: Vec<_> = (0..30 * 20u32).map(|k| [(k * 7919 % 100) as f32 / 100.0, 0.5, 0.0, 1.0]).collect();
    on_live(Backend::ALL[0], |live| {
        for pitch in [2.0, 5.0, 2.5] {
            let size = [(30.0 / pitch) as u32, (20.0 / pitch) as u32];
            let got = shown(live, &photo, 30, &View { pitch, ..view() }, size);
            for (index, got) in got.iter().enumerate() {
                let (i, j) = (index as u32 % size[0], index as u32 / size[0]);
                let overlap = |k: u32, cell: u32| {
                    let (low, high) = (f64::from(cell) * pitch, f64::from(cell + 1) * pitch);
                    (high.min(f64::from(k) + 1.0) - low.max(f64::from(k))).max(0.0)
                };
                let mut mean = 0.0;
                for (k, pixel) in photo.iter().enumerate() {
                    let (column, row) = (k as u32 % 30, k as u32 / 30);
                    mean += overlap(column, i) * overlap(row, j) * f64::from(pixel[0]) / (pitch * pitch);
                }
                let off = (f32::from(got[0]) - code(mean as f32)).abs();
                assert!(off <= 1.0, "{pitch} at {i}, {j}: {got:?} for {mean}");
            }
        }
    });
}

#[test]
fn the_wipe_parts_photo_and_picture() {
    let frame = Frame::full(16, 8);
    let photo = vec![[0.1, 0.1, 0.1, 1.0]; 128];
    let ghosts = [scenes::one([0.0, 0.0], 1.0, [0.5, 0.0, 0.0])];
    on_live(Backend::ALL[0], |live| {
        live.picture.field.set_scene(&plan(&ghosts, frame, &Request::new(1e-3)).unwrap()).unwrap();
        live.picture.load(frame, &photo).unwrap();
        live.picture.draw(frame, &Settings::default()).unwrap();
        let screen = Screen::hidden(live.picture.field.device(), [20, 8]).unwrap();
        let region = Region { x: 4, y: 0, width: 16, height: 8 };
        live.view(&View { wipe: 6.0, ..view() }, &screen, region).unwrap();
        let grey = code(0.1).round() as u8;
        for (index, pixel) in screen.read().iter().enumerate().filter(|(index, _)| index % 20 >= 4) {
            let before = index % 20 < 10;
            assert_eq!(pixel[0].abs_diff(grey) <= 1, before, "{index}: {pixel:?}");
            assert!(pixel[1].abs_diff(grey) <= 1, "{index}: {pixel:?}");
        }
        assert!(live.picture.pixel(8, 4).is_some_and(|[photo, picture]| photo[0] == 0.1 && picture[0] > 0.5));
        assert_eq!(live.picture.pixel(16, 4), None);
    });
}

#[test]
fn a_held_field_gives_the_same_picture() {
    let frame = Frame::full(33, 21);
    let photo = vec![[0.1, 0.2, 0.3, 0.5]; 33 * 21];
    let ghosts = [scenes::one([0.3, -0.2], 0.4, [0.5, 0.25, 1.0])];
    let other = [scenes::one([-0.3, 0.2], 0.2, [0.1, 0.9, 0.2])];
    let settings = Settings { strength: 1.7, ..Settings::default() };
    on_live(Backend::ALL[0], |live| {
        let mut pictures = Vec::new();
        let by = |ghosts: &[_]| plan(ghosts, frame, &Request::new(1e-3)).unwrap();
        live.picture.load(frame, &photo).unwrap();
        for (ghosts, hold) in [(&ghosts, false), (&ghosts, true), (&other, false)] {
            live.picture.field.set_scene(&by(ghosts)).unwrap();
            if hold {
                live.picture.field.hold(frame).unwrap();
            }
            live.picture.draw(frame, &settings).unwrap();
            let mut picture = photo.clone();
            live.picture.fetch(frame, &mut picture).unwrap();
            pictures.push(picture);
        }
        assert_eq!(bits(&pictures[0]), bits(&pictures[1]));
        // What takes too long for one draw is held by several.
        live.picture.field.set_tile_pixels(100);
        live.picture.field.set_scene(&by(&ghosts)).unwrap();
        live.picture.field.hold(frame).unwrap();
        live.picture.field.set_tile_pixels(usize::MAX);
        live.picture.draw(frame, &settings).unwrap();
        let mut picture = photo.clone();
        live.picture.fetch(frame, &mut picture).unwrap();
        assert_eq!(bits(&pictures[0]), bits(&picture), "in bands");
        assert_ne!(bits(&pictures[1]), bits(&pictures[2]), "another scene lets go of the field");
    });
}

#[test]
fn a_mixed_view_is_that_of_the_picture() {
    let frame = Frame::full(60, 40);
    let photo: Vec<_> = (0..60 * 40u32).map(|k| [(k * 7919 % 100) as f32 / 200.0, 0.1, 0.3, 1.0]).collect();
    let scenes = [[0.3, -0.2], [-0.4, 0.5]].map(|center| [scenes::one(center, 0.4, [0.5, 0.25, 1.0])]);
    let places = [(1.0, 0.0, 60), (0.4, 7.25, 80), (2.5, -3.0, 40), (14.0, -100.0, 30)];
    on_live(Backend::ALL[0], |live| {
        live.picture.load(frame, &photo).unwrap();
        for ghosts in &scenes {
            live.picture.field.set_scene(&plan(ghosts, frame, &Request::new(1e-3)).unwrap()).unwrap();
            for normalize in [Normalize::None, Normalize::Minmax] {
                for (part, wipe) in
                    [(Part::Picture, 0.0), (Part::Picture, 11.0), (Part::Glare, 0.0), (Part::Glare, 9.0)]
                {
                    let settings = Settings { strength: 0.6, normalize, ..Settings::default() };
                    match part {
                        Part::Picture => live.picture.draw(frame, &settings).unwrap(),
                        Part::Glare => live.picture.draw_glare(frame, &settings).unwrap(),
                    }
                    for (pitch, at, side) in places {
                        let screen = Screen::hidden(live.picture.field.device(), [side + 5, side + 3]).unwrap();
                        let region = Region { x: 4, y: 1, width: side, height: side };
                        let view = View { pitch, origin: DVec2::splat(at), wipe, ..view() };
                        screen.clear([0.0; 3]);
                        live.view(&view, &screen, region).unwrap();
                        let drawn = screen.read();
                        screen.clear([0.0; 3]);
                        live.view_mixed(frame, &settings, part, &view, &screen, region).unwrap();
                        let off = |(a, b): (&[u8; 4], &[u8; 4])| (0..4).map(|c| a[c].abs_diff(b[c])).max();
                        let worst = drawn.iter().zip(&screen.read()).filter_map(off).max().unwrap();
                        assert!(worst <= 1, "{part:?} {normalize:?} wipe {wipe} pitch {pitch}: {worst} codes apart");
                    }
                }
            }
        }
    });
}

#[test]
fn a_coarse_field_lies_where_the_fine_one_does() {
    let (frame, coarse) = (Frame::full(121, 80), Frame::full(61, 40));
    let photo = vec![[0.02, 0.05, 0.1, 1.0]; 121 * 80];
    // Off the centre both ways, so that a field upside down or shifted is seen.
    let ghosts = [scenes::one([0.7, -0.4], 0.5, [0.3, 0.2, 0.1])];
    on_live(Backend::ALL[0], |live| {
        live.picture.load(frame, &photo).unwrap();
        for pitch in [0.5, 1.0, 1.7] {
            let screen =
                Screen::hidden(live.picture.field.device(), [(121.0 / pitch) as u32, (80.0 / pitch) as u32]).unwrap();
            let [fine, rough] = [frame, coarse].map(|frame| {
                live.picture.field.set_scene(&plan(&ghosts, frame, &Request::new(1e-3)).unwrap()).unwrap();
                let (view, settings) = (View { pitch, ..view() }, Settings::default());
                live.view_mixed(frame, &settings, Part::Picture, &view, &screen, screen.whole()).unwrap();
                screen.read()
            });
            let off = |(a, b): (&[u8; 4], &[u8; 4])| (0..3).map(|c| a[c].abs_diff(b[c])).max();
            let worst = fine.iter().zip(&rough).filter_map(off).max().unwrap();
            let spread =
                fine.iter().map(|pixel| pixel[0]).max().unwrap() - fine.iter().map(|pixel| pixel[0]).min().unwrap();
            assert!(worst <= 6 && spread > 60, "pitch {pitch}: {worst} codes apart of {spread}");
        }
    });
}

#[test]
fn the_mask_marks_what_the_search_takes_for_light() {
    // A lamp of two pixels, a firefly, a pixel that its alpha hides, one of negative luminance, and one not finite.
    let mut photo = vec![[0.2, 0.2, 0.2, 1.0]; 9 * 5];
    for (index, pixel) in [
        (10, [80.0, 80.0, 80.0, 1.0]),
        (11, [60.0, 60.0, 60.0, 1.0]),
        (14, [2e4, 2e4, 2e4, 1.0]),
        (16, [80.0, 80.0, 80.0, 0.01]),
        (17, [70.0, 70.0, 70.0, 0.01]),
        (30, [0.0, 0.0, 500.0, 1.0]),
        (32, [f32::INFINITY, 80.0, 80.0, 1.0]),
        (34, [f32::NAN, 80.0, 80.0, 1.0]),
    ] {
        photo[index] = pixel;
    }
    let frame = Frame::full(9, 5);
    let marked = |live: &mut Live, emission, firefly_limit| -> Vec<usize> {
        live.picture.load(frame, &photo).unwrap();
        let screen = Screen::hidden(live.picture.field.device(), [9, 5]).unwrap();
        screen.clear([0.0; 3]);
        let mask = Mask { threshold: 2.0, firefly_limit, emission, origin: DVec2::ZERO, pitch: 1.0 };
        live.mask(&mask, &screen, screen.whole()).unwrap();
        screen.read().iter().enumerate().filter(|(_, pixel)| pixel[0] > 0).map(|(index, _)| index).collect()
    };
    let weights = [0.3, 0.9, -0.2];
    let premultiplied: Emission = weights.into();
    let straight = Emission { straight: true, ..premultiplied };
    on_live(Backend::ALL[0], |live| {
        for (emission, limit, expected) in [
            (premultiplied, 5000.0, &[10, 11, 16, 17][..]),
            (premultiplied, 0.0, &[10, 11, 14, 16, 17]),
            (straight, 5000.0, &[10, 11]),
        ] {
            assert_eq!(marked(live, emission, limit), expected, "{emission:?} {limit}");
            let options =
                FindOptions { by: emission.by, threshold: Some(2.0), firefly_limit: limit, ..FindOptions::default() };
            let found = find(&photo, &frame, emission, &options);
            assert_eq!(found.fireflies, usize::from(limit > 0.0));
        }
    });
}

#[test]
fn what_is_laid_over_is_a_weighted_sum_in_the_picture_in_the_glare_and_in_every_view() {
    let frame = Frame::full(60, 40);
    let photo: Vec<_> = (0..60 * 40u32).map(|k| [(k * 7919 % 100) as f32 / 200.0, 0.1, 0.3, 0.5]).collect();
    let ghosts = [scenes::one([0.3, -0.2], 0.4, [0.2, 0.1, 0.3])];
    let layer = |seed: u32| -> Vec<[f32; 4]> {
        let value = |k: u32| (k.wrapping_mul(seed) % 97) as f32 / 97.0;
        (0..60 * 40).map(|k| [value(k), value(k + 7) - 0.3, value(k * 3), 9.0]).collect()
    };
    let layers: Vec<_> = [7919, 104_729, 1_299_709, 15_485_863].map(layer).into();
    let weights = [[0.25, 0.0, 1.0], [0.5; 3], [-0.125, 0.25, 0.125], [0.0625, 1.5, 0.5]];
    for backend in Backend::ALL {
        on_live(backend, |live| {
            live.picture.load(frame, &photo).unwrap();
            live.picture.field.set_scene(&plan(&ghosts, frame, &Request::new(1e-3)).unwrap()).unwrap();
            let without = live.picture.glare(frame, &Settings::default()).unwrap();
            for count in [4, 1, 3, 0] {
                live.picture.lay_over(&layers[..count]).unwrap();
                let mut settings = Settings::default();
                settings.overlay[..count].copy_from_slice(&weights[..count]);
                for part in [Part::Picture, Part::Glare] {
                    match part {
                        Part::Picture => live.picture.draw(frame, &settings).unwrap(),
                        Part::Glare => live.picture.draw_glare(frame, &settings).unwrap(),
                    }
                    let mut drawn = photo.clone();
                    live.picture.fetch(frame, &mut drawn).unwrap();
                    for (at, drawn) in drawn.iter().enumerate() {
                        for channel in 0..3 {
                            let below = if part == Part::Picture { photo[at][channel] } else { 0.0 };
                            let laid = layers[..count].iter().zip(weights);
                            let laid: f64 =
                                laid.map(|(layer, weight)| weight[channel] * f64::from(layer[at][channel])).sum();
                            let wanted = f64::from(below) + f64::from(without[at][channel]) + laid;
                            assert!((f64::from(drawn[channel]) - wanted).abs() < 1e-6, "{backend} {count} {part:?}");
                        }
                        assert_eq!(drawn[3], if part == Part::Picture { 0.5 } else { 1.0 });
                    }
                    for (pitch, at, wipe) in [(1.0, 0.0, 0.0), (0.4, 7.25, 11.0), (2.5, -3.0, 0.0), (14.0, -100.0, 0.0)]
                    {
                        let screen = Screen::hidden(live.picture.field.device(), [45, 35]).unwrap();
                        let view = View { pitch, origin: DVec2::splat(at), wipe, ..view() };
                        live.view(&view, &screen, screen.whole()).unwrap();
                        let drawn = screen.read();
                        live.view_mixed(frame, &settings, part, &view, &screen, screen.whole()).unwrap();
                        let off = |(a, b): (&[u8; 4], &[u8; 4])| (0..4).map(|c| a[c].abs_diff(b[c])).max();
                        let worst = drawn.iter().zip(&screen.read()).filter_map(off).max().unwrap();
                        assert!(worst <= 1, "{backend} {count} {part:?} pitch {pitch}: {worst} codes apart");
                    }
                }
            }
            // What goes back to the CPU has nothing laid over it.
            live.picture.lay_over(&layers).unwrap();
            let settings = Settings { overlay: weights, ..Settings::default() };
            assert_eq!(bits(&live.picture.glare(frame, &settings).unwrap()), bits(&without));
        })
    }
}
