//! What a directory says of its picture: how samples are stored, and where.

use std::io::{Read, Seek};

use super::super::read::{MAX_PIXELS, check_size};
use super::super::{Alpha, Reason};
use super::compression::Compression;
use super::directory::{Directory, File, tag};

pub(super) const CFA: u64 = 32803;
pub(super) const LINEAR_RAW: u64 = 34892;

/// What the colour samples of a pixel are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Colour {
    /// Grey, black is zero.
    Grey,
    /// Grey, white is zero.
    GreyInverted,
    Rgb,
    /// An index into a table of colours.
    Palette,
    /// Cyan, magenta, yellow and black ink.
    Cmyk,
    YCbCr,
    /// CIE L*a*b*, a* and b* signed.
    CieLab,
    /// The same with an offset instead of a sign, as ICC profiles have it.
    IccLab,
    /// Logarithm of luminance.
    LogL,
    /// The same with CIE u' and v', in one code.
    LogLuv,
}

impl Colour {
    /// Samples of a pixel that make its colour.
    pub fn samples(self) -> usize {
        match self {
            Self::Grey | Self::GreyInverted | Self::Palette | Self::LogL | Self::LogLuv => 1,
            Self::Rgb | Self::YCbCr | Self::CieLab | Self::IccLab => 3,
            Self::Cmyk => 4,
        }
    }
}

/// What the bits of a sample are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Unsigned,
    Signed,
    Float,
}

pub(super) struct Layout {
    pub width: u32,
    pub height: u32,
    pub colour: Colour,
    pub kind: Kind,
    /// Bits of a sample.
    pub bits: u32,
    /// Samples of a pixel, spare ones included.
    pub samples: usize,
    /// Those that are read: the colours, then alpha if there is one.
    pub kept: Vec<usize>,
    pub alpha: Alpha,
    /// Whether each sample of the pixels is stored by itself.
    pub planar: bool,
    pub compression: Compression,
    /// Whether the strips or tiles, pictures of their own, become RGB when they are unpacked.
    pub converted: bool,
    /// 1 none, 2 differences of integers, 3 of the bytes of floats.
    pub predictor: u64,
    /// Whether the lowest bit of a byte comes first.
    pub lowest_bit_first: bool,
    pub big_endian: bool,
    /// Columns and rows of the picture to which there is one sample of Cb and Cr.
    pub subsampling: (u32, u32),
    pub grid: Grid,
}

/// How the picture is cut into strips or tiles.
pub(super) struct Grid {
    pub tiled: bool,
    /// Size of a strip or tile in pixels.
    pub size: (u32, u32),
    /// How many there are side by side, and above one another.
    pub count: (u32, u32),
    /// Offsets and bytes of all, plane by plane.
    pub pieces: Vec<(u64, u64)>,
}

impl Layout {
    pub fn of<R: Read + Seek>(file: &mut File<R>, page: &Directory) -> Result<Self, Reason> {
        let (width, height) = (side(file, page, tag::WIDTH)?, side(file, page, tag::HEIGHT)?);
        check_size(width, height)?;
        let compression = Compression::of(file, page)?;
        let samples = file.number(page, tag::SAMPLES_PER_PIXEL)?.unwrap_or(1);
        let samples = usize::try_from(samples).ok().filter(|n| (1..=65535).contains(n));
        let samples = samples.ok_or("it says that its pixels have no samples, or more than 65535")?;
        let mut colour = colour(file, page, samples, compression)?;
        // The tags speak of the three numbers that the codes of LogLuv become, and of one for LogL.
        let logarithmic = matches!(colour, Colour::LogL | Colour::LogLuv);
        let samples = if logarithmic { 1 } else { samples };
        if samples < colour.samples() {
            return Err(format!("its pixels have {samples} samples, too few for their colour").into());
        }
        let (kept, alpha) = kept(file, page, colour, samples)?;
        let subsampling = subsampling(file, page, colour, compression)?;
        let planar = samples > 1 && file.number(page, tag::PLANAR_CONFIGURATION)? == Some(2);
        if planar && colour == Colour::YCbCr && subsampling != (1, 1) {
            return Err("it holds YCbCr planes of differing sizes, which vglare does not read".into());
        }
        let bits = match colour {
            Colour::LogL => 16,
            Colour::LogLuv => 32,
            _ => bits(file, page, samples)?,
        };
        let converted = compression.is_picture() && colour == Colour::YCbCr && !planar;
        if converted {
            colour = Colour::Rgb;
        }
        let grid = Grid::of(file, page, (width, height), if planar { samples } else { 1 }, compression)?;
        Self {
            width,
            height,
            colour,
            kind: kind(file, page, colour)?,
            bits,
            samples,
            kept,
            alpha,
            planar,
            compression,
            converted,
            predictor: predictor(file, page, compression)?,
            lowest_bit_first: file.number(page, tag::FILL_ORDER)? == Some(2),
            big_endian: file.big_endian,
            subsampling,
            grid,
        }
        .checked()
    }

    /// Refuses combinations that nothing below can make sense of.
    fn checked(self) -> Result<Self, Reason> {
        let Self { bits, kind, .. } = self;
        let depth_is_known = match kind {
            Kind::Float => matches!(bits, 16 | 24 | 32 | 64),
            Kind::Signed => matches!(bits, 8 | 16 | 32),
            Kind::Unsigned => (1..=32).contains(&bits),
        };
        if !depth_is_known {
            let name = match kind {
                Kind::Unsigned => "unsigned integers",
                Kind::Signed => "signed integers",
                Kind::Float => "floats",
            };
            return Err(format!("its samples are {name} of {bits} bit, which vglare does not read").into());
        }
        if self.compression.is_picture() && bits != 8 {
            return Err(format!("it holds JPEG or WebP of {bits} bit, which vglare does not read").into());
        }
        if self.compression.is_fax() && (bits, self.samples) != (1, 1) {
            return Err(format!("it holds a fax of {} samples of {bits} bit", self.samples).into());
        }
        if self.subsampling != (1, 1) && (self.samples != 3 || self.predictor != 1) {
            return Err(
                "it holds subsampled YCbCr with a predictor or spare samples, which vglare does not read".into()
            );
        }
        let fits = match self.colour {
            Colour::Palette => kind == Kind::Unsigned && bits <= 16,
            Colour::YCbCr => kind == Kind::Unsigned && (bits == 8 || self.subsampling == (1, 1)),
            Colour::CieLab | Colour::IccLab => matches!((kind, bits), (Kind::Unsigned | Kind::Signed, 8 | 16)),
            _ => true,
        };
        if !fits {
            let colour = self.colour;
            return Err(format!("it holds {colour:?} of {bits} bit, which vglare does not read").into());
        }
        if self.predictor == 3 && kind != Kind::Float {
            return Err("it says that its integers are predicted as floats are".into());
        }
        Ok(self)
    }

    /// Samples that stand together for one pixel: all, or one where the planes are apart.
    pub fn together(&self) -> usize {
        if self.planar { 1 } else { self.samples }
    }

    /// Samples of a pixel that are left out.
    pub fn spare(&self) -> usize {
        self.samples - self.kept.len()
    }
}

impl Grid {
    fn of<R: Read + Seek>(
        file: &mut File<R>,
        page: &Directory,
        (width, height): (u32, u32),
        planes: usize,
        compression: Compression,
    ) -> Result<Self, Reason> {
        let tiled = page.has(tag::TILE_OFFSETS) || page.has(tag::TILE_WIDTH);
        let (offsets, bytes, size) = if tiled {
            // Some writers give tiles the tags of strips.
            let offsets = if page.has(tag::TILE_OFFSETS) { tag::TILE_OFFSETS } else { tag::STRIP_OFFSETS };
            let bytes = if page.has(tag::TILE_BYTE_COUNTS) { tag::TILE_BYTE_COUNTS } else { tag::STRIP_BYTE_COUNTS };
            (offsets, bytes, (side(file, page, tag::TILE_WIDTH)?, side(file, page, tag::TILE_LENGTH)?))
        } else {
            let rows = file.number(page, tag::ROWS_PER_STRIP)?.unwrap_or(u64::from(height));
            let rows = rows.clamp(1, u64::from(height)) as u32;
            (tag::STRIP_OFFSETS, tag::STRIP_BYTE_COUNTS, (width, rows))
        };
        if size.0 == 0 || size.1 == 0 || u64::from(size.0) * u64::from(size.1) > MAX_PIXELS as u64 {
            return Err(format!("its tiles are of {} × {} pixels", size.0, size.1).into());
        }
        let count = (width.div_ceil(size.0), height.div_ceil(size.1));
        let name = if tiled { "tiles" } else { "strips" };
        let wanted = (count.0 as usize * count.1 as usize).saturating_mul(planes);
        // Each takes two bytes of the file at least to say where it is.
        if wanted as u64 > 8 + file.length() {
            return Err(format!("the file is cut short: it is too small to hold {wanted} {name}").into());
        }
        let offsets = file.numbers(page, offsets, wanted)?.ok_or("it does not say where its pixels are")?;
        let bytes = file.numbers(page, bytes, wanted)?.unwrap_or_default();
        if offsets.len() < wanted || bytes.len() < wanted && !(bytes.is_empty() && compression.may_lack_sizes(wanted)) {
            let there = offsets.len().min(bytes.len());
            return Err(format!("the file is cut short: it has {there} of {wanted} {name}").into());
        }
        let bytes = bytes.into_iter().chain(std::iter::repeat(0));
        Ok(Self { tiled, size, count, pieces: offsets.into_iter().zip(bytes).collect() })
    }

    /// What a piece is called in an error.
    pub fn name(&self, index: usize) -> String {
        format!("{} {} of {}", if self.tiled { "tile" } else { "strip" }, index + 1, self.pieces.len())
    }
}

fn side<R: Read + Seek>(file: &mut File<R>, page: &Directory, tag: u16) -> Result<u32, Reason> {
    let side = file.number(page, tag)?.ok_or("it does not say how large its picture or its tiles are")?;
    u32::try_from(side).map_err(|_| format!("it says that a side has {side} pixels").into())
}

/// The bits of a sample; alike for all of a pixel.
fn bits<R: Read + Seek>(file: &mut File<R>, page: &Directory, samples: usize) -> Result<u32, Reason> {
    let bits = file.numbers(page, tag::BITS_PER_SAMPLE, samples)?.unwrap_or_else(|| vec![1]);
    let first = *bits.first().ok_or("it does not say how many bits a sample has")?;
    match bits.iter().find(|&&bits| bits != first) {
        None => Ok(u32::try_from(first)?),
        Some(other) => Err(format!("the samples of its pixels have differing depths, {first} and {other} bit").into()),
    }
}

fn kind<R: Read + Seek>(file: &mut File<R>, page: &Directory, colour: Colour) -> Result<Kind, Reason> {
    if matches!(colour, Colour::LogL | Colour::LogLuv) {
        return Ok(Kind::Unsigned);
    }
    match file.number(page, tag::SAMPLE_FORMAT)?.unwrap_or(1) {
        // "Undefined" is read as libtiff reads it.
        0 | 1 | 4 => Ok(Kind::Unsigned),
        2 => Ok(Kind::Signed),
        3 => Ok(Kind::Float),
        5 | 6 => Err("its samples are complex numbers".into()),
        other => Err(format!("its samples are of the unknown format {other}").into()),
    }
}

fn colour<R: Read + Seek>(
    file: &mut File<R>,
    page: &Directory,
    samples: usize,
    compression: Compression,
) -> Result<Colour, Reason> {
    // Files without the tag are told by their samples, as libtiff does.
    let fallback = if samples < 3 { 1 } else { 2 };
    let name = match file.number(page, tag::PHOTOMETRIC)?.unwrap_or(fallback) {
        0 => return Ok(Colour::GreyInverted),
        1 => return Ok(Colour::Grey),
        2 => return Ok(Colour::Rgb),
        3 => return Ok(Colour::Palette),
        5 if file.number(page, tag::INK_SET)?.unwrap_or(1) == 1 => return Ok(Colour::Cmyk),
        6 => return Ok(Colour::YCbCr),
        8 => return Ok(Colour::CieLab),
        9 => return Ok(Colour::IccLab),
        32844 if compression == Compression::SgiLog => return Ok(Colour::LogL),
        32845 if compression == Compression::SgiLog => return Ok(Colour::LogLuv),
        4 => "a mask",
        5 => "inks other than cyan, magenta, yellow and black",
        10 => "ITU Lab",
        CFA | LINEAR_RAW => "a camera's raw data",
        32844 | 32845 => "LogLuv that is not packed in runs",
        51177 => "a depth map",
        other => return Err(format!("its colours are of the unknown kind {other}").into()),
    };
    Err(format!("it holds {name}, which vglare does not read").into())
}

/// The samples that are read, and what alpha is: the first of the extra samples that says that it is alpha.
fn kept<R: Read + Seek>(
    file: &mut File<R>,
    page: &Directory,
    colour: Colour,
    samples: usize,
) -> Result<(Vec<usize>, Alpha), Reason> {
    let colours = colour.samples();
    let extra = match file.numbers(page, tag::EXTRA_SAMPLES, samples)? {
        Some(extra) => extra,
        // Without a word of it a single extra sample is alpha, as everywhere.
        None if samples == colours + 1 && colour != Colour::Palette => vec![2],
        None => Vec::new(),
    };
    let mut kept: Vec<usize> = (0..colours).collect();
    let found = extra.iter().take(samples - colours).position(|&kind| kind == 1 || kind == 2);
    let Some(at) = found else { return Ok((kept, Alpha::None)) };
    kept.push(colours + at);
    Ok((kept, if extra[at] == 1 { Alpha::Premultiplied } else { Alpha::Straight }))
}

fn subsampling<R: Read + Seek>(
    file: &mut File<R>,
    page: &Directory,
    colour: Colour,
    compression: Compression,
) -> Result<(u32, u32), Reason> {
    // JPEG and WebP say it themselves.
    if colour != Colour::YCbCr || compression.is_picture() {
        return Ok((1, 1));
    }
    let given = file.numbers(page, tag::YCBCR_SUBSAMPLING, 2)?.unwrap_or_else(|| vec![2, 2]);
    match given[..] {
        [h @ (1 | 2 | 4), v @ (1 | 2 | 4)] => Ok((h as u32, v as u32)),
        _ => Err(format!("its YCbCr subsampling is {given:?}").into()),
    }
}

fn predictor<R: Read + Seek>(file: &mut File<R>, page: &Directory, compression: Compression) -> Result<u64, Reason> {
    match file.number(page, tag::PREDICTOR)?.unwrap_or(1) {
        _ if !compression.is_predicted() => Ok(1),
        known @ 1..=3 => Ok(known),
        other => Err(format!("its predictor is the unknown {other}").into()),
    }
}
