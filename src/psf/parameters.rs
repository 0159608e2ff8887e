//! What a user writes of a point-spread function, and what is wrong with it.

#[cfg(test)]
mod tests;

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::eye::{Luminance, Observer};
use super::function::Function;
use super::plane::{self, Abg};
use super::starburst::{self, Starburst};
use super::{Fault, Kernel, Psf, Table};

/// The functions that there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "terminal", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Name {
    /// CIE 146:2002's general disability glare equation.
    Cie,
    /// CIE 135/1's total glare function, with the core.
    Cie135,
    /// Spencer's (1995), without the ring.
    Spencer,
    /// Stiles and Holladay's, adjusted to age.
    StilesHolladay,
    /// One Gaussian.
    Gaussian,
    /// Gaussians with weights and tints.
    Mixture,
    /// A/(B + r^g).
    Abg,
    /// Rows of radius and value.
    Table,
    /// A lens: a core and an inverse-square tail.
    Camera,
    /// A picture.
    Kernel,
    /// An iris, by what it diffracts.
    Starburst,
}

impl Name {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Cie,
        Self::Cie135,
        Self::Spencer,
        Self::StilesHolladay,
        Self::Gaussian,
        Self::Mixture,
        Self::Abg,
        Self::Table,
        Self::Camera,
        Self::Kernel,
        Self::Starburst,
    ];

    /// As it is written.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Cie => "cie",
            Self::Cie135 => "cie135",
            Self::Spencer => "spencer",
            Self::StilesHolladay => "stiles-holladay",
            Self::Gaussian => "gaussian",
            Self::Mixture => "mixture",
            Self::Abg => "abg",
            Self::Table => "table",
            Self::Camera => "camera",
            Self::Kernel => "kernel",
            Self::Starburst => "starburst",
        }
    }

    /// The keys that it takes beside `psf` and `scatter`.
    pub fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Cie | Self::Cie135 => &["age", "pigment"],
            Self::Spencer => &["luminance"],
            Self::StilesHolladay => &["age"],
            Self::Gaussian => &["width"],
            Self::Mixture => &["widths", "weights", "tints"],
            Self::Abg => &["a", "b", "g", "end"],
            Self::Table => &["table"],
            Self::Camera => &[],
            Self::Kernel => &["kernel"],
            Self::Starburst => &["fstop", "blades", "rotation", "roundness", "sensor"],
        }
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl FromStr for Name {
    type Err = Fault;

    fn from_str(text: &str) -> Result<Self, Fault> {
        Self::ALL.into_iter().find(|name| name.as_str() == text).ok_or_else(|| {
            let known = Self::ALL.map(Self::as_str).join(", ");
            Fault::new("psf", format!("no point-spread function is called {text:?}; there are {known}"))
        })
    }
}

/// What the command line or the `[veil]` of a scene file says of a function: nothing of it has been checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Parameters {
    /// Which function.
    pub psf: Name,
    /// Of `cie`, `cie135`, `stiles-holladay`: years, 0 to 120; 25 without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub age: Option<f64>,
    /// Of `cie`, `cie135`: pigment factor, 0 (black eyes) to 1.2 (very light); 0.5 (brown) without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pigment: Option<f64>,
    /// Of `spencer`; photopic without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub luminance: Option<Luminance>,
    /// Of `gaussian`: standard deviation, in the look's unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<f64>,
    /// Of `mixture`: standard deviations, in the look's unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub widths: Option<Vec<f64>>,
    /// Of `mixture`: energies, one for each width, as ratios; equal without any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<f64>>,
    /// Of `mixture`: three channels for each width; white without any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tints: Option<Vec<[f64; 3]>>,
    /// Of `abg`: A, per squared unit times the unit of B.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub a: Option<f64>,
    /// Of `abg`: B, in the look's unit to the power g.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub b: Option<f64>,
    /// Of `abg`: g, 0.5 to 10.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub g: Option<f64>,
    /// Of `abg`: the radius where it ends, in the look's unit; below g = 2.05 there must be one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<f64>,
    /// Of `table`: a CSV file of radius, in the look's unit, and value; nothing lies beyond its last row.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table: Option<PathBuf>,
    /// Of `kernel`: a picture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kernel: Option<PathBuf>,
    /// Of `starburst`: the f-number, 0.5 to 64.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fstop: Option<f64>,
    /// Of `starburst`: blades of the iris, 3 to 16, or 0 where it is round; 6 without any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blades: Option<u32>,
    /// Of `starburst`: degrees against the clock from the right to the first corner; 0 without any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<f64>,
    /// Of `starburst`: how far its blades are bent, from 0, straight, to 1, a circle; 0 without any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roundness: Option<f64>,
    /// Of `starburst`: millimetres of the sensor that the photo's width spans, 1 to 500; 36 without any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor: Option<f64>,
    /// Of all: the share of the light that is scattered, instead of the function's own energy; above 0, at most 1. Of `starburst`: what
    /// the lens scatters besides, by `camera`, from 0; 0 without any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scatter: Option<f64>,
}

impl Parameters {
    /// The keys that there are, as they are written.
    pub const KEYS: [&str; 20] = [
        "psf",
        "age",
        "pigment",
        "luminance",
        "width",
        "widths",
        "weights",
        "tints",
        "a",
        "b",
        "g",
        "end",
        "table",
        "kernel",
        "fstop",
        "blades",
        "rotation",
        "roundness",
        "sensor",
        "scatter",
    ];

    /// A function and nothing else.
    pub fn new(psf: Name) -> Self {
        Self {
            psf,
            age: None,
            pigment: None,
            luminance: None,
            width: None,
            widths: None,
            weights: None,
            tints: None,
            a: None,
            b: None,
            g: None,
            end: None,
            table: None,
            kernel: None,
            fstop: None,
            blades: None,
            rotation: None,
            roundness: None,
            sensor: None,
            scatter: None,
        }
    }

    /// The keys that are given, beside `psf` and `scatter`.
    fn given(&self) -> impl Iterator<Item = &'static str> {
        [
            ("age", self.age.is_some()),
            ("pigment", self.pigment.is_some()),
            ("luminance", self.luminance.is_some()),
            ("width", self.width.is_some()),
            ("widths", self.widths.is_some()),
            ("weights", self.weights.is_some()),
            ("tints", self.tints.is_some()),
            ("a", self.a.is_some()),
            ("b", self.b.is_some()),
            ("g", self.g.is_some()),
            ("end", self.end.is_some()),
            ("table", self.table.is_some()),
            ("kernel", self.kernel.is_some()),
            ("fstop", self.fstop.is_some()),
            ("blades", self.blades.is_some()),
            ("rotation", self.rotation.is_some()),
            ("roundness", self.roundness.is_some()),
            ("sensor", self.sensor.is_some()),
        ]
        .into_iter()
        .filter_map(|(key, given)| given.then_some(key))
    }

    /// The function. Of `table` and `kernel`, what their files hold is given by `table` (its text) and `kernel`, which
    /// are called only if the function asks for them.
    ///
    /// # Errors
    /// On a key that the function does not take, one that it needs and that is not there, a number that is out of its
    /// range; and what `table` and `kernel` return.
    pub fn function(
        &self,
        table: impl FnOnce(&Path) -> Result<String, Fault>,
        kernel: impl FnOnce(&Path) -> Result<Kernel, Fault>,
    ) -> Result<Psf, Fault> {
        let name = self.psf;
        if let Some(key) = self.given().find(|key| !name.keys().contains(key)) {
            let takes = [name.keys(), &["scatter"]].concat().join(", ");
            return Err(Fault::new(key, format!("{name} does not take it; it takes {takes}")));
        }
        let observer = || Observer::new(self.age.unwrap_or(25.0), self.pigment.unwrap_or(0.5));
        let function = match name {
            Name::Cie => Function::Cie(observer()?),
            Name::Cie135 => Function::Cie135(observer()?),
            Name::Spencer => Function::Spencer(self.luminance.unwrap_or_default()),
            Name::StilesHolladay => Function::StilesHolladay { age: observer()?.age() },
            Name::Gaussian => Function::Gaussian(plane::gaussian(needed(name, "width", self.width)?)?),
            Name::Mixture => {
                let widths = needed(name, "widths", self.widths.as_deref())?;
                Function::Mixture(plane::mixture(widths, self.weights.as_deref(), self.tints.as_deref())?)
            }
            Name::Abg => {
                let factors = [needed(name, "a", self.a)?, needed(name, "b", self.b)?, needed(name, "g", self.g)?];
                Function::Abg(Abg::new(factors, self.end)?)
            }
            Name::Table => Function::Table(Table::parse(&table(needed(name, "table", self.table.as_ref())?)?)?),
            Name::Camera => Function::Camera,
            Name::Kernel => Function::Kernel(kernel(needed(name, "kernel", self.kernel.as_ref())?)?, name),
            Name::Starburst => Function::Starburst(self.starburst()?),
        };
        let psf = Psf::of(function);
        match self.scatter {
            Some(scatter) => psf.scattering(scatter),
            None => Ok(psf),
        }
    }
}

impl Parameters {
    /// The iris of `starburst`, without what its lens scatters.
    fn starburst(&self) -> Result<Starburst, Fault> {
        Starburst::new(
            needed(self.psf, "fstop", self.fstop)?,
            self.blades.unwrap_or(starburst::USUAL_BLADES),
            self.rotation.unwrap_or(0.0),
            self.roundness.unwrap_or(0.0),
            self.sensor.unwrap_or(starburst::USUAL_SENSOR),
        )
    }
}

/// What a key says, which `name` cannot do without.
fn needed<T>(name: Name, key: &'static str, value: Option<T>) -> Result<T, Fault> {
    value.ok_or_else(|| Fault::new(key, format!("{name} needs it")))
}
