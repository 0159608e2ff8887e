//! A path's file: rows of times, and of where lights or a camera are then.

use std::collections::HashMap;
use std::path::Path as FilePath;

use csv::{ErrorKind, StringRecord};

use super::path::{LightPath, Path, Sees};
use super::{Track, VIEW_FOV};
use crate::scene::{self, check_fov};
use crate::{Error, Result};

/// Columns that say when.
const TIMES: [&str; 2] = ["time", "frame"];
/// Columns of lights.
const LIGHTS: [&str; 8] = ["light", "x", "y", "r", "g", "b", "flux", "size"];
/// Columns of a camera.
const CAMERA: [&str; 4] = ["yaw", "pitch", "roll", "fov"];

/// The flux of a light of which none is said: at the default exposure its ghosts through most lenses are seen on black.
pub const FLUX: f64 = 30.0;
/// The size of a light of which none is said, in the look's unit.
pub const SIZE: f64 = 0.01;

/// What a path's file says.
#[derive(Debug, Clone, PartialEq)]
pub struct Said {
    /// What moves.
    pub path: Path,
    /// Whether its times are numbers of frames.
    pub counts_frames: bool,
}

/// What is wrong, and in which line where that is known.
struct Fault {
    line: Option<u64>,
    reason: String,
}

impl Fault {
    fn whole(reason: impl Into<String>) -> Self {
        Self { line: None, reason: reason.into() }
    }

    fn at(line: u64, reason: impl Into<String>) -> Self {
        Self { line: Some(line), reason: reason.into() }
    }
}

/// Reads a path: CSV in UTF-8 with a header; lines that begin with `#` are comments.
///
/// # Errors
/// [`Error::PathFile`], which names the line and the column.
pub fn read_path(file: &FilePath) -> Result<Said> {
    let told = |Fault { line, reason }| Error::PathFile { path: file.to_owned(), line, reason };
    let bytes = scene::contents(file).map_err(Fault::whole).map_err(told)?;
    read(&bytes).map_err(told)
}

/// The rows of a file by the names of its columns.
struct Rows {
    /// The header's line.
    header: u64,
    /// Where each column stands.
    columns: HashMap<String, usize>,
    /// Rows with their lines.
    rows: Vec<(u64, StringRecord)>,
}

fn read(bytes: &[u8]) -> Result<Said, Fault> {
    let rows = Rows::new(bytes)?;
    let any = |names: &[&'static str]| names.iter().copied().find(|name| rows.has(name));
    let path = match (any(&LIGHTS), any(&CAMERA)) {
        (Some(light), Some(camera)) => {
            return Err(Fault::at(
                rows.header,
                format!(
                    "{light} is a column of lights and {camera} one of a camera: a path is of the one or of the other"
                ),
            ));
        }
        (None, None) => {
            return Err(Fault::at(
                rows.header,
                "what moves? Lights have the columns x and y, a camera has yaw, pitch and roll",
            ));
        }
        (Some(_), None) => Path::Lights(rows.lights()?),
        (None, Some(_)) => rows.camera()?,
    };
    Ok(Said { path, counts_frames: rows.has("frame") })
}

impl Rows {
    fn new(bytes: &[u8]) -> Result<Self, Fault> {
        // As spreadsheets begin their files.
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(bytes);
        let broken = |error: csv::Error| broken(&error, bytes);
        let header = reader.headers().map_err(broken)?.clone();
        let first = header.position().map_or(1, |at| line(at, bytes));
        let columns = columns(&header).map_err(|reason| Fault::at(first, reason))?;
        let mut rows = Vec::new();
        for record in reader.into_records() {
            let record = record.map_err(broken)?;
            rows.push((record.position().map_or(0, |at| line(at, bytes)), record));
        }
        if rows.is_empty() {
            return Err(Fault::whole("it has no rows, and the least is one"));
        }
        Ok(Self { header: first, columns, rows })
    }

    fn has(&self, column: &str) -> bool {
        self.columns.contains_key(column)
    }

    /// A number of a row, or what it is where there is no such column.
    fn number(&self, (line, record): &(u64, StringRecord), column: &str, unsaid: f64) -> Result<f64, Fault> {
        let Some(&at) = self.columns.get(column) else { return Ok(unsaid) };
        let text = record.get(at).unwrap_or_default();
        // As f32 holds them, which the device computes with.
        let fits = |number: &f64| number.abs() <= f64::from(f32::MAX);
        text.parse::<f64>()
            .ok()
            .filter(fits)
            .ok_or_else(|| Fault::at(*line, format!("{column}: expected a finite number, found {text:?}")))
    }

    /// The same of what is never negative.
    fn not_negative(&self, row: &(u64, StringRecord), column: &str, unsaid: f64) -> Result<f64, Fault> {
        let number = self.number(row, column, unsaid)?;
        if number < 0.0 {
            return Err(Fault::at(row.0, format!("{column}: expected 0 or more, found {number}")));
        }
        Ok(number)
    }

    fn time(&self, row: &(u64, StringRecord)) -> Result<f64, Fault> {
        let column = if self.has("frame") { "frame" } else { "time" };
        let time = self.number(row, column, 0.0)?;
        if column == "frame" && (time.fract() != 0.0 || time.abs() > f64::from(i32::MAX)) {
            return Err(Fault::at(row.0, format!("frame: expected a whole number, found {time}")));
        }
        Ok(time)
    }

    fn lights(&self) -> Result<Vec<LightPath>, Fault> {
        if let Some(missing) = ["x", "y"].into_iter().find(|column| !self.has(column)) {
            return Err(Fault::at(self.header, format!("the column {missing} is missing, which lights need")));
        }
        let coloured = ["r", "g", "b"].into_iter().filter(|column| self.has(column)).count();
        if !matches!(coloured, 0 | 3) {
            return Err(Fault::at(self.header, "of the columns r, g and b there are all three or none"));
        }
        let flux = if coloured == 3 { 1.0 } else { FLUX };
        let mut order: Vec<String> = Vec::new();
        let mut lights: HashMap<String, Vec<(f64, [f64; 6])>> = HashMap::new();
        for row in &self.rows {
            let name = self.columns.get("light").and_then(|&at| row.1.get(at)).unwrap_or("light");
            if name.is_empty() {
                return Err(Fault::at(row.0, "light: expected a name or a number, found nothing"));
            }
            let flux = self.not_negative(row, "flux", flux)?;
            let [red, green, blue] = ["r", "g", "b"].map(|column| self.not_negative(row, column, 1.0));
            let colour = [red?, green?, blue?].map(|colour| colour * flux);
            let (x, y) = (self.number(row, "x", 0.0)?, self.number(row, "y", 0.0)?);
            let values = [x, y, colour[0], colour[1], colour[2], self.not_negative(row, "size", SIZE)?];
            let track = lights.entry(name.to_owned()).or_insert_with(|| {
                order.push(name.to_owned());
                Vec::new()
            });
            let of = if self.has("light") { format!(" of light {name:?}") } else { String::new() };
            later(track, row.0, self.time(row)?, &of, values)?;
        }
        let path = |name: String| LightPath { track: Track::new(&lights[&name]), name };
        Ok(order.into_iter().map(path).collect())
    }

    fn camera(&self) -> Result<Path, Fault> {
        let mut track: Vec<(f64, [f64; 4])> = Vec::new();
        for row in &self.rows {
            let [yaw, pitch, roll] = ["yaw", "pitch", "roll"].map(|column| self.number(row, column, 0.0));
            let (yaw, pitch, roll, fov) = (yaw?, pitch?, roll?, self.number(row, "fov", VIEW_FOV)?);
            if !(-90.0..=90.0).contains(&pitch) {
                return Err(Fault::at(row.0, format!("pitch: expected -90 to 90 degrees, found {pitch}")));
            }
            check_fov(fov, None).map_err(|fault| Fault::at(row.0, format!("fov: {}", fault.reason)))?;
            // The short way round from the row before.
            let [yaw, roll] = match track.last() {
                Some((_, [before, _, rolled, _])) => [unwrapped(yaw, *before), unwrapped(roll, *rolled)],
                None => [yaw, roll],
            };
            later(&mut track, row.0, self.time(row)?, "", [yaw, pitch, roll, fov])?;
        }
        let sees = if self.has("fov") { Sees::Field } else { Sees::Unsaid };
        Ok(Path::Camera(Track::new(&track), sees))
    }
}

/// Where each column of a header stands, or what is wrong with it.
fn columns(header: &StringRecord) -> Result<HashMap<String, usize>, String> {
    let known = || TIMES.into_iter().chain(LIGHTS).chain(CAMERA);
    let mut columns = HashMap::new();
    for (at, name) in header.iter().enumerate() {
        let name = name.to_lowercase();
        if !known().any(|known| known == name) {
            let names = known().collect::<Vec<_>>().join(", ");
            return Err(format!("{name:?} is no column of a path; there are {names}"));
        }
        if columns.insert(name.clone(), at).is_some() {
            return Err(format!("there are two columns {name}"));
        }
    }
    match TIMES.map(|name| columns.contains_key(name)) {
        [false, false] => Err("the column time is missing (or frame, for times that are numbers of frames)".into()),
        [true, true] => Err("a row has a time or a frame, and not both".into()),
        _ => Ok(columns),
    }
}

/// The line of a record, whose position is where the reader began to look for it: before lines that are empty or comments.
fn line(at: &csv::Position, bytes: &[u8]) -> u64 {
    let (mut line, mut rest) = (at.line(), bytes.get(at.byte() as usize..).unwrap_or_default());
    while let [first @ (b'\n' | b'\r' | b'#'), others @ ..] = rest {
        rest = match first {
            b'#' => rest.iter().position(|&byte| byte == b'\n').map_or(&[][..], |end| &rest[end..]),
            _ => others,
        };
        line += u64::from(*first == b'\n');
    }
    line
}

/// Adds a row that has to be later than the one before.
fn later<const N: usize>(
    track: &mut Vec<(f64, [f64; N])>,
    line: u64,
    time: f64,
    of: &str,
    values: [f64; N],
) -> Result<(), Fault> {
    if let Some((before, _)) = track.last().filter(|(before, _)| time <= *before) {
        return Err(Fault::at(line, format!("times have to rise, and {time} follows {before}{of}")));
    }
    track.push((time, values));
    Ok(())
}

/// An angle in degrees by the turns that bring it closest to another.
fn unwrapped(angle: f64, before: f64) -> f64 {
    angle + 360.0 * ((before - angle) / 360.0).round()
}

/// What the reader says of a file that is no table.
fn broken(error: &csv::Error, bytes: &[u8]) -> Fault {
    let line = error.position().map(|at| line(at, bytes));
    match error.kind() {
        ErrorKind::UnequalLengths { expected_len, len, .. } => {
            Fault { line, reason: format!("it has {len} cells, and the header has {expected_len}") }
        }
        ErrorKind::Utf8 { .. } => Fault { line, reason: "this is not UTF-8 text".into() },
        _ => Fault { line, reason: error.to_string() },
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::motion::Camera;

    fn said(text: &str) -> Said {
        read(text.as_bytes()).unwrap_or_else(|fault| panic!("{:?}: {}", fault.line, fault.reason))
    }

    fn lights(text: &str) -> Vec<LightPath> {
        match said(text).path {
            Path::Lights(lights) => lights,
            Path::Camera(..) => panic!("lights are meant"),
        }
    }

    #[test]
    fn lights_keep_their_names_and_their_time() {
        let lights = lights(
            "\u{feff}time, light, x, y, flux, r, g, b\n# a comment\n0, lamp, -1, 0, 2, 1, 0.5, 0\n0, 7, 0, 1, 1, 1, 1, 1\n\
             2, 7, 0, 3, 1, 1, 1, 1\n4, lamp, 1, 0, 4, 1, 0.5, 0\n",
        );
        let names: Vec<_> = lights.iter().map(|light| &*light.name).collect();
        assert_eq!(names, ["lamp", "7"]);
        let lamp = lights[0].at(2.0).unwrap();
        assert_eq!((lamp.position, lamp.flux, lamp.size), (DVec2::ZERO, [3.0, 1.5, 0.0], SIZE));
        assert_eq!(lights[1].at(1.0).unwrap().position, DVec2::new(0.0, 2.0));
        assert!(lights[1].at(3.0).is_none() && lights[0].at(4.0).is_some());
        assert_eq!(Path::Lights(lights).span(), [0.0, 4.0]);
    }

    #[test]
    fn what_is_not_said_shows() {
        let light = lights("frame,x,y\n1,0.5,0.25\n")[0].at(1.0).unwrap();
        assert_eq!((light.flux, light.size), ([FLUX; 3], SIZE));
        assert_eq!(lights("time,x,y,r,g,b,size\n1,0,0,1,2,3,0.1\n")[0].at(1.0).unwrap().flux, [1.0, 2.0, 3.0]);
        assert!(said("frame,x,y\n1,0,0\n").counts_frames && !said("time,x,y\n1,0,0\n").counts_frames);
    }

    #[test]
    fn angles_go_the_short_way() {
        let Said { path: Path::Camera(track, sees), .. } = said("time,yaw,roll\n0,350,170\n1,10,-170\n3,-10,179\n")
        else {
            panic!("a camera is meant")
        };
        let camera = |time| Camera::at(&track, sees, time).unwrap();
        assert_eq!((camera(0.0).yaw, camera(1.0).yaw, camera(3.0).yaw), (350.0, 370.0, 350.0));
        assert!((350.0..=370.0).contains(&camera(0.5).yaw) && camera(0.5).fov.is_none());
        assert_eq!((camera(1.0).roll, camera(3.0).roll), (190.0, 179.0));
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, line, words) in [
            ("time,x,y\n0,0,0\n1,a,0\n", Some(3), "x: expected a finite number, found \"a\""),
            ("time,x,y\n0,0,NaN\n", Some(2), "y: expected a finite number"),
            ("time,x,y\n0,1e39,0\n", Some(2), "x: expected"),
            ("time,x,y,flux\n0,0,0,-1\n", Some(2), "flux: expected 0 or more"),
            ("time,x,y,size\n0,0,0,\n", Some(2), "size: expected a finite number, found \"\""),
            ("time,x,y\n1,0,0\n\n0,0,0\n", Some(4), "times have to rise, and 0 follows 1"),
            ("# by hand\r\n\r\ntime,x,y\r\n# and\r\n1,0,0\r\n#,,\r\n2,0\r\n", Some(7), "it has 2 cells"),
            ("# by hand\ntime,x,y,z\n", Some(2), "\"z\" is no column"),
            ("time,light,x,y\n1,a,0,0\n1,b,0,0\n1,a,0,0\n", Some(4), "of light \"a\""),
            ("time,light,x,y\n1,,0,0\n", Some(2), "light: expected a name"),
            ("frame,x,y\n1.5,0,0\n", Some(2), "frame: expected a whole number"),
            ("time,x\n0,0\n", Some(1), "the column y is missing"),
            ("x,y\n0,0\n", Some(1), "the column time is missing"),
            ("time,frame,x,y\n0,0,0,0\n", Some(1), "a time or a frame"),
            ("time,x,y,z\n0,0,0,0\n", Some(1), "\"z\" is no column"),
            ("time,x,y,x\n0,0,0,0\n", Some(1), "two columns x"),
            ("time,x,y,r\n0,0,0,0\n", Some(1), "all three or none"),
            ("time,x,y,yaw\n0,0,0,0\n", Some(1), "x is a column of lights and yaw one of a camera"),
            ("time\n0\n", Some(1), "what moves?"),
            ("time,pitch\n0,91\n", Some(2), "pitch: expected -90 to 90"),
            ("time,yaw,fov\n0,0,180\n", Some(2), "fov: a field of view is from 0.1"),
            ("time,x,y\n0,0\n", Some(2), "it has 2 cells, and the header has 3"),
            ("time,x,y\n", None, "it has no rows"),
            ("", Some(1), "time is missing"),
        ] {
            let fault = read(text.as_bytes()).err().unwrap_or_else(|| panic!("{text:?} is taken"));
            assert!(fault.line == line && fault.reason.contains(words), "{text:?}: {:?}, {}", fault.line, fault.reason);
        }
        assert!(read(b"time,x,y\n\xff,0,0\n").is_err());
    }
}
