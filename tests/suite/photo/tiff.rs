//! Kinds of TIFF that no encoder here writes, put together by hand.

use vglare::photo;

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
    let cases = [
        (Tiff::new(8, 4, 5, 1, vec![0; 8]), "CMYK"),
        (Tiff::new(8, 1, 3, 1, vec![0; 2]).with_tag(320, vec![0; 768]), "Palette"),
        (Tiff::new(64, 3, 2, 1, vec![0; 48]).with_tag(339, vec![3; 3]), "64 bit"),
        (Tiff::new(32, 3, 2, 1, vec![0; 24]), "unsigned integers"),
    ];
    for (tiff, why) in cases {
        let text = reason(&folder.put("a.tif", &tiff.bytes()));
        assert!(text.contains(why), "{why}: {text}");
    }
}
