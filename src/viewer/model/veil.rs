//! What a person does to the veil of a look.

use std::path::Path;

use super::Look;
use crate::choices::{Mix, Projection};
use crate::look::Veil;
use crate::psf::{Fault, Name, Parameters};
use crate::scene::{VeilSection, absolute};

/// What a function that was just chosen scatters at most where it would scatter all of the light, or nearly: those that describe
/// all of it, as an eye's with its core, and those that are given by their shape alone.
const NEARLY_ALL: f64 = 0.99;
const SOME: f64 = 0.1;

/// What functions begin with that need a number, in the look's unit.
const WIDTH: f64 = 0.1;
const WIDTHS: [f64; 2] = [0.02, 0.2];
const TAIL: [f64; 3] = [1e-4, 1e-3, 2.5];
/// The f-number that an iris begins with: its spikes are seen.
const FSTOP: f64 = 16.0;

impl Look {
    /// Takes another function for the veil, with the numbers that it begins with, or none at all. Border, projection and tolerance
    /// stay, as far as they are any of the function's.
    ///
    /// # Errors
    /// A [`Fault`] for a function whose file has to be named: see [`Look::choose_psf_file`].
    pub fn choose_psf(&mut self, name: Option<Name>) -> Result<(), Fault> {
        let Some(name) = name else {
            self.veil = None;
            return Ok(());
        };
        let parameters = Parameters::new(name);
        self.take_psf(match name {
            Name::Gaussian => Parameters { width: Some(WIDTH), ..parameters },
            Name::Mixture => Parameters { widths: Some(WIDTHS.to_vec()), ..parameters },
            Name::Abg => Parameters { a: Some(TAIL[0]), b: Some(TAIL[1]), g: Some(TAIL[2]), ..parameters },
            Name::Starburst => Parameters { fstop: Some(FSTOP), ..parameters },
            _ => parameters,
        })
    }

    /// Takes a function that a file holds, a table or a picture.
    ///
    /// # Errors
    /// A [`Fault`], which says what is wrong with the file.
    pub fn choose_psf_file(&mut self, name: Name, path: &Path) -> Result<(), Fault> {
        let path = Some(absolute(path));
        self.take_psf(match name {
            Name::Kernel => Parameters { kernel: path, ..Parameters::new(name) },
            _ => Parameters { table: path, ..Parameters::new(name) },
        })
    }

    fn take_psf(&mut self, parameters: Parameters) -> Result<(), Fault> {
        let before = self.veil.as_ref().map(Veil::section);
        let (name, adds) = (parameters.psf, self.veil.as_ref().is_some_and(|veil| veil.adds));
        let section = match before {
            Some(before) => VeilSection { parameters, ..before },
            None => VeilSection { parameters, fov: None, projection: None, border: None, tolerance: None },
        };
        let veil = Veil::new(&section, adds)?;
        let planar = veil.projection() == Projection::Planar;
        let mut section = VeilSection {
            projection: section.projection.filter(|_| veil.is_in_degrees()),
            border: section.border.filter(|_| planar || !veil.is_in_degrees()),
            ..section
        };
        let most = veil.psf().energies().into_iter().fold(0.0, f64::max);
        // What leaves a pixel is known where the photo is, and the lens's own scatter is something else.
        if !veil.psf().is_of_pixels() && !adds && self.strength * most >= NEARLY_ALL {
            let all = matches!(name, Name::Cie135 | Name::Spencer);
            // Of the function's mean energy, where its colours differ.
            let share = if all { NEARLY_ALL } else { SOME } / self.strength.max(1.0);
            section.parameters.scatter = Some(share * veil.psf().energy() / most);
        }
        self.veil = Some(veil.changed(&section)?);
        Ok(())
    }

    /// Takes what another section says of the veil that there is.
    ///
    /// # Errors
    /// A [`Fault`], which names the key; the veil stays as it was.
    pub fn change_veil(&mut self, section: &VeilSection) -> Result<(), Fault> {
        if let Some(veil) = &mut self.veil {
            *veil = veil.changed(section)?;
        }
        Ok(())
    }

    /// Lets the photo keep all of its light beside a veil, or lose what is scattered. Only a look whose ghosts are added, too, can
    /// say so.
    pub fn add_veil(&mut self, adds: bool) {
        if let Some(veil) = &mut self.veil {
            veil.adds = adds;
            self.mix = if adds { Mix::Add } else { self.mix };
        }
    }

    /// Sets where the ghosts' light is from; beside light that is taken from the photo no veil is merely added.
    pub fn set_mix(&mut self, mix: Mix) {
        self.mix = mix;
        if let Some(veil) = self.veil.as_mut().filter(|_| mix != Mix::Add) {
            veil.adds = false;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choices::Border;
    use crate::scene::{read_scene, write_scene};

    fn of(name: Name) -> Look {
        let mut look = Look { veil: None, ..Look::default() };
        look.choose_psf(Some(name)).unwrap();
        look
    }

    #[test]
    fn what_is_chosen_can_be_had_at_any_strength() {
        for name in Name::ALL {
            for strength in [0.0, 0.3, 1.0, 10.0] {
                let mut look = Look { strength, veil: None, ..Look::default() };
                let needs_file = matches!(name, Name::Table | Name::Kernel);
                assert_eq!(look.choose_psf(Some(name)).is_err(), needs_file, "{name}");
                let Some(veil) = look.veil.as_ref().filter(|veil| !veil.psf().is_of_pixels()) else { continue };
                let most = veil.psf().energies().into_iter().fold(0.0, f64::max);
                assert!(veil.psf().name() == name && strength * most < 1.0, "{name} at {strength}: {most}");
            }
        }
        // CIE 146 says itself what it scatters.
        assert!((of(Name::Cie).veil.unwrap().psf().energy() - 0.375).abs() < 1e-3);
    }

    #[test]
    fn what_another_function_cannot_have_is_left_behind() {
        let mut look = of(Name::Cie);
        let section = look.veil.as_ref().unwrap().section();
        look.change_veil(&VeilSection { projection: Some(Projection::Fisheye), tolerance: Some(1e-3), ..section })
            .unwrap();
        look.choose_psf(Some(Name::Camera)).unwrap();
        let section = look.veil.as_ref().unwrap().section();
        assert_eq!((section.projection, section.tolerance), (None, Some(1e-3)));
        look.change_veil(&VeilSection { border: Some(Border::Mirror), ..section }).unwrap();
        look.choose_psf(Some(Name::Gaussian)).unwrap();
        assert_eq!(look.veil.as_ref().unwrap().border, Border::Mirror);
        look.choose_psf(Some(Name::Cie)).unwrap();
        assert_eq!(look.veil.as_ref().unwrap().border, Border::None);
        look.choose_psf(None).unwrap();
        assert_eq!(look, Look { veil: None, ..Look::default() });
    }

    #[test]
    fn what_cannot_be_leaves_the_veil_as_it_was() {
        let mut look = of(Name::Abg);
        let (before, section) = (look.clone(), look.veil.as_ref().unwrap().section());
        let parameters = Parameters { g: Some(1.5), ..section.parameters.clone() };
        let fault = look.change_veil(&VeilSection { parameters, ..section }).unwrap_err();
        assert_eq!((fault.key, &look), ("end", &before));
    }

    #[test]
    fn a_table_is_read_once_and_scattered_anew() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("halo.csv");
        std::fs::write(&path, "0.01,1\n0.1,0.1\n1,0.001\n").unwrap();
        let mut look = Look::default();
        look.choose_psf_file(Name::Table, &path).unwrap();
        assert!((look.veil.as_ref().unwrap().psf().energy() - SOME).abs() < 1e-9);
        std::fs::remove_file(&path).unwrap();
        let section = look.veil.as_ref().unwrap().section();
        let parameters = Parameters { scatter: Some(0.25), ..section.parameters.clone() };
        look.change_veil(&VeilSection { parameters, tolerance: Some(1e-3), ..section }).unwrap();
        let veil = look.veil.as_ref().unwrap();
        assert!((veil.psf().energy() - 0.25).abs() < 1e-9 && veil.tolerance() == 1e-3);
        let gone = look.choose_psf_file(Name::Kernel, &folder.path().join("none.exr")).unwrap_err();
        assert!(gone.key == "kernel" && gone.in_words().contains("none.exr"), "{gone}");
    }

    #[test]
    fn a_veil_that_is_added_is_so_after_it_was_saved() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("look.toml");
        let mut look = of(Name::Cie);
        look.set_mix(Mix::Energy);
        look.add_veil(true);
        write_scene(&path, &look.to_scene(), true).unwrap();
        assert_eq!(Look::from_scene(read_scene(&path).unwrap()).unwrap(), look);
        look.set_mix(Mix::Energy);
        write_scene(&path, &look.to_scene(), true).unwrap();
        assert_eq!(Look::from_scene(read_scene(&path).unwrap()).unwrap(), look);
    }
}
