//! `vglare measure`: how black a black spot in a bright field is, through a look or in a photo.

mod closed;
mod draw;
mod field;
mod spots;
#[cfg(test)]
mod tests;
mod told;

use std::path::{Path, PathBuf};

use crate::chart::Kind;
use crate::gpu::Device;
use crate::job::{Computer, Done, Found, Stages, Unwatched, Wanted};
use crate::look::{Look, LookLens};
use crate::options::numbers::{not_negative, positive};
use crate::options::{AccuracyArgs, FindArgs, ReadArgs, SceneArgs, VeilArgs};
use crate::photo::{self, Photo, WhiteLuminance, WriteOptions};
use crate::scene::SENSOR;
use crate::terminal::progress::Progress;
use crate::terminal::{stderr, stdout};
use crate::{Error, Result, target};

use closed::ClosedArgs;
use field::{Field, Place};
use spots::SpotArg;
use told::Told;

/// Measure a veiling glare index: how bright a black spot in a bright field is
///
/// In the manner of ISO 9358, without a claim to conform: an even field with black spots in the middle and as near to a side, the top and a corner
/// as the spot's surroundings are in the picture; the index is what falls on the centre of a spot, as a share of the mean on the field at one and a half
/// diameters from there. The chart is seen through a look as `vglare apply` computes it, every pixel a source, and each index has the bound that
/// follows from the look's; the field ends with the picture.
///
/// Of a lens that is known by its surfaces there is the same index in closed form, too, by integrals of its ghosts and its veil over the field, without a
/// picture; and by exact rays with --rays.
///
/// With a photo of such a chart, the index of each --spot, with its standard error by what pixels differ.
///
/// --luminance says what the chart's field, or the photo's white, is in cd/m²; then spots and fields are told in that, too.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// A photo of black spots in a bright field, in place of a look
    #[arg(value_name = "PHOTO", requires = "spot")]
    photo: Option<PathBuf>,

    /// A spot of the photo: column and row of its centre from the top left, and its diameter, in pixels; may be given several times
    #[arg(long, value_name = "X,Y,DIAMETER", requires = "photo")]
    spot: Vec<SpotArg>,

    /// Diameters of the chart's spots, in degrees
    #[arg(long, value_name = "DEGREES,…", value_delimiter = ',', default_values_t = [0.5, 1.0, 2.0], value_parser = positive)]
    diameters: Vec<f64>,

    /// Columns and rows of the chart's picture
    #[arg(long, value_name = "WxH", default_value = "720x480", value_parser = size)]
    pixels: [u32; 2],

    /// Write the chart with spots of the first diameter, as it is before any glare
    #[arg(long, value_name = "FILE", conflicts_with = "photo")]
    chart: Option<PathBuf>,

    /// Draw the index by the spots' diameters: .svg or .png
    #[arg(short, long, value_name = "FILE", conflicts_with = "photo")]
    output: Option<PathBuf>,

    /// Print JSON
    #[arg(long)]
    json: bool,

    /// Replace files that exist
    #[arg(long)]
    force: bool,

    /// What the glare is multiplied by, 0 or more [default: 1]
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = not_negative)]
    strength: Option<f64>,

    #[command(flatten)]
    closed: ClosedArgs,

    #[command(flatten)]
    reading: ReadArgs,

    #[command(flatten)]
    scene: SceneArgs,

    #[command(flatten)]
    veil: VeilArgs,

    #[command(flatten)]
    accuracy: AccuracyArgs,
}

const EXAMPLES: &str = "\
Examples:
  vglare measure                                              The default preset
  vglare measure --preset vintage-uncoated -o index.svg
  vglare measure --lens double-gauss --coating none --fstop 4
  vglare measure --lens tessar --coating none --fstops 3.5,5.6,8 --angles 0,5,10,15
  vglare measure --lens double-gauss --method closed --rays 4096
  vglare measure --veil cie --age 60 --fov 50 --lens none
  vglare measure --preset vintage-uncoated --luminance 2000   Spot and field in cd/m², too
  vglare measure chart.exr --spot 480,270,40 --spot 900,60,40";

/// Degrees across a look's picture where neither options nor a lens say it.
const USUAL_FOV: f64 = 40.0;

fn size(text: &str) -> std::result::Result<[u32; 2], String> {
    match text.split_once(['x', 'X']).map(|(width, height)| [width.parse(), height.parse()]) {
        Some([Ok(width @ 16..=16384), Ok(height @ 16..=16384)]) => Ok([width, height]),
        _ => Err("expected WxH, each 16 to 16384 pixels, like 720x480".to_owned()),
    }
}

/// A spot of a chart, seen through a look.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Index {
    /// Where the spot is.
    pub place: &'static str,
    /// Its centre.
    pub pixel: [usize; 2],
    /// From the axis, in degrees.
    pub off_axis_degrees: f64,
    /// In degrees.
    pub diameter_degrees: f64,
    /// What falls on the spot, N, and the mean on the field around it, D, where the field is 1 before any glare: RGB.
    #[serde(skip)]
    pub levels: [[f64; 3]; 2],
    /// RGB, 0 to 1.
    pub index: [f64; 3],
    /// How far it may be off, RGB.
    pub bound: [f64; 3],
}

/// Measures, prints and draws.
///
/// # Errors
/// [`Error::Usage`] for a chart or a spot that cannot be; those of reading, of the look and of the job.
pub fn run(args: &Args) -> Result<()> {
    if let Some(path) = &args.photo {
        let photo = photo::read_with(path, &args.reading.of_white(args.veil.white_luminance()))?;
        stderr::warn(&photo.source.notes);
        let spots = spots::measured(&photo, &args.spot)?;
        return told::spots(args.json, path, &photo, &spots);
    }
    let outputs: Vec<(&str, &Path)> = [("--chart", &args.chart), ("--output", &args.output)]
        .into_iter()
        .filter_map(|(name, path)| Some((name, path.as_deref()?)))
        .collect();
    let inputs: Vec<PathBuf> = args.scene.files().into_iter().chain(args.veil.files().cloned()).collect();
    let inputs: Vec<(&str, &Path)> = inputs.iter().map(|path| ("which the look is read from", &**path)).collect();
    target::spare(&outputs, &inputs)?;
    let kind = args.output.as_deref().map(Kind::of).transpose()?;
    outputs.iter().try_for_each(|(_, path)| target::check(path, args.force))?;
    let look = look(args)?;
    let white = field_luminance(args)?;
    let [rendered, in_closed_form] = args.closed.methods(&look)?;
    if args.output.is_some() && !rendered {
        return Err(Error::Usage("--output draws what is rendered: leave it out, or give --method both".into()));
    }
    if white.is_some() && !rendered {
        return Err(Error::Usage("--luminance is of what is rendered: leave it out, or give --method both".into()));
    }
    let fov = look.fov.unwrap_or(USUAL_FOV);
    let field = Field::new(args.pixels, fov);
    let mut diameters = args.diameters.clone();
    diameters.sort_by(f64::total_cmp);
    // Spots at angles need no pixels.
    let places = match args.closed.has_angles() {
        true => Vec::new(),
        false => field.places(diameters[diameters.len() - 1], diameters[0])?,
    };
    if let Some(path) = &args.chart {
        let options = WriteOptions { overwrite: args.force, ..WriteOptions::default() };
        photo::write(path, &field.photo(&places, args.diameters[0], 1.0), &options)?;
    }
    let closed = in_closed_form.then(|| args.closed.indices(&look, &field, &places, &diameters)).transpose()?;
    let all = if rendered { all(args, &look, &field, &places, &diameters)? } else { Vec::new() };
    let closed = closed.as_deref();
    let (look, field, places, diameters, all) = (&look, &field, &places, &diameters, &all);
    let told = Told { look, field, fov, places, diameters, all, white, closed };
    if let (Some(path), Some(kind)) = (&args.output, kind) {
        draw::write(path, kind, &told, args.force)?;
    }
    if args.json { told.json() } else { stdout::print(|out| told.table(out)) }
}

/// The index of each place by a chart that is rendered, diameter by diameter.
fn all(args: &Args, look: &Look, field: &Field, places: &[Place], diameters: &[f64]) -> Result<Vec<Index>> {
    let progress = Progress::start(args.json);
    progress.say("opening the device");
    let open = || -> Result<Computer> {
        let device = Device::open(args.accuracy.backend.backends())?;
        let known = args.accuracy.known(Some(device.info()));
        Ok(Computer::new(device, known))
    };
    let mut computer = look.renders().then(open).transpose()?;
    let mut all = Vec::new();
    for &diameter in diameters {
        progress.say(format!("spots of {diameter}°"));
        all.extend(indices(look, field, places, diameter, 1.0, computer.as_mut())?);
    }
    Ok(all)
}

/// What the field of the chart is in cd/m², where that is given.
fn field_luminance(args: &Args) -> Result<Option<f64>> {
    match args.veil.white_luminance() {
        Some(WhiteLuminance::File) => {
            Err(Error::Usage("--luminance file: without a photo there is no file; give the field's cd/m²".into()))
        }
        Some(WhiteLuminance::Given(white)) => Ok(Some(white)),
        None => Ok(None),
    }
}

/// The look that options give, and what its picture spans.
fn look(args: &Args) -> Result<Look> {
    let look = args.scene.look(&FindArgs::default())?;
    let look = args.veil.over(look, args.accuracy.tolerance(), &args.scene.optics.aperture)?;
    let look =
        Look { strength: args.strength.unwrap_or(look.strength), accuracy: args.accuracy.over(look.accuracy), ..look };
    if look.projection() == crate::choices::Projection::Fisheye {
        return Err(Error::Usage("--projection: the chart is of a rectilinear camera, and no fisheye's".into()));
    }
    let of_lens = match &look.lens {
        LookLens::Optical(optical) => {
            let [width, height] = optical.section().sensor.unwrap_or(SENSOR);
            // The picture's longer side spans the sensor's.
            let [columns, rows] = args.pixels.map(f64::from);
            let half = 0.5 * width.max(height) * columns / columns.max(rows);
            Some(2.0 * (half / optical.ghosts().image_per_tangent.abs()).atan().to_degrees())
        }
        _ => None,
    };
    Ok(Look { fov: Some(look.fov.or(of_lens).unwrap_or(USUAL_FOV)), ..look })
}

/// The index of each place, through a look, of spots of one diameter in a field of this luminance.
fn indices(
    look: &Look,
    field: &Field,
    places: &[Place],
    diameter: f64,
    level: f32,
    computer: Option<&mut Computer>,
) -> Result<Vec<Index>> {
    let wanted = Wanted { glare: true, ..Wanted::default() };
    let photo = field.photo(places, diameter, level);
    let done = Found::new(look, photo, Stages::default())?.compute(computer, wanted, &Unwatched)?;
    done.check()?;
    let (Some(picture), Some(glare)) = (&done.picture, &done.glare) else {
        return Err(Error::Internal { what: "a picture that was wanted is not there".into() });
    };
    let width = field.size[0] as usize;
    let of = |place: &Place| {
        let read = |photo: &Photo, [x, y]: [usize; 2], c: usize| f64::from(photo.pixels[y * width + x][c]);
        let ring = field.ring(place, diameter);
        let mean = |photo: &Photo, c: usize| ring.iter().map(|&at| read(photo, at, c)).sum::<f64>() / ring.len() as f64;
        let index = |c: usize| {
            let (spot, around) = (read(picture, place.pixel, c), mean(picture, c));
            let off = [read(glare, place.pixel, c), mean(glare, c)].map(|glare| bound(&done, c, glare));
            let index = if around > 0.0 { spot / around } else { 0.0 };
            [index, (off[0] + index * off[1]) / (around - off[1]), spot, around]
        };
        let (both, level) = ([0, 1, 2].map(index), f64::from(level));
        Index {
            place: place.name,
            pixel: place.pixel,
            off_axis_degrees: field.off_axis(place.pixel),
            diameter_degrees: diameter,
            levels: [both.map(|[_, _, spot, _]| spot / level), both.map(|[.., around]| around / level)],
            index: both.map(|[index, ..]| index),
            bound: both.map(|[_, bound, ..]| bound),
        }
    };
    Ok(places.iter().map(of).collect())
}

/// By how much a channel's glare, which is so much there, is off at most: its ghosts by their largest, its veil by itself.
fn bound(done: &Done<'_>, channel: usize, glare: f64) -> f64 {
    let ghosts = done.computed.as_ref().map_or(0.0, |computed| {
        done.look.strength * computed.certificate.predicted * computed.planning.plan.scale[channel]
    });
    let veil = done.veiled.as_ref().map_or(0.0, |veiled| veiled.error.predicted * (glare.abs() + ghosts));
    ghosts + veil
}
