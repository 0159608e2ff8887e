//! Which layer of an OpenEXR file is the picture, and what its colours mean.

use std::path::Path;

use exr::compression::Compression;
use exr::math::Vec2;
use exr::meta::BlockDescription;
use exr::meta::attribute::{Chromaticities, SampleType, Text};
use exr::meta::header::Header;
use vglare::photo::{self, Missing, Primaries, ReadOptions, WriteOptions};

use super::exr::{content, header, put};
use super::{Folder, bits, input};

fn part(name: &str, channels: &[(&str, SampleType)]) -> Header {
    let mut header = header(channels, Compression::ZIP16, BlockDescription::ScanLines);
    header.own_attributes.layer_name = Some(Text::from(name));
    header
}

#[test]
fn colours_in_three_parts_go_back_into_their_parts() {
    let folder = Folder::new();
    let (from, to) = (folder.path("from.exr"), folder.path("to.exr"));
    let (half, float) = (SampleType::F16, SampleType::F32);
    let parts = [
        part("alpha", &[("A", half)]),
        part("red", &[("R", half), ("Z", float)]),
        part("green", &[("G", float)]),
        part("blue", &[("B", half)]),
        part("id", &[("id", SampleType::U32)]),
    ];
    put(&from, parts.to_vec());
    let mut photo = photo::read(&from).unwrap();
    photo::write(&to, &photo, &WriteOptions::default()).unwrap();
    assert!(content(&from) == content(&to));
    photo.pixels[40] = [0.25, 0.5, 0.75, 1.0];
    photo::write(&to, &photo, &WriteOptions { overwrite: true, ..Default::default() }).unwrap();
    assert_eq!(photo::read(&to).unwrap().pixels[40], [0.25, 0.5, 0.75, 1.0]);
    let (before, after) = (content(&from).1, content(&to).1);
    let changed: Vec<usize> = before.iter().filter(|(at, bytes)| after[*at] != **bytes).map(|(at, _)| at[0]).collect();
    assert_eq!(changed, [0, 1, 2, 3], "each colour's part and alpha's, and nothing else");
}

#[test]
fn a_lone_channel_is_grey_and_stays_what_it_is() {
    let folder = Folder::new();
    let (from, to) = (folder.path("from.exr"), folder.path("to.exr"));
    for name in ["R", "Z", "depth.V"] {
        put(&from, vec![header(&[(name, SampleType::F32)], Compression::ZIP16, BlockDescription::ScanLines)]);
        let photo = photo::read(&from).unwrap();
        assert!(photo.source.grey && photo.source.notes[0].contains(name), "{:?}", photo.source.notes);
        photo::write(&to, &photo, &WriteOptions { overwrite: true, ..Default::default() }).unwrap();
        assert!(content(&from) == content(&to));
    }
}

#[test]
fn the_picture_of_many_is_named() {
    let folder = Folder::new();
    let path = folder.path("a.exr");
    let rgb = |layer: &str| ["B", "G", "R"].map(|own| format!("{layer}{own}"));
    let names = [rgb("beauty."), rgb("diffuse.")].concat();
    let channels: Vec<_> = names.iter().map(|name| (name.as_str(), SampleType::F16)).collect();
    put(&path, vec![header(&channels, Compression::ZIP16, BlockDescription::ScanLines)]);
    assert_eq!(photo::read(&path).unwrap().source.picture.as_deref(), Some("beauty"));
    put(&path, vec![header(&channels[..3], Compression::ZIP16, BlockDescription::ScanLines)]);
    assert_eq!(photo::read(&path).unwrap().source.picture, None);
}

#[test]
fn twenty_thousand_layers_take_no_longer_than_their_channels() {
    let folder = Folder::new();
    let path = folder.path("a.exr");
    let mut names: Vec<String> =
        (0..20_000).flat_map(|n| ["B", "G", "R"].map(|own| format!("l{n:05}.{own}"))).collect();
    names.sort();
    let channels: Vec<_> = names.iter().map(|name| (name.as_str(), SampleType::F16)).collect();
    let mut header = header(&channels, Compression::RLE, BlockDescription::ScanLines);
    header.layer_size = Vec2(1, 1);
    let header = header.with_encoding(
        Compression::RLE,
        BlockDescription::ScanLines,
        exr::meta::attribute::LineOrder::Increasing,
    );
    put(&path, vec![header]);
    let start = std::time::Instant::now();
    let photo = photo::read(&path).unwrap();
    let seconds = start.elapsed().as_secs_f64();
    println!("{seconds} s");
    // It took 17 to 38 s when each was compared with each.
    assert!(seconds < 5.0, "{seconds} s");
    assert_eq!(photo.source.picture.as_deref(), Some("l00000"));
    assert!(photo.source.notes[0].ends_with("l00001, l00002, l00003 and 19996 more"), "{:?}", photo.source.notes);
}

#[test]
fn xyz_becomes_rec709_where_a_format_wants_it() {
    let folder = Folder::new();
    let photo = photo::read(&input("exr-xyz-primaries.exr")).unwrap();
    let weights = photo.luminance_weights();
    assert!((weights[1] - 1.0).abs() < 1e-6 && photo.source.notes.is_empty(), "{weights:?}");
    // IEC 61966-2-1's matrix, by which the file was made of these.
    let want = [[1.4, 0.25, 0.26], [0.2, 0.6, 0.1], [0.5, 0.5, 0.5]];
    let row = photo.width() as usize * 3;
    let back = folder.round_trip("a.pfm", &photo);
    for (got, want) in back.pixels[row..].iter().zip(want) {
        assert!(got.iter().zip(want).all(|(got, want)| (got - want).abs() < 5e-3), "{got:?} for {want:?}");
    }
    // Channels X, Y, Z mean the same, whatever the chromaticities.
    let path = folder.path("xyz.exr");
    let channels = ["X", "Y", "Z"].map(|name| (name, SampleType::F32));
    put(&path, vec![header(&channels, Compression::ZIP16, BlockDescription::ScanLines)]);
    let photo = photo::read(&path).unwrap();
    assert_eq!((photo.source.primaries, photo.source.notes.len()), (Some(Primaries::XYZ), 1));
    assert!(bits(&folder.round_trip("again.exr", &photo)) == bits(&photo));
}

#[test]
fn senseless_chromaticities_and_pixels_are_told() {
    let folder = Folder::new();
    let path = folder.path("a.exr");
    let rgb = ["B", "G", "R"].map(|name| (name, SampleType::F32));
    let mut odd = header(&rgb, Compression::ZIP16, BlockDescription::ScanLines);
    let point = Vec2(0.3, 0.3);
    odd.shared_attributes.chromaticities = Some(Chromaticities { red: point, green: point, blue: point, white: point });
    odd.shared_attributes.pixel_aspect = 0.0;
    put(&path, vec![odd]);
    let notes = |primaries| {
        let options = ReadOptions { missing: Missing::Refuse, primaries, ..ReadOptions::default() };
        let photo = photo::read_with(&path, &options).unwrap();
        assert!(photo.source.pixel_aspect == 1.0);
        photo.source.notes
    };
    let told = notes(None);
    assert!(told.iter().any(|note| note.contains("chromaticities span no colour space")), "{told:?}");
    assert!(told.iter().any(|note| note.contains("pixelAspectRatio, 0,")), "{told:?}");
    assert_eq!(notes(Some(Primaries::ACESCG)).len(), 1);
}

#[test]
fn the_shape_of_pixels_is_read_and_written() {
    let folder = Folder::new();
    let path = folder.path("a.exr");
    let rgb = ["B", "G", "R"].map(|name| (name, SampleType::F32));
    put(&path, vec![header(&rgb, Compression::ZIP16, BlockDescription::ScanLines)]);
    let aspect = |path: &Path| photo::read(path).unwrap().source.pixel_aspect;
    assert_eq!(aspect(&path), 1.5);
    let mut photo = super::asymmetric(3, 2);
    photo.source.pixel_aspect = 2.0;
    photo::write(&folder.path("b.exr"), &photo, &WriteOptions::default()).unwrap();
    assert_eq!(aspect(&folder.path("b.exr")), 2.0);
}
