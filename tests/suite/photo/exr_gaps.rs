//! OpenEXR files that were not finished, or whose sizes lie.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use exr::compression::Compression;
use exr::meta::attribute::{SampleType, Text};
use exr::meta::{BlockDescription, MetaData};
use vglare::photo::{self, Depth, Missing, Photo, ReadOptions, WriteOptions};

use super::exr::{ALL, TILES, content, header, put, with_levels};
use super::{Folder, bits, input, reason, with_depth};

/// Where the table of blocks begins, and its entries.
fn table(bytes: &[u8]) -> (usize, Vec<u64>) {
    let mut cursor = Cursor::new(bytes);
    let meta = MetaData::read_from_buffered(&mut cursor, true).unwrap();
    let (start, count) = (cursor.position() as usize, meta.headers.iter().map(|h| h.chunk_count).sum::<usize>());
    let entries = bytes[start..start + 8 * count].as_chunks().0.iter().map(|&entry| u64::from_le_bytes(entry));
    (start, entries.collect())
}

/// What a writer leaves that stopped before its last `lost` blocks.
fn unfinished(bytes: &[u8], lost: usize) -> Vec<u8> {
    let (start, mut entries) = table(bytes);
    let mut offsets = entries.clone();
    offsets.sort_unstable();
    let end = offsets[offsets.len() - lost];
    entries.iter_mut().filter(|entry| **entry >= end).for_each(|entry| *entry = 0);
    let mut bytes = bytes[..end as usize].to_vec();
    for (k, entry) in entries.iter().enumerate() {
        bytes[start + 8 * k..][..8].copy_from_slice(&entry.to_le_bytes());
    }
    bytes
}

fn without_table(bytes: &[u8]) -> Vec<u8> {
    let (start, entries) = table(bytes);
    let mut bytes = bytes.to_vec();
    bytes[start..start + 8 * entries.len()].fill(0);
    bytes
}

fn with_zeros(path: &Path) -> Photo {
    photo::read_with(path, &ReadOptions { missing: Missing::Zero, primaries: None, ..ReadOptions::default() }).unwrap()
}

#[test]
fn blocks_are_found_where_the_table_is_empty() {
    let folder = Folder::new();
    let mut depth = header(&ALL[4..5], Compression::PIZ, TILES);
    let mut rgb = header(&ALL[1..4], Compression::ZIP16, BlockDescription::ScanLines);
    depth.own_attributes.layer_name = Some(Text::from("depth"));
    rgb.own_attributes.layer_name = Some(Text::from("rgb"));
    let kinds = [
        vec![header(&ALL, Compression::ZIP16, BlockDescription::ScanLines)],
        vec![header(&ALL, Compression::PIZ, TILES)],
        vec![header(&ALL, Compression::ZIP1, with_levels())],
        vec![depth, rgb],
    ];
    for headers in kinds {
        let whole = folder.path("whole.exr");
        put(&whole, headers);
        let bytes = fs::read(&whole).unwrap();
        let got = photo::read(&folder.put("got.exr", &without_table(&bytes))).unwrap();
        let want = photo::read(&whole).unwrap();
        assert!(bits(&got) == bits(&want) && got.source.notes == want.source.notes);
        let (from, to) = (folder.path("from.exr"), folder.path("to.exr"));
        for (photo, path) in [(&want, &from), (&got, &to)] {
            photo::write(path, photo, &WriteOptions { overwrite: true, ..Default::default() }).unwrap();
        }
        assert!(content(&from) == content(&to));
    }
    // Written by hand: pixel (x, y) is (0.2 + x / 64 …), with a lamp of 30.
    let photo = photo::read(&input("exr-no-offset-table.exr")).unwrap();
    let at = |x: usize, y: usize| photo.pixels[y * photo.width() as usize + x];
    for (got, want) in [(at(10, 10), [0.2, 0.25, 0.25]), (at(49, 69), [0.98, 0.25, 0.25]), (at(21, 31), [30.0; 3])] {
        assert!(got.iter().zip(want).all(|(got, want)| (got - want).abs() < 1e-6), "{got:?} for {want:?}");
    }
}

#[test]
fn an_unfinished_file_says_how_much_is_missing_and_is_read_on_request() {
    let folder = Folder::new();
    let whole = folder.path("whole.exr");
    let channels = [("A", SampleType::F32), ("B", SampleType::F32), ("G", SampleType::F32), ("R", SampleType::F32)];
    for (blocks, there) in [(BlockDescription::ScanLines, 16 * 37), (TILES, 8 * 37)] {
        put(&whole, vec![header(&channels, Compression::ZIP16, blocks)]);
        let want = photo::read(&whole).unwrap();
        let bytes = fs::read(&whole).unwrap();
        let total = table(&bytes).1.len();
        // The second of two rows of blocks, or the last six of nine tiles.
        let lost = if total == 2 { 1 } else { 6 };
        let path = folder.put("unfinished.exr", &unfinished(&bytes, lost));
        let text = reason(&path);
        let are = if lost == 1 { "is" } else { "are" };
        let says = format!(
            "the file is unfinished: {lost} of its {total} blocks {are} missing; --missing zero reads the rest"
        );
        assert!(text.ends_with(&says), "{text}");
        let got = with_zeros(&path);
        assert!(bits(&got)[..there] == bits(&want)[..there]);
        assert!(got.pixels[there..].iter().all(|pixel| *pixel == [0.0; 4]));
        assert!(got.source.notes[0].contains("their pixels are 0"), "{:?}", got.source.notes);
        // What is written is whole.
        assert!(bits(&folder.round_trip("again.exr", &got)) == bits(&got));
        // All but the last byte.
        let text = reason(&folder.put("cut.exr", &bytes[..bytes.len() - 1]));
        assert!(text.contains(&format!("cut short: 1 of its {total} blocks is missing")), "{text}");
        let path = folder.put("none.exr", &unfinished(&bytes, total));
        assert!(
            photo::read_with(&path, &ReadOptions { missing: Missing::Zero, primaries: None, ..ReadOptions::default() })
                .is_err()
        );
    }
    // A render that stopped after 2 of 5 blocks.
    let text = reason(&input("exr-unfinished-render.exr"));
    assert!(text.contains("3 of its 5 blocks are missing"), "{text}");
}

#[test]
fn pixels_without_alpha_stay_opaque_and_other_parts_are_filled() {
    let folder = Folder::new();
    let path = folder.path("whole.exr");
    let mut rgb = header(&ALL[1..4], Compression::ZIP16, BlockDescription::ScanLines);
    let mut depth = header(&ALL[4..5], Compression::DWAA(None), BlockDescription::ScanLines);
    rgb.own_attributes.layer_name = Some(Text::from("rgb"));
    depth.own_attributes.layer_name = Some(Text::from("depth"));
    put(&path, vec![rgb, depth]);
    // Blocks lie in the file as the parts do: of rgb's two the second, and depth's one.
    let path = folder.put("unfinished.exr", &unfinished(&fs::read(&path).unwrap(), 2));
    let photo = with_zeros(&path);
    assert!(photo.source.notes[0].contains("2 of its 3 blocks"), "{:?}", photo.source.notes);
    assert!(photo.pixels.iter().all(|pixel| pixel[3] == 1.0));
    let to = folder.path("to.exr");
    photo::write(&to, &photo, &WriteOptions::default()).unwrap();
    let (_, blocks) = content(&to);
    let of_depth: Vec<&Vec<u8>> = blocks.iter().filter(|(at, _)| at[0] == 1).map(|(_, bytes)| bytes).collect();
    assert!(of_depth.len() == 1 && of_depth[0].iter().all(|&byte| byte == 0));
}

#[test]
fn other_parts_that_lack_gigabytes_are_not_filled() {
    let folder = Folder::new();
    let path = folder.path("whole.exr");
    let mut rgb = header(&ALL[1..4], Compression::ZIP16, BlockDescription::ScanLines);
    let mut depth = header(&ALL[4..5], Compression::ZIP16, BlockDescription::ScanLines);
    rgb.own_attributes.layer_name = Some(Text::from("rgb"));
    depth.own_attributes.layer_name = Some(Text::from("depth"));
    put(&path, vec![rgb, depth]);
    let mut bytes = unfinished(&fs::read(&path).unwrap(), 2);
    let at = bytes.windows(17).rposition(|bytes| bytes == b"dataWindow\0box2i\0").unwrap() + 21;
    bytes[at + 8..at + 12].copy_from_slice(&99_999_999_i32.to_le_bytes());
    let path = folder.put("wide.exr", &bytes);
    let options = ReadOptions { missing: Missing::Zero, primaries: None, ..ReadOptions::default() };
    let text = photo::read_with(&path, &options).unwrap_err().to_string();
    assert!(text.contains("too much to be filled"), "{text}");
}

#[test]
fn deep_data_is_refused_by_name() {
    // Of OpenEXR 3.1.5's DeepScanLineOutputFile.
    let text = reason(&input("exr-deep.exr"));
    assert!(text.ends_with("it holds deep data, which vglare does not read"), "{text}");
}

#[test]
fn compressions_of_newer_versions_are_refused_by_name() {
    // Of OpenEXR 3.5.3's Python module.
    let text = reason(&input("exr-htj2k.exr"));
    assert!(text.ends_with("it is compressed by HTJ2K, which vglare does not read"), "{text}");
    let text = reason(&input("exr-zstd.exr"));
    assert!(text.ends_with("it is compressed by Zstandard, which vglare does not read"), "{text}");
}

#[test]
fn sizes_are_checked_before_a_decoder_takes_memory() {
    let text = reason(&input("exr-dwa-counters.exr"));
    assert!(text.contains("counters of a DWA block"), "{text}");
    let folder = Folder::new();
    let black = Photo::new(64, 16, vec![[0.0, 0.0, 0.0, 1.0]; 64 * 16]);
    folder.round_trip_as("black.exr", &black, with_depth(Depth::Half));
    let bytes = fs::read(folder.path("black.exr")).unwrap();
    let widened = |width: i32| {
        let mut bytes = bytes.clone();
        let at = bytes.windows(17).position(|bytes| bytes == b"dataWindow\0box2i\0").unwrap() + 21;
        bytes[at + 8..at + 12].copy_from_slice(&(width - 1).to_le_bytes());
        folder.put("wide.exr", &bytes)
    };
    // One block of ZIP: 6 bytes a pixel, 16 rows.
    let text = reason(&widened(8_000_000));
    assert!(text.contains("cannot be a block of 768000000"), "{text}");
    let text = reason(&widened(30_000_000));
    assert!(text.contains("a block has 2880000000 bytes, more than"), "{text}");
    // A block that stands where another should.
    let (start, entries) = table(&bytes);
    let mut twice = bytes.clone();
    twice.extend_from_slice(&bytes[entries[0] as usize..]);
    twice[start..start + 8].fill(0);
    let text = reason(&folder.put("twice.exr", &twice));
    assert!(text.contains("a block is there twice"), "{text}");
}
