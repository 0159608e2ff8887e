//! What is read is what the file says, and what is written reads back as it was.

mod colour;
mod damaged;
mod display;
mod exr;
mod exr_gaps;
mod exr_layers;
mod exr_sampled;
mod exr_whole;
mod jpeg;
mod kept;
mod target;
mod tiff;

use std::path::{Path, PathBuf};

use tempfile::TempDir;
use vglare::photo::{self, Depth, Photo, WriteOptions};

/// A file of `tests/inputs`.
fn input(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs").join(name)
}

/// A folder for a test's files; gone when the test ends.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn put(&self, name: &str, bytes: &[u8]) -> PathBuf {
        std::fs::write(self.path(name), bytes).unwrap();
        self.path(name)
    }

    /// Writes a photo with the defaults, and reads it back.
    fn round_trip(&self, name: &str, photo: &Photo) -> Photo {
        self.round_trip_as(name, photo, WriteOptions::default())
    }

    fn round_trip_as(&self, name: &str, photo: &Photo, options: WriteOptions) -> Photo {
        let path = self.path(name);
        photo::write(&path, photo, &WriteOptions { overwrite: true, ..options }).unwrap();
        photo::read(&path).unwrap()
    }
}

/// No two pixels alike, no symmetry: a flip, a turn or a swap of colours would be seen.
fn asymmetric(width: u32, height: u32) -> Photo {
    let pixel = |i: u32| {
        let (x, y) = (i % width, i / width);
        [0.01 + x as f32 * 0.037, 0.02 + y as f32 * 0.11, 0.5 + i as f32 * 1e-4, 1.0]
    };
    Photo::new(width, height, (0..width * height).map(pixel).collect())
}

fn bits(photo: &Photo) -> Vec<[u32; 4]> {
    photo.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

fn with_depth(depth: Depth) -> WriteOptions {
    WriteOptions { depth: Some(depth), ..WriteOptions::default() }
}

fn reason(path: &Path) -> String {
    let text = photo::read(path).unwrap_err().to_string();
    assert!(text.contains(&path.display().to_string()), "{text}");
    text
}

#[test]
fn float_formats_keep_every_bit() {
    let folder = Folder::new();
    let mut photo = asymmetric(19, 7);
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.0, -3.5, 1e-42, f32::MAX];
    for (pixel, &value) in photo.pixels.iter_mut().zip(&odd) {
        pixel[1] = value;
    }
    photo.pixels[9][0] = f32::from_bits(0xffa1_2345);
    for name in ["a.exr", "a.pfm", "a.tif", "A.TIFF"] {
        let back = folder.round_trip(name, &photo);
        assert_eq!((back.width(), back.height()), (19, 7), "{name}");
        assert_eq!(bits(&back), bits(&photo), "{name}");
        assert_eq!(back.depth_name(), "float", "{name}");
        assert!(!back.source.display_referred && !back.source.grey, "{name}");
    }
}

#[test]
fn radiance_is_near_and_does_not_drift() {
    let folder = Folder::new();
    let photo = asymmetric(300, 5);
    let once = folder.round_trip("a.hdr", &photo);
    for (got, want) in once.pixels.iter().zip(&photo.pixels) {
        let brightest = want[0].max(want[1]).max(want[2]);
        assert!((0..3).all(|c| (got[c] - want[c]).abs() <= brightest / 127.0), "{got:?} for {want:?}");
    }
    assert_eq!(folder.round_trip("b.hdr", &once).pixels, once.pixels);
    assert_eq!(once.format_name(), "Radiance HDR");
}

#[test]
fn the_format_is_told_by_content() {
    let folder = Folder::new();
    photo::write(&folder.path("a.exr"), &asymmetric(3, 2), &WriteOptions::default()).unwrap();
    std::fs::rename(folder.path("a.exr"), folder.path("a.png")).unwrap();
    assert_eq!(photo::read(&folder.path("a.png")).unwrap().format_name(), "OpenEXR");
}

#[test]
fn depths_follow_the_input_unless_asked() {
    let folder = Folder::new();
    let linear = asymmetric(4, 3);
    let half = folder.round_trip_as("half.exr", &linear, with_depth(Depth::Half));
    assert_eq!(half.source.depth, Depth::Half);
    assert_eq!(folder.round_trip("again.exr", &half).source.depth, Depth::Half);
    assert_eq!(folder.round_trip_as("float.exr", &half, with_depth(Depth::Float)).source.depth, Depth::Float);
    assert_eq!(folder.round_trip("half.png", &half).source.depth, Depth::Eight);
    let deep = folder.round_trip_as("deep.png", &half, with_depth(Depth::Sixteen));
    assert_eq!(folder.round_trip("deep2.png", &deep).source.depth, Depth::Sixteen);
    assert_eq!(folder.round_trip("deep.tif", &deep).source.depth, Depth::Float);
    let tiff = folder.round_trip_as("sixteen.tif", &deep, with_depth(Depth::Sixteen));
    assert_eq!(folder.round_trip("sixteen2.tif", &tiff).source.depth, Depth::Sixteen);
    assert_eq!(folder.round_trip("deep.exr", &deep).source.depth, Depth::Float);
}

#[test]
fn grey_stays_grey_until_it_gets_a_colour() {
    let folder = Folder::new();
    let mut photo = asymmetric(5, 4);
    photo.source.grey = true;
    photo.pixels.iter_mut().for_each(|p| (p[1], p[2]) = (p[0], p[0]));
    for name in ["a.exr", "a.pfm", "a.tif", "a.png", "a.jpg"] {
        let grey = folder.round_trip(name, &photo);
        assert!(grey.source.grey, "{name}");
        let mut tinted = folder.round_trip(name, &grey);
        assert!(tinted.source.grey, "{name}");
        assert_eq!(bits(&grey).len(), 20);
        tinted.pixels[7][2] *= 0.5;
        let coloured = folder.round_trip(name, &tinted);
        assert!(!coloured.source.grey, "{name}");
    }
}
