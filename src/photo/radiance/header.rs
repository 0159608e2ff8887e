//! The header of a Radiance picture: \[FMT\] Greg Ward, "Radiance File Formats", the section on pictures.

use std::io::{BufRead, Read as _, Write};

use glam::DVec2;

use super::super::camera::Camera;
use super::super::luminance::{RADIANCE_EFFICACY, Said};
use super::super::{Photo, Primaries, Reason};

/// Headers list the commands that made a picture; one longer than this is none.
const LONGEST: u64 = 1 << 20;

/// What the lines before the pixels say.
#[derive(Debug, Clone)]
pub struct Header {
    /// The lines that are carried, as they are: all but those that follow from the photo itself.
    lines: Vec<Vec<u8>>,
    /// The product of all EXPOSURE and COLORCORR: what the original light of each colour was multiplied by; NaN where a line of
    /// them is no number.
    exposure: [f64; 3],
    /// Whether it names an EXPOSURE.
    names_exposure: bool,
    /// Whether the pixels are CIE XYZ.
    pub xyz: bool,
    pub primaries: Option<Primaries>,
    /// Whether its PRIMARIES span no colour space.
    pub lost_primaries: bool,
    /// Height of a pixel over its width.
    aspect: f64,
    /// The camera by VIEW.
    camera: Option<Camera>,
    /// In which order the pixels stand.
    pub order: Order,
}

/// The resolution line: how many pixels, and how they follow each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Order {
    pub width: u32,
    pub height: u32,
    /// Whether scanlines are columns.
    pub columns: bool,
    /// Whether they go, or lie, from the right.
    pub from_right: bool,
    /// Whether they go, or lie, from the bottom.
    pub from_bottom: bool,
}

impl Header {
    /// Reads up to the pixels.
    ///
    /// # Errors
    /// Where there is no header, or one of another kind of file, or of no end.
    pub fn read(mut reader: impl BufRead) -> Result<Self, Reason> {
        let order = Order { width: 0, height: 0, columns: false, from_right: false, from_bottom: false };
        let mut header = Self {
            lines: Vec::new(),
            exposure: [1.0; 3],
            names_exposure: false,
            xyz: false,
            primaries: None,
            lost_primaries: false,
            aspect: 1.0,
            camera: None,
            order,
        };
        let mut left = LONGEST;
        loop {
            let mut line = Vec::new();
            left -= reader.by_ref().take(left).read_until(b'\n', &mut line)? as u64;
            if line.pop() != Some(b'\n') {
                return Err(match left {
                    0 => "its header does not end".into(),
                    _ => {
                        "the file is cut short in its header, or lacks the line of its size, like -Y 480 +X 640".into()
                    }
                });
            }
            line.pop_if(|last| *last == b'\r');
            // Some writers leave the blank line out.
            if let Some(order) = Order::parse(&line) {
                header.order = order;
                return Ok(header);
            }
            header.take(line)?;
        }
    }

    fn take(&mut self, line: Vec<u8>) -> Result<(), Reason> {
        let text = String::from_utf8_lossy(&line);
        // What a line means counts for pictures that this one was made of, where it is indented.
        let (name, value) = text.split_once('=').unwrap_or((&text, ""));
        let numbers = |count: usize| {
            let numbers: Option<Vec<f64>> = value.split_whitespace().map(|word| word.parse().ok()).collect();
            numbers.filter(|numbers| numbers.len() == count && numbers.iter().all(|n| n.is_finite()))
        };
        match name {
            "FORMAT" => match value.trim() {
                "32-bit_rle_rgbe" => return Ok(()),
                "32-bit_rle_xyze" => self.xyz = true,
                other => return Err(format!("its pixels are {other:?}; vglare reads 32-bit_rle_rgbe and _xyze").into()),
            },
            "PRIMARIES" => {
                let point = |n: &[f64], at: usize| DVec2::new(n[at], n[at + 1]);
                let of = |n: Vec<f64>| Primaries {
                    red: point(&n, 0),
                    green: point(&n, 2),
                    blue: point(&n, 4),
                    white: point(&n, 6),
                };
                self.primaries = numbers(8).map(of).and_then(Primaries::sound);
                self.lost_primaries = self.primaries.is_none();
            }
            "PIXASPECT" => self.aspect *= numbers(1).map_or(1.0, |n| if n[0] > 0.0 { n[0] } else { 1.0 }),
            _ => {
                match name {
                    "EXPOSURE" => {
                        self.names_exposure = true;
                        self.multiply(numbers(1).map_or([f64::NAN; 3], |n| [n[0]; 3]));
                    }
                    "VIEW" => self.camera = view(value),
                    "COLORCORR" => self.multiply(numbers(3).map_or([f64::NAN; 3], |n| [n[0], n[1], n[2]])),
                    _ => {}
                }
                if !line.is_empty() && !line.starts_with(b"#?") {
                    self.lines.push(line);
                }
            }
        }
        Ok(())
    }

    /// What the original light of red, green and blue was multiplied by; NaN where that is not known.
    pub fn exposure(&self) -> [f64; 3] {
        self.exposure
    }

    /// A negative or vanishing factor is none, and cannot be made up for by another.
    fn multiply(&mut self, by: [f64; 3]) {
        (0..3).for_each(|c| self.exposure[c] *= if by[c] > 0.0 { by[c] } else { f64::NAN });
    }

    /// What its numbers are in cd/m²: over EXPOSURE and COLORCORR, W/(sr m²) of white light, but lm/(sr m²) where they are XYZ.
    pub fn luminance(&self) -> Said {
        // Of XYZ, Y is luminance.
        let factors = if self.xyz { [self.exposure[1]; 3] } else { self.exposure };
        let efficacy = if self.xyz { 1.0 } else { RADIANCE_EFFICACY };
        let unit = if self.xyz { "its Radiance header, Y in lm/(sr m²)" } else { "its Radiance header, 179 lm/W" };
        let [red, green, blue] = factors;
        let from = match (self.names_exposure, red == green && green == blue) {
            _ if factors.iter().any(|factor| factor.is_nan()) => "its EXPOSURE or COLORCORR".to_owned(),
            (false, true) => format!("{unit}, no EXPOSURE"),
            (true, true) => format!("{unit} over an EXPOSURE of {green}"),
            (_, false) => format!("{unit} over EXPOSURE and COLORCORR of {red}, {green} and {blue}"),
        };
        Said { channels: factors.map(|factor| efficacy / factor), from, explicit: self.names_exposure }
    }

    /// What the same lines say of numbers that are RGB, in cd/m².
    fn as_rgb(&self) -> [f64; 3] {
        self.exposure.map(|factor| RADIANCE_EFFICACY / factor)
    }

    /// The camera, where VIEW tells of one that looks straight at the picture.
    pub fn camera(&self) -> Option<Camera> {
        self.camera
    }

    /// Width of a pixel over its height.
    pub fn pixel_aspect(&self) -> f64 {
        Some(self.aspect.recip()).filter(|aspect| aspect.is_normal()).unwrap_or(1.0)
    }
}

/// The field of a view in perspective, `-vtv`, which is the default, that looks at the picture's middle: rview(1).
fn view(options: &str) -> Option<Camera> {
    let words: Vec<&str> = options.split_whitespace().collect();
    let number = |name: &str| {
        let at = words.iter().rposition(|word| *word == name)?;
        words.get(at + 1)?.parse::<f64>().ok()
    };
    let is_perspective = words.iter().rev().find_map(|word| word.strip_prefix("-vt")).is_none_or(|kind| kind == "v");
    let is_straight = ["-vs", "-vl"].iter().all(|name| number(name).is_none_or(|shift| shift == 0.0));
    let angles = [number("-vh"), number("-vv")];
    if is_perspective && is_straight { Camera::of_angles(angles) } else { None }
}

impl Order {
    /// `-Y 480 +X 640`: the first axis goes from scanline to scanline, the second along them; Y points up.
    fn parse(line: &[u8]) -> Option<Self> {
        // Indented, it would be another picture's.
        line.first().filter(|first| b"+-".contains(first))?;
        let words: Vec<&str> = std::str::from_utf8(line).ok()?.split_ascii_whitespace().collect();
        let &[slow, lines, fast, length] = &words[..] else { return None };
        let (lines, length) = (lines.parse().ok()?, length.parse().ok()?);
        let (columns, x, y) = match (slow, fast) {
            ("-Y" | "+Y", "+X" | "-X") => (false, fast, slow),
            ("+X" | "-X", "-Y" | "+Y") => (true, slow, fast),
            _ => return None,
        };
        let (width, height) = if columns { (lines, length) } else { (length, lines) };
        Some(Self { width, height, columns, from_right: x == "-X", from_bottom: y == "+Y" })
    }

    /// Scanlines, and pixels in each.
    pub fn lines(&self) -> (u32, u32) {
        if self.columns { (self.width, self.height) } else { (self.height, self.width) }
    }

    /// Where the pixel in column `x` of row `y`, from the top left, stands in the file.
    pub fn index(&self, x: usize, y: usize) -> usize {
        let (width, height) = (self.width as usize, self.height as usize);
        let x = if self.from_right { width - 1 - x } else { x };
        let y = if self.from_bottom { height - 1 - y } else { y };
        if self.columns { x * height + y } else { y * width + x }
    }
}

/// Writes a photo's header, with all that its own held if it came from a Radiance file, and with `primaries`.
///
/// # Errors
/// Where the system refuses.
pub fn write(mut writer: impl Write, photo: &Photo, primaries: Option<Primaries>) -> Result<(), Reason> {
    writer.write_all(b"#?RADIANCE\n")?;
    // Written as RGB, the numbers are again what the header's own lines make of them, or another line says it.
    let own = photo.source.radiance.as_deref();
    let said = photo.source.luminance.as_ref();
    let exposure = said.filter(|said| own.is_none_or(|own| own.as_rgb() != said.channels)).and_then(Said::white);
    for line in own.iter().flat_map(|header| &header.lines) {
        if exposure.is_some() && [&b"EXPOSURE="[..], b"COLORCORR="].iter().any(|name| line.starts_with(name)) {
            continue;
        }
        writer.write_all(line)?;
        writer.write_all(b"\n")?;
    }
    if let Some(white) = exposure {
        writeln!(writer, "EXPOSURE= {}", RADIANCE_EFFICACY / white)?;
    }
    if let Some(Primaries { red, green, blue, white }) = primaries {
        let points = [red, green, blue, white].map(|p| format!("{} {}", p.x, p.y));
        writeln!(writer, "PRIMARIES= {}", points.join(" "))?;
    }
    if photo.source.pixel_aspect != 1.0 {
        writeln!(writer, "PIXASPECT= {}", photo.source.pixel_aspect.recip())?;
    }
    write!(writer, "FORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", photo.height(), photo.width())?;
    Ok(())
}
