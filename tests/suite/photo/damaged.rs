//! Files that are not what they should be: an error that names the file, never a panic, never a flood of memory.

use std::fs;

use vglare::photo::{self, Depth, Photo, WriteOptions};

use super::{Folder, asymmetric, bits, reason, with_depth};

/// One small file of each kind that is written, as (name, bytes, photo).
fn samples(folder: &Folder) -> Vec<(&'static str, Vec<u8>, Photo)> {
    let photo = asymmetric(21, 13);
    let kinds = [
        ("float.exr", WriteOptions::default()),
        ("half.exr", with_depth(Depth::Half)),
        ("a.hdr", WriteOptions::default()),
        ("a.pfm", WriteOptions::default()),
        ("float.tif", WriteOptions::default()),
        ("eight.tif", with_depth(Depth::Eight)),
        ("eight.png", WriteOptions::default()),
        ("sixteen.png", with_depth(Depth::Sixteen)),
        ("a.jpg", WriteOptions::default()),
    ];
    let file = |(name, options)| {
        let photo = folder.round_trip_as(name, &photo, options);
        (name, fs::read(folder.path(name)).unwrap(), photo)
    };
    kinds.into_iter().map(file).collect()
}

#[test]
fn a_file_that_is_cut_short_is_an_error() {
    let folder = Folder::new();
    for (name, bytes, whole) in samples(&folder) {
        let mut refused = 0;
        let step = bytes.len() / 150 + 1;
        for length in (0..bytes.len()).step_by(step) {
            let path = folder.put(name, &bytes[..length]);
            match photo::read(&path) {
                Err(error) => {
                    assert!(error.to_string().contains(name), "{error}");
                    refused += 1;
                }
                // What follows the pixels may be missing.
                Ok(photo) => assert_eq!(bits(&photo), bits(&whole), "{name} cut at {length} of {}", bytes.len()),
            }
        }
        assert!(refused * step * 10 > bytes.len() * 9, "{name}: {refused} refused");
        let text = reason(&folder.put(name, &bytes[..bytes.len() * 3 / 4]));
        assert!(text.contains("cut short") || text.contains("end"), "{text}");
    }
}

#[test]
fn a_flipped_bit_is_no_panic() {
    let folder = Folder::new();
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for (name, bytes, _) in samples(&folder) {
        for round in 0..200 {
            let mut damaged = bytes.clone();
            for _ in 0..=round % 3 {
                // The headers are where the harm is.
                let at = if round % 2 == 0 { random(bytes.len().min(400)) } else { random(bytes.len()) };
                damaged[at] ^= 1 << random(8);
            }
            if let Err(error) = photo::read(&folder.put(name, &damaged)) {
                assert!(error.to_string().contains(name), "{error}");
            }
        }
    }
}

#[test]
fn absurd_sizes_are_refused_before_memory_is_taken() {
    let folder = Folder::new();
    let be = |v: u32| v.to_be_bytes();
    let png = |width: u32, height: u32| {
        let mut header = b"IHDR".to_vec();
        header.extend([be(width), be(height)].concat());
        header.extend([8, 2, 0, 0, 0]);
        let crc = crc32(&header);
        [&b"\x89PNG\r\n\x1a\n\0\0\0\x0d"[..], &header, &be(crc), b"\0\0\0\0IDAT"].concat()
    };
    let hdr = |w: u32, h: u32| format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {h} +X {w}\n").into_bytes();
    let pfm = |w: u32, h: u32| format!("PF\n{w} {h}\n-1.0\n").into_bytes();
    let jpeg = |w: u32, h: u32| {
        let (w, h) = ((w as u16).to_be_bytes(), (h as u16).to_be_bytes());
        [&b"\xff\xd8\xff\xc0\0\x0b\x08"[..], &h, &w, b"\x01\x01\x11\0\xff\xda\0\x08\x01\x01\0\0\x3f\0\xff\xd9"].concat()
    };
    for (name, file) in [("a.png", &png as &dyn Fn(u32, u32) -> Vec<u8>), ("a.hdr", &hdr), ("a.pfm", &pfm)] {
        let text = reason(&folder.put(name, &file(100_000, 100_000)));
        assert!(text.contains("more than"), "{text}");
        // Below the limit, but not there.
        reason(&folder.put(name, &file(20_000, 20_000)));
        reason(&folder.put(name, &file(0, 0)));
        reason(&folder.put(name, &file(7, 0)));
    }
    let text = reason(&folder.put("a.jpg", &jpeg(65_000, 65_000)));
    assert!(text.contains("more than"), "{text}");
    reason(&folder.put("a.jpg", &jpeg(0, 0)));
}

pub(super) fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for &byte in bytes {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
        }
    }
    !crc
}

#[test]
fn absurd_sizes_in_headers_of_numbers_are_refused() {
    let folder = Folder::new();
    for (name, bytes, _) in samples(&folder).into_iter().filter(|(name, ..)| name.ends_with("exr")) {
        // The windows stand as four little-endian numbers after their type and size.
        let patched = |largest: i32, smallest: i32| {
            let mut bytes = bytes.clone();
            for start in
                (0..bytes.len() - 40).filter(|&i| bytes[i..].starts_with(b"dataWindow\0box2i\0")).collect::<Vec<_>>()
            {
                let window = [smallest, smallest, largest, largest].map(i32::to_le_bytes);
                bytes[start + 21..start + 37].copy_from_slice(window.as_flattened());
            }
            bytes
        };
        for (largest, smallest) in [(99_999, 0), (i32::MAX, i32::MIN), (i32::MAX - 1, 0), (0, 5), (-1, 0), (20_000, 0)]
        {
            reason(&folder.put(name, &patched(largest, smallest)));
        }
    }
    for (name, bytes, _) in samples(&folder).into_iter().filter(|(name, ..)| name.ends_with("tif")) {
        let ifd = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
        for size in [0_u32, 100_000, u32::MAX, 20_000] {
            let mut bytes = bytes.clone();
            for entry in 0..usize::from(bytes[ifd]) {
                let at = ifd + 2 + entry * 12;
                // Width and height are tags 256 and 257.
                if bytes[at + 1] == 1 && bytes[at] < 2 {
                    bytes[at + 2] = 4;
                    bytes[at + 8..at + 12].copy_from_slice(&size.to_le_bytes());
                }
            }
            reason(&folder.put(name, &bytes));
        }
    }
}

#[test]
fn what_is_no_picture_says_so() {
    let folder = Folder::new();
    let cases: [(&str, &[u8], &str); 5] = [
        ("empty.exr", b"", "empty"),
        ("text.png", b"hello, world, this is no picture at all", "not a picture"),
        ("short.exr", b"\x76\x2f", "not a picture"),
        ("a.exr", b"GIF89a\x01\0\x01\0\0\0\0", "GIF"),
        ("b.exr", b"\x76\x2f\x31\x01\x02\0\0\0", "cut short"),
    ];
    for (name, bytes, why) in cases {
        let text = reason(&folder.put(name, bytes));
        assert!(text.contains(why), "{name}: {text}");
    }
    assert!(reason(&folder.path(".")).contains("folder"));
    assert!(reason(&folder.path("missing.exr")).contains("No such file") || cfg!(not(unix)));
}

#[cfg(unix)]
#[test]
fn what_may_not_be_read_is_an_error() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let path = folder.put("a.pfm", b"Pf 1 1 -1\n\0\0\0\0");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o000)).unwrap();
    // Root may read anything; others get the system's words.
    if let Err(error) = photo::read(&path) {
        assert!(error.to_string().contains("ermission"), "{error}");
    }
    if std::path::Path::new("/dev/zero").exists() {
        assert!(reason(std::path::Path::new("/dev/zero")).contains("not a picture"));
    }
}
