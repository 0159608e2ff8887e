//! Tone maps: from scene-linear light to what a display can show.
//!
//! \[REINHARD\] Reinhard, Stark, Shirley, Ferwerda, "Photographic tone reproduction for digital images", 2002.
//! \[HILL\] Stephen Hill's fit of the ACES RRT and sRGB ODT, BakingLab, ACES.hlsl (MIT licence), 2016.
//! \[AGX\] Troy Sobotka's AgX; \[WRENSCH\] its minimal approximation by Benjamin Wrensch, iolite-engine.com, 2023.

use glam::{Mat3A, Vec3A};

/// How scene-linear light is brought into a display's range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ToneMap {
    /// Clip at 0 and 1.
    None,
    /// v / (1 + v), \[REINHARD\] eq. 3, on each colour: on luminance alone, as in the paper, a sun stays orange and
    /// ends up darker than the sky around it. Flattens contrast.
    Reinhard,
    /// The film-like curve of ACES: \[HILL\]. Contrasty; strong colours burn to white.
    Aces,
    /// A soft, wide curve that takes bright colours gently to white: \[AGX\].
    #[default]
    Agx,
}

/// Light beyond this looks the same under every map here, and its powers do not overflow an f32.
const BRIGHTEST: f32 = 1e9;

impl ToneMap {
    /// Linear Rec.709 light, any value, to linear light in 0..=1; NaN and −∞ become 0.
    pub fn apply(self, rgb: [f32; 3]) -> [f32; 3] {
        let light = Vec3A::from(sound(rgb));
        let light = match self {
            Self::None => light,
            Self::Reinhard => reinhard(light),
            Self::Aces => aces(light),
            Self::Agx => agx(light),
        };
        light.clamp(Vec3A::ZERO, Vec3A::ONE).to_array()
    }
}

/// Light of which everything can be computed: NaN and −∞ are 0.
pub(super) fn sound(rgb: [f32; 3]) -> [f32; 3] {
    rgb.map(|c| if c.is_nan() || c == f32::NEG_INFINITY { 0.0 } else { c.clamp(-BRIGHTEST, BRIGHTEST) })
}

fn reinhard(light: Vec3A) -> Vec3A {
    let light = light.max(Vec3A::ZERO);
    light / (1.0 + light)
}

fn aces(light: Vec3A) -> Vec3A {
    // [HILL]: sRGB to XYZ to D60 to AP1 and the RRT's saturation; the ODT's saturation and back.
    const INTO: Mat3A = Mat3A::from_cols(
        Vec3A::new(0.59719, 0.07600, 0.02840),
        Vec3A::new(0.35458, 0.90834, 0.13383),
        Vec3A::new(0.04823, 0.01566, 0.83777),
    );
    const BACK: Mat3A = Mat3A::from_cols(
        Vec3A::new(1.60475, -0.10208, -0.00327),
        Vec3A::new(-0.53108, 1.10813, -0.07276),
        Vec3A::new(-0.07367, -0.00605, 1.07602),
    );
    // The fit has a pole at negative light.
    let v = (INTO * light).max(Vec3A::ZERO);
    let above = v * (v + 0.024_578_6) - 0.000_090_537;
    let below = v * (0.983_729 * v + 0.432_951) + 0.238_081;
    BACK * (above / below)
}

fn agx(light: Vec3A) -> Vec3A {
    // [WRENSCH]: the inset of Rec.709 and its inverse, the range in stops, and the sixth-order fit of the curve.
    const INSET: Mat3A = Mat3A::from_cols(
        Vec3A::new(0.842_479_06, 0.042_328_24, 0.042_375_654),
        Vec3A::new(0.078_433_6, 0.878_468_64, 0.078_433_6),
        Vec3A::new(0.079_223_745, 0.079_166_13, 0.879_143),
    );
    const OUTSET: Mat3A = Mat3A::from_cols(
        Vec3A::new(1.196_879, -0.052_896_85, -0.052_971_635),
        Vec3A::new(-0.098_020_88, 1.151_903_1, -0.098_043_45),
        Vec3A::new(-0.099_029_74, -0.098_961_18, 1.151_073_7),
    );
    const DARKEST: f32 = -12.473_93;
    const LIGHTEST: f32 = 4.026_069;
    let stops = (INSET * light).max(Vec3A::splat(1e-10)).map(f32::log2);
    let x = ((stops - DARKEST) / (LIGHTEST - DARKEST)).clamp(Vec3A::ZERO, Vec3A::ONE);
    let curve = x.map(|x| (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232);
    (OUTSET * curve).clamp(Vec3A::ZERO, Vec3A::ONE).map(|c| c.powf(2.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [ToneMap; 4] = [ToneMap::None, ToneMap::Reinhard, ToneMap::Aces, ToneMap::Agx];

    /// Numbers of four digits and more, in order, of what lies between two lines.
    fn numbers(text: &str, from: &str, to: &str) -> Vec<f64> {
        let from = text.find(from).unwrap();
        let to = from + text[from..].find(to).unwrap();
        let code: Vec<&str> = text[from..to].lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
        let code = code.join("\n").replace('_', "");
        let words = code.split(|c: char| !c.is_ascii_digit() && c != '.');
        words.filter(|word| word.len() >= 5).filter_map(|word| word.parse().ok()).collect()
    }

    #[test]
    fn the_shader_has_the_same_numbers() {
        let shader = include_str!("../../shaders/shared/tone.glsl");
        let mut here = numbers(include_str!("tone.rs"), "fn aces", "#[cfg(test)]");
        let mut there = numbers(shader, "vec3 aces", "// Linear Rec.709");
        here.sort_by(f64::total_cmp);
        there.sort_by(f64::total_cmp);
        assert_eq!(here, there);
        assert!(here.len() > 40, "{}", here.len());
    }

    #[test]
    fn greys_rise_from_black_to_white_and_stay_grey() {
        for map in ALL {
            assert!(map.apply([0.0; 3])[1] < 1e-3, "{map:?}");
            let mut last = 0.0;
            for step in 0..2000 {
                let grey = 2.0_f32.powf(step as f32 / 50.0 - 20.0);
                let [r, g, b] = map.apply([grey; 3]);
                assert!(g >= last - 1e-6, "{map:?} falls at {grey}: {g} after {last}");
                assert!((r - g).abs() < 2e-3 && (b - g).abs() < 2e-3, "{map:?} tints {grey}: {r} {g} {b}");
                last = g;
            }
            assert!(last > 0.99, "{map:?} ends at {last}");
        }
    }

    #[test]
    fn middle_grey_is_in_the_middle() {
        for (map, want) in ALL.into_iter().zip([0.18, 0.1525, 0.106, 0.18]) {
            let got = map.apply([0.18; 3])[1];
            assert!((got - want).abs() < 0.04, "{map:?}: {got} for {want}");
        }
    }

    #[test]
    fn nothing_leaves_the_range() {
        let values =
            [0.0, -0.0, 0.18, 1.0, 1e30, f32::MAX, -1e-3, -1e30, f32::MIN, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
        for map in ALL {
            for r in values {
                for g in values {
                    for b in values {
                        let out = map.apply([r, g, b]);
                        assert!(out.iter().all(|c| (0.0..=1.0).contains(c)), "{map:?} {r} {g} {b}: {out:?}");
                    }
                }
            }
            assert!(map.apply([f32::NAN; 3])[0] < 1e-3);
            assert!(map.apply([f32::NEG_INFINITY; 3])[0] < 1e-3);
            assert!(map.apply([f32::INFINITY; 3])[0] > 0.99, "{map:?}");
        }
    }
}
