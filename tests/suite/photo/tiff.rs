//! Kinds of TIFF that no encoder here writes, put together by hand.

mod inputs;

use vglare::photo::{self, Alpha, Depth};

use super::{Folder, reason};

/// One directory of SHORT and LONG tags, then the data; every offset into the data is relative to its start.
struct Tiff {
    big_endian: bool,
    tags: Vec<(u16, Vec<u32>)>,
    data: Vec<u8>,
}

const STRIP_OFFSETS: u16 = 273;

impl Tiff {
    /// A picture of 2 × 1 pixels.
    fn new(bits: u32, samples: usize, photometric: u32, strips: usize, data: Vec<u8>) -> Self {
        let size = data.len() / strips;
        let tags = vec![
            (256, vec![2]),
            (257, vec![1]),
            (258, vec![bits; samples]),
            (259, vec![1]),
            (262, vec![photometric]),
            (STRIP_OFFSETS, (0..strips).map(|strip| (strip * size) as u32).collect()),
            (277, vec![samples as u32]),
            (278, vec![1]),
            (279, vec![size as u32; strips]),
            (284, vec![if strips > 1 { 2 } else { 1 }]),
        ];
        Self { big_endian: false, tags, data }
    }

    fn with_tag(mut self, tag: u16, values: Vec<u32>) -> Self {
        self.tags.push((tag, values));
        self
    }

    fn bytes(&self) -> Vec<u8> {
        let short = |v: u16| if self.big_endian { v.to_be_bytes() } else { v.to_le_bytes() };
        let long = |v: u32| if self.big_endian { v.to_be_bytes() } else { v.to_le_bytes() };
        let directory = 8 + 2 + self.tags.len() * 12 + 4;
        let arrays: usize = self.tags.iter().filter(|(_, v)| v.len() > 1).map(|(_, v)| v.len() * 4).sum();
        let data = (directory + arrays) as u32;
        let mut file = [if self.big_endian { b"MM" } else { b"II" }, &short(42)[..], &long(8)].concat();
        file.extend(short(self.tags.len() as u16));
        let mut beyond = Vec::new();
        for (tag, values) in &self.tags {
            let base = if *tag == STRIP_OFFSETS { data } else { 0 };
            file.extend([&short(*tag)[..], &short(4), &long(values.len() as u32)].concat());
            if let [value] = values[..] {
                file.extend(long(base + value));
            } else {
                file.extend(long((directory + beyond.len()) as u32));
                values.iter().for_each(|value| beyond.extend(long(base + value)));
            }
        }
        file.extend(long(0));
        [file, beyond, self.data.clone()].concat()
    }
}

#[test]
fn colours_may_stand_one_after_another() {
    let folder = Folder::new();
    let file = Tiff::new(8, 3, 2, 3, vec![255, 0, 0, 255, 128, 255]).bytes();
    let pixels = photo::read(&folder.put("planar.tif", &file)).unwrap().pixels;
    assert_eq!((pixels[0][0], pixels[0][1]), (1.0, 0.0));
    assert!((pixels[0][2] - 0.2159).abs() < 1e-3);
    assert_eq!(pixels[1], [0.0, 1.0, 1.0, 1.0]);
}

#[test]
fn white_may_be_zero() {
    let folder = Folder::new();
    let file = Tiff::new(8, 1, 0, 1, vec![0, 255]).bytes();
    let photo = photo::read(&folder.put("white.tif", &file)).unwrap();
    assert_eq!(photo.pixels, [[1.0; 4], [0.0, 0.0, 0.0, 1.0]]);
    assert!(photo.source.grey);
}

#[test]
fn floats_may_be_grey_and_big_endian() {
    let folder = Folder::new();
    let data = [2.5_f32, -1e-3].map(f32::to_be_bytes).concat();
    let tiff = Tiff { big_endian: true, ..Tiff::new(32, 1, 1, 1, data).with_tag(339, vec![3]) };
    let photo = photo::read(&folder.put("grey.tif", &tiff.bytes())).unwrap();
    assert_eq!(photo.pixels, [[2.5, 2.5, 2.5, 1.0], [-1e-3, -1e-3, -1e-3, 1.0]]);
    assert!(!photo.source.display_referred);
}

#[test]
fn what_is_not_read_says_what_it_is() {
    let folder = Folder::new();
    let rgb = |bits: u32| Tiff::new(bits, 3, 2, 1, vec![0; bits as usize]);
    let compressed = |scheme: u32| {
        let mut tiff = rgb(8);
        tiff.tags[3].1 = vec![scheme];
        tiff
    };
    let cases = [
        (compressed(6), "old-style JPEG"),
        (compressed(34925), "LZMA"),
        (compressed(34712), "JPEG 2000"),
        (compressed(4711), "the unknown scheme 4711"),
        (Tiff::new(16, 1, 32803, 1, vec![0; 4]), "a camera's raw data"),
        (Tiff::new(16, 3, 34892, 1, vec![0; 12]).with_tag(50706, vec![1]), "raw data (DNG)"),
        (Tiff::new(8, 4, 5, 1, vec![0; 8]).with_tag(332, vec![2]), "inks other than"),
        (rgb(64), "unsigned integers of 64 bit"),
        (rgb(64).with_tag(339, vec![6; 3]), "complex"),
        (rgb(8).with_tag(339, vec![3; 3]), "floats of 8 bit"),
        (Tiff::new(8, 2, 2, 1, vec![0; 4]), "too few"),
        (Tiff::new(8, 1, 3, 1, vec![0; 2]).with_tag(320, vec![0; 700]), "palette has 700"),
    ];
    for (tiff, why) in cases {
        let text = reason(&folder.put("a.tif", &tiff.bytes()));
        assert!(text.contains(why), "{why}: {text}");
    }
}

#[test]
fn strips_that_are_missing_or_too_short_are_no_grey() {
    let folder = Folder::new();
    let tiff = |strip: usize, bytes: u32| {
        let mut tiff = Tiff::new(8, 3, 2, 3, vec![255, 0, 0, 255, 128, 255]);
        tiff.tags[8].1[strip] = bytes;
        tiff.bytes()
    };
    assert!(photo::read(&folder.put("whole.tif", &tiff(0, 2))).is_ok());
    // A size of 0 says nothing; where the strip is, and that it is plain, is enough.
    assert!(photo::read(&folder.put("unsaid.tif", &tiff(1, 0))).is_ok());
    let text = reason(&folder.put("short.tif", &tiff(1, 1)));
    assert!(text.contains("cut short: strip 2 of 3 has 1 bytes for 2"), "{text}");
    let mut few = Tiff::new(8, 3, 2, 3, vec![255, 0, 0, 255, 128, 255]);
    few.tags[5].1.pop();
    let text = reason(&folder.put("few.tif", &few.bytes()));
    assert!(text.contains("cut short: it has 2 of 3 strips"), "{text}");
    // Three runs of one byte each, of six.
    let mut packed = Tiff::new(8, 3, 2, 1, vec![0; 6]);
    packed.tags[3].1 = vec![32773];
    let text = reason(&folder.put("packed.tif", &packed.bytes()));
    assert!(text.contains("strip 1 of 1: it is cut short"), "{text}");
    // The thumbnail that is left is not the photo.
    let bytes = include_bytes!("../../inputs/tiff-thumbnail-first.tif");
    let text = reason(&folder.put("thumbnail.tif", &bytes[..bytes.len() / 2]));
    assert!(text.contains("the file is cut short"), "{text}");
}

#[test]
fn a_huge_profile_is_left_aside() {
    let folder = Folder::new();
    let mut tiff = Tiff::new(8, 1, 1, 1, vec![0, 255]);
    let plain = photo::read(&folder.put("plain.tif", &tiff.bytes())).unwrap();
    // Longs, as many as make 17 MiB, of which the file holds one.
    tiff.tags.push((34675, vec![1]));
    let mut bytes = tiff.bytes();
    let entry = 8 + 2 + 10 * 12;
    bytes[entry + 4..entry + 8].copy_from_slice(&(17_u32 << 18).to_le_bytes());
    let photo = photo::read(&folder.put("huge.tif", &bytes)).unwrap();
    assert_eq!(photo.pixels, plain.pixels);
    assert!(photo.source.notes[0].contains("ICC profile of 17 MiB"), "{:?}", photo.source.notes);
}

#[test]
fn a_float_beyond_32_bits_is_told() {
    let folder = Folder::new();
    let data = [1e300_f64, -2.5].map(f64::to_le_bytes).concat();
    let file = Tiff::new(64, 1, 1, 1, data).with_tag(339, vec![3]).bytes();
    let photo = photo::read(&folder.put("double.tif", &file)).unwrap();
    assert_eq!((photo.pixels[0][0], photo.pixels[1][0]), (f32::INFINITY, -2.5));
    assert!(photo.source.notes[0].contains("too large for a float"), "{:?}", photo.source.notes);
}

#[test]
fn codes_of_associated_alpha_come_back() {
    let folder = Folder::new();
    let path = folder.put("a.tif", include_bytes!("../../inputs/tiff-associated-alpha-8.tif"));
    let photo = photo::read(&path).unwrap();
    assert_eq!((photo.source.alpha, photo.source.depth), (Alpha::Premultiplied, Depth::Eight));
    // (128, 64, 0) of 128 is the colour (255, 127.5, 0), covering half: sRGB's curve by hand.
    let want = [0.501_960_8, 0.107_440_26, 0.0, 128.0 / 255.0];
    assert!((0..4).all(|c| (photo.pixels[1][c] - want[c]).abs() < 1e-6), "{:?}", photo.pixels[1]);
    let back = folder.round_trip("b.tif", &photo);
    assert_eq!((back.source.alpha, &back.pixels), (Alpha::Premultiplied, &photo.pixels));
}

#[test]
fn half_floats_are_written_as_floats() {
    let folder = Folder::new();
    let half = photo::read(&folder.put("a.tif", include_bytes!("../../inputs/tiff-half.tif"))).unwrap();
    let back = folder.round_trip("b.tif", &half);
    assert_eq!((half.source.depth, back.source.depth), (Depth::Half, Depth::Float));
    assert_eq!(back.pixels, half.pixels);
}
