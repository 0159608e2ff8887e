//! What can be wrong with a lens, one variant for each thing that a caller can act on.

use std::path::PathBuf;

/// A result whose error is of optics.
pub type Result<T, E = OpticsError> = std::result::Result<T, E>;

/// Why a lens cannot be read, set up or traced. Surfaces are numbered from 1, lines as well.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OpticsError {
    /// The file is missing, cannot be opened, or is larger than any prescription.
    #[error("cannot read the lens {}: {reason}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why, in words.
        reason: String,
    },

    /// The file as a whole is no prescription that can be used.
    #[error("{lens}: {reason}")]
    Lens {
        /// The file's or the lens's name.
        lens: String,
        /// Why, in words.
        reason: String,
    },

    /// A line of the file cannot be read.
    #[error("{file}, line {line}: {reason}")]
    Line {
        /// The file's name.
        file: String,
        /// The line.
        line: usize,
        /// Why, in words.
        reason: String,
    },

    /// A surface says something that it must not.
    #[error("{lens}, surface {surface}{}: {reason}", at_line(*line))]
    Surface {
        /// The file's or the lens's name.
        lens: String,
        /// The surface.
        surface: usize,
        /// The line at which the surface begins, where it was read from a file.
        line: Option<usize>,
        /// Why, in words.
        reason: String,
    },

    /// A surface, or the whole file, has a property that this model of a lens lacks. It is never left out silently.
    #[error("{lens}{}: {feature} cannot be honoured", at_surface(*surface, *line))]
    Unsupported {
        /// The file's or the lens's name.
        lens: String,
        /// The surface, unless the whole file is meant.
        surface: Option<usize>,
        /// The line that says so.
        line: Option<usize>,
        /// The property, in the file's own words.
        feature: String,
    },

    /// No glass of the catalogue has this name.
    #[error("{lens}, surface {surface}{}: no glass is called {name:?}{}", at_line(*line), perhaps(nearest))]
    UnknownGlass {
        /// The file's or the lens's name.
        lens: String,
        /// The surface.
        surface: usize,
        /// The line at which the surface begins, where it was read from a file.
        line: Option<usize>,
        /// The name that was given.
        name: String,
        /// Names of the catalogue that resemble it, the nearest first.
        nearest: Vec<String>,
    },

    /// The lens has no zoom setting of this name.
    #[error("{lens} has no setting {name:?}; it has {}", listed(known))]
    UnknownSetting {
        /// The lens's name.
        lens: String,
        /// The name that was given.
        name: String,
        /// The names that there are.
        known: Vec<String>,
    },

    /// The lens has no optical power: it makes no image of distant light.
    #[error("{lens} is afocal: it has no focal length, and makes no image of distant light")]
    Afocal {
        /// The lens's name.
        lens: String,
    },

    /// The lens spreads light, so that its image is not on the sensor's side.
    #[error("{lens} makes no real image: its focal length is {focal_length:.4} mm, its back focus {back_focus:.4} mm")]
    NoRealImage {
        /// The lens's name.
        lens: String,
        /// The focal length, in mm.
        focal_length: f64,
        /// From the last surface to the focal point, in mm; negative where that is before it.
        back_focus: f64,
    },

    /// What a photographer asked of the lens cannot be had, or means nothing.
    #[error("{0}")]
    Setup(String),

    /// A path of light names surfaces that the lens lacks, or in an order in which no light goes.
    #[error("no light goes by way of reflections at surfaces {reflections:?} of a lens of {surfaces}")]
    Path {
        /// The surfaces at which the light is to be reflected, in its order.
        reflections: Vec<usize>,
        /// How many surfaces the lens has.
        surfaces: usize,
    },
}

fn at_line(line: Option<usize>) -> String {
    line.map_or_else(String::new, |line| format!(" (line {line})"))
}

fn at_surface(surface: Option<usize>, line: Option<usize>) -> String {
    match surface {
        Some(surface) => format!(", surface {surface}{}", at_line(line)),
        None => line.map_or_else(String::new, |line| format!(", line {line}")),
    }
}

fn perhaps(nearest: &[String]) -> String {
    if nearest.is_empty() { String::new() } else { format!("; the nearest are {}", nearest.join(", ")) }
}

fn listed(known: &[String]) -> String {
    if known.is_empty() { "none".to_owned() } else { known.join(", ") }
}
