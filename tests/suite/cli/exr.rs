//! OpenEXR's parts and layers, and what else of such a file the options are of.

use std::fs::File;
use std::io::BufWriter;

use exr::block::writer::ChunksWriter as _;
use exr::block::{self, UncompressedBlock};
use exr::compression::Compression;
use exr::meta::attribute::{ChannelDescription, LineOrder, SampleType, Text};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, Headers};
use vglare::photo::{self, Photo, Primaries, ReadOptions};

use super::Workplace;

const SIZE: (usize, usize) = (32, 20);

/// A part of these channels, each of one value but for a lamp.
fn part(name: &str, channels: &[&str]) -> Header {
    let list = channels.iter().map(|&name| ChannelDescription::named(name, SampleType::F32)).collect();
    let mut header = Header::new(Text::from(name), SIZE, list);
    header.own_attributes.layer_name = Some(Text::from(name));
    header.with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing)
}

/// Writes parts, whose layers differ.
fn put(place: &Workplace, name: &str, parts: Vec<Header>) {
    let file = BufWriter::new(File::create(place.path(name)).unwrap());
    block::write(file, Headers::from_vec(parts), false, |meta, writer| {
        for (index, block) in meta.enumerate_ordered_header_block_indices() {
            let mut data = Vec::new();
            for y in 0..block.pixel_size.height() {
                for (channel, _) in meta.headers[block.layer].channels.list.iter().enumerate() {
                    for x in 0..block.pixel_size.width() {
                        let lamp = (block.pixel_position.y() + y, x) == (6, 9);
                        let light = if lamp { 500.0 } else { 0.1 * (1 + channel + block.layer) as f32 };
                        data.extend_from_slice(&light.to_ne_bytes());
                    }
                }
            }
            writer.write_chunk(index, UncompressedBlock { index: block, data }.compress_to_chunk(&meta.headers)?)?;
        }
        Ok(())
    })
    .unwrap();
}

fn layer(place: &Workplace, file: &str, part: Option<&str>, layer: Option<&str>) -> Photo {
    let [part, layer] = [part, layer].map(|name| name.map(str::to_owned));
    photo::read_with(&place.path(file), &ReadOptions { part, layer, ..ReadOptions::default() }).unwrap()
}

#[test]
fn the_layer_and_the_part_that_are_named_glare_and_the_others_stay() {
    let place = Workplace::new();
    put(
        &place,
        "in.exr",
        vec![part("rgba", &["B", "G", "R", "key.B", "key.G", "key.R"]), part("fill", &["B", "G", "R"])],
    );
    let all = [(Some("rgba"), Some("")), (Some("rgba"), Some("key")), (Some("fill"), None)];
    for (glares, options) in [
        (0, &[][..]),
        (1, &["--layer", "key"]),
        (1, &["--part", "0", "--layer", "key"]),
        (2, &["--part", "fill"]),
        (2, &["--part", "1"]),
        (2, &["--layer", "fill"]),
    ] {
        let line = ["apply", "in.exr", "-o", "out.exr", "--force", "--sources", "lights"];
        place.vglare(&[&line[..], options].concat()).succeeded();
        for (at, (part, name)) in all.into_iter().enumerate() {
            let same = layer(&place, "in.exr", part, name).pixels == layer(&place, "out.exr", part, name).pixels;
            assert_eq!(same, at != glares, "{options:?}: {part:?} {name:?}");
        }
    }
    // Whatever reads photos knows them.
    let told = place.json(&["info", "in.exr", "--json", "--layer", "key"]);
    assert_eq!(told["layer"], "part rgba, key");
    assert_eq!(told["parts"][0]["layers"], serde_json::json!(["", "key"]));
    assert!(place.vglare(&["info", "in.exr"]).succeeded().stdout().contains("part 1             fill: B, G, R"));
    place.vglare(&["lights", "in.exr", "--part", "fill"]).succeeded();
    place.vglare(&["plan", "in.exr", "--layer", "key"]).succeeded();
    let veil = ["--veil", "gaussian", "--width", "0.1", "--scatter", "0.1"];
    place.vglare(&[&["remove", "in.exr", "-o", "clean.exr", "--layer", "key"][..], &veil].concat()).succeeded();
    let same = |name| {
        layer(&place, "in.exr", Some("rgba"), name).pixels == layer(&place, "clean.exr", Some("rgba"), name).pixels
    };
    assert_eq!([Some(""), Some("key")].map(same), [true, false]);
}

#[test]
fn parts_and_layers_that_are_not_there_are_refused_with_those_that_are() {
    let place = Workplace::new();
    put(
        &place,
        "in.exr",
        vec![part("rgba", &["B", "G", "R", "key.B", "key.G", "key.R"]), part("fill", &["B", "G", "R"])],
    );
    place.photo("in.png");
    let before = place.files();
    for (photo, options, words) in [
        ("in.exr", ["--layer", "rim"], &["in.exr", "no layer rim", "rgba, key, fill"]),
        ("in.exr", ["--part", "2"], &["in.exr", "no part 2", "0 (rgba), 1 (fill)"]),
        ("in.png", ["--layer", "key"], &["in.png", "PNG", "no parts and layers"]),
    ] {
        place.vglare(&[&["apply", photo, "-o", "out.exr"][..], &options].concat()).failed(1, words);
    }
    assert_eq!(place.files(), before);
}

#[test]
fn layers_of_the_glare_add_up_to_the_picture() {
    let place = Workplace::new();
    place.photo("in.exr");
    let read = |file: &str, name: &str| layer(&place, file, None, Some(name)).pixels;
    for (sources, lit, dark) in [("photo", "glare", "lights"), ("lights", "lights", "glare")] {
        let line = ["apply", "in.exr", "-o", "out.exr", "--force", "--layers", "--sources", sources];
        place.vglare(&[&line[..], &["--strength", "2"]].concat()).succeeded();
        let [picture, photo] = ["out.exr", "in.exr"].map(|file| read(file, ""));
        let layers = ["glare", "veil", "lights"].map(|name| read("out.exr", name));
        for (at, (picture, photo)) in picture.iter().zip(&photo).enumerate() {
            for channel in 0..3 {
                let sum = photo[channel] + layers.iter().map(|layer| layer[at][channel]).sum::<f32>();
                let off = (picture[channel] - sum).abs();
                assert!(off <= 1e-5 * photo[channel].abs().max(1e-2), "{at}: {sum} for {}", picture[channel]);
            }
        }
        let is_lit = |layer: &[[f32; 4]]| layer.iter().any(|pixel| pixel[..3] != [0.0; 3]);
        assert!(is_lit(&read("out.exr", lit)) && is_lit(&read("out.exr", "veil")), "{sources}");
        assert!(!is_lit(&read("out.exr", dark)), "{sources}");
    }
    let before = place.files();
    for (line, words) in [
        ("apply in.exr -o o.png --layers", &["--layers", "o.png"][..]),
        ("apply in.exr -o o.exr --layers --mix energy", &["--layers", "--mix energy"]),
        ("apply in.exr --glare g.exr --layers", &["--output"]),
    ] {
        let words_of_line: Vec<&str> = line.split(' ').collect();
        place.vglare(&words_of_line).failed(2, words);
    }
    assert_eq!(place.files(), before);
}

#[test]
fn the_file_says_how_it_was_made_and_in_which_colours() {
    let place = Workplace::new();
    place.photo("in.exr");
    let text = |file: &str, name: &str| {
        let meta = exr::meta::MetaData::read_from_file(place.path(file), false).unwrap();
        let other = &meta.headers[0].own_attributes.other;
        match other.get(&Text::from(name)) {
            Some(exr::meta::attribute::AttributeValue::Text(text)) => text.to_string(),
            _ => String::new(),
        }
    };
    place.vglare(&["apply", "in.exr", "-o", "a.exr", "--glare", "g.exr"]).succeeded();
    place.vglare(&["apply", "a.exr", "-o", "b.exr", "--strength", "0.5", "--colorspace", "ap1"]).succeeded();
    place.vglare(&["apply", "in.exr", "-o", "c.exr", "--strength", "0.5"]).succeeded();
    let looks = ["a.exr", "g.exr", "b.exr", "c.exr"].map(|file| text(file, "vglare.look"));
    assert!(looks[0] == looks[1] && looks[0] != looks[2] && looks[2] == looks[3], "{looks:?}");
    assert!(looks[0].len() == 16 && looks[0].chars().all(|digit| digit.is_ascii_hexdigit()), "{looks:?}");
    // The settings are a scene file, by which the same picture is made.
    std::fs::write(place.path("look.toml"), text("b.exr", "vglare.settings")).unwrap();
    place.vglare(&["apply", "in.exr", "-o", "d.exr", "--scene", "look.toml"]).succeeded();
    assert_eq!(photo::read(&place.path("d.exr")).unwrap().pixels, photo::read(&place.path("c.exr")).unwrap().pixels);
    assert_eq!(text("b.exr", "vglare.version"), env!("CARGO_PKG_VERSION"));
    // In ACEScg, and back.
    assert_eq!(text("b.exr", "colorInteropID"), "lin_ap1_scene");
    assert_eq!(photo::read(&place.path("b.exr")).unwrap().source.primaries, Some(Primaries::ACESCG));
    place.vglare(&["apply", "in.exr", "-o", "o.png", "--colorspace", "ap1"]).failed(1, &["o.png", "display"]);
}
