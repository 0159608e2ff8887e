//! What a file says of the camera that its picture is from, and what the picture spans by that.
//!
//! \[EXIF\] CIPA DC-008-2023, 4.6.6: FocalLength, FocalLengthIn35mmFilm, FocalPlaneXResolution and what belongs to it.
//! \[35\] CIPA DCG-001, "35 mm film camera equivalent focal length": that of the same angle across the diagonal.
//! \[ATT\] OpenEXR, "Standard Attributes": `pinholeFocalLength`, `sensorPhotositePitch`, `sensorAcquisitionRectangle`. \[VIEW\] Greg
//! Ward, Radiance, rview(1): the options of a view.

use exif::{Context, Exif, In, Reader, Tag, Value};
use image::metadata::Orientation;

use super::Photo;
use super::decode::is_quarter_turn;
use crate::choices::Projection;
use crate::frame::Frame;

/// The diagonal of 36 × 24 mm, in millimetres.
const DIAGONAL_35: f64 = 43.266_615_305_567_87;

/// Angles across a picture's width that a camera's are taken for, in degrees; what is beyond them is nonsense.
const FIELDS: [f64; 2] = [0.1, 179.0];

/// By how many pixels the sides of a picture that was made smaller may miss its shape.
const ROUNDING: f64 = 1.5;

/// A picture as seen from where its camera stood.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// The focal length, in heights of a pixel: so far in front of the picture it is seen as the camera saw it.
    pub focal: f64,
    /// What the picture's width spans, in degrees, where that is what was said.
    said: Option<f64>,
    /// What that follows from, in words.
    pub from: String,
}

impl View {
    /// That of a picture whose width spans so many degrees, as the camera formed it.
    pub fn of_field(degrees: f64, frame: &Frame, projection: Projection) -> Self {
        let width = frame.pixel_aspect * f64::from(frame.width);
        let focal = match projection {
            Projection::Fisheye | Projection::Equirectangular => width / degrees.to_radians(),
            Projection::Rectilinear | Projection::Planar => 0.5 * width / (0.5 * degrees).to_radians().tan(),
        };
        Self { focal, said: Some(degrees), from: "as given".to_owned() }
    }

    /// The same of a picture made larger or smaller, in whose pixels it then is.
    pub fn resized(self, from: &Frame, to: &Frame) -> Self {
        let spans_width = self.said.is_some();
        let width = |frame: &Frame| frame.pixel_aspect * f64::from(frame.width);
        let height = |frame: &Frame| f64::from(frame.height);
        let scale = if spans_width { width(to) / width(from) } else { height(to) / height(from) };
        Self { focal: self.focal * scale, ..self }
    }

    /// What the width of the picture spans, in degrees, as the camera formed it; that of a plane as of a rectilinear one.
    pub fn across(&self, frame: &Frame, projection: Projection) -> f64 {
        let width = frame.pixel_aspect * f64::from(frame.width);
        self.said.unwrap_or_else(|| match projection {
            Projection::Fisheye | Projection::Equirectangular => (width / self.focal).to_degrees(),
            Projection::Rectilinear | Projection::Planar => 2.0 * (0.5 * width / self.focal).atan().to_degrees(),
        })
    }
}

/// What a file says of its camera, as far as the picture's field of view follows from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Camera {
    says: Says,
    /// Columns and rows of the picture as the camera made it, where the file says how many there were.
    original: Option<[f64; 2]>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Says {
    /// Degrees across the width of the picture.
    Across(f64),
    /// Degrees from its top to its bottom.
    Down(f64),
    /// \[35\] in millimetres.
    Equivalent(f64),
    /// A focal length in millimetres, and the pixels to a millimetre of the sensor.
    Sensor { focal: f64, pixels: f64 },
}

/// The numbers of \[EXIF\]'s tags, and their names.
pub(super) mod tag {
    pub const FOCAL_LENGTH: u16 = 0x920a;
    pub const PIXEL_X_DIMENSION: u16 = 0xa002;
    pub const PIXEL_Y_DIMENSION: u16 = 0xa003;
    pub const FOCAL_PLANE_X_RESOLUTION: u16 = 0xa20e;
    pub const FOCAL_PLANE_Y_RESOLUTION: u16 = 0xa20f;
    pub const FOCAL_PLANE_RESOLUTION_UNIT: u16 = 0xa210;
    pub const FOCAL_LENGTH_IN_35_MM_FILM: u16 = 0xa405;

    /// All of them.
    pub const NAMES: [(u16, &str); 7] = [
        (FOCAL_LENGTH, "FocalLength"),
        (PIXEL_X_DIMENSION, "PixelXDimension"),
        (PIXEL_Y_DIMENSION, "PixelYDimension"),
        (FOCAL_PLANE_X_RESOLUTION, "FocalPlaneXResolution"),
        (FOCAL_PLANE_Y_RESOLUTION, "FocalPlaneYResolution"),
        (FOCAL_PLANE_RESOLUTION_UNIT, "FocalPlaneResolutionUnit"),
        (FOCAL_LENGTH_IN_35_MM_FILM, "FocalLengthIn35mmFilm"),
    ];
}

/// What is a length or a count at all.
fn sound(value: f64) -> Option<f64> {
    (value.is_finite() && value > 0.0).then_some(value)
}

impl Camera {
    /// That of an OpenEXR file whose `fieldOfViewHorizontal` or `fieldOfViewVertical` this is, as 3Delight writes them, or of
    /// \[VIEW\].
    pub fn of_angles([across, down]: [Option<f64>; 2]) -> Option<Self> {
        let says = match (across.and_then(sound), down.and_then(sound)) {
            (Some(across), _) => Says::Across(across),
            (None, Some(down)) => Says::Down(down),
            (None, None) => return None,
        };
        Some(Self { says, original: None })
    }

    /// \[EXIF\] by the values of its tags: the equivalent focal length, else the focal length with the resolution on the
    /// focal plane, both ways and its unit. A focal length by itself says nothing.
    pub fn of_exif(value: impl Fn(u16) -> Option<f64>) -> Option<Self> {
        let value = |tag| value(tag).and_then(sound);
        let original = value(tag::PIXEL_X_DIMENSION).zip(value(tag::PIXEL_Y_DIMENSION));
        let original = original.map(|(columns, rows)| [columns, rows]);
        if let Some(equivalent) = value(tag::FOCAL_LENGTH_IN_35_MM_FILM) {
            return Some(Self { says: Says::Equivalent(equivalent), original });
        }
        let focal = value(tag::FOCAL_LENGTH)?;
        let (x, y) = (value(tag::FOCAL_PLANE_X_RESOLUTION)?, value(tag::FOCAL_PLANE_Y_RESOLUTION)?);
        let unit = match value(tag::FOCAL_PLANE_RESOLUTION_UNIT)? {
            2.0 => 25.4,
            3.0 => 10.0,
            // Not in the standard, but written by some cameras: millimetres and micrometres.
            4.0 => 1.0,
            5.0 => 1e-3,
            _ => return None,
        };
        // Pixels are square; one number is wrong where they are not.
        (0.5..2.0)
            .contains(&(x / y))
            .then_some(Self { says: Says::Sensor { focal, pixels: (x * y).sqrt() / unit }, original })
    }

    /// That of \[EXIF\] which was read, for a picture that is turned so.
    pub fn of_fields(exif: &Exif, turn: Orientation) -> Option<Self> {
        let camera = Self::of_exif(|tag| {
            let field = exif.get_field(Tag(Context::Exif, tag), In::PRIMARY)?;
            match &field.value {
                Value::Rational(values) => values.first().map(|value| value.to_f64()),
                Value::SRational(values) => values.first().map(|value| value.to_f64()),
                Value::Float(values) => values.first().map(|&value| value.into()),
                Value::Double(values) => values.first().copied(),
                value => value.get_uint(0).map(f64::from),
            }
        })?;
        Some(if is_quarter_turn(turn) { camera.turned() } else { camera })
    }

    /// That of \[EXIF\] as it stands in a file, from the byte order on, as far as it can be read.
    pub fn of_raw_exif(raw: &[u8], turn: Orientation) -> Option<Self> {
        let read = Reader::new().continue_on_error(true).read_raw(raw.to_vec());
        let exif = read.or_else(|error| error.distill_partial_result(|_| {})).ok()?;
        Self::of_fields(&exif, turn)
    }

    /// \[ATT\] a focal length in millimetres, the distance of photosites in micrometres, and the columns and rows of those that
    /// became pixels.
    pub fn of_sensor(focal: f64, pitch: f64, original: [f64; 2]) -> Option<Self> {
        let says = Says::Sensor { focal: sound(focal)?, pixels: 1e3 / sound(pitch)? };
        Some(Self { says, original: Some([sound(original[0])?, sound(original[1])?]) })
    }

    /// The same of a picture that was turned by 90° since.
    pub fn turned(self) -> Self {
        Self { original: self.original.map(|[columns, rows]| [rows, columns]), ..self }
    }

    /// How a picture of this camera was seen; none where what is said makes no sense.
    ///
    /// # Errors
    /// Why that does not follow, in words.
    fn view(&self, frame: &Frame) -> Result<Option<View>, String> {
        let aspect = frame.pixel_aspect;
        let [width, height] = [f64::from(frame.width), f64::from(frame.height)];
        let half = |angle: f64| (0.5 * angle).to_radians().tan();
        let diagonal = |[columns, rows]: [f64; 2]| (aspect * columns).hypot(rows);
        let (focal, from) = match self.says {
            Says::Across(angle) if angle < 180.0 => {
                (0.5 * aspect * width / half(angle), "the file's own field".to_owned())
            }
            Says::Down(angle) if angle < 180.0 => {
                (0.5 * height / half(angle), "the file's own vertical field".to_owned())
            }
            Says::Across(_) | Says::Down(_) => return Ok(None),
            Says::Equivalent(equivalent) => {
                let (original, scale) = self.original([width, height])?;
                let focal = equivalent / DIAGONAL_35 * diagonal(original) * scale;
                (focal, format!("35 mm equivalent {equivalent} mm"))
            }
            Says::Sensor { focal, pixels } => {
                let (_, scale) = self.original([width, height])?;
                (focal * pixels * scale, format!("focal length {focal} mm, {pixels:.1} pixels to a mm of the sensor"))
            }
        };
        let view = View { focal, said: None, from };
        Ok((FIELDS[0]..=FIELDS[1]).contains(&view.across(frame, Projection::Rectilinear)).then_some(view))
    }

    /// The columns and rows of the picture that the camera made, as it lies now, and what one of its pixels is in this one's.
    ///
    /// # Errors
    /// Where it was cut to another shape and made smaller or larger, too: then nothing says by how much.
    fn original(&self, [width, height]: [f64; 2]) -> Result<([f64; 2], f64), String> {
        let Some(original) = self.original else { return Ok(([width, height], 1.0)) };
        let [columns, rows] = original;
        for [columns, rows] in [[columns, rows], [rows, columns]] {
            let (long, short, side) =
                if columns >= rows { (columns, rows, [width, height]) } else { (rows, columns, [height, width]) };
            // Of the same shape it is all of it, whatever its size.
            if (side[1] - side[0] * short / long).abs() <= ROUNDING {
                return Ok(([columns, rows], side[0] / long));
            }
        }
        for [columns, rows] in [[columns, rows], [rows, columns]] {
            // Cut along one side, and not made smaller: the other side shows it.
            if width <= columns && height <= rows && (width == columns || height == rows) {
                return Ok(([columns, rows], 1.0));
            }
        }
        Err(format!(
            "its file tells of the lens, but of a picture of {columns} × {rows} pixels, of which this one of {width} × {height} is a \
             part that nobody says"
        ))
    }
}

impl Photo {
    /// How the picture was seen, as far as its file says that: by \[EXIF\] in JPEG, PNG and TIFF, by attributes in OpenEXR, by VIEW
    /// in Radiance. The picture is all of its display window, whichever part of it is stored.
    ///
    /// # Errors
    /// Why that does not follow from what it says, in words.
    pub fn view(&self) -> Result<Option<View>, String> {
        let Some(camera) = self.source.camera else { return Ok(None) };
        let [columns, rows] = self.source.overscan;
        if [columns, rows] == [0; 2] {
            return camera.view(&self.frame);
        }
        // The file speaks of all that it holds.
        let Frame { width, height, .. } = self.frame;
        let view = camera.view(&Frame { width: width + 2 * columns, height: height + 2 * rows, ..self.frame })?;
        Ok(view.map(|view| View { said: None, ..view }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exif(values: &[(u16, f64)]) -> Option<Camera> {
        Camera::of_exif(|tag| values.iter().find(|(known, _)| *known == tag).map(|(_, value)| *value))
    }

    fn across(camera: Camera, width: u32, height: u32) -> f64 {
        let frame = Frame::full(width, height);
        camera.view(&frame).unwrap().unwrap().across(&frame, Projection::Rectilinear)
    }

    /// 2 atan(w / 2f) by hand: 36 mm and 28 mm, 24 mm and 28 mm, and a square whose diagonal is that of 36 × 24 mm.
    #[test]
    fn an_equivalent_focal_length_counts_by_the_diagonal() {
        let camera = exif(&[(tag::FOCAL_LENGTH_IN_35_MM_FILM, 28.0)]).unwrap();
        for (size, angle) in [([6000, 4000], 65.470_45), ([4000, 6000], 46.397_18), ([3000, 3000], 57.297_64)] {
            let found = across(camera, size[0], size[1]);
            assert!((found - angle).abs() < 1e-4, "{size:?}: {found}");
        }
    }

    #[test]
    fn a_focal_length_says_something_with_its_sensor_alone() {
        let lens = (tag::FOCAL_LENGTH, 35.0);
        // 6000 pixels to 23.5 mm, and as many to an inch as that makes: 2 atan(23.5 / 70) is 37.1218°.
        let resolution = 6000.0 / 23.5 * 25.4;
        let plane = [
            lens,
            (tag::FOCAL_PLANE_X_RESOLUTION, resolution),
            (tag::FOCAL_PLANE_Y_RESOLUTION, resolution),
            (tag::FOCAL_PLANE_RESOLUTION_UNIT, 2.0),
            (tag::PIXEL_X_DIMENSION, 6000.0),
            (tag::PIXEL_Y_DIMENSION, 4000.0),
        ];
        let wanted = 2.0 * (23.5f64 / 70.0).atan().to_degrees();
        let camera = exif(&plane).unwrap();
        // All of it, half as large, and cut to a square at full size.
        assert!((across(camera, 6000, 4000) - wanted).abs() < 1e-9);
        assert!((across(camera, 3000, 2000) - wanted).abs() < 1e-9);
        let square = 2.0 * (0.5 * 4000.0 / 6000.0 * 23.5 / 35.0f64).atan().to_degrees();
        assert!((across(camera, 4000, 4000) - square).abs() < 1e-9);
        for missing in 0..4 {
            let mut part = plane.to_vec();
            part.remove(missing);
            assert_eq!(exif(&part), None, "without {missing}");
        }
        assert_eq!(exif(&[lens]), None);
    }

    #[test]
    fn a_part_of_an_unknown_size_says_so() {
        let of = |width: u32, height: u32| {
            let values = [
                (tag::FOCAL_LENGTH_IN_35_MM_FILM, 50.0),
                (tag::PIXEL_X_DIMENSION, 6000.0),
                (tag::PIXEL_Y_DIMENSION, 4000.0),
            ];
            exif(&values).unwrap().view(&Frame::full(width, height)).map(|view| view.unwrap().focal)
        };
        let whole = of(6000, 4000).unwrap();
        assert!((of(1500, 1000).unwrap() / whole - 0.25).abs() < 1e-12, "made smaller");
        assert!((of(1499, 1000).unwrap() / whole - 0.25).abs() < 1e-3, "and rounded");
        assert!((of(4000, 6000).unwrap() / whole - 1.0).abs() < 1e-12, "turned");
        for (width, height) in [(4000, 4000), (6000, 2000), (3000, 6000)] {
            assert_eq!(of(width, height), Ok(whole), "cut: {width} × {height}");
        }
        for (width, height) in [(1000, 1000), (8000, 4000), (5000, 3999)] {
            assert!(of(width, height).is_err_and(|said| said.contains("6000 × 4000")), "{width} × {height}");
        }
    }

    #[test]
    fn nonsense_is_as_good_as_nothing() {
        let frame = Frame::full(300, 200);
        for value in [0.0, -28.0, f64::NAN, f64::INFINITY, 1e9, 1e-9] {
            let view = exif(&[(tag::FOCAL_LENGTH_IN_35_MM_FILM, value)]).map(|camera| camera.view(&frame));
            assert!(matches!(view, None | Some(Ok(None))), "{value}: {view:?}");
            for angles in [[Some(value), None], [None, Some(value)]] {
                let view = Camera::of_angles(angles).map(|camera| camera.view(&frame));
                assert!(matches!(view, None | Some(Ok(None))), "{value}: {view:?}");
            }
            assert!(Camera::of_sensor(value, 4.0, [300.0, 200.0]).is_none_or(|camera| camera.view(&frame) == Ok(None)));
        }
        let odd = [
            (tag::FOCAL_LENGTH, 50.0),
            (tag::FOCAL_PLANE_X_RESOLUTION, 4000.0),
            (tag::FOCAL_PLANE_Y_RESOLUTION, 100.0),
            (tag::FOCAL_PLANE_RESOLUTION_UNIT, 2.0),
        ];
        assert_eq!(exif(&odd), None);
    }

    #[test]
    fn fields_and_sensors_of_openexr_are_those_of_their_pixels() {
        // 640 × 480 by 3Delight: 45.6036° across and 35° down.
        let both = Camera::of_angles([Some(45.6036), Some(35.0)]).unwrap();
        assert!((across(both, 640, 480) - 45.6036).abs() < 1e-9);
        let down = Camera::of_angles([None, Some(35.0)]).unwrap();
        assert!((across(down, 640, 480) - 45.6036).abs() < 1e-3);
        // 4000 × 8 µm are 32 mm: 2 atan(16 / 32).
        let camera = Camera::of_sensor(32.0, 8.0, [4000.0, 2000.0]).unwrap();
        assert!((across(camera, 4000, 2000) - 2.0 * 0.5f64.atan().to_degrees()).abs() < 1e-9);
        assert!((across(camera, 1000, 500) - 2.0 * 0.5f64.atan().to_degrees()).abs() < 1e-9);
    }
}
