//! Which photos are meant: files, patterns of numbered frames, and those of them that `--frames` picks.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::names::{self, Names};
use crate::shot::Frames;
use crate::{Error, Result, target};

/// The photos that are there, in their order, and the frames that are not.
#[derive(Debug, Default, PartialEq)]
pub struct Inputs {
    pub photos: Vec<PathBuf>,
    /// By pattern, or by the folder of photos that were named one by one.
    pub missing: Vec<(PathBuf, Frames)>,
}

/// A pattern's name or a folder, and the files of each frame.
type Numbered = (PathBuf, BTreeMap<i64, Vec<PathBuf>>);

impl Inputs {
    /// Those that `given` names; a name with a field for a number is a pattern, unless there is such a file. `frames` picks some of
    /// them by number, in its order; without it a pattern names all of its frames that are there.
    ///
    /// # Errors
    /// [`Error::ReadPhoto`] for a pattern without any frame; [`Error::Usage`] for one that is none for photos, and for a photo
    /// without a number where `frames` asks for some.
    pub fn new(given: &[PathBuf], frames: Option<&Frames>) -> Result<Self> {
        let Some(frames) = frames else {
            let photos = given.iter().map(|given| match pattern(given) {
                Some(pattern) => Ok(present(given, &pattern)?.into_values().collect()),
                None => Ok(vec![given.clone()]),
            });
            return Ok(Self { photos: photos.collect::<Result<Vec<_>>>()?.concat(), missing: Vec::new() });
        };
        let mut inputs = Self::default();
        for (name, numbered) in numbered(given)? {
            let files = frames.iter().filter_map(|frame| numbered.get(&frame));
            inputs.photos.extend(files.flatten().cloned());
            let missing: Frames = frames.iter().filter(|frame| !numbered.contains_key(frame)).collect();
            if !missing.is_empty() {
                inputs.missing.push((name, missing));
            }
        }
        Ok(inputs)
    }

    /// Whether one of these names frames by a pattern.
    pub fn are_by_pattern(given: &[PathBuf]) -> bool {
        given.iter().any(|given| pattern(given).is_some())
    }

    /// The frames of one pattern, be they there or not: those of `frames`, or else all that are there.
    ///
    /// # Errors
    /// [`Error::Usage`] for what is no pattern; those of [`Inputs::new`].
    pub fn expected(given: &[PathBuf], frames: Option<&Frames>) -> Result<(Frames, Self)> {
        let names = match given {
            [given] => pattern(given),
            _ => None,
        };
        let names = names.ok_or_else(|| {
            Error::Usage("a job's frames are named by one pattern, as 'shot.####.exr' in quotes".into())
        })?;
        let frames = match frames {
            Some(frames) => frames.clone(),
            None => present(&given[0], &names)?.into_keys().collect(),
        };
        let photos = frames.iter().map(|frame| names.of_frame("", frame)).collect::<Result<_>>()?;
        Ok((frames, Self { photos, missing: Vec::new() }))
    }

    /// The first frame of a shot that is there, whichever of them are picked: of a pattern, or of photos whose names differ in their numbers
    /// alone; none of other photos.
    ///
    /// # Errors
    /// Those of [`Inputs::new`].
    pub fn first(given: &[PathBuf]) -> Result<Option<PathBuf>> {
        let Some(first) = given.first() else { return Ok(None) };
        if let Some(names) = pattern(first) {
            return Ok(present(first, &names)?.into_values().next());
        }
        let around = names::around_number(first);
        let is_shot = around.is_some() && given.iter().all(|photo| names::around_number(photo) == around);
        Ok(is_shot.then(|| first.clone()))
    }

    /// Whether `given` names a shot, be there one frame of it only.
    pub fn is_shot(given: &[PathBuf], frames: Option<&Frames>) -> bool {
        frames.is_some() || given.iter().any(|given| pattern(given).is_some())
    }
}

fn pattern(given: &Path) -> Option<Names> {
    let names = Names::new(given).filter(|names| matches!(names, Names::Pattern { .. }))?;
    (!given.exists()).then_some(names)
}

fn present(given: &Path, pattern: &Names) -> Result<BTreeMap<i64, PathBuf>> {
    let frames = pattern.present()?;
    if frames.is_empty() { Err(Error::read_photo(given, "there is no frame of this pattern")) } else { Ok(frames) }
}

/// Patterns with their frames; photos that are named one by one make up one together.
fn numbered(given: &[PathBuf]) -> Result<Vec<Numbered>> {
    let mut all = Vec::new();
    let mut listed: Option<Numbered> = None;
    for given in given {
        if let Some(pattern) = pattern(given) {
            let frames = present(given, &pattern)?;
            all.push((given.clone(), frames.into_iter().map(|(number, path)| (number, vec![path])).collect()));
            continue;
        }
        let number = names::frame_number(given).ok_or_else(|| {
            Error::Usage(format!("{} has no frame number in its name, as --frames wants", given.display()))
        })?;
        let (_, frames) = listed.get_or_insert_with(|| (target::folder(given).to_owned(), BTreeMap::new()));
        frames.entry(number).or_default().push(given.clone());
    }
    all.extend(listed);
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(names: &[&str]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        names.iter().for_each(|name| std::fs::write(folder.path().join(name), "").unwrap());
        folder
    }

    fn inputs(folder: &Path, given: &[&str], frames: Option<&str>) -> Result<(Vec<String>, Vec<String>)> {
        let given: Vec<PathBuf> = given.iter().map(|given| folder.join(given)).collect();
        let inputs = Inputs::new(&given, frames.map(|frames| frames.parse().unwrap()).as_ref())?;
        let photos =
            inputs.photos.iter().map(|photo| photo.file_name().unwrap().to_str().unwrap().to_owned()).collect();
        Ok((photos, inputs.missing.iter().map(|(_, frames)| frames.to_string()).collect()))
    }

    #[test]
    fn a_pattern_names_its_frames_and_a_range_picks_some() {
        let folder = place(&["a.0001.exr", "a.0002.exr", "a.0003.exr", "a.0005.exr", "b##.exr", "b07.exr"]);
        let of = |given: &[&str], frames| inputs(folder.path(), given, frames).unwrap();
        let all = ["a.0001.exr", "a.0002.exr", "a.0003.exr", "a.0005.exr"];
        assert_eq!(of(&["a.####.exr"], None).0, all);
        assert_eq!(of(&["a.%04d.exr", "b07.exr"], None).0, [&all[..], &["b07.exr"]].concat());
        assert_eq!(of(&["b##.exr"], None).0, ["b##.exr"], "there is such a file");
        assert_eq!(of(&["a.####.exr"], Some("3-1:2")), (vec![all[2].into(), all[0].into()], vec![]));
        assert_eq!(of(&["a.####.exr"], Some("1-9")).1, ["4,6-9"]);
        // Photos that a shell has found are picked by their numbers, too.
        assert_eq!(
            of(&["a.0001.exr", "a.0003.exr", "b07.exr"], Some("3-8")),
            (vec![all[2].into(), "b07.exr".into()], vec!["4-6,8".into()])
        );
    }

    #[test]
    fn a_shot_has_a_first_frame_and_a_heap_of_photos_has_none() {
        let folder = place(&["a.0003.exr", "a.0007.exr"]);
        let first = |given: &[&str]| {
            let given: Vec<PathBuf> = given.iter().map(|given| folder.path().join(given)).collect();
            let first = Inputs::first(&given).unwrap()?;
            Some(first.file_name().unwrap().to_str().unwrap().to_owned())
        };
        assert_eq!(first(&["a.####.exr"]).as_deref(), Some("a.0003.exr"));
        assert_eq!(first(&["a.0007.exr", "a.0003.exr", "a.0100.exr"]).as_deref(), Some("a.0007.exr"));
        for heap in [
            &["a.0007.exr", "b.0003.exr"][..],
            &["lamp.exr", "sun.exr"],
            &["a.0007.exr", "a.0008.png"],
            &["x/a.1.exr", "y/a.2.exr"],
            &[],
        ] {
            assert_eq!(first(heap), None, "{heap:?}");
        }
    }

    #[test]
    fn what_names_no_frames_is_refused() {
        let folder = place(&["lamp.exr"]);
        let refused = |given: &[&str], frames| inputs(folder.path(), given, frames).unwrap_err();
        assert!(matches!(refused(&["a.####.exr"], None), Error::ReadPhoto { .. }));
        assert!(matches!(refused(&["a.####.exr"], Some("1-2")), Error::ReadPhoto { .. }));
        assert!(matches!(refused(&["lamp.exr"], Some("1-2")), Error::Usage(_)));
        assert!(matches!(refused(&["{name}.exr"], None), Error::Usage(_)));
    }
}
