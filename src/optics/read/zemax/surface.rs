//! A surface of a Zemax file.

use super::Line;
use crate::optics::coating::Coating;
use crate::optics::error::{OpticsError, Result};
use crate::optics::glass::Glass;
use crate::optics::prescription::{Origin, Surface};

/// What a keyword is to a surface.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum OfSurface {
    /// It is read here.
    Read,
    /// How the surface is drawn, solved, noted or computed with; the light's way is the same without.
    Aside,
    /// It belongs to no surface, or is not known.
    Unknown,
}

pub(super) fn of_surface(keyword: &str) -> OfSurface {
    match keyword {
        "TYPE" | "CURV" | "DISZ" | "THIC" | "GLAS" | "CONI" | "DIAM" | "CLAP" | "COAT" | "COMM" | "PARM" | "IGNR"
        | "OBDC" => OfSurface::Read,
        "HIDE" | "MIRR" | "SLAB" | "POPS" | "FLAP" | "FIMP" | "SCOL" | "MEMA" | "PPAR" | "PZUP" | "MAZH" | "PRAM"
        | "RAED" | "RAEI" | "OPDX" | "BLNK" | "DMFS" | "CHZN" => OfSurface::Aside,
        _ => OfSurface::Unknown,
    }
}

/// A surface as it is written, in the file's unit.
pub(super) struct SurfaceText {
    /// The file's number, from 0.
    pub number: usize,
    /// Its first line.
    pub line: usize,
    /// To the next; infinite where the file says so.
    pub thickness: f64,
    /// Whether it is the aperture stop.
    pub stop: bool,
    curvature: f64,
    conic: f64,
    semi_aperture: f64,
    /// The largest radius of a circular aperture, if it has one.
    aperture: Option<f64>,
    /// The name, and index and Abbe number of a model glass.
    glass: Option<(String, [f64; 2])>,
    coating: Option<Coating>,
    label: Option<String>,
}

impl SurfaceText {
    /// The surface that this line begins, after so many others.
    pub fn begin(line: &Line, before: usize, origin: &Origin) -> Result<Self> {
        if line.rest.parse() != Ok(before) {
            let after = before.checked_sub(1).map_or("nothing".to_owned(), |last| format!("SURF {last}"));
            let reason = format!("SURF {} follows on {after}", line.rest);
            return Err(OpticsError::Line { file: origin.file.clone(), line: line.number, reason });
        }
        Ok(Self {
            number: before,
            line: line.number,
            thickness: 0.0,
            stop: false,
            curvature: 0.0,
            conic: 0.0,
            semi_aperture: 0.0,
            aperture: None,
            glass: None,
            coating: None,
            label: None,
        })
    }

    /// Takes in a line of it.
    pub fn read(&mut self, line: &Line, origin: &Origin) -> Result<()> {
        let refused = || Err(line.unsupported(Some(self.number), origin));
        let first = || line.number(0, origin);
        match line.keyword {
            "STOP" => self.stop = true,
            "TYPE" if !matches!(line.word(0), Some("STANDARD" | "EVENASPH")) => return refused(),
            "PARM" if line.number(1, origin)? != 0.0 => return refused(),
            "IGNR" if first()? != 0.0 => return refused(),
            "OBDC" if first()? != 0.0 || line.number(1, origin)? != 0.0 => return refused(),
            "CURV" => self.curvature = first()?,
            "CONI" => self.conic = first()?,
            "DIAM" => self.semi_aperture = first()?,
            "DISZ" | "THIC" if line.word(0) == Some("INFINITY") => self.thickness = f64::INFINITY,
            "DISZ" | "THIC" => self.thickness = first()?,
            "CLAP" if first()? != 0.0 => return refused(),
            "CLAP" => self.aperture = Some(line.number(1, origin)?),
            "COMM" => self.label = Some(line.rest.to_owned()).filter(|label| !label.is_empty()),
            "COAT" => {
                // Zemax's own catalogue calls a quarter wave of magnesium fluoride AR.
                self.coating = match line.word(0) {
                    None | Some("NONE" | "NULL") => None,
                    Some("AR") => Some(Coating::MgF2),
                    Some(_) => return refused(),
                }
            }
            "GLAS" => match line.word(0) {
                None | Some("MIRROR") => return refused(),
                Some(name) => {
                    self.glass = Some((name.to_owned(), [line.number(3, origin)?, line.number(4, origin)?]));
                }
            },
            keyword if of_surface(keyword) == OfSurface::Unknown => return refused(),
            _ => {}
        }
        Ok(())
    }

    /// Whether it is air in air without a size, if it is air before it.
    pub fn is_nothing(&self) -> bool {
        !self.stop && self.glass.is_none() && self.semi_aperture == 0.0 && self.aperture.is_none()
    }

    /// The error that this surface has a feature that cannot be honoured.
    pub fn unsupported(&self, feature: &str, origin: &Origin) -> OpticsError {
        OpticsError::Unsupported {
            lens: origin.file.clone(),
            surface: Some(self.number),
            line: Some(self.line),
            feature: feature.to_owned(),
        }
    }

    /// Refuses a scene or a sensor that is not a plane in air.
    pub fn refuse_unless_plane(&self, what: &str, origin: &Origin) -> Result<()> {
        if self.curvature != 0.0 || self.glass.is_some() || self.stop {
            return Err(self.unsupported(&format!("{what} that is not plane and in air"), origin));
        }
        Ok(())
    }

    /// The surface with this index of the table, of a file in units of `unit` mm.
    pub fn surface(self, index: usize, unit: f64, origin: &Origin) -> Result<Surface> {
        let glass = match &self.glass {
            None => Glass::air(),
            Some((name, [refractive, abbe])) if name == "___BLANK" => {
                Glass::model(*refractive, Some(*abbe).filter(|&abbe| abbe != 0.0))
            }
            Some((name, _)) => origin.glass(index, name)?,
        };
        Ok(Surface {
            radius: (self.curvature != 0.0).then(|| unit / self.curvature),
            thickness: Some(self.thickness * unit),
            glass,
            semi_aperture: self.aperture.unwrap_or(self.semi_aperture) * unit,
            conic: self.conic,
            coating: self.coating,
            stop: self.stop,
            label: self.label,
        })
    }
}
