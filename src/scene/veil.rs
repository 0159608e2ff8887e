//! What a scene file says of the veil, and the function that it names.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::{Spanned, Table, Value};

use super::LensVeil;
use super::bells::Fault;
use super::file::contents;
use crate::Error;
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
    let fault = |reason: String| psf::Fault::of_file("table", path, reason);
    let bytes = contents(path).map_err(fault)?;
    String::from_utf8(bytes).map_err(|_| fault("is not UTF-8 text".into()))
}

/// A picture as a kernel.
fn kernel(path: &Path) -> Result<Kernel, psf::Fault> {
    let photo = photo::read(path).map_err(|error| match error {
        // It is no photo that is missing.
        Error::ReadPhoto { path, reason } => psf::Fault::of_file("kernel", &path, format!("cannot be read: {reason}")),
        error => psf::Fault::of_file("kernel", path, format!("cannot be read: {error}")),
    })?;
    let pixels = photo.pixels.iter().map(|&[r, g, b, _]| [r, g, b].map(f64::from)).collect();
    Kernel::new(photo.height() as usize, photo.width() as usize, pixels)
}

/// Fields of view, in degrees, that a projection can have.
pub fn check_fov(fov: f64, projection: Option<Projection>) -> Result<(), psf::Fault> {
    if projection == Some(Projection::Equirectangular) {
        let other = || psf::Fault::new("fov", format!("an equirectangular picture spans 360 degrees, and not {fov}"));
        return if fov == 360.0 { Ok(()) } else { Err(other()) };
    }
    let most = if projection == Some(Projection::Fisheye) { 360.0 } else { 179.0 };
    if (0.1..=most).contains(&fov) {
        return Ok(());
    }
    Err(psf::Fault::new("fov", format!("a field of view is from 0.1 to {most} degrees, and not {fov}")))
}

/// What `psf` is where there is to be no veil.
pub const NO_VEIL: &str = "none";

/// `[veil]` as it is written: the keys and what they say, each with its place.
pub(super) type VeilTable = BTreeMap<Spanned<String>, Spanned<Value>>;

/// The key of a lens's veil alone.
const REPLACES_GHOSTS: &str = "replaces_ghosts";
/// Those that are no function's.
const OF_SECTION: [&str; 4] = ["fov", "projection", "border", "tolerance"];

/// The veil of a lens, as a table of the file at `path` says it.
pub(super) fn of_lens(path: &Path, mut table: Spanned<VeilTable>) -> Result<Option<LensVeil>, Fault> {
    let replaces_ghosts = match table.as_mut().remove(REPLACES_GHOSTS) {
        None => false,
        Some(said) => said.as_ref().as_bool().ok_or_else(|| {
            let message = format!("expected true or false, found {} in `veil.{REPLACES_GHOSTS}`", said.as_ref());
            Fault { span: said.span(), message }
        })?,
    };
    let section = parsed(path, table, &[REPLACES_GHOSTS])?;
    Ok(section.map(|section| LensVeil { section, replaces_ghosts }))
}

/// The section that a table of the file at `path` is; none where it says that there is none.
pub(super) fn section(path: &Path, table: Spanned<VeilTable>) -> Result<Option<VeilSection>, Fault> {
    parsed(path, table, &[])
}

/// The same, of a table that may have had some more keys.
fn parsed(path: &Path, table: Spanned<VeilTable>, more: &[&str]) -> Result<Option<VeilSection>, Fault> {
    let whole = table.span();
    let mut table = table.into_inner();
    if table.get("psf").is_some_and(|psf| psf.as_ref().as_str() == Some(NO_VEIL)) {
        return match table.keys().find(|key| key.as_ref() != "psf") {
            Some(key) => {
                let message = format!("`veil.{}` is of no veil, and `psf` is \"{NO_VEIL}\"", key.as_ref());
                Err(Fault { span: key.span(), message })
            }
            None => Ok(None),
        };
    }
    let places: BTreeMap<String, Range<usize>> =
        table.iter().map(|(key, value)| (key.as_ref().clone(), value.span())).collect();
    // What is wrong with a key is told where it stands.
    let located = |fault: psf::Fault| {
        let span = places.get(fault.key).unwrap_or(&whole).clone();
        Fault { span, message: format!("{} in `veil.{}`", fault.in_words(), fault.key) }
    };
    let tolerance = number(&mut table, "tolerance")?;
    if let Some(tolerance) = tolerance.filter(|tolerance| !(*tolerance > 0.0 && *tolerance < 1.0)) {
        let reason = format!("expected a number between 0 and 1, found {tolerance}");
        return Err(located(psf::Fault::new("tolerance", reason)));
    }
    let fov = number(&mut table, "fov")?;
    let projection = table.remove("projection").map(|value| said("projection", value)).transpose()?;
    let border = table.remove("border").map(|value| said("border", value)).transpose()?;
    let mut parameters = parameters(table, &whole, more)?;
    for file in [&mut parameters.table, &mut parameters.kernel].into_iter().flatten() {
        *file = absolute(&path.parent().unwrap_or(Path::new("")).join(&file));
    }
    fov.map_or(Ok(()), |fov| check_fov(fov, projection)).map_err(located)?;
    VeilFunction::new(&parameters).map_err(located)?;
    Ok(Some(VeilSection { parameters, fov, projection, border, tolerance }))
}

/// The function's own keys; `more` are others that the table may have had.
fn parameters(table: VeilTable, whole: &Range<usize>, more: &[&str]) -> Result<Parameters, Fault> {
    let keys = || Parameters::KEYS.into_iter().chain(OF_SECTION).chain(more.iter().copied());
    if let Some(key) = table.keys().find(|key| !keys().any(|known| known == key.as_ref())) {
        let known: Vec<String> = keys().map(|key| format!("`{key}`")).collect();
        let message = format!("unknown field `{}`, expected one of {} in `veil`", key.as_ref(), known.join(", "));
        return Err(Fault { span: key.span(), message });
    }
    let missing = || Fault { span: whole.clone(), message: "missing field `psf` in `veil`".into() };
    let psf = table.get("psf").ok_or_else(missing)?.clone();
    said::<psf::Name>("psf", psf.clone())?;
    let psf = ("psf".to_owned(), psf.into_inner());
    let plain = table.into_iter().map(|(key, value)| (key.into_inner(), value));
    let mut all = Table::new();
    // One by one, to know which it is that is wrong.
    for (key, value) in plain {
        let span = value.span();
        let value = value.into_inner();
        let alone = Table::from_iter([psf.clone(), (key.clone(), value.clone())]);
        let told = |error: toml::de::Error| Fault { span, message: format!("{} in `veil.{key}`", error.message()) };
        Value::Table(alone).try_into::<Parameters>().map_err(told)?;
        all.insert(key, value);
    }
    let whole =
        |error: toml::de::Error| Fault { span: whole.clone(), message: format!("{} in `veil`", error.message()) };
    Value::Table(all).try_into().map_err(whole)
}

/// A path that means the same from everywhere.
pub fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// A number under a key, whole or not.
fn number(table: &mut VeilTable, key: &str) -> Result<Option<f64>, Fault> {
    let Some(value) = table.remove(key) else { return Ok(None) };
    match value.as_ref() {
        Value::Float(number) => Ok(Some(*number)),
        Value::Integer(number) => Ok(Some(*number as f64)),
        other => {
            Err(Fault { span: value.span(), message: format!("expected a number, found {other} in `veil.{key}`") })
        }
    }
}

/// What a key says.
fn said<T: DeserializeOwned>(key: &str, value: Spanned<Value>) -> Result<T, Fault> {
    let span = value.span();
    let told = |error: toml::de::Error| Fault { span, message: format!("{} in `veil.{key}`", error.message()) };
    value.into_inner().try_into().map_err(told)
}
