//! The primaries of a colour space: its way to Rec.709, and its luminance.

use glam::{DMat3, DVec2, DVec3};

/// CIE 1931 chromaticities (x, y) of a colour space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Primaries {
    /// Of (1, 0, 0).
    pub red: DVec2,
    /// Of (0, 1, 0).
    pub green: DVec2,
    /// Of (0, 0, 1).
    pub blue: DVec2,
    /// Of (1, 1, 1).
    pub white: DVec2,
}

const D65: DVec2 = DVec2::new(0.3127, 0.3290);
const D50: DVec2 = DVec2::new(0.3457, 0.3585);
const ACES_WHITE: DVec2 = DVec2::new(0.32168, 0.33767);

impl Primaries {
    /// ITU-R BT.709, also sRGB's.
    pub const REC709: Self = Self::new([0.64, 0.33], [0.30, 0.60], [0.15, 0.06], D65);
    /// ITU-R BT.2020.
    pub const REC2020: Self = Self::new([0.708, 0.292], [0.170, 0.797], [0.131, 0.046], D65);
    /// SMPTE EG 432-1, Display P3.
    pub const P3_D65: Self = Self::new([0.680, 0.320], [0.265, 0.690], [0.150, 0.060], D65);

    /// Adobe RGB (1998).
    pub const ADOBE_RGB: Self = Self::new([0.64, 0.33], [0.21, 0.71], [0.15, 0.06], D65);
    /// ROMM RGB, ISO 22028-2: ProPhoto's.
    pub const PROPHOTO: Self = Self::new([0.7347, 0.2653], [0.1596, 0.8404], [0.0366, 0.0001], D50);
    /// ACES AP1, SMPTE ST 2065-1 and S-2014-004: ACEScg's.
    pub const ACESCG: Self = Self::new([0.713, 0.293], [0.165, 0.830], [0.128, 0.044], ACES_WHITE);
    /// ACES AP0, SMPTE ST 2065-1.
    pub const ACES2065_1: Self = Self::new([0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077], ACES_WHITE);

    /// CIE 1931 XYZ, with equal energy as white.
    pub const XYZ: Self = Self::new([1.0, 0.0], [0.0, 1.0], [0.0, 0.0], DVec2::new(1.0 / 3.0, 1.0 / 3.0));

    /// The primaries that have a name here.
    pub const NAMES: [(&str, Self); 8] = [
        ("rec709", Self::REC709),
        ("p3-d65", Self::P3_D65),
        ("rec2020", Self::REC2020),
        ("adobe-rgb", Self::ADOBE_RGB),
        ("prophoto", Self::PROPHOTO),
        ("acescg", Self::ACESCG),
        ("aces2065-1", Self::ACES2065_1),
        ("xyz", Self::XYZ),
    ];

    /// What people call these primaries, where they have a name (to three decimals, as files round them).
    pub(crate) fn title(self) -> Option<&'static str> {
        const TITLES: [&str; 8] = [
            "Rec. 709",
            "Display P3",
            "Rec. 2020",
            "Adobe RGB (1998)",
            "ProPhoto RGB",
            "ACEScg",
            "ACES2065-1",
            "CIE XYZ",
        ];
        Self::NAMES.iter().position(|&(_, known)| self.near(known)).map(|k| TITLES[k])
    }

    /// Those called `name`: one of [`Self::NAMES`], or as `--colorspace` has it, `p3d65`, `adobergb`, `ap0` or `ap1`.
    pub fn named(name: &str) -> Option<Self> {
        let name = match name {
            "p3d65" => "p3-d65",
            "adobergb" => "adobe-rgb",
            "ap0" => "aces2065-1",
            "ap1" => "acescg",
            name => name,
        };
        Self::NAMES.into_iter().find(|&(known, _)| known == name).map(|(_, primaries)| primaries)
    }

    const fn new(red: [f64; 2], green: [f64; 2], blue: [f64; 2], white: DVec2) -> Self {
        Self { red: DVec2::from_array(red), green: DVec2::from_array(green), blue: DVec2::from_array(blue), white }
    }

    /// These primaries, if they span a colour space.
    pub fn sound(self) -> Option<Self> {
        let spans = |matrix: &DMat3| matrix.is_finite() && matrix.determinant().abs() > 1e-6;
        self.to_xyz().is_some_and(|matrix| spans(&matrix)).then_some(self)
    }

    /// These primaries, if they span a colour space and are not Rec.709's (to three decimals, as files round them).
    pub(super) fn other_than_rec709(self) -> Option<Self> {
        self.sound().filter(|_| !self.near(Self::REC709))
    }

    /// Whether they are the same to three decimals, as files round them.
    pub(super) fn near(self, other: Self) -> bool {
        let points = |p: Self| [p.red, p.green, p.blue, p.white];
        points(self).into_iter().zip(points(other)).all(|(a, b)| (a - b).abs().max_element() < 1e-3)
    }

    /// The share of red, green and blue in luminance; they add up to 1.
    pub fn luminance_weights(&self) -> [f64; 3] {
        self.to_xyz().unwrap_or(DMat3::IDENTITY).row(1).to_array()
    }

    /// The matrix from this space to Rec.709: white to white, by Bradford's adaptation.
    ///
    /// CIE XYZ is not adapted: its numbers are what an observer measures of a light, and D65 is (0.9505, 1, 1.089)
    /// among them, whatever white their file names. So OpenEXR's test pictures have it: XYZ.exr and Rec709.exr of its
    /// Chromaticities show the same.
    pub(super) fn to_rec709(self) -> DMat3 {
        let (from, to) = (self.to_xyz(), Self::REC709.to_xyz());
        let white = Self::REC709.white;
        match (from, to) {
            _ if self.is_xyz() => Self::xyz_to_rec709(),
            (Some(from), Some(to)) => to.inverse() * adapt(self.white, white) * from,
            _ => DMat3::IDENTITY,
        }
    }

    /// Whether the primaries are those of CIE XYZ, whatever the white.
    fn is_xyz(self) -> bool {
        let near = |a: DVec2, b: DVec2| (a - b).abs().max_element() < 1e-3;
        near(self.red, Self::XYZ.red) && near(self.green, Self::XYZ.green) && near(self.blue, Self::XYZ.blue)
    }

    /// The matrix from CIE XYZ as it stands, not adapted to another white, to Rec.709: (0.9505, 1, 1.089) is white.
    pub(super) fn xyz_to_rec709() -> DMat3 {
        Self::REC709.to_xyz().unwrap_or(DMat3::IDENTITY).inverse()
    }

    /// The matrix from XYZ divided by that of `white`, so that (1, 1, 1) is white, to Rec.709: white to white.
    pub(super) fn relative_xyz_to_rec709(white: DVec2) -> DMat3 {
        Self::xyz_to_rec709() * adapt(white, D65) * DMat3::from_diagonal(xyz(white))
    }

    /// The matrix from the XYZ of an ICC profile, whose white is D50, to Rec.709.
    pub(super) fn pcs_to_rec709() -> DMat3 {
        Self::xyz_to_rec709() * adapt(D50, D65)
    }

    /// RGB to XYZ with Y = 1 at white: each primary's XYZ, scaled so that they add up to white.
    fn to_xyz(self) -> Option<DMat3> {
        // A primary may have no luminance of its own (blue of CIE XYZ), so its direction is (x, y, z) and not X/Y.
        let direction = |c: DVec2| DVec3::new(c.x, c.y, 1.0 - c.x - c.y);
        let directions = DMat3::from_cols(direction(self.red), direction(self.green), direction(self.blue));
        let scale = directions.inverse() * xyz(self.white);
        let matrix = directions * DMat3::from_diagonal(scale);
        (directions.determinant().abs() > 1e-9 && matrix.is_finite()).then_some(matrix)
    }
}

/// XYZ of a chromaticity at Y = 1.
fn xyz(c: DVec2) -> DVec3 {
    DVec3::new(c.x / c.y, 1.0, (1.0 - c.x - c.y) / c.y)
}

/// Bradford's chromatic adaptation: Lam 1985, as in ICC.1:2022 annex E.
fn adapt(from: DVec2, to: DVec2) -> DMat3 {
    let cone = DMat3::from_cols_array(&[0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296]);
    let ratio = (cone * xyz(to)) / (cone * xyz(from));
    cone.inverse() * DMat3::from_diagonal(ratio) * cone
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luminance_weights_are_the_published_ones() {
        let close = |p: Primaries, want: [f64; 3]| {
            let got = p.luminance_weights();
            assert!(got.iter().zip(want).all(|(g, w)| (g - w).abs() < 1e-4), "{got:?} for {want:?}");
        };
        close(Primaries::REC709, [0.2126, 0.7152, 0.0722]);
        close(Primaries::REC2020, [0.2627, 0.6780, 0.0593]);
        close(Primaries::ACESCG, [0.2722, 0.6741, 0.0537]);
    }

    #[test]
    fn acescg_to_rec709_is_the_published_matrix() {
        // ACES Output Transform, AP1 to Rec.709 with Bradford D60 to D65.
        let want = [[1.70505, -0.62179, -0.08326], [-0.13026, 1.14080, -0.01055], [-0.02400, -0.12897, 1.15297]];
        let got = Primaries::ACESCG.to_rec709();
        for (row, want) in want.iter().enumerate() {
            for (column, want) in want.iter().enumerate() {
                let got = got.col(column)[row];
                assert!((got - want).abs() < 2e-4, "row {row} column {column}: {got} for {want}");
            }
        }
    }

    #[test]
    fn xyz_is_what_it_says_and_not_adapted() {
        // IEC 61966-2-1's matrix from XYZ of D65 to linear Rec.709, to its four decimals.
        let want = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];
        for white in [Primaries::XYZ.white, D65] {
            let got = Primaries { white, ..Primaries::XYZ }.to_rec709();
            for (row, want) in want.iter().enumerate() {
                for (column, want) in want.iter().enumerate() {
                    assert!((got.col(column)[row] - want).abs() < 2e-3, "row {row} column {column}: {got}");
                }
            }
        }
        let weights = Primaries::XYZ.luminance_weights();
        assert!(weights.iter().zip([0.0, 1.0, 0.0]).all(|(got, want)| (got - want).abs() < 1e-12), "{weights:?}");
        // SMPTE ST 2065-1's second row: the blue of AP0 takes from luminance.
        let weights = Primaries::ACES2065_1.luminance_weights();
        let want = [0.343_966_449_8, 0.728_166_096_6, -0.072_132_546_4];
        assert!(weights.iter().zip(want).all(|(got, want)| (got - want).abs() < 1e-6), "{weights:?}");
    }

    #[test]
    fn xyz_over_white_is_white_in_rec709() {
        for white in [D50, D65, ACES_WHITE, Primaries::XYZ.white] {
            let light = Primaries::relative_xyz_to_rec709(white) * DVec3::ONE;
            assert!((light - 1.0).abs().max_element() < 1e-12, "{light} for {white}");
        }
    }

    #[test]
    fn senseless_primaries_are_ignored() {
        let point = Primaries::new([0.3, 0.3], [0.3, 0.3], [0.3, 0.3], D65);
        assert_eq!(point.other_than_rec709(), None);
        let nan = Primaries::new([f64::NAN, 0.3], [0.3, 0.6], [0.15, 0.06], D65);
        assert_eq!(nan.other_than_rec709(), None);
        let zero = Primaries::new([0.0; 2], [0.0; 2], [0.0; 2], DVec2::ZERO);
        assert_eq!(zero.other_than_rec709(), None);
        assert_eq!(Primaries::REC709.other_than_rec709(), None);
        assert_eq!(Primaries::ACESCG.other_than_rec709(), Some(Primaries::ACESCG));
    }
}
