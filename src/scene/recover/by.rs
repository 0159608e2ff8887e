//! What is asked for, as options and files say it.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// What becomes of clipped highlights where they make glare.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Recover {
    /// Of a picture for displays, they shine as bright as lamps of their kind are; of any other as they are.
    #[default]
    Auto,
    /// They shine as they are.
    None,
    /// They shine up to so many stops brighter, 0 to [`Recover::MOST`], in any photo.
    Stops(f64),
    /// As [`Recover::Auto`], but for the stops before a region's surroundings have their say: these, 0 to [`Recover::MOST`], whatever
    /// share of the picture is clipped.
    AutoFrom(f64),
}

impl Recover {
    /// The most stops: a million times as bright.
    pub const MOST: f64 = 20.0;
    /// What it may be, in words.
    pub const EXPECTED: &str = "\"auto\", \"auto:STOPS\", \"none\" or a number of stops from 0 to 20";

    /// So many stops, where they can be.
    pub fn stops(stops: f64) -> Option<Self> {
        (0.0..=Self::MOST).contains(&stops).then_some(Self::Stops(stops))
    }

    /// Whether the photo's kind decides, and what is around what is clipped.
    pub fn is_auto(self) -> bool {
        matches!(self, Self::Auto | Self::AutoFrom(_))
    }

    /// A word, or `auto:` and a number.
    fn named(text: &str) -> Option<Self> {
        match text {
            "auto" => Some(Self::Auto),
            "none" => Some(Self::None),
            _ => match Self::stops(text.strip_prefix("auto:")?.parse().ok()?)? {
                Self::Stops(stops) => Some(Self::AutoFrom(stops)),
                _ => None,
            },
        }
    }
}

impl std::fmt::Display for Recover {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::None => f.write_str("none"),
            Self::Stops(stops) => stops.fmt(f),
            Self::AutoFrom(stops) => write!(f, "auto:{stops}"),
        }
    }
}

impl std::str::FromStr for Recover {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = || text.parse().ok().and_then(Self::stops);
        Self::named(text).or_else(number).ok_or_else(|| format!("expected {}", Self::EXPECTED))
    }
}

/// A number, or a word.
impl Serialize for Recover {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Stops(stops) => serializer.serialize_f64(*stops),
            Self::Auto | Self::AutoFrom(_) | Self::None => serializer.collect_str(self),
        }
    }
}

impl<'de> Deserialize<'de> for Recover {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl serde::de::Visitor<'_> for Visitor {
            type Value = Recover;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str(Recover::EXPECTED)
            }

            fn visit_f64<E: serde::de::Error>(self, stops: f64) -> Result<Recover, E> {
                let wrong = || E::custom(format_args!("expected {}, found {stops}", Recover::EXPECTED));
                Recover::stops(stops).ok_or_else(wrong)
            }

            fn visit_i64<E: serde::de::Error>(self, stops: i64) -> Result<Recover, E> {
                self.visit_f64(stops as f64)
            }

            fn visit_u64<E: serde::de::Error>(self, stops: u64) -> Result<Recover, E> {
                self.visit_f64(stops as f64)
            }

            fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<Recover, E> {
                Recover::named(word).ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str(word), &self))
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}
