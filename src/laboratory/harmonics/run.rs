//! The run itself: read, project, turn, write.

use std::time::Instant;

use glam::DQuat;

use super::coefficients::{self, Kind};
use super::{Angles, Args, summary};
use crate::photo::{self, BadPixels, Photo, WriteOptions};
use crate::series::sphere::{Coefficients, Grid, Reading, project_panorama, project_samples, project_turned, turn};
use crate::terminal::progress::Progress;
use crate::terminal::stderr;
use crate::{Error, Result, target};

/// What a run has come to know, for the summary.
pub struct Run<'a> {
    pub args: &'a Args,
    pub panorama: &'a Panorama,
    /// The panorama's own coefficients.
    pub own: Coefficients,
    /// ∫ of the panorama's square over the sphere, all colours.
    pub energy: f64,
    /// The RMS of reconstruction − panorama at the centres of pixels, by solid angle, relative to the panorama's.
    pub error: f64,
    pub check: Option<Check>,
    /// The lowest and the highest value of the picture.
    pub range: [f32; 2],
    pub seconds: f64,
}

/// The turned coefficients against those of the turned panorama: relative differences.
pub struct Check {
    /// Each pixel carried to its place.
    pub carried: f64,
    /// The panorama interpolated, and sampled at rest and turned on a finer grid.
    pub sampled: f64,
    pub fine: Grid,
}

/// Projects a panorama, turns its coefficients and writes what they make.
///
/// # Errors
/// Whatever keeps the picture from being written; nothing is left half-written then.
pub fn run(args: &Args) -> Result<()> {
    let started = Instant::now();
    apart(args)?;
    let progress = Progress::start(args.quiet);
    progress.say("reading the panorama");
    let panorama = Panorama::read(args)?;
    let size =
        args.size.map_or(panorama.grid, |size| Grid { width: size.width as usize, height: size.height as usize });
    check_targets(args, &panorama.output(size, vec![[0.0; 4]; size.width * size.height]))?;

    progress.say("projecting");
    let (grid, read) = (panorama.grid, |row: usize, out: &mut [[f64; 3]]| panorama.row(row, out));
    let own = project_panorama(grid, args.degree, Reading::Areas, read);
    let rotation = args.rotate.map(|Angles(angles)| {
        let [yaw, pitch, roll] = angles.map(f64::to_radians);
        turn(yaw, pitch, roll)
    });
    let turned = rotation.map_or_else(|| own.clone(), |rotation| own.rotated(rotation));
    let check = rotation.filter(|_| args.check).map(|rotation| {
        progress.say("turning the panorama");
        panorama.check(&turned, rotation)
    });

    progress.say("reconstructing");
    let shown = if args.irradiance { turned.irradiance() } else { turned };
    let pixels = shown.to_panorama(size, opaque);
    let (energy, error) = panorama.error(&own, (shown == own && size == grid).then_some(&pixels));
    let range = range(&pixels);

    progress.say("writing");
    if let Some(path) = &args.coefficients {
        let kind = if args.irradiance { Kind::Irradiance } else { Kind::Radiance };
        coefficients::write(path, args, &shown, kind)?;
    }
    photo::write(&args.output, &panorama.output(size, pixels), &write_options(args))?;
    drop(progress);
    let seconds = started.elapsed().as_secs_f64();
    summary::print(&Run { args, panorama: &panorama, own, energy, error, check, range, seconds })
}

fn opaque([r, g, b]: [f64; 3]) -> [f32; 4] {
    [r as f32, g as f32, b as f32, 1.0]
}

fn range(pixels: &[[f32; 4]]) -> [f32; 2] {
    pixels.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], [r, g, b, _]| {
        [low.min(*r).min(*g).min(*b), high.max(*r).max(*g).max(*b)]
    })
}

/// Everything that could keep the results from being written, before the work begins.
/// Whether no file would be written twice, and the panorama only by what becomes of it.
fn apart(args: &Args) -> Result<()> {
    let output = ("--output", args.output.as_path());
    let coefficients = args.coefficients.as_deref().map(|path| ("--coefficients", path));
    let outputs: Vec<_> = std::iter::once(output).chain(coefficients).collect();
    target::spare(&outputs, &[])?;
    target::spare(&outputs[1..], &[("the panorama", &args.panorama)])
}

fn check_targets(args: &Args, output: &Photo) -> Result<()> {
    photo::check_target(&args.output, output, &write_options(args))?;
    if let Some(path) = &args.coefficients {
        coefficients::check(path, args.force)?;
    }
    Ok(())
}

fn write_options(args: &Args) -> WriteOptions {
    WriteOptions {
        format: None,
        depth: None,
        exposure: args.exposure,
        tone_map: None,
        primaries: None,
        overwrite: args.force,
    }
}

/// The picture that was read.
pub struct Panorama {
    pub photo: Photo,
    pub grid: Grid,
    pub bad: BadPixels,
}

impl Panorama {
    fn read(args: &Args) -> Result<Self> {
        let photo = photo::read_with(&args.panorama, &args.reading.options())?;
        stderr::warn(&photo.source.notes);
        let (width, height) = (photo.width(), photo.height());
        if u64::from(width) != 2 * u64::from(height) {
            let reason = format!("a panorama is twice as wide as high, and this is {width} x {height}");
            return Err(Error::read_photo(&args.panorama, reason));
        }
        if args.degree >= height as usize {
            return Err(Error::Usage(format!(
                "--degree {} is beyond what {height} rows can show; {} allows 0 to {}",
                args.degree,
                args.panorama.display(),
                height - 1
            )));
        }
        let bad = photo::survey(&photo);
        Ok(Self { photo, grid: Grid { width: width as usize, height: height as usize }, bad })
    }

    /// A row in f64; what is not finite counts as no light.
    fn row(&self, row: usize, out: &mut [[f64; 3]]) {
        for (out, &pixel) in out.iter_mut().zip(self.photo.picture_row(row as u32).iter()) {
            *out = light(pixel);
        }
    }

    /// The photo to write: of the panorama's primaries, and for a display where it was.
    fn output(&self, size: Grid, pixels: Vec<[f32; 4]>) -> Photo {
        let mut output = Photo::new(size.width as u32, size.height as u32, pixels);
        output.source.primaries = self.photo.source.primaries;
        output.source.display_referred = self.photo.source.display_referred;
        output
    }

    /// The panorama's energy, and the relative RMS error of what `own` makes of it; `drawn` is that, where it is there.
    fn error(&self, own: &Coefficients, drawn: Option<&Vec<[f32; 4]>>) -> (f64, f64) {
        let made;
        let drawn = match drawn {
            Some(drawn) => drawn,
            None => {
                made = own.to_panorama(self.grid, opaque);
                &made
            }
        };
        let row = |row: usize| self.photo.picture_row(row as u32);
        let squares = |[r, g, b]: [f64; 3]| r * r + g * g + b * b;
        let energy = self.grid.integrate(|k| row(k).iter().map(|&pixel| squares(light(pixel))).sum());
        let error = self.grid.integrate(|k| {
            let drawn = &drawn[k * self.grid.width..][..self.grid.width];
            let difference = |ours: [f64; 3], exact: [f64; 3]| [0, 1, 2].map(|i| ours[i] - exact[i]);
            row(k).iter().zip(drawn).map(|(&exact, &ours)| squares(difference(light(ours), light(exact)))).sum()
        });
        (energy, if error == 0.0 { 0.0 } else { (error / energy).sqrt() })
    }

    fn check(&self, turned: &Coefficients, rotation: DQuat) -> Check {
        let read = |row: usize, out: &mut [[f64; 3]]| self.row(row, out);
        let carried = project_turned(self.grid, turned.degree(), rotation, read);
        let carried = turned.difference(&carried);

        let times = (8192 / self.grid.width).clamp(1, 16);
        let fine = Grid { width: times * self.grid.width, height: times * self.grid.height };
        let mut pixels = vec![[0.0; 3]; self.grid.width * self.grid.height];
        pixels.chunks_exact_mut(self.grid.width).enumerate().for_each(|(row, out)| self.row(row, out));
        let pixel = |column: usize, row: usize| pixels[row * self.grid.width + column];
        let back = rotation.inverse();
        let [at_rest, turned] = [DQuat::IDENTITY, back]
            .map(|back| project_samples(fine, turned.degree(), |v| self.grid.interpolate(back * v, pixel)));
        Check { carried, sampled: at_rest.rotated(rotation).difference(&turned), fine }
    }
}

fn light([r, g, b, _]: [f32; 4]) -> [f64; 3] {
    [r, g, b].map(|value| if value.is_finite() { f64::from(value) } else { 0.0 })
}
