//! Lines of samples between a file's types and the photo's f32, exact in both directions.
//!
//! The `half` crate converts fast but may turn a signalling NaN into a quiet one; here a NaN keeps its bits.

use exr::meta::attribute::SampleType;
use half::f16;
use half::slice::HalfFloatSliceExt;

/// Half's largest finite value; what is finite and beyond is written as this, so that light does not become ∞.
const LARGEST_HALF: f32 = 65504.0;

/// Memory that conversions reuse from line to line.
#[derive(Default)]
pub(super) struct Scratch {
    half: Vec<f16>,
    /// The line's samples as f32.
    pub float: Vec<f32>,
}

impl Scratch {
    /// Fills `float` from a line of bytes in the machine's order.
    pub fn load(&mut self, bytes: &[u8], kind: SampleType) {
        self.float.clear();
        match kind {
            SampleType::F32 => self.float.extend(bytes.as_chunks().0.iter().map(|&b| f32::from_ne_bytes(b))),
            SampleType::U32 => self.float.extend(bytes.as_chunks().0.iter().map(|&b| u32::from_ne_bytes(b) as f32)),
            SampleType::F16 => {
                self.half.clear();
                self.half.extend(bytes.as_chunks().0.iter().map(|&b| f16::from_ne_bytes(b)));
                self.float.resize(self.half.len(), 0.0);
                self.half.convert_to_f32_slice(&mut self.float);
                for (float, half) in self.float.iter_mut().zip(&self.half).filter(|(_, half)| half.is_nan()) {
                    *float = nan_of_half(half.to_bits());
                }
            }
        }
    }

    /// Writes `float` into a line of bytes; integers that `was` held stay as they are where they are still meant.
    pub fn store(&mut self, bytes: &mut [u8], kind: SampleType, was: Option<&[u8]>) {
        match kind {
            SampleType::F32 => {
                for (out, float) in bytes.as_chunks_mut().0.iter_mut().zip(&self.float) {
                    *out = float.to_ne_bytes();
                }
            }
            SampleType::U32 => {
                let mut was = was.map(|was| was.as_chunks().0.iter().map(|&b| u32::from_ne_bytes(b)));
                for (out, &float) in bytes.as_chunks_mut().0.iter_mut().zip(&self.float) {
                    let before = was.as_mut().and_then(Iterator::next).filter(|&before| before as f32 == float);
                    *out = before.unwrap_or(float.round() as u32).to_ne_bytes();
                }
            }
            SampleType::F16 => {
                self.half.clear();
                self.half.resize(self.float.len(), f16::ZERO);
                self.half.convert_from_f32_slice(&self.float);
                let out = bytes.as_chunks_mut().0.iter_mut();
                for ((out, half), &float) in out.zip(&self.half).zip(&self.float) {
                    let bits = match half.to_bits() {
                        _ if float.is_nan() => half_of_nan(float),
                        _ if float.is_finite() && half.is_infinite() => {
                            f16::from_f32(LARGEST_HALF.copysign(float)).to_bits()
                        }
                        bits => bits,
                    };
                    *out = bits.to_ne_bytes();
                }
            }
        }
    }
}

fn nan_of_half(bits: u16) -> f32 {
    let (sign, payload) = (u32::from(bits >> 15), u32::from(bits & 0x3ff));
    f32::from_bits(sign << 31 | 0x7f80_0000 | payload << 13)
}

fn half_of_nan(nan: f32) -> u16 {
    let bits = nan.to_bits();
    let payload = (bits >> 13 & 0x3ff) as u16;
    // A payload that half cannot hold must not leave an infinity behind.
    (bits >> 16 & 0x8000) as u16 | 0x7c00 | if payload == 0 { 0x200 } else { payload }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_half_survives() {
        let all: Vec<u8> = (0..=u16::MAX).flat_map(u16::to_ne_bytes).collect();
        let (mut scratch, mut back) = (Scratch::default(), vec![0; all.len()]);
        scratch.load(&all, SampleType::F16);
        scratch.store(&mut back, SampleType::F16, None);
        assert!(all == back);
    }

    #[test]
    fn what_half_cannot_hold_stays_what_it_is() {
        let mut scratch =
            Scratch { float: vec![1e9, -1e9, f32::INFINITY, f32::from_bits(0xff80_0001)], ..Default::default() };
        let mut out = [0; 8];
        scratch.store(&mut out, SampleType::F16, None);
        let got: Vec<u16> = out.as_chunks().0.iter().map(|&b| u16::from_ne_bytes(b)).collect();
        assert_eq!(got, [0x7bff, 0xfbff, 0x7c00, 0xfe00]);
    }

    #[test]
    fn integers_beyond_24_bits_survive_unless_the_light_changed() {
        let was: Vec<u8> = [4_000_000_001_u32, 5].iter().flat_map(|v| v.to_ne_bytes()).collect();
        let (mut scratch, mut out) = (Scratch::default(), [0; 8]);
        scratch.load(&was, SampleType::U32);
        scratch.float[1] += 2.4;
        scratch.store(&mut out, SampleType::U32, Some(&was));
        assert_eq!(out.as_chunks().0.iter().map(|&b| u32::from_ne_bytes(b)).collect::<Vec<_>>(), [4_000_000_001, 7]);
    }
}
