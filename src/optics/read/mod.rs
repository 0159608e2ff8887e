//! Lens files: vglare's own TOML, the tables of pbrt, and sequential files of Zemax.
//!
//! What a file is, is told by what it says, not by its name. What cannot be honoured is an error that names it.

mod pbrt;
mod text;
mod toml;
mod zemax;

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use super::error::{OpticsError, Result};
use super::prescription::{Origin, Prescription};

/// The largest file that is read, in bytes. A zoom lens's Zemax file has some hundred thousand.
const LARGEST: usize = 4 << 20;

/// What a lens file is written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LensFormat {
    /// vglare's own.
    Toml,
    /// Four columns: radius, thickness, index and aperture diameter.
    Pbrt,
    /// The text of a `.zmx` file.
    Zemax,
}

impl LensFormat {
    /// What a text is written in.
    pub fn of(text: &str) -> Self {
        let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with(['#', '!']));
        let keyword = |line: &str| matches!(line.split_whitespace().next(), Some("SURF" | "VERS" | "MODE" | "UNIT"));
        let number = |line: &str| line.split_whitespace().next().is_some_and(|word| word.parse::<f64>().is_ok());
        if lines.clone().any(|line| keyword(line) && !line.contains('=')) {
            Self::Zemax
        } else if lines.next().is_some_and(number) {
            Self::Pbrt
        } else {
            Self::Toml
        }
    }
}

impl Prescription {
    /// A lens from a file.
    ///
    /// # Errors
    ///
    /// [`OpticsError::Read`] where there is no such file, or one of more than 4 MiB; those of [`Prescription::parse`].
    pub fn read(path: &Path) -> Result<Self> {
        let failed = |reason: String| OpticsError::Read { path: path.to_owned(), reason };
        let mut bytes = Vec::new();
        let file = File::open(path).map_err(|error| failed(error.to_string()))?;
        file.take(LARGEST as u64 + 1).read_to_end(&mut bytes).map_err(|error| failed(error.to_string()))?;
        if bytes.len() > LARGEST {
            return Err(failed("it is larger than 4 MiB, which no lens file is".to_owned()));
        }
        Self::parse(&bytes, &path.display().to_string())
    }

    /// A lens from what a file holds. `file` is the name for errors, and for a lens that says none.
    ///
    /// # Errors
    ///
    /// What cannot be read, means nothing or cannot be honoured, with the line and the surface.
    pub fn parse(bytes: &[u8], file: &str) -> Result<Self> {
        let text = text::decode(bytes);
        let mut origin = Origin { file: file.to_owned(), lines: Vec::new() };
        let mut lens = match LensFormat::of(&text) {
            LensFormat::Toml => toml::parse(&text, &mut origin),
            LensFormat::Pbrt => pbrt::parse(&text, &mut origin),
            LensFormat::Zemax => zemax::parse(&text, &mut origin),
        }?;
        if lens.name.is_empty() {
            lens.name = Path::new(file).file_stem().map_or(file.into(), |stem| stem.to_string_lossy()).into_owned();
        }
        lens.check_at(&origin)?;
        Ok(lens)
    }
}

/// A number of a table without keys, at a line of it.
fn number(word: &str, what: &str, line: usize, origin: &Origin) -> Result<f64> {
    let reason =
        || OpticsError::Line { file: origin.file.clone(), line, reason: format!("{what} {word:?} is no number") };
    word.parse::<f64>().ok().filter(|number| number.is_finite()).ok_or_else(reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_format_is_told_by_what_is_said() {
        for (text, format) in [
            ("# pbrt\n\n 29.475 3.76 1.67 25.2\n", LensFormat::Pbrt),
            ("VERS 90111 0\nMODE SEQ\nSURF 0\n", LensFormat::Zemax),
            ("! a comment\nSURF 0\n  TYPE STANDARD\n", LensFormat::Zemax),
            ("name = 'SURF 0'\n[[surface]]\n", LensFormat::Toml),
            ("", LensFormat::Toml),
        ] {
            assert_eq!(LensFormat::of(text), format, "{text}");
        }
    }

    #[test]
    fn a_file_that_is_not_there_or_is_no_lens_is_told_by_its_name() {
        let missing = Prescription::read(Path::new("/nowhere/lens.toml")).unwrap_err().to_string();
        assert!(missing.starts_with("cannot read the lens /nowhere/lens.toml: "), "{missing}");
        for bytes in [&b""[..], b"\xff\xfe", b"\0\0\0\0", b"hello", b"{}", b"[[surface]]\nstop = true\n"] {
            let error = Prescription::parse(bytes, "lens.txt").unwrap_err().to_string();
            assert!(error.starts_with("lens.txt"), "{error}");
        }
    }
}
