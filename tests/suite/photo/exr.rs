//! OpenEXR: nothing is lost.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::Path;

use exr::block::reader::ChunksReader;
use exr::block::writer::ChunksWriter;
use exr::block::{self, BlockIndex, UncompressedBlock};
use exr::compression::Compression;
use exr::math::{RoundingMode, Vec2};
use exr::meta::attribute::{
    AttributeValue, ChannelDescription, Chromaticities, IntegerBounds, LevelMode, LineOrder, SampleType, Text,
    TileDescription,
};
use exr::meta::header::{Header, LayerAttributes};
use exr::meta::{BlockDescription, Headers};
use vglare::frame::{Frame, Window};
use vglare::photo::{self, Alpha, Depth, ToneMap, WriteOptions};

use super::{Folder, bits};

pub(super) const TILES: BlockDescription = BlockDescription::Tiles(TileDescription {
    tile_size: Vec2(16, 8),
    level_mode: LevelMode::Singular,
    rounding_mode: RoundingMode::Down,
});

pub(super) fn header(channels: &[(&str, SampleType)], compression: Compression, blocks: BlockDescription) -> Header {
    let list = channels.iter().map(|&(name, kind)| ChannelDescription::named(name, kind)).collect();
    let mut header = Header::new(Text::from("x"), (37, 21), list);
    header.own_attributes.layer_name = None;
    header.own_attributes.layer_position = Vec2(7, 25);
    header.own_attributes.owner = Some(Text::from("someone"));
    header.own_attributes.exposure = Some(0.25);
    header.own_attributes.other.insert(Text::from("shot"), AttributeValue::Text(Text::from("a12")));
    header.own_attributes.other.insert(Text::from("lens"), AttributeValue::F64(1.0 / 3.0));
    header.shared_attributes.display_window = IntegerBounds::new((10, 20), (40, 30));
    header.shared_attributes.pixel_aspect = 1.5;
    header.with_encoding(compression, blocks, LineOrder::Increasing)
}

/// Bytes of any value: among them NaNs of every kind, infinities, denormals.
fn noise(block: BlockIndex, bytes: usize) -> Vec<u8> {
    let seed = block.layer * 7919 + block.pixel_position.0 * 131 + block.pixel_position.1 * 31 + block.level.0;
    let mut state = seed as u64 + 1;
    let next = |_| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as u8
    };
    (0..bytes).map(next).collect()
}

pub(super) fn put(path: &Path, headers: Vec<Header>) {
    let file = BufWriter::new(File::create(path).unwrap());
    block::write(file, Headers::from_vec(headers), false, |meta, writer| {
        for (index, block) in meta.enumerate_ordered_header_block_indices() {
            let bytes = block.pixel_size.area() * meta.headers[block.layer].channels.bytes_per_pixel;
            let block = UncompressedBlock { index: block, data: noise(block, bytes) };
            writer.write_chunk(index, block.compress_to_chunk(&meta.headers)?)?;
        }
        Ok(())
    })
    .unwrap();
}

pub(super) type Blocks = BTreeMap<[usize; 4], Vec<u8>>;

/// Headers and decompressed bytes of every block.
pub(super) fn content(path: &Path) -> (Headers, Blocks) {
    let reader = block::read(BufReader::new(File::open(path).unwrap()), false).unwrap();
    let headers = reader.meta_data().headers.clone();
    let mut blocks = Blocks::new();
    let reader = reader.filter_chunks(false, |_, _, _| true).unwrap();
    reader
        .decompress_sequential(false, |_, block| {
            let at = block.index;
            blocks.insert([at.layer, at.level.0, at.pixel_position.0, at.pixel_position.1], block.data);
            Ok(())
        })
        .unwrap();
    (headers, blocks)
}

pub(super) const ALL: [(&str, SampleType); 7] = [
    ("A", SampleType::F16),
    ("B", SampleType::F16),
    ("G", SampleType::F32),
    ("R", SampleType::F16),
    ("Z", SampleType::F32),
    ("diffuse.R", SampleType::F16),
    ("id", SampleType::U32),
];

#[test]
fn what_was_read_is_written_bit_for_bit() {
    let folder = Folder::new();
    let (from, to) = (folder.path("from.exr"), folder.path("to.exr"));
    for compression in
        [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::ZIP16, Compression::PIZ]
    {
        for blocks in [BlockDescription::ScanLines, TILES] {
            put(&from, vec![header(&ALL, compression, blocks)]);
            let photo = photo::read(&from).unwrap();
            photo::write(&to, &photo, &WriteOptions { overwrite: true, ..Default::default() }).unwrap();
            assert!(content(&from) == content(&to), "{compression} {blocks:?}");
        }
    }
}

#[test]
fn other_parts_ride_along_even_lossy_ones() {
    let folder = Folder::new();
    let (from, to) = (folder.path("from.exr"), folder.path("to.exr"));
    let part = |name: &str, channels: &[(&str, SampleType)], compression, blocks| {
        let mut header = header(channels, compression, blocks);
        header.own_attributes.layer_name = Some(Text::from(name));
        header
    };
    let mut far = part("far", &[("Z", SampleType::F16)], Compression::B44, BlockDescription::ScanLines);
    far.own_attributes.layer_position = Vec2(-100, 3);
    let mut mips = part("mips", &[("U", SampleType::U32)], Compression::ZIP1, TILES);
    mips.blocks = with_levels();
    let (zip, order) = (mips.compression, mips.line_order);
    let mips = mips.clone().with_encoding(zip, mips.blocks, order);
    let main = part("rgb", &ALL[1..4], Compression::PIZ, BlockDescription::ScanLines);
    put(&from, vec![far, main, mips]);
    let mut photo = photo::read(&from).unwrap();
    photo::write(&to, &photo, &WriteOptions::default()).unwrap();
    assert!(content(&from) == content(&to));
    // A changed pixel changes the main part alone.
    photo.pixels[5] = [1.0, 2.0, 3.0, 1.0];
    photo::write(&to, &photo, &WriteOptions { overwrite: true, ..Default::default() }).unwrap();
    let (mut before, mut after) = (content(&from).1, content(&to).1);
    assert!(before != after);
    before.retain(|at, _| at[0] != 1);
    after.retain(|at, _| at[0] != 1);
    assert!(before == after);
}

pub(super) fn with_levels() -> BlockDescription {
    BlockDescription::Tiles(TileDescription {
        tile_size: Vec2(16, 8),
        level_mode: LevelMode::MipMap,
        rounding_mode: RoundingMode::Up,
    })
}

#[test]
fn the_largest_level_is_the_picture() {
    let folder = Folder::new();
    let (from, to) = (folder.path("from.exr"), folder.path("to.exr"));
    put(&from, vec![header(&ALL, Compression::ZIP16, with_levels())]);
    let mut photo = photo::read(&from).unwrap();
    let last = photo.pixels.len() - 1;
    photo.pixels[last] = [1.0, 2.0, 3.0, 1.0];
    photo::write(&to, &photo, &WriteOptions::default()).unwrap();
    let mut want = content(&from).1;
    want.retain(|at, _| at[1] == 0);
    let (headers, mut got) = content(&to);
    // The one that has changed, in which the other tiles are as they were.
    let changed = want.pop_last().zip(got.pop_last()).is_some_and(|(before, after)| before != after);
    assert!(changed && got == want);
    let BlockDescription::Tiles(tiles) = headers[0].blocks else { panic!("no tiles") };
    assert_eq!((tiles.tile_size, tiles.level_mode), (Vec2(16, 8), LevelMode::Singular));
}

const LOSSY: [Compression; 4] =
    [Compression::B44, Compression::B44A, Compression::PXR24, Compression::DWAA(Some(45.0))];

#[test]
fn a_lossy_picture_loses_no_more() {
    let folder = Folder::new();
    for compression in LOSSY {
        let path = folder.path("lossy.exr");
        put(&path, vec![header(&ALL, compression, BlockDescription::ScanLines)]);
        let photo = photo::read(&path).unwrap();
        let again = folder.round_trip("again.exr", &photo);
        assert_eq!(bits(&again), bits(&photo), "{compression}");
    }
}

#[test]
fn windows_and_attributes_are_told() {
    let folder = Folder::new();
    let path = folder.path("a.exr");
    let mut header = header(&ALL, Compression::ZIP16, BlockDescription::ScanLines);
    header.shared_attributes.chromaticities = Some(ACESCG);
    put(&path, vec![header]);
    let photo = photo::read(&path).unwrap();
    let window = Window { x: -3, y: 5, width: 37, height: 21 };
    assert_eq!(photo.frame, Frame { pixel_aspect: 1.5, ..Frame::full(40, 30).with_window(window) });
    assert_eq!((photo.source.alpha, photo.source.depth), (Alpha::Premultiplied, Depth::Float));
    let weights = photo.luminance_weights();
    assert!((weights[0] - 0.2722).abs() < 1e-3 && (weights.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{weights:?}");
    assert_eq!((photo.format_name(), photo.depth_name()), ("OpenEXR", "float"));
}

/// ACES AP1 with the white of ACES.
pub(super) const ACESCG: Chromaticities = Chromaticities {
    red: Vec2(0.713, 0.293),
    green: Vec2(0.165, 0.83),
    blue: Vec2(0.128, 0.044),
    white: Vec2(0.32168, 0.33767),
};

#[test]
fn other_formats_get_rec709() {
    let folder = Folder::new();
    let path = folder.path("a.exr");
    let channels = [("B", SampleType::F32), ("G", SampleType::F32), ("R", SampleType::F32)];
    let mut header = header(&channels, Compression::ZIP16, BlockDescription::ScanLines);
    header.shared_attributes.chromaticities = Some(ACESCG);
    header.shared_attributes.display_window = IntegerBounds::new((7, 25), (37, 21));
    put(&path, vec![header]);
    let mut photo = photo::read(&path).unwrap();
    photo.pixels.fill([0.5, 0.5, 0.5, 1.0]);
    photo.pixels[0] = [0.5, 0.1, 0.2, 1.0];
    // Published ACEScg to Rec.709.
    let want = [0.7737, 0.0468, 0.2057, 1.0];
    for (name, tolerance) in [("a.pfm", 1e-3), ("a.tif", 1e-3), ("a.hdr", 6e-3), ("a.png", 1e-2)] {
        let tone_map = name.ends_with("png").then_some(ToneMap::None);
        let got = folder.round_trip_as(name, &photo, WriteOptions { tone_map, ..Default::default() });
        let near = |got: [f32; 4], want: [f32; 4]| got.iter().zip(want).all(|(g, w)| (g - w).abs() < tolerance);
        assert!(near(got.pixels[0], want) && near(got.pixels[9], [0.5, 0.5, 0.5, 1.0]), "{name}: {:?}", got.pixels[0]);
        assert!(got.source.primaries.is_none());
    }
    let kept = folder.round_trip("b.exr", &photo);
    assert_eq!((kept.pixels[0], kept.source.primaries), (photo.pixels[0], photo.source.primaries));
}

#[test]
fn integer_colours_stay_integers() {
    let folder = Folder::new();
    let (from, to) = (folder.path("from.exr"), folder.path("to.exr"));
    let channels = [("B", SampleType::U32), ("G", SampleType::U32), ("R", SampleType::U32)];
    put(&from, vec![header(&channels, Compression::ZIP16, BlockDescription::ScanLines)]);
    let photo = photo::read(&from).unwrap();
    assert_eq!(photo.source.depth, Depth::Uint);
    photo::write(&to, &photo, &WriteOptions::default()).unwrap();
    assert!(content(&from) == content(&to));
    let half =
        folder.round_trip_as("half.exr", &photo, WriteOptions { depth: Some(Depth::Half), ..Default::default() });
    assert!(half.pixels.iter().flatten().all(|c| c.is_finite()), "beyond half's range is its largest value");
}

#[test]
fn damage_under_any_compression_is_no_panic() {
    let folder = Folder::new();
    let lossless =
        [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::ZIP16, Compression::PIZ];
    let mut state = 1_u64;
    for compression in lossless.into_iter().chain(LOSSY) {
        for blocks in [BlockDescription::ScanLines, with_levels()] {
            let path = folder.path("whole.exr");
            put(&path, vec![header(&ALL, compression, blocks)]);
            let whole = std::fs::read(&path).unwrap();
            for round in 0..ROUNDS {
                let mut bytes = whole.clone();
                for _ in 0..=round % 4 {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    let at = (state >> 33) as usize % bytes.len();
                    bytes[at] ^= 1 << (state >> 20 & 7);
                }
                if let Err(error) = photo::read(&folder.put("damaged.exr", &bytes)) {
                    assert!(error.to_string().contains("damaged.exr"), "{error}");
                }
            }
        }
    }
}

const ROUNDS: usize = 20;

#[test]
fn luminance_that_gets_a_colour_becomes_three_channels() {
    let folder = Folder::new();
    let path = folder.path("y.exr");
    let channels = [("Y", SampleType::F16), ("Z", SampleType::F32)];
    put(&path, vec![header(&channels, Compression::ZIP16, BlockDescription::ScanLines)]);
    let mut photo = photo::read(&path).unwrap();
    assert!(photo.source.grey);
    photo.pixels[0] = [1.0, 2.0, 3.0, 1.0];
    let to = folder.path("rgb.exr");
    photo::write(&to, &photo, &WriteOptions::default()).unwrap();
    let names: Vec<_> = content(&to).0[0].channels.list.iter().map(|c| c.name.to_string()).collect();
    assert_eq!(names, ["B", "G", "R", "Z"]);
    assert_eq!(photo::read(&to).unwrap().pixels[0], [1.0, 2.0, 3.0, 1.0]);
}

#[test]
fn other_formats_get_the_picture_padded_with_black() {
    let folder = Folder::new();
    let path = folder.path("a.exr");
    let cases = [(-3, 5, 37, 21), (50, 50, 4, 4), (-9, -9, 60, 60), (39, 29, 9, 9), (-1, 0, 1, 30), (2, 3, 4, 5)];
    for (x, y, width, height) in cases {
        let mut photo = super::asymmetric(width, height);
        photo.frame = Frame::full(40, 30).with_window(Window { x, y, width, height });
        let kept = folder.round_trip("a.exr", &photo);
        assert_eq!((kept.frame, bits(&kept)), (photo.frame, bits(&photo)));
        let cropped = folder.round_trip("a.pfm", &photo::read(&path).unwrap());
        assert_eq!(cropped.frame, Frame::full(40, 30));
        for (i, got) in cropped.pixels.iter().enumerate() {
            let (column, row) = (i as i32 % 40 - x, i as i32 / 40 - y);
            let inside = (0..width as i32).contains(&column) && (0..height as i32).contains(&row);
            let stored = inside.then(|| photo.pixels[(row * width as i32 + column) as usize]);
            assert_eq!(*got, stored.unwrap_or([0.0, 0.0, 0.0, 1.0]), "{x} {y}: {column} {row}");
        }
    }
}

#[test]
fn a_companion_keeps_what_the_file_says_of_itself_and_no_more() {
    let folder = Folder::new();
    let tiled = header(&ALL, Compression::ZIP16, TILES);
    let mut named = header(&ALL, Compression::PIZ, BlockDescription::ScanLines);
    named.shared_attributes.chromaticities = Some(ACESCG);
    named.own_attributes.multi_view_names = Some(vec![Text::from("left"), Text::from("right")]);
    for (header, depth) in [(tiled, Depth::Float), (named, Depth::Half)] {
        let path = folder.path("a.exr");
        put(&path, vec![header.clone()]);
        let photo = photo::read(&path).unwrap();
        let pixels: Vec<_> =
            (0..photo.pixels.len()).map(|k| [k as f32 * 0.25, 0.5, 1.0 / (k + 1) as f32, 1.0]).collect();
        let glare = photo.companion(pixels.clone());
        let options = WriteOptions { depth: Some(depth), overwrite: true, ..WriteOptions::default() };
        photo::write(&folder.path("b.exr"), &glare, &options).unwrap();
        let again = photo::read(&folder.path("b.exr")).unwrap();
        assert_eq!((again.frame, again.source.primaries), (photo.frame, photo.source.primaries));
        assert_eq!((again.source.depth, again.source.alpha), (depth, Alpha::None));
        if depth == Depth::Float {
            assert_eq!(again.pixels, pixels);
        }
        let (headers, _) = content(&folder.path("b.exr"));
        assert_eq!(headers.len(), 1);
        let names: Vec<_> = headers[0].channels.list.iter().map(|channel| channel.name.to_string()).collect();
        assert_eq!(names, ["B", "G", "R"]);
        assert_eq!(headers[0].shared_attributes, header.shared_attributes);
        let own = LayerAttributes { multi_view_names: None, ..header.own_attributes.clone() };
        assert_eq!(headers[0].own_attributes, own);
    }
}
