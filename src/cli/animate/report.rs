//! The frames as they are written, and what is told of them: the report.

use std::time::Instant;

use serde::Serialize;

use super::frame::{Base, Drawn, FrameTold};
use super::outputs::Paths;
use super::plot::{self, Mean};
use super::shot::{Lit, Shot};
use super::told::{ErrorTold, PlanTold, Told};
use super::{Args, Outside, Seen, summary};
use crate::choices::{LengthUnit, Mix, Normalize};
use crate::cli::surroundings::StrayTold;
use crate::job::VeilError;
use crate::look::Look;
use crate::motion::{Camera, Path};
use crate::photo::{self, Facts};
use crate::terminal::stderr;
use crate::{Error, Result, target};

/// What has become of the frames so far.
pub struct Log<'a> {
    args: &'a Args,
    shot: &'a Shot,
    paths: &'a [Paths],
    started: Instant,
    /// Of the photo behind the lights.
    pub photo: Option<Facts>,
    /// Columns and rows of the pictures.
    pub sides: [u32; 2],
    /// The lights of each frame.
    pub lights: Vec<Vec<Lit>>,
    /// The camera of each frame, and its field of view.
    pub cameras: Vec<(Camera, f64)>,
    still: Vec<(&'static str, Told)>,
    pub frames: Vec<FrameLog>,
    /// What a person ought to know, each once.
    pub warnings: Vec<String>,
}

/// A frame that was written.
pub struct FrameLog {
    /// The frame that it is the same as.
    pub same: Option<usize>,
    pub told: FrameTold,
    /// Of its glare, where that is wanted.
    pub mean: Option<Mean>,
    pub written_ms: f64,
}

impl<'a> Log<'a> {
    pub fn new(args: &'a Args, shot: &'a Shot, paths: &'a [Paths]) -> Self {
        Self {
            args,
            shot,
            paths,
            started: Instant::now(),
            photo: None,
            sides: [0; 2],
            lights: Vec::new(),
            cameras: Vec::new(),
            still: Vec::new(),
            frames: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// Notes what stands still.
    pub fn still(&mut self, base: &Base) {
        self.still.clone_from(&base.told);
        base.warnings.iter().for_each(|warning| self.warn(warning));
    }

    /// Writes a frame, and notes it.
    ///
    /// # Errors
    /// Those of [`photo::write`].
    pub fn write(&mut self, index: usize, drawn: &Drawn, same: Option<usize>) -> Result<()> {
        let started = Instant::now();
        let (paths, encoding) = (&self.paths[index], &self.args.outputs.encoding);
        if let (Some(path), Some(glare)) = (&paths.glare, &drawn.glare) {
            photo::write(path, glare, &encoding.glare(path, self.args.output.is_some(), self.args.force))?;
        }
        if let (Some(path), Some(picture)) = (&paths.picture, &drawn.picture) {
            let options = encoding.picture(self.args.force);
            photo::lost(path, picture, &options).iter().for_each(|lost| self.warn(lost));
            photo::write(path, picture, &options)?;
        }
        let number = self.shot.number(index);
        if same.is_none() {
            drawn.told.warnings.iter().for_each(|warning| self.warn(warning));
            self.missed(number, &drawn.told);
        }
        let told = match same {
            Some(_) => FrameTold { milliseconds: 0.0, stages: Vec::new(), ..drawn.told.clone() },
            None => drawn.told.clone(),
        };
        let mean = match same {
            Some(same) => self.frames[same].mean,
            None => drawn.glare.as_ref().map(Mean::of),
        };
        self.frames.push(FrameLog { same, told, mean, written_ms: started.elapsed().as_secs_f64() * 1e3 });
        Ok(())
    }

    /// Warns of a frame whose error is beyond what was asked.
    fn missed(&mut self, number: i64, told: &FrameTold) {
        if let Err(error) = told.check() {
            self.warn(&format!("frame {number}: {error}"));
        }
    }

    fn warn(&mut self, warning: &str) {
        if !self.warnings.iter().any(|known| known == warning) {
            self.warnings.push(warning.to_owned());
        }
    }

    /// An error with the frame's file.
    pub fn blame(&self, index: usize, error: Error) -> Error {
        let path = self.paths[index].all().next().unwrap_or(&self.args.motion.path);
        error.in_frame(path)
    }

    /// The frame with the largest error, in what it was asked for.
    pub fn worst(&self) -> Option<(usize, ErrorTold)> {
        let errors = self.frames.iter().enumerate().filter_map(|(index, frame)| Some((index, frame.told.error?)));
        errors.max_by(|(_, one), (_, other)| (one.measured / one.asked).total_cmp(&(other.measured / other.asked)))
    }

    /// The same of its veil.
    pub fn worst_veil(&self) -> Option<(usize, VeilError)> {
        let errors = self.frames.iter().enumerate().filter_map(|(index, frame)| Some((index, frame.told.veil?)));
        errors.max_by(|(_, one), (_, other)| (one.measured / one.asked).total_cmp(&(other.measured / other.asked)))
    }

    /// Frames that were computed.
    pub fn computed(&self) -> impl Iterator<Item = &FrameLog> {
        self.frames.iter().filter(|frame| frame.same.is_none())
    }

    /// What it is of, for a title: the panorama, the photo or the path.
    pub fn name(&self) -> String {
        let motion = &self.args.motion;
        let path = motion.panorama.as_ref().or(self.args.photo.as_ref()).unwrap_or(&motion.path);
        path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    pub fn seconds(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    pub fn still_parts(&self) -> &[(&'static str, Told)] {
        &self.still
    }

    /// Writes the report, and tells the summary.
    ///
    /// # Errors
    /// Those of [`target::write_json`]; with --strict, that of the frame with the largest error, where it is too large.
    pub fn finish(self, args: &Args, shot: &Shot, look: &Look) -> Result<()> {
        if let Some(path) = &args.outputs.report {
            target::write_json(path, &Report::new(&self, look), args.force)?;
        }
        if let Some(path) = &args.outputs.plot {
            plot::write(path, &self, shot, args.force)?;
        }
        stderr::warn(&self.warnings);
        if !args.quiet {
            summary::print(args, shot, look, &self)?;
        }
        if !args.proof.strict {
            return Ok(());
        }
        let worst = [self.worst().map(|(index, _)| index), self.worst_veil().map(|(index, _)| index)];
        worst
            .into_iter()
            .flatten()
            .try_for_each(|index| self.frames[index].told.check().map_err(|error| self.blame(index, error)))
    }
}

impl FrameTold {
    /// An error where the glare, or the veil, is further from the truth than was asked.
    fn check(&self) -> Result<()> {
        match self.error {
            None => {}
            // Written so that a NaN would be an error too.
            Some(ErrorTold { asked, measured, .. }) if measured <= asked => {}
            Some(ErrorTold { asked, measured, .. }) => return Err(Error::ToleranceMissed { asked, measured }),
        }
        self.veil.map_or(Ok(()), |veil| veil.check())?;
        self.outside.as_ref().and_then(|outside| outside.error).map_or(Ok(()), |error| error.check())
    }
}

/// As JSON, one object.
#[derive(Serialize)]
struct Report<'a> {
    vglare: &'static str,
    path: String,
    photo: Option<String>,
    panorama: Option<String>,
    picture: [u32; 2],
    lens: String,
    unit: LengthUnit,
    strength: f64,
    size: f64,
    tint: [f64; 3],
    mix: Mix,
    normalize: Normalize,
    lamps: Option<Seen>,
    outside: Option<Outside>,
    /// What stands still in all frames, computed once.
    still: Vec<StillReport<'a>>,
    frames: Vec<FrameReport<'a>>,
    summary: Summary,
    warnings: &'a [String],
    renderer: Option<&'a str>,
}

#[derive(Serialize)]
struct StillReport<'a> {
    what: &'static str,
    plan: Option<&'a PlanTold>,
    error: Option<ErrorTold>,
    veil: Option<VeilError>,
    wall_ms: f64,
}

#[derive(Serialize)]
struct FrameReport<'a> {
    frame: i64,
    time: f64,
    output: Option<String>,
    glare: Option<String>,
    /// The frame that this one is, bit for bit.
    same_as: Option<i64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    lights: Option<Vec<LightReport<'a>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    camera: Option<CameraReport>,
    plan: Option<&'a PlanTold>,
    error: Option<ErrorTold>,
    veil: Option<VeilError>,
    /// The mean of the glare over the picture, RGB, where the glare is wanted.
    glare_mean: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    surroundings: Option<&'a StrayTold>,
    computed_ms: f64,
    stages: Vec<Stage>,
    written_ms: f64,
}

#[derive(Serialize)]
struct LightReport<'a> {
    light: &'a str,
    position: [f64; 2],
    /// What makes glare of it, after it has faded.
    flux: [f64; 3],
    size: f64,
    /// What is left of it, 0 to 1.
    share: f64,
}

#[derive(Serialize)]
struct CameraReport {
    yaw: f64,
    pitch: f64,
    roll: f64,
    fov: f64,
}

#[derive(Serialize)]
struct Stage {
    stage: &'static str,
    wall_ms: f64,
}

#[derive(Serialize)]
struct Summary {
    frames: usize,
    computed: usize,
    /// With an error above the tolerance.
    above_tolerance: usize,
    worst_error: Option<f64>,
    worst_frame: Option<i64>,
    seconds: f64,
}

impl<'a> Report<'a> {
    fn new(log: &'a Log<'_>, look: &Look) -> Self {
        let (args, of_lights) = (log.args, matches!(log.shot.path, Path::Lights(_)));
        let shown = |path: &std::path::PathBuf| path.display().to_string();
        let worst = log.worst();
        let still = log.still.iter().map(|(what, told)| StillReport {
            what,
            plan: told.plan.as_ref(),
            error: told.error,
            veil: told.veil,
            wall_ms: told.milliseconds,
        });
        Self {
            vglare: env!("CARGO_PKG_VERSION"),
            path: shown(&args.motion.path),
            photo: args.photo.as_ref().map(shown),
            panorama: args.motion.panorama.as_ref().map(shown),
            picture: log.sides,
            lens: look.lens().name,
            unit: look.unit,
            strength: look.strength,
            size: look.size,
            tint: look.tint,
            mix: look.mix,
            normalize: look.normalize,
            lamps: of_lights.then_some(args.motion.lamps),
            outside: of_lights.then_some(args.motion.outside),
            still: still.collect(),
            frames: (0..log.frames.len()).map(|index| FrameReport::new(log, index)).collect(),
            summary: Summary {
                frames: log.frames.len(),
                computed: log.computed().count(),
                above_tolerance: log.frames.iter().filter(|frame| frame.told.check().is_err()).count(),
                worst_error: worst.map(|(_, error)| error.measured),
                worst_frame: worst.map(|(index, _)| log.shot.number(index)),
                seconds: log.seconds(),
            },
            warnings: &log.warnings,
            renderer: log.frames.iter().find_map(|frame| frame.told.renderer.as_deref()),
        }
    }
}

impl<'a> FrameReport<'a> {
    fn new(log: &'a Log<'_>, index: usize) -> Self {
        let (FrameLog { same, told, mean, written_ms }, paths) = (&log.frames[index], &log.paths[index]);
        let name = |lit: &Lit| match &log.shot.path {
            Path::Lights(lights) => &*lights[lit.light].name,
            Path::Camera(..) => "",
        };
        let light = |lit: &Lit| LightReport {
            light: name(lit),
            position: lit.given.position.to_array(),
            flux: lit.given.flux.map(|flux| flux * lit.share),
            size: lit.given.size,
            share: lit.share,
        };
        let camera = |&(Camera { yaw, pitch, roll, .. }, fov): &(Camera, f64)| CameraReport { yaw, pitch, roll, fov };
        let shown = |path: &std::path::PathBuf| path.display().to_string();
        Self {
            frame: log.shot.number(index),
            time: log.shot.time(index),
            output: paths.picture.as_ref().map(shown),
            glare: paths.glare.as_ref().map(shown),
            same_as: same.map(|same| log.shot.number(same)),
            lights: log.lights.get(index).map(|lights| lights.iter().map(light).collect()),
            camera: log.cameras.get(index).map(camera),
            plan: told.plan.as_ref(),
            error: told.error,
            veil: told.veil,
            glare_mean: mean.map(|mean| mean.colour),
            surroundings: told.outside.as_ref(),
            computed_ms: told.milliseconds,
            stages: told.stages.iter().map(|&(stage, wall_ms)| Stage { stage, wall_ms }).collect(),
            written_ms: *written_ms,
        }
    }
}
