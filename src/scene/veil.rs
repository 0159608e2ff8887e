//! What a scene file says of the veil, and the function that it names.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::Serialize;
use toml::{Spanned, Table, Value};

use super::LensVeil;
use super::bells::Fault;
use super::file::contents;
use crate::choices::{Border, Projection};
use crate::photo;
use crate::psf::{self, Kernel, Parameters, Psf};

/// `[veil]`: every pixel a source, by a point-spread function.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VeilSection {
    /// The function, by its name and its keys; files by absolute paths.
    #[serde(flatten)]
    pub parameters: Parameters,
    /// What of the world the picture's width spans, in degrees; 0.1 to 179, or to 360 for a fisheye.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fov: Option<f64>,
    /// How the camera formed the picture; rectilinear where it is `None` and the function is in degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub projection: Option<Projection>,
    /// What lies beyond the picture's edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub border: Option<Border>,
    /// The largest error relative to the veil at each pixel, between 0 and 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
}

/// A function that can be computed with, which copies share.
#[derive(Debug, Clone)]
pub struct VeilFunction(Arc<Psf>);

impl PartialEq for VeilFunction {
    fn eq(&self, other: &Self) -> bool {
        // A picture has millions of numbers, and looks are compared again and again.
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl VeilFunction {
    /// The function of a veil's parameters; files that they name are read.
    ///
    /// # Errors
    /// A [`psf::Fault`], which names the key.
    pub fn new(parameters: &Parameters) -> Result<Self, psf::Fault> {
        parameters.function(table, kernel).map(Self::from)
    }

    /// It.
    pub fn psf(&self) -> &Psf {
        &self.0
    }

    /// The same with another share of the light that is scattered, and nothing read again.
    ///
    /// # Errors
    /// Those of [`Psf::scattering`].
    pub fn scattering(&self, scatter: f64) -> Result<Self, psf::Fault> {
        self.psf().clone().scattering(scatter).map(Self::from)
    }
}

impl From<Psf> for VeilFunction {
    fn from(psf: Psf) -> Self {
        Self(Arc::new(psf))
    }
}

/// What a file of radius and value holds.
fn table(path: &Path) -> Result<String, psf::Fault> {
    let fault = |reason: String| psf::Fault::new("table", format!("{} {reason}", path.display()));
    let bytes = contents(path).map_err(fault)?;
    String::from_utf8(bytes).map_err(|_| fault("is not UTF-8 text".into()))
}

/// A picture as a kernel.
fn kernel(path: &Path) -> Result<Kernel, psf::Fault> {
    let fault = |reason: String| psf::Fault::new("kernel", reason);
    let photo = photo::read(path).map_err(|error| fault(error.to_string()))?;
    let pixels = photo.pixels.iter().map(|&[r, g, b, _]| [r, g, b].map(f64::from)).collect();
    Kernel::new(photo.height() as usize, photo.width() as usize, pixels)
}

/// Fields of view, in degrees, that a projection can have.
pub fn check_fov(fov: f64, projection: Option<Projection>) -> Result<(), psf::Fault> {
    let most = if projection == Some(Projection::Fisheye) { 360.0 } else { 179.0 };
    if (0.1..=most).contains(&fov) {
        return Ok(());
    }
    Err(psf::Fault::new("fov", format!("a field of view is from 0.1 to {most} degrees, and not {fov}")))
}

/// What `psf` is where there is to be no veil.
pub const NO_VEIL: &str = "none";

/// The veil of a lens, as a table of the file at `path` says it.
pub(super) fn of_lens(path: &Path, mut table: Spanned<Table>) -> Result<Option<LensVeil>, Fault> {
    let replaces_ghosts = match table.as_mut().remove("replaces_ghosts") {
        None => false,
        Some(Value::Boolean(replaces)) => replaces,
        Some(other) => {
            let message = format!("expected true or false, found {other} in `veil.replaces_ghosts`");
            return Err(Fault { span: table.span(), message });
        }
    };
    Ok(section(path, table)?.map(|section| LensVeil { section, replaces_ghosts }))
}

/// The section that a table of the file at `path` is; none where it says that there is none.
pub(super) fn section(path: &Path, table: Spanned<Table>) -> Result<Option<VeilSection>, Fault> {
    let span = table.span();
    let at = |message: String| Fault { span: span.clone(), message };
    let mut table = table.into_inner();
    if table.get("psf").and_then(Value::as_str) == Some(NO_VEIL) {
        return match table.keys().find(|key| *key != "psf") {
            Some(key) => Err(at(format!("`veil.{key}` is of no veil, and `psf` is \"{NO_VEIL}\""))),
            None => Ok(None),
        };
    }
    let fov = number(&mut table, "fov").map_err(at)?;
    let tolerance = number(&mut table, "tolerance").map_err(at)?;
    if let Some(tolerance) = tolerance.filter(|tolerance| !(*tolerance > 0.0 && *tolerance < 1.0)) {
        return Err(at(format!("expected a number between 0 and 1, found {tolerance} in `veil.tolerance`")));
    }
    let projection = choice(&mut table, "projection").map_err(at)?;
    let border = choice(&mut table, "border").map_err(at)?;
    let known = |error: toml::de::Error| at(format!("{} in `veil`", error.message()));
    let mut parameters: Parameters = Value::Table(table).try_into().map_err(known)?;
    for file in [&mut parameters.table, &mut parameters.kernel].into_iter().flatten() {
        *file = absolute(&path.parent().unwrap_or(Path::new("")).join(&file));
    }
    let fault = |fault: psf::Fault| at(format!("{} in `veil.{}`", fault.reason, fault.key));
    fov.map_or(Ok(()), |fov| check_fov(fov, projection)).map_err(fault)?;
    VeilFunction::new(&parameters).map_err(fault)?;
    Ok(Some(VeilSection { parameters, fov, projection, border, tolerance }))
}

/// A path that means the same from everywhere.
pub fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// A number under a key, whole or not.
fn number(table: &mut Table, key: &str) -> Result<Option<f64>, String> {
    match table.remove(key) {
        None => Ok(None),
        Some(Value::Float(number)) => Ok(Some(number)),
        Some(Value::Integer(number)) => Ok(Some(number as f64)),
        Some(other) => Err(format!("expected a number, found {other} in `veil.{key}`")),
    }
}

fn choice<T: serde::de::DeserializeOwned>(table: &mut Table, key: &str) -> Result<Option<T>, String> {
    let told = |error: toml::de::Error| format!("{} in `veil.{key}`", error.message());
    table.remove(key).map(|value| value.try_into().map_err(told)).transpose()
}
