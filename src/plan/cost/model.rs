//! The cost model: what each kind of work takes on one machine.

use crate::plan::Precision;

/// Nanoseconds that each kind of work takes on one machine; every one of them finite and above 0.
///
/// The [`Default`] is a software renderer (llvmpipe, 256 bits) on two cores: about the middle of three runs of
/// `vglare calibrate` while little else ran. To choose
/// an evaluator the plan needs their ratios only; a budget in milliseconds needs the values of the machine at hand,
/// which `vglare calibrate` measures.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CostModel {
    /// One bell at one pixel, by `direct`.
    pub bell: f64,
    /// One term of the series at one pixel, by `series`.
    pub term: f64,
    /// One harmonic of a row's profile at one pixel, by `rows`.
    pub harmonic: f64,
    /// One term on the way to a row's profiles, by `rows`.
    pub profile: f64,
    /// One cell of the lattice stretched to one row, by `grid`.
    pub strip: f64,
    /// One interpolation at one pixel, by `grid`.
    pub interpolation: f64,
    /// One term of one ghost, in the spectrum.
    pub spectrum: f64,
    /// One moment of one ghost, where a group's spectrum is gathered. Calibrations from before there were moments lack it.
    #[serde(default = "built_in_moment")]
    pub moment: f64,
    /// One bell at one pixel that it reaches, by `local`. Calibrations from before there was `local` lack this, and the two
    /// that follow.
    #[serde(default = "lacking", skip_serializing_if = "is_lacking")]
    pub splat: f64,
    /// One ghost that is drawn where it reaches, by `local`.
    #[serde(default = "lacking", skip_serializing_if = "is_lacking")]
    pub quad: f64,
    /// One pixel of what they are drawn on, by `local`.
    #[serde(default = "lacking", skip_serializing_if = "is_lacking")]
    pub canvas: f64,
    /// The same as `term`, in 64-bit floats. Calibrations from before there were such series lack this, and the four that follow.
    #[serde(default = "lacking", skip_serializing_if = "is_lacking")]
    pub term_double: f64,
    /// The same as `harmonic`.
    #[serde(default = "lacking", skip_serializing_if = "is_lacking")]
    pub harmonic_double: f64,
    /// The same as `profile`.
    #[serde(default = "lacking", skip_serializing_if = "is_lacking")]
    pub profile_double: f64,
    /// One node of the lattice stretched to one row.
    #[serde(default = "lacking", skip_serializing_if = "is_lacking")]
    pub strip_double: f64,
    /// The same as `interpolation`, with a B-spline of more nodes.
    #[serde(default = "lacking", skip_serializing_if = "is_lacking")]
    pub interpolation_double: f64,
    /// One multiply-add of a veil at one pixel of one channel, by the CPU's cores together. Calibrations from before a device summed veils
    /// lack this, and the two that follow.
    #[serde(default = "lacking", skip_serializing_if = "is_lacking")]
    pub veil_add: f64,
    /// One tap of a veil at one texel, for three channels, by the device.
    #[serde(default = "lacking", skip_serializing_if = "is_lacking")]
    pub veil_tap: f64,
    /// One pixel that is readied, moved to the device and back.
    #[serde(default = "lacking", skip_serializing_if = "is_lacking")]
    pub veil_pixel: f64,
    /// Starting a pass.
    pub pass: f64,
}

impl Default for CostModel {
    fn default() -> Self {
        Self {
            bell: 1.9,
            term: 7.0,
            harmonic: 3.2,
            profile: 12.0,
            strip: 28.0,
            interpolation: 8.5,
            spectrum: 8.0,
            moment: built_in_moment(),
            splat: 2.8,
            quad: 450.0,
            canvas: 8.0,
            term_double: 8.5,
            harmonic_double: 4.5,
            profile_double: 10.0,
            strip_double: 50.0,
            interpolation_double: 30.0,
            veil_add: built_in_veil_add(),
            veil_tap: 1.5,
            veil_pixel: 27.0,
            pass: 50_000.0,
        }
    }
}

/// As the others; K = 1000 and 11,000 with 144 moments each.
fn built_in_moment() -> f64 {
    0.8
}

/// As the others; vectors of 256 bits.
fn built_in_veil_add() -> f64 {
    0.06
}

/// A constant that an old calibration has not: no time.
fn lacking() -> f64 {
    f64::NAN
}

fn is_lacking(value: &f64) -> bool {
    value.is_nan()
}

impl CostModel {
    /// How many constants there are.
    pub const COUNT: usize = 20;

    /// The constants' names, in the order of [`CostModel::values`].
    pub const NAMES: [&'static str; Self::COUNT] = [
        "bell",
        "term",
        "harmonic",
        "profile",
        "strip",
        "interpolation",
        "spectrum",
        "moment",
        "splat",
        "quad",
        "canvas",
        "term_double",
        "harmonic_double",
        "profile_double",
        "strip_double",
        "interpolation_double",
        "veil_add",
        "veil_tap",
        "veil_pixel",
        "pass",
    ];

    /// The constants in nanoseconds, in the order of [`CostModel::NAMES`].
    pub fn values(&self) -> [f64; Self::COUNT] {
        [
            self.bell,
            self.term,
            self.harmonic,
            self.profile,
            self.strip,
            self.interpolation,
            self.spectrum,
            self.moment,
            self.splat,
            self.quad,
            self.canvas,
            self.term_double,
            self.harmonic_double,
            self.profile_double,
            self.strip_double,
            self.interpolation_double,
            self.veil_add,
            self.veil_tap,
            self.veil_pixel,
            self.pass,
        ]
    }

    /// The constants from nanoseconds, in the order of [`CostModel::NAMES`].
    pub fn from_values(values: [f64; Self::COUNT]) -> Self {
        let [
            bell,
            term,
            harmonic,
            profile,
            strip,
            interpolation,
            spectrum,
            moment,
            splat,
            quad,
            canvas,
            term_double,
            harmonic_double,
            profile_double,
            strip_double,
            interpolation_double,
            veil_add,
            veil_tap,
            veil_pixel,
            pass,
        ] = values;
        Self {
            bell,
            term,
            harmonic,
            profile,
            strip,
            interpolation,
            spectrum,
            moment,
            splat,
            quad,
            canvas,
            term_double,
            harmonic_double,
            profile_double,
            strip_double,
            interpolation_double,
            veil_add,
            veil_tap,
            veil_pixel,
            pass,
        }
    }

    /// With what a series costs in floats of a precision in the place of what it does in 32-bit ones.
    pub(super) fn in_floats(&self, precision: Precision) -> Self {
        match precision {
            Precision::Single => *self,
            Precision::Double => Self {
                term: self.term_double,
                harmonic: self.harmonic_double,
                profile: self.profile_double,
                strip: self.strip_double,
                interpolation: self.interpolation_double,
                ..*self
            },
        }
    }

    /// With all constants, where some are lacking: then these are to the others as they are in the built-in model, and the CPU's as there.
    pub fn completed(&self) -> Option<Self> {
        let (values, built_in) = (self.values(), Self::default().values());
        let mut ratios: Vec<f64> = values.iter().zip(built_in).map(|(value, built_in)| value / built_in).collect();
        ratios.retain(|ratio| !ratio.is_nan());
        if ratios.len() == values.len() || ratios.is_empty() {
            return None;
        }
        ratios.sort_by(f64::total_cmp);
        let ratio = ratios[ratios.len() / 2];
        let complete = |k: usize| if values[k].is_nan() { ratio * built_in[k] } else { values[k] };
        let all = Self::from_values(std::array::from_fn(complete));
        // A device says nothing of the CPU.
        let veil_add = if self.veil_add.is_nan() { built_in_veil_add() } else { self.veil_add };
        Some(Self { veil_add, ..all })
    }

    /// What there was not yet when this was measured, in words; none where no constant is lacking.
    pub fn lacks(&self) -> Option<&'static str> {
        let since = [
            (self.splat, "there was `local`"),
            (self.term_double, "there were series in 64-bit floats"),
            (self.veil_tap, "devices summed veils"),
        ];
        since.into_iter().find_map(|(constant, what)| is_lacking(&constant).then_some(what))
    }

    /// Whether every constant is what a time can be: finite and above 0.
    pub fn is_sound(&self) -> bool {
        self.values().iter().all(|&value| value.is_finite() && value > 0.0)
    }
}
