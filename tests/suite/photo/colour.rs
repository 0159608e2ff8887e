//! What a file says of its colours is honoured, or told; and what is written says what it is.

use std::borrow::Cow;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use image::ImageDecoder;
use moxcms::{ColorProfile, DataColorSpace};
use vglare::photo::{self, Depth, Photo, Primaries, ReadOptions, WriteOptions};

use super::damaged::crc32;
use super::{Folder, asymmetric, reason, with_depth};

fn input(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs").join(name)
}

/// A PNG of RGB with what `info` adds to it.
fn put_png(path: &Path, pixels: &[u8], info: impl FnOnce(&mut png::Info<'static>)) {
    let mut header = png::Info::with_size(pixels.len() as u32 / 3, 1);
    (header.color_type, header.bit_depth) = (png::ColorType::Rgb, png::BitDepth::Eight);
    info(&mut header);
    let encoder = png::Encoder::with_info(File::create(path).unwrap(), header).unwrap();
    encoder.write_header().unwrap().write_image_data(pixels).unwrap();
}

/// A PNG with a cICP chunk, which the encoder does not write.
fn put_code_points(path: &Path, pixels: &[u8], primaries: u8, transfer: u8) {
    put_png(path, pixels, |_| {});
    let mut bytes = std::fs::read(path).unwrap();
    let chunk = [b'c', b'I', b'C', b'P', primaries, transfer, 0, 1];
    // It stands behind the header.
    bytes.splice(33..33, [&4_u32.to_be_bytes()[..], &chunk, &crc32(&chunk).to_be_bytes()].concat());
    std::fs::write(path, bytes).unwrap();
}

fn near(got: [f32; 4], want: [f32; 3], tolerance: f32) {
    assert!((0..3).all(|c| (got[c] - want[c]).abs() <= tolerance), "{got:?} for {want:?}");
}

#[test]
fn profiles_of_gamma_18_are_honoured_down_to_black() {
    // In f64 from the profile's own numbers: gamma 1.8, ROMM's primaries, Bradford.
    let wants = [
        [0.0; 3],
        [2.034_367_5, -0.228_826_8, -0.008_558_424],
        [-0.517_055_2, 0.353_110_73, 1.117_524_6],
        [0.258_103, 0.055_900_62, -0.012_632_293],
        [1.0; 3],
        [0.289_049_2; 3],
    ];
    let photo = photo::read(&input("png-icc-gamma18.png")).unwrap();
    photo.pixels.iter().zip(wants).for_each(|(&got, want)| near(got, want, 1e-3));
    assert_eq!(photo.pixels[0][..3], [0.0; 3]);
    // (code / 255) ^ 1.8.
    let grey = photo::read(&input("png-icc-gamma18-grey.png")).unwrap();
    let wants = [0.0, 4.638_18e-5, 0.082_962_65, 0.289_049_2, 1.0];
    grey.pixels.iter().zip(wants).for_each(|(&got, want)| near(got, [want; 3], 1e-6));
}

#[test]
fn a_bad_profile_is_told_and_the_photo_read() {
    let photo = photo::read(&input("png-icc-cut-profile.png")).unwrap();
    // sRGB of code 130.
    near(photo.pixels[26], [0.223_227_96; 3], 1e-6);
    let [note] = &photo.source.notes[..] else { panic!("{:?}", photo.source.notes) };
    assert!(note.contains("ICC profile") && note.contains("sRGB"), "{note}");
}

#[test]
fn a_profile_that_swells_is_passed_over() {
    let folder = Folder::new();
    let path = folder.path("bomb.png");
    put_png(&path, &[130; 3], |info| info.icc_profile = Some(Cow::Owned(vec![0; 40 << 20])));
    assert!(path.metadata().unwrap().len() < 1 << 20);
    let photo = photo::read(&path).unwrap();
    near(photo.pixels[0], [0.223_227_96; 3], 1e-6);
    assert!(photo.source.notes[0].contains("ICC profile"), "{:?}", photo.source.notes);
}

#[test]
fn a_png_that_claims_gigabytes_is_refused() {
    let folder = Folder::new();
    let path = folder.round_trip_as("a.png", &asymmetric(21, 13), with_depth(Depth::Sixteen));
    assert_eq!(path.width(), 21);
    let mut bytes = std::fs::read(folder.path("a.png")).unwrap();
    bytes[16..24].copy_from_slice([20_000_u32.to_be_bytes(); 2].as_flattened());
    let text = reason(&folder.put("a.png", &bytes));
    assert!(text.contains("20000 × 20000") && text.contains("cut short"), "{text}");
}

#[test]
fn a_palette_whose_last_colour_is_cut_is_refused() {
    let folder = Folder::new();
    let path = folder.path("a.png");
    let mut encoder = png::Encoder::new(File::create(&path).unwrap(), 1, 1);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_palette(vec![255; 7]);
    encoder.write_header().unwrap().write_image_data(&[0]).unwrap();
    assert!(reason(&path).contains("palette is damaged"));
}

#[test]
fn code_points_of_png_are_honoured_or_told() {
    let folder = Folder::new();
    let read = |primaries, transfer| {
        let path = folder.path("a.png");
        put_code_points(&path, &[255, 0, 0], primaries, transfer);
        photo::read(&path).unwrap()
    };
    // Full red of Display P3 in Rec. 709, as published.
    let p3 = read(12, 13);
    near(p3.pixels[0], [1.2249, -0.0420, -0.0197], 1e-3);
    assert_eq!((p3.source.space.as_deref(), p3.source.notes.len()), (Some("Display P3"), 0));
    let unknown = read(12, 99);
    assert_eq!(unknown.pixels[0], [1.0, 0.0, 0.0, 1.0]);
    assert!(unknown.source.notes[0].contains("transfer function 99"), "{:?}", unknown.source.notes);
}

#[test]
fn an_animation_gives_its_still_picture() {
    let folder = Folder::new();
    let path = folder.path("a.png");
    let mut encoder = png::Encoder::new(File::create(&path).unwrap(), 1, 1);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_animated(2, 0).unwrap();
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[255]).unwrap();
    writer.write_image_data(&[0]).unwrap();
    writer.finish().unwrap();
    let photo = photo::read(&path).unwrap();
    assert_eq!(photo.pixels, [[1.0; 4]]);
    assert!(photo.source.notes[0].contains("animation of 2 pictures"), "{:?}", photo.source.notes);
}

#[test]
fn primaries_that_are_asked_for_go_before_the_files() {
    let folder = Folder::new();
    let path = folder.path("a.png");
    put_code_points(&path, &[255, 0, 0, 128, 128, 128], 9, 8);
    let options = ReadOptions { primaries: Some(Primaries::P3_D65), ..Default::default() };
    let photo = photo::read_with(&path, &options).unwrap();
    near(photo.pixels[0], [1.2249, -0.0420, -0.0197], 1e-3);
    // The file's curve, which is straight, stays.
    near(photo.pixels[1], [128.0 / 255.0; 3], 1e-6);
}

/// The profile in a file, by a decoder that is not ours.
fn embedded(path: &Path) -> Option<ColorProfile> {
    let file = BufReader::new(File::open(path).unwrap());
    let icc = match path.extension().unwrap().to_str().unwrap() {
        "tif" => {
            let tag = tiff::decoder::Decoder::new(file).unwrap().find_tag(tiff::tags::Tag::IccProfile).unwrap();
            tag.map(|value| value.into_u8_vec().unwrap())
        }
        _ => image::codecs::jpeg::JpegDecoder::new(file).unwrap().icc_profile().unwrap(),
    };
    icc.map(|icc| ColorProfile::new_from_slice(&icc).unwrap())
}

#[test]
fn pictures_for_displays_say_that_they_are_srgb() {
    let folder = Folder::new();
    let colour = asymmetric(4, 3);
    let mut grey = Photo::new(2, 1, vec![[0.5, 0.5, 0.5, 1.0]; 2]);
    grey.source.grey = true;
    for (photo, space) in [(&colour, DataColorSpace::Rgb), (&grey, DataColorSpace::Gray)] {
        for (name, options) in [
            ("a.tif", with_depth(Depth::Eight)),
            ("b.tif", with_depth(Depth::Sixteen)),
            ("a.jpg", WriteOptions::default()),
        ] {
            let back = folder.round_trip_as(name, photo, options);
            let profile = embedded(&folder.path(name)).expect("a profile");
            assert_eq!(profile.color_space, space, "{name}");
            assert!(back.source.notes.is_empty() && back.source.space.is_none(), "{name}: {:?}", back.source);
        }
        folder.round_trip("float.tif", photo);
        assert!(embedded(&folder.path("float.tif")).is_none());
        folder.round_trip("a.png", photo);
        let png = png::Decoder::new(BufReader::new(File::open(folder.path("a.png")).unwrap())).read_info().unwrap();
        assert!(png.info().srgb.is_some());
    }
}

#[test]
fn colours_that_an_output_cannot_hold_are_told() {
    let folder = Folder::new();
    let path = folder.path("p3.png");
    put_code_points(&path, &[255, 0, 0], 12, 13);
    let p3 = photo::read(&path).unwrap();
    let mut acescg = asymmetric(2, 2);
    acescg.source.primaries = Some(Primaries::ACESCG);
    let told = |photo: &Photo, name: &str| photo::lost(Path::new(name), photo, &WriteOptions::default()).concat();
    let mapped = WriteOptions { tone_map: Some(photo::ToneMap::Aces), ..WriteOptions::default() };
    for name in ["a.png", "a.jpg"] {
        // They stay what they are, but under a tone map.
        assert_eq!(told(&p3, name), "", "{name}");
        let said = photo::lost(Path::new(name), &p3, &mapped).concat();
        assert!(said.contains("tone map") && said.contains("Display P3"), "{name}: {said}");
        assert!(told(&acescg, name).contains("ACEScg, are written as sRGB"), "{name}");
        assert_eq!(told(&asymmetric(2, 2), name), "");
    }
    assert!(told(&p3, "a.hdr").contains("clipped"));
    assert_eq!(told(&p3, "a.exr"), "");
    assert_eq!(told(&acescg, "a.exr"), "");
    assert!(told(&acescg, "a.pfm").contains("ACEScg, are written as Rec. 709"));
    let radiance = photo::read(&input("hdr-exposure-and-view.hdr")).unwrap();
    assert!(told(&radiance, "a.pfm").contains("EXPOSURE of 4"));
    // OpenEXR has whiteLuminance for it.
    assert_eq!([told(&radiance, "a.exr"), told(&radiance, "a.hdr")], ["", ""]);
}

#[test]
fn a_radiance_header_survives() {
    let folder = Folder::new();
    let photo = photo::read(&input("hdr-exposure-and-view.hdr")).unwrap();
    let back = folder.round_trip("a.hdr", &photo);
    assert_eq!(back.pixels, photo.pixels);
    let text = String::from_utf8_lossy(&std::fs::read(folder.path("a.hdr")).unwrap()[..200]).into_owned();
    assert!(text.contains("\nEXPOSURE=4\n") && text.contains("\nVIEW= -vtv -vh 45\n"), "{text}");
}
