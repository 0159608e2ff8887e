//! Shaders: read from `shaders/`, put together, compiled.
//!
//! A source is a file of that folder. `#include "path"` pulls in another, once; each file keeps its own line numbers,
//! and the driver's messages name the file. Every shader begins with the version, the binding numbers and
//! the other numbers of [`super::layout`], and the caller's own definitions.

use std::fmt::Write as _;
use std::rc::Rc;

use glow::HasContext as _;

use super::context::Device;
use super::layout::{BINDINGS, NUMBERS};
use crate::{Error, Result, limits};

/// What a software renderer takes to compile a program, bytes.
const COMPILING: u64 = 16 << 20;

macro_rules! sources {
    ($($path:literal),* $(,)?) => {
        [$(($path, include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", $path)))),*]
    };
}

/// Every file of `shaders/`.
const SOURCES: &[(&str, &str)] = &sources![
    "bells/any.glsl",
    "bells/bladed_disc.glsl",
    "bells/cosine_squared.glsl",
    "bells/disc.glsl",
    "bells/gaussian.glsl",
    "bells/iris.glsl",
    "bells/parabola.glsl",
    "bells/paraboloid.glsl",
    "bells/point.glsl",
    "bells/profile.glsl",
    "bells/sine_gaussian.glsl",
    "bells/von_mises.glsl",
    "cells.frag",
    "coefficients.comp",
    "coefficients_sum.comp",
    "composite.frag",
    "copy.frag",
    "evaluators/direct.glsl",
    "evaluators/direct_double.glsl",
    "evaluators/graf.glsl",
    "evaluators/grid.glsl",
    "evaluators/grid_double.glsl",
    "evaluators/held.glsl",
    "evaluators/layers.glsl",
    "evaluators/local.glsl",
    "evaluators/local_double.glsl",
    "evaluators/none.glsl",
    "evaluators/rows.glsl",
    "evaluators/rows_double.glsl",
    "evaluators/series.glsl",
    "evaluators/series_double.glsl",
    "evaluators/split.glsl",
    "field.frag",
    "fullscreen.vert",
    "graf_folded.frag",
    "graf_radial.frag",
    "graf_spectrum.comp",
    "harmonics.frag",
    "lattice.frag",
    "lattice_double.comp",
    "lines.frag",
    "lines.vert",
    "local.frag",
    "local.vert",
    "local_lists.frag",
    "mask.frag",
    "precision.comp",
    "probe.frag",
    "profiles.frag",
    "profiles_double.comp",
    "range.frag",
    "shared/bessel.glsl",
    "shared/bspline.glsl",
    "shared/bspline_double.glsl",
    "shared/double.glsl",
    "shared/emission.glsl",
    "shared/knots.glsl",
    "shared/knots_double.glsl",
    "shared/normalized.glsl",
    "shared/overlay.glsl",
    "shared/phase.glsl",
    "shared/shapes.glsl",
    "shared/sine.glsl",
    "shared/spectrum.glsl",
    "shared/spectrum_double.glsl",
    "shared/tone.glsl",
    "shared/waves.glsl",
    "shrink.frag",
    "spectrum.comp",
    "spectrum_sum.comp",
    "strips.frag",
    "strips_double.comp",
    "veil/convolve.frag",
    "veil/expand.frag",
    "veil/finish.frag",
    "view.frag",
];

/// A definition that a shader is specialised with.
pub(crate) type Define<'a> = (&'a str, &'a str);

/// A linked program.
pub(crate) struct Program {
    device: Rc<Device>,
    raw: glow::Program,
}

impl Program {
    /// A program that runs `fragment` for each texel of its target.
    pub fn fragment(device: &Rc<Device>, fragment: &str, defines: &[Define<'_>]) -> Result<Self> {
        let stages = [(glow::VERTEX_SHADER, "fullscreen.vert"), (glow::FRAGMENT_SHADER, fragment)];
        Self::link(device, &stages, defines)
    }

    /// A program that runs `fragment` for what `vertex` makes of its vertices.
    pub fn drawing(device: &Rc<Device>, vertex: &str, fragment: &str, defines: &[Define<'_>]) -> Result<Self> {
        Self::link(device, &[(glow::VERTEX_SHADER, vertex), (glow::FRAGMENT_SHADER, fragment)], defines)
    }

    /// A program of one compute shader.
    pub fn compute(device: &Rc<Device>, compute: &str, defines: &[Define<'_>]) -> Result<Self> {
        Self::link(device, &[(glow::COMPUTE_SHADER, compute)], defines)
    }

    /// A program of one compute shader that is no file of `shaders/`; it has the same head as all.
    #[cfg(test)]
    pub fn compute_from(device: &Rc<Device>, source: &str) -> Result<Self> {
        let text = head(&[]) + source;
        Self::link_texts(device, "a test's shader", vec![(glow::COMPUTE_SHADER, text, Vec::new())])
    }

    fn link(device: &Rc<Device>, stages: &[(u32, &str)], defines: &[Define<'_>]) -> Result<Self> {
        let texts = stages.iter().map(|&(stage, path)| {
            let (text, files) = assemble(path, defines)?;
            Ok((stage, text, files))
        });
        Self::link_texts(device, stages[stages.len() - 1].1, texts.collect::<Result<_>>()?)
    }

    fn link_texts(device: &Rc<Device>, name: &str, texts: Vec<(u32, String, Vec<String>)>) -> Result<Self> {
        limits::room(COMPILING, "a shader")?;
        let gl = device.gl();
        // SAFETY: the device keeps its context current on this thread.
        let raw = unsafe { gl.create_program() }.map_err(|reason| Error::Gl(format!("{name}: {reason}")))?;
        let program = Self { device: device.clone(), raw };
        for (stage, text, files) in texts {
            let shader = compile(gl, stage, &text, &files)?;
            // SAFETY: the device keeps its context current on this thread, and the program and its shaders are its own.
            unsafe {
                gl.attach_shader(raw, shader);
                // Freed together with the program from here on.
                gl.delete_shader(shader);
            }
        }
        // SAFETY: the device keeps its context current on this thread, and the program and its shaders are its own.
        unsafe { gl.link_program(raw) };
        // SAFETY: the device keeps its context current on this thread, and the program and its shaders are its own.
        if unsafe { gl.get_program_link_status(raw) } {
            Ok(program)
        } else {
            // SAFETY: the device keeps its context current on this thread, and the program and its shaders are its own.
            Err(Error::Gl(format!("{name} does not link: {}", unsafe { gl.get_program_info_log(raw) })))
        }
    }

    /// Makes the program current.
    pub fn bind(&self) {
        // SAFETY: the device keeps its context current on this thread, and the program and its shaders are its own.
        unsafe { self.device.gl().use_program(Some(self.raw)) }
    }

    /// Runs a compute program, and makes what it stores visible to every later pass.
    pub fn dispatch(&self, groups: [u32; 3]) {
        self.bind();
        // SAFETY: the device keeps its context current on this thread. OpenGL 4.3 does not keep a shader from reading and
        // writing beside what is bound; each shader stops at the counts that its pass gives it or at the buffer's own length,
        // and each pass makes its buffers for these counts.
        unsafe {
            self.device.gl().dispatch_compute(groups[0], groups[1], groups[2]);
            self.device.gl().memory_barrier(glow::SHADER_STORAGE_BARRIER_BIT);
        }
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        if let Some(gl) = self.device.to_free() {
            // SAFETY: the device's context is there and current, and nothing uses what is freed from here on.
            unsafe { gl.delete_program(self.raw) }
        }
    }
}

fn compile(gl: &glow::Context, stage: u32, source: &str, files: &[String]) -> Result<glow::Shader> {
    let path = files.first().map_or("a shader", String::as_str);
    // SAFETY: the device keeps its context current on this thread.
    let shader = unsafe { gl.create_shader(stage) }.map_err(|reason| Error::Gl(format!("{path}: {reason}")))?;
    // SAFETY: the device keeps its context current on this thread, and the program and its shaders are its own.
    unsafe {
        gl.shader_source(shader, source);
        gl.compile_shader(shader);
    }
    // SAFETY: the device keeps its context current on this thread, and the program and its shaders are its own.
    if unsafe { gl.get_shader_compile_status(shader) } {
        return Ok(shader);
    }
    // SAFETY: the device keeps its context current on this thread, and the program and its shaders are its own.
    let log = unsafe { gl.get_shader_info_log(shader) };
    // SAFETY: the device keeps its context current on this thread, and the shader is not used from here on.
    unsafe { gl.delete_shader(shader) };
    let legend: Vec<_> = files.iter().enumerate().map(|(index, file)| format!("{index} is {file}")).collect();
    Err(Error::Gl(format!("{path} does not compile ({}):\n{log}", legend.join(", "))))
}

/// The whole text of a shader, and the files that its `#line` directives number.
fn assemble(path: &str, defines: &[Define<'_>]) -> Result<(String, Vec<String>)> {
    let mut text = head(defines);
    let mut files = Vec::new();
    include(path, defines, &mut text, &mut files)?;
    Ok((text, files))
}

/// What every shader begins with.
fn head(defines: &[Define<'_>]) -> String {
    let mut text = String::from("#version 430 core\n");
    for (name, number) in BINDINGS.into_iter().chain(NUMBERS) {
        let _ = writeln!(text, "#define {name} {number}");
    }
    for (name, value) in defines {
        let _ = writeln!(text, "#define {name} {value}");
    }
    text
}

/// A file of `shaders/`, as it is.
pub(super) fn source(path: &str) -> Result<&'static str> {
    let found = SOURCES.iter().find(|(name, _)| *name == path);
    found.map(|(_, source)| *source).ok_or_else(|| Error::Gl(format!("there is no shader called {path}")))
}

fn include(path: &str, defines: &[Define<'_>], text: &mut String, files: &mut Vec<String>) -> Result<()> {
    if files.iter().any(|file| file == path) {
        return Ok(());
    }
    let source = source(path)?;
    let index = files.len();
    files.push(path.to_owned());
    let _ = writeln!(text, "#line 1 {index}");
    for (line, number) in source.lines().zip(2..) {
        if let Some(target) = line.trim().strip_prefix("#include ") {
            // A definition may choose the file: `#include BELL` with BELL defined as "bells/gaussian.glsl".
            let target = defines.iter().find(|(name, _)| *name == target).map_or(target, |(_, value)| value);
            include(target.trim_matches('"'), defines, text, files)?;
            let _ = writeln!(text, "#line {number} {index}");
        } else {
            text.push_str(line);
            text.push('\n');
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shader_file_is_embedded() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
        let mut folders = vec![root.clone()];
        let mut found = Vec::new();
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    found.push(path.strip_prefix(&root).unwrap().to_str().unwrap().to_owned());
                }
            }
        }
        found.sort();
        let embedded: Vec<_> = SOURCES.iter().map(|(name, _)| name.to_string()).collect();
        assert_eq!(found, embedded, "SOURCES, sorted, must list the files of shaders/");
    }

    #[test]
    fn every_number_that_is_defined_is_used_and_every_one_that_is_compared_with_is_defined() {
        let words = |text: &'static str| text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        let used: Vec<_> = SOURCES.iter().flat_map(|(_, source)| words(source)).collect();
        // What no shader asks for, since it is what is left where nothing is done.
        let left = ["NORMALIZE_NONE", "TONE_MAP_NONE"];
        let defined: Vec<_> = BINDINGS.into_iter().chain(NUMBERS).map(|(name, _)| name).collect();
        // Some are Rust's alone.
        for name in defined.iter().filter(|name| !left.contains(name) && !name.starts_with("UNIT_WORKBENCH")) {
            assert!(used.contains(name), "no shader uses {name}");
        }
        let mut compared = 0;
        for (path, source) in SOURCES {
            for line in source.lines().filter(|line| line.starts_with("#if ") || line.starts_with("#elif ")) {
                if let Some((_, number)) = line.split_once(" == ") {
                    assert!(defined.contains(&number), "{path}: {line}: is not defined, and would be 0");
                    compared += 1;
                }
            }
        }
        assert!(compared >= 5, "{compared}");
    }

    #[test]
    fn a_file_is_included_once_and_lines_keep_their_numbers() {
        let (text, files) = assemble("field.frag", &[("EVALUATOR", "\"evaluators/rows.glsl\"")]).unwrap();
        assert_eq!(files, ["field.frag", "evaluators/rows.glsl", "shared/spectrum.glsl"]);
        assert!(text.contains("#line 1 1"), "{text}");
        assert!(!text.contains("#include"), "{text}");
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = assemble("nothing.frag", &[]).unwrap_err();
        assert!(error.to_string().contains("nothing.frag"), "{error}");
    }
}
