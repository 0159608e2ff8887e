//! Who may import whom, and where `unsafe` may stand.

use std::path::{Path, PathBuf};

/// Modules that know nothing of GL, windows and the command line.
const PURE: [&str; 19] = [
    "choices",
    "compare",
    "environment",
    "error",
    "frame",
    "look",
    "motion",
    "optics",
    "photo",
    "plan",
    "plate",
    "problem",
    "psf",
    "reference",
    "scene",
    "series",
    "shot",
    "veil",
    "viewer/model",
];
/// What they do not know: modules, and other crates.
const IMPURE: [&str; 9] = ["gpu", "renderer", "measure", "egui", "egui_glow", "glow", "glutin", "rfd", "winit"];
/// The rooms on top of the core; none knows another.
const ROOMS: [&str; 3] = ["cli", "laboratory", "viewer"];
/// What the rooms share: it knows none of them, and the core knows none of it.
const SHARED: [&str; 4] = ["chart", "false_colour", "options", "terminal"];
/// In `src/`, but of the program, which knows all.
const PROGRAM: [&str; 3] = ["lib", "main", "program"];

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
    assert!(files.len() > 200, "the sources are there");
    files
}

/// Lines of code, without comments, with their numbers.
fn code(text: &str) -> impl Iterator<Item = (usize, &str)> {
    (1..).zip(text.lines()).map(|(number, line)| (number, line.split("//").next().unwrap_or("")))
}

/// Modules of the crate and other crates that a file's paths begin with, with their lines. `depth` is how many `super`s
/// lead to the crate's root.
fn imports(text: &str, depth: usize) -> Vec<(usize, String)> {
    let mut all = Vec::new();
    let (mut numbers, mut joined) = (Vec::new(), String::new());
    for (number, line) in code(text) {
        numbers.resize(joined.len() + line.len() + 1, number);
        joined.push_str(line);
        joined.push('\n');
    }
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut at = 0;
    while let Some(found) = joined[at..].find("::") {
        let end = at + found;
        at = end + 2;
        let start = joined[..end].rfind(|c| !is_name(c)).map_or(0, |before| before + 1);
        // Not what follows on `::`, but for `super::super::`.
        let (head, before) = (&joined[start..end], &joined[..start]);
        let supers = before.len() - before.trim_end_matches("super::").len();
        let from_root = head == "crate" || head == "super" && supers / "super::".len() + 1 == depth;
        if from_root {
            all.extend(heads(&joined[at..]).into_iter().map(|name| (numbers[start], name)));
        } else if !head.is_empty() && !before.ends_with("::") {
            all.push((numbers[start], head.to_owned()));
        }
    }
    all
}

/// What the paths of a tree like `{a, b::{c, d}}`, or of a single path, begin with.
fn heads(tree: &str) -> Vec<String> {
    let name = |text: &str| text.trim().chars().take_while(|&c| c.is_alphanumeric() || c == '_').collect::<String>();
    if !tree.starts_with('{') {
        return vec![name(tree)];
    }
    let (mut depth, mut start, mut names) = (0, 1, Vec::new());
    for (index, c) in tree.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 || depth == 1 && c == ',' {
            names.push(name(&tree[start..index]));
            start = index + 1;
        }
        if depth == 0 {
            break;
        }
    }
    names.into_iter().filter(|name| !name.is_empty()).collect()
}

/// Whether `module` may import `other`.
fn may_import(module: &str, other: &str) -> bool {
    let room = module.split('/').next().unwrap_or(module);
    if PURE.contains(&module) && IMPURE.contains(&other) || room == "gpu" && other == "photo" {
        return false;
    }
    let on_top = ROOMS.contains(&room);
    match other {
        other if room == other || PROGRAM.contains(&room) => true,
        other if ROOMS.contains(&other) => false,
        other if SHARED.contains(&other) => on_top || SHARED.contains(&room),
        _ => true,
    }
}

/// The imports of a file that break the order, each with its line.
fn out_of_order(path: &str, text: &str) -> Vec<(usize, String)> {
    let path = Path::new(path);
    let module = module(path);
    let is_root = path.file_stem().is_some_and(|stem| stem == "mod");
    let depth = path.components().count() - usize::from(is_root);
    imports(text, depth).into_iter().filter(|(_, other)| !may_import(&module, other)).collect()
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
fn no_module_imports_what_stands_above_or_beside_it() {
    let sources = sources();
    for (path, text) in &sources {
        let path = path.to_str().expect("the sources' names are text");
        let broken = out_of_order(path, text);
        assert!(broken.is_empty(), "src/{path} imports out of order: {broken:?}");
    }
    let named = PURE.iter().chain(&ROOMS).chain(&SHARED).chain(&PROGRAM);
    for name in named {
        assert!(sources.iter().any(|(path, _)| module(path) == **name || path.starts_with(name)), "there is no {name}");
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
    let lines = |path, text| out_of_order(path, text).into_iter().map(|(line, _)| line).collect::<Vec<_>>();
    assert_eq!(lines("plan/mod.rs", "use crate::frame;\nuse crate::gpu::Device;\n"), [2]);
    assert_eq!(lines("plan/cost.rs", "// not crate::gpu\nuse crate::{\n    frame,\n    gpu::{Device}};\n"), [2, 4]);
    assert_eq!(lines("plan.rs", "use super::gpu::Device;\n"), [1]);
    assert_eq!(lines("plan/cost.rs", "use super::gpu::Device;\nuse super::super::gpu::Device;\n"), [2]);
    assert_eq!(lines("photo/mod.rs", "fn f() {\n    glow::f();\n    crate::gpu::f();\n}\n"), [2, 3]);
    assert_eq!(lines("gpu/mask.rs", "use crate::photo::Photo;\n"), [1]);
    assert_eq!(lines("renderer.rs", "use crate::gpu::Device;\nuse crate::photo;\n"), [0; 0]);
    assert_eq!(lines("viewer/stage.rs", "use crate::gpu;\nuse crate::cli;\nuse crate::options;\n"), [2]);
    assert_eq!(lines("viewer/model/edits.rs", "use crate::viewer::model;\nuse egui::Ui;\n"), [2]);
    assert_eq!(lines("laboratory/rex/lab.rs", "use crate::viewer;\nuse crate::laboratory::chart;\n"), [1]);
    assert_eq!(lines("options/find.rs", "use crate::cli::lights;\nuse crate::terminal;\n"), [1]);
    assert_eq!(lines("job/mod.rs", "use crate::terminal::progress;\nuse crate::plan::gpu::f;\n"), [1]);
    assert_eq!(lines("program/live.rs", "use vglare::viewer;\n"), [0; 0]);
    assert_eq!(heads("{a, b::{c, d}, e as f};"), ["a", "b", "e"]);
    assert_eq!(uses_unsafe("// unsafe\nlet is_unsafe = 1;\n    unsafe { f() }\n"), [3]);
}
