//! The lens tables of pbrt (Pharr, Jakob and Humphreys, Physically Based Rendering, §6.4): a surface in each line, from the
//! scene to the film, with radius, thickness, index behind it and aperture diameter, in mm.
//!
//! A radius of 0 is a plane, and one between air and air the stop; an index of 0 is that of air.

use super::number;
use crate::optics::coating::Coating;
use crate::optics::error::{OpticsError, Result};
use crate::optics::glass::Glass;
use crate::optics::prescription::{Iris, Origin, Prescription, Surface};

pub(super) fn parse(text: &str, origin: &mut Origin) -> Result<Prescription> {
    let mut comments = Vec::new();
    let mut surfaces: Vec<Surface> = Vec::new();
    for (line, words) in (1..).zip(text.lines()) {
        let (columns, comment) = words.split_once('#').unwrap_or((words, ""));
        comments.extend((surfaces.is_empty() && !comment.trim().is_empty()).then(|| comment.trim()));
        if columns.trim().is_empty() {
            continue;
        }
        let before_is_air = surfaces.last().is_none_or(|surface| surface.glass.is_air());
        surfaces.push(surface(columns, before_is_air, line, origin)?);
        origin.lines.push(line);
    }
    // pbrt finds the film's place itself, and so it is done here.
    if let Some(last) = surfaces.last_mut() {
        last.thickness = None;
    }
    Ok(Prescription {
        name: comments.first().copied().unwrap_or_default().to_owned(),
        description: comments.get(1..).unwrap_or_default().join(" "),
        patent: None,
        focal_length: None,
        f_number: None,
        field: None,
        coating: Coating::None,
        iris: Iris::default(),
        surfaces,
        settings: Vec::new(),
        notes: vec![
            "a table of pbrt has no Abbe numbers: dispersion is off".to_owned(),
            "a table of pbrt has no coatings: all surfaces are bare".to_owned(),
            "the sensor is in the paraxial focus, whatever the last thickness says, as in pbrt".to_owned(),
        ],
    })
}

fn surface(columns: &str, before_is_air: bool, line: usize, origin: &Origin) -> Result<Surface> {
    let words: Vec<_> = columns.split_whitespace().collect();
    let [radius, thickness, index, diameter] = words[..] else {
        let reason = format!("{} numbers; a surface has 4: radius, thickness, index, aperture diameter", words.len());
        return Err(OpticsError::Line { file: origin.file.clone(), line, reason });
    };
    let number = |word, what| number(word, what, line, origin);
    let (radius, index) = (number(radius, "the radius")?, number(index, "the index")?);
    let glass = if index == 0.0 || index == 1.0 { Glass::air() } else { Glass::model(index, None) };
    Ok(Surface {
        radius: (radius != 0.0).then_some(radius),
        thickness: Some(number(thickness, "the thickness")?),
        semi_aperture: 0.5 * number(diameter, "the aperture diameter")?,
        conic: 0.0,
        coating: None,
        stop: radius == 0.0 && before_is_air && glass.is_air(),
        label: None,
        glass,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str =
        "# Singlet\n# by hand\n# radius sep n aperture\n50 4 1.5168 20\n\n0 2 1 20 # a plane\n0 90 0 10\n";

    fn parse(text: &str) -> Result<Prescription> {
        Prescription::parse(text.as_bytes(), "lens.dat")
    }

    #[test]
    fn a_table_is_read_with_its_stop_and_without_dispersion() {
        let lens = parse(TABLE).unwrap();
        assert_eq!((lens.name.as_str(), lens.description.as_str()), ("Singlet", "by hand radius sep n aperture"));
        assert_eq!(lens.surfaces.len(), 3);
        assert_eq!((lens.surfaces[0].radius, lens.surfaces[0].semi_aperture), (Some(50.0), 10.0));
        assert_eq!(lens.surfaces[0].glass, Glass::model(1.5168, None));
        assert_eq!(lens.surfaces.iter().map(|surface| surface.stop).collect::<Vec<_>>(), [false, false, true]);
        assert_eq!(lens.surfaces[2].thickness, None);
        assert!(lens.notes[0].contains("dispersion is off"));
        assert_eq!(parse(&TABLE[TABLE.find("50").unwrap()..]).unwrap().name, "lens");
    }

    #[test]
    fn mistakes_are_told_with_their_line() {
        for (from, to, said) in [
            ("50 4 1.5168 20", "50 4 1.5168", "lens.dat, line 4: 3 numbers; a surface has 4"),
            ("50 4 1.5168 20", "50 4 1.5168 x", "lens.dat, line 4: the aperture diameter \"x\" is no number"),
            ("50 4 1.5168 20", "50 inf 1.5168 20", "line 4: the thickness \"inf\" is no number"),
            ("0 90 0 10", "0 90 0 -1", "surface 3 (line 7): a semi-aperture of -0.5"),
            ("0 90 0 10", "9 90 0 1", "none of its surfaces is the stop"),
            ("50 4 1.5168 20", "0 4 1 20", "surfaces [1, 2, 3] are all the stop"),
            ("50 4 1.5168 20", "50 4 0.7 20", "surface 1 (line 4): an index of 0.7"),
        ] {
            let error = parse(&TABLE.replacen(from, to, 1)).unwrap_err().to_string();
            assert!(error.contains(said), "{error:?} does not say {said:?}");
        }
    }
}
