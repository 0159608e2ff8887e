use super::*;
use crate::choices::LightBy;

const REC709: Emission = Emission { weights: [0.2126, 0.7152, 0.0722], by: LightBy::Luminance, straight: false };

/// A picture of rows by a function of column and row.
fn picture(width: u32, height: u32, of: impl Fn(f64, f64) -> [f32; 3]) -> (Vec<[f32; 4]>, Frame) {
    let pixel = |at: u32| {
        let [r, g, b] = of(f64::from(at % width), f64::from(at / width));
        [r, g, b, 1.0]
    };
    ((0..width * height).map(pixel).collect(), Frame::full(width, height))
}

/// A lamp as a display shows it: it grows to white and beyond, red where it is not clipped.
fn lamp(width: u32, height: u32) -> (Vec<[f32; 4]>, Frame) {
    let [x0, y0] = [width, height].map(|side| 0.5 * f64::from(side - 1));
    picture(width, height, |x, y| {
        let far = (x - x0).hypot(y - y0);
        let light = 40.0 * (-(far / 12.0).powi(2)).exp();
        [1.0, 0.25, 0.125].map(|tint| (0.02 + tint * light).min(1.0) as f32)
    })
}

fn display(pixels: &[[f32; 4]], frame: &Frame, by: Recover) -> Recovered {
    recover(pixels, frame, REC709, true, by)
}

fn luminance(pixel: &[f32; 4]) -> f32 {
    REC709.luminance(pixel)
}

#[test]
fn highlights_grow_inwards_from_the_rim_without_a_jump() {
    let (pixels, frame) = lamp(401, 401);
    let recovered = display(&pixels, &frame, Recover::Stops(4.0));
    let shining = recovered.over(&pixels);
    let row = |pixels: &[[f32; 4]]| pixels[200 * 401..][..201].to_vec();
    let (shown, shining) = (row(&pixels), row(shining));
    for x in 1..=200 {
        let (before, here) = (luminance(&shining[x - 1]), luminance(&shining[x]));
        assert!(here >= before * (1.0 - 1e-6), "{x}: {here} is less than {before}");
        // 4 stops over 4 pixels, and what the lamp has itself: red, it is clipped before it is white.
        let itself = luminance(&shown[x]) / luminance(&shown[x - 1]);
        assert!(here / before <= 2.01 * itself, "{x}: {before} {here}");
        for channel in 0..3 {
            assert!(shining[x][channel] >= shown[x][channel] && shining[x][channel].is_finite());
        }
    }
    let middle = luminance(&shining[200]) / luminance(&shown[200]);
    assert!((middle / 16.0 - 1.0).abs() < 1e-5, "{middle}");
    // Where nothing is clipped, nothing changes.
    let told = recovered.told.clone().unwrap();
    let same = shown.iter().zip(&shining).filter(|(shown, shining)| shown == shining).count();
    assert!(same > 150 && shown.iter().take(150).eq(shining.iter().take(150)));
    assert!((told.stops - 4.0).abs() < 1e-6 && told.pixels > 300 && told.share > 0.5, "{told:?}");
    assert_eq!(told.note, None);
}

#[test]
fn the_white_core_of_a_red_lamp_shines_red() {
    let (pixels, frame) = lamp(401, 401);
    let recovered = display(&pixels, &frame, Recover::Stops(6.0));
    let [r, g, b, _] = recovered.over(&pixels)[200 * 401 + 200];
    assert_eq!(pixels[200 * 401 + 200][..3], [1.0; 3]);
    assert!(r > 2.0 * g && g > b && b >= 1.0, "{r} {g} {b}");
    // Of a lamp with a dark sky about it nothing is known but itself.
    let (disc, frame) = picture(200, 200, |x, y| {
        let inside = (x - 100.0).hypot(y - 100.0) < 20.0;
        if inside { [1.0, 1.0, 1.0] } else { [0.0, 0.01, 0.1] }
    });
    let [r, g, b, _] = display(&disc, &frame, Recover::Stops(6.0)).over(&disc)[100 * 200 + 100];
    assert!((r / 64.0 - 1.0).abs() < 1e-5 && r == g && g == b, "{r} {g} {b}");
}

#[test]
fn a_turned_picture_shines_as_the_picture_does() {
    let (width, height) = (90u32, 61);
    let chance = |x: f64, y: f64| ((x * 12.9898 + y * 78.233).sin() * 43758.5453).fract().abs() as f32;
    let of = |x: f64, y: f64| {
        let blob = (x - 30.0).hypot(y - 20.0) < 9.0 || (x - 60.0).abs() + (y - 44.0).abs() < 12.0;
        let noise = 0.08 * chance(x, y);
        if blob { [1.0, 1.0 - noise, 1.0 - noise] } else { [0.4 + noise, 0.3, 8.0 * noise] }
    };
    let (pixels, frame) = picture(width, height, of);
    let (turned, turned_frame) = picture(height, width, |x, y| of(y, f64::from(height) - 1.0 - x));
    for by in [Recover::Auto, Recover::Stops(5.0)] {
        let (one, other) = (display(&pixels, &frame, by), display(&turned, &turned_frame, by));
        let (one, other) = (one.over(&pixels), other.over(&turned));
        assert!(one != pixels);
        for y in 0..width as usize {
            for x in 0..height as usize {
                let (turned, upright) =
                    (other[y * height as usize + x], one[(height as usize - 1 - x) * width as usize + y]);
                let close = turned.iter().zip(upright).all(|(a, b)| (a / b - 1.0).abs() < 1e-5 || *a == b);
                assert!(close, "{x}, {y}: {turned:?} {upright:?}");
            }
        }
    }
}

#[test]
fn a_picture_without_a_rim_stays_and_is_told() {
    for (width, height) in [(1, 1), (7, 3), (1, 40)] {
        let (pixels, frame) = picture(width, height, |_, _| [1.0; 3]);
        for by in [Recover::Auto, Recover::Stops(3.0)] {
            let recovered = display(&pixels, &frame, by);
            assert!(!recovered.is_other() && recovered.over(&pixels) == pixels);
            let told = recovered.told.unwrap();
            assert!((told.pixels, told.clipped) == (0, (width * height) as usize) && told.note.is_some());
            assert!(told.to_string().starts_with("nothing of "), "{told}");
        }
    }
}

#[test]
fn what_is_no_number_or_hidden_is_not_clipped_and_stays() {
    let (mut pixels, frame) = picture(40, 30, |x, _| if x > 20.0 { [1.0; 3] } else { [0.5; 3] });
    let odd = [
        [f32::NAN, 1.0, 1.0, 1.0],
        [f32::INFINITY, 1.0, 1.0, 1.0],
        [1.0, f32::NEG_INFINITY, 1.0, 1.0],
        [-1.0, -2.0, -3.0, 1.0],
        [1.0, 1.0, 1.0, 0.0],
    ];
    for (k, &odd) in odd.iter().enumerate() {
        pixels[10 * 40 + 25 + 2 * k] = odd;
    }
    let straight = Emission { straight: true, ..REC709 };
    let recovered = recover(&pixels, &frame, straight, true, Recover::Stops(4.0));
    let shining = recovered.over(&pixels);
    for (k, odd) in odd.iter().enumerate() {
        let same = shining[10 * 40 + 25 + 2 * k].map(f32::to_bits) == odd.map(f32::to_bits);
        assert!(same, "{odd:?} became {:?}", shining[10 * 40 + 25 + 2 * k]);
    }
    assert!(shining[20 * 40 + 38][0] > 15.0 && shining.iter().all(|pixel| pixel[3] == 1.0 || pixel[3] == 0.0));
    // A negative channel of a clipped pixel neither becomes more nor less.
    let (mut wide, frame) = picture(40, 30, |x, _| if x > 20.0 { [1.2, 1.1, -0.1] } else { [0.5; 3] });
    wide[0] = [1e-30, f32::MAX, 1.0, 1.0];
    let recovered = display(&wide, &frame, Recover::Stops(20.0));
    assert!(recovered.over(&wide).iter().flatten().all(|value| value.is_finite()));
}

#[test]
fn noise_in_a_lamp_is_no_rim_and_one_clipped_channel_is_little() {
    let disc = |x: f64, y: f64| (x - 100.0).hypot(y - 100.0) < 30.0;
    let (pixels, frame) = picture(200, 200, |x, y| match disc(x, y) {
        true if (x * 7.0 + y * 3.0) % 11.0 == 0.0 => [0.93, 0.92, 0.91],
        true => [1.0; 3],
        false => [0.1; 3],
    });
    let recovered = display(&pixels, &frame, Recover::Stops(4.0));
    let dimmest = (90..110).map(|x| luminance(&recovered.over(&pixels)[100 * 200 + x])).fold(f32::MAX, f32::min);
    assert!(dimmest > 10.0, "{dimmest}");
    // A sky that is blue at the end of the scale is not sixteen times as bright.
    let (sky, frame) = picture(200, 200, |x, y| if disc(x, y) { [0.2, 0.5, 1.0] } else { [0.2, 0.5, 0.9] });
    let recovered = display(&sky, &frame, Recover::Stops(4.0));
    let times = luminance(&recovered.over(&sky)[100 * 200 + 100]) / luminance(&[0.2, 0.5, 1.0, 1.0]);
    assert!((1.5..2.0).contains(&times), "{times}");
}

#[test]
fn scene_linear_light_is_clipped_where_a_patch_reaches_the_maximum() {
    let (mut pixels, frame) = picture(300, 200, |x, y| match (x - 150.0).hypot(y - 100.0) {
        far if far < 20.0 => [60.0, 50.0, 40.0],
        far => [600.0 / far as f32 / far as f32; 3],
    });
    let by = Recover::Stops(3.0);
    let linear = |pixels: &[[f32; 4]], by| recover(pixels, &frame, REC709, false, by);
    assert!(!linear(&pixels, Recover::Auto).is_other() && !linear(&pixels, Recover::None).is_other());
    let recovered = linear(&pixels, by);
    let times = recovered.over(&pixels)[100 * 300 + 150][1] / 50.0;
    assert!((times - 8.0).abs() < 1e-3, "{times}");
    // A firefly is no maximum, and neither is a pixel that is brighter than the patch.
    pixels[5 * 300 + 5] = [1e9; 4];
    assert!(linear(&pixels, by).is_other());
    pixels[100 * 300 + 150] = [70.0; 4];
    assert!(!linear(&pixels, by).is_other());
    assert!(!linear(&vec![[0.0; 4]; 60_000], by).is_other());
}

#[test]
fn auto_knows_lamps_from_skies() {
    let of = |share: f64, around: f32| {
        let side = (200.0 * share.sqrt()).round();
        let edge = 0.5 * (200.0 - side);
        let inside = |v: f64| v >= edge.floor() && v < edge.floor() + side;
        let (pixels, frame) = picture(200, 200, |x, y| if inside(x) && inside(y) { [1.0; 3] } else { [around; 3] });
        display(&pixels, &frame, Recover::Auto).told.unwrap()
    };
    let lamp = of(0.01, 0.1);
    assert!((lamp.stops - 8.0).abs() < 1e-6 && lamp.note.is_none(), "{lamp:?}");
    // A shirt in the sun, a sky, paper.
    let (shirt, sky, paper) = (of(0.01, 0.9), of(0.12, 0.1), of(0.7, 0.1));
    assert!(shirt.stops > 1.0 && shirt.stops < 2.0, "{shirt:?}");
    assert!((sky.stops - 4.0).abs() < 0.1 && sky.note.is_some(), "{sky:?}");
    assert!(paper.pixels == 0 && paper.note.unwrap().contains("70 % of the picture is clipped"));
    assert_eq!(lamp.to_string(), "400 clipped pixels shine up to 256 times as bright, which is 94 % of all light");
}

#[test]
fn it_is_read_as_it_is_written() {
    for recover in [Recover::Auto, Recover::None, Recover::Stops(0.0), Recover::Stops(4.25)] {
        assert_eq!(recover.to_string().parse(), Ok(recover));
    }
    for bad in ["", "Auto", "-1", "20.5", "nan", "inf", "4 stops"] {
        let refused = bad.parse::<Recover>().unwrap_err();
        assert!(refused.contains("a number of stops from 0 to 20"), "{bad}: {refused}");
    }
}
