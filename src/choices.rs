//! What a person chooses by name, with the same names on the command line, in files and in reports.

use serde::{Deserialize, Serialize};

/// How the field is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Evaluator {
    /// Sum the bells at every pixel.
    Direct,
    /// Sum every kept term of the series at every pixel.
    Series,
    /// Sum over the harmonics in y once for each row, then over those in x at every pixel.
    Rows,
    /// Evaluate the series on the coarse lattice that its band limit allows, then interpolate.
    Grid,
    /// Sum each bell at the pixels that it reaches, and nowhere else.
    Local,
    /// Sum the ghosts of all pixels of a photo on the picture's own pixels.
    Plate,
}

impl Evaluator {
    /// Every evaluator of single ghosts; the ghosts of all pixels of a photo go by a series, by a plate, or by both.
    pub const ALL: [Self; 5] = [Self::Direct, Self::Series, Self::Rows, Self::Grid, Self::Local];

    /// Those that evaluate a Fourier series.
    pub const SERIES: [Self; 3] = [Self::Series, Self::Rows, Self::Grid];

    /// Whether it evaluates a Fourier series, with a period and a degree.
    pub fn is_series(self) -> bool {
        Self::SERIES.contains(&self)
    }
}

impl std::fmt::Display for Evaluator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Direct => "direct",
            Self::Series => "series",
            Self::Rows => "rows",
            Self::Grid => "grid",
            Self::Local => "local",
            Self::Plate => "plate",
        })
    }
}

/// What sums a veil.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Processor {
    /// The processor's cores, by their vectors.
    Cpu,
    /// The device, by OpenGL.
    Gl,
}

impl std::fmt::Display for Processor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Cpu => "the CPU",
            Self::Gl => "OpenGL",
        })
    }
}

/// How the field's values become glare.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Normalize {
    /// As they are: physical.
    #[default]
    None,
    /// Clamped to 0..1.
    Clamp,
    /// Stretched so that the smallest over the picture becomes 0 and the largest 1, all colours alike; the prototype's.
    Minmax,
}

/// Where the glare's light comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Mix {
    /// From nowhere: the photo keeps its own
    #[default]
    Add,
    /// From the pixels that are lights: what scatters is missing there
    Energy,
}

/// What in a photo makes ghosts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Sources {
    /// Every pixel
    Photo,
    /// What is found to be a light, as one round spot each
    Lights,
}

/// What tells lights from the rest of a photo.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum LightBy {
    /// A pixel's luminance, by which red and blue lamps are darker than white ones
    Luminance,
    /// Its brightest channel, by which a lamp of any colour is as bright as a white one
    #[default]
    Brightest,
}

impl std::fmt::Display for LightBy {
    /// What is compared, for people.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Luminance => "luminance",
            Self::Brightest => "brightest channel",
        })
    }
}

/// What becomes of lights beyond the most that are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Beyond {
    /// Each joins the nearest that is kept, so that no light is lost
    #[default]
    Join,
    /// They are left out
    Drop,
}

/// What a light is that is long, bent or hollow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum LightShape {
    /// Several lights, each about as long as wide, so that it keeps its shape
    #[default]
    Kept,
    /// One round light of the same extent
    Ball,
}

/// What a look's lengths are counted in: sizes, and positions from the picture's centre.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum LengthUnit {
    /// Half the picture's height
    Height,
    /// Half its shorter side, which stays the same when it is turned by 90°
    ShortSide,
    /// Half its diagonal, which does so, too
    Diagonal,
    /// Degrees, as they are in the picture's middle, by its field of view
    Degrees,
}

impl LengthUnit {
    /// What a file with lengths in it means that names neither a unit nor a version: such files are older than the others.
    pub const OF_FILES: Self = Self::Height;
}

impl std::fmt::Display for LengthUnit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Height => "height",
            Self::ShortSide => "short-side",
            Self::Diagonal => "diagonal",
            Self::Degrees => "degrees",
        })
    }
}

/// How a camera formed the picture: what angle lies between two pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Projection {
    /// r = F tan ψ, as nearly every lens: straight lines stay straight
    Rectilinear,
    /// r = F ψ: an equidistant fisheye
    Fisheye,
    /// Of all directions, twice as wide as high: columns are azimuths, rows heights
    Equirectangular,
    /// A plane: angles are distances, which is right in the middle of a rectilinear picture only
    Planar,
}

/// What lies beyond the picture's edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Border {
    /// Nothing, which sends no light
    #[default]
    None,
    /// The picture again, turned over
    Mirror,
    /// The pixels at the edge, on and on
    Extend,
}
