//! What an OpenEXR file says and how it is stored outlives a picture that is the same, and as much of it as can one that has changed.

use exr::compression::Compression;
use exr::meta::BlockDescription;
use exr::meta::attribute::{AttributeValue, KeyCode, SampleType, Text};
use exr::meta::header::Header;
use vglare::photo::{self, Beside, Made, Photo, Primaries, ReadOptions, WriteOptions};

use super::Folder;
use super::exr::{ACESCG, ALL, Blocks, TILES, content, header, put, with_levels};

const AGAIN: WriteOptions =
    WriteOptions { format: None, depth: None, exposure: 0.0, tone_map: None, primaries: None, overwrite: true };

/// Every compression that loses something.
const LOSSY: [Compression; 5] =
    [Compression::B44, Compression::B44A, Compression::PXR24, Compression::DWAA(Some(120.0)), Compression::DWAB(None)];

/// The bytes of the channels of one part but for some, row by row of each block.
fn others(header: &Header, blocks: &Blocks, without: &[&str]) -> Vec<u8> {
    let width = header.layer_size.width();
    let mut bytes = Vec::new();
    for data in blocks.values() {
        let mut rest = &data[..];
        while !rest.is_empty() {
            for channel in &header.channels.list {
                let (row, after) = rest.split_at(width * channel.sample_type.bytes_per_sample());
                if !without.contains(&&*channel.name.to_string()) {
                    bytes.extend_from_slice(row);
                }
                rest = after;
            }
        }
    }
    bytes
}

#[test]
fn a_picture_that_is_the_same_keeps_its_compression_and_its_levels() {
    let folder = Folder::new();
    let (from, to) = (folder.path("from.exr"), folder.path("to.exr"));
    for compression in LOSSY.into_iter().chain([Compression::ZIP16]) {
        for blocks in [BlockDescription::ScanLines, TILES, with_levels()] {
            put(&from, vec![header(&ALL, compression, blocks)]);
            photo::write(&to, &photo::read(&from).unwrap(), &AGAIN).unwrap();
            assert!(content(&from) == content(&to), "{compression} {blocks:?}");
        }
    }
}

#[test]
fn a_picture_that_changes_keeps_its_compression_where_no_other_channel_loses() {
    let folder = Folder::new();
    let (from, to) = (folder.path("from.exr"), folder.path("to.exr"));
    let picture = [("B", SampleType::F16), ("G", SampleType::F16), ("R", SampleType::F16), ("Z", SampleType::F32)];
    let aside = [&picture[..], &[("diffuse.R", SampleType::F16)]].concat();
    for (channels, zip) in [
        (&picture[..], &[][..]),
        (&aside, &[Compression::B44, Compression::B44A, Compression::DWAA(Some(120.0)), Compression::DWAB(None)]),
    ] {
        for compression in LOSSY {
            put(&from, vec![header(channels, compression, BlockDescription::ScanLines)]);
            let mut photo = photo::read(&from).unwrap();
            // Smooth, since noise is what a lossy compression is not for.
            photo.pixels.iter_mut().enumerate().for_each(|(at, pixel)| *pixel = [at as f32 / 1e3, 0.5, 0.25, 1.0]);
            photo::write(&to, &photo, &AGAIN).unwrap();
            let ((before, blocks), (after, written)) = (content(&from), content(&to));
            let expected = if zip.contains(&compression) { Compression::ZIP16 } else { compression };
            assert_eq!(after[0].compression, expected);
            let kept = |header, blocks| others(header, blocks, &["B", "G", "R"]);
            assert!(kept(&before[0], &blocks) == kept(&after[0], &written), "{compression}: other channels");
            for (got, want) in photo::read(&to).unwrap().pixels.iter().zip(&photo.pixels) {
                assert!(got.iter().zip(want).all(|(got, want)| (got - want).abs() < 0.03), "{got:?} for {want:?}");
            }
        }
    }
}

#[test]
fn key_codes_leave_a_file_that_can_be_read() {
    let folder = Folder::new();
    let (from, to) = (folder.path("from.exr"), folder.path("to.exr"));
    let code = KeyCode {
        film_manufacturer_code: 1,
        film_type: 2,
        film_roll_prefix: 3,
        count: 4,
        perforation_offset: 5,
        perforations_per_frame: 6,
        perforations_per_count: 64,
    };
    let mut coded = header(&ALL, Compression::ZIP16, BlockDescription::ScanLines);
    // As bytes, which the crate writes as they are.
    let bytes = [1, 2, 3, 4, 5, 6, 64].iter().flat_map(|number: &i32| number.to_le_bytes()).collect();
    let whole = AttributeValue::Custom { kind: Text::from("keycode"), bytes };
    coded.own_attributes.other.insert(Text::from("keyCode"), whole);
    put(&from, vec![coded]);
    photo::write(&to, &photo::read(&from).unwrap(), &AGAIN).unwrap();
    assert_eq!(content(&to).0[0].own_attributes.film_key_code, Some(code));
    assert!(content(&from) == content(&to));
}

/// A picture of one colour, whose file says these things of its space.
fn said(folder: &Folder, id: Option<&str>, aces: bool, chromaticities: bool) -> Photo {
    let path = folder.path("said.exr");
    let rgb = ["B", "G", "R"].map(|name| (name, SampleType::F32));
    let mut header = header(&rgb, Compression::ZIP16, BlockDescription::ScanLines);
    if let Some(id) = id {
        let id = AttributeValue::Text(Text::from(id));
        header.own_attributes.other.insert(Text::from("colorInteropID"), id);
    }
    if aces {
        header.own_attributes.other.insert(Text::from("acesImageContainerFlag"), AttributeValue::I32(1));
    }
    header.shared_attributes.chromaticities = chromaticities.then_some(ACESCG);
    put(&path, vec![header]);
    let mut photo = photo::read(&path).unwrap();
    photo.pixels.fill([0.5, 0.25, 0.125, 1.0]);
    photo
}

#[test]
fn a_colour_space_is_what_the_file_says_first() {
    let folder = Folder::new();
    for (id, aces, chromaticities, primaries, known, notes) in [
        (None, false, false, None, false, 0),
        (None, false, true, Some(Primaries::ACESCG), true, 0),
        (Some("lin_rec2020_scene"), false, true, Some(Primaries::REC2020), true, 0),
        (Some("lin_rec2020_scene"), true, true, Some(Primaries::ACES2065_1), true, 0),
        (Some("lin_rec709_scene"), false, true, None, true, 0),
        (Some("unknown"), false, true, Some(Primaries::ACESCG), true, 0),
        (Some("unknown"), false, false, None, false, 0),
        (Some("srgb_rec709_scene"), false, false, None, false, 1),
    ] {
        let photo = said(&folder, id, aces, chromaticities);
        let near = |p: Primaries, q: Primaries| (p.green - q.green).abs().max_element() < 1e-6;
        let same = match (photo.source.primaries, primaries) {
            (Some(got), Some(want)) => near(got, want),
            (got, want) => got == want,
        };
        assert!(same, "{id:?} {aces} {chromaticities}: {:?}", photo.source.primaries);
        assert_eq!((photo.source.knows_primaries, photo.source.notes.len()), (known, notes), "{id:?} {aces}");
    }
}

/// The colour interop ID, whether there are chromaticities, and whether the file calls itself an ACES container.
fn tags(header: &Header) -> (Option<String>, bool, bool) {
    let other = &header.own_attributes.other;
    let id = match other.get(&b"colorInteropID"[..]) {
        Some(AttributeValue::Text(id)) => Some(id.to_string()),
        _ => None,
    };
    (id, header.shared_attributes.chromaticities.is_some(), other.contains_key(&b"acesImageContainerFlag"[..]))
}

#[test]
fn tags_of_colours_hold_or_are_dropped() {
    let folder = Folder::new();
    let to = folder.path("to.exr");
    let written = |photo: &Photo, options: &WriteOptions| {
        photo::write(&to, photo, options).unwrap();
        tags(&content(&to).0[0])
    };
    // Nothing is guessed, and what holds stays.
    assert_eq!(written(&said(&folder, None, false, false), &AGAIN), (None, false, false));
    assert_eq!(written(&said(&folder, None, false, true), &AGAIN), (None, true, false));
    let aces = said(&folder, Some("lin_ap0_scene"), true, true);
    assert_eq!(written(&aces, &AGAIN), (Some("lin_ap0_scene".into()), true, true));
    // What a person says is written instead.
    said(&folder, None, false, true);
    let options = ReadOptions { primaries: Some(Primaries::REC2020), ..ReadOptions::default() };
    let told = photo::read_with(&folder.path("said.exr"), &options).unwrap();
    assert_eq!(written(&told, &AGAIN), (Some("lin_rec2020_scene".into()), false, false));
    let own = Primaries { red: Primaries::XYZ.red, ..Primaries::REC709 };
    let options = ReadOptions { primaries: Some(own), ..ReadOptions::default() };
    let told = photo::read_with(&folder.path("said.exr"), &options).unwrap();
    assert_eq!(written(&told, &AGAIN), (None, true, false));
    // In another space the pixels are other numbers of the same colours.
    for (primaries, id) in [
        (Primaries::REC709, "lin_rec709_scene"),
        (Primaries::P3_D65, "lin_p3d65_scene"),
        (Primaries::REC2020, "lin_rec2020_scene"),
        (Primaries::ACES2065_1, "lin_ap0_scene"),
        (Primaries::ACESCG, "lin_ap1_scene"),
        (Primaries::ADOBE_RGB, "lin_adobergb_scene"),
    ] {
        let options = WriteOptions { primaries: Some(primaries), ..AGAIN };
        let is_its_own = primaries == Primaries::ACES2065_1;
        assert_eq!(written(&aces, &options), (Some(id.into()), is_its_own, is_its_own));
        let there = photo::read(&to).unwrap();
        let back = folder.path("back.exr");
        let options = WriteOptions { primaries: Some(Primaries::ACES2065_1), ..AGAIN };
        photo::write(&back, &there, &options).unwrap();
        for (got, want) in photo::read(&back).unwrap().pixels.iter().zip(&aces.pixels) {
            assert!(got.iter().zip(want).all(|(got, want)| (got - want).abs() < 1e-6), "{id}: {got:?}");
        }
    }
}

#[test]
fn other_formats_are_written_in_a_space_that_is_asked_for() {
    let folder = Folder::new();
    let photo = said(&folder, Some("lin_rec709_scene"), false, false);
    // ACES Output Transform's matrix, Rec.709 to AP1.
    let want = [0.613_1 * 0.5 + 0.339_5 * 0.25 + 0.047_4 * 0.125, 0.070_2 * 0.5 + 0.916_4 * 0.25 + 0.013_5 * 0.125];
    for name in ["a.pfm", "a.tif", "a.hdr"] {
        let options = WriteOptions { primaries: Some(Primaries::ACESCG), ..AGAIN };
        let path = folder.path(name);
        photo::write(&path, &photo, &options).unwrap();
        let row = (0..photo::read(&path).unwrap().pixels.len()).find(|&at| {
            let pixel = photo::read(&path).unwrap().pixels[at];
            pixel[0] > 0.0
        });
        let got = photo::read(&path).unwrap().pixels[row.unwrap()];
        assert!((got[0] - want[0]).abs() < 3e-3 && (got[1] - want[1]).abs() < 3e-3, "{name}: {got:?}");
        let told = photo::lost(&path, &photo, &options);
        assert_eq!(told.iter().any(|note| note.contains("ACEScg")), name != "a.hdr", "{told:?}");
    }
    let options = WriteOptions { primaries: Some(Primaries::ACESCG), ..AGAIN };
    let error = photo::write(&folder.path("a.png"), &photo, &options).unwrap_err().to_string();
    assert!(error.contains("a.png") && error.contains("display"), "{error}");
}

#[test]
fn a_file_is_the_same_to_the_byte_however_often_it_is_written() {
    let folder = Folder::new();
    let path = folder.path("a.exr");
    put(&path, vec![header(&ALL, Compression::ZIP16, BlockDescription::ScanLines)]);
    let bytes = |number: usize| {
        let mut photo = photo::read(&path).unwrap();
        photo.source.made = Some(Made::new("strength = 1.0").into());
        let to = folder.path(&format!("{number}.exr"));
        photo::write(&to, &photo, &AGAIN).unwrap();
        std::fs::read(to).unwrap()
    };
    let first = bytes(0);
    assert!((1..8).all(|number| bytes(number) == first));
}

#[test]
fn data_is_no_picture_unless_it_is_asked_for() {
    let folder = Folder::new();
    let path = folder.path("a.exr");
    let rgb = ["B", "G", "R"].map(|name| (name, SampleType::F32));
    let part = |name: &str, id: &str| {
        let mut header = header(&rgb, Compression::ZIP16, BlockDescription::ScanLines);
        header.own_attributes.layer_name = Some(Text::from(name));
        let id = AttributeValue::Text(Text::from(id));
        header.own_attributes.other.insert(Text::from("colorInteropID"), id);
        header
    };
    put(&path, vec![part("rgba", "data"), part("other", "lin_ap1_scene")]);
    let photo = photo::read(&path).unwrap();
    assert_eq!((photo.source.picture.as_deref(), photo.source.primaries.is_some()), (Some("part other"), true));
    let options = ReadOptions { part: Some("0".into()), ..ReadOptions::default() };
    assert_eq!(photo::read_with(&path, &options).unwrap().source.picture.as_deref(), Some("part rgba"));
    put(&path, vec![part("rgba", "data")]);
    let error = photo::read(&path).unwrap_err().to_string();
    assert!(error.contains("data and no picture"), "{error}");
}

#[test]
fn layers_beside_a_picture_and_how_it_was_made_replace_those_of_before() {
    let folder = Folder::new();
    let (from, to) = (folder.path("from.exr"), folder.path("to.exr"));
    let mut channels = [&ALL[..], &[("glare.R", SampleType::F16), ("zoom.R", SampleType::F16)]].concat();
    channels.sort_by_key(|(name, _)| *name);
    put(&from, vec![header(&channels, Compression::ZIP16, BlockDescription::ScanLines)]);
    for value in [1.0 / 3.0, 2.0 / 3.0] {
        let mut photo = photo::read(if value < 0.5 { &from } else { &to }).unwrap();
        let pixels = vec![[value, 2.0 * value, 3.0 * value, 1.0]; photo.pixels.len()];
        photo.source.beside = vec![Beside { name: "glare", pixels }];
        photo.source.made = Some(Made::new(&format!("strength = {value}")).into());
        let again = folder.path("again.exr");
        photo::write(&again, &photo, &AGAIN).unwrap();
        std::fs::rename(&again, &to).unwrap();
        let (headers, _) = content(&to);
        let names: Vec<_> = headers[0].channels.list.iter().map(|channel| channel.name.to_string()).collect();
        let expected =
            ["A", "B", "G", "R", "Z", "diffuse.R", "glare.B", "glare.G", "glare.R", "id", "zoom.R"].map(String::from);
        assert_eq!(names, expected);
        let glare = ReadOptions { layer: Some("glare".into()), ..ReadOptions::default() };
        let glare = photo::read_with(&to, &glare).unwrap();
        assert_eq!(glare.pixels[11], [value, 2.0 * value, 3.0 * value, 1.0]);
        let other = &headers[0].own_attributes.other;
        let AttributeValue::Text(settings) = &other[&Text::from("vglare.settings")] else { panic!("no text") };
        assert_eq!(settings.to_string(), format!("strength = {value}"));
        assert!(other.contains_key(&Text::from("vglare.look")) && other.contains_key(&Text::from("vglare.version")));
    }
}
