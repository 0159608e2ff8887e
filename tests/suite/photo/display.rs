//! PNG, JPEG and TIFF: display light decoded, encoded, and left alone where nothing changed.

use std::fs::File;
use std::path::Path;

use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::PngEncoder;
use image::metadata::Orientation;
use image::{ExtendedColorType, ImageEncoder};
use moxcms::ColorProfile;
use vglare::photo::{self, Alpha, Depth, Photo, ToneMap, WriteOptions};

use super::{Folder, asymmetric, with_depth};

const ALPHA_8: [ExtendedColorType; 4] =
    [ExtendedColorType::L8, ExtendedColorType::La8, ExtendedColorType::Rgb8, ExtendedColorType::Rgba8];
const ALPHA_16: [ExtendedColorType; 4] =
    [ExtendedColorType::L16, ExtendedColorType::La16, ExtendedColorType::Rgb16, ExtendedColorType::Rgba16];

fn put_png(path: &Path, data: &[u8], width: u32, colour: ExtendedColorType) {
    let height = (data.len() * 8 / usize::from(colour.bits_per_pixel())) as u32 / width;
    PngEncoder::new(File::create(path).unwrap()).write_image(data, width, height, colour).unwrap();
}

fn png_bytes(path: &Path) -> Vec<u8> {
    let mut reader = png::Decoder::new(std::io::BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    bytes
}

#[test]
fn integers_come_back_as_they_were() {
    let folder = Folder::new();
    let (path, again, tiff) = (folder.path("a.png"), folder.path("b.png"), folder.path("c.tif"));
    // Every code in every place; for 16 bit every high byte with varied low bytes.
    let data: Vec<u8> = (0..256 * 48_u32).map(|i| (i % 256 * 7 + i / 256 * 11) as u8).collect();
    for colour in ALPHA_8.into_iter().chain(ALPHA_16) {
        put_png(&path, &data, 32, colour);
        let photo = photo::read(&path).unwrap();
        let overwrite = WriteOptions { overwrite: true, ..Default::default() };
        photo::write(&again, &photo, &overwrite).unwrap();
        assert_eq!(png_bytes(&again), png_bytes(&path), "{colour:?}");
        photo::write(&tiff, &photo, &WriteOptions { depth: Some(photo.source.depth), ..overwrite }).unwrap();
        let back = photo::read(&tiff).unwrap();
        assert_eq!(back.pixels, photo.pixels, "{colour:?}");
        assert_eq!(back.source.alpha, photo.source.alpha, "{colour:?}");
    }
}

#[test]
fn jpeg_is_near() {
    let folder = Folder::new();
    let photo = folder.round_trip("a.png", &asymmetric(16, 9));
    let back = folder.round_trip("a.jpg", &photo);
    assert_eq!((back.width(), back.height(), back.source.depth), (16, 9, Depth::Eight));
    for (got, want) in back.pixels.iter().zip(&photo.pixels) {
        assert!((0..3).all(|c| (got[c].sqrt() - want[c].sqrt()).abs() < 0.06), "{got:?} for {want:?}");
    }
}

/// What EXIF holds at least: little-endian, one entry, the orientation.
fn exif(orientation: Orientation) -> Vec<u8> {
    let mut chunk = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0".to_vec();
    chunk.extend([orientation.to_exif(), 0, 0, 0, 0, 0, 0, 0]);
    chunk
}

#[test]
fn pictures_are_turned_upright() {
    let folder = Folder::new();
    let data: Vec<u8> = (0..24 * 16 * 3).map(|i| if i % 3 == 0 { (i / 3 % 24 * 10) as u8 } else { 90 }).collect();
    let turn = Orientation::Rotate90;
    let mut png = PngEncoder::new(File::create(folder.path("a.png")).unwrap());
    png.set_exif_metadata(exif(turn)).unwrap();
    png.write_image(&data, 24, 16, ExtendedColorType::Rgb8).unwrap();
    let mut jpeg = JpegEncoder::new(File::create(folder.path("a.jpg")).unwrap());
    jpeg.set_exif_metadata(exif(turn)).unwrap();
    jpeg.write_image(&data, 24, 16, ExtendedColorType::Rgb8).unwrap();
    let mut tiff = tiff::encoder::TiffEncoder::new(File::create(folder.path("a.tif")).unwrap()).unwrap();
    let mut picture = tiff.new_image::<tiff::encoder::colortype::RGB8>(24, 16).unwrap();
    picture.encoder().write_tag(tiff::tags::Tag::Orientation, u16::from(turn.to_exif())).unwrap();
    picture.write_data(&data).unwrap();
    for name in ["a.png", "a.jpg", "a.tif"] {
        let photo = photo::read(&folder.path(name)).unwrap();
        assert_eq!((photo.width(), photo.height()), (16, 24), "{name}");
        // Red rises to the right; after a clockwise turn it rises downwards.
        let red = |x: usize, y: usize| photo.pixels[y * 16 + x][0];
        assert!(red(3, 20) > red(3, 10) && red(3, 10) > red(3, 2), "{name}");
        assert!((red(15, 12) - red(0, 12)).abs() < 0.05, "{name}");
    }
}

/// Full red of Display P3 in Rec.709, as published.
const P3_RED: [f32; 4] = [1.2249, -0.0420, -0.0197, 1.0];

#[test]
fn an_icc_profile_is_honoured() {
    let folder = Folder::new();
    let profile = ColorProfile::new_display_p3().encode().unwrap();
    let pixels = [255, 0, 0, 255, 255, 255, 128, 128, 128];
    let mut png = PngEncoder::new(File::create(folder.path("a.png")).unwrap());
    png.set_icc_profile(profile.clone()).unwrap();
    png.write_image(&pixels, 3, 1, ExtendedColorType::Rgb8).unwrap();
    let mut tiff = tiff::encoder::TiffEncoder::new(File::create(folder.path("a.tif")).unwrap()).unwrap();
    let mut picture = tiff.new_image::<tiff::encoder::colortype::RGB8>(3, 1).unwrap();
    picture.encoder().write_tag(tiff::tags::Tag::IccProfile, &profile[..]).unwrap();
    picture.write_data(&pixels).unwrap();
    for name in ["a.png", "a.tif"] {
        let photo = photo::read(&folder.path(name)).unwrap();
        let want = [P3_RED, [1.0; 4], [0.2159, 0.2159, 0.2159, 1.0]];
        for (got, want) in photo.pixels.iter().zip(want) {
            assert!(got.iter().zip(want).all(|(g, w)| (g - w).abs() < 1e-3), "{name}: {got:?} for {want:?}");
        }
    }
    let mut jpeg = JpegEncoder::new_with_quality(File::create(folder.path("a.jpg")).unwrap(), 100);
    jpeg.set_icc_profile(profile).unwrap();
    jpeg.write_image(&[255, 0, 0].repeat(64), 8, 8, ExtendedColorType::Rgb8).unwrap();
    let red = photo::read(&folder.path("a.jpg")).unwrap().pixels[9];
    assert!((red[0] - 1.2249).abs() < 0.02 && red[1] < -0.02, "{red:?}");
}

#[test]
fn a_palette_with_transparency_is_colours_with_alpha() {
    let folder = Folder::new();
    let mut encoder = png::Encoder::new(File::create(folder.path("a.png")).unwrap(), 2, 1);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::One);
    encoder.set_palette(vec![255, 0, 0, 0, 0, 255]);
    encoder.set_trns(vec![255, 51]);
    encoder.write_header().unwrap().write_image_data(&[0b0100_0000]).unwrap();
    let photo = photo::read(&folder.path("a.png")).unwrap();
    assert_eq!(photo.pixels, [[1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.2]]);
    assert_eq!((photo.source.alpha, photo.source.depth), (Alpha::Straight, Depth::Eight));
}

#[test]
fn png_gamma_is_honoured() {
    let folder = Folder::new();
    let put = |name: &str, gamma: u32| {
        let mut encoder = png::Encoder::new(File::create(folder.path(name)).unwrap(), 1, 1);
        encoder.set_source_gamma(png::ScaledFloat::from_scaled(gamma));
        encoder.set_color(png::ColorType::Grayscale);
        encoder.write_header().unwrap().write_image_data(&[128]).unwrap();
        photo::read(&folder.path(name)).unwrap().pixels[0][0]
    };
    let code = 128.0 / 255.0_f32;
    assert!((put("linear.png", 100_000) - code).abs() < 1e-6);
    assert!((put("mac.png", 55_556) - code.powf(1.8)).abs() < 1e-4);
    assert!((put("usual.png", 45_455) - 0.215_861).abs() < 1e-5, "1/2.2 means sRGB");
}

#[test]
fn alpha_goes_where_it_can() {
    let folder = Folder::new();
    let mut photo = asymmetric(3, 1);
    photo.source.alpha = Alpha::Straight;
    photo.pixels = vec![[0.5, 0.25, 1.0, 0.5], [1.0, 1.0, 1.0, 0.0], [0.2, 0.4, 0.6, 1.0]];
    let exr = folder.round_trip("a.exr", &photo);
    assert_eq!(exr.pixels, [[0.25, 0.125, 0.5, 0.5], [0.0; 4], [0.2, 0.4, 0.6, 1.0]]);
    assert_eq!(exr.source.alpha, Alpha::Premultiplied);
    let tiff = folder.round_trip("a.tif", &exr);
    assert_eq!((tiff.source.alpha, &tiff.pixels), (Alpha::Premultiplied, &exr.pixels));
    assert_eq!(folder.round_trip("b.tif", &photo).source.alpha, Alpha::Straight);
    assert_eq!(folder.round_trip("a.png", &photo).source.alpha, Alpha::Straight);
    for name in ["premultiplied.png", "a.jpg", "a.hdr", "a.pfm"] {
        assert_eq!(folder.round_trip(name, &exr).source.alpha, Alpha::None, "{name}");
    }
}

#[test]
fn tone_maps_and_exposure_are_for_scene_light_on_a_display() {
    let folder = Folder::new();
    let grey = Photo::new(1, 1, vec![[0.18, 0.18, 0.18, 1.0]]);
    let shown = |photo: &Photo, options: WriteOptions| {
        folder.round_trip_as("a.png", photo, WriteOptions { depth: Some(Depth::Sixteen), ..options }).pixels[0][1]
    };
    let plain = WriteOptions { tone_map: Some(ToneMap::None), ..Default::default() };
    assert!((shown(&grey, plain) - 0.18).abs() < 1e-4);
    assert!((shown(&grey, WriteOptions { exposure: 1.0, ..plain }) - 0.36).abs() < 1e-4);
    let agx = WriteOptions { tone_map: Some(ToneMap::Agx), ..Default::default() };
    assert_eq!(shown(&grey, WriteOptions::default()), shown(&grey, agx), "scene light gets AgX by default");
    let display = folder.round_trip_as("b.png", &grey, WriteOptions { depth: Some(Depth::Sixteen), ..plain });
    assert_eq!(shown(&display, WriteOptions::default()), display.pixels[0][1], "display light gets none");
}

#[test]
fn undefined_pixels_are_black_and_infinite_ones_white() {
    let folder = Folder::new();
    let odd = |v: f32| [v, v, v, 1.0];
    let photo = Photo::new(4, 1, [f32::NAN, f32::NEG_INFINITY, -0.5, f32::INFINITY].map(odd).to_vec());
    for name in ["a.png", "a.tif", "a.jpg"] {
        for map in [ToneMap::None, ToneMap::Reinhard, ToneMap::Aces, ToneMap::Agx] {
            let options = WriteOptions { tone_map: Some(map), ..with_depth(Depth::Eight) };
            let got = folder.round_trip_as(name, &photo, options).pixels;
            // JPEG may ring a little.
            assert!(got[..3].iter().all(|p| p[1] < 2e-3) && got[3][1] > 0.97, "{name} {map:?}: {got:?}");
        }
    }
}
