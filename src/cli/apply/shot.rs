//! How several photos are gone through.

use std::path::{Path, PathBuf};

use super::Args;
use super::fault::Fault;
use super::lock::{Lock, Locked};
use super::outputs::Paths;
use super::workers::Part;
use crate::cli::encoding::EncodingArgs;
use crate::job::Done;
use crate::photo::ReadOptions;
use crate::shot::{Frames, Ledger, Measured};
use crate::{Result, limits};

/// How several photos are gone through.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Several photos")]
pub struct ShotArgs {
    /// The frames of INPUT's pattern that are done, or of the photos by the numbers in their names: 1001-1240, 1001-1240x2 or
    /// 1,3,7-20:2, each once and in this order; numbers may be negative, and ranges run downwards. Where some are missing, all of those are named
    /// and nothing is done, unless --keep-going does the others [default: all that are there]
    #[arg(long, value_name = "RANGES", allow_hyphen_values = true)]
    pub(super) frames: Option<Frames>,

    /// Go on where an earlier run ended: photos are left out whose pictures are there, whole, and made of the same photo with the
    /// same options by the same version; others are done, and replace what is there
    ///
    /// Each run of several photos keeps what it takes to know that in the hidden folder .vglare beside the pictures. Size and
    /// time of a file tell whether it has changed, and its hash where they differ.
    #[arg(long)]
    pub(super) resume: bool,

    /// What is chosen once for a shot, by one of its frames, so that glare does not jump from frame to frame: the threshold that tells lights,
    /// how much brighter clipped highlights shine (--recover auto), and the range of --normalize minmax
    ///
    /// `first` is the first frame that is there of the pattern, whichever are done, or the first photo; a number names
    /// another frame; with `none` each photo is taken by itself. What an option or a file says is as it says.
    #[arg(long = "lock-from", alias = "lock", value_name = "first|FRAME|none", allow_hyphen_values = true)]
    pub(super) lock: Option<Lock>,

    /// Where a photo cannot be done, or a frame is missing, go on with the others and fail at the end, instead of stopping there
    #[arg(long)]
    pub(super) keep_going: bool,

    /// Finish each photo before the next is read: with one photo in memory at a time instead of up to three
    #[arg(long)]
    one_by_one: bool,

    /// So many processes of vglare share the photos, which is faster where one does not keep the machine busy, and takes as much memory again for each;
    /// one that ends before its photos are done is told, and with --keep-going the others go on
    #[arg(long, value_name = "COUNT", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=256))]
    pub(super) jobs: u32,

    /// The photos of this process, one of several of --jobs, which tells what becomes of them as JSON
    #[arg(long, value_name = "INDEX/COUNT", hide = true)]
    pub(super) among: Option<Part>,

    /// Panic in a step of one photo, to test that the others are done; see src/cli/apply/fault.rs
    #[arg(long, value_name = "STEP:PHOTO", hide = true)]
    pub(super) panic_in: Option<Fault>,
}

impl ShotArgs {
    /// Whether the next photo is read and the last written while one is computed: not where memory is limited, since what
    /// a driver can have then must not change under its hands.
    pub fn side_by_side(&self) -> bool {
        !self.one_by_one && !limits::memory_is_limited()
    }
}

/// All that a picture depends on, beside the photo, the program and what computes it.
#[derive(Debug)]
#[expect(dead_code, reason = "they are shown as a whole")]
struct Settings<'a> {
    look: crate::scene::SceneFile,
    reading: ReadOptions,
    encoding: &'a EncodingArgs,
    map_range: Option<[f64; 2]>,
    verify: crate::certificate::Verify,
    range: Option<[f32; 2]>,
}

/// The ledger of photos with a look.
///
/// # Errors
/// [`Error::SceneFile`] where a file of the look can no longer be read.
pub fn ledger(args: &Args, locked: &Locked) -> Result<Ledger> {
    let settings = Settings {
        look: locked.look.to_scene(),
        reading: args.reading.of_white(args.veil.white_luminance()),
        encoding: &args.output_options.encoding,
        map_range: args.output_options.map_range,
        verify: args.proof.verify,
        range: locked.range,
    };
    let files = args.scene.files().into_iter().chain(args.veil.files().cloned());
    // A lens that comes with vglare is named where a file could be.
    Ledger::new(&settings, files.filter(|path| path.is_file()))
}

/// The files that a photo becomes, as the ledger knows them.
pub fn outputs(paths: &Paths) -> Vec<&Path> {
    paths.files().map(PathBuf::as_path).collect()
}

/// How far the ghosts of a photo and its veil are from the truth, as the ledger keeps it.
pub fn measured(done: &Done<'_>) -> [Option<Measured>; 2] {
    let glare = done.computed.as_ref().map(|computed| {
        let certificate = &computed.certificate;
        Measured { predicted: certificate.predicted, measured: certificate.measured, asked: certificate.asked }
    });
    let veil = done.veiled.as_ref().map(|veiled| {
        let error = &veiled.error;
        Measured { predicted: error.predicted, measured: error.measured, asked: error.asked }
    });
    [glare, veil]
}
