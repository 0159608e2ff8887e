//! The report: what was computed, how, how exactly and how fast.

use std::path::PathBuf;
use std::time::SystemTime;

use glam::DVec2;
use serde::Serialize;

use super::job::{Job, Luminance};
use crate::certificate::Certificate;
use crate::choices::{LengthUnit, LightBy, Mix, Normalize, Sources};
use crate::cli::lights::FirefliesJson;
use crate::cli::photo_told::PhotoTold;
use crate::cli::plan::CostModelReport;
use crate::cli::surroundings::StrayTold;
use crate::gpu::{Info, PassTime};
use crate::job::{Computed, Done, EachPixel, Veiled};
use crate::look::{Gathered, Look, LookLens};
use crate::photo::BadKind;
use crate::plan::Plan;
use crate::problem::Rims;
use crate::scene::{Goal, Light, OpticsSection, Recover, Recovery};
use crate::shot;

/// Which run a report is of.
#[derive(Serialize)]
pub struct Run {
    /// Word by word.
    command: Vec<String>,
    /// When it was written, UTC, by RFC 3339.
    date: String,
}

impl Run {
    /// This one, now.
    pub fn now() -> Self {
        let words = std::env::args_os().map(|word| word.to_string_lossy().into_owned());
        Self { command: words.collect(), date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string() }
    }
}

/// As JSON, one object.
#[derive(Serialize)]
pub struct Report<'a> {
    vglare: &'static str,
    /// Of one photo alone; of several it stands beside them.
    #[serde(flatten)]
    run: Option<Run>,
    /// What tells one look from another: sixteen digits, as OpenEXR's `vglare.look`.
    look: String,
    input: PhotoReport,
    output: Option<String>,
    glare: Option<String>,
    map: Option<String>,
    scene: SceneReport<'a>,
    unit: UnitReport,
    strength: f64,
    size: f64,
    tint: [f64; 3],
    normalize: Normalize,
    mix: Mix,
    recover: RecoverReport,
    veil: Option<&'a Veiled>,
    /// What light from outside the frame did.
    #[serde(skip_serializing_if = "Option::is_none")]
    surroundings: Option<&'a StrayTold>,
    /// Photo and glare in cd/m², where the photo's numbers are known to be any.
    #[serde(skip_serializing_if = "Option::is_none")]
    luminance: Option<&'a Luminance>,
    plan: Option<&'a Plan>,
    cost: Option<CostReport<'a>>,
    notes: &'a [String],
    warnings: &'a [String],
    error: Option<&'a Certificate>,
    each_pixel: Option<&'a EachPixel>,
    passes: &'a [PassTime],
    milliseconds: Vec<Stage>,
    renderer: Option<&'a Info>,
}

#[derive(Serialize)]
struct PhotoReport {
    #[serde(flatten)]
    photo: PhotoTold,
    /// BLAKE3 of the file, 256 bits in hexadecimal digits; none of what came by standard input.
    blake3: Option<String>,
    bad_pixels: BadReport,
}

/// What was to become of clipped highlights, and what did.
#[derive(Serialize)]
struct RecoverReport {
    asked: Recover,
    #[serde(flatten)]
    done: Recovery,
}

/// What lengths are counted in, and what that is in heights of a pixel.
#[derive(Serialize)]
struct UnitReport {
    name: LengthUnit,
    pixels: f64,
}

/// What spectrum and field were expected to take, and what they took together with the composite. A driver may compile
/// in that time, when it meets a shader for the first time.
#[derive(Serialize)]
struct CostReport<'a> {
    budget_ms: Option<f64>,
    predicted_ms: Option<f64>,
    measured_ms: Option<f64>,
    model: CostModelReport<'a>,
}

/// How many pixels are no light, and where the first one is.
#[derive(Serialize)]
struct BadReport {
    nan: usize,
    infinite: usize,
    negative: usize,
    first: Option<FirstBad>,
}

#[derive(Serialize)]
struct FirstBad {
    column: i32,
    row: i32,
    kind: &'static str,
}

#[derive(Serialize)]
struct SceneReport<'a> {
    lens: Option<&'a str>,
    /// How a lens is set that is known by its surfaces.
    optics: Option<&'a OpticsSection>,
    axis: [f64; 2],
    lights_by: Option<LightBy>,
    threshold: Option<f64>,
    regions: Option<usize>,
    lights_dropped: Option<usize>,
    /// Of the flux of all regions, as the next.
    dropped_share: Option<f64>,
    lights_joined: Option<usize>,
    joined_share: Option<f64>,
    fireflies: Option<FirefliesJson>,
    lights: Vec<LightReport>,
    sources: Sources,
    ghosts: usize,
    /// What rims of a real lens do, where every pixel is a source.
    rims: Option<&'a Rims>,
}

#[derive(Serialize)]
struct LightReport {
    position: [f64; 2],
    flux: [f64; 3],
    size: f64,
    muted: bool,
}

/// A stage of the run and how long it took.
#[derive(Serialize)]
pub struct Stage {
    stage: &'static str,
    wall_ms: f64,
}

impl<'a> Report<'a> {
    pub fn new(job: &'a Job<'_, Done<'_>>) -> Self {
        let Job { args: _, paths, work, outside, luminance } = job;
        let shown = |path: &Option<PathBuf>| path.as_ref().map(|path| path.display().to_string());
        // What a look has new is to be told, too.
        let &Look {
            description: _,
            ref lens,
            unit,
            fov: _,
            axis,
            size,
            tint,
            lights: _,
            ghosts: _,
            find,
            strength,
            veil: _,
            mix,
            normalize,
            accuracy,
        } = work.look;
        let computed = work.computed.as_ref();
        Self {
            vglare: env!("CARGO_PKG_VERSION"),
            run: None,
            look: work.look.made().look,
            input: photo_report(job),
            output: shown(&paths.output),
            glare: shown(&paths.glare),
            map: shown(&paths.map),
            scene: scene_report(&work.scene, lens, axis),
            unit: UnitReport { name: unit, pixels: work.frame.pixel_size().recip() },
            strength,
            size,
            tint,
            normalize,
            mix,
            recover: RecoverReport { asked: find.recover, done: work.scene.recovery.clone().unwrap_or_default() },
            veil: work.veiled.as_ref(),
            surroundings: outside.as_ref(),
            luminance: luminance.as_ref(),
            plan: computed.map(|computed| &computed.planning.plan),
            cost: computed.map(|computed| cost_report(computed, accuracy.goal)),
            notes: computed.map_or(&[], |computed| &computed.planning.notes),
            warnings: &work.warnings,
            error: computed.map(|computed| &computed.certificate),
            each_pixel: computed.and_then(|computed| computed.each_pixel.as_ref()),
            passes: computed.map_or(&[], |computed| &computed.passes),
            milliseconds: work.stages.0.iter().map(|&(stage, wall_ms)| Stage { stage, wall_ms }).collect(),
            renderer: computed.map(|computed| &*computed.info),
        }
    }

    /// The same, of a run that is of this photo alone.
    pub fn alone(self) -> Self {
        Self { run: Some(Run::now()), ..self }
    }
}

fn cost_report(computed: &Computed, goal: Goal) -> CostReport<'_> {
    CostReport {
        budget_ms: goal.budget(),
        predicted_ms: computed.planning.plan.cost(),
        measured_ms: computed.measured_ms,
        model: CostModelReport::new(&computed.planning),
    }
}

fn photo_report(job: &Job<'_, Done<'_>>) -> PhotoReport {
    let bad = &job.work.bad;
    PhotoReport {
        photo: PhotoTold::new(&job.paths.input, &job.work.facts),
        blake3: shot::ledger::hash_of(&job.paths.input).ok(),
        bad_pixels: BadReport {
            nan: bad.nan,
            infinite: bad.infinite,
            negative: bad.negative,
            first: bad.first.map(|(column, row, kind)| FirstBad { column, row, kind: kind_name(kind) }),
        },
    }
}

/// What is wrong with a pixel, in a word.
pub fn kind_name(kind: BadKind) -> &'static str {
    match kind {
        BadKind::Nan => "NaN",
        BadKind::Infinite => "infinite",
        BadKind::Negative => "negative",
    }
}

fn scene_report<'a>(scene: &'a Gathered, lens: &'a LookLens, axis: DVec2) -> SceneReport<'a> {
    let found = scene.found.as_ref();
    SceneReport {
        lens: scene.lens.as_ref().map(|lens| lens.name.as_str()),
        optics: if let LookLens::Optical(optical) = lens { Some(optical.section()) } else { None },
        axis: axis.to_array(),
        lights_by: found.map(|found| found.by),
        threshold: found.map(|found| found.threshold),
        regions: found.map(|found| found.regions),
        lights_dropped: found.map(|found| found.dropped),
        dropped_share: found.map(|found| found.dropped_share),
        lights_joined: found.map(|found| found.joined),
        joined_share: found.map(|found| found.joined_share),
        fireflies: found.map(FirefliesJson::from),
        lights: scene
            .lights
            .iter()
            .map(|&Light { position, flux, size, muted }| LightReport {
                position: position.to_array(),
                flux,
                size,
                muted,
            })
            .collect(),
        sources: scene.sources(),
        ghosts: scene.count(),
        rims: scene.images.as_ref().and_then(|images| images.rims()),
    }
}
