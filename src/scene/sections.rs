//! What a scene file says besides what glares: how the glare looks, what counts as a light, and how exact it is to be.

use serde::{Deserialize, Deserializer, Serialize};
use toml::Spanned;

use super::bells::Fault;
use super::number::{Allowed, IsFactor, IsField, IsFraction, IsNotNegative, IsPositive, NotNegative, Number, plain};
use super::{FindOptions, Recover};
use crate::choices::{Beyond, Evaluator, LengthUnit, LightBy, LightShape, Mix, Normalize, Sources};

/// What a scene file means by what it does not say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Version {
    /// That of files without a version: lights that are found, few of them, seen through the lenses of then.
    One,
    /// Today's: every pixel is a source.
    #[default]
    Two,
}

impl Version {
    /// Its number, as a file says it.
    pub fn number(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Two => 2,
        }
    }
}

/// `[look]`; what is `None` is left to the command line and its defaults.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LookSection {
    /// What the glare is multiplied by, 0 or more.
    #[serde(default, deserialize_with = "number::<_, IsNotNegative>", skip_serializing_if = "Option::is_none")]
    pub strength: Option<f64>,
    /// What the size of every ghost is multiplied by, > 0; its flux stays.
    #[serde(default, deserialize_with = "number::<_, IsPositive>", skip_serializing_if = "Option::is_none")]
    pub size: Option<f64>,
    /// What the colour of every ghost is multiplied by, RGB, 0 or more.
    #[serde(default, deserialize_with = "colour", skip_serializing_if = "Option::is_none")]
    pub tint: Option<[f64; 3]>,
    /// Where the glare's light comes from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mix: Option<Mix>,
    /// How the field's values become glare.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normalize: Option<Normalize>,
    /// What lengths are counted in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<LengthUnit>,
    /// What the picture's width spans, in degrees.
    #[serde(default, deserialize_with = "number::<_, IsField>", skip_serializing_if = "Option::is_none")]
    pub fov: Option<f64>,
    /// What in the photo makes ghosts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sources: Option<Sources>,
    /// What becomes of clipped highlights where they make glare.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recover: Option<Recover>,
}

/// `[find]`; see [`super::FindOptions`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FindSection {
    /// What tells light from the rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<LightBy>,
    /// The brightness from which on a pixel is light, 0 or more, in the photo's unit.
    #[serde(default, deserialize_with = "number::<_, IsNotNegative>", skip_serializing_if = "Option::is_none")]
    pub threshold: Option<f64>,
    /// How close regions are that become one light, 0 or more, in half picture heights.
    #[serde(default, deserialize_with = "number::<_, IsNotNegative>", skip_serializing_if = "Option::is_none")]
    pub merge: Option<f64>,
    /// What becomes of a region that is no ball.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<LightShape>,
    /// Most lights.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_lights: Option<usize>,
    /// What becomes of the others.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub beyond: Option<Beyond>,
    /// How many times as bright as its brightest neighbour a single pixel may be, and still is light: at least 1, or 0 for
    /// whatever it likes.
    #[serde(default, deserialize_with = "number::<_, IsFactor>", skip_serializing_if = "Option::is_none")]
    pub firefly_limit: Option<f64>,
    /// How far about the threshold pixels begin to shine, 0 or more.
    #[serde(default, deserialize_with = "number::<_, IsNotNegative>", skip_serializing_if = "Option::is_none")]
    pub knee: Option<f64>,
    /// Whether the file's lights are added to those of the photo, instead of taking their place.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub add: bool,
}

/// `[accuracy]`; period and degree of the series stand at the top of the file.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AccuracySection {
    /// What the plan is to reach.
    pub goal: Option<Goal>,
    /// Whether to take the lowest tolerance that can be had, where what is asked cannot.
    pub allow_floor: bool,
    /// Whether the error at each pixel is to be within the tolerance of photo and glare there, too; not with a budget.
    pub each_pixel: bool,
    /// How the field is computed.
    pub evaluator: Option<Evaluator>,
}

/// What a plan is to reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// The largest error relative to the largest glare of the same colour, between 0 and 1.
    Tolerance(f64),
    /// Milliseconds for the spectrum and the field, > 0: be as exact as they allow.
    Budget(f64),
}

impl Goal {
    /// The milliseconds, if it is a budget.
    pub fn budget(self) -> Option<f64> {
        match self {
            Self::Tolerance(_) => None,
            Self::Budget(budget) => Some(budget),
        }
    }
}

impl Default for Goal {
    fn default() -> Self {
        Self::Tolerance(1e-3)
    }
}

/// `[accuracy]` as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AccuracyTable {
    tolerance: Option<Number<IsFraction>>,
    budget: Option<Spanned<Number<IsPositive>>>,
    #[serde(default)]
    allow_floor: bool,
    #[serde(default)]
    each_pixel: bool,
    evaluator: Option<Evaluator>,
}

impl AccuracyTable {
    /// What it says, unless it says two things at once.
    pub fn section(self) -> Result<AccuracySection, Fault> {
        let Self { tolerance, budget, allow_floor, each_pixel, evaluator } = self;
        let goal = match (tolerance, budget) {
            (Some(_), Some(budget)) => {
                let message = "expected either `tolerance` or `budget`, found both".to_owned();
                return Err(Fault { span: budget.span(), message });
            }
            (None, Some(budget)) if each_pixel => {
                let message = "`each_pixel` is of a `tolerance`, and this is a `budget`".to_owned();
                return Err(Fault { span: budget.span(), message });
            }
            (Some(tolerance), None) => Some(Goal::Tolerance(tolerance.0)),
            (None, Some(budget)) => Some(Goal::Budget(budget.into_inner().0)),
            (None, None) => None,
        };
        Ok(AccuracySection { goal, allow_floor, each_pixel, evaluator })
    }
}

fn number<'de, D: Deserializer<'de>, R: Allowed>(deserializer: D) -> Result<Option<f64>, D::Error> {
    Number::<R>::deserialize(deserializer).map(|number| Some(number.0))
}

fn colour<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[f64; 3]>, D::Error> {
    <[NotNegative; 3]>::deserialize(deserializer).map(|numbers| Some(plain(numbers)))
}

impl FindSection {
    /// What counts as a light, with the defaults that a version has for what is left open.
    pub fn options(self, version: Version) -> FindOptions {
        let default = match version {
            Version::One => FindOptions::VERSION_1,
            Version::Two => FindOptions::default(),
        };
        FindOptions {
            by: self.by.unwrap_or(default.by),
            threshold: self.threshold,
            merge: self.merge.unwrap_or(default.merge),
            shape: self.shape.unwrap_or(default.shape),
            max_lights: self.max_lights.unwrap_or(default.max_lights),
            beyond: self.beyond.unwrap_or(default.beyond),
            firefly_limit: self.firefly_limit.unwrap_or(default.firefly_limit),
            knee: self.knee.unwrap_or(default.knee),
            // What shines brighter than it is shown stands in [`LookSection`].
            recover: default.recover,
        }
    }
}
