//! Which of a file's pictures is the photo: the first that is neither a reduced copy nor a mask.

use std::collections::HashSet;
use std::io::{Read, Seek};

use super::super::Reason;
use super::super::foreign::RAW;
use super::directory::{Directory, File, tag};
use super::layout::{CFA, LINEAR_RAW};

/// The picture that is taken.
pub(super) struct Page {
    pub directory: Directory,
    /// What it is called, where the file holds several.
    pub name: Option<String>,
    /// What a person ought to know of the choice.
    pub notes: Vec<String>,
}

/// Directories of sub-pictures that are looked at; a raw file has three or four.
const MOST_SUB_PICTURES: usize = 64;

pub(super) fn choose<R: Read + Seek>(file: &mut File<R>) -> Result<Page, Reason> {
    if file.canon_raw {
        return Err(refusal("Canon CR2"));
    }
    let (mut pages, broken) = chain(file)?;
    let mut notes = Vec::new();
    let mut full = Vec::new();
    for (index, page) in pages.iter().enumerate() {
        if is_full(file, page)? {
            full.push(index);
        }
    }
    if let Some(&index) = full.first() {
        if broken.is_some() {
            notes.push("the list of the file's pictures breaks off: there may be more than are told here".to_owned());
        }
        let page = pages.swap_remove(index);
        check_no_raw(file, &page, &page)?;
        let several = full.len() > 1 || index > 0;
        if full.len() > 1 {
            let (others, are) = if full.len() == 2 { ("the other", "is") } else { ("the others", "are") };
            notes.push(format!("the file holds {} pictures: the first is taken, {others} {are} left out", full.len()));
        }
        return Ok(Page { directory: page, name: several.then(|| format!("page {}", index + 1)), notes });
    }
    for page in &pages {
        for sub in sub_pictures(file, page)? {
            if is_full(file, &sub)? {
                check_no_raw(file, &sub, page)?;
                return Ok(Page { directory: sub, name: Some("sub-picture of page 1".into()), notes });
            }
        }
    }
    if let Some(reason) = broken {
        return Err(reason);
    }
    notes.push("the file says that its picture is a reduced copy of another, which it does not hold".into());
    let directory = pages.into_iter().next().ok_or("it holds no picture")?;
    Ok(Page { directory, name: None, notes })
}

/// The directories that hang on one another, and why there are no more where the chain is broken; the first must be
/// readable.
fn chain<R: Read + Seek>(file: &mut File<R>) -> Result<(Vec<Directory>, Option<Reason>), Reason> {
    let first = file.first;
    if first == 0 {
        return Err("it holds no picture".into());
    }
    let (mut pages, mut seen, mut total) = (Vec::new(), HashSet::new(), 0);
    let mut next = first;
    while next != 0 {
        // Directories that do not overlap cannot be more than the file.
        let page = match file.directory(next) {
            Ok(page) if seen.insert(next) && total <= file.length() => page,
            Ok(_) => return Ok((pages, Some("the list of its pictures is damaged".into()))),
            Err(reason) if pages.is_empty() => return Err(reason),
            Err(reason) => return Ok((pages, Some(reason))),
        };
        total += page.size;
        next = page.next;
        pages.push(page);
    }
    Ok((pages, None))
}

/// Whether this is a picture in its own right: TIFF 6.0, NewSubfileType (bit 0 a reduced copy, bit 2 a mask), and
/// SubfileType (2 a reduced copy).
fn is_full<R: Read + Seek>(file: &mut File<R>, page: &Directory) -> Result<bool, Reason> {
    let new = file.number(page, tag::NEW_SUBFILE_TYPE)?.unwrap_or(0);
    let old = file.number(page, tag::SUBFILE_TYPE)?.unwrap_or(1);
    let mask = file.number(page, tag::PHOTOMETRIC)? == Some(4);
    Ok(new & 0b101 == 0 && old != 2 && !mask && page.has(tag::WIDTH))
}

fn sub_pictures<R: Read + Seek>(file: &mut File<R>, page: &Directory) -> Result<Vec<Directory>, Reason> {
    let offsets = file.numbers(page, tag::SUB_IFDS, MOST_SUB_PICTURES)?.unwrap_or_default();
    offsets.into_iter().map(|at| file.directory(at)).collect()
}

/// An error if the picture is raw data, or the rendering that a camera puts beside them; `main` is the directory that says whose.
fn check_no_raw<R: Read + Seek>(file: &mut File<R>, page: &Directory, main: &Directory) -> Result<(), Reason> {
    let make = file.raw(main, tag::MAKE).ok().flatten().unwrap_or_default().to_ascii_uppercase();
    let kind = match &make[..] {
        _ if main.has(tag::DNG_VERSION) || page.has(tag::DNG_VERSION) => "DNG",
        [b'N', b'I', b'K', b'O', b'N', ..] => "Nikon NEF",
        [b'S', b'O', b'N', b'Y', ..] => "Sony ARW",
        [b'P', b'E', b'N', b'T', b'A', b'X', ..] => "Pentax PEF",
        _ => "the pattern of its sensor",
    };
    let subs = sub_pictures(file, page).unwrap_or_default();
    for picture in std::iter::once(page).chain(&subs) {
        if matches!(file.number(picture, tag::PHOTOMETRIC)?, Some(CFA | LINEAR_RAW)) {
            return Err(refusal(kind));
        }
    }
    Ok(())
}

fn refusal(kind: &str) -> Reason {
    format!("it holds a camera's raw data ({kind}), which vglare does not read: {RAW}").into()
}
