//! What a picture for displays says beside its pixels is said again by the picture that is made of it; other programs' readers
//! tell.

use std::fs::File;
use std::io::{BufReader, Cursor};
use std::path::Path;

use exif::{In, Tag, Value};
use image::ImageDecoder;
use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageEncoder};
use moxcms::ColorProfile;
use png::chunk::ChunkType;
use vglare::photo::{self, Depth, Format, Photo, WriteOptions};

use super::{Folder, with_depth};

const IPTC: &[u8] = b"\x1c\x02\x05\0\x06A lamp\x1c\x02\x50\0\x08Somebody";
const WIDTH: u32 = 48;
const HEIGHT: u32 = 32;

fn xmp(orientation: u8) -> String {
    format!(
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\
         <rdf:Description rdf:about=\"\" xmlns:tiff=\"http://ns.adobe.com/tiff/1.0/\" \
         xmlns:dc=\"http://purl.org/dc/elements/1.1/\" tiff:Orientation=\"{orientation}\" dc:format=\"image/x\"/></rdf:RDF></x:xmpmeta>"
    )
}

/// Little-endian Exif: a maker, an orientation, an exposure time, and a thumbnail in a second directory.
fn exif_of(orientation: u16) -> Vec<u8> {
    let entry = |tag: u16, kind: u16, count: u32, value: u32| {
        [&tag.to_le_bytes()[..], &kind.to_le_bytes(), &count.to_le_bytes(), &value.to_le_bytes()].concat()
    };
    let main = [
        &b"II*\0\x08\0\0\0\x03\0"[..],
        &entry(0x10f, 2, 10, 50),
        &entry(0x112, 3, 1, orientation.into()),
        &entry(0x8769, 4, 1, 60),
        &100_u32.to_le_bytes(),
    ];
    let exposure = [&1_u16.to_le_bytes()[..], &entry(0x829a, 5, 1, 78), &[0; 4]].concat();
    let rational = [1_u32.to_le_bytes(), 250_u32.to_le_bytes()].concat();
    let thumbnail = [&2_u16.to_le_bytes()[..], &entry(0x201, 4, 1, 130), &entry(0x202, 4, 1, 9), &[0; 4]].concat();
    let parts = [&main.concat()[..], b"The maker\0", &exposure, &rational, &[0; 14], &thumbnail, b"thumbnail"];
    let raw = parts.concat();
    assert_eq!((raw.len(), &raw[130..]), (139, &b"thumbnail"[..]));
    raw
}

fn display_p3() -> Vec<u8> {
    ColorProfile::new_display_p3().encode().unwrap()
}

/// Codes that leave no corner of the colours out.
fn codes() -> Vec<u8> {
    (0..WIDTH * HEIGHT)
        .flat_map(|i| [i * 5 % 256, i * 3 / 7 % 256, 255 - i * 11 % 256].map(|code| code as u8))
        .collect()
}

/// A PNG of Display P3 with all that a PNG can say.
fn p3_png(folder: &Folder, orientation: u16) -> Photo {
    let path = folder.path("in.png");
    let mut info = png::Info::with_size(WIDTH, HEIGHT);
    (info.color_type, info.bit_depth) = (png::ColorType::Rgb, png::BitDepth::Eight);
    info.icc_profile = Some(display_p3().into());
    info.exif_metadata = Some(exif_of(orientation).into());
    info.pixel_dims = Some(png::PixelDimensions { xppu: 11811, yppu: 11811, unit: png::Unit::Meter });
    let encoder = png::Encoder::with_info(File::create(&path).unwrap(), info).unwrap();
    let mut writer = encoder.write_header().unwrap();
    let packet = [b"XML:com.adobe.xmp\0\0\0\0\0", xmp(orientation as u8).as_bytes()].concat();
    writer.write_chunk(ChunkType(*b"iTXt"), &packet).unwrap();
    writer.write_chunk(ChunkType(*b"tEXt"), b"Title\0Lamps").unwrap();
    writer.write_image_data(&codes()).unwrap();
    writer.finish().unwrap();
    photo::read(&path).unwrap()
}

/// A JPEG of Display P3 with all that a JPEG can say.
fn p3_jpeg(folder: &Folder, orientation: u16) -> Photo {
    let mut file = Vec::new();
    let mut encoder = JpegEncoder::new_with_quality(&mut file, 95);
    encoder.set_icc_profile(display_p3()).unwrap();
    encoder.set_exif_metadata(exif_of(orientation)).unwrap();
    encoder.write_image(&codes(), WIDTH, HEIGHT, ExtendedColorType::Rgb8).unwrap();
    // 300 to an inch.
    file[13..18].copy_from_slice(&[1, 1, 44, 1, 44]);
    let segment = |marker: u8, parts: &[&[u8]]| {
        let length = 2 + parts.iter().map(|part| part.len()).sum::<usize>() as u16;
        [&[0xff, marker][..], &length.to_be_bytes(), &parts.concat()].concat()
    };
    let iptc = (IPTC.len() as u32).to_be_bytes();
    let segments = [
        segment(0xe1, &[b"http://ns.adobe.com/xap/1.0/\0", xmp(orientation as u8).as_bytes()]),
        segment(0xed, &[b"Photoshop 3.0\0", b"8BIM\x04\x04\0\0", &iptc, IPTC, &[0][..IPTC.len() % 2]]),
        segment(0xfe, &[b"A comment"]),
    ];
    file.splice(20..20, segments.concat());
    photo::read(&folder.put("in.jpg", &file)).unwrap()
}

/// What is told of Exif by its own reader: maker, exposure, orientation; and that no picture hides in it.
fn check_exif(raw: &[u8], what: &str) {
    assert!(!raw.windows(9).any(|word| word == b"thumbnail"), "{what}");
    let read = exif::Reader::new().read_raw(raw.to_vec()).unwrap_or_else(|error| panic!("{what}: {error}"));
    let shown = |tag| read.get_field(tag, In::PRIMARY).map(|field| field.display_value().to_string());
    assert_eq!(shown(Tag::Make).as_deref(), Some("\"The maker\""), "{what}");
    assert_eq!(shown(Tag::ExposureTime).as_deref(), Some("1/250"), "{what}");
    let turned = read.get_field(Tag::Orientation, In::PRIMARY).and_then(|field| field.value.get_uint(0));
    assert!(matches!(turned, None | Some(1)), "{what}: {turned:?}");
    assert!(read.fields().all(|field| field.ifd_num == In::PRIMARY), "{what}");
}

struct Said {
    icc: Vec<u8>,
    exif: Vec<u8>,
    xmp: String,
    iptc: Option<Vec<u8>>,
    per_inch: f64,
}

/// What a file says, by readers that are not ours.
fn said(path: &Path) -> Said {
    let file = || BufReader::new(File::open(path).unwrap());
    match path.extension().unwrap().to_str().unwrap() {
        "png" => {
            let mut reader = png::Decoder::new(file()).read_info().unwrap();
            reader.finish().unwrap();
            let info = reader.info();
            let text = info.utf8_text.iter().find(|text| text.keyword == "XML:com.adobe.xmp").expect("XMP");
            Said {
                icc: info.icc_profile.clone().expect("a profile").into_owned(),
                exif: info.exif_metadata.clone().expect("Exif").into_owned(),
                xmp: text.get_text().unwrap(),
                iptc: None,
                per_inch: f64::from(info.pixel_dims.expect("a resolution").xppu) * 0.0254,
            }
        }
        "jpg" => {
            let mut decoder = image::codecs::jpeg::JpegDecoder::new(file()).unwrap();
            let whole = std::fs::read(path).unwrap();
            assert_eq!(whole[6..11], *b"JFIF\0");
            let at = |word: &[u8]| whole.windows(word.len()).position(|at| at == word).map(|at| at + word.len());
            Said {
                icc: decoder.icc_profile().unwrap().expect("a profile"),
                exif: decoder.exif_metadata().unwrap().expect("Exif"),
                xmp: String::from_utf8(decoder.xmp_metadata().unwrap().expect("XMP")).unwrap(),
                iptc: at(b"8BIM\x04\x04\0\0").map(|at| whole[at + 4..][..IPTC.len()].to_vec()),
                per_inch: f64::from(u16::from_be_bytes([whole[14], whole[15]]))
                    * if whole[13] == 2 { 2.54 } else { 1.0 },
            }
        }
        _ => {
            let mut decoder = tiff::decoder::Decoder::new(file()).unwrap();
            let mut tag = |tag: u16| decoder.find_tag(tiff::tags::Tag::from_u16_exhaustive(tag)).unwrap();
            let bytes = |value: Option<tiff::decoder::ifd::Value>| value.map(|value| value.into_u8_vec().unwrap());
            let resolution = match tag(282) {
                Some(tiff::decoder::ifd::Value::Rational(n, d)) => f64::from(n) / f64::from(d),
                other => panic!("{other:?}"),
            };
            assert_eq!(tag(296).unwrap().into_u16().unwrap(), 2, "inches");
            Said {
                icc: bytes(tag(34675)).expect("a profile"),
                // A TIFF is Exif by itself.
                exif: std::fs::read(path).unwrap(),
                xmp: String::from_utf8(bytes(tag(700)).expect("XMP")).unwrap(),
                iptc: bytes(tag(33723)),
                per_inch: resolution,
            }
        }
    }
}

#[test]
fn everything_goes_from_every_format_to_every_format() {
    let folder = Folder::new();
    let tiff = {
        p3_jpeg(&folder, 6);
        let photo = photo::read(&folder.path("in.jpg")).unwrap();
        folder.round_trip_as("in.tif", &photo, with_depth(Depth::Eight))
    };
    for (from, photo) in [("png", p3_png(&folder, 6)), ("jpeg", p3_jpeg(&folder, 6)), ("tiff", tiff)] {
        assert_eq!((photo.width(), photo.height()), (HEIGHT, WIDTH), "{from} lies upright");
        for name in ["out.png", "out.jpg", "out.tif"] {
            let what = format!("{from} to {name}");
            let options = WriteOptions { depth: Some(Depth::Eight), ..WriteOptions::default() };
            let told = photo::lost(&folder.path(name), &photo, &options);
            let back = folder.round_trip_as(name, &photo, options);
            assert_eq!((back.width(), back.height()), (HEIGHT, WIDTH), "{what}: not turned again");
            assert_eq!(back.source.space.as_deref(), Some("Display P3"), "{what}");
            let Said { icc, exif, xmp: packet, iptc, per_inch } = said(&folder.path(name));
            assert!(icc == display_p3(), "{what}: another profile");
            check_exif(&exif, &what);
            assert_eq!(packet, xmp(1), "{what}");
            assert!((per_inch - 300.0).abs() < 0.01, "{what}: {per_inch}");
            match (from, name) {
                ("png", _) => assert_eq!((iptc, told), (None, vec![]), "{what}"),
                (_, "out.png") => assert!(told.len() == 1 && told[0].contains("IPTC"), "{what}: {told:?}"),
                _ => assert_eq!((iptc.as_deref(), told), (Some(IPTC), vec![]), "{what}"),
            }
        }
    }
}

#[test]
fn texts_and_comments_stay_in_their_own_format() {
    let folder = Folder::new();
    folder.round_trip("out.png", &p3_png(&folder, 1));
    let mut reader =
        png::Decoder::new(BufReader::new(File::open(folder.path("out.png")).unwrap())).read_info().unwrap();
    reader.finish().unwrap();
    let texts = &reader.info().uncompressed_latin1_text;
    assert_eq!(texts.iter().map(|text| (&*text.keyword, &*text.text)).collect::<Vec<_>>(), [("Title", "Lamps")]);
    folder.round_trip("out.jpg", &p3_jpeg(&folder, 1));
    let holds = |name: &str| std::fs::read(folder.path(name)).unwrap().windows(9).any(|word| word == b"A comment");
    assert!(holds("out.jpg"));
}

#[test]
fn codes_of_display_p3_stay_what_they_were() {
    let folder = Folder::new();
    let photo = p3_png(&folder, 1);
    folder.round_trip("out.png", &photo);
    let mut reader =
        png::Decoder::new(BufReader::new(File::open(folder.path("out.png")).unwrap())).read_info().unwrap();
    let mut got = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut got).unwrap();
    assert!(
        got == codes(),
        "of {} codes {} differ",
        got.len(),
        got.iter().zip(codes()).filter(|(a, b)| *a != b).count()
    );
    // 16 bit, too.
    let deep: Vec<u8> = (0..4096_u32)
        .flat_map(|i| [i * 16, 65535 - i * 7, i * i % 65536])
        .flat_map(|code| (code as u16).to_be_bytes())
        .collect();
    let mut info = png::Info::with_size(64, 64);
    (info.color_type, info.bit_depth) = (png::ColorType::Rgb, png::BitDepth::Sixteen);
    info.icc_profile = Some(display_p3().into());
    let encoder = png::Encoder::with_info(File::create(folder.path("deep.png")).unwrap(), info).unwrap();
    encoder.write_header().unwrap().write_image_data(&deep).unwrap();
    folder.round_trip("deep-out.png", &photo::read(&folder.path("deep.png")).unwrap());
    let file = BufReader::new(File::open(folder.path("deep-out.png")).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut got = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut got).unwrap();
    assert!(got == deep);
    // A JPEG is as near as its own coding is when it is coded again.
    let photo = p3_jpeg(&folder, 1);
    let back = folder.round_trip("out.jpg", &photo);
    let mean = photo.pixels.iter().flatten().zip(back.pixels.iter().flatten()).map(|(a, b)| f64::from((a - b).abs()));
    let mean = mean.sum::<f64>() / (4.0 * f64::from(WIDTH * HEIGHT));
    assert!(mean < 4e-3, "{mean}");
}

#[test]
fn what_becomes_srgb_says_so_in_exif_too() {
    let folder = Folder::new();
    // Adobe RGB by Exif alone: a profile is made for it.
    let adobe = photo::read(&super::input("jpeg-exif-adobe-rgb.jpg")).unwrap();
    let back = folder.round_trip("out.jpg", &adobe);
    assert_eq!(back.source.space.as_deref(), Some("Adobe RGB (1998)"));
    let value = |name: &str, tag| {
        let file = std::fs::read(folder.path(name)).unwrap();
        let read = exif::Reader::new().read_from_container(&mut Cursor::new(file)).unwrap();
        read.get_field(tag, In::PRIMARY).map(|field| field.value.clone())
    };
    assert!(matches!(value("out.jpg", Tag::InteroperabilityIndex), Some(Value::Ascii(text)) if text[0] == b"R03"));
    // Without its own space it is sRGB.
    let mut photo = adobe.clone();
    photo.source.display_referred = false;
    folder.round_trip("srgb.jpg", &photo);
    assert!(matches!(value("srgb.jpg", Tag::InteroperabilityIndex), Some(Value::Ascii(text)) if text[0] == b"R98"));
    assert_eq!(value("srgb.jpg", Tag::ColorSpace).and_then(|value| value.get_uint(0)), Some(1));
}

#[test]
fn nothing_is_kept_of_a_photo_in_a_companion() {
    let folder = Folder::new();
    let photo = p3_png(&folder, 1);
    let other = photo.companion(vec![[0.5; 4]; photo.pixels.len()]);
    folder.round_trip("out.png", &other);
    let reader = png::Decoder::new(BufReader::new(File::open(folder.path("out.png")).unwrap())).read_info().unwrap();
    let info = reader.info();
    assert!(info.srgb.is_some() && info.icc_profile.is_none() && info.exif_metadata.is_none());
}

#[test]
fn a_format_is_asked_for_where_a_name_does_not_tell() {
    let folder = Folder::new();
    let photo = p3_png(&folder, 1);
    let options = WriteOptions { format: Some(Format::Jpeg), ..WriteOptions::default() };
    photo::write(&folder.path("out"), &photo, &options).unwrap();
    assert_eq!(photo::read(&folder.path("out")).unwrap().source.format, Some(Format::Jpeg));
    let error = photo::write(&folder.path("out.png"), &photo, &options).unwrap_err().to_string();
    assert!(error.contains("PNG") && error.contains("JPEG"), "{error}");
    assert_eq!(photo.source.format, Some(Format::Png));
}
