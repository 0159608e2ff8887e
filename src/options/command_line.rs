//! The command line that does what the window does.

use std::path::Path;

use glam::DVec2;

use crate::choices::Sources;
use crate::look::{Accuracy, Look, LookLens, LookLights, Shared, Veil};
use crate::scene::{FindOptions, Goal, NO_VEIL, OpticsSection, VeilSection};
use crate::{Error, Result};

/// The `vglare apply` that lays `look` over `photo` and writes `output`, quoted for a POSIX shell: with an option for
/// whatever is not as by default, or, where options cannot say it all, with `file`, which must hold the look.
///
/// # Errors
/// [`Error::Usage`] where the look needs a file and there is none, and for a path that no command line can have.
pub fn command_line(look: &Look, photo: &Path, output: &Path, file: Option<&Path>) -> Result<String> {
    let mut words = vec!["vglare".into(), "apply".into(), word(photo)?, "-o".into(), word(output)?];
    match file {
        _ if !needs_file(look) => words.extend(options(look)?),
        Some(file) => words.extend(["--scene".into(), word(file)?]),
        None => {
            let reason = "lights, ghosts, a veil or a lens by hand need a file: save the look first";
            return Err(Error::Usage(reason.into()));
        }
    }
    let refused = |error| Error::Usage(format!("no command line can say this: {error}"));
    shlex::try_join(words.iter().map(String::as_str)).map_err(refused)
}

/// Whether there are no options that say the same.
fn needs_file(look: &Look) -> bool {
    // A veil has many options, and a file says them all.
    matches!(look.lens, LookLens::Own(_))
        || (look.veil.is_some() && !has_veil_of_lens(look))
        || !(look.lights == LookLights::Found || look.lights == LookLights::Photo(Shared::default()))
        || !look.ghosts.is_empty()
}

/// Whether the veil is the one that the lens brings along, as exact as options have it.
fn has_veil_of_lens(look: &Look) -> bool {
    // A tolerance is one of all glare on a command line.
    let asked = match look.accuracy.goal {
        Goal::Tolerance(tolerance) if look.accuracy.goal != Goal::default() => Some(tolerance),
        _ => None,
    };
    let of_lens = look
        .lens
        .veil()
        .map(|veil| VeilSection { tolerance: asked.or(veil.section.tolerance), ..veil.section.clone() });
    look.veil == of_lens.and_then(|section| Veil::new(&section, false).ok())
}

/// A path as a word that is no option.
fn word(path: &Path) -> Result<String> {
    let text = path.to_str().ok_or_else(|| Error::Usage(format!("the name {} is no text", path.display())))?;
    Ok(if text.starts_with('-') { format!("./{text}") } else { text.to_owned() })
}

/// The options for what is not as by default.
fn options(look: &Look) -> Result<Vec<String>> {
    let default = Look::default();
    let mut options = Options::default();
    // All fields by name: one that is added does not compile until it is an option, or said by a file.
    #[rustfmt::skip]
    let Look {
        description: _, lens, unit, fov, axis, size, tint, lights, ghosts: _, find, strength, veil, mix, normalize, accuracy,
    } = look;
    match lens {
        LookLens::File(path, _) => options.add("--lens", word(path)?),
        LookLens::Preset(preset) if *lens != default.lens => options.add("--preset", &preset.name),
        LookLens::Optical(optical) => of_optics(&mut options, optical.section())?,
        LookLens::Preset(_) | LookLens::Own(_) => {}
    }
    // A lens brings its veil along.
    if lens.veil().is_some() && veil.is_none() {
        options.add("--veil", NO_VEIL);
    }
    // The rules for lights below mean lights, too, where they are other than by default.
    if !matches!(lights, LookLights::Photo(_)) {
        options.add("--sources", name(Sources::Lights));
    }
    options.changed("--unit", *unit, default.unit, name);
    options.given("--fov", *fov, |fov| fov.to_string());
    options.changed("--axis", *axis, default.axis, pair);
    let FindOptions { by, threshold, merge, shape, max_lights, beyond, firefly_limit, knee, recover } = *find;
    options.changed("--by", by, default.find.by, name);
    options.given("--threshold", threshold, |x| x.to_string());
    options.changed("--merge", merge, default.find.merge, |x| x.to_string());
    options.changed("--shape", shape, default.find.shape, name);
    // Beside pixels a number of lights means nothing, and no command line can say it.
    if !matches!(lights, LookLights::Photo(_)) {
        options.changed("--max-lights", max_lights, default.find.max_lights, |n| n.to_string());
    }
    options.changed("--beyond", beyond, default.find.beyond, name);
    options.changed("--firefly-limit", firefly_limit, default.find.firefly_limit, |x| x.to_string());
    options.changed("--knee", knee, default.find.knee, |x| x.to_string());
    options.changed("--recover", recover, default.find.recover, |recover| recover.to_string());
    options.changed("--strength", *strength, default.strength, |x| x.to_string());
    options.changed("--size", *size, default.size, |x| x.to_string());
    options.changed("--tint", *tint, default.tint, |[r, g, b]| format!("{r},{g},{b}"));
    options.changed("--mix", *mix, default.mix, name);
    options.changed("--normalize", *normalize, default.normalize, name);
    let Accuracy { goal, allow_floor, each_pixel, degree, period, evaluator } = *accuracy;
    match goal {
        Goal::Tolerance(_) if goal == default.accuracy.goal => {}
        Goal::Tolerance(tolerance) => options.add("--tolerance", tolerance),
        Goal::Budget(budget) => options.add("--budget", budget),
    }
    if allow_floor {
        options.0.push("--allow-floor".into());
    }
    if each_pixel {
        options.0.push("--each-pixel".into());
    }
    options.given("--degree", degree, |[n, m]| format!("{n},{m}"));
    options.given("--period", period, pair);
    options.given("--evaluator", evaluator, |evaluator| evaluator.to_string());
    Ok(options.0)
}

/// The options for a lens that is known by its surfaces.
fn of_optics(options: &mut Options, section: &OpticsSection) -> Result<()> {
    let OpticsSection { lens, file, fstop, focus, sensor, blades, coating, setting } = section.clone();
    match (lens, file) {
        (Some(name), _) => options.add("--lens", name),
        (None, file) => options.add("--lens", word(&file.unwrap_or_default())?),
    }
    options.given("--fstop", fstop, |x| x.to_string());
    options.given("--focus", focus, |x| x.to_string());
    options.given("--sensor", sensor, |[width, height]| format!("{width}x{height}"));
    options.given("--blades", blades, |x| x.to_string());
    options.given("--coating", coating, |x| x);
    options.given("--setting", setting, |x| x);
    Ok(())
}

#[derive(Default)]
struct Options(Vec<String>);

impl Options {
    fn add(&mut self, option: &str, value: impl ToString) {
        self.0.extend([option.to_owned(), value.to_string()]);
    }

    fn given<T>(&mut self, option: &str, value: Option<T>, text: impl FnOnce(T) -> String) {
        if let Some(value) = value {
            self.add(option, text(value));
        }
    }

    fn changed<T: PartialEq>(&mut self, option: &str, value: T, default: T, text: impl FnOnce(T) -> String) {
        self.given(option, (value != default).then_some(value), text);
    }
}

fn pair(DVec2 { x, y }: DVec2) -> String {
    format!("{x},{y}")
}

/// What a choice is called on the command line.
fn name(choice: impl clap::ValueEnum) -> String {
    choice.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::presets;

    fn line(look: &Look) -> String {
        command_line(look, Path::new("night.exr"), Path::new("out.png"), None).unwrap()
    }

    #[test]
    fn what_is_as_by_default_is_not_said() {
        assert_eq!(line(&Look::default()), "vglare apply night.exr -o out.png");
        let look = Look { strength: 1.5, lens: LookLens::preset("v1/zoom").unwrap(), veil: None, ..Look::default() };
        assert_eq!(line(&look), "vglare apply night.exr -o out.png --preset v1/zoom --strength 1.5");
        let look = Look { lights: LookLights::Found, ..Look::default() };
        assert_eq!(line(&look), "vglare apply night.exr -o out.png --sources lights");
    }

    #[test]
    fn names_are_quoted_and_are_no_options() {
        let line = command_line(&Look::default(), Path::new("-my $HOME's.exr"), Path::new("a\nb.png"), None).unwrap();
        let words = ["vglare", "apply", "./-my $HOME's.exr", "-o", "a\nb.png"];
        assert_eq!(shlex::split(&line).unwrap(), words, "{line}");
        let nul = command_line(&Look::default(), Path::new("a\0b"), Path::new("b"), None);
        assert!(matches!(nul, Err(Error::Usage(_))));
    }

    #[test]
    fn what_options_cannot_say_needs_a_file() {
        let own = Look { lens: LookLens::Own(presets::named("zoom").unwrap().ghosts.into()), ..Look::default() };
        let listed = Look { lights: LookLights::Listed(Vec::new().into()), ..Look::default() };
        for look in [own, listed] {
            let (photo, output) = (Path::new("a.exr"), Path::new("b.exr"));
            assert!(matches!(command_line(&look, photo, output, None), Err(Error::Usage(_))));
            let line = command_line(&look, photo, output, Some(Path::new("my look.toml"))).unwrap();
            assert_eq!(line, "vglare apply a.exr -o b.exr --scene 'my look.toml'");
        }
    }
}
