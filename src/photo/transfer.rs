//! Transfer functions: from the numbers in a file to light, and for sRGB back.
//!
//! \[SRGB\] IEC 61966-2-1:1999; \[709\] ITU-R BT.709-6, item 1.2; \[2100\] ITU-R BT.2100-2, tables 4 and 5;
//! \[2408\] ITU-R BT.2408-7, section 2.1: reference white is 203 cd/m², and 75 % of the HLG signal;
//! \[ICC\] ICC.1:2022, sections 10.6 and 10.18.

use std::sync::Arc;

/// How encoded values become linear light; display white is 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Curve {
    /// They are linear already.
    Linear,
    /// \[SRGB\]
    Srgb,
    /// A power: light = value ^ exponent.
    Power(f64),
    /// \[709\], inverse of the camera's function.
    Rec709,
    /// \[2100\] PQ, in units of 203 cd/m².
    Pq,
    /// \[2100\] HLG, scene light in units of the light of a 75 % signal.
    Hlg,
    /// \[ICC\] 10.18, function type 4, of which the others are cases: parameters g, a, b, c, d, e, f.
    Parametric([f64; 7]),
    /// \[ICC\] 10.6: light at equal steps of 0..1, two at least, straight in between and beyond.
    Table(Arc<[f64]>),
}

impl Curve {
    /// Light of the encoded value `v`, usually in 0..1; negative values mirror.
    pub fn light(&self, v: f64) -> f64 {
        self.light_of_positive(v.abs()).copysign(v)
    }

    fn light_of_positive(&self, v: f64) -> f64 {
        match self {
            Self::Linear => v,
            Self::Srgb if v <= 0.04045 => v / 12.92,
            Self::Srgb => ((v + 0.055) / 1.055).powf(2.4),
            Self::Power(exponent) => v.powf(*exponent),
            Self::Rec709 if v < 0.081 => v / 4.5,
            Self::Rec709 => ((v + 0.099) / 1.099).powf(1.0 / 0.45),
            Self::Pq => pq(v) * 10_000.0 / 203.0,
            Self::Hlg => hlg(v) / hlg(0.75),
            // A base below 0 has no power; the curve is 0 where it begins.
            &Self::Parametric([g, a, b, c, d, e, f]) => {
                if v >= d {
                    (a * v + b).max(0.0).powf(g) + e
                } else {
                    c * v + f
                }
            }
            Self::Table(steps) => interpolated(steps, v),
        }
    }

    /// The encoded value of `light`, the inverse of [`Self::light`]; where several have that light, one of them.
    pub fn encoded(&self, light: f64) -> f64 {
        self.encoded_of_positive(light.abs()).copysign(light)
    }

    fn encoded_of_positive(&self, light: f64) -> f64 {
        match self {
            Self::Linear => light,
            Self::Srgb if light <= 0.04045 / 12.92 => light * 12.92,
            Self::Srgb => 1.055 * light.powf(1.0 / 2.4) - 0.055,
            Self::Power(exponent) => light.powf(exponent.recip()),
            Self::Rec709 if light < 0.081 / 4.5 => light * 4.5,
            Self::Rec709 => 1.099 * light.powf(0.45) - 0.099,
            Self::Pq => pq_signal(light * 203.0 / 10_000.0),
            Self::Hlg => hlg_signal(light * hlg(0.75)),
            &Self::Parametric([g, a, b, c, d, e, f]) => {
                if light >= self.light_of_positive(d.max(0.0)) {
                    (((light - e).max(0.0).powf(g.recip()) - b) / a).max(d.max(0.0))
                } else if c != 0.0 {
                    (light - f) / c
                } else {
                    0.0
                }
            }
            Self::Table(steps) => {
                let above = steps.partition_point(|&step| step < light).clamp(1, steps.len() - 1);
                let (low, high) = (steps[above - 1], steps[above]);
                let part = if high > low { (light - low) / (high - low) } else { 1.0 };
                (above as f64 - 1.0 + part) / (steps.len() - 1) as f64
            }
        }
    }

    /// Whether light tells the encoded value: it rises with it over 0..1, and [`Self::encoded`] finds the way back.
    pub fn has_inverse(&self) -> bool {
        let lights: Vec<f64> = (0..=255).map(|code| self.light(f64::from(code) / 255.0)).collect();
        let span = lights[255] - lights[0];
        let back = |&light: &f64| (self.light(self.encoded(light)) - light).abs() <= 1e-9 * span;
        span > 0.0 && lights.is_sorted() && lights.iter().all(back)
    }

    /// The curve that this one is, as nearly as profiles can say it, where it is straight or sRGB's.
    pub fn recognised(self) -> Self {
        // Profiles round curves to 16 bits, and sRGB's to a few hundred points.
        let same = |known: &Self| {
            (0..=1000).all(|k| (self.light(f64::from(k) * 1e-3) - known.light(f64::from(k) * 1e-3)).abs() < 1e-4)
        };
        [Self::Linear, Self::Srgb].into_iter().find(same).unwrap_or(self)
    }
}

/// A line through the samples of 0..1, which goes on straight beyond 1.
fn interpolated(steps: &[f64], v: f64) -> f64 {
    let place = v * (steps.len() - 1) as f64;
    let first = (place as usize).min(steps.len() - 2);
    let slope = steps[first + 1] - steps[first];
    // Nothing times infinity is undefined.
    if slope == 0.0 && !v.is_nan() { steps[first] } else { steps[first] + slope * (place - first as f64) }
}

/// \[2100\] table 4: cd/m² / 10000 of a PQ signal.
fn pq(v: f64) -> f64 {
    let (m1, m2) = (2610.0 / 16384.0, 2523.0 / 4096.0 * 128.0);
    let (c1, c2, c3) = (3424.0 / 4096.0, 2413.0 / 4096.0 * 32.0, 2392.0 / 4096.0 * 32.0);
    let e = v.powf(1.0 / m2);
    ((e - c1).max(0.0) / (c2 - c3 * e)).powf(1.0 / m1)
}

/// \[2100\] table 4: the PQ signal of cd/m² / 10000.
fn pq_signal(light: f64) -> f64 {
    let (m1, m2) = (2610.0 / 16384.0, 2523.0 / 4096.0 * 128.0);
    let (c1, c2, c3) = (3424.0 / 4096.0, 2413.0 / 4096.0 * 32.0, 2392.0 / 4096.0 * 32.0);
    let y = light.powf(m1);
    // Of no light at all it is 7e-7, which no code shows.
    if light == 0.0 { 0.0 } else { ((c1 + c2 * y) / (1.0 + c3 * y)).powf(m2) }
}

/// \[2100\] table 5: scene light in 0..1 of an HLG signal.
fn hlg(v: f64) -> f64 {
    let (a, b, c) = (0.178_832_77, 0.284_668_92, 0.559_910_73);
    if v <= 0.5 { v * v / 3.0 } else { (((v - c) / a).exp() + b) / 12.0 }
}

/// \[2100\] table 5: the HLG signal of scene light in 0..1.
fn hlg_signal(light: f64) -> f64 {
    let (a, b, c) = (0.178_832_77, 0.284_668_92, 0.559_910_73);
    if light <= 1.0 / 12.0 { (3.0 * light).sqrt() } else { a * (12.0 * light - b).ln() + c }
}

/// \[SRGB\] the encoded value of `light` in 0..1.
pub(crate) fn srgb_encode(light: f32) -> f32 {
    if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_16_bit_code_survives_srgb() {
        for code in 0..=65535_u32 {
            let light = Curve::Srgb.light(f64::from(code) / 65535.0) as f32;
            assert_eq!((srgb_encode(light) * 65535.0).round() as u32, code);
        }
    }

    #[test]
    fn curves_of_profiles_are_evaluated_as_they_are_defined() {
        // [ICC] 10.18: sRGB as a function of type 3.
        let srgb = Curve::Parametric([2.4, 1.0 / 1.055, 0.055 / 1.055, 1.0 / 12.92, 0.04045, 0.0, 0.0]);
        for k in 0..=100 {
            let v = f64::from(k) / 100.0;
            assert!((srgb.light(v) - Curve::Srgb.light(v)).abs() < 1e-12, "{v}");
        }
        assert_eq!(srgb.recognised(), Curve::Srgb);
        assert_eq!(Curve::Power(2.2).recognised(), Curve::Power(2.2));
        // A base that is negative at first: type 1 with an offset.
        let late = Curve::Parametric([1.8, 2.0, -0.5, 0.0, 0.25, 0.0, 0.0]);
        assert_eq!((late.light(0.0), late.light(0.2)), (0.0, 0.0));
        assert!((late.light(0.75) - 1.0).abs() < 1e-12);
        let table = Curve::Table([0.0, 0.25, 1.0].into());
        let points = [(0.0, 0.0), (0.25, 0.125), (0.5, 0.25), (0.75, 0.625), (1.0, 1.0), (2.0, 2.5)];
        points.into_iter().for_each(|(v, light)| assert_eq!(table.light(v), light, "{v}"));
        assert!(table.light(f64::NAN).is_nan());
        assert_eq!(Curve::Table([0.0, 1.0, 1.0].into()).light(f64::INFINITY), 1.0);
        assert_eq!(Curve::Table([0.0, 0.5, 1.0].into()).recognised(), Curve::Linear);
    }

    #[test]
    fn every_curve_has_the_way_back_that_it_says() {
        let srgb = Curve::Parametric([2.4, 1.0 / 1.055, 0.055 / 1.055, 1.0 / 12.92, 0.04045, 0.0, 0.0]);
        let curves = [
            Curve::Linear,
            Curve::Srgb,
            Curve::Power(2.2),
            Curve::Rec709,
            Curve::Pq,
            Curve::Hlg,
            srgb,
            // A floor that is flat, as in type 1, and one that is lifted.
            Curve::Parametric([1.8, 2.0, -0.5, 0.0, 0.25, 0.0, 0.0]),
            Curve::Parametric([2.2, 0.9, 0.05, 0.1, 0.1, 0.02, 0.01]),
            Curve::Table([0.0, 0.0, 0.25, 1.0, 1.0].into()),
        ];
        for curve in curves {
            assert!(curve.has_inverse(), "{curve:?}");
            for k in 0..=1000 {
                let light = curve.light(f64::from(k) * 1e-3);
                let back = curve.light(curve.encoded(light));
                assert!((back - light).abs() <= 1e-12 * curve.light(1.0), "{curve:?}: {back} for {light}");
            }
        }
        // What falls has none, and neither has what stands still.
        for curve in [Curve::Table([0.0, 0.6, 0.5, 1.0].into()), Curve::Table([0.5, 0.5].into())] {
            assert!(!curve.has_inverse(), "{curve:?}");
        }
    }

    #[test]
    fn published_points_are_met() {
        assert!((Curve::Srgb.light(0.5) - 0.214_041_14).abs() < 1e-8);
        assert!((Curve::Srgb.light(-0.5) + 0.214_041_14).abs() < 1e-8);
        // [2408] table 1: reference white is at 58 % of PQ and 75 % of HLG.
        assert!((Curve::Pq.light(0.5807) - 1.0).abs() < 2e-3, "{}", Curve::Pq.light(0.5807));
        assert_eq!(Curve::Hlg.light(0.75), 1.0);
        assert!((Curve::Pq.light(1.0) - 49.26).abs() < 0.01);
        assert!((Curve::Rec709.light(1.0) - 1.0).abs() < 1e-12);
    }
}
