//! Small files of all kinds of TIFF, of tests/inputs, against the closed form that they were made from.
//!
//! tifffile 2026.3.3 with imagecodecs 2026.3.6 wrote most of them, Pillow and libtiff 4.5.0 the faxes, JPEG and LogLuv;
//! the rest was put together by hand. All but the last few hold the picture that `value` gives, 13 × 9.

use std::path::Path;

use vglare::photo::{self, Alpha, Depth, Photo};

fn read(name: &str) -> Photo {
    photo::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs").join(format!("tiff-{name}.tif"))).unwrap()
}

/// Channel `c` at column `x` and row `y`, 0..1.
fn value(c: usize, x: usize, y: usize) -> f64 {
    let (x, y, c) = (x as f64, y as f64, c as f64);
    ((x / 7.0 + c).sin() + (y / 5.0 * (c + 1.0)).cos() + 2.0) / 4.0
}

fn srgb_light(v: f64) -> f64 {
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// Asserts that all pixels are within `tolerance` of `want` at (x, y).
fn check(name: &str, photo: &Photo, tolerance: f64, want: impl Fn(usize, usize) -> [f64; 3]) {
    assert_eq!((photo.width(), photo.height()), (13, 9), "{name}");
    for (i, pixel) in photo.pixels.iter().enumerate() {
        let (x, y) = (i % 13, i / 13);
        let want = want(x, y);
        let near = (0..3).all(|c| (f64::from(pixel[c]) - want[c]).abs() <= tolerance);
        assert!(near, "{name} at ({x}, {y}): {pixel:?} for {want:?}");
    }
}

/// RGB or, with one channel, grey, of integers up to `top`; the light is exact to the rounding of f32.
fn check_codes(name: &str, channels: usize, top: f64, depth: Depth) -> Photo {
    let photo = read(name);
    assert!(photo.source.display_referred && photo.source.depth == depth && photo.source.grey == (channels == 1));
    check(name, &photo, 1e-6, |x, y| {
        [0, 1, 2].map(|c| srgb_light((value(c.min(channels - 1), x, y) * top).round() / top))
    });
    photo
}

#[test]
fn spare_channels_are_left_out_whatever_the_predictor() {
    let photo = check_codes("lzw-spare-channel", 3, 255.0, Depth::Eight);
    assert_eq!(photo.source.alpha, Alpha::None);
    assert!(photo.source.notes[0].contains("a channel that is neither colour nor alpha"), "{:?}", photo.source.notes);
    let photo = check_codes("zip-spare-channel-and-alpha", 3, 65535.0, Depth::Sixteen);
    assert_eq!(photo.source.alpha, Alpha::Straight);
    assert!((f64::from(photo.pixels[0][3]) - value(4, 0, 0)).abs() < 1e-5, "alpha is the fifth channel");
    let photo = read("zip-float-two-spare-channels");
    check("zip-float", &photo, 3e-7, |x, y| [0, 1, 2].map(|c| 3.0 * value(c, x, y) - 0.2));
    assert!(photo.source.notes[0].contains("2 channels"), "{:?}", photo.source.notes);
}

#[test]
fn integers_of_all_depths_are_read() {
    check_codes("grey-1", 1, 1.0, Depth::Eight);
    check_codes("grey-4", 1, 15.0, Depth::Eight);
    check_codes("12-bit-predictor", 3, 4095.0, Depth::Sixteen);
    check_codes("14-bit", 1, 16383.0, Depth::Sixteen);
    check_codes("unsigned-32", 3, 4_294_967_295.0, Depth::Sixteen);
    let photo = check_codes("signed-16", 3, 32767.0, Depth::Sixteen);
    assert!(photo.source.notes[0].contains("signed"), "{:?}", photo.source.notes);
}

#[test]
fn floats_of_all_depths_are_linear() {
    for (name, channels, tolerance, depth) in [
        // Half a step of the mantissa below 4.
        ("half", 3, 2.0_f64.powi(-10), Depth::Half),
        ("half-grey", 1, 2.0_f64.powi(-10), Depth::Half),
        ("float-24", 3, 2.0_f64.powi(-16), Depth::Float),
        ("double", 3, 2.0_f64.powi(-23), Depth::Float),
    ] {
        let photo = read(name);
        assert_eq!((photo.source.depth, photo.source.display_referred), (depth, false), "{name}");
        check(name, &photo, tolerance, |x, y| [0, 1, 2].map(|c| 3.0 * value(c.min(channels - 1), x, y) - 0.2));
    }
}

#[test]
fn compressions_planes_and_orders_of_bits_are_read() {
    for name in ["zstd", "webp", "packbits"] {
        check_codes(name, 3, 255.0, Depth::Eight);
    }
    check_codes("planar-tiles-big-endian", 3, 65535.0, Depth::Sixteen);
    check_codes("lowest-bit-first-16", 3, 65535.0, Depth::Sixteen);
    check_codes("old-lzw", 1, 255.0, Depth::Eight);
    for name in ["fax-group3", "fax-group4"] {
        check(name, &read(name), 0.0, |x, y| [((x / 3 + y / 4) % 2) as f64; 3]);
    }
    // A decoder's freedom: two codes.
    check("jpeg-grey", &read("jpeg-grey"), 0.02, |x, y| [srgb_light(value(0, x, y)); 3]);
    let photo = read("jpeg-ycbcr");
    assert_eq!((photo.width(), photo.height()), (32, 16));
    let blue = [40.0, 80.0, 200.0].map(|code: f64| srgb_light(code / 255.0));
    for (pixel, want) in [(photo.pixels[4], [1.0, 0.0, 0.0]), (photo.pixels[32 * 15 + 28], blue)] {
        assert!((0..3).all(|c| (f64::from(pixel[c]) - want[c]).abs() < 0.02), "{pixel:?} for {want:?}");
    }
}

#[test]
fn palettes_inks_and_differences_become_colours() {
    // Pillow leaves the lower bytes of its palettes 0.
    for name in ["palette-4", "palette-upper-bytes"] {
        check(name, &read(name), 1e-6, |x, y| {
            let index = ((3 * x + 5 * y) % 16) as f64;
            [index * 17.0, 255.0 - index * 17.0, 51.0].map(|code| srgb_light(code / 255.0))
        });
    }
    // Inks (0.5, 0, 1, 0) under alpha 128, any under 0, and (1, 0, 0, 0.2) under 255.
    let photo = read("cmyk-associated-alpha");
    assert_eq!(photo.source.alpha, Alpha::Premultiplied);
    let alpha = 128.0 / 255.0;
    let want = [[0.214_041 * alpha, alpha, 0.0], [0.0; 3], [0.0, 0.603_827, 0.603_827]];
    for (pixel, want) in photo.pixels.iter().zip(want) {
        assert!((0..3).all(|c| (pixel[c] - want[c]).abs() < 1e-6), "{pixel:?} for {want:?}");
    }
    let photo = read("cmyk");
    let code = |c: usize, x: usize, y: usize| (value(c, x, y) * 255.0).round() / 255.0;
    check("cmyk", &photo, 1e-6, |x, y| [0, 1, 2].map(|c| srgb_light((1.0 - code(c, x, y)) * (1.0 - code(3, x, y)))));
    assert!(photo.source.notes[0].contains("CMYK"), "{:?}", photo.source.notes);
    // To two codes of 8 bit: white, black, and a full ink of which the profile says L*a*b* 50.196, 20, −30: (0.2361, 0.1515, 0.4072).
    let photo = read("cmyk-profile");
    for (pixel, want) in photo.pixels.iter().zip([[1.0; 3], [0.0; 3], [0.2361, 0.1515, 0.4072]]) {
        assert!((0..3).all(|c| (pixel[c] - want[c]).abs() < 1e-2), "{pixel:?} for {want:?}");
    }
    assert!(photo.source.notes[0].contains("through its ICC profile"), "{:?}", photo.source.notes);
    // TIFF 6.0, section 21, with the shares of BT.601; one Cb and Cr to four pixels.
    check("ycbcr", &read("ycbcr-subsampled"), 1e-6, |x, y| {
        let luma = (value(0, x, y) * 255.0).round();
        let (cb, cr) = (100.0 + 5.0 * (y / 2) as f64 - 128.0, 110.0 + 4.0 * (x / 2) as f64 - 128.0);
        let (r, b) = (luma + 1.402 * cr, luma + 1.772 * cb);
        let g = (luma - 0.299 * r - 0.114 * b) / 0.587;
        [r, g, b].map(|code| srgb_light((code / 255.0).clamp(0.0, 1.0)))
    });
    // White, the grey of L* 50 (Y = (66/116)³), and sRGB's red, L*a*b* 54.29, 80.80, 69.89 in D50.
    let grey = (66.0_f64 / 116.0).powi(3) as f32;
    for (pixel, want) in read("cielab-16").pixels.iter().zip([[1.0; 3], [grey; 3], [1.0, 0.0, 0.0]]) {
        assert!((0..3).all(|c| (pixel[c] - want[c]).abs() < 2e-4), "{pixel:?} for {want:?}");
    }
}

#[test]
fn logarithms_are_light() {
    let photo = read("logl");
    assert_eq!((photo.source.depth, photo.source.display_referred), (Depth::Float, false));
    for (i, pixel) in photo.pixels.iter().enumerate() {
        let want = value(0, i % 13, i / 13) * 300.0 + 0.01;
        assert!((f64::from(pixel[0]) / want - 1.0).abs() < 0.0014, "half a step of 2^(1/256): {pixel:?} for {want}");
    }
    // u' and v' have steps of 1/410: 4 % of the brightest channel.
    for (i, pixel) in read("logluv").pixels.iter().enumerate() {
        let want = [0, 1, 2].map(|c| value(c, i % 13, i / 13) * 20.0 + 0.05);
        let brightest = want.iter().fold(0.0_f64, |a, &b| a.max(b));
        assert!((0..3).all(|c| (f64::from(pixel[c]) - want[c]).abs() < 0.04 * brightest), "{pixel:?} for {want:?}");
    }
}

#[test]
fn the_photo_is_the_first_picture_that_is_no_copy() {
    let photo = check_codes("thumbnail-first", 3, 255.0, Depth::Eight);
    assert_eq!(photo.source.picture.as_deref(), Some("page 2"));
    check_codes("picture-below-thumbnail", 3, 255.0, Depth::Eight);
    let photo = check_codes("two-pages", 3, 255.0, Depth::Eight);
    assert_eq!(photo.source.picture.as_deref(), Some("page 1"));
    assert!(photo.source.notes[0].contains("holds 2 pictures"), "{:?}", photo.source.notes);
}
