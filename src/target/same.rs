//! Which paths are one file.

use std::collections::HashMap;
use std::fs;
use std::path::{Component, Path, PathBuf};

use super::{folder, followed};
use crate::{Error, Result};

/// What a file is known by, whatever path leads to it: `.`, `..`, links to it or to a folder above it, hard links.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Identity {
    /// A file that is there: its device and number.
    #[cfg(unix)]
    There(u64, u64),
    /// Another, by its path without any links.
    Named(PathBuf),
}

impl Identity {
    /// That of the file which a path leads to; none for the one that everything may be written to at once, since it keeps
    /// nothing.
    pub fn of(path: &Path) -> Option<Self> {
        // It has a name of its own, too.
        let path = if super::is_standard(path) { Path::new("/dev/stdout") } else { path };
        let path = followed(path).unwrap_or_else(|_| path.to_owned());
        if path == Path::new("/dev/null") {
            return None;
        }
        #[cfg(unix)]
        if let Ok(about) = fs::metadata(&path) {
            use std::os::unix::fs::MetadataExt as _;
            return Some(Self::There(about.dev(), about.ino()));
        }
        Some(Self::Named(real(&path)))
    }
}

/// Whether outputs are files apart from each other and from every input. Each has what a person calls it (an option, say)
/// and its path.
///
/// # Errors
/// [`Error::Usage`] where one would replace another or an input, be that allowed to be overwritten or not.
pub fn spare(outputs: &[(&str, &Path)], inputs: &[(&str, &Path)]) -> Result<()> {
    let mut taken: HashMap<Identity, &str> = HashMap::new();
    for (output, path) in outputs {
        let Some(identity) = Identity::of(path) else { continue };
        if let Some(other) = taken.insert(identity, output) {
            let path = path.display();
            return Err(Error::Usage(format!("{other} and {output} need a file each, and {path} would be both")));
        }
    }
    // What comes from standard input is replaced by nothing.
    for (what, path) in inputs.iter().filter(|(_, path)| !super::is_standard(path)) {
        if let Some(output) = Identity::of(path).and_then(|identity| taken.get(&identity)) {
            return Err(Error::Usage(format!("{output} would replace {}, {what}", path.display())));
        }
    }
    Ok(())
}

/// A path without links and dots, as far as its folders are there.
fn real(path: &Path) -> PathBuf {
    if let Ok(real) = fs::canonicalize(path) {
        return real;
    }
    let above = folder(path);
    let above = if above == path { above.to_owned() } else { real(above) };
    match path.components().next_back() {
        // Of a folder that is missing, whose links cannot lead elsewhere.
        Some(Component::ParentDir) => above.parent().unwrap_or(&above).to_owned(),
        Some(Component::Normal(name)) => above.join(name),
        _ => above,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn same(a: &Path, b: &Path) -> bool {
        Identity::of(a) == Identity::of(b)
    }

    #[test]
    fn a_file_is_the_same_by_whatever_path() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("a")).unwrap();
        fs::write(path("photo"), "").unwrap();
        fs::write(path("other"), "").unwrap();
        for name in ["photo", "new", "no/where/new"] {
            for alike in [format!("./{name}"), format!("a/../{name}"), format!("b/../{name}"), format!("a/.././{name}")]
            {
                // The system itself finds nothing by way of a folder that is missing.
                if name != "photo" || !alike.starts_with('b') {
                    assert!(same(&path(name), &path(&alike)), "{name} and {alike}");
                }
            }
        }
        for [a, b] in [["photo", "other"], ["photo", "new"], ["new", "newer"], ["a/new", "new"], ["x/new", "y/new"]] {
            assert!(!same(&path(a), &path(b)), "{a} and {b}");
        }
    }

    #[test]
    #[cfg(unix)]
    fn links_lead_to_the_same_file() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("real")).unwrap();
        symlink("real", path("link")).unwrap();
        fs::write(path("photo"), "").unwrap();
        fs::hard_link(path("photo"), path("hard")).unwrap();
        symlink("photo", path("soft")).unwrap();
        symlink("new", path("to-be")).unwrap();
        for [a, b] in
            [["photo", "hard"], ["photo", "soft"], ["hard", "soft"], ["new", "to-be"], ["real/new", "link/new"]]
        {
            assert!(same(&path(a), &path(b)), "{a} and {b}");
        }
        symlink("round", path("round")).unwrap();
        assert!(!same(&path("round"), &path("photo")), "and it comes to an end");
    }
}
