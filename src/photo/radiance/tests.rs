use glam::DVec3;
use image::codecs::hdr::HdrDecoder as Independent;

use super::super::{WhiteLuminance, luminance};
use super::*;

fn round_trip(pixels: Vec<[f32; 4]>) -> Vec<[f32; 4]> {
    let mut file = Vec::new();
    write(&mut file, &Photo::new(pixels.len() as u32, 1, pixels)).unwrap();
    read(Cursor::new(file), &ReadOptions::default()).unwrap().pixels
}

#[test]
fn extremes_stay_in_place() {
    let values = [f32::NAN, f32::NEG_INFINITY, -1.0, 1e-45, 1e-39, f32::INFINITY, f32::MAX, LARGEST, 1e38, 0.75];
    let got = round_trip(values.iter().map(|&v| [v, v, v, 1.0]).collect());
    let got: Vec<f32> = got.iter().map(|p| p[1]).collect();
    assert_eq!(got[..5], [0.0; 5]);
    assert_eq!(got[5..8], [LARGEST; 3]);
    assert!((got[8] / 1e38 - 1.0).abs() < 0.01 && got[9] == 0.75, "{got:?}");
}

/// 3 × 2 pixels, flat: (column + 1, row + 1, 8) / 8, in the order that the resolution line says.
fn file(header: &str, resolution: &str, end: &str, places: &[(u8, u8)]) -> Vec<u8> {
    let header = header.replace('\n', end);
    let mut file = format!("#?RADIANCE{end}{header}{end}{resolution}{end}").into_bytes();
    // Mantissa over 256, times 2^(exponent - 128).
    file.extend(places.iter().flat_map(|&(x, y)| [32 * (x + 1), 32 * (y + 1), 255, 128]));
    file
}

const UPRIGHT: [(u8, u8); 6] = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)];

fn photo(file: Vec<u8>) -> Photo {
    read(Cursor::new(file), &ReadOptions::default()).unwrap()
}

fn places(photo: &Photo) -> Vec<(u8, u8)> {
    photo.pixels.iter().map(|p| ((p[0] * 8.0) as u8 - 1, (p[1] * 8.0) as u8 - 1)).collect()
}

#[test]
fn every_orientation_is_turned_upright() {
    // [FMT]: the first axis is that from scanline to scanline; Y goes up, X to the right.
    let (rows, columns) = (
        |y: [u8; 2], x: [u8; 3]| y.map(|y| x.map(|x| (x, y))).concat(),
        |x: [u8; 3], y: [u8; 2]| x.map(|x| y.map(|y| (x, y))).concat(),
    );
    let cases = [
        ("-Y 2 +X 3", rows([0, 1], [0, 1, 2])),
        ("-Y 2 -X 3", rows([0, 1], [2, 1, 0])),
        ("+Y 2 +X 3", rows([1, 0], [0, 1, 2])),
        ("+Y 2 -X 3", rows([1, 0], [2, 1, 0])),
        ("+X 3 -Y 2", columns([0, 1, 2], [0, 1])),
        ("-X 3 -Y 2", columns([2, 1, 0], [0, 1])),
        ("+X 3 +Y 2", columns([0, 1, 2], [1, 0])),
        ("-X 3 +Y 2", columns([2, 1, 0], [1, 0])),
    ];
    for (resolution, order) in cases {
        let photo = photo(file("", resolution, "\n", &order));
        assert_eq!((photo.width(), photo.height()), (3, 2), "{resolution}");
        assert_eq!(places(&photo), UPRIGHT, "{resolution}");
    }
}

#[test]
fn headers_of_many_writers_are_read() {
    let format = "FORMAT=32-bit_rle_rgbe\n";
    let headers = [
        file(format, "-Y 2 +X 3", "\r\n", &UPRIGHT),
        file("# made by hand\nrpict -x 3 -y 2 a.oct\n\tFORMAT=of another\n", "-Y 2 +X 3", "\n", &UPRIGHT),
        // No blank line.
        [b"#?RGBE\nFORMAT=32-bit_rle_rgbe\n".to_vec(), file("", "-Y 2 +X 3", "\n", &UPRIGHT)[12..].to_vec()].concat(),
    ];
    for header in headers {
        let text = String::from_utf8_lossy(&header[..30]).into_owned();
        assert_eq!(places(&photo(header)), UPRIGHT, "{text}");
    }
    let refused = [
        (file("FORMAT=Radiance_spectra\n", "-Y 2 +X 3", "\n", &UPRIGHT), "Radiance_spectra"),
        (b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n".to_vec(), "cut short"),
        ([b"#?RADIANCE\n".to_vec(), vec![b'x'; 1 << 21]].concat(), "does not end"),
        (file("", "-Y 0 +X 3", "\n", &[]), "no pixels"),
        (file("", "-Y 20000 +X 20000", "\n", &UPRIGHT), "cut short"),
        (file("", "-Y 4000000 +X 4000000", "\n", &UPRIGHT), "more than"),
    ];
    for (file, why) in refused {
        let error = read(Cursor::new(file), &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains(why), "{error} for {why}");
    }
}

#[test]
fn a_header_is_kept_and_its_primaries_honoured() {
    let header = "SOFTWARE=x\nEXPOSURE=4\nEXPOSURE= 0.5\nCOLORCORR= 1 2 1\nVIEW= -vtv -vh 45\nPIXASPECT=2\n\
                  PRIMARIES= 0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290\nFORMAT=32-bit_rle_rgbe\n";
    let photo = photo(file(header, "-Y 2 +X 3", "\n", &UPRIGHT));
    assert_eq!(photo.source.primaries, Some(Primaries::REC2020));
    assert_eq!(photo.source.pixel_aspect, 0.5, "Radiance's is height over width");
    assert_eq!(photo.source.luminance.as_ref().unwrap().channels, [89.5, 44.75, 89.5]);
    let mut written = Vec::new();
    write(&mut written, &photo).unwrap();
    let text = String::from_utf8_lossy(&written);
    for line in header.lines().filter(|line| !line.starts_with("PIX")) {
        assert_eq!(
            text.matches(&line.replace("0.170", "0.17").replace("0.3290", "0.329")).count(),
            1,
            "{line} in {text}"
        );
    }
    let again = read(Cursor::new(written.clone()), &ReadOptions::default()).unwrap();
    assert_eq!((again.pixels, again.source.primaries), (photo.pixels.clone(), photo.source.primaries));
    assert_eq!(again.source.pixel_aspect, 0.5);
    // Another reader of the same bytes.
    let independent = Independent::new(Cursor::new(written)).unwrap();
    assert_eq!(independent.dimensions(), (3, 2));
    // Glare is in the photo's unit and primaries.
    let mut glare = Vec::new();
    write(&mut glare, &photo.companion(photo.pixels.clone())).unwrap();
    assert!(String::from_utf8_lossy(&glare).contains("EXPOSURE=4"));
}

/// As a file is read and not decoded alone.
fn settled(header: &str, asked: Option<WhiteLuminance>) -> Result<Photo, String> {
    let mut photo = photo(file(header, "-Y 2 +X 3", "\n", &UPRIGHT));
    luminance::settle(&mut photo, asked).map_err(|reason| reason.to_string()).map(|()| photo)
}

fn written_and_read(photo: &Photo) -> Photo {
    let mut written = Vec::new();
    write(&mut written, photo).unwrap();
    let mut again = super::read(Cursor::new(written), &ReadOptions::default()).unwrap();
    luminance::settle(&mut again, None).unwrap();
    again
}

#[test]
fn luminance_is_179_over_the_exposures_and_kept() {
    let file = Some(WhiteLuminance::File);
    let weights = |photo: &Photo| photo.luminance_scale().unwrap().weights;
    let shares = [0.2126, 0.7152, 0.0722];
    for (header, asked, factors) in [
        ("EXPOSURE=4\n\tEXPOSURE=3\nEXPOSURE= 0.5\n", None, [2.0; 3]),
        ("", file, [1.0; 3]),
        ("EXPOSURE=2\nCOLORCORR= 1 2 4\n", None, [2.0, 4.0, 8.0]),
    ] {
        let photo = settled(header, asked).unwrap();
        let want = [0, 1, 2].map(|c| 179.0 * shares[c] / factors[c]);
        let close = |got: [f64; 3]| got.iter().zip(want).all(|(got, want)| (got / want - 1.0).abs() < 1e-12);
        assert!(close(weights(&photo)), "{header}: {:?} for {want:?}", weights(&photo));
        if asked.is_none() {
            assert!(close(weights(&written_and_read(&photo))), "{header}, written");
        }
    }
    assert_eq!(settled("", None).unwrap().luminance_scale(), None, "no line says it");
    // Of XYZ, Y is luminance; the written file is of RGB again.
    let photo = settled("FORMAT=32-bit_rle_xyze\nEXPOSURE=0.5\n", None).unwrap();
    let y = 2.0 * 64.0 / 256.0;
    // RGBE has eight bits for the brightest of a pixel's colours, here blue.
    for (photo, off) in [(&photo, 1e-3), (&written_and_read(&photo), 0.04)] {
        let got = photo.luminance_scale().unwrap().of(&photo.pixels[5]);
        assert!((got / y - 1.0).abs() < off, "{got} for {y}");
    }
    // Given, it replaces what the header said.
    let photo = settled("EXPOSURE=4\nCOLORCORR=1 2 1\n", Some(WhiteLuminance::Given(50.0))).unwrap();
    let again = written_and_read(&photo);
    assert!((again.luminance_scale().unwrap().cd_m2_per_unit - 50.0).abs() < 1e-9);
}

#[test]
fn exposures_that_are_none_tell_nothing() {
    for header in ["EXPOSURE=0\n", "EXPOSURE=-1\nEXPOSURE=-1\n", "EXPOSURE=x\n", "EXPOSURE=nan\n", "COLORCORR=1 0 1\n"]
    {
        let photo = settled(header, None).unwrap();
        assert_eq!(photo.luminance_scale(), None, "{header}");
        assert!(photo.source.notes[0].contains("EXPOSURE or COLORCORR"), "{header}: {:?}", photo.source.notes);
        assert!(settled(header, Some(WhiteLuminance::File)).is_err(), "{header}");
        assert!(settled(header, Some(WhiteLuminance::Given(2.0))).unwrap().source.notes.is_empty(), "{header}");
    }
}

#[test]
fn primaries_that_are_none_are_told() {
    for value in ["0 0 0 0 0 0 0 0", "0.64 0.33", "a b c d e f g h", "nan 1 2 3 4 5 6 7"] {
        let photo = photo(file(&format!("PRIMARIES={value}\n"), "-Y 2 +X 3", "\n", &UPRIGHT));
        assert_eq!(photo.source.primaries, None, "{value}");
        assert!(photo.source.notes.len() == 1 && photo.source.notes[0].contains("PRIMARIES"), "{value}");
    }
    let error = read(Cursor::new(file("", "-Y 2 X 3", "\n", &UPRIGHT)), &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("lacks the line of its size"), "{error}");
}

#[test]
fn xyz_becomes_rec709() {
    // By the matrix that IEC 61966-2-1 prints, of XYZ (3/8, 2/8, 255/256).
    let header = "FORMAT=32-bit_rle_xyze\n";
    let photo = photo(file(header, "-Y 2 +X 3", "\n", &UPRIGHT));
    let got = DVec3::from([photo.pixels[5][0], photo.pixels[5][1], photo.pixels[5][2]].map(f64::from));
    assert!((got - DVec3::new(0.3343, 0.1470, 1.0228)).abs().max_element() < 1e-3, "{got}");
    assert_eq!(photo.source.space.as_deref(), Some("CIE XYZ"));
    assert_eq!(photo.source.primaries, None);
    let options = ReadOptions { primaries: Some(Primaries::XYZ), ..Default::default() };
    let plain = read(Cursor::new(file(header, "-Y 2 +X 3", "\n", &UPRIGHT)), &options).unwrap();
    assert_eq!(plain.pixels[5][..2], [0.375, 0.25]);
}

#[test]
fn what_was_read_is_written_the_same() {
    let once = round_trip((0..500).map(|i| [i as f32 * 0.37, (i % 7) as f32 * 1e-3, 2e4 / i as f32, 1.0]).collect());
    assert_eq!(round_trip(once.clone()), once);
}
