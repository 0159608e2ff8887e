//! `vglare animate`: lights that move in a picture, or a camera that moves in a panorama, frame by frame.

mod frame;
mod outputs;
mod parts;
mod plot;
mod report;
mod run;
mod shot;
mod summary;
mod told;

use std::path::PathBuf;

use clap::ValueEnum;

use crate::Result;
use crate::cli::apply::ProofArgs;
use crate::cli::apply::look::LookArgs;
use crate::cli::encoding::EncodingArgs;
use crate::look::Look;
use crate::options::numbers::sides;
use crate::options::{AccuracyArgs, FindArgs, HoodArgs, ReadArgs, SceneArgs, VeilArgs};

pub use run::run;

/// Move lights through a picture, or a camera through a panorama
///
/// A path, a file of rows, says where lights are at which time, or how a camera is held; between its rows they glide. Each frame is the
/// picture of its moment with the glare of its lights, computed to the tolerance and measured. Lights keep their names, and fade as they
/// leave the picture. What stands still is computed once, and a frame in which nothing has moved is the one before, bit for bit.
///
/// The path is CSV with a header. Each row has a `time` in any unit, or the number of a `frame`. Rows of lights have `x` and `y`, in
/// the look's unit from the picture's centre; `light`, a name or number that tells lights apart; and, if need be, `r`, `g`, `b` or
/// `flux`, and `size`. Rows of a camera have `yaw`, `pitch` and `roll` in degrees and, if need be, `fov`; they need --panorama.
/// docs/animate.md has it all.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The photo behind moving lights, which stands still [default: black]
    #[arg(value_name = "PHOTO")]
    photo: Option<PathBuf>,

    /// The pictures, as out.####.png: .exr .hdr .pfm .tif .tiff .png .jpg .jpeg. ####, or %04d, becomes the frame's number, {name} the
    /// path's name. Where --glare, --plot or --report is given, it may be left out
    #[arg(short, long, value_name = "PATTERN", required_unless_present_any = ["glare", "plot", "report"])]
    output: Option<PathBuf>,

    /// Replace files that exist
    #[arg(long)]
    force: bool,

    /// Say nothing but errors and warnings
    #[arg(short, long, conflicts_with = "verbose")]
    quiet: bool,

    /// Say more: a line for each frame
    #[arg(short, long)]
    verbose: bool,

    #[command(flatten)]
    motion: MotionArgs,

    #[command(flatten)]
    hood: HoodArgs,

    #[command(flatten)]
    reading: ReadArgs,

    #[command(flatten)]
    scene: SceneArgs,

    #[command(flatten)]
    veil: VeilArgs,

    #[command(flatten)]
    find: FindArgs,

    #[command(flatten)]
    look: LookArgs,

    #[command(flatten)]
    accuracy: AccuracyArgs,

    #[command(flatten)]
    proof: ProofArgs,

    #[command(flatten)]
    outputs: OutputArgs,
}

const EXAMPLES: &str = "\
Examples:
  vglare animate --lens double-gauss --path lamp.csv --frames 120 -o out.####.png
  vglare animate night.exr --path car.csv --frames 48 -o out.####.exr --glare glare.####.exr --report report.json
  vglare animate night.exr --path car.csv --frames 48 -o out.####.png --lamps hidden --outside keep
  vglare animate --path pan.csv --panorama street.exr --frames 240 --frame 1280x720 -o pan.####.png
  vglare animate --path lamp.csv --frames 1 --frame 960x540 -o still.####.png";

/// What moves, and how.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Motion")]
struct MotionArgs {
    /// The path of the lights, or of the camera
    #[arg(long, value_name = "CSV")]
    path: PathBuf,

    /// How many frames there are: the first at the path's first row, the last at its last [default: where rows have a `frame`, as many as
    /// these count]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: Option<u32>,

    /// The number of the first frame [default: 1, or that of the first row's `frame`]
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    first: Option<i32>,

    /// The pictures' columns and rows, where no photo gives them [default: 1920x1080]
    #[arg(long, value_name = "WxH", value_parser = sides, conflicts_with = "photo")]
    frame: Option<[u32; 2]>,

    /// What a camera sees: a picture of all directions, twice as wide as high, whose centre is at yaw 0
    #[arg(long, value_name = "FILE", conflicts_with = "photo")]
    panorama: Option<PathBuf>,

    /// Whether what the camera does not see of the panorama shines, too: it scatters light over the picture, and its lights make ghosts
    #[arg(long, value_enum, default_value_t = Lit::Lit, requires = "panorama")]
    surroundings: Lit,

    /// Whether the lights of the path are drawn, too, as lamps of their size, or only their glare is seen
    #[arg(long, value_enum, default_value_t = Seen::Shown)]
    lamps: Seen,

    /// What becomes of a light that leaves the picture: it fades by the share of it that is inside, or goes on shining from
    /// outside
    #[arg(long, value_enum, default_value_t = Outside::Fade)]
    outside: Outside,
}

/// `--lamps`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
enum Seen {
    Shown,
    Hidden,
}

/// `--outside`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
enum Outside {
    Fade,
    Keep,
}

/// `--surroundings`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
enum Lit {
    Lit,
    Dark,
}

/// What is written beside the pictures, and how.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Output")]
struct OutputArgs {
    /// Write the glare alone, as it was added; scene-linear, in any format
    #[arg(long, value_name = "PATTERN")]
    glare: Option<PathBuf>,

    /// Draw the mean glare of each frame over the frames, as .svg or .png
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,

    /// Write what was computed, how, how exactly and how fast, frame by frame, as JSON
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,

    #[command(flatten)]
    encoding: EncodingArgs,
}

impl Args {
    /// The look that the files and options give; whether what it has in degrees is known is another matter.
    fn look(&self) -> Result<Look> {
        let (tolerance, aperture) = (self.accuracy.tolerance(), &self.scene.optics.aperture);
        let look = self.look.over(self.veil.over(self.scene.look(&self.find)?, tolerance, aperture)?);
        let (find, accuracy) = (self.find.over(look.find), self.accuracy.over(look.accuracy));
        Ok(Look { find, accuracy, ..look })
    }

    /// Columns and rows where no photo gives them.
    fn sides(&self) -> [u32; 2] {
        self.motion.frame.unwrap_or([1920, 1080])
    }
}
