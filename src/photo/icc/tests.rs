use glam::DVec3;
use moxcms::{ColorProfile, ToneReprCurve};

use super::super::Primaries;
use super::*;

fn of(profile: &ColorProfile, grey: bool) -> Profile {
    Profile::new(&profile.encode().unwrap(), grey).unwrap().unwrap()
}

fn light_of(profile: &ColorProfile, colour: [f32; 3]) -> [f32; 3] {
    of(profile, false).to_light(&[colour]).unwrap()[0]
}

fn close(got: [f32; 3], want: [f32; 3], tolerance: f32) {
    assert!(got.iter().zip(want).all(|(g, w)| (g - w).abs() < tolerance), "{got:?} for {want:?}");
}

fn with_curve(mut profile: ColorProfile, curve: ToneReprCurve) -> ColorProfile {
    profile.cicp = None;
    (profile.red_trc, profile.green_trc, profile.blue_trc) = (Some(curve.clone()), Some(curve.clone()), Some(curve));
    profile
}

#[test]
fn display_p3_becomes_rec709_and_may_leave_its_gamut() {
    let p3 = ColorProfile::new_display_p3();
    let matrix = Primaries::P3_D65.to_rec709();
    for colour in [[1.0, 1.0, 1.0], [0.5, 0.5, 0.5], [0.9, 0.2, 0.4], [1.0, 0.0, 0.0], [0.02, 0.5, 0.01]] {
        let light = DVec3::from(colour.map(|c| Curve::Srgb.light(f64::from(c))));
        close(light_of(&p3, colour), (matrix * light).to_array().map(|c| c as f32), 1e-6);
    }
    assert!(light_of(&p3, [0.0, 1.0, 0.0])[0] < -0.1, "out of gamut stays out of gamut");
    assert_eq!(of(&p3, false).space().unwrap(), "Display P3");
}

#[test]
fn srgb_is_srgb_to_the_bit() {
    for code in 0..=255 {
        let encoded = code as f32 / 255.0;
        let want = Curve::Srgb.light(f64::from(encoded)) as f32;
        assert_eq!(light_of(&ColorProfile::new_srgb(), [encoded, 0.0, 1.0]), [want, 0.0, 1.0]);
    }
    for grey in [false, true] {
        let written = Profile::new(srgb_profile(grey).unwrap(), grey).unwrap().unwrap();
        assert_eq!(written.to_light(&[[0.5; 3]]).unwrap(), [[Curve::Srgb.light(0.5) as f32; 3]]);
        assert_eq!(written.space(), None);
        assert_eq!(srgb_profile(grey).unwrap()[24..36], [7, 234, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0], "no clock");
    }
}

#[test]
fn a_linear_profile_has_no_ceiling() {
    let linear = with_curve(ColorProfile::new_srgb(), ToneReprCurve::Lut(Vec::new()));
    assert_eq!(light_of(&linear, [0.25, 12.5, -3.0]), [0.25, 12.5, -3.0]);
}

#[test]
fn black_is_black_whatever_the_gamma() {
    for gamma in [0.5_f32, 1.0, 1.5, 1.8, 2.0, 2.2, 2.4, 3.0] {
        for curve in [ToneReprCurve::Lut(vec![(gamma * 256.0).round() as u16]), ToneReprCurve::Parametric(vec![gamma])]
        {
            for profile in [ColorProfile::new_srgb(), ColorProfile::new_adobe_rgb(), ColorProfile::new_pro_photo_rgb()]
            {
                let profile = with_curve(profile, curve.clone());
                assert_eq!(light_of(&profile, [0.0; 3]), [0.0; 3], "{gamma}");
                close(light_of(&profile, [1.0; 3]), [1.0; 3], 1e-6);
                close(light_of(&profile, [0.5; 3]), [0.5_f32.powf(gamma); 3], 2e-3);
            }
        }
    }
}

#[test]
fn prophoto_red_is_where_it_should_be() {
    // ROMM RGB to Rec. 709 by Bradford, as brucelindbloom.com computes it from the primaries.
    let profile = with_curve(ColorProfile::new_pro_photo_rgb(), ToneReprCurve::Lut(vec![461]));
    close(light_of(&profile, [1.0, 0.0, 0.0]), [2.0344, -0.2288, -0.0086], 1e-3);
    assert_eq!(of(&profile, false).space().unwrap(), "ProPhoto RGB");
}

#[test]
fn grey_profiles_give_grey() {
    let grey = ColorProfile::new_gray_with_gamma(2.2);
    let light = of(&grey, true).to_light(&[[0.5; 3], [0.0; 3]]).unwrap();
    close(light[0], [0.5_f32.powf(2.2); 3], 1e-3);
    assert_eq!(light[1], [0.0; 3]);
    // A straight curve of lightness: L* 50 is a light of 0.18419, CIE 15.
    let mut lightness = grey;
    lightness.pcs = moxcms::DataColorSpace::Lab;
    lightness.gray_trc = Some(ToneReprCurve::Lut(Vec::new()));
    close(of(&lightness, true).to_light(&[[0.5; 3]]).unwrap()[0], [0.184_19; 3], 1e-5);
}

#[test]
fn what_cannot_be_read_is_srgb_with_a_note() {
    let good = with_curve(ColorProfile::new_display_p3(), ToneReprCurve::Lut(vec![461])).encode().unwrap();
    let changed = |at: usize, bytes: &[u8]| {
        let mut icc = good.clone();
        icc[at..at + bytes.len()].copy_from_slice(bytes);
        icc
    };
    let lacking = |tag: &[u8; 4]| changed((128..400).find(|&at| good[at..].starts_with(tag)).unwrap(), b"none");
    let cases = [
        (good[..100].to_vec(), "cut short"),
        (good[..300].to_vec(), "cut short"),
        (Vec::new(), "cut short"),
        (changed(36, b"ACSP"), "signature"),
        (changed(8, &[5]), "version 5"),
        (changed(8, &[0]), "version 0"),
        (changed(16, b"CMYK"), "is for CMYK, not for RGB"),
        (changed(16, b"GRAY"), "is for grey, not for RGB"),
        (lacking(b"rTRC"), "lacks a curve"),
        (lacking(b"gXYZ"), "lacks a primary"),
        (vec![0; LARGEST + 1], "more than"),
        (with_curve(ColorProfile::new_srgb(), ToneReprCurve::Lut(vec![0])).encode().unwrap(), "a curve that is none"),
    ];
    for (icc, why) in cases {
        let mut notes = Vec::new();
        let encoding = encoding(&icc, false, Curve::Srgb, &ReadOptions::default(), &mut notes);
        assert!(notes.len() == 1 && notes[0].contains(why) && notes[0].contains("sRGB"), "{why}: {notes:?}");
        let Encoding::Curves(shaper) = encoding else { panic!("{why}: a profile") };
        assert_eq!((shaper.curves, shaper.matrix), ([Curve::Srgb, Curve::Srgb, Curve::Srgb], None), "{why}");
    }
    let mut notes = Vec::new();
    encoding(&lacking(b"rTRC"), false, Curve::Srgb, &ReadOptions::default(), &mut notes);
    assert!(notes[0].contains("Display P3"), "{notes:?}");
}

#[test]
fn what_is_not_needed_may_be_broken() {
    let mut icc = ColorProfile::new_adobe_rgb().encode().unwrap();
    let whole = Profile::new(&icc, false).unwrap().unwrap().to_light(&[[0.3, 0.6, 0.9]]).unwrap();
    let at = (128..400).find(|&at| icc[at..].starts_with(b"cprt")).unwrap();
    icc[at + 4..at + 12].fill(0xff);
    icc[24..36].fill(0);
    assert_eq!(Profile::new(&icc, false).unwrap().unwrap().to_light(&[[0.3, 0.6, 0.9]]).unwrap(), whole);
}

#[test]
fn named_primaries_take_the_place_of_the_profiles() {
    let icc = with_curve(ColorProfile::new_srgb(), ToneReprCurve::Lut(vec![461])).encode().unwrap();
    let (mut notes, options) = (Vec::new(), ReadOptions { primaries: Some(Primaries::REC2020), ..Default::default() });
    let Encoding::Curves(shaper) = encoding(&icc, false, Curve::Srgb, &options, &mut notes) else { panic!() };
    assert_eq!(shaper.curves[0], Curve::Power(461.0 / 256.0));
    assert_eq!(shaper.matrix, Some(Primaries::REC2020.to_rec709()));
    assert!(notes.is_empty());
}

#[test]
fn colours_that_two_spaces_share_are_not_negative() {
    // Adobe RGB has the red and the blue of Rec. 709.
    let adobe = with_curve(ColorProfile::new_adobe_rgb(), ToneReprCurve::Lut(vec![563]));
    for colour in [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.004], [0.7, 0.0, 0.2]] {
        assert!(light_of(&adobe, colour).iter().all(|&c| c >= 0.0), "{colour:?}");
    }
}

/// [ICC] 10.12: curves, a matrix and straight curves as a table from device to PCS XYZ, under the name `tag`.
fn of_tables(tag: &[u8; 4]) -> Vec<u8> {
    let fixed = |x: f64| ((x * 65536.0).round() as i32).to_be_bytes();
    let gamma = [b"curv\0\0\0\0\0\0\0\x01".as_slice(), &461_u16.to_be_bytes(), &[0, 0]].concat();
    // ROMM's colorants, in PCS XYZ of which 1 is 32768/65535.
    let matrix = [0.7977, 0.1352, 0.0313, 0.2880, 0.7119, 0.0001, 0.0, 0.0, 0.8249, 0.0, 0.0, 0.0];
    let matrix = matrix.map(|m| fixed(m * 32768.0 / 65535.0)).concat();
    let starts = [32_u32, 68, 116, 0, 0].map(u32::to_be_bytes).concat();
    let straight = b"curv\0\0\0\0\0\0\0\0".repeat(3);
    let table = [b"mAB \0\0\0\0\x03\x03\0\0".to_vec(), starts, straight, matrix, gamma.repeat(3)].concat();
    let mut header = ColorProfile::new_srgb().encode().unwrap()[..128].to_vec();
    let entry = [tag.as_slice(), &144_u32.to_be_bytes(), &(table.len() as u32).to_be_bytes()].concat();
    header.extend([1_u32.to_be_bytes().to_vec(), entry, table].concat());
    header
}

#[test]
fn profiles_of_tables_alone_are_honoured() {
    for tag in [b"A2B0", b"A2B1", b"A2B2"] {
        let profile = Profile::new(&of_tables(tag), false).unwrap().unwrap();
        let colours = [[0.0; 3], [1.0; 3], [0.0, 128.0 / 255.0, 1.0], [1.0, 0.0, 0.0]];
        let light = profile.to_light(&colours).unwrap();
        assert_eq!(light[0], [0.0; 3]);
        close(light[1], [1.0; 3], 1e-3);
        // In f64: gamma 461/256, ROMM's primaries, Bradford.
        close(light[2], [-0.517_055, 0.353_111, 1.117_525], 1.5e-3);
        close(light[3], [2.034_37, -0.228_83, -0.008_56], 1.5e-3);
    }
}

/// A table of black and white alone from device to PCS Lab, [ICC] 10.10 and 10.11: of 16 bits where `wide`, else of 8.
fn of_lab(wide: bool, version: u8) -> Vec<u8> {
    let one = 0x1_0000_u32.to_be_bytes();
    let unit = (0..9).flat_map(|k| if k % 4 == 0 { one } else { [0; 4] });
    let kind = if wide { b"mft2" } else { b"mft1" };
    let mut table: Vec<u8> = kind.iter().copied().chain([0, 0, 0, 0, 3, 3, 2, 0]).chain(unit).collect();
    let curves = match wide {
        true => [0_u16, 65535].map(u16::to_be_bytes).concat().repeat(3),
        false => (0..=255).collect::<Vec<u8>>().repeat(3),
    };
    if wide {
        table.extend([0, 2, 0, 2]);
    }
    table.extend(&curves);
    for corner in 0..8 {
        let white = corner == 7;
        match wide {
            true => table.extend([if white { 0xff00 } else { 0 }, 0x8000, 0x8000].map(u16::to_be_bytes).concat()),
            false => table.extend([if white { 255 } else { 0 }, 128, 128]),
        }
    }
    table.extend(&curves);
    let mut profile = ColorProfile::new_srgb().encode().unwrap()[..128].to_vec();
    profile[8] = version;
    profile[20..24].copy_from_slice(b"Lab ");
    let entry = [b"A2B0".as_slice(), &144_u32.to_be_bytes(), &(table.len() as u32).to_be_bytes()].concat();
    profile.extend([1_u32.to_be_bytes().to_vec(), entry, table].concat());
    profile
}

#[test]
fn lab_of_tables_is_encoded_by_their_type_and_not_by_the_profiles_version() {
    for (wide, version) in [(true, 2), (true, 4), (false, 2), (false, 4)] {
        let profile = Profile::new(&of_lab(wide, version), false).unwrap().unwrap();
        let light = profile.to_light(&[[1.0; 3], [0.0; 3]]).unwrap();
        close(light[0], [1.0; 3], 1e-3);
        close(light[1], [0.0; 3], 1e-5);
    }
}
