//! Names of outputs: a folder, or a pattern with fields that each photo fills in.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf, is_separator};
use std::{fs, io};

use crate::{Error, Result};

/// The field for a photo's own name.
const NAME: &str = "{name}";
/// The most bytes that a file's name may have, and so the most digits of a number in it.
const MOST_BYTES: usize = 255;

/// What an output option names for many photos.
#[derive(Debug, Clone, PartialEq)]
pub enum Names {
    /// A folder, where each output is called as its photo.
    Folder(PathBuf),
    /// One file, for one photo.
    File(PathBuf),
    /// A file name with fields, in a folder.
    Pattern { given: PathBuf, parts: Vec<Part> },
}

/// A part of a pattern.
#[derive(Debug, Clone, PartialEq)]
pub enum Part {
    /// Stands for itself.
    Text(String),
    /// The photo's file name without its extension.
    Name,
    /// The photo's frame number, with at least so many digits; a sign counts as one, as it does for printf.
    Number(usize),
}

impl Names {
    /// What `given` names, if it is a folder or has a field in its file name; otherwise it is one file's name.
    pub fn new(given: &Path) -> Option<Self> {
        let ends_open = given.to_string_lossy().ends_with(is_separator);
        if ends_open || given.is_dir() {
            return Some(Self::folder(given));
        }
        let parts = parts(given.file_name()?.to_str()?);
        let plain = parts.iter().all(|part| matches!(part, Part::Text(_)));
        (!plain).then(|| Self::Pattern { given: given.to_owned(), parts })
    }

    /// A folder, whether it is there or not.
    pub fn folder(given: &Path) -> Self {
        // Without the separator at its end, by which a file could not even be seen to be one.
        Self::Folder(given.components().collect())
    }

    /// The folder that all outputs are in.
    pub fn place(&self) -> &Path {
        let folder = match self {
            Self::Folder(folder) => Some(folder.as_path()),
            Self::File(given) | Self::Pattern { given, .. } => given.parent(),
        };
        folder.filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
    }

    /// The output of a photo.
    ///
    /// # Errors
    /// [`Error::Usage`] where the photo's name lacks what the pattern asks for.
    pub fn of(&self, photo: &Path) -> Result<PathBuf> {
        let lacks = |what: &str, given: &Path| {
            Error::Usage(format!("{} has no {what} in its name, as {} wants", photo.display(), given.display()))
        };
        match self {
            Self::Folder(folder) => Ok(folder.join(photo.file_name().ok_or_else(|| lacks("file", folder))?)),
            Self::File(given) => Ok(given.clone()),
            Self::Pattern { given, parts } => {
                let stem =
                    photo.file_stem().and_then(|stem| stem.to_str()).ok_or_else(|| lacks("readable file", given))?;
                let mut name = String::new();
                for part in parts {
                    match part {
                        Part::Text(text) => name.push_str(text),
                        Part::Name => name.push_str(stem),
                        Part::Number(digits) => {
                            let (sign, number) = number(stem).ok_or_else(|| lacks("frame number", given))?;
                            name.push_str(&padded(*digits, sign, number)?);
                        }
                    }
                }
                Ok(given.with_file_name(name))
            }
        }
    }
}

impl Names {
    /// Whether names have the frame's number in them.
    pub fn count(&self) -> bool {
        matches!(self, Self::Pattern { parts, .. } if parts.iter().any(|part| matches!(part, Part::Number(_))))
    }

    /// The output of a frame that has a number and no photo of its own; `{name}` is `name`. Without fields it is one and
    /// the same.
    ///
    /// # Errors
    /// [`Error::Usage`] for more digits than a name has room for.
    pub fn of_frame(&self, name: &str, number: i64) -> Result<PathBuf> {
        let (given, parts) = match self {
            Self::Folder(given) | Self::File(given) => return Ok(given.clone()),
            Self::Pattern { given, parts } => (given, parts),
        };
        let (sign, number) = (if number < 0 { "-" } else { "" }, number.unsigned_abs().to_string());
        let filled: Result<String> = parts
            .iter()
            .map(|part| match part {
                Part::Text(text) => Ok(text.clone()),
                Part::Name => Ok(name.to_owned()),
                Part::Number(digits) => padded(*digits, sign, &number),
            })
            .collect();
        Ok(given.with_file_name(filled?))
    }
}

impl Names {
    /// The frames that are there of a pattern for photos: their numbers, and their files.
    ///
    /// # Errors
    /// [`Error::Usage`] for a pattern with another field than one frame number; [`Error::ReadPhoto`] where its folder cannot be
    /// read.
    pub fn present(&self) -> Result<BTreeMap<i64, PathBuf>> {
        let (before, after) = self.around_number()?;
        let unreadable = |error: io::Error| Error::read_photo(self.place(), error);
        let mut frames = BTreeMap::new();
        for entry in fs::read_dir(self.place()).map_err(unreadable)? {
            let name = entry.map_err(unreadable)?.file_name();
            let Some(name) = name.to_str() else { continue };
            let digits = name.strip_prefix(before).and_then(|rest| rest.strip_suffix(after));
            let Some(number) = digits.and_then(|digits| digits.parse().ok()) else { continue };
            // A number that is written otherwise, as with fewer digits, is another pattern's.
            let path = self.of_frame("", number)?;
            if path.file_name().is_some_and(|of_frame| of_frame == name) {
                frames.insert(number, path);
            }
        }
        Ok(frames)
    }

    /// What stands before and after the number of a pattern for photos.
    fn around_number(&self) -> Result<(&str, &str)> {
        let Self::Pattern { given, parts } = self else { return Ok(("", "")) };
        match &parts[..] {
            [Part::Number(_)] => Ok(("", "")),
            [Part::Text(before), Part::Number(_)] => Ok((before, "")),
            [Part::Number(_), Part::Text(after)] => Ok(("", after)),
            [Part::Text(before), Part::Number(_), Part::Text(after)] => Ok((before, after)),
            _ => Err(Error::Usage(format!(
                "{} names no photos: a pattern for them has one frame number, as #### or %04d",
                given.display()
            ))),
        }
    }
}

/// The frame number in a photo's name, as [`Names::of`] fills it in.
pub fn frame_number(photo: &Path) -> Option<i64> {
    let (sign, number) = number(photo.file_stem()?.to_str()?)?;
    format!("{sign}{number}").parse().ok()
}

/// A photo's folder, and what stands before and after its frame number.
pub fn around_number(photo: &Path) -> Option<(&Path, &str, &str)> {
    let name = photo.file_name()?.to_str()?;
    let stem = photo.file_stem()?.to_str()?;
    number(stem)?;
    let until = stem.trim_end_matches(|c: char| !c.is_ascii_digit());
    let before = until.trim_end_matches(|c: char| c.is_ascii_digit());
    Some((photo.parent()?, before, &name[until.len()..]))
}

/// A number with at least so many digits, of which the sign is one.
fn padded(digits: usize, sign: &str, number: &str) -> Result<String> {
    if digits > MOST_BYTES {
        let room = format!("a file's name has room for {MOST_BYTES} bytes");
        return Err(Error::Usage(format!("a pattern asks for numbers of {digits} digits; {room}")));
    }
    let digits = digits.saturating_sub(sign.len());
    Ok(format!("{sign}{number:0>digits$}"))
}

/// Takes a file name apart.
fn parts(mut text: &str) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut plain = String::new();
    while let Some(first) = text.chars().next() {
        let (part, length) = match field(text) {
            Some(found) => found,
            None => {
                plain.push(first);
                text = &text[first.len_utf8()..];
                continue;
            }
        };
        if !plain.is_empty() {
            parts.push(Part::Text(std::mem::take(&mut plain)));
        }
        parts.push(part);
        text = &text[length..];
    }
    if !plain.is_empty() {
        parts.push(Part::Text(plain));
    }
    parts
}

/// The field that `text` begins with, and how long it is.
fn field(text: &str) -> Option<(Part, usize)> {
    if text.starts_with(NAME) {
        return Some((Part::Name, NAME.len()));
    }
    let hashes = text.len() - text.trim_start_matches('#').len();
    // One alone means one digit to some programs, four to others, and is a plain character in a title.
    if hashes >= 2 {
        return Some((Part::Number(hashes), hashes));
    }
    let printf = text.strip_prefix('%')?;
    let (digits, _) = printf.split_once('d')?;
    match digits.as_bytes() {
        [] => Some((Part::Number(1), 2)),
        [b'0', width @ b'1'..=b'9'] => Some((Part::Number(usize::from(width - b'0')), 4)),
        _ => None,
    }
}

/// The frame number in a file name: its last digits, without the noughts that they begin with, and the sign before it.
///
/// A minus is a sign where the number is a part of the name by itself, as in `shot.-001` or `shot_-1`; after anything else
/// it only keeps apart what it stands between, as in `shot-001`.
fn number(stem: &str) -> Option<(&'static str, &str)> {
    let until = stem.trim_end_matches(|c: char| !c.is_ascii_digit());
    let before = until.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = until[before.len()..].trim_start_matches('0');
    if until.is_empty() {
        return None;
    }
    let negative = before.strip_suffix('-').is_some_and(|before| before.is_empty() || before.ends_with(['.', '_']));
    Some(match (digits, negative) {
        ("", _) => ("", "0"),
        (digits, true) => ("-", digits),
        (digits, false) => ("", digits),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(given: &str, photo: &str) -> Option<String> {
        let path = Names::new(Path::new(given)).expect("many names").of(Path::new(photo)).ok()?;
        Some(path.to_str().expect("text").replace('\\', "/"))
    }

    #[test]
    fn fields_are_filled_in() {
        for (given, photo, expected) in [
            ("out/veiled.####.exr", "in/shot.0007.exr", "out/veiled.0007.exr"),
            ("veiled.####.exr", "shot.12345.exr", "veiled.12345.exr"),
            ("veiled.##.exr", "shot.0007.exr", "veiled.07.exr"),
            ("v_%04d.png", "shot_v02.1001.exr", "v_1001.png"),
            ("v_%d.png", "shot.0000.exr", "v_0.png"),
            ("out/{name}.png", "in/shot.0007.exr", "out/shot.0007.png"),
            ("{name}_%03d#.png", "é7.exr", "é7_007#.png"),
            ("out/", "in/shot.0007.exr", "out/shot.0007.exr"),
            ("a####/{name}.exr", "b.exr", "a####/b.exr"),
            ("x.####.exr", "n.-001.exr", "x.-001.exr"),
            ("x.####.exr", "n.0001.exr", "x.0001.exr"),
            ("x_%04d.exr", "n_-12345.exr", "x_-12345.exr"),
            ("x_%02d.exr", "n.-0007.exr", "x_-7.exr"),
            ("x%d.exr", "-3.exr", "x-3.exr"),
            ("x.####.exr", "n.-000.exr", "x.0000.exr"),
            ("x.####.exr", "shot-001.exr", "x.0001.exr"),
            ("x.####.exr", "take.2-17.exr", "x.0017.exr"),
            ("x.####.exr", "2024-01-05.exr", "x.0005.exr"),
            ("x.##.exr", "n.--5.exr", "x.05.exr"),
            ("x.##.exr", "n.-12.v.exr", "x.-12.exr"),
            ("x%d.exr", "n.123456789012345678901234567890.exr", "x123456789012345678901234567890.exr"),
        ] {
            assert_eq!(of(given, photo).as_deref(), Some(expected), "{given} of {photo}");
        }
        assert_eq!(of("out.####.exr", "lamp.exr"), None, "a number is missing");
        for (digits, fits) in [(255, true), (256, false), (70_000, false)] {
            assert_eq!(of(&"#".repeat(digits), "7.exr").is_some(), fits, "{digits} digits");
        }
    }

    #[test]
    fn frames_are_counted() {
        let of = |given: &str, number| {
            let names = Names::new(Path::new(given)).expect("many names");
            names.count().then(|| names.of_frame("path", number).unwrap().to_str().expect("text").to_owned())
        };
        assert_eq!(of("a/out.####.png", 7).as_deref(), Some("a/out.0007.png"));
        assert_eq!(of("%02d_{name}.exr", 123).as_deref(), Some("123_path.exr"));
        assert_eq!(of("x.####.exr", -7).as_deref(), Some("x.-007.exr"));
        assert_eq!(of("{name}.exr", 7), None);
    }

    #[test]
    fn names_without_fields_are_files() {
        for given in
            ["out.exr", "take#2.exr", "100%.exr", "a%5d.exr", "%0xd.exr", "{frame}.exr", "a####/out.exr", "out"]
        {
            assert_eq!(Names::new(Path::new(given)), None, "{given}");
        }
    }

    #[test]
    fn the_frames_of_a_pattern_are_those_that_are_written_so() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            "s.0001.exr",
            "s.12345.exr",
            "s.-002.exr",
            "s.002.exr",
            "s.00003.exr",
            "s.+004.exr",
            "s..exr",
            "t.0005.exr",
        ] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let present = |pattern: &str| Names::new(&folder.path().join(pattern)).expect("a pattern").present();
        let numbers = |pattern: &str| present(pattern).unwrap().into_keys().collect::<Vec<_>>();
        assert_eq!(numbers("s.####.exr"), [-2, 1, 12345]);
        assert_eq!(numbers("s.%03d.exr"), [2, 12345]);
        assert_eq!(numbers("s.%d.exr"), [12345]);
        assert_eq!(present("s.%04d.exr").unwrap()[&-2], folder.path().join("s.-002.exr"));
        for pattern in ["{name}.exr", "##.####.exr"] {
            assert!(matches!(present(pattern), Err(Error::Usage(_))), "{pattern}");
        }
        assert!(matches!(present("none/####.exr"), Err(Error::ReadPhoto { .. })));
    }

    #[test]
    fn the_place_is_the_folder() {
        for (given, place) in
            [("out/", "out"), ("out/{name}.exr", "out"), ("{name}.exr", "."), ("/tmp/a/%d.exr", "/tmp/a")]
        {
            assert_eq!(Names::new(Path::new(given)).unwrap().place(), Path::new(place), "{given}");
        }
    }
}
