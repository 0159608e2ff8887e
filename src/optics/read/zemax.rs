//! Sequential lens files of Zemax (`.zmx`, as text): rotationally symmetric lenses of spheres and conics.
//!
//! The file's surface 0 is the scene and its last one the sensor. Fields, wavelengths, merit functions and tolerances
//! are about a design and not the lens; they are not read. What would change the light's way and cannot be honoured is an
//! error, and so is a keyword of a surface that is not known here.

mod surface;

use super::number;
use crate::optics::coating::Coating;
use crate::optics::error::{OpticsError, Result};
use crate::optics::prescription::{Iris, Origin, Prescription, Surface};
use surface::{OfSurface, SurfaceText, of_surface};

/// A line of the file.
struct Line<'a> {
    number: usize,
    keyword: &'a str,
    /// What follows the keyword.
    rest: &'a str,
    indented: bool,
}

impl Line<'_> {
    fn word(&self, index: usize) -> Option<&str> {
        self.rest.split_whitespace().nth(index)
    }

    /// The number at this place after the keyword; 0 where nothing stands there.
    fn number(&self, index: usize, origin: &Origin) -> Result<f64> {
        self.word(index).map_or(Ok(0.0), |word| number(word, self.keyword, self.number, origin))
    }

    /// An error that says that this line cannot be honoured.
    fn unsupported(&self, surface: Option<usize>, origin: &Origin) -> OpticsError {
        let feature = format!("{} {}", self.keyword, self.rest).trim_end().to_owned();
        OpticsError::Unsupported { lens: origin.file.clone(), surface, line: Some(self.number), feature }
    }
}

/// What is said before and after the surfaces.
struct Header {
    name: String,
    /// In mm.
    unit: f64,
    /// The stop's surface, in files that do not say it at the surface.
    stop: Option<usize>,
}

pub(super) fn parse(text: &str, origin: &mut Origin) -> Result<Prescription> {
    let mut header = Header { name: String::new(), unit: 1.0, stop: None };
    let mut surfaces: Vec<SurfaceText> = Vec::new();
    // Whether lines belong to the last surface.
    let mut within = false;
    for (number, text) in (1..).zip(text.lines()) {
        let trimmed = text.trim();
        let (keyword, rest) = trimmed.split_once(char::is_whitespace).unwrap_or((trimmed, ""));
        let line = Line { number, keyword, rest: rest.trim(), indented: text.starts_with([' ', '\t']) };
        if keyword.is_empty() || keyword.starts_with('!') {
            continue;
        }
        if keyword == "SURF" {
            surfaces.push(SurfaceText::begin(&line, surfaces.len(), origin)?);
            within = true;
            continue;
        }
        within &= line.indented || of_surface(keyword) != OfSurface::Unknown;
        match surfaces.last_mut().filter(|_| within) {
            Some(surface) => surface.read(&line, origin)?,
            None => header.read(&line, origin)?,
        }
    }
    lens(header, surfaces, origin)
}

impl Header {
    fn read(&mut self, line: &Line, origin: &Origin) -> Result<()> {
        match line.keyword {
            "MODE" if line.word(0) != Some("SEQ") => return Err(line.unsupported(None, origin)),
            // The number of configurations; one is no multi-configuration.
            "MNUM" if line.number(0, origin)? > 1.0 => return Err(line.unsupported(None, origin)),
            "NAME" => line.rest.clone_into(&mut self.name),
            "STOP" => self.stop = line.word(0).and_then(|word| word.parse().ok()),
            "UNIT" => {
                self.unit = match line.word(0) {
                    Some("MM") => 1.0,
                    Some("CM") => 10.0,
                    Some("IN" | "INCH") => 25.4,
                    Some("M" | "METER") => 1000.0,
                    _ => return Err(line.unsupported(None, origin)),
                }
            }
            _ => {}
        }
        Ok(())
    }
}

fn lens(header: Header, mut surfaces: Vec<SurfaceText>, origin: &mut Origin) -> Result<Prescription> {
    let (Some(image), false) = (surfaces.pop(), surfaces.is_empty()) else {
        return Err(origin.lens("it has no surfaces between the scene and the sensor"));
    };
    image.refuse_unless_plane("an image surface", origin)?;
    let object = surfaces.remove(0);
    object.refuse_unless_plane("an object surface", origin)?;
    if object.thickness.is_finite() {
        let feature = format!("an object at {} mm", object.thickness * header.unit);
        return Err(object.unsupported(
            &format!("{feature}: focus is at infinity in a lens file, and a focus at a distance"),
            origin,
        ));
    }
    if let Some(stop) = header.stop
        && let Some(surface) = surfaces.iter_mut().find(|surface| surface.number == stop)
    {
        surface.stop = true;
    }
    let mut table: Vec<Surface> = Vec::new();
    for surface in surfaces {
        let is_air = table.last().is_none_or(|before| before.glass.is_air());
        match table.last_mut() {
            // A surface for the designer, that does nothing and has no size.
            _ if !(surface.is_nothing() && is_air) => {
                origin.lines.push(surface.line);
                table.push(surface.surface(table.len(), header.unit, origin)?);
            }
            Some(before) => before.thickness = before.thickness.map(|gap| gap + surface.thickness * header.unit),
            None => {}
        }
    }
    Ok(Prescription {
        name: header.name,
        description: String::new(),
        patent: None,
        focal_length: None,
        f_number: None,
        field: None,
        coating: Coating::None,
        iris: Iris::default(),
        surfaces: table,
        settings: Vec::new(),
        notes: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::glass::Glass;

    const LENS: &str = "VERS 90111 0 25 27471\nMODE SEQ\nNAME Test lens\nUNIT MM X W X CM MR CPMM\nENPD 10\nWAVM 1 0.5876 1\n\
        MNUM 1 1\nSURF 0\n  TYPE STANDARD\n  CURV 0.0 0 0 0 0 \"\"\n  DISZ INFINITY\n  DIAM 0 0 0 0 1 \"\"\n\
        SURF 1\n  COMM front\n  TYPE STANDARD\n  CURV 2.0E-2 0 0 0 0 \"\"\n  HIDE 0 0 0\n  DISZ 4\n  GLAS N-BK7 0 0 1.5 40\n  \
        CONI -0.5\n  COAT AR\n  DIAM 10 1 0 0 1 \"\"\n\
        SURF 2\n  TYPE EVENASPH\n  CURV 0.0\n  PARM 1 0\n  PARM 2 0.0\n  DISZ 2\n  GLAS ___BLANK 1 0 1.6727 32.2 0\n  DIAM 9\n  CLAP 0 8.5 0\n\
        SURF 3\n  TYPE STANDARD\n  CURV -0.01\n  DISZ 1\n  DIAM 9\n\
        SURF 4\n  TYPE STANDARD\n  CURV 0\n  DISZ 0.5\n  DIAM 0\n\
        SURF 5\n  STOP\n  TYPE STANDARD\n  CURV 0\n  DISZ 40\n  DIAM 4\n\
        SURF 6\n  TYPE STANDARD\n  CURV 0\n  DISZ 0\n  DIAM 15\nTOL TOFF 0 0\nMNUM 1\n";

    fn parse(text: &str) -> Result<Prescription> {
        Prescription::parse(text.as_bytes(), "lens.zmx")
    }

    #[test]
    fn a_sequential_lens_is_read() {
        let lens = parse(LENS).unwrap();
        let [front, cemented, back, stop] = &lens.surfaces[..] else { panic!("{:?}", lens.surfaces) };
        assert_eq!((lens.name.as_str(), front.label.as_deref()), ("Test lens", Some("front")));
        assert_eq!(
            (front.radius, front.thickness, front.conic, front.semi_aperture),
            (Some(50.0), Some(4.0), -0.5, 10.0)
        );
        assert_eq!((front.glass.name.as_str(), front.coating.as_ref()), ("N-BK7", Some(&Coating::MgF2)));
        assert_eq!((cemented.radius, cemented.semi_aperture), (None, 8.5));
        assert_eq!(cemented.glass, Glass::model(1.6727, Some(32.2)));
        assert_eq!(
            (back.radius, back.thickness),
            (Some(-100.0), Some(1.5)),
            "with the gap of the surface that is nothing"
        );
        assert_eq!((stop.stop, stop.thickness, stop.semi_aperture), (true, Some(40.0), 4.0));
    }

    #[test]
    fn utf_16_and_other_units_give_the_same_lens() {
        let bytes = |order: fn(u16) -> [u8; 2]| LENS.encode_utf16().flat_map(order).collect::<Vec<u8>>();
        let lens = parse(LENS).unwrap();
        for bytes in
            [bytes(u16::to_le_bytes), bytes(u16::to_be_bytes), [&[0xff, 0xfe], &bytes(u16::to_le_bytes)[..]].concat()]
        {
            assert_eq!(Prescription::parse(&bytes, "lens.zmx").unwrap(), lens);
        }
        for (unit, millimetres) in [("CM", 10.0), ("IN", 25.4), ("METER", 1000.0)] {
            let scaled = parse(&LENS.replace("UNIT MM", &format!("UNIT {unit}"))).unwrap();
            let front = &scaled.surfaces[0];
            assert!((front.radius.unwrap() - 50.0 * millimetres).abs() < 1e-9, "{unit}");
            assert_eq!((front.thickness, front.semi_aperture), (Some(4.0 * millimetres), 10.0 * millimetres));
        }
    }

    #[test]
    fn what_cannot_be_honoured_is_refused_by_name() {
        for (from, to, said) in [
            ("MODE SEQ", "MODE NSC", "lens.zmx, line 2: MODE NSC cannot be honoured"),
            ("MNUM 1 1", "MNUM 3 1", "MNUM 3 1 cannot"),
            ("UNIT MM", "UNIT FURLONG", "UNIT FURLONG X W"),
            ("DISZ INFINITY", "DISZ 500", "surface 0 (line 8): an object at 500 mm"),
            ("PARM 2 0.0", "PARM 2 1e-5", "surface 2 (line 27): PARM 2 1e-5 cannot be honoured"),
            ("TYPE EVENASPH", "TYPE TOROIDAL", "surface 2 (line 24): TYPE TOROIDAL cannot be honoured"),
            ("TYPE EVENASPH", "TYPE COORDBRK", "surface 2 (line 24): TYPE COORDBRK cannot"),
            ("TYPE EVENASPH", "TYPE GRINSUR1", "TYPE GRINSUR1 cannot"),
            ("GLAS N-BK7", "GLAS MIRROR", "surface 1 (line 19): GLAS MIRROR 0 0 1.5 40 cannot"),
            ("CLAP 0 8.5", "CLAP 2 8.5", "CLAP 2 8.5 0 cannot"),
            ("CLAP 0 8.5 0", "SQAP 5 5", "surface 2 (line 31): SQAP 5 5 cannot"),
            ("COAT AR", "COAT GOLD", "COAT GOLD cannot"),
            ("COAT AR", "IGNR 1", "IGNR 1 cannot"),
            ("COAT AR", "WXYZ 1", "WXYZ 1 cannot"),
            ("GLAS N-BK7", "GLAS X-NOPE", "surface 1 (line 13): no glass is called \"X-NOPE\""),
            ("CURV 2.0E-2", "CURV x", "line 16: CURV \"x\" is no number"),
            ("STOP", "COMM no stop", "none of its surfaces is the stop"),
            ("DIAM 4", "DIAM 0", "surface 4 (line 42): a semi-aperture of 0"),
            ("DISZ 40", "DISZ -40", "surface 4 (line 42): a thickness of -40"),
            ("DISZ 40", "DISZ INFINITY", "a thickness of inf"),
            ("DISZ 0\n", "DISZ 0\n  CONI 1\n  CURV -0.02\n", "surface 6 (line 48): an image surface that is not plane"),
            ("SURF 4", "SURF 7", "line 37: SURF 7 follows on SURF 3"),
        ] {
            let error = parse(&LENS.replacen(from, to, 1)).map(|lens| lens.name).unwrap_err().to_string();
            assert!(error.contains(said), "{error:?} does not say {said:?}");
        }
        assert!(parse("SURF 0\n  TYPE STANDARD\n").unwrap_err().to_string().contains("no surfaces between"));
    }

    #[test]
    fn a_stop_may_be_named_before_the_surfaces() {
        let text = LENS.replacen("  STOP\n", "", 1).replacen("ENPD 10", "STOP 5", 1);
        assert_eq!(parse(&text).unwrap().stop_number(), 4);
    }
}
