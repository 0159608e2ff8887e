//! JPEG of every kind that cameras, phones and other encoders write; what is damaged is refused or told.
//!
//! Values marked djpeg are those of libjpeg-turbo 2.1.5's `djpeg -dct int`, in codes of 0..=255.

use std::path::PathBuf;

use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageEncoder};
use moxcms::ColorProfile;
use vglare::photo::{self, Photo, Primaries, ReadOptions};

use super::{Folder, asymmetric, bits, reason};

fn input(name: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests/inputs", name].iter().collect()
}

/// The sRGB code of light.
fn code(light: f32) -> f32 {
    255.0 * if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

fn codes(photo: &Photo, x: u32, y: u32) -> [f32; 3] {
    let pixel = photo.pixels[(y * photo.width() + x) as usize];
    [code(pixel[0]), code(pixel[1]), code(pixel[2])]
}

fn near(got: [f32; 3], want: [f32; 3], within: f32, what: &str) {
    assert!(got.iter().zip(want).all(|(g, w)| (g - w).abs() <= within), "{what}: {got:?} for {want:?}");
}

/// A JPEG of one colour, at the best quality.
fn flat(width: u32, height: u32, colour: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let kind = if colour.len() == 1 { ExtendedColorType::L8 } else { ExtendedColorType::Rgb8 };
    let samples = colour.repeat((width * height) as usize);
    JpegEncoder::new_with_quality(&mut file, 100).write_image(&samples, width, height, kind).unwrap();
    file
}

/// The file with a segment behind its first marker.
fn with_segment(file: &[u8], marker: u8, name: &[u8], payload: &[u8]) -> Vec<u8> {
    let length = (2 + name.len() + payload.len()) as u16;
    [&file[..2], &[0xff, marker], &length.to_be_bytes(), name, payload, &file[2..]].concat()
}

fn notes(photo: &Photo) -> String {
    photo.source.notes.join("\n")
}

#[test]
fn every_sampling_and_order_of_scans_is_the_same_picture() {
    const PLACES: [(u32, u32); 4] = [(3, 4), (25, 13), (40, 30), (60, 44)];
    let small = [[7, 17, 9], [65, 52, 61], [106, 122, 112], [160, 178, 166]];
    // djpeg
    for (name, want) in [
        ("jpeg-420-scans-apart.jpg", small),
        ("jpeg-420-scans-apart-restart.jpg", small),
        ("jpeg-440-scans-apart.jpg", [[164, 224, 225], [229, 39, 23], [37, 58, 61], [130, 27, 230]]),
        ("jpeg-420-chroma-in-one-scan.jpg", [[165, 223, 225], [230, 38, 23], [35, 59, 63], [130, 27, 228]]),
        ("jpeg-411-progressive.jpg", [[160, 225, 231], [229, 39, 27], [31, 60, 68], [136, 24, 233]]),
        ("jpeg-luma-narrow-red-low.jpg", [[164, 224, 225], [235, 45, 29], [37, 58, 61], [130, 27, 230]]),
        ("jpeg-luma-subsampled.jpg", [[6, 15, 10], [68, 52, 62], [107, 120, 111], [161, 178, 168]]),
        ("jpeg-rgb.jpg", [[165, 223, 229], [225, 38, 23], [34, 60, 63], [133, 28, 229]]),
    ] {
        let photo = photo::read(&input(name)).unwrap();
        assert_eq!(notes(&photo), "", "{name}");
        for ((x, y), want) in PLACES.into_iter().zip(want) {
            near(codes(&photo, x, y), want.map(|c| c as f32), 3.0, &format!("{name} at {x}, {y}"));
        }
    }
}

#[test]
fn twelve_bits_are_read() {
    let photo = photo::read(&input("jpeg-12-bit.jpg")).unwrap();
    // By libjpeg-turbo 3 (imagecodecs), code / 4095 × 255.
    for ((x, y), want) in [((3, 4), [17.81, 19.43, 16.44]), ((40, 30), [161.28, 125.60, 164.27])] {
        near(codes(&photo, x, y), want, 0.1, "12 bit");
    }
}

#[test]
fn cmyk_of_adobe_is_inverted_and_said() {
    let photo = photo::read(&input("jpeg-cmyk.jpg")).unwrap();
    // Inks 30, 80, 200 and 60 of 255: (255 − ink) × (255 − 60) / 255.
    near(codes(&photo, 5, 5), [172.0, 134.0, 42.0], 2.0, "CMYK");
    assert!(notes(&photo).contains("CMYK"), "{}", notes(&photo));
}

#[test]
fn what_cannot_be_read_is_refused_by_name() {
    let folder = Folder::new();
    assert!(reason(&input("jpeg-arithmetic.jpg")).contains("arithmetic"));
    let file = flat(16, 16, &[90, 100, 110]);
    let frame = file.windows(2).position(|pair| pair == [0xff, 0xc0]).unwrap();
    let with = |at: usize, bytes: &[u8]| [&file[..at], bytes, &file[at + bytes.len()..]].concat();
    for (bytes, word) in [(with(frame + 1, &[0xc5]), "hierarchical"), (with(frame + 5, &[0, 0]), "DNL")] {
        let text = reason(&folder.put("a.jpg", &bytes));
        assert!(text.contains(word), "{text}");
    }
    let text = reason(&folder.put("a.jpg", &with(frame + 9, &[2])));
    assert!(text.contains("2 colour components"), "{text}");
}

#[test]
fn what_stands_behind_the_end_is_not_the_picture() {
    let folder = Folder::new();
    let photo = photo::read(&input("jpeg-motion-photo.jpg")).unwrap();
    // djpeg, as linear light.
    near(codes(&photo, 50, 30), [0.238_397_57, 0.191_201_68, 0.215_860_5].map(code), 3.0, "motion photo");
    folder.round_trip("a.jpg", &asymmetric(40, 30));
    let file = std::fs::read(folder.path("a.jpg")).unwrap();
    let alone = bits(&photo::read(&folder.path("a.jpg")).unwrap());
    for behind in [&b"\xff\xda\0\0 film \xff\xda"[..], b"\xff\xd8\xff\xe0", &[0; 999], &file] {
        let photo = photo::read(&folder.put("b.jpg", &[&file, behind].concat())).unwrap();
        assert_eq!(bits(&photo), alone);
        assert_eq!(notes(&photo), "");
    }
    // Fill bytes may stand before a marker, and some writers forget the end.
    let (end, filled) = (file.len() - 2, [&file[..file.len() - 2], &[0xff; 40], b"\xff\xd9"].concat());
    assert_eq!(bits(&photo::read(&folder.put("b.jpg", &filled)).unwrap()), alone);
    let photo = photo::read(&folder.put("b.jpg", &file[..end])).unwrap();
    assert_eq!(bits(&photo), alone);
    assert!(notes(&photo).contains("no end marker"), "{}", notes(&photo));
}

#[test]
fn a_picture_that_is_cut_short_never_passes_in_silence() {
    let folder = Folder::new();
    folder.round_trip("a.jpg", &asymmetric(40, 30));
    let written = std::fs::read(folder.path("a.jpg")).unwrap();
    let inputs = ["jpeg-411-progressive.jpg", "jpeg-440-scans-apart.jpg", "jpeg-420-chroma-in-one-scan.jpg"];
    let mut files = inputs.map(|name| std::fs::read(input(name)).unwrap()).to_vec();
    files.push(written);
    let (mut tried, mut silent) = (0, 0);
    for file in files {
        let scan = file.windows(2).position(|pair| pair == [0xff, 0xda]).unwrap();
        for cut in (scan + 14..file.len() - 3).step_by(31) {
            let zeros = vec![0; file.len() - cut];
            for behind in [&b"\xff\xd9"[..], b"maker's note \xff\xd9", &[&zeros[..], b"\xff\xd9"].concat(), b""] {
                let path = folder.put("b.jpg", &[&file[..cut], behind].concat());
                let told = |notes: String| notes.contains("damaged") || notes.contains("unfinished");
                tried += 1;
                silent += usize::from(photo::read(&path).is_ok_and(|photo| !told(notes(&photo))));
            }
        }
    }
    // What follows may happen to fill the picture to the last bit: zeros are the codes of flat blocks.
    assert!(silent * 100 < tried, "{silent} of {tried} passed in silence");
}

#[test]
fn damage_is_refused_or_told() {
    let folder = Folder::new();
    let text = reason(&input("jpeg-half-zero.jpg"));
    assert!(text.contains("damaged"), "{text}");
    // Data that are there twice are left over.
    folder.round_trip("a.jpg", &asymmetric(40, 30));
    let file = std::fs::read(folder.path("a.jpg")).unwrap();
    let doubled = [&file[..file.len() - 2], &file[file.len() - 60..]].concat();
    let photo = photo::read(&folder.put("b.jpg", &doubled)).unwrap();
    assert!(notes(&photo).contains("58 bytes of its data are left over"), "{}", notes(&photo));
    // A restart marker out of order.
    let mut file = std::fs::read(input("jpeg-420-chroma-in-one-scan.jpg")).unwrap();
    let marker = file.windows(2).position(|pair| pair == [0xff, 0xd1]).unwrap();
    file[marker + 1] = 0xd5;
    let text = reason(&folder.put("b.jpg", &file));
    assert!(text.contains("make no sense from row"), "{text}");
}

#[test]
fn endless_work_is_refused_before_it_begins() {
    let folder = Folder::new();
    let segment = |marker: u8, payload: &[u8]| {
        let length = (payload.len() as u16 + 2).to_be_bytes();
        [&[0xff, marker], &length[..], payload].concat()
    };
    // 96 megapixels of grey: a DC scan of zeros, and 90 scans of nothing.
    let frame = segment(0xc2, &[8, 0x1f, 0x40, 0x2e, 0xe0, 1, 1, 0x11, 0]);
    let first = [segment(0xda, &[1, 1, 0, 0, 0, 0]), vec![0; 187_500]].concat();
    let more = segment(0xda, &[1, 1, 0, 1, 63, 0]).repeat(90);
    let text = reason(&folder.put("a.jpg", &[&b"\xff\xd8"[..], &frame, &first, &more, b"\xff\xd9"].concat()));
    assert!(text.contains("96 megapixels in 91 scans"), "{text}");
    // A picture that so little data cannot fill.
    let text = reason(&folder.put("a.jpg", &[&b"\xff\xd8"[..], &frame, &first[..900], b"\xff\xd9"].concat()));
    assert!(text.contains("cut short"), "{text}");
}

/// Exif of a ColorSpace and, if there is one, an interoperability index; TIFF of CIPA DC-008, 4.6.
fn exif(space: u16, index: Option<&[u8; 4]>) -> Vec<u8> {
    let entry = |tag: u16, kind: u16, count: u32, value: [u8; 4]| {
        [&tag.to_be_bytes()[..], &kind.to_be_bytes(), &count.to_be_bytes(), &value].concat()
    };
    let ifd = |entries: &[Vec<u8>]| [&(entries.len() as u16).to_be_bytes()[..], &entries.concat(), &[0; 4]].concat();
    let [high, low] = space.to_be_bytes();
    let space = entry(0xa001, 3, 1, [high, low, 0, 0]);
    let first = ifd(&[entry(0x8769, 4, 1, 26_u32.to_be_bytes())]);
    let inner = match index {
        // The third directory begins behind 8 bytes of header, 18 of the first and 30 of the second.
        Some(index) => {
            [ifd(&[space, entry(0xa005, 4, 1, 56_u32.to_be_bytes())]), ifd(&[entry(1, 2, 4, *index)])].concat()
        }
        None => ifd(&[space]),
    };
    [&b"MM\0\x2a\0\0\0\x08"[..], &first, &inner].concat()
}

#[test]
fn adobe_rgb_by_exif_is_adobe_rgb() {
    let folder = Folder::new();
    let photo = photo::read(&input("jpeg-exif-adobe-rgb.jpg")).unwrap();
    // Codes (40, 200, 60) through 563/256 and the matrix of Adobe RGB (1998).
    let want = [-0.209_680, 0.586_084, 0.018_120];
    let got = photo.pixels[85];
    assert!((0..3).all(|c| (got[c] - want[c]).abs() < 0.02), "{got:?}");
    let file = flat(16, 16, &[40, 200, 60]);
    let read =
        |name, exif: &[u8]| photo::read(&folder.put(name, &with_segment(&file, 0xe1, b"Exif\0\0", exif))).unwrap();
    let adobe = read("r03.jpg", &exif(65535, Some(b"R03\0")));
    assert!((0..3).all(|c| (adobe.pixels[9][c] - want[c]).abs() < 0.02), "{:?}", adobe.pixels[9]);
    for (space, index) in [(1, None), (1, Some(b"R98\0")), (65535, None), (1, Some(b"R03\0"))] {
        let photo = read("srgb.jpg", &exif(space, index));
        near(codes(&photo, 5, 5), [40.0, 200.0, 60.0], 2.0, "sRGB");
        assert_eq!(notes(&photo).contains("uncalibrated"), space == 65535, "{}", notes(&photo));
    }
    let photo = read("bad.jpg", b"MM\0\x2a\xff\xff\xff\xff");
    near(codes(&photo, 5, 5), [40.0, 200.0, 60.0], 2.0, "damaged Exif");
}

#[test]
fn an_icc_profile_in_pieces_is_one_and_wins() {
    let folder = Folder::new();
    let profile = ColorProfile::new_display_p3().encode().unwrap();
    let (head, tail) = profile.split_at(200);
    let name = b"ICC_PROFILE\0";
    let file = with_segment(&flat(16, 16, &[255, 0, 0]), 0xe1, b"Exif\0\0", &exif(65535, Some(b"R03\0")));
    let second = with_segment(&file, 0xe2, name, &[&[2, 2], tail].concat());
    let both = with_segment(&second, 0xe2, name, &[&[1, 2], head].concat());
    let red = photo::read(&folder.put("a.jpg", &both)).unwrap().pixels[9];
    assert!((red[0] - 1.2249).abs() < 0.02 && (red[1] + 0.042).abs() < 0.02, "{red:?}");
    let photo = photo::read(&folder.put("a.jpg", &second)).unwrap();
    assert!(notes(&photo).contains("1 of 2"), "{}", notes(&photo));
    // A profile that is none is told, and the photo read.
    let photo = photo::read(&folder.put("a.jpg", &with_segment(&file, 0xe2, name, b"\x01\x01nothing"))).unwrap();
    assert!(notes(&photo).contains("ICC profile"), "{}", notes(&photo));
    // Primaries that are asked for win over the profile's, whose curves stay; full red of Rec. 2020.
    let options = ReadOptions { primaries: Some(Primaries::REC2020), ..ReadOptions::default() };
    let photo = photo::read_with(&folder.put("a.jpg", &both), &options).unwrap();
    let red = photo.pixels[9];
    assert!((red[0] - 1.6605).abs() < 0.02 && (red[1] + 0.1246).abs() < 0.02, "{red:?}");
    assert!(notes(&photo).is_empty(), "the profile's curves are kept: {}", notes(&photo));
    assert!(photo.source.primaries.is_none());
}

#[test]
fn other_formats_are_named() {
    let folder = Folder::new();
    for (head, name) in [
        (&b"\0\0\0\x18ftypheic\0\0\0\0mif1heic"[..], "HEIC"),
        (b"\0\0\0\x1cftypavif\0\0\0\0", "AVIF"),
        (b"\0\0\0\x0cjP  \r\n\x87\n", "JPEG 2000"),
        (b"RIFF\x20\0\0\0WEBPVP8 ", "WebP"),
        (b"GIF89a\x01\0\x01\0", "GIF"),
        (b"\xff\xd8\xff\xf7\0\x0b\x08\0\x01\0\x01\x01\x01\x11\0", "JPEG-LS"),
    ] {
        let text = reason(&folder.put("a.jpg", head));
        assert!(text.contains(name), "{text}");
    }
}

const XMP: &[u8] = b"http://ns.adobe.com/xap/1.0/\0";
const ISO: &[u8] = b"urn:iso:std:iso:ts:21496:-1\0";

fn xmp(attributes: &str, inside: &str) -> Vec<u8> {
    format!(
        "<x:xmpmeta xmlns:x='adobe:ns:meta/'><rdf:RDF xmlns:rdf='http://www.w3.org/1999/02/22-rdf-syntax-ns#'>\
         <rdf:Description xmlns:hdrgm='http://ns.adobe.com/hdr-gain-map/1.0/' hdrgm:Version='1.0' {attributes}>{inside}\
         </rdf:Description></rdf:RDF></x:xmpmeta>"
    )
    .into_bytes()
}

/// The maximum of each colour, as a list.
fn list(stops: [&str; 3]) -> String {
    let items = stops.map(|stops| format!("<rdf:li>{stops}</rdf:li>")).concat();
    format!("<hdrgm:GainMapMax><rdf:Seq>{items}</rdf:Seq></hdrgm:GainMapMax>")
}

/// Light of the sRGB code 188, and the formula of Ultra HDR 1.1 with offsets of 1/64.
fn brightened(stops: f32) -> f32 {
    let plain = ((188.0_f32 / 255.0 + 0.055) / 1.055).powf(2.4);
    (plain + 1.0 / 64.0) * stops.exp2() - 1.0 / 64.0
}

fn brightness(photo: &Photo) -> [f32; 3] {
    let pixel = photo.pixels[photo.pixels.len() / 2 + 3];
    [pixel[0], pixel[1], pixel[2]]
}

#[test]
fn a_gain_map_is_applied_in_full() {
    let folder = Folder::new();
    let plain = flat(32, 16, &[188, 188, 188]);
    let map =
        |codes: &[u8], numbers: &str, inside: &str| with_segment(&flat(8, 8, codes), 0xe1, XMP, &xmp(numbers, inside));
    let read = |map: &[u8]| photo::read(&folder.put("a.jpg", &[&plain, map].concat())).unwrap();
    let check = |map: &[u8], stops: [f32; 3]| {
        let photo = read(map);
        let (got, want) = (brightness(&photo), stops.map(brightened));
        assert!(got.iter().zip(want).all(|(g, w)| (g / w - 1.0).abs() < 0.02), "{got:?} for {want:?}");
        assert!(!photo.source.display_referred && notes(&photo).contains("gain map"), "{}", notes(&photo));
    };
    check(&map(&[255], "hdrgm:GainMapMax='3'", ""), [3.0; 3]);
    check(&map(&[0], "hdrgm:GainMapMin='-1' hdrgm:GainMapMax='3'", ""), [-1.0; 3]);
    check(&map(&[128], "hdrgm:GainMapMax='2' hdrgm:Gamma='0.5'", ""), [2.0 * (128.0_f32 / 255.0).powi(2); 3]);
    check(&map(&[255, 255, 255], "", &list(["1", "2", "3"])), [1.0, 2.0, 3.0]);
    // In the picture's own primaries: grey of Display P3, red brightened; first column of its matrix to Rec. 709.
    let profile = ColorProfile::new_display_p3().encode().unwrap();
    let wide = with_segment(&plain, 0xe2, b"ICC_PROFILE\0\x01\x01", &profile);
    let red = list(["2", "0", "0"]);
    let photo = photo::read(&folder.put("a.jpg", &[wide, map(&[255, 255, 255], "", &red)].concat())).unwrap();
    let (grey, more) = (brightened(0.0), brightened(2.0) - brightened(0.0));
    for (got, share) in brightness(&photo).into_iter().zip([1.2249, -0.0420, -0.0197]) {
        assert!((got - grey - more * share).abs() < 0.01, "{:?}", brightness(&photo));
    }
    // ISO 21496-1: versions, no flags, then headrooms, minimum, maximum, gamma and the offsets as fractions.
    let fractions = [(0, 1), (4, 1), (-1, 2), (5, 2), (1, 1), (1, 64), (1, 64)];
    let numbers = fractions.iter().flat_map(|(n, d): &(i32, i32)| [n.to_be_bytes(), d.to_be_bytes()]);
    let iso = [vec![0; 5], numbers.flatten().collect()].concat();
    check(&with_segment(&flat(8, 8, &[255]), 0xe2, ISO, &iso), [2.5; 3]);
    // Other pictures may stand before it, and a film behind.
    let behind = [&flat(8, 8, &[9]), &map(&[255], "hdrgm:GainMapMax='3'", "")[..], b"\0\0\0\x18ftypmp42"].concat();
    check(&behind, [3.0; 3]);
}

#[test]
fn a_gain_map_is_turned_with_its_picture() {
    let folder = Folder::new();
    let mut file = Vec::new();
    // The map's left half is dark: the picture's upper half after a turn to the right.
    let samples: Vec<u8> = (0..32 * 16).map(|i| if i % 32 < 16 { 0 } else { 255 }).collect();
    JpegEncoder::new_with_quality(&mut file, 100).write_image(&samples, 32, 16, ExtendedColorType::L8).unwrap();
    let map = with_segment(&file, 0xe1, XMP, &xmp("hdrgm:GainMapMax='2'", ""));
    let turned = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0";
    let plain = with_segment(&flat(64, 32, &[188, 188, 188]), 0xe1, b"Exif\0\0", turned);
    let photo = photo::read(&folder.put("a.jpg", &[plain, map].concat())).unwrap();
    assert_eq!((photo.width(), photo.height()), (32, 64));
    let light = |x: u32, y: u32| photo.pixels[(y * 32 + x) as usize][1];
    for (y, stops) in [(3, 0.0), (20, 0.0), (44, 2.0), (60, 2.0)] {
        assert!((light(5, y) / brightened(stops) - 1.0).abs() < 0.02, "row {y}: {}", light(5, y));
    }
}

#[test]
fn a_gain_map_that_is_not_applied_is_told() {
    let folder = Folder::new();
    let plain = flat(32, 16, &[188, 188, 188]);
    let map = |attributes: &str| with_segment(&flat(8, 8, &[255]), 0xe1, XMP, &xmp(attributes, ""));
    let promised = with_segment(&plain, 0xe1, XMP, &xmp("", ""));
    let apple = with_segment(&flat(8, 8, &[255]), 0xe1, XMP, b"<x xmlns:a='http://ns.apple.com/HDRGainMap/1.0/'/>");
    let damaged = map("hdrgm:GainMapMax='2'");
    for (file, word) in [
        (promised, "which is not there"),
        ([&plain[..], &apple].concat(), "Apple"),
        ([&plain[..], &map("hdrgm:GainMapMax='2' hdrgm:BaseRenditionIsHDR='True'")].concat(), "HDR to SDR"),
        ([&plain[..], &map("hdrgm:GainMapMax='many'")].concat(), "numbers"),
        ([&plain[..], &map("hdrgm:GainMapMax='900'")].concat(), "no sense"),
        ([&plain[..], &map("")].concat(), "no sense"),
        ([&plain[..], &damaged[..damaged.len() - 3]].concat(), "cut short"),
    ] {
        let photo = photo::read(&folder.put("a.jpg", &file)).unwrap();
        assert!(notes(&photo).contains(word) && notes(&photo).contains("SDR"), "{word}: {}", notes(&photo));
        assert!(photo.source.display_referred);
        near(codes(&photo, 5, 5), [188.0; 3], 1.0, word);
    }
}
