//! Who may import whom, and where `unsafe` may stand.

use std::path::{Path, PathBuf};

/// Modules that know nothing of GL, windows and the command line.
const PURE: [&str; 11] =
    ["choices", "look", "photo", "scene", "series", "plan", "reference", "compare", "frame", "error", "viewer/model"];
const FORBIDDEN: [&str; 12] = [
    "crate::gpu",
    "crate::renderer",
    "crate::cli",
    "crate::viewer",
    "glow::",
    "use glow",
    "egui",
    "glutin",
    "winit",
    "gpu::{",
    "renderer::{",
    "super::gpu",
];

fn sources() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut folders, mut files) = (vec![root.clone()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                files.push((path.strip_prefix(&root).unwrap().to_owned(), text));
            }
        }
    }
    assert!(files.len() > 30, "the sources are there");
    files
}

/// Lines of code, without comments, with their numbers.
fn code(text: &str) -> impl Iterator<Item = (usize, &str)> {
    (1..).zip(text.lines()).map(|(number, line)| (number, line.split("//").next().unwrap_or("")))
}

fn imports_upwards(module: &str, text: &str) -> Vec<usize> {
    let is_pure = PURE.contains(&module);
    code(text).filter(|(_, line)| is_pure && FORBIDDEN.iter().any(|name| line.contains(name))).map(|(n, _)| n).collect()
}

fn uses_unsafe(text: &str) -> Vec<usize> {
    let word = |line: &str| line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == "unsafe");
    code(text).filter(|(_, line)| word(line)).map(|(number, _)| number).collect()
}

/// The module of `src/` that a file belongs to; the window's model is one of its own.
fn module(path: &Path) -> String {
    if path.starts_with("viewer/model") {
        return "viewer/model".to_owned();
    }
    path.components().next().unwrap().as_os_str().to_str().unwrap().trim_end_matches(".rs").to_owned()
}

#[test]
fn the_pure_modules_import_nothing_above_them() {
    let sources = sources();
    for (path, text) in &sources {
        let lines = imports_upwards(&module(path), text);
        assert!(lines.is_empty(), "src/{} imports upwards in lines {lines:?}", path.display());
    }
    for pure in PURE {
        assert!(sources.iter().any(|(path, _)| module(path) == pure), "there is a module called {pure}");
    }
}

#[test]
fn unsafe_stands_in_gpu_only() {
    let mut seen = 0;
    for (path, text) in sources() {
        let lines = uses_unsafe(&text);
        seen += lines.len();
        assert!(module(&path) == "gpu" || lines.is_empty(), "src/{} is unsafe in lines {lines:?}", path.display());
    }
    assert!(seen > 0, "the search finds the ones in gpu");
}

#[test]
fn the_searches_find_what_they_look_for() {
    assert_eq!(imports_upwards("plan", "use crate::frame;\nuse crate::gpu::Device;\n"), [2]);
    assert_eq!(imports_upwards("plan", "// not crate::gpu\nuse crate::{frame, gpu::{Device}};\n"), [2]);
    assert_eq!(imports_upwards("renderer", "use crate::gpu::Device;\n"), [0; 0]);
    assert_eq!(uses_unsafe("// unsafe\nlet is_unsafe = 1;\n    unsafe { f() }\n"), [3]);
}
