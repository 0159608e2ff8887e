//! vglare's own lens files. Every table refuses keys that it does not know.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use crate::optics::coating::Coating;
use crate::optics::error::{OpticsError, Result};
use crate::optics::glass::Glass;
use crate::optics::prescription::{Iris, Origin, Prescription, Setting, Surface};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LensTable {
    #[serde(default)]
    name: String,
    #[serde(default)]
    description: String,
    patent: Option<String>,
    focal_length: Option<f64>,
    f_number: Option<f64>,
    field: Option<f64>,
    #[serde(default)]
    coating: Coating,
    blades: Option<u32>,
    #[serde(default)]
    rotation: f64,
    #[serde(default)]
    roundness: f64,
    #[serde(default, rename = "surface")]
    surfaces: Vec<Spanned<SurfaceTable>>,
    #[serde(default, rename = "setting")]
    settings: Vec<SettingTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SurfaceTable {
    radius: Option<f64>,
    thickness: Option<f64>,
    glass: Option<String>,
    index: Option<f64>,
    abbe: Option<f64>,
    semi_aperture: f64,
    #[serde(default)]
    conic: f64,
    coating: Option<Coating>,
    #[serde(default)]
    stop: bool,
    label: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SettingTable {
    name: String,
    focal_length: Option<f64>,
    f_number: Option<f64>,
    #[serde(default)]
    thickness: BTreeMap<String, f64>,
}

pub(super) fn parse(text: &str, origin: &mut Origin) -> Result<Prescription> {
    let line_of = |byte: usize| 1 + text.as_bytes().iter().take(byte).filter(|&&byte| byte == b'\n').count();
    let table: LensTable = toml::from_str(text).map_err(|error| OpticsError::Line {
        file: origin.file.clone(),
        line: error.span().map_or(1, |span| line_of(span.start)),
        reason: error.message().trim_end().to_owned(),
    })?;
    origin.lines = table.surfaces.iter().map(|surface| line_of(surface.span().start)).collect();
    let tables = table.surfaces.into_iter().map(Spanned::into_inner);
    let surfaces = tables.enumerate().map(|(index, table)| table.surface(index, origin)).collect::<Result<_>>()?;
    let settings = table.settings.into_iter().map(|setting| setting.setting(origin)).collect::<Result<_>>()?;
    Ok(Prescription {
        name: table.name,
        description: table.description,
        patent: table.patent,
        focal_length: table.focal_length,
        f_number: table.f_number,
        field: table.field,
        coating: table.coating,
        iris: Iris { blades: table.blades, rotation: table.rotation, roundness: table.roundness },
        surfaces,
        settings,
        notes: Vec::new(),
    })
}

impl SurfaceTable {
    fn surface(self, index: usize, origin: &Origin) -> Result<Surface> {
        let glass = match (&self.glass, self.index, self.abbe) {
            (Some(name), None, None) => origin.glass(index, name)?,
            (None, Some(refractive), abbe) => Glass::model(refractive, abbe),
            (None, None, None) => Glass::air(),
            (Some(_), ..) => {
                return Err(origin.surface(index, "it has a glass, and an index or an Abbe number besides"));
            }
            (None, None, Some(_)) => return Err(origin.surface(index, "it has an Abbe number without an index")),
        };
        Ok(Surface {
            radius: self.radius,
            thickness: self.thickness,
            glass,
            semi_aperture: self.semi_aperture,
            conic: self.conic,
            coating: self.coating,
            stop: self.stop,
            label: self.label,
        })
    }
}

impl SettingTable {
    fn setting(self, origin: &Origin) -> Result<Setting> {
        let numbered = |(key, thickness): (String, f64)| match key.parse::<usize>() {
            Ok(number) => Ok((number, thickness)),
            Err(_) => Err(origin.lens(format!("the setting {:?}: {key:?} is no surface's number", self.name))),
        };
        let thickness = self.thickness.into_iter().map(numbered).collect::<Result<_>>()?;
        Ok(Setting { name: self.name, focal_length: self.focal_length, f_number: self.f_number, thickness })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENS: &str = r#"
name = "Test"
description = "a lens"
patent = "US 1"
focal_length = 50.0
f_number = 2
field = 22.0
coating = "mgf2"
blades = 6
rotation = 10

[[surface]]
radius = 29.475
thickness = 3.76
glass = "n-bk7"
semi_aperture = 12.6
coating = "none"

[[surface]]
thickness = 6.0
index = 1.67
abbe = 48.4
semi_aperture = 12
label = "back"

[[surface]]
stop = true
semi_aperture = 9.0

[[setting]]
name = "tele"
focal_length = 80
thickness = { "1" = 4.0, "3" = 40 }
"#;

    fn parse(text: &str) -> Result<Prescription> {
        Prescription::parse(text.as_bytes(), "lens.toml")
    }

    #[test]
    fn everything_that_a_file_may_say_is_read() {
        let lens = parse(LENS).unwrap();
        assert_eq!((lens.name.as_str(), lens.patent.as_deref(), lens.f_number), ("Test", Some("US 1"), Some(2.0)));
        assert_eq!((&lens.coating, lens.iris.blades, lens.iris.rotation), (&Coating::MgF2, Some(6), 10.0));
        let [front, back, stop] = &lens.surfaces[..] else { panic!("{:?}", lens.surfaces) };
        assert_eq!((front.glass.name.as_str(), front.coating.as_ref()), ("N-BK7", Some(&Coating::None)));
        assert_eq!((back.radius, &back.glass), (None, &Glass::model(1.67, Some(48.4))));
        assert_eq!((stop.stop, stop.thickness, stop.glass.is_air(), lens.stop_number()), (true, None, true, 3));
        assert_eq!(lens.settings[0].thickness, BTreeMap::from([(1, 4.0), (3, 40.0)]));
    }

    #[test]
    fn mistakes_are_told_with_their_line_and_surface() {
        for (from, to, said) in [
            ("rotation = 10", "rotate = 10", "lens.toml, line 10: unknown field `rotate`"),
            ("thickness = 3.76", "thicknes = 3.76", "lens.toml, line 14: unknown field `thicknes`"),
            ("thickness = 3.76", "thickness = 'x'", "lens.toml, line 14: invalid type"),
            ("thickness = 3.76", "thickness = nan", "lens.toml, surface 1 (line 12): a thickness of NaN"),
            ("radius = 29.475", "radius = 0.0", "lens.toml, surface 1 (line 12): a radius of 0"),
            ("semi_aperture = 12\n", "semi_aperture = 0\n", "surface 2 (line 19): a semi-aperture of 0"),
            ("semi_aperture = 12\n", "\n", "line 19: missing field `semi_aperture`"),
            ("abbe = 48.4", "glass = 'F2'", "surface 2 (line 19): it has a glass, and an index"),
            ("index = 1.67", "", "surface 2 (line 19): it has an Abbe number without an index"),
            ("\"n-bk7\"", "\"n-bk77\"", "no glass is called \"n-bk77\"; the nearest are N-BK7"),
            ("\"mgf2\"", "\"gold\"", "lens.toml, line 8: invalid value: string \"gold\""),
            ("\"3\" = 40", "\"x\" = 40", "\"x\" is no surface's number"),
            ("\"3\" = 40", "\"9\" = 40", "there is no surface 9"),
            ("stop = true", "", "none of its surfaces is the stop"),
            ("name = \"Test\"", "name = ", "lens.toml, line 2: "),
        ] {
            let error = parse(&LENS.replacen(from, to, 1)).unwrap_err().to_string();
            assert!(error.contains(said), "{error:?} does not say {said:?}");
        }
    }
}
