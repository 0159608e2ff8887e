//! OpenEXR files with subsampled channels.
//!
//! The luminance-chroma inputs are R = 0.2 + x / 64, G = 0.5, B = 0.3 + y / 128 at 32 × 32 pixels, written by OpenEXR
//! 3.1.5's `RgbaOutputFile` with `WRITE_YC`. That library's `RgbaInputFile` reads them with errors up to 0.0044 inside
//! of a border of four pixels, and 0.0112 with it: half precision of Y and of the chroma, and the filters' edges.

use std::fs;

use vglare::photo::{self, WriteOptions};

use super::{Folder, bits, input};

const INPUTS: [&str; 5] = ["zip", "piz", "pxr24", "b44", "dwaa"];

#[test]
fn luminance_and_chroma_become_red_green_and_blue() {
    for kind in INPUTS {
        let photo = photo::read(&input(&format!("exr-luminance-chroma-{kind}.exr"))).unwrap();
        assert_eq!((photo.width(), photo.height(), photo.depth_name()), (32, 32, "half float"));
        assert!(!photo.source.grey && photo.source.notes[0].contains("luminance and chroma"));
        let (mut inner, mut outer) = (0.0_f32, 0.0_f32);
        for (i, pixel) in photo.pixels.iter().enumerate() {
            let (x, y) = (i % 32, i / 32);
            let want = [0.2 + x as f32 / 64.0, 0.5, 0.3 + y as f32 / 128.0, 1.0];
            let worst = pixel.iter().zip(want).map(|(got, want)| (got - want).abs()).fold(0.0, f32::max);
            let is_inner = (4..28).contains(&x) && (4..28).contains(&y);
            let seen = if is_inner { &mut inner } else { &mut outer };
            *seen = seen.max(worst);
        }
        println!("{kind}: off by {inner} inside, {outer} at the border");
        assert!(inner < 5e-3 && outer < 1.5e-2, "{kind}: {inner} {outer}");
    }
}

#[test]
fn an_unchanged_picture_goes_back_as_it_came_and_a_changed_one_in_full() {
    let folder = Folder::new();
    for kind in INPUTS {
        let from = input(&format!("exr-luminance-chroma-{kind}.exr"));
        let mut photo = photo::read(&from).unwrap();
        let to = folder.path("to.exr");
        photo::write(&to, &photo, &WriteOptions { overwrite: true, ..Default::default() }).unwrap();
        // Headers may be in another order; what follows the table is the same.
        let (before, after) = (fs::read(&from).unwrap(), fs::read(&to).unwrap());
        let tail = before.len() / 2;
        assert!(before[tail..] == after[after.len() - (before.len() - tail)..], "{kind}");
        assert!(bits(&photo::read(&to).unwrap()) == bits(&photo), "{kind}");
        photo.pixels[5] = [1.0, 2.0, 3.0, 1.0];
        let full = folder.round_trip("full.exr", &photo);
        assert!(full.pixels[5] == [1.0, 2.0, 3.0, 1.0] && full.source.notes.is_empty());
        let near = |(a, b): (&f32, &f32)| (a - b).abs() < 1e-3;
        assert!(
            full.pixels.as_flattened().iter().zip(photo.pixels.as_flattened()).all(near),
            "{kind}: half's rounding"
        );
        let bytes = fs::read(folder.path("full.exr")).unwrap();
        assert!(!bytes.windows(3).any(|name| name == b"RY\0"), "{kind}: chroma is left beside the colours");
    }
}

/// Written by hand as numpy's float32: R = 0.25 + x / 8, G = 0.5, B = 0.125 + y / 8 at 6 × 4, with a sample of each
/// channel at each pixel.
#[test]
fn chroma_that_is_whole_goes_back_as_it_came_too() {
    let folder = Folder::new();
    let photo = photo::read(&input("exr-luminance-chroma-full.exr")).unwrap();
    for (i, pixel) in photo.pixels.iter().enumerate() {
        let want = [0.25 + (i % 6) as f32 / 8.0, 0.5, 0.125 + (i / 6) as f32 / 8.0, 1.0];
        assert!(pixel.iter().zip(want).all(|(got, want)| (got - want).abs() < 1e-6), "{i}: {pixel:?}");
    }
    let again = folder.round_trip("again.exr", &photo);
    assert!(bits(&again) == bits(&photo));
    let bytes = fs::read(folder.path("again.exr")).unwrap();
    assert!(bytes.windows(3).any(|name| name == b"RY\0"), "luminance and chroma have become colours");
}
