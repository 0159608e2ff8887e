//! Looks as scene files, and back.

use super::{Accuracy, Look, LookLens, LookLights, Shared, Veil};
use crate::choices::{LengthUnit, Mix, Sources};
use crate::scene::presets::{self, DEFAULT_PRESET, NO_LENS};
use crate::scene::{AccuracySection, FindOptions, FindSection, LookSection, Optical, SceneFile, VeilSection, Version};
use crate::{Error, Result};

impl Look {
    /// The look that a scene file describes. What one of version 2 leaves open is as by default; what it lists, lights, ghosts or a lens
    /// of its own, has no veil unless it names one. What one of version 1 leaves open is as it was then: lights that are found by
    /// [`FindOptions::VERSION_1`], and lengths in [`LengthUnit::OF_FILES`].
    ///
    /// # Errors
    /// [`Error::UnknownPreset`] for a preset that there is not, which no file that was read names; [`Error::Usage`] for a veil that
    /// cannot be had, as where a file that it names is gone.
    pub fn from_scene(scene: SceneFile) -> Result<Self> {
        // Ghosts alone are the whole scene: nothing then is looked for in the photo.
        let ghosts_only = !scene.ghosts.is_empty() && scene.lens_ghosts.is_empty() && scene.preset.is_none();
        let lists = scene.lights.is_some() || !scene.ghosts.is_empty() || !scene.lens_ghosts.is_empty();
        let sources = scene.look.sources.unwrap_or(match scene.version {
            Version::One => Sources::Lights,
            // Who counts lights means lights.
            Version::Two if scene.find.max_lights.is_some() || ghosts_only => Sources::Lights,
            Version::Two if scene.lights.is_some() && !scene.find.add => Sources::Lights,
            Version::Two => Sources::Photo,
        });
        let lights = match scene.lights {
            lights if sources == Sources::Photo => LookLights::Photo(lights.unwrap_or_default().into()),
            Some(lights) if scene.find.add && !lights.is_empty() => LookLights::FoundAnd(lights.into()),
            Some(_) | None if scene.find.add => LookLights::Found,
            Some(lights) => LookLights::Listed(lights.into()),
            None if ghosts_only => LookLights::Listed(Shared::default()),
            None => LookLights::Found,
        };
        let lens = match scene.preset {
            Some(name) => LookLens::preset(&name)?,
            None if scene.optics.is_some() => LookLens::Optical(Optical::new(scene.optics.unwrap_or_default())?),
            None if scene.lens_ghosts.is_empty() => {
                LookLens::Preset(presets::named_in(scene.version, DEFAULT_PRESET)?.into())
            }
            None => LookLens::Own(scene.lens_ghosts.into()),
        };
        let LookSection { strength, size, tint, mix, normalize, unit, fov, sources: _, recover } = scene.look;
        let AccuracySection { goal, allow_floor, each_pixel, evaluator } = scene.accuracy;
        let of_veil = scene.veil.as_ref().and_then(|veil| veil.fov);
        if let (Some(one), Some(other)) = (fov, of_veil)
            && one != other
        {
            return Err(Error::Usage(format!("the scene says that the picture spans {one}° and {other}°")));
        }
        let adds = mix == Some(Mix::Add);
        let by_version = scene.find.options(scene.version);
        let (veil, of_lens) = match scene.veil {
            None if scene.no_veil => (None, None),
            None if lists && scene.version == Version::Two => (None, None),
            None => {
                (lens.veil().map(|veil| Veil::new(&veil.section, adds)), lens.veil().and_then(|veil| veil.section.fov))
            }
            Some(veil) => (Some(Veil::new(&veil, adds)), None),
        };
        let veil = veil.transpose().map_err(|fault| Error::Usage(format!("the scene's veil: {fault}")))?;
        Ok(Self {
            description: scene.description,
            lens,
            unit: unit.unwrap_or(match scene.version {
                Version::One => LengthUnit::OF_FILES,
                Version::Two => LengthUnit::ShortSide,
            }),
            fov: fov.or(of_veil).or(of_lens),
            axis: scene.axis.unwrap_or_default(),
            size: size.unwrap_or(1.0),
            tint: tint.unwrap_or([1.0; 3]),
            lights,
            ghosts: scene.ghosts.into(),
            find: FindOptions { recover: recover.unwrap_or(by_version.recover), ..by_version },
            strength: strength.unwrap_or(1.0),
            veil,
            mix: mix.unwrap_or_default(),
            normalize: normalize.unwrap_or_default(),
            accuracy: Accuracy {
                goal: goal.unwrap_or_default(),
                allow_floor,
                each_pixel,
                degree: scene.degree,
                period: scene.period,
                evaluator,
            },
        })
    }

    /// The scene file that describes the look, with every value spelt out. The lens of a file becomes a table of the
    /// scene's own.
    pub fn to_scene(&self) -> SceneFile {
        #[rustfmt::skip]
        let Self {
            description, lens, unit, fov, axis, size, tint, lights, ghosts, find, strength, veil, mix, normalize, accuracy,
        } = self;
        let mut optics = None;
        let (preset, lens_ghosts) = match lens {
            LookLens::Preset(lens) => (Some(lens.name.clone()), Vec::new()),
            LookLens::Optical(optical) => {
                optics = Some(optical.section().clone());
                (None, Vec::new())
            }
            // Ghosts in whose place there is a veil.
            LookLens::File(_, lens) if self.lens_ghosts().len() < lens.ghosts.len() => {
                (Some(NO_LENS.to_owned()), Vec::new())
            }
            LookLens::File(_, lens) => (None, lens.ghosts.clone()),
            LookLens::Own(ghosts) => (None, ghosts.to_vec()),
        };
        let listed = match lights {
            LookLights::Found => None,
            LookLights::Photo(lights) if lights.is_empty() => None,
            LookLights::Listed(lights) | LookLights::FoundAnd(lights) | LookLights::Photo(lights) => {
                Some(lights.to_vec())
            }
        };
        let add = matches!(lights, LookLights::FoundAnd(_));
        let sources = if matches!(lights, LookLights::Photo(_)) { Sources::Photo } else { Sources::Lights };
        let Accuracy { goal, allow_floor, each_pixel, degree, period, evaluator } = *accuracy;
        let FindOptions { by, threshold, merge, shape, max_lights, beyond, firefly_limit, knee, recover } = *find;
        SceneFile {
            version: Version::Two,
            description: description.clone(),
            preset,
            optics,
            axis: Some(*axis),
            period,
            degree,
            look: LookSection {
                strength: Some(*strength),
                size: Some(*size),
                tint: Some(*tint),
                // To say of a veil that it is added is to say more than nothing.
                mix: veil.as_ref().is_none_or(|veil| veil.adds || *mix != Mix::Add).then_some(*mix),
                normalize: Some(*normalize),
                unit: Some(*unit),
                fov: if veil.is_some() { None } else { *fov },
                sources: Some(sources),
                recover: Some(recover),
            },
            find: FindSection {
                by: Some(by),
                threshold,
                merge: Some(merge),
                shape: Some(shape),
                max_lights: Some(max_lights),
                beyond: Some(beyond),
                firefly_limit: Some(firefly_limit),
                knee: Some(knee),
                add,
            },
            accuracy: AccuracySection { goal: Some(goal), allow_floor, each_pixel, evaluator },
            veil: veil.as_ref().map(|veil| VeilSection { fov: *fov, ..veil.section() }),
            no_veil: veil.is_none(),
            lights: listed,
            ghosts: ghosts.to_vec(),
            lens_ghosts,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::choices::{Beyond, Evaluator, LightBy, LightShape, Normalize};
    use crate::psf::{Name, Parameters};
    use crate::scene::{Ghost, Goal, Lens, Light, Recover, presets, read_scene, write_scene};
    use crate::series::Bell;

    fn through_a_file(look: &Look) -> Look {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("look.toml");
        write_scene(&path, &look.to_scene(), false).unwrap();
        Look::from_scene(read_scene(&path).unwrap()).unwrap()
    }

    #[test]
    fn a_look_comes_back_from_its_file() {
        let light = Light { position: DVec2::new(2.5, -0.1), flux: [0.1, 0.2, 0.3], size: 0.1, muted: true };
        let (bell, size) = (Bell::Gaussian, DVec2::new(0.1, 0.3));
        let ghost = Ghost { bell, center: DVec2::ONE, size, radiance: [1.0, -1.0, 0.0] };
        let Lens { ghosts: table, .. } = presets::named("zoom").unwrap();
        let full = Look {
            description: "all of it".into(),
            lens: LookLens::Own(table.into()),
            unit: LengthUnit::Diagonal,
            fov: Some(40.5),
            axis: DVec2::new(0.1, 0.2),
            size: 0.7,
            tint: [1.0, 0.3, 0.0],
            lights: LookLights::Listed(vec![light].into()),
            ghosts: vec![ghost.clone()].into(),
            find: FindOptions {
                by: LightBy::Luminance,
                threshold: Some(3.5),
                merge: 0.1,
                shape: LightShape::Ball,
                max_lights: 5,
                beyond: Beyond::Drop,
                firefly_limit: 20.0,
                knee: 0.5,
                recover: Recover::Stops(3.5),
            },
            strength: 1.7,
            veil: None,
            mix: Mix::Energy,
            normalize: Normalize::None,
            accuracy: Accuracy {
                goal: Goal::Tolerance(1.0 / 800.0),
                allow_floor: true,
                each_pixel: true,
                degree: Some([0, 12]),
                period: Some(DVec2::new(4.0, 3.0)),
                evaluator: Some(Evaluator::Grid),
            },
        };
        let none = Look { lights: LookLights::Listed(Shared::default()), ..Look::default() };
        // Without the preset's name the ghost would be the whole scene.
        let ghost_and_photo = Look { ghosts: vec![ghost].into(), ..Look::default() };
        let found = Look { lights: LookLights::Found, ..Look::default() };
        let added = Look { lights: LookLights::FoundAnd(vec![light].into()), ..Look::default() };
        let beside = Look { lights: LookLights::Photo(vec![light].into()), ..Look::default() };
        let old = Look { lens: LookLens::preset("v1/zoom").unwrap(), find: FindOptions::VERSION_1, ..found.clone() };
        let section = VeilSection {
            parameters: Parameters { age: Some(60.0), ..Parameters::new(Name::Cie) },
            fov: None,
            projection: None,
            border: None,
            tolerance: Some(0.02),
        };
        let veiled = |adds| {
            let veil = Some(Veil::new(&section, adds).unwrap());
            Look { veil, fov: Some(50.0), unit: LengthUnit::Degrees, ..Look::default() }
        };
        let eye = Look::default().through(LookLens::preset("eye").unwrap(), false).unwrap();
        let without = Look { veil: None, ..eye.clone() };
        assert!(eye.lens_ghosts().is_empty() && eye.veil.is_some());
        let looks = [Look::default(), full.clone(), none, ghost_and_photo, found, added, beside, old];
        for look in looks.into_iter().chain([veiled(false), veiled(true), eye, without]) {
            assert_eq!(through_a_file(&look), look);
        }
        let filed =
            Look { lens: LookLens::File("lens.toml".into(), presets::named("zoom").unwrap().into()), ..full.clone() };
        assert_eq!(through_a_file(&filed), full);
    }

    #[test]
    fn ghosts_alone_are_the_whole_scene() {
        let ghost = Ghost { bell: Bell::Gaussian, center: DVec2::ZERO, size: DVec2::ONE, radiance: [1.0; 3] };
        let look = Look::from_scene(SceneFile { ghosts: vec![ghost.clone()], ..SceneFile::default() }).unwrap();
        assert_eq!((&look.lights, look.ghosts(&[])), (&LookLights::Listed(Shared::default()), vec![ghost]));
        assert_eq!(through_a_file(&look), look);
    }

    #[test]
    fn an_empty_file_is_the_default_look_of_its_version() {
        assert_eq!(Look::from_scene(SceneFile::default()).unwrap(), Look::default());
        let look = Look {
            lens: LookLens::preset("v1/classic-prime").unwrap(),
            unit: LengthUnit::Height,
            lights: LookLights::Found,
            find: FindOptions::VERSION_1,
            veil: None,
            ..Look::default()
        };
        assert_eq!(Look::from_scene(SceneFile { version: Version::One, ..SceneFile::default() }).unwrap(), look);
        assert_eq!(through_a_file(&look), look);
    }

    #[test]
    fn what_a_file_lists_is_all_there_is() {
        let light = Light { position: DVec2::ONE, flux: [1.0; 3], size: 0.0, muted: false };
        let ghost = Ghost { bell: Bell::Gaussian, center: DVec2::ZERO, size: DVec2::ONE, radiance: [1.0; 3] };
        let veiled = SceneFile { preset: Some("eye".into()), ..SceneFile::default() };
        let read = |scene: SceneFile| Look::from_scene(scene).unwrap();
        assert!(read(veiled.clone()).veil.is_some());
        let look = read(SceneFile { lights: Some(vec![light]), ..veiled.clone() });
        assert_eq!((look.lights, look.veil), (LookLights::Listed(vec![light].into()), None));
        let look = read(SceneFile { ghosts: vec![ghost.clone()], ..SceneFile::default() });
        assert_eq!((look.lights, look.veil), (LookLights::Listed(Shared::default()), None));
        // A lens that is named beside them is one of the photo.
        let look = read(SceneFile { ghosts: vec![ghost], ..veiled.clone() });
        assert_eq!((look.lights, look.veil), (LookLights::Photo(Shared::default()), None));
        let own = presets::named("zoom").unwrap().ghosts;
        let look = read(SceneFile { lens_ghosts: own, ..SceneFile::default() });
        assert_eq!((look.lights, look.veil), (LookLights::Photo(Shared::default()), None));
        // Who names a veil has it.
        let section = look_veil();
        let look = read(SceneFile { lights: Some(vec![light]), veil: Some(section), ..veiled.clone() });
        assert!(look.veil.is_some());
        // Beside what is in the photo, which are its pixels unless lights are counted.
        let find = FindSection { add: true, ..FindSection::default() };
        let adds = SceneFile { lights: Some(vec![light]), find, ..SceneFile::default() };
        assert_eq!(read(adds.clone()).lights, LookLights::Photo(vec![light].into()));
        let counted = FindSection { max_lights: Some(7), ..find };
        assert_eq!(read(SceneFile { find: counted, ..adds }).lights, LookLights::FoundAnd(vec![light].into()));
        assert_eq!(read(SceneFile { find: counted, ..SceneFile::default() }).lights, LookLights::Found);
        let knee = FindSection { threshold: Some(7.0), ..FindSection::default() };
        assert_eq!(read(SceneFile { find: knee, ..SceneFile::default() }).lights, Look::default().lights);
    }

    fn look_veil() -> VeilSection {
        Look::default().through(LookLens::preset("eye").unwrap(), false).unwrap().veil.unwrap().section()
    }

    #[test]
    fn a_file_adds_its_lights_to_the_photos() {
        let light = Light { position: DVec2::ONE, flux: [1.0; 3], size: 0.0, muted: false };
        let file = |lights| SceneFile {
            version: Version::One,
            find: FindSection { add: true, ..FindSection::default() },
            lights,
            ..SceneFile::default()
        };
        let look = Look::from_scene(file(Some(vec![light]))).unwrap();
        assert_eq!(look.lights, LookLights::FoundAnd(vec![light].into()));
        let found = Light { flux: [2.0; 3], ..light };
        assert_eq!((&*look.lights(&[found]), look.searches()), (&[found, light][..], true));
        for nothing in [None, Some(Vec::new())] {
            assert_eq!(Look::from_scene(file(nothing)).unwrap().lights, LookLights::Found);
        }
    }

    #[test]
    fn lights_are_added_to_what_there_is() {
        let light = Light { position: DVec2::ONE, flux: [1.0; 3], size: 0.0, muted: false };
        let added = |lights| {
            let mut look = Look { lights, ..Look::default() };
            look.add_lights(vec![light]);
            look.lights
        };
        assert_eq!(added(LookLights::Found), LookLights::FoundAnd(vec![light].into()));
        assert_eq!(added(LookLights::FoundAnd(vec![light].into())), LookLights::FoundAnd(vec![light; 2].into()));
        assert_eq!(added(LookLights::Listed(Shared::default())), LookLights::Listed(vec![light].into()));
    }
}
