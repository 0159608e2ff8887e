//! What can go wrong, one variant for each thing that a caller can act on.

use std::path::{Path, PathBuf};

use crate::shot::Frames;

/// A result whose error is vglare's own.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Everything that can go wrong, with the file and the reason in its text.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A photo could not be read: missing, damaged, or of a kind that vglare does not read.
    #[error("cannot read the photo {}: {reason}", path.display())]
    ReadPhoto {
        /// The file or folder.
        path: PathBuf,
        /// Why, in words.
        reason: String,
    },

    /// A picture could not be written. Nothing is left behind under its name.
    #[error("cannot write {}: {reason}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// Why, in words.
        reason: String,
    },

    /// The output exists already and `--force` was not given.
    #[error("{} exists already; --force overwrites it", path.display())]
    Exists {
        /// The file or folder.
        path: PathBuf,
    },

    /// A folder that is to be filled holds something else already, and `--force` was not given.
    #[error("the folder {} holds other files; name another, or --force writes among them", path.display())]
    Occupied {
        /// The file or folder.
        path: PathBuf,
    },

    /// A scene, light or lens file says something that it must not.
    #[error("{}: {reason}", path.display())]
    SceneFile {
        /// The file or folder.
        path: PathBuf,
        /// Why, in words.
        reason: String,
    },

    /// A path of lights or of a camera says something that it must not.
    #[error("{}:{} {reason}", path.display(), line.map(|line| format!("{line}:")).unwrap_or_default())]
    PathFile {
        /// The file or folder.
        path: PathBuf,
        /// The line, where one is at fault.
        line: Option<u64>,
        /// Why, in words.
        reason: String,
    },

    /// A script for the window that cannot be read or played.
    #[error("{}: {reason}", path.display())]
    Script {
        /// The file or folder.
        path: PathBuf,
        /// Why, in words.
        reason: String,
    },

    /// No lens preset has this name.
    #[error("no lens preset is called {name:?}; there are {}{}{}", known.join(", "), older(known), meant(name, known))]
    UnknownPreset {
        /// The name that was given.
        name: String,
        /// The names that there are.
        known: Vec<String>,
    },

    /// No real lens has this name, and no preset.
    #[error(
        "no lens is called {name:?}, and there is no such file; there are {}, and those of vglare presets{}",
        known.join(", "),
        meant(name, known)
    )]
    UnknownLens {
        /// The name that was given.
        name: String,
        /// The names of real lenses.
        known: Vec<String>,
    },

    /// A lens cannot be read, set up or traced.
    #[error(transparent)]
    Optics(#[from] crate::optics::OpticsError),

    /// f32 cannot be as exact as asked in this scene.
    #[error(
        "{}; ask for --tolerance {}, or for whatever can be had by --allow-floor",
        below_floor(*asked, *floor),
        above(*floor)
    )]
    ToleranceBelowFloor {
        /// The tolerance, relative to the largest glare.
        asked: f64,
        /// The least that can be had, in the same measure.
        floor: f64,
    },

    /// Even the loosest plan is expected to take longer than it may.
    #[error("a budget of {asked:.3} ms is below what the cheapest plan is expected to cost here: {least:.3} ms")]
    BudgetTooSmall {
        /// The budget, in milliseconds.
        asked: f64,
        /// What the cheapest plan is expected to take, in milliseconds.
        least: f64,
    },

    /// The rendered field is further from the truth than was asked.
    #[error("the glare is off by {measured:.1e} of its largest value, and {asked:.1e} was asked")]
    ToleranceMissed {
        /// What was asked, relative to the largest glare.
        asked: f64,
        /// The largest error that was measured, in the same measure.
        measured: f64,
    },

    /// The glare is not certain to be as exact at each pixel as was asked.
    #[error(
        "the glare may be off by {predicted:.1e} of photo and glare at the darkest pixel, and {asked:.1e} was asked"
    )]
    EachPixelMissed {
        /// What was asked, relative to photo and glare.
        asked: f64,
        /// The bound, in the same measure.
        predicted: f64,
    },

    /// The veil is further from the truth than was asked.
    #[error("the veil is off by {measured:.1e} of its own brightness at a pixel, and {asked:.1e} was asked")]
    VeilMissed {
        /// What was asked, relative to the local veil.
        asked: f64,
        /// The largest error that was measured, in the same measure.
        measured: f64,
    },

    /// Nothing says how far an answer is from the truth, and an answer without that is none.
    #[error("it cannot be proved: {0}")]
    Unproved(String),

    /// A photo without its veil, veiled again, is further from the photo than the tolerance allows.
    #[error(
        "the photo without its veil, veiled again, is off by {measured:.1e} of its brightest sample, and {asked:.1e} was asked"
    )]
    RemovalMissed {
        /// What was asked, relative to the brightest sample of the same channel.
        asked: f64,
        /// The largest difference that was measured, in the same measure.
        measured: f64,
    },

    /// What was rendered is not finite where the photo is: too bright for 32-bit floats, or a driver's fault.
    #[error("the glare is infinite or undefined at {} where the photo is not; nothing is written", counted(*pixels))]
    NotFinite {
        /// How many pixels it is at.
        pixels: usize,
    },

    /// The glare is finite, and the picture is not where the photo is: their sum is too bright for 32-bit floats.
    #[error(
        "the picture is infinite or undefined at {} where photo and glare are not: their sum is beyond what 32-bit floats hold; \
         nothing is written",
        counted(*pixels)
    )]
    PictureNotFinite {
        /// How many pixels it is at.
        pixels: usize,
    },

    /// One photo of several could not be done.
    #[error("{}: {error}", path.display())]
    Frame {
        /// The file or folder.
        path: PathBuf,
        /// What went wrong with it.
        error: Box<Error>,
    },

    /// What one of several processes said of a photo that it could not do.
    #[error("{reason}")]
    Worker {
        /// In its words.
        reason: String,
        /// What it would have exited with.
        code: u8,
    },

    /// Several photos were done, but not all; each error has been told.
    #[error("{failed} of {frames} photos could not be done")]
    Frames {
        /// How many were not done.
        failed: usize,
        /// How many there were.
        frames: usize,
        /// The first error.
        first: Box<Error>,
    },

    /// Frames that were asked for are not there.
    #[error("{}", lacking(missing))]
    MissingFrames {
        /// What names frames, or the folder that they are in, and their numbers.
        missing: Vec<(PathBuf, Frames)>,
    },

    /// Of several photos, some have glare that is further from the truth than was asked.
    #[error(
        "the glare of {missed} of {frames} photos is further off than was asked; {} is the worst, with {measured:.1e} \
         of {}, and {asked:.1e} was asked",
        worst.display(),
        if *veil { "the veil at a pixel" } else { "its largest value" }
    )]
    FramesMissed {
        /// How many missed it.
        missed: usize,
        /// How many there were.
        frames: usize,
        /// The photo with the largest error.
        worst: PathBuf,
        /// Whether that is one of its veil, relative to the local veil.
        veil: bool,
        /// The largest error that was measured, in the same measure.
        measured: f64,
        /// What was asked, relative to the largest glare.
        asked: f64,
    },

    /// What was asked of the plan cannot be had.
    #[error("no plan: {0}")]
    Plan(String),

    /// The bench missed a bar, and was asked to hold them all.
    #[error("missed:\n  {}", missed.join("\n  "))]
    Missed {
        /// Each bar that was missed, in words.
        missed: Vec<String>,
    },

    /// A chart could not be drawn.
    #[error("the chart cannot be drawn: {0}")]
    Chart(String),

    /// The system's limit of memory leaves too little.
    #[error("not enough memory: {reason}")]
    Memory {
        /// Why, in words.
        reason: String,
    },

    /// The system gives no thread to work on, or too few.
    #[error("too few threads can be started: {reason}")]
    Threads {
        /// Why, in words.
        reason: String,
    },

    /// A mistake in the program itself.
    #[error("an internal error ({what}); please report it")]
    Internal {
        /// Where, and what it said.
        what: String,
    },

    /// Someone who watched called it off.
    #[error("cancelled")]
    Cancelled,

    /// Options that do not go together.
    #[error("{0}")]
    Usage(String),

    /// No backend gives OpenGL 4.3.
    #[error("no OpenGL 4.3 context could be had\n  {}", reasons.join("\n  "))]
    NoContext {
        /// Why, for each way that was tried.
        reasons: Vec<String>,
    },

    /// There is nothing to open a window on.
    #[error("no window can be opened: {reason}")]
    NoDisplay {
        /// Why, in words.
        reason: String,
    },

    /// The driver refused something that it should support; a shader that does not compile, for example.
    #[error("OpenGL failed: {0}")]
    Gl(String),
}

/// A path as a person is told of it: `-` is no file.
fn told(path: &Path, standard: &str) -> PathBuf {
    if path == Path::new("-") { standard.into() } else { path.to_owned() }
}

impl Error {
    /// Why something cannot be had, without what to ask for instead: for where another way is taken anyway.
    pub(crate) fn reason(&self) -> String {
        match self {
            Self::ToleranceBelowFloor { asked, floor } => below_floor(*asked, *floor),
            error => error.to_string(),
        }
    }

    /// What the program exits with: 1 in general, 2 where the command line asks for the impossible, 3 where the
    /// tolerance or the budget cannot be or was not met, 4 where there is no OpenGL or no display. (clap's own usage errors exit with 2 as well.)
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Frame { error, .. } | Self::Frames { first: error, .. } => error.exit_code(),
            Self::Worker { code, .. } => *code,
            Self::UnknownPreset { .. } | Self::UnknownLens { .. } | Self::Usage(_) => 2,
            Self::ToleranceBelowFloor { .. }
            | Self::BudgetTooSmall { .. }
            | Self::ToleranceMissed { .. }
            | Self::EachPixelMissed { .. }
            | Self::VeilMissed { .. }
            | Self::RemovalMissed { .. }
            | Self::Unproved(_)
            | Self::FramesMissed { .. }
            | Self::Missed { .. } => 3,
            Self::NoContext { .. } | Self::NoDisplay { .. } => 4,
            _ => 1,
        }
    }

    /// The error of one photo of several, with its name unless the text has it already.
    pub(crate) fn in_frame(self, path: &Path) -> Self {
        match self {
            Self::ReadPhoto { .. } | Self::Write { .. } | Self::Exists { .. } | Self::Worker { .. } => self,
            error => Self::Frame { path: path.to_owned(), error: Box::new(error) },
        }
    }

    /// A [`Error::ReadPhoto`] from anything that can say why.
    pub fn read_photo(path: &Path, reason: impl ToString) -> Self {
        Self::ReadPhoto { path: told(path, "standard input"), reason: reason.to_string() }
    }

    /// A [`Error::Write`] from anything that can say why.
    pub fn write(path: &Path, reason: impl ToString) -> Self {
        Self::Write { path: told(path, "standard output"), reason: reason.to_string() }
    }

    /// A [`Error::Threads`] from what the system says.
    pub(crate) fn threads(reason: impl ToString) -> Self {
        Self::Threads { reason: reason.to_string() }
    }

    /// A [`Error::SceneFile`] from anything that can say why.
    pub fn scene_file(path: &Path, reason: impl ToString) -> Self {
        Self::SceneFile { path: path.to_owned(), reason: reason.to_string() }
    }
}

/// The name that may have been meant, as a question; empty where none is like what was given.
fn meant(name: &str, known: &[String]) -> String {
    let name = name.to_lowercase();
    let alike = |known: &&String| match known.contains(&name) && name.len() > 2 {
        true => 1.0,
        false => strsim::jaro_winkler(&name, known),
    };
    let best = known.iter().max_by(|a, b| alike(a).total_cmp(&alike(b)));
    best.filter(|best| alike(best) > 0.8).map_or_else(String::new, |best| format!("; did you mean {best}?"))
}

/// Those that are not in a list of names.
fn older(known: &[String]) -> &'static str {
    if known.iter().any(|name| name.starts_with("v1/")) { "" } else { ", and those of looks of version 1 as v1/NAME" }
}

/// Which frames of which patterns are missing.
fn lacking(missing: &[(PathBuf, Frames)]) -> String {
    let of = |(pattern, frames): &(PathBuf, Frames)| {
        let (noun, verb) = if frames.len() == 1 { ("frame", "is") } else { ("frames", "are") };
        format!("{noun} {frames} of {} {verb} missing", pattern.display())
    };
    missing.iter().map(of).collect::<Vec<_>>().join("; ")
}

/// So many pixels.
fn counted(pixels: usize) -> String {
    if pixels == 1 { "1 pixel".to_owned() } else { format!("{pixels} pixels") }
}

fn below_floor(asked: f64, floor: f64) -> String {
    format!("a tolerance of {asked:.1e} is below what can be had here: {floor:.1e}")
}

/// Two digits that are no less than `floor`, for an option.
fn above(floor: f64) -> String {
    let unit = 10_f64.powf(floor.log10().floor() - 1.0);
    format!("{:.1e}", unit * (1.001 * floor / unit).ceil())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preset_that_may_have_been_meant_is_named() {
        let known = ["classic-prime", "anamorphic", "zoom", "vintage-uncoated", "eye"].map(String::from).to_vec();
        let said = |name: &str| Error::UnknownPreset { name: name.into(), known: known.clone() }.to_string();
        for (name, meant) in [("vintage", "vintage-uncoated"), ("clasic-prime", "classic-prime"), ("Zoom", "zoom")] {
            let ends = format!(", eye, and those of looks of version 1 as v1/NAME; did you mean {meant}?");
            assert!(said(name).ends_with(&ends), "{}", said(name));
        }
        for name in ["fisheye-8mm", "x", ""] {
            assert!(!said(name).contains("did you mean"), "{}", said(name));
        }
    }

    #[test]
    fn the_tolerance_that_can_be_had_is_not_below_the_floor() {
        for floor in [3.21e-7, 9.96e-7, 1e-6, 1.99e-5, 0.04] {
            let tolerance: f64 = above(floor).parse().unwrap();
            assert!(tolerance > 1.0001 * floor && tolerance < 1.12 * floor, "{tolerance} for {floor}");
        }
        let said = Error::ToleranceBelowFloor { asked: 1e-9, floor: 3.21e-7 }.to_string();
        assert!(said.contains("--tolerance 3.3e-7, or ") && said.contains("--allow-floor"), "{said}");
    }
}
