//! What is printed.

use std::io::{self, Write};
use std::path::Path;

use comfy_table::{CellAlignment, Table, presets};
use serde::Serialize;

use super::Index;
use super::closed::{self, Closed};
use super::field::{Field, Place, RING};
use super::spots::Spot;
use crate::Result;
use crate::look::{Look, LookLens};
use crate::photo::{LuminanceScale, Photo};
use crate::terminal::{digits, stdout};

/// What was measured of a look.
pub struct Told<'a> {
    pub look: &'a Look,
    pub field: &'a Field,
    /// Degrees across the picture.
    pub fov: f64,
    pub places: &'a [Place],
    /// Rising.
    pub diameters: &'a [f64],
    /// Of each diameter, all places.
    pub all: &'a [Index],
    /// cd/m² of the chart's field before any glare, where that is given.
    pub white: Option<f64>,
    /// Closed forms, in the same order where there are both.
    pub closed: Option<&'a [Closed]>,
}

/// What was measured, and in cd/m² where that is known.
#[derive(Serialize)]
struct WithLuminance<T: Serialize> {
    #[serde(flatten)]
    measured: T,
    /// N, of the spot.
    #[serde(skip_serializing_if = "Option::is_none")]
    spot_cd_m2: Option<f64>,
    /// D, of the field around it.
    #[serde(skip_serializing_if = "Option::is_none")]
    field_cd_m2: Option<f64>,
}

impl<T: Serialize> WithLuminance<T> {
    fn new(measured: T, both: Option<[f64; 2]>) -> Self {
        Self { measured, spot_cd_m2: both.map(|[spot, _]| spot), field_cd_m2: both.map(|[_, field]| field) }
    }
}

#[derive(Serialize)]
struct Json<'a> {
    vglare: &'static str,
    lens: String,
    veil: Option<String>,
    f_number: Option<f64>,
    strength: f64,
    picture: [u32; 2],
    fov: f64,
    ring_diameters: f64,
    /// cd/m² of the field before any glare.
    #[serde(skip_serializing_if = "Option::is_none")]
    field_cd_m2: Option<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    spots: Vec<WithLuminance<Index>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    closed: Option<&'a [Closed]>,
}

/// Rec. 709's weights of luminance.
pub fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

impl Told<'_> {
    /// The look, in a few words.
    pub fn name(&self) -> String {
        let veil = self.veil().map_or(String::new(), |veil| format!(", veil {veil}"));
        let closed = self.closed.unwrap_or_default();
        let several = closed.windows(2).any(|pair| pair[0].f_number != pair[1].f_number);
        let stop = self.f_number().filter(|_| !several).map_or(String::new(), |number| format!(" at f/{number:.1}"));
        format!("{}{stop}{veil}", self.lens())
    }

    fn lens(&self) -> String {
        if self.look.lens_ghosts().is_empty() { "no ghosts".to_owned() } else { self.look.lens().name.clone() }
    }

    /// N and D of a spot in cd/m², where the field is.
    fn in_cd_m2(&self, spot: &Index) -> Option<[f64; 2]> {
        self.white.map(|white| spot.levels.map(|level| white * luminance(level)))
    }

    fn veil(&self) -> Option<String> {
        self.look.veil.as_ref().map(|veil| veil.psf().name().to_string())
    }

    fn f_number(&self) -> Option<f64> {
        if let LookLens::Optical(optical) = &self.look.lens { Some(optical.f_number()) } else { None }
    }

    /// As JSON, one object.
    pub fn json(&self) -> Result<()> {
        let json = Json {
            vglare: env!("CARGO_PKG_VERSION"),
            lens: self.lens(),
            veil: self.veil(),
            f_number: self.f_number(),
            strength: self.look.strength,
            picture: self.field.size,
            fov: self.fov,
            ring_diameters: RING,
            field_cd_m2: self.white,
            spots: self.all.iter().map(|spot| WithLuminance::new(*spot, self.in_cd_m2(spot))).collect(),
            closed: self.closed,
        };
        print(&json)
    }

    /// A row for each place, a column for each diameter, and one for its closed form; then what rays tell.
    pub fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        let [width, height] = self.field.size;
        let across = format!("{:.1}° across {width} × {height} pixels", self.fov);
        let closed = self.closed.unwrap_or_default();
        if self.all.is_empty() {
            writeln!(out, "{}: {across}, in closed form", self.name())?;
            closed::print(closed, self.diameters, out)?;
        } else {
            writeln!(out, "{}: {across}, every pixel a source", self.name())?;
            self.rendered(closed, out)?;
        }
        writeln!(
            out,
            "The luminance of a spot's centre over that of the field {RING} diameters from it; in the manner of ISO 9358."
        )?;
        closed::rays_table(closed, out)?;
        self.white.map_or(Ok(()), |white| self.luminances(out, white))
    }

    fn rendered(&self, closed: &[Closed], out: &mut dyn Write) -> io::Result<()> {
        let mut table = Table::new();
        table.load_style(presets::NOTHING);
        let beside = if closed.is_empty() { &[][..] } else { &["closed form"] };
        let spots = self.diameters.iter().flat_map(|diameter| {
            std::iter::once(format!("{diameter}° spot, %")).chain(beside.iter().map(|text| (*text).to_owned()))
        });
        table.set_header(["place".to_owned(), "off axis".to_owned()].into_iter().chain(spots));
        for (number, place) in self.places.iter().enumerate() {
            let of = self.all.iter().skip(number).step_by(self.places.len());
            let mut beside = closed::columns(closed, number, self.places.len()).into_iter();
            let cells = of.flat_map(|Index { index, bound, .. }| {
                let rendered = format!("{:.3} ± {:.3}", 100.0 * luminance(*index), 100.0 * luminance(*bound));
                std::iter::once(rendered).chain(beside.next())
            });
            let off = format!("{:.1}°", self.field.off_axis(place.pixel));
            table.add_row([place.name.to_owned(), off].into_iter().chain(cells));
        }
        table.column_iter_mut().skip(1).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
        writeln!(out, "{}", table.trim_fmt())
    }

    /// The same places in cd/m².
    fn luminances(&self, out: &mut dyn Write, white: f64) -> io::Result<()> {
        writeln!(out, "\nSpot and field in cd/m², of a field of {} before any glare:", digits(white))?;
        let mut table = Table::new();
        table.load_style(presets::NOTHING);
        let spots = self.diameters.iter().map(|diameter| format!("{diameter}° spot"));
        table.set_header(["place".to_owned()].into_iter().chain(spots));
        for (number, place) in self.places.iter().enumerate() {
            let of = self.all.iter().skip(number).step_by(self.places.len()).filter_map(|spot| self.in_cd_m2(spot));
            let cells = of.map(|both| both.map(digits).join(" and "));
            table.add_row([place.name.to_owned()].into_iter().chain(cells));
        }
        table.column_iter_mut().skip(1).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
        writeln!(out, "{}", table.trim_fmt())
    }
}

#[derive(Serialize)]
struct PhotoJson<'a> {
    vglare: &'static str,
    photo: String,
    /// What the photo's numbers are, where that is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    luminance: Option<&'a LuminanceScale>,
    spots: Vec<WithLuminance<Spot>>,
}

/// What was measured in a photo.
pub fn spots(as_json: bool, path: &Path, photo: &Photo, spots: &[Spot]) -> Result<()> {
    let scale = photo.luminance_scale();
    let in_cd_m2 = |spot: &Spot| scale.as_ref().map(|scale| spot.levels.map(|level| scale.of_colour(level)));
    if as_json {
        let spots = spots.iter().map(|spot| WithLuminance::new(*spot, in_cd_m2(spot))).collect();
        let (vglare, photo) = (env!("CARGO_PKG_VERSION"), path.display().to_string());
        return print(&PhotoJson { vglare, photo, luminance: scale.as_ref(), spots });
    }
    stdout::print(|out| {
        writeln!(out, "{}: {} x {}, {}", path.display(), photo.width(), photo.height(), photo.format_name())?;
        let mut table = Table::new();
        table.load_style(presets::NOTHING);
        let header = ["column", "row", "diameter", "red, %", "green, %", "blue, %", "pixels"];
        let more: &[&str] = if scale.is_some() { &["spot, cd/m²", "field, cd/m²"] } else { &[] };
        table.set_header(header.iter().chain(more));
        for spot in spots {
            let in_cd_m2 = in_cd_m2(spot);
            let Spot { centre: [x, y], diameter, levels: _, index, standard_error, pixels: [spot, ring] } = spot;
            let cell = |c: usize| format!("{:.3} ± {:.3}", 100.0 * index[c], 100.0 * standard_error[c]);
            let [red, green, blue] = [0, 1, 2].map(cell);
            let pixels = format!("{spot} and {ring}");
            let cells = [x.to_string(), y.to_string(), diameter.to_string(), red, green, blue, pixels];
            table.add_row(cells.into_iter().chain(in_cd_m2.into_iter().flatten().map(digits)));
        }
        table.column_iter_mut().for_each(|column| column.set_cell_alignment(CellAlignment::Right));
        writeln!(out, "{}", table.trim_fmt())?;
        scale.iter().try_for_each(|scale| {
            writeln!(out, "White of the photo: {} cd/m², {}", digits(scale.cd_m2_per_unit), scale.from)
        })
    })
}

fn print(value: &impl Serialize) -> Result<()> {
    stdout::json(|out| {
        serde_json::to_writer_pretty(&mut *out, value)?;
        writeln!(out)
    })
}
