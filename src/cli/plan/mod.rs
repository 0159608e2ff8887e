//! `vglare plan`: what `vglare apply` would do, and why, without doing it.

pub mod text;

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::found;
use crate::choices::Sources;
use crate::frame::Frame;
use crate::gpu::{Device, Info};
use crate::job::{self, Planning, VeilPlanned};
use crate::look::{Gathered, Look};
use crate::options::AccuracyArgs;
use crate::options::FindArgs;
use crate::options::ReadArgs;
use crate::options::SceneArgs;
use crate::options::VeilArgs;
use crate::plan::{CostModel, Plan};
use crate::problem::Rims;
use crate::scene::Recovery;
use crate::terminal::stderr::warn;
use crate::terminal::stdout;
use crate::{Result, photo};

/// Show how the glare of a photo would be computed
///
/// Prints the plan that `vglare apply` would follow with the same options: the period, the degree, the groups of ghosts,
/// the bound of each source of error, what each evaluator is expected to cost, and why the others are not taken. Nothing
/// is rendered or written. Without OpenGL 4.3 the plan is made for a device without limits.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The photo: OpenEXR, Radiance HDR, PFM, TIFF, PNG, JPEG or JPEG XL; - for standard input
    photo: PathBuf,

    /// Plan for a picture of this size in pixels, with the photo's lights where they are [default: the photo's]
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,

    /// Print JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    reading: ReadArgs,

    #[command(flatten)]
    scene: SceneArgs,

    #[command(flatten)]
    veil: VeilArgs,

    #[command(flatten)]
    find: FindArgs,

    #[command(flatten)]
    accuracy: AccuracyArgs,
}

const EXAMPLES: &str = "\
Examples:
  vglare plan night.exr                               How, how exactly, how fast?
  vglare plan night.exr --budget 16 --size 3840x2160  How exact can a frame of film be?
  vglare plan night.exr --veil cie --fov 50           How is a veil computed?
  vglare plan night.exr --tolerance 1e-5 --json";

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).map(|(width, height)| [width.parse(), height.parse()]);
    match sides {
        Some([Ok(width @ 1..=65536), Ok(height @ 1..=65536)]) => Ok([width, height]),
        _ => Err("expected WxH, each 1 to 65536 pixels, like 1920x1080".to_owned()),
    }
}

/// Reads the photo, finds its lights, plans and prints.
///
/// # Errors
/// Where the photo or a file of the scene cannot be read, where there is no plan, or standard output cannot be written.
/// No OpenGL is no error.
pub fn run(args: &Args) -> Result<()> {
    let mut look =
        args.veil.over(args.scene.look(&args.find)?, args.accuracy.tolerance(), &args.scene.optics.aperture)?;
    args.scene.unit.check(&look)?;
    look.find = args.find.over(look.find);
    look.accuracy = args.accuracy.over(look.accuracy);
    let photo = photo::read_with(&args.photo, &args.reading.of_white(args.veil.white_luminance()))?;
    warn(&photo.source.notes);
    let whole = look.frame(&photo)?;
    let scene = look.gather(&photo, &whole);
    let frame = args.size.map_or(whole, |[width, height]| whole.resized(width, height));
    let device = Device::open(args.accuracy.backend.backends()).ok();
    let info = device.as_ref().map(|device| device.info());
    let problem = scene.problem(frame);
    // However large it is planned, the picture is as dark.
    let darkest = job::Darkest::new(&look, &photo, &scene.problem(whole))?;
    let planned = job::plan(&look.accuracy, darkest.as_ref(), &problem, info, args.accuracy.known(info))?;
    warn(&planned.warnings);
    let veil = job::plan_veil(&look, &photo, &frame)?;
    let budget = look.accuracy.goal.budget();
    let told = Told { photo: &args.photo, frame, look: &look, scene: &scene, planned: &planned, veil, info, budget };
    if args.json { stdout::json(|out| told.json(out)) } else { stdout::print(|out| told.text(out)) }
}

/// What is printed.
struct Told<'a> {
    photo: &'a Path,
    frame: Frame,
    look: &'a Look,
    scene: &'a Gathered,
    planned: &'a Planning,
    veil: Option<VeilPlanned>,
    info: Option<&'a Info>,
    budget: Option<f64>,
}

impl Told<'_> {
    fn text(&self, out: &mut dyn Write) -> io::Result<()> {
        let window = self.frame.window;
        write!(out, "photo    {}, planned for {} x {} pixels", self.photo.display(), window.width, window.height)?;
        match self.frame.pixel_aspect {
            1.0 => writeln!(out)?,
            aspect => writeln!(out, ", {aspect:.4} times as wide as high")?,
        }
        match &self.scene.lens {
            Some(lens) if let Some(images) = &self.scene.images => {
                let (pixels, ghosts) = (images.raster().pixels(), self.scene.count());
                writeln!(out, "scene    {pixels} pixels through {}: {ghosts} ghosts", lens.name)?;
                found::rims(images).iter().try_for_each(|rims| writeln!(out, "         {rims}"))?;
            }
            Some(lens) => {
                let (lights, ghosts) = (self.scene.lights.len(), self.scene.ghosts.len());
                writeln!(out, "scene    {lights} lights through {}: {ghosts} ghosts", lens.name)?;
            }
            None => writeln!(out, "scene    {} ghosts", self.scene.ghosts.len())?,
        }
        if let Some(recovery) = &self.scene.recovery {
            writeln!(out, "recovered: {recovery}")?;
        }
        if let Some(found) = self.scene.found.as_ref().filter(|_| self.look.finds()) {
            if found.regions == 0 {
                writeln!(out, "         no lights: {}", found::none(found))?;
            }
            found::beyond(found).iter().try_for_each(|beyond| writeln!(out, "         {beyond}"))?;
            let fireflies = found::fireflies(found, &self.look.find);
            fireflies.iter().try_for_each(|fireflies| writeln!(out, "         {fireflies}"))?;
        }
        let plan = &self.planned.plan;
        text::plan(out, plan)?;
        if let Some(budget) = self.budget {
            let predicted = plan.cost().unwrap_or(f64::NAN);
            writeln!(out, "budget   {budget} ms buys a tolerance of {:.1e}: {predicted:.1} ms", plan.tolerance)?;
        }
        self.planned.notes.iter().try_for_each(|note| writeln!(out, "note     {note}"))?;
        text::details(out, self.planned)?;
        self.veil.iter().try_for_each(|veil| text::veil(out, veil))?;
        writeln!(out, "device   {}", self.device())
    }

    /// What the plan was made for.
    fn device(&self) -> String {
        match self.info {
            Some(info) => match info.loop_rounds() {
                Some(rounds) => format!("{}: at most {rounds} rounds of a shader's loops", info.renderer),
                None => info.renderer.clone(),
            },
            None => "no OpenGL 4.3 here: assuming a device that ends no loop early and holds 2 Mi terms".to_owned(),
        }
    }

    fn json(&self, out: &mut dyn Write) -> io::Result<()> {
        let json = Json {
            vglare: env!("CARGO_PKG_VERSION"),
            photo: self.photo.display().to_string(),
            size: [self.frame.window.width, self.frame.window.height],
            lights: self.scene.lights.len(),
            sources: self.scene.sources(),
            ghosts: self.scene.count(),
            rims: self.scene.images.as_ref().and_then(|images| images.rims()),
            recover: self.scene.recovery.as_ref(),
            plan: &self.planned.plan,
            veil: self.veil.as_ref(),
            predicted_total: self.planned.plan.predicted.total(),
            budget_ms: self.budget,
            predicted_ms: self.planned.plan.cost(),
            model: CostModelReport::new(self.planned),
            notes: &self.planned.notes,
            device: self.device(),
            renderer: self.info,
        };
        serde_json::to_writer_pretty(&mut *out, &json)?;
        writeln!(out)
    }
}

#[derive(Serialize)]
struct Json<'a> {
    vglare: &'static str,
    photo: String,
    size: [u32; 2],
    lights: usize,
    sources: Sources,
    ghosts: usize,
    rims: Option<&'a Rims>,
    recover: Option<&'a Recovery>,
    plan: &'a Plan,
    veil: Option<&'a VeilPlanned>,
    predicted_total: f64,
    budget_ms: Option<f64>,
    predicted_ms: Option<f64>,
    model: CostModelReport<'a>,
    notes: &'a [String],
    device: String,
    renderer: Option<&'a Info>,
}

/// The cost model that decided, and where it is from.
#[derive(Serialize)]
pub struct CostModelReport<'a> {
    /// "built-in" or "calibrated".
    source: &'static str,
    /// The calibration's file.
    file: Option<&'a Path>,
    nanoseconds: &'a CostModel,
}

impl<'a> CostModelReport<'a> {
    /// That of a plan.
    pub fn new(planned: &'a Planning) -> Self {
        let file = planned.calibration.as_deref();
        let source = if file.is_some() { "calibrated" } else { "built-in" };
        Self { source, file, nanoseconds: &planned.model }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_two_sides() {
        assert_eq!(size("3840x2160"), Ok([3840, 2160]));
        for bad in ["64", "64x", "x36", "0x36", "64x-1", "64x36x2", "99999x10", "a×b"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }
}
