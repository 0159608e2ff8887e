//! `vglare apply`: the main job, for one photo or for the photos of a shot.

mod expected;
mod fault;
mod inputs;
mod job;
mod lock;
pub(super) mod look;
mod map;
pub(super) mod names;
pub(super) mod outputs;
pub(super) mod pipeline;
mod report;
mod run;
mod sequence;
mod shot;
mod spool;
mod summary;
mod tally;
mod told;
mod workers;

use std::path::PathBuf;

use crate::certificate::Verify;
use crate::choices::Mix;
use crate::cli::encoding::EncodingArgs;
use crate::look::Look;
use crate::options::AccuracyArgs;
use crate::options::EnvironmentArgs;
use crate::options::FindArgs;
use crate::options::ReadArgs;
use crate::options::SceneArgs;
use crate::options::VeilArgs;
use crate::options::numbers::range;
use crate::{Error, Result, target};

use inputs::Inputs;
use look::LookArgs;
use shot::ShotArgs;

pub use run::run;

/// Lay glare over a photo
///
/// Makes the ghosts that the lens turns every pixel of the photo into (or the lights that are found in it, or those of a file),
/// computes their sum to the tolerance, adds it to the photo and writes the picture in the format that OUTPUT's extension names.
///
/// Several photos, as the frames of a shot, are done in one run, in which the next is read and the last written while one
/// is computed. OUTPUT then is a folder, which is made if need be, or a pattern. Each photo has lights, a plan and a
/// measured error of its own. Where photos are the frames of a shot, by a pattern or by names that differ in their numbers alone,
/// the first chooses for all what would flicker if each chose: see --lock-from.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The photo, or several: OpenEXR, Radiance HDR, PFM, TIFF, PNG, JPEG or JPEG XL; - for standard input
    ///
    /// The frames of a shot may be named by a pattern, as shot.####.exr or shot.%04d.exr: all that are there, or those that
    /// --frames picks.
    #[arg(value_name = "INPUT", required_unless_present = "environment")]
    inputs: Vec<PathBuf>,

    /// The picture: .exr .hdr .pfm .tif .tiff .png .jpg .jpeg; for several photos, a folder or a pattern
    ///
    /// A folder, as out/, is made if need be; each picture in it is called as its photo. A pattern has fields in its file
    /// name: #### or %04d becomes the frame number, the last number in the photo's name, with at least four digits (so do
    /// ## or %02d with two, and %d with as many as it has); {name} becomes the photo's name without its extension. One #
    /// alone stays what it is. The number of shot.-001.exr and shot_-1.exr is -1, whose sign counts as a digit, and that of
    /// shot-001.exr is 1. A single - is standard output, of the format that --format names; the summary then goes to standard
    /// error, and --glare or --report may be - in its place. Where --glare, --map or --report is given, OUTPUT may be
    /// left out.
    #[arg(short, long, required_unless_present_any = ["glare", "map", "report"])]
    output: Option<PathBuf>,

    /// Replace files that exist
    #[arg(long)]
    force: bool,

    /// Say nothing but errors and warnings
    #[arg(short, long, conflicts_with = "verbose")]
    quiet: bool,

    /// Say more: the plan, and the time of each pass; for several photos, a line each
    #[arg(short, long)]
    verbose: bool,

    #[command(flatten)]
    sequence: ShotArgs,

    #[command(flatten)]
    reading: ReadArgs,

    #[command(flatten)]
    scene: SceneArgs,

    #[command(flatten)]
    veil: VeilArgs,

    #[command(flatten)]
    surroundings: EnvironmentArgs,

    #[command(flatten)]
    find: FindArgs,

    #[command(flatten)]
    look: LookArgs,

    #[command(flatten)]
    accuracy: AccuracyArgs,

    #[command(flatten)]
    proof: ProofArgs,

    #[command(flatten)]
    output_options: OutputArgs,
}

const EXAMPLES: &str = "\
Examples:
  vglare apply night.exr -o night.png
  vglare apply night.exr -o veiled.exr --preset vintage-uncoated --strength 1.5
  vglare apply night.exr -o veiled.exr --sources lights
  vglare apply night.exr -o veiled.exr --glare glare.exr --report report.json
  vglare apply night.exr -o veiled.exr --scene scene.toml --tolerance 1e-4 --strict
  vglare apply night.exr -o veiled.exr --veil cie --age 60 --fov 50 --projection planar --lens none
  vglare apply night.exr -o veiled.exr --veil cie --environment street.exr --view 20,5,0 --fov 60
  vglare apply --environment street.exr --view 20,5,0 --fov 60 --frame 960x540 -o out.exr --veil cie
  vglare apply night.exr --map veil.png --veil cie --fov 50 --lens none --luminance 250
  vglare apply night.exr -o veiled.exr --budget 20 --verify full
  vglare apply night.exr --glare glare.exr --depth half
  vglare apply - -o - --format png < night.exr > night.png
  vglare apply night.exr -o veiled.exr --layers
  vglare apply render.exr -o veiled.exr --layer beauty --colorspace ap1
  vglare apply shot.*.exr -o veiled/
  vglare apply shot.*.exr -o 'veiled.####.exr' --glare 'glare.####.exr' --report report.json
  vglare apply shot.*.exr -o 'previews/{name}.png' --keep-going --quiet
  vglare apply 'shot.####.exr' -o 'out/shot.####.exr' --frames 1001-1240x2
  vglare apply 'shot.####.exr' -o 'out/shot.####.exr' --resume";

impl Args {
    /// The photos; where there are none, what one is seen of.
    fn photos(&self) -> &[PathBuf] {
        match &self.surroundings.environment {
            Some(environment) if self.inputs.is_empty() => std::slice::from_ref(environment),
            _ => &self.inputs,
        }
    }

    /// Whether files that are there may be replaced. One of several processes does not look: another may have been quicker, and who
    /// started them has.
    fn overwrites(&self) -> bool {
        self.force || self.sequence.resume || self.sequence.among.is_some()
    }

    /// Whether what is known of frames that are done stays when all of them are: of a shot that is named as one, or goes on. Of photos that
    /// are named one by one nobody expects more than their pictures.
    fn keeps_ledger(&self) -> bool {
        self.sequence.resume || self.sequence.frames.is_some() || Inputs::are_by_pattern(&self.inputs)
    }

    /// Whether one of the files goes to standard output.
    fn takes_stdout(&self) -> bool {
        let OutputArgs { glare, map, report, .. } = &self.output_options;
        [&self.output, glare, map, report].into_iter().flatten().any(|path| target::is_standard(path))
    }

    /// The look that the files and options give.
    ///
    /// # Errors
    /// Those of [`SceneArgs::look`].
    pub fn look(&self) -> Result<Look> {
        let look = self.look.over(self.veil.over(
            self.scene.look(&self.find)?,
            self.accuracy.tolerance(),
            &self.scene.optics.aperture,
        )?);
        let (find, accuracy) = (self.find.over(look.find), self.accuracy.over(look.accuracy));
        self.surroundings.check()?;
        self.check_layers(&look)?;
        VeilArgs::check_panorama(&look, self.scene.lens_option())?;
        if self.surroundings.environment.is_none() {
            self.scene.unit.check(&look)?;
        }
        Ok(Look { find, accuracy, ..look })
    }
}

impl Args {
    /// Layers are of a sum, and a look may make something else of a photo.
    fn check_layers(&self, look: &Look) -> Result<()> {
        let against = [
            (look.mix != Mix::Add, "--mix energy: it takes light from the photo, which none of them would show"),
            (self.surroundings.environment.is_some(), "--environment: they are of what the picture itself makes"),
        ];
        match against.into_iter().find(|(is_there, _)| *is_there && self.output_options.layers) {
            Some((_, why)) => Err(Error::Usage(format!("--layers cannot be used with {why}"))),
            None => Ok(()),
        }
    }
}

/// How the result is held against the truth.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Accuracy")]
pub(super) struct ProofArgs {
    /// Fail with exit code 3 where the measured error is beyond the tolerance, instead of warning
    #[arg(long)]
    pub(super) strict: bool,

    /// Where the glare is compared with the direct sum in 64-bit floats: at some hundred pixels, or at every one
    #[arg(long, value_enum, default_value_t = Verify::Sample)]
    pub(super) verify: Verify,
}

/// What is written beside the picture, and how.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Output")]
struct OutputArgs {
    /// Write the glare alone, as it was added; scene-linear, in any format, and with what an OpenEXR photo says of itself.
    /// For several photos a folder or a pattern, like OUTPUT
    #[arg(long, value_name = "FILE")]
    glare: Option<PathBuf>,

    /// Write what was added to the photo as layers beside the picture, OpenEXR only, in 32-bit floats: glare.R, glare.G, glare.B by the ghosts of all
    /// pixels, lights by those of lights where only lights make some, veil by the veil, less what it takes. The photo and all three are the picture
    #[arg(long, requires = "output")]
    layers: bool,

    /// Draw the luminance of all that was added in false colours, on a logarithmic scale with a legend: in cd/m² where --luminance or
    /// the file says what the photo's numbers are, else in its numbers. .png or .svg; for several photos a pattern, like OUTPUT
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,

    /// The ends of that scale, so that several maps share one [default: what the glare spans, five decades at most]
    #[arg(long, value_name = "FROM,TO", requires = "map", value_parser = range, allow_hyphen_values = true)]
    map_range: Option<[f64; 2]>,

    /// Write what was computed, how, how exactly and how fast, as JSON; one file for all photos
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,

    #[command(flatten)]
    encoding: EncodingArgs,
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use glam::DVec2;

    use super::*;
    use crate::choices::{Beyond, Evaluator, LengthUnit, LightBy, LightShape, Mix, Normalize};
    use crate::look::{Accuracy, LookLens, LookLights};
    use crate::options::command_line;
    use crate::scene::{FindOptions, Goal, Light, Recover, presets, write_scene};

    #[derive(clap::Parser)]
    struct Cli {
        #[command(flatten)]
        args: Args,
    }

    /// The look of a command line that begins with `vglare apply`.
    fn look(line: &str) -> Look {
        let words = shlex::split(line).unwrap().into_iter().skip(1);
        let Cli { args } = clap::Parser::try_parse_from(words).unwrap_or_else(|error| panic!("{line}: {error}"));
        assert_eq!(
            (&*args.inputs, args.output.as_deref()),
            (&["my night.exr".into()][..], Some(Path::new("it's.png")))
        );
        args.look().unwrap()
    }

    fn again(look_before: &Look, file: Option<&Path>) -> Look {
        look(&command_line(look_before, Path::new("my night.exr"), Path::new("it's.png"), file).unwrap())
    }

    /// Everything that an option can say.
    fn changed() -> Look {
        Look {
            lens: LookLens::preset("zoom").unwrap(),
            axis: DVec2::new(-0.1, 1.0 / 3.0),
            size: 0.7,
            tint: [1.0, 0.1, 0.0],
            lights: LookLights::Found,
            find: FindOptions {
                by: LightBy::Luminance,
                threshold: Some(1e-7),
                merge: 0.0,
                shape: LightShape::Ball,
                max_lights: 5,
                beyond: Beyond::Drop,
                firefly_limit: 0.0,
                knee: 0.25,
                recover: Recover::Stops(4.5),
            },
            strength: 1e9,
            veil: None,
            mix: Mix::Energy,
            normalize: Normalize::Minmax,
            accuracy: Accuracy {
                goal: Goal::Tolerance(1.0 / 7000.0),
                allow_floor: true,
                each_pixel: true,
                degree: Some([0, 12]),
                period: Some(DVec2::new(4.1, 3.0)),
                evaluator: Some(Evaluator::Rows),
            },
            ..Look::default()
        }
    }

    #[test]
    fn the_windows_command_line_is_parsed_as_the_same_look() {
        let accuracy = Accuracy { goal: Goal::Budget(16.7), ..Accuracy::default() };
        let eye = Look::default().through(LookLens::preset("eye").unwrap(), false).unwrap();
        let units = Look { unit: LengthUnit::Degrees, fov: Some(40.5), ..Look::default() };
        let found = Look { lights: LookLights::Found, ..Look::default() };
        let lens = LookLens::preset("v1/eye").unwrap();
        let old = Look { lens, find: FindOptions::VERSION_1, veil: None, ..found.clone() };
        for look in [Look::default(), changed(), Look { accuracy, ..Look::default() }, eye, units, found, old] {
            assert_eq!(again(&look, None), look);
        }
    }

    #[test]
    fn files_of_the_windows_command_line_are_read_as_the_same_look() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("my lens.toml"), presets::find("anamorphic").unwrap().toml).unwrap();
        let lens = crate::scene::read_lens(&path("my lens.toml")).unwrap();
        let filed = Look { lens: LookLens::File(path("my lens.toml"), lens.into()), ..changed() };
        assert_eq!(again(&filed, None), filed);
        let light = Light { position: DVec2::new(2.0, 0.1), flux: [1.0, 0.0, 0.3], size: 0.0, muted: true };
        let own = LookLens::Own(presets::named("zoom").unwrap().ghosts.into());
        let listed = Look { lights: LookLights::Listed(vec![light].into()), lens: own, ..changed() };
        write_scene(&path("my look.toml"), &listed.to_scene(), false).unwrap();
        assert_eq!(again(&listed, Some(&path("my look.toml"))), listed);
    }

    #[test]
    fn the_help_names_the_defaults_that_a_look_has() {
        use clap::CommandFactory as _;
        let (look, command) = (Look::default(), Cli::command());
        let Goal::Tolerance(tolerance) = look.accuracy.goal else { panic!("the default is a tolerance") };
        let defaults = [
            ("preset", look.lens().name),
            ("axis", format!("{},{}", look.axis.x, look.axis.y)),
            ("by", format!("{:?}", look.find.by).to_lowercase()),
            ("shape", format!("{:?}", look.find.shape).to_lowercase()),
            ("beyond", format!("{:?}", look.find.beyond).to_lowercase()),
            ("merge", look.find.merge.to_string()),
            ("max_lights", look.find.max_lights.to_string()),
            ("firefly_limit", look.find.firefly_limit.to_string()),
            ("knee", look.find.knee.to_string()),
            ("recover", look.find.recover.to_string()),
            ("strength", look.strength.to_string()),
            ("size", look.size.to_string()),
            ("tint", look.tint.map(|part| part.to_string()).join(",")),
            ("mix", format!("{:?}", look.mix).to_lowercase()),
            ("normalize", format!("{:?}", look.normalize).to_lowercase()),
            ("tolerance", tolerance.to_string()),
        ];
        for (name, default) in defaults {
            let option = command.get_arguments().find(|option| option.get_id() == name).expect(name);
            let help = option.get_long_help().or(option.get_help()).expect(name).to_string();
            assert!(help.contains(&format!("[default: {default}]")), "{name}: {help}");
        }
    }

    #[test]
    fn every_pixel_is_a_source_unless_somebody_means_lights() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        file("old.toml", "");
        file("new.toml", "version = 2\n");
        file("listed.toml", "version = 2\n[[light]]\nposition = [0, 0]\nflux = [1, 1, 1]\n");
        file("lights.toml", "[[light]]\nposition = [0, 0]\nflux = [1, 1, 1]\n");
        let parsed = |options: &str| {
            let line = options.replace('@', &format!("{}/", folder.path().display()));
            let line = format!("vglare apply 'my night.exr' -o \"it's.png\" {line}");
            let Cli { args } = clap::Parser::try_parse_from(shlex::split(&line).unwrap().into_iter().skip(1)).unwrap();
            args.look().map_err(|error| error.to_string())
        };
        let sources = |options: &str| match parsed(options).unwrap().lights {
            LookLights::Found => "found",
            LookLights::Listed(_) => "listed",
            LookLights::FoundAnd(_) => "found and listed",
            LookLights::Photo(lights) if lights.is_empty() => "photo",
            LookLights::Photo(_) => "photo and listed",
        };
        for (options, expected) in [
            ("", "photo"),
            ("--threshold 2 --knee 0.5", "photo"),
            ("--sources photo", "photo"),
            ("--sources lights", "found"),
            ("--max-lights 5", "found"),
            ("--lights @lights.toml", "listed"),
            ("--lights @lights.toml --sources lights", "listed"),
            ("--add-lights @lights.toml", "photo and listed"),
            ("--add-lights @lights.toml --sources lights", "found and listed"),
            ("--scene @old.toml", "found"),
            ("--scene @old.toml --sources photo", "photo"),
            ("--scene @new.toml", "photo"),
            ("--scene @new.toml --max-lights 5", "found"),
            ("--scene @listed.toml", "listed"),
            ("--scene @listed.toml --max-lights 5", "listed"),
            ("--scene @listed.toml --sources photo", "photo and listed"),
        ] {
            assert_eq!(sources(options), expected, "{options}");
        }
        for (options, named) in [("--lights @lights.toml", "--lights"), ("--max-lights 5", "--max-lights")] {
            let said = parsed(&format!("--sources photo {options}")).unwrap_err();
            assert!(said.contains(&format!("--sources photo cannot be used with {named}:")), "{said}");
        }
        // A lens of one's own has no veil but its own.
        file("lens.toml", "[[lens_ghost]]\nalong = 1\nsize = 1\nshare = 0.1\n");
        assert!(parsed("--preset eye").unwrap().veil.is_some());
        assert_eq!(parsed("--scene @new.toml --lens @lens.toml").unwrap().veil, None);
        assert!(parsed("--lens @lens.toml --veil gaussian --width 0.1 --scatter 0.1").unwrap().veil.is_some());
    }

    #[test]
    fn options_win_over_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("look.toml");
        let (accuracy, file) = (Accuracy::default(), changed().to_scene());
        write_scene(&path, &file, false).unwrap();
        let line = format!("vglare apply 'my night.exr' -o \"it's.png\" --scene {}", path.display());
        assert_eq!(look(&line), changed());
        let given = "--preset classic-prime --axis 0,0 --size 1 --tint 1,1,1 --by brightest --threshold 2 --merge 0.02 --shape kept \
                     --max-lights 4096 --beyond join --firefly-limit 1000 --knee 0 --recover auto --strength 1 --mix add --normalize none --tolerance 0.001 --degree 1,1 \
                     --period 3,3 --evaluator grid";
        let expected = Look {
            lights: LookLights::Found,
            find: FindOptions { threshold: Some(2.0), ..FindOptions::default() },
            veil: None,
            accuracy: Accuracy {
                allow_floor: true,
                each_pixel: true,
                degree: Some([1, 1]),
                period: Some(DVec2::splat(3.0)),
                evaluator: Some(Evaluator::Grid),
                ..accuracy
            },
            ..Look::default()
        };
        assert_eq!(look(&format!("{line} {given}")), expected);
        assert_eq!(look(&format!("{line} --budget 5")).accuracy.goal, Goal::Budget(5.0));
    }
}
