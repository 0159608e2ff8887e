//! LogL and LogLuv: light by its logarithm, packed in runs.
//!
//! \[LOGLUV\] G. Ward Larson, "LogLuv encoding for full-gamut, high-dynamic range images", Journal of Graphics Tools
//! 3(1), 1998: the encodings of 16 and 32 bits. The runs are those of libtiff's `COMPRESSION_SGILOG`.

use glam::{DMat3, DVec3};

use super::super::{Primaries, Reason};
use super::samples::Code;

/// The pixels of rows that hold their codes byte by byte, the highest bytes of a row first, each in runs.
pub(super) fn unpack<C: Code>(packed: &[u8], width: usize, rows: usize, bits: u32) -> Result<Vec<C>, Reason> {
    let mut codes = Vec::new();
    let mut rest = packed;
    for _ in 0..rows {
        let mut row = vec![0_u64; width];
        for shift in (0..bits).step_by(8).rev() {
            let mut pixels = row.iter_mut();
            while pixels.len() > 0 {
                rest = unpack_run(rest, |byte| {
                    pixels.next().into_iter().for_each(|pixel| *pixel |= u64::from(byte) << shift);
                })
                .ok_or("it is cut short")?;
            }
        }
        codes.extend(row.into_iter().map(C::cut));
    }
    Ok(codes)
}

/// One run: 2 to 129 equal bytes, or up to 127 that differ.
fn unpack_run(packed: &[u8], mut put: impl FnMut(u8)) -> Option<&[u8]> {
    let (&count, rest) = packed.split_first()?;
    if count >= 128 {
        let (&byte, rest) = rest.split_first()?;
        (0..count - 126).for_each(|_| put(byte));
        return Some(rest);
    }
    let (bytes, rest) = rest.split_at_checked(usize::from(count))?;
    bytes.iter().for_each(|&byte| put(byte));
    Some(rest)
}

/// \[LOGLUV\] the luminance of a 16-bit code: a sign and 15 bits of logarithm, 0 for none.
pub(super) fn luminance(code: u16) -> f64 {
    let size = code & 0x7fff;
    let light = if size == 0 { 0.0 } else { ((f64::from(size) + 0.5) / 256.0 - 64.0).exp2() };
    if code & 0x8000 == 0 { light } else { -light }
}

/// \[LOGLUV\] the colour of a 32-bit code: 16 bits of luminance, 8 each of u' and v'; in Rec.709, white to white.
pub(super) fn colour(code: u32, to_rec709: &DMat3) -> [f32; 3] {
    let luminance = luminance((code >> 16) as u16);
    let u = (f64::from(code >> 8 & 0xff) + 0.5) / 410.0;
    let v = (f64::from(code & 0xff) + 0.5) / 410.0;
    let scale = 1.0 / (6.0 * u - 16.0 * v + 12.0);
    let (x, y) = (9.0 * u * scale, 4.0 * v * scale);
    let xyz = DVec3::new(x / y, 1.0, (1.0 - x - y) / y) * luminance;
    (*to_rec709 * xyz).as_vec3().to_array()
}

/// From XYZ with equal energy as white, which LogLuv's is.
pub(super) fn to_rec709() -> DMat3 {
    Primaries::relative_xyz_to_rec709(Primaries::XYZ.white)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_and_grey_are_where_the_paper_has_them() {
        // 64 × 256 is the code from 1 to 2^(1/256); half a step is 0.14 %.
        assert!((luminance(64 * 256) - (0.5_f64 / 256.0).exp2()).abs() < 1e-12);
        assert_eq!((luminance(0), luminance(0x8000)), (0.0, -0.0));
        // Equal energy: u' = 0.2105, v' = 0.4737.
        let [r, g, b] = colour((64 * 256) << 16 | 86 << 8 | 194, &to_rec709());
        assert!([r, g, b].iter().all(|c| (c - 1.0).abs() < 0.02), "{r} {g} {b}");
    }

    #[test]
    fn runs_are_of_equal_or_of_differing_bytes() {
        let packed = [130, 7, 130, 7, 3, 1, 2, 3, 1, 9, 128, 5, 1, 6];
        let codes: Vec<u16> = unpack(&packed[..4], 4, 1, 16).unwrap();
        assert_eq!(codes, [0x707; 4]);
        let codes: Vec<u16> = unpack(&[&packed[4..10], &packed[10..], &[1, 8]].concat(), 4, 1, 16).unwrap();
        assert_eq!(codes, [0x105, 0x205, 0x306, 0x908]);
        assert!(unpack::<u16>(&packed[..3], 4, 1, 16).is_err());
    }
}
